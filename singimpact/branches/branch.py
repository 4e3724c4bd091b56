"""A branch of periodic orbits over a parameter, through its grazes, with its events."""

import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from singimpact import cache
from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.branches.branch_points import BranchPoint, branch_point
from singimpact.branches.closing import Closing
from singimpact.branches.continuation import Curve, Point
from singimpact.branches.events import KINDS, Event, EventKind, kind_of, own_events
from singimpact.branches.events.kind import Test
from singimpact.branches.events.meeting_branches import PITCHFORK
from singimpact.branches.orbit_curve import SETTINGS, OrbitCurve, places
from singimpact.branches.orbits import OfImpacts, PeriodicOrbit
from singimpact.branches.solutions import AnyClosing, closing_of, orbit_of, point_of
from singimpact.branches.step_search import Crossing, EventTests, Key, StepSearch, Tests
from singimpact.inputs import InputError, checked_keywords, refuse, require, takes_two_walls, whole
from singimpact.oscillator import CLEARANCE, RESTITUTION, UPPER, Oscillator, value_of, with_number
from singimpact.result import numbered
from singimpact.store import cache_folder

# Arrays of a branch, a row for each of its points.
POINTS = ("parameter", "period", "tau", "v", "stable", "visible", "multipliers")


@dataclass(frozen=True, eq=False)
class Branch(OfImpacts):
    """Periodic orbits over a parameter.

    Parameters
    ----------
    oscillator : the model where the branch began. over : the parameter. n, k : impacts in k periods.
    parameter : shape (m,). tau, v : shape (m, n), states after the impacts; of orbits without impact x and x' at time
        0, shape (m, 1). multipliers : shape (m, 2), the larger first; of limit cycles (m, 1). visible : shape
        (m,), bool.
    period : the time after which each closes, shape (m,). wall : int8, shape (n,), of each impact, of a model with two.
    events : in the order of the branch. A point of the branch stands at each that is no touch of the wall, and between
        any two. notes : where and why it ends, and where rounding leaves events open.
    """

    oscillator: Oscillator
    over: str
    n: int
    k: int
    parameter: Array
    tau: Array
    v: Array
    multipliers: Array
    visible: Array
    events: tuple[Event, ...]
    notes: tuple[str, ...]
    period: Array
    wall: Array | None = None

    def __len__(self) -> int:
        return int(self.parameter.size)

    @property
    def stable(self) -> Array:
        """Whether both multipliers are below 1 in size, by more than rounding, shape (m,)."""
        with np.errstate(invalid="ignore"):
            return np.asarray((np.abs(self.multipliers) < 1 - SETTINGS.neutral).all(axis=1))

    @property
    def at_event(self) -> Array:
        """Whether a point is an event, shape (m,): a fold, doubling, torus, pitchfork or other branch point."""
        at = np.zeros(len(self), dtype=bool)
        at[[event.index + 1 for event in self.events if not event.described.touches]] = True
        return at

    @property
    def closing(self) -> AnyClosing:
        """The closing conditions of its orbits."""
        return closing_of(self.oscillator, self.word, self.k, (self.over,))

    def orbit(self, index: int) -> PeriodicOrbit:
        """The orbit at a point."""
        closing = self.closing
        parameter = self.parameter[index : index + 1 or None][:1]
        if isinstance(closing, Closing):
            states = closing.point(self.tau[index], self.v[index], float(self.period[index]))
        else:
            states = np.concatenate([self.tau[index], self.v[index]])
        return orbit_of(closing, np.append(states, parameter))

    def as_dict(self) -> dict[str, Any]:
        """n, k, the arrays of points, events and notes."""
        return {
            "n": self.n,
            "k": self.k,
            "points": {name: getattr(self, name) for name in POINTS},
            "events": [event.as_dict() for event in self.events],
            "notes": list(self.notes),
        }

    def arrays(self) -> dict[str, tuple[tuple[str, ...], Array]]:
        """The arrays of points, with the names of their axes."""
        axes = {"tau": ("point", "impact"), "v": ("point", "impact"), "multipliers": ("point", "multiplier")}
        return {name: (axes.get(name, ("point",)), values) for name, values in self.as_dict()["points"].items()}

    def table(self) -> dict[str, Array]:
        """One row for each point: parameter, states, multipliers, stable, visible."""
        multipliers = {
            f"multiplier_{i + 1}_{name}": component(self.multipliers[:, i])
            for i in range(self.multipliers.shape[1])
            for name, component in (("re", np.real), ("im", np.imag))
        }
        flags = {name: getattr(self, name).astype(int) for name in ("stable", "visible")}
        cycles = {"period": self.period} if self.oscillator.autonomous else {}  # of others the forcing has it
        return (
            {self.over: self.parameter}
            | cycles
            | numbered("tau", self.tau)
            | numbered("v", self.v)
            | multipliers
            | flags
        )

    def __repr__(self) -> str:
        low, high = (float(end) for end in (self.parameter.min(), self.parameter.max()))
        plain = f"({self.impacts}, {self.k}) orbits"
        cycles = f"limit cycles, n = {self.n}" if self.oscillator.autonomous else plain
        lines = [f"<branch of {cycles}, {len(self)} points, {self.over} from {low:.6g} to {high:.6g}"]
        lines += [f"  {event!r}" for event in self.events]
        return "\n".join([*lines, *(f"  {note}" for note in self.notes)]) + ">"


@checked_keywords
@takes_two_walls
def branch(
    orbit: PeriodicOrbit,
    over: str = CLEARANCE,
    between: Any = None,
    *,
    points: int = 2000,
    step: float | None = None,
    events: Iterable[Any] = (),
) -> Branch:
    """The branch of periodic orbits through an orbit, over a parameter of its model.

    Parameters
    ----------
    orbit : of `osc.periodic`, of n impacts or of none. over : clearance, restitution, a parameter; "amplitude" and
        "damping" of any model, "stiffness" and "phase" of `si.linear`, need not be parameters of it.
    between : (low, high); half the number on either side of it, or 0.5 where it is 0, without it.
    points : at most so many on either side of the orbit, beside those at events. step : the largest step, a part of the
        interval (0.02).
    events : your own kinds of events: functions of a `PeriodicOrbit`, which give a number that vanishes at an event, or
        objects with such a function `test` and a `name`. `kind` of an event is the name of its function.

    Returns
    -------
    Branch : from its end with the smaller number on; events are located to rounding. Steps are divided where the rates
        of a test function show that it may vanish twice on the way.

    Notes
    -----
    The branch is followed on the surface of flights that do not feel the wall, where it is smooth through a graze.
    Beyond the graze it is virtual: `visible` says so. Points of a model without a closed form are kept in the cache: a
    call that was interrupted continues from its stored points. Values of your own functions are not stored.

    A function of `events` is also called for virtual orbits (`orbit.visible`); the impacts of its orbit are in the
    order of `branch.tau`. A change of sign at which it jumps is not an event: `notes` has the values on both sides. A
    jump of less than 1e-5 of its change within a step is not distinguished from a zero.

    Raises
    ------
    InputError : a function of `events` raises, or its value is not finite, for an orbit of the branch.

    Examples
    --------
    >>> from singimpact.branches.periodic import periodic
    >>> model = Oscillator("x + 0.1*xdot", "-A*cos(0.8*t)", -1, "0.8", {"A": "0.45"})
    >>> found = branch(periodic(model, 1, 1)[0], "A", (0.3, 0.5))
    >>> [(event.kind, round(event.parameter, 12)) for event in found.events][:1]
    [('graze', 0.368781778292)]
    >>> def half_speed(orbit):
    ...     return orbit.v[0] - 0.25
    >>> found = branch(periodic(model, 1, 1)[0], "A", (0.3, 0.5), events=[half_speed])
    >>> [(event.kind, round(event.parameter, 9)) for event in found.events][-1:]
    [('half_speed', 0.469489726)]
    """
    osc, state = _checked(orbit)
    osc = with_number(osc, over)
    closing = closing_of(osc, orbit.word, orbit.k, (over,))
    value = value_of(osc, over)
    low, high = interval(over, between, value)
    whole("points", points, 2, 10**6)
    if step is not None and not 0 < step <= 1:
        raise refuse("step", step, "a part of the interval, in (0, 1]")
    own = own_events(events, [kind.name for kind in KINDS])
    walk = BranchWalk(closing, (low, high), step or SETTINGS.step, points, over, own)
    rows = walk.rows(np.append(state, value))
    listed = places([row.listed for row in rows])
    events = [
        replace(row.event, index=i - row.listed) for i, row in zip(listed, rows, strict=True) if row.event is not None
    ]
    rows = [row for row in rows if row.listed]
    n, at = max(closing.n, 1), np.array([row.point.at for row in rows])
    curve = Branch(
        osc,
        over,
        closing.n,
        closing.k,
        at[:, -1],
        np.array([closing.times(row) for row in at]) if isinstance(closing, Closing) else at[:, :n],
        at[:, n : 2 * n],
        np.array([row.multipliers for row in rows]),
        np.array([row.visible for row in rows]),
        tuple(events),
        tuple(walk.notes),
        np.array([closing.k * closing.period(row) for row in at]),
        orbit.wall,
    )
    return _confirmed(curve, at)


def _confirmed(branch: Branch, at: Array) -> Branch:
    """`visible` compared with the true first hits in the middle of every visible stretch."""
    if not branch.n:
        return branch
    closing = branch.closing
    seen, notes = branch.visible.copy(), list(branch.notes)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], seen, [False]]).astype(int)))
    for begin, end in edges.reshape(-1, 2).tolist():
        if not orbit_of(closing, at[(begin + end) // 2]).visible:
            seen[begin:end] = False
            notes.append(f"points {begin} to {end - 1} meet the wall earlier than the closing conditions say: virtual")
    return replace(branch, visible=seen, notes=tuple(notes))


def _checked(orbit: PeriodicOrbit) -> tuple[Oscillator, Array]:
    if not isinstance(orbit, PeriodicOrbit) or not isinstance(orbit.oscillator, Oscillator):
        raise refuse("orbit", orbit, "an orbit of osc.periodic(n, k)")
    if orbit.kind == "chatter":
        raise InputError("an orbit with chatter is not followed: give one with finitely many impacts, or with none")
    if orbit.kind == "free":
        closing = closing_of(orbit.oscillator, (), orbit.k, ())
        span = float(np.asarray(orbit.tau, dtype=float)[0])
        # from its lowest place back to time 0
        end = closing.family.end({CLEARANCE: float(orbit.x[0])}, span, float(orbit.v[0]), -span)
        return orbit.oscillator, np.array([float(orbit.x[0]) + end.place[0], end.place[1]])
    return orbit.oscillator, point_of(closing_of(orbit.oscillator, orbit.word, orbit.k, ()), orbit)


def interval(over: str, between: Any, value: float) -> tuple[float, float]:
    """The ends of the interval, as floats.

    Examples
    --------
    >>> interval("clearance", None, 0.0), interval("restitution", None, 0.8), interval("w", ("1/2", 2), 1.0)
    ((-0.5, 0.5), (0.4, 1.0), (0.5, 2.0))
    """
    restitution = over in (RESTITUTION, UPPER[1])
    if restitution and not value:
        raise InputError(f"{over} = 0 is not accepted here: a branch over it needs an orbit that rebounds")
    if between is None:
        reach = SETTINGS.around * (abs(value) or 1.0)
        low, high = value - reach, value + reach
        return (low, min(high, 1.0)) if restitution else (low, high)
    try:
        low, high = (as_float(constant("between", end)) for end in between)
    except (TypeError, ValueError):
        raise refuse("between", between, "two numbers low < high") from None
    if not low < high or (restitution and not 0 < low < high <= 1):
        raise refuse("between", between, "two numbers low < high" + (" in (0, 1]" if restitution else ""))
    require(low <= value <= high, "between", between, f"an interval that holds {over} = {value:.12g} of the orbit")
    return low, high


# The branch while it is followed: points, and the events between them. Points are stored in the cache, so that an
# interrupted branch continues where it was.


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
    tests : of events, by kind, impact and number: the numbers of `events.kind.Test`.
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
