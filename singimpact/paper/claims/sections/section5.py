"""Section 5: swan points, a = a' = 0, a'' != 0."""

from typing import Any

import sympy

from singimpact.algebra.certificates import definite, negative_on, positive_on, value_at
from singimpact.paper.claims.claim import Check, Encoding, Statement
from singimpact.paper.claims.sections import section4_orbits as orbits
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS
from singimpact.paper.claims.sections.section4a_arc import above_one, limit_in_words, on_gamma, rate_on_gamma, repelling
from singimpact.paper.claims.verifiers import agree, every, identity, is_zero
from singimpact.paper.routes import swan
from singimpact.paper.routes.implicit import r, v
from singimpact.paper.trials import arcs, true_orbits
from singimpact.theory import DG_on_ray, eigenvalues_on_gamma, generic_sheet, lambda_, leading_coefficient, r_of_lambda

m, s, ell, mbar = swan.m, swan.s, swan.ell, swan.mbar
a2, sigma, t = sympy.symbols("a_d2 sigma t")
HALF = sympy.Rational(1, 2)
REACHED = 1e-3  # as in section 4(a)


def _sheet(which: str) -> Any:
    sheet = generic_sheet(2, 3)
    return sheet.to_sympy(sheet.v if which == "p" else sheet.xdot).subs(a2, -24 * ell)


def _p(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """p in (s, m) by the boundary value route with a = a' = 0 set first, and by the paper's own."""
    velocity = _sheet("p").subs({sigma: s, t: s * m})
    return every(
        [
            identity(lambda: (s, velocity), "the solution of the boundary value problem")(stated),
            identity(lambda: (s * swan.p_blown_up()[0], ell * s**3 * swan.p_blown_up()[1]))(stated),
        ]
    )


def _phi(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """phi in (s, m): the time of landing, and its velocity from the solution of the boundary value problem."""
    ray = {sigma: s, t: s * m}
    return every(
        {
            "it lands at sigma + t": agree(sigma + t, ray, stated[0]),
            "with the launch velocity after the involution": agree(_sheet("phi"), ray, stated[1]),
        }
    )


def _coordinates(time: sympy.Expr) -> Check:
    """e:pdeg3 and s5-phi hold when the flight time is `time` in (s, m)."""
    launch = sympy.expand(_sheet("p").subs({sigma: s, t: time}))
    impact = sympy.expand(_sheet("phi").subs({sigma: s, t: time}))
    stated = (ell * s**3 * swan.p_blown_up()[1], ell * s**3 * swan.phi_blown_up()[1])
    point = {s: 1, m: -HALF, ell: 1}
    return every(
        {
            "p has the printed form": is_zero(launch - stated[0]),
            "phi has the printed form": is_zero(impact - stated[1]),
        },
        witness=lambda: {
            "s": "1",
            "m": "-1/2",
            "ell": "1",
            "t": str(time.subs(point)),
            "v of p": str(launch.subs(point)),
            "printed": str(stated[0].subs(point)),
        },
    )


def _intersections(count: int) -> Check:
    """Common points of f and g with m real: m = 0, which is Pi_0, and one in (-1, 0)."""
    zero = is_zero(swan.h_bar().subs({m: 0, mbar: 0}))
    rule = swan.r_of_m()
    one = value_at(rule, m, -1) == 0 and value_at(rule, m, 0) == 1 and positive_on(sympy.diff(rule, m), m, -1, 0)
    beyond = positive_on(rule - 1, m, 0, sympy.oo) and negative_on(rule, m, -sympy.oo, -1)
    return every(
        {
            "r(m) rises from 0 to 1 on (-1, 0): one common point there for every r in (0, 1)": one,
            "r(m) > 1 for m > 0 and r(m) < 0 for m < -1: none there": beyond,
            "f(0) = g(0) = 0: m = 0, the axis Pi_0, is another" if zero else "f(0) != g(0)": count == 1 + int(zero),
        },
        witness=lambda: {"m": "0", "f": str(swan.f_map().subs(m, 0)), "g": str(swan.g_map().subs(m, 0))},
    )


def _place(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    low, high = stated
    rule = swan.r_of_m()
    return every(
        [
            (
                "r(m) is an increasing bijection of the interval onto (0, 1)",
                value_at(rule, m, low) == 0
                and value_at(rule, m, high) == 1
                and positive_on(sympy.diff(rule, m), m, low, high),
            ),
            (
                "none elsewhere: r(m) < 0 for m < -1, 0 at -1, and > 1 for m > 0",
                negative_on(rule, m, -sympy.oo, -1)
                and value_at(rule, m, -1) == 0
                and positive_on(rule - 1, m, 0, sympy.oo),
            ),
        ]
    )


def _slopes(sign: int) -> Check:
    """f'(m_*) - g'(m_*) with r eliminated, on (-1, 0)."""
    difference = sympy.cancel((sympy.diff(swan.f_map(), m) - sympy.diff(swan.g_map(), m)).subs(r, swan.r_of_m()))
    found = 1 if positive_on(difference, m, -1, 0) else -1 if negative_on(difference, m, -1, 0) else 0
    return every({"f' - g' at m_* keeps one sign on (-1, 0), that is for every r in (0, 1)": found == sign})


def _jacobian(stated: sympy.MatrixBase) -> Check:
    """The entries but *, each as derived: d(mbar)/dm by implicit differentiation of s5-hbar."""
    derived = swan.Dh_bar()
    return identity(
        lambda: (derived[0, 0], derived[0, 1], derived[1, 1]), "the derivative of h-bar at its fixed point"
    )((stated[0, 0], stated[0, 1], stated[1, 1]))


def _saddle(stated: tuple[int, int]) -> Check:
    """Number of multipliers in (0, 1) and above 1 at (0, m_*), and the m-axis is invariant with the larger one."""
    rate, multiplier = swan.Dh_bar()[0, 0], swan.mu_of_m()
    inside = int(positive_on(rate, m, -1, 0) and positive_on(1 - rate, m, -1, 0))
    above = int(positive_on(multiplier - 1, m, -1, 0))
    return every(
        {
            "1 + m_* in (0, 1) and f'/g' > 1 for every r in (0, 1)": (inside, above) == stated,
            "s' = (1 + m) s, so s = 0 is invariant, and carries f'/g'": swan.Dh_bar()[0, 1] == 0,
        }
    )


def _positive_slope(sign: int) -> Check:
    """dv_c/dt = -(a''/24)(6 sigma^2 + 8 sigma t + 3 t^2): the form is definite."""
    leading = sympy.expand(sympy.diff(swan_velocity(), t) / (-a2 / 24))
    return every(
        [
            (
                f"dv_c/dt = -(a''/24)({leading}) + ..., a definite form, so > 0 off w_* for a'' < 0",
                definite(leading, sigma, t) == 1 and sign == 1,
            )
        ]
    )


def swan_velocity() -> Any:
    """v_c at a swan to third order."""
    sheet = generic_sheet(2, 3)
    return sheet.to_sympy(sheet.v)


def _smoothness(stated: int) -> Check:
    """The power of t in v on sigma = 0: F is smooth at w_* where it is 1.

    v_c grows with t for every sigma, so F is one to one and continuous; it is smooth where dv_c/dt > 0, off w_*.
    """
    cubic = -a2 * t**3 / 24
    power = min(degree for (degree,) in sympy.Poly(cubic, t).monoms())
    growing = _positive_slope(1).holds
    return every(
        [
            (
                f"on sigma = 0 v = {cubic} + ..., so t ~ v^(1/{power}) and dt/dv is unbounded at w_*",
                agree(swan_velocity(), {sigma: 0}, cubic) and power == stated,
            ),
            ("v_c grows with t near w_*, strictly off w_*: F is continuous there, and smooth elsewhere", growing),
        ],
        tried=lambda: (f"true flights: t ~ v^{arcs.cube_root():.4f} as v -> 0", abs(arcs.cube_root() - 1 / 3) < 1e-2),
        witness=lambda: {
            "sigma": "0",
            "exponent of v in the flight time": f"{arcs.cube_root():.4f}",
            "needed for a smooth F": "1",
        },
    )


def _unique(stated: tuple[Any, int]) -> Check:
    """The number of invariant arcs that end at a swan in a region v > 0 or v >= 0: gamma, and Pi_0 where it is included."""
    region, count = stated
    one = _place((sympy.Integer(-1), sympy.Integer(0))).holds and _saddle((1, 1)).holds
    with_axis = bool(region.subs(v, 0)) and is_zero(swan.h_bar().subs({m: 0, mbar: 0}))
    arcs = int(bool(region.subs(v, 1))) + int(with_axis)
    return every(
        [
            ("one fixed m_* in (-1, 0) for every r in (0, 1), a hyperbolic saddle", one),
            *orbits.before(2),
            (
                "so a point off gamma with v > 0 comes to rest on Pi_0, and lies on no invariant arc with v > 0; "
                + orbits.after(2)[1][0],
                orbits.after(2) == ("chatter", orbits.after(2)[1]) and orbits.after(2)[1][1],
            ),
            (f"{arcs} such arcs: gamma{' and Pi_0 (m = 0)' if with_axis else ''}; stated: {count}", arcs == count),
        ],
        modulo=(orbits.STABLE,),
        witness=lambda: {"arc": "{v = 0, tau < tau_*}", "v": "0", "invariant arcs found": str(arcs)},
    )


def _exists(stated: tuple[int, int]) -> Check:
    """gamma at a swan with a'' < 0: cubic tangency, from sigma < 0, v > 0."""
    power, side = stated
    sign = negative_on(
        -leading_coefficient(2), lambda_, 0, 1
    )  # v = (a''/2) coefficient sigma^3 > 0 for a'' < 0, sigma < 0
    return every(
        [
            ("h-bar has a hyperbolic saddle for every r in (0, 1)", _saddle((1, 1)).holds),
            *orbits.relation(2),
            *orbits.saddle(2),
            ("v ~ sigma^3 > 0 for sigma < 0", sign and (power, side) == (3, -1)),
        ],
        modulo=(orbits.STABLE,),
        tried=lambda: on_gamma(2),
    )


def _attracting(stated: tuple[int, int]) -> Check:
    """On gamma sigma -> lambda sigma + ..., lambda = 1 + m_*, and it lies in the stated interval for every r in (0, 1)."""
    low, high = stated
    growth = swan.phi_blown_up()[0]
    agree = is_zero(swan.r_of_m().subs(m, lambda_ - 1) - r_of_lambda(2))
    ends = tuple(value_at(growth, m, end) for end in (-1, 0))
    return every(
        [
            (
                f"sigma' = {growth} sigma on gamma, from {ends[0]} to {ends[1]} as m_* runs through (-1, 0)",
                ends == (low, high) and positive_on(sympy.diff(growth, m), m, -1, 0),
            ),
            ("lambda = 1 + m_* solves r = lambda^3 P_2/Q_2 of the homogeneous model", agree),
        ],
        tried=lambda: rate_on_gamma(2),
    )


def _limit(stated: sympy.Expr) -> Check:
    """The limit of that eigenvalue along gamma, as a function of lambda."""
    matrix = DG_on_ray(2)
    residual = stated**2 - matrix.trace() * stated + matrix.det()

    def trial() -> tuple[str, bool]:
        _, orbit = arcs.eigenvalue()
        value = float(sympy.N(stated.subs(lambda_, true_orbits.lambda_of(0.5, 2))))
        return f"true orbits give {orbit:.6f} at r = 1/2, the statement {value:.6f}", abs(orbit / value - 1) < REACHED

    return every(
        {
            "it is a root of the characteristic polynomial of DG on gamma for every r": is_zero(residual),
            "and the one above 1: so it is at lambda = 1/2, and no root passes 1": above_one(stated, 2),
        },
        tried=trial,
        witness=lambda: {
            "r": "1/2",
            "limit of the eigenvalue": f"{arcs.eigenvalue()[0]:.15f}",
            "found on true orbits": f"{arcs.eigenvalue()[1]:.6f}",
        },
    )


def _others(stated: str) -> Check:
    """Fates of launches near a swan with a'' < 0, below and above gamma: "chatter", or contact is "lost"."""
    behind, reason = orbits.after(2)
    below = "chatter" if orbits.drift(2) == 1 else behind
    return every([*orbits.before(2), (reason[0], reason[1] and {below, behind} == {stated})], modulo=(orbits.STABLE,))


def _no_impacts(stated: int) -> Check:
    """v_c = -(a''/24) t (6 sigma^2 + 4 sigma t + t^2): the form is definite, so v_c < 0 for t > 0, a'' > 0."""
    leading = sympy.expand(sympy.cancel(swan_velocity() / (-a2 * t / 24)))
    discriminant = sympy.discriminant(leading.subs(sigma, 1), t)
    return every(
        [
            (
                f"v_c = -(a''/24) t ({leading}) + ..., discriminant {discriminant} < 0: negative for t > 0, a'' > 0",
                definite(leading, sigma, t) == 1 and stated == -1,
            )
        ]
    )


_LAUNCH, _IMPACT = 6 * m + 4 * m**2 + m**3, 6 * m + 8 * m**2 + 3 * m**3
_STAR = sympy.Symbol("*")
_SLOPE = sympy.diff(r * _IMPACT / (1 + m) ** 3, m) / sympy.diff(_LAUNCH, m)

CLAIMS = {
    "s5-coordinates": Encoding(s * m - 3 * s / 2, _coordinates, (s * m + 3 * s / 2, -s * m), lambda: s * m),
    "e:pdeg3": Encoding(
        (s, ell * s**3 * _LAUNCH), _p, ((s, -ell * s**3 * _LAUNCH), (s, ell * s**3 * (6 * m + 8 * m**2 + m**3)))
    ),
    "s5-phi": Encoding(
        (s * (1 + m), -ell * s**3 * _IMPACT),
        _phi,
        ((s * (1 + m), ell * s**3 * _IMPACT), (s * (1 + m), -ell * s**3 * _LAUNCH)),
    ),
    "s5-hbar": Encoding(
        r * _IMPACT - (1 + m) ** 3 * _LAUNCH.subs(m, mbar),
        identity(swan.h_bar),
        (r * _IMPACT - (1 + m) ** 2 * _LAUNCH.subs(m, mbar), -r * _IMPACT - (1 + m) ** 3 * _LAUNCH.subs(m, mbar)),
    ),
    "s5-unique": Encoding(1, _intersections, (0, 3), lambda: 2),
    "s5-mstar-place": Encoding(
        (sympy.Integer(-1), sympy.Integer(0)), _place, ((-HALF, sympy.Integer(0)), (sympy.Integer(0), sympy.Integer(1)))
    ),
    "s5-slopes": Encoding(1, _slopes, (-1, 0)),
    "s5-jacobian": Encoding(
        sympy.Matrix([[1 + m, 0], [_STAR, _SLOPE]]),
        _jacobian,
        (sympy.Matrix([[1 - m, 0], [_STAR, _SLOPE]]), sympy.Matrix([[1 + m, 0], [_STAR, 1 / _SLOPE]])),
    ),
    "s5-saddle": Encoding((1, 1), _saddle, ((2, 0), (0, 2))),
    "s5-vt-positive": Encoding(1, _positive_slope, (-1,)),
    "s5-F-smooth": Encoding(1, _smoothness, (2, 0), lambda: 3),
    "t:t3-unique": Encoding((v >= 0, 1), _unique, ((v > 0, 2), (v > 0, 0)), lambda: (v > 0, 1)),
    "t:t3": Encoding((3, -1), _exists, ((2, -1), (3, 1))),
    "t:t3-smooth": Encoding(sympy.oo, orbits.smooth(2), (sympy.Integer(2), sympy.Integer(3))),
    "t:t3-attracting": Encoding((0, 1), _attracting, ((1, 2), (0, 2))),
    "t:t3-repelling": Encoding(1, repelling(2), (0, 2)),
    "t:t3-eigenvalue-limit": Encoding(
        sympy.Integer(1),
        _limit,
        (sympy.Integer(2), lambda_, eigenvalues_on_gamma(2)[1]),
        lambda: Statement(limit_in_words(2), eigenvalues_on_gamma(2)[0]),
    ),
    "t:t3-others": Encoding("chatter", _others, ("lost",)),
    "s5-positive": Encoding(-1, _no_impacts, (1,)),
}
