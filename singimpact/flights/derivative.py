"""The derivative D G of the impact map, from the response of flights to their launches."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from singimpact.algebra.expressions import names_in
from singimpact.flights.blocks import in_blocks, many
from singimpact.flights.compiled_model import allowed, compiled_model
from singimpact.flights.horizons import Allowance, horizon_of, steps_of
from singimpact.flights.kernels.state import TIME_BY_TAU, VELOCITY_BY_V
from singimpact.flights.rebound_law import rebound, rebound_slope
from singimpact.flights.response import response, touching
from singimpact.flights.results import Derivative
from singimpact.flights.states import States
from singimpact.flights.undecided import flights_and_rows
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.status import Status

Array = np.ndarray[Any, Any]


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
    if many(tau, v):
        return in_blocks(partial(derivative, osc, horizon=horizon), tau, v)  # type: ignore[no-any-return]
    states = States.of(osc, tau, v)
    model = (
        compiled_model(osc)
        if horizon is None
        else allowed(osc, Allowance(horizon_of(osc, horizon), steps=steps_of(osc)))
    )
    hit, rows = flights_and_rows(osc, model, states)
    status, velocity = np.asarray(hit.status).copy(), hit.velocity
    columns = rows[TIME_BY_TAU : VELOCITY_BY_V + 1]
    others = np.isnan(columns[0]) & (status == Status.hit)
    if others.any():
        at = np.flatnonzero(others)
        answers = response(osc, states.tau[at], states.v[at], hit.flight_time[at], velocity[at])
        columns[:, at] = answers.time_by_tau, answers.time_by_v, answers.velocity_by_tau, answers.velocity_by_v
    columns[:, status != Status.hit] = np.nan
    slope = rebound_slope(osc, velocity)
    matrix = np.stack([1 + columns[0], columns[1], slope * columns[2], slope * columns[3]], axis=-1).reshape(-1, 2, 2)
    if names_in(osc.restitution):
        dead = (status == Status.hit) & np.isnan(rebound(osc, velocity))
        status[dead], matrix[dead] = Status.no_rebound, np.nan
    touch, rest = np.flatnonzero(status == Status.graze), np.flatnonzero(status == Status.sticks)
    if touch.size:
        matrix[touch] = _at_touch(*touching(osc, states.tau[touch], states.v[touch], hit.flight_time[touch]))
    if rest.size:
        matrix[rest] = _at_rest(osc, acceleration(osc, states.tau[rest]))
    return Derivative(matrix.reshape(*states.shape, 2, 2), status.reshape(states.shape)[()])


def _at_touch(by_tau: Array, by_v: Array) -> Array:
    """On the side that hits, T = T_0 - sqrt(2 depth/x'') and v' = r sqrt(2 depth x''), where depth falls with x."""
    with np.errstate(invalid="ignore"):
        steep = [np.where(part == 0, 0.0, np.sign(part) * np.inf) for part in (by_tau, by_v)]
    return np.stack([1 + steep[0], steep[1], -steep[0], -steep[1]], axis=-1).reshape(-1, 2, 2)


def _at_rest(osc: Oscillator, acceleration_there: Array) -> Array:
    """From v > 0: G = (tau - 2 v/a + ..., r v + ...)."""
    slope = rebound_slope(osc, np.zeros(acceleration_there.shape))
    with np.errstate(divide="ignore"):
        delay = np.where(acceleration_there < 0, -2 / acceleration_there, np.inf)
    one = np.ones(delay.shape)
    return np.stack([one, delay, 0 * one, -slope], axis=-1).reshape(-1, 2, 2)
