"""Certificates of derivations: what was substituted into what, and the motion that a series is.

They join the open collection.  Each function does nothing while none is open, and decides nothing: what was derived
wrongly leaves a certificate that the second program refuses.
"""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from types import MappingProxyType
from typing import Any, NamedTuple

import sympy

from singimpact.algebra.gathering import gathering, left_behind

Images = Mapping[Any, Any]


class At(NamedTuple):
    """A function and what is put for its variables, at the same time."""

    outer: Any
    images: Images = MappingProxyType({})


def substitution(
    left: At, right: At | Any, *, order: int | None = None, small: Sequence[Any] = (), where: Any = None
) -> None:
    """Leave the certificate that left.outer at left.images is the right side, which was found in another way.

    Parameters
    ----------
    left, right : rational functions of symbols with the images of some of them; the right side may have none.
    order, small : up to a total degree in these variables; exactly without.
    where : a polynomial of degree 2 in its last variable, given as (polynomial, variable): the identity holds at its roots.

    Examples
    --------
    >>> from singimpact.algebra.gathering import collected
    >>> x, e = sympy.symbols("x e")
    >>> with collected() as found:
    ...     substitution(At(x**2, {x: 1 + e}), 1 + 2 * e, order=1, small=[e])
    >>> [found[0][name] for name in ("kind", "variables", "weights", "order")]
    ['composed', ['e', 'x'], [1, 0], 1]
    """  # noqa: E501
    if not gathering():
        return
    sides = [_used(side if isinstance(side, At) else At(side)) for side in (left, right)]
    relation, last = where if where is not None else (None, None)
    parts = [relation or sympy.Integer(0), *small]
    parts += [expression for side in sides for expression in (side.outer, *side.images, *side.images.values())]
    names = sorted({name for expression in parts for name in sympy.sympify(expression).free_symbols} - {last}, key=str)
    variables = [*names, *([last] if last is not None else [])]
    left_behind(
        {
            "kind": "composed",
            "variables": [str(name) for name in variables],
            "weights": [int(name in small) for name in variables],
            "order": order,
            "left": _side(sides[0], variables),
            "right": _side(sides[1], variables),
            "relation": None if relation is None else _related(sides, relation, last, order, small, variables),
        }
    )


def _used(side: At) -> At:
    """A composition with the images of those variables that occur in its outer function."""
    occurring = sympy.sympify(side.outer).free_symbols
    return At(side.outer, {name: image for name, image in side.images.items() if name in occurring})


def _side(side: At, variables: Sequence[Any]) -> dict[str, Any]:
    images = [[variables.index(name), _pair(image, variables)] for name, image in side.images.items()]
    return {"outer": _pair(side.outer, variables), "images": sorted(images, key=lambda pair: pair[0])}


def _pair(expression: Any, variables: Sequence[Any]) -> list[Any]:
    return [terms_of(part, variables) for part in _split(expression)]


def _split(expression: Any) -> tuple[Any, Any]:
    """Numerator and denominator; a polynomial keeps the denominator 1."""
    expression = sympy.sympify(expression)
    if expression.is_polynomial(*expression.free_symbols):
        return expression, sympy.Integer(1)
    return sympy.fraction(sympy.cancel(sympy.together(expression)))  # type: ignore[no-any-return]


def terms_of(expression: Any, variables: Sequence[Any]) -> list[Any]:
    """A polynomial with rational coefficients as [exponents, coefficient] pairs."""
    terms = sympy.Poly(expression, *variables, domain="QQ").terms()
    return [[list(key), int(value) if value.q == 1 else str(value)] for key, value in terms if value]


def _related(
    sides: Sequence[At], relation: Any, last: Any, order: int | None, small: Sequence[Any], variables: Sequence[Any]
) -> list[Any]:
    """[multiplier, cofactor, relation]: multiplier times the difference is cofactor times relation, to the order."""
    (above, below), (other, under) = (_fraction(side) for side in sides)
    difference = sympy.Poly(sympy.expand(above * under - other * below), last)
    if order is not None:
        short = sympy.Poly(difference.as_expr(), *small)
        truncated = {key: value for key, value in short.terms() if sum(key) <= order}
        difference = sympy.Poly(sympy.Poly.from_dict(truncated or {(0,) * len(small): 0}, *small).as_expr(), last)
    zero = sympy.Poly(relation, last)
    if difference.degree() < 2:
        multiplier, cofactor = sympy.Integer(1), sympy.Integer(0)
    else:
        multiplier, cofactor = zero.LC() ** (difference.degree() - 1), sympy.pdiv(difference, zero)[0].as_expr()
    return [terms_of(polynomial, variables) for polynomial in (multiplier, cofactor, relation)]


def _fraction(side: At) -> tuple[Any, Any]:
    """Numerator and denominator of a composition as the checker forms them, without cancelling."""
    pairs = {name: _split(image) for name, image in side.images.items()}
    sides = []
    for side_ in _split(side.outer):
        poly = sympy.Poly(side_, *pairs) if pairs else None
        tops = dict(zip(pairs, poly.degree_list(), strict=True)) if poly is not None else {}
        below = sympy.Mul(*(pairs[name][1] ** tops[name] for name in pairs))
        above = side_.subs({name: pair[0] / pair[1] for name, pair in pairs.items()}, simultaneous=True) * below
        sides.append((sympy.expand(sympy.cancel(above)), sympy.expand(below)))
    (one, two), (three, four) = sides
    return sympy.expand(one * four), sympy.expand(three * two)


def motion(
    variables: Sequence[Any],
    height: Any,
    acceleration: Sequence[Any],
    force: Mapping[tuple[int, int], Any],
    *,
    order: int | None = None,
    launch: Any = None,
    landing: Any = None,
) -> None:
    """Leave the certificate that x = height(sigma, v, t) solves x'' + f = a from x = 0, x' = v.

    Parameters
    ----------
    variables : (sigma, v, t). height : polynomial in these and the letters of the jets.
    acceleration : n -> coefficient of (tau - tau_*)^n. force : (i, k) -> coefficient of x^i x'^k.
    order : of height/t, a total degree in (sigma, v, t); None for an exact solution.
    launch : v_c(sigma, t), for which height/t = 0. landing : x' then.
    """
    if not gathering():
        return
    parts = [height, *acceleration, *force.values(), *(series for series in (launch, landing) if series is not None)]
    names = {name for series in parts for name in sympy.sympify(series).free_symbols} - set(variables)
    every = [*variables, *sorted(names, key=str)]
    left_behind(
        {
            "kind": "motion",
            "variables": [str(name) for name in every],
            "weights": [1, 1, 1, *[0] * len(names)],
            "order": order,
            "height": terms_of(height, every),
            # a = sum a_n (tau - tau_*)^n, f - f(c, 0) = sum f_ik x^i x'^k
            "acceleration": [terms_of(jet, every) for jet in acceleration],
            "force": [[list(pair), terms_of(jet, every)] for pair, jet in sorted(force.items())],
            "launch": None if launch is None else terms_of(launch, every),
            "landing": None if landing is None else terms_of(landing, every),
        }
    )


def flight(contact: Any, order: int, rise: Mapping[Any, Any], launch: Any, landing: Any) -> None:
    """Leave the certificate that x = t rise(z; sigma, t) is at the wall at z = 0 and z = 1 and solves the equation.

    Parameters
    ----------
    contact : with the jets a, f and the ring of exact coefficients, rationals or with symbols. order : of the velocities.
    rise, launch, landing : exponents of (z, sigma, t), or (sigma, t) -> coefficient.
    """  # noqa: E501
    names = tuple(getattr(contact.ring, "names", ()))

    def data_of(terms: Mapping[tuple[int, ...], Any]) -> list[Any]:
        return [
            [[*(0,) * (3 - len(key)), *key, *tail], str(part)]
            for key, value in terms.items()
            for tail, part in _scalars(value, len(names))
        ]

    left_behind(
        {
            "kind": "flight",
            "variables": ["z", "sigma", "t", *names],
            "weights": [0, 1, 1, *[0] * len(names)],
            "order": order,
            "rise": data_of(rise),
            "acceleration": [
                data_of({(0, 0, 0): contact.a[n]}) if n in contact.a else []
                for n in range(max(contact.a, default=0) + 1)
            ],
            "force": [[list(pair), data_of({(0, 0, 0): value})] for pair, value in sorted(contact.f.items())],
            "launch": data_of(launch),
            "landing": data_of(landing),
        }
    )


def _scalars(value: Any, size: int) -> Iterable[tuple[tuple[int, ...], Fraction]]:
    """An element of a ring of symbols by its terms; a rational by itself."""
    if not hasattr(value, "to_dict"):
        return [((0,) * size, value)] if value else []
    return [(tuple(map(int, key)), Fraction(int(c.p), int(c.q))) for key, c in value.to_dict().items()]
