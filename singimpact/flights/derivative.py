"""The derivative D G of the impact map, from the response of flights to their launches; and its determinant.

The determinant is the product of Liouville's formula, to full relative accuracy where the entries of D G nearly cancel:

    |det D G| = -rho'(u) (v/|u|) exp(-int_0^T f_v(x, x') dt)

A flight that contracts by e^(-70) leaves two equal columns of D G in doubles; this product knows its determinant.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial, reduce
from math import isnan
from typing import Any

import numpy as np

from singimpact.algebra.derivatives import derivative as formula_of_derivative
from singimpact.algebra.expressions import evaluate, names_in, substitute
from singimpact.algebra.numbers import Array, as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.flights.blocks import in_blocks, many
from singimpact.flights.compiled_model import allowed, compiled_model
from singimpact.flights.family import family
from singimpact.flights.flight_path import many_paths
from singimpact.flights.horizons import Allowance, horizon_of, steps_of
from singimpact.flights.impact_map import impact_map, plain_hit
from singimpact.flights.kernels.state import TIME_BY_TAU, VELOCITY_BY_V
from singimpact.flights.rebound_law import rebound, rebound_slope
from singimpact.flights.response import response, response_of_one, touching
from singimpact.flights.results import SCALAR_STATUS, Derivative
from singimpact.flights.states import States
from singimpact.flights.undecided import Flown, flights_and_rows
from singimpact.flights.walls import at_walls
from singimpact.inputs import checked_keywords
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import with_number
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.result import Result
from singimpact.status import Status, Wall


def derivative(osc: Oscillator, tau: Any, v: Any, *, horizon: Any = None, wall: Any = None) -> Derivative:
    """D G at states, from the variational equation.

    Parameters
    ----------
    osc : the model. tau, v : states, v >= 0; they broadcast. horizon : time after which a flight is given up.
    wall : of the states of a model with two walls, as for `first_hit`.

    Returns
    -------
    Derivative : matrix[..., 0, :] = d tau'/d(tau, v), matrix[..., 1, :] = d v'/d(tau, v), and the status of the flight.
        Without an impact it is nan.  At `graze` (infinite) and `sticks` it is one-sided, from the side that hits.

    Examples
    --------
    >>> (derivative(Oscillator("0", "-2", 0, "1/2"), 0, 1).matrix + 0).tolist()
    [[1.0, 1.0], [0.0, 0.5]]
    """
    if wall is not None:
        return at_walls(partial(derivative, horizon=horizon), osc, wall, (tau, v))  # type: ignore[no-any-return]
    flown = None
    if type(tau) is float and type(v) is float and horizon is None and compiled_model(osc).constant_restitution:
        result, flown = _of_one(osc, tau, v)
        if result is not None:
            return result
    if many(tau, v):
        return in_blocks(partial(derivative, osc, horizon=horizon), tau, v)  # type: ignore[no-any-return]
    states = States.of(osc, tau, v)
    model = (
        compiled_model(osc)
        if horizon is None
        else allowed(osc, Allowance(horizon_of(osc, horizon), steps=steps_of(osc)))
    )
    hit, rows = flights_and_rows(osc, model, states, flown)
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
    if not model.constant_restitution:
        dead = (status == Status.hit) & np.isnan(rebound(osc, velocity))
        status[dead], matrix[dead] = Status.no_rebound, np.nan
    touch, rest = np.flatnonzero(status == Status.graze), np.flatnonzero(status == Status.sticks)
    if touch.size:
        by_tau, by_v = touching(osc, states.tau[touch], states.v[touch], hit.flight_time[touch])
        side = np.where(np.broadcast_to(hit.wall, status.shape)[touch] == Wall.upper, -1.0, 1.0)
        matrix[touch] = _at_touch(side * by_tau, side * by_v)
    if rest.size:
        matrix[rest] = _at_rest(osc, acceleration(osc, states.tau[rest]))
    return Derivative(matrix.reshape(*states.shape, 2, 2), status.reshape(states.shape)[()])


@dataclass(frozen=True, eq=False)
class Sensitivity(Result):
    """Derivatives of impacts by their states and by numbers of the model.

    Attributes
    ----------
    matrix : shape (..., 2, 2 + numbers): of tau' and v', by tau, v and the numbers `over`; nan where there is no plain
        impact. over : their names. status : of the flights.
    """

    matrix: Array
    over: tuple[str, ...]
    status: Any


@checked_keywords
def sensitivity(osc: Oscillator, tau: Any, v: Any, over: Sequence[str]) -> Sensitivity:
    """The derivatives of the next impact by its state and by numbers of the model.

    Parameters
    ----------
    osc : the model, of one wall. tau, v : states, v >= 0; they broadcast. over : names of numbers, as `bifurcation`
        takes them.

    Examples
    --------
    >>> found = sensitivity(Oscillator("0", "-2", 0, "1/2"), 0, 1, ("restitution",))
    >>> (found.matrix + 0).tolist()  # T = v, v' = r v
    [[1.0, 1.0, 0.0], [0.0, 0.5, 1.0]]
    """
    osc = reduce(with_number, over, osc)
    moving, states = family(osc, over), States.of(osc, tau, v)
    step = impact_map(osc, states.tau, states.v)
    matrix = np.full((states.tau.size, 2, 2 + len(over)), np.nan)
    for i in np.flatnonzero(step.status == Status.hit).tolist():
        end = moving.end(moving.start, float(states.tau[i]), float(states.v[i]), float(step.flight_time[i]))
        columns = np.stack([end.by_tau, end.by_v, *end.by_numbers], axis=1)
        late = -columns[0] / end.by_time[0]
        _, slope, by_numbers = moving.rebound(float(step.velocity[i]), moving.start)
        matrix[i] = late, slope * (columns[1] + end.by_time[1] * late)
        matrix[i, 0, 0] += 1
        matrix[i, 1, 2:] += by_numbers
    return Sensitivity(matrix.reshape(*states.shape, 2, -1), tuple(over), step.status.reshape(states.shape)[()])


def _of_one(osc: Oscillator, tau: float, v: float) -> tuple[Derivative | None, Flown | None]:
    """D G at a plain hit of two floats; None for all others, with what was flown of them."""
    model = compiled_model(osc)
    hit, flown = plain_hit(model, tau, v)
    if hit is None:
        return None, flown
    late, later, faster, fast = hit[TIME_BY_TAU : VELOCITY_BY_V + 1]
    if not model.linear or isnan(late):
        late, later, faster, fast = response_of_one(osc, tau, v, hit[0], hit[1])
    slope = -model.r if hit[1] < 0 else model.rates[-1]
    matrix = np.array([[1 + late, later], [slope * faster, slope * fast]])
    return Derivative(matrix, SCALAR_STATUS[0]), None


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


# ---- the determinant


# Of Gauss's rule for the integral of a damping that varies along a flight: nodes of a piece, which on a piece of one
# unit of time are exact to degree 31; pieces per period of the forcing, or per unit of time without one
NODES, PIECES = 16, 4.0


def log_determinant(
    osc: Oscillator, tau: Array, v: Array, time: Array, velocity: Array, wall: Array | None = None
) -> Array:
    """ln |det D G| of impacts: flights from (tau, v), v > 0, that hit after `time` with x' = velocity < 0.

    Parameters
    ----------
    osc : the model. tau, v, time, velocity : shape (n,). wall : of the launches, of a model with two walls, where the
        velocity is > 0 at the upper one.

    Examples
    --------
    >>> osc = Oscillator("3*xdot", "-2", 0, "1/2")
    >>> from singimpact.flights.impact_map import first_hit
    >>> hit = first_hit(osc, np.zeros(1), np.ones(1))
    >>> log_determinant(osc, np.zeros(1), np.ones(1), hit.flight_time, hit.velocity).round(9).tolist()
    [-2.206788838]
    """
    if wall is not None and wall.any():
        logs = np.empty(tau.size)
        for side_of, model, side in ((0, osc, 1), (1, osc.mirrored, -1)):
            at = wall == side_of
            logs[at] = log_determinant(model, tau[at], v[at], time[at], side * velocity[at])
        return logs
    loss = _integral_of_damping(osc, tau, v, time)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.log(np.abs(rebound_slope(osc, velocity)) * v / np.abs(velocity)) - loss)


def _integral_of_damping(osc: Oscillator, tau: Array, v: Array, time: Array) -> Array:
    """The integral of f_v along each flight."""
    slope = formula_of_derivative(osc.f, "xdot")
    if not names_in(slope) & {"x", "xdot", "t"}:
        return as_float(substitute(slope, osc.parameters)) * time
    slope = formula_of_derivative(osc.force(), "xdot")
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    unit = 1.0 if osc.period is None else as_float(osc.period)
    counts = np.maximum(1, np.ceil(PIECES * time / unit)).astype(int)
    widths = time / counts
    ticks = [
        ((np.arange(n)[:, None] + (1 + nodes) / 2) * width).ravel() for n, width in zip(counts, widths, strict=True)
    ]
    clearance, integrals = as_float(osc.clearance), []
    for start, late, way, width in zip(tau, ticks, many_paths(osc, tau, v, ticks), widths, strict=True):
        state = {"x": clearance + way[:, 0], "xdot": way[:, 1], "t": start + late}
        values = evaluate(slope, state, DOUBLES) + np.zeros(len(way))
        integrals.append(width / 2 * (values.reshape(-1, NODES) @ weights).sum())
    return np.array(integrals)
