"""Section 6: statements about the universal model that polynomials decide, for every r in (0, 1).

What is visible (its boundary by conics, each cell of the plane by a rational point in it), first hits from rest, how
often R phi(AE) meets the outline, and that chatter is complete beyond B where a < 0.  Before these: how an oscillator
near a swan follows the universal model, and by which conditions what holds there persists.

In lengths scaled by H the velocities of an oscillator are those of the model plus H times smooth functions, on bounded
sets.  So a simple zero, a transverse crossing, a nondegenerate cusp and an inequality that is strict on a closed set
persist for small H: each by the implicit function theorem or by compactness, once a number is not 0.  `near_the_swan`
decides these numbers.  Where a quadratic form is definite, nothing else is near the swan either: it outweighs the rest.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import combinations, pairwise
from typing import Any, NamedTuple

import sympy

from singimpact.algebra import At, definite, negative_on, positive_in, sign_chain, substitution, value_at
from singimpact.paper.claims.claim import Check
from singimpact.paper.claims.verifiers import every, same
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.unfolding import Weights, kappa, r, sigma, t, u, w

Named = Sequence[tuple[str, Any]]


def near_the_swan(check: Check, conditions: Named) -> Check:
    """A check in the model with the conditions by which its statement persists: it fails where one does not hold.

    Parameters
    ----------
    conditions : (what, value): a value that must not be 0 for any kappa but 0, or whether the condition holds.
    """
    conditions_ = [
        (f"{what} holds", value) if isinstance(value, bool) else (f"{what} = {value}", nonzero(value))
        for what, value in conditions
    ]
    failed = [name for name, holds in conditions_ if not holds]
    if not conditions or failed:
        return replace(check, holds=False, evidence=f"{check.evidence}; does not persist near the swan: {failed}")
    persists = f"persists near the swan for small H, since {'; '.join(name for name, _ in conditions_)}"
    return replace(check, evidence=f"{check.evidence}; {persists}", transverse=tuple(name for name, _ in conditions_))


def persisting(
    checks: Sequence[tuple[str, bool]],
    conditions: Named,
    witness: Callable[[], dict[str, str]] | None = None,
    modulo: tuple[str, ...] = (),
) -> Check:
    """One check in the model from several named ones, with the conditions by which its statement persists.

    Parameters
    ----------
    checks, witness, modulo : as of `every`. conditions : as of `near_the_swan`.
    """
    return near_the_swan(every(checks, witness=witness, modulo=modulo), conditions)


def nonzero(value: sympy.Expr) -> bool:
    """Whether a number times a power of kappa is not 0; other expressions are not decided, and count as 0.

    Examples
    --------
    >>> nonzero(-24 * sympy.sqrt(3) * kappa), nonzero(kappa - kappa), nonzero(kappa + 1)
    (True, False, False)
    """
    terms = sympy.Poly(sympy.expand(value), kappa).terms()
    return len(terms) == 1 and bool(terms[0][1].is_number) and terms[0][1] != 0


def at(expression: Any, point: tuple[sympy.Expr, sympy.Expr]) -> Any:
    """An expression in (sigma, t) at a point."""
    return sympy.expand(sympy.sympify(expression).subs({sigma: point[0], t: point[1]}, simultaneous=True))


def crossing(point: tuple[sympy.Expr, sympy.Expr]) -> Any:
    """The Jacobian of the horizon and the zero set at a point: not 0 where they cross transversely."""
    return at(sympy.Matrix([model.horizon(), model.zero_set()]).jacobian([sigma, t]).det(), point)


def regular_conic() -> bool:
    """Whether the horizon has no singular point, and nothing of it is near a swan outside the region of its ellipse.

    It is a definite form less 6, and sigma d/dsigma + t d/dt takes it to twice this form, which is 12 on the horizon.
    """
    conic = model.horizon()
    grown = sigma * sympy.diff(conic, sigma) + t * sympy.diff(conic, t)
    return same(grown, 2 * conic + 12) and definite(conic + 6, sigma, t) == 1


def scaling_check(stated: tuple[Weights, Any]) -> Check:
    """The powers of H, and the launch velocity to which that of any oscillator tends, as a polynomial in (sigma, t, e)."""
    weights, leading = stated
    try:
        limit, rest = model.scaled(weights)
        near = model.leading_launch(weights)
    except ArithmeticError as error:
        return Check(False, "proved", str(error), {"weights": str(tuple(weights))})
    height = model.y * t - t * model.limit_launch()  # of the model, at t: x - c = t (x' - v) for the launch x'
    checks = every(
        [
            (
                f"x'' = {limit} + H ({rest}) in scaled lengths, with smooth functions alpha, phi_1, phi_2: smooth at H = 0",
                limit == model.limit_acceleration() and sympy.sympify(rest).is_polynomial(model.H),
            ),
            (f"the model's launch velocity is {sympy.factor(leading)}", same(leading, model.limit_launch())),
            ("it is the leading part of v_c of any oscillator, to all jets", same(near, leading)),
        ],
        witness=lambda: {"kappa": "1", "limit": str(limit), "v": str(sympy.factor(near))},
    )
    slope = sympy.diff(sympy.cancel(height / t), model.y)
    return near_the_swan(checks, [("dy/dv of y = (x - c)/t in the model, at every time", slope)])


# Statements about the universal model.

z = sympy.Symbol("z")
NARROW = sympy.Rational(1, 1000)  # width of the intervals that isolate roots, between which samples are taken
OUTLINE, LANDING = (1 - 4 * z) ** 2 * (1 + 2 * z), (1 + 4 * z) ** 2 * (1 - 2 * z)  # p(BE) and phi(AE) over w z
MEET = (w**2 * (1 + 2 * z**2) - 18, w)  # sigma = w z, t = w (1 - 4 z)/3 runs through H with this w


class Arc(NamedTuple):
    """Part of a conic in (sigma, t): the points at times between two, where a linear function is positive."""

    conic: Any
    side: Any
    low: Any
    high: Any


ADCBA = (  # AD on the horizon, DC on the shadow, CB on the zero set; BA lies on t = 0
    Arc(6 * sigma**2 + 8 * sigma * t + 3 * t**2 - 6, -3 * sigma - 2 * t, sympy.Integer(0), sympy.Integer(4)),
    Arc(8 * sigma**2 + 8 * sigma * t + 3 * t**2 - 24, sympy.Integer(1), sympy.Integer(4), sympy.oo),
    Arc(6 * sigma**2 + 4 * sigma * t + t**2 - 6, 3 * sigma + t, sympy.Integer(0), sympy.Integer(4)),
)


def ends(arc: Arc) -> list[tuple[sympy.Expr, sympy.Expr]]:
    """The points at which an arc ends, at its lowest and its highest time; an ellipse closes by itself at infinity."""
    times = [time for time in (arc.low, arc.high) if time.is_finite]
    roots = [(place, time) for time in times for place in sympy.Poly(arc.conic.subs(t, time), sigma).real_roots()]
    return [(place, time) for place, time in roots if arc.side.subs({sigma: place, t: time}) > 0]


def visible_check(stated: tuple[Sequence[Arc], int]) -> Check:
    """A point with v > 0 is visible where the number of arcs to its left is even (0) or odd (1), for kappa < 0.

    On a flight x - c = kappa u (u - t) q(u) and q is quadratic in u, so the point is hidden where q has a root in
    (0, t).  Such a root comes and goes where q(0) = 0, q(t) = 0 or the discriminant of q is 0, and a point goes through
    the loop on one of its conics; so one point in each cell between these conics decides the cell.
    """
    arcs, parity = stated
    q = model.cofactor()
    conics = {sympy.expand(polynomial) for polynomial in (q.subs(u, 0), q.subs(u, t), sympy.discriminant(q, u))}
    corners = [end for arc in arcs for end in ends(arc)]
    closed = all(corners.count(end) == 2 - (end[1] == 0) for end in corners)
    points = [p for p in _cells([*conics, *(arc.conic for arc in arcs)]) if q.subs(u, 0).subs(p) > 0]
    hidden = [bool(sympy.Poly(q.subs(p), u).count_roots(0, p[t])) for p in points]
    inside = [sum(_left_of(p, arc) for arc in arcs) % 2 for p in points]
    wrong = sum((odd == parity) != (not gone) for odd, gone in zip(inside, hidden, strict=True))
    return every(
        {
            "q(0) is Z and q(t) is H": same(q.subs(u, 0), model.zero_set()) and same(q.subs(u, t), model.horizon()),
            f"the arcs end at {sorted(set(corners))}, and follow one another there": closed and len(corners) == 6,
            f"of {len(points)} cells with v > 0 that the conics Z, H and shadow cut out {sum(hidden)} are hidden, "
            f"{wrong} not as said": wrong == 0 and 0 < sum(hidden) < len(points),
        },
        witness=lambda: _first_wrong(points, hidden, inside, parity),
    )


def _first_wrong(points: Sequence[Any], hidden: Sequence[bool], inside: Sequence[int], parity: int) -> dict[str, str]:
    for point, gone, odd in zip(points, hidden, inside, strict=True):
        if (odd == parity) == gone:
            return {"sigma": str(point[sigma]), "t": str(point[t]), "hidden": str(gone)}
    return {"the arcs": "do not close"}


def _cells(conics: Iterable[Any]) -> list[dict[Any, Any]]:
    """A rational point in each cell of t > 0 into which the conics cut it: between any two heights of a crossing or of a
    vertical tangent the conics are graphs that do not meet."""
    curves = sorted({sympy.Poly(conic, sigma, t, domain="QQ").primitive()[1].as_expr() for conic in conics}, key=str)
    curves = [curve for n, curve in enumerate(curves) if -curve not in curves[:n]]
    turns = [sympy.discriminant(curve, sigma) for curve in curves]
    meets = [sympy.resultant(one, two, sigma) for one, two in combinations(curves, 2)]
    cells = []
    for time in _between([*turns, *meets, t], t):
        if time > 0:
            cells += [{sigma: phase, t: time} for phase in _between([curve.subs(t, time) for curve in curves], sigma)]
    return cells


def _between(polynomials: Iterable[Any], variable: sympy.Expr) -> list[Any]:
    """Rational numbers between the real roots of polynomials, and beyond them."""
    product = sympy.Poly(sympy.prod(polynomials), variable, domain="QQ")
    squarefree = sympy.prod([factor for factor, _ in product.factor_list()[1]], start=sympy.Poly(1, variable))
    gaps = [interval for interval, _ in squarefree.intervals(eps=NARROW)]  # isolating, with rational ends
    if not gaps:
        return [sympy.Integer(0)]
    inner = [_inside(squarefree, left, right) for (_, left), (right, _) in pairwise(gaps)]
    return [gaps[0][0] - 1, *inner, gaps[-1][1] + 1]


def _inside(polynomial: Any, low: sympy.Expr, high: sympy.Expr) -> Any:
    """A rational number in [low, high] that is no root; all roots nearby lie outside."""
    for share in (sympy.Rational(1, 2), sympy.Rational(1, 3), sympy.Rational(2, 3)):
        place = low + share * (high - low)
        if polynomial.eval(place) != 0:
            return place
    raise ArithmeticError(f"no rational number was found between the roots at {low} and {high}")


def _left_of(point: dict[Any, Any], arc: Arc) -> int:
    """The number of points of an arc that lie at the height of a point, to its left."""
    if not arc.low < point[t] < arc.high:
        return 0
    line = sympy.Poly(arc.conic.subs(t, point[t]), sigma)
    side = sympy.Poly(arc.side.subs(t, point[t]), sigma)
    if side.degree() == 0:
        return int(line.count_roots(None, point[sigma]))
    edge = -side.nth(0) / side.nth(1)
    if side.LC() < 0:
        return int(line.count_roots(None, min(edge, point[sigma])))
    return int(line.count_roots(edge, point[sigma])) if edge < point[sigma] else 0


def interval_check(stated: tuple[object, object]) -> Check:
    """F takes AB, at rest with a > 0, to the arc of Z with t > 0 that runs from stated[0] to stated[1]; kappa < 0."""
    conic = model.zero_set()
    product, total = (sympy.Poly(conic, t).nth(n) for n in (0, 2))
    heights = tuple((end, max(sympy.Poly(conic.subs(sigma, end), t).real_roots())) for end in (-1, 1))
    rise = sympy.diff(conic, t)
    return persisting(
        [
            (
                "where v = 0 x - c is kappa u^2 Z(sigma, u), so the first hit is the first positive u with Z(sigma, u) = 0",
                same(model.height(u), model.launch_velocity() * u + kappa * u**2 * model.zero_set().subs(t, u)),
            ),
            (
                "the two values of t on Z have a negative product for -1 < sigma < 1, so one is positive",
                negative_on(product, sigma, -1, 1) and total.is_positive,
            ),
            (f"the arc runs from {heights[0]} to {heights[1]}", heights == stated),
        ],
        [
            ("dZ/dt at C", at(rise, model.C)),
            ("dZ/dt at B", at(rise, model.B)),
            ("dZ/dsigma at A", at(sympy.diff(conic, sigma), model.A)),
            ("dZ/dsigma at B", at(sympy.diff(conic, sigma), model.B)),
            ("Z has a definite form", definite(conic + 6, sigma, t) == 1),
        ],
    )


def chatter_check(stated: Any) -> Check:
    """A is at rest at the start of a flight to C; from phi(C) on chatter is complete at X > stated, for every r in (0, 1).

    With t' of the next flight r x'(sigma, t) = v(sigma + t, t'), up to the sign of the two.
    """
    landing, speed = model.reset(model.C)
    launch = sympy.expand(sympy.cancel(model.launch_velocity() / (-kappa * t)))
    impact = sympy.expand(sympy.cancel(model.impact_velocity() / (kappa * t)))
    after = {sigma: (1, sympy.oo), t: (0, sympy.oo)}
    next_launch = launch.subs({sigma: sigma + t, t: r * t}, simultaneous=True)
    excess = sympy.expand(sympy.cancel((next_launch - impact) / t))
    return near_the_swan(
        every(
            [
                (
                    f"phi(C) = {(landing, speed)}: v > 0 after the impact for kappa < 0",
                    negative_on(speed, kappa, -sympy.oo, 0),
                ),
                (
                    "for sigma > 1 every flight ends at its t: q > 0 for u > 0",
                    positive_in(model.cofactor(), after | {u: (0, sympy.oo)}),
                ),
                ("for sigma > 1 v rises with t", positive_in(sympy.expand(sympy.diff(t * launch, t)), after)),
                (
                    "v(sigma + t, r t) exceeds the velocity after the impact: each flight is shorter than r times the last",
                    positive_in(excess, after | {r: (0, 1)}),
                ),
                (
                    f"so X lies beyond {landing}, which is more than {stated}, and nearer than any larger place as r -> 0; "
                    "a(X) has the sign of kappa",
                    landing == model.C[0] + model.C[1]
                    and bool(stated <= landing)
                    and positive_in(model.acceleration().subs(kappa, 1), {sigma: (1, sympy.oo)}),
                ),
            ]
        ),
        [
            ("at t = 0 the excess over t", value_at(excess.subs({sigma: landing, r: 0}), t, 0)),
            ("x' at phi(C)", speed),
            ("dZ/dt at C", at(sympy.diff(model.zero_set(), t), model.C)),
        ],
    )


def epsilon_check(stated: int) -> Check:
    """The number of points at which R phi(AE) meets the outline p(BE) over AB, for every r in (0, 1).

    BE is sigma = w z, t = w (1 - 4 z)/3 for -1/2 <= z <= 1/4, where w > 0 and w^2 (1 + 2 z^2) = 18.  AE is launched at
    sigma = -w (1 + z)/3 and takes t = w (1 + 4 z)/3 to w z, for -1/4 <= z <= 1/2.  So both curves are over w z.
    """
    third = sympy.Rational(1, 3)
    on_be, on_ae = {sigma: w * z, t: third * w * (1 - 4 * z)}, {sigma: -third * w * (1 + z), t: third * w * (1 + 4 * z)}
    unit = sympy.Rational(2, 27) * kappa * w**3
    held = [
        _on_conic(model.horizon(), on_be, 0),
        _on_conic(model.zero_set(), on_ae, 0),
        _on_conic(model.launch_velocity(), on_be, unit * OUTLINE),
        _on_conic(model.impact_velocity(), on_ae, -unit * LANDING),
        sympy.expand(on_ae[sigma] + on_ae[t] - w * z) == 0,
    ]
    quarter = sympy.Rational(1, 4)
    difference = sympy.expand(OUTLINE - r * LANDING)
    changes = sign_chain(difference, z, ((-quarter, 1), (quarter, -1)), {r: (0, 1)})
    falls = positive_in(-sympy.diff(difference, z), {z: (-quarter, quarter), r: (0, 1)})
    bend = value_at(LANDING / (1 + 4 * z) ** 2, z, -quarter)
    return persisting(
        [
            (f"v = {OUTLINE} on p(BE), r ({LANDING}) on R phi(AE), in units of {unit}, at sigma = w z", all(held)),
            (
                f"their difference {difference} falls from z = -1/4, A, to z = 1/4, B, and changes its sign once, for 0 < r < 1",
                changes and falls and stated == 1,
            ),
            (f"v = {bend} (1 + 4 z)^2 + ... on phi(AE) at A: tangent to Pi_0", bool(bend > 0)),
        ],
        [
            ("the difference falls where it is 0", falls),
            ("H and Z cross at A: their Jacobian", crossing(model.A)),
            ("H and Z cross at E: their Jacobian", crossing(model.E)),
        ],
    )


def _on_conic(expression: sympy.Expr, place: dict[Any, Any], value: Any) -> bool:
    """Whether a function is what is said where w^2 (1 + 2 z^2) = 18, with its certificate."""
    difference = sympy.expand(expression.subs(place, simultaneous=True) - value)
    if not sympy.rem(sympy.Poly(difference, w), sympy.Poly(MEET[0], w)).is_zero:
        return False
    substitution(At(expression, place), sympy.sympify(value), where=MEET)
    return True
