"""Flights that start off the wall: the first impact, and the state after it.

No root of x - c is removed at such a start.  Taylor steps fly linear models too, as their closed form restarts from the
wall; a hit of theirs is placed by one Newton step of the closed form.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache, partial
from math import fsum, inf, isnan
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression, Number, subtract
from singimpact.algebra.numbers import Array, as_float, as_mpf, constant, float_array
from singimpact.algebra.precision import digits_at
from singimpact.flights.bind import over_mpmath
from singimpact.flights.causes import decoded, where
from singimpact.flights.compiled_model import CompiledModel, allowed, compiled_model
from singimpact.flights.flight_path import off_wall_places
from singimpact.flights.horizons import Allowance, horizon_of, reach_of, steps_of
from singimpact.flights.impact_map import impact_map
from singimpact.flights.interpreted import workspace
from singimpact.flights.kernels.entries import DROPS, PLACES
from singimpact.flights.kernels.state import Rules
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.model_numbers import constants_of, has_table, recurrence_of
from singimpact.flights.rebound_law import rebound
from singimpact.flights.results import SCALAR_STATUS
from singimpact.flights.states import States, require_room
from singimpact.flights.undecided import Fates, escapes
from singimpact.inputs import InputError, refuse
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result, in_words
from singimpact.status import Cause, Status, status_array


@dataclass(frozen=True)
class OffWallSettings:
    """Settings of the place of a hit of a linear model."""

    # a Newton step longer than this part of the flight time is not taken: Taylor steps lose 1e-13 in a long flight
    step: float = 1e-10


SETTINGS = OffWallSettings()


@dataclass(frozen=True, eq=False, repr=False)
class Launched(Result):
    """First impacts of flights that start off the wall.

    Parameters
    ----------
    tau, v : the states just after the impacts, as those of a `Step`. flight_time : from the start to the impact; inf
        when there is none, nan beside `unresolved`. velocity : x' at the impact.
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


def launch(osc: Oscillator, x: Any, xdot: Any, t: Any, *, horizon: Any = None) -> Launched:
    """The first impact of flights from (x, x') at time t, off the wall or on it.

    Parameters
    ----------
    osc : the model. x : places, at or above the clearance. xdot : velocities of either sign. t : times; they broadcast.
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
    require_room(("x", x), ("xdot", xdot), ("t", t))
    parts = [_objects(name, value) for name, value in (("x", x), ("xdot", xdot), ("t", t))]
    try:
        places, speeds, times = np.broadcast_arrays(*parts)
    except ValueError:
        shapes = ", ".join(str(column.shape) for column in parts)
        raise InputError(f"x, xdot and t have shapes {shapes}: give shapes that broadcast") from None
    shape = places.shape
    u, starts = float_array("xdot", speeds.ravel()), States.read(times.ravel(), 0.0).in_period(osc)
    heights = _heights(osc, places.ravel())
    flown = _Flown(osc, horizon, starts, u)
    flown.above(np.flatnonzero(heights > 0), heights, (times.ravel(), speeds.ravel(), places.ravel()))
    flown.at_wall(np.flatnonzero((heights == 0) & (u >= 0)), times.ravel(), speeds.ravel())
    flown.into_wall(np.flatnonzero((heights == 0) & (u < 0)))
    return flown.result(shape)


def _of_one(osc: Oscillator, x: float, xdot: float, t: float) -> Launched | None:
    """A plain hit from three floats off the wall; None for all that needs a closer look."""
    model, closed, (high, low) = _usual(osc)
    height = fsum((x, -high, -low))  # rounded once
    if not (0 < height < inf and -inf < xdot < inf and -closed.nearest < t < closed.nearest):
        return None
    code, (time, velocity, *_) = model.one(DROPS, t, xdot, height)
    if code:
        return None
    if closed.linear:
        z, u = closed.one(PLACES, t, xdot, time, height)[1][:2]
        if u < 0 and abs(z / u) <= SETTINGS.step * time:
            time -= z / u
            velocity = closed.one(PLACES, t, xdot, time, height)[1][1]
    after = abs(closed.r * velocity) if closed.constant_restitution else float(rebound(osc, np.array(velocity)))
    status = Status.no_rebound if isnan(after) else Status.hit
    return Launched(t + time, after, time, velocity, SCALAR_STATUS[status], SCALAR_STATUS[0])


@lru_cache(maxsize=256)
def _usual(osc: Oscillator) -> tuple[CompiledModel, CompiledModel, tuple[float, float]]:
    """The model in Taylor steps under the default rules, the compiled one, and the clearance with its rounding."""
    high = as_float(osc.clearance)
    parts = high, as_float(subtract(osc.clearance, Number(Fraction(high))))
    return stepped(osc, horizon_of(osc, None), reach_of(osc)), compiled_model(osc), parts


def _objects(name: str, value: Any) -> Array:
    """Numbers as they were written: text among numbers stays text."""
    if isinstance(value, Expression):
        boxed = np.empty((), dtype=object)
        boxed[()] = value
        return boxed
    try:
        return value if isinstance(value, np.ndarray) and value.dtype.kind in "fiu" else np.array(value, dtype=object)
    except ValueError:
        raise refuse(name, value, "a number or an array of numbers") from None


def _heights(osc: Oscillator, places: Array) -> Array:
    """x - c, rounded once."""
    if places.dtype.kind in "fiu":
        high, low = _usual(osc)[2]
        heights = (float_array("x", places) - high) - low
    else:
        heights = np.array([as_float(subtract(constant("x", position), osc.clearance)) for position in places.tolist()])
    if heights.size and heights.min() < 0:
        raise refuse("x", places[heights < 0][0], f"places at or above the wall, x >= {osc.clearance}")
    return heights


@lru_cache(maxsize=64)
def stepped(osc: Oscillator, horizon: float, reach: float) -> CompiledModel:
    """A model as Taylor steps fly it, a linear one too."""
    allowance = Allowance(horizon, steps=steps_of(osc), reach=reach)
    return CompiledModel(osc, allowance, recurrence_of(osc)) if has_table(osc) else allowed(osc, allowance)


class _Flown:
    """Flights as they are flown, flat."""

    def __init__(self, osc: Oscillator, horizon: Any, starts: States, u: Array) -> None:
        self.osc, self.horizon, self.tau, self.turns, self.u = osc, horizon, starts.tau, starts.turns, u
        tau = starts.tau
        self.time, self.velocity, self.after = (np.full(tau.size, np.nan) for _ in range(3))
        self.status, self.cause = np.zeros(tau.size, np.int8), np.zeros(tau.size, np.int8)
        self.notes: dict[int, str] = {}

    def above(self, at: Array, heights: Array, written: tuple[Array, Array, Array]) -> None:
        """Starts off the wall."""
        if not at.size:
            return
        reach = reach_of(self.osc) if self.horizon is None else 0.0
        model = stepped(self.osc, horizon_of(self.osc, self.horizon), reach)
        tau, u = self.tau[at], self.u[at]
        codes, rows = model.drops(model.near(tau), u, heights[at])
        fates = Fates(*decoded(codes), rows)
        for index in np.flatnonzero(fates.cause == Cause.near_graze)[: LIMITS.settled].tolist():
            exact = [
                constant(name, column[at[index]]) for name, column in zip(("t", "xdot", "x"), written, strict=True)
            ]
            self._settle(fates, index, exact, model.allowance.horizon)
        escapes(self.osc, model, States(tau, u, tau.shape, (tau, u)), fates)
        hit = fates.status == Status.hit
        if has_table(self.osc):
            self._place(rows, (tau, u, heights[at]), hit)
        graze = fates.status == Status.graze
        self.status[at], self.cause[at] = fates.status, fates.cause
        gone = (fates.status == Status.no_return) | (fates.status == Status.escaped)
        self.time[at] = np.where(hit | graze, rows[0], np.where(gone, np.inf, np.nan))
        self.velocity[at] = np.where(hit, rows[1], np.where(graze, 0.0, np.nan))
        self._rebound(at)
        for index in np.flatnonzero(fates.cause).tolist():
            approach = (
                f"the flight comes to within {rows[2, index]:.3g} of the wall {rows[0, index]:.12g} after its start"
            )
            near = fates.cause[index] == Cause.near_graze
            note = approach if near else f"the flight came to {where(self.osc, tau[index], rows[:4, index])}"
            self.notes[int(at[index])] = note

    def _place(self, rows: Array, starts: tuple[Array, Array, Array], hit: Array) -> None:
        """One Newton step of the closed form at hits."""
        tau, v, heights = (part[hit] for part in starts)
        time = rows[0, hit]
        z, u = off_wall_places(self.osc, tau, v, heights, time).T
        with np.errstate(all="ignore"):
            near = (u < 0) & (np.abs(z / u) <= SETTINGS.step * time)
            time = np.where(near, time - z / u, time)
        rows[0, hit] = time
        rows[1, hit] = np.where(near, off_wall_places(self.osc, tau, v, heights, time)[:, 1], rows[1, hit])

    def _settle(self, fates: Fates, index: int, exact: list[Expression], limit: float) -> None:
        """A flight that doubles leave open near a graze, in many digits."""
        from singimpact.flights.multiprecision import settled  # 8 ms that few calls need

        outcome = settled(partial(_in_digits, self.osc, exact, limit))
        if outcome is not None:
            fates.status[index], fates.rows[:4, index] = outcome
            fates.cause[index] = Cause.decided

    def at_wall(self, at: Array, times: Array, speeds: Array) -> None:
        """Starts on the wall are launches of the impact map."""
        for index in at.tolist():
            step = impact_map(self.osc, times[index], speeds[index], horizon=self.horizon)
            self.time[index], self.velocity[index], self.after[index] = step.flight_time, step.velocity, step.v
            self.status[index], self.cause[index] = step.status, step.cause
            if step.cause:
                self.notes[index] = step.notes.get(0, "the flight comes near the wall")

    def into_wall(self, at: Array) -> None:
        """Starts on the wall with x' < 0 are impacts."""
        self.time[at], self.velocity[at], self.status[at] = 0.0, self.u[at], Status.hit
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
        return Launched(tau, after, time, velocity, status_array(self.status.reshape(shape)), cause, self.notes)


def _in_digits(osc: Oscillator, exact: list[Expression], limit: float, digits: int) -> tuple[int, Any]:
    """Code, and time, velocity, depth and bound, of a flight from t, x', x in many digits."""
    flow = recurrence_of(osc)
    with digits_at(digits) as mp:
        space, order = over_mpmath(mp, flow.source), degree_for(float(mp.eps))
        rules = Rules(mp.mpf(limit), LIMITS.settling_steps, order, order, 8 * mp.eps, 0, 0, 0, 0, 0, 0)
        p, work = [as_mpf(tree, mp) for tree in constants_of(osc, linear=False)], workspace(mp.mpf(0), order, flow.rows)
        t, v, work.q[0] = (as_mpf(tree, mp) for tree in (*exact[:2], subtract(exact[2], osc.clearance)))
        try:
            code, *numbers = space["taylor_flight"]([t], v, 0, mp.nan, p, rules, work, [])
        except (ArithmeticError, ValueError, TypeError):  # log or a root left its domain on the way
            return 22, ()
        return int(code), tuple(numbers[:4])
