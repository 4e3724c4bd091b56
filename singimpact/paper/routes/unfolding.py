"""The unfolded swan in its universal form x'' = 12 kappa (s^2 - 1), c = 0: the curves of section 6 are algebraic.

Time is measured from the swan in half the distance of the two zeros A, B of a; kappa > 0 is a positive swan, < 0 a
negative one.  A flight from sigma lands after t; nothing is cut, the model has no higher terms.
"""

from __future__ import annotations

from typing import Any

import sympy

from singimpact.paper.routes.equations import equation

sigma, t, s, kappa, r = sympy.symbols("sigma t s kappa r")


@equation("s6-model")
def acceleration() -> Any:
    """a(sigma) = 12 kappa (sigma^2 - 1)."""
    return 12 * kappa * (sigma**2 - 1)


@equation("s6-model-at-c0")
def acceleration_at_swan() -> Any:
    """a(sigma) when A and B meet: with their half distance e for unit of length, 12 kappa (sigma^2 - e^2) at e = 0."""
    e = sympy.Symbol("e")
    return sympy.expand(e**2 * acceleration().subs(sigma, sigma / e)).subs(e, 0)


@equation("s6-launch")
def launch_velocity() -> Any:
    """v(sigma, t): the velocity with which a flight leaves sigma to be back after t, from x'' = a by two integrations.

    Examples
    --------
    >>> sympy.factor(launch_velocity())
    -kappa*t*(6*sigma**2 + 4*sigma*t + t**2 - 6)
    """
    poly = sympy.Poly(acceleration().subs(sigma, sigma + s), s)
    displaced = sum(value * s ** (n + 2) / ((n + 1) * (n + 2)) for (n,), value in poly.terms())
    return sympy.expand(sympy.cancel(-displaced.subs(s, t) / t))


@equation("s6-impact")
def impact_velocity() -> Any:
    """x-dot at the landing: the launch velocity after the involution."""
    return sympy.expand(launch_velocity().subs({sigma: sigma + t, t: -t}, simultaneous=True))


@equation("s6-horizon")
def horizon() -> Any:
    """The conic on which x-dot = 0 at the landing, t != 0: a polynomial in (sigma, t)."""
    return sympy.expand(sympy.cancel(impact_velocity() / (kappa * t)))


@equation("s6-zero-set")
def zero_set() -> Any:
    """The conic on which v = 0, t != 0."""
    return sympy.expand(sympy.cancel(-launch_velocity() / (kappa * t)))


def project(point: tuple[Any, Any]) -> tuple[Any, Any]:
    """p(sigma, t) = (sigma, v)."""
    return point[0], sympy.expand(launch_velocity().subs({sigma: point[0], t: point[1]}, simultaneous=True))


def reset(point: tuple[Any, Any]) -> tuple[Any, Any]:
    """phi(sigma, t) = (sigma + t, x-dot)."""
    at = {sigma: point[0], t: point[1]}
    return sympy.expand(point[0] + point[1]), sympy.expand(impact_velocity().subs(at, simultaneous=True))


A, B = (sympy.Integer(-1), sympy.Integer(0)), (sympy.Integer(1), sympy.Integer(0))
C, D = (sympy.Integer(-1), sympy.Integer(4)), (sympy.Integer(-3), sympy.Integer(4))
E = (-sympy.sqrt(3), 2 * sympy.sqrt(3))


def cusp_conditions(point: tuple[Any, Any]) -> tuple[Any, Any, Any, Any]:
    """(v_t, v_tt, v_ttt, v_sigma t) at a point: p has a cusp where the first two vanish and the others do not."""
    v = launch_velocity()
    at = {sigma: point[0], t: point[1]}
    parts = (sympy.diff(v, t), sympy.diff(v, t, 2), sympy.diff(v, t, 3), sympy.diff(v, sigma, t))
    first, second, third, mixed = (sympy.expand(part.subs(at, simultaneous=True)) for part in parts)
    return first, second, third, mixed


@equation("s6-shadow")
def shadow() -> Any:
    """t_1 of the next hit behind a graze (sigma, t_0): x - c has the roots 0, t_0, t_0, t_1, whose sum is known."""
    u = sympy.Symbol("u")
    quartic = sympy.Poly(sympy.expand(height(u)), u)
    total = -sympy.cancel(quartic.nth(3) / quartic.nth(4))  # of the roots 0, t_0, t_0, t_1
    return sympy.expand(total - 2 * t)


def height(u: Any) -> Any:
    """x - c at u of the flight (sigma, t)."""
    v = launch_velocity()
    poly = sympy.Poly(acceleration().subs(sigma, sigma + s), s)
    return v * u + sum(value * u ** (n + 2) / ((n + 1) * (n + 2)) for (n,), value in poly.terms())
