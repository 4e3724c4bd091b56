"""Polynomials in many variables as plain dictionaries, exponents -> Fraction: what proofs are checked with."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

Terms = dict[tuple[int, ...], Fraction]


def rational(value: Any) -> Fraction:
    """A number as certificates write it: a whole number, or text of a fraction."""
    if isinstance(value, bool) or not isinstance(value, int | str):
        raise TypeError(f"{value!r} is not a whole number or the text of a fraction")
    return Fraction(value)


def terms(data: Iterable[Any]) -> Terms:
    """A polynomial from [exponents, coefficient] pairs: coefficients not 0; exponents whole, not negative, each once.

    Examples
    --------
    >>> terms([[[1, 0], 2], [[0, 0], "1/2"]])
    {(1, 0): Fraction(2, 1), (0, 0): Fraction(1, 2)}
    """
    found: Terms = {}
    for exponents, value in data:
        key = tuple(exponents)
        if any(type(power) is not int or power < 0 for power in key) or key in found:
            raise ValueError(f"exponents {key} are negative, not whole, or occur twice")
        if found and len(key) != len(next(iter(found))):
            raise ValueError("exponents of several lengths")
        found[key] = rational(value)
    if not all(found.values()):
        raise ValueError("a coefficient of 0 is not written")
    return found


def row(data: Iterable[Any]) -> Terms:
    """A polynomial in one variable from its coefficients, the constant one first."""
    return {(n,): rational(value) for n, value in enumerate(data) if rational(value)}


def plus(left: Terms, right: Terms, factor: Fraction = Fraction(1)) -> Terms:
    keys = left.keys() | right.keys()
    total = {key: left.get(key, Fraction(0)) + factor * right.get(key, Fraction(0)) for key in keys}
    return {key: value for key, value in total.items() if value}


def times(left: Terms, right: Terms) -> Terms:
    total: Terms = {}
    for one, value in left.items():
        for two, other in right.items():
            key = tuple(a + b for a, b in zip(one, two, strict=True))
            total[key] = total.get(key, Fraction(0)) + value * other
    return {key: value for key, value in total.items() if value}


def raised(base: Terms, exponent: int, size: int) -> Terms:
    if exponent < 0:
        raise ValueError("a negative power is no polynomial")
    total: Terms = {(0,) * size: Fraction(1)}
    for _ in range(exponent):
        total = times(total, base)
    return total


def line(constant: Fraction, slope: int, index: int, size: int) -> Terms:
    """constant + slope x_index."""
    unit = tuple(int(n == index) for n in range(size))
    return plus({(0,) * size: constant}, {unit: Fraction(slope)})
