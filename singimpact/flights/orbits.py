"""Impacts in a row: of one orbit with every impact, and of many orbits with their last states."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.flights.blocks import LEAST, in_blocks, many
from singimpact.flights.causes import decoded
from singimpact.flights.compiled_model import allowed, compiled_model
from singimpact.flights.flat_numbers import EPSILON
from singimpact.flights.impact_map import impact_map
from singimpact.flights.kernels.hits import AT_REST, PRESSED
from singimpact.flights.states import States, as_written
from singimpact.flights.walls import at_walls, wall_codes
from singimpact.inputs import require_memory
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import reduced
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.result import Result, default_axes, in_words
from singimpact.status import Status, Wall, status_array

# Impacts below this velocity may be those of a chatter that is over, for a_c up to 1e10 times tau
SLOW = 1e-6


@dataclass(frozen=True, eq=False)
class Segment:
    """Impacts after a state.

    Parameters
    ----------
    tau, v : states just after each impact. flight_time, velocity : of the flights that ended there.
    acceleration : a_c at the launch of each flight. condition, error : of the flight times; of linear models.
    slopes : of flight time and velocity by tau and by v, shape (4, n); of linear models.
    status : of the flight that was not flown or did not end in an impact; 0 when all were flown or the chatter left is
        short.
    cause : why that flight is unresolved, see `singimpact.status.Cause`. short : whether the chatter left is short.
    wall : of each impact, int8; at the upper wall the velocity is > 0.
    """

    tau: Array
    v: Array
    flight_time: Array
    velocity: Array
    acceleration: Array
    condition: Array
    error: Array
    slopes: Array
    status: int
    cause: int
    short: bool
    wall: Array


def orbit_segment(
    osc: Oscillator, tau: float, v: float, count: int, near_end: float = 0.0, wall: int = Wall.lower
) -> Segment:
    """Fly at most `count` impacts from a state with v > 0; stop where the chatter left is short.

    Parameters
    ----------
    near_end : the part of the time on which a_c changes that the chatter left is below; 0 for never.
    wall : of the state.

    Examples
    --------
    >>> found = orbit_segment(Oscillator("0", "-2", 0, "1/2"), 0.0, 1.0, 3)
    >>> found.tau.tolist(), found.v.tolist(), found.status
    ([1.0, 1.5, 1.75], [0.5, 0.25, 0.125], 0)
    """
    model = compiled_model(osc if wall == Wall.lower else osc.mirrored)
    start = tau if osc.period is None or abs(tau) < model.nearest else float(reduced(np.array([tau]), osc.period)[0])
    rows, code = model.segment(start, v, count, near_end)
    if code == Status.no_rebound:  # the last impact leaves no velocity
        rows = rows[:-1]
    ended, cause = (int(codes[0]) for codes in decoded(np.array([0 if code == PRESSED else code])))
    since, speed, time, velocity, acceleration, condition, error = rows.T[:7]
    slopes, walls = rows.T[7:11], rows.T[11].astype(np.int8)
    if wall == Wall.upper:
        velocity, walls = -velocity, np.int8(1) - walls
        slopes = slopes * np.array([[1.0], [1.0], [-1.0], [-1.0]])
    return Segment(
        tau + since, speed, time, velocity, acceleration, condition, error, slopes, ended, cause, code == PRESSED, walls
    )


@dataclass(frozen=True, repr=False)
class Ends(Result):
    """The states after the last impact flown, and 0, or the status of the flight that ended an orbit before.

    Parameters
    ----------
    wall : int8, of the states of a model with two walls; None of others.
    """

    tau: Any
    v: Any
    status: Any
    wall: Any = None

    __repr__ = in_words

    def arrays(self) -> dict[str, tuple[tuple[str, ...], Any]]:
        """Names of axes and values; of states that were kept the number of the impact is the first axis."""
        of_one = default_axes(np.ndim(self.status))
        kept = ("impact",) * (np.ndim(self.tau) - np.ndim(self.status))
        values = super().arrays()
        return {name: (of_one if name == "status" else kept + of_one, value) for name, (_, value) in values.items()}


def iterate(
    osc: Oscillator,
    tau: Any,
    v: Any,
    impacts: int,
    tolerance: float = EPSILON,
    horizon: float | None = None,
    wall: Any = None,
) -> Ends:
    """G^impacts of states; an orbit that meets no further impact stays where it is.

    Parameters
    ----------
    osc : the model. tau, v : states that broadcast. impacts : flown. A chatter whose rest is below the last bit of tau
        ends as `complete`, with v = 0.
    tolerance : relative error of a Taylor step; closed forms keep to roundings. horizon : of a flight, in place of the
        default. wall : of the states of a model with two walls, as for `first_hit`.

    Examples
    --------
    >>> ends = iterate(Oscillator("0", "-2", 0, "1/2"), [0, 1], 1, 3)
    >>> ends.tau.tolist(), ends.v.tolist()
    ([1.75, 2.75], [0.125, 0.125])
    """
    if wall is not None:
        fly = partial(iterate, impacts=impacts, tolerance=tolerance, horizon=horizon)
        return at_walls(fly, osc, wall, (tau, v))  # type: ignore[no-any-return]
    if many(tau, v):
        return in_blocks(partial(iterate, osc, impacts=impacts, tolerance=tolerance, horizon=horizon), tau, v)  # type: ignore[no-any-return]
    states = States.read(tau, v).in_period(osc)
    model = compiled_model(osc)
    if osc.plastic:
        times, speeds, codes = _from_rest(osc, states, impacts, tolerance)
        shaped = (column.reshape(states.shape)[()] for column in (times + states.turns, speeds, codes))
        return Ends(*shaped)
    epsilon = EPSILON if model.linear else tolerance
    if epsilon > EPSILON or horizon is not None:
        longest = model.allowance.horizon if horizon is None else horizon
        model = allowed(osc, replace(model.allowance, epsilon=epsilon, horizon=longest))
    times, speeds, codes, sides = model.iterate(states.tau, states.v, impacts)
    if tolerance > EPSILON and (left := codes == Status.unresolved).any():
        # a graze that a coarse flight does not decide: one more impact, accurately
        accurate = compiled_model(osc).iterate(times[left], speeds[left], 1)
        times[left], speeds[left], codes[left], sides[left] = accurate
    codes = np.where(codes == AT_REST, np.int8(Status.sticks), codes)
    for side, model_there in enumerate(model.walls):
        at = np.flatnonzero(sides == side)
        over = at[_completed(model_there, times[at], speeds[at], codes[at])]
        codes[over], speeds[over] = Status.complete, 0.0
    parts = times + states.turns, speeds, decoded(codes)[0], sides.astype(np.int8)
    last = [column.reshape(states.shape)[()] for column in parts]
    return Ends(*(last if len(model.walls) == 2 else last[:3]))


def signed_iterate(
    osc: Oscillator,
    tau: Array | float,
    xdot: Array | float,
    impacts: int,
    tolerance: float = EPSILON,
    horizon: float | None = None,
) -> Ends:
    """`iterate` of states (tau, x') with x' instead of v, before and after: x' < 0, or -0.0, at an upper wall.

    Examples
    --------
    >>> signed_iterate(Oscillator("0", "-2", 0, "1/2", upper=2), 0, -1.5, 1).v.round(6).tolist()  # 2 - 1.5 t - t*t = 0
    1.600781
    """
    if osc.upper is None:
        return iterate(osc, tau, xdot, impacts, tolerance, horizon)
    ends = iterate(osc, tau, np.abs(xdot), impacts, tolerance, horizon, np.signbit(xdot).astype(np.int8))
    return replace(ends, v=signed(ends))


def signed(ends: Any) -> Array:
    """x' just after impacts, from a record with v and walls: -v at an upper wall."""
    return np.array(ends.v if ends.wall is None else np.where(ends.wall == Wall.upper, -ends.v, ends.v))


def _from_rest(osc: Oscillator, states: States, impacts: int, tolerance: float) -> tuple[Array, Array, Array]:
    """The last states and statuses where impacts leave no velocity: from the first one on the mass starts at rest.

    An orbit ends, as `sticks`, where a_c presses the mass to the wall after an impact.
    """
    times, speeds, codes = states.tau.copy(), states.v.copy(), np.zeros(states.v.size, np.int8)
    going = np.arange(times.size)
    for _ in range(impacts):
        step = impact_map(osc, times[going], speeds[going], tolerance=tolerance)
        ended = step.status != Status.hit
        codes[going[ended]] = step.status[ended]
        going = going[~ended]
        if not going.size:
            break
        times[going], speeds[going] = step.tau[~ended], 0.0
    return times, speeds, codes


def _completed(osc: Oscillator, tau: Array, v: Array, codes: Array) -> Array:
    """Where a chatter is over: a_c < 0, and all that is left of it does not change the double tau, or v underflowed.

    What is left of a chatter lasts about 2 v/(|a_c| (1 - r)).
    """
    over = np.zeros(tau.size, dtype=bool)
    r = as_float(osc.slope_at_rest())
    slow = np.flatnonzero(((codes == Status.hit) & (v < SLOW) & (r < 1)) | ((codes == Status.no_rebound) & (v == 0)))
    if slow.size and r > 0:
        a = acceleration(osc, tau[slow])
        over[slow] = (a < 0) & (2 * v[slow] <= EPSILON / 4 * np.abs(tau[slow]) * np.abs(a) * (1 - r))
    return over


def iterates(osc: Oscillator, tau: Any, v: Any, impacts: int, keep: bool, wall: Any = None) -> Ends:
    """`iterate`; where they are to be kept, with the states after every impact along a first axis."""
    if osc.upper is not None and wall is None:
        wall = Wall.lower
    if not keep:
        ends = iterate(osc, tau, v, impacts, wall=wall)
        return Ends(ends.tau, ends.v, status_array(ends.status), ends.wall)
    states = States.read(*np.broadcast_arrays(as_written("tau", tau), as_written("v", v), wall_codes(osc, wall))[:2])
    states = states.in_period(osc)
    require_memory("iterates kept", (impacts + 1, *states.shape), 2 * LEAST)  # rows, and rows put together
    walls = None if wall is None else np.broadcast_to(wall_codes(osc, wall), states.shape).ravel()
    rows = [Ends(states.tau, states.v, np.zeros(states.v.size, np.int8), walls)]
    for _ in range(impacts):
        last = rows[-1]
        ends = iterate(osc, last.tau, last.v, 1, wall=last.wall)
        rows.append(Ends(ends.tau, ends.v, np.where(last.status != 0, last.status, ends.status), ends.wall))
    shape = (impacts + 1, *states.shape)
    times, speeds = (
        np.stack(column).reshape(shape) for column in zip(*((row.tau, row.v) for row in rows), strict=True)
    )
    flown_to = None if walls is None else np.stack([row.wall for row in rows]).reshape(shape)
    turns = np.broadcast_to(states.turns, states.tau.shape).reshape(states.shape)
    return Ends(times + turns, speeds, status_array(rows[-1].status.reshape(states.shape)), flown_to)
