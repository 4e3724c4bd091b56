"""The restitution law in numbers: rho, its slope, and the velocity before an impact from the one after it."""

from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, evaluate, names_in, number
from singimpact.algebra.numbers import Array, as_float, as_mpf
from singimpact.algebra.precision import digits_at, for_user
from singimpact.algebra.rings import DOUBLES, Multiprecision
from singimpact.oscillator.model import Oscillator

DOUBLINGS = 64
STEPS = 120
DIGITS = 20  # of a speed that doubles leave open
FLAT = 64  # roundings of v that one rounding of the speed may stand for
SPARE = 40  # digits beyond 2 `digits`: half of the digits are lost where rho has a maximum


def rebound(osc: Oscillator, velocity: Array) -> Array:
    """rho(velocity) for velocities <= 0, and that of the upper wall for velocities > 0; nan where it is not positive
    for a velocity that is not 0.
    """
    if osc.upper is not None:
        lower, upper = (_rebound_below(each, -np.abs(velocity)) for each in (osc, osc.mirrored))
        return np.where(np.asarray(velocity) > 0, upper, lower)
    return _rebound_below(osc, velocity)


def _rebound_below(osc: Oscillator, velocity: Array) -> Array:
    """rho(velocity) of the lower wall."""
    if not names_in(osc.restitution):
        return np.abs(as_float(osc.restitution) * velocity)
    with np.errstate(all="ignore"):
        bounce = np.asarray(evaluate(osc.rho(), {"v": velocity}, DOUBLES), dtype=float)
    return np.where(velocity == 0, 0.0, np.where((bounce > 0) & np.isfinite(bounce), bounce, np.nan))


def rebound_in_digits(osc: Oscillator, velocity: Any, mp: Any) -> Any:
    """rho(velocity) at the precision of an mpmath context."""
    if osc.upper is not None and velocity > 0:
        osc, velocity = osc.mirrored, -velocity
    if not names_in(osc.restitution):
        return abs(as_mpf(osc.restitution, mp) * velocity)
    return mp.re(evaluate(osc.rho(), {"v": velocity}, Multiprecision(mp)))


@lru_cache(maxsize=256)
def _slope_of_rho(osc: Oscillator) -> Any:
    return derivative(osc.rho(), "v")


def rebound_slope(osc: Oscillator, velocity: Any, ring: Any = DOUBLES) -> Any:
    """The derivative of `rebound`; at rest from the expansion of rho, for the formula of rho' may be 0/0 there."""
    if osc.upper is not None and np.any(np.asarray(velocity) > 0):
        lower, upper = (_slope_below(each, -abs(velocity), ring) for each in (osc, osc.mirrored))
        return np.where(np.asarray(velocity) > 0, -upper, lower)[()]
    return _slope_below(osc, velocity, ring)


def _slope_below(osc: Oscillator, velocity: Any, ring: Any) -> Any:
    """rho'(velocity) of the lower wall."""
    if not names_in(osc.restitution):
        return -evaluate(osc.restitution, {}, ring) + 0 * velocity
    if osc.rho_at_rest() is None:
        return evaluate(_slope_of_rho(osc), {"v": velocity}, ring) + 0 * velocity
    still = -evaluate(osc.slope_at_rest(), {}, ring)
    if np.ndim(velocity) == 0 and velocity == 0:
        return still + 0 * velocity
    with np.errstate(all="ignore"):
        slope = evaluate(_slope_of_rho(osc), {"v": velocity}, ring) + 0 * velocity
    return slope if np.ndim(velocity) == 0 else np.where(velocity == 0, float(still), slope)


def speed_before(osc: Oscillator, v: Array) -> Array:
    """U >= 0 with rho(-U) = v for each v >= 0; nan where no velocity on the branch from rest rebounds to v.

    Parameters
    ----------
    osc : a model whose rho is an expression. v : velocities after an impact, any shape.

    Examples
    --------
    >>> osc = Oscillator("x", "cos(t)", 0, "-tanh(v/2)")
    >>> speed_before(osc, np.array([0.5, 1.0])).round(12).tolist()
    [1.098612288668, nan]
    """
    v = np.asarray(v, dtype=float)
    low, high = np.zeros(v.shape), v / as_float(osc.slope_at_rest())
    for _ in range(DOUBLINGS):
        below = _still_below(*_rebound(osc, high), v)
        if not below.any():
            break
        low, high = np.where(below, high, low), np.where(below, 2 * high, high)
    guess = high.copy()
    for _ in range(STEPS):
        value, slope = _rebound(osc, guess)
        below = _still_below(value, slope, v)
        low, high = np.where(below, guess, low), np.where(below, high, guess)
        with np.errstate(all="ignore"):
            newton = guess - (value - v) / slope
        inside = (newton > low) & (newton < high)
        middle = np.where(low > 0, np.sqrt(low * high), high / 2)
        moved = np.where(inside, newton, middle)
        if np.all((moved == guess) | (high - low <= 2 * np.spacing(high))):
            break
        guess = moved
    ends = np.stack([low, guess, high])
    value, slope = _rebound(osc, ends)
    with np.errstate(invalid="ignore"):
        allowed = 4 * (np.spacing(v) + np.nan_to_num(np.abs(slope)) * np.spacing(ends))
    miss = np.abs(np.where(np.isfinite(value), value - v, np.inf))
    best = np.argmin(miss, axis=0)[None]
    close = (np.take_along_axis(miss, best, 0) <= np.take_along_axis(allowed, best, 0))[0]
    return _decided(osc, v, np.where(v == 0, 0.0, np.where(close, np.take_along_axis(ends, best, 0)[0], np.nan)))


def _decided(osc: Oscillator, v: Array, speed: Array) -> Array:
    """Near a maximum of rho rounding decides the speed, or whether one exists: inverted with more digits."""
    _, slope = _rebound(osc, speed)
    with np.errstate(all="ignore"):
        flat = (speed > 0) & ~(np.spacing(v) < FLAT * np.spacing(speed) * slope)
    for index in np.argwhere(flat).tolist():
        sharper = sharpened(osc, number(Fraction(float(v[tuple(index)]))), float(speed[tuple(index)]), DIGITS)
        speed[tuple(index)] = np.nan if sharper is None else float(sharper)
    return speed


def _rebound(osc: Oscillator, speed: Array) -> tuple[Array, Array]:
    """rho(-U), and its slope along U."""
    with np.errstate(all="ignore"):
        return rebound(osc, -speed), -np.asarray(rebound_slope(osc, -speed), dtype=float)


def _still_below(value: Array, slope: Array, v: Array) -> Array:
    """On the branch from rest, and not yet at v."""
    return np.asarray((value < v) & (slope > 0) & np.isfinite(slope))


def sharpened(osc: Oscillator, v: Expression, speed: float, digits: int) -> Any:
    """U to `digits` digits by Newton's method from a double; None where it does not settle.

    Parameters
    ----------
    v : an exact number. speed : U as a double.
    """
    with digits_at(2 * digits + SPARE) as mp:
        speed_in_digits, after, ring = mp.mpf(-speed), as_mpf(v, mp), Multiprecision(mp)
        small = mp.mpf(10) ** (-digits - 5)
        for _ in range(4 * digits + STEPS):
            slope = rebound_slope(osc, speed_in_digits, ring)
            if not slope < 0:
                return None
            change = (rebound_in_digits(osc, speed_in_digits, mp) - after) / slope
            speed_in_digits -= change
            if abs(change) <= small * abs(speed_in_digits):
                return for_user(-speed_in_digits)
    return None
