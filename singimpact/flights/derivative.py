"""The derivative D G of the impact map, and how a flight answers to its launch.

    U = x'(T),  dT/dtau = -Z/U,  dT/dv = -Y/U,  dU = (Z', Y') + x''(T) dT,  dv' = rho'(U) dU

with Y, Z the derivatives of x(T) by v and tau at fixed flight time: solutions of the variational equation, no
differences.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.derivatives import derivative as differentiated
from singimpact.algebra.expressions import evaluate, names_in
from singimpact.algebra.numbers import as_float, as_mpf
from singimpact.algebra.rings import DOUBLES, Multiprecision
from singimpact.flights.bind import over_mpmath
from singimpact.flights.compiled_model import EPSILON, Allowance, allowed, compiled_model
from singimpact.flights.kernels.state import TIME_BY_TAU, VELOCITY_BY_V, Columns, Rules, Work
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.model_numbers import constants_of, horizon_of, recurrence_of
from singimpact.flights.phase import reduced
from singimpact.flights.results import Derivative
from singimpact.flights.states import States
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.model import Oscillator
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
    from singimpact.flights import undecided
    from singimpact.flights.impact_map import rebound

    states = States.of(osc, tau, v)
    model = compiled_model(osc) if horizon is None else allowed(osc, Allowance(horizon_of(osc, horizon)))
    hit, rows = undecided.flights_and_rows(osc, model, states)
    status, velocity = np.asarray(hit.status).copy(), hit.velocity
    known = rows[TIME_BY_TAU : VELOCITY_BY_V + 1]
    others = np.isnan(known[0]) & (status == Status.hit)
    if others.any():
        at = np.flatnonzero(others)
        answers = response(osc, states.tau[at], states.v[at], hit.flight_time[at], velocity[at])
        known[:, at] = answers.time_by_tau, answers.time_by_v, answers.velocity_by_tau, answers.velocity_by_v
    known[:, status != Status.hit] = np.nan
    slope = rebound_slope(osc, velocity)
    matrix = np.stack([1 + known[0], known[1], slope * known[2], slope * known[3]], axis=-1).reshape(-1, 2, 2)
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


@dataclass(frozen=True)
class Response:
    """Derivatives at a hit: of the flight time and of x' there, by tau and by v."""

    time_by_tau: Any
    time_by_v: Any
    velocity_by_tau: Any
    velocity_by_v: Any

    def conditions(self, tau: Array, v: Array, time: Array, velocity: Array) -> tuple[Array, Array]:
        """kappa = 1 + (|dT/dtau| max(|tau|, |T|) + |dT/dv| v)/T, and so for x' at the hit; nan where there is none."""
        with np.errstate(all="ignore"):
            reach = np.maximum(np.abs(tau), time)
            late = 1 + (np.abs(self.time_by_tau) * reach + np.abs(self.time_by_v) * v) / time
            moved = 1 + (np.abs(self.velocity_by_tau) * reach + np.abs(self.velocity_by_v) * v) / np.abs(velocity)
        return np.where(np.isfinite(late), late, np.nan), moved


def response(osc: Oscillator, tau: Array, v: Array, time: Array, velocity: Array) -> Response:
    """The response of flights in doubles; entries that are no hits, velocity < 0, give nan."""
    parts = variations(osc, tau, v, time)
    with np.errstate(all="ignore"):
        parts[~((velocity < 0) & np.isfinite(time))] = np.nan
    return _response(parts.T, velocity, _acceleration(osc, tau, time, velocity))


def usual_errors(osc: Oscillator, tau: Array, v: Array, time: Array, velocity: Array) -> tuple[Array, Array]:
    """Relative errors of flight time and velocity as roundings of the velocities on the way usually leave them."""
    force = np.abs(_acceleration(osc, tau, time, velocity))
    with np.errstate(all="ignore"):
        speeds = np.abs(v) + np.abs(velocity) + force * np.minimum(time, 1) / 2
        late = LIMITS.likely * EPSILON * speeds * time / 2 / np.abs(velocity)
        off = LIMITS.likely * EPSILON * speeds + force * late
        return late / time, off / np.abs(velocity)


def touching(osc: Oscillator, tau: Array, v: Array, time: Array) -> tuple[Array, Array]:
    """Derivatives of x(T) by tau and by v at fixed flight time."""
    by_v, _, by_tau, _ = variations(osc, tau, v, time).T
    return by_tau, by_v


def variations(osc: Oscillator, tau: Array, v: Array, time: Array) -> Array:
    """dx/dv, dx'/dv, dx/dtau, dx'/dtau at fixed flight times >= 0, shape (n, 4); nan where the time is not finite."""
    from singimpact.flights.undecided import near

    model, out = compiled_model(osc), np.full((v.size, 4), np.nan)
    known = np.flatnonzero(np.isfinite(time))
    if known.size:
        out[known] = model.variations(near(osc, model, tau[known]), v[known], time[known])
    return out


def _response(parts: Any, velocity: Any, acceleration_there: Any) -> Response:
    by_v, by_v_dot, by_tau, by_tau_dot = parts
    with np.errstate(all="ignore"):
        time_by_tau, time_by_v = -by_tau / velocity, -by_v / velocity
        return Response(time_by_tau, time_by_v, by_tau_dot + acceleration_there * time_by_tau,
                        by_v_dot + acceleration_there * time_by_v)  # fmt: skip


@lru_cache(maxsize=256)
def _slope_of_rho(osc: Oscillator) -> Any:
    return differentiated(osc.rho(), "v")


def rebound_slope(osc: Oscillator, velocity: Any, ring: Any = DOUBLES) -> Any:
    """rho'(velocity)."""
    if not names_in(osc.restitution):
        return -evaluate(osc.restitution, {}, ring) + 0 * velocity
    return evaluate(_slope_of_rho(osc), {"v": velocity}, ring) + 0 * velocity


def _acceleration(osc: Oscillator, tau: Array, time: Array, velocity: Array) -> Array:
    """x'' at the hits."""
    start = tau if osc.period is None else reduced(tau, osc.period)
    with np.errstate(all="ignore"):
        forcing = evaluate(osc.forcing(), {"t": start + time}, DOUBLES) + 0 * velocity
        force = evaluate(osc.force(), {"x": as_float(osc.clearance), "xdot": velocity}, DOUBLES)
        found = np.asarray(forcing - force)
        for index in np.flatnonzero(np.abs(found) < LIMITS.cancelled * np.abs(forcing)):
            found[index] = _cancelled(osc, start[index] + time[index], velocity[index])
    return found


def _cancelled(osc: Oscillator, at: float, velocity: float) -> float:
    """x'' at a hit where g and f nearly cancel, from numbers that hold what doubles lose."""
    from singimpact.algebra.precision import balls_at

    balls = Balls(256)
    speed, time = (balls.rational(Fraction(float(value))) for value in (velocity, at))
    with balls_at(balls.bits):
        force = balls.evaluate(osc.force(), {"x": balls.evaluate(osc.clearance, {}), "xdot": speed})
        return float((balls.evaluate(osc.forcing(), {"t": time}) - force).mid())


def precise(osc: Oscillator, tau: Any, v: Any, time: Any, velocity: Any, mp: Any) -> Response:
    """The response of one flight at the precision of an mpmath context; by Taylor steps for every model."""
    flow = recurrence_of(osc)
    space = over_mpmath(mp, flow.source)
    order = degree_for(float(mp.eps)) if mp.prec < 1000 else int(mp.prec / 2.15)
    p = [as_mpf(tree, mp) for tree in constants_of(osc, linear=False)]
    rows = [[mp.mpf(0)] * (order + 2) for _ in range(flow.rows + 5)]
    work, columns = Work(rows[0], rows[5:], rows[1]), Columns(*rows[2:5])
    rules = Rules(mp.inf, LIMITS.steps, order, order, 8 * mp.eps, 0, 0, 0, 0, 0)
    *parts, _ = space["derivatives_at"]([tau], v, time, p, rules, work, columns)
    ring = Multiprecision(mp)
    values = {"x": as_mpf(osc.clearance, mp), "xdot": velocity}
    force = evaluate(osc.force(), values, ring)
    return _response(parts, velocity, evaluate(osc.forcing(), {"t": tau + time}, ring) - force)
