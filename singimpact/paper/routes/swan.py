"""The paper's steps at a swan point (section 5): p, phi and h blown up, the functions f and g, m_*, the multipliers.

Symbols: s, m with (sigma, t) = (s, s m); mbar for the new m; ell = -a''/24; r.  What is cut is O(s).
"""

from typing import Any

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.paper.routes.equations import equation
from singimpact.paper.routes.implicit import X, Y, a_symbol, at_contact, p_c, phi_c, r, sigma, t

s, m, mbar, ell = sympy.symbols("s m mbar ell")
e = sympy.Symbol("e")  # a small step, in certificates


def _blown_up(images: tuple[sympy.Expr, sympy.Expr]) -> tuple[sympy.Expr, sympy.Expr]:
    """(first/s, second/(ell s^3)) of a map of (sigma, t) at a swan point, in (s, m)."""
    swan = [at_contact(part, 2) for part in images]
    first, second = (part.subs(a_symbol(2), -24 * ell).subs({sigma: s, t: s * m}) for part in swan)
    found = sympy.expand(sympy.cancel(first / s)), sympy.expand(sympy.cancel(second / (ell * s**3)))
    for part, unit, ratio in zip(swan, (s, ell * s**3), found, strict=True):
        substitution(At(part, {sigma: s, t: s * m, a_symbol(2): -24 * ell}), At(unit * X, {X: ratio}))
    return found


@equation("e:pdeg3")
def p_blown_up() -> tuple[sympy.Expr, sympy.Expr]:
    """p: (s, m) -> (s first, ell s^3 second) at s = 0, as (first, second) [e:pdeg3]."""
    return _blown_up(p_c(3))


@equation("s5-phi")
def phi_blown_up() -> tuple[sympy.Expr, sympy.Expr]:
    """phi: (s, m) -> (s first, ell s^3 second) at s = 0, as (first, second)."""
    return _blown_up(phi_c(3))


@equation("s5-hbar")
def h_bar() -> Any:
    """r (impact polynomial of m) - (new s/s)^3 (launch polynomial of mbar), zero where mbar is the image of m."""
    growth, impact = phi_blown_up()
    _, launch = p_blown_up()
    found = -r * impact - growth**3 * launch.subs(m, mbar)
    new = s * growth  # the launch velocity from there is to be -r times the impact velocity, all over ell s^3
    goes_on = At(-r * Y - ell * X**3 * launch.subs(m, mbar), {X: new, Y: ell * s**3 * impact})
    substitution(goes_on, At(ell * s**3 * X, {X: sympy.expand(found)}))
    return found


@equation("s5-f")
def f_map() -> Any:
    """f(m) = r (6m + 8m^2 + 3m^3)/(1 + m)^3: the new launch polynomial as a function of the old m."""
    growth, impact = phi_blown_up()
    found = sympy.factor(-r * impact) / sympy.factor(growth) ** 3
    substitution(At(X * Y**3, {X: found, Y: growth}), -r * impact)
    return found


@equation("s5-g")
def g_map() -> sympy.Expr:
    """g(m) = 6m + 4m^2 + m^3: the launch polynomial."""
    return p_blown_up()[1]


@equation("s5-fixed")
def fixed_point_polynomial() -> Any:
    """The polynomial in m, without the factor m of Pi_0, whose root in (-1, 0) is m_*."""
    found = sympy.expand(sympy.cancel(-h_bar().subs(mbar, m) / m))
    substitution(At(h_bar(), {mbar: m}), At(-m * X, {X: found}))
    return found


@equation("s5-r-of-m")
def r_of_m() -> Any:
    """r as a rational function of m_*: the fixed-point polynomial is linear in r."""
    poly = sympy.Poly(fixed_point_polynomial(), r)
    found = sympy.factor(-poly.nth(0) / poly.nth(1))
    substitution(At(poly.as_expr(), {r: found}), sympy.Integer(0))
    return found


@equation("s5-jacobian")
def Dh_bar() -> sympy.MatrixBase:
    """D h-bar(0, m) at the fixed point: lower triangular, since s = 0 is invariant; * depends on the O(s) terms.

    d(mbar)/dm is f'(m)/g'(mbar) by implicit differentiation of f(m) = g(mbar).  Its certificate is that the equation of
    h-bar holds at m + e and mbar = m + e d(mbar)/dm to first order in e, with r that of the fixed point.
    """
    growth, _ = phi_blown_up()
    first = [sympy.diff(s * growth, letter).subs(s, 0) for letter in (s, m)]
    step = At(s * growth, {s: e, m: m + Y * e})  # from (0, m) by e in s and by Y e in m
    substitution(step, first[0] * e + first[1] * Y * e, order=1, small=[e])
    slope = sympy.factor(sympy.cancel(sympy.diff(f_map(), m) / sympy.diff(g_map(), m)))
    moved = At(h_bar(), {m: m + e, mbar: m + slope.subs(r, r_of_m()) * e, r: r_of_m()})
    substitution(moved, sympy.Integer(0), order=1, small=[e])
    return sympy.Matrix([first, [sympy.Symbol("*"), slope]])


@equation("s5-mu")
def mu_of_m() -> Any:
    """d(mbar)/dm at the fixed point with r eliminated."""
    found = sympy.factor(sympy.cancel(Dh_bar()[1, 1].subs(r, r_of_m())))
    substitution(At(Dh_bar()[1, 1], {r: r_of_m()}), found)
    return found
