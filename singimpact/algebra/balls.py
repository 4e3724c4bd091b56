"""Certified enclosures: the ring of real balls (python-flint's arb), and simple zeros of functions refined in it."""

from __future__ import annotations  # flint and sympy are loaded when they are used

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from typing import Any

from singimpact.algebra.expressions import BOUND, Expression, Root, evaluate
from singimpact.algebra.precision import Ladder, balls_at
from singimpact.algebra.solving import newton_in_balls
from singimpact.handed_on import flint

BITS_A_DIGIT = 3.3219281  # log2 10, rounded up
BITS = 128  # of the balls that isolate zeros; far more than the least width of a piece needs
END_BITS = 53  # of the ends of a piece between two precisions: Newton's steps find again what they lose


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

    def element(self, value: Any) -> flint.arb:
        """A ball, or a rational of Python."""
        if isinstance(value, flint.arb):
            return value
        if isinstance(value, int | Fraction) and not isinstance(value, bool):
            return self.rational(Fraction(value))
        raise TypeError(f"{value!r} is not a ball")

    def evaluate(self, tree: Expression, values: Mapping[str, flint.arb]) -> Any:
        """The ball of a tree; `values` are balls."""
        with balls_at(self.bits):
            return evaluate(tree, values, self)

    def rational(self, value: Fraction) -> flint.arb:
        with balls_at(self.bits):
            return flint.arb(flint.fmpq(value.numerator, value.denominator))

    def interval(self, low: Fraction, high: Fraction) -> flint.arb:
        """The smallest ball around [low, high] at this precision."""
        with balls_at(self.bits):
            return self.rational(low).union(self.rational(high))

    def unknown(self) -> flint.arb:
        """The ball of all numbers."""
        return flint.arb("nan")

    def pi(self) -> flint.arb:
        with balls_at(self.bits):
            return flint.arb.pi()

    def power(self, base: flint.arb, exponent: Fraction) -> flint.arb:
        return base ** (int(exponent) if exponent.denominator == 1 else self.rational(exponent))

    def call(self, function: str, argument: flint.arb) -> flint.arb:
        return abs(argument) if function == "abs" else getattr(argument, function)()

    def root(self, tree: Root) -> flint.arb:
        return ball_of(tree, self.bits)


def as_rational(ball: flint.arb) -> Fraction:
    """The midpoint of a ball, exactly."""
    mantissa, exponent = ball.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


@dataclass(frozen=True)
class Zero:
    """A piece of the axis with one zero, or with none or more when undecided.

    Attributes
    ----------
    low, high : ends of the piece, exact. slope : sign of the derivative on it; 0 when undecided.
    """

    low: Fraction
    high: Fraction
    slope: int


def derivatives(tree: Expression, variable: str, at: Any, order: int, ring: Any) -> list[Any]:
    """Taylor coefficients of a tree at `at`, an element of the ring."""
    from singimpact.algebra.jets import JetSpace

    space = JetSpace((variable,), order, ring)
    jet = space.evaluate(tree, {variable: space.constant(at) + (space.generators()[0] if order else space.jet({}))})
    return [jet.coefficient((k,)) for k in range(order + 1)]


def sign_at(tree: Expression, variable: str, at: Fraction, order: int) -> int:
    """The sign of a derivative at an exact point; 0 when 2048 bits do not tell it from zero."""
    for bits in (128, 512, 2048):
        balls = Balls(bits)
        with balls_at(bits):
            value = derivatives(tree, variable, balls.rational(at), order, balls)[order]
            if value > 0 or value < 0:
                return 1 if value > 0 else -1
    return 0


def _coefficient(taylor: Callable[..., list[Any]], order: int, times: int, at: Any) -> Any:
    return taylor(at=at, order=order)[order] * times


def refined(tree: Expression, variable: str, zero: Zero, bits: int, order: int = 0) -> flint.arb:
    """A ball of about this many bits around the simple zero in a piece, by interval Newton steps."""
    low, high, first = _monotone(tree, variable, zero, order)
    most = max(bits + 64, first)
    for work in Ladder(first, most, lambda before: min(2 * before, most)):
        balls = Balls(work)
        with balls_at(work):
            taylor = partial(derivatives, tree, variable, ring=balls)
            enclosure = newton_in_balls(
                partial(_coefficient, taylor, order, 1),
                partial(_coefficient, taylor, order + 1, order + 1),
                balls.interval(low, high),
            )
        if work < most:
            low, high = _ends(enclosure)
    return enclosure


@lru_cache(maxsize=256)
def ball_of(tree: Root, bits: int) -> flint.arb:
    """A ball of about this many bits around the number that a root is.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> print(ball_of(parse("root(u**2 - 2, 1, 2)"), 100).str(20, radius=False))
    1.4142135623730950488
    """
    zero = Zero(tree.low, tree.high, sign_at(tree.function, BOUND, tree.high, 0))
    return refined(tree.function, BOUND, zero, bits)


def _monotone(tree: Expression, variable: str, zero: Zero, order: int) -> tuple[Fraction, Fraction, int]:
    """The piece halved by signs until the derivative keeps one sign on it, and the bits that show it.

    Next to a second zero the derivative is as small as the piece, so that every halving asks for bits of its own.
    """
    low, high, bits = zero.low, zero.high, BITS
    while True:
        balls = Balls(bits)
        with balls_at(bits):
            slope = derivatives(tree, variable, balls.interval(low, high), order + 1, balls)[order + 1]
        if slope > 0 or slope < 0:
            return low, high, bits
        bits += 2
        middle = (low + high) / 2
        beyond = sign_at(tree, variable, middle, order) * zero.slope > 0
        low, high = (low, middle) if beyond else (middle, high)


def _ends(ball: flint.arb) -> tuple[Fraction, Fraction]:
    with balls_at(END_BITS):
        low, high = ball.lower(), ball.upper()
    return as_rational(low), as_rational(high)
