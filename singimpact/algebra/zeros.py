"""All real zeros of a function of one variable in a window: isolated by balls, so none is missed.

A piece of the window is dropped when the ball of the function over it leaves out 0, and settled when the ball of the
derivative does: then there is at most one zero, and the signs at the two ends decide.  A piece that is neither, down to
the least width, is kept as `undecided` (a double zero looks like this).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import BOUND, Expression, Root
from singimpact.algebra.jets import JetSpace
from singimpact.algebra.precision import balls_at
from singimpact.inputs import InputError, shown

BITS = 128  # of the balls that isolate; far more than the least width needs
END_BITS = 53  # of the ends of a piece between two precisions: Newton's steps find again what they lose
LEAST_WIDTH = Fraction(1, 2**26)  # of the window: below it a double zero is suspected and handed on as undecided


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
    space = JetSpace((variable,), order, ring)
    step = space.generators()[0] if order else space.jet({})
    jet = space.evaluate(tree, {variable: space.constant(at) + step})
    return [jet.coefficient((k,)) for k in range(order + 1)]


def isolate(
    tree: Expression, variable: str, low: Fraction, high: Fraction, order: int = 0, pieces: int | None = None
) -> list[Zero]:
    """All zeros in [low, high) of the derivative of this order of a tree in one variable.

    Raises
    ------
    InputError : more than `pieces` pieces were looked at, when a number of them is given.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> [zero.slope for zero in isolate(parse("cos(t)", ["t"]), "t", Fraction(-1), Fraction(6))]
    [-1, 1]
    """
    balls = Balls(BITS)
    least = (high - low) * LEAST_WIDTH
    found: list[Zero] = []
    with balls_at(BITS):
        stack = [(low, high)]
        while stack:
            left, right = stack.pop()
            if pieces is not None:
                pieces -= 1
                if pieces < 0:
                    raise InputError(f"the zeros of {shown(str(tree))} cost too much to tell apart: give closer ends")
            window = balls.interval(left, right)
            value, slope = derivatives(tree, variable, window, order + 1, balls)[order : order + 2]
            if value > 0 or value < 0:
                continue
            if slope > 0 or slope < 0:
                rising = 1 if slope > 0 else -1
                if sign_at(tree, variable, left, order) * rising <= 0 < sign_at(tree, variable, right, order) * rising:
                    found.append(Zero(left, right, rising))
                continue
            if right - left < least:
                found.append(Zero(left, right, 0))
                continue
            middle = left + (right - left) * Fraction(127, 256)  # off the middle: symmetric zeros do not fall on an end
            stack += [(middle, right), (left, middle)]
    return _merged(found)


def sign_at(tree: Expression, variable: str, at: Fraction, order: int) -> int:
    """The sign of a derivative at an exact point; 0 when 2048 bits do not tell it from zero."""
    for bits in (128, 512, 2048):
        balls = Balls(bits)
        with balls_at(bits):
            value = derivatives(tree, variable, balls.rational(at), order, balls)[order]
            if value > 0 or value < 0:
                return 1 if value > 0 else -1
    return 0


def _merged(found: list[Zero]) -> list[Zero]:
    """Neighbouring undecided pieces as one."""
    merged: list[Zero] = []
    for zero in found:
        if merged and zero.slope == 0 == merged[-1].slope and zero.low == merged[-1].high:
            merged[-1] = Zero(merged[-1].low, zero.high, 0)
        else:
            merged.append(zero)
    return merged


def refined(tree: Expression, variable: str, zero: Zero, bits: int, order: int = 0) -> Any:
    """A ball of about this many bits around the simple zero in a piece, by interval Newton steps."""
    import flint

    low, high, work = _monotone(tree, variable, zero, order)
    most = max(bits + 64, work)
    work //= 2
    while True:
        work = min(2 * work, most)
        balls = Balls(work)
        with balls_at(work):
            enclosure = balls.interval(low, high)
            for _ in range(200):
                middle = enclosure.mid()
                value = derivatives(tree, variable, middle, order, balls)[order]
                slope = derivatives(tree, variable, enclosure, order + 1, balls)[order + 1] * (order + 1)
                smaller = (middle - value / slope).intersection(enclosure)
                if smaller.rad() >= enclosure.rad() * flint.arb(0.9):
                    break
                enclosure = smaller
        if work == most:
            return enclosure
        low, high = _ends(enclosure)


@lru_cache(maxsize=256)
def ball_of(tree: Root, bits: int) -> Any:
    """A ball of about this many bits around the number that a root is.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> print(ball_of(parse("root(u**2 - 2, 1, 2)"), 100).str(20, radius=False))
    1.4142135623730950488
    """
    rising = sign_at(tree.function, BOUND, tree.high, 0)
    return refined(tree.function, BOUND, Zero(tree.low, tree.high, rising), bits)


def is_one_root(tree: Root, pieces: int | None = None) -> bool:
    """Whether the function has exactly one zero in the interval, with opposite signs at the ends."""
    ends = [sign_at(tree.function, BOUND, end, 0) for end in (tree.low, tree.high)]
    found = isolate(tree.function, BOUND, tree.low, tree.high, pieces=pieces)
    return ends[0] * ends[1] < 0 and len(found) == 1 and found[0].slope != 0


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


def _ends(ball: Any) -> tuple[Fraction, Fraction]:
    from singimpact.algebra.balls import as_rational

    with balls_at(END_BITS):
        low, high = ball.lower(), ball.upper()
    return as_rational(low), as_rational(high)
