"""Contact order three, a_c = t^3 + p t + q: the border orbit from the first zero of a_c to the third, for every r.

The orbit is released at the first zero t_1.  With t_1 = 0 and the length of its hop for 1 it lands at 1; near the
limits t_1 = -1, t_2 = -b, t_3 = 0.
"""

import sympy

from singimpact.algebra.certificates import positive_in
from singimpact.algebra.derivations import At, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.verifiers import every, is_zero, root_of_line, same

s, d, D, m, t, x, b, e, S, T = sympy.symbols("s d D m t x b e S T", positive=True)
HOP = s**3 / 60 * (3 * s**2 - 5 * (d + D) * s + 10 * d * D)  # d and D are t_2 and t_3
LANDED = {D: (3 - 5 * d) / (5 * (1 - 2 * d))}  # of a hop of length 1
HOPS = {d: (sympy.Rational(2, 5), sympy.Rational(1, 2))}  # from a landing at t_3 to the swan in which t_1 and t_2 meet
CUBIC = x * (x + 1) * (x + b)
P, Q = (1 + b) ** 2 / 3 - b, CUBIC.subs(x, -(1 + b) / 3)  # kappa = Q/P^(3/2)


def _launch(height: sympy.Expr, start: sympy.Expr, length: sympy.Expr) -> sympy.Expr:
    """The velocity with which a flight of a length starts, from any motion under the same push."""
    rise = height.subs(x, start + length) - height.subs(x, start)
    velocity: sympy.Expr = sympy.diff(height, x).subs(x, start) - rise / length
    return velocity


def _one(stated: tuple[sympy.Expr, int, int]) -> Check:
    """(d of a landing at t_3; signs of the derivatives by d of r, for one second flight, and by b of kappa).

    T is the length of the second flight; its unit is t_3 - t_2, and so is that of the other two that are shown to be
    monotone: the distance of the landing from t_3, and that of t_1.
    """
    last, nearer, falls = stated
    push = sympy.diff(HOP, s, 2)
    lands = is_zero(HOP.subs(LANDED).subs(s, 1)) and same(push, s * (s - d) * (s - D))
    if lands:
        substitution(At(HOP, {s: sympy.Integer(1), **LANDED}), sympy.Integer(0))
    width = (D - d).subs(LANDED)
    rate = sympy.factor(
        _launch(HOP.subs(s, x), sympy.Integer(1), t).subs(LANDED) / -sympy.diff(HOP, s).subs(LANDED).subs(s, 1)
    )
    slope = sympy.diff(rate.subs(t, T * width), d).subs(T, m * (LANDED[D] - 1) / width)
    bend = sympy.diff(sympy.diff(CUBIC, x) / CUBIC, x)
    kappa = sympy.cancel((P * sympy.diff(Q, b) - sympy.Rational(3, 2) * Q * sympy.diff(P, b)) * falls)
    return every(
        [
            ("the orbit from rest at t_1 lands at 1 if t_3 = (3 - 5 t_2)/(5 (1 - 2 t_2))", lands),
            (
                "its height vanishes again later alone",
                positive_in(sympy.cancel((5 * (d + D) / 3 - 2).subs(LANDED)), HOPS),
            ),
            (f"it lands at t_3 for t_2 = {last}", same(LANDED[D].subs(d, last), 1)),
            (
                "in units of t_3 - t_2 the hop ends the earlier the nearer t_1 is",
                positive_in(sympy.cancel(sympy.diff(((D - 1) / (D - d)).subs(LANDED), d)), HOPS)
                and positive_in(-sympy.cancel(sympy.diff((D / (D - d)).subs(LANDED), d)), HOPS),
            ),
            (
                "and the r for which the second flight has one length changes by one sign",
                positive_in(sympy.cancel(slope) * nearer, {**HOPS, m: (0, 1)}),
            ),
            ("ln|a_c| is concave between t_2 and t_3", same(bend, -sum((x + root) ** -2 for root in (0, 1, b)))),
            (
                "a_c of two places d < D of t_1 before t_2 has a quotient (x + d)/(x + D) that rises",
                same(sympy.diff((x + d) / (x + D), x), (D - d) / (x + D) ** 2),
            ),
            ("kappa changes with b by one sign", positive_in(kappa, {b: (0, 1)})),
        ],
        "argued",
        witness=lambda: {"t_3": str(LANDED[D].subs(d, last)), "signs": str((nearer, falls))},
    )


def _without_rebound(stated: tuple[sympy.Expr, ...]) -> Check:
    """The coefficients of kappa in powers of e = sqrt(r), from a landing at the distance S before t_3."""
    b1, S1, b2, S2 = sympy.symbols("b1 S1 b2 S2")
    near = {b: sympy.Rational(3, 5) + b1 * e + b2 * e**2, S: S1 * e + S2 * e**2}
    height = HOP.subs({d: 1 - b, D: 1}, simultaneous=True).subs(s, 1 + x)
    slow = sympy.cancel(_launch(x**3 / 6, -S, m * S) / S**2)
    fast = m - m**2 / 2 - slow  # of the landing of that flight
    # on gamma the next flight ends a part 1 - m of S before t_3, and (1 - m)^2 tends to r times a quotient of speeds
    share = 1 - e * sympy.sqrt((fast / slow).subs(m, 1))
    launch = sympy.expand(sympy.cancel(_launch(height, -S, m * S))).subs(m, share)
    sides = sympy.cancel(height / (1 + x) ** 3), -(e**2) * sympy.diff(height, x) - launch
    landing, speed = (sympy.Poly(sympy.expand(side.subs(x, -S).subs(near, simultaneous=True)), e) for side in sides)
    values = {S1: sympy.sqrt(root_of_line(speed.coeff_monomial(e**2).subs(S1, sympy.sqrt(t)), t))}
    for name, equation, power in ((b1, landing, 1), (S2, speed, 3), (b2, landing, 2)):
        values[name] = root_of_line(sympy.expand(equation.coeff_monomial(e**power).subs(values)), name)
    slopes = [sympy.diff(Q / P ** sympy.Rational(3, 2), b, k).subs(b, near[b].subs(e, 0)) for k in range(3)]
    series = slopes[0], slopes[1] * values[b1], slopes[1] * values[b2] + slopes[2] * values[b1] ** 2 / 2
    coefficients = [sympy.expand(sympy.radsimp(coefficient)) for coefficient in series]
    return every(
        [
            (
                f"on gamma a flight from S ends a part m = {share} + O(e^2) of the way to t_3",
                same((1 - share) ** 2 * slow.subs(m, 1), e**2 * fast.subs(m, 1)),
            ),
            (
                f"so the hop lands at S = {near[S].subs(values)} + O(e^3)",
                all(
                    sympy.expand(equation.coeff_monomial(e**power).subs(values)) == 0
                    for equation, power in ((landing, 1), (landing, 2), (speed, 2), (speed, 3))
                ),
            ),
            (f"and kappa has the coefficients {coefficients}", coefficients == list(map(sympy.expand, stated))),
        ],
        "argued",
        witness=lambda: {"coefficients": str(coefficients), "stated": str(stated)},
    )


ROOTS = tuple(map(sympy.sqrt, (19, 38, 57)))
RESTED = (-56 * ROOTS[2] / 3249, -225 * ROOTS[0] / 13718, -2625 * ROOTS[2] / 260642 - 225 * ROOTS[1] / 109744)
CLAIMS = {
    "b:three-one": Encoding(
        (sympy.Rational(2, 5), 1, -1),
        _one,
        ((sympy.Rational(3, 7), 1, -1), (sympy.Rational(2, 5), -1, -1), (sympy.Rational(2, 5), 1, 1)),
    ),
    "b:three-rest": Encoding(
        RESTED,
        _without_rebound,
        ((RESTED[0], -RESTED[1], RESTED[2]), (RESTED[0], RESTED[1], RESTED[2] + sympy.Rational(1, 10**9))),
    ),
}
