"""Section 6: what the regions of an unfolded swan are bounded by, and where the two maps have cusps beside A and B."""

from itertools import pairwise
from typing import Any

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section6 import TRIALS as TRIALS
from singimpact.paper.claims.sections.section6_exact import crossing, persisting
from singimpact.paper.claims.sections.section6_negative import cusp_above
from singimpact.paper.claims.verifiers import every, is_zero, same
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.unfolding import kappa, sigma, t
from singimpact.paper.trials import universal_orbits


def _over(conic: sympy.Expr, direction: sympy.Expr, ends: tuple[tuple[Any, Any], tuple[Any, Any]]) -> bool:
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


# Section 6: stable manifolds of an unfolded swan, on true orbits of its universal model.

RATES = ("1/10", "1/2", "9/10")


def _separated(stated: tuple[bool, bool]) -> Check:
    """Whether chatter is complete before B, and so on AB, below gamma, and above it; otherwise orbits leave S'."""
    parts = []
    for rate in RATES:
        lines = universal_orbits.fates(rate)
        changes = {line: sum(one != other for one, other in pairwise(feet)) for line, feet in lines.items()}
        below = [feet[0] for line, feet in lines.items() if changes[line]]
        above = [feet[-1] for line, feet in lines.items() if changes[line]]
        parts.append(
            (
                f"r = {rate}: over {len(lines)} lines in S' the end changes {list(changes.values())} times as v rises, "
                "from chatter that is complete on AB to orbits that pass B",
                set(changes.values()) == {0, 1} or set(changes.values()) == {1},
            )
        )
        as_stated = bool(below) and set(below) == {stated[0]} and set(above) == {stated[1]}
        parts.append((f"below it is complete: {set(below)}; above: {set(above)}", as_stated))
        passing = [feet for line, feet in lines.items() if not changes[line]]
        parts.append(("a line without a change is left of gamma: all of it leaves", not any(map(any, passing))))
    return every(parts, kind="supported")


def _crossed(stated: int) -> Check:
    """The sign of the derivative, along R(D''C'') from C'' to B, of the phase at which chatter ends."""
    feet = {rate: universal_orbits.feet_on_the_landing_arc(rate) for rate in RATES}
    text = "; ".join(f"{min(rates):.4f} to {max(rates):.4f} for r = {rate}" for rate, rates in feet.items())
    return every(
        [
            (
                f"per length of the arc the end of chatter changes by {text}: no stable manifold touches it",
                all(rate * stated > 0 for rates in feet.values() for rate in rates),
            ),
        ],
        kind="supported",
    )


def _beyond(stated: tuple[int, int]) -> Check:
    """The sign of the excess of feet over X at discontinuities, and crossings gained by each that comes into reach."""
    counts = universal_orbits.beyond()
    sign, gain = stated
    return every(
        [
            (
                f"next to delta and its first inverse images, on both sides, orbits rest at {max(map(max, counts.tears)):.2g} "
                "from X at most: W^s(Y), Y > X, meets none of them",
                all(side * sign > 0 for sides in counts.tears for side in sides),
            ),
            (
                f"W^s(Y) for Y - X = {counts.excess} crosses the line sigma = -1.02 {counts.crossings} times: once up and "
                "down between two more of them each time",
                counts.crossings == tuple(gain * count for count in range(len(counts.crossings))),
            ),
        ],
        kind="supported",
    )


LEAVES = {
    "s6p-separates": Encoding((True, False), _separated, ((False, True), (True, True))),
    "s6n-transverse": Encoding(-1, _crossed, (1, 0)),
    "s6n-Y": Encoding((-1, 2), _beyond, ((1, 2), (-1, 1), (-1, 3))),
}

CLAIMS = REGIONS | LEAVES
