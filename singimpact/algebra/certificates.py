"""Statements about polynomials "for all r in (0, 1)", proved: their certificates are made here.

A certificate is plain data.  It joins the collection that the caller has opened (`gathering.collected`), and counts
once the second program of `certificates`, which shares nothing with this room, has verified it from the data alone.
Certificates of series, substitutions and motions are made in `derivations`.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise, product
from math import lcm, prod
from typing import Any

import sympy

from singimpact.algebra.derivations import terms_of
from singimpact.algebra.gathering import Certificate as Certificate, collected as collected, left_behind

Box = Mapping[Any, tuple[Any, Any]]


@dataclass(frozen=True)
class Effort:
    """Limits of the search for positive expansions.

    Parameters
    ----------
    raised : extra degrees tried; the claims of the paper need 4 at the most. samples : points a side where the sign is looked at first.
    """  # noqa: E501

    raised: tuple[int, ...] = (0, 1, 2, 4, 8, 16, 32)
    samples: tuple[Fraction, ...] = (Fraction(1, 2), Fraction(1, 37), Fraction(1, 7), Fraction(5, 6), Fraction(40, 41))


EFFORT = Effort()


def positive_on(expression: Any, variable: Any, low: Any, high: Any) -> bool:
    """Proved to be positive on the open interval; infinite ends are allowed.

    Parameters
    ----------
    expression : polynomial or rational function of the variable with rational coefficients. low, high : rationals, or infinite.

    Raises
    ------
    ArithmeticError : there is no root inside, yet no certificate was found.

    Examples
    --------
    >>> x = sympy.Symbol("x")
    >>> positive_on(x * (1 - x), x, 0, 1), positive_on(x - sympy.Rational(1, 2), x, 0, 1)
    (True, False)
    """  # noqa: E501
    return positive_in(expression, {variable: (low, high)})


def negative_on(expression: Any, variable: Any, low: Any, high: Any) -> bool:
    """Proved to be negative on the open interval."""
    return positive_on(-expression, variable, low, high)


def negative_in(expression: Any, box: Box) -> bool:
    """Proved to be negative on an open box."""
    return positive_in(-expression, box)


def positive_in(expression: Any, box: Box) -> bool:
    """Proved to be positive on an open box, for all variables at once: see `positive_on`.

    Examples
    --------
    >>> x, y = sympy.symbols("x y")
    >>> positive_in(2 - x - y, {x: (0, 1), y: (0, 1)}), positive_in(1 - x - y, {x: (0, 1), y: (0, 1)})
    (True, False)
    """
    above, below = _quotient(expression)
    poly = sympy.Poly(sympy.expand(above * below), *box, domain="QQ")
    if poly.is_zero or _seen_wrong(poly, box) or (len(box) == 1 and _roots(poly, *next(iter(box.values())))):
        return False
    proof = expansion(poly, list(box.values()))
    if proof is None:
        raise ArithmeticError(f"no certificate was found that {expression} > 0")
    scale = lcm(*(int(sympy.Poly(polynomial, *box).clear_denoms()[0]) for polynomial in (above, below)))
    data = {
        "kind": "positive",
        "variables": [str(name) for name in box],
        "numerator": terms_of(above * scale, list(box)),
        "denominator": terms_of(below * scale, list(box)),
        "sign": 1,
    }
    proof["expansion"] = [[key, str(Fraction(value) * scale**2)] for key, value in proof["expansion"]]
    left_behind(data | proof)
    return True


def expansion(poly: Any, box: Sequence[tuple[Any, Any]]) -> Certificate | None:
    """poly (times powers of 1 + distance to an end) as a positive sum of products of distances to the ends of a box."""
    for more in EFFORT.raised:
        lines = [_line(low, high, degree, more) for (low, high), degree in zip(box, poly.degree_list(), strict=True)]
        total: dict[tuple[int, ...], Fraction] = {}
        for key, value in poly.terms():
            for powers in product(*(line[exponent].items() for line, exponent in zip(lines, key, strict=True))):
                at = tuple(power for power, _ in powers)
                term = prod((factor for _, factor in powers), start=Fraction(int(value.p), int(value.q)))
                total[at] = total.get(at, Fraction(0)) + term
        if all(value >= 0 for value in total.values()):
            return {
                "box": [[str(low), str(high)] for low, high in box],
                "degree": [d + more if _finite(*ends) else 0 for d, ends in zip(poly.degree_list(), box, strict=True)],
                "raised": [0 if _finite(*ends) else more for ends in box],
                "expansion": [[list(key), str(value)] for key, value in sorted(total.items()) if value],
            }
    return None


def _finite(low: Any, high: Any) -> bool:
    return bool(sympy.sympify(low).is_finite and sympy.sympify(high).is_finite)


def _line(low: Any, high: Any, degree: int, more: int) -> list[dict[int, Fraction]]:
    """x^n for n = 0..degree in the basis of an interval: power -> coefficient."""
    t = sympy.Symbol("t")
    if _finite(low, high):
        width = sympy.sympify(high) - low  # x = (low + high t)/(1 + t)
        forms = [
            (low + high * t) ** n * (1 + t) ** (degree + more - n) / width ** (degree + more) for n in range(degree + 1)
        ]
    else:
        line = low + t if sympy.sympify(low).is_finite else high - t
        if not sympy.sympify(line).is_polynomial(t) or line.has(sympy.oo):
            raise ArithmeticError(f"the interval ({low}, {high}) has no finite end")
        forms = [line**n * (1 + t) ** more for n in range(degree + 1)]
    return [
        {int(k): Fraction(int(v.p), int(v.q)) for (k,), v in sympy.Poly(form, t, domain="QQ").terms()} for form in forms
    ]


def _quotient(expression: Any) -> tuple[Any, Any]:
    return sympy.fraction(sympy.cancel(sympy.together(sympy.sympify(expression))))  # type: ignore[no-any-return]


def _seen_wrong(poly: Any, box: Box) -> bool:
    """Whether some sample point of the box has a value that is not positive."""
    sides = [[_inside(part, *ends) for part in EFFORT.samples] for ends in box.values()]
    return any(poly(*point) <= 0 for point in product(*sides))


def _inside(part: Fraction, low: Any, high: Any) -> Any:
    share = sympy.Rational(part.numerator, part.denominator)
    if _finite(low, high):
        return low + (sympy.sympify(high) - low) * share
    return low + share / (1 - share) if sympy.sympify(low).is_finite else high - share / (1 - share)


def _roots(poly: Any, low: Any, high: Any) -> int:
    """The number of distinct real roots in the open interval, counted by sympy."""
    if poly.degree() == 0:
        return 0
    ends = [sympy.sympify(end) for end in (low, high)]
    total = poly.count_roots(*(end if end.is_finite else None for end in ends))
    return int(total) - sum(1 for end in ends if end.is_finite and poly.eval(end) == 0)


def sign_chain(expression: Any, variable: Any, signs: Sequence[tuple[Any, int]], box: Box) -> bool:
    """Proved: at each place of the variable, which may be infinite, the polynomial has the sign stated for all parameters.

    Examples
    --------
    >>> x, r = sympy.symbols("x r")
    >>> sign_chain(x**2 - r, x, ((0, -1), (1, 1)), {r: (0, 1)}), sign_chain(x**2 - r, x, ((0, 1), (1, 1)), {r: (0, 1)})
    (True, False)
    """  # noqa: E501
    poly = sympy.Poly(expression, variable, *box, domain="QQ").primitive()[1]
    if not all(one < two for (one, _), (two, _) in pairwise(signs)):
        return False
    places = []
    for at, sign in signs:
        value = sympy.Poly(_value_or_leading(poly.as_expr(), variable, at) * sign, *box, domain="QQ")
        if value.is_zero or _seen_wrong(value, box):
            return False
        proof = expansion(value, list(box.values()))
        if proof is None:
            raise ArithmeticError(f"no certificate was found for the sign of {expression} at {variable} = {at}")
        places.append({"at": str(at), "sign": sign} | {name: proof[name] for name in ("degree", "raised", "expansion")})
    gaps = [[a["at"], b["at"]] for a, b in pairwise(places) if a["sign"] != b["sign"]]
    left_behind(
        {
            "kind": "chain",
            "variables": [str(variable), *map(str, box)],
            "polynomial": terms_of(poly.as_expr(), [variable, *box]),
            "box": [[str(low), str(high)] for low, high in box.values()],
            "places": places,
            "roots": gaps,
            "all": len(gaps) == poly.degree(variable),
        }
    )
    return True


def _value_or_leading(expression: Any, variable: Any, at: Any) -> Any:
    if at in (sympy.oo, -sympy.oo):
        poly = sympy.Poly(expression, variable)
        return poly.LC() * (-1 if at == -sympy.oo and poly.degree() % 2 else 1)
    return expression.subs(variable, at)


def value_at(expression: Any, variable: Any, point: Any) -> Any:
    """The limit of a rational function at a point: its value after common factors are cancelled, or infinity.

    Examples
    --------
    >>> x = sympy.Symbol("x")
    >>> value_at((x**2 - 1) / (x - 1), x, 1), value_at(1 / x, x, 0), value_at(1 / x, x, sympy.oo)
    (2, zoo, 0)
    """
    above, below = _quotient(expression)
    limit = _limit(above, below, variable, point)
    variables = sorted(expression.free_symbols | {variable}, key=str)
    data = {
        "kind": "value",
        "variables": [str(name) for name in variables],
        "numerator": terms_of(above, variables),
        "denominator": terms_of(below, variables),
        "index": variables.index(variable),
        "at": str(point),
        "value": "infinite" if limit == sympy.zoo else [terms_of(side, variables) for side in _quotient(limit)],
    }
    left_behind(data)
    return limit


def _limit(above: Any, below: Any, variable: Any, point: Any) -> Any:
    """The limit of a quotient without common factors; at infinity by degrees."""
    if point not in (sympy.oo, -sympy.oo):
        under = below.subs(variable, point)
        return sympy.zoo if under == 0 else sympy.cancel(above.subs(variable, point) / under)
    more = sympy.degree(above, variable) - sympy.degree(below, variable)
    if more:
        return sympy.zoo if more > 0 else sympy.Integer(0)
    return sympy.cancel(sympy.Poly(above, variable).LC() / sympy.Poly(below, variable).LC())


def definite(form: Any, x: Any, y: Any) -> int:
    """The sign of a definite quadratic form in x and y off the origin, proved; 0 when it is not definite.

    Examples
    --------
    >>> x, y = sympy.symbols("x y")
    >>> definite(6 * x**2 + 4 * x * y + y**2, x, y), definite(x * y, x, y)
    (1, 0)
    """
    poly = sympy.Poly(form, x, y, domain="QQ")
    if set(map(sum, poly.monoms())) - {2}:
        return 0
    values = [poly.coeff_monomial(square) for square in (x**2, x * y, y**2)]
    sign = int(sympy.sign(values[0]))
    if values[1] ** 2 >= 4 * values[0] * values[2]:
        return 0
    data = {"kind": "definite", "variables": [str(x), str(y)], "form": [str(value) for value in values], "sign": sign}
    left_behind(data)
    return sign


def identical(left: Any, right: Any) -> bool:
    """Record that two rational functions are equal, or two with one square root; the caller has shown that they are.

    Returns
    -------
    bool : whether it is recorded; not where both sides are the same polynomials, which proves nothing, or have another form.
    """  # noqa: E501
    left, right = sympy.sympify(left), sympy.sympify(right)
    root = sorted(
        (p for polynomial in (left, right) for p in polynomial.atoms(sympy.Pow) if p.exp.is_Rational and p.exp.q == 2),
        key=str,
    )[:1]
    w, relation = sympy.Symbol("w"), sympy.Integer(0)
    if root:
        above, below = _quotient(root[0].base)
        relation = below * w**2 - above
        left, right = (
            polynomial.subs({p: w ** (2 * p.exp) for p in polynomial.atoms(sympy.Pow) if p.base == root[0].base})
            for polynomial in (left, right)
        )
    sides = [_quotient(side) for side in (left, right)]
    parts = [relation, *(polynomial for side in sides for polynomial in side)]
    names = sorted({name for polynomial in parts for name in polynomial.free_symbols} - {w}, key=str)
    if not all(polynomial.is_polynomial(*names, w) for side in sides for polynomial in side):
        return False
    if [sympy.expand(polynomial) for polynomial in sides[0]] == [sympy.expand(polynomial) for polynomial in sides[1]]:
        return False
    variables = [*names, w]
    left_behind(
        {
            "kind": "identity",
            "variables": [str(name) for name in variables],
            "left": [terms_of(polynomial, variables) for polynomial in sides[0]],
            "right": [terms_of(polynomial, variables) for polynomial in sides[1]],
            "relation": [terms_of(polynomial, variables) for polynomial in _related(sides, relation, w)]
            if root
            else None,
        }
    )
    return True


def _related(sides: list[Any], relation: Any, w: Any) -> tuple[Any, Any, Any]:
    """(multiplier, cofactor, relation), multiplier (left - right) = cofactor relation over the common denominator."""
    (above, below), (other, under) = sides
    difference = sympy.Poly(sympy.expand(above * under - other * below), w)
    if difference.degree() < 2:
        return sympy.Integer(1), sympy.Integer(0), relation
    cofactor, _ = sympy.pdiv(difference, sympy.Poly(relation, w))
    return sympy.Poly(relation, w).LC() ** (difference.degree() - 1), cofactor.as_expr(), relation
