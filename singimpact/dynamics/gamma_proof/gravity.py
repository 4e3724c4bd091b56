"""A linear impact oscillator before a contact point as a ball under gravity: its power series, the tail bounded.

X'' + 2 b X' + (b^2 + w) X = a_c(t) for X = x - c.  With C = cos(sqrt(w) t), s = tan(sqrt(w) t)/sqrt(w), t counted from
tau_*, and y = X e^(b t)/C it is y'' = A(s), A = e^(b t) C^3 a_c, with the same restitution (claim b:gauge).  As
dt/ds = 1/(1 + w s^2) and C^-2 = 1 + w s^2, the series in s hold for w > 0, w = 0 and w < 0 alike.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, NamedTuple, Protocol

from flint import arb, arb_poly, arb_series

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Expression, evaluate
from singimpact.algebra.precision import balls_at, series_of_any_length
from singimpact.contact.zero_ahead import ContactZero
from singimpact.dynamics.gamma_proof.folded import Models, symmetric
from singimpact.inputs import InputError
from singimpact.oscillator.linear import at_rest, linear_form
from singimpact.oscillator.model import Oscillator

MOST = 240  # terms of the series of A
RADII = 40  # discs on which A is bounded; each radius is 4/5 of the one before
SMALL = 2.0**-36  # tail, in units of the leading coefficient, at which the series is cut


class LinearNumbers(NamedTuple):
    """b, w, the constant part of a_c, and (rate, phase at tau_*, cosine, sine) of each harmonic, as balls."""

    damping: Any
    square: Any
    steady: Any
    waves: tuple[tuple[Any, Any, Any, Any], ...]


@dataclass(frozen=True)
class Gravity:
    """|A(-x)| = sum of b_k x^k for 0 <= x <= reach.

    Attributes
    ----------
    j : contact order; b_k = 0 below it. reach : a rational. b : balls of b_0, ..., b_K. size, radius : a bound of |A|
        on |s| <= radius, so that |b_k| <= size radius^-k. bits : of the balls.
    """

    j: int
    reach: Fraction
    b: tuple[Any, ...]
    size: Any
    radius: Any
    bits: int

    def s0(self) -> Any:
        """The reach as a ball."""
        return Balls(self.bits).rational(self.reach)

    def tail(self, power: int) -> Any:
        """A bound of sum k |b_k| x^(k - power) over the terms left out, for 0 <= x <= reach."""
        s0, K = self.s0(), len(self.b) - 1
        ratio = s0 / self.radius
        return self.size * ratio ** (K + 1) / s0**power * ((K + 1) - K * ratio) / (1 - ratio) ** 2


def numbers_of(osc: Oscillator, zero: ContactZero, bits: int) -> LinearNumbers:
    """The numbers of a linear model at the precision that is set.

    Raises
    ------
    InputError : the model is not linear.
    """
    form = linear_form(osc)
    if form is None:
        raise InputError(
            f"f = {osc.f}, g = {osc.g} is not accepted: gamma is certified for linear f and a forcing of harmonics"
        )
    balls = Balls(bits)

    def ball(tree: Expression) -> Any:
        return evaluate(tree, {}, balls)

    time, b = zero.moved(bits), ball(form.damping) / 2
    waves = tuple(
        (
            ball(harmonic.rate),
            ball(harmonic.rate) * time + ball(harmonic.phase),
            ball(harmonic.cosine),
            ball(harmonic.sine),
        )
        for harmonic in form.harmonics
    )
    return LinearNumbers(b, ball(form.stiffness) - b * b, ball(at_rest(form, osc.clearance)), waves)


@lru_cache(maxsize=64)
def gravity(osc: Oscillator, zero: ContactZero, reach: Fraction, bits: int, small: float = SMALL) -> Gravity:
    """The gravity before a contact point, with as many terms as the reach needs.

    Parameters
    ----------
    reach : x goes up to it. bits : of the balls, the precision that is set. small : tail, in units of b_j.

    Raises
    ------
    InputError : the model is not linear, or the reach lies outside the disc of convergence.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> from singimpact.contact.zero_ahead import next_zero
    >>> osc = Oscillator("x", "cos(2*t)", 1, "1/2")
    >>> found = gravity(osc, next_zero(osc, constant("tau", 3)).zero, Fraction(1, 4), 96)
    >>> [round(float(b.mid()), 12) for b in found.b[:5]]
    [0.0, 0.0, 2.0, 0.0, -5.0]
    """
    with balls_at(bits):
        numbers = numbers_of(osc, zero, bits)
        b = _coefficients(numbers, zero.order, MOST)
        s0, discs = Balls(bits).rational(reach), _discs(numbers, Balls(bits).rational(reach))
        if not discs:
            raise InputError(f"S <= {reach} is not accepted: the series in S converges up to 1/omega_d only")
        for K in range(40, MOST + 1, 8):  # folded models take at least D + j terms
            size, radius = min(discs, key=lambda disc: float((disc[0] * (s0 / disc[1]) ** K).upper()))
            series = Gravity(zero.order, reach, tuple(b[: K + 1]), size, radius, bits)
            if series.tail(zero.order + 1) < small * b[zero.order]:
                break
        return series


def _coefficients(numbers: LinearNumbers, j: int, K: int) -> list[Any]:
    """b_0, ..., b_K: the first j are 0 by the contact order."""
    with series_of_any_length():
        prec, w = K + 1, numbers.square
        time = arb_series([0] + [(-w) ** (k // 2) / (k + 1) if k % 2 == 0 else 0 for k in range(K)], prec=prec)
        spread = arb_series([1, 0, w], prec=prec)  # C^-2
        pressed = arb_series([numbers.steady], prec=prec)
        for rate, phase, cosine, sine in numbers.waves:
            angle = rate * time + arb_series([phase], prec=prec)
            pressed += cosine * angle.cos() + sine * angle.sin()
        whole = (numbers.damping * time).exp() * pressed / (spread * spread.sqrt())
        coefficients = [-((-1) ** k) * whole[k] for k in range(K + 1)]
    return [arb(0)] * j + coefficients[j:]


def _discs(numbers: LinearNumbers, s0: Any) -> list[tuple[Any, Any]]:
    """Bounds of |A| on discs |s| <= R with R > reach: |t| <= atanh(sqrt|w| R)/sqrt|w| and |cos z| <= cosh |z| there."""
    w, discs = abs(numbers.square), []
    root = arb(w.upper()).sqrt()
    widest = 1 / root if root > 0 else 64 * s0
    widest = arb((19 * widest / 20).min(64 * s0).lower())
    for n in range(RADII):
        R = arb((widest * (arb(4) / 5) ** n).lower())
        if not s0 < R:
            break
        time = (root * R).atanh() / root if root > 0 else R
        push = abs(numbers.steady)
        for rate, phase, cosine, sine in numbers.waves:
            size = (abs(rate) * time).cosh()
            shifted = abs(cosine * phase.cos() + sine * phase.sin()), abs(sine * phase.cos() - cosine * phase.sin())
            push = push + size * (shifted[0] + shifted[1])
        left = 1 - w * R * R  # |C^-2| is at least this
        size = (abs(numbers.damping) * time).exp() / (left * left.sqrt())
        discs.append((arb((size * push).upper()), R))
    return discs


# ---- the time T before a contact point and the coordinate S = tan(sqrt(w) T)/sqrt(w), each as a function of the other


def clock_of(osc: Oscillator, zero: ContactZero, bits: int) -> LinearNumbers:
    """The numbers by which S and time are exchanged: those of a linear model; S is the time for others."""
    return LinearNumbers(arb(0), arb(0), arb(0), ()) if linear_form(osc) is None else numbers_of(osc, zero, bits)


def time_of(w: Any, S: Any) -> Any:
    """T = atan(sqrt(w) S)/sqrt(w), by atanh for w < 0.

    Examples
    --------
    >>> print(time_of(arb(1), arb(1)).str(10, radius=False))
    0.7853981634
    """
    if w > 0:
        return (w.sqrt() * S).atan() / w.sqrt()
    if w < 0:
        return ((-w).sqrt() * S).atanh() / (-w).sqrt()
    root = arb(abs(w).upper()).sqrt()  # w may be 0: the distance from T = S is at most that for w = -|w|
    return S + symmetric((root * S).atanh() / root - S) if root > 0 else S


def place_of(w: Any, T: Any) -> Any:
    """S = tan(sqrt(w) T)/sqrt(w), by tanh for w < 0."""
    if w > 0:
        return (w.sqrt() * T).tan() / w.sqrt()
    if w < 0:
        return ((-w).sqrt() * T).tanh() / (-w).sqrt()
    root = arb(abs(w).upper()).sqrt()
    return T + symmetric((root * T).tan() / root - T) if root > 0 else T


def speed_factor(numbers: LinearNumbers, S: Any) -> Any:
    """v/y' at an impact S before the contact point: e^(b T) sqrt(1 + w S^2)."""
    return (numbers.damping * time_of(numbers.square, S)).exp() * (1 + numbers.square * S * S).sqrt()


# The relation between two flights before a contact point: W^, U^ and their derivatives in balls.
#
# notation: S = -s at launch, l = ratio of landing to launch place, B = |A(-S u)|/S^j = sum of b_k S^(k-j) u^k;
#           W^ = int_0^1 x B(S, l + (1-l) x) dx,    U^ = int_0^1 (1-x) B(S, l + (1-l) x) dx,    W = (1-l) W^,
#           U = (1-l) U^; in code l is `ell`.
#
# The launch speed is S^(j+1) W, the landing speed S^(j+1) U, and dW/dl = -U^.  Nothing is divided by S or by 1 - l.
# `nonlinear` has the same relation for flights of other models, where dW/dl = -V is not -U^.


class Hats(NamedTuple):
    """W^, U^, their derivatives by S and by l, and V = -dW/dl."""

    W: Any
    WS: Any
    Wl: Any
    U: Any
    US: Any
    Ul: Any
    V: Any


class Flights(Protocol):
    """The flights before a contact point, as the lemmas need them.

    Attributes
    ----------
    j : the contact order. s0 : the reach, a ball. leading : |a^(j)|/(j + 2)!, so that W^ = leading P_j at S = 0.
    """

    j: int
    s0: Any
    leading: Any

    def hats(self, S: Any, ell: Any) -> Hats:
        """W^ and U^ at balls of S in [0, s0] and of l in [-1, 1]."""

    def modelled(self, models: Models, S: Any, ell: Any) -> tuple[Any, Any]:
        """W^ and U^ of Taylor models of S and l."""


def residual(flights: Flights, models: Models, L: list[Any], r: Any) -> Any:
    """l^(j+1) W(l S, L(l S)) - r U(S, l) on l = L(S), as a Taylor model."""
    ell = models.compose(L, models.S) if len(L) > 1 else L[0]
    S1 = models.mul(models.S, ell)
    l1 = models.compose(L, S1)
    w = models.mul(1 - l1, flights.modelled(models, S1, l1)[0])
    u = models.mul(1 - ell, flights.modelled(models, models.S, ell)[1])
    for _ in range(flights.j + 1):
        w = models.mul(w, ell)
    return w - models.mul(r, u)


class Relation:
    """W^ and U^ of a gravity, at balls of S in [0, reach] and of l in [-1, 1]."""

    def __init__(self, o: Gravity) -> None:
        self.o, self.j, self.s0 = o, o.j, o.s0()
        self.leading = o.b[o.j] / ((o.j + 1) * (o.j + 2))
        self.f = [b / ((k + 1) * (k + 2)) for k, b in enumerate(o.b)]
        # |P_k|, |Q_k| <= (k+1)(k+2)/2 and |P_k'|, |Q_k'| <= k (k+1)(k+2)/3 on [-1, 1]: k/2 serves all six
        self.tail = symmetric(o.tail(o.j + 1).max(o.tail(o.j)) / 2)

    def hats(self, S: Any, ell: Any) -> Hats:
        """All six at (S, l)."""
        j, zero, t = self.j, arb(0), self.tail
        W = WS = Wl = U = US = Ul = Gl = Pl = Ql = Sk = zero
        G = P = Q = lk = arb(1)
        for k in range(1, len(self.f)):
            Gl, G = G + ell * Gl, 1 + ell * G
            P, Pl, before, lk = P + G, Pl + Gl, lk, lk * ell
            Q, Ql = Q + (k + 1) * lk, Ql + (k + 1) * k * before
            if k < j:
                continue
            slope, Sk = (zero, arb(1)) if k == j else (Sk, Sk * S)
            g, h = self.f[k] * Sk, self.f[k] * (k - j) * slope
            W, Wl, WS, U, Ul, US = W + g * P, Wl + g * Pl, WS + h * P, U + g * Q, Ul + g * Ql, US + h * Q
        U = U + t
        return Hats(W + t, WS + t, Wl + t, U, US + t, Ul + t, U)

    def modelled(self, models: Models, S: Any, ell: Any) -> tuple[Any, Any]:
        """W^ and U^ of Taylor models of S and l."""
        o, j, D = self.o, self.j, models.D
        W, U = arb_poly([0]), arb_poly([0])
        G = P = Q = lk = Sk = arb_poly([1])
        for k in range(1, D + j + 1):
            G = 1 + models.mul(ell, G)
            P, lk = P + G, models.mul(lk, ell)
            Q = Q + (k + 1) * lk
            if k < j:
                continue
            Sk = models.mul(Sk, S) if k > j else Sk
            f = o.b[k] / ((k + 1) * (k + 2))
            W, U = W + models.mul(f * Sk, P), U + models.mul(f * Sk, Q)
        beyond = o.tail(j + D)
        for k in range(D + j + 1, len(o.b)):
            beyond = beyond + abs(o.b[k]) * self.s0 ** (k - j - D)
        last = models.folded_last(symmetric(beyond))
        return W + last, U + last


def homogeneous(j: int, ell: Any) -> tuple[Any, Any, Any]:
    """P_j, Q_j and Q_j' at l."""
    P = sum(((j + 1 - i) * ell**i for i in range(1, j + 1)), ell * 0 + (j + 1))
    Q = sum(((i + 1) * ell**i for i in range(1, j + 1)), ell * 0 + 1)
    slope = sum(((i + 1) * i * ell ** (i - 1) for i in range(2, j + 1)), ell * 0 + 2)
    return P, Q, slope


def restitution_at(j: int, ell: Any) -> Any:
    """r = l^(j+1) P_j/Q_j."""
    P, Q, _ = homogeneous(j, ell)
    return ell ** (j + 1) * P / Q
