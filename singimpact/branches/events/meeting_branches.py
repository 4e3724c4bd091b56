"""Branch points: the branch meets another branch of orbits of as many impacts and periods."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.events.kind import CurveLook, EventKind, OrbitState, ReturnMapKind

if TYPE_CHECKING:
    from singimpact.branches.solutions import AnyClosing

# Parts of an orbit that differ by less, in scaled unknowns, where the branch comes near an orbit that repeats them.
ALIKE = 1e-3


class BranchPointKind(ReturnMapKind):
    """A branch point whose other branch was not reached.

    Its test is the determinant of the closing conditions with their derivative by the parameter, above the tangent.
    """

    name = "branch point"
    word = "branch point"
    marker = "*"
    may_meet = True
    is_located = is_class = False

    def test(self, state: OrbitState) -> float:
        """The determinant of the derivatives above the tangent."""
        return float(np.linalg.det(np.vstack([state.slopes, state.tangent])))

    def doubt(self, closing: AnyClosing, at: Array) -> str:
        """Near an orbit that repeats a shorter one: which orbits it meets."""
        share = repeats(closing, at)
        if share == 1:
            return super().doubt(closing, at)
        n, k = closing.n // share, closing.k // share
        return f"meets the ({n}, {k}) orbits, of which a multiplier to the power {share} is 1"


class Pitchfork(EventKind):
    """Pitchfork: one of two branches turns back where they cross, such as doubled orbits where they begin."""

    name = "pitchfork"
    word = "pitchfork bifurcation"
    marker = "P"
    look = CurveLook("purple", "dashes", 2.4)

    def equation(self, state: OrbitState) -> float:
        """det J(-1) of half the orbit, or of half a symmetric one."""
        return state.determinant(-1.0)

    def degenerate(self, state: OrbitState, gradient: Callable[[], Array]) -> dict[str, float]:
        """A fold at the pitchfork, an impact that grazes."""
        return {"fold and pitchfork": state.determinant(1.0)} | super().degenerate(state, gradient)


class Transcritical(EventKind):
    """Transcritical bifurcation: two branches cross, and neither turns back."""

    name = "transcritical"
    word = "transcritical bifurcation"
    marker = "X"


BRANCH_POINT, PITCHFORK, TRANSCRITICAL = BranchPointKind(), Pitchfork(), Transcritical()


def repeats(closing: AnyClosing, at: Array, alike: float = ALIKE, fast: float | None = None) -> int:
    """The number of times that an orbit with impacts repeats one of fewer impacts and periods, about.

    Parameters
    ----------
    alike : parts of the orbit that differ by less, of a period and of `fast`, are equal. fast : of velocities.
    """
    n, k = closing.n, closing.k
    if not n:
        return 1
    period, times, speeds = closing.period(at), closing.times(at), at[n : 2 * n]
    fast = float(closing.scales(at)[n]) if fast is None else fast
    for share in range(n, 1, -1):
        m = n // share
        if n % share == 0 and k % share == 0 and closing.word[m:] == closing.word[: n - m]:
            late = np.abs(np.roll(times, -m) - times - k // share * period)[: n - m]
            if max(float(late.max()) / period, float(np.abs(np.roll(speeds, -m) - speeds).max()) / fast) < alike:
                return share
    return 1
