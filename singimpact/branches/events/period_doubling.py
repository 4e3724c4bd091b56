"""Period doublings (flip bifurcations): orbits of twice the period leave the branch."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from singimpact.branches.events.kind import CurveLook, MultiplierKind
from singimpact.branches.events.orbit_state import OrbitState

if TYPE_CHECKING:
    from singimpact.branches.orbits import PeriodicOrbit


class PeriodDoubling(MultiplierKind):
    """Flip bifurcation: a multiplier is -1.

    Its test is det J(-1) of `closing.Loop`; in a proof 1 + t + d.
    """

    name = "period-doubling"
    word = "period doubling (flip bifurcation)"
    label = "doubling"
    marker = "s"
    look = CurveLook("vermillion", "dashes", 1.8)
    multiplier = -1.0
    proof = (
        "the orbits form one curve, on which 1 + trace + determinant of the return map vanishes once, at a rate that "
        "is not 0: a multiplier is -1"
    )

    def test(self, state: OrbitState) -> float:
        """det J(-1)."""
        return state.characteristic.doubling

    def others(self, orbit: PeriodicOrbit, over: str, parameter: float) -> list[PeriodicOrbit]:
        """The orbit of 2n impacts in 2k periods next to the doubling."""
        from singimpact.branches.branch_points import doubled

        return doubled(orbit, over, parameter)

    def degenerate(self, state: OrbitState, gradient: Any) -> dict[str, float]:
        """A fold at the doubling, an impact that grazes."""
        return {"fold and doubling": state.determinant(1.0)} | super().degenerate(state, gradient)


PERIOD_DOUBLING = PeriodDoubling()
