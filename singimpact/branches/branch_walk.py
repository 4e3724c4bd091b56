"""A branch of periodic orbits while it is followed: points, and the events between them.

Points are stored in the user's cache, so that an interrupted branch continues where it was.
"""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from singimpact import cache
from singimpact.algebra.numbers import Array
from singimpact.branches.branch_points import BranchPoint, branch_point
from singimpact.branches.closing import Closing
from singimpact.branches.continuation import Curve, Point
from singimpact.branches.events import KINDS, Event, EventKind, kind_of
from singimpact.branches.events.meeting_branches import PITCHFORK
from singimpact.branches.events.orbit_state import Test
from singimpact.branches.orbit_curve import SETTINGS, OrbitCurve
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.solutions import AnyClosing, orbit_of
from singimpact.branches.step_search import Crossing, EventTests, Key, StepSearch, Tests
from singimpact.inputs import InputError
from singimpact.store import cache_folder

# Sub-packages that no branch depends on: a change of theirs leaves stored points valid.
ABOVE = ("paper/", "documents/", "scenes/", "bench/", "cli/")
EVERY = 1.0  # seconds of work between two writings of points to the user's cache


class Row(NamedTuple):
    """A point of a branch with its computed values, or an event."""

    point: Point
    multipliers: Array
    visible: bool
    event: Event | None = None

    @property
    def listed(self) -> bool:
        """Whether it is a point of the branch; at touches multipliers are infinite and first hits jump."""
        return self.event is None or not self.event.described.touches


class BranchWalk(OrbitCurve):
    """A branch while it is followed.

    Parameters
    ----------
    closing : of its orbits. ends : of the interval. step : the largest one. most : points on either side. over : the
        name of the parameter. own : kinds of events of a user.
    """

    def __init__(
        self,
        closing: AnyClosing,
        ends: tuple[float, float],
        step: float,
        most: int,
        over: str,
        own: Sequence[EventKind] = (),
    ) -> None:
        super().__init__(closing, [ends], step, most)
        self.over, self.own = over, own

    def conditions(self, point: Array) -> tuple[Array, Array]:
        """The closing conditions."""
        loop = self.tests.loop(point)
        return loop.miss, loop.slope

    def rows(self, guess: Array) -> list[Row]:
        """The points of the branch in both directions from a guess, in the order of the branch."""
        self.scaled(guess)
        self.tests = EventTests(self.closing, self.scales, (*KINDS, *self.own))
        start = self.begin(guess)
        if start is None:
            raise InputError("the orbit does not solve its closing conditions: give one of osc.periodic(n, k)")
        return self.both_sides(start)

    # ---- one side

    def side(self, curve: Curve, start: Point, sign: float) -> list[Row]:
        # an event at the start itself belongs to the second side
        tests = self.tests.at(start) if sign < 0 else self.tests.leaving(start)
        self.kept = KeptSide(self._key(start))
        try:
            return self._followed(curve, start, tests)
        finally:
            self.kept.write()

    def _followed(self, curve: Curve, start: Point, before: Tests) -> list[Row]:
        rows: list[Row] = []
        for index, (here, length, after, is_last) in enumerate(self.steps(curve, start)):
            stored = self.kept.points[index] if index < len(self.kept.points) else None
            tests = self.tests.at(after, None if stored is None else stored.named_tests())
            rows += self._events(StepSearch(self.tests, curve, here, length), before, after, tests)
            rows.append(self.row(after) if stored is None else Row(after, stored.multipliers, stored.visible))
            if stored is None and not is_last:
                self.kept.add((after.at, after.tangent, curve.following), rows[-1][:3], tests)
            before = tests
        return rows

    def _key(self, start: Point) -> tuple[Any, ...] | None:
        """The key of a side in the cache; None for a linear model, whose branches take less than 1 s."""
        family = self.closing.family
        if family.linear:
            return None
        numbers = (start.at.tolist(), start.tangent.tolist(), self.ends[0], self.step, self.most)
        return family.osc, self.closing.word, self.closing.k, self.over, numbers

    def walked(self, curve: Curve, start: Point) -> Iterator[tuple[Point, float, Point]]:
        """The stored steps, then new ones."""
        here = start
        stored = list(self.kept.points)
        for point in stored:
            after = Point(point.at, point.tangent)
            yield here, float(here.tangent @ ((after.at - here.at) / curve.scales)), after
            here = after
        yield from curve.walk(here, self.most - len(stored), stored[-1].following if stored else None)

    # ---- a point: visible or not

    def row(self, point: Point, rounding: float = SETTINGS.touching, event: Event | None = None) -> Row:
        loop = self.tests.loop(point.at)
        with np.errstate(all="ignore"):
            product = partial(self.closing.product, point.at) if isinstance(self.closing, Closing) else None
            return Row(point, loop.multipliers(product), self._visible(point.at, rounding), event)

    def _visible(self, at: Array, rounding: float) -> bool:
        n = self.closing.n
        if n and float(at[n : 2 * n].min()) < -rounding:
            return False
        if self.closing.plastic and self.closing.pushes(at).min() < -rounding:  # the mass rests there
            return False
        return min(self.tests.heights(at)) >= -rounding

    # ---- events within a step

    def _events(self, search: StepSearch, before: Tests, after: Point, later: Tests) -> list[Row]:
        """The events of a step, and a point between those that are apart."""
        located: list[tuple[float, Row]] = []
        meetings: list[float] = []
        crossings = search.crossings(before, after, later)
        # at a pitchfork both of these may change sign: it is located first, and once
        for crossing in sorted(crossings, key=lambda crossing: crossing.kind.is_located):
            if crossing.kind.may_meet:
                meeting = branch_point(search, crossing)
                if meeting is not None:
                    if not any(abs(meeting.along - along) <= 1e-3 * search.length for along in meetings):
                        point = Point(meeting.at, crossing.low.point.tangent)
                        located.append((meeting.along, self._event_row(meeting.kind, point, other=meeting.other)))
                        self._met(meeting)
                    meetings.append(meeting.along)
                    continue
            if not crossing.kind.is_located:
                self.notes.append(f"a {crossing.kind.name} near {crossing.low.point.at[-1]:.9g} could not be located")
                continue
            row = self._crossed(search, crossing)
            if row is not None and not self._repeated(search, row, located):
                located.append(row)
        # test functions that touch 0
        for (kind, _, _), at in {key: (key, at) for key, at in search.doubts}.values():
            self.notes.append(f"near {self.over} = {at[-1]:.9g} {kind.doubt(self.closing, at)}")
        located.sort(key=lambda pair: pair[0])
        return self._separated(search, located)

    def _met(self, meeting: BranchPoint) -> None:
        """Note which orbits a doubled branch meets."""
        n, k = self.closing.n, self.closing.k
        if meeting.kind is PITCHFORK and meeting.other is not None and meeting.other.k < k:
            self.notes.append(f"meets the ({n // 2}, {k // 2}) orbits at their doubling, at {meeting.at[-1]:.12g}")

    def _repeated(self, search: StepSearch, row: tuple[float, Row], located: list[tuple[float, Row]]) -> bool:
        """Whether an orbit without impact touches the wall again, some periods of the forcing later."""
        if self.closing.n or row[1].listed:
            return False
        near = SETTINGS.together * search.length
        return any(abs(along - row[0]) <= near and not other.listed for along, other in located)

    def _separated(self, search: StepSearch, located: list[tuple[float, Row]]) -> list[Row]:
        rows: list[Row] = []
        for i, (along, row) in enumerate(located):
            if i and along - located[i - 1][0] > SETTINGS.together * search.length:
                between = search.curve.beyond(search.here, (along + located[i - 1][0]) / 2)
                rows += [] if between is None else [self.row(between[0])]
            rows.append(row)
        return rows

    def _crossed(self, search: StepSearch, crossing: Crossing) -> tuple[float, Row] | None:
        """The event at a change of sign; None where it is none of an orbit."""
        root = search.located(crossing)
        kind, impact, _ = crossing.keys[0]
        if root is None:
            self.notes.append(f"a {kind.name} near {crossing.low.point.at[-1]:.9g} could not be located")
            return None
        along, point = root
        if not kind.occurs(self.tests.loop(point.at)):
            return None
        jump = search.jump(crossing, along) if kind.is_own else None
        if jump is not None:
            self.notes.append(
                f"{kind.name} jumps from {jump[0]:.6g} to {jump[1]:.6g} near {self.over} = "
                f"{point.at[-1]:.9g}: this change of sign is not a zero"
            )
            return None
        time = np.nan
        if crossing.ends[0].is_minimum:
            turn = search.turn(crossing, along, point)
            size = max(abs(test.value) for test in crossing.ends)
            # a minimum that is not the lowest of its flight has its zero behind the wall
            lowest = turn is not None and turn[1] - self.tests.heights(point.at)[impact] <= SETTINGS.located * size
            if not (lowest and self._launched(point)) or turn is None:
                return None
            time = turn[0]
        return along, self._event_row(kind, point, impact, np.nan if kind.at_impact else time)

    def _launched(self, point: Point) -> bool:
        """Whether every flight begins with a velocity: flights of orbits with v <= 0 start behind the wall."""
        n = self.closing.n
        return (
            not n
            or self.closing.plastic
            or float(point.at[n : 2 * n].min()) > 1e-9 * float(self.closing.scales(point.at)[n])
        )

    def _event_row(
        self, kind: EventKind, point: Point, impact: int = 0, time: float = np.nan, other: PeriodicOrbit | None = None
    ) -> Row:
        orbit = orbit_of(self.closing, point.at, self._visible(point.at, SETTINGS.located))
        value = float(point.at[-1])
        impact %= max(self.closing.n, 1)  # flights between two walls are looked at from both
        remark = kind.remark(orbit, float(point.at[impact]), value)
        self.notes += [remark] if remark else []
        return self.row(point, SETTINGS.located, Event(kind.name, value, orbit, 0, impact, time, self.over, other))


# ---- points in the user's cache


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
