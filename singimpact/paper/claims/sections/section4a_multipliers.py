"""Section 4.1(a): the Jacobian of h' on s = 0, the saddle at m3, and the tangent of beta."""

from collections.abc import Callable
from typing import Any

import sympy

from singimpact.algebra.certificates import negative_on, positive_on, value_at
from singimpact.paper.claims.claim import Check, Encoding, Statement
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS
from singimpact.paper.claims.sections.section4a_blowup import CUBIC, HALF, ROOT_SIGNS, THREE_HALVES, Q, sign_chain
from singimpact.paper.claims.verifiers import agree, every, identity, is_eigenvector, is_zero
from singimpact.paper.routes import fold
from singimpact.paper.routes.fold import m
from singimpact.paper.routes.implicit import r, sigma, t
from singimpact.theory.notation import latex

# Section 4.1(a): the four solutions of the fixed-point equation, and the images of their rays under p and q.


def _ray(low: sympy.Expr, high: sympy.Expr) -> dict[str, Any]:
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
    second = fold.psi_q()[1].subs(fold.eta, m * sigma)
    image = folded.subs(fold.eta, m * rate * sigma)
    return is_zero(sympy.rem(sympy.expand((second - image) / fold.k / sigma**2), fold.fixed_point_factors()[1], m))


def _line(low: sympy.Expr, high: sympy.Expr) -> Callable[[tuple[int, int]], Check]:
    """A verifier of (orientation of q against p, sign of v on the image) for every root in (low, high)."""

    def verify(stated: tuple[int, int]) -> Check:
        ray = _ray(low, high)
        return every(
            {
                "p and q map the line onto one parabola": _same_parabola(),
                f"q turns it {'round' if ray['orientation'] < 0 else 'the same way'}": ray["orientation"] == stated[0],
                f"v is {'positive' if ray['v'] > 0 else 'negative'} on it for k > 0": ray["v"] == stated[1],
            },
            witness=lambda: {
                "m in": f"({low}, {high})",
                "orientation": str(ray["orientation"]),
                "sign of v": str(ray["v"]),
            },
        )

    return verify


def _gradient(stated: tuple[sympy.Expr, int]) -> Check:
    """eta = m1 sigma is t = (m1 - 3/2) sigma, and m1 < -3/2."""
    at_zero = fold.fold_coordinate().subs(t, 0)  # eta = t + at_zero
    gradient = sympy.cancel((m * sigma - at_zero) / sigma)
    below = sign_chain(fold.fixed_point_factors()[1], ((-sympy.oo, -1), (-THREE_HALVES, 1)))
    bound = gradient.subs(m, -THREE_HALVES)
    return every(
        {
            f"the gradient is {gradient}": is_zero(gradient - stated[0]),
            f"m1 < -3/2, so it is below {bound}": below and bound == stated[1],
        }
    )


def _m2_sign(stated: int) -> Check:
    """Sign of v after q o p^{-1} on the image of the m2 line, where v > 0 before."""
    ray = _ray(sympy.Integer(0), HALF)["v"]
    root = sympy.Poly(fold.fixed_point_factors()[1].subs(r, HALF), m).nroots(n=8)[1]
    before = fold.gamma_leading().subs({m: root, fold.k: 1})
    after = sympy.N(_q_velocity(root) / 2, 20)
    return every(
        {
            "p and q map the line onto one parabola": _same_parabola(),
            "on which v > 0 for k > 0, before and after": ray == stated and positive_on(_q_velocity(m), m, 0, HALF),
        },
        witness=lambda: {"r": "1/2", "k": "1", "m2": str(root), "v before": str(before), "v after": str(after)},
    )


def _q_velocity(root: sympy.Expr) -> Any:
    """v over k r on q's image of (sigma, eta) = (1, root)."""
    _, second = fold.phi()
    return sympy.expand(-second.subs({sigma: 1, t: root - THREE_HALVES}) / fold.k)


def ray_m3(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """On the m3 ray v > 0 and p, q agree in orientation; m3 grows from stated[0] to stated[1] with r."""
    low, high = stated
    rule = fold.r_of_m()
    return every(
        {
            "v > 0 and the same orientation on the ray": _ray(low, high) == {"v": 1, "orientation": 1},
            "t = (m - 3/2) sigma > 0 for sigma < 0": positive_on(THREE_HALVES - m, m, low, high),
            "r(m) increases on the interval": positive_on(sympy.diff(rule, m), m, low, high),
            "from 0 to 1": value_at(rule, m, low) == 0 and value_at(rule, m, high) == 1,
        }
    )


RAYS = {
    "s4-m1": Encoding((-1, -1), _line(-sympy.oo, -THREE_HALVES), ((1, -1), (-1, 1))),
    "s4-m1-gradient": Encoding((m - THREE_HALVES, -3), _gradient, ((m + THREE_HALVES, -3), (m - THREE_HALVES, -2))),
    "s4-m2": Encoding((-1, 1), _line(sympy.Integer(0), HALF), ((1, 1),)),
    "s4-m2-sign": Encoding(-1, _m2_sign, (0,), lambda: 1),
    "s4-m3": Encoding((HALF, THREE_HALVES), ray_m3, ((HALF, sympy.Integer(2)), (sympy.Integer(0), THREE_HALVES))),
}


_ON_FORM3 = (2 * m + 3) ** 2 / (8 * m**2 * (2 * m - 1))
_FORM1 = (HALF / (m - HALF) * (r * (4 * m - 3) + sympy.Rational(9, 2) * (m - HALF)) - Q / (m - HALF) ** 2) / sympy.sqrt(
    Q
)
_FORM2 = r * (2 * m + 3) / (2 * m - 1) ** 2 / sympy.sqrt(Q)


def _N_r(stated: sympy.Expr, derived: Callable[[], sympy.Expr] = fold.N_r) -> Check:
    return identity(derived, "derived by differentiating m'")(stated.subs(Q, fold.Q_at_one()))


def _N_r_form(stated: tuple[sympy.Expr, str]) -> Check:
    """N_r at the solutions of e:fixm: on the cubic with m (m - 1/2) > 0, and in "all" of them, m2 and 3/2 too."""
    formula, where = stated
    check = identity(fold.N_r_at_fixed_points, "derived on the cubic with m (m - 1/2) > 0")(formula)
    trivial, at = fold.in_root(fold.N_r_collected()), {m: THREE_HALVES, fold.w: THREE_HALVES}
    is_r = agree(trivial, at, r) and agree(fold.Q_at_one(), {m: THREE_HALVES}, THREE_HALVES**2)
    covers = where == "m1, m3" or formula.subs(m, THREE_HALVES) == r
    return every(
        [
            check,
            (
                "at m = 3/2 N_r is r, the formula gives 1" if where == "all" else "m1 and m3 have m (m - 1/2) > 0",
                is_r and covers and sign_chain(CUBIC - 2 * r * m, ROOT_SIGNS),
            ),
        ],
        witness=lambda: {
            "r": "1/2",
            "m": "3/2",
            "N_r": str(sympy.cancel(trivial.subs(at | {r: HALF}))),
            "formula": str(formula.subs(m, THREE_HALVES)),
        },
    )


def _jacobian(stated: sympy.MatrixBase) -> Check:
    """The first row of Dh'(0, m) and the entry below the diagonal's end; * is not tested, it depends on O(3)."""
    derived = fold.Dh_blown_up()
    return identity(lambda: (derived[0, 0], derived[0, 1], derived[1, 1]))(
        (stated[0, 0], stated[0, 1], stated[1, 1].subs(Q, fold.Q_at_one()))
    )


def _saddle(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """Limits of (lambda, mu) as r -> 0 and as r -> 1, and 0 < lambda < 1 < mu for every r in (0, 1)."""
    rate, _ = fold.h_blown_up()
    multiplier = fold.N_r_at_fixed_points()
    ends = tuple(value_at(eigenvalue, m, end) for end in (HALF, THREE_HALVES) for eigenvalue in (rate, multiplier))
    return every(
        {
            "m3 in (1/2, 3/2) runs once through r in (0, 1)": ray_m3((HALF, THREE_HALVES)).holds,
            "0 < lambda < 1": positive_on(rate, m, HALF, THREE_HALVES) and positive_on(1 - rate, m, HALF, THREE_HALVES),
            "mu > 1": positive_on(multiplier - 1, m, HALF, THREE_HALVES),
            f"limits {ends[0]}, {ends[1]} as r -> 0 and {ends[2]}, {ends[3]} as r -> 1": ends == stated,
        }
    )


def _direction(stated: tuple[int, int]) -> Check:
    """The eigenvector of Dh'(0, m3) for mu, whatever * is."""
    matrix = sympy.Matrix([list(fold.Dh_blown_up().row(0)), sympy.symbols("star mu")])
    return every({"Dh' v = mu v for the direction stated, for any *": is_eigenvector(matrix, matrix[1, 1], stated)})


def _tangent(stated: tuple[sympy.Expr, int]) -> Check:
    """chi(W^s) = {(s, s m(s))}, m(0) = m3: its tangent at 0 has slope m3, and eta has the sign of sigma."""
    slope, sign = stated
    s, start, bend = sympy.symbols("s m_3 c")
    derived = sympy.diff(s * (start + bend * s), s).subs(s, 0)  # eta = s m(s) with m(s) = m_3 + c s + ...
    value = sympy.Poly(fold.fixed_point_factors()[1].subs(r, HALF), m).nroots(n=20)[2]
    return every(
        {
            "the tangent at the origin has slope m(0) = m3 in (1/2, 3/2)": slope == derived,
            "for sigma < 0 the sign of eta = m sigma is -": positive_on(m, m, HALF, THREE_HALVES) and sign == -1,
        },
        witness=lambda: {"r": "1/2", "slope of the tangent": str(value), "stated slope": str(slope)},
    )


MULTIPLIERS = {
    "s4-Dh-form": Encoding(
        sympy.Matrix([[m - HALF, 0], [0, _FORM2]]),
        _jacobian,
        (
            sympy.Matrix([[m + HALF, 0], [0, _FORM2]]),
            sympy.Matrix([[m - HALF, 0], [0, -_FORM2]]),
            sympy.Matrix([[m - HALF, 1], [0, _FORM2]]),
        ),
    ),
    "s4-Nr-2": Encoding(
        _FORM2,
        lambda stated: _N_r(stated, fold.N_r_collected),
        (r * (2 * m - 3) / (2 * m - 1) ** 2 / sympy.sqrt(Q), r * (2 * m + 3) / (2 * m - 1) / sympy.sqrt(Q)),
    ),
    "s4-Nr-1": Encoding(_FORM1, _N_r, (-_FORM1, _FORM1 + 2 * sympy.sqrt(Q) / (m - HALF) ** 2)),
    "s4-Nr-3-all": Encoding(
        (_ON_FORM3, "all"),
        _N_r_form,
        ((-_ON_FORM3, "all"), (-_ON_FORM3, "m1, m3")),
        lambda: Statement(
            f"N_r(m)={latex(fold.N_r_at_fixed_points())}\\ \\text{{at the roots of the cubic with}}\\ m(m-\\tfrac12)>0",
            (fold.N_r_at_fixed_points(), "m1, m3"),
        ),
    ),
    "s4-Nr-3": Encoding(
        _ON_FORM3,
        identity(fold.N_r_at_fixed_points, "derived on the cubic with m (m - 1/2) > 0"),
        (_ON_FORM3 / 2, (2 * m - 3) ** 2 / (8 * m**2 * (2 * m - 1))),
    ),
    "s4-saddle-m3": Encoding(
        (sympy.Integer(0), sympy.zoo, sympy.Integer(1), sympy.Integer(1)),
        _saddle,
        (
            (sympy.Integer(0), sympy.Integer(1), sympy.Integer(1), sympy.Integer(1)),
            (sympy.Integer(1), sympy.zoo, sympy.Integer(0), sympy.Integer(1)),
        ),
    ),
    "s4-mu-direction": Encoding((0, 1), _direction, ((1, 0), (1, 1))),
    "s4-beta-tangent": Encoding(
        (sympy.Integer(0), 1),
        _tangent,
        ((sympy.Integer(0), -1), (sympy.Symbol("m_3"), 1)),
        lambda: (sympy.Symbol("m_3"), -1),
    ),
}

CLAIMS = RAYS | MULTIPLIERS
