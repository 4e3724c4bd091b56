"""Certified digits: a computation in balls is done again with more bits until each result has its digits."""

from __future__ import annotations  # flint and sympy are loaded when they are used

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from math import ceil
from typing import Any

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.certified import Certified, as_certified
from singimpact.algebra.precision import Ladder, digits_at, for_user
from singimpact.algebra.univariate import precision_of
from singimpact.handed_on import flint, sympy
from singimpact.inputs import InputError, refuse

MOST_DIGITS = 2000  # that are given
MOST_BITS = 1 << 16  # that are worked with, reached when a result cancels


def with_digits(
    compute: Callable[[Balls], Any],
    digits: int,
    show: Callable[[Any, int], Any],
    balls_in: Callable[[Any], Iterable[Any]] = lambda enclosure: enclosure.values(),
) -> Any:
    """The numbers of `compute(ring)` in balls, at growing precision until each number has its digits.

    Parameters
    ----------
    show : makes the result of what was computed and the digits. balls_in : its numbers.
    """
    if isinstance(digits, bool) or not isinstance(digits, int) or not 1 <= digits <= MOST_DIGITS:
        raise refuse("digits", digits, f"an integer from 1 to {MOST_DIGITS}")
    for bits in Ladder(ceil(digits * 3.33) + 128, MOST_BITS):
        with precision_of(Balls(bits)):
            enclosure = compute(Balls(bits))
        if all(as_certified(ball, digits) is not None for ball in balls_in(enclosure)):
            return show(enclosure, digits)
    raise InputError(f"{digits} digits are not reached with {MOST_BITS} bits: ask for fewer, or a lower order")


def all_certified(found: Mapping[int, flint.arb], digits: int) -> dict[int, Certified | None]:
    """Every ball of a series as a value with a radius."""
    return {n: as_certified(ball, digits) for n, ball in found.items()}


def all_digits(found: Mapping[int, flint.arb], digits: int) -> dict[int, Any]:
    """Every ball of a series as an mpmath number."""
    return {n: as_digits(ball, digits) for n, ball in found.items()}


def as_digits(ball: flint.arb, digits: int) -> Any:
    """A ball as an mpmath number with this many digits; zero when it holds zero, for then it is far below them."""
    with digits_at(digits + 3) as mp:
        value = Fraction(0) if ball.contains(0) else as_rational(ball)
        return for_user(mp.mpf(value.numerator) / value.denominator)


def sympy_digits(ball: flint.arb, digits: int) -> Any:
    """A ball as a sympy Float with this many digits."""
    return sympy.Float(as_digits(ball, digits), digits)
