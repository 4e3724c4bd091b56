"""Test functions of events at a point of a branch, with their rates along it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import copysign
from typing import Any, NamedTuple

import numpy as np

from singimpact.branches.closing import Loop, Turn
from singimpact.branches.continuation import Point
from singimpact.branches.events.kind import EventKind
from singimpact.branches.events.orbit_state import NUDGE, OrbitState, Test
from singimpact.branches.solutions import AnyClosing

Array = np.ndarray[Any, Any]
LEAST, RESTING = 1e-300, 1e-8
"""In place of 0 at the first point; its product with another value is not 0. Of a test that is a difference of two
terms which are equal in models without losses a part of these terms."""
REMEMBERED = 8
"""Points whose closing conditions and minima are remembered."""


class Key(NamedTuple):
    """Which test function: the kind of the event, impact or flight, and which of its minima."""

    kind: EventKind
    impact: int
    number: int


Tests = dict[Key, Test]


@dataclass
class EventTests:
    """Test functions of the events of a branch.

    Parameters
    ----------
    closing : of its orbits. scales : of its unknowns. kinds : of events.
    """

    closing: AnyClosing
    scales: Array
    kinds: Sequence[EventKind]
    _loops: dict[bytes, Loop] = field(default_factory=dict)
    _minima: dict[bytes, list[list[Turn]]] = field(default_factory=dict)

    def state(self, point: Point) -> OrbitState:
        """A point of the branch, with what the tests are computed from."""
        state = OrbitState(self.closing, self.scales, point.at, point.tangent)
        state.loop = self.loop(point.at)  # computed once at a point, whatever its tangent is
        return state

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

    def at(self, point: Point, stored: Tests | None = None) -> Tests:
        """Every test function at a point of the branch; those of a user alone where the others are stored."""
        kinds = [kind for kind in self.kinds if stored is None or kind.is_own]
        if not kinds:
            return stored or {}
        state = self.state(point)
        state.turns = self.minima(point.at)
        tests = {Key(kind, i, j): test for kind in kinds for i, j, test in kind.tests(state)}
        return (stored or {}) | tests

    def value(self, kind: EventKind, impact: int, point: Point) -> float:
        """One test function, which is no minimum of a flight, at a point of the branch."""
        return kind.value(self.state(point), impact)

    def leaving(self, point: Point) -> Tests:
        """Every test function at the first point of a branch; one that is 0 there has the sign from which it comes."""
        tests = self.at(point)
        for key, test in tests.items():
            # this test is 0 up to rounding of its terms; without losses it is 0 everywhere, and its rate too
            conserved = key.kind.conserved
            zero = RESTING * test.size if conserved else LEAST
            if abs(test.value) < zero and (not conserved or abs(test.rate) > NUDGE * test.size):
                tests[key] = test._replace(value=-copysign(zero, test.rate))
        return tests
