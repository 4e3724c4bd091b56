"""Certified enclosures: the ring of real balls (python-flint's arb) at a fixed number of bits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.expressions import Expression, Root, evaluate
from singimpact.algebra.precision import balls_at

BITS_A_DIGIT = 3.3219281  # log2 10, rounded up


@dataclass(frozen=True)
class Balls:
    """Real balls; every operation rounds outwards, so what is returned contains the true value.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> Balls(128).evaluate(parse("sin(pi/6)"), {}).overlaps(Balls(128).rational(Fraction(1, 2)))
    True
    """

    bits: int

    def element(self, value: Any) -> Any:
        """A ball, or a rational of Python."""
        import flint

        if isinstance(value, flint.arb):
            return value
        if isinstance(value, int | Fraction) and not isinstance(value, bool):
            return self.rational(Fraction(value))
        raise TypeError(f"{value!r} is not a ball")

    def evaluate(self, tree: Expression, values: Mapping[str, Any]) -> Any:
        """The ball of a tree; `values` are balls."""
        with balls_at(self.bits):
            return evaluate(tree, values, self)

    def rational(self, value: Fraction) -> Any:
        import flint

        with balls_at(self.bits):
            return flint.arb(flint.fmpq(value.numerator, value.denominator))

    def interval(self, low: Fraction, high: Fraction) -> Any:
        """The smallest ball around [low, high] at this precision."""
        with balls_at(self.bits):
            return self.rational(low).union(self.rational(high))

    def pi(self) -> Any:
        import flint

        with balls_at(self.bits):
            return flint.arb.pi()

    def power(self, base: Any, exponent: Fraction) -> Any:
        if exponent.denominator == 1:
            return base ** int(exponent)
        return base ** self.rational(exponent)

    def call(self, function: str, argument: Any) -> Any:
        return abs(argument) if function == "abs" else getattr(argument, function)()

    def root(self, tree: Root) -> Any:
        from singimpact.algebra.zeros import ball_of

        return ball_of(tree, self.bits)


def as_rational(ball: Any) -> Fraction:
    """The midpoint of a ball, exactly."""
    mantissa, exponent = ball.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
