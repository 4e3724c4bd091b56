"""An orbit of a branch or of an event curve, with what the tests of events are computed from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from singimpact.branches.closing import Characteristic, Loop, Turn
    from singimpact.branches.solutions import AnyClosing

Array = np.ndarray[Any, Any]
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
