"""Exact facts about the derivatives of a flight by its launch, for any f and g: the group law, and the Wronskian.

Along the flight x(tau, v; t), from x = c with velocity v at the time tau, let u = x-dot and E = x-ddot; P, b and q are
the derivatives of x by tau, by v and by the height of the launch, P1, b1 and q1 their derivatives by t.  With f_x, f_u
and g' taken on the flight, they change at the rates `RATES`; a rate is formed by the chain rule, and is left as a
certificate: the polynomial with each letter moved by e times its rate, to first order in e.
"""

from typing import Any

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.inputs import need
from singimpact.paper.routes.equations import equation

u, E, P, P1, b, b1, q, q1 = sympy.symbols("xdot E P P1 b b1 q q1")
f_x, f_u, dg, v, A, e = sympy.symbols("f_x f_u dg v A e")
RATES = {
    u: E,
    E: dg - f_x * u - f_u * E,
    P: P1,
    P1: dg - f_x * P - f_u * P1,
    b: b1,
    b1: -f_x * b - f_u * b1,
    q: q1,
    q1: -f_x * q - f_u * q1,
}
# At the launch: E is the acceleration A there, and x = c, x-dot = v at t = 0 whatever tau is.
START = {u: v, E: A, P: 0, P1: 0, b: 0, b1: 1, q: 1, q1: 0}


def rate_of(expression: sympy.Expr) -> Any:
    """The derivative by t of a polynomial in the letters, expanded; its certificate is left."""
    if expression in RATES:
        return RATES[expression]
    found = sympy.expand(sum(sympy.diff(expression, letter) * rate for letter, rate in RATES.items()))
    moved = {letter: letter + e * rate for letter, rate in RATES.items()}
    substitution(At(expression, moved), expression + e * found, order=1, small=[e])
    return found


@equation("s2-group-law")
def by_launch_time() -> Any:
    """dx/dtau = x-dot - v q - A b, since waiting moves the launch along the flight backwards.

    The difference of the two sides solves the linear homogeneous equation and vanishes with its rate at t = 0.

    Raises
    ------
    ArithmeticError : it does not.
    """
    difference = P - (u - v * q - A * b)
    change = rate_of(difference)
    if sympy.expand(rate_of(change) + f_x * difference + f_u * change) != 0:
        raise ArithmeticError("the difference does not solve the homogeneous equation")
    if any(sympy.expand(term.subs(START)) != 0 for term in (difference, change)):
        raise ArithmeticError("the difference does not vanish at the launch")
    return u - v * q - A * b


@equation("s2-wronskian")
def wronskian() -> Any:
    """W = q b1 - q1 b: W' = -f_u W and W = 1 at the launch, so W is positive all along the flight.

    Raises
    ------
    ArithmeticError : it is not so.
    """
    determinant = q * b1 - q1 * b
    if sympy.expand(rate_of(determinant) + f_u * determinant) != 0 or determinant.subs(START) != 1:
        raise ArithmeticError("the Wronskian does not decay at the rate f_u")
    return determinant


# iota reads a flight backwards: launch and landing exchange their velocities, t becomes -t.  phi = p o iota.
INVOLUTION = {v: u, u: v}


@equation("s2-singular-p")
def singular_p() -> tuple[sympy.Expr, sympy.Expr]:
    """Where p is singular on V_c': the polynomial that vanishes there off t = 0, and the one on t = 0.

    V_c' is y = 0, x = c + t y, and p forgets t: it is singular where dy/dt = 0.  There x-dot = y + t dy/dt = t dy/dt.
    On t = 0 dy/dt is half the acceleration.
    """
    y, y_t, t = sympy.symbols("y y_t t")
    velocity = y + t * y_t
    substitution(At(velocity, {y: sympy.Integer(0)}), t * y_t)
    need(sympy.cancel(velocity.subs(y, 0) / t) == y_t, ArithmeticError("x-dot is not t dy/dt where y = 0"))
    from singimpact.paper.routes import implicit

    slope = sympy.diff(implicit.y_c(2), implicit.t).subs({implicit.t: 0, implicit.v: 0, implicit.sigma: 0})
    return u, sympy.expand(slope)


@equation("s2-singular-phi")
def singular_phi() -> tuple[sympy.Expr, sympy.Expr]:
    """Where phi is singular: the image of `singular_p` under iota, which leaves every point of t = 0 where it is."""
    off, on = singular_p()
    return off.subs(INVOLUTION, simultaneous=True), on


@equation("s2-second-derivative")
def second_derivative() -> Any:
    """The second derivative along the kernel of p where x-dot = 0, times dx/dv: minus the acceleration at the landing.

    In a chart v = V(t) of V_c', dx/dv != 0, and in a chart tau = T(t), dx/dtau != 0: with V = k e^2/2 the height
    changes by (b k + E) e^2/2, so b k = -E, and likewise with P.
    """
    k, s, w, x_ww, x_ws = sympy.symbols("k s w x_ww x_ws")
    for by in (b, P):
        height = by * w + E * s**2 / 2 + x_ws * w * s + x_ww * w**2 / 2
        substitution(At(height, {w: k * e**2 / 2, s: e}), (by * k + E) * e**2 / 2, order=2, small=[e])
        if sympy.Poly(sympy.expand(height.subs({w: k * e**2 / 2, s: e})), e).coeff_monomial(e**2) * 2 != by * k + E:
            raise ArithmeticError("the second derivative is not -E")
    return -E


@equation("s2-third-derivative")
def cusp_derivatives() -> tuple[sympy.Expr, sympy.Expr]:
    """At x-dot = E = 0: minus the third derivative of x, and b^2 times the mixed derivative of the launch velocity.

    d^2 v/dtau dt = -(b P1 - b1 P)/b^2 by implicit differentiation of x = c; the group law makes it v times W.
    """
    still = {u: 0, E: 0}
    jerk = rate_of(E).subs(still)
    law = by_launch_time()
    mixed = sympy.expand((b1 * law - b * rate_of(law)).subs(still))
    substitution(At(b1 * P - b * P1, {P: law.subs(still), P1: rate_of(law).subs(still)}), -v * wronskian())
    need(sympy.expand(mixed + v * wronskian()) == 0, ArithmeticError("the mixed derivative is not v W"))
    return -jerk, mixed
