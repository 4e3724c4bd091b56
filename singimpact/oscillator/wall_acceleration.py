"""a_c(tau) = g(tau) - f(c, 0), the acceleration of a mass at rest on the obstacle, and its derivatives."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from math import factorial
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Expression, Number, evaluate, names_in, number, substitute
from singimpact.algebra.jets import JetSpace
from singimpact.algebra.numbers import as_float
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import DOUBLES
from singimpact.algebra.taylor import NotSmooth
from singimpact.oscillator.model import Oscillator

CANCELLATION = 1 / 32
"""Below this part of |g| + |f| the difference g - f has lost five bits and is computed again with balls."""

BITS = (128, 512, 2048, 8192)
"""Precisions tried until the sign of a is decided; what is still undecided is below 10^-2000 and is taken as zero."""


@lru_cache(maxsize=256)
def resting_force(osc: Oscillator) -> Expression:
    """f(c, 0)."""
    return substitute(osc.force(), {"x": osc.clearance, "xdot": number(0)})


def acceleration(osc: Oscillator, tau: np.ndarray[Any, Any], order: int = 0) -> np.ndarray[Any, Any]:
    """a_c or a tau-derivative of it at doubles, each to a few units in the last place.

    Parameters
    ----------
    osc : the model.
    tau : finite doubles. order : which derivative, >= 0.

    Examples
    --------
    >>> acceleration(Oscillator("x", "cos(t)", 1, 1), np.array([1e-9])).tolist()
    [-5e-19]
    """
    forcing, force = _forcing(osc, tau, order), _resting_float(osc) if order == 0 else 0.0
    values = np.asarray(forcing - force, dtype=float)
    size = np.abs(forcing) + abs(force)
    # a big tau loses its phase in double arithmetic, and a derivative has no size to compare with
    doubtful = ~(np.abs(values) >= CANCELLATION * size) | (np.abs(tau) > 64) | (order > 0)
    for index in np.flatnonzero(doubtful):
        exactly = at_exactly(osc, Number(Fraction(float(tau[index]))), order)
        # where it is not smooth a_c itself stays inf or nan, as of any numpy function
        values[index] = exactly if order or not np.isnan(exactly) else values[index]
    return values


def at_exactly(osc: Oscillator, tau: Expression, order: int = 0) -> float:
    """a_c, or a tau-derivative of it, at an exact time; nan where it is not smooth.

    Examples
    --------
    >>> at_exactly(Oscillator("x", "cos(t)", 0, 1), Number(Fraction(2**53 + 1)))
    0.4287904318447045
    """
    try:
        return float(as_ball(osc, tau, order).mid())
    except NotSmooth:
        return float("nan")


def largest_push(osc: Oscillator) -> float:
    """The largest |a_c| at 64 phases of a period.

    Examples
    --------
    >>> largest_push(Oscillator("x", "cos(2*t)", -1, 1))
    2.0
    """
    assert osc.period is not None
    return float(np.abs(acceleration(osc, np.linspace(0, as_float(osc.period), 64))).max())


def _forcing(osc: Oscillator, tau: np.ndarray[Any, Any], order: int) -> np.ndarray[Any, Any]:
    forcing, steady = _forcing_tree(osc)
    if order or steady is not None:
        return np.full(tau.shape, 0.0 if order or steady is None else steady)
    with np.errstate(all="ignore"):
        return np.broadcast_to(evaluate(forcing, {"t": tau}, DOUBLES), tau.shape)


@lru_cache(maxsize=256)
def _forcing_tree(osc: Oscillator) -> tuple[Expression, float | None]:
    """g with its parameters put in, and its value when it does not move."""
    forcing = osc.forcing()
    return forcing, None if "t" in names_in(forcing) else as_float(forcing)


@lru_cache(maxsize=256)
def _resting_float(osc: Oscillator) -> float:
    return as_float(resting_force(osc))


def as_ball(osc: Oscillator, tau: Expression, order: int = 0) -> Any:
    """The derivative of a_c as a ball that is relatively narrow, or that is zero or tiny beyond doubt.

    Raises
    ------
    NotSmooth : it is no number there, or out of the range of balls.
    """
    ball: Any = None
    for bits in BITS:
        ball = _ball(osc, tau, order, bits)
        if ball == 0 or (ball.is_finite() and ball.rel_accuracy_bits() > 64):
            return ball
    if not ball.is_finite():
        raise NotSmooth(f"a_c is no finite number at tau = {tau!s:.40}: the model must be smooth there")
    return ball


def _ball(osc: Oscillator, tau: Expression, order: int, bits: int) -> Any:
    balls = Balls(bits + _exponent(tau))
    return around(osc, balls.evaluate(tau, {}), order, balls)


def around(osc: Oscillator, start: Any, order: int, balls: Balls) -> Any:
    """The derivative of a_c over a ball of times.

    Examples
    --------
    >>> balls = Balls(64)
    >>> around(Oscillator("x", "sin(t)", 0, 1), balls.interval(Fraction(0), Fraction(1)), 1, balls).contains(1)
    True
    """
    force = balls.evaluate(resting_force(osc), {})
    with balls_at(balls.bits):
        if not order:
            return balls.evaluate(_forcing_tree(osc)[0], {"t": start}) - force
        space = JetSpace(("s",), order, balls)
        moved = space.constant(start) + space.generators()[0]
        jet = space.evaluate(_forcing_tree(osc)[0], {"t": moved})
        # log has a slope on paper where it is no number: nan goes on to it
        return jet.coefficient((order,)) * factorial(order) + 0 * jet.coefficient((0,))


def _exponent(tau: Expression) -> int:
    size = abs(as_float(tau))
    return 64 + max(int(np.frexp(size)[1]), 0)


def sign_of_acceleration(osc: Oscillator, tau: Expression, order: int = 0) -> int:
    """The sign of a derivative of a_c; 0 when it is zero or below 10^-2000."""
    ball = as_ball(osc, tau, order)
    return 1 if ball > 0 else -1 if ball < 0 else 0
