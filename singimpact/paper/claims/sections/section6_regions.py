"""Section 6: the negative swan in its universal model, kappa < 0, visible part and images; what the regions of an
unfolded swan are bounded by, and where the two maps have cusps beside A and B.
"""

from typing import Any

import sympy

from singimpact.algebra import At, negative_on, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section6 import TRIALS as TRIALS
from singimpact.paper.claims.sections.section6_exact import (
    ADCBA,
    at,
    chatter_check,
    crossing,
    interval_check,
    persisting,
    visible_check,
)
from singimpact.paper.claims.verifiers import is_zero, root_of_line, same
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.unfolding import kappa, sigma, t, u


def _over(
    conic: sympy.Expr, direction: sympy.Expr, ends: tuple[tuple[sympy.Expr, sympy.Expr], tuple[sympy.Expr, sympy.Expr]]
) -> bool:
    """Whether an arc of a conic between two ends is a graph over `direction`, a linear form that no point of it turns at.

    The arc is the one with times between those of its ends; the points of the conic where the form is stationary along
    it have other times, or are an end.
    """
    weight = sympy.diff(direction, sigma), sympy.diff(direction, t)
    along = sympy.expand(weight[0] * sympy.diff(conic, t) - weight[1] * sympy.diff(conic, sigma))
    times = sympy.Poly(sympy.resultant(conic, along, sigma), t).real_roots()
    low, high = sorted(end[1] for end in ends)
    return bool(times) and all(time <= low or time >= high for time in times)


def _graphs(stated: tuple[int, int]) -> Check:
    """Signs of v on p(BE), over an interval of sigma, and on phi(AE), over one of sigma + t, for kappa > 0."""
    middle = {sigma: sympy.Integer(0), t: sympy.sqrt(2)}  # of BE, on the horizon
    inner = -sympy.Rational(7, 5)
    other = {sigma: inner, t: -2 * inner - sympy.sqrt(6 - 2 * inner**2)}  # of AE, on the zero set
    launch, landing = (velocity.subs(kappa, 1) for velocity in (model.launch_velocity(), model.impact_velocity()))
    signs = (sympy.sign(sympy.expand(launch.subs(middle))), sympy.sign(sympy.expand(landing.subs(other))))
    on_arcs = is_zero(model.horizon().subs(middle)) and is_zero(sympy.expand(model.zero_set().subs(other)))
    return persisting(
        [
            (
                "p(BE) is a graph over sigma: H turns in no point between",
                _over(model.horizon(), sigma, (model.B, model.E)),
            ),
            (
                "phi(AE) is a graph over sigma + t: Z turns in no point between",
                _over(model.zero_set(), sigma + t, (model.A, model.E)),
            ),
            (f"v has the signs {signs[0]}, {signs[1]} on them, at {middle} and {other}", on_arcs and signs == stated),
            (
                "and vanishes at their ends alone, where H meets Z or t = 0; so with its interval of Pi_0 each "
                "bounds a simply connected region",
                _ends_alone(),
            ),
        ],
        [("the Jacobian of H and Z at E", crossing(model.E)), *_tangencies()],
    )


def _ends_alone() -> bool:
    """Whether H and Z have no common point with a time strictly between 0 and that of E."""
    common = sympy.Poly(sympy.resultant(model.horizon(), model.zero_set(), sigma), t).real_roots()
    return all(not 0 < time < model.E[1] for time in common)


def _tangencies() -> list[tuple[str, Any]]:
    return [(f"a'({name})", model.slope_of_acceleration(point[0])) for name, point in (("A", model.A), ("B", model.B))]


def _cusp_of_phi(point: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """v = 0, a = 0, a' != 0 at the launch and x-dot != 0 at the landing: a cusp of phi (p:phising-cusp)."""
    point_ = {sigma: point[0], t: point[1]}
    launch, landing = model.launch_velocity().subs(point_), sympy.expand(model.impact_velocity().subs(point_))
    pressed = model.acceleration().subs(sigma, point[0])
    return persisting(
        [
            (f"a flight from rest, v = {launch}, t = {point[1]} != 0", is_zero(launch) and point[1] != 0),
            (f"at a zero of a: {pressed}", is_zero(pressed)),
            (f"which lands with x-dot = {landing}", not is_zero(landing)),
        ],
        [("a' at the launch", model.slope_of_acceleration(point[0])), ("x-dot", landing)],
    )


def _swallowtail(stated: dict[int, tuple[int, int]]) -> Check:
    """Numbers of cusps and crossings of the curve of flights from rest before and after a swan, for the signs of e.

    The flight from rest at s of x'' = a is R(T; s) = F(T) - F(s) - F'(s)(T - s), F'' = a, so dR/ds = -a(s)(T - s).  In
    the plane of flights the curve has the direction of T - s everywhere, and stops where a(s) = 0.
    """
    s, other = sympy.symbols("s s_2")
    pressed = model.limit_acceleration().subs(sigma, s)
    falling = sympy.Poly(pressed * (t - s), s).terms()
    rest = -sympy.Add(*(value * s ** (n + 1) / (n + 1) for (n,), value in falling))
    flat, steep = (sympy.Poly(rest, t).nth(power) for power in (0, 1))
    chords = [sympy.cancel((slope - slope.subs(s, other)) / (s - other)) for slope in (flat, steep)]
    meeting = sympy.factor_list(sympy.resultant(*chords, other), s)[1]
    counts = {}
    for sign in (1, -1):
        cusps = sympy.Poly(pressed.subs({kappa: 1, model.e: sign}), s).real_roots()
        apart = [
            root
            for factor, _ in meeting
            for root in sympy.Poly(factor.subs({kappa: 1, model.e: sign}), s).real_roots()
            if root not in cusps
        ]
        counts[sign] = (len(cusps), len(apart) // 2)
    doubled = -3 * model.e  # s^2 at the crossing, whose other flight is that from -s
    substitution(At(steep, {s: -s}), -steep)
    square = sympy.Symbol("s_s")
    substitution(At(sympy.cancel(steep / s).subs(s**2, square), {square: doubled}), 0)
    substitution(At(flat, {s: -s}), flat)
    return persisting(
        [
            (
                f"dR/ds = {sympy.factor(sympy.diff(rest, s))}: it vanishes at the zeros of a alone",
                same(sympy.diff(rest, s), -pressed * (t - s)),
            ),
            (f"cusps and crossings for e = 1 and e = -1: {counts}", counts == stated),
            (
                "the flights from rest at -s and s are one where s^2 = -3e",
                is_zero(sympy.rem(steep, s**2 - doubled, s)) and is_zero(flat - flat.subs(s, -s)),
            ),
        ],
        [*_tangencies(), (f"a at s^2 = {doubled}", sympy.expand(pressed.subs({s: sympy.sqrt(3), model.e: -1})))],
    )


REGIONS = {
    "s6-swallowtail": Encoding(
        {1: (0, 0), -1: (2, 1)},
        _swallowtail,
        ({1: (0, 0), -1: (2, 0)}, {1: (2, 1), -1: (0, 0)}, {1: (0, 0), -1: (3, 1)}),
    ),
    "s6p-regions": Encoding((1, -1), _graphs, ((-1, 1), (1, 1))),
    "s6n-corr-A": Encoding(
        (sympy.Integer(3), -sympy.Integer(4)),
        lambda point: cusp_above(point, model.A, "A"),
        (model.D, (sympy.Integer(3), sympy.Integer(4))),
    ),
    "s6n-C": Encoding(
        (-sympy.Integer(1), sympy.Integer(4)),
        _cusp_of_phi,
        (model.D, (-sympy.Integer(1), sympy.Integer(3)), (sympy.Integer(0), sympy.sqrt(6))),
    ),
}


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


def _images(stated: tuple[tuple[sympy.Expr, sympy.Expr], tuple[sympy.Expr, sympy.Expr]]) -> Check:
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


def _turning_points() -> list[tuple[sympy.Expr, sympy.Expr]]:
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
        [("d/du of (x - c)/(u (u - t_0)^2)", sympy.diff(cofactor, u)), ("v_ttt v_(sigma t) at D", cusp[2] * cusp[3])],
    )


def _cusp(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
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


NEGATIVE = {
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
}

CLAIMS = NEGATIVE | REGIONS
