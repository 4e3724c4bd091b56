"""The motion x'' + f(x, x') = g(t) in balls, up to its first hit.

From (x, x') at a time t_0 it is followed by Taylor polynomials P of degree n.  Let F = P'' + f(P, P') - g.  If f and g
are analytic on the images of the disc |s| <= R and |F| <= M there, F has a zero of order n - 1 at s = 0, so |F(s)| <=
M (|s|/R)^(n-1) by Schwarz's lemma.  Let |f_x| <= A, |f_x'| <= B for all (x, x') within `slack` of (P, P'), and
K = M R^(1-n) exp(B h + A h^2/2)/n.  By Gronwall's lemma the motion exists on [0, h] and

    |x'(s) - P'(s)| <= K s^n,        |x(s) - P(s)| <= K s^(n+1)/(n+1)        if K h^n (1 + h) < slack.

The same holds for x with its derivatives psi by the state at the launch, psi'' + f_x psi + f_x' psi' = 0, as one
motion: then P, F and f stand for all components, and A, B for the largest sum of sizes in a row of derivatives.

A first hit is a change of sign of x - c on a piece on which x' < 0, with x - c > 0 on all pieces before; on the first
step (x - c)/s takes the place of x - c, so that launches from the wall are decided however slow they are.

A ball of launches round a centre is flown with the centre: at the end of a step the distance of x from that of the
centre is at most the distance of the launches times a bound of the derivatives by them, by the mean value theorem.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from flint import acb, arb, arb_poly, arb_series

from .formulas import Dual, Formula, Refused, Wrong

HORIZON = 1e4  # of a flight


class Model:
    """x'' + f(x, x') = g(t), x >= c, and what an impact makes of a velocity."""

    def __init__(self, told: dict[str, Any]) -> None:
        given = dict(told.get("parameters") or {})
        self.f, self.g, self.c = (Formula(told[name], given) for name in ("f", "g", "clearance"))
        self._law = Formula(told["restitution"], given)

    def ratio(self) -> Any:
        """r, where the restitution is a number."""
        if any(isinstance(node, ast.Name) and node.id == "v" for node in ast.walk(self._law.tree)):
            raise Wrong("the restitution is a law, and no number")
        return self._law()

    def rebound(self, velocity: Any) -> Any:
        """The velocity after an impact with x' = velocity < 0: by a law in v, or r |x'|."""
        law = any(isinstance(node, ast.Name) and node.id == "v" for node in ast.walk(self._law.tree))
        return self._law(v=velocity) if law else self._law() * (velocity * -1)

    def push(self, time: Any, velocity: Any) -> Any:
        """x'' at the wall."""
        return self.g(t=time) - self.f(x=self.c(), xdot=velocity)

    def field(self, X: Sequence[Any], V: Sequence[Any]) -> list[Any]:
        """f at x = X[0], and f_x psi + f_x' psi' of the other components psi."""
        found = self.f(x=Dual(X[0], [1, 0]), xdot=Dual(V[0], [0, 1])) if X[1:] else self.f(x=X[0], xdot=V[0])
        value, slopes = (found.value, found.slopes) if X[1:] and isinstance(found, Dual) else (found, [0, 0])
        return [value, *(p * slopes[0] + q * slopes[1] for p, q in zip(X[1:], V[1:], strict=True))]


def size(number: Any) -> Any:
    """The largest size in a ball."""
    return arb(abs(number).upper())


def within(radius: Any) -> Any:
    """All numbers of at most this size."""
    return arb(0, radius.upper()) if radius.upper() > 0 else arb(0)


def coefficients(number: Any, count: int) -> list[Any]:
    """The first coefficients of a series, or of a constant."""
    return [number[k] for k in range(count)] if isinstance(number, arb_series) else [number, *[arb(0)] * (count - 1)]


def derived(X: Sequence[Any]) -> list[Any]:
    """The coefficients of the derivative."""
    return [(k + 1) * part for k, part in enumerate(X[1:])]


def taylor(model: Model, time: Any, x: Sequence[Any], v: Sequence[Any], n: int) -> list[list[Any]]:
    """The coefficients 0, ..., n of all components of the motion, one after the other."""
    forcing, X = coefficients(model.g(t=arb_series([time, 1], prec=n)), n), [x[0], v[0]]
    for k in range(n - 1):
        f = model.f(x=arb_series(X, prec=k + 1), xdot=arb_series(derived(X), prec=k + 1))
        X.append((forcing[k] - coefficients(f, k + 1)[k]) / ((k + 1) * (k + 2)))
    found, one, zero = [X], arb_series([1], prec=n - 1), arb_series([0], prec=n - 1)
    if x[1:]:
        place = [arb_series(part, prec=n - 1) for part in (X, derived(X))]
        by_x, by_v = (coefficients(model.field([place[0], *pair[0]], [place[1], *pair[1]])[1], n - 1)
                      for pair in (((one,), (zero,)), ((zero,), (one,))))  # fmt: skip
    for start in zip(x[1:], v[1:], strict=True):
        psi, rate = list(start), [start[1]]
        for k in range(n - 1):
            pull = sum(map(arb.__mul__, by_x, psi[k::-1]), arb(0)) + sum(map(arb.__mul__, by_v, rate[k::-1]), arb(0))
            psi.append(-pull / ((k + 1) * (k + 2)))
            rate.append((k + 2) * psi[-1])
        found.append(psi)
    return found


def spread(X: list[Any]) -> list[Any]:
    """Bounds of |P(s) - P(0)|, |P'(s) - P'(0)| and |P''(s)| for |s| <= R, as polynomials in R."""
    P = arb_poly([0, *map(size, X[1:])])
    D = P.derivative()
    return [P, D - arb_poly([D[0]]), D.derivative()]


def defect(model: Model, time: Any, X: list[list[Any]], R: Any) -> Any:
    """A bound of |P'' + f(P, P') - g| on |s| <= R; None where f or g is not shown to be analytic on the image."""
    bounds = [[bound(R) for bound in spread(part)] for part in X]
    places = [[acb(part[i] + within(bound[i]), within(bound[i])) for part, bound in zip(X, bounds, strict=True)]
              for i in (0, 1)]  # fmt: skip
    found = [acb(part) for part in model.field(*places)]
    found[0] -= acb(model.g(t=acb(time + within(R), within(R))))
    if not all(part.is_finite() for part in found):
        return None
    return largest(size(part) + bound[2] for part, bound in zip(found, bounds, strict=True))


def largest(numbers: Iterable[Any]) -> Any:
    """The largest of upper bounds."""
    return max((arb(part.upper()) for part in numbers), key=float)


def lipschitz(model: Model, X: list[list[Any]], length: Any, slack: Any) -> tuple[Any, Any]:
    """The largest sums of |derivatives by x, psi| and of |those by x', psi'| of a component of f, next to a step."""
    m, sums = len(X), [spread(part) for part in X]
    slopes = [[int(i == k) for k in range(2 * m)] for i in range(2 * m)]
    places = [[Dual(part[i] + within(bound[i](length) + slack), slopes[i * m + k])
               for k, (part, bound) in enumerate(zip(X, sums, strict=True))] for i in (0, 1)]  # fmt: skip
    rows = [part.slopes if isinstance(part, Dual) else [0] * (2 * m) for part in model.field(*places)]
    A, B = (largest(sum((size(arb(each)) for each in row[i : i + m]), arb(0)) for row in rows) for i in (0, m))
    return A, B


def step(model: Model, time: Any, x: Sequence[Any], v: Sequence[Any], bits: int) -> tuple[list[list[Any]], Any, Any]:
    """The polynomials of one step, its length h, and K."""
    n = max(16, int(0.55 * bits))
    X = taylor(model, time, x, v, n)
    if not all(a.is_finite() for part in X for a in part):
        raise Refused("f or g is singular on the way")
    unit = sum((size(part[1]) + size(part[2]) / 8 for part in X), arb(0))
    rate = max(float(size(part[k]) / unit) ** (1 / k) for part in X for k in (n - 2, n - 1, n))
    radius, best = min(1.3 / rate, 8.0) if rate > 0 else 8.0, (0.0, 0.0, arb(0))
    for _ in range(60):
        M = defect(model, time, X, arb(radius))
        if M is not None:
            share = unit * n / (M * radius + unit * arb(2) ** -900)
            h = radius * min(0.9, 2.0 ** (-bits / n) * float(share) ** (1 / n))
            if h < 1.01 * best[0]:
                break
            best = h, radius, M
        radius *= 0.85
    if not best[0]:
        raise Refused("no disc is found on which f and g are analytic")
    length, R, M = arb(best[0]), arb(best[1]), best[2]
    slack = arb(2) ** (-bits // 2)
    for _ in range(60):
        A, B = lipschitz(model, X, length, slack)
        K = M * R ** (1 - n) * (B * length + A * length * length / 2).exp() / n
        if K * length**n * (1 + length) < slack:
            return X, length, K
        length = arb((length / 2).mid())
    raise Refused("no step is short enough")


def first_root(q: Callable[[Any], Any], slope: Callable[[Any], Any], h: Any, least: Any) -> Any:
    """An interval with the first root on [0, h], in which there is one alone; None where there is none."""
    left = [(arb(0), h)]
    while left and len(left) < 4000:
        a, b = left.pop()
        U, middle = a.union(b), arb((a + (b - a) * 0.4817).mid())
        rise = slope(U)
        if q(U) > 0 or q(middle) + rise * (U - middle) > 0 or (rise > 0 and q(a) > 0) or (rise < 0 and q(b) > 0):
            continue
        if rise < 0 and q(a) > 0 and q(b) < 0:
            while True:
                middle = arb(U.mid())
                smaller = U.intersection(middle - q(middle) / slope(U))
                if smaller.rad() * 1.5 > U.rad():
                    return smaller
                U = smaller
        if b - a < least:
            break
        left += [(middle, b), (a, middle)]
    else:
        if not left:
            return None
    raise Refused(f"near t = {float(a):.6g} neither a hit nor a miss is shown")


def flight(
    model: Model, tau: Any, v: Any, bits: int, columns: int = 0, centre: tuple[Any, Any] | None = None
) -> tuple[Any, Any, list[tuple[Any, Any]]]:
    """The time of the first hit and x' there; and psi, psi' of the derivatives by x and x' at the launch, of 0 or 2.

    `centre` is a launch within the balls tau and v, beside which they are flown; then there are 2 columns.
    """
    if not v > 0:
        raise Refused("the launch velocity is not shown to be positive")
    c, passed, first = model.c(), arb(0), True
    x, speed = [c, arb(1), arb(0)][: 1 + columns], [v, arb(0), arb(1)][: 1 + columns]
    beside = None if centre is None else Beside(model, (tau, v), centre)
    while passed < HORIZON:
        X, h, K = step(model, tau + passed, x, speed, bits)
        if beside is not None:
            h = min(h, beside.step(passed, bits), key=float)
        n, P = len(X[0]) - 1, arb_poly(X[0])
        Q = arb_poly(X[0][1:]) if first else P - arb_poly([c])
        dQ, k = Q.derivative(), n if first else n + 1

        def q(s: Any, Q: Any = Q, K: Any = K, k: int = k, n: int = n) -> Any:
            return Q(s) + within(K / (n + 1) * size(s) ** k)

        def slope(s: Any, dQ: Any = dQ, K: Any = K, k: int = k, n: int = n) -> Any:
            # of y = (x - c)/s: |y' - Q'| <= K s^(n-1) + K s^(n-1)/(n+1)
            return dQ(s) + within(K * size(s) ** (k - 1) * (1 if k > n else 1 + arb(1) / (n + 1)))

        U = None
        for part in (1.0, 0.93, 0.86, 0.79):  # a root at the very end of a step is not decided there
            h = arb((h * part).mid())
            try:
                U = first_root(q, slope, h, h * arb(2) ** (-(2 * bits) // 3))
                break
            except Refused:
                if part < 0.8:
                    raise
        s = h if U is None else U
        x, speed = ends(X, K, s)
        if U is not None:
            there = speed[0].intersection(U * slope(U)) if first else speed[0]
            return passed + U, there, list(zip(x[1:], speed[1:], strict=True))
        passed, first = passed + s, False
        if beside is not None:
            x[0], speed[0] = beside.narrowed(x, speed, passed, s)
        if not x[0] - c > 0:
            raise Refused("x - c is lost at the end of a step")
    raise Refused(f"no hit before {HORIZON:g}")


def ends(X: Sequence[Any], K: Any, s: Any) -> tuple[list[Any], list[Any]]:
    """All components and their rates at a time of a step."""
    n = len(X[0]) - 1
    x = [arb_poly(part)(s) + within(K * size(s) ** (n + 1) / (n + 1)) for part in X]
    return x, [arb_poly(derived(part))(s) + within(K * size(s) ** n) for part in X]


class Beside:
    """The motion of the centre of a ball of launches, which is flown at the same times after the launch."""

    def __init__(self, model: Model, launch: tuple[Any, Any], centre: tuple[Any, Any]) -> None:
        self.model, self.tau, self.launch = model, centre[0], launch
        self.x, self.speed = [model.c()], [centre[1]]
        self.push = model.push(*launch)
        self.off = [ball_ - point for ball_, point in zip(launch, centre, strict=True)]

    def step(self, passed: Any, bits: int) -> Any:
        """Prepare a step, and its length."""
        self.X, h, self.K = step(self.model, self.tau + passed, self.x, self.speed, bits)
        return h

    def narrowed(self, x: Sequence[Any], speed: Sequence[Any], passed: Any, s: Any) -> list[Any]:
        """x and x' of the ball at the end of the step, by the mean value theorem."""
        self.x, self.speed = ends(self.X, self.K, s)
        bend = self.model.g(t=self.launch[0] + passed) - self.model.f(x=x[0], xdot=speed[0])
        found = []
        for part, rate, own in ((x, speed[0], self.x[0]), (speed, bend, self.speed[0])):
            # a later launch is, at its own time, later along the motion, and less by v and by x'' at the start
            by_tau = rate - self.launch[1] * part[1] - self.push * part[2]
            found.append(part[0].intersection(own + by_tau * self.off[0] + part[2] * self.off[1]))
        return found


def impact(model: Model, tau: Any, v: Any, bits: int, centre: tuple[Any, Any] | None = None) -> list[list[Any]]:
    """The derivative of the impact map over a ball of states: rows of the next tau and v, columns of tau and v."""
    time, speed, ((p, p_dot), (q, q_dot)) = flight(model, tau, v, bits, 2, centre)
    rebound = model.rebound(Dual(speed, [1]))
    start, end = model.push(tau, v), model.push(tau + time, speed)
    # a later launch is, at its time, a launch with x less by v and x' less by x''
    moved = [(-v * p - start * q, -v * p_dot - start * q_dot), (q, q_dot)]
    late = [-x / speed for x, _ in moved]
    return [late, [rebound.slopes[0] * (w + end * part) for (_, w), part in zip(moved, late, strict=True)]]


def next_state(model: Model, tau: Any, v: Any, bits: int) -> tuple[Any, Any]:
    """tau and v just after the next impact."""
    time, velocity, _ = flight(model, tau, v, bits)
    return tau + time, model.rebound(velocity)
