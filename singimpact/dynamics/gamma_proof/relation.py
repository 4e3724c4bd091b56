"""The relation between two flights before a contact point: W^, U^ and their derivatives in balls.

notation: S = -s at launch, l = ratio of landing to launch place, B = |A(-S u)|/S^j = sum of b_k S^(k-j) u^k;
          W^ = int_0^1 x B(S, l + (1-l) x) dx,    U^ = int_0^1 (1-x) B(S, l + (1-l) x) dx,    W = (1-l) W^,
          U = (1-l) U^; in code l is `ell`.

The launch speed is S^(j+1) W, the landing speed S^(j+1) U, and dW/dl = -U^.  Nothing is divided by S or by 1 - l.
`nonlinear` has the same relation for flights of other models, where dW/dl = -V is not -U^.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from flint import arb, arb_poly

from singimpact.dynamics.gamma_proof.folded import Models, symmetric
from singimpact.dynamics.gamma_proof.gravity import Gravity


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
