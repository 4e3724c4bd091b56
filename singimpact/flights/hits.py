"""First hit F and impact map G for arrays of states, in doubles; `digits` hands over to `manydigits`."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import Expression, evaluate, names_in
from singimpact.algebra.numbers import as_float, constant
from singimpact.algebra.rings import DOUBLES
from singimpact.flights import counted, edges, manydigits
from singimpact.flights.carriers import Derivative, Flight, Step
from singimpact.flights.escape import never_returns
from singimpact.flights.escape_polynomial import never_turns
from singimpact.flights.kernel import Kernel, kernel_of, ready
from singimpact.flights.launch import States, at_rest, horizon_of, launches
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.phase import reduced
from singimpact.flights.polish import polished
from singimpact.flights.tables import STRIDES, table_of
from singimpact.flights.tangent import rebound_slope, response
from singimpact.inputs import InputError, refuse
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.linear import LinearForm
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

EPSILON = 2.0**-52
Array = np.ndarray[Any, Any]


def first_hit(
    osc: Oscillator, tau: Any, v: Any, *, digits: int | None = None, tolerance: Any = None, horizon: Any = None
) -> Flight:
    """The first hit of the obstacle by the flight from (tau, v).

    Parameters
    ----------
    osc : the model.
    tau : launch times, any finite numbers. v : launch velocities >= 0; they broadcast.
    digits : decimal digits; the result then holds mpmath numbers.
    tolerance : relative error allowed in a step of a Taylor flow, and, times ten, of a hit before it is polished.
    horizon : time after which a flight is given up; 1000 periods of g if not given, or 2e5 radians of the fastest
        motion where those come first. At most 1e7 radians.

    Returns
    -------
    Flight : arrays of the broadcast shape, scalars for scalars.

    Examples
    --------
    >>> hit = first_hit(Oscillator("0", "-2", 0, 1), 0, [0, 1, 3])
    >>> hit.flight_time.tolist(), hit.velocity.tolist(), hit.status.tolist()
    ([0.0, 1.0, 3.0], [0.0, -1.0, -3.0], [2, 0, 0])
    """
    states = States.read(tau, v)
    limit = horizon_of(osc, horizon)
    epsilon = _tolerance(tolerance)
    if digits is not None:
        found = manydigits.flights(osc, states, checked_digits(digits), limit)
        return shaped(_conditioned(osc, states, found, epsilon)[0], states.shape)
    return shaped(_flights(osc, states, limit, epsilon), states.shape)


def impact_map(
    osc: Oscillator, tau: Any, v: Any, *, digits: int | None = None, tolerance: Any = None, horizon: Any = None
) -> Step:
    """The impact map G(tau, v) = (tau + T, -r x'(T)); parameters as in `first_hit`.

    Notes
    -----
    At `no_return` and `escaped` tau is inf and v nan; at `unresolved` both are nan; at `sticks` and `graze` v is 0; at
    `no_rebound` v is nan.

    Examples
    --------
    >>> step = impact_map(Oscillator("0", "-2", 0, "1/2"), 1.0, 3.0)
    >>> step.tau, step.v, step.status
    (np.float64(4.0), np.float64(1.5), np.int8(0))
    """
    states = States.read(tau, v)
    hit = first_hit(osc, tau, v, digits=digits, tolerance=tolerance, horizon=horizon)
    if digits is not None:
        return manydigits.step(osc, states, hit, digits)
    landed = states.tau.reshape(states.shape) + hit.flight_time
    bounce = rebound(osc, np.asarray(hit.velocity))
    dead = (np.asarray(hit.status) == Status.hit) & np.isnan(bounce)
    status = np.where(dead, np.int8(Status.no_rebound), hit.status).astype(np.int8)
    return Step(**(vars(hit) | {"status": status[()]}), tau=landed[()], v=bounce[()])


def derivative(osc: Oscillator, tau: Any, v: Any, *, horizon: Any = None) -> Derivative:
    """D G at states, from the variational equation.

    Parameters
    ----------
    osc : the model. tau, v : states, v >= 0; they broadcast. horizon : time after which a flight is given up.

    Returns
    -------
    Derivative : matrix[..., 0, :] = d tau'/d(tau, v), matrix[..., 1, :] = d v'/d(tau, v), and the status of the flight.
        Without an impact it is nan.  At `graze` (infinite) and `sticks` it is one-sided, from the side that hits.

    Examples
    --------
    >>> (derivative(Oscillator("0", "-2", 0, "1/2"), 0, 1).matrix + 0).tolist()
    [[1.0, 1.0], [0.0, 0.5]]
    """
    states = States.read(tau, v)
    step = impact_map(osc, tau, v, horizon=horizon)
    time, velocity, status = (np.ravel(part) for part in (step.flight_time, step.velocity, step.status))
    answers = response(osc, states.tau, states.v, time, velocity)
    slope = rebound_slope(osc, velocity)
    rows = [1 + answers.time_by_tau, answers.time_by_v, slope * answers.velocity_by_tau, slope * answers.velocity_by_v]
    matrix = np.stack(rows, axis=-1).reshape(-1, 2, 2)
    edges.fill(osc, states, time, status, matrix)
    return Derivative(matrix.reshape(*states.shape, 2, 2), step.status)


def rebound(osc: Oscillator, velocity: Array) -> Array:
    """rho(velocity) for velocities <= 0; nan where it is not positive for a velocity that is not 0."""
    if not names_in(osc.restitution):
        return np.abs(as_float(osc.restitution) * velocity)
    with np.errstate(all="ignore"):
        bounce = np.asarray(evaluate(osc.rho(), {"v": velocity}, DOUBLES), dtype=float)
    return np.where(velocity == 0, 0.0, np.where((bounce > 0) & np.isfinite(bounce), bounce, np.nan))


def checked_digits(digits: Any) -> int:
    """Digits as an int between 1 and 2000."""
    if isinstance(digits, bool) or not isinstance(digits, int | np.integer) or not 1 <= digits <= 2000:
        raise refuse("digits", digits, "a whole number from 1 to 2000")
    return int(digits)


def _tolerance(tolerance: Any) -> float:
    if tolerance is None:
        return EPSILON
    value = as_float(constant("tolerance", tolerance))
    if not EPSILON <= value <= 1e-3:
        raise refuse("tolerance", tolerance, "a number from 2.3e-16 to 1e-3, or digits= for more than doubles hold")
    return value


def shaped(flight: Flight, shape: tuple[int, ...]) -> Flight:
    """The flat fields in a shape, or as scalars."""
    fields = {name: np.asarray(value).reshape(shape)[()] for name, value in vars(flight).items()}
    return type(flight)(**fields)


def _flights(osc: Oscillator, states: States, limit: float, epsilon: float) -> Flight:
    kernel = kernel_of(osc)
    status = np.zeros(states.v.size, dtype=np.int8)
    removed = _removed(osc, states, status)
    pushes = acceleration(osc, states.tau)
    numbers = _flown(osc, kernel, states, removed, pushes, status, limit, epsilon)
    # first: what left the range of doubles would be followed again in many digits
    _escapes(osc, kernel.form, states, status, numbers)
    if _settle(osc, states, limit, status, numbers):
        _escapes(osc, kernel.form, states, status, numbers)
    flight, rough = _conditioned(osc, states, flight_of(status, numbers), epsilon)
    return _sharpened(osc, states, flight, rough & (status == Status.hit), pushes, limit)


def _sharpened(
    osc: Oscillator, states: States, flight: Flight, rough: Array, pushes: Array, limit: float
) -> Flight:  # fmt: skip
    """Rough hits are polished in balls, and what balls do not confirm is flown in many digits.

    At near resonances all flights come back together: the state hardly matters, but the sums still cancel.
    """
    if not rough.any():
        return flight
    table = table_of(kernel_of(osc), doubles(kernel_of(osc)))
    # pressed back at once, a flight is a short series in t that loses nothing
    far = (flight.flight_time > (table.step if table else 0)) | (pushes >= 0)
    left = LIMITS.settled
    for index in np.flatnonzero(far & rough).tolist():
        found = polished(osc, states, index, float(flight.flight_time[index]))
        if found is None and left:
            left -= 1
            settled = manydigits.settle(osc, states, index, limit)
            found = settled[1][:2] if settled is not None and settled[0] == Status.hit else None
        if found is not None:
            flight.flight_time[index], flight.velocity[index] = found
    return flight


def _conditioned(osc: Oscillator, states: States, flight: Flight, epsilon: float) -> tuple[Flight, Array]:
    """The flight with its condition; and where its rounding is more than that condition and the tolerance explain."""
    time, velocity = (np.array(part, dtype=float) for part in (flight.flight_time, flight.velocity))
    answers = response(osc, states.tau, states.v, time, velocity)
    tau = states.tau if osc.period is None else reduced(states.tau, osc.period)
    kappas = answers.conditions(tau, states.v, time, velocity)
    with np.errstate(all="ignore"):
        late, dull = (part > np.maximum(least, 10 * kappa * epsilon)
                      for part, least, kappa in zip(answers.rounding, LIMITS.rough, kappas, strict=True))  # fmt: skip
    return replace(flight, condition=kappas[0]), late | dull


def _escapes(osc: Oscillator, form: LinearForm | None, states: States, status: Array, numbers: Array) -> None:
    """What has not returned is asked whether it ever can."""
    # a flight that left the range of doubles was followed without impact too
    gone = np.flatnonzero((status == Status.no_return) | _lost(status, numbers))
    if gone.size:
        time, speed, place, _ = numbers[gone].T
        proved = (never_turns(osc, place, speed) if form is None
                  else never_returns(osc, form, states.tau[gone], time, place, speed))  # fmt: skip
        status[gone[proved]] = Status.escaped


def _removed(osc: Oscillator, states: States, status: Array) -> Array:
    """How often t = 0 is a root of x - c; a mass at rest that stays is marked."""
    removed = np.ones(states.v.size, dtype=np.int64)
    for index in np.flatnonzero(states.v == 0):
        sign, order = at_rest(osc, states.exact_tau(int(index)))
        removed[index] = order + 2
        status[index] = Status.hit if sign > 0 else Status.sticks
    return removed


def _flown(
    osc: Oscillator, kernel: Kernel, states: States, removed: Array, pushes: Array, status: Array, limit: float,
    epsilon: float,
) -> Array:  # fmt: skip
    order = degree_for(EPSILON if kernel.form else epsilon) + int(removed.max(initial=1)) - 1
    numbers = np.zeros((states.v.size, 4))
    moving = np.flatnonzero(status == Status.hit)
    if not moving.size:
        return numbers
    counted.add(moving.size)
    p, table = doubles(kernel), table_of(kernel, doubles(kernel))
    part, flown = np.empty(moving.size, dtype=np.int8), np.empty((moving.size, 4))
    work = np.zeros(order + 2), np.zeros((kernel.rows, order + 2)), np.zeros(order + 2)
    given = launches(osc, kernel, states.tau)[moving], states.v[moving], removed[moving], pushes[moving]
    if table is None:
        ready(kernel, "run", moving.size)(*given, order, limit, LIMITS.safety * epsilon, p, *work, part, flown)
    else:
        ready(kernel, "stride_all", moving.size)(
            *given, STRIDES.order, degree_for(EPSILON), limit, LIMITS.safety * EPSILON, p, table.step, table.rows,
            table.bound, *work, part, flown,
        )  # fmt: skip
    status[moving], numbers[moving] = part, flown
    return numbers


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


def _lost(status: Array, numbers: Array) -> Array:
    """Flights that came to no graze but to the end of the range of numbers, or of the functions in f and g."""
    return np.asarray((status == Status.unresolved) & ~(numbers[:, 2] <= 10 * numbers[:, 3]))


def _settle(osc: Oscillator, states: States, limit: float, status: Array, numbers: Array) -> bool:
    """What doubles leave open is asked again with many digits: the state is exact, so the answer exists."""
    open_ones = np.flatnonzero((status == Status.unresolved) & ~_lost(status, numbers))[: LIMITS.settled]
    for index in open_ones:
        settled = manydigits.settle(osc, states, int(index), limit)
        if settled is not None:
            status[index], numbers[index] = settled
    return bool(open_ones.size)


def flight_of(status: Array, numbers: Array) -> Flight:
    """The carrier, with nan and inf where the status says so."""
    time, velocity, depth, bound = (numbers[:, column].copy() for column in range(4))
    unknown = status == Status.unresolved
    gone = (status == Status.no_return) | (status == Status.escaped)
    time[gone], velocity[gone | unknown], time[unknown] = np.inf, np.nan, np.nan
    velocity[(status == Status.graze) | (status == Status.sticks)] = 0.0
    plain = (~unknown & (status != Status.graze)) | _lost(status, numbers)
    depth[plain], bound[plain] = np.nan, np.nan
    return Flight(time, velocity, status, depth, bound, np.full(time.shape, np.nan))
