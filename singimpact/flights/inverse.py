"""The inverse of the impact map: the flight that ended in an impact, run backwards."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Name, multiply, names_in, number, substitute
from singimpact.algebra.numbers import as_float, as_mpf
from singimpact.algebra.precision import digits_at, for_user
from singimpact.flights.carriers import Step
from singimpact.flights.hits import first_hit
from singimpact.flights.launch import States
from singimpact.flights.velocity_before import sharpened, speed_before
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

Array = np.ndarray[Any, Any]
KEPT = ("flight_time", "depth", "bound", "condition", "velocity_condition", "time_error", "velocity_error", "cause")


@lru_cache(maxsize=64)
def backwards(osc: Oscillator) -> Oscillator:
    """The model whose flights are those of `osc` run backwards: f(x, -x'), g(-t)."""
    turned = {"xdot": multiply(number(-1), Name("xdot")), "t": multiply(number(-1), Name("t"))}
    return Oscillator(
        substitute(osc.force(), turned), substitute(osc.forcing(), turned), osc.clearance, 1, period=osc.period
    )


def inverse_map(osc: Oscillator, tau: Any, v: Any, *, digits: int | None = None, horizon: Any = None) -> Step:
    """The state whose next impact leaves (tau, v): G^{-1}.

    Parameters
    ----------
    osc : the model. tau, v : states just after an impact, v >= 0. digits, horizon : as for the impact map.

    Returns
    -------
    Step : tau and v before, flight_time > 0, velocity x' < 0 just before the impact at (tau, v); `no_rebound` where no
        velocity rebounds to v.

    Examples
    --------
    >>> before = inverse_map(Oscillator("0", "-2", 0, "1/2"), 4, 1.5)
    >>> before.tau, before.v, before.status
    (np.float64(1.0), np.float64(3.0), np.int8(0))
    """
    states = States.read(tau, v)
    times, speeds = np.empty(states.v.size, dtype=object), _speeds(osc, states, digits)
    dead = np.array([speed is None for speed in speeds], dtype=bool)
    for index in range(states.v.size):
        time = states.given(index)[0]
        times[index] = -time if isinstance(time, float) else multiply(number(-1), states.exact_tau(index))
        speeds[index] = 0 if dead[index] else speeds[index]
    hit = first_hit(backwards(osc), times, speeds, digits=digits, horizon=horizon)
    return _step(states, hit, speeds, dead, digits)


def _speeds(osc: Oscillator, states: States, digits: int | None) -> Array:
    """U with rho(-U) = v, as an exact number where rho is -r v; None where no velocity rebounds to v."""
    found = np.empty(states.v.size, dtype=object)
    if not names_in(osc.restitution):
        found[:] = [multiply(states.exact_v(index), _inverse(osc)) for index in range(found.size)]
        return found
    doubles = speed_before(osc, states.v)
    for index in np.flatnonzero(~np.isnan(doubles)).tolist():
        found[index] = (
            float(doubles[index])
            if digits is None
            else sharpened(osc, states.exact_v(index), float(doubles[index]), digits)
        )
    return found


def _inverse(osc: Oscillator) -> Any:
    from singimpact.algebra.expressions import power

    return power(osc.restitution, number(-1))


def _step(states: States, hit: Any, speeds: Any, dead: Any, digits: int | None) -> Step:
    shape = states.shape
    status = np.where(dead, np.int8(Status.no_rebound), np.ravel(hit.status)).astype(np.int8)
    fields = _in_doubles(states, hit, speeds) if digits is None else _in_digits(states, hit, speeds, digits)
    fields |= {name: getattr(hit, name) for name in KEPT}
    fields["v"] = np.where(dead, np.nan, fields["v"])
    shaped = {name: np.reshape(value, shape)[()] for name, value in fields.items()}
    return Step(**shaped, status=status.reshape(shape)[()], notes=hit.notes)


def _in_doubles(states: States, hit: Any, speeds: Any) -> dict[str, Any]:
    """The state before, and the velocity just after its impact."""
    before = -np.array([as_float(s) if not isinstance(s, int | float) else float(s) for s in speeds])
    return {"tau": states.tau - np.ravel(hit.flight_time), "v": -np.ravel(hit.velocity) + 0, "velocity": before}


def _in_digits(states: States, hit: Any, speeds: Any, digits: int) -> dict[str, Any]:
    """The same in mpmath numbers."""
    fields = {name: np.empty(speeds.size, dtype=object) for name in ("tau", "v", "velocity")}
    with digits_at(digits) as mp:
        for index, (time, speed) in enumerate(zip(np.ravel(hit.flight_time), np.ravel(hit.velocity), strict=True)):
            fields["tau"][index] = for_user(as_mpf(states.exact_tau(index), mp) - mp.convert(time))
            fields["v"][index] = for_user(-mp.convert(speed) + 0)
            fields["velocity"][index] = for_user(-_number(speeds[index], mp))
    return fields


def _number(value: Any, mp: Any) -> Any:
    return mp.mpf(value) if isinstance(value, int | float) or hasattr(value, "_mpf_") else as_mpf(value, mp)
