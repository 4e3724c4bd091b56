"""Sections 6 and 7: stable manifolds of an unfolded swan, by the order of flights and by blowing up at A.

Where a flight is followed by one that rises with the place s of landing and with the last length t, orbits keep their
order, and so do feet.  The length t_1 of the next flight solves L(s, t_1) = r V, L and V being launch and landing speed:
its slopes have signs without r in them.

Next to A the motion is x'' = a'(A) sigma in the limit.  In units of a'(A) sigma^2 a velocity is a height w, and with
the ratio l of landing and launch time w = (1 - l)(2 + l)/6.
"""

from collections.abc import Mapping
from functools import cache
from typing import Any

import sympy

from singimpact.algebra import Box, definite, motion, positive_in, positive_on
from singimpact.inputs import need
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section3 import NORMALLY_HYPERBOLIC
from singimpact.paper.claims.sections.section4_orbits import STABLE
from singimpact.paper.claims.sections.section6 import TRIALS as TRIALS
from singimpact.paper.claims.sections.section6_exact import crossing, persisting
from singimpact.paper.claims.verifiers import agree, is_zero, root_of_line, same
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.unfolding import kappa, sigma, t
from singimpact.theory.multipliers import P, Q, lambda_, launch_velocity, mu_of_lambda

INCLINATION = "the inclination lemma"
later, place = sympy.symbols("t_1 s")  # length of the next flight; place of landing
m, e, y = sympy.symbols("m e y")  # slope of a chord of a conic; what a flight lasts longer; a root
HORIZON_SLOPES, REST_SLOPES = (-2, -sympy.Rational(3, 2)), (2, 3)  # from D to A on the horizon, C to B on the zero set
THIRD, HALF, TEAR = sympy.Rational(1, 3), sympy.Rational(1, 2), sympy.Rational(3, 8)


def at_A() -> tuple[str, sympy.Expr]:
    """A condition by which what is blown up at A persists."""
    return "a'(A)", model.slope_of_acceleration(-1)


# The order of flights.


def next_length_slopes() -> tuple[sympy.Expr, sympy.Expr]:
    """Polynomials in (s, t, t_1) with the signs of dt_1/ds and dt_1/dt, for flights of length t that land at s."""
    speed = agreed(model.impact_velocity() / kappa, {sigma: place - t}, t * (t**2 - 4 * place * t + 6 * place**2 - 6))
    launch = agreed(
        -model.launch_velocity() / kappa,
        {sigma: place, t: later},
        later * (later**2 + 4 * place * later + 6 * place**2 - 6),
    )
    by_place = 6 + 6 * place**2 + 3 * place * (later - t) - t * later
    turned = sympy.diff(speed, place) * launch - speed * sympy.diff(launch, place)
    need(same(turned, 4 * t * later * (t + later) * by_place), ArithmeticError("dt_1/ds is not as derived"))
    return by_place, sympy.diff(speed, t)


def agreed(expression: sympy.Expr, images: Mapping[sympy.Expr, sympy.Expr], stated: sympy.Expr) -> Any:
    """The stated expression, which a function with images put in has to be."""
    need(agree(expression, images, stated), ArithmeticError(f"{expression} at {images} is not {stated}"))
    return stated


def keeps_order() -> bool:
    """Whether behind B, for kappa < 0, the next length rises with the place of landing and with the last length."""
    after = {sigma: (1, sympy.oo), t: (0, sympy.oo), later: (0, sympy.oo)}
    return all(positive_in(sympy.expand(slope.subs(place, sigma + t)), after) for slope in next_length_slopes())


def feet_along(start: sympy.Expr, length: sympy.Expr, letter: sympy.Expr, box: Box) -> int:
    """1 where the feet of a curve of flights rise with its letter for every r, -1 where they fall, 0 if neither is seen.

    They do with the place of landing and the next length.  This has the sign of V' L - V L_s s' along the curve.
    """
    landing = sympy.factor(start + length)
    speed = sympy.factor((model.impact_velocity() / kappa).subs({sigma: start, t: length}, simultaneous=True))
    agreed(model.impact_velocity() / kappa, {sigma: start, t: length}, speed)
    launch = (-model.launch_velocity() / (kappa * t)).subs({sigma: place, t: later}, simultaneous=True)
    moved, ahead = sympy.diff(speed, letter), sympy.diff(landing, letter)
    turned = sympy.factor((moved * launch - speed * sympy.diff(launch, place) * ahead).subs(place, landing))
    after = {**box, later: (0, sympy.oo)}
    for sign in (1, -1) if positive_in(speed, box) else ():
        if positive_in(sign * ahead, {letter: box[letter]}) and positive_in(sign * turned, after):
            return sign
    return 0


@cache
def grazing() -> tuple[sympy.Expr, ...]:
    """Functions (sigma, t_0, t_1) on the arc AD of the horizon, by the slope m of the chord from A, and its shadow."""
    start = sympy.cancel((6 - 3 * m**2) / (3 * m**2 + 8 * m + 6))
    return start, sympy.factor(m * (start + 1)), sympy.factor(-4 * start - 2 * m * (start + 1))


@cache
def resting() -> tuple[sympy.Expr, sympy.Expr]:
    """Functions (sigma, t) on the arc CB of the zero set, flights from rest on AB, by the slope -m of the chord from B."""
    start = sympy.cancel((m**2 - 6) / (m**2 - 4 * m + 6))
    return start, sympy.factor(m * (1 - start))


def on_their_conics() -> bool:
    """Whether the two arcs lie on H and Z, the shadow is that of the graze, and their ends are A, D and C, B."""
    start, graze, hit = grazing()
    rest, flight = resting()
    first, last = ({m: end} for end in HORIZON_SLOPES)
    low, high = ({m: end} for end in REST_SLOPES)
    return (
        agree(model.horizon(), {sigma: start, t: graze}, 0)
        and agree(model.shadow(), {sigma: start, t: graze}, hit)
        and agree(model.zero_set(), {sigma: rest, t: flight}, 0)
        and [(start.subs(end), graze.subs(end)) for end in (last, first)] == [model.A, model.D]
        and [(rest.subs(end), flight.subs(end)) for end in (low, high)] == [model.C, model.B]
    )


def feet_of_the_images() -> tuple[int, int]:
    """The signs with which the end of chatter changes along R(D''C'') from C'' to B, and along R phi F(AB) from C'' to B."""
    start, _, hit = grazing()
    return -feet_along(start, hit, m, {m: HORIZON_SLOPES}), feet_along(*resting(), m, {m: REST_SLOPES})


def feet_upwards() -> tuple[int, int, int]:
    """The signs with which the end of chatter changes with v over A, over the points of AB, and above delta."""
    beyond = {e: (0, sympy.oo)}
    rest, flight = resting()
    start, _, hit = grazing()
    return (
        feet_along(model.A[0], model.C[1] + e, e, beyond),
        feet_along(rest, flight + e, e, beyond | {m: REST_SLOPES}),
        feet_along(start, hit + e, e, beyond | {m: HORIZON_SLOPES}),
    )


def first_hits() -> bool:
    """Whether a flight from AB longer than the one from rest, or above delta longer than the shadow, is the first hit.

    With the length beyond by e, x - c = kappa u (u - t) q: from AB all terms of q are positive, and above delta it is
    y^2 + e y + e^2 and a positive term, with y = u - t_0.
    """
    start, graze, hit = grazing()
    rest, flight = resting()
    over_AB = sympy.factor(model.cofactor().subs({sigma: rest, t: flight + e}, simultaneous=True))
    above = sympy.factor(-4 * start - 3 * graze)
    left_of_A = model.cofactor().subs({sigma: start, t: hit + e, model.u: graze + y}, simultaneous=True)
    return (
        positive_in(over_AB, {m: REST_SLOPES, e: (0, sympy.oo), model.u: (0, sympy.oo)})
        and same(sympy.factor(left_of_A), y**2 + e * y + e**2 + e * above)
        and definite(y**2 + e * y + e**2, y, e) == 1
        and positive_in(above, {m: HORIZON_SLOPES})
    )


def _images_fall(sign: int) -> list[tuple[str, bool]]:
    signs = feet_of_the_images()
    return [
        ("the arcs AD of H, with its shadow, and CB of Z run between their ends", on_their_conics()),
        ("longer flights than these are hidden by none before", first_hits()),
        ("behind B the next length rises with the place of landing and with the last one", keeps_order()),
        (f"along both arcs from R(C'') to B the end of chatter changes by {signs}, for every r", signs == (sign, sign)),
    ]


def _at_the_ends() -> list[tuple[str, sympy.Expr]]:
    """Slopes along the landing arc at its ends; at C'', a cusp, over the distance from it in m."""
    start, _, hit = grazing()
    slope = sympy.cancel(sympy.diff(start + hit, m) / (2 * m + 3))
    foot, cusp = (slope.subs(m, end) for end in HORIZON_SLOPES)
    return [("the slope of the arc at its cusp C''", cusp), ("and at B", foot), at_A()]


def _crossed(stated: int) -> Check:
    """The sign of the change, along R(D''C'') from C'' to B, of the phase at which chatter ends."""
    return persisting(_images_fall(stated), _at_the_ends(), modulo=(NORMALLY_HYPERBOLIC,))


# Blowing up at A.

ell, w, r, s, v = sympy.symbols("l w r s v")


def height(ratio: sympy.Expr) -> Any:
    """w of the flight from sigma = -1 to -l, in the homogeneous model of order 1."""
    return sympy.expand(launch_velocity(1, sympy.Integer(-1), -ratio))


def excess(start: sympy.Expr, velocity: sympy.Expr) -> Any:
    """x' at A of the motion through (start, velocity): v - sigma^2/2.  On W^s(X) it is 0 to second order."""
    time = sympy.Symbol("t")
    flight = v * time + s * time**2 / 2 + time**3 / 6
    motion((s, v, time), flight, (sympy.Integer(0), sympy.Integer(1)), {})
    found = sympy.expand(sympy.diff(flight, time).subs(time, -s))
    need(is_zero(found - (v - s**2 / 2)), ArithmeticError("x' at A is not v - sigma^2/2"))
    return found.subs({s: start, v: velocity}, simultaneous=True)


def inner() -> Any:
    """The excess after a landing behind A at -l, l < 0: a polynomial in (l, r), times 6."""
    landing = sympy.expand(-launch_velocity(1, -ell, sympy.Integer(-1)))  # speed, by the involution
    return sympy.expand(6 * excess(-ell, r * landing))


def preimage() -> Any:
    """r (landing speed) - w l^2, which vanishes where the image of the height of l is w; times 6, over 1."""
    landing = sympy.expand(-launch_velocity(1, -ell, sympy.Integer(-1)))
    return sympy.expand(6 * (r * landing - w * ell**2))


def changes_sign(polynomial: sympy.Expr, low: sympy.Expr, high: sympy.Expr) -> bool:
    """Whether a quadratic in l is negative at low and positive at high for every r in (0, 1): one root between."""
    first, last = polynomial.subs(ell, low), polynomial.subs(ell, high)
    opens = sympy.Poly(polynomial, ell).LC()
    return positive_on(-first, r, 0, 1) and positive_on(last, r, 0, 1) and positive_on(-opens, r, 0, 1)


def heights_fall() -> bool:
    """Whether the height falls as l rises through (0, 1), and w as a function of l on the inverse images too."""
    image = sympy.cancel(preimage().subs(w, 0) / (6 * ell**2))  # w of the image of the height of l
    return positive_on(-sympy.diff(height(ell), ell), ell, 0, 1) and positive_in(
        -sympy.diff(image, ell), {ell: (0, 1), r: (0, 1)}
    )


def edges_beside_A() -> tuple[sympy.Expr, sympy.Expr, bool]:
    """(outer edge of the loop, tear, whether one inner edge lies between the tear and 1/3), in heights next to A."""
    outer = root_of_line(excess(sympy.Integer(-1), w), w)
    turn = root_of_line(sympy.diff(height(ell), ell), ell)
    return (
        outer,
        height(ell).subs(ell, turn),
        changes_sign(inner(), turn, sympy.Integer(0)) and same(height(sympy.Integer(0)), THIRD),
    )


def _tangent(order: int) -> Check:
    """The order of v in sigma + 1 on W^s(X) at A."""
    arriving = root_of_line(excess(s, v), v)
    above_A = root_of_line(sympy.expand((v * -s + s * s**2 / 2 - s**3 / 6) / s), v)  # x = 0 at A
    text = f"x' at A is v - {arriving} in units of a'(A): 0 to second order on both sides"
    return persisting(
        [
            (text, sympy.degree(arriving, s) == order),
            ("an orbit with this v passes above A", positive_on(arriving - above_A, s, 0, sympy.oo)),
            ("the foot, smooth in height and velocity at A, rises with x'", feet_upwards()[0] == 1 and keeps_order()),
        ],
        [at_A(), ("dH/dt at C", model.value_at_point(model.horizon(), model.C))],
        modulo=(NORMALLY_HYPERBOLIC,),
    )


def _mirrored() -> bool:
    """Whether flights backwards are those of the mirrored model, which is the model itself."""
    return agree(model.acceleration(), {sigma: -sigma}, model.acceleration())


def _loop(stated: int) -> Check:
    """Edges of the loop G^-1(lambda) over lines before A: one above delta and one just below it."""
    outer, tear, below = edges_beside_A()
    edges, rising = int(bool(outer > tear)) + int(below), feet_upwards()
    return persisting(
        [
            *_images_fall(-1),
            (
                f"over A, AB and above delta the end of chatter changes with v by the signs {rising}: so W^s(X) is a graph "
                "over AB, above R(D''C'') and R phi F(AB) up to their end R(C''), and met once above delta, on each line",
                rising == (1, 1, 1),
            ),
            (
                "flights backwards are those of the mirrored model: so G^-1(lambda) goes left of A, from A to A",
                _mirrored(),
            ),
            (
                f"next to A its edges are at w = {outer}, above the tear at {tear}, and in (1/3, {tear})",
                edges == stated,
            ),
        ],
        _at_the_ends(),
        modulo=(NORMALLY_HYPERBOLIC,),
    )


def falling_heights() -> list[tuple[str, bool]]:
    """Checks of the map of heights under G^-1: it rises, its values are below 1/3, and gamma's alone is fixed."""
    step = preimage()
    fixed = sympy.cancel(step.subs(w, height(ell)) / (1 - ell))
    product, quotient = (form(1).subs(lambda_, ell) for form in (P, Q))
    return [
        (
            f"a height w has the inverse image of l in (0, 1) with {step} = 0",
            positive_on(-step.subs(ell, 1), w, 0, sympy.oo),
        ),
        ("which rises with w", heights_fall()),
        ("it lies below 1/3, and so below the tear", positive_on(THIRD - height(ell), ell, 0, 1)),
        ("one height is its own inverse image, that of gamma", same(fixed, r * quotient - ell**2 * product)),
    ]


def _accumulation(factor: str) -> Check:
    """The factor by which heights of G^-n(delta) approach gamma's, in the limit."""
    image = sympy.cancel(preimage().subs(w, 0) / (6 * ell**2))
    on_gamma = ell**2 * P(1).subs(lambda_, ell) / Q(1).subs(lambda_, ell)
    rate = sympy.cancel((sympy.diff(height(ell), ell) / sympy.diff(image, ell)).subs(r, on_gamma))
    ratio = lambda_ if factor == "1/lambda" else mu_of_lambda(1)
    tear = edges_beside_A()[1]
    text = f"in the limit by the factor {factor} = {sympy.factor(rate)}, l = lambda"
    return persisting(
        [
            *falling_heights(),
            (f"delta is at w = {tear}: its inverse images fall to gamma", tear == TEAR),
            (text, same(rate.subs(ell, lambda_), 1 / ratio)),
            ("left of A G^-1 is continuous: in the mirror its flights start behind B", _mirrored() and keeps_order()),
        ],
        [at_A(), ("the distance of the tear from 1/3", tear - THIRD)],
        modulo=(STABLE, INCLINATION),
    )


def _infinitely(count: int) -> Check:
    """Edges of loops of W^s(X) between successive inverse images of delta; the paper's manifolds, read for that one."""
    outer, tear, below = edges_beside_A()
    next_edge = agree(preimage(), {w: outer}, inner())  # the image of the outer edge: it is the next loop's
    edges = int(below) + int(bool(outer > tear) and next_edge)
    return persisting(
        [
            *falling_heights(),
            ("G^-1 maps what is left of A into itself, one to one, and loops to loops", _mirrored() and keeps_order()),
            (
                f"between the tear and its inverse image are the inner edge and that of w = {outer}: {edges}",
                edges == count,
            ),
        ],
        [at_A(), ("the distance of the tear from 1/3", tear - THIRD)],
        modulo=(STABLE, INCLINATION),
    )


def _beyond(stated: tuple[int, int]) -> Check:
    """The sign of the excess of feet over X at discontinuities, and crossings gained by each that comes into reach."""
    sign, gain = stated
    parabola = sympy.Poly(inner(), ell)
    arched = positive_on(parabola.as_expr().subs(ell, 0), r, 0, 1) and positive_on(-parabola.LC(), r, 0, 1)
    return persisting(
        [
            *_images_fall(sign),
            ("from delta G leads to R(D''C'') and to rest on AB: so orbits next to it rest at X at most", sign == -1),
            (
                f"next to A the foot exceeds X by a multiple of h_n^2 ({parabola.as_expr()}) between two of them, where "
                "6w = (1 - l)(2 + l): a parabola from edge to edge, which takes each value below its largest twice",
                arched and parabola.degree() == gain and agree(preimage(), {w: HALF}, inner()),
            ),
        ],
        _at_the_ends(),
        modulo=(NORMALLY_HYPERBOLIC,),
    )


def _separated(stated: tuple[bool, bool]) -> Check:
    """Whether chatter is complete before B, and so on AB, below gamma, and above it; otherwise orbits leave S'."""
    by_place, by_length = next_length_slopes()
    upwards = same(sympy.diff(model.launch_velocity(), t), -kappa * model.horizon())
    forward = _positive_on_S(by_place)
    ordered = forward and same(by_length.subs(place, sigma + t), sympy.expand(-model.launch_velocity() / (kappa * t)))
    return persisting(
        [
            ("over each sigma the length rises with v up to the horizon, where dv/dt = 0", upwards),
            ("in S' the next length rises with the place of landing and with the last one: orbits keep order", ordered),
            (
                "an orbit that stays in S' rests on AB or tends to B, and gamma is all that does; so below gamma it rests "
                f"before B, {ordered}, and above it it would have to pass B: rests {not ordered}",
                (ordered, not ordered) == stated,
            ),
        ],
        [
            ("dt_1/ds > 0 on the closed region", forward),
            ("the Jacobian of H and Z at E", crossing(model.E)),
            at_A(),
            ("a'(B)", model.slope_of_acceleration(1)),
        ],
        modulo=(STABLE,),
    )


def _positive_on_S(slope: sympy.Expr) -> bool:
    """Whether a function is positive for lengths t, t_1 up to the horizon and its mirror image, at each s in (-1, 1).

    It is linear in t and in t_1, so its corners decide: with y^2 + 2 s^2 = 18, t = (y + 4 s)/3 and t_1 = (y - 4 s)/3 at
    the ends, each corner is a quadratic form in (s, y), which has to be definite.
    """
    last, following = (y + 4 * place) / 3, (y - 4 * place) / 3
    ends = [model.horizon().subs(at) for at in ({sigma: place, t: following}, {sigma: -place, t: last})]
    round_ = y**2 + 2 * place**2
    corners = [sympy.expand(slope.subs({t: first, later: then})) for first in (0, last) for then in (0, following)]
    forms = [corner + sympy.Poly(corner, place, y).nth(0, 0) * (round_ / 18 - 1) for corner in corners]
    return (
        all(same(end, (round_ - 18) / 3) for end in ends)
        and sympy.degree(slope, t) == sympy.degree(slope, later) == 1
        and all(definite(sympy.expand(form), place, y) == 1 for form in forms)
    )


CLAIMS = {
    "s6p-separates": Encoding((True, False), _separated, ((False, True), (True, True))),
    "s6n-tangent": Encoding(2, _tangent, (1,)),
    "s6n-transverse": Encoding(-1, _crossed, (1, 0)),
    "s6n-loops": Encoding(2, _loop, (1,)),
    "s6n-accumulate": Encoding("1/mu", _accumulation, ("1/lambda",)),
    "s7-loops": Encoding(2, _infinitely, (3,)),
    "s6n-Y": Encoding((-1, 2), _beyond, ((1, 2), (-1, 1), (-1, 3))),
}
