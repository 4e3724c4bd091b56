"""Section 4.1(b): what orbits near a tangency with a' < 0 do, and the leaves that fill a neighbourhood."""

from itertools import pairwise
from typing import Any

import sympy

from singimpact.algebra.certificates import positive_in
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections import section4_orbits as orbits
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS
from singimpact.paper.claims.sections.section4b import vanish_at_launch
from singimpact.paper.claims.verifiers import agree, every, is_zero
from singimpact.paper.routes import fold
from singimpact.paper.routes.fold import k
from singimpact.paper.routes.implicit import X, r, sigma, t
from singimpact.paper.trials import arcs


def _iterates(stated: int) -> Check:
    """The limit of the largest v over the iterates of p(alpha): flights shorten by a factor below 1, and v < C t."""
    return every(
        [
            *orbits.shortening(1, -1),
            (
                "v_c has the factor t, so v <= C t falls to 0 as fast, at once for all launches near w_*",
                vanish_at_launch(),
            ),
            ("so the limit is 0", stated == 0),
        ]
    )


def _backwards(stated: Any) -> Check:
    """For which sigma the stable manifold of (tau_* + sigma, 0) has a point (tau', 0), tau' < tau_*: those > 0.

    The time E(w) at which chatter from w ends is continuous, as a uniform limit.  On Pi_0 it is > 0 before tau_* and tends
    to 0 there, so it takes each small value > 0; it takes no other.
    """

    def trial() -> tuple[str, bool]:
        found = arcs.leaves()
        shown = ", ".join(f"{case.foot:.3g} -> {case.end:.5g}" for case in found[:3])
        models = {case.name for case in found}
        ratios = [[case.end / case.foot for case in found if case.name == name] for name in models]
        shrinking = all(abs(one / two - 1) < 0.02 for row in ratios for one, two in pairwise(row))
        name = f"the leaf of sigma > 0 of true orbits ends at sigma' < 0 (sigma -> sigma': {shown}), in a ratio that settles"
        return name, all(case.end < 0 for case in found) and shrinking

    return every(
        [
            *orbits.shortening(1, -1),
            *orbits.edge(),
            (
                "the end of chatter depends continuously on the launch, is > 0 from rest at sigma' < 0 and -> 0 as sigma' -> 0: "
                "it takes the values sigma > 0 and no other",
                [bool(stated.subs(sigma, value)) for value in (-1, 0, 1)] == [False, False, True],
            ),
        ],
        tried=trial,
        witness=lambda: {
            "sigma": "0",
            "sigma'/sigma as sigma -> 0": ", ".join(
                f"{case.end / case.foot:.4f} at {case.foot:.3g}" for case in arcs.leaves()[:3]
            ),
        },
    )


def _foliated(stated: tuple[int, int]) -> Check:
    """Signs of the ends of a leaf: the level sets of the time E at which chatter ends, one for each small value > 0.

    E(sigma, v) is continuous and increases strictly with v, so a level is a graph v = V(sigma) over the interval between
    its two points on Pi_0: sigma = E > 0, at rest, and the sigma' < 0 from which chatter ends there.

    From rest at sigma' < 0 the first hit is behind tau_*, and E behind it; from rest at sigma >= 0 E is sigma.
    """
    landed = sympy.cancel(fold.phi()[0].subs(t, -3 * sigma) / sigma)

    def trial() -> tuple[str, bool]:
        ends = arcs.leaves()
        ordered = all(abs(one.end) > abs(two.end) for one, two in pairwise(ends) if one.name == two.name)
        name = f"true orbits: {len(ends)} leaves on two models, nested: one with a smaller foot lies inside"
        return name, ordered and all((case.foot > 0, case.end < 0) == (True, True) for case in ends)

    return every(
        [
            *orbits.shortening(1, -1),
            *orbits.edge(),
            *orbits.monotone(),
            (
                "so the level sets of the end of chatter are arcs v = V(sigma) from sigma > 0 to sigma' < 0 on Pi_0, and fill "
                "a neighbourhood",
                (-sympy.sign(landed), sympy.sign(landed)) == stated,
            ),
        ],
        tried=trial,
    )


def _smoothly(stated: Any) -> Check:
    """Where the leaves are smooth: v > 0, as preimages under G of leaves next to Pi_0.

    G is a local diffeomorphism where v > 0 before and after the flight: p is one where dv_c/dt > 0, and phi folds on v = 0
    alone.
    """
    launch = sympy.expand(fold.p()[1] / -k)
    inside = sympy.expand(sympy.diff(launch, t).subs(sigma, X - t / 3))
    landing = sympy.expand(fold.phi()[1] / k)
    jacobian = sympy.expand(sympy.diff(landing, t) - sympy.diff(landing, sigma))  # of (sigma + t, landing velocity)
    vanishes = sympy.cancel(jacobian / (3 * sigma + t))
    return every(
        [
            (
                "dv_c/dt > 0 in the sector, so p is a local diffeomorphism there",
                positive_in(inside, {X: (0, sympy.oo), t: (0, sympy.oo)}),
            ),
            (
                f"det Dphi = {jacobian} k vanishes where v_c = 0 alone, 3 sigma + t = 0",
                bool(vanishes.is_number and vanishes != 0) and agree(X * (3 * sigma + t), {X: vanishes}, jacobian),
            ),
            (
                "next to a point at rest with a < 0 the leaves are smooth (s3-takens), so their preimages with v > 0 are",
                [bool(stated.subs(X, value)) for value in (-1, 0, 1)] == [False, False, True],
            ),
        ]
    )


def _epsilon(stated: tuple[int, sympy.Expr]) -> Check:
    """G of (tau_* + sigma, 0), sigma < 0: the flight lands where 3 sigma + t = 0."""
    first, second = fold.phi()
    landed = first.subs(t, -3 * sigma)
    speed = sympy.cancel((-r * second).subs(t, -3 * sigma) / landed**2)
    return every(
        [
            (
                f"it lands at {landed} (sigma < 0, so on the other side) with v = {speed} sigma'^2",
                is_zero(landed + 2 * sigma) and stated[0] == 1 and is_zero(speed - stated[1]),
            ),
            (
                "v > 0 for k < 0 and every r in (0, 1), quadratically tangent to Pi_0",
                positive_in(speed, {k: (-sympy.oo, 0), r: (0, 1)}),
            ),
        ]
    )


CLAIMS = {
    "s4b-contraction": Encoding(0, _iterates, (1,)),
    "s4b-back": Encoding(sigma >= 0, _backwards, (sigma < 0, sigma <= 0), lambda: sigma > 0),
    "t:foliate": Encoding((1, -1), _foliated, ((1, 0), (0, -1))),
    "t:foliate-smooth": Encoding(X > 0, _smoothly, (X >= 0, X < 0)),
    "s4b-eps": Encoding(
        (1, -sympy.Rational(9, 4) * r * k),
        _epsilon,
        ((-1, -sympy.Rational(9, 4) * r * k), (1, sympy.Rational(9, 4) * r * k)),
    ),
}
