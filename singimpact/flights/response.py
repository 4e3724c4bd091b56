"""Derivatives of a hit by its launch, condition numbers, usual errors.

    U = x'(T),  dT/dtau = -Z/U,  dT/dv = -Y/U,  dU = (Z', Y') + x''(T) dT

with Y, Z the derivatives of x(T) by v and tau at fixed flight time: solutions of the variational equation, no
differences.
"""

from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.numbers import Array, as_float, as_mpf
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import DOUBLES, Multiprecision
from singimpact.flights.bind import over_mpmath
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.flat_numbers import EPSILON
from singimpact.flights.kernels.entries import VARIATIONS
from singimpact.flights.kernels.state import Columns, Rules, Work
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.model_numbers import constants_of, recurrence_of
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import reduced
from singimpact.oscillator.wall_acceleration import in_floats_of


class Response(NamedTuple):
    """Derivatives at a hit: of the flight time and of x' there, by tau and by v."""

    time_by_tau: Any
    time_by_v: Any
    velocity_by_tau: Any
    velocity_by_v: Any

    def conditions(self, tau: Array, v: Array, time: Array, velocity: Array) -> tuple[Array, Array]:
        """kappa = 1 + (|dT/dtau| max(|tau|, |T|) + |dT/dv| v)/T, and so for x' at the hit; nan where there is none."""
        with np.errstate(all="ignore"):
            # tau is rounded with its own size, and with that of the flight time where it is smaller
            reach = np.maximum(np.abs(tau), time)
            late = 1 + (np.abs(self.time_by_tau) * reach + np.abs(self.time_by_v) * v) / time
            moved = 1 + (np.abs(self.velocity_by_tau) * reach + np.abs(self.velocity_by_v) * v) / np.abs(velocity)
        return np.where(np.isfinite(late), late, np.nan), moved


def response(osc: Oscillator, tau: Array, v: Array, time: Array, velocity: Array) -> Response:
    """The response of flights in doubles; entries that are no hits, velocity < 0, or > 0 at an upper wall, give nan."""
    parts = variations(osc, tau, v, time)
    with np.errstate(all="ignore"):
        hits = velocity < 0 if osc.upper is None else velocity != 0
        parts[~(hits & np.isfinite(time))] = np.nan
    return with_bend(parts.T, velocity, _acceleration(osc, tau, time, velocity))


def response_of_one(osc: Oscillator, tau: float, v: float, time: float, velocity: float) -> Response:
    """`response` of one hit of a launch with v > 0, in floats."""
    forcing, force = in_floats_of(osc)
    parts = compiled_model(osc).one(VARIATIONS, tau, v, time)[1][:4]
    if velocity > 0:  # at an upper wall
        there = float(_acceleration(osc, *(np.array([number]) for number in (tau, time, velocity)))[0])
        return with_bend(parts, velocity, there)
    at = (tau if osc.period is None else float(reduced(np.array([tau]), osc.period)[0])) + time
    ahead = forcing(at)
    there = ahead - force(velocity, at)
    if not abs(there) >= LIMITS.cancelled * abs(ahead):
        there = float(_acceleration(osc, *(np.array([number]) for number in (tau, time, velocity)))[0])
    return with_bend(parts, velocity, there)


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
    model, out = compiled_model(osc), np.full((v.size, 4), np.nan)
    known = np.flatnonzero(np.isfinite(time))
    if known.size:
        out[known] = model.variations(model.near(tau[known]), v[known], time[known])
    return out


def with_bend(parts: Any, velocity: Any, acceleration_there: Any) -> Response:
    """The response from derivatives of x and x' at the flight time, by v and by tau, and x'' there."""
    by_v, by_v_dot, by_tau, by_tau_dot = parts
    with np.errstate(all="ignore"):
        time_by_tau, time_by_v = -by_tau / velocity, -by_v / velocity
        return Response(
            time_by_tau,
            time_by_v,
            by_tau_dot + acceleration_there * time_by_tau,
            by_v_dot + acceleration_there * time_by_v,
        )


def _acceleration(osc: Oscillator, tau: Array, time: Array, velocity: Array) -> Array:
    """x'' at the hits."""
    start = tau if osc.period is None else reduced(tau, osc.period)
    lower = as_float(osc.clearance)
    x = lower if osc.upper is None else np.where(velocity > 0, as_float(osc.upper), lower)
    with np.errstate(all="ignore"):
        state = {"x": x, "xdot": velocity, "t": start + time}
        forcing = evaluate(osc.forcing(), state, DOUBLES) + 0 * velocity
        difference = np.asarray(forcing - evaluate(osc.force(), state, DOUBLES))
        # where g and f nearly cancel, doubles keep too few digits of x''
        for index in np.flatnonzero(np.abs(difference) < LIMITS.cancelled * np.abs(forcing)):
            difference[index] = _cancelled(osc, start[index] + time[index], velocity[index])
    return difference


def _cancelled(osc: Oscillator, at: float, velocity: float) -> float:
    """x'' at a hit where g and f nearly cancel, from numbers that hold what doubles lose."""
    balls = Balls(256)
    speed, time = (balls.rational(Fraction(float(value))) for value in (velocity, at))
    with balls_at(balls.bits):
        place = osc.clearance if osc.upper is None or velocity < 0 else osc.upper
        force = balls.evaluate(osc.force(), {"x": balls.evaluate(place, {}), "xdot": speed, "t": time})
        return float((balls.evaluate(osc.forcing(), {"t": time}) - force).mid())


def precise(osc: Oscillator, tau: Any, v: Any, time: Any, velocity: Any, mp: Any) -> Response:
    """The response of one flight at the precision of an mpmath context; by Taylor steps for every model."""
    flow = recurrence_of(osc)
    space = over_mpmath(mp, flow.source)
    order = degree_for(float(mp.eps)) if mp.prec < 1000 else int(mp.prec / 2.15)
    p = [as_mpf(tree, mp) for tree in constants_of(osc, linear=False)]
    rows = [[mp.mpf(0)] * (order + 2) for _ in range(flow.rows + 5)]
    work, columns = Work(rows[0], rows[5:], rows[1]), Columns(*rows[2:5])
    rules = Rules(mp.inf, LIMITS.steps, order, order, 8 * mp.eps, 0, 0, 0, 0, 0, 0, mp.inf, 0)
    *parts, _ = space["derivatives_at"]([tau], v, time, p, rules, work, columns)
    ring = Multiprecision(mp)
    values = {"x": as_mpf(osc.clearance, mp), "xdot": velocity, "t": tau + time}
    return with_bend(parts, velocity, evaluate(osc.forcing(), values, ring) - evaluate(osc.force(), values, ring))
