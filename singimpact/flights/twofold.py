"""Numbers of many models at once as sums of two doubles, about 32 digits: a ring of arrays for trees of constants."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import Expression, Pi, Root, evaluate, names_in
from singimpact.algebra.numbers import as_float, rational_near
from singimpact.flights.kernels.double_double import product_twice, sum_twice


@dataclass(frozen=True)
class Twofold:
    """high + low, numbers or arrays; low is below the last bit of high.

    Examples
    --------
    >>> third = TWOFOLDS.power(Twofold.of(3.0), Fraction(-1))
    >>> (third * Twofold.of(3.0) + Twofold.of(-1.0)).high < 1e-31
    True
    """

    high: Any
    low: Any

    @staticmethod
    def of(value: Any) -> Twofold:
        """Doubles as they are."""
        return Twofold(value, 0.0 * value)

    @staticmethod
    def near(value: Fraction) -> Twofold:
        """The nearest one to a rational."""
        return Twofold(float(value), float(value - Fraction(float(value))))

    def __add__(self, other: Twofold) -> Twofold:
        return Twofold(*sum_twice(self.high, self.low, other.high, other.low))

    def __mul__(self, other: Twofold) -> Twofold:
        return Twofold(*product_twice(self.high, self.low, other.high, other.low))

    def inverse(self) -> Twofold:
        """1/self, by one step of Newton's method."""
        first = Twofold.of(1.0 / self.high)
        left = Twofold.of(1.0) + self * Twofold.of(-first.high)
        return first + left * first


class Twofolds:
    """The ring; sums, products and whole powers of arrays, all other functions element by element."""

    def rational(self, value: Fraction) -> Twofold:
        return Twofold.near(value)

    def pi(self) -> Twofold:
        return Twofold.near(rational_near(Pi(), 256))

    def root(self, tree: Root) -> Twofold:
        return Twofold.near(rational_near(tree, 256))

    def power(self, base: Twofold, exponent: Fraction) -> Twofold:
        if exponent.denominator != 1:
            return _each(base, lambda balls, ball: balls.power(ball, exponent))
        found = Twofold.of(1.0)
        for _ in range(abs(int(exponent))):
            found = found * base
        return found if exponent > 0 else found.inverse()

    def call(self, function: str, argument: Twofold) -> Twofold:
        return _each(argument, lambda balls, ball: balls.call(function, ball))


TWOFOLDS = Twofolds()


def _each(argument: Twofold, work: Callable[[Balls, Any], Any]) -> Twofold:
    """A function of every element, in balls of 192 bits."""
    balls, highs = Balls(192), np.asarray(argument.high)
    parts = []
    for high, low in zip(
        highs.ravel().tolist(), np.broadcast_to(argument.low, highs.shape).ravel().tolist(), strict=True
    ):
        ball = work(balls, balls.rational(Fraction(high) + Fraction(low)))
        near = Twofold.near(as_rational(ball)) if ball.is_finite() else Twofold(np.nan, np.nan)
        parts.append((near.high, near.low))
    result = np.array(parts).reshape(*highs.shape, 2)
    return Twofold(result[..., 0][()], result[..., 1][()])


def value_of(tree: Expression, numbers: Mapping[str, Twofold]) -> Twofold:
    """A tree of constants and letters; without letters the doubles nearest to it, inf or nan where there is none."""
    if not names_in(tree):
        high = as_float(tree)
        low = float(rational_near(tree, 256) - Fraction(high)) if np.isfinite(high) else 0.0
        return Twofold(np.float64(high), np.float64(low))
    with np.errstate(all="ignore"):  # what is no number is refused by who reads it
        return evaluate(tree, numbers, TWOFOLDS)  # type: ignore[no-any-return]
