"""The loops of W^s(X) at an unfolded negative swan: their heights next to A are algebraic in r.

Next to A the motion is x'' = a'(A) sigma in the limit.  In units of a'(A) sigma^2 a velocity is a height w, and with
the ratio l of landing and launch time w = (1 - l)(2 + l)/6.
"""

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.paper.claims.beyond.holder import PLANE
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section3 import NORMALLY_HYPERBOLIC
from singimpact.paper.claims.sections.section6_exact import persisting
from singimpact.paper.claims.sections.section6_loops import (
    HALF,
    TEAR,
    THIRD,
    at_A,
    edges_beside_A,
    ell,
    excess,
    falling_heights,
    height,
    inner,
    r,
    s,
    v,
    w,
)
from singimpact.paper.claims.verifiers import root_of_line, same
from singimpact.theory.multipliers import P, lambda_

lam, mu = sympy.symbols("lambda mu")


def _map(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """(height on W^s(X) above the tear, height of the tear, polynomial in (l, r) of the height below it)."""
    outer, tear, polynomial = stated
    above, graze, below = edges_beside_A()
    turn = root_of_line(sympy.diff(height(ell), ell), ell)
    passed, landed = excess(sympy.Integer(-1), graze), excess(-turn, sympy.Integer(0))
    substitution(At(-6 * height(ell) + w, {ell: lambda_, w: (1 - lambda_) * P(1)}), sympy.Integer(0))
    return persisting(
        [
            (f"an orbit that passes A has the excess 0 there at w = {above}: stated {outer}", above == outer),
            (f"the tear is at w = {graze}, where l = {turn}: stated {tear}", same(graze, tear)),
            (
                f"flights that pass the graze and those that hit have the same excess {passed} at A",
                same(passed, landed),
            ),
            (f"a flight that hits behind A has the excess 0 where {inner()} = 0", same(inner(), polynomial)),
            ("with one l in (-1/2, 0) for each r, so w lies between 1/3 and 3/8", below),
            *falling_heights(),
        ],
        [at_A(), ("the distance of the tear from 1/3", graze - THIRD)],
        witness=lambda: {"above": str(above), "tear": str(graze), "below": f"{inner()} = 0"},
        modulo=(NORMALLY_HYPERBOLIC,),
    )


def _crossings(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(outer start, polynomial of the inner one) of heights in the limit; others are inverse images, smooth in h."""
    outer, polynomial = stated
    above, _, below = edges_beside_A()
    return persisting(
        [
            (f"of the first loop w is {above} or in (1/3, 3/8): stated {outer}", above == outer and below),
            (f"there {inner()} = 0", same(inner(), polynomial)),
            *falling_heights(),
        ],
        [at_A(), ("the slope by w of x' at A", sympy.diff(excess(sympy.Integer(-1), w), w))],
        modulo=(NORMALLY_HYPERBOLIC,),
    )


def _law(stated: sympy.Expr) -> Check:
    """By which factor, in lambda and mu, foot - X changes where delta is divided by mu, in the limit.

    In coordinates next to gamma in which G is (h, delta) -> (lambda h, mu delta), (K - X)(h, delta/mu) is
    (K - X)(lambda h, delta), and to leading order K - X is the excess at A times a number.
    """
    near = excess(s, v)
    shrunk = sympy.cancel(excess(lam * s, lam**2 * v) / near)
    return persisting(
        [
            (f"x' at A is {near} and changes by {shrunk} with s and v by lambda and lambda^2", same(shrunk, stated)),
            *falling_heights(),
        ],
        [at_A()],
        modulo=(PLANE, NORMALLY_HYPERBOLIC),
    )


INNER = r * (1 + ell - 2 * ell**2) - 3 * ell**2

CLAIMS = {
    "b:loops-map": Encoding(
        (HALF, TEAR, INNER),
        _map,
        (
            (sympy.Rational(1, 3), TEAR, INNER),
            (HALF, sympy.Rational(1, 3), INNER),
            (HALF, TEAR, r * (1 + ell - 2 * ell**2) - 2 * ell**2),
            (HALF, TEAR, r * (1 - ell - 2 * ell**2) - 3 * ell**2),
            (TEAR, HALF, INNER),
        ),
    ),
    "b:loops": Encoding(
        (HALF, INNER),
        _crossings,
        (
            (TEAR, INNER),
            (HALF, r * (1 + ell - 2 * ell**2) - 2 * ell**2),
            (HALF + sympy.Rational(1, 1000), INNER),
            (HALF, r * (1 + ell - 2 * ell**2) - 4 * ell**2),
        ),
    ),
    "b:loops-law": Encoding(lam**2, _law, (lam, lam**3, 1 / mu, lam / mu, 1 / mu**2)),
}
