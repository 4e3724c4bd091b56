"""a_c(tau) = g(tau) - f(c, 0, tau), the acceleration of a mass at rest on the obstacle, its derivatives, and its zeros.

A launch at rest next to a zero of a_c is a launch from that zero: no double is pi/2, and a mass released at the double
next to a zero would fly or stick by the sign of a rounding.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import factorial, ulp
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import Expression, Number, evaluate, names_in, number, substitute, subtract
from singimpact.algebra.jets import JetSpace
from singimpact.algebra.numbers import Array, as_float
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import DOUBLES
from singimpact.algebra.taylor import NotSmooth
from singimpact.codegen.scalar import in_floats
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import reduced

# Below this part of |g| + |f| the difference g - f has lost five bits and is computed again with balls
CANCELLATION = 1 / 32

# Times up to which doubles keep the phase; later ones are reduced by the period
NEAR = 64.0

# Precisions tried until the sign of a is decided; what is still undecided is below 10^-2000 and is taken as zero
BITS = (128, 512, 2048, 8192)


class AtWall(NamedTuple):
    """a_c = moving - steady: g and f(c, 0); where t occurs in f(c, 0, t), all of a_c and 0."""

    moving: Expression
    steady: Expression


@lru_cache(maxsize=256)
def at_wall(osc: Oscillator) -> AtWall:
    """The two parts of a_c.

    Examples
    --------
    >>> print(*at_wall(Oscillator("x + x**2*sin(t)", "cos(t)", 3, 1)))
    cos(t) - (9*sin(t) + 3) 0
    """
    force, forcing = substitute(osc.force(), {"x": osc.clearance, "xdot": number(0)}), osc.forcing()
    return AtWall(subtract(forcing, force), number(0)) if "t" in names_in(force) else AtWall(forcing, force)


def acceleration(osc: Oscillator, tau: Array, order: int = 0) -> Array:
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
    near = tau if order else _near(osc, tau)
    forcing, force = _forcing(osc, near, order), _resting_float(osc) if order == 0 else 0.0
    values = np.asarray(forcing - force, dtype=float)
    size = np.abs(forcing) + abs(force)
    # a big tau loses its phase in double arithmetic, and a derivative has no size to compare with
    doubtful = ~(np.abs(values) >= CANCELLATION * size) | (np.abs(near) > NEAR) | (order > 0)
    for index in np.flatnonzero(doubtful):
        exactly = at_exactly(osc, Number(Fraction(float(tau[index]))), order)
        # where it is not smooth a_c itself stays inf or nan, as of any numpy function
        values[index] = exactly if order or not np.isnan(exactly) else values[index]
    return values


def acceleration_at(osc: Oscillator, tau: float) -> float:
    """a_c at one time, as by `acceleration`.

    Examples
    --------
    >>> acceleration_at(Oscillator("x", "cos(t)", 1, 1), 1e-9)
    -5e-19
    """
    forcing, force = in_floats_of(osc)[0], _resting_float(osc)
    phase = tau if -NEAR <= tau <= NEAR else float(_near(osc, np.array([tau]))[0])
    if -NEAR <= phase <= NEAR:
        ahead = forcing(phase)
        value = ahead - force
        if abs(value) >= CANCELLATION * (abs(ahead) + abs(force)):
            return value
    return float(acceleration(osc, np.array([tau]))[0])


@lru_cache(maxsize=256)
def in_floats_of(osc: Oscillator) -> tuple[Callable[[float], float], Callable[[float, float], float]]:
    """The moving part of a_c by t, and f(c, x', t) by x' and t, as functions of floats."""
    force = substitute(osc.force(), {"x": osc.clearance})
    return in_floats(_moving_part(osc)[0], "t"), in_floats(force, "xdot", "t")


def _near(osc: Oscillator, tau: Array) -> Array:
    """Times of which doubles lose the phase, reduced by the period, if there is one; the others as they are."""
    far = np.abs(tau) > NEAR
    return np.where(far, reduced(tau, osc.period), tau) if osc.period is not None and far.any() else tau


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


def _forcing(osc: Oscillator, tau: Array, order: int) -> Array:
    forcing, steady = _moving_part(osc)
    if order or steady is not None:
        return np.full(tau.shape, 0.0 if order or steady is None else steady)
    with np.errstate(all="ignore"):
        return np.broadcast_to(evaluate(forcing, {"t": tau}, DOUBLES), tau.shape)


@lru_cache(maxsize=256)
def _moving_part(osc: Oscillator) -> tuple[Expression, float | None]:
    """The moving part of a_c, and its value when it does not move."""
    forcing = at_wall(osc).moving
    return forcing, None if "t" in names_in(forcing) else as_float(forcing)


@lru_cache(maxsize=256)
def _resting_float(osc: Oscillator) -> float:
    return as_float(at_wall(osc).steady)


def as_ball(osc: Oscillator, tau: Expression, order: int = 0) -> Any:
    """The derivative of a_c as a ball that is relatively narrow, or that is zero or tiny beyond doubt.

    Raises
    ------
    NotSmooth : it is no number there, or out of the range of balls.
    """
    ball: Any = None
    for bits in BITS:
        # a large tau needs as many bits more as its exponent has
        balls = Balls(bits + 64 + max(int(np.frexp(abs(as_float(tau)))[1]), 0))
        ball = around(osc, balls.evaluate(tau, {}), order, balls)
        if ball == 0 or (ball.is_finite() and ball.rel_accuracy_bits() > 64):
            return ball
    if not ball.is_finite():
        raise NotSmooth(f"a_c is no finite number at tau = {tau!s:.40}: the model must be smooth there")
    return ball


def around(osc: Oscillator, start: Any, order: int, balls: Balls) -> Any:
    """The derivative of a_c over a ball of times.

    Examples
    --------
    >>> balls = Balls(64)
    >>> around(Oscillator("x", "sin(t)", 0, 1), balls.interval(Fraction(0), Fraction(1)), 1, balls).contains(1)
    True
    """
    force = balls.evaluate(at_wall(osc).steady, {})
    with balls_at(balls.bits):
        if not order:
            return balls.evaluate(_moving_part(osc)[0], {"t": start}) - force
        space = JetSpace(("s",), order, balls)
        jet = space.evaluate(_moving_part(osc)[0], {"t": space.constant(start) + space.generators()[0]})
        # log has a slope on paper where it is no number: nan goes on to it
        return jet.coefficient((order,)) * factorial(order) + 0 * jet.coefficient((0,))


def sign_of_acceleration(osc: Oscillator, tau: Expression, order: int = 0) -> int:
    """The sign of a derivative of a_c; 0 when it is zero or below 10^-2000."""
    ball = as_ball(osc, tau, order)
    return 1 if ball > 0 else -1 if ball < 0 else 0


# The zero of a_c that a double stands for.

# The highest order of a zero that is recognised
HIGHEST = 6


@dataclass(frozen=True)
class Zero:
    """A time, and order and sign of the first derivative of a_c that is not zero there."""

    tau: Expression
    order: int
    sign: int


@lru_cache(maxsize=1024)
def zero_beside(osc: Oscillator, tau: float, bits: int) -> Zero | None:
    """The zero of a_c within one ulp of a double; None where there is none, or where it is not decided.

    Parameters
    ----------
    osc : the model. tau : a finite double. bits : the zero is returned to 2^-bits.

    Notes
    -----
    A derivative of a_c that is a ball without 0 over the two ulps makes the derivative below it monotone: one change of
    its sign is one zero.  At a multiple zero the lower derivatives are taken as zero when they are below 2^(-bits/2).

    Examples
    --------
    >>> from math import pi
    >>> zero = zero_beside(Oscillator("x", "cos(t)", 0, 1), 3 * pi / 2, 200)
    >>> zero.order, zero.sign
    (1, 1)
    >>> print(zero_beside(Oscillator("x", "cos(t)", 0, 1), 4.7123889803847, 200))
    None
    """
    centre, reach = Fraction(tau), Fraction(ulp(tau))
    try:
        order, leading = _leading(osc, centre - reach, centre + reach)
        if not order or not _changes_sign(osc, centre - reach, centre + reach, order - 1):
            return None
        zero = _refined(osc, centre, reach, order - 1, bits)
        lower = [_derivative(osc, zero, zero, below, bits) for below in range(order - 1)]
    except NotSmooth:
        return None
    if any(abs(coefficient) > Balls(bits).rational(Fraction(1, 2 ** (bits // 2))) for coefficient in lower):
        return None
    return Zero(Number(zero), order, 1 if leading > 0 else -1)


def _leading(osc: Oscillator, low: Fraction, high: Fraction) -> tuple[int, Any]:
    """The first derivative of a_c that is not zero anywhere from low to high; (0, ...) also where none is found."""
    for order in range(HIGHEST + 1):
        ball = _derivative(osc, low, high, order, 128)
        if ball.is_finite() and not ball.contains(0):
            return order, ball
    return 0, None


def _changes_sign(osc: Oscillator, low: Fraction, high: Fraction, order: int) -> bool:
    first, last = (_derivative(osc, end, end, order, 512) for end in (low, high))
    return bool((first < 0 and last > 0) or (first > 0 and last < 0))


def _refined(osc: Oscillator, start: Fraction, reach: Fraction, order: int, bits: int) -> Fraction:
    """Newton's method for the simple zero of a derivative that is monotone within reach of the start."""
    zero, precision = start, 128
    while True:
        values = [_derivative(osc, zero, zero, order + k, precision) for k in range(2)]
        zero = min(max(zero - as_rational(values[0]) / as_rational(values[1]), start - reach), start + reach)
        zero = as_rational(Balls(2 * precision).rational(zero))
        if precision > 2 * bits:
            return zero
        precision *= 2


def _derivative(osc: Oscillator, low: Fraction, high: Fraction, order: int, bits: int) -> Any:
    balls = Balls(bits)
    return around(osc, balls.interval(low, high), order, balls)
