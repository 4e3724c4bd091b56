"""Neimark-Sacker bifurcations: two complex multipliers leave the unit disc, and an invariant torus begins."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from singimpact.branches.events.kind import ReturnMapKind, rate_of_determinant, trace
from singimpact.branches.events.orbit_state import OrbitState

if TYPE_CHECKING:
    from singimpact.branches.closing import Loop


class NeimarkSacker(ReturnMapKind):
    """Neimark-Sacker bifurcation: the product of two complex multipliers is 1.

    Its test is the determinant of the return map less 1, times the last coefficient of det J(mu); in a proof 1 - d,
    where t^2 < 4 d.
    """

    name = "torus"
    word = "Neimark-Sacker bifurcation (torus)"
    marker = "D"
    conserved = True
    proof = (
        "the orbits form one curve, on which the product of two complex multipliers passes 1 once, at a rate that is "
        "not 0"
    )

    def test(self, state: OrbitState) -> float:
        """The first coefficient of det J(mu) less the last."""
        return state.characteristic.torus

    def size(self, state: OrbitState) -> float:
        """The sum of the sizes of both coefficients."""
        return abs(state.characteristic.zero) + abs(state.characteristic.two)

    def occurs(self, loop: Loop) -> bool:
        """Where the multipliers are complex: real ones whose product is 1 are no bifurcation."""
        return loop.characteristic().are_complex

    def of_return_map(self, total: Any) -> Any:
        """1 - d."""
        return 1 - total.det()

    def rate_of_return_map(self, total: Any, change: Any) -> Any:
        """Its rate."""
        return -rate_of_determinant(total, change)

    def refusal(self, total: Any) -> str:
        """Whether the multipliers are shown to be complex."""
        return "" if trace(total) ** 2 < 4 * total.det() else "the multipliers are not shown to be complex"


NEIMARK_SACKER = NeimarkSacker()
