"""The three lemmas from which gamma follows, for one lambda or for all lambda of a short interval.

notation: L = series of gamma, l = L(S) + y on the strip |y| <= eta; q = (1-l)/(1-L(S)), 0 on Pi_0 and 1 on gamma up to
          S^N; K = (1-L(lS))/(1-L(S)), m = 1-(1-l)K, the next l that leaves q unchanged;
          H(S, l) = l^(j+1) K W^(lS, m)/U^(S, l) - r: H > 0 where q decreases, H < 0 where it increases or no impact
          comes before tau_*;   F(S, y, y1) = l^(j+1) W(lS, L(lS) + y1) - r U(S, l), the relation of two flights.

Lemma 1: H(S, .) increases on [0, 1].  Lemma 2: |H U| <= R S^N on l = L(S).  Lemma 3: F expands the cones
|dS| <= M |dy| of the strip into themselves.
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

from flint import arb, arb_poly, fmpq

from singimpact.dynamics.gamma_proof.folded import Models, between, symmetric
from singimpact.dynamics.gamma_proof.gravity import Flights, residual
from singimpact.inputs import need


@dataclass(frozen=True)
class ProofSettings:
    """Settings of the lemmas.

    Parameters
    ----------
    N : the series is cut below S^N. D : power of S at which Taylor models are folded. thin : eta is (1 - lambda)/thin.
    pieces : of [0, s0], on which residual and cones are bounded. boxes : of lemma 1 at most.
    steep : M is steep s0/(1 - lambda). least : of the logarithmic derivative in lemma 1.
    """

    N: int = 6
    D: int = 20
    thin: int = 100
    pieces: int = 64
    boxes: int = 4000
    steep: float = 0.75
    least: float = 0.5


WIDE = 1.02  # room for another evaluation of a bound


class Undecided(Exception):
    """A lemma that the balls do not decide, and which."""


class BoxSeries(NamedTuple):
    """L_0, ..., L_{N-1} and r over a box of lambda, and what the lemmas use of them."""

    L: Any  # coefficients as balls over the box
    r: Any
    gap: Any  # (1 - L(S))/(1 - lambda), whose constant term is 1 for every lambda
    residual: list[Any]  # coefficients of S^N, ..., S^D; the lower ones are 0
    low: list[Any]  # the lower ones as computed


@dataclass(frozen=True)
class BoxProof:
    """The lemmas for one box of lambda.

    Attributes
    ----------
    low, high : ends of the box. series : L_0, ..., L_{N-1} over it. r : over it. settings : with which they hold.
        eta, M : half the width of the strip, slope of the cones. R, Kl, Kw : bounds of the residual, of |l - L(S)|/S^N
        and of |W - W_L|/S^N on gamma. least : of the logarithmic derivative of lemma 1. grow : factor by which y grows
        in a cone. tree : the bisection of lemma 1, preorder: S, l where a side is halved, "." a box.
    """

    low: Fraction
    high: Fraction
    series: tuple[Any, ...]
    r: Any
    settings: ProofSettings
    eta: Fraction
    M: Fraction
    R: Any
    Kl: Any
    Kw: Any
    least: Any
    grow: Any
    tree: str

    @property
    def boxes(self) -> int:
        """The number of boxes of lemma 1."""
        return self.tree.count(".")


def grown(relation: Flights, low: Any, high: Any, settings: ProofSettings, exact: Any = None) -> BoxSeries:
    """The series over all lambda in [low, high]: the real numbers that annul the residual below order N, enclosed.

    Parameters
    ----------
    exact : a ball of r where it is known better than by its formula in lambda.
    """
    j, N = relation.j, settings.N
    centre = arb(((low + high) / 2).mid())
    h = arb((high - centre).max(centre - low).upper())
    order = 2 if float(h) > 2.0**-60 else 0
    models = [Models(D, relation.s0, h, order) for D in (*range(1, N + 1), settings.D)]  # exact below S^D
    make = models[0]
    lam = make.model([[centre, arb(1)] if order else [between(low, high)]])

    def constant(value: Any) -> Any:
        return make.model([[value]])

    powers = [constant(arb(1))]
    for _ in range(j + N + 1):
        powers.append(make.mul(powers[-1], lam))
    P, Q, slope = (
        sum((c * p for c, p in zip(parts, powers, strict=False)), constant(arb(0)))
        for parts in (
            [j + 1 - i for i in range(j + 1)],
            [i + 1 for i in range(j + 1)],
            [(i + 1) * i for i in range(1, j + 1)],
        )
    )
    r = make.mul(make.mul(powers[j + 1], P), make.model([make.reciprocal(make.row(Q, 0))]))
    if exact is not None and not order:
        r = constant(exact)
    L, f, one = [lam], relation.leading, 1 - lam
    for n in range(1, N):
        factor = (j + 1) * make.mul(make.mul(powers[j], one), P) - make.mul(powers[j + 1 + n], Q)
        factor = f * (factor - make.mul(r, make.mul(one, slope) - Q))
        missed = residual(relation, models[n], L, r)
        L.append(-make.mul(make.model([models[n].row(missed, n)]), make.model([make.reciprocal(make.row(factor, 0))])))
    last = models[-1]
    missed = residual(relation, last, L, r)
    inverse = make.model([make.reciprocal(make.row(one, 0))])
    gap = [arb(1), *(-make.range(make.mul(coefficient, inverse), 0) for coefficient in L[1:])]
    coefficients = [last.range(missed, i) for i in range(settings.D + 1)]
    return BoxSeries(
        arb_poly([between(low, high), *(make.range(coefficient, 0) for coefficient in L[1:])]),
        make.range(r, 0),
        arb_poly(gap),
        coefficients[N:],
        coefficients[:N],
    )


def rational(value: Fraction) -> Any:
    """A ball of a rational."""
    return arb(fmpq(value.numerator, value.denominator))


def short(value: Any) -> Fraction:
    """The middle of a ball as a decimal of six digits."""
    return Fraction(f"{float(value.mid()):.6g}")


def prove_box(
    relation: Flights,
    ends: tuple[Fraction, Fraction],
    settings: ProofSettings,
    exact: Any = None,
    series: BoxSeries | None = None,
) -> BoxProof:
    """All three lemmas for all lambda between the ends.

    Parameters
    ----------
    exact : a ball of r, for one lambda. series : that of another program, to see it refused.

    Raises
    ------
    Undecided : a lemma is not decided, or is false.
    """
    low, high = map(rational, ends)
    grown_series = series or grown(relation, low, high, settings, exact)
    s0, N, L = relation.s0, settings.N, grown_series.L
    eta, M = short((1 - high) / settings.thin), short(settings.steep * s0 / (1 - high))
    if not all(coefficient.contains(0) for coefficient in grown_series.low):
        raise Undecided("the series does not annul the residual")
    steps = [s0 * i / settings.pieces for i in range(settings.pieces + 1)]
    R = _largest(abs(_horner(grown_series.residual, between(a, b))) for a, b in pairwise(steps))
    _require_agreement(relation, grown_series, R * s0**N)
    least, tree = drift_bound(relation, grown_series, settings)
    cone = (rational(eta), rational(M))
    bounds = [_cones(relation, grown_series, (a, b), cone, settings) for a, b in pairwise(steps)]
    slope, U0 = _least(strip.rate for strip in bounds) * least, _least(strip.U for strip in bounds)
    Kl = arb((R / (U0 * slope)).upper())
    need(WIDE * Kl * s0**N < cone[0], Undecided("lemma 2: the bound of |l - L| is wider than the strip"))
    Kw = arb((Kl * _largest(strip.V for strip in bounds)).upper())
    return BoxProof(
        *ends,
        tuple(L[i] for i in range(N)),
        grown_series.r,
        settings,
        eta,
        M,
        R,
        Kl,
        Kw,
        least,
        _least(strip.grow for strip in bounds),
        tree,
    )


def _horner(coefficients: list[Any], x: Any) -> Any:
    found = arb(0)
    for part in reversed(coefficients):
        found = found * x + part
    return found


def _largest(balls: Any) -> Any:
    """An upper bound of balls; nan, which compares as false with everything, if one is nan."""
    found = arb(0)
    for ball in balls:
        found = found.max(arb(ball.upper()))
    return found


def _least(balls: Any) -> Any:
    found = arb("1e9")
    for ball in balls:
        found = found.min(arb(ball.lower()))
    return found


def _require_agreement(relation: Flights, series: BoxSeries, size: Any) -> None:
    """Refuse balls and Taylor models that differ at s0, and W^ that does not fit dW/dl = -V."""
    if not (size.is_finite() and all(coefficient.is_finite() for coefficient in series.L.coeffs())):
        raise Undecided("the series, or its residual, is enclosed too widely")
    L, j, s0 = series.L, relation.j, relation.s0
    ell = L(s0)
    l1 = L(ell * s0)
    need(0 < ell < 1 and 0 < l1 < 1, Undecided("the series leaves 0 < l < 1"))
    after, before = relation.hats(ell * s0, l1), relation.hats(s0, ell)
    direct = ell ** (j + 1) * (1 - l1) * after.W - series.r * (1 - ell) * before.U
    if not ((1 - l1) * after.Wl - after.W + after.V).contains(0) or not direct.overlaps(symmetric(size)):
        raise Undecided("W^ and U^ in balls and in Taylor models differ")


def drift(relation: Flights, series: BoxSeries, slopes: Any, S: Any, ell: Any) -> Any:
    """Lemma 1: l d/dl ln(H + r); None where a sign is not decided."""
    j, gap = relation.j, series.gap
    S1 = ell * S
    inverse = 1 / gap(S)
    K, Kl = gap(S1) * inverse, S * slopes(S1) * inverse
    m = 1 - (1 - ell) * K
    if not (K > 0 and m > -1 and m < arb("1.01")):
        return None
    m = m if m < 1 else between(m.lower(), 1)  # l <= 1 makes m <= 1
    at, to = relation.hats(S, ell), relation.hats(S1, m)
    if not (at.U > 0 and at.V > 0 and to.W > 0 and (m > 0 or relation.hats(S1, m.union(arb(0))).V > 0)):
        return None
    return (j + 1) + ell * (Kl / K + (to.WS * S + to.Wl * (K - (1 - ell) * Kl)) / to.W - at.Ul / at.U)


def drift_bound(relation: Flights, series: BoxSeries, settings: ProofSettings) -> tuple[Any, str]:
    """Lemma 1 by bisection of [0, s0] x [0, 1]: the least value, and the bisection as text."""
    slopes, least, tree = series.gap.derivative(), arb(9), []
    todo, half = [(0, 0, 0, 0)], arb(1) / 2  # (index, level) of the piece of S and of that of l
    while todo:
        a, n, e, k = todo.pop()
        S = between(a * half**n, (a + 1) * half**n) * relation.s0
        z = drift(relation, series, slopes, S, between(e * half**k, (e + 1) * half**k))
        if z is not None and z > settings.least:
            least = least.min(arb(z.lower()))
            tree.append(".")
            continue
        if len(tree) > 2 * settings.boxes or n + k > 40:
            raise Undecided("lemma 1: that H increases is not decided")
        if n < k:
            tree.append("S")
            todo += [(2 * a + 1, n + 1, e, k), (2 * a, n + 1, e, k)]
        else:
            tree.append("l")
            todo += [(a, n, 2 * e + 1, k + 1), (a, n, 2 * e, k + 1)]
    return least, "".join(tree)


class Strip(NamedTuple):
    """Bounds on a piece of the strip."""

    rate: Any  # (H + r)/l, without the factor of lemma 1
    U: Any
    V: Any
    grow: Any


def _cones(
    relation: Flights, series: BoxSeries, piece: tuple[Any, Any], cone: tuple[Any, Any], settings: ProofSettings
) -> Strip:
    """Lemma 3 on a piece of [0, s0]."""
    j, s0, L = relation.j, relation.s0, series.L
    (eta, M), (a, b) = cone, piece
    more = 2 * M * eta  # two points of a cone lie that close in S
    S = between((a - more).max(arb(0)), (b + more).min(s0))
    y, slopes = symmetric(eta), L.derivative()
    centre, dS = L(S), slopes(S)
    ell = centre + y
    S1 = ell * S
    Z, d1 = L(S1), slopes(S1)
    l1 = Z + y
    if not (ell > 0 and ell < 1 and l1 > 0 and l1 < 1 and settings.N * (1 - centre) + S * dS > 0):
        raise Undecided("the strip leaves 0 < l < 1")
    to, at = relation.hats(S1, l1), relation.hats(S, ell)
    K = series.gap(S1) / series.gap(S)
    m = 1 - (1 - ell) * K
    need(m > -1 and m < 1, Undecided("the strip leaves 0 < l < 1"))
    rate = ell**j * K * relation.hats(S1, m).W / at.U
    shifted = (1 - l1) * to.WS - to.V * d1  # d/dS1 of W(S1, L(S1) + y1)
    F1 = -(ell ** (j + 1)) * to.V
    Fy = (j + 1) * ell**j * (1 - l1) * to.W + ell ** (j + 1) * S * shifted - series.r * ((1 - ell) * at.Ul - at.U)
    FS = ell ** (j + 2) * shifted - series.r * (1 - ell) * at.US + Fy * dS
    d, g, e = -Fy / F1, -FS / F1, ell + S * dS
    up = d - abs(g) * M
    if not (at.U > 0 and to.V > 0 and up > 1 and M * up > abs(e) * M + S and e * d - g * S > 0):
        raise Undecided("lemma 3: the cones are not shown to be expanded into themselves")
    return Strip(rate, (1 - ell) * at.U, at.V, up)
