"""Curves of folds, doublings and grazes in two parameters."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial, reduce
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.branch import interval
from singimpact.branches.branch_points import half_of, halves, repeated
from singimpact.branches.continuation import Curve, Point
from singimpact.branches.events import KINDS, Event
from singimpact.branches.events.kind import OrbitState
from singimpact.branches.events.meeting_branches import PITCHFORK
from singimpact.branches.orbit_curve import SETTINGS, OrbitCurve, places
from singimpact.branches.orbits import OfImpacts
from singimpact.branches.solutions import AnyClosing, closing_of, point_of
from singimpact.inputs import checked_keywords, refuse, require, takes_two_walls, whole
from singimpact.oscillator import CLEARANCE, RESTITUTION, UPPER, Oscillator, value_of, with_number
from singimpact.result import Result, numbered

# Names of points of codimension two in MatCont and MatContM.
MATCONT = {"cusp": "CP", "generalized flip": "GPD", "Chenciner": "CH", "fold and doubling": "LPPD"}
MATCONT |= {f"1:{q} resonance": f"R{q}" for q in (1, 2, 3, 4)}
POLES = ("cusp", "generalized flip", "Chenciner")  # tests that change sign at poles too
HALVES = 1e-6  # halves of an orbit at a pitchfork that differ by more, in scaled unknowns, are not equal
# Half the width of a central difference, in scaled unknowns: the derivative then has a relative error of 1e-10.
NUDGE = 1e-6


@dataclass(frozen=True)
class Special(Result):
    """A point of codimension two.

    Parameters
    ----------
    kind : "cusp" (two folds meet), "resonant graze" (folds and doublings leave the curve of grazes), "fold at a graze",
        "doubling at a graze", "degenerate graze" (a_c = 0 there), "two grazes", "graze", "fold and doubling",
        "generalized flip" and "Chenciner" (the first coefficient of the normal form of a doubling or torus is 0),
        "1:1 resonance" to "1:4 resonance" (both multipliers are 1, or -1, or at angles of 120 or 90 degrees).
    parameters : the two numbers. index : it lies after this point of the curve.
    """

    kind: str
    parameters: tuple[float, float]
    index: int = 0

    @property
    def label(self) -> str:
        """The name in MatCont: CP, GPD, CH, LPPD, R1 to R4; empty where it has none, such as at grazes."""
        return MATCONT.get(self.kind, "")

    def as_dict(self) -> dict[str, Any]:
        """Kind, name in MatCont, both numbers, and the point of the curve after which it lies."""
        names = {"kind": self.kind, "label": self.label}
        return names | {"parameters": list(self.parameters), "after_point": self.index}


@dataclass(frozen=True, eq=False)
class EventCurve(OfImpacts):
    """Events of one kind in two parameters.

    Parameters
    ----------
    kind : of the events. over : the two numbers. parameters : shape (m, 2). tau, v : shape (m, n).
    visible : shape (m,): whether no flight is below the wall. special : points of codimension two. notes : how it ends.
    wall : int8, shape (n,), of each impact, of a model with two.
    """

    oscillator: Oscillator
    kind: str
    over: tuple[str, str]
    n: int
    k: int
    parameters: Array
    tau: Array
    v: Array
    visible: Array
    special: tuple[Special, ...]
    notes: tuple[str, ...]
    wall: Array | None = None

    def __len__(self) -> int:
        return len(self.parameters)

    def as_dict(self) -> dict[str, Any]:
        """Kind, n, k, the arrays of points, points of codimension two and notes."""
        return {
            "kind": self.kind,
            "n": self.n,
            "k": self.k,
            "points": {name: getattr(self, name) for name in ("parameters", "tau", "v", "visible")},
            "special": [point.as_dict() for point in self.special],
            "notes": list(self.notes),
        }

    def arrays(self) -> dict[str, tuple[tuple[str, ...], Array]]:
        """The arrays of points, with the names of their axes."""
        axes = {"parameters": ("point", "number"), "tau": ("point", "impact"), "v": ("point", "impact")}
        return {name: (axes.get(name, ("point",)), values) for name, values in self.as_dict()["points"].items()}

    def table(self) -> dict[str, Array]:
        """One row for each point: both parameters, the states, visible."""
        numbers = dict(zip(self.over, self.parameters.T, strict=True))
        return numbers | numbered("tau", self.tau) | numbered("v", self.v) | {"visible": self.visible.astype(int)}

    def __repr__(self) -> str:
        lines = [
            f"<curve of {self.kind} events of ({self.impacts}, {self.k}) orbits in {' and '.join(self.over)}, "
            f"{len(self)} points"
        ]
        for point in self.special:
            label = point.label and f" ({point.label})"
            lines.append(f"  {point.kind}{label} at ({point.parameters[0]:.12g}, {point.parameters[1]:.12g})")
        return "\n".join([*lines, *(f"  {note}" for note in self.notes)]) + ">"


@checked_keywords
@takes_two_walls
def event_curve(
    event: Event,
    over: Sequence[str] = (CLEARANCE, RESTITUTION),
    between: Any = None,
    *,
    points: int = 1000,
    step: float | None = None,
) -> EventCurve:
    """The curve of a fold, doubling, torus, graze, hidden impact, onset of rest or pitchfork in two parameters.

    Parameters
    ----------
    event : of a branch; of pitchforks one at which half of the orbit doubles, as half of a symmetric orbit does.
    over : two numbers, as `branch` takes them. between : a pair of intervals, one a number.
    points : at most so many on either side of the event. step : the largest step, a part of the intervals (0.02).

    Returns
    -------
    EventCurve : with its points of codimension two, located to rounding; cusps to 1e-9, for their test is a difference.
        Beyond a 1:1 or 1:2 resonance the multipliers on a curve of tori are real, with the product 1: such orbits are
        neutral saddles, and no torus begins at them.

    Examples
    --------
    >>> from singimpact.branches.branch import branch
    >>> from singimpact.branches.periodic import periodic
    >>> model = Oscillator("x + b*xdot", "-A*cos(w*t)", -1, "0.8", {"A": "0.45", "b": "0.1", "w": "0.8"})
    >>> graze = branch(periodic(model, 1, 1)[0], "A", (0.3, 0.5)).events[0]
    >>> curve = event_curve(graze, ("A", "w"), ((0.05, 0.6), (0.6, 0.95)))
    >>> A, w = curve.parameters.T
    >>> bool(np.abs(A / np.hypot(1 - w * w, 0.1 * w) - 1).max() < 1e-12)
    True
    """
    over = tuple(over)
    if not isinstance(event, Event) or event.described.look is None:
        *labels, last = (kind.label for kind in KINDS if kind.look is not None)
        raise refuse("event", event, f"a {', '.join(labels)} or {last} among the events of a branch")
    require(len(over) == 2 and over[0] != over[1], "over", over, "two different numbers of the model")
    whole("points", points, 2, 10**6)
    orbit = event.orbit
    osc = reduce(with_number, over, orbit.oscillator)
    intervals = (None, None) if between is None else tuple(between)
    require(len(intervals) == 2, "between", between, "a pair of intervals, one for each number")
    values = [value_of(osc, name) for name in over]
    ends = [interval(name, limits, value) for name, limits, value in zip(over, intervals, values, strict=True)]
    require(orbit.n, "event", event, "an event of an orbit with impacts: event.others()[0] has one that grazes alike")
    full = closing_of(osc, orbit.word, orbit.k, over)
    closing, at = full, np.concatenate([point_of(full, orbit), values])
    if event.described is PITCHFORK:  # half of the orbit doubles there
        half = half_of(full)
        if half is None or np.abs(halves(full, at)).max() > HALVES:
            raise refuse("event", event, "a pitchfork of an orbit whose halves are equal, or mirror images")
        closing, at = half, at[[*range(half.n), *range(full.n, full.n + half.n), -2, -1]]
    return _Walk(closing, event, ends, step or SETTINGS.step, points).curve(at, full)


class _Walk(OrbitCurve):
    """An event curve while it is followed."""

    def __init__(
        self, closing: AnyClosing, event: Event, ends: list[tuple[float, float]], step: float, most: int
    ) -> None:
        super().__init__(closing, ends, step, most)
        self.kind, self.impact = event.described, event.described.touching(closing, event.orbit)

    # ---- equations

    def state(self, point: Array) -> OrbitState:
        """The state from which the kind of the event computes its equation."""
        return OrbitState(self.closing, self.scales, point, impact=self.impact)

    def test(self, point: Array) -> float:
        """The test function, which vanishes at the event."""
        return self.kind.equation(self.state(point))

    def gradient(self, state: OrbitState) -> Array:
        """The derivative of the test by each unknown: central differences, as their error does not move its root."""
        exact = self.kind.gradient(state)
        if exact is not None:
            return exact
        point, slopes = state.at, np.empty(len(state.at))
        for i in range(len(point)):
            moved = np.zeros(len(point))
            moved[i] = NUDGE * self.scales[i]
            slopes[i] = (self.test(point + moved) - self.test(point - moved)) / (2 * moved[i])
        return slopes

    def conditions(self, point: Array) -> tuple[Array, Array]:
        """The closing conditions and the test."""
        state = self.state(point)
        loop = state.loop
        return np.append(loop.miss, self.kind.equation(state)), np.vstack([loop.slope, self.gradient(state)])

    def is_sound(self, point: Array) -> bool:
        """Whether no flight has shrunk to nothing, and both numbers are such as a model may have."""
        values = self.closing.values(point)
        laws = (values.get(name, 0.5) for name in (RESTITUTION, UPPER[1]))
        allowed = all(0 < law < 1.05 for law in laws) and self.closing.period(point) > 0
        return bool(allowed) and super().is_sound(point)

    # ---- the curve

    def curve(self, guess: Array, whole: AnyClosing) -> EventCurve:
        """Follow the curve in both directions from a guess; its orbits are those of the whole closing conditions."""
        self.scaled(guess)
        start = self.begin(guess)
        if start is None:
            raise refuse("event", self.kind.name, "an event that solves its equations with these two numbers")
        rows = self.both_sides(start)
        indices = places([isinstance(row, Point) for row in rows])
        special = [replace(row, index=i) for i, row in zip(indices, rows, strict=True) if isinstance(row, Special)]
        points = [row for row in rows if isinstance(row, Point)]
        seen, names = np.array([self._visible(point.at) for point in points]), self.closing.over
        at, n, k, osc = np.array([point.at for point in points]), whole.n, whole.k, whole.family.osc
        if self.closing.n < n:
            at = np.array([repeated(self.closing, whole, point) for point in at])
        return EventCurve(
            osc,
            self.kind.name,
            (names[0], names[1]),
            n,
            k,
            at[:, 2 * n :],
            at[:, :n],
            at[:, n : 2 * n],
            seen,
            tuple(special),
            tuple(self.notes),
            None if osc.upper is None else np.array(whole.word, np.int8),
        )

    def row(self, point: Point) -> Point:
        return point

    def side(self, curve: Curve, start: Point, sign: float) -> list[Point | Special]:  # noqa: ARG002
        rows: list[Point | Special] = []
        before = self._tests(start)
        for here, length, after, is_last in self.steps(curve, start):
            if not is_last:  # points of codimension two in the piece before an end are not looked for
                tests = self._tests(after)
                rows += self._special(curve, here, length, (before, tests))
                before = tests
            rows.append(after)
        return rows

    # ---- points of codimension two

    def _tests(self, point: Point) -> dict[str, float]:
        """Test functions, which change sign at points of codimension two."""
        state = self.state(point.at)
        return self.kind.degenerate(state, partial(self.gradient, state))

    def _one_test(self, name: str, point: Point) -> float:
        return self._tests(point).get(name, np.nan)

    def _special(
        self, curve: Curve, here: Point, length: float, tests: tuple[dict[str, float], dict[str, float]]
    ) -> list[Special]:
        before, after = tests
        crossings: list[tuple[float, str, Point]] = []
        for name, value in before.items():
            later = after.get(name)
            if later is None or not value * later < 0:
                continue
            located = curve.located(here, length, partial(self._one_test, name), (value, later))
            if located is None:
                continue
            along, point = located
            if not (name in POLES and abs(self._tests(point)[name]) > 0.1 * max(abs(value), abs(later))):
                crossings.append((along, name.rstrip("0123456789 "), point))
        return _merged(sorted(crossings, key=lambda crossing: crossing[0]), length)

    def _visible(self, at: Array) -> bool:
        n = self.closing.n
        if float(at[n : 2 * n].min()) < -1e-9 * float(self.scales[n]):
            return False
        return min(height for _, height in self.closing.heights(at)) >= -1e-9 * float(self.scales[n])


def _merged(crossings: list[tuple[float, str, Point]], length: float) -> list[Special]:
    """Fold and doubling that meet a graze at one point are one resonant graze."""
    names = {name for _, name, _ in crossings}
    special: list[Special] = []
    for pair in ({"fold at a graze", "doubling at a graze"}, {"graze", "fold and doubling"}):
        parts = [along for along, name, _ in crossings if name in pair]
        if pair <= names and max(parts) - min(parts) < 1e-6 * length:
            point = next(point for _, name, point in crossings if name in pair)
            special.append(Special("resonant graze", (float(point.at[-2]), float(point.at[-1]))))
            crossings = [crossing for crossing in crossings if crossing[1] not in pair]
    return special + [
        Special(name, (float(crossing.at[-2]), float(crossing.at[-1]))) for _, name, crossing in crossings
    ]
