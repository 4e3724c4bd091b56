"""First hit F and impact map G for arrays of states, in doubles; `digits` hands over to `manydigits`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from singimpact.algebra.expressions import evaluate, names_in
from singimpact.algebra.numbers import as_float, constant, sign_of
from singimpact.algebra.rings import DOUBLES
from singimpact.flights import edges, manydigits
from singimpact.flights.carriers import Derivative, Flight, Step
from singimpact.flights.causes import decoded, explained
from singimpact.flights.escape import never_returns
from singimpact.flights.escape_polynomial import never_turns
from singimpact.flights.in_doubles import EPSILON, Allowance, Raw, doubles, fly, raw_flights, removed_roots
from singimpact.flights.kernel import kernel_of
from singimpact.flights.launch import States, horizon_of
from singimpact.flights.limits import LIMITS
from singimpact.flights.phase import reduced
from singimpact.flights.polish import polished
from singimpact.flights.tables import table_of
from singimpact.flights.tangent import rebound_slope, response
from singimpact.inputs import refuse
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.linear import LinearForm
from singimpact.oscillator.model import Oscillator
from singimpact.status import Cause, Status

Array = np.ndarray[Any, Any]


def first_hit(
    osc: Oscillator, tau: Any, v: Any, *, digits: int | None = None, tolerance: Any = None, horizon: Any = None,
    steps: int | None = None,
) -> Flight:  # fmt: skip
    """The first hit of the obstacle by the flight from (tau, v).

    Parameters
    ----------
    osc : the model.
    tau : launch times, any finite numbers. v : launch velocities >= 0; they broadcast.
    digits : decimal digits; the result then holds mpmath numbers.
    tolerance : relative error allowed in a step of a Taylor flow, and, times ten, of a hit before it is polished.
    horizon : time after which a flight is given up; 1000 periods of g if not given, or 2e5 radians of the fastest
        motion where those come first. At most 1e7 radians.
    steps : Taylor steps after which a flight of a model without a closed form is given up, 10000 if not given.

    Returns
    -------
    Flight : arrays of the broadcast shape, scalars for scalars.

    Examples
    --------
    >>> hit = first_hit(Oscillator("0", "-2", 0, 1), 0, [0, 1, 3])
    >>> hit.flight_time.tolist(), hit.velocity.tolist(), hit.status.tolist()
    ([0.0, 1.0, 3.0], [0.0, -1.0, -3.0], [2, 0, 0])
    """
    states = States.of(osc, tau, v, digits if isinstance(digits, int) else 15)
    limits = Allowance(horizon_of(osc, horizon), _tolerance(tolerance), checked_steps(steps))
    if digits is not None:
        return shaped(_many_digits(osc, states, checked_digits(digits), limits), states.shape)
    return shaped(_flights(osc, states, limits), states.shape)


def impact_map(
    osc: Oscillator, tau: Any, v: Any, *, digits: int | None = None, tolerance: Any = None, horizon: Any = None,
    steps: int | None = None,
) -> Step:  # fmt: skip
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
    states = States.of(osc, tau, v, digits if isinstance(digits, int) else 15)
    hit = first_hit(osc, tau, v, digits=digits, tolerance=tolerance, horizon=horizon, steps=steps)
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


def checked_steps(steps: Any) -> int:
    """The steps of a flight, between 1 and ten million."""
    if steps is None:
        return LIMITS.steps
    if isinstance(steps, bool) or not isinstance(steps, int | np.integer) or not 1 <= steps <= 10_000_000:
        raise refuse("steps", steps, "a whole number from 1 to 10000000")
    return int(steps)


def shaped(flight: Flight, shape: tuple[int, ...]) -> Flight:
    """The flat fields in a shape, or as scalars."""
    fields: dict[str, Any] = {name: value if name == "notes" else np.asarray(value).reshape(shape)[()]
                              for name, value in vars(flight).items()}  # fmt: skip
    return type(flight)(**fields)


def _flights(osc: Oscillator, states: States, limits: Allowance) -> Flight:
    kernel = kernel_of(osc)
    raw = raw_flights(states.v.size)
    removed = removed_roots(states, raw.status)
    pushes = acceleration(osc, states.tau)
    fly(osc, kernel, states, removed, pushes, raw, limits)
    # first: what left the range of doubles would be followed again in many digits
    _escapes(osc, kernel.form, states, raw)
    settled = _settle(osc, states, raw, limits)
    if settled.size:
        _escapes(osc, kernel.form, states, raw)
    flight, rough = _conditioned(osc, states, flight_of(raw), raw.judged, limits.epsilon)
    settled = settled[raw.status[settled] == Status.hit]
    flight.time_error[settled] = flight.velocity_error[settled] = EPSILON
    rough[settled] = False
    flight = _explained(osc, states, flight, raw)
    return _sharpened(osc, states, flight, rough & (raw.status == Status.hit), pushes, limits)


def _explained(osc: Oscillator, states: States, flight: Flight, raw: Raw) -> Flight:
    """The flight with its causes told apart and a note for each that is lost."""
    notes = {}
    for index in np.flatnonzero(raw.lost).tolist():
        tau = float(states.tau[index])

        def way(times: Array, at: int = index) -> Any:
            from singimpact.flights.path import path

            return path(osc, states.tau[at], states.v[at], times)

        raw.cause[index], notes[index] = explained(osc, tau, raw.numbers[index], Cause(int(raw.cause[index])), way)
    return replace(flight, cause=raw.cause, notes=notes)


def _sharpened(
    osc: Oscillator, states: States, flight: Flight, rough: Array, pushes: Array, limits: Allowance
) -> Flight:  # fmt: skip
    """Rough hits of linear models are refined in balls, and what balls do not confirm is flown in many digits.

    At near resonances all flights come back together: the state hardly matters, but the sums still cancel.
    """
    if kernel_of(osc).form is None or not rough.any():  # a flight in Taylor steps knows its error
        return flight
    table = table_of(kernel_of(osc), doubles(kernel_of(osc)))
    # pressed back at once, a flight is a short series in t that loses nothing
    far = (flight.flight_time > (table.step if table else 0)) | (pushes >= 0)
    left = LIMITS.settled
    for index in np.flatnonzero(far & rough).tolist():
        found = polished(osc, states, index, float(flight.flight_time[index]))
        if found is None and left:
            left -= 1
            settled = manydigits.settle(osc, states, index, limits.horizon)
            found = settled[1][:2] if settled is not None and settled[0] == Status.hit else None
        if found is not None:
            flight.flight_time[index], flight.velocity[index] = found
            for part, least in ((flight.time_error, 4), (flight.velocity_error, 64)):
                part[index] = np.minimum(part[index], least * EPSILON)
    return flight


def _conditioned(
    osc: Oscillator, states: States, flight: Flight, judged: Array, epsilon: float
) -> tuple[Flight, Array]:
    """The flight with conditions and errors; and where an error is more than condition and tolerance explain."""
    time, velocity = (np.array(part, dtype=float) for part in (flight.flight_time, flight.velocity))
    answers = response(osc, states.tau, states.v, time, velocity, judged)
    tau = states.tau if osc.period is None else reduced(states.tau, osc.period)
    kappas = answers.conditions(tau, states.v, time, velocity)
    with np.errstate(all="ignore"):
        late, dull = (part > np.maximum(least, 10 * kappa * epsilon)
                      for part, least, kappa in zip(answers.rounding, LIMITS.rough, kappas, strict=True))  # fmt: skip
        margin = LIMITS.margin if kernel_of(osc).form is None else 1.0
        errors = [margin * part + EPSILON for part in answers.rounding]
    flight = replace(flight, condition=kappas[0], velocity_condition=kappas[1], time_error=errors[0],
                     velocity_error=errors[1])  # fmt: skip
    return flight, late | dull


def _many_digits(osc: Oscillator, states: States, digits: int, limits: Allowance) -> Flight:
    """First hits in many digits, with the conditions that doubles know.

    Flights in Taylor steps are flown in doubles before: what does not come back there does not here, and the number of
    steps is known.
    """
    raw, known = raw_flights(states.v.size), {}
    budgets = np.full(states.v.size, limits.steps)
    if kernel_of(osc).form is None:
        tiny = np.array([states.v[i] == 0 and sign_of(states.exact_v(i)) > 0 for i in range(states.v.size)], bool)
        removed = removed_roots(states, raw.status)
        raw.status[tiny] = Status.unresolved
        fly(osc, kernel_of(osc), states, removed, acceleration(osc, states.tau), raw, limits)
        _escapes(osc, None, states, raw)
        over = raw.lost | (raw.status == Status.no_return) | (raw.status == Status.escaped)
        known = {int(i): int(raw.status[i]) for i in np.flatnonzero(over)}
        budgets = np.where(np.isnan(raw.judged[:, 8]), limits.steps, 2 * np.nan_to_num(raw.judged[:, 8]) + 100).astype(
            int
        )
    found, codes, rough = manydigits.flights(osc, states, digits, limits.horizon, known, budgets)
    for index in range(states.v.size):
        if index not in known:
            raw.numbers[index] = rough[index]
    status, cause = decoded(codes)
    flown = np.array([index not in known for index in range(status.size)], dtype=bool)
    raw.status[flown], raw.cause[flown] = status[flown], cause[flown]
    flight = _explained(osc, states, found, raw)
    flight, _ = _conditioned(osc, states, flight, raw.judged, limits.epsilon)
    error = np.where(raw.status == Status.hit, 10.0 ** -min(digits, 300), np.nan)
    return replace(flight, time_error=error, velocity_error=error.copy())


def _escapes(osc: Oscillator, form: LinearForm | None, states: States, raw: Raw) -> None:
    """Flights that have not returned become `escaped` where they are proved never to return."""
    # a flight that left the range of doubles, or spent its steps, was followed without impact too
    singular = (raw.cause == Cause.domain_left) & (raw.numbers[:, 3] > 0)
    gone = np.flatnonzero(((raw.status == Status.no_return) | (raw.lost & ~singular)) & (raw.numbers[:, 0] > 0))
    if gone.size:
        time, speed, place, _ = raw.numbers[gone].T
        proved = (never_turns(osc, place, speed) if form is None
                  else never_returns(osc, form, states.tau[gone], time, place, speed))  # fmt: skip
        raw.status[gone[proved]], raw.cause[gone[proved]] = Status.escaped, Cause.decided


def _settle(osc: Oscillator, states: States, raw: Raw, limits: Allowance) -> Array:
    """What doubles leave open is asked again with many digits: the state is exact, so the answer exists.  Which was."""
    open_ones = np.flatnonzero(raw.cause == Cause.near_graze)[: LIMITS.settled]
    for index in open_ones:
        settled = manydigits.settle(osc, states, int(index), limits.horizon)
        if settled is not None:
            raw.status[index], raw.numbers[index] = settled
            raw.cause[index], raw.judged[index] = Cause.decided, np.nan
    return open_ones


def flight_of(raw: Raw) -> Flight:
    """The carrier, with nan and inf where the status says so."""
    time, velocity, depth, bound = (raw.numbers[:, column].copy() for column in range(4))
    status = raw.status
    unknown = status == Status.unresolved
    gone = (status == Status.no_return) | (status == Status.escaped)
    time[gone], velocity[gone | unknown], time[unknown] = np.inf, np.nan, np.nan
    velocity[(status == Status.graze) | (status == Status.sticks)] = 0.0
    plain = (~unknown & (status != Status.graze)) | raw.lost
    depth[plain], bound[plain] = np.nan, np.nan
    return Flight(time, velocity, status, depth, bound, np.full(time.shape, np.nan), cause=raw.cause)
