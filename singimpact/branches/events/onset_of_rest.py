"""Orbits of restitution 0 of which an impact lies at a lift-off phase: the mass leaves at once, or rests before."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.events.kind import CurveLook, EventKind, Indexed
from singimpact.branches.events.orbit_state import NUDGE, OrbitState, Test
from singimpact.oscillator.wall_acceleration import acceleration

if TYPE_CHECKING:
    from singimpact.branches.orbits import PeriodicOrbit
    from singimpact.branches.solutions import AnyClosing


class OnsetOfRest(EventKind):
    """An impact that leaves no velocity where a_c = 0: where a_c < 0 the mass rests, and the orbit is another one."""

    name = "onset of rest"
    word = "onset of rest (an impact where a_c = 0, restitution 0)"
    marker = "d"
    look = CurveLook("black", "dash-dot", 1.4)

    def tests(self, state: OrbitState) -> Indexed:
        """a_c at each impact, where impacts leave no velocity."""
        for i in range(state.closing.n if state.closing.plastic else 0):
            here = self.value(state, i)
            later = self.value(state.beside, i) if state.beside.is_finite else np.nan
            yield i, 0, Test(here, (later - here) / NUDGE)

    def value(self, state: OrbitState, impact: int) -> float:
        """a_c at an impact."""
        return float(state.closing.pushes(state.at)[impact])

    def equation(self, state: OrbitState) -> float:
        """a_c at the impact of the event."""
        return self.value(state, state.impact)

    def touching(self, closing: AnyClosing, orbit: PeriodicOrbit) -> int:  # noqa: ARG002
        """The impact at which |a_c| is least."""
        times: Array = np.asarray(orbit.tau, dtype=float)
        return int(np.argmin(np.abs(acceleration(orbit.oscillator, times))))


ONSET_OF_REST = OnsetOfRest()
