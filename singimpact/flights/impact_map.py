"""First hit F and impact map G, in doubles or in many digits, for one state or for arrays.

A pair of floats takes the short way: one call of the compiled entry.  All else is read once, flown in blocks, and the
few flights that end in no plain hit are decided one by one (`undecided`).
"""

from collections.abc import Mapping
from functools import partial
from math import inf
from typing import Any

import numpy as np

from singimpact.algebra.expressions import names_in
from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.flights import undecided
from singimpact.flights.blocks import in_blocks, many
from singimpact.flights.compiled_model import CompiledModel, allowed, compiled_model
from singimpact.flights.flat_numbers import EPSILON
from singimpact.flights.horizons import Allowance, horizon_of, reach_of, steps_of
from singimpact.flights.kernels.entries import HITS
from singimpact.flights.kernels.hits import CANCELS
from singimpact.flights.limits import LIMITS
from singimpact.flights.rebound_law import rebound
from singimpact.flights.response import response
from singimpact.flights.results import SCALAR_STATUS, Flight, Step
from singimpact.flights.states import States
from singimpact.inputs import refuse
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration_at
from singimpact.status import Cause, Status, status_array

NONE = np.int8(0)
# Launch times from which on the rounding of phases that no period takes in is looked at
LATE = 2.0**22
NO_NOTES: dict[int, str] = {}


def first_hit(
    osc: Oscillator,
    tau: Any,
    v: Any,
    *,
    digits: int | None = None,
    tolerance: Any = None,
    horizon: Any = None,
    steps: int | None = None,
    out: Mapping[str, Array] | None = None,
) -> Flight:
    """The first hit of the obstacle by the flight from (tau, v).

    Parameters
    ----------
    osc : the model.
    tau : launch times, any finite numbers. v : launch velocities >= 0; they broadcast.
    digits : decimal digits; the result then holds mpmath numbers, and `certified` the same with proved radii.
    tolerance : relative error allowed in a step of a Taylor flow, and, times ten, of a hit before it is refined.
    horizon : time after which a flight is given up. Without it at least 1000 periods of g (1e4 without a period, at
        most 2e5 radians of the fastest motion), 2 periods of a slow g, 64 half turns of the free motion (4 if f is not
        linear), and 8 v over the mean force. At most 1e7 radians.
    steps : Taylor steps after which a flight of a model without a closed form is given up; without it 16000, or
        fewer where f and g have many products and functions (700 of 100).
    out : arrays that take the results, by field: {"flight_time": a, "velocity": b}, memory maps too. Of the shape of
        the states, doubles (`status` and `cause`: int8). Other fields than these, `status` and `cause` are not kept.

    Returns
    -------
    Flight : arrays of the broadcast shape, scalars for scalars; 34 to 66 bytes a state. Arrays of more than 131072
        states are flown in blocks, which take 20 MB beside them.

    Examples
    --------
    >>> hit = first_hit(Oscillator("0", "-2", 0, 1), 0, [0, 1, 3])
    >>> hit.flight_time.tolist(), hit.velocity.tolist(), hit.status.tolist()
    ([0.0, 1.0, 3.0], [0.0, -1.0, -3.0], [2, 0, 0])
    """
    flown = None
    if type(tau) is float and type(v) is float and digits is tolerance is horizon is steps is None and out is None:
        fields, flown = plain_fields(compiled_model(osc), tau, v)
        if fields is not None:
            return Flight.made(fields.pop("later"), **fields)
    if many(tau, v, out, digits):
        fly = partial(first_hit, osc, tolerance=tolerance, horizon=horizon, steps=steps)
        return in_blocks(fly, tau, v, out)  # type: ignore[no-any-return]
    states = States.of(osc, tau, v, digits)
    return _flights(osc, states, digits, _allowance(osc, tolerance, horizon, steps), flown)


def impact_map(
    osc: Oscillator,
    tau: Any,
    v: Any,
    *,
    digits: int | None = None,
    tolerance: Any = None,
    horizon: Any = None,
    steps: int | None = None,
    out: Mapping[str, Array] | None = None,
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
    (4.0, 1.5, np.int8(0))
    """
    flown = None
    if type(tau) is float and type(v) is float and digits is tolerance is horizon is steps is None and out is None:
        model = compiled_model(osc)
        fields, flown = plain_fields(model, tau, v) if model.constant_restitution else (None, None)
        if fields is not None:
            later, velocity = fields.pop("later"), fields["velocity"]
            v = -model.r * velocity if velocity < 0 else model.rates[-1] * velocity
            return Step.made(later, tau=tau + fields["flight_time"], v=v, **fields)
    if many(tau, v, out, digits):
        fly = partial(impact_map, osc, tolerance=tolerance, horizon=horizon, steps=steps)
        return in_blocks(fly, tau, v, out)  # type: ignore[no-any-return]
    states = States.of(osc, tau, v, digits)
    hit = _flights(osc, states, digits, _allowance(osc, tolerance, horizon, steps), flown)
    if digits is not None:
        from singimpact.flights import in_digits  # with `multiprecision`: 8 ms that flights in doubles do not need

        return in_digits.step(osc, states, hit, digits)
    return landed(osc, states, hit)


def landed(osc: Oscillator, states: States, hit: Flight) -> Step:
    """The states just after first hits."""
    tau = landing_times(states, hit.flight_time)
    fields, model = vars(hit).copy(), compiled_model(osc)
    later = fields.pop("_later", None)
    if model.constant_restitution and osc.upper is None:
        return Step.made(later, **fields, tau=tau[()], v=np.abs(model.r * hit.velocity)[()])
    bounce = rebound(osc, np.asarray(hit.velocity))
    dead = (np.asarray(hit.status) == Status.hit) & np.isnan(bounce)
    fields["status"] = status_array(np.where(dead, np.int8(Status.no_rebound), hit.status).astype(np.int8))[()]
    return Step.made(later, **fields, tau=tau[()], v=bounce[()])


def landing_times(states: States, times: Any) -> Any:
    """Launch times plus flight times, in the shape of the states."""
    landed = states.tau.reshape(states.shape) + times
    return landed if isinstance(states.turns, float) else landed + states.turns.reshape(states.shape)


def plain_hit(model: CompiledModel, tau: float, v: float) -> tuple[list[float] | None, undecided.Flown | None]:
    """The columns of a plain hit of two floats, the first two of a Taylor flow; None for all that needs a closer look,
    with what was flown of it.
    """
    if not (0 < v < inf and -model.nearest < tau < model.nearest) or model.sometimes_kept:
        return None, None
    if model.osc.period is None and abs(tau) > LATE:
        return None, None
    code, hit = model.one(HITS, tau, v)
    if code == CANCELS:  # a_c at the launch has lost digits: flown with the exact one
        code, hit = model.one(HITS, tau, v, acceleration_at(model.osc, tau))
    return (hit, None) if code == 0 else (None, (np.array([code], np.int8), np.array(hit).reshape(10, 1)))


def plain_fields(model: CompiledModel, tau: float, v: float) -> tuple[dict[str, Any] | None, undecided.Flown | None]:
    """The fields of a `plain_hit`."""
    hit, flown = plain_hit(model, tau, v)
    if hit is None:
        return None, flown
    fields = {
        "flight_time": hit[0],
        "velocity": hit[1],
        "status": SCALAR_STATUS[0],
        "depth": np.nan,
        "bound": np.nan,
        "cause": NONE,
        "notes": NO_NOTES,
    }
    if model.osc.upper is not None:
        fields["wall"] = np.int8(hit[1] > 0)
    if not model.linear:
        return fields | {"later": partial(undecided.judged_alone, model, tau, v)}, None
    fields["condition"], fields["velocity_condition"], fields["time_error"], fields["velocity_error"] = hit[2:6]
    fields["later"] = None
    return fields, None


def _flights(
    osc: Oscillator, states: States, digits: int | None, allowance: Allowance | None, flown: undecided.Flown | None
) -> Flight:
    if digits is not None:
        from singimpact.flights import in_digits

        allowance = allowance or compiled_model(osc).allowance
        return shaped(in_digits.flights(osc, states, checked_digits(digits), allowance), states.shape)
    model = compiled_model(osc) if allowance is None else allowed(osc, allowance)
    return shaped(_with_rounded_launches(osc, states, undecided.flights(osc, model, states, flown)), states.shape)


def _with_rounded_launches(osc: Oscillator, states: States, flight: Flight) -> Flight:
    """Errors with what a late launch loses where no period takes it in: its digits beyond a double, those of phases.

    Where this is more than a hundredth of the flight time or velocity, rounding would decide which impact is the first:
    such flights are decided in many digits.
    """
    if osc.period is not None or not names_in(osc.g):
        return flight
    time, velocity = flight.flight_time, flight.velocity
    # phases are reduced with twice a double's digits
    lost = np.abs(states.below_doubles()) + (4 * EPSILON * states.tau) ** 2
    late = np.flatnonzero((np.asarray(flight.status) == Status.hit) & (lost > EPSILON * np.abs(time)))
    if late.size:
        moved = response(osc, states.tau[late], states.v[late], time[late], velocity[late])
        flight.time_error[late] += np.abs(moved.time_by_tau) * lost[late] / time[late]
        flight.velocity_error[late] += np.abs(moved.velocity_by_tau) * lost[late] / np.abs(velocity[late])
        error = np.maximum(flight.time_error[late], flight.velocity_error[late])
        for n, index in enumerate(late[~(error < LIMITS.vague)].tolist()):
            _decide_in_digits(osc, states, flight, index, n < LIMITS.settled)
    return flight


def _decide_in_digits(osc: Oscillator, states: States, flight: Flight, index: int, few: bool) -> None:
    """One flight that doubles leave open, from the time that was written; unresolved after many of them.

    Its errors stay those of a launch from a double, which are what the call's other flights have.
    """
    flight.status[index], flight.cause[index] = Status.unresolved, Cause.near_graze
    numbers, values = (flight.flight_time, flight.velocity), [np.nan, np.nan]
    if few:
        exact = first_hit(osc, states.written[0][index], states.written[1][index], digits=20)
        flight.status[index], flight.cause[index] = exact.status, exact.cause
        if exact.status == Status.hit:
            values = [float(exact.flight_time), float(exact.velocity)]
    if flight.status[index] != Status.hit:
        flight.time_error[index] = flight.velocity_error[index] = np.nan
    for array, value in zip(numbers, values, strict=True):
        array[index] = value


def _allowance(osc: Oscillator, tolerance: Any, horizon: Any, steps: Any) -> Allowance | None:
    """The options of one call; None stands for a default."""
    if tolerance is horizon is steps is None:
        return None
    reach = reach_of(osc) if horizon is None else 0.0
    return Allowance(horizon_of(osc, horizon), _tolerance(tolerance), checked_steps(osc, steps), reach)


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


def checked_steps(osc: Oscillator, steps: Any) -> int:
    """The steps of a flight, between 1 and ten million."""
    if steps is None:
        return steps_of(osc)
    if isinstance(steps, bool) or not isinstance(steps, int | np.integer) or not 1 <= steps <= 10_000_000:
        raise refuse("steps", steps, "a whole number from 1 to 10000000")
    return int(steps)


def shaped(flight: Flight, shape: tuple[int, ...]) -> Flight:
    """The flat fields in a shape, or as scalars."""
    later = vars(flight).get("_later")
    if len(shape) == 1:
        flight.__dict__["status"] = status_array(flight.status)
        return flight
    fields = {
        name: value if name == "notes" or value is None else np.asarray(value).reshape(shape)[()]
        for name, value in vars(flight).items()
        if name != "_later"
    }
    fields["status"] = status_array(fields["status"])
    return type(flight).made(None if later is None else partial(undecided.in_shape, later, shape), **fields)
