"""The relation between two flights before a contact point for any analytic f and g: its series, the rest bounded.

notation: T = S at launch and l S at landing, T = tau_* - t;  x - c = S^(j+2) X(u) at T = S u, u from l to 1;
          u = l + (1-l) z, X = (1-l)^2 Z(z), d = 1 - l, and

              Z'' = -B - S^2 d^2 Z f_x + S d Z' f_xdot,     Z(0) = Z(1) = 0,     B = |a_c(tau_* - S u)|/S^j,

          with f_x, f_xdot averaged between rest and the flight.  W^ = -Z'(1), U^ = Z'(0).

W^ and U^ are power series in S whose coefficients are polynomials in l, those of v_c (`theory.impact_sheet`).  The map
from right side to right side of this problem is defined for complex S and l, |S| <= R, l within `beside` of [-1, 1].
Where it contracts, |Z''| <= z, so |W^|, |U^| <= z/2, and Cauchy's bounds hold for all that the series leave out.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import product
from typing import Any, NamedTuple

from flint import acb, arb, arb_poly

from singimpact.algebra.analytic import Recorder
from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.precision import balls_at
from singimpact.contact.contact import Contact, acceleration
from singimpact.contact.zero_ahead import ContactZero
from singimpact.dynamics.gamma_proof.folded import Models, symmetric
from singimpact.dynamics.gamma_proof.gravity import Hats
from singimpact.inputs import InputError
from singimpact.oscillator.model import Oscillator
from singimpact.theory.impact_sheet import sheet

TERMS = 28  # powers of S, below which the coefficients are known
BITS = 192  # of the balls of the series: its coefficients are turned round l = 1
BESIDE = Fraction(1, 4)  # width of the strip of complex l round [-1, 1]
RADII = 24  # discs that are tried; each radius is 5/6 of the one before
# Half the sides of boxes of x - c and of x' that are tried
SIDES = tuple(Fraction(2) ** k for k in range(-4, 5))


@dataclass(frozen=True)
class Disc:
    """Where the flights are analytic, |S| <= radius, and a bound of |Z''| there."""

    radius: Any
    size: Any


class NonlinearRelation:
    """W^ and U^ at balls of S in [0, reach] and of l in [-1, 1].

    Parameters
    ----------
    series : W^_n(l) and U^_n(l), polynomials. disc : on which the rest is bounded. fastest : a launch speed up to which
        the series are those of the flight, and its first impact is the only one.
    """

    def __init__(self, j: int, s0: Any, series: tuple[list[Any], list[Any]], disc: Disc, fastest: Any) -> None:
        self.j, self.s0, self.disc, self.fastest = j, s0, disc, fastest
        self.launch, self.landing = series
        self.leading = self.launch[0][0] / (j + 1)
        self.slopes = [[part.derivative() for part in parts] for parts in series]
        rest = self.beyond(len(self.launch) - 1, 0)
        self.tail = symmetric(rest.max(self.beyond(len(self.launch) - 1, 1)).max(rest / _ball(BESIDE)))

    def beyond(self, n: int, slope: int, power: int = 0) -> Any:
        """A bound of what comes after S^n, over S^power; of its derivative by S with slope = 1."""
        ratio = self.s0 / self.disc.radius
        count = (n + 1) - n * ratio if slope else 1 - ratio
        return self.disc.size / 2 * ratio ** (n + 1) * count / (1 - ratio) ** 2 / self.s0 ** (power + slope)

    def hats(self, S: Any, ell: Any) -> Hats:
        """W^, U^, their derivatives by S and by l, and V = -dW/dl, at (S, l)."""
        parts = []
        for series, slopes in zip((self.launch, self.landing), self.slopes, strict=True):
            value, by_S, by_l = arb_poly([0]), arb_poly([0]), arb_poly([0])
            for coefficient, slope in zip(reversed(series), reversed(slopes), strict=True):
                by_S = by_S * S + value
                value, by_l = value * S + coefficient, by_l * S + slope
            parts += [poly(ell) + self.tail for poly in (value, by_S, by_l)]
        W, WS, Wl, U, US, Ul = parts
        return Hats(W, WS, Wl, U, US, Ul, W - (1 - ell) * Wl)

    def modelled(self, models: Models, S: Any, ell: Any) -> tuple[Any, Any]:
        """W^ and U^ of Taylor models of S and l."""
        D, powers, sums = models.D, [arb_poly([1])], [arb_poly([0]), arb_poly([0])]
        Sk = powers[0]
        for n in range(min(D + 1, len(self.launch))):
            Sk = models.mul(Sk, S) if n else Sk
            for k, polynomial in enumerate((self.launch[n], self.landing[n])):
                while len(powers) <= polynomial.degree():
                    powers.append(models.mul(powers[-1], ell))
                value = sum((c * p for c, p in zip(polynomial.coeffs(), powers, strict=False)), arb_poly([0]))
                sums[k] = sums[k] + models.mul(Sk, value)
        last = models.folded_last(symmetric(self.beyond(min(D, len(self.launch) - 1), 0, D)))
        return sums[0] + last, sums[1] + last


@lru_cache(maxsize=64)
def nonlinear_relation(osc: Oscillator, zero: ContactZero, reach: Fraction, bits: int) -> NonlinearRelation:
    """The flights before a contact point.

    Parameters
    ----------
    reach : S, a time here, goes up to it. bits : of the balls, the precision that is set.

    Raises
    ------
    InputError : f or g is not shown to be analytic round the contact point as far as the reach needs.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> from singimpact.contact.zero_ahead import next_zero
    >>> osc = Oscillator("x + x**3/5", "cos(2*t)", "3/10", "1/2")
    >>> with balls_at(96):
    ...     found = nonlinear_relation(osc, next_zero(osc, constant("tau", 2)).zero, Fraction(1, 8), 96)
    ...     hats = found.hats(arb("0.1"), arb("0.5"))
    >>> print(hats.W.str(8, radius=False), hats.U.str(8, radius=False))
    0.81137948 0.64688503
    """
    j = zero.order
    series = _series(osc, zero, TERMS + j + 1)
    s0 = Balls(bits).rational(reach)
    bounds = _Bounds(osc, zero)
    disc, fastest = _disc(bounds, s0), _fastest(osc, zero, s0)
    size = bounds.least(s0)
    if size is None or not s0 ** (j + 1) * size / 2 < fastest:
        raise InputError(f"S <= {reach}: flights are not shown to stay where no two join the same two impacts")
    return NonlinearRelation(j, s0, series, disc, fastest)


@lru_cache(maxsize=16)
def _series(osc: Oscillator, zero: ContactZero, order: int) -> tuple[list[Any], list[Any]]:
    """W^_n and U^_n: launch and landing velocity at sigma = -S, t = S (1 - l), by powers of S, over 1 - l."""
    ring, j = Balls(BITS), zero.order
    with balls_at(BITS):
        jets = sheet(Contact.of(osc, zero.moved(BITS), j, order, ring), order)
        columns: tuple[list[Any], list[Any]] = [], []
        for jet, parts, sign in zip((jets.v, jets.xdot), columns, (1, -1), strict=True):
            rows = [[arb(0)] * order for _ in range(order - j)]
            for (i, k), value in jet.terms.items():
                rows[i + k - j - 1][k - 1] = sign * (-1) ** i * value
            parts += [arb_poly(row)(arb_poly([1, -1])) for row in rows]
    return columns


class _Bounds:
    """Bounds of |Z''| for |S| <= R, from each box of flights on which they hold."""

    def __init__(self, osc: Oscillator, zero: ContactZero) -> None:
        self.j, self.tau = zero.order, zero.moved(BITS)
        self.pressed = Recorder().alone(acceleration(osc))
        self.boxes = _boxes(osc)

    def least(self, R: Any) -> Any | None:
        """The least bound, or None where no box has one."""
        wide = 1 + _ball(BESIDE)
        most, bounds = 1 + wide, []
        B = arb(abs(self.pressed(t=_around(self.tau, R * wide))).upper()) / R**self.j
        for box in self.boxes:
            share = (R * most) ** 2 * box.by_x / 8 + R * most * box.by_v / 2
            z = arb((B / (1 - share)).upper()) if share < 1 else arb.nan()
            if R ** (self.j + 2) * most**2 * z / 8 < box.x and R ** (self.j + 1) * most * z / 2 < box.v:
                bounds.append(z)
        return min(bounds, key=float, default=None)


def _disc(bounds: _Bounds, s0: Any) -> Disc:
    """The disc for which what the series leave out is least."""
    discs = []
    for n in range(RADII):
        R = arb((4 * s0 * (arb(5) / 6) ** n).mid())
        size = bounds.least(R) if s0 < R else None
        if size is not None:
            discs.append(Disc(R, size))
    if not discs:
        raise InputError(f"S <= {float(s0):.4g}: f and g are not shown to be analytic on a disc that is large enough")
    return min(discs, key=lambda disc: float(disc.size) * float(s0 / disc.radius) ** TERMS)


def _fastest(osc: Oscillator, zero: ContactZero, s0: Any) -> Any:
    """A launch speed up to which flights stay until tau_* in a box where no two flights join the same two impacts."""
    force, push = Recorder().alone(osc.force()), Recorder().alone(osc.forcing())(t=_around(zero.moved(BITS), s0))
    best = arb(0)
    for box in _boxes(osc):
        if s0**2 * box.by_x / 8 + s0 * box.by_v / 2 < 1:
            most = arb(abs(acb(push - force(**box.names))).upper())  # of |x''|
            best = best.max((box.v - s0 * most).min(box.x / s0 - s0 * most))
    return arb(best.lower())


class _Box(NamedTuple):
    """All complex |x - c| <= x, |x'| <= v, and bounds of |f_x| and |f_xdot| there."""

    x: Any
    v: Any
    names: dict[str, Any]
    by_x: Any
    by_v: Any


def _boxes(osc: Oscillator) -> list[_Box]:
    recorder, c = Recorder(), evaluate(osc.clearance, {}, Balls(BITS))
    force = recorder.record(osc.force())
    slopes, found = recorder.program([recorder.derivative(force, name) for name in ("x", "xdot")]), []
    for x, v in product(map(_ball, SIDES), repeat=2):
        names = {"x": _around(c, x), "xdot": _around(arb(0), v)}
        found.append(_Box(x, v, names, *(arb(abs(acb(part)).upper()) for part in slopes(names))))
    return found


def _around(value: Any, width: Any) -> Any:
    """All complex numbers at most this far from a ball, in each part."""
    wide = symmetric(width)
    return acb(value + wide, wide)


def _ball(value: Fraction) -> Any:
    return Balls(BITS).rational(value)
