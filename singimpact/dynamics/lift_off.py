"""A mass at rest on the obstacle: when the acceleration lifts it off."""

from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Number, number, subtract
from singimpact.algebra.numbers import EPSILON, Array, as_float
from singimpact.flights.bind import over_floats
from singimpact.flights.interpreted import workspace
from singimpact.flights.kernels.roots import first_root
from singimpact.flights.limits import LIMITS
from singimpact.flights.model_numbers import constants_of, recurrence_of
from singimpact.flights.states import at_rest
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import at_wall

ORDER = 22
# Lift-offs whose phases differ by at most this, relative, are one: both are doubles next to one zero of a_c
SAME = 4 * EPSILON


def release(osc: Oscillator, tau: float, horizon: float | None = None) -> float:
    """The first time after tau at which a_c becomes positive; inf when that is not before the horizon.

    Parameters
    ----------
    osc : the model. tau : a time at which the mass is pressed against the obstacle.
    horizon : time after tau at which the search ends; two periods, in which a_c has done all it does, if it has one.

    Returns
    -------
    float : a double at which a mass at rest lifts off (within an ulp of the zero of a_c, on its positive side); nan
        when a_c comes so near to zero that doubles cannot tell whether it becomes positive.

    Examples
    --------
    >>> release(Oscillator("x", "sin(t)", 0, 1), 4.0, 100.0)
    6.283185307179587
    """
    if horizon is None:
        horizon = LIMITS.horizon_time if osc.period is None else 2 * as_float(osc.period)
    start = tau
    longest = 1.0
    while start - tau < horizon:
        series, width = _pressure(osc, start, longest)
        if not start + width > start:  # g is singular there
            return float("nan")
        code, s, _slope, _depth, _bound = first_root(series, ORDER, width, 0.0, LIMITS.safety * EPSILON)
        if code == 2:
            return float("nan")
        if code == 1:
            return _lifted(osc, start + s)
        start, longest = start + width, 2 * width
    return float("inf")


def next_lift_offs(osc: Oscillator, times: Array) -> tuple[Array, Array]:
    """The phases at which masses that rest at times lift off, and the whole periods before; inf or nan as in `release`.

    Parameters
    ----------
    osc : a model with a period. times : shape (n,), at which a_c presses.

    Examples
    --------
    >>> phases, turns = next_lift_offs(Oscillator("x", "sin(t)", 0, 0), np.array([4.0, 5.0, -2.0]))
    >>> abs(phases).max() < 1e-15, turns.tolist()
    (np.True_, [1.0, 1.0, 0.0])
    """
    period, lifted = as_float(osc.period), list[float]()
    turns = np.floor(times / period)
    begun, phases = times - turns * period, np.full(times.size, np.nan)
    left = np.argsort(begun)
    while left.size:
        time = release(osc, float(begun[left[0]]))
        # between a rest and its lift-off a_c presses throughout
        shared = left[begun[left] <= time] if np.isfinite(time) else left[:1]
        passed = np.floor(time / period) if np.isfinite(time) else 0.0
        phase = _lifted(osc, time - passed * period) if passed else time
        phase = next((earlier for earlier in lifted if abs(earlier - phase) <= SAME * period), phase)
        lifted.append(phase)
        phases[shared], turns[shared] = phase, turns[shared] + passed
        left = left[shared.size :]
    return phases, turns


def periods_between(osc: Oscillator, earlier: float, later: float) -> float | None:
    """Time from one lift-off to another of the same phase; None where the phases differ or g has no period.

    Examples
    --------
    >>> osc = Oscillator("x", "sin(t)", 0, 1)
    >>> periods_between(osc, 0.0, release(osc, 4.0)) == 2 * np.pi, periods_between(osc, 0.0, 3.0)
    (True, None)
    """
    if osc.period is None:
        return None
    period = as_float(osc.period)
    turns, miss = turns_between(earlier, later, period)
    return turns * period if miss <= SAME * max(abs(later), period) else None


def turns_between(earlier: float, later: float, period: float) -> tuple[int, float]:
    """Whole periods between two times, and by how much the time between them misses these.

    Examples
    --------
    >>> turns_between(0.5, 7.75, 2.0)
    (4, 0.75)
    """
    turns = int(np.rint((later - earlier) / period))
    return turns, abs(later - earlier - turns * period)


def _lifted(osc: Oscillator, tau: float) -> float:
    """The nearest double from tau upwards where the exact acceleration lifts the mass."""
    candidate, gap = tau, float(np.spacing(abs(tau)))
    candidate -= 2 * gap
    for _ in range(80):
        if at_rest(osc, Number(Fraction(candidate)))[0] > 0:
            return candidate
        candidate += gap
        gap = gap if candidate < tau + 4 * gap else 2 * gap
    return float("nan")


@lru_cache(maxsize=64)
def _resting_model(osc: Oscillator) -> tuple[dict[str, Any], list[float], int]:
    """x'' = -a_c(t) as a recurrence; its coefficients give those of -a_c."""
    moving, steady = at_wall(osc)
    model = Oscillator(number(0), subtract(steady, moving), 0, 1)
    flow = recurrence_of(model)
    numbers = [as_float(tree) for tree in constants_of(model, linear=False)]
    return over_floats(flow.source), numbers, flow.rows


def _pressure(osc: Oscillator, tau: float, longest: float) -> tuple[list[float], float]:
    """Taylor coefficients of -a_c at tau, and a step on which what they leave out is proved to be below rounding."""
    space, p, rows = _resting_model(osc)
    work = workspace(0.0, ORDER + 2, rows)
    space["coefficients"]([tau], 0.0, 0.0, 0.0, 0.0, ORDER + 2, p, work)
    series = [work.X[k + 2] * (k + 1) * (k + 2) for k in range(ORDER + 1)]
    width = R = _width(series, longest)
    R *= 4
    while width > EPSILON * abs(tau):
        bound, _suspect = space["disc"](work.X, work.W, ORDER + 2, R, p)
        q = width / R
        # Cauchy's bound of the coefficients beyond ORDER, summed
        if q < 0.9 and bound * q ** (ORDER + 1) / (1 - q) < 8 * EPSILON * max(map(abs, series[:4])):
            break
        width, R = 0.8 * width, 0.87 * R
    return series, width


def _width(series: list[float], longest: float) -> float:
    """A step on which the last terms are below rounding."""
    width = longest
    size = 0.0
    for part in reversed(series[:4]):
        size = size * width + abs(part)
    for k in range(ORDER - 2, ORDER + 1):
        if series[k]:
            width = min(width, (EPSILON * size / abs(series[k])) ** (1.0 / k))
    return width
