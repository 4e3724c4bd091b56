"""A branch of periodic orbits over a parameter, through its grazes, with its events."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float, constant
from singimpact.branches.closing import Closing
from singimpact.branches.continuation import Curve, Point
from singimpact.branches.events import Event
from singimpact.branches.kept import KeptSide
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.solutions import AnyClosing, closing_of, orbit_of, orbit_period
from singimpact.flights.family import SteppedFamily
from singimpact.inputs import InputError, refuse, whole
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION, value_of, with_number
from singimpact.store import write_text

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class BranchSettings:
    """Step sizes and tolerances of a branch."""

    # largest step, as a part of the width of the interval, of a period and of the largest velocity
    step: float = 0.02
    # half width of the default interval, as a part of the parameter, or of 1 if it is 0
    around: float = 0.5
    # flight time, in periods, below which two impacts have met
    shortest: float = 1e-9
    # height above the wall that is a rounding error
    touching: float = 1e-12
    # |product of the multipliers| - 1 that is a rounding error: for r = 1 without damping it is 0 everywhere
    neutral: float = 1e-9


SETTINGS = BranchSettings()


@dataclass(frozen=True, eq=False)
class Branch:
    """Periodic orbits over a parameter.

    Parameters
    ----------
    oscillator : the model where the branch began. over : the parameter. n, k : impacts in k periods.
    parameter : shape (m,). tau, v : shape (m, n), states after the impacts; of orbits without impact x and x' at time
        0, shape (m, 1). multipliers : shape (m, 2), the larger first. visible : shape (m,), bool.
    events : in the order of the branch. notes : where and why it ends.
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

    def __len__(self) -> int:
        return int(self.parameter.size)

    @property
    def stable(self) -> Array:
        """Whether both multipliers are below 1 in size, by more than rounding, shape (m,)."""
        with np.errstate(invalid="ignore"):
            return np.asarray((np.abs(self.multipliers) < 1 - SETTINGS.neutral).all(axis=1))

    def orbit(self, index: int) -> PeriodicOrbit:
        """The orbit at a point."""
        closing = closing_of(self.oscillator, self.n, self.k, (self.over,))
        at = np.concatenate([self.tau[index], self.v[index], self.parameter[index : index + 1 or None][:1]])
        return orbit_of(closing, at)

    def csv_lines(self) -> list[str]:
        """The names of the columns, then one line for each point: parameter, states, multipliers, stable, visible."""
        names = [self.over, *(f"{name}_{i + 1}" for name in ("tau", "v") for i in range(self.tau.shape[1]))]
        names += ["multiplier_1_re", "multiplier_1_im", "multiplier_2_re", "multiplier_2_im", "stable", "visible"]
        lines = [",".join(names)]
        for i in range(len(self)):
            numbers = [self.parameter[i], *self.tau[i], *self.v[i]]
            numbers += [part for each in self.multipliers[i] for part in (np.real(each), np.imag(each))]
            flags = [str(int(self.stable[i])), str(int(self.visible[i]))]
            lines.append(",".join([*(repr(float(each)) for each in numbers), *flags]))
        return lines

    def to_csv(self, file: str | Path) -> None:
        """Write `csv_lines` to a file, which appears only when complete."""
        write_text(file, "\n".join(self.csv_lines()) + "\n")

    def __repr__(self) -> str:
        low, high = (float(end) for end in (self.parameter.min(), self.parameter.max()))
        lines = [
            f"<branch of ({self.n}, {self.k}) orbits, {len(self)} points, {self.over} from {low:.6g} to {high:.6g}"
        ]
        lines += [f"  {event!r}" for event in self.events]
        return "\n".join([*lines, *(f"  {note}" for note in self.notes)]) + ">"


def branch(
    orbit: PeriodicOrbit, over: str = CLEARANCE, between: Any = None, *, points: int = 2000, step: float | None = None
) -> Branch:
    """The branch of periodic orbits through an orbit, over a parameter of its model.

    Parameters
    ----------
    orbit : of `osc.periodic`, of n impacts or of none. over : clearance, restitution, a parameter; "amplitude" and
        "damping" of any model, "stiffness" and "phase" of `si.linear`, need not be parameters of it.
    between : (low, high); half the number on either side of it, or 0.5 where it is 0, without it.
    points : at most so many on either side of the orbit. step : the largest step, a part of the interval (0.02).

    Returns
    -------
    Branch : from its end with the smaller number on; events are located to rounding.

    Notes
    -----
    The branch is followed on the surface of flights that do not feel the wall, where it is smooth through a graze.
    Beyond the graze it is virtual: `visible` says so. Points of a model without a closed form are kept in the cache: a
    call that was interrupted continues from its stored points.

    Examples
    --------
    >>> from singimpact.branches.periodic import periodic
    >>> model = Oscillator("x + 0.1*xdot", "-A*cos(0.8*t)", -1, "0.8", {"A": "0.45"})
    >>> found = branch(periodic(model, 1, 1)[0], "A", (0.3, 0.5))
    >>> [(event.kind, round(event.parameter, 12)) for event in found.events][:1]
    [('graze', 0.368781778292)]
    """
    osc, state = _checked(orbit)
    osc = with_number(osc, over)
    closing = closing_of(osc, int(orbit.n), orbit.k, (over,))
    value = value_of(osc, over)
    low, high = interval(over, between, value)
    whole("points", points, 2, 10**6)
    if step is not None and not 0 < step <= 1:
        raise refuse("step", step, "a part of the interval, in (0, 1]")
    walk = _Walk(closing, (low, high), step or SETTINGS.step, points)
    return walk.branch(np.append(state, value), osc, over)


def _checked(orbit: PeriodicOrbit) -> tuple[Oscillator, Array]:
    if not isinstance(orbit, PeriodicOrbit) or not isinstance(orbit.oscillator, Oscillator):
        raise refuse("orbit", orbit, "an orbit of osc.periodic(n, k)")
    if orbit.kind == "chatter":
        raise InputError("an orbit with chatter is not followed: give one with finitely many impacts, or with none")
    if orbit.kind == "free":
        closing = closing_of(orbit.oscillator, 0, orbit.k, ())
        span = float(np.asarray(orbit.tau, dtype=float)[0])
        # from its lowest place back to time 0
        values = {CLEARANCE: float(orbit.x[0])}
        end = closing.family.end(values, span, float(orbit.v[0]), -span)
        return orbit.oscillator, np.array([float(orbit.x[0]) + end.place[0], end.place[1]])
    return orbit.oscillator, np.concatenate([np.asarray(part, dtype=float) for part in (orbit.tau, orbit.v)])


def interval(over: str, between: Any, value: float) -> tuple[float, float]:
    """The ends of the interval, as floats.

    Examples
    --------
    >>> interval("clearance", None, 0.0), interval("restitution", None, 0.8), interval("w", ("1/2", 2), 1.0)
    ((-0.5, 0.5), (0.4, 1.0), (0.5, 2.0))
    """
    if between is None:
        reach = SETTINGS.around * (abs(value) or 1.0)
        low, high = value - reach, value + reach
        return (low, min(high, 1.0)) if over == RESTITUTION else (low, high)
    try:
        low, high = (as_float(constant("between", end)) for end in between)
    except (TypeError, ValueError):
        raise refuse("between", between, "two numbers low < high") from None
    if not low < high or (over == RESTITUTION and not 0 < low < high <= 1):
        raise refuse("between", between, "two numbers low < high" + (" in (0, 1]" if over == RESTITUTION else ""))
    if not low <= value <= high:
        raise refuse("between", between, f"an interval that holds {over} = {value:.12g} of the orbit")
    return low, high


@dataclass
class _Walk:
    """A branch while it is followed."""

    closing: AnyClosing
    ends: tuple[float, float]
    step: float
    most: int

    def equations(self, point: Array) -> tuple[Array, Array]:
        """The closing conditions; nan where a flight has collapsed."""
        if isinstance(self.closing, Closing) and self._collapsed(point):
            return np.full(2 * self.closing.n, np.nan), np.full((2 * self.closing.n, len(point)), np.nan)
        loop = self.closing.at(point)
        return loop.miss, loop.slope

    def _collapsed(self, point: Array) -> bool:
        assert isinstance(self.closing, Closing)
        period = self.closing.family.period(self.closing.values(point)).value
        return any(flight[3] < SETTINGS.shortest * period for flight in self.closing.flights(point))

    def branch(self, guess: Array, osc: Oscillator, over: str) -> Branch:
        """Follow the branch in both directions from a guess."""
        scales = self.closing.scales(guess)
        scales[-1] = self.ends[1] - self.ends[0]
        upwards = np.zeros(len(guess))
        upwards[-1] = scales[-1]
        notes: list[str] = []
        n = self.closing.n
        speeds = slice(n, 2 * n) if n else slice(0, 2)
        curve = Curve(self, scales, self.step, speeds)
        start = curve.begin(guess, upwards)
        if start is None:
            raise InputError("the orbit does not solve its closing conditions: give one of osc.periodic(n, k)")
        rows, events = [self._row(start)], []
        for sign in (-1.0, 1.0):
            side, met = self._side(
                Curve(self, scales, self.step, speeds), Point(start.at, sign * start.tangent), notes, over
            )
            if sign < 0:
                rows = side[::-1] + rows
                events = [replace(event, index=-event.index - 1) for event in met[::-1]]
            else:
                rows += side
                events += met
            if notes and notes[-1].startswith("closed"):
                break
        before = next(i for i, row in enumerate(rows) if row[0] is start)
        events = [replace(event, index=event.index + before, over=over) for event in events]
        n = max(n, 1)
        at = np.array([row[0].at for row in rows])
        seen = self._confirmed(np.array([row[2] for row in rows]), at, notes)
        return Branch(osc, over, self.closing.n, self.closing.k, at[:, -1], at[:, :n], at[:, n : 2 * n],
                      np.array([row[1] for row in rows]), seen, tuple(events), tuple(notes))  # fmt: skip

    # ---- one side

    def _side(self, curve: Curve, start: Point, notes: list[str], over: str) -> tuple[list[Any], list[Event]]:
        kept = KeptSide(self._asked(start, over))
        try:
            return self._followed(curve, start, notes, over, kept)
        finally:
            kept.write()

    def _followed(
        self, curve: Curve, start: Point, notes: list[str], over: str, kept: KeptSide
    ) -> tuple[list[Any], list[Event]]:
        rows: list[Any] = []
        events: list[Event] = []
        before = self._tests(start)
        low, high = self.ends
        for here, length, after in self._steps(curve, start, kept):
            known = kept.points[len(rows)] if len(rows) < len(kept.points) else None
            outside = not low <= after.at[-1] <= high
            if outside:
                end = self._end(curve, here, length, after)
                if end is None:
                    notes.append(f"ends at {over} = {here.at[-1]:.12g}, next to the end of the interval")
                    return rows, events
                length, after = end
            tests = self._tests(after) if known is None else known.named_tests()
            events += self._events(curve, (here, length, after), (before, tests), len(rows), notes)
            rows.append(self._row(after) if known is None else (after, known.multipliers, known.visible))
            if known is None and not outside:
                kept.add((after.at, after.tangent, curve.following), rows[-1], tests)
            before = tests
            if outside:
                notes.append(f"ends at {over} = {after.at[-1]:.12g}, the end of the interval")
                return rows, events
            if len(rows) > 10 and self._again(curve, start, here, after):
                notes.append("closed: the branch comes back to where it began")
                return rows, events
        where = rows[-1][0] if rows else start
        notes.append(f"at {over} = {where.at[-1]:.12g}: {self._reason(where) or curve.note}")
        return rows, events

    def _asked(self, start: Point, over: str) -> tuple[Any, ...] | None:
        """The key of a side in the cache; None for a linear model, whose branches take less than 1 s."""
        family = self.closing.family
        if not isinstance(family, SteppedFamily):
            return None
        numbers = (start.at.tolist(), start.tangent.tolist(), self.ends, self.step, self.most)
        return family.osc, self.closing.n, self.closing.k, over, numbers

    def _steps(self, curve: Curve, start: Point, kept: KeptSide) -> Iterator[tuple[Point, float, Point]]:
        """The stored steps, then new ones."""
        here = start
        known = list(kept.points)
        for each in known:
            after = Point(each.at, each.tangent)
            yield here, float(here.tangent @ ((after.at - here.at) / curve.scales)), after
            here = after
        yield from curve.walk(here, self.most - len(known), known[-1].following if known else None)

    def _reason(self, where: Point) -> str:
        """Why flights have no value just beyond a point."""
        if not isinstance(self.closing, Closing):
            return ""
        values = self.closing.values(where.at)
        period = self.closing.family.period(values).value
        times = [flight[3] for flight in self.closing.flights(where.at)]
        if min(times) < 1e-3 * period:
            return "two impacts meet: a flight shrinks to nothing"
        return ""

    def _end(self, curve: Curve, here: Point, length: float, after: Point) -> tuple[float, Point] | None:
        """The point of the step at which the number is the end of the interval."""
        goal = self.ends[0] if after.at[-1] < self.ends[0] else self.ends[1]
        ends = float(here.at[-1] - goal), float(after.at[-1] - goal)
        found = None if ends[0] == 0 else curve.located(here, length, lambda point: float(point.at[-1] - goal), ends)
        if found is not None:
            found[1].at[-1] = goal
        return found

    def _again(self, curve: Curve, start: Point, here: Point, after: Point) -> bool:
        """Whether a step passes the start, perhaps some periods later."""
        gap, n = (start.at - here.at) / curve.scales, self.closing.n
        if n:
            period = self.closing.family.period(self.closing.values(after.at)).value / curve.scales[0]
            gap[:n] -= period * np.rint(gap[0] / period)
        return curve.passes(start, here, after, gap)

    # ---- a point: visible or not, events

    def _row(self, point: Point) -> tuple[Point, Array, bool]:
        loop = self.closing.at(point.at)
        with np.errstate(all="ignore"):
            return point, loop.multipliers(), self._visible(point)

    def _visible(self, point: Point, rounding: float = SETTINGS.touching) -> bool:
        n = self.closing.n
        if n and float(point.at[n : 2 * n].min()) < -rounding:
            return False
        return min(height for _, height in self._heights(point)) >= -rounding

    def _heights(self, point: Point) -> list[tuple[float, float]]:
        known = self.__dict__.setdefault("_known", {})
        key = point.at.tobytes()
        if key not in known:
            if len(known) > 8:
                known.pop(next(iter(known)))
            known[key] = self.closing.heights(point.at)
        found: list[tuple[float, float]] = known[key]
        return found

    def _tests(self, point: Point) -> dict[tuple[str, int], float]:
        """Test functions, which change sign at events."""
        zero, one, two = self.closing.at(point.at).characteristic()
        tests = {("fold", 0): float(point.tangent[-1]), ("period-doubling", 0): zero - one + two}
        if one * one < 4 * zero * two:
            tests["torus", 0] = (zero - two) / (abs(zero) + abs(two))
        n = self.closing.n
        for i in range(n):
            tests["graze", i] = float(point.at[n + i])
        for i, (_, height) in enumerate(self._heights(point)):
            if np.isfinite(height):
                tests["hidden impact" if n else "graze", i] = height
        return tests

    def _events(
        self, curve: Curve, step: tuple[Point, float, Point], tests: tuple[Any, Any], index: int, notes: list[str]
    ) -> list[Event]:
        before, after = tests
        here, length, after_point = step
        found = []
        for key, value in before.items():
            later = after.get(key)
            if later is None or value == 0 or not value * later <= 0:
                continue
            if key[0] == "torus" and min(abs(value), abs(later)) < SETTINGS.neutral:
                continue
            if key[0] == "fold" and self._halves(here.at) @ self._halves(after_point.at) < 0:
                notes.append(f"meets the ({self.closing.n // 2}, {self.closing.k // 2}) orbits at their doubling, near "
                             f"{here.at[-1]:.9g}")  # fmt: skip
                continue
            located = curve.located(here, length, partial(self._test, key), (value, later))
            if located is None and key[0] == "torus":
                continue  # the multipliers are real where their product is 1, so this is no torus bifurcation
            if located is None:
                notes.append(f"a {key[0]} near {here.at[-1]:.9g} could not be located")
                continue
            part, point = located
            if key[0] in ("hidden impact", "graze") and self.closing.n and not self._real(key, point):
                continue
            found.append((part, self._event(key, point, index, notes)))
        return [event for _, event in sorted(found, key=lambda pair: pair[0])]

    def _test(self, key: tuple[str, int], point: Point) -> float | None:
        return self._tests(point).get(key)

    def _halves(self, at: Array) -> Array:
        """The second half of an orbit less the first; it changes sign where a doubled orbit begins."""
        n, k = self.closing.n, self.closing.k
        if n < 2 or n % 2 or k % 2:
            return np.zeros(1)
        period = self.closing.family.period(self.closing.values(at)).value
        times, speeds = np.diff(at[:n].reshape(2, -1), axis=0)[0], np.diff(at[n : 2 * n].reshape(2, -1), axis=0)[0]
        scales = self.closing.scales(at)
        return np.concatenate([(times - k // 2 * period) / scales[0], speeds / scales[n]])

    def _real(self, key: tuple[str, int], point: Point) -> bool:
        """Drop hidden impacts of orbits with v <= 0: their flights start behind the wall."""
        n = self.closing.n
        small = 1e-9 * float(self.closing.scales(point.at)[n])
        return key[0] == "graze" or float(point.at[n : 2 * n].min()) > small

    def _event(self, key: tuple[str, int], point: Point, index: int, notes: list[str]) -> Event:
        kind, impact = key
        orbit = orbit_of(self.closing, point.at, self._visible(point, 1e-9))
        time = np.nan
        if kind == "hidden impact":
            time = self._heights(point)[impact][0]
        value = float(point.at[-1])
        if kind == "graze" and self.closing.n:
            push = float(acceleration(orbit.oscillator, np.array([point.at[impact]]))[0])
            fastest = float(np.abs(acceleration(orbit.oscillator, np.linspace(0, 1, 9) * orbit_period(orbit))).max())
            if abs(push) < 1e-6 * fastest:
                notes.append(f"the graze at {value:.12g} is one with a_c = 0: a degenerate graze")
        return Event(kind, value, orbit, index, impact, time)

    def _confirmed(self, seen: Array, at: Array, notes: list[str]) -> Array:
        """`visible` compared with the true first hits in the middle of every visible stretch."""
        if not self.closing.n:
            return seen
        edges = np.flatnonzero(np.diff(np.concatenate([[False], seen, [False]]).astype(int)))
        for begin, end in edges.reshape(-1, 2).tolist():
            middle = (begin + end) // 2
            if not orbit_of(self.closing, at[middle]).visible:
                seen[begin:end] = False
                notes.append(
                    f"points {begin} to {end - 1} meet the wall earlier than the closing conditions say: virtual"
                )
        return seen
