"""A branch of periodic orbits over a parameter, through its grazes, with its events."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.branches.branch_walk import BranchWalk
from singimpact.branches.closing import Closing
from singimpact.branches.events import KINDS, Event, own_events
from singimpact.branches.orbit_curve import SETTINGS, places
from singimpact.branches.orbits import OfImpacts, PeriodicOrbit
from singimpact.branches.solutions import AnyClosing, closing_of, orbit_of, point_of
from singimpact.inputs import InputError, checked_keywords, refuse, takes_two_walls, whole
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION, UPPER, value_of, with_number
from singimpact.result import numbered

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
    if not low <= value <= high:
        raise refuse("between", between, f"an interval that holds {over} = {value:.12g} of the orbit")
    return low, high
