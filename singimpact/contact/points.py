"""Tangency points of a model and swan points of a family, with exact definitions: their numbers give any digits."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import ceil
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls, Zero, as_rational, derivatives, refined, sign_at
from singimpact.algebra.certified import Certified, as_certified
from singimpact.algebra.expressions import Call, Expression, Number, Power, children, evaluate, names_in, walk
from singimpact.algebra.isolated_zeros import isolate
from singimpact.algebra.numbers import as_float
from singimpact.algebra.precision import Ladder, balls_at, digits_at, for_user, kept_property
from singimpact.contact.contact import acceleration
from singimpact.inputs import InputError, checked_keywords, takes_two_walls, whole
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result, Results

MOST_DIGITS = 100_000
SLACK = 1e-12  # of a period: a zero at 0 is found with a tiny sign


@dataclass(frozen=True, repr=False)
class TangencyPoint(Result):
    """A zero tau_* of a_c.

    Attributes
    ----------
    function : a_c as a tree in t. zero : the piece of the axis that isolates it.
    kind : "gamma" (a' > 0, an invariant arc ends here), "foliation" (a' < 0), "degenerate" (a' = 0 to 2048 bits).
    """

    function: Expression
    zero: Zero
    kind: str

    def __repr__(self) -> str:
        return f"{type(self).__name__}(tau={self.tau}, kind={self.kind})"

    def as_dict(self) -> dict[str, Any]:
        """tau_* as a double, and its kind."""
        return {"tau": self.tau, "kind": self.kind}

    def ball(self, bits: int = 128) -> Any:
        """A ball that contains tau_*."""
        if self.kind == "degenerate":
            return refined(self.function, "t", self.zero, bits, order=1)
        return refined(self.function, "t", self.zero, bits)

    @kept_property
    def tau(self) -> float:
        """tau_* as a double."""
        return float(self.ball().mid())

    def certified(self, digits: int = 30) -> Certified:
        """tau_* with a certified radius; of a degenerate point, the zero of a_c' that is meant.

        Examples
        --------
        >>> print(tangency_points(Oscillator("x", "cos(2*t)", "0.3", "1/2"))[1].certified(40))
        2.508540817200043682832984018073391746625
        """
        return enclosed(self.ball, digits)

    def value(self, digits: int = 30) -> Any:
        """tau_* as an mpmath number with this many digits."""
        with digits_at(digits + 5) as mp:
            return for_user(+mp.convert(self.certified(digits + 3).value))


def enclosed(ball: Callable[[int], Any], digits: int) -> Certified:
    """The certified number that ball(bits) gives, with more bits until it has its digits.

    Raises
    ------
    InputError : digits are not a whole number from 1 to MOST_DIGITS.
    """
    for bits in Ladder(ceil(whole("digits", digits, 1, MOST_DIGITS) * 3.33) + 32, 64 * (digits + 64)):
        if (number := as_certified(ball(bits), digits)) is not None:
            return number
    raise ArithmeticError(f"{digits} digits are not reached with {bits} bits")


class TangencyPoints(Results, tuple[TangencyPoint, ...]):
    """Tangency points in order, with `.tau` and `.kind` as arrays; `digits` of what `certified` gives.

    Attributes
    ----------
    notes : why there are none, where a_c is the same at all times.
    """

    called = "points"
    digits: int = 30
    notes: tuple[str, ...] = ()

    def certified(self, digits: int | None = None) -> tuple[Certified, ...]:
        """The times tau_*, each with a certified radius and so many significant digits."""
        return tuple(point.certified(self.digits if digits is None else digits) for point in self)

    @property
    def tau(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """The times tau_*."""
        return np.array([point.tau for point in self])

    @property
    def kind(self) -> tuple[str, ...]:
        """ "gamma", "foliation" or "degenerate" for each."""
        return tuple(point.kind for point in self)


KINDS = {1: "gamma", -1: "foliation"}


@checked_keywords
@takes_two_walls
def tangency_points(osc: Oscillator, digits: int = 30, *, wall: object = None) -> TangencyPoints:
    """The zeros of a_c over one period [0, T), or all real zeros when g is a polynomial.

    Parameters
    ----------
    digits : significant ones that `certified` of the points gives.
    wall : of a model with two walls: "lower" (also without it) or "upper", where a' is that of x -> -x.

    Raises
    ------
    InputError : g is neither periodic nor a polynomial.

    Examples
    --------
    >>> points = tangency_points(Oscillator("x", "cos(2*t)", "0.3", "1/2"))
    >>> points.kind, points.tau.round(6).tolist()
    (('foliation', 'gamma'), [0.633052, 2.508541])
    """
    osc = osc.seen_from(wall)
    points = TangencyPoints(_points(osc))
    points.digits = whole("digits", digits, 1, MOST_DIGITS)
    a_c = acceleration(osc)
    if "t" not in names_in(a_c):
        zeros = "no zeros" if as_float(a_c) else "no isolated zeros"
        points.notes = (f"a_c = {as_float(a_c):.12g} at all times: it has {zeros}",)
    return points


@lru_cache(maxsize=256)
def _points(oscillator: Oscillator) -> tuple[TangencyPoint, ...]:
    function = acceleration(oscillator)
    if "t" not in names_in(function):
        return ()
    low, high = window(oscillator, function)
    points = []
    for zero in isolate(function, "t", low, high):
        points += [TangencyPoint(function, zero, KINDS[zero.slope])] if zero.slope else _decided(function, zero)
    return tuple(sorted((p for p in points if in_period(oscillator, p.tau)), key=lambda point: point.tau))


def window(oscillator: Oscillator, function: Expression) -> tuple[Fraction, Fraction]:
    """A window of the tau-axis with rational ends that contains one period, or all zeros of a polynomial."""
    if oscillator.period is not None:
        period = Fraction(as_float(oscillator.period))
        return -period * Fraction(1, 97), period * Fraction(98, 97)
    if not is_polynomial(function):
        raise InputError(f"g = {oscillator.g} is not seen to be periodic: give period=")
    bound = _root_bound(function)
    return -bound, bound


def is_polynomial(tree: Expression) -> bool:
    """Whether a tree is written as a polynomial in the names in it.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> is_polynomial(parse("t**3 - t/2", ["t"])), is_polynomial(parse("t/(1 + t**2)", ["t"]))
    (True, False)
    """
    for node in walk(tree):
        if isinstance(node, Call) and names_in(node):
            return False
        if isinstance(node, Power) and names_in(node):
            power = node.exponent
            if not isinstance(power, Number) or power.value.denominator != 1 or power.value < 0:
                return False
    return True


def _root_bound(function: Expression) -> Fraction:
    """Cauchy's bound on the zeros of a polynomial in t, a little enlarged."""
    from singimpact.algebra.rings import EXACT

    degree = 1 + sum(
        int(abs(e.exponent.value)) if hasattr(e, "exponent") and hasattr(e.exponent, "value") else 1
        for e in walk(function)
        if not children(e) or isinstance(e, Power)
    )
    try:
        coefficients = derivatives(function, "t", Fraction(0), degree, EXACT)
    except ArithmeticError:
        raise InputError(
            "a polynomial forcing needs rational coefficients here: give period= or rational numbers"
        ) from None
    while len(coefficients) > 1 and coefficients[-1] == 0:
        coefficients.pop()
    size: Fraction = max(abs(value / coefficients[-1]) for value in coefficients)
    return size + Fraction(98, 97)


def _decided(function: Expression, zero: Zero) -> list[TangencyPoint]:
    """An undecided piece: a_c at the zero of a_c' on it tells whether it holds no zero, two, or a double one."""
    turns = [piece for piece in isolate(function, "t", zero.low, zero.high, order=1) if piece.slope]
    if not turns:
        phase = f"{float(zero.low):.6g}"
        raise InputError(f"a_c has zeros near t = {phase} of contact order 3 or more: they are not classified")
    turn = turns[0]
    for bits in (256, 2048):
        ball = refined(function, "t", turn, bits, order=1)
        with balls_at(bits):
            value = evaluate(function, {"t": ball}, Balls(bits))
            if value > 0 or value < 0:
                return _beside(function, zero, as_rational(ball), turn.slope)
    return [TangencyPoint(function, turn, "degenerate")]


def _beside(function: Expression, zero: Zero, turn: Fraction, slope: int) -> list[TangencyPoint]:
    """The zeros of a piece on the two sides of an extremum, by signs; `slope` is that of the derivative after it."""
    low, middle, high = (sign_at(function, "t", end, 0) for end in (zero.low, turn, zero.high))
    left = [Zero(zero.low, turn, -slope)] if low != -slope == middle else []
    right = [Zero(turn, zero.high, slope)] if middle != slope == high else []
    return [TangencyPoint(function, piece, KINDS[piece.slope]) for piece in left + right]


def in_period(oscillator: Oscillator, tau: float) -> bool:
    """Whether a time lies in [0, T); every one does where there is no period."""
    if oscillator.period is None:
        return True
    period = as_float(oscillator.period)
    return -SLACK * period <= tau < period * (1 - SLACK)
