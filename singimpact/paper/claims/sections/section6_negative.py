"""Sections 6.2 and 7: the negative swan in its universal model, kappa < 0: visible part, images, loops."""

from typing import Any

import sympy

from singimpact.algebra.certificates import negative_on
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section6 import TRIALS as TRIALS
from singimpact.paper.claims.sections.section6_exact import (
    ADCBA,
    at,
    chatter_check,
    interval_check,
    persisting,
    visible_check,
)
from singimpact.paper.claims.verifiers import every, is_zero, root_of_line, same
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.unfolding import kappa, sigma, t, u
from singimpact.paper.trials import universal_orbits
from singimpact.paper.trials.true_orbits import lambda_of
from singimpact.theory.multipliers import lambda_, mu_of_lambda


def cusp_above(point: tuple[sympy.Expr, sympy.Expr], tangency: tuple[sympy.Expr, sympy.Expr], name: str) -> Check:
    """Whether a point is a cusp point of p that phi takes to a tangency point."""
    conditions = model.cusp_conditions(point)
    image = model.reset(point)
    return persisting(
        [
            (
                f"v_t = {conditions[0]}, v_tt = {conditions[1]}, v_ttt = {conditions[2]}, v_(sigma t) = {conditions[3]}: a cusp of p",
                conditions[0] == conditions[1] == 0 and 0 not in conditions[2:],
            ),
            (f"phi takes it to {image}, {name} is {tangency}", image == model.project(tangency)),
            ("where v_t = v_tt = 0 a flight lands at rest at a zero of a", _lands_at_rest()),
        ],
        [
            ("v_ttt v_(sigma t) there", conditions[2] * conditions[3]),
            (f"a'({name})", model.slope_of_acceleration(tangency[0])),
        ],
    )


def _lands_at_rest() -> bool:
    """Whether v_t and v_tt vanish together where x' and x'' = a do at the landing: t v_t = -x' and its derivative by t."""
    v, landing = model.launch_velocity(), model.impact_velocity()
    slope, bend = sympy.diff(v, t), sympy.diff(v, t, 2)
    pressed = model.acceleration().subs(sigma, sigma + t)
    return same(t * slope, -landing) and same(t * bend, -pressed - 2 * slope)


def _images(stated: tuple[tuple[Any, Any], tuple[Any, Any]]) -> Check:
    """phi(DA) on Pi_0 between stated[0], and the end stated[1] of phi(DC)."""
    ends = tuple(model.reset(point)[0] for point in (model.A, model.D))
    on_axis = is_zero(sympy.rem(sympy.Poly(model.impact_velocity(), t), sympy.Poly(model.horizon(), t)).as_expr())
    turns = _turning_points()
    on_arc = [point for point in turns if 0 <= point[1] <= 4 and 3 * point[0] + 2 * point[1] <= 0]  # of A and D
    end = model.reset(model.C)
    conic = model.horizon()
    turning = sympy.diff(conic, t) - sympy.diff(conic, sigma)
    return persisting(
        [
            ("x-dot vanishes on H", on_axis),
            (f"phi(A), phi(D) are at {ends}", ends == stated[0]),
            (
                f"sigma + t turns on H at {turns} only, and not on DA, so it runs through the interval once",
                bool(turns) and not on_arc and all(3 * p[0] + 2 * p[1] <= 0 for p in (model.A, model.D)),
            ),
            (
                f"phi(C) = {end}, with v < 0 for kappa < 0",
                end == stated[1] and negative_on(end[1], kappa, -sympy.oo, 0),
            ),
        ],
        [
            ("d(sigma + t) along H at A", at(turning, model.A)),
            ("d(sigma + t) along H at D", at(turning, model.D)),
            ("dZ/dt at C", at(sympy.diff(model.zero_set(), t), model.C)),
            ("x' at phi(C)", end[1]),
        ],
    )


def _turning_points() -> list[tuple[Any, Any]]:
    """The points of H at which sigma + t is stationary along it: v of H's tangent, (H_t, -H_sigma), has sum 0."""
    conic = model.horizon()
    line = root_of_line(sympy.diff(conic, t) - sympy.diff(conic, sigma), t)
    return [(root, line.subs(sigma, root)) for root in sympy.Poly(conic.subs(t, line), sigma).real_roots()]


def _shadow_velocity(sign: int) -> Check:
    """x - c = kappa u (u - t_0)^2 (u - t_1) on a flight that grazes at t_0, so x-dot = kappa t_1 (t_1 - t_0)^2 at t_1."""
    factored = kappa * u * (u - t) ** 2 * (u - model.shadow())
    conic = sympy.Poly(model.horizon(), sigma)
    rest = sympy.rem(sympy.Poly(sympy.expand(model.height(u) - factored), sigma), conic)
    meeting = sympy.Poly(model.horizon().subs(sigma, -3 * t / 4), t).real_roots()  # t_1 = t_0
    speed = sympy.diff(factored, u).subs(u, model.shadow())
    cofactor = sympy.cancel(factored / (u * (u - t) ** 2))
    cusp = model.cusp_conditions(model.D)
    return persisting(
        [
            ("the factorisation holds on H", is_zero(rest.as_expr())),
            (f"t_1 = t_0 only at t_0 = {max(meeting)}, which is D", max(meeting) == model.D[1]),
            (
                "t_1 = -(3 sigma + 2 t_0) - sigma, which is positive on AD, where 3 sigma + 2 t_0 < 0 and so sigma < 0",
                same(model.shadow(), -(3 * sigma + 2 * t) - sigma),
            ),
            (
                "x-dot = kappa t_1 (t_1 - t_0)^2 there, with the sign of kappa < 0",
                sign == -1
                and same(speed, kappa * model.shadow() * (model.shadow() - t) ** 2)
                and negative_on(sympy.cancel(speed / model.shadow() / (model.shadow() - t) ** 2), kappa, -sympy.oo, 0),
            ),
        ],
        [
            ("d/du of (x - c)/(u (u - t_0)^2)", sympy.diff(cofactor, u)),
            ("v_ttt v_(sigma t) at D", cusp[2] * cusp[3]),
        ],
    )


def _cusp(stated: tuple[Any, Any]) -> Check:
    """C'' = phi(C). It is a cusp of P: p of the mirror image of D."""
    mirror = (-model.D[0], -model.D[1])
    conditions = model.cusp_conditions(mirror)
    return persisting(
        [
            (
                "the mirror image of D is a cusp point of p",
                conditions[0] == conditions[1] == 0 and 0 not in conditions[2:],
            ),
            (f"its image is {model.project(mirror)} = phi(C)", model.project(mirror) == model.reset(model.C) == stated),
            ("where v_t = v_tt = 0 a flight lands at rest at a zero of a", _lands_at_rest()),
        ],
        [("v_ttt v_(sigma t) there", conditions[2] * conditions[3]), ("a'(A)", model.slope_of_acceleration(-1))],
    )


def _tangent(order: int) -> Check:
    """v/(sigma + 1)^order tends to a finite limit, not 0, on W^s(X) on both sides of A."""
    left, right = universal_orbits.tangency_at_A()
    return every(
        [
            (
                f"on W^s(X) v/(sigma + 1)^2 -> {left:.4f} and {right:.4f} on the two sides of A (a'(A)/2 = 12): tangent to Pi_0",
                abs(left - 12) < 0.1 and abs(right - 12) < 0.1 and order == 2,
            )
        ],
        kind="supported",
    )


def _loop(stated: int) -> Check:
    """Branches of W^s(X) over lines that meet delta: one above it and one just below, joined to the left of D'."""
    loops = universal_orbits.loops()
    return every(
        [
            (
                f"W^s(X) crosses the lines sigma = -1.05, -1.8, -2.7 (above, just below delta) {loops.around} times, and -4.5, -5 {loops.beyond} times: two branches, which join to the left of D'; nearer to A than 0.05 no line was tried",
                all(sum(pair) == stated for pair in loops.around) and loops.beyond == (stated, 0),
            )
        ],
        kind="supported",
    )


def _accumulation(factor: str) -> Check:
    """Heights v/h^2 of G^-n(delta) over sigma = -1 - h against gamma's; distances shrink by 1/mu."""
    preimages = universal_orbits.preimages()
    expected = 1 / float(mu_of_lambda(1).subs(lambda_, lambda_of(0.5, 1)))
    shown, twice = (", ".join(f"{v:.4f}" for v in heights[:5]) for heights in (preimages.heights, preimages.farther))
    return every(
        [
            (
                f"v/h^2 on the line sigma = -1 - h, h = 0.001, is {shown}, ... and falls to gamma's {preimages.gamma:.4f}; last factor {preimages.factor:.3f}, 1/mu = {expected:.3f}",
                abs(preimages.factor - expected) < 0.02 and factor == "1/mu",
            ),
            (
                f"at h = 0.002 the first two are {twice}: v is of order h^2 on them",
                all(abs(two / one - 1) < 0.02 for one, two in zip(preimages.heights, preimages.farther, strict=False)),
            ),
        ],
        kind="supported",
    )


def _infinitely(count: int) -> Check:
    """Crossings of W^s(X) between successive inverse images of delta: a loop in each interval."""
    loops = universal_orbits.loops()
    return every(
        [
            (
                f"read for the manifold through A (just after tau_* a > 0 and no point rests): W^s(X), X beyond tau_2, meets sigma = -1.02 {loops.between} times in successive intervals between inverse images of delta",
                all(number >= count for number in loops.between) and count == 2,
            )
        ],
        kind="supported",
    )


CLAIMS = {
    "s6n-visible": Encoding(
        (ADCBA, 0),
        visible_check,
        ((ADCBA, 1), ((*ADCBA[:2], ADCBA[2]._replace(side=-ADCBA[2].side)), 0), (ADCBA[:2], 0)),
    ),
    "s6n-corr": Encoding(model.D, lambda point: cusp_above(point, model.B, "B"), (model.C, model.E)),
    "s6n-maps": Encoding(
        ((-1, 1), (3, 64 * kappa)), _images, (((-1, 3), (3, 64 * kappa)), ((-1, 1), (3, -64 * kappa)))
    ),
    "s6n-shadow-neg": Encoding(-1, _shadow_velocity, (1,)),
    "s6n-cusp": Encoding((3, 64 * kappa), _cusp, ((3, -64 * kappa),)),
    "s6n-AB": Encoding(((-1, 4), (1, 0)), interval_check, (((-1, 3), (1, 0)), ((-1, 4), (1, 1)))),
    "s6n-X": Encoding(1, chatter_check, (4, sympy.Rational(16, 5))),
    "s6n-tangent": Encoding(2, _tangent, (1,)),
    "s6n-loops": Encoding(2, _loop, (1,)),
    "s6n-accumulate": Encoding("1/mu", _accumulation, ("1/lambda",)),
    "s7-loops": Encoding(2, _infinitely, (3,)),
}
