"""Orbits near a tangency or swan point: the argument that t:t2, t:t3 and t:foliate share.

Each function returns the computed hypotheses of one step, as parts for `verifiers.every`.  The forms are exact leading
parts; what is left out is O(S) on a compact set of ratios, so that a strict inequality of the leading parts holds for
small S too.  Only the existence of gamma uses a theorem, `STABLE`.
"""

from collections.abc import Callable
from typing import Any

import sympy

from singimpact.algebra.certificates import negative_in, positive_in, positive_on
from singimpact.paper.claims.claim import Check
from singimpact.paper.claims.verifiers import agree, every, is_zero, same
from singimpact.paper.routes import ratios
from singimpact.paper.routes.implicit import sigma, t
from singimpact.paper.routes.ratios import l
from singimpact.theory.multipliers import DG_on_ray, P, Q, lambda_

STABLE = "the stable manifold theorem"
BEHIND = -sympy.Rational(1, 4)  # ratios down to it are used: next to gamma a landing may fall just behind tau_*
rho, t_2 = sympy.symbols("rho t_2")

Part = tuple[str, bool]


def positive_up_to_the_ends(expression: sympy.Expr, low: Any, high: int) -> bool:
    """Whether a polynomial in l is proved to be positive on a closed interval."""
    return positive_on(expression, l, low, high) and all(expression.subs(l, end) > 0 for end in (low, high))


def rises(j: int) -> bool:
    """Whether l^(j+1) P/Q rises strictly from 0 to 1 on [0, 1], by its logarithmic derivative times l."""
    launch, landing = ratios.reduced(j)
    slope = sympy.diff(launch, l) * landing - launch * sympy.diff(landing, l)
    rate = ratios.restitution_of_ratio(j)
    ends = (rate.subs(l, 0), rate.subs(l, 1)) == (0, 1)
    return ends and positive_up_to_the_ends(sympy.expand((j + 1) * launch * landing + l * slope), 0, 1)


def relation(j: int) -> list[Part]:
    """Signs of the forms of the flights between sigma = -S and -l S."""
    launch, landing = ratios.reduced(j)
    falls = same(sympy.diff(ratios.by_ratio(j).launch, l), -landing)
    closed_form = all(agree(form, {l: lambda_}, velocity) for form, velocity in ((launch, P(j)), (landing, Q(j))))
    return [
        (
            f"v_c(-S, (1-l)S) = b S^{j + 1} (1-l)(P + O(S)), impact speed b S^{j + 1} (1-l)(Q + O(S)), P = {launch}, "
            f"Q = {landing}, both > 0 for {BEHIND} <= l <= 1",
            closed_form and all(positive_up_to_the_ends(velocity, BEHIND, 1) for velocity in (launch, landing)),
        ),
        ("d((1-l)P)/dl = -Q < 0, so the first hit is the only root and depends smoothly on the launch", falls),
        (f"l^{j + 1} P/Q rises strictly from 0 to 1 on [0, 1]: one invariant ratio lambda for every r", rises(j)),
        (
            "P = Q at l = 1, so next to rest an impact multiplies flight times by r",
            same(launch.subs(l, 1), landing.subs(l, 1)),
        ),
    ]


def saddle(j: int) -> list[Part]:
    """The hypotheses of the stable manifold theorem at S = 0, l = lambda, for every r in (0, 1)."""
    factor = ratios.multiplier(j)
    return [
        (
            "(S, l) -> (l S, l1) is smooth near (0, lambda), since d((1-l)P)/dl = -Q is not 0 there, and leaves S = "
            "0 invariant",
            positive_up_to_the_ends(ratios.reduced(j).landing, BEHIND, 1),
        ),
        (
            f"its multipliers are lambda in (0, 1) and {factor} > 1 at l = lambda: a saddle, whose stable manifold "
            "is a smooth graph l = L(S), L(0) = lambda; gamma is v = b S^" + str(j + 1) + " (1-L)(P(L) + O(S)), "
            "smooth",
            positive_on(factor - 1, l, 0, 1) and rises(j),
        ),
    ]


def smooth(j: int) -> Callable[[Any], Check]:
    """A verifier of the least order at which gamma may fail to be differentiable at w_*: none.

    v = b S^(j+1) (1 - L)(P(L) + ...) with a smooth function L of S.
    """

    def verify(stated: sympy.Expr) -> Check:
        none = ("smooth of every order: no least order is left", stated == sympy.oo)
        shape = agree(ratios.by_ratio(j).launch, {l: lambda_}, (1 - lambda_) * P(j))
        form = (f"gamma is v = b S^{j + 1} ((1 - lambda) {P(j)} + O(S)), smooth in S", shape)
        return every([*relation(j), *saddle(j), form, none], modulo=(STABLE,))

    return verify


def limit_of_DG(j: int) -> list[Part]:
    """Check that DG on gamma, its entries scaled by powers of S, tends to the matrix of the homogeneous model.

    In (S, l) launch and landing are smooth, and G is the second after the inverse of the first.
    """
    point = {sigma: -1, t: 1 - l}
    launch, landing = ratios.forms(j)
    before = sympy.Matrix([sigma, launch]).jacobian([sigma, t]).subs(point)
    after = sympy.Matrix([sigma + t, ratios.restitution_of_ratio(j) * landing]).jacobian([sigma, t]).subs(point)
    limit, stated = after * before.inv(), DG_on_ray(j).subs(lambda_, l)
    agree = all(is_zero(one - other) for one, other in ((limit.trace(), stated.trace()), (limit.det(), stated.det())))
    return [
        (
            "launch and landing are S^j times smooth functions of (S, l), d launch/d l = -Q is not 0, so DG scaled "
            "by powers of S is the matrix of the homogeneous model plus O(S) on gamma",
            agree and positive_up_to_the_ends(ratios.reduced(j).landing, BEHIND, 1),
        )
    ]


def drift(j: int) -> int:
    """Sign of the change of q = (1 - l)/(1 - L(S)) above gamma, where q > 1: it grows there and falls below.

    With K = (1 - L(l S))/(1 - L(S)), m = 1 - (1 - l)K and H = l^(j+1) K P(m)/Q(l) - r + O(S), q falls in one impact
    where H > 0 and grows, or there is no further impact before tau_*, where H < 0.  At S = 0 K = 1, m = l and H is
    l^(j+1) P/Q - r; l dH/dl > 0 persists for small S on 0 <= l <= 1, and H = 0 on gamma itself.
    """
    return 1 if rises(j) else 0


def before(j: int) -> list[Part]:
    """Fates before tau_*: below gamma chatter is complete, above it the impacts before tau_* are finitely many."""
    return [
        (
            "q = (1-l)/(1-L(S)) is 1 on gamma, falls in each impact below it and grows above it: l d/dl (l^"
            f"{j + 1} P/Q) > 0 up to the ends, so for small S too",
            drift(j) == 1,
        ),
        (
            "below, q -> q_oo: q_oo > 0 and S -> 0 would make l -> lambda, q_oo = 1; so l -> 1, 1 - l falls by r in "
            "the end and S tends to a positive limit: complete chatter before tau_*, where a < 0",
            drift(j) == 1 and ratios.restitution_of_ratio(j).subs(l, 1) == 1,
        ),
        (
            "above, infinitely many impacts would make l -> lambda or l -> 0, where r Q > 0 = l P: there are "
            "finitely many",
            ratios.reduced(j).landing.subs(l, 0) > 0,
        ),
    ]


def shortening(j: int, side: int) -> list[Part]:
    """Each flight is at most rho < 1 times as long as the one before, any rho in (r, 1), for launches near tau_*.

    side 1 : launches at sigma >= 0, behind a swan point with a'' < 0.  side -1 : all launches near a tangency with
    a' < 0, which have 3 sigma + t >= 0.
    """
    launch, landing = (side * form for form in ratios.forms(j))
    u = sympy.Symbol("u")
    corner = {sigma: u} if side > 0 else {sigma: u - t / 3}
    again = sympy.expand(launch.subs({sigma: sigma + t, t: rho * t}, simultaneous=True) - rho * landing)
    box = {u: (0, sympy.oo), t: (0, sympy.oo)}
    landed = sympy.Poly(sympy.expand(landing.subs(corner) / t), u, t)
    definite = positive_in(landed.as_expr(), box) and {(j, 0), (0, j)} <= set(landed.monoms())
    return [
        (
            f"a flight t1 after one of length t from sigma has p(sigma + t, t1) = r q(sigma, t) + ..., q = {landing}, "
            "above a multiple of t (|sigma| + t)^" + str(j),
            definite,
        ),
        (
            f"p(sigma + t, rho t) - rho q = {sympy.factor(again)} >= 0, and p = {launch} grows with t, so t1 <= rho "
            "t for r < rho < 1",
            positive_in(again.subs(corner, simultaneous=True), box | {rho: (0, 1)})
            and positive_in(sympy.diff(launch, t).subs(corner), box),
        ),
    ]


def after(j: int) -> tuple[str, Part]:
    """(what happens to launches at sigma >= 0 next to tau_*, why): contact is lost, or chatter completes."""
    launch = ratios.forms(j).launch
    behind = {sigma: (0, sympy.oo), t: (0, sympy.oo)}
    if negative_in(launch, behind):
        return "lost", (
            f"from sigma >= 0 v_c = b ({launch}) + ... < 0 for t > 0: no impact follows, contact is lost",
            True,
        )
    shorter = shortening(j, 1)
    return "chatter", (
        f"from sigma >= 0 {shorter[1][0]}: the flights sum up, chatter completes behind tau_*, where a < 0",
        positive_in(launch, behind) and all(holds for _, holds in shorter),
    )


def monotone() -> list[Part]:
    """Near a tangency with a' < 0 the time at which chatter ends grows strictly with the launch velocity.

    A direction (de, xi de) of landing time e and next flight time t goes to xi' = (r (q_e + q_t xi)/(1 + xi) - p_e)/p_t,
    with p, q at (e + t, t_2) and (e, t).  It increases with xi; the cone xi >= -b, (1 - b)^2 > r, is mapped into itself.
    """
    launch, landing = (-form for form in ratios.forms(1))
    by_launch, by_time = (sympy.diff(launch, x) for x in (sigma, t))
    landed_by_launch, landed_by_time = (sympy.diff(landing, x) for x in (sigma, t))
    u = sympy.Symbol("u")
    first = sympy.expand((landed_by_time - by_launch).subs(sigma, u - t / 3))  # t1 <= r t, over r
    slope = sympy.expand(
        by_time.subs({sigma: sigma + t, t: t_2}, simultaneous=True) - (landed_by_time - landed_by_launch)
    )
    at_zero = sympy.expand(landed_by_launch - by_launch)  # with t_2 <= r t, over r
    return [
        (
            f"from one velocity to a larger one at the same sigma: dt1/de has the sign of r ({landed_by_time}) - 3 "
            f"t1 >= r ({first.subs(u, sigma + t / 3).expand()}) >= 0 on 3 sigma + t >= 0",
            positive_in(first, {u: (0, sympy.oo), t: (0, sympy.oo)}),
        ),
        ("xi = 0 goes to xi' >= 0, since r q_e - p_e = 3 (r t - t_2) >= 0", is_zero(at_zero)),
        (
            f"d xi'/d xi <= r/(1 + xi)^2, since p_t - (q_t - q_e) = {slope} >= 0: so xi >= -b goes to xi' >= -b "
            "r/(1-b)^2 > -b",
            positive_in(slope, dict.fromkeys((sigma, t, t_2), (0, sympy.oo))),
        ),
    ]


def edge() -> list[Part]:
    """Launches from rest at sigma' < 0 next to a tangency with a' < 0: where they land, with what speed over r b."""
    launch, landing = (-form for form in ratios.forms(1))
    flight = {t: -3 * sigma}
    return [
        (
            "from rest at sigma' < 0 the first hit is at -2 sigma' + ..., with speed above 0",
            is_zero(launch.subs(flight)) and positive_on(landing.subs(flight) / sigma**2, sigma, -sympy.oo, 0),
        )
    ]
