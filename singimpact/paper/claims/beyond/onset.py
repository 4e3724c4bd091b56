"""Births: at a negative swan nothing that recurs but one orbit that starts at A; at a graze an exponent."""

import sympy

from singimpact.algebra import At, positive_in, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section6_exact import persisting
from singimpact.paper.claims.verifiers import every, is_zero, same
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.unfolding import kappa, r, sigma, t, u

slow, m, kick, w, d, h, mu, nu, pull = sympy.symbols("lambda m c w d h mu nu a", positive=True)
BORN = (1 - d) / (2 * d), kick**2 * d / (1 - d) ** 2, sympy.Rational(2, 3), (1 + r) * sympy.sqrt(2 * pull) / (nu - mu)
v, s, bend, drop, rate = sympy.symbols("v s A2 dc a_c")  # A2 = |a''|, a_c = |da/dc|
WINDOW = {sigma: (-5, 5), t: (0, 12), r: (0, 1)}  # of the universal model, in half distances


def _rises(stated: sympy.Expr) -> Check:
    """Whether a function of (sigma, v) rises along every flight, from (sigma, v) to (sigma + t, -r x')."""
    images, before = {sigma: sigma + t}, stated
    if stated.has(v):  # only then does the motion matter: that of the universal model
        images[v] = -r * model.impact_velocity().subs(kappa, -1)
        before = stated.subs(v, model.launch_velocity().subs(kappa, -1))
    change = sympy.expand(stated.subs(images, simultaneous=True) - before)
    substitution(At(stated, images), sympy.expand(before + change))
    return every(
        {
            f"from an impact to the next {stated} changes by {change}": True,
            "which is positive for t > 0": positive_in(change, WINDOW),
            "in every model, as the next launch is at tau + t: no state comes back, and none near it": same(change, t),
        },
        witness=lambda: {"function": str(stated), "change": str(change)},
    )


def _hop(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """(flight, time of its hit, its speed, its height): a polynomial in s; units of H, |a''| H^3, |a''| H^4."""
    flight, time, speed, top = stated
    derived = sympy.expand(model.height(u).subs({sigma: model.A[0], t: model.C[1], kappa: -1}).subs(u, s + 1))
    substitution(At(model.height(u), {sigma: model.A[0], t: model.C[1], kappa: -1, u: s + 1}), sympy.factor(derived))
    unit = sympy.Rational(1, 24)  # |a''| = 24 |kappa| in lengths scaled by H
    (summit,) = [root for root in sympy.Poly(sympy.diff(derived, s), s).real_roots() if -1 < root < 3]
    landing = sympy.diff(derived, s).subs(s, 3)
    coefficients = (sympy.Integer(4), -unit * landing, unit * derived.subs(s, summit))
    square = 2 * rate * drop / bend  # H^2, as a_c rises by |a''| H^2/2 from A to the middle of A and B
    curve = sympy.diff(derived, s, 2).subs(s, summit)
    return persisting(
        [
            (f"the flight from rest at A is {sympy.factor(derived)}", same(derived, flight)),
            (
                f"it hits after 4, the speed is {coefficients[1]} and the height {coefficients[2]}",
                coefficients == (time, speed, top),
            ),
            (
                "in c_0 - c the height is (9/2) a_c^2 (c_0 - c)^2/|a''|",
                same(LAWS[2] * bend * square**2, sympy.Rational(9, 2) * rate**2 * drop**2 / bend),
            ),
        ],
        [("x' at the hit", landing * kappa), ("x'' at the summit", curve * kappa)],
        witness=lambda: {"flight": str(sympy.factor(derived)), "hit, speed, height": str(coefficients)},
    )


def _exponent(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """(stretch, e^B, lambda, c): a return has the exponent E ln stretch, and (|ln e| + B)/(2 |ln lambda|) periods.

    Of the limit of the square-root map as a non-impacting orbit passes the wall by e = w^2: an impact of the depth e d,
    d = h^2, throws the slow part of the motion to e s, s = lambda^m c h/w, m periods later. There lambda < s <= 1, and
    the next d is 1 - s. Above the stated lambda all returns expand.
    """
    stretch, periods, least, kicked = stated
    thrown = slow**m * kick * h / w
    free = kicked * (sympy.exp(-mu * t) - sympy.exp(-nu * t))
    fast = sympy.diff(pull * t**2 / 2, t).subs(t, sympy.sqrt(2 / pull)) ** 2  # as the turn is 1 below the wall
    speed = sympy.diff(free, t)
    motion = sympy.diff(speed, t) + (mu + nu) * speed + mu * nu * free
    slowest = slow / (2 * (1 - slow))
    return every(
        [
            ("a return stretches by s/(2 d)", is_zero(sympy.diff(1 - thrown, h) / (2 * h) + thrown / (2 * h**2))),
            ("s has the mean of 1 - d, so ln s/(2 d) has that which is stated", same(stretch, (1 - d) / (2 * d))),
            (
                "and lambda^(-2m) is that of e^B/e, with s in the place of 1 - d",
                same(periods.subs(d, h**2) * (1 - h**2) ** 2, (thrown * w / slow**m) ** 2),
            ),
            (
                f"s/(2 d) is least for s = lambda, d = 1 - lambda, and 1 there for lambda = {least}",
                positive_in(slowest - 1, {slow: (least, 1)}) and slowest.subs(slow, least) == 1,
            ),
            (
                "c is the slow part of 1 + r of sqrt(2 a), with which a motion that turns at depth 1 meets the wall",
                is_zero(sympy.expand(motion / kicked)) and same((speed.subs(t, 0) / (1 + r)) ** 2, fast),
            ),
        ],
        "argued",
        witness=lambda: {"stretch": str(stretch), "least": str(slowest.subs(slow, least))},
    )


FLIGHT = (s + 1) ** 3 * (3 - s)
LAWS = sympy.Integer(4), sympy.Rational(8, 3), sympy.Rational(9, 8)

CLAIMS = {
    "b:grazing-exponent": Encoding(
        BORN,
        _exponent,
        (
            (2 * BORN[0], *BORN[1:]),
            (BORN[0], BORN[1] * (1 - d), *BORN[2:]),
            (*BORN[:2], sympy.Rational(3, 4), BORN[3]),
            (*BORN[:3], BORN[3] / (1 + r)),
        ),
    ),
    "b:onset-none": Encoding(sigma, _rises, (-sigma, v, sigma - v, sigma + v)),
    "b:onset-hop": Encoding(
        (FLIGHT, *LAWS),
        _hop,
        (
            (FLIGHT, LAWS[0], sympy.Rational(4, 3), LAWS[2]),
            (FLIGHT, LAWS[0], LAWS[1], sympy.Rational(27, 8)),
            ((s + 1) ** 2 * (3 - s), *LAWS),
            (FLIGHT, sympy.Integer(3), *LAWS[1:]),
        ),
    ),
}
