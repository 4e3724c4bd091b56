"""All double zeros in one variable of a function with a parameter, in a window of both: isolated by balls."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression
from singimpact.algebra.isolated_zeros import SETTINGS, isolated_zeros
from singimpact.algebra.precision import balls_at

Box = tuple[Fraction, Fraction, Fraction, Fraction]


@dataclass(frozen=True)
class DoubleZero:
    """A place where the function and its slope vanish, proved to exist and to be alone in its box.

    Attributes
    ----------
    at, value : of the variable and of the parameter, rational, true to 2^-80 of the window. curvature : sign of the
        second derivative; 0 where it is not told from zero.
    """

    at: Fraction
    value: Fraction
    curvature: int


@dataclass(frozen=True)
class DoubleZeros:
    """found : in order of the parameter, then of the variable. undecided : boxes that may hold more."""

    found: tuple[DoubleZero, ...]
    undecided: tuple[Box, ...]

    @property
    def complete(self) -> bool:
        """Whether no other double zero lies in the window."""
        return not self.undecided


def double_zeros(tree: Expression, names: tuple[str, str], window: Box) -> DoubleZeros:
    """The double zeros of a tree in the first name, as the second moves.

    Parameters
    ----------
    names : the variable and the parameter. window : ends of the one, ends of the other.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> box = (Fraction(-1), Fraction(6), Fraction(0), Fraction(2))
    >>> made = double_zeros(parse("p*cos(t) - 1", ["t", "p"]), ("t", "p"), box)
    >>> [(round(float(each.at), 12) + 0.0, float(each.value), each.curvature) for each in made.found], made.complete
    ([(0.0, 1.0, -1)], True)
    """
    slope = derivative(tree, names[0])
    bend = derivative(slope, names[0])
    isolated = isolated_zeros((tree, slope), names, (window[:2], window[2:]))
    zeros = []
    for at, value in isolated.found:
        with balls_at(SETTINGS.bits):
            bent: Any = Balls(SETTINGS.bits).evaluate(bend, {names[0]: at, names[1]: value})
        zero = DoubleZero(as_rational(at), as_rational(value), 1 if bent > 0 else -1 if bent < 0 else 0)
        if window[0] <= zero.at <= window[1] and window[2] <= zero.value <= window[3]:
            zeros.append(zero)
    zeros.sort(key=lambda each: (each.value, each.at))
    return DoubleZeros(tuple(zeros), tuple((*a, *b) for a, b in isolated.undecided))
