"""The paper's steps at a tangency point (section 4): fold coordinate, psi, Q_r, h, blow-up, fixed points, multipliers.

Every step is made from the one before it; nothing is transcribed.  Symbols: sigma, eta, s, m; k = a'/6; r.
The leading parts are exact polynomials; what is cut is O(3) before the blow-up and O(s) after it.
"""

from typing import Any

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.inputs import need
from singimpact.paper.routes.equations import equation
from singimpact.paper.routes.implicit import X, Y, a_symbol, at_contact, p_c, phi_c, r, sigma, t

eta, s, m, k = sympy.symbols("eta s m k")
_left = sympy.Symbol("s", negative=True)  # the visible part lies in s < 0
e, w = sympy.symbols("e w")  # in certificates: a small step, and the square root of Q_r


def in_k(expression: sympy.Expr) -> Any:
    """An expression in a' rewritten with k = a'/6."""
    found = sympy.expand(expression.subs(a_symbol(1), 6 * k))
    if found != expression:
        substitution(At(expression, {a_symbol(1): 6 * k}), found)
    return found


@equation("e:pnew")
def p() -> tuple[sympy.Expr, sympy.Expr]:
    """p at a tangency point, to second order in (sigma, t) [e:pnew]."""
    first, second = p_c(2)
    return first, in_k(at_contact(second, 1))  # the first component, sigma + t, has no coefficient of a_c


@equation("e:phinew")
def phi() -> tuple[sympy.Expr, sympy.Expr]:
    """phi at a tangency point, to second order in (sigma, t) [e:phinew]."""
    first, second = phi_c(2)
    found = first, in_k(at_contact(second, 1))
    substitution(At(p()[1], {sigma: sigma + t, t: -t}), found[1])
    return found


@equation("s4-horizon-line")
def horizon() -> tuple[sympy.Expr, sympy.Expr]:
    """(t on the horizon as a function of sigma, v on its image): dv_c/dt = 0 to first order, then p."""
    _, velocity = p()
    slope = sympy.Poly(sympy.diff(velocity, t), t)
    line = sympy.cancel(-slope.nth(0) / slope.nth(1))
    image = sympy.expand(velocity.subs(t, line))
    substitution(At(velocity, {t: line + e}), image, order=1, small=[e])  # no linear term: dv_c/dt = 0
    return line, image


@equation("s4-fold-eta")
def fold_coordinate() -> Any:
    """eta: the distance in t from the horizon, which completes the square in v_c."""
    line, _ = horizon()
    return t - line


def in_fold_coordinates(expression: sympy.Expr) -> Any:
    """An expression in (sigma, t) rewritten in (sigma, eta)."""
    return sympy.expand(expression.subs(t, t + eta - fold_coordinate()))


@equation("s4-fold-p")
def p_folded() -> tuple[sympy.Expr, sympy.Expr]:
    """p in the coordinates (sigma, eta)."""
    first, second = p()
    folded = in_fold_coordinates(second)
    substitution(At(folded, {eta: fold_coordinate()}), second)
    return first, folded


@equation("s4-psi")
def psi(u: sympy.Expr, w: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """psi(u, w): takes the image of the horizon, w = (9/4) k u^2, to w = 0."""
    _, outline = horizon()
    return u, sympy.expand(w - outline.subs(sigma, u))


def _outline_off(u: sympy.Expr, velocity: sympy.Expr) -> sympy.Expr:
    """The second component of psi."""
    return psi(u, velocity)[1]


@equation("e:pdef")
def psi_p() -> tuple[sympy.Expr, sympy.Expr]:
    """psi o p in (sigma, eta), to second order: the fold form [e:pdef]."""
    folded = psi(*p_folded())
    substitution(At(_outline_off(X, Y), {X: sigma, Y: p_folded()[1]}), folded[1])
    return folded


@equation("e:defq")
def psi_q() -> tuple[sympy.Expr, sympy.Expr]:
    """psi o q with q = R o phi, in (sigma, eta), to second order [e:defq]."""
    first, second = phi()
    found = psi(in_fold_coordinates(first), in_fold_coordinates(-r * second))
    at_eta = {eta: fold_coordinate()}
    substitution(At(found[0], at_eta), first)
    substitution(At(found[1], at_eta), At(_outline_off(X, -r * Y), {X: first, Y: second}))
    return found


@equation("e:qdef")
def Q_r() -> Any:
    """Q_r(sigma, eta): the square of the new eta, from psi o p(new) = psi o q(old) [e:qdef]."""
    _, folded = psi_p()
    square = sympy.cancel(folded / eta**2)  # psi o p = (sigma, square * eta^2)
    found = sympy.expand(sympy.cancel(psi_q()[1] / square))
    substitution(At(folded, {eta: w}), psi_q()[1], where=(w**2 - found, w))
    return found


@equation("e:hdef")
def h() -> tuple[sympy.Expr, sympy.Expr]:
    """h = p^{-1} o q in (sigma, eta) on the visible part, to leading order [e:hdef].

    A first hit comes before the horizon, and t grows with eta, so the new eta is the negative root.
    """
    substitution(At(psi_p()[1], {eta: -w}), psi_q()[1], where=(w**2 - Q_r(), w))
    return psi_q()[0], -sympy.sqrt(Q_r())


@equation("s4-blowup")
def h_blown_up() -> tuple[sympy.Expr, sympy.Expr]:
    """h' in (s, m), (sigma, eta) = (s, s m), at s = 0: (s'/s, m') on the visible part s < 0, m > 1/2."""
    first, second = h()
    rate = sympy.cancel(first.subs({sigma: s, eta: s * m}) / s)
    sign = sympy.cancel(second / sympy.sqrt(Q_r()))
    image = sign * sympy.sqrt(_left**2) / _left * sympy.sqrt(Q_at_one()) / rate  # Q_r(s, s m) = s^2 Q_r(1, m)
    rays = {sigma: s, eta: s * m}
    substitution(At(first, rays), At(s * X, {X: rate}))
    on_ray = At(s**2 * X**2 * Y**2, {X: rate, Y: in_root(image)})  # (s' m')^2 is the square of the new eta
    substitution(on_ray, At(Q_r(), rays), where=(w**2 - Q_at_one(), w))
    return rate, image


def in_root(expression: sympy.Expr) -> Any:
    """An expression with w for the root of Q_r(1, m)."""
    root = sympy.sqrt(Q_at_one())
    return sympy.together(expression.subs({root: w, 1 / root: 1 / w}))


@equation("s4-Q1m")
def Q_at_one() -> Any:
    """Q_r(1, m), by homogeneity Q_r(s, s m)/s^2."""
    found = sympy.expand(sympy.cancel(Q_r().subs({sigma: s, eta: s * m}) / s**2))
    substitution(At(Q_r(), {sigma: s, eta: s * m}), At(s**2 * X, {X: found}))
    return found


@equation("e:fixm")
def fixed_point_equation() -> Any:
    """The polynomial Q_r(1, m) - m^2 (m - 1/2)^2, zero at the fixed points of h' [e:fixm]."""
    rate, image = h_blown_up()
    found = sympy.expand(Q_at_one() - m**2 * rate**2)
    fixed = At(X**2 * (Y**2 - m**2), {X: rate, Y: in_root(image)})  # zero where m' = m
    substitution(fixed, found, where=(w**2 - Q_at_one(), w))
    return found


@equation("e:meq")
def fixed_point_factors() -> tuple[sympy.Expr, sympy.Expr]:
    """(m - 3/2 and the cubic) whose product is the fixed-point polynomial [e:meq].

    The cubic is (m - 1/2)^2 (m + 3/2) - 2 r m.
    """
    trivial = m - sympy.Rational(3, 2)  # Pi_0 itself: t = 0 is eta = 3 sigma/2
    quotient, rest = sympy.div(sympy.Poly(fixed_point_equation(), m), sympy.Poly(trivial, m))
    need(rest.is_zero, ArithmeticError("the tau-axis is not a fixed ray of h'"))
    cubic = sympy.expand(-quotient.as_expr())
    substitution(At(-X * Y, {X: trivial, Y: cubic}), fixed_point_equation())
    return trivial, cubic


@equation("s4-r-of-m")
def r_of_m() -> Any:
    """r as a rational function of a root m of the cubic, which is linear in r."""
    cubic = sympy.Poly(fixed_point_factors()[1], r)
    found = sympy.factor(-cubic.nth(0) / cubic.nth(1))
    substitution(At(cubic.as_expr(), {r: found}), sympy.Integer(0))
    return found


@equation("s4-Nr-1")
def N_r() -> Any:
    """N_r(m) = dm'/dm at s = 0, by differentiating h'; Q stands for Q_r(1, m)."""
    found = sympy.diff(h_blown_up()[1], m)
    _is_slope(found)
    return found


def _is_slope(slope: sympy.Expr) -> None:
    """Leave the certificate that dm'/dm is `slope`: ((m' + slope e) s'/s)^2 = Q_r(1, m + e) to first order in e."""
    rate, image = h_blown_up()
    moved = At((Y + X * e) ** 2 * rate.subs(m, m + e) ** 2, {Y: in_root(image), X: in_root(slope)})
    substitution(moved, At(Q_at_one(), {m: m + e}), order=1, small=[e], where=(w**2 - Q_at_one(), w))


@equation("s4-Nr-2")
def N_r_collected() -> Any:
    """N_r(m) over one denominator: a rational function times Q^(-1/2)."""
    root = sympy.sqrt(Q_at_one())
    found = sympy.factor(sympy.cancel(sympy.expand(N_r() * root))) / root
    _is_slope(found)
    return found


@equation("s4-Nr-3")
def N_r_at_fixed_points() -> Any:
    """N_r(m) at a root of the cubic with m (m - 1/2) > 0: r eliminated, and Q^(1/2) = m (m - 1/2)."""
    rate, _ = h_blown_up()
    rational = sympy.cancel(N_r_collected() * sympy.sqrt(Q_at_one())) / (m * rate)
    found = sympy.factor(sympy.cancel(rational.subs(r, r_of_m())))
    moved = At((m + X * e) ** 2 * rate.subs(m, m + e) ** 2, {X: found})
    substitution(moved, At(Q_at_one(), {m: m + e, r: r_of_m()}), order=1, small=[e])
    return found


@equation("s4-Dh-form")
def Dh_blown_up() -> sympy.MatrixBase:
    """Dh'(0, m): lower triangular, since s = 0 is invariant; the entry * depends on the O(3) terms."""
    new = sympy.expand(psi_q()[0].subs({sigma: s, eta: s * m}))  # s'
    first = [sympy.diff(new, letter).subs(s, 0) for letter in (s, m)]
    step = At(psi_q()[0], {sigma: e, eta: e * (m + Y * e)})  # from (0, m) by e in s and by Y e in m
    substitution(step, first[0] * e + first[1] * Y * e, order=1, small=[e])
    return sympy.Matrix([first, [sympy.Symbol("*"), N_r_collected()]])


@equation("s4-gamma-leading")
def gamma_leading() -> Any:
    """The factor of sigma^2 in v along the ray eta = m sigma: p(sigma, m sigma)/sigma^2."""
    found = sympy.factor(sympy.cancel(p_folded()[1].subs(eta, m * sigma) / sigma**2))
    substitution(At(p_folded()[1], {eta: m * sigma}), At(sigma**2 * X, {X: found}))
    return found
