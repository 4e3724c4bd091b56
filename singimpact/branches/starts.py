"""Newton's method on the closing conditions from many starts: a grid of states, and grazes of simpler orbits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.expressions import evaluate
from singimpact.algebra.rings import DOUBLES
from singimpact.branches.closing import Closing
from singimpact.branches.resting import free_orbits
from singimpact.flights.family import LinearFamily, SteppedFamily
from singimpact.flights.flight_path import ends
from singimpact.flights.impact_map import impact_map
from singimpact.flights.rebound_law import rebound_slope
from singimpact.flights.response import variations
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class StartSettings:
    """Starts and tolerances of Newton's method."""

    # phases of the grid, and velocities from 1e-3 of the fastest to the fastest
    phases: int = 48
    speeds: int = 16
    # the same of a model without a closed form, whose flights may be interpreted still; and how many starts, those of
    # the shortest first steps, are followed
    fewer: tuple[int, int] = (20, 8)
    kept: int = 80
    # further, smaller velocities, for orbits that nearly graze
    weak: tuple[float, ...] = (1e-12, 1e-8, 1e-5)
    # a start is flown when its n impacts take this part of the time in which it must close
    span: tuple[float, float] = (0.4, 1.8)
    rounds: int = 25
    # rounds after which points with larger relative steps are dropped
    slow: tuple[int, float] = (9, 0.1)
    # largest change of a phase in one round, in periods
    longest: float = 0.15
    # relative tolerance
    arrived: float = 1e-12
    # distance of equal points
    apart: float = 1e-8


SETTINGS = StartSettings()


def grid_of_starts(closing: Closing, tau: Any = None, v: Any = None) -> Array:
    """Points to start from, shape (m, 2n).

    Parameters
    ----------
    tau, v : states of the first impact; a grid of phases and velocities without them.
    """
    osc, n = closing.family.osc, closing.n
    period = closing.family.period({}).value
    span = closing.k * period
    if tau is None:
        linear = isinstance(closing.family, LinearFamily)
        count, speed_count = (SETTINGS.phases, SETTINGS.speeds) if linear else SETTINGS.fewer
        phases = np.linspace(0, period, count, endpoint=False)
        fast = float(np.abs(acceleration(osc, phases)).max()) * span / n
        speeds = fast * np.concatenate([SETTINGS.weak, np.geomspace(1e-3, 1, speed_count)])
        tau, v = (coordinates.ravel() for coordinates in np.meshgrid(phases, speeds))
    else:
        tau, v = np.asarray(tau, dtype=float), np.asarray(v, dtype=float)
    points = np.stack([tau, v], axis=1) if n == 1 else _flown(osc, tau, v, n, span)
    return np.concatenate([points, _grazes(closing)]) if n < 9 else points


def _flown(osc: Oscillator, tau: Array, v: Array, n: int, span: float) -> Array:
    """n impacts of the true map from each start; sequences that take far more or less than the span are left out."""
    times, speeds = [tau], [v]
    for _ in range(n):
        step = impact_map(osc, times[-1], speeds[-1], horizon=2 * span)
        good = np.isfinite(step.tau) & np.isfinite(step.v)
        times.append(np.where(good, step.tau, np.nan))
        speeds.append(np.where(good, step.v, 0.0))
        times[-1][~good], speeds[-1][~good] = 0.0, 0.0
    share = (times[-1] - times[0]) / span
    chosen = (share > SETTINGS.span[0]) & (share < SETTINGS.span[1])
    # the span is met by stretching the flights alike
    stretched = [times[0] + (phases - times[0]) / np.where(chosen, share, 1.0) for phases in times[:-1]]
    return np.stack([*stretched, *speeds[:-1]], axis=1)[chosen]


def _grazes(closing: Closing) -> Array:
    """Points of orbits with one impact less, and with an impact of no velocity at the lowest place of a flight."""
    n, k, points = closing.n, closing.k, list[Array]()
    if n == 1:
        for orbit in free_orbits(closing.family.osc, k, lowest_only=True):
            points += [np.array([float(tau), 0.0]) for tau in np.atleast_1d(orbit.tau)]
        return np.array(points).reshape(-1, 2)
    simpler = Closing(closing.family, n - 1, k)
    for point in closed_from(simpler, grid_of_starts(simpler)):
        for i, (time, height) in enumerate(simpler.heights(point)):
            if np.isfinite(height):
                times = np.insert(point[: n - 1], i + 1, point[i] + time)
                speeds = np.insert(point[n - 1 :], i + 1, 0.0)
                points.append(np.concatenate([times, speeds]))
    return np.array(points).reshape(-1, 2 * n)


def conditions(closing: Closing, points: Array) -> tuple[Array, Array]:
    """Miss and slope of many points, shapes (m, 2n) and (m, 2n, 2n), as `Closing.at` gives them; nan where T <= 0."""
    osc, n, m = closing.family.osc, closing.n, len(points)
    period = closing.family.period({}).value
    times = np.concatenate([points[:, :n], points[:, :1] + closing.k * period], axis=1)
    launches, spans, speeds = (block.ravel() for block in (times[:, :n], np.diff(times, axis=1), points[:, n:]))
    launches = launches - period * np.floor(launches / period)
    spans = np.where(spans > 0, spans, np.nan)
    position, speed, bend = ends(osc, launches, speeds, spans)
    by_v, by_v_dot, by_tau, by_tau_dot = variations(osc, launches, speeds, spans).T
    with np.errstate(all="ignore"):
        # the same blocks as `Closing.at`, for many points at once
        factor = rebound_slope(osc, speed)
        miss = np.empty((m, 2 * n))
        miss[:, ::2] = position.reshape(m, n)
        miss[:, 1::2] = evaluate(osc.rho(), {"v": speed}, DOUBLES).reshape(m, n) - np.roll(points[:, n:], -1, axis=1)
    slope = np.zeros((m, 2 * n, 2 * n))
    parts = [
        block.reshape(m, n)
        for block in (by_tau - speed, factor * (by_tau_dot - bend), by_v, factor * by_v_dot, speed, factor * bend)
    ]
    for i in range(n):
        after = (i + 1) % n
        slope[:, 2 * i, i] += parts[0][:, i]
        slope[:, 2 * i + 1, i] += parts[1][:, i]
        slope[:, 2 * i, n + i] += parts[2][:, i]
        slope[:, 2 * i + 1, n + i] += parts[3][:, i]
        slope[:, 2 * i, after] += parts[4][:, i]
        slope[:, 2 * i + 1, after] += parts[5][:, i]
        slope[:, 2 * i + 1, n + after] -= 1.0
    return miss, slope


def closed_from(closing: Closing, points: Array) -> list[Array]:
    """The solutions that Newton's method finds from these points, each once, virtual ones too."""
    n, period = closing.n, closing.family.period({}).value
    solutions: list[Array] = []
    at = points
    for count in range(SETTINGS.rounds):
        if not len(at):
            break
        miss, slope = conditions(closing, at)
        good = np.isfinite(miss).all(axis=1) & np.isfinite(slope).all(axis=(1, 2))
        at, miss, slope = at[good], miss[good], slope[good]
        step, regular = _solved(slope, miss)
        at, step = at[regular], step[regular]
        fast = np.maximum(np.abs(at[:, n:]).max(axis=1, initial=0.0), 1e-300)
        with np.errstate(over="ignore"):  # a start with v = 0
            size = np.maximum(np.abs(step[:, :n]).max(axis=1) / period, np.abs(step[:, n:]).max(axis=1) / fast)
        if count == 0 and isinstance(closing.family, SteppedFamily) and len(at) > SETTINGS.kept:
            best = np.argsort(size, kind="stable")[: SETTINGS.kept]
            at, step, size = at[best], step[best], size[best]
        longest = np.abs(step[:, :n]).max(axis=1) / period
        at = at - step * np.minimum(1.0, SETTINGS.longest / np.maximum(longest, 1e-300))[:, None]
        arrived = size < SETTINGS.arrived
        solutions += list(at[arrived])
        at = at[~arrived & (size < (1e6 if count < SETTINGS.slow[0] else SETTINGS.slow[1]))]
    return _distinct(solutions, n, period)


def _solved(slope: Array, miss: Array) -> tuple[Array, Array]:
    """Newton's steps, and which of them there are."""
    size = np.abs(slope).max(axis=(1, 2))
    # powers of two round nothing, so that det and solve see the same pivots: solve raises where one is 0
    scale = np.exp2(np.floor(np.log2(np.where(size > 0, size, 1.0))))[:, None, None]
    regular = (size > 0) & (np.abs(np.linalg.det(slope / scale)) > 1e-25)
    steps = np.full(miss.shape, np.nan)
    if regular.any():
        scaled = miss[:, :, None] / scale
        steps[regular] = np.linalg.solve((slope / scale)[regular], scaled[regular])[:, :, 0]
    return steps, regular & np.isfinite(steps).all(axis=1)


def _distinct(points: list[Array], n: int, period: float) -> list[Array]:
    """Each point once, its first phase within a period."""
    kept: dict[tuple[int, ...], Array] = {}
    for point in points:
        moved = point.copy()
        moved[:n] -= period * np.floor(moved[0] / period)
        fast = max(float(np.abs(moved[n:]).max()), 1e-300)
        rounded = np.concatenate([moved[:n] / period, moved[n:] / fast, [np.log(fast)]]) / SETTINGS.apart
        kept.setdefault(tuple(np.rint(rounded).astype(np.int64).tolist()), moved)
    return list(kept.values())
