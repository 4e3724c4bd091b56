"""Transitions of P as a number of the model moves, the periodic orbits between them, and what happens to these orbits.

At a transition of P no orbit changes, but in codimension two: an orbit grazes at a value of its own, where one of its
flights is launched at rest.  So orbits are listed between neighbouring transitions, with the values at which they
graze, fold or double.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float, constant
from singimpact.branches.branch import Branch, branch
from singimpact.branches.events import Event
from singimpact.branches.orbits import PeriodicOrbit, same_states
from singimpact.branches.periodic import periodic
from singimpact.dynamics.basins_of_attraction import Basins, basins
from singimpact.inputs import InputError, checked_keywords, need, refuse, require, takes_two_walls, whole
from singimpact.oscillator import RESTITUTION, Oscillator, largest_push, with_number
from singimpact.surface import Transition, default_window, window_ends
from singimpact.surface.outline_transitions import Transitions, at_wall as transitions_of_outline

SEEN_ALONE = ("tacnode", "triple point")  # transitions that part intervals only where they are visible
WORDS = ("stable", "neutral", "unstable", "virtual")


@dataclass(frozen=True)
class OrbitSettings:
    """Settings of the search for orbits between transitions."""

    # n, k at most
    most: int = 8
    # least number of values at which orbits are searched; the middle between neighbouring transitions is always one
    samples: int = 5
    # an orbit is one of a branch when its states differ by less than this, of a period and of the largest velocity,
    # from those of the next point of the branch
    near: float = 0.02
    # |multiplier| - 1 that is rounding
    neutral: float = 1e-9
    # the values on both sides of a transition that are drawn: a part of the interval, or of the way to the next one
    apart: tuple[float, float] = (0.05, 0.4)


SETTINGS = OrbitSettings()


@dataclass(frozen=True, eq=False)
class OrbitChange:
    """A change of periodic orbits at a value of the number.

    Parameters
    ----------
    kind : "graze", "hidden impact", "fold", "period-doubling", "torus", "pitchfork", "transcritical". value : of the
        number.
    n, k : of the orbits. event : with the orbit there; its `.others()` are those of the branches that meet it.
    below, above : what the orbits are for smaller and for larger values: "stable", "neutral" (the larger multiplier is
        1 in size: without impact and damping), "unstable", "virtual" (the solution goes through the wall: no orbit of
        the mass); at a fold there are two on one side, and none on the other.
    interval : its place in `intervals`.
    """

    kind: str
    value: float
    n: int
    k: int
    event: Event
    below: tuple[str, ...]
    above: tuple[str, ...]
    interval: int = 0

    def __repr__(self) -> str:
        told = " and ".join(
            f"{' and '.join(part) or 'none'} {where}" for part, where in ((self.below, "below"), (self.above, "above"))
        )
        name = f"({self.n}, {self.k}) orbit" if self.n else "orbit without impact"
        return f"<{self.kind} of the {name} at {self.event.over} = {self.value:.12g}: {told}>"


@dataclass(frozen=True)
class Interval:
    """The orbits between two neighbouring transitions.

    Parameters
    ----------
    low, high : values of the number. orbits : the visible ones at the middle, orbits with complete chatter among them.
    changes : what happens to orbits on the way, in order of the value.
    """

    low: float
    high: float
    orbits: tuple[PeriodicOrbit, ...]
    changes: tuple[OrbitChange, ...]


class OrbitTransitions(Transitions):
    """Transitions of P with the periodic orbits between them.

    Parameters
    ----------
    oscillator, over, ends : the model, the name of the number, and its ends.
    intervals : one more than there are values of transitions. changes : of all intervals. branches : followed for them.
    notes : why a swan may be missing. orbit_notes : how orbits were found, and what may be missing of them.
    """

    oscillator: Oscillator
    over: str
    ends: tuple[float, float]
    intervals: tuple[Interval, ...]
    branches: tuple[Branch, ...]
    orbit_notes: tuple[str, ...]

    def __new__(cls, without_orbits: Transitions, *_: Any) -> "OrbitTransitions":
        """The tuple is that of the transitions."""
        return super().__new__(cls, without_orbits)

    def __init__(
        self,
        without_orbits: Transitions,
        moved: tuple[Oscillator, str, tuple[float, float]],
        intervals: tuple[Interval, ...],
        branches: tuple[Branch, ...],
        orbit_notes: tuple[str, ...],
    ) -> None:
        self._proof = without_orbits._proof
        self.notes, (self.oscillator, self.over, self.ends) = without_orbits.notes, moved
        self.intervals, self.branches, self.orbit_notes = intervals, branches, orbit_notes

    @property
    def changes(self) -> tuple[OrbitChange, ...]:
        """The changes of orbits, in order of the value."""
        return tuple(change for interval in self.intervals for change in interval.changes)

    def __repr__(self) -> str:
        lines = []
        for interval in self.intervals:
            lines += [
                f"{row.kind} at {self.over} = {row.value:.12g}, tau = {row.tau:.6g}, t = {row.t:.6g}"
                for row in self
                if row.value == interval.low
            ]
            names = [_named(orbit) for orbit in interval.orbits]
            lines.append(
                f"from {interval.low:.9g} to {interval.high:.9g}: {', '.join(names) or 'none of these orbits'}"
            )
            lines += [f"  {change!r}" for change in interval.changes]
        return "\n".join([*lines, *self.notes, *self.orbit_notes])

    def both_sides(self, index: int, *, apart: Any = None, v: Any = None, size: int = 200) -> "BothSides":
        """The plane of states before and after a transition, for `si.plot`.

        Parameters
        ----------
        index : the transition. apart : the distance of both values from it; a twentieth of the interval without it, or
            less, so that no other transition lies between.
        v : ends of the velocities; from 0 to what the largest a_c gives in a quarter of a period without it.
        size : states a side of the basins.
        """
        if not -len(self) <= index < len(self):
            raise refuse("index", index, f"one of {len(self)} transitions")
        chosen = self[index]
        others = [abs(other.value - chosen.value) for other in self if other.value != chosen.value]
        most = min([SETTINGS.apart[0] * (self.ends[1] - self.ends[0]), *(SETTINGS.apart[1] * gap for gap in others)])
        step = most if apart is None else as_float(constant("apart", apart))
        require(step > 0, "apart", apart, "a number > 0")
        models = [_moved(self.oscillator, self.over, chosen.value + side * step) for side in (-1, 1)]
        need(models[0].period is not None, InputError("the forcing has no period: basins need one"))
        period = as_float(models[0].period)
        speeds = (0.0, largest_push(models[0]) * period / 4) if v is None else window_ends("v", v)
        tau = (chosen.tau - period / 2, chosen.tau + period / 2)
        planes = [basins(model, tau, speeds, whole("size", size, 2, 10_000)) for model in models]
        return BothSides(chosen, self.over, (models[0], models[1]), (planes[0], planes[1]))


@dataclass(frozen=True)
class BothSides:
    """Basins before and after a transition of P.

    Parameters
    ----------
    transition, over : where, and the number that is varied. models, basins : for a smaller and for a larger value.
    """

    transition: Transition
    over: str
    models: tuple[Oscillator, Oscillator]
    basins: tuple[Basins, Basins]


@checked_keywords
@takes_two_walls
def transitions(
    osc: Oscillator,
    over: str = "clearance",
    between: Any = None,
    t: Any = None,
    *,
    orbits: Any = None,
    kinds: Any = None,
    wall: object = None,
) -> Transitions:
    """Where P changes its kind as a number of the model moves, and what happens to periodic orbits on the way.

    Parameters
    ----------
    osc : the model. over : clearance, restitution, a parameter; "amplitude" and "damping" of any model, "stiffness" and
        "phase" of `si.linear`, need not be parameters of it. between : its ends.
    t : ends of the flight times; as for `classify` when they are not given, one period to both sides. Flights with two
        rests or more are listed where the time from the first rest to the last, or its negative, lies between them.
    kinds : some of "swan", "swallowtail", "tangency" (lips, beaks, and flights from tangency to tangency), "tacnode",
        "triple point", "periodic graze"; all without it.
    orbits : a whole number m, for the orbits of n impacts in k periods, n, k <= m, the one without impact and those
        with complete chatter; or pairs (n, k). Without it P alone is looked at.
    wall : of a model with two: "lower" (also without it) or "upper", moved by over="upper". Flights that meet the other
        wall are in the list, not visible; orbits= takes a model with one.

    Returns
    -------
    Transitions : a tuple in order of the number, each with `.kind`, `.value`, `.tau`, `.t`, the `.rests` of its flight,
        `.visible`, `.launch` and `.effect` in words; its `.visible` are those at which first hits change. `.complete`
        says whether it is proved that none is missing, `.doubts` why one may be. With `orbits` an `OrbitTransitions`:
        `.intervals` between transitions (of tacnodes and triple points the visible ones; at a periodic graze an orbit
        changes), with the orbits in the middle of each and `.changes`: grazes, hidden impacts, folds, period
        doublings, tori and pitchforks at their own values. Its `.both_sides(index)` is drawn by `si.plot`.

    Raises
    ------
    InputError : no number of the model, or ends that are no two numbers in rising order.

    Notes
    -----
    An orbit grazes where one of its flights begins at rest, a point of P for its end; that happens at a value of its
    own, at a transition only by coincidence (codimension two), but for the orbit without impact, whose graze is one. At
    the graze its multipliers jump: with the impact one
    tends to infinity, without it both are finite.

    Examples
    --------
    >>> from singimpact.impact_oscillator import linear
    >>> [(each.kind, each.value) for each in transitions(linear(2, 0, "0.5"), between=("0.9", "1.1"), t=(-1, 1))]
    [('swan, negative', 1.0)]
    >>> found = transitions(linear(2, 0, "0.5"), between=("0.9", "1.1"), t=(-1, 1), orbits=1)
    >>> [[orbit.kind for orbit in each.orbits] for each in found.intervals]
    [['chatter'], []]
    """
    require(isinstance(osc, Oscillator), "osc", osc, "an ImpactOscillator")
    pairs = None if orbits is None else _pairs(orbits)
    if pairs is not None and osc.period is None:
        raise InputError("the forcing has no period: periodic orbits need one")
    if pairs is not None and osc.upper is not None:
        raise refuse("orbits", orbits, "None for a model with two walls, or osc.one_wall('lower')")
    times = default_window(osc.seen_from(wall))[1] if t is None else t
    changes = transitions_of_outline(osc, wall, over, between, times, kinds)
    if pairs is None:
        return changes
    return _Search(changes, osc, over, window_ends(over, between), pairs).found()


def _pairs(orbits: Any) -> list[tuple[int, int]]:
    if isinstance(orbits, int | np.integer) and not isinstance(orbits, bool):
        most = whole("orbits", orbits, 1, SETTINGS.most)
        return [(0, 1), *((n, k) for n in range(1, most + 1) for k in range(1, most + 1))]
    try:
        return [(whole("n", n, 0, SETTINGS.most), whole("k", k, 1, SETTINGS.most)) for n, k in orbits]
    except (TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise refuse("orbits", orbits, f"a whole number from 1 to {SETTINGS.most}, or pairs (n, k)") from None


def _moved(osc: Oscillator, over: str, value: float) -> Oscillator:
    return with_number(osc, over).replace(**{over: value})


@dataclass
class _Search:
    """Orbits between transitions and their branches."""

    transitions: Transitions
    osc: Oscillator
    over: str
    ends: tuple[float, float]
    pairs: Sequence[tuple[int, int]]
    branches: list[Branch] = field(default_factory=list)

    def found(self) -> OrbitTransitions:
        """The transitions with intervals and branches."""
        low, high = self.ends
        # orbits are listed on both sides of these
        parting = [change for change in self.transitions if change.visible or change.event not in SEEN_ALONE]
        inner = {change.value for change in parting if low < change.value < high and change.event != "periodic graze"}
        edges = [low, *sorted(inner), high]
        middles = [(one + other) / 2 for one, other in pairwise(edges)]
        extra = np.linspace(low, high, SETTINGS.samples + 2)[1:-1].tolist()
        at_middles = {}
        for value in sorted({*middles, *extra}):
            orbits = self._orbits(value)
            if value in middles:
                at_middles[value] = orbits
            for orbit in orbits:
                if orbit.kind != "chatter" and not any(self._passes(curve, orbit, value) for curve in self.branches):
                    self.branches.append(branch(orbit, self.over, self.ends))
        # equal values, of orbits that meet at a graze, may differ by rounding
        changes = sorted(self._changes(), key=lambda change: (float(f"{change.value:.12g}"), change.n, change.k))
        intervals = tuple(
            Interval(
                one,
                other,
                tuple(at_middles[(one + other) / 2]),
                tuple(replace(change, interval=number) for change in changes if one <= change.value < other),
            )
            for number, (one, other) in enumerate(pairwise(edges))
        )
        note = (
            f"orbits are looked for at {len(set(middles) | set(extra))} values: those of branches between two of these "
            "alone are missing"
        )
        moved = self.osc, self.over, self.ends
        return OrbitTransitions(self.transitions, moved, intervals, tuple(self.branches), (note,))

    def _orbits(self, value: float) -> list[PeriodicOrbit]:
        osc = _moved(self.osc, self.over, value)
        if self.over == RESTITUTION and value >= 1:
            return []
        found = [orbit for n, k in self.pairs for orbit in periodic(osc, n, k)]
        return found + [orbit for k in sorted({k for _, k in self.pairs}) for orbit in periodic(osc, np.inf, k)]

    def _passes(self, followed: Branch, orbit: PeriodicOrbit, value: float) -> bool:
        if (followed.n, followed.k) != (int(orbit.n), orbit.k):
            return False
        at = np.append(followed.parameter - value, np.nan)
        for i in np.flatnonzero(at[:-1] * at[1:] <= 0).tolist():
            share = at[i] / (at[i] - at[i + 1]) if at[i] != at[i + 1] else 0.0
            if _alike(followed.orbit(i if share < 0.5 else i + 1), orbit):
                return True
        return False

    def _changes(self) -> Iterable[OrbitChange]:
        seen: list[OrbitChange] = []
        for followed in self.branches:
            for event in followed.events:
                below, above = _sides(followed, event)
                if set(below) | set(above) <= {"virtual"}:
                    continue
                change = OrbitChange(event.kind, event.parameter, followed.n, followed.k, event, below, above)
                if not any(_same(change, other) for other in seen):
                    seen.append(change)
        return seen


def _same(one: OrbitChange, other: OrbitChange) -> bool:
    """Whether two branches met the same event: a branch that folds may be followed from both of its sheets."""
    if (one.kind, one.n, one.k) != (other.kind, other.n, other.k):
        return False
    near = abs(one.value - other.value) <= 1e-9 * max(abs(one.value), abs(other.value), 1e-3)
    return near and _alike(one.event.orbit, other.event.orbit)


def _alike(one: PeriodicOrbit, other: PeriodicOrbit) -> bool:
    """Whether two orbits have nearly the same states."""
    if one.kind == "free":
        sizes = max(abs(float(one.x[0])), abs(float(other.x[0])), 1e-9)
        return bool(abs(float(one.x[0]) - float(other.x[0])) < SETTINGS.near * sizes)
    return same_states(one, other, SETTINGS.near)


def _sides(followed: Branch, event: Event) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The orbits of a branch next to an event, for smaller and for larger values."""
    below: list[str] = []
    above: list[str] = []
    plain = np.flatnonzero(~followed.at_event)
    for i in (*plain[plain <= event.index][-1:].tolist(), *plain[plain > event.index][:1].tolist()):
        word = _word(followed.multipliers[i]) if followed.visible[i] else WORDS[3]
        (below if followed.parameter[i] < event.parameter else above).append(word)
    return tuple(below), tuple(above)


def _word(multipliers: Any) -> str:
    size = float(np.abs(np.asarray(multipliers, dtype=complex)).max())
    return WORDS[1] if abs(size - 1) < SETTINGS.neutral else WORDS[0] if size < 1 else WORDS[2]


def _named(orbit: PeriodicOrbit) -> str:
    kind = _word(orbit.multipliers)
    if orbit.kind == "chatter":
        return f"(inf, {orbit.k}) chatter"
    return f"({orbit.n:.0f}, {orbit.k}) {kind}" if orbit.n else f"without impact, {kind}"
