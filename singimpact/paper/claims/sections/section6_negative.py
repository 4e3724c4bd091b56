"""Sections 6.2 and 7: the negative swan in its universal model, kappa < 0: visible part, images, loops."""

from __future__ import annotations

from typing import Any

import sympy

from singimpact.algebra.certificates import negative_on
from singimpact.paper.claims.claim import Check, Statement
from singimpact.paper.claims.sections.section6 import claim_6
from singimpact.paper.claims.sections.section6_trials import TRIALS as TRIALS
from singimpact.paper.claims.verifiers import every, is_zero
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.unfolding import kappa, sigma, t
from singimpact.paper.trials import unfolded
from singimpact.paper.trials.true_orbits import lambda_of
from singimpact.theory.homogeneous import lambda_, mu_of_lambda


def _visible(side: str) -> Check:
    found = unfolded.visibility()
    return every(
        [
            (
                f"of {found.count} points of V' with v > 0, t > 0 ({found.inside} inside the loop) {found.wrong} are not as said",
                found.wrong == 0 and found.inside > 50 and side == "outside",
            )
        ],
        kind="supported",
    )


def _corresponds(point: tuple[Any, Any]) -> Check:
    """A cusp point of p that phi takes to B."""
    conditions = model.cusp_conditions(point)
    image = model.reset(point)
    return every(
        [
            (
                f"v_t = {conditions[0]}, v_tt = {conditions[1]}, v_ttt = {conditions[2]}, v_(sigma t) = {conditions[3]}: a cusp of p",
                conditions[0] == conditions[1] == 0 and 0 not in conditions[2:],
            ),
            (f"phi takes it to {image}, B is (1, 0)", image == model.project(model.B)),
        ]
    )


def _images(stated: tuple[tuple[Any, Any], tuple[Any, Any]]) -> Check:
    """phi(DA) on Pi_0 between stated[0], and the end stated[1] of phi(DC)."""
    ends = tuple(model.reset(point)[0] for point in (model.A, model.D))
    on_axis = is_zero(sympy.rem(sympy.Poly(model.impact_velocity(), t), sympy.Poly(model.horizon(), t)).as_expr())
    turns = _turning_points()
    on_arc = [point for point in turns if 0 <= point[1] <= 4 and 3 * point[0] + 2 * point[1] <= 0]  # of A and D
    end = model.reset(model.C)
    return every(
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
        ]
    )


def _turning_points() -> list[tuple[Any, Any]]:
    """The points of H at which sigma + t is stationary along it: v of H's tangent, (H_t, -H_sigma), has sum 0."""
    conic = model.horizon()
    turning = sympy.Poly(sympy.diff(conic, t) - sympy.diff(conic, sigma), t)  # a line
    line = -turning.nth(0) / turning.nth(1)
    return [(root, line.subs(sigma, root)) for root in sympy.Poly(conic.subs(t, line), sigma).real_roots()]


def _shadow_velocity(sign: int) -> Check:
    """x - c = kappa u (u - t_0)^2 (u - t_1) on a flight that grazes at t_0, so x-dot = kappa t_1 (t_1 - t_0)^2 at t_1."""
    u = sympy.Symbol("u")
    factored = kappa * u * (u - t) ** 2 * (u - model.shadow())
    conic = sympy.Poly(model.horizon(), sigma)
    rest = sympy.rem(sympy.Poly(sympy.expand(model.height(u) - factored), sigma), conic)
    meeting = sympy.Poly(model.horizon().subs(sigma, -3 * t / 4), t).real_roots()  # t_1 = t_0
    return every(
        [
            ("the factorisation holds on H", is_zero(rest.as_expr())),
            (f"t_1 = t_0 only at t_0 = {max(meeting)}, which is D", max(meeting) == model.D[1]),
            ("so x-dot has the sign of kappa < 0 elsewhere on CD, t_1 > 0", sign == -1),
        ]
    )


def _cusp(stated: tuple[Any, Any]) -> Check:
    """C'' = phi(C). It is a cusp of P: p of the mirror image of D."""
    mirror = (-model.D[0], -model.D[1])
    conditions = model.cusp_conditions(mirror)
    return every(
        [
            (
                "the mirror image of D is a cusp point of p",
                conditions[0] == conditions[1] == 0 and 0 not in conditions[2:],
            ),
            (f"its image is {model.project(mirror)} = phi(C)", model.project(mirror) == model.reset(model.C) == stated),
        ]
    )


def _interval(stated: tuple[tuple[Any, Any], tuple[Any, Any]]) -> Check:
    """F takes AB, at rest with a > 0, to the arc of Z with t > 0 from C to B; v <= 0 after phi."""
    product = sympy.Poly(model.zero_set(), t).nth(0)
    osc = unfolded.negative("1/2")
    launch = [-0.9, -0.3, 0.0, 0.6, 0.95]
    times = osc.first_hit(launch, 0.0).flight_time
    worst = max(abs(time - float(-2 * s + sympy.sqrt(6 - 2 * s**2))) for s, time in zip(launch, times, strict=True))
    roots = tuple(max(sympy.Poly(model.zero_set().subs(sigma, end), t).real_roots()) for end in (-1, 1))
    return every(
        [
            (
                "the two values of t on Z have a negative product for -1 < sigma < 1, so one is positive",
                negative_on(product, sigma, -1, 1),
            ),
            (f"first hits from rest agree with it to {worst:.0e}", worst < 1e-12),
            ("the arc runs from C to B", ((-1, roots[0]), (1, roots[1])) == stated),
        ],
        kind="supported",
    )


def _foot(side: int) -> Check:
    """X: where chatter from A comes to rest, against tau_2 = 1."""
    found = {rate: unfolded.foot(rate) for rate in ("1/10", "1/2", "9/10")}
    shown = ", ".join(f"{value:.10g} at r = {rate}" for rate, value in found.items())
    return every(
        [
            (
                f"chatter from A comes to rest at {shown}, a < 0 there",
                all((value - 1) * side > 0 for value in found.values()),
            )
        ],
        kind="supported",
    )


def _tangent(order: int) -> Check:
    """v/(sigma + 1)^order tends to a finite limit, not 0, on W^s(X) on both sides of A."""
    left, right = unfolded.tangency_at_A()
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
    found = unfolded.loops()
    pairs = all(sum(pair) == stated for pair in found.around)
    return every(
        [
            (
                f"W^s(X) crosses the lines sigma = -1.05, -1.8, -2.7 (above, just below delta) {found.around} times, and -4.5, -5 {found.beyond} times: two branches, which join to the left of D'; nearer to A than 0.05 no line was tried",
                pairs and found.beyond == (stated, 0),
            )
        ],
        kind="supported",
    )


def _accumulation(factor: str) -> Check:
    """Heights v/h^2 of G^-n(delta) over sigma = -1 - h against gamma's; distances shrink by 1/mu."""
    found = unfolded.preimages()
    expected = 1 / float(mu_of_lambda(1).subs(lambda_, lambda_of(0.5, 1)))
    shown, twice = (", ".join(f"{v:.4f}" for v in heights[:5]) for heights in (found.heights, found.farther))
    return every(
        [
            (
                f"v/h^2 on the line sigma = -1 - h, h = 0.001, is {shown}, ... and falls to gamma's {found.gamma:.4f}; last factor {found.factor:.3f}, 1/mu = {expected:.3f}",
                abs(found.factor - expected) < 0.02 and factor == "1/mu",
            ),
            (
                f"at h = 0.002 the first two are {twice}: v is of order h^2 on them",
                all(abs(two / one - 1) < 0.02 for one, two in zip(found.heights, found.farther, strict=False)),
            ),
        ],
        kind="supported",
    )


def _infinitely(count: int) -> Check:
    """Crossings of W^s(X) between successive inverse images of delta: a loop in each interval."""
    found = unfolded.loops()
    return every(
        [
            (
                f"read for the manifold through A (just after tau_* a > 0 and no point rests): W^s(X), X beyond tau_2, meets sigma = -1.02 {found.between} times in successive intervals between inverse images of delta",
                all(number >= count for number in found.between) and count == 2,
            )
        ],
        kind="supported",
    )


CLAIMS = (
    claim_6(
        "s6n-visible",
        "the visible part of V' is the outside of the loop ADCBA",
        Statement(r"\text{visible}=V'\setminus\text{inside}(ADCBA)", "outside"),
        _visible,
        ("inside",),
        ("s6-lips",),
    ),
    claim_6(
        "s6n-corr",
        "B corresponds to the cusp point D of p",
        Statement(r"\phi(D)=B,\ D\ \text{a cusp point of}\ p", model.D),
        _corresponds,
        (model.C, model.E),
        ("s6-lips",),
    ),
    claim_6(
        "s6n-maps",
        "phi takes DA to the interval A''D'' of Pi_0 and DC to an arc with v < 0 ending at C''",
        Statement(r"\phi(DA)=[-1,1]\times0,\quad\phi(C)=(3,64\kappa)", ((-1, 1), (3, 64 * kappa))),
        _images,
        (((-1, 3), (3, 64 * kappa)), ((-1, 1), (3, -64 * kappa))),
        ("s6n-corr",),
    ),
    claim_6(
        "s6n-shadow-neg",
        "x-dot < 0 on the shadow arc CD except at D",
        Statement(r"\dot x_c<0\ \text{on}\ CD\setminus D", -1),
        _shadow_velocity,
        (1,),
        ("s6n-corr",),
    ),
    claim_6(
        "s6n-cusp",
        "C'' is a cusp point of P",
        Statement(r"C''=\phi(C)\in\text{cusps}(P)", (3, 64 * kappa)),
        _cusp,
        ((3, -64 * kappa),),
        ("s6-lips",),
    ),
    claim_6(
        "s6n-AB",
        "F takes AB to the arc CB of Z",
        Statement(r"F(AB)=CB\subset Z", ((-1, 4), (1, 0))),
        _interval,
        (((-1, 3), (1, 0)), ((-1, 4), (1, 1))),
        ("s6-lips",),
    ),
    claim_6(
        "s6n-X",
        "A lies on the stable manifold of a regular point X with tau_3 > tau_2",
        Statement(r"A\in W^s(X),\ X=(\tau_3,0),\ \tau_3>\tau_2", 1),
        _foot,
        (-1,),
        ("s6n-AB",),
    ),
    claim_6(
        "s6n-tangent",
        "W^s(X) is tangent to Pi_0 at A",
        Statement(r"W^s(X):\ v\sim12|\kappa|(\sigma+1)^2\ \text{at}\ A", 2),
        _tangent,
        (1,),
        ("s6n-X",),
    ),
    claim_6(
        "s6n-loops",
        "G^-1(lambda) is a loop around delta with both ends at A",
        Statement(r"G^{-1}(\lambda)\ \text{surrounds}\ \delta=AD'", 2),
        _loop,
        (1,),
        ("s6n-X", "s6n-tangent"),
    ),
    claim_6(
        "s6n-accumulate",
        "the inverse images of delta are arcs tangent to Pi_0 at A that accumulate on gamma",
        Statement(r"G^{-n}(\delta)\to\gamma", "1/mu"),
        _accumulation,
        ("1/lambda",),
        ("t:t2-exists", "s4-saddle-m3"),
    ),
    claim_6(
        "s7-loops",
        "nearby stable manifolds have infinitely many loops accumulating on gamma",
        Statement(r"W^s_\tau:\ \text{a loop around each}\ G^{-n}(\delta)", 2),
        _infinitely,
        (3,),
        ("s6n-loops", "s6n-accumulate"),
    ),
)
