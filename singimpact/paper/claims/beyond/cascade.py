"""The cascade beside a border orbit: what a launch next to a release forgets, and how fast the windows shrink."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import islice
from typing import NamedTuple

import numpy as np
import sympy

from singimpact.algebra.balls import Balls
from singimpact.algebra.certificates import positive_on
from singimpact.algebra.numbers import Array, constant, rational_near
from singimpact.algebra.precision import balls_at
from singimpact.branches.border import border_orbits
from singimpact.branches.border_digits import rising_zero
from singimpact.branches.resting_windows import Line, Lines, flown_sets, released_sets, resting_windows
from singimpact.dynamics.long_run import rising_zeros
from singimpact.dynamics.orbit import orbit
from singimpact.flights.enclosures.analytic_flow import AnalyticFlow
from singimpact.oscillator.model import Oscillator
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section4a_blowup import HALF, THREE_HALVES
from singimpact.paper.claims.sections.section4a_multipliers import ray_m3
from singimpact.paper.claims.verifiers import agree, every, identity, is_zero
from singimpact.paper.routes import fold
from singimpact.paper.routes.fold import w
from singimpact.paper.routes.implicit import X, Y, a_symbol, at_contact, sigma, t, v, y_c

lam = sympy.Symbol("lambda")
_SCALE = sympy.Symbol("h")
_FACTOR = lam * (2 + lam) ** 2 / (1 + 2 * lam) ** 2


def _at_release() -> tuple[sympy.Expr, sympy.Expr]:
    """x - c and x' at tau_* of a launch at (tau_* + h sigma, h^2 v) next to a tangency, to order 3 in h."""
    height = t * at_contact(y_c(3), 1)
    scaled = {sigma: _SCALE * sigma, v: _SCALE**2 * v}
    first, second = (part.subs(t, -sigma).subs(scaled, simultaneous=True) for part in (height, sympy.diff(height, t)))
    return sympy.expand(first), sympy.expand(second)


def _forgets(stated: tuple[int, sympy.Expr]) -> Check:
    """(k, w): at tau_* the launch has x - c = O(h^k), not O(h^(k+1)), and x' = h^2 w + O(h^3)."""
    power, speed = stated
    height, slope = _at_release()
    least = min(key[0] for key in sympy.Poly(height, _SCALE).as_dict())
    polynomial = sympy.Poly(slope, _SCALE)
    return every(
        [
            (f"x - c begins with h^{least}", least == power),
            ("x' begins with h^2", is_zero(polynomial.nth(0)) and is_zero(polynomial.nth(1))),
            identity(lambda: polynomial.nth(2), "derived from the equation of motion at a tangency")(speed),
        ],
        witness=lambda: {"x - c": f"h^{least}", "stated": f"h^{power}"},
    )


def _contracts(stated: tuple[int, sympy.Expr, str]) -> Check:
    """(p, formula, side): lambda^p mu is the formula, and lies on that side of 1 for every r in (0, 1)."""
    power, formula, side = stated
    rate, _ = fold.h_blown_up()
    product = rate**power * fold.N_r_at_fixed_points()
    rest = sympy.cancel((1 - formula if side == "below" else formula - 1).together())
    return every(
        [
            identity(lambda: product, "derived from the blow-up at a tangency")(formula.subs(lam, rate)),
            (
                "m3 = 1/2 + lambda runs once through (1/2, 3/2) as r does through (0, 1)",
                ray_m3((HALF, THREE_HALVES)).holds,
            ),
            (
                f"what it lacks of 1 is {sympy.factor(rest)}" if side == "below" else "it is above 1",
                positive_on(rest, lam, 0, 1),
            ),
        ],
        witness=lambda: {"lambda": "1/2", "value": str(formula.subs(lam, HALF))},
    )


def _in_r(stated: tuple[int, int]) -> Check:
    """(p, q): lambda^2 mu = r^p/lambda^q at the fixed point."""
    rate, _ = fold.h_blown_up()
    power, root = stated
    r, multiplier = fold.r_of_m(), fold.N_r_at_fixed_points()
    composed = agree(X**2 * Y - w**power / X**root, {X: rate, Y: multiplier, w: r}, 0)
    derived = identity(lambda: rate**2 * multiplier, "derived from the blow-up at a tangency")(r**power / rate**root)
    return every([derived, ("so are lambda^2 mu and r put in", composed)])


def _rests(stated: tuple[str, str, int, tuple[str, str]]) -> Check:
    """(low, high, k, borders): for all G between the first two the released ball is released again k periods later.

    borders : the nearest border orbits on both sides, to twelve decimals.
    """
    low, high, periods, borders = stated
    windows = resting_windows(BALL, "G", (low, high), periods=periods, pieces=PIECES)
    beside = [
        orbit
        for edge in map(float, borders)
        for orbit in border_orbits(BALL, "G", (edge - NEXT, edge + NEXT), digits=DIGITS, periods=periods, points=3)
    ]
    values = [orbit.certified for orbit in beside]
    return every(
        [
            (
                f"balls fly the orbits of all G of a share of {float(windows.share):.6g} between {low} and {high}",
                windows.share == 1 and {one.periods for one in windows} == {periods},
            ),
            (
                f"border orbits of {periods} periods are certified at G = {', '.join(map(str, values))}",
                len(values) == len(borders)
                and all(
                    ball is not None and orbit.period == periods and f"{float(ball.value):.12f}" == border
                    for ball, orbit, border in zip(values, beside, borders, strict=True)
                ),
            ),
        ],
        "certified",
        witness=lambda: {"windows": str(windows), "borders": str(values)},
    )


class _Trap(NamedTuple):
    """A parallelogram of states: corner is its middle; inverse takes them to coordinates below size in it."""

    corner: tuple[Fraction, Fraction]
    inverse: tuple[tuple[Fraction, Fraction], ...]
    size: Fraction

    def holds(self, lines: Lines, halves: Sequence[Fraction]) -> bool:
        """Whether a set lies in it, some periods later."""
        tau, v = lines
        period = rational_near(constant("the period", "2*pi"), BITS)
        later = round((tau.centre - self.corner[0]) / period) * period
        return all(
            abs(p * (tau.centre - self.corner[0] - later) + q * (v.centre - self.corner[1]))
            + sum(abs(p * by + q * also) * half for by, also, half in zip(tau.slopes, v.slopes, halves, strict=True))
            + abs(p) * (tau.error + ROUNDED)
            + abs(q) * v.error
            < self.size
            for p, q in self.inverse
        )


def _never_rests(stated: tuple[str, Fraction, int, Fraction]) -> Check:
    """(G, half, n, size): for all G within half of it the orbit ends in a set that n impacts take into itself."""
    amplitude, half, impacts, size = stated
    model = BALL.replace(G=amplitude)
    (release,) = rising_zeros(model)
    run = orbit(model, release, 0, 100 * impacts)
    corner = Fraction(float(run.tau[-1])), Fraction(float(run.v[-1]))
    halves = [half, size, size]

    def returned(sides: Array) -> Lines:
        rows = [(Fraction(0), *map(Fraction, row)) for row in sides.tolist()]
        start = Line(corner[0], rows[0], Fraction(0)), Line(corner[1], rows[1], Fraction(0))
        *_, lines = islice(flown_sets(model, "G", halves, start), impacts)
        return lines

    _, sides = np.linalg.eig(np.array([line.slopes[1:] for line in returned(np.eye(2))], dtype=float))
    (a, b), (c, d) = ([Fraction(side) for side in row] for row in sides.tolist())
    area = a * d - b * c
    trap = _Trap(corner, ((d / area, -b / area), (-c / area, a / area)), size)
    with balls_at(BITS):
        ball = Balls(BITS).interval(Fraction(amplitude) - half, Fraction(amplitude) + half)
        start = [
            rising_zero(flow, release, NEXT)
            for flow in (AnalyticFlow(model, BITS), AnalyticFlow(model, BITS, ("G", ball)))
        ]
        entered = next(
            (
                n
                for n, lines in enumerate(released_sets(model, "G", half, (start[0], start[1])), 1)
                if trap.holds(lines, [half])
            ),
            None,
        )
    return every(
        [
            (
                f"{impacts} impacts take a set of states into itself, for all G of an interval",
                trap.holds(returned(sides), halves),
            ),
            (f"the released orbits are in it after {entered} impacts", entered is not None),
        ],
        "certified",
        witness=lambda: {"impacts": str(entered)},
    )


BITS, ROUNDED = 128, Fraction(1, 2**90)  # of the balls; more than the error of a period times their number
BALL = Oscillator("1", "G*sin(t)", 0, "1/2", {"G": "19/10"})
PIECES, DIGITS = 256, 16
NEXT = Fraction(1, 10**4)  # half the width of the search for a border orbit, and for a release
BORDERS = ("1.893700796003", "1.939751233691")
CLAIMS = {
    "b:cascade-launch": Encoding(
        (3, v - a_symbol(1) * sigma**2 / 2),
        _forgets,
        (
            (2, v - a_symbol(1) * sigma**2 / 2),
            (3, v + a_symbol(1) * sigma**2 / 2),
            (3, v - a_symbol(1) * sigma**2 / 6),
            (4, v),
        ),
    ),
    "b:cascade-contraction": Encoding(
        (2, _FACTOR, "below"),
        _contracts,
        (
            (2, _FACTOR, "above"),
            (1, _FACTOR / lam, "below"),
            (3, _FACTOR * lam, "above"),
            (2, lam * (2 + lam) / (1 + 2 * lam), "below"),
            (2, 1 - (1 - lam**2) / (1 + 2 * lam) ** 2, "below"),
        ),
    ),
    "b:resting-window": Encoding(
        ("1.9", "1.93", 5, BORDERS),
        _rests,
        (
            ("1.9", "1.901", 4, BORDERS),
            ("1.939", "1.94", 5, BORDERS),
            ("1.9", "1.901", 5, ("1.893700796004", BORDERS[1])),
        ),
    ),
    "b:never-rests": Encoding(
        ("2.3695", Fraction(1, 10**8), 3, Fraction(1, 2000)),
        _never_rests,
        (
            ("2.3695", Fraction(1, 10**8), 2, Fraction(1, 2000)),
            ("2.3695", Fraction(1, 10**8), 3, Fraction(1, 500)),
            ("2.3695", Fraction(1, 10**6), 3, Fraction(1, 2000)),
        ),
    ),
    "b:cascade-contraction-r": Encoding((2, 3), _in_r, ((2, 2), (1, 3), (2, 5))),
}
