"""Points of a branch in the user's cache, from which an interrupted branch continues."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact import cache
from singimpact.branches.event_tests import Key, Tests
from singimpact.branches.events.orbit_state import Test
from singimpact.branches.events.table import kind_of
from singimpact.store import cache_folder

Array = np.ndarray[Any, Any]
ABOVE = ("paper/", "documents/", "scenes/", "bench/", "cli/")
"""Sub-packages that no branch depends on."""
EVERY = 1.0
"""Seconds of work between two writings."""


@dataclass(frozen=True)
class KeptPoint:
    """A point with its computed values.

    Parameters
    ----------
    following : length of the next step. multipliers, visible : of the orbit.
    tests : of events, by kind, impact and number: the numbers of `orbit_state.Test`.
    """

    at: Array
    tangent: Array
    following: float
    multipliers: Array
    visible: bool
    tests: dict[str, tuple[float, ...]]

    def named_tests(self) -> Tests:
        """The test functions of events."""
        named = {}
        for name, numbers in self.tests.items():
            kind, impact, number = name.rsplit(" ", 2)
            named[Key(kind_of(kind), int(impact), int(number))] = Test(*numbers)
        return named


class KeptSide:
    """The points of one side of a branch, as far as they are known.

    Parameters
    ----------
    asked : texts and numbers that the side depends on; None: nothing is kept.
    """

    def __init__(self, asked: tuple[Any, ...] | None) -> None:
        self.place = (
            None if asked is None else cache_folder() / "branches" / f"{cache.key_of(asked, ('numpy',), ABOVE)}.points"
        )
        self.points: list[KeptPoint] = []
        content = None if self.place is None else cache.recall(self.place)
        if content is not None:
            self.points = list(cache.unpacked(content, (KeptPoint,)))
        self._written, self._new = time.monotonic(), False

    def add(self, at: tuple[Array, Array, float], row: tuple[Any, Array, bool], tests: Tests) -> None:
        """Keep one point more: `at`, tangent and next step; `row` with multipliers and whether it is visible."""
        if self.place is None:
            return
        named = {
            f"{kind.name} {impact} {number}": tuple(test)
            for (kind, impact, number), test in tests.items()
            if not kind.is_own
        }
        self.points.append(KeptPoint(*at, row[1], bool(row[2]), named))
        self._new = True
        if time.monotonic() - self._written > EVERY:
            self.write()

    def write(self) -> None:
        """Write the points to disk, if there are new ones."""
        if self.place is not None and self._new:
            cache.keep(self.place, cache.packed(self.points))
            self._written, self._new = time.monotonic(), False
