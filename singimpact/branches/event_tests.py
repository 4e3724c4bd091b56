"""Test functions of events at a point of a branch, with their rates along it."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import copysign
from typing import Any, NamedTuple

import numpy as np

from singimpact.branches.closing import Loop, Turn
from singimpact.branches.continuation import Point
from singimpact.branches.solutions import AnyClosing

Array = np.ndarray[Any, Any]
Key = tuple[str, int, int]
"""Kind of the event, impact or flight, and which of its minima."""
NUDGE = 1e-6
"""A forward difference along the tangent, in scaled unknowns: rates then have a relative error of 1e-6 or less."""
LEAST, RESTING = 1e-300, 1e-8
"""In place of 0 at the first point; its product with another value is not 0. Of the torus test a part of its terms."""
REMEMBERED = 8
"""Points whose closing conditions and minima are remembered."""


class Test(NamedTuple):
    """A test function at a point of a branch: it changes sign at an event.

    Parameters
    ----------
    value, rate : the function and its derivative by the arc length of the branch, in scaled unknowns.
    share : of a minimum of x - c the part of the flight time at which it lies; of a Neimark-Sacker test the size of its
        two terms; else nan.
    """

    value: float
    rate: float
    share: float = np.nan


Tests = dict[Key, Test]


@dataclass
class EventTests:
    """Test functions of the events of a branch.

    Parameters
    ----------
    closing : of its orbits. scales : of its unknowns.

    Notes
    -----
    With J(mu) of `closing.Loop`, u the unit tangent and d a determinant:

        fold              u of the parameter
        period-doubling   d(J(-1))
        torus             the determinant of the return map less 1, times the last coefficient of d(J(mu))
        branch point      d(J and its derivative by the parameter, above u)
        graze             v of an impact; of an orbit without impact as a hidden impact
        hidden impact     x - c at a local minimum of a flight
    """

    closing: AnyClosing
    scales: Array
    _loops: dict[bytes, Loop] = field(default_factory=dict)
    _minima: dict[bytes, list[list[Turn]]] = field(default_factory=dict)

    def loop(self, at: Array) -> Loop:
        """The closing conditions at a point."""
        loop: Loop = self._remembered(self._loops, at, self.closing.at)
        return loop

    def minima(self, at: Array) -> list[list[Turn]]:
        """Times and heights of the local minima of each flight."""
        turns: list[list[Turn]] = self._remembered(self._minima, at, self.closing.minima)
        return turns

    def heights(self, at: Array) -> list[float]:
        """The height of the lowest minimum of each flight; inf where there is none."""
        return [min((height for _, height in turns), default=np.inf) for turns in self.minima(at)]

    def _remembered(self, store: dict[bytes, Any], at: Array, compute: Any) -> Any:
        key = at.tobytes()
        if key not in store:
            while len(store) >= REMEMBERED:
                store.pop(next(iter(store)))
            store[key] = compute(at)
        return store[key]

    def at(self, point: Point) -> Tests:
        """Every test function at a point of the branch."""
        direction = point.tangent * self.scales
        beside = point.at + NUDGE * direction
        here = self._smooth(self.loop(point.at), point.tangent, point.tangent)
        later = self._smooth(self.closing.at(beside), None, point.tangent)
        tests = {(kind, 0, 0): Test(here[kind], (later[kind] - here[kind]) / NUDGE) for kind in SMOOTH}
        zero, two = here["zero"], here["two"]
        tests["torus", 0, 0] = tests["torus", 0, 0]._replace(share=abs(zero) + abs(two))
        n = self.closing.n
        for i in range(n):
            tests["graze", i, 0] = Test(float(point.at[n + i]), float(direction[n + i]))
        for i, turns in enumerate(self.minima(point.at)):
            span = self.closing.span(point.at, i)
            for j, (time, height) in enumerate(turn for turn in turns if np.isfinite(turn[1])):
                rate = self.closing.rise(point.at, direction, i, time)
                tests["hidden impact" if n else "graze", i, j] = Test(height, rate, time / span)
        return tests

    def leaving(self, point: Point) -> Tests:
        """Every test function at the first point of a branch; one that is 0 there has the sign from which it comes."""
        tests = self.at(point)
        for key, test in tests.items():
            # the torus test is 0 up to rounding of its terms; without losses it is 0 everywhere, and its rate too
            zero = RESTING * test.share if key[0] == "torus" else LEAST
            if abs(test.value) < zero and (key[0] != "torus" or abs(test.rate) > NUDGE * test.share):
                tests[key] = test._replace(value=-copysign(zero, test.rate))
        return tests

    def _smooth(self, loop: Loop, tangent: Array | None, before: Array) -> dict[str, float]:
        """Tests that depend on the derivatives of the closing conditions alone."""
        slopes = loop.slope * self.scales
        if not np.isfinite(slopes).all():
            return dict.fromkeys((*SMOOTH, "zero", "two"), np.nan)
        if tangent is None:
            right = np.zeros(len(before))
            right[-1] = 1.0
            try:
                tangent = np.linalg.solve(np.vstack([slopes, before]), right)
            except np.linalg.LinAlgError:
                tangent = before
            tangent = tangent / np.linalg.norm(tangent)
        multipliers = loop.characteristic()
        crossing = float(np.linalg.det(np.vstack([slopes, tangent])))
        return {"fold": float(tangent[-1]), "period-doubling": multipliers.doubling, "torus": multipliers.torus,
                "branch point": crossing, "zero": multipliers.zero, "two": multipliers.two}  # fmt: skip


SMOOTH = ("fold", "period-doubling", "torus", "branch point")
