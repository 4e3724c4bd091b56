"""Section 4.1(a), second part: the blow-up h', its fixed points and their multipliers, for all r in (0, 1)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy

from singimpact.algebra.certificates import negative_on, positive_on, value_at
from singimpact.claims.claim import Check, Claim, Statement
from singimpact.claims.notation import latex
from singimpact.claims.verifiers import every, identity, is_zero
from singimpact.theory import fold_route as fold
from singimpact.theory.fold_route import m
from singimpact.theory.implicit_route import r

HALF, THREE_HALVES = sympy.Rational(1, 2), sympy.Rational(3, 2)
Q = sympy.Symbol("Q")
QUARTIC = m**2 * (m - HALF) ** 2
CUBIC = (m - HALF) ** 2 * (m + THREE_HALVES)


def _sign_chain(expression: Any, signs: tuple[tuple[Any, int], ...]) -> bool:
    """The polynomial in m has the stated sign at each place, for every r in (0, 1); the places may be infinite."""
    return all(_sign_at(expression, place) == sign for place, sign in signs)


def _sign_at(expression: Any, place: Any) -> int:
    if place in (sympy.oo, -sympy.oo):
        poly = sympy.Poly(expression, m)
        value = poly.LC() * (1 if place == sympy.oo or poly.degree() % 2 == 0 else -1)
    else:
        value = expression.subs(m, place)
    return 1 if positive_on(value, r, 0, 1) else -1 if negative_on(value, r, 0, 1) else 0


def _blow_up(stated: tuple[Any, Any]) -> Check:
    return identity(fold.h_blown_up, "derived from h with s < 0 and the root that lands before the horizon")(stated)


def _q_zeros(stated: tuple[Any, Any, Any]) -> Check:
    """Q_r(1, m) has its zeros in (stated[0], stated[1]) and (stated[1], stated[2]); both tend to stated[1]."""
    low, middle, high = stated
    polynomial = fold.Q_at_one()
    at_zero = sympy.factor(polynomial.subs(r, 0))
    chain = _sign_chain(polynomial, ((-sympy.oo, 1), (low, 1), (middle, -1), (high, 1), (sympy.oo, 1)))
    return every(
        [
            (f"signs + + - + + at -oo, {low}, {middle}, {high}, oo for every r in (0, 1)", chain),
            (
                "it is quadratic, so there is one zero in each gap and it is positive outside",
                sympy.degree(polynomial, m) == 2,
            ),
            (
                f"at r = 0 both zeros are {middle}",
                is_zero(at_zero.subs(m, middle)) and is_zero(at_zero.diff(m).subs(m, middle)),
            ),
        ]
    )


def _q_positive(stated: str) -> Check:
    """Q_r(1, m) has the stated sign (">" or ">=") on the closed set E_r; the closed ends are the zeros themselves."""
    polynomial = fold.Q_at_one()
    outside = _sign_chain(polynomial, ((-sympy.oo, 1), (0, 1), (HALF, -1), (THREE_HALVES, 1), (sympy.oo, 1)))
    end = sympy.Poly(polynomial.subs(r, HALF), m).nroots(n=30)[1]
    at_end = abs(polynomial.subs({r: HALF, m: end}))
    strict_fails = at_end < sympy.Rational(1, 10**20)
    return every(
        [
            ("positive outside [m_-, m_+] for every r in (0, 1)", outside),
            ("the zeros m_-, m_+ belong to E_r, so the sign there is 0", stated == ">=" or not strict_fails),
            ("and not negative anywhere on E_r", stated in (">", ">=")),
        ],
        witness=lambda: {"r": "1/2", "m_+": str(end), "Q_r(1, m_+)": "0"},
    )


def _domain(stated: tuple[str, str]) -> Check:
    """Near s = 0 the equation Q_r(1, m) + O(s) = 0 has smooth solutions through the zeros, which are simple."""
    discriminant = sympy.discriminant(fold.Q_at_one(), m)
    ends = ("m_-", "m_+")
    return every(
        [
            ("the discriminant of Q_r(1, m) is positive for every r in (0, 1), so dQ/dm is not 0 at m_-, m_+ "
             "and the implicit function theorem gives delta_-, delta_+", positive_on(discriminant, r, 0, 1)),
            ("delta_-(0), delta_+(0) are the zeros of Q_r(1, m), at which the root leaves the reals", stated == ends),
        ]
    )  # fmt: skip


def _converse(stated: Callable[[Any], Any]) -> Check:
    """Solutions of Q = m^2 (m - 1/2)^2 in the stated set satisfy m = (m - 1/2)^(-1) sqrt(Q), sqrt the nonnegative root.

    There sqrt(Q) = |m (m - 1/2)|, so the equation holds where m/(m - 1/2) >= 0 and m is not 0; the solutions have places
    m1 < -3/2, 0 < m2 < 1/2 < m3 and 3/2.
    """
    places = {"m1": (-sympy.Integer(5), -THREE_HALVES), "m2": (sympy.Integer(0), HALF), "m3": (HALF, THREE_HALVES)}
    root = sympy.Poly((CUBIC - 2 * r * m).subs(r, HALF), m).nroots(n=20)[1]
    image = sympy.sqrt(fold.Q_at_one()) / (m - HALF)
    failing = [
        name
        for name, (low, high) in places.items()
        if stated((low + high) / 2) and negative_on(m * (m - HALF), m, low, high)
    ]
    missing = [
        name
        for name, (low, high) in places.items()
        if not stated((low + high) / 2) and positive_on(m * (m - HALF), m, low, high)
    ]
    return every(
        [
            ("m (m - 1/2) has one sign on the place of each root", _sign_chain(CUBIC - 2 * r * m, _CHAIN)),
            ("it is positive for each root in the stated set", not failing),
            ("no root with m (m - 1/2) > 0 is left out", not missing),
        ],
        witness=lambda: {
            "r": "1/2",
            "m2": str(root),
            "(m2-1/2)^(-1) sqrt(Q)": str(sympy.N(image.subs({m: root, r: HALF}), 15)),
        },
    )


_CHAIN = ((-sympy.oo, -1), (-THREE_HALVES, 1), (0, 1), (HALF, -1), (sympy.oo, 1))


def _fixed_points(stated: Any) -> Check:
    """m' = m squared and cleared: the polynomial equation is the stated one."""
    rate, new = fold.h_blown_up()
    cleared = sympy.cancel(sympy.expand((new * rate) ** 2 - (m * rate) ** 2))
    return every(
        [
            ("squaring m = (m - 1/2)^(-1) sqrt(Q) gives it", is_zero(stated - cleared)),
            ("m = 1/2 is not lost: it lies outside E_r", negative_on(fold.Q_at_one().subs(m, HALF), r, 0, 1)),
        ],
        witness=lambda: {
            "m": "2",
            "r": "1/2",
            "stated": str(stated.subs({m: 2, r: HALF})),
            "derived": str(cleared.subs({m: 2, r: HALF})),
        },
    )


def _root_places(stated: tuple[Any, Any, Any]) -> Check:
    """Three real roots: one below stated[0], one in (stated[1], stated[2]), one above stated[2]."""
    low, left, right = stated
    cubic = fold.fixed_point_factors()[1]
    chain = ((-sympy.oo, -1), (low, 1), (left, 1), (right, -1), (sympy.oo, 1))
    return every(
        [
            (f"signs - + + - + at -oo, {low}, {left}, {right}, oo for every r in (0, 1)", _sign_chain(cubic, chain)),
            ("it is a cubic, so these are all", sympy.degree(cubic, m) == 3),
        ]
    )


def _trivial_root(stated: str) -> Check:
    """Where m = 3/2 solves e:fixm: "r = 1" or "every r"."""
    value = fold.fixed_point_equation().subs(m, THREE_HALVES)
    cubic = fold.fixed_point_factors()[1].subs(m, THREE_HALVES)
    always = is_zero(value)
    return every(
        [
            ("m = 3/2 solves e:fixm for every r" if always else "m = 3/2 does not solve e:fixm for every r",
             always == (stated == "every r")),
            ("it is a root of the cubic e:meq only for r = 1", sympy.Poly(cubic, r).all_roots() == [1]),
        ],
        witness=lambda: {"r": "1/2", "m": "3/2", "Q_r(1,m) - m^2(m-1/2)^2": str(value)},
    )  # fmt: skip


def _ray(low: Any, high: Any) -> dict[str, Any]:
    """Signs along the line eta = m sigma for every root m in (low, high): of v, and of q's first component."""
    velocity = fold.gamma_leading() / fold.k
    rate, _ = fold.h_blown_up()
    return {
        "v": 1 if positive_on(velocity, m, low, high) else -1 if negative_on(velocity, m, low, high) else 0,
        "orientation": 1 if positive_on(rate, m, low, high) else -1 if negative_on(rate, m, low, high) else 0,
    }


def _same_parabola() -> bool:
    """On a ray with Q = m^2 (m - 1/2)^2, q's image is p's image: v = k (9/4 - m^2) sigma^2 again."""
    rate, _ = fold.h_blown_up()
    _, folded = fold.psi_p()
    second = fold.psi_q()[1].subs(fold.eta, m * fold.sigma)
    image = folded.subs(fold.eta, m * rate * fold.sigma)
    return is_zero(sympy.rem(sympy.expand((second - image) / fold.k / fold.sigma**2), fold.fixed_point_factors()[1], m))


def _line(low: Any, high: Any) -> Callable[[tuple[str, int]], Check]:
    """A verifier of (orientation of q against p, sign of v on the image) for every root in (low, high)."""

    def verify(stated: tuple[int, int]) -> Check:
        found = _ray(low, high)
        return every(
            [
                ("p and q map the line onto one parabola", _same_parabola()),
                (
                    f"q turns it {'round' if found['orientation'] < 0 else 'the same way'}",
                    found["orientation"] == stated[0],
                ),
                (f"v is {'positive' if found['v'] > 0 else 'negative'} on it for k > 0", found["v"] == stated[1]),
            ],
            witness=lambda: {
                "m in": f"({low}, {high})",
                "orientation": str(found["orientation"]),
                "sign of v": str(found["v"]),
            },
        )

    return verify


def _gradient(stated: Any) -> Check:
    """eta = m1 sigma is t = (m1 - 3/2) sigma, and m1 < -3/2."""
    at_zero = fold.fold_coordinate().subs(fold.t, 0)  # eta = t + at_zero
    gradient = sympy.cancel((m * fold.sigma - at_zero) / fold.sigma)
    below = _sign_chain(fold.fixed_point_factors()[1], ((-sympy.oo, -1), (-THREE_HALVES, 1)))
    bound = gradient.subs(m, -THREE_HALVES)
    return every(
        [
            (f"the gradient is {gradient}", is_zero(gradient - stated[0])),
            (f"m1 < -3/2, so it is below {bound}", below and bound == stated[1]),
        ]
    )


def _m2_sign(stated: int) -> Check:
    """Sign of v after q o p^{-1} on the image of the m2 line, where v > 0 before."""
    found = _ray(sympy.Integer(0), HALF)["v"]
    root = sympy.Poly(fold.fixed_point_factors()[1].subs(r, HALF), m).nroots(n=20)[1]
    before = fold.gamma_leading().subs({m: root, fold.k: 1})
    after = _q_velocity(root)
    return every(
        [
            ("p and q map the line onto one parabola", _same_parabola()),
            ("on which v > 0 for k > 0, before and after", found == stated),
        ],
        witness=lambda: {"r": "1/2", "k": "1", "m2": str(root), "v before": str(before), "v after": str(after)},
    )


def _q_velocity(root: Any) -> Any:
    """v on q's image of (sigma, eta) = (1, root) at r = 1/2, k = 1."""
    _, second = fold.phi()
    point = {fold.sigma: 1, fold.t: root - THREE_HALVES, fold.k: 1, r: HALF}
    return sympy.N((-r * second).subs(point), 20)


def _m3(stated: tuple[Any, Any]) -> Check:
    """On the m3 ray v > 0 and p, q agree in orientation; m3 grows from stated[0] to stated[1] with r."""
    low, high = stated
    rule = fold.r_of_m()
    found = _ray(low, high)
    return every(
        [
            ("v > 0 and the same orientation on the ray", found == {"v": 1, "orientation": 1}),
            ("t = (m - 3/2) sigma > 0 for sigma < 0", positive_on(THREE_HALVES - m, m, low, high)),
            ("r(m) increases on the interval", positive_on(sympy.diff(rule, m), m, low, high)),
            ("from 0 to 1", value_at(rule, m, low) == 0 and value_at(rule, m, high) == 1),
        ]
    )


def _N_r(stated: Any) -> Check:
    return identity(fold.N_r, "derived by differentiating m'")(stated.subs(Q, fold.Q_at_one()))


def _N_r_form(stated: tuple[Any, str]) -> Check:
    """N_r at the solutions of e:fixm: on the cubic with m (m - 1/2) > 0, and in "all" of them, m2 and 3/2 too."""
    formula, where = stated
    check = identity(fold.N_r_at_fixed_points, "derived on the cubic with m (m - 1/2) > 0")(formula)
    trivial = fold.N_r_collected().subs(m, THREE_HALVES)
    covers = where == "m1, m3" or is_zero(trivial - formula.subs(m, THREE_HALVES))
    return every(
        [
            (check.evidence, check.holds),
            ("at m = 3/2 N_r is r, the formula gives 1" if where == "all" else "m1 and m3 have m (m - 1/2) > 0",
             covers and _sign_chain(CUBIC - 2 * r * m, _CHAIN)),
        ],
        witness=lambda: dict(check.witness or {"r": "1/2", "m": "3/2", "N_r": str(trivial.subs(r, HALF)),
                                               "formula": str(formula.subs(m, THREE_HALVES))}),
    )  # fmt: skip


def _jacobian(stated: Any) -> Check:
    """The first row of Dh'(0, m) and the entry below the diagonal's end; * is not tested, it depends on O(3)."""
    derived = fold.Dh_blown_up()
    return identity(lambda: (derived[0, 0], derived[0, 1], derived[1, 1]))(
        (stated[0, 0], stated[0, 1], stated[1, 1].subs(Q, fold.Q_at_one()))
    )


def _saddle(stated: tuple[Any, Any, Any, Any]) -> Check:
    """(lambda, mu as r -> 0, lambda, mu as r -> 1), and 0 < lambda < 1 < mu for every r in (0, 1), by m in (1/2, 3/2)."""
    rate, _ = fold.h_blown_up()
    multiplier = fold.N_r_at_fixed_points()
    ends = tuple(value_at(part, m, end) for end in (HALF, THREE_HALVES) for part in (rate, multiplier))
    return every(
        [
            ("m3 in (1/2, 3/2) runs once through r in (0, 1)", _m3((HALF, THREE_HALVES)).holds),
            (
                "0 < lambda < 1",
                positive_on(rate, m, HALF, THREE_HALVES) and positive_on(1 - rate, m, HALF, THREE_HALVES),
            ),
            ("mu > 1", positive_on(multiplier - 1, m, HALF, THREE_HALVES)),
            (f"limits {ends[0]}, {ends[1]} as r -> 0 and {ends[2]}, {ends[3]} as r -> 1", ends == stated),
        ]
    )


def _direction(stated: tuple[int, int]) -> Check:
    """The eigenvector of Dh'(0, m3) for mu, whatever * is."""
    matrix, vector = fold.Dh_blown_up(), sympy.Matrix(stated)
    image = matrix * vector - matrix[1, 1] * vector
    return every([("Dh' v = mu v for the direction stated, for any *", all(is_zero(part) for part in image.expand()))])


def _tangent(stated: tuple[Any, int]) -> Check:
    """chi(W^s) = {(s, s m(s))}, m(0) = m3: its tangent at 0 has slope m3, and eta has the sign of sigma."""
    slope, sign = stated
    derived = sympy.Symbol("m_3")
    value = sympy.Poly(fold.fixed_point_factors()[1].subs(r, HALF), m).nroots(n=20)[2]
    positive = positive_on(m, m, HALF, THREE_HALVES)
    return every(
        [
            ("the tangent at the origin has slope m(0) = m3 in (1/2, 3/2)", slope == derived),
            ("for sigma < 0 the sign of eta = m sigma is -", positive and sign == -1),
        ],
        witness=lambda: {"r": "1/2", "slope of the tangent": str(value), "stated slope": str(slope)},
    )


def _claim(name: str, title: str, printed: Statement, verify: Any, mutants: tuple[Any, ...], rests_on: tuple[str, ...],
           corrected: Any = None) -> Claim:  # fmt: skip
    return Claim(name, "4.1(a)", title, printed, verify, mutants, corrected, rests_on)


_ON_FORM3 = (2 * m + 3) ** 2 / (8 * m**2 * (2 * m - 1))
_FORM1 = (HALF / (m - HALF) * (r * (4 * m - 3) + sympy.Rational(9, 2) * (m - HALF)) - Q / (m - HALF) ** 2) / sympy.sqrt(
    Q
)
_FORM2 = r * (2 * m + 3) / (2 * m - 1) ** 2 / sympy.sqrt(Q)

CLAIMS = (
    _claim("s4-blowup", "the blown-up h' on the visible part, s < 0, m > 1/2",
           Statement(r"s'=(m-\tfrac12)s,\quad m'=(m-\tfrac12)^{-1}\sqrt{Q_r(1,m)+O(s)}",
                     (m - HALF, sympy.sqrt(r * (2 * m**2 - 3 * m) + sympy.Rational(9, 4) * (m - HALF) ** 2) / (m - HALF))),
           _blow_up,
           ((m - HALF, -sympy.sqrt(r * (2 * m**2 - 3 * m) + sympy.Rational(9, 4) * (m - HALF) ** 2) / (m - HALF)),
            (m + HALF, sympy.sqrt(r * (2 * m**2 - 3 * m) + sympy.Rational(9, 4) * (m - HALF) ** 2) / (m - HALF))),
           ("e:hdef", "e:qdef")),
    _claim("s4-Qr-zeros", "Q_r(1, m) has zeros 0 < m_- < 1/2 < m_+ < 3/2, is positive outside, and both tend to 1/2 as r -> 0",
           Statement(r"0<m_-<\tfrac12<m_+<\tfrac32,\qquad m_\pm\to\tfrac12\ (r\to0)", (sympy.Integer(0), HALF, THREE_HALVES)),
           _q_zeros, ((sympy.Integer(0), sympy.Integer(1), THREE_HALVES), (HALF, THREE_HALVES, sympy.Integer(2))), ("e:qdef",)),
    _claim("s4-Er-closed", "Q_r(1, m) > 0 on the closed set E_r; at its ends it is 0",
           Statement(r"Q_r(1,m)>0\ \text{for}\ m\in E_r=(-\infty,m_-]\cup[m_+,\infty)", ">"), _q_positive, ("<", "<="),
           ("s4-Qr-zeros",), lambda: Statement(r"Q_r(1,m)\ge0\ \text{for}\ m\in E_r,\ \text{with}\ 0\ \text{at}\ m_\pm\ \text{only}", ">=")),
    _claim("s4-domain", "near s = 0 the domain of h' is bounded by smooth curves through m_- and m_+",
           Statement(r"m=\delta_\pm(s),\qquad\delta_\pm(0)=m_\pm", ("m_-", "m_+")), _domain, (("m_-", "m_-"), ("1/2", "3/2")),
           ("s4-Qr-zeros", "s4-blowup")),
    _claim("e:fixm-converse", "every solution of the squared equation solves the fixed-point equation; m2 does not",
           Statement(r"Q_r(1,m)=m^2(m-\tfrac12)^2\Rightarrow m=(m-\tfrac12)^{-1}\sqrt{Q_r(1,m)}", lambda _place: True), _converse,
           (lambda place: place < 0, lambda place: place < HALF), ("e:fixm", "s4-root-places"),
           lambda: Statement(r"Q_r(1,m)=m^2(m-\tfrac12)^2\ \text{and}\ m(m-\tfrac12)>0\Rightarrow m=(m-\tfrac12)^{-1}\sqrt{Q_r(1,m)}",
                             lambda place: place * (place - HALF) > 0)),
    _claim("e:fixm", "a fixed point of h' on s = 0 satisfies Q_r(1, m) = m^2 (m - 1/2)^2",
           Statement(r"Q_r(1,m)=m^2(m-\tfrac12)^2", r * (2 * m**2 - 3 * m) + sympy.Rational(9, 4) * (m - HALF) ** 2 - QUARTIC),
           _fixed_points,
           (r * (2 * m**2 - 3 * m) + sympy.Rational(9, 4) * (m - HALF) ** 2 - m**2 * (m + HALF) ** 2,
            r * (2 * m**2 - 3 * m) + sympy.Rational(9, 4) * (m - HALF) ** 2 - m * (m - HALF) ** 2), ("s4-blowup", "e:qdef")),
    _claim("e:meq", "besides m = 3/2 the solutions are the roots of 2 r m = (m - 1/2)^2 (m + 3/2)",
           Statement(r"2rm=(m-\tfrac12)^2(m+\tfrac32)", CUBIC - 2 * r * m), identity(lambda: fold.fixed_point_factors()[1]),
           (CUBIC + 2 * r * m, CUBIC - r * m, (m - HALF) ** 2 * (m - THREE_HALVES) - 2 * r * m), ("e:fixm",)),
    _claim("s4-root-places", "the cubic has three real roots m1 < -3/2 and 0 < m2 < 1/2 < m3",
           Statement(r"m_1<-\tfrac32,\quad0<m_2<\tfrac12<m_3", (-THREE_HALVES, sympy.Integer(0), HALF)), _root_places,
           ((-HALF, HALF, THREE_HALVES), (-sympy.Integer(3), sympy.Integer(0), HALF)), ("e:meq",)),
    _claim("s4-m32-r1", "m = 3/2 solves e:fixm only if r = 1; it solves it for every r",
           Statement(r"m=\tfrac32\Rightarrow r=1", "r = 1"), _trivial_root, ("r = 0",), ("e:fixm", "e:meq"),
           lambda: Statement(r"m=\tfrac32\ \text{solves}\ Q_r(1,m)=m^2(m-\tfrac12)^2\ \text{for every}\ r", "every r")),
    _claim("s4-m1", "m1: p and q give the image opposite orientations, and it lies in v <= 0",
           Statement(r"m_1<-\tfrac32:\quad v\le0,\ \text{opposite orientations}", (-1, -1)),
           _line(-sympy.oo, -THREE_HALVES), ((1, -1), (-1, 1)), ("s4-root-places", "s4-fold-form", "e:defq")),
    _claim("s4-m1-gradient", "in (sigma, t) the line of m1 has gradient m1 - 3/2 < -3",
           Statement(r"t=(m_1-\tfrac32)\sigma,\quad m_1-\tfrac32<-3", (m - THREE_HALVES, -3)), _gradient,
           ((m + THREE_HALVES, -3), (m - THREE_HALVES, -2)), ("s4-root-places", "s4-fold-form")),
    _claim("s4-m2", "m2: p and q give the image opposite orientations",
           Statement(r"0<m_2<\tfrac12:\quad\text{opposite orientations}", (-1, 1)), _line(sympy.Integer(0), HALF),
           ((1, 1),), ("s4-root-places", "s4-fold-form", "e:defq")),
    _claim("s4-m2-sign", "m2: points of the image with v > 0 go to points with v < 0; they stay in v > 0",
           Statement(r"q\circ p^{-1}:\{v>0\}\to\{v<0\}", -1), _m2_sign, (0,), ("s4-m2",),
           lambda: Statement(r"q\circ p^{-1}:\{v>0\}\to\{v>0\},\ \sigma\mapsto(m_2-\tfrac12)\sigma\ \text{changes sign}", 1)),
    _claim("s4-m3", "m3: for t > 0 p and q map the ray into v > 0 with one orientation, and m3 grows from 1/2 to 3/2 with r",
           Statement(r"\tfrac12<m_3<\tfrac32,\quad m_3\nearrow\ \text{as}\ r\nearrow", (HALF, THREE_HALVES)), _m3,
           ((HALF, sympy.Integer(2)), (sympy.Integer(0), THREE_HALVES)), ("s4-root-places", "s4-fold-form", "e:defq")),
    _claim("s4-Dh-form", "Dh'(0, m) is lower triangular with m - 1/2 and N_r(m)",
           Statement(r"Dh'(0,m)=\begin{pmatrix}m-\tfrac12&0\\ *&N_r(m)\end{pmatrix}", sympy.Matrix([[m - HALF, 0], [0, _FORM2]])),
           _jacobian, (sympy.Matrix([[m + HALF, 0], [0, _FORM2]]), sympy.Matrix([[m - HALF, 0], [0, -_FORM2]]),
                       sympy.Matrix([[m - HALF, 1], [0, _FORM2]])), ("s4-blowup", "s4-Nr-2")),
    _claim("s4-Nr-2", "N_r(m) over one denominator", Statement(r"N_r(m)=r(2m+3)(2m-1)^{-2}Q^{-\frac12}", _FORM2), _N_r,
           (r * (2 * m - 3) / (2 * m - 1) ** 2 / sympy.sqrt(Q), r * (2 * m + 3) / (2 * m - 1) / sympy.sqrt(Q)), ("s4-Nr-1",)),
    _claim("s4-Nr-1", "N_r(m) = dm'/dm at s = 0, as differentiated",
           Statement(r"N_r(m)=Q^{-\frac12}\bigl(\tfrac12(m-\tfrac12)^{-1}[r(4m-3)+\tfrac92(m-\tfrac12)]-Q(m-\tfrac12)^{-2}\bigr)", _FORM1),
           _N_r, (-_FORM1, _FORM1 + 2 * sympy.sqrt(Q) / (m - HALF) ** 2), ("s4-blowup",)),
    _claim("s4-Nr-3-all", "the third form of N_r at every solution of e:fixm; at m = 3/2 it fails",
           Statement(r"N_r(m)=\frac{(2m+3)^2}{8m^2(2m-1)}\ \text{for every solution of}\ Q_r(1,m)=m^2(m-\tfrac12)^2", (_ON_FORM3, "all")),
           _N_r_form, ((-_ON_FORM3, "all"), (-_ON_FORM3, "m1, m3")), ("e:fixm", "s4-Nr-2", "s4-Nr-3"),
           lambda: Statement(rf"N_r(m)={latex(fold.N_r_at_fixed_points())}\ \text{{at the roots of the cubic with}}\ m(m-\tfrac12)>0",
                             (fold.N_r_at_fixed_points(), "m1, m3"))),
    _claim("s4-Nr-3", "the third form of N_r at m1 and m3",
           Statement(r"N_r(m)=\frac{(2m+3)^2}{8m^2(2m-1)}", (_ON_FORM3, "m1, m3")), _N_r_form,
           ((_ON_FORM3 / 2, "m1, m3"), ((2 * m - 3) ** 2 / (8 * m**2 * (2 * m - 1)), "m1, m3")), ("s4-Nr-2", "e:meq", "s4-root-places")),
    _claim("s4-saddle-m3", "0 < lambda < 1 < mu for 0 < r < 1, with the limits as r -> 0 and r -> 1",
           Statement(r"0<\lambda<1<\lambda',\quad(\lambda,\lambda')\to(0,\infty)\ (r\to0),\quad(\lambda,\lambda')\to(1,1)\ (r\to1)",
                     (sympy.Integer(0), sympy.zoo, sympy.Integer(1), sympy.Integer(1))), _saddle,
           ((sympy.Integer(0), sympy.Integer(1), sympy.Integer(1), sympy.Integer(1)),
            (sympy.Integer(1), sympy.zoo, sympy.Integer(0), sympy.Integer(1))), ("s4-Dh-form", "s4-Nr-3", "s4-m3")),
    _claim("s4-mu-direction", "the eigendirection of Dh'(0, m3) for the eigenvalue > 1 is the m-axis",
           Statement(r"\ker(Dh'(0,m_3)-\lambda'I)=\langle(0,1)\rangle", (0, 1)), _direction, ((1, 0), (1, 1)),
           ("s4-Dh-form", "s4-saddle-m3")),
    _claim("s4-beta-tangent", "chi(W^s) is tangent to the s-axis with eta > 0 for sigma < 0; it is tangent to eta = m3 sigma",
           Statement(r"\beta=\chi(W^s)\ \text{tangent to}\ \eta=0,\ \eta>0\ \text{for}\ \sigma<0", (sympy.Integer(0), 1)), _tangent,
           ((sympy.Integer(0), -1), (sympy.Symbol("m_3"), 1)), ("s4-saddle-m3", "s4-m3"),
           lambda: Statement(r"\beta=\chi(W^s)\ \text{tangent to}\ \eta=m_3\sigma,\ \eta<0\ \text{for}\ \sigma<0", (sympy.Symbol("m_3"), -1))),
)  # fmt: skip
