"""A linear model before a zero of a_c as a ball under gravity, and the speeds of its flights.

X'' + 2 b X' + (b^2 + w) X = a_c(t), X = x - c.  With s = tan(sqrt(w) t)/sqrt(w), t from the zero, and y = X e^(b t)/C,
C^-2 = 1 + w s^2, it is y'' = A(s) = e^(b t) C^3 a_c; velocities at the wall are multiplied by e^(b t) C, and the
restitution stays.  |A(-x)| = b_j x^j + b_(j+1) x^(j+1) + ...; by Cauchy |b_k| <= M R^-k if |A| <= M on |s| <= R.

A flight from s = -S to s = -l S is launched with S^(j+1) (1-l) W and lands with S^(j+1) (1-l) U, where

    W = sum b_k S^(k-j) P_k/((k+1)(k+2)),   P_k = (k+1) + l P_(k-1),        P_k, Q_k <= (k+1)(k+2)/2 for |l| <= 1.
    U = sum b_k S^(k-j) Q_k/((k+1)(k+2)),   Q_k = (1 + ... + l^k) + l Q_(k-1)
"""

import ast
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from flint import acb, arb, arb_poly, arb_series

from .formulas import Formula, Refused, Wrong, need
from .motion import Model, size, within
from .told import lies_within, read

MOST = 240  # terms
SMALL = 2.0**-36  # tail, in units of b_j


def affine(f: Formula, node: ast.expr) -> tuple[Any, Any, Any]:
    """(k, d, m) of a part k x + d xdot + m."""
    names = f.names(node) & {"x", "xdot"}
    zero = arb(0)
    if not names:
        return zero, zero, f._at(node, {})
    match node:
        case ast.Name(name):
            return arb(int(name == "x")), arb(int(name == "xdot")), zero
        case ast.UnaryOp(ast.USub(), part):
            k, d, m = affine(f, part)
            return -k, -d, -m
        case ast.BinOp(left, ast.Add() | ast.Sub() as op, right):
            sign = 1 if isinstance(op, ast.Add) else -1
            one, other = affine(f, left), affine(f, right)
            return one[0] + sign * other[0], one[1] + sign * other[1], one[2] + sign * other[2]
        case ast.BinOp(left, ast.Mult() | ast.Div() as op, right):
            (k, d, m), (p, q, factor) = affine(f, left), affine(f, right)
            if isinstance(op, ast.Mult) and not f.names(left) & names:
                (k, d, m), (p, q, factor) = (p, q, factor), (k, d, m)
            if p == 0 and q == 0:
                factor = factor if isinstance(op, ast.Mult) else 1 / factor
                return k * factor, d * factor, m * factor
    raise Wrong(f"f = {f.text} is not linear")


def contact(model: Model, written: dict[str, str], j: int) -> Any:
    """A ball of the zero of a_c of order j in the written one: simple, or at the clearance for which it has this order.

    Newton's method shows it: with no zero in the ball, an end of the ball is an end of all that follows.  For j > 1 no
    number of digits shows that a_c vanishes: what is shown holds for the clearance at which it does.
    """
    force, why = model.f(x=model.c(), xdot=arb(0)), "that tau is a zero of a_c of its order is not shown"

    def jet(at: Any) -> list[Any]:
        series = model.g(t=arb_series([at, 1], prec=j + 1)) - force
        return [series[k] for k in range(j + 1)]

    whole, inner = read(written), {**written, "radius": Fraction(written["radius"]) * 99 / 100}
    for _ in range(6):
        middle = arb(whole.mid())
        closer = middle - jet(middle)[j - 1] / (j * jet(whole)[j])
        if not (closer.is_finite() and closer.overlaps(whole)):
            raise Refused(why)
        whole = whole.intersection(closer)
    need("zero of a_c", lies_within(whole, inner), why, Refused)
    vanishes = all(coefficient.contains(0) for coefficient in jet(whole)[: j - 1])
    need("order", vanishes, "a_c does not vanish at tau to the order that is written")
    return whole


class Gravity:
    """b_j, ..., b_K for 0 <= x <= reach, the bound of the tail, and W, U with their derivatives."""

    def __init__(self, model: Model, tau: Any, j: int, reach: Any, small: float = SMALL) -> None:
        stiffness, damping, _ = affine(model.f, model.f.tree)
        self.model, self.tau, self.j, self.s0 = model, tau, j, reach
        self.damping, self.square = damping / 2, stiffness - damping * damping / 4
        K = MOST
        one, w = arb(1), self.square
        time = arb_series([0, *(one * (-w) ** (k // 2) / (k + 1) if k % 2 == 0 else 0 for k in range(K))], prec=K + 1)
        spread = arb_series([1, 0, w], prec=K + 1)
        rest = -model.f(x=model.c(), xdot=arb(0))
        pressed = model.g(t=time + arb_series([tau], prec=K + 1)) + rest
        A = (self.damping * time).exp() * pressed / (spread * spread.sqrt())
        b = [-A[k] if k % 2 == 0 else A[k] for k in range(K + 1)]
        self.b = [arb(0)] * j + b[j:]
        self.lead = self.b[j] / ((j + 1) * (j + 2))
        if not self.lead > 0:
            raise Refused("that gamma ends at tau is not shown: |A| has no positive leading coefficient")
        discs = self.discs(rest)
        if not discs:
            raise Wrong("the reach is not within the disc of convergence")
        for terms in range(48, K + 1, 16):
            self.M, self.R = min(discs, key=lambda disc: float(disc[0] * (self.s0 / disc[1]) ** terms))
            self.K = terms
            if self.tail(j + 1) < small * self.b[j]:
                break
        del self.b[self.K + 1 :]
        self.rest = within(self.tail(j).max(self.tail(j + 1)) / 2)

    def discs(self, rest: Any) -> list[tuple[Any, Any]]:
        """(M, R): |A| <= M for |s| <= R, where |t| <= atanh(sqrt|w| R)/sqrt|w|."""
        pairs, w = [], size(self.square)
        root = w.sqrt()
        for n in range(24):
            R = arb((self.s0 * arb(1.2) ** (n + 1)).mid())
            left = 1 - w * R * R
            if not left > 0.05:
                break
            T = size((root * R).atanh() / root) if root > 0 else R
            push = abs(self.model.g(t=acb(self.tau + within(T), within(T))) + rest)
            M = size(size(push) * (abs(self.damping) * T).exp() / (left * left.sqrt()))
            if M.is_finite():
                pairs.append((M, R))
        return pairs

    def tail(self, power: int) -> Any:
        """A bound of sum k |b_k| x^(k - power) over k > K."""
        q = self.s0 / self.R
        return size(self.M * q ** (self.K + 1) / self.s0**power * (self.K + 1) / (1 - q) ** 2)

    def time(self, S: Any) -> Any:
        """The time between the zero and an impact at S."""
        root = size(self.square).sqrt()
        if self.square > 0:
            return (self.square.sqrt() * S).atan() / self.square.sqrt()
        if self.square < 0:
            return ((-self.square).sqrt() * S).atanh() / (-self.square).sqrt()
        return S + within((root * S).atanh() / root - S) if root > 0 else S

    def speeds(self, S: Any, x: Any) -> list[Any]:
        """W and U at (S, l = x), then their derivatives by S, then by l."""
        moved = [[arb_series([part, int(i == k)], prec=2) for i, part in enumerate((S, x))] for k in (0, 1)]
        (W, U), (Wx, Ux) = (sums(self.b, self.j, self.K, *each) for each in moved)
        return [part + self.rest for part in (W[0], U[0], W[1], U[1], Wx[1], Ux[1])]

    def fall(self, speeds: list[Any], x: Any) -> Any:  # noqa: ARG002
        """Minus the derivative of (1 - l) W by l."""
        return speeds[1]

    def folded(self, ring: Any, S: Any, x: Any) -> tuple[Any, Any]:
        """W and U of polynomials."""
        D, j = ring.D, self.j
        left = (abs(self.b[k]) * self.s0 ** (k - j - D) for k in range(D + j + 1, self.K + 1))
        last = ring(arb_poly([0] * D + [within((self.tail(j + D) + sum(left, arb(0))) / 2)]))
        W, U = sums(self.b, j, D + j, S, x)
        return W + last, U + last

    def factor(self, S: Any) -> Any:
        """v over the speed dy/ds."""
        return (self.damping * self.time(S)).exp() * (1 + self.square * S * S).sqrt()


def sums(b: Sequence[Any], j: int, last: int, S: Any, x: Any) -> tuple[Any, Any]:
    """The terms of W and U up to k = last, at elements of any ring."""
    W, U, P, Q, G, power = 0, 0, 1, 1, 1, 1
    for k in range(1, last + 1):
        P, G = x * P + (k + 1), x * G + 1
        Q = x * Q + G
        if k >= j:
            power = power * S if k > j else power
            share = power * (b[k] / ((k + 1) * (k + 2)))
            W, U = share * P + W, share * Q + U
    return W, U
