"""Periodic orbits without impacts, those that chatter to rest and lift off again, and orbits from one lift-off on."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches.closing import FreeClosing, lowest
from singimpact.branches.orbits import Notes, PeriodicOrbit, PeriodicOrbits, chatter_orbit
from singimpact.contact.contact import acceleration as a_c
from singimpact.contact.points import window
from singimpact.dynamics import ENDING, chatter_left, release, rising_zeros, turns_between
from singimpact.dynamics.orbit import orbit
from singimpact.flights.family import Family, family
from singimpact.flights.impact_map import impact_map
from singimpact.flights.orbits import orbit_segment
from singimpact.oscillator import CLEARANCE, Oscillator, acceleration, linear_form
from singimpact.status import Status

SAME_PHASE = 1e-9  # lift-offs whose phases differ by less than this, of the period, are one
TOUCHING = 1e-12  # depth below the wall of an orbit that touches it, in units of the larger of |c| and 1
FAR = 30.0  # size of x and x', in units of the starts, at which Newton's method stops: stiff flights are slow
ROUNDS = 40  # steps of Newton's method at most
FLOWN = 4000  # impacts after a lift-off in which chatter must complete for the next one to be known


def free_orbits(osc: Oscillator, k: int, lowest_only: bool = False) -> PeriodicOrbits:
    """The orbits of k periods that do not meet the wall, each given by its lowest place.

    Parameters
    ----------
    osc : a model with a period. lowest_only : also those that are below the wall there, which are virtual.

    Examples
    --------
    >>> (found,) = free_orbits(Oscillator("x + 0.1*xdot", "cos(0.8*t)", -3, "0.8"), 1)
    >>> round(float(found.x[0]), 12), found.visible
    (-2.711630722733, True)
    """
    moving = family(osc, (CLEARANCE,))
    period = moving.period({CLEARANCE: as_float(osc.clearance)}).value
    orbits: list[PeriodicOrbit] = []
    linear = linear_form(osc) is not None
    wall, span = as_float(osc.clearance), k * period
    size = max(abs(wall), 1.0)
    starts = [(0.0, 0.0)] if linear else [(x, u) for x in size * np.array([-1.5, 0, 1.5]) for u in (-size, 0.0, size)]
    for start in starts:
        state = _closed(moving, start, span, np.inf if linear else FAR * size)
        if state is not None:
            one = _at_its_lowest(moving, osc, state, k)
            if one is not None and not any(abs(one.x[0] - other.x[0]) < 1e-9 * size for other in orbits):
                orbits.append(one)
    listed = orbits if lowest_only else [one for one in orbits if one.visible]
    doubts = () if linear else ("found from a grid of starts: it is not shown that there are no others",)
    if linear and not orbits:
        doubts = ("the free motion is in resonance: there is no periodic motion, or a continuum of them",)
    return PeriodicOrbits(listed, doubts)


def _closed(moving: Family, start: tuple[float, float], span: float, far: float) -> tuple[float, float] | None:
    """x and x' at time 0 of an orbit that closes after the span; None if Newton's method diverges."""
    x, u = start
    for _ in range(ROUNDS):
        end = moving.end({CLEARANCE: x}, 0.0, u, span)
        miss = np.array([end.place[0], end.place[1] - u])
        slope = np.stack([end.by_numbers[0], end.by_v - np.array([0.0, 1.0])], axis=1)
        if not np.isfinite(miss).all() or not np.isfinite(slope).all() or abs(np.linalg.det(slope)) < 1e-12:
            return None
        step = np.linalg.solve(slope, miss)
        x, u = x - float(step[0]), u - float(step[1])
        if not max(abs(x), abs(u)) <= far:
            return None
        if np.abs(step).max() <= 1e-14 * max(abs(x), abs(u), 1e-3):
            return x, u
    return None


def _at_its_lowest(moving: Family, osc: Oscillator, state: tuple[float, float], k: int) -> PeriodicOrbit | None:
    """The orbit with its lowest point, which is a turning point if the orbit has one minimum in each period."""
    x, u = state
    period = moving.period({CLEARANCE: x}).value
    # a turn and a half shows every turning point inside
    time, height = lowest(moving, {CLEARANCE: x}, (0.0, u, 1.5 * k * period))
    if not np.isfinite(height):
        return None
    span = k * period
    end = moving.end({CLEARANCE: x}, 0.0, u, time)
    across = moving.end({CLEARANCE: x + height}, float(np.mod(time, period)), float(end.place[1]), span)
    multipliers = np.linalg.eigvals(np.stack([across.by_numbers[0] + np.array([1.0, 0.0]), across.by_v], axis=1))
    miss = float(np.abs(across.place - np.array([0.0, end.place[1]])).max())
    order = np.argsort(-np.abs(multipliers))
    at, speed, position = (
        np.array([coordinate]) for coordinate in (np.mod(time, period), float(end.place[1]), x + height)
    )
    wall = as_float(osc.clearance)
    seen = height + x >= wall - TOUCHING * max(abs(wall), 1.0)
    return PeriodicOrbit(at, speed, multipliers[order], miss, np.int8(Status.hit), osc, 0, k, "free", seen, position)


def free_orbit_at(closing: FreeClosing, point: Array) -> PeriodicOrbit:
    """The orbit of a closed point x, x' at time 0 and numbers."""
    osc = closing.family.oscillator(closing.values(point))
    found = _at_its_lowest(family(osc, (CLEARANCE,)), osc, (float(point[0]), float(point[1])), closing.k)
    if found is None:
        raise ArithmeticError("an orbit without a lowest place")
    return found


def chatter_orbits(osc: Oscillator, k: int) -> PeriodicOrbits:
    """The orbits of k periods in which chatter completes and the mass rests until it lifts off.

    Notes
    -----
    The mass lifts off at finitely many phases, and what follows each is fixed: the next lift-off, rest for ever or no
    return. So each orbit is a circle of phases. `.complete` where this is known of every phase for k periods.

    Examples
    --------
    >>> [found] = chatter_orbits(Oscillator("x", "cos(2*t)", "0.7", "1/2"), 1)
    >>> round(float(found.tau[0]), 6), found.stable
    (2.743893, True)
    """
    phases, notes = list(rising_zeros(osc)), Notes()
    following = [_next_lift_off(osc, phases, index, k, notes) for index in range(len(phases))]
    orbits = list[PeriodicOrbit]()
    for first, phase in enumerate(phases):
        circle, turns, miss, step = [first], 0, 0.0, following[first]
        while step is not None:
            turns, miss = turns + step.periods, max(miss, step.miss)
            if step.place in circle:
                break
            circle.append(step.place)
            step = following[step.place]
        # of the phases of one circle the first stands for it; a phase that leads into a circle is not on it
        if step is not None and step.place == first == min(circle) and turns == k:
            orbits.append(chatter_orbit(osc, phase, k, miss))
    return PeriodicOrbits(orbits, tuple(notes.sentences))


@dataclass(frozen=True)
class _Lift:
    """The next lift-off: the place of its phase, the periods until then, by how much it misses that phase."""

    place: int
    periods: int
    miss: float


def _next_lift_off(osc: Oscillator, phases: list[float], index: int, k: int, notes: Notes) -> _Lift | None:
    """The lift-off within k periods after the one at phases[place]; None where there is none, or it is open: noted."""
    period, phase = as_float(osc.period), phases[index]
    end = phase + (k + 1) * period
    # an orbit of k periods is home by then: what an undamped one does later may be undecided in doubles, and slow
    for impacts in (20, 200, FLOWN):
        flown = orbit(osc, phase, 0, impacts=impacts)
        lifted = flown.tau[flown.kind == "release"][:1].tolist()
        ended = flown.phases[-1][0] if flown.phases else ""
        if lifted or flown.tau[-1] > end or ended in ("sticking", "no_return", "unresolved"):
            break
    for time in lifted:
        for other, zero in enumerate(phases):
            turns, miss = turns_between(zero, time, period)
            if miss < SAME_PHASE * period:
                return _Lift(other, turns, miss)
    if flown.tau[-1] <= end and ended not in ("sticking", "no_return"):
        notes.add(f"what follows the lift-off at tau = {phase:.6g} is open: no rest within {FLOWN} impacts in doubles")
    return None


# The orbit released at rest where a_c rises through zero, as a number of the model moves: where its chatter completes.
#
# What it does is told by the first later zero of that kind before which its chatter completes.  Flights are continuous
# in the number, grazes included, so this changes only where the orbit runs along gamma into such a zero.


@dataclass(frozen=True)
class ReleasedSettings:
    """Settings of an orbit from lift-off."""

    # impacts of the first block; each next one is twice as long, up to the longest
    block: int = 64
    longest: int = 4096
    # impacts at most
    impacts: int = 200_000
    # impacts flown on where the rest of a chatter does not end before the zero of a_c
    more: int = 8
    # steps of Newton's method for a zero of a_c; the search in doubles begins this fraction of a period before it
    steps: int = 20
    before: float = 1e-9


SETTINGS = ReleasedSettings()


@dataclass(frozen=True, eq=False)
class Released:
    """An orbit from its release to the end of its chatter, or past the last zero.

    Parameters
    ----------
    model : of this value of the number. tau : the release. zeros : the later zeros at which a_c rises, in order.
    times, speeds : of the impacts, just after each.
    place : of the zero before which its chatter completes, from 1; 0 where it passes all of them.
    decided : whether doubles decide all its flights.
    """

    model: Oscillator
    tau: float
    zeros: Array
    times: Array
    speeds: Array
    place: int
    decided: bool

    def impacts_before(self, place: int) -> int:
        """The number of impacts before a zero, given by its place."""
        return int(np.searchsorted(self.times, self.zeros[place - 1]))

    def landing(self, number: int, place: int) -> float:
        """The time of an impact, counted from 1, less that of a zero; nan where there is no such impact."""
        return float(self.times[number - 1] - self.zeros[place - 1]) if number <= self.times.size else np.nan

    def entry(self, place: int) -> int:
        """The number of the first impact after which a_c presses up to a zero; 0 where there is none."""
        before = self.tau if place == 1 else float(self.zeros[place - 2])
        inside = (self.times > before) & (self.times < self.zeros[place - 1])
        pressed = np.flatnonzero(inside & (acceleration(self.model, self.times) < 0))
        return int(pressed[0]) + 1 if pressed.size else 0


@dataclass(frozen=True)
class Releases:
    """The models of one number that is varied, and the orbits released in them.

    Parameters
    ----------
    osc : a model with a period, or whose g is a polynomial. over : the number.
    periods : of the forcing, after which an orbit is followed no more.
    """

    osc: Oscillator
    over: str
    periods: int

    def model(self, value: Any) -> Oscillator:
        """The model at a value of the number: a double or a Fraction, taken exactly."""
        return self.osc.replace(**{self.over: value})

    def followed(self, model: Oscillator, phases: tuple[float, ...]) -> tuple[float, ...]:
        """The phases at which a_c rises through zero, next to those of a model nearby; nan where a period has none."""
        near = tuple(_rising(model, phase) for phase in phases)
        # next to a swan releases move like a root: a model nearby may not lead to them
        lost = model.period is None and not np.isfinite(near).all()
        return rising_zeros(model) if lost else near

    def flown(self, value: Any, index: int, near: tuple[float, ...] | None = None) -> Released:
        """The orbit of one of the releases in a period, given by its index in their order.

        Parameters
        ----------
        near : the phases of the releases of a model nearby, which spares the search for them.

        Examples
        --------
        >>> found = Releases(Oscillator("x", "cos(2.8*t)", 0, "1/2"), "clearance", 1).flown(0.61, 0)
        >>> found.place, found.impacts_before(1) > 10
        (1, True)
        """
        model = self.model(value)
        return self.orbit(model, rising_zeros(model) if near is None else self.followed(model, near), index)

    def orbit(self, model: Oscillator, phases: tuple[float, ...], index: int) -> Released:
        """The orbit released at phases[index]."""
        return _Run(model, phases[index], self.zeros(model, phases, index)).released()

    def zeros(self, model: Oscillator, phases: tuple[float, ...], index: int) -> Array:
        """The zeros at which a_c rises after phases[index], in order, as far as an orbit is followed."""
        if model.period is None:
            return np.array(phases[index + 1 :])
        start, period = phases[index], as_float(model.period)
        turned = np.add.outer(np.arange(self.periods + 2) * period, np.array(phases)).ravel()
        if not np.isfinite(turned).all():
            return np.zeros(0)
        # a hundredth of the least distance is far more than rounding
        gap = np.diff(np.sort(np.append(phases, min(phases) + period))).min() / 100
        return np.sort(turned[(turned > start + gap) & (turned < start + self.periods * period + gap)])


def clock(model: Oscillator) -> float:
    """The period of the forcing; of a polynomial a length within which all zeros of a_c lie."""
    return 2 * float(window(model, a_c(model))[1]) if model.period is None else as_float(model.period)


def _rising(model: Oscillator, near: float) -> float:
    """The double from which the mass lifts off, next to a phase; nan where Newton's method does not find it."""
    period, at = clock(model), near
    for _ in range(SETTINGS.steps):
        value, slope = (float(acceleration(model, np.array([at]), order)[0]) for order in (0, 1))
        if not slope > 0 or not abs(at - near) < period / 4:
            return float("nan")
        at -= value / slope
        if abs(value) < SETTINGS.before * period * slope:
            break
    before = at - SETTINGS.before * period
    pressed = acceleration(model, np.array([before]))[0] < 0
    phase = release(model, before, 4 * SETTINGS.before * period) if pressed else np.inf
    return phase if np.isfinite(phase) else float("nan")


class _Run:
    """A released orbit that is being flown."""

    def __init__(self, model: Oscillator, start: float, zeros: Array) -> None:
        self.model, self.start, self.zeros = model, start, zeros
        self.times: list[Array] = []
        self.speeds: list[Array] = []
        self.count = 0

    def released(self) -> Released:
        if not self.zeros.size or not np.isfinite(self.start):
            return self._result(0, False)
        place = self._flown()
        return self._result(max(place, 0), place >= 0)

    def _result(self, place: int, decided: bool) -> Released:
        none = [np.zeros(0)]
        times, speeds = (np.concatenate(part or none) for part in (self.times, self.speeds))
        return Released(self.model, self.start, self.zeros, times, speeds, place, decided)

    def _flown(self) -> int:
        """The place of the zero before which chatter completes; 0: none, -1: not decided."""
        status, block, short = self._one(self.start, 0.0), SETTINGS.block, False
        while status == Status.hit:
            tau, v = float(self.times[-1][-1]), float(self.speeds[-1][-1])
            if tau >= self.zeros[-1]:
                return 0
            if self.count >= SETTINGS.impacts:
                return -1
            if v == 0:  # a graze: the mass goes on from rest
                status = self._one(tau, v)
                continue
            left = chatter_left(self.model, tau, v) if short else None
            short = left is not None
            if left is not None:
                following = int(np.searchsorted(self.zeros, tau))
                if tau + left[0] < self.zeros[following]:
                    return following + 1
            count, near = (SETTINGS.more, 0.0) if short else (block, ENDING.near)
            segment = orbit_segment(self.model, tau, v, count, near)
            self._add(segment.tau, segment.v)
            short, block = short or segment.short, min(2 * block, SETTINGS.longest)
            if segment.status:
                # a graze that a block of flights does not decide, or no impact any more: the map says which
                last = (float(segment.tau[-1]), float(segment.v[-1])) if segment.tau.size else (tau, v)
                status = self._one(*last)
        if status == Status.sticks:
            return int(np.searchsorted(self.zeros, float(self.times[-1][-1]))) + 1 if self.times else -1
        return 0 if status in (Status.no_return, Status.escaped) else -1

    def _one(self, tau: float, v: float) -> Status:
        step = impact_map(self.model, tau, v)
        status = Status(int(step.status))
        if status in (Status.hit, Status.graze):
            self._add(np.array([float(step.tau)]), np.array([float(step.v)]))
            return Status.hit
        return status

    def _add(self, times: Array, speeds: Array) -> None:
        if times.size:
            self.times.append(times)
            self.speeds.append(speeds)
            self.count += times.size


@dataclass(frozen=True)
class Return:
    """A released orbit that comes back next to gamma, at a value of the number.

    Parameters
    ----------
    releases : the models. value : of the number, a double. phases : of all releases there. index : of the one released.
    place : of the zero into which gamma runs, from 1. entry : the number of the first impact after which a_c presses.
    side : 1 where chatter completes for larger values of the number, -1 where for smaller ones.
    reach : the larger of the distances to the ends of the search: models farther away are not looked at.
    """

    releases: Releases
    value: float
    phases: tuple[float, ...]
    index: int
    place: int
    entry: int
    side: int
    reach: float

    def flown(self, value: float) -> Released:
        """The orbit at a value of the number nearby."""
        return self.releases.flown(value, self.index, self.phases)

    def ends(self, model: Oscillator) -> tuple[float, float]:
        """The release, and the zero into which gamma runs, of a model nearby."""
        phases = self.releases.followed(model, self.phases)
        return phases[self.index], float(self.releases.zeros(model, phases, self.index)[self.place - 1])
