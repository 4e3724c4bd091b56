"""The second program: `python checker.py FILE.json ...` checks certificates.

This file stands alone.  It imports python-flint and the standard library, reads the model as text, and encloses the
motion again with its own code.  It accepts a certificate when its enclosure lies within what the certificate says.

The motion x'' + f(x, x') = g(t) from (x, x') at a time t_0 is followed by Taylor polynomials P of degree n.  Let
F = P'' + f(P, P') - g.  If f and g are analytic on the images of the disc |s| <= R and |F| <= M there, F has a zero of
order n - 1 at s = 0, so |F(s)| <= M (|s|/R)^(n-1) by Schwarz's lemma.  Let |f_x| <= A, |f_x'| <= B for all (x, x')
within `slack` of (P, P'), and K = M R^(1-n) exp(B h + A h^2/2)/n.  By Gronwall's lemma the motion exists on [0, h] and

    |x'(s) - P'(s)| <= K s^n,        |x(s) - P(s)| <= K s^(n+1)/(n+1)        if K h^n (1 + h) < slack.

The same holds for x with its derivatives psi by the state at the launch, psi'' + f_x psi + f_x' psi' = 0, as one
motion: then P, F and f stand for all components, and A, B for the largest sum of sizes in a row of derivatives.

A first hit is a change of sign of x - c on a piece on which x' < 0, with x - c > 0 on all pieces before; on the first
step (x - c)/s takes the place of x - c, so that launches from the wall are decided however slow they are.

A periodic orbit is a zero of F_i = G(state i) - state i+1, G the map from impact to impact.  With Y about the inverse
of D F, the zero exists and is alone in a box X round a point p if p - Y F(p) + (1 - Y D F(X)) (X - p) lies inside X.
"""

from __future__ import annotations

import ast
import hashlib
import json
import sys
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import Any

from flint import acb, arb, arb_mat, arb_poly, arb_series, ctx, fmpq

SCHEMA = "singimpact certificate 1"
PARTS = ("flight_time", "velocity", "tau", "v")
HORIZON = 1e4  # of a flight
TERMS = 10_000  # flint cuts a series after ctx.cap terms without a word


class Refused(Exception):
    """A certificate that is not accepted, and why."""


class Wrong(Refused):
    """One that more digits do not help."""


# ---- expressions over balls, series of balls, and numbers with derivatives


def ball(value: Fraction) -> Any:
    """A rational at the working precision."""
    return arb(fmpq(value.numerator, value.denominator))


class Dual:
    """A number and its derivatives by some others, which may be such numbers themselves."""

    def __init__(self, value: Any, slopes: Sequence[Any]) -> None:
        self.value, self.slopes = value, list(slopes)

    def __add__(self, other: Any) -> Dual:
        if isinstance(other, Dual):
            return Dual(self.value + other.value, map(sum, zip(self.slopes, other.slopes, strict=True)))  # type: ignore[arg-type]
        return Dual(self.value + other, self.slopes)

    def __mul__(self, other: Any) -> Dual:
        if not isinstance(other, Dual):
            return Dual(self.value * other, [each * other for each in self.slopes])
        pairs = zip(self.slopes, other.slopes, strict=True)
        return Dual(self.value * other.value, [a * other.value + b * self.value for a, b in pairs])

    __radd__, __rmul__ = __add__, __mul__


def reciprocal(number: Any) -> Any:
    if isinstance(number, Dual):
        value = reciprocal(number.value)
        return Dual(value, [each * (value * value * -1) for each in number.slopes])
    return 1 / number


def applied(name: str, x: Any) -> Any:
    """A function of a number."""
    if isinstance(x, Dual):
        y, at = applied(name, x.value), x.value
        slope = {
            "sin": lambda: applied("cos", at), "cos": lambda: applied("sin", at) * -1, "exp": lambda: y,
            "log": lambda: reciprocal(at), "sqrt": lambda: reciprocal(y * 2), "atan": lambda: reciprocal(at * at + 1),
        }[name]()  # fmt: skip
        return Dual(y, [slope * each for each in x.slopes])
    if isinstance(x, acb) and (
        (name in ("log", "sqrt") and not x.real > 0) or (name == "atan" and not abs(x.imag) < 1)
    ):
        return acb(arb.nan())  # flint's value is finite on a ball that meets the cut, where nothing is analytic
    return getattr(x, name)()


def power(x: Any, exponent: Fraction) -> Any:
    """A power; of a whole exponent by squaring."""
    if exponent < 0:
        return reciprocal(power(x, -exponent))
    if exponent.denominator > 1:
        return applied("exp", applied("log", x) * ball(exponent))
    found: Any = ball(Fraction(1))
    for bit in f"{int(exponent):b}" if exponent else "":
        found = found * found * x if bit == "1" else found * found
    return found


class Formula:
    """A text of numbers, names, + - * / **, and functions."""

    FUNCTIONS = ("sin", "cos", "tan", "tanh", "exp", "log", "sqrt", "atan")

    def __init__(self, text: Any, parameters: dict[str, Any]) -> None:
        self.text, self.parameters = str(text), parameters
        self.tree = ast.parse(self.text, mode="eval").body

    def __call__(self, **values: Any) -> Any:
        return self._at(self.tree, values)

    def _exact(self, node: ast.expr) -> Fraction | None:
        """The rational that a part is, if it is one: decimals are exact."""
        match node:
            case ast.Constant(int() | float()):
                return Fraction(ast.get_source_segment(self.text, node) or "")
            case ast.UnaryOp(ast.USub(), part) if (value := self._exact(part)) is not None:
                return -value
            case ast.BinOp(left, op, right):
                one, other = self._exact(left), self._exact(right)
                if one is not None and other is not None and not (isinstance(op, ast.Div) and not other):
                    made = {ast.Add: Fraction.__add__, ast.Sub: Fraction.__sub__, ast.Mult: Fraction.__mul__,
                            ast.Div: Fraction.__truediv__}.get(type(op))  # fmt: skip
                    return None if made is None else made(one, other)
        return None

    def monomial(self, node: ast.expr) -> tuple[Fraction, int] | None:
        """(q, k) of a part that is q pi^k, q rational."""
        if (known := self._exact(node)) is not None:
            return known, 0
        match node:
            case ast.Name("pi"):
                return Fraction(1), 1
            case ast.Name(name) if name in self.parameters:
                inner = Formula(self.parameters[name], {})
                return inner.monomial(inner.tree)
            case ast.UnaryOp(ast.USub(), part) if (found := self.monomial(part)) is not None:
                return -found[0], found[1]
            case ast.BinOp(left, ast.Mult() | ast.Div() as op, right):
                one, other = self.monomial(left), self.monomial(right)
                if one is not None and other is not None and other[0]:
                    sign = 1 if isinstance(op, ast.Mult) else -1
                    return one[0] * other[0] ** sign, one[1] + sign * other[1]
        return None

    def rate(self, node: ast.expr) -> tuple[Fraction, int] | None:
        """(q, k) of a part that is q pi^k t + a constant; q = 0 where it is constant."""
        if not any(isinstance(part, ast.Name) and part.id == "t" for part in ast.walk(node)):
            return Fraction(0), 0
        match node:
            case ast.Name():
                return Fraction(1), 0
            case ast.UnaryOp(ast.USub(), part) if (found := self.rate(part)) is not None:
                return -found[0], found[1]
            case ast.BinOp(left, ast.Add() | ast.Sub() as op, right):
                one, other = self.rate(left), self.rate(right)
                if one is None or other is None or (one[0] and other[0]):
                    return None
                return one if one[0] else (other[0] * (1 if isinstance(op, ast.Add) else -1), other[1])
            case ast.BinOp(left, ast.Mult() | ast.Div() as op, right):
                inner, factor = self.rate(left), self.monomial(right)
                if isinstance(op, ast.Mult) and factor is None:
                    inner, factor = self.rate(right), self.monomial(left)
                if inner is not None and factor is not None and factor[0]:
                    sign = 1 if isinstance(op, ast.Mult) else -1
                    return inner[0] * factor[0] ** sign, inner[1] + sign * factor[1]
        return None

    def _at(self, node: ast.expr, values: dict[str, Any]) -> Any:
        known = self._exact(node)
        if known is not None:
            return ball(known)
        minus = ball(Fraction(-1))
        match node:
            case ast.Name(name) if name in values:
                return values[name]
            case ast.Name("pi"):
                return arb.pi()
            case ast.Name(name) if name in self.parameters:
                return Formula(self.parameters[name], {})()
            case ast.UnaryOp(ast.USub(), part):
                return self._at(part, values) * minus
            case ast.BinOp(left, ast.Add(), right):
                return self._at(left, values) + self._at(right, values)
            case ast.BinOp(left, ast.Sub(), right):
                return self._at(left, values) + self._at(right, values) * minus
            case ast.BinOp(left, ast.Mult(), right):
                return self._at(left, values) * self._at(right, values)
            case ast.BinOp(left, ast.Div(), right):
                return self._at(left, values) * reciprocal(self._at(right, values))
            case ast.BinOp(base, ast.Pow(), exponent) if (value := self._exact(exponent)) is not None:
                return power(self._at(base, values), value)
            case ast.Call(ast.Name(name), [part], []) if name in self.FUNCTIONS:
                x = self._at(part, values)
                if name == "tan":
                    return applied("sin", x) * reciprocal(applied("cos", x))
                if name == "tanh":
                    grown = applied("exp", x + x)
                    return (grown + minus) * reciprocal(grown + 1)
                return applied(name, x)
        raise Refused(f"{ast.unparse(node)!r} in {self.text!r} is not understood")


class Model:
    """x'' + f(x, x') = g(t), x >= c, and what an impact makes of a velocity."""

    def __init__(self, told: dict[str, Any]) -> None:
        given = dict(told.get("parameters") or {})
        self.f, self.g, self.c = (Formula(told[name], given) for name in ("f", "g", "clearance"))
        self._law = Formula(told["restitution"], given)

    def rebound(self, velocity: Any) -> Any:
        """The velocity after an impact with x' = velocity < 0: by a law in v, or r |x'|."""
        law = any(isinstance(node, ast.Name) and node.id == "v" for node in ast.walk(self._law.tree))
        return self._law(v=velocity) if law else self._law() * (velocity * -1)

    def field(self, X: Sequence[Any], V: Sequence[Any]) -> list[Any]:
        """f at x = X[0], and f_x psi + f_x' psi' of the other components psi."""
        found = self.f(x=Dual(X[0], [1, 0]), xdot=Dual(V[0], [0, 1])) if X[1:] else self.f(x=X[0], xdot=V[0])
        value, slopes = (found.value, found.slopes) if X[1:] and isinstance(found, Dual) else (found, [0, 0])
        return [value, *(p * slopes[0] + q * slopes[1] for p, q in zip(X[1:], V[1:], strict=True))]


# ---- the motion


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


def flight(model: Model, tau: Any, v: Any, bits: int, columns: int = 0) -> tuple[Any, Any, list[tuple[Any, Any]]]:
    """The time of the first hit and x' there; and psi, psi' of the derivatives by x and x' at the launch, of 0 or 2."""
    if not v > 0:
        raise Refused("the launch velocity is not shown to be positive")
    c, passed, first = model.c(), arb(0), True
    x, speed = [c, arb(1), arb(0)][: 1 + columns], [v, arb(0), arb(1)][: 1 + columns]
    while passed < HORIZON:
        X, h, K = step(model, tau + passed, x, speed, bits)
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
        x = [arb_poly(part)(s) + within(K * size(s) ** (n + 1) / (n + 1)) for part in X]
        speed = [arb_poly(derived(part))(s) + within(K * size(s) ** n) for part in X]
        if U is not None:
            there = speed[0].intersection(U * slope(U)) if first else speed[0]
            return passed + U, there, list(zip(x[1:], speed[1:], strict=True))
        passed, first = passed + s, False
        if not x[0] - c > 0:
            raise Refused("x - c is lost at the end of a step")
    raise Refused(f"no hit before {HORIZON:g}")


def impact(model: Model, tau: Any, v: Any, bits: int) -> list[list[Any]]:
    """The derivative of the impact map over a ball of states: rows of the next tau and v, columns of tau and v."""
    time, speed, ((p, p_dot), (q, q_dot)) = flight(model, tau, v, bits, 2)
    c, rebound = model.c(), model.rebound(Dual(speed, [1]))
    start, end = (model.g(t=t) - model.f(x=c, xdot=w) for t, w in ((tau, v), (tau + time, speed)))
    # a later launch is, at its time, a launch with x less by v and x' less by x''
    moved = [(-v * p - start * q, -v * p_dot - start * q_dot), (q, q_dot)]
    late = [-x / speed for x, _ in moved]
    return [late, [rebound.slopes[0] * (w + end * part) for (_, w), part in zip(moved, late, strict=True)]]


# ---- certificates


def lies_within(found: Any, told: dict[str, Any]) -> bool:
    """Whether a ball lies within the one that is written, as rationals."""
    value, radius = Fraction(told["value"]), Fraction(told["radius"])
    ends = [Fraction(int(m)) * Fraction(2) ** int(e) for m, e in (found.lower().man_exp(), found.upper().man_exp())]
    return value - radius <= ends[0] and ends[1] <= value + radius


def digest_of(told: dict[str, Any]) -> str:
    """A digest of all but itself: a larger radius would be true as well, but nobody has certified it."""
    rest = {name: part for name, part in told.items() if name != "digest"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()


def check(told: dict[str, Any]) -> None:
    """Nothing where the certificate holds.

    Raises
    ------
    Refused : it does not hold, or that is not decided; and why.
    """
    shown = {"first impact": first_impact, "periodic orbit": periodic_orbit}.get(str(told.get("statement")))
    if told.get("schema") != SCHEMA or shown is None:
        raise Refused(f"only certificates {SCHEMA!r} of a 'first impact' or of a 'periodic orbit' are checked here")
    if told.get("digest") != digest_of(told):
        raise Refused("the digest is not that of the content: the file was changed")
    before, why = (ctx.prec, ctx.cap), ""
    try:
        numbers = list(balls_of(told))
        narrowest = min(Fraction(each["radius"]) / max(abs(Fraction(each["value"])), Fraction(1)) for each in numbers)
        if narrowest <= 0:
            raise Refused("a radius that is not above 0")
        wanted = narrowest.denominator.bit_length() - narrowest.numerator.bit_length()
        for bits in ((wanted + 16) * 2**k for k in range(4)):
            ctx.prec, ctx.cap = bits + 32, TERMS
            try:
                return shown(Model(told["model"]), told, bits)
            except Wrong:
                raise
            except Refused as reason:
                why = str(reason)
        raise Refused(why)
    except (KeyError, TypeError, ValueError, SyntaxError, ZeroDivisionError, AttributeError) as error:
        raise Refused(f"not a certificate: {error!r}") from error
    finally:
        ctx.prec, ctx.cap = before


def balls_of(told: Any) -> Iterable[dict[str, str]]:
    """All numbers with a radius."""
    if isinstance(told, dict) and set(told) == {"value", "radius"}:
        yield told
    elif isinstance(told, dict | list):
        for part in told.values() if isinstance(told, dict) else told:
            yield from balls_of(part)


def compared(found: dict[str, tuple[Any, dict[str, str]]]) -> None:
    """Refuse the first ball that does not lie within the one that is written."""
    for name, (ball_found, told) in found.items():
        if not lies_within(ball_found, told):
            apart = not ball_found.overlaps(ball(Fraction(told["value"])) + within(ball(Fraction(told["radius"]))))
            raise (Wrong if apart else Refused)(f"{name} is {ball_found.str(30)}")


def first_impact(model: Model, told: dict[str, Any], bits: int) -> None:
    """That the motion from the launch meets the wall first where and as fast as it is written."""
    tau, v = (Formula(told["launch"][name], {})() for name in ("tau", "v"))
    time, velocity, _ = flight(model, tau, v, bits)
    found = zip(PARTS, (time, velocity, tau + time, model.rebound(velocity)), strict=True)
    compared({name: (each, told[name]) for name, each in found})


def periodic_orbit(model: Model, told: dict[str, Any], bits: int) -> None:
    """That one orbit has its states in the balls that are written, and no other is near; and its multipliers."""
    states, k = told["states"], int(told["periods"])
    if k < 1 or not states:
        raise Wrong("an orbit has impacts, and closes after one period or more")
    require_period(model.g, told["period"])
    numbers = [state[name] for state in states for name in ("tau", "v")]
    point, radii = ([ball(Fraction(each[part])) for each in numbers] for part in ("value", "radius"))
    span, unique = Formula(told["period"], model.g.parameters)() * k, ball(Fraction(told["unique_within"]))
    for near in ([unique] * len(point), radii):
        slopes, image = krawczyk(model, point, near, span, bits)
        for part, radius in zip(image, near, strict=True):
            if not abs(part) < radius:
                # more bits help a narrow box alone, and only if there may be a zero in it
                error = Wrong if near is not radii or abs(part) > radius else Refused
                raise error(f"Krawczyk's operator maps a side of {float(radius):.3g} to {float(size(part)):.3g}")
    total = arb_mat([[1, 0], [0, 1]])
    for slope in slopes:  # over the balls of the states
        total = arb_mat(slope) * total
    if told["multipliers"]:
        wanted = [each[part] for each in told["multipliers"] for part in ("real", "imaginary")]
        for found, written in zip(eigenvalues(total), wanted, strict=True):
            compared({"a multiplier": (found, written)})


def krawczyk(
    model: Model, point: list[Any], radii: list[Any], span: Any, bits: int
) -> tuple[list[list[list[Any]]], list[Any]]:
    """The derivatives of the impact map over a box, and what Krawczyk's operator makes of the box less its centre."""
    size_of, n = len(point), len(point) // 2
    box = [x + within(r) for x, r in zip(point, radii, strict=True)]
    slopes = [impact(model, box[2 * i], box[2 * i + 1], bits) for i in range(n)]
    D, missed = arb_mat(size_of, size_of), []
    for i in range(n):
        time, velocity, _ = flight(model, point[2 * i], point[2 * i + 1], bits)
        image, following = (point[2 * i] + time, model.rebound(velocity)), 2 * ((i + 1) % n)
        missed += [image[0] - point[following] - (span if i == n - 1 else 0), image[1] - point[following + 1]]
        for a in (0, 1):
            for b in (0, 1):
                D[2 * i + a, 2 * i + b] += slopes[i][a][b]
            D[2 * i + a, following + a] -= 1
    middle = arb_mat([[arb(part.mid()) for part in row] for row in D.table()])
    Y = arb_mat([[arb(part.mid()) for part in row] for row in middle.inv().table()])
    one = arb_mat([[int(i == j) for j in range(size_of)] for i in range(size_of)])
    spread_out = (one - Y * D) * arb_mat([[within(r)] for r in radii])
    return slopes, (spread_out - Y * arb_mat([[part] for part in missed])).entries()


def eigenvalues(matrix: Any) -> list[Any]:
    """Real and imaginary part of the larger eigenvalue, and of the other."""
    half, determinant = (matrix[0, 0] + matrix[1, 1]) / 2, matrix.det()
    under = half * half - determinant
    if under > 0:
        far = half + under.sqrt() if half > 0 else half - under.sqrt()
        return [far, arb(0), determinant / far, arb(0)]
    if under < 0:
        return [half, (-under).sqrt(), half, -(-under).sqrt()]
    raise Refused("the multipliers are not told apart")


def require_period(g: Formula, period: str) -> None:
    """Refuse a period that g is not shown to have: t is in sines of rate t + phase, rate period = 2 pi m."""
    length = Formula(period, g.parameters)
    turn = length.monomial(length.tree)

    def seen(node: ast.AST) -> bool:
        """Whether a part has the period."""
        match node:
            case ast.Name("t"):
                return False
            case ast.Call(ast.Name("sin" | "cos" | "tan"), [argument]) if any(
                isinstance(part, ast.Name) and part.id == "t" for part in ast.walk(argument)
            ):
                rate = g.rate(argument)
                if rate is None or turn is None or rate[1] + turn[1] != 1:
                    return False
                return (rate[0] * turn[0] / 2).denominator == 1
        return all(seen(part) for part in ast.iter_child_nodes(node))

    if not seen(g.tree):
        raise Refused(f"g = {g.text} is not shown to have the period {period}")


def main(paths: Sequence[str]) -> int:
    """0 where all certificates hold, else 1."""
    failed = 0
    for path in paths:
        try:
            with open(path, encoding="utf-8") as file:
                check(json.load(file))
            print(f"{path}: holds")
        except (Refused, OSError, json.JSONDecodeError) as reason:
            print(f"{path}: refused: {reason}")
            failed = 1
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
