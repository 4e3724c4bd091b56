"""Polynomials in many variables as plain dictionaries, exponents -> Fraction: what proofs are checked with."""

from collections.abc import Iterable, Mapping, Sequence
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
    sums: Terms = {}
    for exponents, value in data:
        key = tuple(exponents)
        if any(type(power) is not int or power < 0 for power in key) or key in sums:
            raise ValueError(f"exponents {key} are negative, not whole, or occur twice")
        if sums and len(key) != len(next(iter(sums))):
            raise ValueError("exponents of several lengths")
        sums[key] = rational(value)
    if not all(sums.values()):
        raise ValueError("a coefficient of 0 is not written")
    return sums


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
    return plus({(0,) * size: constant}, {tuple(int(n == index) for n in range(size)): Fraction(slope)})


def slope(poly: Terms, index: int) -> Terms:
    """The derivative by one variable."""
    return {_moved(key, index, key[index] - 1): value * key[index] for key, value in poly.items() if key[index]}


def at(poly: Terms, index: int, value: Fraction) -> Terms:
    """The polynomial with one variable set to a number; the variable stays, to power 0."""
    total: Terms = {}
    for key, coefficient in poly.items():
        place = _moved(key, index, 0)
        total[place] = total.get(place, Fraction(0)) + coefficient * value ** key[index]
    return {key: coefficient for key, coefficient in total.items() if coefficient}


def _moved(key: tuple[int, ...], index: int, power: int) -> tuple[int, ...]:
    return (*key[:index], power, *key[index + 1 :])


def weight(key: tuple[int, ...], weights: Sequence[int]) -> int:
    """The weighted degree of a monomial."""
    return sum(power * each for power, each in zip(key, weights, strict=True))


def cut(poly: Terms, weights: Sequence[int], order: int | None) -> Terms:
    """The terms of at most this weighted degree; all of them for None."""
    return poly if order is None else {key: value for key, value in poly.items() if weight(key, weights) <= order}


def short_times(left: Terms, right: Terms, weights: Sequence[int], order: int | None) -> Terms:
    """The product, cut; no term is formed that is cut away."""
    if order is None:
        return times(left, right)
    by_degree: dict[int, Terms] = {}
    for key, value in right.items():
        by_degree.setdefault(weight(key, weights), {})[key] = value
    total: Terms = {}
    for one, value in left.items():
        room = order - weight(one, weights)
        for degree, group in by_degree.items():
            if degree <= room:
                for two, other in group.items():
                    key = tuple(map(int.__add__, one, two))
                    total[key] = total.get(key, 0) + value * other
    return {key: value for key, value in total.items() if value}


def substituted(
    poly: Terms, images: Mapping[int, tuple[Terms, Terms]], weights: Sequence[int], order: int | None
) -> tuple[Terms, Terms]:
    """(above, below): the polynomial with variables replaced by quotients, at the same time; above is cut.

    Examples
    --------
    >>> x, y = {(1, 0): Fraction(1)}, {(0, 1): Fraction(1)}
    >>> substituted({(2, 0): Fraction(3)}, {0: (plus(x, y), x)}, (0, 0), None)[1]
    {(2, 0): Fraction(1, 1)}
    """
    size = len(weights)
    top = {index: max((key[index] for key in poly), default=0) for index in images}
    raises = {(i, side_): powers(images[i][side_], top[i], weights, order) for i in images for side_ in (0, 1)}
    above: Terms = {}
    for key, value in poly.items():
        rest = key
        for index in images:
            rest = _moved(rest, index, 0)
        term: Terms = {rest: value}
        for index in images:
            for power in (raises[index, 0][key[index]], raises[index, 1][top[index] - key[index]]):
                term = short_times(term, power, weights, order)
        above = plus(above, term)
    below: Terms = {(0,) * size: Fraction(1)}
    for index in images:
        below = times(below, raised(images[index][1], top[index], size))
    return cut(above, weights, order), below


def powers(base: Terms, count: int, weights: Sequence[int], order: int | None) -> list[Terms]:
    """The powers 0, ..., count of a polynomial, each cut."""
    found: list[Terms] = [{(0,) * len(weights): Fraction(1)}]
    for _ in range(count):
        found.append(short_times(found[-1], base, weights, order))
    return found
