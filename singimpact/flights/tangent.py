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
from singimpact.algebra.rings import DOUBLES, Multiprecision
from singimpact.codegen.interpreted import function
from singimpact.codegen.kernels import FUNCTIONS, plain
from singimpact.flights import kernel as kernels
from singimpact.flights import march, variation
from singimpact.flights.flow import taylor
from singimpact.flights.kernel import kernel_of, ready
from singimpact.flights.launch import launches
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


def response(osc: Oscillator, tau: Array, v: Array, time: Array, velocity: Array) -> Response:
    """The response of flights in doubles; entries that are no hits, velocity < 0, give nan."""
    flat = np.full((v.size, 6), np.nan)
    with np.errstate(all="ignore"):
        hit = np.flatnonzero((velocity < 0) & np.isfinite(time))
    if hit.size:
        flat[hit] = variations(osc, tau[hit], v[hit], time[hit])
    acceleration = _acceleration(osc, tau, time, velocity)
    found = _response(flat.T[:4], velocity, acceleration)
    _sized(osc, flat, v, time, velocity, acceleration)
    with np.errstate(all="ignore"):
        late = LIMITS.likely * EPSILON * flat[:, 4] / np.abs(velocity)
        dull = LIMITS.likely * EPSILON * flat[:, 5] + np.abs(acceleration) * late
        rounding = late / time, dull / np.abs(velocity)
    return replace(found, rounding=rounding)


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
    text, names = _text(osc)
    emitted, order = taylor.variation_of(osc), degree_for(EPSILON)
    p = np.array([as_float(tree) for tree in taylor.values(osc, emitted)])
    rows = [np.zeros(order + 2) for _ in range(3)]
    function(text, names, "respond_all", v.size * kernels.PRICES.taylor)(
        launches(osc, kernel, tau), v, time, order, LIMITS.safety * EPSILON, p, rows[0],
        np.zeros((emitted.rows, order + 2)), rows[1], rows[2], out,
    )  # fmt: skip
    return out


def _text(osc: Oscillator) -> tuple[str, tuple[str, ...]]:
    parts = (taylor.step_size, march.advanced, variation.respond, variation.respond_all)
    return kernels.joined(taylor.variation_of(osc).source, parts), ("variations", *(part.__name__ for part in parts))


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
    return float((balls.evaluate(osc.forcing(), {"t": time}) - pull).mid())


def precise(osc: Oscillator, tau: Any, v: Any, time: Any, velocity: Any) -> Response:
    """The response of one flight at the working precision of mpmath."""
    import mpmath

    emitted = taylor.variation_of(osc)
    space = plain(_text(osc)[0], {name: getattr(mpmath.mp, {"log": "ln"}.get(name, name)) for name in FUNCTIONS})
    order = degree_for(float(mpmath.eps)) if mpmath.mp.prec < 1000 else int(mpmath.mp.prec / 2.15)
    p = np.array([as_mpf(tree, mpmath.mp) for tree in taylor.values(osc, emitted)], dtype=object)
    work = [np.full(shape, mpmath.mpf(0), dtype=object)
            for shape in ((order + 2,), (emitted.rows, order + 2), (order + 2,), (order + 2,))]  # fmt: skip
    *variations, _ = space["respond"]([tau], v, time, order, 8 * mpmath.eps, p, *work)
    ring = Multiprecision(mpmath.mp)
    values = {"x": as_mpf(osc.clearance, mpmath.mp), "xdot": velocity}
    pull = evaluate(osc.force(), values, ring)
    return _response(variations, velocity, evaluate(osc.forcing(), {"t": tau + time}, ring) - pull)
