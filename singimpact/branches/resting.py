"""Periodic orbits without impacts, and those that chatter to rest and lift off again."""

from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches.closing import FreeClosing, lowest
from singimpact.branches.orbits import Notes, PeriodicOrbit, PeriodicOrbits, chatter_orbit
from singimpact.dynamics.lift_off import turns_between
from singimpact.dynamics.long_run import lift_offs
from singimpact.dynamics.orbit import orbit
from singimpact.flights.family import Family, family
from singimpact.oscillator.linear import linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE
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
    phases, notes = list(lift_offs(osc)), Notes()
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
