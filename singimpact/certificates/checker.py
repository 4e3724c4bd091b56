"""The second program: `python checker.py FILE.json ...` checks certificates.

This file stands alone.  It imports python-flint and the standard library, reads the model as text, and encloses the
motion again with its own code.  It accepts a certificate when its enclosure lies within what the certificate says.

The motion x'' + f(x, x') = g(t) from (x, x') at a time t_0 is followed by Taylor polynomials P of degree n.  Let
F = P'' + f(P, P') - g.  If f and g are analytic on the images of the disc |s| <= R and |F| <= M there, F has a zero of
order n - 1 at s = 0, so |F(s)| <= M (|s|/R)^(n-1) by Schwarz's lemma.  Let |f_x| <= A, |f_x'| <= B for all (x, x')
within `slack` of (P, P'), and K = M R^(1-n) exp(B h + A h^2/2)/n.  By Gronwall's lemma the motion exists on [0, h] and

    |x'(s) - P'(s)| <= K s^n,        |x(s) - P(s)| <= K s^(n+1)/(n+1)        if K h^n (1 + h) < slack.

A first hit is a change of sign of x - c on a piece on which x' < 0, with x - c > 0 on all pieces before; on the first
step (x - c)/s takes the place of x - c, so that launches from the wall are decided however slow they are.
"""

from __future__ import annotations

import ast
import hashlib
import json
import sys
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

from flint import acb, arb, arb_poly, arb_series, ctx, fmpq

SCHEMA = "singimpact certificate 1"
PARTS = ("flight_time", "velocity", "tau", "v")
TERMS = 10_000  # flint cuts a series after ctx.cap terms without a word


class Refused(Exception):
    """A certificate that is not accepted, and why."""


# ---- expressions over balls, series of balls, and numbers with derivatives


def ball(value: Fraction) -> Any:
    """A rational at the working precision."""
    return arb(fmpq(value.numerator, value.denominator))


class Dual:
    """A number and its derivatives by x and x'."""

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
        return Dual(1 / number.value, [-each / (number.value * number.value) for each in number.slopes])
    return 1 / number


def applied(name: str, x: Any) -> Any:
    """A function of a number."""
    if isinstance(x, Dual):
        y, at = applied(name, x.value), x.value
        slope = {
            "sin": lambda: at.cos(), "cos": lambda: -at.sin(), "exp": lambda: y, "log": lambda: 1 / at,
            "sqrt": lambda: 1 / (2 * y), "atan": lambda: 1 / (1 + at * at),
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
        return self._law(v=velocity) if law else self._law() * -velocity


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


def taylor(model: Model, time: Any, x: Any, v: Any, n: int) -> list[Any]:
    """The coefficients 0, ..., n of the motion, one after the other."""
    forcing, X = coefficients(model.g(t=arb_series([time, 1], prec=n)), n), [x, v]
    for k in range(n - 1):
        place = arb_series(X[: k + 1], prec=k + 1)
        speed = arb_series([(i + 1) * a for i, a in enumerate(X[1:])], prec=k + 1)
        X.append((forcing[k] - coefficients(model.f(x=place, xdot=speed), k + 1)[k]) / ((k + 1) * (k + 2)))
    return X


def spread(X: list[Any]) -> tuple[Callable[[Any], Any], Callable[[Any], Any], Callable[[Any], Any]]:
    """Bounds of |P(s) - P(0)|, |P'(s) - P'(0)| and |P''(s)| for |s| <= R, as functions of R."""
    P = arb_poly([0, *map(size, X[1:])])
    D = P.derivative()
    return P, D - arb_poly([D[0]]), D.derivative()


def defect(model: Model, time: Any, X: list[Any], R: Any) -> Any:
    """A bound of |P'' + f(P, P') - g| on |s| <= R; None where f or g is not shown to be analytic on the image."""
    bounds = [bound(R) for bound in spread(X)]
    place, speed, at = (acb(centre + within(radius), within(radius))
                        for centre, radius in ((X[0], bounds[0]), (X[1], bounds[1]), (time, R)))  # fmt: skip
    total = acb(model.f(x=place, xdot=speed)) - acb(model.g(t=at))
    return size(total) + bounds[2] if total.is_finite() else None


def step(model: Model, time: Any, x: Any, v: Any, bits: int) -> tuple[list[Any], Any, Any]:
    """The polynomial of one step, its length h, and K."""
    n = max(16, int(0.55 * bits))
    X = taylor(model, time, x, v, n)
    if not all(a.is_finite() for a in X):
        raise Refused("f or g is singular on the way")
    unit = size(X[1]) + size(X[2]) / 8
    rate = max(float(size(X[k]) / unit) ** (1 / k) for k in (n - 2, n - 1, n))
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
    for _ in range(60):
        slack, bounds = arb(2) ** (-bits // 2), spread(X)
        place, speed = (X[i] + within(bounds[i](length) + slack) for i in (0, 1))
        found = model.f(x=Dual(place, [1, 0]), xdot=Dual(speed, [0, 1]))
        A, B = (size(arb(each)) for each in (found.slopes if isinstance(found, Dual) else (0, 0)))
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


def flight(model: Model, tau: Any, v: Any, bits: int, horizon: float = 1e4) -> tuple[Any, Any]:
    """The time of the first hit and x' there."""
    if not v > 0:
        raise Refused("the launch velocity is not shown to be positive")
    c, passed, first = model.c(), arb(0), True
    x, speed = c, v
    while passed < horizon:
        X, h, K = step(model, tau + passed, x, speed, bits)
        n, P, D = len(X) - 1, arb_poly(X), arb_poly(X).derivative()
        Q = arb_poly(X[1:]) if first else arb_poly([X[0] - c, *X[1:]])
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
        speed = D(s) + within(K * size(s) ** n)
        if U is not None:
            return passed + U, speed.intersection(U * slope(U)) if first else speed
        x, passed, first = P(s) + within(K * s ** (n + 1) / (n + 1)), passed + s, False
        if not x - c > 0:
            raise Refused("x - c is lost at the end of a step")
    raise Refused(f"no hit before {horizon:g}")


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
    if (told.get("schema"), told.get("statement")) != (SCHEMA, "first impact"):
        raise Refused(f"only certificates {SCHEMA!r} of a 'first impact' are checked here")
    if told.get("digest") != digest_of(told):
        raise Refused("the digest is not that of the content: the file was changed")
    before = ctx.prec, ctx.cap
    try:
        _check_first_impact(told)
    except (KeyError, TypeError, ValueError, SyntaxError, ZeroDivisionError, AttributeError) as error:
        raise Refused(f"not a certificate: {error!r}") from error
    finally:
        ctx.prec, ctx.cap = before


def _check_first_impact(told: dict[str, Any]) -> None:
    model, why = Model(told["model"]), ""
    sizes = {name: max(abs(Fraction(told[name]["value"])), Fraction(1)) for name in PARTS}
    narrowest = min(Fraction(told[name]["radius"]) / sizes[name] for name in PARTS)
    if narrowest <= 0:
        raise Refused("a radius that is not above 0")
    wanted = narrowest.denominator.bit_length() - narrowest.numerator.bit_length()
    for bits in ((wanted + 16) * 2**k for k in range(4)):
        ctx.prec, ctx.cap = bits + 32, TERMS
        tau, v = (Formula(told["launch"][name], {})() for name in ("tau", "v"))
        try:
            time, velocity = flight(model, tau, v, bits)
        except Refused as reason:
            why = str(reason)
            continue
        found = dict(zip(PARTS, (time, velocity, tau + time, model.rebound(velocity)), strict=True))
        missed = [name for name in PARTS if not lies_within(found[name], told[name])]
        if not missed:
            return
        why = f"{missed[0]} is {found[missed[0]].str(30)}"
        told_ball = ball(Fraction(told[missed[0]]["value"])) + within(ball(Fraction(told[missed[0]]["radius"])))
        if not found[missed[0]].overlaps(told_ball):
            break
    raise Refused(why)


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
