"""The motion x'' + f(x, x') = g(t) in balls, up to its first hit.

From (x, x') at a time t_0 it is followed by Taylor polynomials P of degree n.  Let F = P'' + f(P, P') - g.  If f and g
are analytic on the images of the disc |s| <= R and |F| <= M there, F has a zero of order n - 1 at s = 0, so |F(s)| <=
M (|s|/R)^(n-1) by Schwarz's lemma.  Let |f_x| <= A, |f_x'| <= B for all (x, x') within `slack` of (P, P'), and
K = M R^(1-n) exp(B h + A h^2/2)/n.  By Gronwall's lemma the motion exists on [0, h] and

    |x'(s) - P'(s)| <= K s^n,        |x(s) - P(s)| <= K s^(n+1)/(n+1)        if K h^n (1 + h) < slack.

The same holds for x with its derivatives psi by the state at the launch, psi'' + f_x psi + f_x' psi' = 0, and that by
a number p of the model, driven by g_p - f_p, as one motion: then P, F and f stand for all components, and A, B for the
largest sum of sizes in a row of derivatives.

A first hit is a change of sign of x - c on a piece on which x' < 0, with x - c > 0 on all pieces before; on the first
step (x - c)/s takes the place of x - c, so that launches from the wall are decided however slow they are, and
(x - c)/s^2 from rest, (x - c)/s^3 from rest at a zero of x''.  Of a model with an upper wall each piece is looked at
for the distance from that too; launches from it are those of the model with x -> -x.
"""

import re
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any

from flint import acb, arb, arb_poly, arb_series

from .formulas import FUNCTIONS, Dual, Formula, Refused, Wrong, ball, need

HORIZON = 1e4  # of a flight


class Model:
    """x'' + f(x, x', t) = g(t), x >= c, and what an impact makes of a velocity; a parameter `over` may be a ball."""

    def __init__(self, content: dict[str, Any], over: str | None = None, value: Any = None) -> None:
        self.content, self.over, self.value = content, over, value
        parameters = dict(content.get("parameters") or {}) | ({over: value} if over else {})
        self.f, self.g, self.c = (Formula(content[name], parameters) for name in ("f", "g", "clearance"))
        both = [content["restitution"], content.get("upper_restitution", content["restitution"])]
        self._law, upper = (Formula(law, parameters) for law in both)
        self.gap = Formula(content["upper"], parameters)() - self.c() if "upper" in content else None
        for law in (self._law, upper):
            if not law.names() - {"pi", *FUNCTIONS, *parameters}:
                need("restitution", 0 <= law() <= 1, "the restitution is not shown to be in [0, 1]")

    def at(self, value: Any) -> "Model":
        """The model with another number."""
        return Model(self.content, self.over, value) if self.over else self

    def from_wall(self, wall: str | None) -> "Model":
        """The model whose lower wall is a wall of this one: with x -> -x for the upper one."""
        return Model(mirrored(self.content), self.over, self.value) if wall == "upper" else self

    def ratio(self) -> Any:
        """r, where the restitution is a number."""
        if "v" in self._law.names():
            raise Wrong("the restitution is a law, and no number")
        return self._law()

    def rebound(self, velocity: Any, **number: Any) -> Any:
        """The velocity after an impact with x' = velocity < 0: by a law in v, or r |x'|."""
        law = "v" in self._law.names()
        return self._law(v=velocity, **number) if law else self._law(**number) * (velocity * -1)

    def push(self, time: Any, velocity: Any, height: Any = None) -> Any:
        """x'', at the wall where no x is given."""
        return self.g(t=time) - self.f(x=self.c() if height is None else height, xdot=velocity, t=time)

    def moved(self, *slopes: int) -> dict[str, Any]:
        """The number with its derivatives."""
        return {self.over: Dual(self.value, slopes)} if self.over else {}

    def field(self, places: Sequence[Any], time: Any) -> list[Any]:
        """f at x = X[0], and f_x psi + f_x' psi' of the other components psi, with f_p of the one by the number p."""
        X, V = places
        if len(X) == 1:
            return [self.f(x=X[0], xdot=V[0], t=time)]
        found = self.f(x=Dual(X[0], X[1:]), xdot=Dual(V[0], V[1:]), t=time, **self.moved(0, 0, 1))
        return [found.value, *found.slopes] if isinstance(found, Dual) else [found, *[0] * (len(X) - 1)]

    def forcing(self, time: Any, count: int) -> list[Any]:
        """g, and what drives the other components."""
        found = self.g(t=time, **(self.moved(0, 0, 1) if count > 1 else {}))
        return [found.value, *found.slopes] if isinstance(found, Dual) else [found, *[0] * (count - 1)]


def mirrored(content: dict[str, Any]) -> dict[str, Any]:
    """The model with x -> -x, as text."""
    turned = re.sub(r"\b(x|xdot)\b", r"(-\1)", content["f"])
    law = content["restitution"]
    return content | {
        "f": f"-({turned})",
        "g": f"-({content['g']})",
        "clearance": f"-({content['upper']})",
        "upper": f"-({content['clearance']})",
        "restitution": content.get("upper_restitution", law),
        "upper_restitution": law,
    }


def size(number: Any) -> Any:
    """The largest size in a ball."""
    return arb(abs(number).upper())


def within(radius: Any) -> Any:
    """All numbers of at most this size."""
    return arb(0, radius.upper()) if radius.upper() > 0 else arb(0)


def coefficients(number: Any, count: int) -> list[Any]:
    """The first coefficients of a series, or of a constant."""
    number = number if isinstance(number, arb_series) else arb(number)
    return [number[k] for k in range(count)] if isinstance(number, arb_series) else [number, *[arb(0)] * (count - 1)]


def derived(X: Sequence[Any]) -> list[Any]:
    """The coefficients of the derivative."""
    return [(k + 1) * part for k, part in enumerate(X[1:])]


def taylor(model: Model, time: Any, x: Sequence[Any], v: Sequence[Any], n: int) -> list[list[Any]]:
    """The coefficients 0, ..., n of all components of the motion, one after the other."""
    forcing, X = (
        [coefficients(series, n) for series in model.forcing(arb_series([time, 1], prec=n), len(x))],
        [x[0], v[0]],
    )
    for k in range(n - 1):
        clock = arb_series([time, 1], prec=k + 1)
        f = model.f(x=arb_series(X, prec=k + 1), xdot=arb_series(derived(X), prec=k + 1), t=clock)
        X.append((forcing[0][k] - coefficients(f, k + 1)[k]) / ((k + 1) * (k + 2)))
    rows, count = [X], n - 1
    if x[1:]:
        units = [[arb_series([int(i == k)], prec=count) for k in range(len(x) - 1)] for i in (0, 1)]
        state = [[arb_series(series, prec=count), *unit] for series, unit in zip((X, derived(X)), units, strict=True)]
        by_x, by_v, *by_number = (
            coefficients(series, count) for series in model.field(state, arb_series([time, 1], prec=count))[1:]
        )
    for i, start in enumerate(zip(x[1:], v[1:], strict=True)):
        psi, rate = list(start), [start[1]]
        for k in range(n - 1):
            pull = sum(map(arb.__mul__, by_x, psi[k::-1]), arb(0)) + sum(map(arb.__mul__, by_v, rate[k::-1]), arb(0))
            pull += by_number[0][k] - forcing[3][k] if i == 2 else 0
            psi.append(-pull / ((k + 1) * (k + 2)))
            rate.append((k + 2) * psi[-1])
        rows.append(psi)
    return rows


def spread(X: list[Any]) -> list[Any]:
    """Bounds of |P(s) - P(0)|, |P'(s) - P'(0)| and |P''(s)| for |s| <= R, as polynomials in R."""
    P = arb_poly([0, *map(size, X[1:])])
    D = P.derivative()
    return [P, D - arb_poly([D[0]]), D.derivative()]


def defect(model: Model, time: Any, X: list[list[Any]], R: Any) -> Any:
    """A bound of |P'' + f(P, P') - g| on |s| <= R; None where f or g is not shown to be analytic on the image."""
    bounds = [[bound(R) for bound in spread(series)] for series in X]
    places = [
        [acb(series[i] + within(bound[i]), within(bound[i])) for series, bound in zip(X, bounds, strict=True)]
        for i in (0, 1)
    ]
    during = acb(time + within(R), within(R))
    forcing = model.forcing(during, len(X))
    misses = [acb(series) - acb(pull) for series, pull in zip(model.field(places, during), forcing, strict=True)]
    if not all(series.is_finite() for series in misses):
        return None
    return largest(size(series) + bound[2] for series, bound in zip(misses, bounds, strict=True))


def largest(numbers: Iterable[Any]) -> Any:
    """The largest of upper bounds."""
    return max((arb(part.upper()) for part in numbers), key=float)


def lipschitz(model: Model, time: Any, X: list[list[Any]], length: Any, slack: Any) -> tuple[Any, Any]:
    """The largest sums of |derivatives by x, psi| and of |those by x', psi'| of a component of f, next to a step."""
    m, sums = len(X), [spread(series) for series in X]
    slopes = [[int(i == k) for k in range(2 * m)] for i in range(2 * m)]
    places = [
        [
            Dual(series[i] + within(bound[i](length) + slack), slopes[i * m + k])
            for k, (series, bound) in enumerate(zip(X, sums, strict=True))
        ]
        for i in (0, 1)
    ]
    rows = [
        series.slopes if isinstance(series, Dual) else [0] * (2 * m)
        for series in model.field(places, time + within(length))
    ]
    A, B = (largest(sum((size(arb(slope)) for slope in row[i : i + m]), arb(0)) for row in rows) for i in (0, m))
    return A, B


def step(model: Model, time: Any, x: Sequence[Any], v: Sequence[Any], bits: int) -> tuple[list[list[Any]], Any, Any]:
    """The polynomials of one step, its length h, and K."""
    n = max(16, int(0.55 * bits))
    X = taylor(model, time, x, v, n)
    if not all(a.is_finite() for series in X for a in series):
        raise Refused("f or g is singular on the way")
    unit = sum((size(series[1]) + size(series[2]) / 8 for series in X), arb(0))
    rate = max(float(size(series[k]) / unit) ** (1 / k) for series in X for k in (n - 2, n - 1, n))
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
        A, B = lipschitz(model, time, X, length, slack)
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


def tiny(h: Any, bits: int) -> Any:
    """The least piece of a step on which a root is looked for."""
    return h * arb(2) ** (-(2 * bits) // 3)


def above(X: Sequence[Any], K: Any, c: Any, removed: int) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """y = (x - c)/s^removed and y' on a step, where so many coefficients of x - c vanish at its beginning."""
    n = len(X[0]) - 1
    Q = arb_poly(X[0][removed:]) if removed else arb_poly(X[0]) - arb_poly([c])
    dQ = Q.derivative()

    def y(s: Any) -> Any:
        return Q(s) + within(K / (n + 1) * size(s) ** (n + 1 - removed))

    def slope(s: Any) -> Any:
        # |y' - Q'| <= K s^(n - removed) + removed K s^(n - removed)/(n + 1)
        return dQ(s) + within(K * size(s) ** (n - removed) * (1 + arb(removed) / (n + 1)))

    return y, slope


class Flight:
    """A motion from the wall, step after step: x, x' and their derivatives by x and x' at the launch, and a number.

    `columns` derivatives are carried.  `removed` : how many coefficients of x - c vanish at the launch, 3 for a release
    at a zero of x''; where it is 0, 1 for a launch and 2 from rest.
    """

    def __init__(self, model: Model, tau: Any, v: Any, bits: int, columns: int = 0, removed: int = 0) -> None:
        if not (v > 0 or v == 0):
            raise Refused("a velocity after an impact is not shown to be positive")
        self.model, self.tau, self.bits, self.c, self.passed = model, tau, bits, model.c(), arb(0)
        self.x, self.speed = [self.c, arb(1), arb(0), arb(0)][: 1 + columns], [v, arb(0), arb(1), arb(0)][: 1 + columns]
        self.removed = removed or (1 if v > 0 else 2)
        self.across = False  # whether the first hit is at the upper wall

    def step(self) -> Any:
        """The polynomials of the next step, and its length."""
        self.X, h, self.K = step(self.model, self.tau + self.passed, self.x, self.speed, self.bits)
        self.y, self.slope = above(self.X, self.K, self.c, self.removed)
        if self.model.gap is not None:
            self.room, self.closing = above([[-part for part in self.X[0]]], self.K, -(self.c + self.model.gap), 0)
        return h

    def root(self, h: Any) -> tuple[Any, Any]:
        """The first root on the step, or None; and the length up to which that is shown."""
        why = Refused()
        for part in (1.0, 0.93, 0.86, 0.79):  # a root at the very end of a step is not decided there
            h = arb((h * part).mid())
            try:
                return self._first(h), h
            except Refused as reason:
                why = reason
        raise why

    def _first(self, h: Any) -> Any:
        """The first root of the distance from a wall on [0, h]; None where there is none."""
        least, U = tiny(h, self.bits), first_root(self.y, self.slope, h, tiny(h, self.bits))
        if self.model.gap is None:
            return U
        V = first_root(self.room, self.closing, h if U is None else arb(U.upper()), least)
        if not (U is None or V is None or V < U):
            raise Refused("the hits of both walls are not told apart")
        self.across = V is not None
        return V if self.across else U

    def move(self, s: Any) -> None:
        """To a time of the step."""
        self.x, self.speed = ends(self.X, self.K, s)
        self.passed, self.removed = self.passed + s, 0

    def advance(self, s: Any) -> None:
        """To a time of the step up to which no root was found: x > c there, as on all the way."""
        self.move(s)
        if not self.passed < HORIZON:
            raise Refused(f"no hit before {HORIZON:g}")

    def first_hit(self) -> tuple[Any, Any, list[tuple[Any, Any]]]:
        """The time of the first hit, x' there, and psi, psi' of the derivatives."""
        while True:
            U, h = self.root(self.step())
            if U is not None:
                x, speed = ends(self.X, self.K, U)
                own = self.removed and not self.across
                there = speed[0].intersection(U**self.removed * self.slope(U)) if own else speed[0]
                return self.passed + U, there, list(zip(x[1:], speed[1:], strict=True))
            self.advance(h)


def ends(X: Sequence[Any], K: Any, s: Any) -> tuple[list[Any], list[Any]]:
    """All components and their rates at a time of a step."""
    n = len(X[0]) - 1
    x = [arb_poly(part)(s) + within(K * size(s) ** (n + 1) / (n + 1)) for part in X]
    return x, [arb_poly(derived(part))(s) + within(K * size(s) ** n) for part in X]


def landed(model: Model, motion: Flight) -> tuple[Model, int]:
    """The model of the wall that was hit, and the sign of x' in it."""
    return (model.from_wall("upper"), -1) if motion.across else (model, 1)


def next_state(model: Model, tau: Any, v: Any, bits: int, across: bool = False) -> tuple[Any, Any]:
    """tau and v just after the next impact, at the other wall or at the same."""
    motion = Flight(model, tau, v, bits)
    time, velocity, _ = motion.first_hit()
    need("wall", motion.across == across, "the next impact is at another wall than is written")
    there, side = landed(model, motion)
    return tau + time, there.rebound(velocity * side)


# ---- numbers as a certificate writes them, compared with balls


def lies_within(enclosure: Any, written: dict[str, Any]) -> bool:
    """Whether a ball lies within the one that is written, as rationals."""
    value, radius = Fraction(written["value"]), Fraction(written["radius"])
    ends = [
        Fraction(int(m)) * Fraction(2) ** int(e) for m, e in (enclosure.lower().man_exp(), enclosure.upper().man_exp())
    ]
    return value - radius <= ends[0] and ends[1] <= value + radius


def balls_of(content: Any) -> Iterable[dict[str, str]]:
    """All numbers with a radius."""
    if isinstance(content, dict) and set(content) == {"value", "radius"}:
        yield content
    elif isinstance(content, dict | list):
        for entry in content.values() if isinstance(content, dict) else content:
            yield from balls_of(entry)


def compared(pairs: dict[str, tuple[Any, dict[str, str]]]) -> None:
    """Refuse the first ball that does not lie within the one that is written."""
    for name, (enclosure, written) in pairs.items():
        error = Refused if enclosure.overlaps(read(written)) else Wrong
        need("compared", lies_within(enclosure, written), f"{name} is {enclosure.str(30)}", error)


def read(written: dict[str, str]) -> Any:
    """A number with its radius as a ball."""
    return ball(Fraction(written["value"])) + within(ball(Fraction(written["radius"])))


def launched(content: dict[str, Any], moving: bool = False) -> tuple[Any, Any]:
    """tau and v of a launch: from the wall, not into it."""
    tau, v = (Formula(content["launch"][name], {})() for name in ("tau", "v"))
    need("launch", v > 0 or (v == 0 and not moving), "the launch velocity is not shown to be positive")
    return tau, v
