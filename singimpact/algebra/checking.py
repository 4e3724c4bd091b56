"""Certificates checked from their data alone: whole numbers and fractions, no algebra system.

A polynomial is a list of [exponents, coefficient].  `certificates` and `derivations` make them and share nothing with
this file but the layout of the data; the sentence that goes with one is made from the data (`sentences`), and another
is refused.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

from singimpact.algebra.plain import (
    Terms,
    at,
    cut,
    line,
    plus,
    powers,
    raised,
    rational,
    row,
    short_times,
    slope,
    substituted,
    terms,
    times,
    weight,
)
from singimpact.algebra.sentences import sentence

INFINITE = ("-oo", "oo")
ONE, ZERO = Fraction(1), Fraction(0)


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
        leading = {key: value * sign for key, value in poly.items() if key[index] == top}
        return {(*key[:index], 0, *key[index + 1 :]): value for key, value in leading.items()}
    return at(poly, index, rational(place))


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
        signed = {key[1:]: number * point["sign"] for key, number in _at(poly, 0, point["at"]).items()}
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
    return sum(a != b for a, b in pairwise([value > 0 for value in values if value]))


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


# The checks of identities: two different quotients are equal, or two compositions are, exactly or to an order.
#
# Where a relation is given, of degree 2 in the last variable, the identity holds at both its roots.


class Cut(NamedTuple):
    """The truncation: terms of weighted degree <= order; all terms for None."""

    weights: Sequence[int]
    order: int | None

    def of(self, poly: Terms) -> Terms:
        return cut(poly, *self)

    def lowest(self, poly: Terms) -> Terms:
        """The part without small variables: where it is not 0, a denominator is invertible as a series."""
        return poly if self.order is None else cut(poly, self.weights, 0)

    def spared(self, *polys: Terms) -> bool:
        """Whether no small variable occurs."""
        return self.order is None or not any(weight(key, self.weights) for poly in polys for key in poly)


def identity(data: Mapping[str, Any]) -> bool:
    """Two different quotients are equal; one that is equal to itself says nothing."""
    size = len(data["variables"])
    left, right = ((terms(data[side][0]), terms(data[side][1])) for side in ("left", "right"))
    return left != right and _equal(left, right, data["relation"], Cut((0,) * size, None))


def composed(data: Mapping[str, Any]) -> bool:
    """outer(images) of the left side is that of the right side, which has another outer function or other images."""
    truncation = Cut(tuple(data["weights"]), data["order"])
    if len(truncation.weights) != len(data["variables"]) or not all(
        type(weight_) is int and weight_ >= 0 for weight_ in truncation.weights
    ):
        raise ValueError("weights are whole numbers >= 0, one a variable")
    if truncation.order is not None and (type(truncation.order) is not int or truncation.order < 0):
        raise ValueError("an order is a whole number >= 0, or null")
    if truncation.order is None and any(truncation.weights):
        raise ValueError("weights without an order")
    sides = []
    for side in ("left", "right"):
        images = {index: (terms(pair[0]), terms(pair[1])) for index, pair in data[side]["images"]}
        if len(images) != len(data[side]["images"]) or not all(
            0 <= index < len(truncation.weights) for index in images
        ):
            raise ValueError("a variable with two images, or none of the variables")
        if not all(_invertible(below, data["relation"], truncation) for _, below in images.values()):
            return False
        above, below = (substituted(terms(coefficient), images, *truncation) for coefficient in data[side]["outer"])
        sides.append((times(above[0], below[1]), times(below[0], above[1])))
    return data["left"] != data["right"] and _equal(sides[0], sides[1], data["relation"], truncation)


def _equal(left: tuple[Terms, Terms], right: tuple[Terms, Terms], relation: Any, truncation: Cut) -> bool:
    """multiplier times the difference over the common denominator is cofactor times relation, to the order."""
    difference = truncation.of(plus(times(left[0], right[1]), times(right[0], left[1]), -ONE))
    if not (_invertible(left[1], relation, truncation) and _invertible(right[1], relation, truncation)):
        return False
    if relation is None:
        return not difference
    multiplier, cofactor, zero = (terms(factor) for factor in relation)
    of_a_root = max(key[-1] for key in zero) == 2 and not any(key[-1] for key in multiplier)
    sound = bool(multiplier) and of_a_root and truncation.spared(multiplier, zero)
    return sound and truncation.of(times(multiplier, difference)) == truncation.of(times(cofactor, zero))


def _invertible(below: Terms, relation: Any, kept: Cut) -> bool:
    """Whether a denominator is not 0, to lowest order and at both roots of the relation."""
    lowest = kept.lowest(below)
    return bool(_norm(lowest, terms(relation[2])) if relation is not None else lowest)


def _norm(poly: Terms, relation: Terms) -> Terms:
    """A multiple of the product of the values at both roots of a quadratic in the last variable; {} when one is 0."""
    if not poly:
        return {}
    c0, c1, c2 = (_coefficient(relation, n) for n in range(3))
    parts = [_coefficient(poly, n) for n in range(max([key[-1] for key in poly] + [1]) + 1)]
    while len(parts) > 2:  # c2 poly = (c2 w^2 + c1 w + c0)(top w^n) + a poly of a lower degree
        top = parts.pop()
        parts = [times(c2, conjugate) for conjugate in parts]
        parts[-1], parts[-2] = plus(parts[-1], times(top, c1), -ONE), plus(parts[-2], times(top, c0), -ONE)
    b0, b1 = parts
    return plus(plus(times(c2, times(b0, b0)), times(c1, times(b0, b1)), -ONE), times(c0, times(b1, b1)))


def _coefficient(poly: Terms, power: int) -> Terms:
    return {(*key[:-1], 0): value for key, value in poly.items() if key[-1] == power}


# The checks of motions: a polynomial solves x'' + f(x, x') = a at the wall, as an initial or a boundary value problem.
#
# The equation is data: `acceleration` has the polynomials a_n of a = sum a_n (tau - tau_*)^n, and `force` the f_ik of
# f(c + x, x') - f(c, 0) = sum f_ik x^i x'^k.  The residual is formed here, from these and the motion alone.


def motion(data: Mapping[str, Any]) -> bool:
    """x = height(sigma, v, t) leaves 0 with velocity v and solves the equation at the time sigma + t, to the order.

    With launch = v_c(sigma, t) the motion is back after t: height/t = 0 at v = launch; landing is x' there.
    """
    size, weights, order = _layout(data, (1, None, 1))
    height = terms(data["height"])
    speed = slope(height, 2)
    clock = plus(line(ZERO, 1, 0, size), line(ZERO, 1, 2, size))
    pushed = _pushed(data, height, speed, clock, weights, order)
    residual = cut(plus(slope(speed, 2), pushed, -ONE), weights, None if order is None else order - 1)
    starts = not at(height, 2, ZERO) and at(speed, 2, ZERO) == line(ZERO, 1, 1, size)
    if residual or not starts or data["launch"] is None:
        return not residual and starts and data["landing"] is None
    launch = terms(data["launch"])
    if any(key[1] for key in launch) or any(weight(key, weights) < weights[1] for key in launch):
        return False  # then terms that were cut away could come back to a lower degree
    quotient = {(*key[:2], key[2] - 1, *key[3:]): value for key, value in height.items()}
    images = {1: (launch, {(0,) * size: ONE})}
    back, _ = substituted(quotient, images, weights, order)
    if data["landing"] is None:
        return not back
    landed, _ = substituted(speed, images, weights, order)
    return not back and cut(landed, weights, order) == cut(terms(data["landing"]), weights, order)


def flight(data: Mapping[str, Any]) -> bool:
    """x = t rise(z; sigma, t), z = time/t, is at the wall at z = 0 and z = 1 and solves the equation at sigma + z t.

    launch and landing are its velocities there.
    """
    size, weights, order = _layout(data, (0, 1, 1))
    rise = terms(data["rise"])
    speed, t = slope(rise, 0), line(ZERO, 1, 2, size)
    clock = plus(line(ZERO, 1, 1, size), times(line(ZERO, 1, 0, size), t))
    pushed = times(t, _pushed(data, times(t, rise), speed, clock, weights, order))
    if cut(plus(slope(speed, 0), pushed, -ONE), weights, order):
        return False
    ends = [cut(at(series, 0, end), weights, order) for series in (rise, speed) for end in (ZERO, ONE)]
    stated = [{}, {}, *(cut(terms(data[name]), weights, order) for name in ("launch", "landing"))]
    return ends == stated


def _layout(data: Mapping[str, Any], first: Sequence[int | None]) -> tuple[int, tuple[int, ...], int | None]:
    """(variables, weights, order); the first three variables have weights, the letters of the equation have none."""
    size, weights, order = len(data["variables"]), tuple(data["weights"]), data["order"]
    right = all(
        weight >= 1 if wanted is None else weight == wanted for weight, wanted in zip(weights, first, strict=False)
    )
    if order is None and weights[:3] != (1, 1, 1):
        raise ValueError("weights without an order")
    if len(weights) != size or any(type(weight) is not int for weight in weights) or any(weights[3:]) or not right:
        raise ValueError(f"weights {weights} are not those of a motion")
    if order is not None and (type(order) is not int or order < 1):
        raise ValueError("an order is a whole number >= 1, or null")
    return size, weights, order


def _pushed(
    data: Mapping[str, Any], x: Terms, speed: Terms, clock: Terms, weights: Sequence[int], order: int | None
) -> Terms:
    """a - (f - f(c, 0)) on a motion, at the time `clock` after tau_*, cut; the state may not occur in the jets."""
    acceleration, force = [terms(jet) for jet in data["acceleration"]], data["force"]
    pairs, jets = [tuple(pair) for pair, _ in force], [terms(jet) for _, jet in force]
    if any(any(key[:3]) for jet in (*acceleration, *jets) for key in jet):
        raise ValueError("a jet that depends on the state")
    if len(set(pairs)) < len(pairs) or not all(type(n) is int and n >= 0 for pair in pairs for n in pair):
        raise ValueError("powers of x and x' that are not whole, negative, or occur twice")
    if (0, 0) in pairs:
        raise ValueError("f(c, 0) belongs to the acceleration")
    tops = [max((pair[n] for pair in pairs), default=0) for n in (0, 1)]
    xs, speeds = (powers(base, top, weights, order) for base, top in zip((x, speed), tops, strict=True))
    total: Terms = {}
    for jet, power in zip(acceleration, powers(clock, len(acceleration), weights, order), strict=False):
        total = plus(total, times(jet, power))
    for (i, k), jet in zip(pairs, jets, strict=True):
        total = plus(total, times(jet, short_times(xs[i], speeds[k], weights, order)), -ONE)
    return total


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
