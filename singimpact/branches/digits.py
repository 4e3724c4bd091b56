"""A periodic orbit and its multipliers in many digits."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_mpf
from singimpact.algebra.precision import digits_at, for_user
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.flights.derivative import derivative
from singimpact.flights.impact_map import impact_map
from singimpact.flights.rebound_law import rebound_slope
from singimpact.flights.response import precise
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

Array = np.ndarray[Any, Any]


def in_digits(osc: Oscillator, rough: PeriodicOrbit, digits: int) -> PeriodicOrbit:
    """The orbit and its multipliers in many digits."""
    n, k = int(rough.n), rough.k
    times, speeds, miss = _corrected(osc, rough, _inverse(osc, rough), n, k, digits)
    with digits_at(digits + 15) as mp:
        multipliers = _multipliers(osc, times, speeds, mp)
        span = k * as_mpf(osc.period, mp) if osc.period is not None else mp.nan
        closes = miss < mp.mpf(10) ** (-digits - 3) * span
    with digits_at(digits):
        fields = (times[:-1], speeds[:-1], multipliers)
        one, two, three = (np.array([for_user(+value) for value in part], dtype=object) for part in fields)
        status = np.int8(Status.hit if closes else Status.unresolved)
        return replace(rough, tau=one, v=two, multipliers=three, miss=for_user(+miss), status=status)


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
