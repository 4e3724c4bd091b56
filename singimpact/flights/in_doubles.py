"""Flights in doubles as the kernels leave them: numbers of a model, what a flight is allowed, codes, raw rows."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import Expression
from singimpact.algebra.numbers import as_float
from singimpact.flights import counted
from singimpact.flights.causes import decoded
from singimpact.flights.escape_averaged import stays_up
from singimpact.flights.escape_barrier import kept_up
from singimpact.flights.kernel import Kernel, ready
from singimpact.flights.launch import States, launches
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.tables import STRIDES, table_of
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.status import Cause, Status

EPSILON = 2.0**-52
Array = np.ndarray[Any, Any]
JUDGED = 9  # columns of what `variation.judge` fills


@dataclass(frozen=True)
class Allowance:
    """When a flight is given up: time, relative error of a step, number of steps."""

    horizon: float
    epsilon: float
    steps: int


@dataclass(frozen=True)
class Raw:
    """Flights as a kernel leaves them, one row a state.

    Parameters
    ----------
    status, cause : int8. numbers : flight time, velocity, depth, bound; of what ends in no hit: time, x', x - c, and
        its bound or a singular part. judged : what `variation.judge` fills, nan where nothing is judged.
    """

    status: Array
    cause: Array
    numbers: Array
    judged: Array

    @property
    def lost(self) -> Array:
        """Flights that came to no graze but to the end of the range of numbers, of the functions in f and g, or of the
        steps.
        """
        return np.asarray(self.cause > Cause.near_graze)


def raw_flights(size: int) -> Raw:
    return Raw(np.zeros(size, np.int8), np.zeros(size, np.int8), np.zeros((size, 4)), np.full((size, JUDGED), np.nan))


def removed_roots(states: States, status: Array) -> Array:
    """How often t = 0 is a root of x - c; a mass at rest that stays is marked."""
    removed = np.ones(states.v.size, dtype=np.int64)
    for index in np.flatnonzero(states.v == 0):
        rest = states.rest[int(index)]
        removed[index] = rest.order + 2
        status[index] = Status.hit if rest.sign > 0 else Status.sticks
    return removed


def fly(
    osc: Oscillator, kernel: Kernel, states: States, removed: Array, pushes: Array, raw: Raw, limits: Allowance
) -> None:  # fmt: skip
    """Fly the states whose status is `hit` so far, and fill in what becomes of them."""
    if kernel.form is None:
        _decided_at_launch(osc, states, raw, limits)
    moving = np.flatnonzero(raw.status == Status.hit)
    if not moving.size:
        return
    counted.add(moving.size)
    codes, flown, judged = (np.empty(moving.size, dtype=np.int8), np.empty((moving.size, 4)),
                            np.full((moving.size, JUDGED), np.nan))  # fmt: skip
    given = launches(osc, kernel, states.tau)[moving], states.v[moving], removed[moving], pushes[moving]
    p, table = doubles(kernel), table_of(kernel, doubles(kernel))
    order = degree_for(EPSILON if kernel.form else limits.epsilon) + int(removed.max(initial=1)) - 1
    room = max(order, degree_for(LIMITS.judging)) + 2
    work = np.zeros(room), np.zeros((kernel.rows, room)), np.zeros(room)
    if kernel.form is None:
        _fly_taylor(kernel, given, order, limits, (p, *work), (codes, flown, judged))
    elif table is None:
        ready(kernel, "run", moving.size)(
            *given, order, limits.horizon, LIMITS.longest, LIMITS.safety * limits.epsilon, p, *work, codes, flown
        )
    else:
        ready(kernel, "stride_all", moving.size)(
            *given, STRIDES.order, degree_for(EPSILON), limits.horizon, LIMITS.safety * EPSILON, p, table.step,
            table.rows, table.bound, *work, codes, flown,
        )  # fmt: skip
    raw.status[moving], raw.cause[moving] = decoded(codes)
    raw.numbers[moving], raw.judged[moving] = flown, judged


def _decided_at_launch(osc: Oscillator, states: States, raw: Raw, limits: Allowance) -> None:
    """Flights that are proved not to return before they are flown."""
    moving = raw.status == Status.hit
    raw.status[moving & kept_up(osc, states.v)] = Status.escaped
    raw.status[moving & stays_up(osc, states.v, limits.horizon)] = Status.no_return


def _fly_taylor(kernel: Kernel, given: Any, order: int, limits: Allowance, work: Any, found: Any) -> None:
    """Flights in Taylor steps, in blocks that hear an interruption; long ones again with room for all their steps."""
    codes, _flown, judged = found
    columns = np.zeros((3, work[1].size))

    def run(chosen: Any, rows: int) -> None:
        parts = [part[chosen] for part in found]
        ready(kernel, "run_judged", parts[0].size)(
            *(part[chosen] for part in given), order, limits.horizon, limits.steps, LIMITS.safety * limits.epsilon,
            *work, np.zeros((rows, 4)), columns, degree_for(LIMITS.judging), *parts,
        )  # fmt: skip
        for part, filled in zip(found, parts, strict=True):
            part[chosen] = filled

    rows = min(limits.steps + 1, LIMITS.traced)
    for begin in range(0, codes.size, LIMITS.block):
        run(np.arange(begin, min(begin + LIMITS.block, codes.size)), rows)
    long = np.flatnonzero((codes == Status.hit) & np.isnan(judged[:, 0]))
    for index in long if rows <= limits.steps else ():
        run(np.array([index]), limits.steps + 1)


def doubles(kernel: Kernel) -> Array:
    """The numbers of the model, refused when they do not fit a double."""
    return _doubles(kernel).copy()


@lru_cache(maxsize=256)
def _doubles(kernel: Kernel) -> Array:
    p = np.array([as_float(tree) for tree in kernel.constants])
    if not np.all(np.isfinite(p)):
        raise InputError("a constant of the model is too large for a double: scale the model, or ask with digits=")
    return p


@lru_cache(maxsize=256)
def remainders(kernel: Kernel) -> tuple[Array, Array]:
    """What the doubles of a linear model leave out; the phases of its waves, with what their doubles leave out."""
    assert kernel.form is not None
    low = np.array([_halves(tree)[1] for tree in kernel.constants])
    waves = kernel.form.harmonics
    return low, np.array([_halves(wave.phase) for wave in waves]).reshape(len(waves), 2).T.copy()


def _halves(tree: Expression) -> tuple[float, float]:
    high = as_float(tree)
    exact = as_rational(Balls(256).evaluate(tree, {}))
    return high, float(exact - Fraction(high)) if np.isfinite(high) else 0.0
