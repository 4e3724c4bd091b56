"""Polynomials in many variables as plain dictionaries, exponents -> Fraction: what proofs are checked with."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

Terms = dict[tuple[int, ...], Fraction]


def terms(data: Iterable[Any]) -> Terms:
    return {tuple(key): Fraction(value) for key, value in data if Fraction(value)}


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
    total: Terms = {(0,) * size: Fraction(1)}
    for _ in range(exponent):
        total = times(total, base)
    return total


def line(constant: Fraction, slope: int, index: int, size: int) -> Terms:
    """constant + slope x_index."""
    unit = tuple(int(n == index) for n in range(size))
    return plus({(0,) * size: constant}, {unit: Fraction(slope)})
