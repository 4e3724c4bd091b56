"""Section 4.1(a): the four solutions of the fixed-point equation, and the images of their rays under p and q."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import sympy

from singimpact.algebra.certificates import negative_on, positive_on, value_at
from singimpact.paper.claims.claim import Check, Statement
from singimpact.paper.claims.sections.section4_trials import TRIALS as TRIALS
from singimpact.paper.claims.sections.section4a_blowup import HALF, THREE_HALVES, claim_4a, sign_chain
from singimpact.paper.claims.verifiers import every, is_zero
from singimpact.paper.routes import fold
from singimpact.paper.routes.fold import m
from singimpact.paper.routes.implicit import r, sigma, t


def _ray(low: Any, high: Any) -> dict[str, Any]:
    """Signs along the line eta = m sigma for every root m in (low, high): of v, and of q's first component."""
    velocity = fold.gamma_leading() / fold.k
    rate, _ = fold.h_blown_up()
    return {
        "v": 1 if positive_on(velocity, m, low, high) else -1 if negative_on(velocity, m, low, high) else 0,
        "orientation": 1 if positive_on(rate, m, low, high) else -1 if negative_on(rate, m, low, high) else 0,
    }


def _same_parabola() -> bool:
    """On a ray with Q = m^2 (m - 1/2)^2, q's image is p's image: v = k (9/4 - m^2) sigma^2 again."""
    rate, _ = fold.h_blown_up()
    _, folded = fold.psi_p()
    second = fold.psi_q()[1].subs(fold.eta, m * sigma)
    image = folded.subs(fold.eta, m * rate * sigma)
    return is_zero(sympy.rem(sympy.expand((second - image) / fold.k / sigma**2), fold.fixed_point_factors()[1], m))


def _line(low: Any, high: Any) -> Callable[[tuple[int, int]], Check]:
    """A verifier of (orientation of q against p, sign of v on the image) for every root in (low, high)."""

    def verify(stated: tuple[int, int]) -> Check:
        ray = _ray(low, high)
        return every(
            [
                ("p and q map the line onto one parabola", _same_parabola()),
                (
                    f"q turns it {'round' if ray['orientation'] < 0 else 'the same way'}",
                    ray["orientation"] == stated[0],
                ),
                (f"v is {'positive' if ray['v'] > 0 else 'negative'} on it for k > 0", ray["v"] == stated[1]),
            ],
            witness=lambda: {
                "m in": f"({low}, {high})",
                "orientation": str(ray["orientation"]),
                "sign of v": str(ray["v"]),
            },
        )

    return verify


def _gradient(stated: Any) -> Check:
    """eta = m1 sigma is t = (m1 - 3/2) sigma, and m1 < -3/2."""
    at_zero = fold.fold_coordinate().subs(t, 0)  # eta = t + at_zero
    gradient = sympy.cancel((m * sigma - at_zero) / sigma)
    below = sign_chain(fold.fixed_point_factors()[1], ((-sympy.oo, -1), (-THREE_HALVES, 1)))
    bound = gradient.subs(m, -THREE_HALVES)
    return every(
        [
            (f"the gradient is {gradient}", is_zero(gradient - stated[0])),
            (f"m1 < -3/2, so it is below {bound}", below and bound == stated[1]),
        ]
    )


def _m2_sign(stated: int) -> Check:
    """Sign of v after q o p^{-1} on the image of the m2 line, where v > 0 before."""
    ray = _ray(sympy.Integer(0), HALF)["v"]
    root = sympy.Poly(fold.fixed_point_factors()[1].subs(r, HALF), m).nroots(n=20)[1]
    before = fold.gamma_leading().subs({m: root, fold.k: 1})
    after = _q_velocity(root)
    return every(
        [
            ("p and q map the line onto one parabola", _same_parabola()),
            ("on which v > 0 for k > 0, before and after", ray == stated),
        ],
        witness=lambda: {"r": "1/2", "k": "1", "m2": str(root), "v before": str(before), "v after": str(after)},
    )


def _q_velocity(root: Any) -> Any:
    """v on q's image of (sigma, eta) = (1, root) at r = 1/2, k = 1."""
    _, second = fold.phi()
    point = {sigma: 1, t: root - THREE_HALVES, fold.k: 1, r: HALF}
    return sympy.N((-r * second).subs(point), 20)


def ray_m3(stated: tuple[Any, Any]) -> Check:
    """On the m3 ray v > 0 and p, q agree in orientation; m3 grows from stated[0] to stated[1] with r."""
    low, high = stated
    rule = fold.r_of_m()
    ray = _ray(low, high)
    return every(
        [
            ("v > 0 and the same orientation on the ray", ray == {"v": 1, "orientation": 1}),
            ("t = (m - 3/2) sigma > 0 for sigma < 0", positive_on(THREE_HALVES - m, m, low, high)),
            ("r(m) increases on the interval", positive_on(sympy.diff(rule, m), m, low, high)),
            ("from 0 to 1", value_at(rule, m, low) == 0 and value_at(rule, m, high) == 1),
        ]
    )


CLAIMS = (
    claim_4a(
        "s4-m1",
        "m1: p and q give the image opposite orientations, and it lies in v <= 0",
        Statement(r"m_1<-\tfrac32:\quad v\le0,\ \text{opposite orientations}", (-1, -1)),
        _line(-sympy.oo, -THREE_HALVES),
        ((1, -1), (-1, 1)),
        ("s4-root-places", "e:pdef", "e:defq"),
    ),
    claim_4a(
        "s4-m1-gradient",
        "in (sigma, t) the line of m1 has gradient m1 - 3/2 < -3",
        Statement(r"t=(m_1-\tfrac32)\sigma,\quad m_1-\tfrac32<-3", (m - THREE_HALVES, -3)),
        _gradient,
        ((m + THREE_HALVES, -3), (m - THREE_HALVES, -2)),
        ("s4-root-places", "s4-fold-form"),
    ),
    claim_4a(
        "s4-m2",
        "m2: p and q give the image opposite orientations",
        Statement(r"0<m_2<\tfrac12:\quad\text{opposite orientations}", (-1, 1)),
        _line(sympy.Integer(0), HALF),
        ((1, 1),),
        ("s4-root-places", "e:pdef", "e:defq"),
    ),
    claim_4a(
        "s4-m2-sign",
        "m2: points of the image with v > 0 go to points with v < 0; they stay in v > 0",
        Statement(r"q\circ p^{-1}:\{v>0\}\to\{v<0\}", -1),
        _m2_sign,
        (0,),
        ("s4-m2",),
        lambda: Statement(
            r"q\circ p^{-1}:\{v>0\}\to\{v>0\},\ \sigma\mapsto(m_2-\tfrac12)\sigma\ \text{changes sign}", 1
        ),
    ),
    claim_4a(
        "s4-m3",
        "m3: for t > 0 p and q map the ray into v > 0 with one orientation, and m3 grows from 1/2 to 3/2 with r",
        Statement(r"\tfrac12<m_3<\tfrac32,\quad m_3\nearrow\ \text{as}\ r\nearrow", (HALF, THREE_HALVES)),
        ray_m3,
        ((HALF, sympy.Integer(2)), (sympy.Integer(0), THREE_HALVES)),
        ("s4-root-places", "e:pdef", "e:defq"),
    ),
)
