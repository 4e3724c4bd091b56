"""Orbits of other branches that meet a branch at an event."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.branches.closing import Closing
from singimpact.branches.continuation import Curve, Point
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.solutions import AnyClosing, closing_of, orbit_of, orbit_period
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE

Array = np.ndarray[Any, Any]
APART = 1e-3
"""Distance from a doubling at which the doubled orbit is given, in scaled unknowns."""


def states_of(orbit: PeriodicOrbit) -> Array:
    return np.concatenate([np.asarray(orbit.tau, dtype=float), np.asarray(orbit.v, dtype=float)])


def _closed(event: PeriodicOrbit, n: int, point: Array) -> PeriodicOrbit:
    """The orbit next to a point at the event's model; the event itself closes it already, up to rounding."""
    closing = closing_of(event.oscillator, n, event.k, ())
    assert isinstance(closing, Closing)
    found = closing.newton(point)
    return orbit_of(closing, point if found is None else found[0])


def without_impact(orbit: PeriodicOrbit) -> PeriodicOrbit:
    n = int(orbit.n)
    times, speeds = np.asarray(orbit.tau, dtype=float), np.asarray(orbit.v, dtype=float)
    at = int(np.argmin(np.abs(speeds)))  # an orbit begins at its least phase, not where its branch did
    if n == 1:
        osc = orbit.oscillator
        closing = closing_of(osc, 0, orbit.k, ())
        end = closing.family.end({CLEARANCE: _wall(osc)}, float(times[0]), 0.0, -float(times[0]))
        return orbit_of(closing, np.array([_wall(osc) + end.place[0], end.place[1]]))
    others = [(at + 1 + i) % n for i in range(n - 1)]
    span = orbit.k * orbit_period(orbit)
    later = [times[i] + (span if i <= at else 0.0) for i in others]
    return _closed(orbit, n - 1, np.concatenate([later, speeds[others]]))


def with_impact(orbit: PeriodicOrbit) -> PeriodicOrbit:
    n = int(orbit.n)
    times, speeds = np.asarray(orbit.tau, dtype=float), np.asarray(orbit.v, dtype=float)
    if n == 0:
        return _closed(orbit, 1, np.array([times[0], 0.0]))
    flight, time = touching_flight(orbit)
    return _closed(
        orbit,
        n + 1,
        np.concatenate([np.insert(times, flight + 1, times[flight] + time), np.insert(speeds, flight + 1, 0.0)]),
    )


def touching_flight(orbit: PeriodicOrbit) -> tuple[int, float]:
    """The flight of a hidden impact and the time from its launch: the one with the least height, wherever it begins."""
    closing = closing_of(orbit.oscillator, int(orbit.n), orbit.k, ())
    heights = closing.heights(states_of(orbit))
    flight = int(np.argmin([abs(height) for _, height in heights]))
    return flight, heights[flight][0]


def doubled(orbit: PeriodicOrbit, over: str, parameter: float) -> list[PeriodicOrbit]:
    """The orbit of twice the period next to a doubling, by one step along the vector that -1 belongs to."""
    n = int(orbit.n)
    if n == 0:
        return []
    once = closing_of(orbit.oscillator, n, orbit.k, ())
    at = states_of(orbit)
    loop = once.at(at)
    # the eigenvector of -1: the doubled orbit alternates along it
    vector = np.linalg.svd(loop.slope[:, : 2 * n] - 2 * loop.wrap)[2][-1]
    osc = orbit.oscillator
    twice: AnyClosing = closing_of(osc, 2 * n, 2 * orbit.k, (over,))
    span = orbit.k * orbit_period(orbit)
    point = np.concatenate([at[:n], at[:n] + span, at[n:], at[n:], [parameter]])
    moved = np.concatenate([vector[:n], -vector[:n], vector[n:], -vector[n:], [0.0]])
    scales = twice.scales(point)
    scales[-1] = max(abs(parameter), 1e-3)
    curve = Curve(Equations(twice), scales, 10 * APART)
    tangent = moved / scales
    start = Point(point, tangent / np.linalg.norm(tangent))
    corrected = curve.beyond(start, APART)
    return [] if corrected is None else [orbit_of(twice, corrected[0].at)]


class Equations:
    """Closing conditions as equations of a curve."""

    def __init__(self, closing: AnyClosing) -> None:
        self.closing = closing

    def equations(self, point: Array) -> tuple[Array, Array]:
        """Values and derivatives."""
        loop = self.closing.at(point)
        return loop.miss, loop.slope


def _wall(osc: Oscillator) -> float:
    return as_float(osc.clearance)
