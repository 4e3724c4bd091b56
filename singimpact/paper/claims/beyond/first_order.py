"""The first correction to the blown-up map, removed at every contact order; what is left of it at an unfolded swan."""

from math import factorial
from typing import Any

import sympy

from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section3 import NORMALLY_HYPERBOLIC
from singimpact.paper.claims.verifiers import every, is_zero, same, sample
from singimpact.paper.routes import first_order as route
from singimpact.paper.routes.first_order import A2, A3, Change, damping, first, h, j, s, second
from singimpact.theory import generic_sheet, launch_velocity

X = sympy.Symbol("X")
SHOWN = 3  # contact orders at which v_c is compared beside the identity for every j


def _removed(stated: sympy.Expr) -> Check:
    """alpha in S = s + alpha s^2, as a function of j and of the jets."""
    change = route.removal()
    derived = sympy.cancel(change.time / s**2)
    enough = [_weight(i, k) for i, k in ((1, 0), (2, 0), (1, 1), (0, 2))]
    compared = [_sheet_agrees(order, change) for order in range(1, SHOWN + 1)] if same(stated, derived) else []
    return every(
        [
            (f"Y'' = a_j S^j + O(h^2) for every j with alpha = {derived}", same(stated, derived)),
            (
                f"beside f_v x' the force x^i x'^k is smaller by h^w, w = {', '.join(map(str, enough))} for (i, k) = "
                "(1, 0), (2, 0), (1, 1), (0, 2)",
                all(min(sympy.Poly(weight - 2, j).all_coeffs()) >= 0 for weight in enough) and _weight(0, 1) == 1,
            ),
            (f"v_c of j = 1..{SHOWN} is the transformed one to two orders", bool(compared) and all(compared)),
        ],
        witness=lambda: sample(stated, derived),
    )


def _weight(i: int, k: int) -> Any:
    """The power of h of x^i x'^k beside a_j s^j, with s, x, x' scaled by h, h^(j+2), h^(j+1)."""
    return sympy.expand(i * (j + 2) + k * (j + 1) - j)


def _sheet_agrees(order: int, change: Change) -> bool:
    """Whether v_c to two degrees is the homogeneous one in the new time and height: v = V dS/ds/(1 + beta s)."""
    sheet = generic_sheet(order, order + 2)
    jets = {first: sympy.Symbol(f"a_d{order}") / factorial(order), damping: sympy.Symbol("f_01")}
    jets[second] = sympy.Symbol(f"a_d{order + 1}") / factorial(order + 1)
    moved, higher = (term.subs({j: order} | jets) for term in change)
    sigma, t = sympy.symbols("sigma t")
    start, end = (time + h * moved.subs(s, time) for time in (sigma, sigma + t))
    tempo, scale = (1 + h * term.subs(s, sigma) for term in (sympy.diff(moved, s), higher))
    stated = route.truncated(jets[first] * launch_velocity(order, start, end) * tempo / scale)
    by_degree = sympy.expand(sheet.to_sympy(sheet.v).subs({sigma: h * sigma, t: h * t}, simultaneous=True))
    return is_zero(sympy.expand(stated - by_degree / h ** (order + 1)))


def _shifted(stated: sympy.Expr) -> Check:
    """X_H - X to first order in H, in f_v and the derivatives A2, A3 of a_c at the swan point."""
    change = route.swan_removal()
    derived = sympy.factor(-change.time.subs(s, X))
    ends = [change.time.subs(s, edge) for edge in (-1, 1)]
    return every(
        {
            f"S takes X_H to X, so X_H - X = {derived} H + O(H^2)": same(stated, derived),
            "A and B stay at -1 and 1": all(end == 0 for end in ends),
        },
        witness=lambda: sample(stated, derived),
        modulo=(NORMALLY_HYPERBOLIC,),  # Pi_0 behind B: the foot is a smooth function of the state and of H
    )


ALPHA = (2 * second + first * damping) / (2 * (j + 3) * first)
CHI = damping + 2 * A3 / (3 * A2)

CLAIMS = {
    "b:first-order": Encoding(
        ALPHA,
        _removed,
        (
            ALPHA * (j + 3) / (j + 2),
            ALPHA - damping / (j + 3),
            ALPHA + second / (j + 3) / first,
            ALPHA.subs(j, 2),
            sympy.Integer(0),
        ),
    ),
    "b:first-order-foot": Encoding(
        -CHI * (X**2 - 1) / 10,
        _shifted,
        (
            CHI * (X**2 - 1) / 10,
            -CHI * (X**2 - 1) / 5,
            -CHI * (X + 1) ** 2 / 10,
            -(damping + A3 / (3 * A2)) * (X**2 - 1) / 10,
            -(damping - 2 * A3 / (3 * A2)) * (X**2 - 1) / 10,
        ),
    ),
}
