"""Certificates checked from their data alone: whole numbers and fractions, no algebra system.

A polynomial is a list of [exponents, coefficient].  `certificates` and `derivations` make them and share nothing with
this file but the layout of the data; the sentence that goes with one is made from the data (`sentences`), and another
is refused.  Signs, roots and values are checked here, identities and motions in `checked_identities`.
"""

from collections.abc import Mapping
from fractions import Fraction
from itertools import pairwise
from typing import Any

from singimpact.algebra.checked_identities import composed, flight, identity, motion
from singimpact.algebra.plain import Terms, line, plus, raised, rational, row, terms, times
from singimpact.algebra.sentences import sentence

INFINITE = ("-oo", "oo")
ONE = Fraction(1)


def accepts(certificate: Mapping[str, Any]) -> bool:
    """Whether the data prove what the certificate claims; damaged data prove nothing.

    Examples
    --------
    >>> accepts({"kind": "definite", "variables": ["x", "y"], "form": ["6", "4", "1"], "sign": 1})
    True
    >>> accepts({"kind": "definite", "variables": ["x", "y"], "form": ["6", "5", "1"], "sign": 1})
    False
    """
    try:
        said = sentence(certificate)
        return certificate.get("says", said) == said and bool(_CHECKS[certificate["kind"]](certificate))
    except (KeyError, TypeError, ValueError, ZeroDivisionError, IndexError, AttributeError):
        return False


def _at(poly: Terms, index: int, place: str) -> Terms:
    """A variable set to a number, or the leading coefficient, signed, at infinity; it stays, to power 0."""
    if place in INFINITE:
        top = max(key[index] for key in poly)
        sign = -1 if place == "-oo" and top % 2 else 1
        return {_without(key, index): value * sign for key, value in poly.items() if key[index] == top}
    total: Terms = {}
    for key, value in poly.items():
        total = plus(total, {_without(key, index): value * rational(place) ** key[index]})
    return total


def _without(key: tuple[int, ...], index: int) -> tuple[int, ...]:
    return (*key[:index], 0, *key[index + 1 :])


def _expands(poly: Terms, proof: Mapping[str, Any]) -> bool:
    """poly times powers of 1 + distance equals a sum, with coefficients > 0, of products of distances to the ends."""
    size, left, total = len(proof["box"]), poly, dict[tuple[int, ...], Fraction]()
    expansion = terms(proof["expansion"])
    for index, (low, high) in enumerate(proof["box"]):
        more = proof["raised"][index]
        if more if low not in INFINITE and high not in INFINITE else proof["degree"][index]:
            return False  # a finite interval has a degree and needs no factor, a half-line the other way round
        one = _distance(low, 1, index, size) if high == "oo" else _distance(high, -1, index, size)
        left = times(left, raised(plus(one, line(ONE, 0, index, size)), more, size))
    for key, value in expansion.items():
        term = {(0,) * size: value}
        for index, (low, high) in enumerate(proof["box"]):
            term = times(term, _basis(low, high, key[index], proof["degree"][index], index, size))
        total = plus(total, term)
    return bool(expansion) and all(value > 0 for value in expansion.values()) and left == total


def _distance(end: str, sign: int, index: int, size: int) -> Terms:
    return line(-sign * rational(end), sign, index, size)


def _basis(low: str, high: str, power: int, degree: int, index: int, size: int) -> Terms:
    """(x - low)^power (high - x)^(degree - power), or a power of the distance to the one finite end."""
    if high == "oo":
        return raised(_distance(low, 1, index, size), power, size)
    if low == "-oo":
        return raised(_distance(high, -1, index, size), power, size)
    if not rational(low) < rational(high):
        raise ValueError("no such interval")
    above = raised(_distance(high, -1, index, size), degree - power, size)
    return times(raised(_distance(low, 1, index, size), power, size), above)


def _positive(data: Mapping[str, Any]) -> bool:
    """numerator/denominator has the sign claimed on the open box."""
    poly = times(terms(data["numerator"]), terms(data["denominator"]))
    return data["sign"] in (-1, 1) and _expands({key: value * data["sign"] for key, value in poly.items()}, data)


def _order(place: str) -> tuple[int, Fraction]:
    """Places on the line in order, the infinite ones too."""
    return (INFINITE.index(place) * 2 - 1, Fraction(0)) if place in INFINITE else (0, rational(place))


def _chain(data: Mapping[str, Any]) -> bool:
    """At each place one sign for all parameters in the box; so a root in every gap where it changes, and no others."""
    poly, places = terms(data["polynomial"]), data["places"]
    order = [_order(point["at"]) for point in places]
    for point in places:
        value = _at(poly, 0, point["at"])
        signed = {key[1:]: number * point["sign"] for key, number in value.items()}
        if point["sign"] not in (-1, 1) or not _expands(signed, point | {"box": data["box"]}):
            return False
    gaps = [[a["at"], b["at"]] for a, b in pairwise(places) if a["sign"] != b["sign"]]
    degree = max(key[0] for key in poly)
    return order == sorted(order) and gaps == data["roots"] and data["all"] == (len(gaps) == degree)


def _count(data: Mapping[str, Any]) -> bool:
    """Sturm: the polynomial without multiple roots has so many roots in the open interval."""
    chain = [row(member) for member in data["chain"]]
    ends = [_order(data["low"]), _order(data["high"])]
    slope = {(key[0] - 1,): value * key[0] for key, value in chain[0].items() if key[0]}
    if rational(data["first"]) <= 0 or slope != times(chain[1], {(0,): rational(data["first"])}):
        return False
    for n, (quotient, scale) in enumerate(data["steps"]):
        last = chain[n + 2] if n + 2 < len(chain) else {}
        right = plus(times(row(quotient), chain[n + 1]), last, -rational(scale))
        if rational(scale) <= 0 or chain[n] != right or (not last and rational(scale) != 1):
            return False
    changes = [_changes(chain, end) for end in (data["low"], data["high"])]
    at_end = data["high"] not in INFINITE and not _at(chain[0], 0, data["high"])
    whole = len(data["steps"]) == len(chain) - 1 and set(chain[-1]) == {(0,)}
    return whole and ends[0] < ends[1] and changes[0] - changes[1] - at_end == data["roots"]


def _changes(chain: list[Terms], place: str) -> int:
    values = [sum(_at(part, 0, place).values(), Fraction(0)) for part in chain]
    signs = [value > 0 for value in values if value]
    return sum(a != b for a, b in pairwise(signs))


def _value(data: Mapping[str, Any]) -> bool:
    """A quotient at a place, after common factors are gone; at infinity the degrees decide before the coefficients."""
    polys, index, at = [terms(data[name]) for name in ("numerator", "denominator")], data["index"], data["at"]
    above, below = (_at(poly, index, at) if poly else {} for poly in polys)
    if not polys[1]:
        return False
    more = max((key[index] for key in polys[0]), default=-1) - max(key[index] for key in polys[1])
    if at in INFINITE and more < 0:
        above = {}
    if data["value"] == "infinite":
        return bool(above) and (more > 0 if at in INFINITE else not below)
    stated = [terms(side) for side in data["value"]]
    free = not any(key[index] for side in stated for key in side) and not (at in INFINITE and more > 0)
    return free and bool(below and stated[1]) and times(above, stated[1]) == times(below, stated[0])


def _definite(data: Mapping[str, Any]) -> bool:
    """a x^2 + b x y + c y^2 has one sign off the origin."""
    a, b, c = (data["sign"] * rational(value) for value in data["form"])
    return data["sign"] in (-1, 1) and a > 0 and 4 * a * c > b * b


_CHECKS = {
    "positive": _positive,
    "chain": _chain,
    "count": _count,
    "value": _value,
    "definite": _definite,
    "identity": identity,
    "composed": composed,
    "motion": motion,
    "flight": flight,
}
