"""The relation between two flights before a contact point: W^, U^ and their derivatives in balls.

notation: S = -s at launch, l = ratio of landing to launch place, B = |A(-S u)|/S^j = sum of b_k S^(k-j) u^k;
          W^ = int_0^1 x B(S, l + (1-l) x) dx,    U^ = int_0^1 (1-x) B(S, l + (1-l) x) dx,    W = (1-l) W^,
          U = (1-l) U^; in code l is `ell`.

The launch speed is S^(j+1) W, the landing speed S^(j+1) U, and dW/dl = -U^.  Nothing is divided by S or by 1 - l.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from flint import arb

from singimpact.dynamics.gamma_proof.folded import symmetric
from singimpact.dynamics.gamma_proof.gravity import Gravity


class Hats(NamedTuple):
    """W^, U^ and their derivatives by S and by l."""

    W: Any
    WS: Any
    Wl: Any
    U: Any
    US: Any
    Ul: Any


class Relation:
    """W^ and U^ of a gravity, at balls of S in [0, reach] and of l in [-1, 1]."""

    def __init__(self, o: Gravity) -> None:
        self.o, self.j, self.s0 = o, o.j, o.s0()
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
        return Hats(W + t, WS + t, Wl + t, U + t, US + t, Ul + t)


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
