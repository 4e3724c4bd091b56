"""A number that is sought: by halving, by the secant method, by Newton's method in balls."""

from __future__ import annotations  # flint and sympy are loaded when they are used

from collections.abc import Callable
from fractions import Fraction
from typing import Any, TypeVar

from singimpact.handed_on import flint

T = TypeVar("T", float, Fraction)

ROUNDS = 200  # of Newton's method in balls: each doubles the bits, or halves the ball where it is wide


def halved(is_low: Callable[[T], bool], low: T, high: T, narrow: float = 0) -> tuple[T, T]:
    """Neighbours around the place where `is_low` ends: between doubles none, or narrow * |high| at most.

    Parameters
    ----------
    is_low : whether a number lies on the side of `low`. low, high : doubles or rationals; rationals need `narrow` > 0.

    Examples
    --------
    >>> low, high = halved(lambda x: x * x < 2, 1.0, 2.0)
    >>> low * low < 2 <= high * high, high - low < 3e-16
    (True, True)
    """
    while abs(high - low) > narrow * abs(high):
        middle = (low + high) / 2
        if middle in (low, high):
            break
        low, high = (middle, high) if is_low(middle) else (low, middle)
    return low, high


def secant(miss: Callable[[Any], Any], first: Any, second: Any, rounds: int = 12, small: Any = 0) -> Any:
    """A zero next to two numbers, of any kind; the rounds end where a value comes again or is at most `small`.

    Examples
    --------
    >>> secant(lambda x: x * x - 2, 1.0, 1.5)
    1.414213562373095
    """
    value, other = miss(first), miss(second)
    for _ in range(rounds):
        if other == value or abs(other) <= small:
            break
        first, second = second, second - other * (second - first) / (other - value)
        value, other = other, miss(second)
    return second


def newton_in_balls(
    function: Callable[[flint.arb], flint.arb], slope: Callable[[flint.arb], flint.arb], root: flint.arb
) -> flint.arb:
    """The ball of a zero made narrow: what encloses one zero, where the slope keeps its sign, goes on to enclose it.

    Parameters
    ----------
    function, slope : of balls. root : a ball around the zero.

    Examples
    --------
    >>> import flint
    >>> wide = flint.arb("1.5", "0.2")
    >>> newton_in_balls(lambda x: x * x - 2, lambda x: 2 * x, wide)
    [1.41421356237310 +/- 5.08e-15]
    """
    for _ in range(ROUNDS):
        middle = root.mid()
        closer = (middle - function(middle) / slope(root)).intersection(root)
        if not closer.is_finite():  # the slope may be 0 in a ball so wide
            return root
        if not closer.rad() * 10 < root.rad() * 9:
            return closer
        root = closer
    return root
