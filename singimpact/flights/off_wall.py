"""Flights that start off the wall: the first impact, and the state after it.

No root of x - c is removed at such a start.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache, partial
from math import fsum, inf, isnan
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression, Number, negate, subtract
from singimpact.algebra.numbers import Array, as_float, as_mpf, constant, float_array
from singimpact.algebra.precision import digits_at
from singimpact.flights.bind import over_mpmath
from singimpact.flights.causes import where
from singimpact.flights.compiled_model import CompiledModel, allowed, compiled_model
from singimpact.flights.flat_numbers import gap_of
from singimpact.flights.horizons import Allowance, horizon_of, steps_of
from singimpact.flights.impact_map import impact_map
from singimpact.flights.interpreted import workspace
from singimpact.flights.kernels.entries import DROPS
from singimpact.flights.kernels.hits import NOT_REFINED
from singimpact.flights.kernels.state import Rules
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.model_numbers import constants_of, recurrence_of
from singimpact.flights.rebound_law import rebound
from singimpact.flights.results import SCALAR_STATUS
from singimpact.flights.states import States, as_written, require_room
from singimpact.flights.undecided import Fates, escapes, refined_hit
from singimpact.flights.walls import at_walls
from singimpact.inputs import InputError, refuse, require
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result, in_words
from singimpact.status import Cause, Status, status_array


@dataclass(frozen=True, eq=False, repr=False)
class Launched(Result):
    """First impacts of flights that start off the wall.

    Parameters
    ----------
    tau, v, wall : the states just after the impacts, as those of a `Step`. flight_time : from the start to the impact;
        inf when there is none, nan beside `unresolved`. velocity : x' at the impact.
    status, cause : int8, see `singimpact.status`.
    notes : for unresolved flights, by their index in the flat arrays: where the flight came to.
    """

    tau: Any
    v: Any
    flight_time: Any
    velocity: Any
    status: Any
    cause: Any
    notes: Mapping[int, str] = field(default_factory=dict)
    wall: Any = None

    __repr__ = in_words

    @property
    def sentence(self) -> Any:
        """The outcome of each flight: a text, or an array of texts of the shape of `status`."""
        pairs = zip(np.ravel(self.status).tolist(), np.ravel(self.cause).tolist(), strict=True)
        causes = {cause: Cause(cause).sentence.partition(":")[0] for cause in np.unique(self.cause).tolist()}
        texts = [
            f"{self.notes[at]}; {causes[cause]}" if cause else Status(status).sentence
            for at, (status, cause) in enumerate(pairs)
        ]
        return np.array([*texts, None], dtype=object)[:-1].reshape(np.shape(self.status))[()]


NAMES = ("t", "xdot", "x")
# Starts of a call up to which reading them costs as much as their flights
FEW_STARTS = 1000


def launch(osc: Oscillator, x: Any, xdot: Any, t: Any, *, horizon: Any = None) -> Launched:
    """The first impact of flights from (x, x') at time t, off the wall or on it.

    Parameters
    ----------
    osc : the model. x : places, at or above the clearance, at or below an upper wall.
    xdot : velocities of either sign. t : times; they broadcast.
    horizon : time after which a flight is given up; None for the package default.

    Returns
    -------
    Launched : `.tau`, `.v` just after the impact, `.flight_time`, `.velocity`, `.status`; of the broadcast shape.
        A start on the wall with x' < 0 is an impact there, any other start on the wall a launch of the impact map.

    Raises
    ------
    InputError : a place behind the wall.

    Examples
    --------
    >>> ball = launch(Oscillator("0", "-2", 0, "1/2"), 4, 0, 0)
    >>> float(ball.tau), float(ball.v), float(ball.velocity)
    (2.0, 2.0, -4.0)
    """
    if type(x) is type(xdot) is type(t) is float and horizon is None:
        launched = _of_one(osc, x, xdot, t)
        if launched is not None:
            return launched
    elif horizon is None and (launched := _of_few(osc, x, xdot, t)) is not None:
        return launched
    require_room(("x", x), ("xdot", xdot), ("t", t))
    columns = [as_written(name, value) for name, value in (("x", x), ("xdot", xdot), ("t", t))]
    try:
        shape = np.broadcast_shapes(*(column.shape for column in columns))
    except ValueError:
        shapes = ", ".join(str(column.shape) for column in columns)
        raise InputError(f"x, xdot and t have shapes {shapes}: give shapes that broadcast") from None
    columns += [float_array("xdot", columns[1]), _heights(osc, columns[0])]
    if osc.upper is not None:
        columns.append(_heights(osc.mirrored, negated(columns[0])))
    flat = [column if column.shape == shape else np.broadcast_to(column, shape) for column in columns]
    places, speeds, times, u, *heights = (column.ravel() for column in flat)
    flown = _Flown(osc, horizon, States.read(times, np.zeros(times.size)).in_period(osc), u)
    flown.above(np.flatnonzero(np.min(heights, axis=0) > 0), heights[0], (times, speeds, places))
    for wall, above in enumerate(heights):
        # away from the upper wall is x' < 0
        side, on_wall = 1 - 2 * wall, np.flatnonzero(above == 0)
        if on_wall.size:
            away = side * u[on_wall] >= 0
            flown.at_wall(on_wall[away], times, speeds if not wall else negated(speeds), wall)
            flown.into_wall(on_wall[~away])
    return flown.result(shape)


def negated(values: Array) -> Array:
    """Numbers as they were written, times -1."""
    if values.dtype.kind == "f":
        return np.negative(values)
    texts = [negate(constant("x", value)) for value in values.ravel().tolist()]
    boxed = np.empty(len(texts), dtype=object)
    boxed[:] = texts
    return boxed.reshape(values.shape)


def _of_one(osc: Oscillator, x: float, xdot: float, t: float) -> Launched | None:
    """A plain hit from three floats off the wall; None for all that needs a closer look."""
    model, (high, low), gap = _usual(osc)
    height = fsum((x, -high, -low))  # rounded once
    if not (0 < height < gap and -inf < xdot < inf and -model.nearest < t < model.nearest):
        return None
    code, (time, velocity, *_) = model.one(DROPS, t, xdot, height)
    if code:
        return None
    rate = model.r if velocity < 0 else model.rates[-1]
    after = abs(rate * velocity) if model.constant_restitution else float(rebound(osc, np.array(velocity)))
    status, wall = Status.no_rebound if isnan(after) else Status.hit, None
    if osc.upper is not None:
        wall = SCALAR_STATUS[velocity > 0]
    return Launched(t + time, after, time, velocity, SCALAR_STATUS[status], SCALAR_STATUS[0], wall=wall)


def _of_few(osc: Oscillator, x: Any, xdot: Any, t: Any) -> Launched | None:
    """Plain hits from a small array of doubles off the wall; None for all that is not plain."""
    if not all(
        type(column) is float or (type(column) is np.ndarray and column.dtype == float) for column in (x, xdot, t)
    ):
        return None
    model, (high, low), gap = _usual(osc)
    try:
        if not 0 < np.broadcast(x, xdot, t).size <= FEW_STARTS:
            return None
    except ValueError:
        return None
    heights = (x - high) - low
    total = heights + xdot + t  # of their shape; not finite where one of them is not
    if not model.constant_restitution or not np.isfinite(total).all():
        return None
    if not np.min(heights) > 0 or not np.max(heights) < gap or not np.max(np.abs(t)) < model.nearest:
        return None
    tau, u, z = (np.broadcast_to(column, total.shape).ravel() for column in (t, xdot, heights))
    codes, (time, velocity, *_) = model.drops(tau, u, z)
    if np.count_nonzero(codes):
        return None
    columns = (tau + time, rebound(osc, velocity), time, velocity, np.zeros(tau.size, np.int8), velocity > 0)
    tau, after, time, velocity, cause, above = (column.reshape(total.shape)[()] for column in columns)
    wall = None if osc.upper is None else np.int8(above)
    return Launched(tau, after, time, velocity, status_array(np.zeros(total.shape, np.int8)), cause, wall=wall)


@lru_cache(maxsize=256)
def _usual(osc: Oscillator) -> tuple[CompiledModel, tuple[float, float], float]:
    """The compiled model under the default rules, the clearance with its rounding, and the distance of both walls."""
    high = as_float(osc.clearance)
    return compiled_model(osc), (high, as_float(subtract(osc.clearance, Number(Fraction(high))))), gap_of(osc)[0]


def _heights(osc: Oscillator, places: Array) -> Array:
    """x - c, rounded once."""
    if places.dtype.kind in "fiu":
        high, low = _usual(osc)[1]
        heights = (float_array("x", places) - high) - low
    else:
        heights = np.array(
            [as_float(subtract(constant("x", position), osc.clearance)) for position in places.ravel().tolist()]
        ).reshape(places.shape)
    if heights.size and heights.min() < 0:
        behind = places[heights < 0].tolist()[0]
        require(osc.upper is None, "x, or -x at the upper wall,", behind, "places between both walls")
        raise refuse("x", behind, f"places at or above the wall, x >= {osc.clearance}")
    return heights


class _Flown:
    """Flights as they are flown, flat."""

    def __init__(self, osc: Oscillator, horizon: Any, starts: States, u: Array) -> None:
        self.osc, self.horizon, self.tau, self.turns, self.u = osc, horizon, starts.tau, starts.turns, u
        tau = starts.tau
        self.time, self.velocity, self.after = np.full((3, tau.size), np.nan)
        self.status, self.cause, self.wall = np.zeros((3, tau.size), np.int8)
        self.notes: dict[int, str] = {}

    def above(self, at: Array, heights: Array, written: tuple[Array, Array, Array]) -> None:
        """Starts off the wall."""
        if not at.size:
            return
        model = compiled_model(self.osc)
        if self.horizon is not None:
            model = allowed(self.osc, Allowance(horizon_of(self.osc, self.horizon), steps=steps_of(self.osc)))
        tau, u = self.tau[at], self.u[at]
        codes, rows = model.drops(model.near(tau), u, heights[at])
        fates = Fates.of(codes, rows)
        if np.count_nonzero(codes):
            self._decide(model, States(tau, u, tau.shape, (tau, u)), codes, fates, (at, *written))
        self.status[at], self.cause[at], self.time[at], self.velocity[at] = fates.status, fates.cause, *rows[:2]
        self.wall[at] = fates.walls
        self._rebound(at)

    def _decide(
        self, model: CompiledModel, states: States, codes: Array, fates: Fates, written: tuple[Array, ...]
    ) -> None:
        """Flights that end in no plain hit."""
        (at, *columns), rows = written, fates.rows

        def exact(index: int) -> tuple[Expression, ...]:
            """t, x' and x - c as they were written."""
            t, xdot, x = (constant(name, column[at[index]]) for name, column in zip(NAMES, columns, strict=True))
            return t, xdot, subtract(x, self.osc.clearance)

        for index in np.flatnonzero(codes == NOT_REFINED).tolist():
            refined = refined_hit(self.osc, exact(index), *rows[:2, index].tolist())
            fates.status[index], rows[:2, index] = Status.hit, rows[:2, index] if refined is None else refined
        for index in np.flatnonzero(fates.cause == Cause.near_graze)[: LIMITS.settled].tolist():
            self._settle(fates, index, exact(index), model.allowance.horizon)
        escapes(self.osc, model, states, fates)
        for index in np.flatnonzero(fates.cause).tolist():
            note = f"the flight comes to within {rows[2, index]:.3g} of the wall {rows[0, index]:.12g} after its start"
            if fates.cause[index] != Cause.near_graze:
                note = f"the flight came to {where(self.osc, states.tau[index], rows[:4, index])}"
            self.notes[int(at[index])] = note
        hit, graze = fates.status == Status.hit, fates.status == Status.graze
        gone = (fates.status == Status.no_return) | (fates.status == Status.escaped)
        rows[0] = np.where(hit | graze, rows[0], np.where(gone, np.inf, np.nan))
        rows[1] = np.where(hit, rows[1], np.where(graze, 0.0, np.nan))

    def _settle(self, fates: Fates, index: int, exact: tuple[Expression, ...], limit: float) -> None:
        """A flight that doubles leave open near a graze, in many digits."""
        from singimpact.flights.multiprecision import settled  # 8 ms that few calls need

        outcome = settled(partial(_in_digits, self.osc, exact, limit))
        if outcome is not None:
            fates.decide(index, *outcome)

    def at_wall(self, at: Array, times: Array, speeds: Array, wall: int) -> None:
        """Starts on a wall are launches of the impact map."""
        step = at_walls(partial(impact_map, horizon=self.horizon), self.osc, wall, (times[at], speeds[at]))
        self.wall[at] = 0 if step.wall is None else step.wall
        self.time[at], self.velocity[at], self.after[at] = step.flight_time, step.velocity, step.v
        self.status[at], self.cause[at] = step.status, step.cause
        for index in np.flatnonzero(step.cause).tolist():
            self.notes[int(at[index])] = step.notes.get(index, "the flight comes near the wall")

    def into_wall(self, at: Array) -> None:
        """Starts on a wall that move into it are impacts."""
        self.time[at], self.velocity[at], self.status[at] = 0.0, self.u[at], Status.hit
        self.wall[at] = self.u[at] > 0
        self._rebound(at)

    def _rebound(self, at: Array) -> None:
        after = rebound(self.osc, self.velocity[at])
        dead = (self.status[at] == Status.hit) & np.isnan(after)
        self.after[at] = after
        self.status[at[dead]] = Status.no_rebound

    def result(self, shape: tuple[int, ...]) -> Launched:
        """All flights in their shape."""
        parts = self.tau + self.time + self.turns, self.after, self.time, self.velocity
        tau, after, time, velocity, cause = (part.reshape(shape)[()] for part in (*parts, self.cause))
        wall = None if self.osc.upper is None else self.wall.reshape(shape)[()]
        return Launched(tau, after, time, velocity, status_array(self.status.reshape(shape)), cause, self.notes, wall)


def _in_digits(osc: Oscillator, exact: tuple[Expression, ...], limit: float, digits: int) -> tuple[int, Any]:
    """Code, and time, velocity, depth and bound, of a flight from t, x', x - c in many digits."""
    from singimpact.flights.multiprecision import at_wall, gap_in_digits  # 8 ms that few calls need

    flow = recurrence_of(osc)
    with digits_at(digits) as mp:
        space, order = over_mpmath(mp, flow.source), degree_for(float(mp.eps))
        rules = Rules(
            mp.mpf(limit), LIMITS.settling_steps, order, order, 8 * mp.eps, 0, 0, 0, 0, 0, 0, gap_in_digits(osc, mp), 0
        )
        p, work = [as_mpf(tree, mp) for tree in constants_of(osc, linear=False)], workspace(mp.mpf(0), order, flow.rows)
        t, v, work.q[0] = (as_mpf(tree, mp) for tree in exact)
        try:
            code, *numbers = space["taylor_flight"]([t], v, 0, mp.nan, p, rules, work, [])
        except (ArithmeticError, ValueError, TypeError):  # log or a root left its domain on the way
            return 22, ()
        return at_wall(int(code), numbers)
