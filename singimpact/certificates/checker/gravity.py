"""A linear model before a zero of a_c as a ball under gravity, and the speeds of its flights.

X'' + 2 b X' + (b^2 + w) X = a_c(t), X = x - c.  With s = tan(sqrt(w) t)/sqrt(w), t from the zero, and y = X e^(b t)/C,
C^-2 = 1 + w s^2, it is y'' = A(s) = e^(b t) C^3 a_c; velocities at the wall are multiplied by e^(b t) C, and the
restitution stays.  |A(-x)| = b_j x^j + b_(j+1) x^(j+1) + ...; by Cauchy |b_k| <= M R^-k if |A| <= M on |s| <= R.

A flight from s = -S to s = -l S is launched with S^(j+1) (1-l) W and lands with S^(j+1) (1-l) U, where

    W = sum b_k S^(k-j) P_k/((k+1)(k+2)),   P_k = (k+1) + l P_(k-1),        P_k, Q_k <= (k+1)(k+2)/2 for |l| <= 1.
    U = sum b_k S^(k-j) Q_k/((k+1)(k+2)),   Q_k = (1 + ... + l^k) + l Q_(k-1)
"""

import ast
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from flint import acb, arb, arb_poly, arb_series

from .formulas import Formula, Refused, Wrong, ball, need
from .motion import Model, lies_within, read, size, within

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

    def log_concave(self) -> bool:
        """Whether (ln |A|)'' < 0 before the contact: with B = |A|/x^j, j B^2 + (x B')^2 > B x^2 B''."""
        more = within(self.tail(self.j) * (self.K + 1) * 2 / (1 - self.s0 / self.R))  # of the terms by k^2

        def concave(x: Any) -> bool:
            weights = (lambda _: 1), (lambda k: k - self.j), (lambda k: (k - self.j) * (k - self.j - 1))
            B, first, second = (series(self, x, weight) for weight in weights)
            return bool(self.j * B * B + first * first > B * (second + more))

        ends = [-self.s0 * n / PIECES for n in range(PIECES + 1)]
        return all(concave(ends[n].union(ends[n + 1])) for n in range(PIECES))

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


# The motion after a contact point: contact is lost, or, at a swan, chatter completes.
#
# Where a_c > 0 the motion y is convex in s, so it meets the wall at most once more.  After a negative swan |A|
# increases with s up to some place.  There each flight is at most r times as long as the one before: from sigma to e it
# lands with at most |A(e)| (e - sigma)/2, and is launched from e with at least |A(e)| (e1 - e)/2.  A flight from -S <=
# 0 that is launched with at most V, below int (e + x)|A| dx/(e + S) over -S < s < e, lands before e; if at e0, then
# with at most max |A| (e0 + S)/2.  The next one, launched from e0 with v, lands within d if alpha d (e0^2/2 + e0 d/3 +
# d^2/12) >= v, |A| >= alpha s^2.  All end before e0 + d/(1 - r).

PIECES, LAUNCHES, DEEP = 64, 16, 7
COARSE = 2.0**-16


def require_after(o: Gravity, content: dict[str, Any], r: Any) -> None:
    """Refuse what the certificate says of the time after tau, unless it says nothing."""
    after = content["after"]
    if not after:
        return
    numbers = {name: ball(Fraction(text)) for name, text in after.items()}
    reached = Fraction(after["near" if o.j % 2 else "launch"]) <= Fraction(content["reach"])
    need("reached", reached, "what comes after tau is said of launches beyond the reach")
    if o.j % 2:
        require_lost(o, numbers["near"], numbers["time"])
    elif o.j == 2:
        launch, end = numbers["launch"], numbers["end"]
        wide = launch if launch > end else end
        require_settled(Gravity(o.model, o.tau, 2, wide, COARSE), numbers, r)
    else:
        raise Wrong("nothing is shown after a contact point of this order")


def series(o: Gravity, s: Any, weight: Callable[[int], Any]) -> Any:
    """sum weight(k) b_k (-s)^(k-j), weights at most k."""
    total, power = arb(0), arb(1)
    for k in range(o.j, o.K + 1):
        total, power = total + weight(k) * o.b[k] * power, power * -s
    return total + arb(0, o.tail(o.j).upper())


def require_positive(function: Callable[[Any], Any], end: Any, what: str) -> None:
    for n in range(PIECES):
        piece = (end * n / PIECES).union(end * (n + 1) / PIECES)
        need(what, function(piece) > 0, f"that {what} is not shown", Refused)


def require_lost(o: Gravity, near: Any, time: Any) -> None:
    """a_c > 0 for so long."""
    short = not o.square > 0 or time * o.square.sqrt() < arb.pi() / 2
    need("short", short, "the time after tau is longer than the change of variable reaches")
    require_positive(lambda s: series(o, s, lambda _: 1), near, "a_c > 0 after tau")
    todo = [(arb(o.time(near).lower()), arb(time.upper()), 0)]
    while todo:
        a, b, level = todo.pop()
        if a >= b or o.model.push(o.tau + a.union(b), arb(0)) > 0:
            continue
        if level > 12:
            need("lost", False, "that a_c > 0 for so long is not shown", Refused)
            break
        middle = arb(((a + b) / 2).mid())
        todo += [(a, middle, level + 1), (middle, b, level + 1)]


def moment(o: Gravity, s: Any, n: int) -> Any:
    """int |u|^(n-1) |A| du between 0 and s."""
    return abs(s) ** (o.j + n) * series(o, s, lambda k: arb(1) / (k + n))


def require_settled(o: Gravity, numbers: dict[str, Any], r: Any) -> None:
    """Chatter completes before s = end, of all launches with S <= launch and y' <= speed that pass tau."""
    launch, speed, first, end = (numbers[name] for name in ("launch", "speed", "first", "end"))
    require_positive(lambda s: series(o, s, lambda k: k), end, "|A| increases after tau")
    right = first ** (o.j + 2) * series(o, first, lambda k: arb(1) / ((k + 1) * (k + 2)))
    for n in range(LAUNCHES):
        S = (launch * n / LAUNCHES).union(launch * (n + 1) / LAUNCHES)
        landed = speed * (first + S) < right + first * moment(o, -S, 1) + moment(o, -S, 2)
        need("landed", landed, "that the first flight after tau lands in time is not shown", Refused)
    ratios = [
        arb(series(o, (end * n / PIECES).union(end * (n + 1) / PIECES), lambda _: 1).lower()) for n in range(PIECES)
    ]
    todo, half = [(0, 0, 0)], arb(1) / 2
    while todo:
        a, c, n = todo.pop()
        S, e = ((k * half**n).union((k + 1) * half**n) * width for k, width in ((a, launch), (c, first)))
        if not ends_before(o, (S, e), r, end, ratios):
            if n >= DEEP:
                need("completes", False, "that chatter completes in time is not shown", Refused)
                break
            todo += [(2 * a + i, 2 * c + k, n + 1) for i in (0, 1) for k in (0, 1)]


def ends_before(o: Gravity, cell: tuple[Any, Any], r: Any, end: Any, ratios: list[Any]) -> bool:
    S, e = cell
    x = (-S).union(e)
    landing = arb((x * x * series(o, x, lambda _: 1) * (e + S) / 2).upper())
    exact = (moment(o, e, 2) + S * (moment(o, e, 1) + moment(o, -S, 1)) - moment(o, -S, 2)) / (e + S)
    if exact.is_finite():
        landing = landing.min(arb(exact.upper()))
    speed, start, piece = r * landing, arb(e.lower()), PIECES - 1
    for _ in range(3):
        alpha = arb("1e9")
        for ratio in ratios[: piece + 1]:
            alpha = alpha.min(ratio)
        d = length(speed, start, alpha)
        if d is None:
            return False
        if e + d / (1 - r) < end:
            return True
        reached = (e + d) / end * PIECES
        piece = min(int(float(reached.upper())), PIECES - 1) if reached < PIECES else PIECES - 1
    return False


def length(speed: Any, start: Any, alpha: Any) -> Any:
    """A d with alpha d (start^2/2 + start d/3 + d^2/12) >= speed."""
    d = arb(2) ** -12
    while d < 4:
        if alpha * d * (start * start / 2 + start * d / 3 + d * d / 12) >= speed:
            return d
        d = arb((d * arb(257) / 256).mid())
    return None
