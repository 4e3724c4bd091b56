"""Grazes and interior grazes: the orbit touches the wall with no velocity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from singimpact.branches.events.kind import EventKind, Indexed
from singimpact.branches.events.orbit_state import OrbitState, Test

if TYPE_CHECKING:
    from singimpact.branches.orbits import PeriodicOrbit


class TouchingKind(EventKind):
    """A kind at which the orbit touches the wall; a zero of smooth equations, which Krawczyk's operator proves."""

    touches = True
    proof = "an orbit that touches the wall in the point tau[0], where a_c > 0, and is above it between its impacts"

    def others(self, orbit: PeriodicOrbit, over: str, parameter: float) -> list[PeriodicOrbit]:  # noqa: ARG002
        """The orbit with an impact where it touches the wall."""
        from singimpact.branches.switching import with_impact

        return [with_impact(orbit)]

    def graze_time(self, orbit: PeriodicOrbit) -> float:
        """The time of the lowest place, of an orbit without impact; else of the flight that touches the wall."""
        from singimpact.branches.switching import touching_flight

        times = np.asarray(orbit.tau, dtype=float)
        if not orbit.n:
            return float(times[0])
        flight, time = touching_flight(orbit)
        return float(times[flight] + time)


def heights(state: OrbitState) -> Indexed:
    """x - c at the local minima of each flight."""
    for i, turns in enumerate(state.turns):
        span = state.closing.span(state.at, i)
        for j, (time, height) in enumerate(turn for turn in turns if np.isfinite(turn[1])):
            rate = state.closing.rise(state.at, state.direction, i, time)
            yield i, j, Test(height, rate, time / span)
