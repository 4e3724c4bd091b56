"""The series by sympy as one writes them down: Picard's integrals, `series` in a bookkeeping letter, `solve`.

sigma, t, v are small; force f(x, x') and forcing g(t) are polynomials in sympy, perhaps with symbols, and tau_* = 0.
"""

from typing import Any

import sympy

sigma, t, v, x, xdot, h = sympy.symbols("sigma t v x xdot h")


def cut(expression: Any, small: tuple[Any, ...], order: int) -> Any:
    """The terms of total degree <= order in the small letters, by sympy's `series`."""
    scaled = sympy.expand(expression.subs({letter: h * letter for letter in small}, simultaneous=True))
    return sympy.expand(sympy.series(scaled, h, 0, order + 1).removeO().subs(h, 1))


def flight(force: Any, forcing: Any, clearance: Any, order: int) -> Any:
    """x(sigma, v; t) from (clearance, v) at sigma, to degree order + 1 in (sigma, t, v), by Picard's integrals."""
    found, time = clearance + v * t, sympy.Symbol("time")
    for _ in range(order):
        pushed = forcing.subs(t, sigma + t) - force.subs({x: found, xdot: sympy.diff(found, t)}, simultaneous=True)
        pushed = cut(pushed, (sigma, t, v), order - 1).subs(t, time)
        slope = v + sympy.integrate(pushed, (time, 0, t))
        found = sympy.expand(clearance + sympy.integrate(sympy.expand(slope).subs(t, time), (time, 0, t)))
    return found


def velocities(force: Any, forcing: Any, clearance: Any, order: int) -> tuple[Any, Any]:
    """v_c and the impact velocity as polynomials in (sigma, t), to total degree `order`."""
    motion = flight(force, forcing, clearance, order)
    rest = sympy.expand(v - sympy.expand((motion - clearance) / t))
    launch = sympy.Integer(0)
    for degree in range(1, order + 1):
        launch = cut(rest.subs(v, launch), (sigma, t), degree)
    return launch, cut(sympy.diff(motion, t).subs(v, launch), (sigma, t), order)


def gamma(force: Any, forcing: Any, clearance: Any, lambda_: Any, order: int) -> Any:
    """gamma at a tangency to sigma^order: W(sigma + T) = -r U(sigma) solved for T, one power after the other."""
    launch, impact = velocities(force, forcing, clearance, order)
    r = lambda_**2 * (lambda_ + 2) / (2 * lambda_ + 1)
    time = (lambda_ - 1) * sigma
    for power in range(2, order):
        unknown = sympy.Symbol("unknown")
        trial = time + unknown * sigma**power
        after = sympy.expand(sigma + trial)
        later = cut(trial.subs(sigma, after), (sigma,), power)
        here, there = {t: trial}, {sigma: after, t: later}
        missing = cut(launch.subs(there, simultaneous=True) + r * impact.subs(here), (sigma,), power + 1)
        (value,) = sympy.solve(missing.coeff(sigma, power + 1), unknown)
        time += value * sigma**power
    return cut(launch.subs(t, time), (sigma,), order)
