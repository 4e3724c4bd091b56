"""gamma as a threshold: tau_* - tau_inf = C delta^alpha below it, ln(1/delta)/ln mu impacts above it."""

import sympy

from singimpact.paper.claims.beyond.every_order import j, rising
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section4_orbits import STABLE
from singimpact.paper.claims.verifiers import agree, every
from singimpact.theory.multipliers import launch_velocity

lam, mu = sympy.symbols("lambda mu")
EXPONENT = sympy.log(1 / lam) / sympy.log(mu)
PLANE = "Hartman's theorem in the plane"


def _between(stated: tuple[int, int, int]) -> Check:
    """(p, q, s): p/(q + s j) < ln(1/l)/ln mu < 1 for every j and r.

    It says (P/Q)^(2p) l^(q - p + s j) < 1, and l^j (P/Q)^3 < 1 is the sharp inequality of this form at l = 1.
    """
    p, q, s = stated
    spare = sympy.expand((3 * q + 3 * s * j - p * (3 + 2 * j)).subs(j, j + 1))  # of 3/(3+2j) over p/(q+sj), from j = 1
    enough = p > 0 and all(value >= 0 for value in sympy.Poly(spare, j).all_coeffs())
    weight = sympy.Symbol("w")  # ln(P/Q)/ln(1/l): alpha = 1/(1 + 2w), and 0 < w < j/3
    alpha = 1 / (1 + 2 * weight)
    return every(
        [
            (
                "alpha = ln(1/l)/ln mu = 1/(1 + 2w), w = ln(P/Q)/ln(1/l) > 0 as P > Q: alpha < 1",
                agree(alpha, {weight: 0}, 1),
            ),
            *rising(),
            ("so w < j/3 and alpha > 3/(3 + 2j)", agree(alpha, {weight: j / 3}, 3 / (3 + 2 * j))),
            (f"3/(3 + 2j) is at least {p}/({q} + {s}j) for every j", enough),
        ],
        witness=lambda: _fails(p, q, s),
    )


def _fails(p: int, q: int, s: int) -> dict[str, str]:
    """A contact order at which alpha tends to 3/(3 + 2j) below the stated bound as r -> 1."""
    for order in range(1, 1000):
        if p * (3 + 2 * order) > 3 * (q + s * order):
            limit, bound = sympy.Rational(3, 3 + 2 * order), sympy.Rational(p, q + s * order)
            return {"j": str(order), "limit of alpha as r -> 1": str(limit), "stated bound": str(bound)}
    return {"p": str(p)}


def _scaled() -> tuple[str, bool]:
    """A check: next to the saddle, in coordinates in which G is (S, delta) -> (lambda S, mu delta), S is a unit."""
    h, start, end = sympy.symbols("h s e")
    speeds = {k + 1: launch_velocity(k, start, end) for k in (1, 2, 3)}
    return "in the limit flights, and so the ends of chatter, scale with S", all(
        agree(speed, {start: h * start, end: h * end}, h**n * speed) for n, speed in speeds.items()
    )


def _slopes(stated: sympy.Expr) -> Check:
    """The exponent of delta, in lambda and mu: S is lambda^n S where mu^n delta has come to a fixed size."""
    left = sympy.cancel(sympy.expand_log(stated * sympy.log(mu) + sympy.log(lam), force=True))
    return every([_scaled(), (f"lambda^n = delta^({stated}) where mu^n delta = 1", left == 0)], modulo=(STABLE, PLANE))


def _counts(stated: int) -> Check:
    """The number of additional impacts when delta is divided by mu: those that take delta/mu to delta."""
    text = f"mu^{stated} takes delta/mu to delta; from there on the orbits are next to each other, S beside lambda S"
    return every([_scaled(), (text, mu**stated == mu)], modulo=(STABLE, PLANE))


CLAIMS = {
    "b:holder-bounds": Encoding((3, 3, 2), _between, ((3, 3, 1), (3, 2, 2), (4, 3, 2), (1, 2, 0))),
    "b:holder": Encoding(
        EXPONENT,
        _slopes,
        (sympy.Rational(1, 2), 1 / EXPONENT, EXPONENT / 2, sympy.Integer(1), 3 * EXPONENT / (2 + EXPONENT)),
    ),
    "b:holder-count": Encoding(1, _counts, (0, 2)),
}
