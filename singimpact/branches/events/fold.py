"""Folds: two orbits meet, and the parameter turns back along the branch."""

from typing import Any

import numpy as np

from singimpact.branches.events.kind import CurveLook, MultiplierKind
from singimpact.branches.events.orbit_state import OrbitState


class Fold(MultiplierKind):
    """Saddle-node bifurcation: a multiplier is 1.

    Its test is the component of the tangent by the parameter; on a curve, and in a proof, 1 - t + d.
    """

    name = "fold"
    word = "fold (saddle-node bifurcation)"
    marker = "o"
    look = CurveLook("blue", "solid", 2.8)
    may_meet = True
    multiplier = 1.0
    proof = "the orbits form one curve, on which the parameter turns back once: a multiplier is 1"

    def test(self, state: OrbitState) -> float:
        """The last component of the tangent."""
        return float(state.tangent[-1])

    def degenerate(self, state: OrbitState, gradient: Any) -> dict[str, float]:
        """A cusp, a doubling at the fold, an impact that grazes."""
        size = 2 * state.closing.n
        # at a fold the conditions have a null vector; at a cusp it is tangent to the curve of folds (Kuznetsov, ch. 8)
        vector = np.linalg.svd(state.loop.slope[:, :size] * state.scales[:size])[2][-1]
        slope = gradient()[:size] * state.scales[:size]
        turned = vector if vector[int(np.argmax(np.abs(vector)))] > 0 else -vector
        tests = {"cusp": float(slope @ turned), "fold and doubling": state.determinant(-1.0)}
        return tests | super().degenerate(state, gradient)


FOLD = Fold()
