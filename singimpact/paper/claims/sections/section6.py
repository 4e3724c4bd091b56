"""Section 6: the unfolded swan, in its universal model x'' = 12 kappa (t^2 - 1); kappa > 0 positive, < 0 negative."""

from fractions import Fraction
from math import factorial
from typing import Any

import sympy

from singimpact.algebra import At, definite, negative_on, positive_on, substitution
from singimpact.contact import swan_points_over_clearance, tangency_points
from singimpact.impact_oscillator import linear
from singimpact.oscillator.model import Oscillator
from singimpact.paper.claims.claim import Check, Encoding, Trial, Trials, at_each
from singimpact.paper.claims.sections import section6_exact
from singimpact.paper.claims.sections.section4_orbits import STABLE
from singimpact.paper.claims.verifiers import every, is_zero, root_of_line, same
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.implicit import v_c_swan
from singimpact.paper.routes.unfolding import WEIGHTS, Weights, kappa, sigma, t
from singimpact.paper.trials import true_orbits
from singimpact.paper.trials.true_sheet import Place, swans

SQRT3 = sympy.sqrt(3)


def _birth(stated: int) -> Check:
    """Sign of d (c - c_0) for which a_c has two zeros near a swan: a'' sigma^2/2 + (da/dc)(c - c_0) = 0."""
    rise, bend = zeros_by_clearance()
    second, rate = sympy.symbols("a_d2 a_c")
    share = sympy.cancel(second * rate * bend / second**2)  # d (c - c_0) = share a''^2 sigma^2 on the zeros
    return every(
        [
            ("da/dc != 0, so the zeros are a graph c - c_0 = delta(sigma), with delta'(0) = 0", rise == 0),
            (
                f"d delta(sigma) = {share} a''^2 sigma^2 + O(3): two zeros where d (c - c_0) < 0, none where it is > 0",
                share.is_Rational and sympy.sign(share) == stated,
            ),
        ]
    )


def zeros_by_clearance() -> tuple[sympy.Expr, sympy.Expr]:
    """(first, second) Taylor coefficient of delta(sigma), a(sigma, delta(sigma)) = 0, where a = a_sigma = 0, a'' != 0.

    a is any function of (sigma, delta), delta = c - c_0, with da/dc != 0, by its Taylor polynomial of degree 3.
    """
    delta = sympy.Symbol("delta")
    jets = {(2, 0): "a_d2", (0, 1): "a_c"}
    letters = {
        (i, n): sympy.Symbol(jets.get((i, n), f"a_{i}{n}")) for i in range(4) for n in range(4 - i) if i > 1 or n
    }
    near = sum(letter * sigma**i * delta**n / (factorial(i) * factorial(n)) for (i, n), letter in letters.items())
    at_swan = {sigma: 0, delta: 0}
    by_clearance = sympy.diff(near, delta).subs(at_swan)
    rise = sympy.cancel(-sympy.diff(near, sigma).subs(at_swan) / by_clearance)
    along = sum(
        (sympy.diff(near, (sigma, 2 - n), (delta, n)).subs(at_swan) * rise**n * (1, 2, 1)[n] for n in range(3)),
        sympy.Integer(0),
    )
    bend = sympy.cancel(-along / by_clearance) / 2
    substitution(At(near, {delta: rise * sigma + bend * sigma**2}), sympy.Integer(0), order=2, small=[sigma])
    return rise, bend


def _side(stated: int) -> Check:
    """For x'' + x = cos 2t, on which side of c_0 = 1 the two zeros of a_c near 0 exist."""
    tau, c = sympy.symbols("tau c")
    at_rest = sympy.cos(2 * tau) - c
    jets = [sympy.diff(at_rest, tau, n).subs({tau: 0, c: 1}) for n in range(3)]
    share = jets[2] * sympy.diff(at_rest, c)  # d
    zeros = {clearance: tangency_points(linear(2, clearance, 1), 15) for clearance in ("0.99", "1.01")}
    below, above = (len(points) for points in zeros.values())
    shown = ", ".join(str(point) for point in zeros["0.99"].certified())
    return every(
        [
            (
                f"at c = 1, tau = 0 a = {jets[0]}, a' = {jets[1]}, d = a'' da/dc = {share}",
                jets[:2] == [0, 0] and sympy.sign(-share) == stated,
            ),
            (
                f"in one period all zeros of a_c lie in balls: {below} at c = 0.99, at {shown}; {above} at c = 1.01",
                (below, above) == ((2, 0) if stated < 0 else (0, 2)),
            ),
        ],
        kind="certified",
        witness=lambda: {"omega": "2", "c": "1.01", "zeros of a_c": str(above), "zeros at c = 0.99": str(below)},
    )


def _lips(cusps: int) -> Check:
    """H is an ellipse, and p has cusps at exactly the points of H with v_tt = 0."""
    conic, second = model.horizon(), sympy.diff(model.launch_velocity(), t, 2)
    line = sympy.cancel(root_of_line(second, t))
    points = [(root, line.subs(sigma, root)) for root in sympy.Poly(conic.subs(t, line), sigma).real_roots()]
    good = [model.cusp_conditions(point) for point in points]
    return section6_exact.persisting(
        [
            (
                "H is an ellipse (its quadratic form is definite), in lengths that shrink with the distance of the zeros",
                definite(conic + 6, sigma, t) == 1,
            ),
            (
                f"v_tt = 0 on it at {points}, both nondegenerate cusps",
                all(g[0] == g[1] == 0 and 0 not in g[2:] for g in good) and len(points) == cusps,
            ),
        ],
        [
            ("H has no singular point, and its form is definite", section6_exact.regular_conic()),
            *((f"v_ttt v_(sigma t) at {p}", g[2] * g[3]) for p, g in zip(points, good, strict=True)),
        ],
    )


def _second_derivative(order: int) -> Check:
    """The number whose sign distinguishes a positive from a negative swan: a derivative of a_c0 of this order at tau_*."""
    at_rest = -2 * sympy.diff(v_c_swan(3), t).subs(t, 0)  # v_c = -a t/2 + O(t^2)
    values = [sympy.diff(at_rest, sigma, n).subs(sigma, 0) for n in range(3)]
    return every(
        {f"at a swan a = {values[0]}, a' = {values[1]}, a'' = {values[2]}: only a'' has a sign": values[order] != 0},
        witness=lambda: {"a at tau_*": str(values[0]), "a_d2 at tau_*": f"{values[2]}, not 0"},
    )


def _none(sign: int) -> Check:
    """v for a positive swan before the zeros are born: a = 12 kappa (sigma^2 + e), e >= 0."""
    form = sympy.Poly(sympy.expand(sympy.cancel(-model.limit_launch() / (kappa * t))), model.e)
    slope, rest = form.nth(1), form.nth(0)
    positive = definite(rest, sigma, t) == 1 and slope.is_positive and form.degree() == 1
    return section6_exact.persisting(
        [
            (
                f"v = -kappa t ({form.as_expr()}), for e >= 0 positive off the origin: v < 0 for t > 0",
                bool(positive) and sign == -1,
            )
        ],
        [("for e >= 0 the form outweighs terms of higher weight, being definite", bool(positive))],
    )


def _symmetric(stated: int) -> Check:
    v = model.launch_velocity()
    mirrored = v.subs({sigma: -sigma, t: -t}, simultaneous=True)
    return every({"v(-sigma, -t) = -v(sigma, t)": same(mirrored, stated * v)})


def _ends(stated: tuple[int, int]) -> Check:
    slopes = [model.slope_of_acceleration(point[0]) / kappa for point in (model.A, model.B)]
    found = tuple(int(sympy.sign(slope)) for slope in slopes)
    return section6_exact.persisting(
        [(f"a' at A and B is {slopes[0]} kappa and {slopes[1]} kappa", found == stated)],
        [(f"a'({name})", slope * kappa) for name, slope in zip("AB", slopes, strict=True)],
        witness=lambda: {"kappa": "1", "a'(A)": str(slopes[0]), "a'(B)": str(slopes[1])},
    )


def _slopes_of_outline(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """Slope of p(H) at B and at E' = p(E): along H it is dv/dsigma, since v_t = 0 there."""
    rate = sympy.diff(model.launch_velocity(), sigma)
    slopes = tuple(
        sympy.expand(rate.subs({sigma: point[0], t: point[1]}, simultaneous=True)) for point in (model.B, model.E)
    )
    on_both = (
        model.E[1] > 0,
        *[
            sympy.expand(curve.subs({sigma: model.E[0], t: model.E[1]}, simultaneous=True))
            for curve in (model.horizon(), model.zero_set())
        ],
    )
    return section6_exact.persisting(
        [
            (f"E = {model.E} lies on H and Z, and its flight time is positive", on_both == (True, 0, 0)),
            (
                f"slopes {slopes[0]} at B and {slopes[1]} at E'",
                all(is_zero(x - y) for x, y in zip(slopes, stated, strict=True)),
            ),
            ("v = 0 at t = 0, where H goes through B: there the image is tangent to Pi_0", _at_rest_tangent()),
        ],
        [
            ("H and Z cross at E: their Jacobian", section6_exact.crossing(model.E)),
            ("dv/dsigma at E'", slopes[1]),
            ("dH/dsigma at B", section6_exact.at(sympy.diff(model.horizon(), sigma), model.B)),
        ],
    )


def _at_rest_tangent() -> bool:
    """Whether v has the factor t, and H goes through A and B at t = 0, where a vanishes, as it does for any oscillator."""
    at_rest = [sympy.expand(part.subs(t, 0)) for part in (model.launch_velocity(), model.horizon())]
    return at_rest[0] == 0 and same(2 * kappa * at_rest[1], model.acceleration())


def _slopes_of_reset(stated: tuple[sympy.Expr, sympy.Expr, int]) -> Check:
    """Slope of phi(Z) at A and at E'' = phi(E), and the sign of v on phi(AE): phi(Z) = p(iota(Z)), on H again."""
    rate = sympy.diff(model.launch_velocity(), sigma)
    involuted = [(point[0] + point[1], -point[1]) for point in (model.A, model.E)]
    slopes = [sympy.expand(rate.subs({sigma: a, t: b}, simultaneous=True)) for a, b in involuted]
    middle = (-sympy.Rational(7, 5), -2 * -sympy.Rational(7, 5) - sympy.sqrt(6 - 2 * sympy.Rational(49, 25)))
    speed = model.reset(middle)[1].subs(kappa, 1)
    common = _common_points()
    ends = {model.A, model.E} <= set(common) and model.E[1] > 0
    return section6_exact.persisting(
        [
            (
                f"slopes {slopes[0]} at A and {slopes[1]} at E''",
                all(is_zero(x - y) for x, y in zip(slopes, stated[:2], strict=True)),
            ),
            (
                f"Z and H meet at sigma = {', '.join(str(point[0]) for point in common)} only, of which A and E are the ends of the arc, so x-dot keeps its sign on it, which is negative at sigma = -7/5",
                ends
                and not any(model.E[0] < point[0] < model.A[0] for point in common)
                and int(sympy.sign(speed)) == stated[2]
                and is_zero(sympy.expand(model.zero_set().subs({sigma: middle[0], t: middle[1]}, simultaneous=True))),
            ),
        ],
        [
            ("H and Z cross at A: their Jacobian", section6_exact.crossing(model.A)),
            ("H and Z cross at E: their Jacobian", section6_exact.crossing(model.E)),
            ("dv/dsigma at E''", slopes[1]),
        ],
    )


def _common_points() -> list[tuple[sympy.Expr, sympy.Expr]]:
    """The points where Z and H meet, by the factors of their difference, each of which is linear."""
    found = []
    for factor, _ in sympy.factor_list(model.horizon() - model.zero_set(), t)[1]:
        time = root_of_line(factor, t)
        places = sympy.Poly(model.zero_set().subs(t, time), sigma).real_roots()
        found += [(place, sympy.expand(time.subs(sigma, place))) for place in places]
    return sorted(found)


def _gamma(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(low, high) of an interval in which gamma meets Pi_0 again; and at what slope, for every r.

    Next to A, where a' < 0, chatter completes before B (t:foliate); where the first flight lands at B or later the orbit
    leaves.  Both sets of points at rest are open, and what is between tends to B.  Flights of the same orbit land alike:
    along (1, -1) in (sigma, t) the landing stays where it is when v = 0, and v changes by a, which is the slope of gamma.
    """
    low, high = stated
    landing, launch = model.impact_velocity(), model.launch_velocity()
    push = sympy.cancel(model.acceleration() / kappa)
    conic, force = sympy.Poly(model.zero_set(), sigma), model.acceleration()
    turns = [sympy.expand(sympy.diff(speed, sigma) - sympy.diff(speed, t)) for speed in (landing, launch)]
    left_over = [sympy.rem(sympy.Poly(turn, sigma), conic).as_expr() for turn in (turns[0], turns[1] - force)]
    first = min(
        sympy.Poly(model.zero_set().subs(t, 1 - sigma), sigma).real_roots()
    )  # whose flight from rest lands at B
    near_A, at_B = model.slope_of_acceleration(-1), model.value_at_point(landing, (first, 1 - first))
    return section6_exact.persisting(
        [
            (f"from sigma = {first} the flight from rest lands at B, {low} < {first}", bool(low < first < high)),
            (
                f"next to A a' = {near_A}: chatter completes; stated {high}",
                high == -1 and section6_exact.nonzero(near_A),
            ),
            ("with kappa > 0 it is negative", negative_on(near_A, kappa, 0, sympy.oo)),
            ("along (1, -1) x' at the landing is stationary on Z, and v has the slope a", all(map(is_zero, left_over))),
            ("a > 0 for sigma < -1: transverse", positive_on(push, sigma, -sympy.oo, -1)),
        ],
        [("x' where it lands at B", at_B), ("a'(A)", near_A), ("a'(B)", model.slope_of_acceleration(1))],
        modulo=(STABLE,),
    )


def _universal(middle: int) -> Any:
    """-kappa t (6 sigma^2 + 6 e + middle sigma t + t^2)."""
    return -kappa * t * (6 * sigma**2 + 6 * model.e + middle * sigma * t + t**2)


# What is printed and what is corrected, tried on the unfolded swans of two models.

STEP = Fraction(1, 100)  # of the clearance, from c_0


def _side_tried(place: Place, *sides: int) -> Trial:
    """The side of c_0 on which a_c has two zeros near a negative swan."""
    centre = Fraction(float(place.model.replace().clearance.value))  # type: ignore[union-attr]
    counts = [len(tangency_points(place.model.replace(clearance=centre + sign * STEP))) for sign in (-1, 1)]
    side = {(2, 0): -1, (0, 2): 1}.get((counts[0], counts[1]), 0)
    text = f"{counts[0]} for c < c_0, {counts[1]} for c > c_0 = {float(centre):.8g}"
    says = [f"2 for c {'>' if sign > 0 else '<'} c_0" for sign in sides]
    return Trial(place.name, "zeros of a_c", text, says[0], says[1], side == sides[0], side == sides[1])


def _derivative_tried(place: Place, *orders: int) -> Trial:
    """The derivative of a_c0 that is to tell the sign of a swan: it must not vanish at tau_*."""
    values = [float(place.model.acceleration(place.tau, order=order)) for order in orders]
    says = [f"a{chr(39) * order} = {value:.6g}" for order, value in zip(orders, values, strict=True)]
    holds = [abs(value) > 1e-6 for value in values]
    return Trial(place.name, "a negative swan, told by its sign", "a sign", says[0], says[1], holds[0], holds[1])


def _signs_tried(named: tuple[str, Oscillator], printed: tuple[int, int], corrected: tuple[int, int]) -> Trial:
    """Signs of a' at the two zeros of a_c that a positive swan gives birth to."""
    name, model = named
    swan = next(p for p in swan_points_over_clearance(model, (Fraction(-2), Fraction(2))) if p.kind == "positive")
    unfolded = model.replace(clearance=Fraction(swan.clearance) + STEP)
    near = [point for point in tangency_points(unfolded) if abs(point.tau - swan.tau) < 0.5]
    signs = tuple(1 if point.kind == "gamma" else -1 for point in near)
    says = str(printed), str(corrected)
    return Trial(name, "signs of a' at A and B", str(signs), *says, signs == printed, signs == corrected)


TRIALS: dict[str, Trials] = {
    "s6-c-side": at_each(swans, _side_tried),
    "s6-a0-typo": at_each(swans, _derivative_tried),
    "s6p-AB": at_each(true_orbits.MODELS.items, _signs_tried),
}


CLAIMS = {
    "s6-d": Encoding(-1, _birth, (1,)),
    "s6-scaling": Encoding(
        (WEIGHTS, _universal(4)),
        section6_exact.scaling_check,
        ((WEIGHTS, _universal(3)), (Weights(1, 2, 3, 2), _universal(4)), (Weights(1, 1, 4, 3), _universal(4))),
    ),
    "s6-c-side": Encoding(1, _side, (0,), lambda: -1),
    "s6-lips": Encoding(2, _lips, (0, 4)),
    "s6-a0-typo": Encoding(0, _second_derivative, (1,), lambda: 2),
    "s6p-none": Encoding(-1, _none, (1,)),
    "s6-sections": Encoding(-1, _symmetric, (1,)),
    "s6p-AB": Encoding((1, -1), _ends, ((1, 1),), lambda: (-1, 1)),
    "s6p-BE": Encoding(
        (sympy.Integer(0), 24 * kappa),
        _slopes_of_outline,
        ((24 * kappa, 24 * kappa), (sympy.Integer(0), sympy.Integer(0))),
    ),
    "s6p-AE": Encoding(
        (sympy.Integer(0), 24 * kappa, -1),
        _slopes_of_reset,
        ((sympy.Integer(0), 24 * kappa, 1), (sympy.Integer(0), sympy.Integer(0), -1)),
    ),
    "s6p-eps": Encoding(1, section6_exact.epsilon_check, (0, 2)),
    "s6p-gamma": Encoding(
        (-SQRT3, sympy.Integer(-1)),
        _gamma,
        (
            (sympy.Integer(-1), sympy.Integer(1)),
            (sympy.Integer(-3), -SQRT3),
            (-SQRT3, -sympy.Rational(13, 10)),
            (-sympy.Rational(8, 5), sympy.Integer(-1)),
        ),
    ),
}
