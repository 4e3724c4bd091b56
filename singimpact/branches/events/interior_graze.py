"""Interior grazes, called hidden impacts: a flight touches the wall between its impacts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from singimpact.branches.events.graze import TouchingKind, heights
from singimpact.branches.events.kind import CurveLook, Indexed
from singimpact.branches.events.orbit_state import OrbitState

if TYPE_CHECKING:
    from singimpact.branches.orbits import PeriodicOrbit
    from singimpact.branches.solutions import AnyClosing


class InteriorGraze(TouchingKind):
    """Interior graze: x - c vanishes at a local minimum of a flight."""

    name = "hidden impact"
    word = "interior graze (hidden impact)"
    marker = "v"
    look = CurveLook("green", "dash-dot", 1.6)

    def tests(self, state: OrbitState) -> Indexed:
        """The heights of the minima of all flights of an orbit with impacts."""
        return heights(state) if state.closing.n else iter(())

    def touching(self, closing: AnyClosing, orbit: PeriodicOrbit) -> int:
        """The flight whose lowest place is nearest to the wall."""
        from singimpact.branches.branch_points import states_of
        from singimpact.branches.solutions import closing_of

        plain = closing_of(orbit.oscillator, closing.n, closing.k, ())
        return int(np.argmin([abs(height) for _, height in plain.heights(states_of(orbit))]))

    def equation(self, state: OrbitState) -> float:
        """x - c at the lowest place of the flight."""
        return state.closing.heights(state.at)[state.impact][1]


INTERIOR_GRAZE = InteriorGraze()
