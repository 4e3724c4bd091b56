"""All real zeros of a function of one variable in a window: isolated by balls, so none is missed.

A piece of the window is dropped when the ball of the function over it leaves out 0, and settled when the ball of the
derivative does: then there is at most one zero, and the signs at the two ends decide.  A piece that is neither, down to
the least width, is kept as `undecided` (a double zero looks like this).
"""

from __future__ import annotations

from fractions import Fraction

from singimpact.algebra.balls import BITS, Balls, Zero, derivatives, sign_at
from singimpact.algebra.expressions import BOUND, Expression, Root
from singimpact.algebra.precision import balls_at
from singimpact.algebra.taylor import NotSmooth
from singimpact.inputs import InputError, shown

LEAST_WIDTH = Fraction(1, 2**26)  # of the window: below it a double zero is suspected and handed on as undecided


def isolate(
    tree: Expression, variable: str, low: Fraction, high: Fraction, order: int = 0, pieces: int | None = None
) -> list[Zero]:
    """All zeros in [low, high) of the derivative of this order of a tree in one variable.

    Raises
    ------
    InputError : more than `pieces` pieces were looked at, when a number of them is given.
    NotSmooth : the function has no Taylor series somewhere in the window, to within the least width of a piece.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> [zero.slope for zero in isolate(parse("cos(t)", ["t"]), "t", Fraction(-1), Fraction(6))]
    [-1, 1]
    """
    balls = Balls(BITS)
    least = (high - low) * LEAST_WIDTH
    zeros: list[Zero] = []
    with balls_at(BITS):
        stack = [(low, high)]
        while stack:
            left, right = stack.pop()
            if pieces is not None:
                pieces -= 1
                if pieces < 0:
                    raise InputError(f"the zeros of {shown(str(tree))} cost too much to tell apart: give closer ends")
            window = balls.interval(left, right)
            try:
                value, slope = derivatives(tree, variable, window, order + 1, balls)[order : order + 2]
            except NotSmooth:
                # a ball over a long piece may hold a 0 of a denominator that none of its points has
                if right - left < least:
                    raise
                value = slope = balls.unknown()
            if value > 0 or value < 0:
                continue
            if slope > 0 or slope < 0:
                rising = 1 if slope > 0 else -1
                if sign_at(tree, variable, left, order) * rising <= 0 < sign_at(tree, variable, right, order) * rising:
                    zeros.append(Zero(left, right, rising))
                continue
            if right - left < least:
                zeros.append(Zero(left, right, 0))
                continue
            middle = left + (right - left) * Fraction(127, 256)  # off the middle: symmetric zeros do not fall on an end
            stack += [(middle, right), (left, middle)]
    return _merged(zeros)


def _merged(found: list[Zero]) -> list[Zero]:
    """Neighbouring undecided pieces as one."""
    merged: list[Zero] = []
    for zero in found:
        if merged and zero.slope == 0 == merged[-1].slope and zero.low == merged[-1].high:
            merged[-1] = Zero(merged[-1].low, zero.high, 0)
        else:
            merged.append(zero)
    return merged


def is_one_root(tree: Root, pieces: int | None = None) -> bool:
    """Whether the function has exactly one zero in the interval, with opposite signs at the ends."""
    ends = [sign_at(tree.function, BOUND, end, 0) for end in (tree.low, tree.high)]
    found = isolate(tree.function, BOUND, tree.low, tree.high, pieces=pieces)
    return ends[0] * ends[1] < 0 and len(found) == 1 and found[0].slope != 0
