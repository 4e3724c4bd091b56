"""Contacts of every order: the border orbit from a zero of a_c to the next but one; at order three for every r.

The orbit is released at the first zero t_1.  With t_1 = 0 and the length of its hop for 1 it lands at 1; near the
limits t_1 = -1, t_2 = -b, t_3 = 0.
"""

import sympy

from singimpact.algebra.certificates import positive_in
from singimpact.algebra.derivations import At, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.verifiers import every, is_zero, root_of_line, same
from singimpact.paper.trials.universal_foot import elastic

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


def _every_order(stated: tuple[int, int]) -> Check:
    """(n, sign): 1 - dw/dL = w (n/T + p'/p), and the sign of dL/dt_1, for a_c = (t - t_1) p and a landing L.

    h is the height of the hop, k that of a flight from rest at t_1 under p; w = h'/a_c at L, and T = L - t_1.
    """
    power, sooner = stated
    k = sympy.Function("k")(t)
    speed, push, bend = sympy.symbols("speed push bend")  # of k; of p and its derivative
    lift, falling = sympy.Symbol("lift", positive=True), sympy.Symbol("falling", negative=True)  # k and h' at L
    rate = T * speed - lift
    earlier = rate / lift  # dt_1/dL
    changes = (T * push - speed * earlier) / (T * push) - rate * (push + T * bend - push * earlier) / (T * push) ** 2
    fading = sympy.exp(-m * x)
    left, integrand = 2 * x * (1 - x), m * (1 - x) ** 2 + 2 * (1 - x)
    below = sympy.expand((power + m) * (1 - x) ** power + left - integrand) == 0
    return every(
        [
            (
                "k > 0 at the landing, as (t_2 - s) p(s) > 0, and -k = dh/dt_1",
                sympy.sign(lift / falling) == sooner,
            ),
            (
                "h' = (t - t_1) k' - k, as both are 0 at t_1",
                same(sympy.diff((t - x) * sympy.diff(k, t) - k, t), (t - x) * sympy.diff(k, t, 2)),
            ),
            (
                "so w has the derivative that is stated",
                same(changes, 1 - rate / (T * push) * (power / T + bend / push)),
            ),
            (
                "with m = T p'/p the integral of (2 + m) (1 - x)^2 exp(-m x) over (0, 1) is below 1",
                below
                and is_zero(sympy.expand((sympy.diff(-((1 - x) ** 2) * fading, x) - integrand * fading) / fading))
                and positive_in(left, {x: (0, 1)}),
            ),
            (
                "which times T is more than w, as ln|p| is concave; so w rises with L",
                same(sympy.diff(1 / (t - x), t), -((t - x) ** -2)) and is_zero((1 - x) - x * (1 - x) - (1 - x) ** 2),
            ),
            (
                "1 + s/S falls and 1 - s/S rises with S = L - t_1: launches lengthen, landings quicken",
                same(sympy.diff(1 + s / S, S), -s / S**2) and same(sympy.diff(1 - s / S, S), s / S**2),
            ),
        ],
        "argued",
        witness=lambda: {"power": str(power), "sign": str(sooner)},
    )


def _one(stated: tuple[sympy.Expr, int]) -> Check:
    """(d of a landing at t_3; sign of the derivative by b of kappa): what is beside the theorem of every order."""
    last, falls = stated
    push = sympy.diff(HOP, s, 2)
    lands = is_zero(HOP.subs(LANDED).subs(s, 1)) and same(push, s * (s - d) * (s - D))
    if lands:
        substitution(At(HOP, {s: sympy.Integer(1), **LANDED}), sympy.Integer(0))
    kappa = sympy.cancel((P * sympy.diff(Q, b) - sympy.Rational(3, 2) * Q * sympy.diff(P, b)) * falls)
    return every(
        [
            ("the orbit from rest at t_1 lands at 1 if t_3 = (3 - 5 t_2)/(5 (1 - 2 t_2))", lands),
            (
                "its height vanishes again later alone",
                positive_in(sympy.cancel((5 * (d + D) / 3 - 2).subs(LANDED)), HOPS),
            ),
            (f"it lands at t_3 for t_2 = {last}", same(LANDED[D].subs(d, last), 1)),
            ("kappa changes with b by one sign", positive_in(kappa, {b: (0, 1)})),
        ],
        "argued",
        witness=lambda: {"t_3": str(LANDED[D].subs(d, last)), "sign": str(falls)},
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


def _elastic(stated: tuple[sympy.Expr, sympy.Expr, str]) -> Check:
    """(kappa^2, formula, C): kappa by the share e, the limit of e^(7/3)/(1 - r), and C of kappa - kappa(0) in e^2.

    Of the way from the middle of t_1 and t_2 to t_3 the part e is before t_2. u = v/|a_c|^(1/3) after the swan is that
    of the elastic ball there, (1 - h)^(2/3) h^(7/3) u/12^(2/3) with 2h = t_2 - t_1, e = h/(1 - h), as r -> 1.
    """
    square, formula, value = stated
    shares = {b: (1 - e) / (1 + e)}
    # of a flight of length T under the push 1 + s x + S x^2: launch and landing over T/2, and the push at its end
    launch, landing, end = 1 + s * T / 3 + S * T**2 / 6, 1 + 2 * s * T / 3 + S * T**2 / 2, 1 + s * T + S * T**2
    change = sympy.expand(landing**3 - launch**3 * end)
    whole = sympy.gammasimp(sympy.gamma(sympy.Rational(5, 3)) * sympy.gamma(sympy.Rational(7, 3)) / 6)
    rise = -sympy.diff(square, e, 2).subs(e, 0) / (4 * sympy.sqrt(square.subs(e, 0)))
    bounds = [rise * formula.subs(m, sympy.Rational(end)) ** sympy.Rational(6, 7) for end in elastic().invariant]
    printed = [f"{sympy.N(bound, 20):.{len(value) - 2}f}" for bound in bounds]
    return every(
        [
            ("u changes at the third order of a flight", all(change.coeff(T, n) == 0 for n in range(3))),
            (
                "and t |a_c|^(2/3) = 2u is the integral of |a_c|^(2/3) up to the second order",
                same(launch.coeff(T, 1), sympy.diff((1 + s * x) ** sympy.Rational(2, 3), x).subs(x, 0) / 2),
            ),
            (
                "where |a_c| falls launches are slower, landings faster than under one push, so each flight is longer "
                "than r times the last, and shorter than 1 - r of the way to t_3",
                positive_in(m * x * (1 - x), {x: (0, 1), m: (0, sympy.oo)}),
            ),
            (
                "so the changes of u vanish in all, and 2u/(1 - r) is the integral from t_2 to t_3",
                same(CUBIC.subs(b, 1), x * (x + 1) ** 2)
                and is_zero(12 ** sympy.Rational(2, 3) * whole / (2 * m) - formula),
            ),
            (f"kappa is the root of {square}, even in e", same((Q**2 / P**3).subs(shares), square)),
            (f"and {rise} times the 6/7-th power of that limit is {' to '.join(printed)}", {*printed} == {value}),
        ],
        "argued",
        witness=lambda: {"value": str(printed), "stated": value},
    )


def _events(stated: tuple[int, int, sympy.Expr]) -> Check:
    """(a, b, kappa): the flight from a zero of a_c that grazes is C (s - a)^3 (s - b)^2, where q is kappa |p|^(3/2).

    A flight has degree five, and no term of degree four as a_c has none of degree two.
    """
    rest, graze, value = stated
    height = sympy.Poly((s - rest) ** 3 * (s - graze) ** 2, s)
    push = height.diff((s, 2))
    p, q = (push.coeff_monomial(s**n) / push.LC() for n in (1, 0))
    mirrored = sympy.diff((s + rest) ** 3 * (s + graze) ** 2, s, 2).subs(s, -graze)
    least = {"three rests": 2 + 2 + 2, "two rests at zeros of a_c": 3 + 3}
    return every(
        [
            (
                "a triple and a double zero have the sum 0",
                3 * rest + 2 * graze == 0 and height.coeff_monomial(s**4) == 0,
            ),
            ("the flight is above the wall", positive_in(height.as_expr(), {s: (rest, graze)}) and rest < graze),
            (f"and q = {value} |p|^(3/2) there", p < 0 and is_zero(q / (-p) ** sympy.Rational(3, 2) - value)),
            ("its mirror image starts where a_c < 0", mirrored < 0),
            (f"other events of the outline need {least} zeros of a flight", min(least.values()) > height.degree()),
        ],
        "argued",
        witness=lambda: {"q/|p|^(3/2)": str(q / (-p) ** sympy.Rational(3, 2)), "stated": str(value)},
    )


ROOTS = tuple(map(sympy.sqrt, (19, 38, 57)))
USED = 4 * sympy.pi * 12 ** sympy.Rational(2, 3) / (81 * sympy.sqrt(3) * m)  # m is u of the universal swan
SHARED = sympy.Rational(4, 27) * (1 - 9 * e**2) ** 2 / (1 + 3 * e**2) ** 3
RESTED = (-56 * ROOTS[2] / 3249, -225 * ROOTS[0] / 13718, -2625 * ROOTS[2] / 260642 - 225 * ROOTS[1] / 109744)
CLAIMS = {
    "b:border-order": Encoding((2, -1), _every_order, ((1, -1), (3, -1), (2, 1))),
    "b:three-one": Encoding((sympy.Rational(2, 5), -1), _one, ((sympy.Rational(3, 7), -1), (sympy.Rational(2, 5), 1))),
    "b:three-rest": Encoding(
        RESTED,
        _without_rebound,
        ((RESTED[0], -RESTED[1], RESTED[2]), (RESTED[0], RESTED[1], RESTED[2] + sympy.Rational(1, 10**9))),
    ),
    "b:three-events": Encoding(
        (-2, 3, -2 * sympy.sqrt(2) / 27),
        _events,
        ((-2, 3, 2 * sympy.sqrt(2) / 27), (-2, 3, -sympy.sqrt(2) / 27), (2, -3, -2 * sympy.sqrt(2) / 27)),
    ),
    "b:three-elastic": Encoding(
        (SHARED, USED, "0.2844281"),
        _elastic,
        ((4 * SHARED, USED, "0.2844281"), (SHARED, 2 * USED, "0.2844281"), (SHARED, USED, "0.2844282")),
    ),
}
