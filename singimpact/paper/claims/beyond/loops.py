"""The loops of W^s(X) at an unfolded negative swan: their heights next to A are algebraic in r.

Next to A the motion is x'' = a'(A) sigma in the limit.  In units of a'(A) sigma^2 a velocity is a height w, and with
the ratio l of landing and launch time w = (1 - l)(2 + l)/6.
"""

from math import log
from typing import Any

import numpy as np
import sympy

from singimpact.algebra.certificates import positive_in, positive_on
from singimpact.algebra.derivations import At, motion, substitution
from singimpact.inputs import need
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.verifiers import Finding, every, is_zero, measured_on, root_of_line, same
from singimpact.paper.trials.loop_heights import (
    GENERATIONS,
    LINES,
    PHASES,
    RATES,
    SWANS,
    Swan,
    feet_beside_gamma,
    generations,
    heights,
)
from singimpact.theory.multipliers import P, Q, lambda_, launch_velocity

ell, w, r, s, v = sympy.symbols("l w r s v")
lam, mu = sympy.symbols("lambda mu")
NEAR, ORDER = 0.02, 0.1  # of a ratio of feet, and of an order over a factor 2


def height(ratio: Any) -> Any:
    """w of the flight from sigma = -1 to -l, in the homogeneous model of order 1."""
    return sympy.expand(launch_velocity(1, sympy.Integer(-1), -ratio))


def excess(place: sympy.Expr, velocity: sympy.Expr) -> Any:
    """x' at A of the motion through (place, velocity): v - sigma^2/2.  On W^s(X) it is 0 to second order."""
    time = sympy.Symbol("t")
    flight = v * time + s * time**2 / 2 + time**3 / 6
    motion((s, v, time), flight, (sympy.Integer(0), sympy.Integer(1)), {})
    found = sympy.expand(sympy.diff(flight, time).subs(time, -s))
    need(is_zero(found - (v - s**2 / 2)), ArithmeticError("x' at A is not v - sigma^2/2"))
    return found.subs({s: place, v: velocity}, simultaneous=True)


def inner() -> Any:
    """The excess after a landing behind A at -l, l < 0: a polynomial in (l, r), times 6."""
    landing = sympy.expand(-launch_velocity(1, -ell, sympy.Integer(-1)))  # speed, by the involution
    return sympy.expand(6 * excess(-ell, r * landing))


def preimage() -> Any:
    """r (landing speed) - w l^2, which vanishes where the image of the height of l is w; times 6, over 1."""
    landing = sympy.expand(-launch_velocity(1, -ell, sympy.Integer(-1)))
    return sympy.expand(6 * (r * landing - w * ell**2))


def _map(stated: tuple[sympy.Expr, sympy.Expr, sympy.Expr]) -> Check:
    """(height on W^s(X) above the tear, height of the tear, polynomial in (l, r) of the height below it)."""
    outer, tear, polynomial = stated
    above = root_of_line(excess(sympy.Integer(-1), w), w)
    turn = root_of_line(sympy.diff(height(ell), ell), ell)
    graze = height(ell).subs(ell, turn)
    passed, landed = excess(sympy.Integer(-1), graze), excess(-turn, sympy.Integer(0))
    substitution(At(-6 * height(ell) + w, {ell: lambda_, w: (1 - lambda_) * P(1)}), sympy.Integer(0))
    low, high = -sympy.Rational(1, 2), sympy.Integer(0)
    below = inner()
    step = preimage()
    ends = step.subs(ell, 0), step.subs(ell, 1)
    fixed = sympy.cancel(step.subs(w, height(ell)) / (1 - ell))
    return every(
        [
            (f"an orbit that passes A has the excess 0 there at w = {above}: stated {outer}", above == outer),
            (f"the tear is at w = {graze}, where l = {turn}: stated {tear}", same(graze, tear)),
            (
                f"flights that pass the graze and those that hit have the same excess {passed} at A",
                same(passed, landed),
            ),
            (f"a flight that hits behind A has the excess 0 where {below} = 0", same(below, polynomial)),
            (
                "with one l in (-1/2, 0) for each r, so w lies between 1/3 and 3/8",
                _changes_sign(below, low, high) and same(height(0), sympy.Rational(1, 3)),
            ),
            (
                f"w has one inverse image, {step} = 0 with 0 < l < 1, below 1/3, which rises with w",
                ends[0] == r and positive_on(-ends[1], w, 0, sympy.oo) and _falls(),
            ),
            (
                "the one height that is its own inverse image is that of gamma",
                same(fixed, r * Q(1).subs(lambda_, ell) - ell**2 * P(1).subs(lambda_, ell)),
            ),
        ],
        witness=lambda: {"above": str(above), "tear": str(graze), "below": f"{below} = 0"},
    )


def _changes_sign(polynomial: sympy.Expr, low: sympy.Expr, high: sympy.Expr) -> bool:
    """Whether a quadratic in l is negative at low and positive at high for every r in (0, 1): one root between."""
    first, last = polynomial.subs(ell, low), polynomial.subs(ell, high)
    opens = sympy.Poly(polynomial, ell).LC()
    return positive_on(-first, r, 0, 1) and positive_on(last, r, 0, 1) and positive_on(-opens, r, 0, 1)


def _falls() -> bool:
    """Whether the height falls as l rises through (0, 1), and w as a function of l on the inverse images too."""
    image = sympy.cancel(preimage().subs(w, 0) / (6 * ell**2))  # w of the image of the height of l
    return positive_on(-sympy.diff(height(ell), ell), ell, 0, 1) and positive_in(
        -sympy.diff(image, ell), {ell: (0, 1), r: (0, 1)}
    )


def _crossings(stated: tuple[sympy.Expr, sympy.Expr]) -> Check:
    """(outer start, polynomial of the inner one): heights on true orbits differ from the stated ones by O(h)."""

    def order(swan: Swan, rate: str) -> Finding:
        loops, ratio = heights(swan, rate), float(sympy.Rational(rate))
        predicted = np.array([height for start in _starts(stated, rate) for height in generations(start, ratio)])
        errors = np.array(loops.found) - predicted
        orders = np.log(np.abs(errors[0] / errors[1])) / log(LINES[0] / LINES[1])
        holds = bool(np.all(np.abs(orders - 1) < ORDER)) and loops.left < 1e-12
        numbers = {"model": swan.name, "r": rate, "w": _numbers(loops.found[1]), "stated": _numbers(predicted)}
        return f"{orders.min():.3f} to {orders.max():.3f} at r = {rate}", holds, numbers

    return measured_on(
        SWANS, RATES, order, lambda swan, words: f"{swan.name}: {2 * GENERATIONS} crossings, orders {words}"
    )


def _starts(stated: tuple[sympy.Expr, sympy.Expr], rate: str) -> list[float]:
    """The heights of the first generation for a value of r."""
    outer, polynomial = stated
    roots = sympy.Poly(polynomial.subs(r, sympy.Rational(rate)), ell).nroots()
    (ratio,) = [float(root) for root in roots if root.is_real and -1 < root < 0]
    return [float(outer), (1 - ratio) * (2 + ratio) / 6]


def _numbers(values: Any) -> str:
    return ", ".join(f"{value:.6f}" for value in values)


def _law(stated: sympy.Expr) -> Check:
    """By which factor, in lambda and mu, foot - X changes where delta is divided by mu, in the limit."""

    def ratio(swan: Swan, rate: str) -> Finding:
        feet = feet_beside_gamma(swan, rate)
        wanted = float(sympy.sympify(stated).subs({lam: feet.lambda_, mu: feet.mu}))
        rows = np.array(feet.offsets)
        ratios = rows[1:] / rows[:-1]
        off = np.abs(ratios / wanted - 1)
        holds = bool(np.all(off < NEAR) and np.all(off[1] < off[0]) and (rows[0] > 0).any() and (rows[0] < 0).any())
        numbers = {"model": swan.name, "r": rate, "found": _numbers(ratios[-1]), "stated": f"{wanted:.6f}"}
        return f"{ratios[-1].min():.5f} to {ratios[-1].max():.5f} at r = {rate}", holds, numbers

    return measured_on(SWANS, RATES, ratio, lambda swan, words: f"{swan.name}: ratios at {len(PHASES)} phases {words}")


HALF, TEAR = sympy.Rational(1, 2), sympy.Rational(3, 8)
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
