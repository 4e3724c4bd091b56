"""Bifurcation diagrams: the last impacts of one long orbit for each value of a parameter."""

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass, field
from functools import partial
from typing import Any, ClassVar

import numpy as np

from singimpact.algebra.expressions import names_in
from singimpact.algebra.numbers import Array, as_float
from singimpact.case_pools import ThreadPool
from singimpact.cases import sweep
from singimpact.dynamics import attractors as kinds
from singimpact.dynamics.behaviours import LongRun, behaviour, matched
from singimpact.dynamics.free_motion import free_fates
from singimpact.dynamics.long_run import chaotic
from singimpact.dynamics.orbit import Orbit, dropped_orbit, orbit
from singimpact.dynamics.phases import Times, phases_of
from singimpact.dynamics.settling import Study
from singimpact.dynamics.synchrony import meets
from singimpact.inputs import checked_keywords, refuse, require, require_known, require_memory, takes_two_walls
from singimpact.oscillator.model import Oscillator, require_model
from singimpact.oscillator.moving_number import with_number
from singimpact.oscillator.period import moving_in_time, oscillates
from singimpact.result import Result
from singimpact.surface.curve import window_ends

# Total of impacts below which no processes are started: about 5 s of work
FEW = 200_000


# Impacts at most, of an orbit that does not settle
SETTLE = 20_000
# Events of the longest period that is looked for, and relative distance of events that repeat
PERIOD, CLOSE = 64, 1e-6
Row = tuple[float, float, float]
WAYS = {"up": ("up",), "down": ("down",), "both": ("up", "down")}


@dataclass(frozen=True)
class Bifurcation(Result):
    """Events of settled orbits.

    Attributes
    ----------
    over : the parameter. values : its values in the order of computation. events : shape (values, kept,
        3): phase, v, 1 where chatter ended; nan where an orbit had fewer. Without a period the time since
        the event before stands in place of the phase.
    direction : "up", "down" or "both" where each orbit starts from the last state of the one before: with "both" the
        values go up, then down. Empty where each starts from one state.
    periods : of the forcing at each of the values, nan without one. settled : bool of each value: the events are those
        of an attracting orbit or repeat, or no impact comes before the horizon; False where a flight is unresolved.
    settle : impacts after which an orbit that has not settled was left.
    attractors : of each value, with the names that basins have. labels : their numbers, shape (values,), equal where
        attractors of values next to one another are of one class and their states are near, see `si.basins`.
    rotation : of each value, periods of the forcing an impact, k/n of an (n, k) orbit; nan of others.
    """

    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "values": ("value",),
        "periods": ("value",),
        "settled": ("value",),
        "class": ("value",),
        "labels": ("value",),
        "rotation": ("value",),
        "events": ("value", "event", "phase_v_ended"),
    }
    over: str
    values: Array
    events: Array
    direction: str = ""
    periods: Array = field(default_factory=lambda: np.ones(1), repr=False)
    settled: Array = field(default_factory=lambda: np.ones(1, dtype=bool), repr=False)
    settle: int = 0
    attractors: tuple[LongRun, ...] = field(default=(), repr=False)

    @property
    def labels(self) -> Array:
        """Numbers of the attractors, which are followed from value to value."""
        units = np.broadcast_to(np.nan_to_num(self.periods, nan=np.inf), self.values.shape).tolist()
        fast = float(np.nanmax(np.abs(self.events[..., 1]), initial=1e-300))
        return np.ravel(matched([[run] for run in self.attractors], units, fast)[1])

    @property
    def rotation(self) -> Array:
        """Rotation numbers k/n of (n, k) orbits; nan of other attractors."""
        counts = np.array([(run.k, run.n) if run.kind == "orbit" else (0, 0) for run in self.attractors], dtype=float)
        return np.asarray(np.divide(*np.where(counts > 0, counts, np.nan).T))

    def __repr__(self) -> str:
        count, kept = self.events.shape[:2]
        ends = f"{self.values.min():.6g} to {self.values.max():.6g}"
        carried = {"": "", "both": ", up and down"}.get(self.direction, f", {self.direction}")
        left = np.count_nonzero(~self.settled)
        open_ = f"; {left} without a period seen in at most {self.settle} impacts" if left else ""
        return f"Bifurcation(over {self.over}: {count} values from {ends}{carried}, {kept} events of each{open_})"

    def as_dict(self) -> dict[str, Any]:
        """The number that moves, its values, and for each value phase, v, 1 for an end of chatter, of every event."""
        return (
            {"over": self.over, "direction": self.direction, "settle": self.settle}
            | {name: getattr(self, name) for name in ("values", "events", "periods", "settled", "labels", "rotation")}
            | {"class": np.array([each.name for each in self.attractors], dtype=object)}
        )

    def table(self) -> dict[str, Array]:
        """One row for each event: value, phase, v, 1 for an end of chatter, and the label of its attractor."""
        phase, v, ended = self.events.reshape(-1, 3).T
        there = np.isfinite(phase)
        values = np.repeat(self.values, self.events.shape[1])[there]
        ends = ended[there].astype(int)
        labels = np.repeat(self.labels, self.events.shape[1])[there]
        return {self.over: values, "phase": phase[there], "v": v[there], "chatter_ended": ends, "attractor": labels}


@checked_keywords
@takes_two_walls
def bifurcation(
    osc: Oscillator,
    over: str,
    between: Any,
    points: int = 300,
    *,
    start: Any = (0, "0.1"),
    impacts: int = 200,
    kept: int = 60,
    direction: str | None = None,
    **sweeping: Any,
) -> Bifurcation:
    """A bifurcation diagram: the last events of one orbit for each value of a parameter.

    Parameters
    ----------
    osc : a model with a period, without t, or with sums of waves in t.
    over : "clearance", "restitution", a parameter, "amplitude", "damping", "stiffness" or "phase" (also if the model
        does not name them). between : its interval. points : values, evenly spaced.
    start : the first state (tau, v) of each orbit. impacts : number for each value.
    kept : last events of each orbit that are returned.
    sweeping : `settle`, the impacts at most of an orbit whose events do not repeat (20000); `executor` and `output` of
        `sweep`.
    direction : "up", "down", "both": each orbit starts from the last state of the one before, so hysteresis shows.

    Returns
    -------
    Bifurcation : `.values`, shape (points,), and `.events`, shape (points, kept, 3): phase, v (-v at an upper wall)
        and 1 where chatter has ended; nan where an orbit had fewer; without a period the time since the event before
        stands in place of the phase. `.settled`, shape (points,): whether the events repeat, or where the forcing never
        does, whether a neighbour comes to the orbit; `.attractors` have the names of basins. `si.plot` draws it,
        `.to_csv(file)` writes it.

    Raises
    ------
    InputError : another model, an unknown parameter, or an interval that is not valid.

    Examples
    --------
    >>> found = bifurcation(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance", ("0.2", "0.22"), 2, kept=4)
    >>> found
    Bifurcation(over clearance: 2 values from 0.2 to 0.22, 4 events of each)
    >>> found.events[0, :, 1].round(6).tolist(), found.labels.tolist(), found.rotation.tolist()
    ([1.066667, 1.066667, 1.066667, 1.066667], [0, 0], [1.0, 1.0])
    """
    accepted = ["executor", "output", "settle", "start", "impacts", "kept", "direction"]
    require_known("argument of bifurcation", sweeping, accepted)
    require_model("osc", osc)
    model = with_number(osc, over)
    if model.period is None and not oscillates(model.force(), model.forcing()):
        raise refuse("model", model, "one with a period, without t, or with sums of waves in t")
    for name, value, least in (("points", points, 2), ("impacts", impacts, 1), ("kept", kept, 1)):
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            raise refuse(name, value, f"a whole number from {least}")
    settle = sweeping.pop("settle", SETTLE)
    low, high = window_ends(over, between)
    require_memory("values with their last events", (points, kept), 48)  # three doubles each, and a copy
    values = np.linspace(low, high, points)
    periods = np.full(values.size, as_float(model.period))
    if any(over in names_in(tree) for tree in moving_in_time(model.f, model.g).values()):  # of others it is one
        periods = np.array([as_float(model.replace(**{over: value}).period) for value in values.tolist()])
    if direction is not None:
        require(direction in WAYS, "direction", direction, "'up', 'down' or 'both'")
        if any(value is not None for value in sweeping.values()):
            raise refuse("direction", direction, "it without executor= and output=: its orbits are flown in a row")
        values, periods = (
            np.concatenate([column[:: 1 if way == "up" else -1] for way in WAYS[direction]])
            for column in (values, periods)
        )
        events = _carried(model, over, values, start, (impacts, kept, settle))
        return _result((model, over, values), events, direction, periods, max(settle, impacts))
    ask = partial(settled, dict(model.to_dict()), over, tuple(map(str, start)), (impacts, kept, settle))
    few = sweeping.get("executor") is None and points * impacts <= FEW
    with ThreadPool(1) if few else nullcontext(sweeping.get("executor")) as pool:
        events = sweep(ask, values.tolist(), **(sweeping | {"executor": pool}))
    return _result((model, over, values), np.array(events), "", periods, max(settle, impacts))


def _result(
    numbers: tuple[Oscillator, str, Array], events: Array, direction: str, periods: Array, settle: int
) -> Bifurcation:
    """The result for a model, the number that moves and its values; the last two rows of each value's events are not
    events but whether it has settled, and the row of its class.
    """
    model, over, values = numbers
    models = [model.replace(**{over: value}) for value in values.tolist()]
    runs = tuple(
        behaviour(Study(moved, (), 1.0, settle), row) for moved, row in zip(models, events[:, -1], strict=True)
    )
    return Bifurcation(over, values, events[:, :-2], direction, periods, events[:, -2, 0] == 1, settle, runs)


def settled(
    fields: Mapping[str, Any], over: str, start: tuple[str, ...], flown: tuple[int, int, int], value: float
) -> Array:
    """The last events of one orbit. A module-level function, so that it can be pickled."""
    model = Oscillator(**fields).replace(**{over: value})
    return _last_events(*_followed(orbit(model, start[0], start[1], flown[0]), flown), flown)


def _followed(first: Orbit, flown: tuple[int, int, int]) -> tuple[Orbit, Row]:
    """An orbit, or its continuation until the events repeat; and the row of its class, as of `classify`.

    Parameters
    ----------
    flown : impacts of the first orbit, events of the end that are shown, impacts at most.
    """
    last, count, block = first, flown[0], flown[0]
    while (row := _ending(last)) is None and count < flown[2]:
        block = min(2 * block, flown[2] - count)
        last = orbit(last.oscillator, _phase(last, float(last.tau[-1])), float(last.v[-1]), block, wall=_wall(last))
        count += block
    if row is None:
        tau, v = np.array([_phase(last, float(last.tau[-1]))]), last.speeds[-1:]
        flies = last.kind[-1] == "impact"
        grows = flies and bool(chaotic(last.oscillator, tau, v, max(float(last.v.max()), 1e-300))[0])
        row = (kinds.CHAOS if grows else kinds.OTHER, 0.0, 0.0)
    return last, row


def _wall(flown_orbit: Orbit) -> int | None:
    """The wall of the last event; None of a model with one."""
    return None if flown_orbit.wall is None else int(flown_orbit.wall[-1])


def _phase(flown_orbit: Orbit, time: float) -> float:
    """A time within a period; 0 where the model has no clock, and the time where nothing repeats."""
    phases = phases_of(flown_orbit.oscillator)
    return float(np.mod(time, phases.unit) if phases.clocked and phases.repeats else phases.of(np.array(time)))


def _ending(flown_orbit: Orbit) -> Row | None:
    """The row of the class, where the last events are those of a period before, or no other follows."""
    last = flown_orbit.phases[-1][0] if flown_orbit.phases else ""
    if last in ("no_return", "unresolved"):
        if flown_orbit.oscillator.autonomous:
            height = flown_orbit.places[-1:] - as_float(flown_orbit.oscillator.clearance)
            height += flown_orbit.height if flown_orbit.tau.size == 1 else 0.0
            row = free_fates(flown_orbit.oscillator, height, flown_orbit.speeds[-1:])[0]
            if np.isfinite(row[0]) and row[0] not in (kinds.AWAY, kinds.STUCK):
                return tuple(row.tolist())
        return (
            kinds.STUCK if last == "unresolved" else kinds.GONE if np.isinf(flown_orbit.end) else kinds.AWAY,
            0.0,
            0.0,
        )
    if last == "sticking" and not np.isfinite(flown_orbit.phases[-1][2]):
        return (kinds.CHATTER, -1.0 - (_wall(flown_orbit) or 0), 0.0)
    shown = np.isin(flown_orbit.kind, ("impact", "graze", "complete"))
    tau, v = flown_orbit.tau[shown], flown_orbit.speeds[shown]
    phases, fast = phases_of(flown_orbit.oscillator), max(float(np.abs(v).max(initial=0.0)), 1e-300)
    if not phases.repeats:
        rests = np.count_nonzero(flown_orbit.kind == "release") > 1
        return (kinds.RESTING, 0.0, 0.0) if rests else _response(flown_orbit, fast)
    if not phases.clocked:
        n = _cycle(np.diff(tau), v[1:])
        return _orbit(flown_orbit, n, fast) if n else None
    if turn := _between_lift_offs(flown_orbit):
        return (kinds.CHATTER, 0.0, float(phases.periods(np.array(turn))))
    for n in range(1, min(PERIOD, tau.size // 2) + 1):
        last_ones, before = slice(-n, None), slice(-2 * n, -n)
        if kinds.apart((tau[last_ones], v[last_ones]), (tau[before], v[before]), phases, fast).max() < CLOSE:
            if not (flown_orbit.kind[flown_orbit.tau >= tau[-2 * n]] == "impact").all():
                return (kinds.CHATTER, 0.0, float(phases.periods(tau[-1] - tau[-1 - n])))
            return _orbit(flown_orbit, n, fast)
    return None


def _between_lift_offs(flown_orbit: Orbit) -> float:
    """The time since the last lift-off of the phase and the wall of the last one, which fix what follows; 0 without."""
    lifted = np.flatnonzero(flown_orbit.kind == "release")
    if not lifted.size:
        return 0.0
    times = flown_orbit.tau[lifted]
    same = np.abs(phases_of(flown_orbit.oscillator).off(times[:-1], times[-1])) < CLOSE
    if flown_orbit.wall is not None:
        same &= flown_orbit.wall[lifted[:-1]] == flown_orbit.wall[lifted[-1]]
    return float(times[-1] - times[:-1][same][-1]) if same.any() else 0.0


def _response(flown_orbit: Orbit, fast: float) -> Row | None:
    """The row of an orbit under a forcing that never repeats, where a neighbour comes to it."""
    tau, v = float(flown_orbit.tau[-1]), float(flown_orbit.speeds[-1])
    return (kinds.RESPONSE, tau, v) if v and meets(Study(flown_orbit.oscillator, (), fast, 1), tau, v) else None


def _cycle(spans: Array, v: Array) -> int:
    """Events of the limit cycle that the last events of a model without a clock are within `close` of, or 0.

    The distance that is left is that of a geometric sequence with the ratio of the last two changes.
    """
    sizes = Times(max(float(spans.max(initial=0.0)), 1e-300)), max(float(np.abs(v).max(initial=0.0)), 1e-300)
    for n in range(1, min(PERIOD, v.size // 3) + 1):
        parts = [(spans[v.size - k * n :][:n], v[v.size - k * n :][:n]) for k in (1, 2, 3)]
        last, before = (kinds.apart(parts[i], parts[i + 1], *sizes).max() for i in (0, 1))
        if last < CLOSE and (last < 1e-14 or last * last < CLOSE * max(before - last, 0.0)):
            return n
    return 0


def _orbit(flown_orbit: Orbit, n: int, fast: float) -> Row | None:
    """The row of an attracting orbit of n impacts with the last impact, which is not on its way past or towards one."""
    end, v = flown_orbit.tau[flown_orbit.kind == "impact"], flown_orbit.speeds[flown_orbit.kind == "impact"]
    phases = phases_of(flown_orbit.oscillator)
    turns, tau = phases.periods(end[-1:] - end[-1 - n]).astype(np.int64), phases.of(end[-1:])
    beside = kinds.nearby_orbits(flown_orbit.oscillator, tau, v[-1:], np.array([n]), turns, fast)
    away = kinds.apart((beside.tau, beside.v), (tau, v[-1]), phases, fast)
    if not np.where(beside.found, away < CLOSE, beside.returned)[0]:
        return None
    n, k = (int(beside.n[0]), int(beside.k[0])) if beside.found[0] else (n, int(turns[0]))
    if not phases.clocked and kinds.neutral(flown_orbit.oscillator, np.array([n]), v[-1:])[0]:
        return (kinds.LEVEL, 0.0, 0.0)
    return (n * kinds.PLACES + k, float(tau[0]), float(v[-1]))


def _carried(model: Oscillator, over: str, values: Array, start: Any, flown: tuple[int, int, int]) -> Array:
    """The last events of orbits each of which starts from the last state of the one before.

    Parameters
    ----------
    flown : impacts of an orbit, events of its end, impacts at most.
    """
    rows: list[Array] = []
    last: Orbit | None = None
    row: Row = (kinds.OTHER, 0.0, 0.0)
    for value in values.tolist():
        moved = model.replace(**{over: value})
        first = orbit(moved, start[0], start[1], flown[0]) if last is None else _continued(moved, last, row, flown[0])
        last, row = _followed(first, flown)
        rows.append(_last_events(last, row, flown))
    return np.array(rows)


def _continued(moved: Oscillator, last: Orbit, row: Row, impacts: int) -> Orbit:
    """The orbit of a model from the last state of another one; the phase within the period is kept."""
    if row[0] in (kinds.CYCLE, kinds.STILL):  # from the least x of the cycle, or the rest
        height = row[2] if row[0] == kinds.CYCLE else row[1]
        x = _between(moved, as_float(last.oscillator.clearance) + height)
        return dropped_orbit(moved, (x, 0.0, 0.0), impacts)
    period, before = phases_of(moved).unit, phases_of(last.oscillator).unit
    away = bool(last.phases) and last.phases[-1][0] == "no_return"
    # periods after which a motion without impact is taken as settled
    time = min(last.end, float(last.tau[-1]) + 200 * before) if away else float(last.tau[-1])
    tau = _phase(last, time) / before * period
    if not away:
        return orbit(moved, tau, float(last.v[-1]), impacts, wall=_wall(last))
    # off the wall: the motion without impact is carried on
    state = last.sample(time)
    return dropped_orbit(moved, (_between(moved, float(state.x)), float(state.xdot), tau), impacts)


def _between(moved: Oscillator, x: float) -> float:
    """A place at or above the wall, and at or below an upper one."""
    x = max(x, as_float(moved.clearance))
    return x if moved.upper is None else min(x, as_float(moved.upper))


def _last_events(flown_orbit: Orbit, row: Row, flown: tuple[int, int, int]) -> Array:
    """Impacts, grazes and ends of chatter (1 in the last column) of the end of an orbit, and whether it has settled.

    Shape (kept + 2, 3): the first number of the last row but one is 1 where it has; the last row is that of its class.
    """
    repeats = row[0] not in (kinds.OTHER, kinds.CHAOS, kinds.STUCK)
    shown, count = np.isin(flown_orbit.kind, ("impact", "graze", "complete")), flown[1]
    rows = np.stack([flown_orbit.tau, flown_orbit.speeds, flown_orbit.kind == "complete"], axis=1)[shown]
    if flown_orbit.oscillator.period is None:
        rows[:, 0] = np.diff(rows[:, 0], prepend=flown_orbit.tau[0])
    last = rows[max(flown[0] - count, 0) :][-count:]
    if row[0] in (kinds.CYCLE, kinds.STILL):  # the impacts before belong to the transient
        last = rows = rows[:0]
    events = last if len(last) else rows[-1:]  # one that has come to rest for ever shows only that
    if flown_orbit.oscillator.period is not None:
        events[:, 0] = np.mod(events[:, 0], as_float(flown_orbit.oscillator.period))
    return np.vstack([events, np.full((count - len(events), 3), np.nan), [[float(repeats), 0.0, 0.0], row]])
