"""How a flight answers to its launch: the derivative D G of the impact map, and condition numbers.

    U = x'(T),  dT/dtau = -Z/U,  dT/dv = -Y/U,  dU = (Z', Y') + x''(T) dT,  dv' = rho'(U) dU

with Y, Z the derivatives of x(T) by v and tau at fixed flight time: solutions of the variational equation, no
differences.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.derivatives import derivative as differentiated
from singimpact.algebra.expressions import evaluate, names_in
from singimpact.algebra.numbers import as_float, as_mpf
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import DOUBLES, Multiprecision
from singimpact.codegen.kernels import FUNCTIONS, plain
from singimpact.flights.kernel import kernel_of, ready, taylor_kernel
from singimpact.flights.launch import launches, workspace
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.phase import reduced
from singimpact.oscillator.model import Oscillator

Array = np.ndarray[Any, Any]
EPSILON = 2.0**-52


@dataclass(frozen=True)
class Response:
    """Derivatives at a hit: of the flight time and of x' there, by tau and by v."""

    time_by_tau: Any
    time_by_v: Any
    velocity_by_tau: Any
    velocity_by_v: Any
    rounding: Any = None
    """Of the flight time and of x' at the hit, relative, as it usually is."""

    def conditions(self, tau: Array, v: Array, time: Array, velocity: Array) -> tuple[Array, Array]:
        """kappa = 1 + (|dT/dtau| max(|tau|, |T|) + |dT/dv| v)/T, and so for x' at the hit; nan where there is none."""
        with np.errstate(all="ignore"):
            reach = np.maximum(np.abs(tau), time)
            late = 1 + (np.abs(self.time_by_tau) * reach + np.abs(self.time_by_v) * v) / time
            moved = 1 + (np.abs(self.velocity_by_tau) * reach + np.abs(self.velocity_by_v) * v) / np.abs(velocity)
        return np.where(np.isfinite(late), late, np.nan), moved


def response(
    osc: Oscillator, tau: Array, v: Array, time: Array, velocity: Array, judged: Array | None = None
) -> Response:
    """The response of flights in doubles; entries that are no hits, velocity < 0, give nan.

    Parameters
    ----------
    judged : what `variation.judge` has filled for flights in Taylor steps, nan where it has not.
    """
    flat = np.full((v.size, 6), np.nan)
    with np.errstate(all="ignore"):
        hit = (velocity < 0) & np.isfinite(time)
    known = np.zeros(v.size, dtype=bool) if judged is None else ~np.isnan(judged[:, 0])
    rest = np.flatnonzero(hit & ~known)
    if rest.size:
        flat[rest] = variations(osc, tau[rest], v[rest], time[rest])
    if judged is not None:
        flat[known, :4] = judged[known, :4]
    acceleration = _acceleration(osc, tau, time, velocity)
    found = _response(flat.T[:4], velocity, acceleration)
    _sized(osc, flat, v, time, velocity, acceleration)
    with np.errstate(all="ignore"):
        late = LIMITS.likely * EPSILON * flat[:, 4] / np.abs(velocity)
        dull = LIMITS.likely * EPSILON * flat[:, 5] + np.abs(acceleration) * late
        rounding = [late / time, dull / np.abs(velocity)]
        if judged is not None and known.any():
            for part, better in zip(rounding, _carried(judged[known], time[known], velocity[known]), strict=True):
                part[known] = better
    return replace(found, rounding=tuple(rounding))


def _carried(judged: Array, time: Array, velocity: Array) -> tuple[Array, Array]:
    """Relative errors of flight time and velocity from the variances of x and x' at the hit."""
    zz, zu, uu, acceleration, steps = judged[:, 4:9].T
    turn = acceleration / velocity
    late = np.sqrt(zz / velocity**2 + steps * (time * EPSILON / 2) ** 2)
    dull = np.sqrt(np.maximum(uu - 2 * turn * zu + turn**2 * zz, 0.0))
    return late / time, dull / np.abs(velocity)


def _sized(osc: Oscillator, flat: Array, v: Array, time: Array, velocity: Array, acceleration: Array) -> None:
    """The sizes that rounding is relative to: with a closed form its phases lose digits in time; else by the speeds."""
    kernel = kernel_of(osc)
    with np.errstate(all="ignore"):
        if kernel.form is not None:
            flat[:, 4:] *= (1 + as_float(kernel.constants[4]) * time * LIMITS.likely_phase)[:, None]
        else:
            speeds = np.abs(v) + np.abs(velocity) + np.abs(acceleration) * np.minimum(time, 1) / 2
            flat[:, 5] = speeds * LIMITS.likely_steps
            flat[:, 4] = flat[:, 5] * time / 2


def touching(osc: Oscillator, tau: Array, v: Array, time: Array) -> tuple[Array, Array]:
    """Derivatives of x(T) by tau and by v at fixed flight time."""
    by_v, _, by_tau, *_ = variations(osc, tau, v, time).T
    return by_tau, by_v


def _response(variations: Any, velocity: Any, acceleration: Any) -> Response:
    by_v, by_v_dot, by_tau, by_tau_dot = variations
    with np.errstate(all="ignore"):
        time_by_tau, time_by_v = -by_tau / velocity, -by_v / velocity
        return Response(time_by_tau, time_by_v, by_tau_dot + acceleration * time_by_tau,
                        by_v_dot + acceleration * time_by_v)  # fmt: skip


def variations(osc: Oscillator, tau: Array, v: Array, time: Array) -> Array:
    """dx/dv, dx'/dv, dx/dtau, dx'/dtau at fixed flight times >= 0, and the sizes of x and x', shape (n, 6)."""
    kernel, out = kernel_of(osc), np.full((v.size, 6), np.nan)
    if kernel.form is not None:
        p = np.array([as_float(tree) for tree in kernel.constants])
        ready(kernel, "responses", v.size)(launches(osc, kernel, tau), v, time, p, out)
        return out
    p, order = np.array([as_float(tree) for tree in kernel.constants]), degree_for(EPSILON)
    rows = [np.zeros(order + 2) for _ in range(4)]
    ready(kernel, "respond_all", v.size)(
        launches(osc, kernel, tau), v, time, order, LIMITS.steps, LIMITS.safety * EPSILON, p, rows[0],
        np.zeros((kernel.rows, order + 2)), *rows[1:], out,
    )  # fmt: skip
    return out


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
    balls = Balls(256)
    speed, time = (balls.rational(Fraction(float(value))) for value in (velocity, at))
    pull = balls.evaluate(osc.force(), {"x": balls.evaluate(osc.clearance, {}), "xdot": speed})
    push = balls.evaluate(osc.forcing(), {"t": time})
    with balls_at(53):
        return float((push - pull).mid())


def precise(osc: Oscillator, tau: Any, v: Any, time: Any, velocity: Any, mp: Any) -> Response:
    """The response of one flight, given and returned in an mpmath context, at its precision."""
    kernel = taylor_kernel(osc)
    space = plain(kernel.text, {name: getattr(mp, {"log": "ln"}.get(name, name)) for name in FUNCTIONS})
    order = degree_for(float(mp.eps)) if mp.prec < 1000 else int(mp.prec / 2.15)
    p = [as_mpf(tree, mp) for tree in kernel.constants]
    work = workspace(mp.mpf(0), order, kernel.rows, 3)
    *variations, _ = space["respond"]([tau], v, time, order, LIMITS.steps, 8 * mp.eps, p, *work)
    ring = Multiprecision(mp)
    values = {"x": as_mpf(osc.clearance, mp), "xdot": velocity}
    pull = evaluate(osc.force(), values, ring)
    return _response(variations, velocity, evaluate(osc.forcing(), {"t": tau + time}, ring) - pull)
