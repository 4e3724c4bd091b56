"""Section 4.1(a): the discontinuity arc P_* and the theorem on the invariant arc gamma at a tangency with a' > 0."""

from collections.abc import Callable
from typing import Any

import sympy

from singimpact.algebra.certificates import negative_in, negative_on, positive_on, value_at
from singimpact.paper.claims.claim import Check, Encoding, Statement
from singimpact.paper.claims.sections import section4_orbits as orbits
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS
from singimpact.paper.claims.sections.section4a_blowup import HALF, THREE_HALVES
from singimpact.paper.claims.verifiers import agree, every, is_zero, same
from singimpact.paper.routes import fold, implicit as route
from singimpact.paper.routes.fold import m
from singimpact.paper.routes.implicit import a_symbol, t, v
from singimpact.paper.trials import arcs, true_orbits
from singimpact.theory import DG_on_ray, eigenvalues_on_gamma, lambda_, latex, leading_coefficient, r_of_lambda

REACHED = 1e-3  # relative error to which DOP853 finds a leading coefficient of gamma: double precision near Pi_0


def _discontinuity(stated: tuple[sympy.Expr, int]) -> Check:
    """Where the low-velocity first hit jumps: v = coefficient a' sigma^2 on one side of tau_*, found and proved.

    At each sigma < 0 v_c(sigma, .) rises from 0 to its value on the horizon and falls after it, so a launch below P_* hits
    while v_c still rises, smoothly in the launch, and one above P_* has no low-velocity hit.  For sigma > 0 v_c < 0.
    """
    coefficient, side = stated
    launch, line = fold.p()[1], fold.horizon()[0]
    slope = sympy.expand(sympy.diff(launch, t) / fold.k)
    turned = sympy.cancel(slope / (line - t))  # > 0: v_c rises before the horizon and falls after it
    at_horizon = sympy.cancel(fold.horizon()[1] / (6 * fold.k * route.sigma**2))
    jump = agree(launch, {t: line}, 6 * fold.k * coefficient * route.sigma**2)
    behind = negative_in(launch / fold.k, {route.sigma: (0, sympy.oo), t: (0, sympy.oo)})

    return every(
        [
            (
                f"for sigma < 0 v_c rises up to t = {line} and falls after it, to first order, with v = {at_horizon} a' sigma^2 there",
                turned.is_positive and jump and side == -1,
            ),
            ("for sigma >= 0 v_c < 0 for t > 0: no low-velocity hit there, and no jump", behind),
        ]
    )


def _exists(stated: tuple[int, int, sympy.Expr]) -> Check:
    """(power, side, bound of C/a'): a hyperbolic saddle for every r, and gamma on true orbits; the bound is that of P_*."""
    power, side, bound = stated
    coefficient = leading_coefficient(1)  # beside a' sigma^2
    rate = r_of_lambda(1)
    jump = sympy.cancel(fold.horizon()[1] / (6 * fold.k * route.sigma**2))  # of P_*, beside a' sigma^2 too
    ends = tuple(value_at(coefficient, lambda_, end) for end in (0, 1))
    transverse = 1 - fold.N_r_at_fixed_points().subs(m, lambda_ + HALF)  # 1 - mu, lambda = m3 - 1/2
    return every(
        [
            (
                "h' has a hyperbolic saddle on s = 0 for every r in (0, 1)",
                _interval_map(rate) and negative_on(transverse, lambda_, 0, 1),
            ),
            *orbits.relation(1),
            *orbits.saddle(1),
            (
                f"gamma lies between Pi_0 and P_*: 0 < coefficient < {jump}",
                positive_on(coefficient, lambda_, 0, 1)
                and positive_on(jump - coefficient, lambda_, 0, 1)
                and bound == jump,
            ),
            (
                f"it falls from {ends[0]} to {ends[1]} as r grows from 0 to 1",
                negative_on(sympy.diff(coefficient, lambda_), lambda_, 0, 1) and ends == (sympy.Rational(1, 3), 0),
            ),
            ("quadratic, from sigma < 0", (power, side) == (2, -1)),
        ],
        modulo=(orbits.STABLE,),
        tried=lambda: on_gamma(1),
    )


def _interval_map(rate: sympy.Expr) -> bool:
    """lambda -> r is an increasing bijection of (0, 1) onto itself, so "every r" is "every lambda"."""
    ends = (value_at(rate, lambda_, 0), value_at(rate, lambda_, 1))
    return ends == (0, 1) and positive_on(sympy.diff(rate, lambda_), lambda_, 0, 1)


def _unique(stated: tuple[Any, int]) -> Check:
    """The number of invariant arcs that end at w_* in a region v > 0 or v >= 0: gamma, and Pi_0 where it is included."""
    region, count = stated
    cubic = fold.fixed_point_factors()[1]
    inside = [fold.r_of_m().subs(m, end) for end in (HALF, THREE_HALVES)]
    one = (
        inside == [0, 1]
        and positive_on(sympy.diff(fold.r_of_m(), m), m, HALF, THREE_HALVES)
        and sympy.degree(cubic, m) == 3
    )
    with_axis = bool(region.subs(v, 0)) and is_zero(fold.fixed_point_equation().subs(m, THREE_HALVES))
    arc_count = int(bool(region.subs(v, 1))) + int(with_axis)
    return every(
        [
            ("exactly one fixed ray m3 in (1/2, 3/2) for every r in (0, 1)", one),
            *orbits.before(1),
            (
                f"so a point off gamma with v > 0 comes to rest or loses contact, and lies on no invariant arc with v > 0; {orbits.after(1)[1][0]}",
                orbits.after(1)[0] == "lost",
            ),
            (
                f"{arc_count} such arcs: gamma{' and Pi_0 (the ray m = 3/2, points at rest)' if with_axis else ''}; stated: {count}",
                arc_count == count,
            ),
        ],
        modulo=(orbits.STABLE,),
        witness=lambda: {"arc": "{v = 0, tau < tau_*}", "v": "0", "invariant arcs found": str(arc_count)},
    )


def _attracting(stated: tuple[int, int]) -> Check:
    """On gamma sigma -> lambda sigma + ..., and lambda lies in the stated interval for every r in (0, 1)."""
    low, high = stated
    return every(
        {
            "lambda = m3 - 1/2 runs through (0, 1) as r does": _interval_map(r_of_lambda(1)) and (low, high) == (0, 1),
            "it is the rate of h' at m3": agree(fold.r_of_m(), {m: lambda_ + HALF}, r_of_lambda(1)),
        },
        tried=lambda: rate_on_gamma(1),
    )


def repelling(j: int) -> Callable[[int], Check]:
    """A verifier of the number of eigenvalues > 1 of DG at points of gamma, in the limit at a contact of order j.

    There is one, whose direction is not gamma's.
    """

    def verify(stated: int) -> Check:
        matrix = DG_on_ray(j)
        at_one = sympy.cancel(1 - matrix.trace() + matrix.det())
        slope = (j + 1) * leading_coefficient(j)  # tangent of gamma at sigma = 1, in units of a^(j)/j!
        image = matrix * sympy.Matrix([1, slope])
        turned = sympy.cancel(image[0] * slope - image[1])
        off = positive_on(turned, lambda_, 0, 1) or negative_on(turned, lambda_, 0, 1)
        count = 1 if negative_on(at_one, lambda_, 0, 1) and positive_on(matrix.det(), lambda_, 0, 1) else 0
        return every(
            [
                *orbits.limit_of_DG(j),
                (
                    "the characteristic polynomial is negative at 1 and positive at 0 and at infinity for every r in (0, 1)",
                    count == 1 and _interval_map(r_of_lambda(j)),
                ),
                ("so one eigenvalue is > 1", count == stated),
                ("the tangent of gamma is no eigenvector, so its direction is transverse", off),
            ]
        )

    return verify


def _at_rest(stated: sympy.Expr) -> Check:
    """x_c - c on the motion from (tau_*, 0), to third order in t: 0 if w_* is fixed; a' t^3/6 lifts off."""
    leading = sympy.expand(t * route.at_contact(route.y_c(2), 1).subs({route.sigma: 0, route.v: 0}))
    return every(
        {f"from w_* x_c - c = {leading} + ..., above 0 for a' > 0; stated: {stated}": same(leading, stated)},
        tried=lambda: (
            "first hit from (tau_*, 0) after {1:.6f} ({0}): F(w_*) is not w_*".format(*arcs.lift_off()[0]),
            all(time > 0.5 for _, time in arcs.lift_off()),
        ),
        witness=lambda: {
            "model": arcs.lift_off()[0][0],
            "v": "0",
            "flight time from (tau_*, 0)": f"{arcs.lift_off()[0][1]:.12g}",
        },
    )


def _sides(stated: tuple[str, str]) -> Check:
    """(below, above) gamma: "chatter" to rest before tau_*, or "lost" contact after finitely many impacts."""
    behind, reason = orbits.after(1)
    proved = ("chatter", behind) if orbits.drift(1) == 1 else (behind, "chatter")
    return every([*orbits.before(1), (reason[0], reason[1] and proved == stated)], modulo=(orbits.STABLE,))


def above_one(stated: sympy.Expr, j: int) -> bool:
    """Whether a root of the characteristic polynomial of DG on gamma is the larger one: 1 is no root for any r."""
    matrix = DG_on_ray(j)
    at_one = sympy.cancel(1 - matrix.trace() + matrix.det())
    return negative_on(at_one, lambda_, 0, 1) and bool(stated.subs(lambda_, HALF) > 1)


def _limit(stated: sympy.Expr) -> Check:
    """The eigenvalue > 1 of DG(w) in the limit along gamma, as a function of lambda."""
    matrix = DG_on_ray(1)
    residual = stated**2 - matrix.trace() * stated + matrix.det()
    larger = eigenvalues_on_gamma(1)[0]

    def trial() -> tuple[str, bool]:
        cases = arcs.eigenvalues()
        values = [float(sympy.N(stated.subs(lambda_, true_orbits.lambda_of(case.r, 1)))) for case in cases]
        worst = max(abs(case.found / value - 1) for case, value in zip(cases, values, strict=True))
        name = (
            f"true orbits give {cases[0].found:.8f} at r = {cases[0].r} ({cases[0].name}), the statement is off by "
            f"{worst:.0e}"
        )
        return name, worst < REACHED

    return every(
        {
            "it is a root of the characteristic polynomial of DG on gamma for every r": is_zero(residual),
            "and the one above 1: so it is at lambda = 1/2, and no root passes 1": above_one(stated, 1),
        },
        tried=trial,
        witness=lambda: {
            "r": "1/2",
            "limit of the eigenvalue": str(sympy.N(larger.subs(lambda_, _lambda_half()), 20)),
            "found on true orbits": f"{arcs.eigenvalues()[0].found:.8f}",
        },
    )


def limit_in_words(j: int) -> str:
    """The limit of the eigenvalue as the larger root of the characteristic polynomial; trace and determinant by lambda."""
    matrix = DG_on_ray(j)
    larger = eigenvalues_on_gamma(j)[0]
    if not is_zero(larger**2 - matrix.trace() * larger + matrix.det()):
        raise ArithmeticError("the eigenvalue is no root of the characteristic polynomial")
    trace, determinant = (latex(sympy.factor(invariant)) for invariant in (matrix.trace(), matrix.det()))
    return (
        r"\lim_{w\to w_*,\,w\in\gamma}\Lambda(w)>1,\ \text{the larger root of}\ \Lambda^2-T\Lambda+D=0,\ "
        rf"T={trace},\ D={determinant}"
    )


def _lambda_half() -> Any:
    equation = sympy.Poly(sympy.fraction(sympy.together(r_of_lambda(1) - HALF))[0], lambda_)
    return next(root for root in equation.nroots(n=30) if 0 < root < 1)


def on_gamma(j: int) -> tuple[str, bool]:
    """A trial: the leading coefficient of gamma at contact order j on true orbits."""
    cases = true_orbits.gamma_cases(j)
    worst = max(case.error for case in cases)
    return f"on true orbits {cases[0].line()}; worst relative error {worst:.0e}", worst < REACHED


def rate_on_gamma(j: int) -> tuple[str, bool]:
    """A trial: sigma'/sigma of true orbits along gamma, against its limit lambda."""
    worst = max(abs(case.ratio / case.multiplier - 1) for case in true_orbits.gamma_cases(j))
    return f"sigma'/sigma on true orbits agrees to {worst:.0e}", worst < REACHED


CLAIMS = {
    "s4-P-star": Encoding(
        (sympy.Rational(3, 8), -1), _discontinuity, ((sympy.Rational(3, 8), 1), (sympy.Rational(1, 4), -1))
    ),
    "t:t2-exists": Encoding(
        (2, -1, sympy.Rational(3, 8)),
        _exists,
        (
            (3, -1, sympy.Rational(3, 8)),
            (2, 1, sympy.Rational(3, 8)),
            (2, -1, sympy.Rational(5, 8)),
            (2, -1, sympy.Rational(1, 3)),
        ),
    ),
    "t:t2-smooth": Encoding(sympy.oo, orbits.smooth(1), (sympy.Integer(2), sympy.Integer(3))),
    "t:t2-unique": Encoding((v >= 0, 1), _unique, ((v > 0, 2), (v > 0, 0)), lambda: (v > 0, 1)),
    "t:t2-attracting": Encoding((0, 1), _attracting, ((1, 2), (0, 2))),
    "t:t2-repelling": Encoding(1, repelling(1), (0, 2)),
    "t:t2-fixed": Encoding(
        sympy.Integer(0), _at_rest, (-a_symbol(1) * t**3 / 6, a_symbol(1) * t**3 / 2), lambda: a_symbol(1) * t**3 / 6
    ),
    "t:t2-sides": Encoding(("chatter", "lost"), _sides, (("lost", "chatter"), ("chatter", "chatter"))),
    "t:t2-eigenvalue-limit": Encoding(
        sympy.Integer(1),
        _limit,
        (sympy.Integer(2), lambda_, eigenvalues_on_gamma(1)[1]),
        lambda: Statement(limit_in_words(1), eigenvalues_on_gamma(1)[0]),
    ),
}
