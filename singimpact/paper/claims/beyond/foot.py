"""The foot X of the universal negative swan as a function of r: it rises, is enclosed, and grows like a power."""

import itertools
from fractions import Fraction
from functools import cache
from typing import Any

import sympy

from singimpact.algebra.certificates import positive_in
from singimpact.algebra.derivations import At, substitution
from singimpact.paper.claims.claim import Check, Encoding
from singimpact.paper.claims.sections.section6_loops import feet_upwards, later, next_length_slopes, place
from singimpact.paper.claims.verifiers import every, is_zero, same, sample
from singimpact.paper.routes import unfolding as model
from singimpact.paper.routes.unfolding import kappa, sigma, t
from singimpact.paper.trials.universal_foot import Box, covering, elastic, foot, scaled

w = sympy.Symbol("w")  # the invariant of the elastic ball
e, b = sympy.symbols("e b")  # t/sigma and 1/sigma^2
BEHIND = {sigma: (1, sympy.oo), t: (0, sympy.oo), later: (0, sympy.oo)}
CLOSE = 1e-3  # the rest of the way to X, as a part of X, in which it is enclosed for r near 1
NEAR_ONE = tuple(Fraction(value) for value in ("0.9", "0.95", "0.99", "0.995"))


def _velocities() -> tuple[sympy.Expr, sympy.Expr]:
    """Launch and landing speed over t |kappa|, as polynomials in (sigma, t)."""
    launch = sympy.expand(sympy.cancel(model.launch_velocity() / (-kappa * t)))
    return launch, sympy.expand(sympy.cancel(model.impact_velocity() / (kappa * t)))


def _rises(stated: tuple[int, int, int]) -> Check:
    """Signs of the derivatives of the next flight's length: by the place of landing, by the last length, by r.

    With t_1 the next length the equation is t_1 launch(s, t_1) = r t landing(s - t, t), s the place of landing.
    """
    launch, landing = _velocities()
    left = sympy.expand(later * launch.subs({sigma: sigma + t, t: later}, simultaneous=True))
    slopes = [sympy.expand(slope.subs(place, sigma + t)) for slope in next_length_slopes()]
    signs = tuple(
        1 if positive_in(slope, BEHIND) else -1 if positive_in(-slope, BEHIND) else 0
        for slope in (*slopes, t * landing)
    )
    return every(
        [
            ("behind B the launch speed rises with the length", positive_in(sympy.diff(left, later), BEHIND)),
            (
                f"the next length changes with the place of landing, the last length and r by the signs {signs}",
                signs == stated,
            ),
            ("over A the place of landing and the next length rise with v", feet_upwards()[0] == 1),
            (
                "so X rises with r and with the velocity at A, for the map (landing, length) is monotone",
                signs == (1, 1, 1),
            ),
        ],
        witness=lambda: {"signs": str(signs), "stated": str(stated)},
    )


@cache
def boxes(low: Fraction, high: Fraction) -> tuple[Box, ...]:
    """X for all r between two values."""
    return tuple(covering(low, high))


def _within(stated: tuple[Any, Fraction, Fraction, Fraction, Fraction]) -> Check:
    """(m, p, d, low, high): |X (1 - r)^p - m| < m d for all r in [low, high]."""
    middle, power, share, low, high = stated
    covering = boxes(low, high)
    above = [scaled(box.high / middle, box.r[0], power) for box in covering]
    below = [scaled(box.low / middle, box.r[1], power) for box in covering]
    most, least = max(map(float, above)), min(map(float, below))
    joined = all(one.r[1] == two.r[0] for one, two in itertools.pairwise(covering))
    return every(
        [
            (
                f"{len(covering)} intervals of r follow one another from {low} to {high}",
                joined and covering[-1].r[1] == high,
            ),
            (
                f"on them X (1-r)^({power})/{middle} lies between {least:.5f} and {most:.5f}",
                all(ratio < 1 + _ball(share) for ratio in above) and all(ratio > 1 - _ball(share) for ratio in below),
            ),
        ],
        "certified",
        witness=lambda: {"least": f"{least:.5f}", "most": f"{most:.5f}", "stated": f"1 +- {share}"},
    )


def _ball(value: Fraction) -> Any:
    return scaled(value, Fraction(0), Fraction(1))


def _short_flights() -> tuple[bool, bool]:
    """Whether u = v/|a|^(1/3) of the elastic ball changes at the third order of e = t/sigma in a flight; whether v is
    t |a|/2 in the limit.  With b = 1/sigma^2 and |a| in units of 12 sigma^2."""
    launch, landing = (sympy.expand(velocity.subs(t, e * sigma) / sigma**2) for velocity in _velocities())
    pressed = sympy.expand(model.acceleration().subs(kappa, 1) / (12 * sigma**2))
    behind = sympy.expand(model.acceleration().subs(kappa, 1).subs(sigma, sigma * (1 + e)) / (12 * sigma**2))
    launch, landing, start, end = (
        velocity.subs(sigma, b ** -sympy.Rational(1, 2)) for velocity in (launch, landing, pressed, behind)
    )
    before, after = sympy.expand(launch**3 * end), sympy.expand(landing**3 * start)
    third = all(is_zero(sympy.expand(after - before).coeff(e, n)) for n in range(3))
    if third:
        substitution(At(after), before, order=2, small=[e])
    return third, same(launch.subs(e, 0), 6 * start)


def _used_up() -> Any:
    """The X (1-r)^(3/7) at which u falls to 0: du/dsigma = -(1-r) |a|^(2/3)/2 with |a| = 12 sigma^2.

    Examples
    --------
    >>> round(float(_used_up().subs(w, 1)), 5)
    0.95144
    """
    root, power = 12 ** sympy.Rational(2, 3), sympy.Rational(4, 3)  # |a|^(2/3) is root sigma^power
    return (2 * (power + 1) * w / root) ** (1 / (power + 1))


def _limit(stated: tuple[sympy.Expr, str, str]) -> Check:
    """(formula in u, u, value): the limit of X (1 - r)^(3/7) as r -> 1, u the invariant of the elastic ball.

    For r < 1 flights shorten too, so the bound of all later changes of u that serves the elastic ball holds as well.
    """
    formula, invariant, value = stated
    third, length = _short_flights()
    derived, limit = _used_up(), elastic()
    u_low, u_high = limit.invariant
    ends = [Fraction(str(sympy.N(derived.subs(w, sympy.Rational(bound)), 30))) for bound in (u_low, u_high)]
    equal = sympy.expand(formula**7 - derived**7) == 0
    above = [[scaled(bound, rate, SEVENTHS) for bound in foot(rate, CLOSE)] for rate in NEAR_ONE]
    nearer = all(low > high for (low, _), (_, high) in itertools.pairwise(above))
    return every(
        [
            ("u = v/|a|^(1/3) of the elastic ball changes at the third order of t/sigma in a flight", third),
            (
                f"so it has a limit u: {float(u_low):.9f} < u < {float(u_high):.9f} after {limit.impacts} flights",
                _rounds((u_low, u_high), invariant),
            ),
            (
                f"the changes of ln u after a flight are below {limit.third:.3g} (t/sigma)^2 in all, for every r",
                limit.third * limit.ratio < CLOSE,
            ),
            ("a short flight takes t = 2v/|a| and an impact takes (1-r) u: du/dsigma = -(1-r) |a|^(2/3)/2", length),
            (f"u is used up at X (1-r)^(3/7) -> {derived}, u = {w}", equal),
            (f"which lies between {float(ends[0]):.8f} and {float(ends[1]):.8f}", _rounds(tuple(ends), value)),
            (
                f"X (1-r)^(3/7) falls towards it: {', '.join(f'{float(low):.5f}' for low, _ in above)} at r = "
                f"{', '.join(str(float(rate)) for rate in NEAR_ONE)}",
                nearer and above[-1][0] > _ball(ends[1]),
            ),
        ],
        "argued",
        witness=lambda: sample(formula, derived) if not equal else {"u": f"{float(u_low):.9f}", "limit": str(ends[0])},
    )


def _rounds(ends: tuple[Fraction, ...], text: str) -> bool:
    """Whether everything between two ends rounds to a decimal."""
    half = Fraction(1, 2 * 10 ** len(text.partition(".")[2]))
    return all(abs(each - Fraction(text)) < half for each in ends)


SEVENTHS = Fraction(3, 7)
FORMULA = (14 * w / (3 * 12 ** sympy.Rational(2, 3))) ** sympy.Rational(3, 7)

CLAIMS = {
    "b:foot-monotone": Encoding((1, 1, 1), _rises, ((-1, 1, 1), (1, -1, 1), (1, 1, -1))),
    "b:foot": Encoding(
        (3, SEVENTHS, Fraction(1, 50), Fraction(0), Fraction(19, 20)),
        _within,
        (
            (3, SEVENTHS, Fraction(1, 100), Fraction(0), Fraction(19, 20)),
            (3, Fraction(1, 2), Fraction(1, 50), Fraction(0), Fraction(19, 20)),
            (3, Fraction(2, 5), Fraction(1, 50), Fraction(0), Fraction(19, 20)),
            (Fraction(29, 10), SEVENTHS, Fraction(1, 50), Fraction(0), Fraction(19, 20)),
        ),
    ),
    "b:foot-limit": Encoding(
        (FORMULA, "13.919146", "2.9410294"),
        _limit,
        (
            (FORMULA, "13.919147", "2.9410294"),
            (FORMULA, "13.919146", "2.9410304"),
            (FORMULA.subs(w, w / 2), "13.919146", "2.9410294"),
            (FORMULA ** sympy.Rational(7, 6), "13.919146", "2.9410294"),
        ),
    ),
}
