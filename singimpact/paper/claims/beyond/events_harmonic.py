"""Events of a swan: P and Pi_0 as the preimage of one curve of flights, and the events of that curve over c; for
x'' + x = cos(omega t) all flights with two rests, in closed form, and the first one that is seen.

Two rests stand at m - h and m + h.  With kappa = 1/(1 - omega^2) the flight is kappa cos(omega t) + P cos(t - m)
+ Q sin(t - m).  Letters: Cm, Sm for cosine and sine of omega m, Cw, Sw of omega h, Ch, Sh of h.

R(t; s) is the flight at rest at the wall at s, Y(t, s) its variation with Y = 0, Y' = 1 at s, a the acceleration at the
wall.  psi takes a launch (tau, v) to its flight, told by (x, x') at one time.
"""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import sympy

from singimpact.algebra import At, Balls, balls_at, parse, positive_on, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.verifiers import every, identity

kappa, omega, P, Q, g, u, y = sympy.symbols("kappa omega P Q g u y")
Cm, Sm, Cw, Sw, Ch, Sh = sympy.symbols("Cm Sm Cw Sw Ch Sh")
K, p_, q_, r_ = sympy.symbols("K p q r")
UNIT = Sh**2 + Ch**2 - 1, Sh
PHI = kappa * (Cw - omega * Sw * Ch / Sh)  # c of the symmetric flights with cos(omega m) = 1
REAL = 1 / (1 - omega**2)
B = Sw * Ch - omega * Cw * Sh


def _at_rests() -> dict[str, Any]:
    found = {}
    for sign in (1, -1):
        cosine, sine = Cm * Cw - sign * Sm * Sw, Sm * Cw + sign * Cm * Sw  # of omega (m + sign h)
        found[f"x{sign}"] = kappa * cosine + P * Ch + sign * Q * Sh
        found[f"v{sign}"] = -kappa * omega * sine - sign * P * Sh + Q * Ch
        found[f"a{sign}"] = cosine
    return found


def _two_families(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """(c where Sm = 0, c where B = 0, a(s_1) + a(s_2) there)."""
    symmetric, skew, total = stated
    at = _at_rests()
    even, odd = (at["x1"] + at["x-1"]) / 2, (at["x1"] - at["x-1"]) / 2
    turn, slip = (at["v1"] + at["v-1"]) / 2, (at["v1"] - at["v-1"]) / 2
    either = composed(p_ * Ch - q_ * Sh, {p_: odd, q_: turn}, -kappa * Sm * B)
    one = {Sm: sympy.Integer(0), Cm: g, Q: sympy.Integer(0), P: -kappa * omega * g * Sw / Sh}
    ends = all(sympy.cancel(factor.subs(one, simultaneous=True)) == 0 for factor in (odd, turn, slip))
    first = composed(even, one, symmetric)
    tangent = {Sw: omega * Cw * Sh / Ch}  # B = 0, Ch != 0: where Ch = 0 it asks for Cw = 0, and the flight is symmetric
    other = {**tangent, P: -kappa * omega**2 * Cm * Cw / Ch, Q: kappa * omega * Sm * Cw / Ch}
    rests = all(sympy.cancel(factor.subs(other, simultaneous=True)) == 0 for factor in (odd, turn, slip))
    real = {name: sympy.sympify(image).subs(kappa, REAL) for name, image in other.items()}
    second = composed(even, real | {kappa: REAL}, skew)
    return every(
        [
            ("from x and x' at both rests: Sm (Sw Ch - omega Cw Sh) = 0", either),
            ("Sm = 0: the flight is symmetric about m, its rests exist for every h with Sh != 0", ends and first),
            ("Sw Ch = omega Cw Sh: a flight for every m, its c", rests and second),
            (
                "there the accelerations at the two rests are opposite, so that one of them is not reached upwards",
                composed(p_ + q_ - 2 * r_, {p_: at["a1"], q_: at["a-1"], r_: skew}, total),
            ),
            ("Sh = 0 asks for Sw = 0: the rests are a period of the flight apart", _with_sine_zero()),
        ]
    )


def _with_sine_zero() -> bool:
    """Where Sh = 0, Ch = +-1: odd and even parts of x and x' leave Sw (Cm, Sm) = 0."""
    at = _at_rests()
    flat = {Sh: sympy.Integer(0)}
    odd = sympy.expand(((at["x1"] - at["x-1"]) / 2).subs(flat))
    slip = sympy.expand(((at["v1"] - at["v-1"]) / 2).subs(flat))
    return bool(odd == -kappa * Sm * Sw and slip == -kappa * omega * Cm * Sw)


def _exactly_two(stated: tuple[Any, Any, Any, dict[int, Any]]) -> Check:
    """omega = 2: (c over u = cos h, factor of (cos(t - m) - u)^2 in x - c, a at the rests, {g: c of the event})."""
    clearance, factor, push, values = stated
    two = {omega: sympy.Integer(2), kappa: sympy.Rational(-1, 3), Cw: 2 * u**2 - 1, Sw: 2 * Sh * u, Ch: u}
    c_ = composed(g * PHI, two, clearance)
    amplitude = sympy.cancel((-kappa * omega * g * Sw / Sh).subs(two, simultaneous=True))
    flight = -g * (2 * y**2 - 1) / 3 + amplitude * y
    square = composed(p_ - q_, {p_: flight, q_: clearance}, factor * (y - u) ** 2)
    pushed = composed(p_ - q_, {p_: g * (2 * u**2 - 1), q_: clearance}, push)
    skew = composed(B, two, 2 * Sh * (1 - u**2))
    slope = sympy.factor(sympy.diff(clearance, u))
    critical = list(sympy.roots(sympy.Poly(slope, u)))
    clearances = {sign: clearance.subs({u: 0, g: sign}) for sign in (1, -1)}
    upwards = [sign for sign in (1, -1) if positive_on(push.subs(g, sign), u, -1, 1)]
    return every(
        [
            ("symmetric flights: c as stated", c_),
            ("no skew ones but with sin h = 0", skew),
            ("x - c is a square in cos(t - m): two rests a turn, so no triple point", square),
            ("a at the rests vanishes for sin h = 0 alone: no tangency", pushed and positive_on(-push / g, u, -1, 1)),
            (f"dc/du = {slope} vanishes at u in {critical}: rests pi = T apart, once a period", critical == [0]),
            (
                f"there c = {clearances}; upwards and x >= c for g in {upwards} alone",
                clearances == values and upwards == [-1],
            ),
        ]
    )


def _critical_values(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """(dc/dh over a, c at Ch = 0, c at a = 0) of the symmetric flights, over g."""
    ratio, tacnode, tangency = stated
    push = Cw - PHI  # a/g
    rates = {Cw: -omega * Sw, Sw: omega * Cw, Ch: -Sh, Sh: Ch}
    slope = sum(sympy.diff(PHI, name) * rate for name, rate in rates.items())
    turned = composed(p_, {p_: slope.subs(kappa, REAL)}, push.subs(kappa, REAL) * ratio, UNIT)
    return every(
        [
            ("dc/dh = a cot h", turned),
            (
                "so c is critical at cos h = 0, the tacnodes at d = k pi, k odd: c",
                composed(PHI, {Ch: sympy.Integer(0)}, tacnode),
            ),
            (
                "and at a = 0, where both ends are tangency points and omega tan h = tan(omega h): c",
                composed(PHI + q_, {q_: push}, tangency) and composed(push * Sh, {kappa: REAL}, REAL * omega * B),
            ),
        ]
    )


def _first(stated: tuple[sympy.Expr, sympy.Expr, int]) -> Check:
    """(c_1 below a rate, in K = cos(omega pi/2), c_1 above it, the rate)."""
    below, above, border = stated
    links = [*_branch(below, above), *_no_others(border)]
    # that other flights have no larger c is said in words between the identities: no program decides those sentences
    return every(links, "argued")


def _branch(below: sympy.Expr, above: sympy.Expr) -> list[tuple[str, bool]]:
    """The flights with cos(omega m) = -1, from the positive swan c = -1 to the first critical value."""
    real = {kappa: REAL}
    first = composed(-PHI, real | {Ch: sympy.Integer(0), Cw: K}, below)
    second = composed(-PHI, real | {Sw: omega * Cw * Sh / Ch}, above, None)
    rates = {Cw: -omega * Sw, Sw: omega * Cw, Ch: -Sh, Sh: Ch}
    slope = sum(sympy.diff(B, name) * rate for name, rate in rates.items())
    grows = composed(p_, {p_: slope}, (omega**2 - 1) * Sw * Sh)
    return [
        (
            "on the branch of the positive swan c = -phi(h), phi' = cot h (cos(omega h) - phi), a = omega "
            "B/((omega^2 - 1) sin h), and B' = (omega^2 - 1) sin(omega h) sin h, B(0) = 0: c rises while B > 0 and h "
            "< pi/2",
            grows,
        ),
        ("it ends at h = pi/2, with c_1 as stated", first),
        ("or at the first zero h_1 of B, omega tan h_1 = tan(omega h_1), with c_1 as stated", second),
        (
            "its flights are above c between the rests: x' = kappa omega sin u (rho(u) - rho(h)), rho = sin(omega u)/"
            "sin u, rho' = -B/sin^2 falls there, kappa < 0",
            _falls(),
        ),
    ]


def _falls() -> bool:
    """x' of the symmetric flight with g = -1 at u, and the slope of rho."""
    s_u, S_u, c_u, C_u = sympy.symbols("s_u S_u c_u C_u")  # sine and cosine of u, omega u
    speed = kappa * omega * S_u - P * s_u
    factored = composed(speed, {P: kappa * omega * Sw / Sh}, kappa * omega * s_u * (S_u / s_u - Sw / Sh))
    slope = sum(sympy.diff(S_u / s_u, name) * rate for name, rate in {S_u: omega * C_u, s_u: c_u}.items())
    return factored and composed(p_, {p_: slope}, -(S_u * c_u - omega * C_u * s_u) / s_u**2)


def _no_others(border: int) -> list[tuple[str, bool]]:
    """No other flight that is above c between two rests with a >= 0 has c > c_1."""
    s_, e_, f_, n_ = sympy.symbols("s e f n")  # sin(omega h/2), cos(h/2), sin(h/2), cos(omega h/2)
    start = composed(
        p_ * (1 - Cw) + q_ * (1 - Ch),
        {p_: kappa, q_: -kappa * omega * (2 * s_ * n_) / (2 * e_ * f_), Cw: 1 - 2 * s_**2, Ch: 1 - 2 * f_**2},
        2 * kappa * s_ * (s_ * e_ - omega * n_ * f_) / e_,
    )
    C_t, S_t, C_k, S_k = sympy.symbols("C_t S_t C_k S_k")  # of theta = omega w and of omega pi/2
    apart = composed(p_ + q_, {p_: C_t * C_k - S_t * S_k, q_: C_t * C_k + S_t * S_k}, 2 * C_t * C_k)
    whole = composed(PHI, {Sw: sympy.Integer(0), Cw: sympy.Integer(1)}, kappa)
    end = composed(PHI, {Cw: -C_k, Sw: -S_k, Ch: -S_t, Sh: C_t}, -kappa * (C_k + omega * S_k * S_t / C_t))
    steep = positive_on((omega**2 - 1) ** 2 - (1 + 6 * omega**2), omega, 4, sympy.oo)
    return [
        (
            "two points pi apart: x(w - pi/2) + x(w + pi/2) = 2 g kappa cos(omega w) cos(omega pi/2), so c is at "
            "most half of it where both lie between the rests: for h >= pi/2 w = 0 gives c <= c_1 if g = -1 and "
            "omega < 3, w = pi/omega if g = 1 and h >= pi/2 + pi/omega; every longer flight meets the wall for c > c_1",
            apart,
        ),
        (
            "omega < 3, g = 1, h < pi: a >= 0 asks for B(h) <= 0, so h > pi/2, and x(0) - c = 2 kappa sin(omega h/2) "
            "B(h/2)/cos(h/2) with B > 0 on (0, pi/2], so h > 2 pi/omega > pi/2, where phi falls from",
            start,
        ),
        ("phi(2 pi/omega) = kappa <= c_1; B rises on (2 pi/omega, pi), so that B <= 0 before h too", whole),
        (
            "omega < 2, g = 1, pi <= h < pi/2 + pi/omega: B > 0 there, so phi rises to its value at the end, kappa "
            "(|cos| + omega sin |tan(pi/omega)|) <= c_1, cos and sin of omega pi/2",
            end,
        ),
        (
            "omega > 3: where a >= 0 and h < pi/2 c rises to a zero h_j of B or to pi/2, and at h_j |c| = (1 + omega^2 "
            "tan^2 h_j)^(-1/2), largest at h_1; for h >= pi/2 c <= |cos(omega pi/2)|/(omega^2 - 1), which is below "
            "c_1 as h_1 < 3 pi/(2 omega) <= 3 pi/8, tan^2 < 6, for omega >= 4; for omega < 4 -phi falls from h_1 to "
            "pi/2, B < 0",
            steep,
        ),
        (
            f"B(pi/2) = -omega cos(omega pi/2) is positive for 1 < omega < {border} and negative above, to 5; B(2 "
            "pi/omega) < 0, 2 pi/omega <= pi/2 from 4 on",
            _signs(border),
        ),
    ]


def _signs(border: int) -> bool:
    """cos(omega pi/2) is negative between 1 and the border, positive from it to 5: it vanishes at odd numbers alone."""

    def sign(at: Fraction) -> int:
        with balls_at(64):
            value = Balls(64).evaluate(parse(f"cos(({at})*pi/2)", []), {})
        return int(value > 0) - int(value < 0)

    left = [Fraction(2 * n + 1, 2) for n in range(1, 2 * border) if Fraction(2 * n + 1, 2) < border]
    right = [Fraction(2 * n + 1, 2) for n in range(border, 5)]
    return border % 2 == 1 and {sign(at) for at in left} == {-1} and {sign(at) for at in right} == {1}


TWO = (
    g * (1 + 2 * u**2) / 3,
    -2 * g / 3,
    -4 * g * (1 - u**2) / 3,
    {1: sympy.Rational(1, 3), -1: sympy.Rational(-1, 3)},
)


FAMILIES = {
    "b:events-families": Encoding(
        (g * PHI, Cm * Cw, sympy.Integer(0)),
        _two_families,
        (
            (g * kappa * (Cw + omega * Sw * Ch / Sh), Cm * Cw, sympy.Integer(0)),
            (g * PHI, Sm * Cw, sympy.Integer(0)),
            (g * PHI, Cm * Cw, 2 * Cm * Cw),
        ),
    ),
    "b:events-values": Encoding(
        (Ch / Sh, kappa * Cw, Cw),
        _critical_values,
        ((Sh / Ch, kappa * Cw, Cw), (Ch / Sh, Cw, Cw), (Ch / Sh, kappa * Cw, -Cw), (-Ch / Sh, kappa * Cw, Cw)),
    ),
    "b:events-two": Encoding(
        TWO,
        _exactly_two,
        (
            (g * (1 + u**2) / 3, *TWO[1:]),
            (TWO[0], 2 * g / 3, *TWO[2:]),
            (*TWO[:2], 4 * g * (1 - u**2) / 3, TWO[3]),
            (*TWO[:3], {1: sympy.Rational(1, 3), -1: sympy.Rational(-2, 3)}),
        ),
    ),
    "b:events-first": Encoding(
        (K / (omega**2 - 1), -Cw, 3),
        _first,
        (
            (K / (omega**2 + 1), -Cw, 3),
            (-K / (omega**2 - 1), -Cw, 3),
            (K / (omega**2 - 1), Cw, 3),
            (K / (omega**2 - 1), -Cw, 5),
            (K / (omega**2 - 1), -Cw, 2),
        ),
    ),
}


tau, v, t, c, k = sympy.symbols("tau v t c k")
a, a_1, a_2, a_d1, Y, Y_d, R_c, R_dc = sympy.symbols("a a_1 a_2 a_d1 Y Yd R_c Rd_c")
C, S, A_1, A_2 = sympy.symbols("C S A_1 A_2")
p, q, r, s = sympy.symbols("p q r s")


def composed(outer: sympy.Expr, images: Mapping[Any, Any], right: sympy.Expr, where: Any = None) -> bool:
    """Whether an outer function of some images is the right side, with its certificate."""
    gap = sympy.together(sympy.sympify(outer).subs(images, simultaneous=True) - right)
    if where is not None:
        gap = sympy.rem(sympy.Poly(sympy.fraction(sympy.cancel(gap))[0], where[1]), sympy.Poly(*where)).as_expr()
    if sympy.cancel(gap) != 0:
        return False
    substitution(At(outer, images), right, where=where)
    return True


def _derivatives() -> tuple[sympy.Expr, sympy.Expr, sympy.Expr, sympy.Expr]:
    """x and x' of the flight from (tau, v), derived by tau and by v at the time tau, where order 3 drops out."""
    push = sympy.Function("A")(tau, v)  # g - f at the launch
    height = c + v * (t - tau) + push * (t - tau) ** 2 / 2
    parts = [sympy.diff(part, name) for part in (height, sympy.diff(height, t)) for name in (tau, v)]
    return tuple(sympy.cancel(part.subs(t, tau).subs(push, a)) for part in parts)


def _front(stated: tuple[Any, ...]) -> Check:
    """(dR, dR') by s at s; det D psi; kernel on v = 0; det derived once and twice along it on v = 0."""
    x_tau, x_v, y_tau, y_v = _derivatives()
    at_rest = x_tau.subs(v, 0), y_tau.subs(v, 0)  # the flight at rest at s, moved in s
    determinant = sympy.expand(x_tau * y_v - x_v * y_tau)
    kernel = sympy.Integer(1), sympy.cancel(-at_rest[1] / y_v)  # (x_v, y_v) = (0, 1): the second row decides
    push = sympy.Function("a")(tau)

    def along(function: sympy.Expr) -> Any:
        return sympy.diff(function, tau) + push * sympy.diff(function, v)

    once = along(determinant)
    twice = along(once).subs(sympy.diff(push, tau), a_d1).subs(push, a)
    derived = (*at_rest, determinant, *kernel, once.subs(push, a), twice)
    sound = composed(p * s - q * r, {p: x_tau, q: x_v, r: y_tau, s: y_v}, stated[2])
    flat = x_tau.subs(v, 0) * kernel[0] + x_v * kernel[1] == 0 and at_rest[1] * kernel[0] + y_v * kernel[1] == 0
    return every(
        [
            (f"at t = tau D psi has the rows {(x_tau, x_v)}, {(y_tau, y_v)}", sound),
            ("on v = 0 it takes (1, a) to 0", flat),
            identity(lambda: derived)(stated),
        ],
        witness=lambda: {"derived": str(derived)},
    )


def _critical(stated: sympy.Expr) -> Check:
    """The component of c of the tangent of {x = c, x' = 0 at s + d} in (s_1, s_2, c)."""
    rows = ((-a_1 * Y, sympy.Integer(0), R_c), (-a_1 * Y_d, a_2, R_dc))  # x'(s_2) = 0, x''(s_2) = a_2
    (m, n, _), (o, u, _) = rows
    determinant = sympy.expand(m * u - n * o)
    tangent = tuple(sympy.expand(component) for component in sympy.Matrix(rows[0]).cross(sympy.Matrix(rows[1])))
    tangent_vanishes = all(sympy.expand(sum(x * y for x, y in zip(row, tangent, strict=True))) == 0 for row in rows)
    exact = composed(p * s - q * r, {p: m, q: n, r: o, s: u}, stated)
    return every(
        {
            f"the tangent is {tangent}, in (s_1, s_2, c), where its parts do not all vanish": tangent_vanishes,
            f"its component of c is {determinant}": exact and tangent[2] == determinant,
        },
        witness=lambda: {"derived": str(determinant), "stated": str(stated)},
    )


def _eliminated(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(F, c) of a linear model: E1 = A_1 + c(C - 1) and E2 = A_2 - c k S vanish together where F = 0, c as stated."""
    F, clearance = stated
    one, two = A_1 + c * (C - 1), A_2 - c * k * S
    size = (C - 1) ** 2 + (k * S) ** 2
    first = composed(k * S * p + (C - 1) * q, {p: one, q: two}, F)
    second = composed((C - 1) * p - k * S * q, {p: one, q: two}, size * (c - clearance))
    turned = sympy.expand(sympy.Matrix([[k * S, C - 1], [C - 1, -k * S]]).det() + size)
    return every(
        {
            "k S E1 + (C - 1) E2 = F": first,
            "(C - 1) E1 - k S E2 = ((C - 1)^2 + k^2 S^2)(c - this)": second,
            "these combinations are independent where (C - 1)^2 + k^2 S^2 is not 0": turned == 0,
        }
    )


FRONT = (sympy.Integer(0), -a, -v, sympy.Integer(1), a, -a, -a_d1)


def _with(index: int, other: sympy.Expr) -> tuple[Any, ...]:
    return (*FRONT[:index], other, *FRONT[index + 1 :])


FLIGHTS = {
    "b:events-front": Encoding(
        FRONT, _front, (_with(1, a), _with(2, v), _with(4, -a), _with(5, a), _with(6, sympy.Integer(0)))
    ),
    "b:events-critical": Encoding(-a_1 * a_2 * Y, _critical, (-a_1 * Y, -a_1 * a_2 * Y_d, a_1 * a_2 * Y, -a_1 * a_2)),
    "b:events-eliminated": Encoding(
        (A_1 * k * S + A_2 * (C - 1), (A_2 * k * S - A_1 * (C - 1)) / ((C - 1) ** 2 + (k * S) ** 2)),
        _eliminated,
        (
            (A_1 * k * S - A_2 * (C - 1), (A_2 * k * S - A_1 * (C - 1)) / ((C - 1) ** 2 + (k * S) ** 2)),
            (A_1 * k * S + A_2 * (C - 1), (A_2 * k * S + A_1 * (C - 1)) / ((C - 1) ** 2 + (k * S) ** 2)),
            (A_1 * S + A_2 * (C - 1), (A_2 * k * S - A_1 * (C - 1)) / ((C - 1) ** 2 + (k * S) ** 2)),
        ),
    ),
}

CLAIMS = FLIGHTS | FAMILIES
