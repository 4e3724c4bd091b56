"""A kind of event: what the walk along a branch, event curves, proofs and pictures take from it.

Its tests are computed from an orbit of a branch or of an event curve, `OrbitState`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from singimpact.algebra.numbers import Array

if TYPE_CHECKING:
    from singimpact.branches.closing import Characteristic, Loop, Turn
    from singimpact.branches.orbits import PeriodicOrbit
    from singimpact.branches.solutions import AnyClosing


# A forward difference along the tangent, in scaled unknowns: rates then have a relative error of 1e-6 or less.
NUDGE = 1e-6


class Test(NamedTuple):
    """A test function at a point of a branch: it changes sign at an event.

    Parameters
    ----------
    value, rate : the function and its derivative by the arc length of the branch, in scaled unknowns.
    share : of a minimum of x - c the part of the flight time at which it lies; else nan.
    size : of a difference of two terms the sum of their sizes; else nan.
    """

    value: float
    rate: float
    share: float = np.nan
    size: float = np.nan

    @property
    def is_minimum(self) -> bool:
        """Whether it is the height of a minimum of a flight, which may begin or end along the branch."""
        return bool(np.isfinite(self.share))


@dataclass
class OrbitState:
    """Closing conditions at a point, and their derivatives in scaled unknowns.

    Parameters
    ----------
    closing : of the orbits. scales : of the unknowns. at : the point.
    tangent : the unit tangent of the branch in scaled unknowns; empty on an event curve.
    impact : of an event curve, the impact or flight that touches the wall.
    """

    closing: AnyClosing
    scales: Array
    at: Array
    tangent: Array = field(default_factory=lambda: np.zeros(0))
    impact: int = 0

    @cached_property
    def loop(self) -> Loop:
        """The closing conditions."""
        return self.closing.at(self.at)

    @cached_property
    def turns(self) -> list[list[Turn]]:
        """Times and heights of the local minima of each flight."""
        return self.closing.minima(self.at)

    @property
    def direction(self) -> Array:
        """The tangent in the unknowns themselves."""
        return self.tangent * self.scales

    @cached_property
    def slopes(self) -> Array:
        """The derivatives of the closing conditions by scaled unknowns."""
        return self.loop.slope * self.scales

    @cached_property
    def is_finite(self) -> bool:
        """Whether no flight has left the domain of f or g."""
        return bool(np.isfinite(self.slopes).all())

    @cached_property
    def characteristic(self) -> Characteristic:
        """The polynomial whose zeros are the multipliers."""
        return self.loop.characteristic()

    @cached_property
    def beside(self) -> OrbitState:
        """The state a little further along the tangent."""
        moved = OrbitState(self.closing, self.scales, self.at + NUDGE * self.direction, self.tangent)
        if moved.is_finite:
            right = np.zeros(len(self.tangent))
            right[-1] = 1.0
            try:
                tangent = np.linalg.solve(np.vstack([moved.slopes, self.tangent]), right)
            except np.linalg.LinAlgError:
                tangent = self.tangent
            moved.tangent = tangent / np.linalg.norm(tangent)
        return moved

    def determinant(self, multiplier: float) -> float:
        """det J(mu) of scaled unknowns, which vanishes where mu is a multiplier."""
        size = 2 * self.closing.n
        square = self.loop.at_multiplier(multiplier) * self.scales[:size]
        return float(np.linalg.det(square / np.abs(self.scales[: self.closing.n].max())))


def difference(value: Callable[[OrbitState], float], state: OrbitState, size: float = np.nan) -> Test:
    """A test function and its rate along the branch; nan where a flight has left the domain of f or g."""
    here, later = (value(at) if at.is_finite else np.nan for at in (state, state.beside))
    return Test(here, (later - here) / NUDGE, size=size)


Indexed = Iterator[tuple[int, int, Test]]  # impact or flight, which of its minima, and the test there


class CurveLook(NamedTuple):
    """Names of the colour and the line style of a curve of events, and its width."""

    color: str
    style: str
    width: float


class EventKind(Protocol):
    """The differences between kinds of events; a method that a kind does not have does what most kinds do.

    Attributes
    ----------
    name : as `Event.kind` has it. word : the field's. marker : of matplotlib.
    look : of its curves in two numbers; None: it is not followed as a curve.
    touches : the orbit touches the wall: multipliers are infinite and first hits jump, so a branch has no point there.
    at_impact : it is that of one impact, whose velocity vanishes.
    conserved : its test is 0, up to rounding, all along a branch of a model without losses.
    may_meet : another branch of such orbits may cross where its test changes sign.
    is_located : where its test changes sign, and no other branch crosses, it takes place.
    is_class : whether an event that was classified may have this name.
    is_own : a user defines it: its test may jump, and is not stored.
    proof : what a proof of such an event shows, in a sentence; empty: no proof covers it.
    gentle : the sign of the first coefficient of its normal form where it is supercritical; 0: it has none.
    """

    name: str
    word: str
    marker: str
    look: CurveLook | None = None
    touches: bool = False
    at_impact: bool = False
    conserved: bool = False
    may_meet: bool = False
    is_located: bool = True
    is_class: bool = True
    is_own: bool = False
    proof: str = ""
    gentle: int = 0

    @property
    def label(self) -> str:
        """The name beside its mark in a picture."""
        return self.name

    # ---- along a branch

    def tests(self, state: OrbitState) -> Indexed:  # noqa: ARG002
        """Its test functions at a point of a branch, with their rates; none where other tests lead to it."""
        return iter(())

    def value(self, state: OrbitState, impact: int) -> float:  # noqa: ARG002
        """One of its test functions, which is no minimum of a flight, at a point of the branch."""
        return np.nan

    def occurs(self, loop: Loop) -> bool:  # noqa: ARG002
        """Whether a zero of the test is an event."""
        return True

    def remark(self, orbit: PeriodicOrbit, time: float, parameter: float) -> str:  # noqa: ARG002
        """A sentence about what is special at an event; `time` is that of the impact."""
        return ""

    def doubt(self, closing: AnyClosing, at: Array) -> str:  # noqa: ARG002
        """A sentence about what a test that touches 0, up to rounding, leaves open."""
        return f"the test of a {self.name} comes so near to 0 that two may lie there, or none: give a smaller step="

    # ---- at an event

    def others(self, orbit: PeriodicOrbit, over: str, parameter: float) -> list[PeriodicOrbit]:  # noqa: ARG002
        """Orbits of the other branches that meet the branch there."""
        return []

    def touching(self, closing: AnyClosing, orbit: PeriodicOrbit) -> int:  # noqa: ARG002
        """The index of the impact or flight that touches the wall; 0 where none is singled out."""
        return 0

    def graze_time(self, orbit: PeriodicOrbit) -> float:  # noqa: ARG002
        """When the orbit touches the wall; nan where it does not."""
        return np.nan

    # ---- as a curve in two numbers

    def equation(self, state: OrbitState) -> float:
        """The function that vanishes on the curve, beside the closing conditions."""
        return self.value(state, 0)

    def gradient(self, state: OrbitState) -> Array | None:  # noqa: ARG002
        """The derivative of the equation by each unknown; None: by differences."""
        return None

    def degenerate(self, state: OrbitState, gradient: Callable[[], Array]) -> dict[str, float]:  # noqa: ARG002
        """Test functions of points of codimension two, by their names; `gradient` computes that of the equation."""
        return grazes(state, "graze")

    # ---- in a proof

    def of_return_map(self, total: Any) -> Any:  # noqa: ARG002
        """The function of the derivative M of the return map that vanishes at the event, in balls."""
        raise ArithmeticError(f"no proof covers a {self.name}")

    def rate_of_return_map(self, total: Any, change: Any) -> Any:  # noqa: ARG002
        """The rate of `of_return_map` where M changes at a rate."""
        return self.of_return_map(total)

    def refusal(self, total: Any) -> str:  # noqa: ARG002
        """Why a zero of `of_return_map` is not shown to be the event, or nothing."""
        return ""


def grazes(state: OrbitState, name: str, but: int | None = None) -> dict[str, float]:
    """The velocities of the impacts but one, by a name and the index of the impact."""
    n = state.closing.n
    impacts = () if state.closing.plastic else range(n)
    return {f"{name} {i}": float(state.at[n + i]) for i in impacts if i != but}


# ---- kinds that the derivatives of the closing conditions decide: conditions on the return map


class ReturnMapKind(EventKind):
    """A kind with one test function at each orbit, whose rate along the branch is a difference."""

    def test(self, state: OrbitState) -> float:  # noqa: ARG002
        """The test function: 0 at an event."""
        raise ArithmeticError(f"a {self.name} has no test of its own")

    def size(self, state: OrbitState) -> float:  # noqa: ARG002
        """The sum of the sizes of its terms, where it is a difference that may be rounding alone; else nan."""
        return np.nan

    def tests(self, state: OrbitState) -> Indexed:
        """The test and its rate; nan where a flight has left the domain of f or g."""
        yield 0, 0, difference(self.test, state, self.size(state))

    def value(self, state: OrbitState, impact: int) -> float:  # noqa: ARG002
        """The test function."""
        return self.test(state)
