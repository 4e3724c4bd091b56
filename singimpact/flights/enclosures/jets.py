"""Jets of order 2: a number with its Taylor coefficients by the launch time, the launch velocity and a number p.

    c_0 + sum c_i eps_i + sum c_ij eps_i eps_j,     products of three eps are 0.

With |c| the sum of the sizes of the coefficients |a b| <= |a| |b|: jets are a Banach algebra. An analytic function is
defined on them by its Taylor series, which ends. Coefficients are balls, complex balls or series of balls.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from math import factorial
from typing import Any

from singimpact.flights.enclosures.tube import upper

Jet = list[Any]
FIRST = ((0,), (1,), (2,))
"""Monomials of degree 1: tau, v, p."""
SECOND = tuple((i, j) for i in range(3) for j in range(i, 3))
MONOMIALS: tuple[tuple[int, ...], ...] = ((), *FIRST, *SECOND)
PLACES = {monomial: place for place, monomial in enumerate(MONOMIALS)}
PRODUCTS = tuple(
    (i, j, PLACES[tuple(sorted(a + b))])
    for i, a in enumerate(MONOMIALS)
    for j, b in enumerate(MONOMIALS)
    if len(a + b) <= 2
)
"""Which coefficients of two factors are multiplied, and the coefficient to which the product belongs."""
Partials = Mapping[tuple[int, ...], Any]
"""Values of the partial derivatives of a function by its arguments, by the orders of each."""


@cache
def orders(arguments: int, most: int) -> tuple[tuple[int, ...], ...]:
    """The orders of the partial derivatives of at most a total order.

    Examples
    --------
    >>> orders(2, 1)
    ((0, 0), (0, 1), (1, 0))
    """
    if not arguments:
        return ((),)
    return tuple((k, *rest) for k in range(most + 1) for rest in orders(arguments - 1, most - k))


def jet(values: Mapping[int, Any], zero: Any) -> Jet:
    """The jet with coefficients at some places, and 0 elsewhere."""
    return [values.get(place, zero) for place in range(len(MONOMIALS))]


def product(one: Sequence[Any], other: Sequence[Any]) -> Jet:
    """The product of two jets."""
    found: list[Any] = [0] * len(MONOMIALS)
    for i, j, place in PRODUCTS:
        if _counts(one[i]) and _counts(other[j]):
            found[place] = found[place] + one[i] * other[j]
    return found


def _counts(part: Any) -> bool:
    return not (isinstance(part, int) and part == 0)


def scaled(one: Sequence[Any], factor: Any) -> Jet:
    """A jet times a number."""
    return [part * factor for part in one]


def total(*jets: Sequence[Any]) -> Jet:
    """The sum of jets."""
    return [sum(parts[1:], parts[0]) for parts in zip(*jets, strict=True)]


def composed(partials: Partials, small: Sequence[Sequence[Any]], at: tuple[int, ...] | None = None) -> Jet:
    """A function of jets, by its partial derivatives at their values.

    Parameters
    ----------
    partials : up to order 2, or 2 beyond `at`. small : each argument less its value. at : the derivative of the
        function by its arguments whose jet is wanted; the function itself where it is left out.
    """
    base = at or (0,) * len(small)
    zero = partials[base] * 0
    image = jet({0: partials[base]}, zero)
    for powers in orders(len(small), 2):
        if any(powers):
            term: Jet = jet({0: partials[tuple(a + b for a, b in zip(base, powers, strict=True))]}, 0)
            for n, count in enumerate(powers):
                for _ in range(count):
                    term = product(term, small[n])
                term = [
                    coefficient / factorial(count) if count > 1 and _counts(coefficient) else coefficient
                    for coefficient in term
                ]
            image = total(image, term)
    return image


def norm(one: Sequence[Any]) -> Any:
    """An upper bound of the sum of the sizes of the coefficients."""
    return upper(sum((upper(part) for part in one[1:]), upper(one[0])))


def quotient(one: Sequence[Any], other: Sequence[Any]) -> Jet:
    """The quotient of two jets."""
    small = [0, *(part / other[0] for part in other[1:])]
    inverse = total(
        jet({0: 1 / other[0]}, other[0] * 0), scaled(small, -1 / other[0]), scaled(product(small, small), 1 / other[0])
    )
    return product(one, inverse)
