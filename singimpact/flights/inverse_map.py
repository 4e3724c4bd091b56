"""The inverse of the impact map: the flight that ended in an impact, run backwards."""

from functools import lru_cache, partial
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Name, multiply, names_in, number, power, substitute
from singimpact.algebra.numbers import Array, as_float, as_mpf
from singimpact.algebra.precision import digits_at, for_user
from singimpact.flights.blocks import in_blocks, many
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.impact_map import first_hit, landing_times, plain_fields
from singimpact.flights.rebound_law import sharpened, speed_before
from singimpact.flights.results import Step
from singimpact.flights.states import States
from singimpact.flights.undecided import in_shape
from singimpact.flights.walls import at_walls
from singimpact.oscillator.model import Oscillator, require_rebound
from singimpact.status import Status, status_array

KEPT = (
    "flight_time",
    "depth",
    "bound",
    "condition",
    "velocity_condition",
    "time_error",
    "velocity_error",
    "cause",
    "wall",
)


@lru_cache(maxsize=64)
def backwards(osc: Oscillator) -> Oscillator:
    """The model whose flights are those of `osc` run backwards: f(x, -x'), g(-t)."""
    turned = {"xdot": multiply(number(-1), Name("xdot")), "t": multiply(number(-1), Name("t"))}
    force, forcing = substitute(osc.force(), turned), substitute(osc.forcing(), turned)
    return Oscillator(force, forcing, osc.clearance, 1, period=osc.period, upper=osc.upper)


def inverse_map(
    osc: Oscillator, tau: Any, v: Any, *, digits: int | None = None, horizon: Any = None, wall: Any = None
) -> Step:
    """The state whose next impact leaves (tau, v): G^{-1}.

    Parameters
    ----------
    osc : the model. tau, v : states just after an impact, v >= 0. digits, horizon : as for the impact map.
    wall : of these states of a model with two walls, as for the impact map.

    Returns
    -------
    Step : tau and v before, flight_time > 0, velocity x' < 0 just before the impact at (tau, v), > 0 at an upper wall;
        `no_rebound` where no velocity rebounds to v. `wall` is the one of the state before.

    Examples
    --------
    >>> before = inverse_map(Oscillator("0", "-2", 0, "1/2"), 4, 1.5)
    >>> before.tau, before.v, before.status
    (np.float64(1.0), np.float64(3.0), np.int8(0))
    """
    require_rebound(osc, "the inverse of the impact map")
    if wall is not None:
        return at_walls(partial(inverse_map, digits=digits, horizon=horizon), osc, wall, (tau, v))  # type: ignore[no-any-return]
    if many(tau, v, digits=digits):
        return in_blocks(partial(inverse_map, osc, horizon=horizon), tau, v)  # type: ignore[no-any-return]
    if type(tau) is float and type(v) is float and digits is horizon is None and not names_in(osc.restitution):
        speed = v / compiled_model(osc).r if v > 0 else 0.0
        fields, _ = plain_fields(compiled_model(backwards(osc)), -tau, speed)
        if fields is not None:
            fields |= {"tau": tau - fields["flight_time"], "v": abs(fields["velocity"]), "velocity": -speed}
            return Step.made(fields.pop("later"), **fields)
    states = States.read(tau, v).in_period(osc)
    if digits is None:
        return _in_doubles(osc, states, horizon)
    speeds = _speeds(osc, states, digits)
    dead = np.array([speed is None for speed in speeds], dtype=bool)
    speeds[dead] = 0
    hit = first_hit(backwards(osc), _turned(states), speeds, digits=digits, horizon=horizon)
    return _step(states, hit, _in_digits(states, hit, speeds, digits), dead)


def _in_doubles(osc: Oscillator, states: States, horizon: Any) -> Step:
    speeds = states.v / as_float(osc.restitution) if not names_in(osc.restitution) else speed_before(osc, states.v)
    dead = np.isnan(speeds)
    times = -states.tau if states.v.all() else _turned(states)
    hit = first_hit(backwards(osc), times, np.where(dead, 0.0, speeds), horizon=horizon)
    fields = {"tau": landing_times(states, -hit.flight_time), "v": np.abs(hit.velocity), "velocity": -speeds}
    return _step(states, hit, fields, dead)


def _turned(states: States) -> Array:
    """-tau, a float where it came as one."""
    times = np.empty(states.v.size, dtype=object)
    for index in range(times.size):
        time = states.given(index)[0]
        times[index] = -time if isinstance(time, float) else multiply(number(-1), states.exact_tau(index))
    return times


def _speeds(osc: Oscillator, states: States, digits: int) -> Array:
    """U with rho(-U) = v, as an exact number where rho is -r v; None where no velocity rebounds to v."""
    speeds = np.empty(states.v.size, dtype=object)
    if not names_in(osc.restitution):
        inverse = power(osc.restitution, number(-1))
        speeds[:] = [multiply(states.exact_v(index), inverse) for index in range(speeds.size)]
        return speeds
    doubles = speed_before(osc, states.v)
    for index in np.flatnonzero(~np.isnan(doubles)).tolist():
        speeds[index] = sharpened(osc, states.exact_v(index), float(doubles[index]), digits)
    return speeds


def _step(states: States, hit: Any, fields: dict[str, Any], dead: Array) -> Step:
    """The state before, and the velocity just after its impact, in the shape of the states."""
    shape = states.shape
    status = np.where(dead, np.int8(Status.no_rebound), hit.status).astype(np.int8)
    fields["v"] = np.where(dead, np.nan, fields["v"])
    fields |= {"status": status} | {name: value for name, value in vars(hit).items() if name in KEPT}
    shaped = {name: np.reshape(value, shape)[()] for name, value in fields.items()}
    shaped["status"] = status_array(shaped["status"])
    later = vars(hit).get("_later")
    return Step.made(None if later is None else partial(in_shape, later, shape), **shaped, notes=hit.notes)


def _in_digits(states: States, hit: Any, speeds: Any, digits: int) -> dict[str, Any]:
    """The inverse map in mpmath numbers."""
    fields = {name: np.empty(speeds.size, dtype=object) for name in ("tau", "v", "velocity")}
    with digits_at(digits) as mp:
        for index, (time, speed) in enumerate(zip(np.ravel(hit.flight_time), np.ravel(hit.velocity), strict=True)):
            fields["tau"][index] = for_user(as_mpf(states.exact_tau(index), mp) - mp.convert(time))
            fields["v"][index] = for_user(abs(mp.convert(speed)))
            before = speeds[index]
            plain = isinstance(before, int | float) or hasattr(before, "_mpf_")
            fields["velocity"][index] = for_user(-(mp.mpf(before) if plain else as_mpf(before, mp)))
    return fields
