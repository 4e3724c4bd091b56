"""Orbits: impact after impact, rest on the obstacle and complete chatter in between; their motion at given times."""

import warnings
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from math import ceil, log
from typing import Any

import numpy as np

from singimpact.algebra.expressions import subtract
from singimpact.algebra.numbers import EPSILON, Array, as_float, constant, float_array
from singimpact.dynamics.chatter import ENDING, chatter_left, impacts_until
from singimpact.dynamics.lift_off import periods_between, release
from singimpact.dynamics.remaining import stays_below
from singimpact.flights.flight_path import Path, along, dropped
from singimpact.flights.horizons import horizon_of
from singimpact.flights.impact_map import impact_map
from singimpact.flights.limits import LIMITS
from singimpact.flights.off_wall import Launched, launch
from singimpact.flights.orbits import orbit_segment
from singimpact.flights.results import Step
from singimpact.flights.states import States
from singimpact.flights.walls import wall_codes
from singimpact.inputs import InputError, refuse, require, shown, whole
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.result import Result, plain
from singimpact.status import Status, Wall

# Impacts of one call into compiled code
BLOCK = 4096
# Through a chatter that was summed up velocities below this part of the largest one are 0: heights are then below its
# square
SLOW = 2.0**-52
# The phase before an event of a kind
BEFORE = {"impact": "flight", "graze": "flight", "complete": "chatter", "release": "sticking"}
# What follows the last event, by the kind of the phase after it
ENDINGS = {
    "": "all flights asked for were flown",
    "sticking": "at rest from there on",
    "unresolved": "the next flight is not resolved",
}


@dataclass(frozen=True, eq=False)
class Section(Result):
    """States of an orbit once a period.

    Parameters
    ----------
    t : times, one a period. x, xdot : the state at each.
    """

    t: Array
    x: Array
    xdot: Array

    def __repr__(self) -> str:
        return f"Section({self.t.size} states, one a period)"

    def after(self, states: int) -> "Section":
        """The section without its first states, such as those of a transient."""
        return Section(self.t[states:], self.x[states:], self.xdot[states:])


@dataclass(frozen=True, eq=False, repr=False)
class Orbit(Result):
    """The states of an orbit just after its events.

    Parameters
    ----------
    oscillator : the model.
    tau, v : time of every event and velocity just after it; the first entry is the given state.
    kind : of every event: `start`, `impact`, `graze`, `complete` (infinitely many impacts end there: the time is a sum
        of what was too short to fly), `release` (the mass at rest lifts off).
    phases : (kind, tau_start, tau_end), in order: `flight`, `chatter` (summed up), `sticking`; the last one may be
        `no_return`, `sticking` (tau_end inf) or `unresolved` (tau_end nan).
    end : the time up to which x(t) is known: of the last event; the horizon of a flight that does not return, or inf
        where it is proved never to; inf for a rest for ever.
    height : x - c at the start; 0 but for an orbit that starts off the wall, whose first v is x' there.
    wall : int8, of every event, of a model with two walls, 1 at the upper one; None of a model with one.
    """

    oscillator: Oscillator
    tau: Array
    v: Array
    kind: Array
    phases: list[tuple[str, float, float]]
    end: float
    height: float = 0.0
    wall: Array | None = None

    def sample(self, t: Any) -> Path:
        """x and x' at times, through flights, chatter and rest.

        Parameters
        ----------
        t : times, any shape.

        Returns
        -------
        Path : `.x`, `.xdot` of the shape of t; nan before the start and after `end`. At an impact x' is the velocity
            just after it; at rest x is the clearance and x' is 0.

        Notes
        -----
        The impacts of a chatter that was summed up are flown for the times asked, until their velocity is below a
        rounding of the largest one of the orbit; from there on x is the clearance and x' is 0.

        Examples
        --------
        >>> ball = orbit(Oscillator("0", "-2", 0, "1/2"), 0, 1)
        >>> ball.sample([-1, 0.5, 1, 1.25, 3]).x.tolist()
        [nan, 0.25, 0.0, 0.0625, 0.0]
        """
        times = float_array("t", t)
        flat = times.ravel()
        if flat.size and not ((flat >= self.tau[0]) & (flat <= self.end)).any():
            words = f"t = {shown(t)}: the orbit is known from {self.tau[0]:.6g} to {self.end:.6g}; x and xdot are nan"
            warnings.warn(words, stacklevel=3)
        order = np.argsort(flat, kind="stable")
        out, events = np.full((flat.size, 2), np.nan), (self.tau, self.v, self.kind)
        how = self._last_kind, self.end, self.height
        above = self.oscillator.upper
        if self.wall is None or above is None:
            out[order] = sampled(self.oscillator, events, *how, flat[order])
        else:
            walls = self.wall[np.maximum(np.searchsorted(self.tau, flat[order], side="right") - 1, 0)]
            lower, upper = order[walls == Wall.lower], order[walls == Wall.upper]
            out[lower] = sampled(self.oscillator, events, *how, flat[lower])
            out[upper] = -sampled(self.oscillator.mirrored, events, *how[:2], 0.0, flat[upper])
            # rounding next to an impact would above the mass behind the other wall
            out[:, 0] = np.clip(out[:, 0], as_float(self.oscillator.clearance), as_float(above))
        return Path(out[:, 0].reshape(times.shape)[()], out[:, 1].reshape(times.shape)[()])

    @property
    def speeds(self) -> Array:
        """x' just after each event: v, and -v at an upper wall."""
        return self.v if self.wall is None else np.where(self.wall == Wall.upper, -self.v, self.v)

    @property
    def places(self) -> Array:
        """x of the wall of each event."""
        low, high = self.oscillator.clearance, self.oscillator.upper
        if high is None or self.wall is None:
            return np.full(self.tau.size, as_float(low))
        return np.where(self.wall == Wall.upper, as_float(high), as_float(low))

    def section(self, phase: Any = 0) -> Section:
        """The states once a period of the forcing, from the start to the last event.

        Parameters
        ----------
        phase : the time after the start of each period, such as 0 or "pi/2.8".

        Returns
        -------
        Section : `.t`, the times phase + k period; `.x`, `.xdot` there. `si.plot` draws it, `.to_csv(file)` writes it.

        Raises
        ------
        InputError : the model has no period.

        Examples
        --------
        >>> found = orbit(Oscillator("x", "cos(4*t)", 0, "1/2"), 0, 1, impacts=60).section("pi/8")
        >>> found, bool(abs(found.x[-1] - found.x[-3]) < 1e-12)  # two periods an impact
        (Section(120 states, one a period), True)
        """
        if self.oscillator.period is None:
            raise refuse("model", self.oscillator, "one with a period: a section has one state a period")
        period, first = as_float(self.oscillator.period), as_float(constant("phase", phase))
        numbers = np.arange(np.ceil((self.tau[0] - first) / period), np.floor((self.tau[-1] - first) / period) + 1)
        times = first + period * numbers
        times = times[(times >= self.tau[0]) & (times <= self.tau[-1])]
        return Section(times, *self.sample(times))

    def as_dict(self) -> dict[str, Any]:
        """tau, v and kind of every event, and the phases between them."""
        phases = [{"kind": kind, "start": float(start), "end": float(end)} for kind, start, end in self.phases]
        walls = {} if self.wall is None else {"wall": plain(self.wall, "wall")}
        return {"tau": self.tau, "v": self.v, **walls, "kind": self.kind.astype(object), "phases": phases}

    @property
    def _last_kind(self) -> str:
        """The kind of the phase after the last event; empty where there is none."""
        return self.phases[-1][0] if len(self.phases) == self.tau.size else ""

    @property
    def _ending(self) -> str:
        if self._last_kind != "no_return":
            return ENDINGS[self._last_kind]
        proved = np.isinf(self.end)
        return "the mass never returns" if proved else f"no impact within {self.end - float(self.tau[-1]):.6g}"

    def __repr__(self) -> str:
        names = {"impact": "impacts", "graze": "grazes", "complete": "chatters that end", "release": "lift-offs"}
        counts = {word: int(np.count_nonzero(self.kind == name)) for name, word in names.items()}
        told = ", ".join(f"{count} {word}" for word, count in counts.items() if count or word == "impacts")
        at = "" if self.wall is None else f"wall = {Wall(int(self.wall[-1])).name}, "
        last = f"{at}tau = {self.tau[-1]:.17g}, v = {self.v[-1]:.17g}; {self._ending}"
        return f"Orbit from tau = {self.tau[0]:.9g} to {self.tau[-1]:.9g}: {told}\n  last state {last}"


def orbit(osc: Oscillator, tau: Any, v: Any, impacts: int = 200, *, horizon: Any = None, wall: Any = None) -> Orbit:
    """The orbit of a state through at most `impacts` flights.

    Parameters
    ----------
    osc : the model. tau, v : the state, v >= 0.
    impacts : how many flights are flown; a chatter that is summed up counts as one.
    horizon : flight time at which a flight is given up; None for the package default.
    wall : of the state, of a model with two walls: "lower" (also without it) or "upper".

    Notes
    -----
    What follows a lift-off is fixed by its phase. When the mass lifts off a wall at a phase again, the events since the
    first time are repeated, shifted by whole periods; they are not flown again.

    Returns
    -------
    Orbit : it is shorter when the mass does not return, rests for ever, or meets a graze that doubles cannot decide.

    Examples
    --------
    >>> found = orbit(Oscillator("0", "-2", 0, "1/2"), 0, 1)
    >>> found.kind.tolist(), found.tau.tolist(), found.phases[-1]
    (['start', 'complete'], [0.0, 2.0], ('sticking', 2.0, inf))
    """
    states = States.read(tau, v)
    if states.shape:
        raise InputError(f"tau and v have shape {states.shape}: an orbit starts from one state, give two numbers")
    most = whole("impacts", impacts, 0, 10**7)
    if states.v[0] > 0:
        states = states.in_period(osc)
    codes = wall_codes(osc, wall)
    require(not codes.shape, "wall", wall, "one wall: an orbit starts from one state")
    run = _Run(osc, (float(states.tau[0]), float(states.v[0])), horizon, most, int(codes))
    if isinstance(states.turns, float):
        run.given = states.given(0)
        return run.orbit()
    orbit, time = run.orbit(), float(states.turns[0])
    phases = [(kind, begin + time, end + time) for kind, begin, end in orbit.phases]
    return replace(orbit, tau=orbit.tau + time, phases=phases, end=orbit.end + time)


def dropped_orbit(osc: Oscillator, start: tuple[Any, Any, Any], impacts: int = 200, *, horizon: Any = None) -> Orbit:
    """The orbit of a start off the wall: (x, x', t), x at or above the clearance; the rest as for `orbit`.

    Examples
    --------
    >>> ball = dropped_orbit(Oscillator("0", "-2", 0, "1/2"), (4, 0, 0))
    >>> ball.kind.tolist(), ball.tau.tolist(), ball.sample([0, 1]).x.tolist()
    (['start', 'impact', 'complete'], [0.0, 2.0, 6.0], [4.0, 3.0])
    """
    x, xdot, t = start
    first = launch(osc, x, xdot, t, horizon=horizon)
    if np.ndim(first.status):
        shape = np.shape(first.status)
        raise InputError(f"x, xdot and t have shape {shape}: an orbit starts from one state, give three numbers")
    begin = as_float(constant("t", t)), as_float(constant("xdot", xdot))
    run = _Run(osc, begin, horizon, whole("impacts", impacts, 0, 10**7))
    if run.most:
        run.ended(first)
    return replace(run.orbit(), height=as_float(subtract(constant("x", x), osc.clearance)))


def sampled(
    osc: Oscillator, events: tuple[Array, Array, Array], last: str, end: float, height: float, times: Array
) -> Array:
    """x and x' at rising times, shape (n, 2); nan before the first event and after `end`.

    Parameters
    ----------
    osc : the model. events : tau, v and kind of every event. last : the kind of the phase after the last event.
    height : x - c at the first event.

    Examples
    --------
    >>> osc = Oscillator("0", "-2", "0.5", "1/2")
    >>> events = np.array([0.0, 1.0]), np.array([1.0, 0.5]), np.array(["start", "impact"])
    >>> sampled(osc, events, "", 1.0, 0.0, np.array([0.5, 1.0, 1.5])).tolist()
    [[0.75, 0.0], [0.5, 0.5], [nan, nan]]
    """
    tau, v, kind = events
    out = np.full((times.size, 2), np.nan)
    which = np.searchsorted(tau, times, side="right") - 1
    within = (which >= 0) & (times <= end)
    # a phase ends in the event after it; the last event itself is a state, of which a flight of no time is sampled
    flights = np.append((kind[1:] == "impact") | (kind[1:] == "graze"), last in ("", "no_return", "unresolved"))
    sums = np.append(kind[1:] == "complete", False)
    out[within] = 0.0
    for at in np.unique(which[within & sums[which]]).tolist():
        inside = np.flatnonzero(within & (which == at))
        out[inside] = _in_chatter(osc, float(tau[at]), float(v[at]), times[inside], SLOW * float(v.max()))
    flying = np.flatnonzero(within & flights[which])
    if height > 0:
        first = flying[which[flying] == 0]
        out[first] = dropped(osc, (float(tau[0]), float(v[0]), height), times[first] - tau[0])
        flying = flying[which[flying] > 0]
    launch = which[flying]
    out[flying] = along(osc, tau, v, launch, times[flying] - tau[launch])
    # rounding next to an impact would place the mass behind the obstacle
    out[:, 0] = np.maximum(out[:, 0], 0.0) + as_float(osc.clearance)
    return out


def _in_chatter(osc: Oscillator, tau: float, v: float, times: Array, slow: float) -> Array:
    """x - c and x' at rising times after a state whose impacts accumulate."""
    out, done = np.zeros((times.size, 2)), 0
    rate = -log(as_float(osc.slope_at_rest()))
    while done < times.size and v > slow:
        # where r = 1 the speeds fall like a power of the number of impacts
        count = min(BLOCK, ceil(log(v / slow) / rate) + 1) if rate else BLOCK
        segment = orbit_segment(osc, tau, v, count)
        starts, speeds = np.append(tau, segment.tau), np.append(v, segment.v)
        inside = np.arange(done, np.searchsorted(times, starts[-1]))
        launch = np.searchsorted(starts, times[inside], side="right") - 1
        out[inside] = along(osc, starts, speeds, launch, times[inside] - starts[launch])
        done += inside.size
        if segment.status or not starts[-1] > tau:  # doubles do not tell the impacts left apart
            break
        tau, v = float(starts[-1]), float(speeds[-1])
    return out


class _Run:
    """An orbit that is being flown: its events in blocks, its phases."""

    def __init__(self, osc: Oscillator, start: tuple[float, float], horizon: Any, most: int, wall: int = 0) -> None:
        self.osc, self.horizon, self.most = osc, horizon, most
        self.models = (osc,) if osc.upper is None else (osc, osc.mirrored)
        self.wall = wall
        # the first state as it was written
        self.given: tuple[Any, Any] = start
        self.tau, self.v = start
        self.begun, self.flown, self.over = self.tau, 0, False
        # the time up to which x(t) is known
        self.known = self.tau
        self.times, self.velocities = [np.array([self.tau])], [np.array([self.v])]
        self.kinds: list[Array] = [np.array(["start"], dtype="U8")]
        self.walls: list[Array] = [np.array([wall], np.int8)]
        self.phases: list[tuple[str, float, float]] = []
        # whether the chatter left is short, and how many impacts are flown before it can be summed up
        self.short, self.more = False, 0
        # time and wall of every lift-off, and how many blocks of events there were
        self.lifted: list[tuple[float, int, int]] = []

    @property
    def here(self) -> Oscillator:
        """The model whose lower wall is the wall of the state."""
        return self.models[self.wall]

    def orbit(self) -> Orbit:
        """All flights that are left, and what came of them."""
        while self.flown < self.most and not self.over:
            self.advance()
        times, velocities = np.concatenate(self.times), np.concatenate(self.velocities)
        known = max(self.known, float(times[-1]))
        walls = None if self.osc.upper is None else np.concatenate(self.walls)
        return Orbit(self.osc, times, velocities, np.concatenate(self.kinds), self.phases, known, wall=walls)

    def advance(self) -> None:
        """At least one flight, or the end of a chatter."""
        if self.v > 0 and self.horizon is None and not self.osc.plastic:
            if self.short and self._summed():
                return
            most, near = (self.more, 0.0) if self.short else (BLOCK, ENDING.near)
            count = min(self.most - self.flown, most)
            segment = orbit_segment(self.osc, self.tau, self.v, count, near, self.wall)
            self._impacts(segment.tau, segment.v, segment.wall)
            self.short = not segment.status and (self.short or segment.short)
            if not segment.status or self.flown == self.most:
                return
        self._mapped()

    def _impacts(self, times: Array, velocities: Array, walls: Array) -> None:
        self.phases += [("flight", begin, end) for begin, end in pairwise([self.tau, *times.tolist()])]
        if times.size:
            self._event(times, velocities, "impact", walls)
            self.flown += times.size

    def _event(self, times: Array, velocities: Array, kind: str, walls: Array | None = None) -> None:
        """Events of a kind; without `walls` at the present one."""
        self.walls.append(np.full(times.size, self.wall, np.int8) if walls is None else walls)
        self.wall = int(self.walls[-1][-1])
        self.times.append(times)
        self.velocities.append(velocities)
        self.kinds.append(np.full(times.size, kind, dtype="U8"))
        self.tau, self.v = float(times[-1]), float(velocities[-1])

    def _go(self, phase: str, tau: float, v: float, kind: str) -> None:
        self.phases.append((phase, self.tau, tau))
        self._event(np.array([tau]), np.array([v]), kind)

    def _end(self, phase: str, tau: float) -> None:
        self.phases.append((phase, self.tau, tau))
        self.over = True

    def _summed(self) -> bool:
        """Whether the chatter left is summed up, which counts as one flight."""
        left = chatter_left(self.here, self.tau, self.v)
        if left is None:  # a_c presses no more
            self.short = False
            return False
        time, error = left
        resolution = EPSILON * max(abs(self.tau), self.tau - self.begun)
        below = self.osc.upper is None or bool(
            stays_below(self.here, self.v, float(acceleration(self.here, np.array([self.tau]))[0]))
        )
        if not (error <= resolution and below):
            self.more = impacts_until(self.here, error, resolution) if below else 1
            return False
        self._go("chatter", self.tau + time, 0.0, "complete")
        self.flown, self.short = self.flown + 1, False
        self.rest()
        return True

    def _mapped(self) -> None:
        """One flight by the impact map, which says what became of it."""
        if self.v == 0 and len(self.times) > 1 and self.horizon is None:
            self.ended(_after_rest(self.here, self.tau), self.wall)
        else:
            given = self.given if len(self.times) == 1 else (self.tau, self.v)
            self.ended(impact_map(self.here, *given, horizon=self.horizon), self.wall)

    def ended(self, step: Step | Launched, wall: int = 0) -> None:
        """The end of one flight of the model whose lower wall is `wall`."""
        if step.wall is not None and step.status in (Status.hit, Status.graze):
            self.wall = int(step.wall) ^ wall
        self.flown, self.short = self.flown + 1, False
        match step.status:
            case Status.hit | Status.graze:
                kind = Status(int(step.status)).name.replace("hit", "impact")
                self._go("flight", float(step.tau), float(step.v), kind)
            case Status.sticks:
                if self.osc.plastic:  # the mass rests after each such impact: that is no flight
                    self.flown -= 1
                self.rest()
            case _:
                self.stops(int(step.status))

    def stops(self, status: int) -> None:
        """The end of the orbit, for a reason other than a rest."""
        if status in (Status.no_return, Status.escaped):
            self._end("no_return", np.inf)
            self.known = np.inf if status == Status.escaped else self.tau + horizon_of(self.osc, self.horizon)
        else:
            self._end("unresolved", np.nan)

    def rest(self) -> None:
        """The mass at rest, up to its lift-off."""
        lifted = release(self.here, self.tau)
        if not np.isfinite(lifted):
            self._end("sticking" if np.isinf(lifted) else "unresolved", lifted)
            if np.isinf(lifted):
                self.known = np.inf if self.osc.period is not None else self.tau + LIMITS.horizon_time
            return
        self._go("sticking", lifted, 0.0, "release")
        for earlier, wall, block in self.lifted:
            time = periods_between(self.osc, earlier, lifted)
            if time is not None and wall == self.wall:
                self._repeat(block, time)
                return
        self.lifted.append((lifted, self.wall, len(self.times)))

    def _repeat(self, block: int, time: float) -> None:
        """The events since a lift-off at this phase, again and again, until all flights asked for are there."""
        left = self.most - self.flown
        if not left:  # the chatter before this lift-off was the last flight asked for
            return
        times, velocities, kinds, walls = (
            np.concatenate(blocks[block:]) for blocks in (self.times, self.velocities, self.kinds, self.walls)
        )
        again = -(-left // np.count_nonzero(kinds != "release"))
        shifts = time * np.arange(1, again + 1)
        count = int(np.searchsorted(np.cumsum(np.tile(kinds != "release", again)), left, side="right"))
        phases = ([kind for kind, *_ in self.phases[-times.size :]] * again)[:count]
        ends = np.add.outer(shifts, times).ravel()[:count]
        self.phases += zip(phases, [self.tau, *ends[:-1].tolist()], ends.tolist(), strict=True)
        self.times.append(ends)
        self.velocities.append(np.tile(velocities, again)[:count])
        self.kinds.append(np.tile(kinds, again)[:count])
        self.walls.append(np.tile(walls, again)[:count])
        self.flown = self.most


def recorded(osc: Oscillator, events: tuple[Array, Array, Array, Array], status: int) -> Orbit:
    """An orbit whose events were flown elsewhere: their times, velocities, kinds and walls, and what ended it, or 0."""
    times, velocities, kinds, walls = events
    run = _Run(osc, (float(times[-1]), float(velocities[-1])), None, 0, int(walls[-1]))
    run.times, run.velocities, run.kinds, run.walls = [times], [velocities], [kinds], [walls]
    run.phases = [
        (BEFORE[kind], *ends) for kind, ends in zip(kinds[1:].tolist(), pairwise(times.tolist()), strict=True)
    ]
    if status == Status.sticks:
        run.rest()
    elif status:
        run.stops(status)
    return run.orbit()


@lru_cache(maxsize=256)
def _after_rest(osc: Oscillator, tau: float) -> Step:
    """The flight of a mass that lifts off from rest; every orbit that rests there goes on with it."""
    return impact_map(osc, tau, 0.0)
