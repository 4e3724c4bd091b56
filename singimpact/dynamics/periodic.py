"""Periodic points: n impacts in k periods of the forcing, by Newton's method on the closing of the orbit."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float, as_mpf
from singimpact.algebra.precision import digits_at, for_user
from singimpact.flights.derivative import derivative
from singimpact.flights.impact_map import checked_digits, impact_map
from singimpact.flights.rebound_law import rebound_slope
from singimpact.flights.response import precise
from singimpact.inputs import InputError, refuse
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

EPSILON = 2.0**-52
Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Starts:
    """Where Newton's method starts, and when it has arrived.

    Parameters
    ----------
    phases, speeds : of the grid of starts; orbits that no start leads to are not found.
    rounds : steps of Newton's method.
    closed : an orbit is closed when it misses by this much of its size, times its condition.
    apart : points nearer than this are one.
    stiff, settling : where (D G^n - 1)^-1 is larger, the gap is computed with so many digits.
    """

    phases: int = 48
    speeds: int = 24
    rounds: int = 40
    closed: float = 1e-11
    apart: float = 1e-7
    stiff: float = 20.0
    settling: int = 20


STARTS = Starts()


@dataclass(frozen=True)
class PeriodicOrbit:
    """States tau, v of n impacts, the first phase in [0, period), with multipliers, and how far it misses closing.

    The status is `hit`; `unresolved` when the digits asked for were not reached.
    """

    tau: Any
    v: Any
    multipliers: Any
    miss: Any
    status: Any


def periodic(osc: Oscillator, n: int, k: int, *, digits: int | None = None) -> list[PeriodicOrbit]:
    """The orbits that close after n impacts in k periods, as far as a grid of starts leads to them.

    Parameters
    ----------
    osc : the model; g must have a period. n, k : whole numbers >= 1. digits : the orbits then hold mpmath numbers.

    Returns
    -------
    list, in the order of the first phase; an orbit that closes sooner is among them.

    Examples
    --------
    >>> found = periodic(Oscillator("x", "cos(4*t)", 0, "0.5"), 1, 2)
    >>> print([f"{orbit.v[0]:.12f}" for orbit in found])
    ['0.533333333333']
    """
    for name, value in (("n", n), ("k", k)):
        if isinstance(value, bool) or not isinstance(value, int | np.integer) or not 1 <= value <= 1000:
            raise refuse(name, value, "a whole number from 1 to 1000")
    if osc.period is None:
        raise InputError("the forcing has no period: a periodic orbit needs one")
    span = k * as_float(osc.period)
    tau, v = _starts(osc, n, span)
    found = _distinct(osc, _closed(osc, *_newton(osc, tau, v, n, span), n, span))
    orbits = [_orbit(osc, tau, v, n, span) for tau, v in found]
    if digits is None:
        return [_settled(osc, one, n, k) for one in orbits]
    return [_precise(osc, one, n, k, checked_digits(digits)) for one in orbits]


def _starts(osc: Oscillator, n: int, span: float) -> tuple[Array, Array]:
    period = as_float(osc.period) if osc.period is not None else span
    tau = np.linspace(0, period, STARTS.phases, endpoint=False)
    fast = float(np.abs(acceleration(osc, tau)).max()) * span / n
    grid = np.meshgrid(tau, fast * np.geomspace(1e-3, 1, STARTS.speeds))
    return grid[0].ravel(), grid[1].ravel()


def _around(osc: Oscillator, tau: Array, v: Array, n: int, span: float) -> tuple[Array, Array, Array]:
    """G^n and its derivative; nan where an impact is missing or the orbit has left the span by far."""
    matrix = np.broadcast_to(np.eye(2), (tau.size, 2, 2))
    limit = 3 * span
    for _ in range(n):
        matrix = derivative(osc, tau, v, horizon=limit).matrix @ matrix
        step = impact_map(osc, tau, v, horizon=limit)
        good = (step.status == Status.hit) & (step.v > 0)
        tau, v = np.where(good, step.tau, 0.0), np.where(good, step.v, 1.0)
        matrix = np.where(good[:, None, None], matrix, np.nan)
    return tau, v, matrix


def _newton(osc: Oscillator, tau: Array, v: Array, n: int, span: float) -> tuple[Array, Array]:
    for _ in range(STARTS.rounds):
        end, speed, matrix = _around(osc, tau, v, n, span)
        miss = np.stack([end - tau - span, speed - v], axis=-1)
        with np.errstate(all="ignore"):
            change = _solved(matrix - np.eye(2), miss)
            size = np.hypot(change[:, 0] / span, change[:, 1] / v)
            damped = change * np.minimum(1, 0.3 / np.maximum(size, 1e-300))[:, None]
        alive = np.isfinite(damped).all(axis=1) & (v - damped[:, 1] > 0)
        tau, v, size = tau[alive] - damped[alive, 0], v[alive] - damped[alive, 1], size[alive]
        if not tau.size or np.all(size < 1e-13):
            break
    return tau, v


def _solved(matrix: Array, right: Array) -> Array:
    """Cramer's rule: a singular matrix gives inf, not an error."""
    (a, b), (c, d) = matrix[:, 0].T, matrix[:, 1].T
    x, y = right.T
    solution: Array = np.stack([d * x - b * y, a * y - c * x], axis=-1) / (a * d - b * c)[:, None]
    return solution


def _closed(osc: Oscillator, tau: Array, v: Array, n: int, span: float) -> tuple[Array, Array]:
    if not tau.size:
        return tau, v
    end, speed, _ = _around(osc, tau, v, n, span)
    with np.errstate(invalid="ignore"):
        good = (np.abs(end - tau - span) < STARTS.closed * span) & (np.abs(speed - v) < STARTS.closed * v)
    return tau[good], v[good]


def _distinct(osc: Oscillator, states: tuple[Array, Array]) -> list[tuple[float, float]]:
    """One state an orbit is not sought: every point of an orbit that a start led to is a way to give it."""
    period = as_float(osc.period) if osc.period is not None else np.inf
    kept: list[tuple[float, float]] = []
    for tau, v in zip(*states, strict=True):
        place = float(tau - period * np.floor(tau / period))
        gaps = [(abs(place - t), abs(v - s) / s) for t, s in kept]
        if all(min(g, period - g) > STARTS.apart * period or h > STARTS.apart for g, h in gaps):
            kept.append((place, float(v)))
    return sorted(kept)


def _orbit(osc: Oscillator, tau: float, v: float, n: int, span: float) -> PeriodicOrbit:
    times, speeds, matrix = [tau], [v], np.eye(2)
    for _ in range(n):
        matrix = derivative(osc, times[-1], speeds[-1]).matrix @ matrix
        step = impact_map(osc, times[-1], speeds[-1])
        times.append(float(step.tau))
        speeds.append(float(step.v))
    miss = max(abs(times[-1] - tau - span), abs(speeds[-1] - v))
    return PeriodicOrbit(np.array(times[:-1]), np.array(speeds[:-1]), np.linalg.eigvals(matrix), miss, np.int8(0))


def _settled(osc: Oscillator, rough: PeriodicOrbit, n: int, k: int) -> PeriodicOrbit:
    """A state that closing determines badly, because multipliers are near 1, is found again from the exact gap."""
    inverse = _inverse(osc, rough)
    if not STARTS.stiff < np.abs(inverse).max() < np.inf:
        return rough
    times, speeds, _ = _corrected(osc, rough, inverse, n, k, STARTS.settling)
    tau, v = (np.array([float(value) for value in part[:-1]]) for part in (times, speeds))
    return replace(rough, tau=tau, v=v)


def _precise(osc: Oscillator, rough: PeriodicOrbit, n: int, k: int, digits: int) -> PeriodicOrbit:
    """The orbit and its multipliers in many digits."""
    times, speeds, miss = _corrected(osc, rough, _inverse(osc, rough), n, k, digits)
    with digits_at(digits + 15) as mp:
        multipliers = _multipliers(osc, times, speeds, mp)
        span = k * as_mpf(osc.period, mp) if osc.period is not None else mp.nan
        closes = miss < mp.mpf(10) ** (-digits - 3) * span
    with digits_at(digits):
        fields = (times[:-1], speeds[:-1], multipliers)
        one, two, three = (np.array([for_user(+value) for value in part], dtype=object) for part in fields)
        return PeriodicOrbit(one, two, three, for_user(+miss), np.int8(0 if closes else Status.unresolved))


def _inverse(osc: Oscillator, rough: PeriodicOrbit) -> Array:
    """(D G^n - 1)^-1 in doubles; inf when it is singular."""
    matrix = np.eye(2)
    for tau, v in zip(rough.tau, rough.v, strict=True):
        matrix = derivative(osc, tau, v).matrix @ matrix
    (a, b), (c, d) = matrix - np.eye(2)
    with np.errstate(all="ignore"):
        return np.asarray(np.array([[d, -b], [-c, a]]) / (a * d - b * c))


def _corrected(
    osc: Oscillator, rough: PeriodicOrbit, inverse: Array, n: int, k: int, digits: int
) -> tuple[list[Any], list[Any], Any]:
    """Times and velocities in many digits, and by how much they miss; the inverse gives twelve digits a round."""
    with digits_at(digits + 15) as mp:
        span = k * as_mpf(osc.period, mp) if osc.period is not None else mp.nan
        tau, v = mp.mpf(float(rough.tau[0])), mp.mpf(float(rough.v[0]))
        small, miss = mp.mpf(10) ** (-digits - 3), mp.inf
        for _ in range(5 + digits // 5):
            times, speeds = _flown(osc, tau, v, n, mp)
            gap = (times[-1] - tau - span, speeds[-1] - v)
            miss = max(abs(gap[0]), abs(gap[1]))
            tau -= inverse[0, 0] * gap[0] + inverse[0, 1] * gap[1]
            v -= inverse[1, 0] * gap[0] + inverse[1, 1] * gap[1]
            if miss < small * span:
                break
    return times, speeds, miss


def _flown(osc: Oscillator, tau: Any, v: Any, n: int, mp: Any) -> tuple[list[Any], list[Any]]:
    times, speeds = [tau], [v]
    for _ in range(n):
        step = impact_map(osc, times[-1], speeds[-1], digits=mp.dps - 4)
        times.append(mp.convert(step.tau))
        speeds.append(mp.convert(step.v))
    return times, speeds


def _multipliers(osc: Oscillator, times: list[Any], speeds: list[Any], mp: Any) -> list[Any]:
    """Roots of x^2 - trace x + determinant of the derivatives' product."""
    from singimpact.algebra.rings import Multiprecision

    total = mp.eye(2)
    for i in range(len(times) - 1):
        step = impact_map(osc, times[i], speeds[i], digits=mp.dps - 4)
        time, velocity = mp.convert(step.flight_time), mp.convert(step.velocity)
        answer = precise(osc, times[i], speeds[i], time, velocity, mp)
        slope = rebound_slope(osc, velocity, Multiprecision(mp))
        rows = [
            [1 + answer.time_by_tau, answer.time_by_v],
            [slope * answer.velocity_by_tau, slope * answer.velocity_by_v],
        ]
        total = mp.matrix(rows) * total
    trace, determinant = total[0, 0] + total[1, 1], total[0, 0] * total[1, 1] - total[0, 1] * total[1, 0]
    root = mp.sqrt(mp.mpc(trace * trace / 4 - determinant))
    return [trace / 2 + root, trace / 2 - root]
