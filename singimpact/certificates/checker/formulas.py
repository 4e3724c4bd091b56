"""Texts as functions of balls, of complex balls, of series of balls, and of numbers with derivatives."""

import ast
from collections.abc import Sequence
from fractions import Fraction
from time import process_time
from typing import Any

from flint import acb, arb, fmpq

FUNCTIONS = ("sin", "cos", "tan", "tanh", "exp", "log", "sqrt", "atan")


class Refused(Exception):
    """A certificate that is not accepted, and why."""


class Wrong(Refused):
    """A certificate is refused for a reason that more digits do not remove."""


def need(name: str, holds: Any, why: str, error: type[Refused] = Wrong) -> None:
    """Refuse unless a condition holds; its name stands in the tests, with a false certificate that it alone refuses."""
    if not holds:
        refuse(name, error(why))


def refuse(name: str, error: Refused) -> None:  # noqa: ARG001
    """The one place in which a condition refuses."""
    raise error


class Clock:
    """The CPU seconds that a certificate may take."""

    seconds = end = float("inf")

    @classmethod
    def start(cls, seconds: float) -> None:
        cls.seconds, cls.end = seconds, process_time() + seconds

    @classmethod
    def stop(cls) -> None:
        """End the limit on the CPU time of this process."""
        cls.seconds = cls.end = float("inf")

    @classmethod
    def look(cls) -> None:
        if process_time() > cls.end:
            raise Wrong(f"it is not decided within {cls.seconds:g} s of CPU")


def ball(value: Fraction) -> Any:
    """A rational at the working precision."""
    return arb(fmpq(value.numerator, value.denominator))


class Dual:
    """A number and its derivatives by some others, which may be such numbers themselves."""

    def __init__(self, value: Any, slopes: Sequence[Any]) -> None:
        self.value, self.slopes = value, list(slopes)

    def __add__(self, other: Any) -> "Dual":
        if isinstance(other, Dual):
            return Dual(self.value + other.value, map(sum, zip(self.slopes, other.slopes, strict=True)))  # type: ignore[arg-type]
        return Dual(self.value + other, self.slopes)

    def __mul__(self, other: Any) -> "Dual":
        if not isinstance(other, Dual):
            return Dual(self.value * other, [each * other for each in self.slopes])
        pairs = zip(self.slopes, other.slopes, strict=True)
        return Dual(self.value * other.value, [a * other.value + b * self.value for a, b in pairs])

    __radd__, __rmul__ = __add__, __mul__


def total(one: Any, other: Any) -> Any:
    """The sum; a series of python-flint 0.7 does not leave it to a `Dual` behind it."""
    return other + one if isinstance(other, Dual) else one + other


def product(one: Any, other: Any) -> Any:
    """The product, as `total`."""
    return other * one if isinstance(other, Dual) else one * other


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
            "sin": lambda: applied("cos", at),
            "cos": lambda: applied("sin", at) * -1,
            "exp": lambda: y,
            "log": lambda: reciprocal(at),
            "sqrt": lambda: reciprocal(y * 2),
            "atan": lambda: reciprocal(at * at + 1),
        }[name]()
        return Dual(y, [slope * rate for rate in x.slopes])
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

    def __init__(self, text: Any, parameters: dict[str, Any]) -> None:
        self.text, self.parameters = str(text), parameters
        self.tree = ast.parse(self.text, mode="eval").body

    def __call__(self, **values: Any) -> Any:
        Clock.look()
        return self._at(self.tree, values)

    def names(self, node: ast.expr | None = None) -> set[str]:
        """The names in the text, or in a part of it."""
        return {part.id for part in ast.walk(node or self.tree) if isinstance(part, ast.Name)}

    def exact(self, node: ast.expr) -> Fraction | None:
        """The rational that a part is, if it is one: decimals are exact."""
        match node:
            case ast.Constant(int() | float()):
                return Fraction(ast.get_source_segment(self.text, node) or "")
            case ast.UnaryOp(ast.USub(), part) if (value := self.exact(part)) is not None:
                return -value
            case ast.BinOp(left, op, right):
                one, other = self.exact(left), self.exact(right)
                if one is not None and other is not None and not (isinstance(op, ast.Div) and not other):
                    operation = {
                        ast.Add: Fraction.__add__,
                        ast.Sub: Fraction.__sub__,
                        ast.Mult: Fraction.__mul__,
                        ast.Div: Fraction.__truediv__,
                    }.get(type(op))
                    return None if operation is None else operation(one, other)
        return None

    def _at(self, node: ast.expr, values: dict[str, Any]) -> Any:
        constant = self.exact(node)
        if constant is not None:
            return ball(constant)
        minus = ball(Fraction(-1))
        match node:
            case ast.Name(name) if name in values:
                return values[name]
            case ast.Name("pi"):
                return arb.pi()
            case ast.Name(name) if name in self.parameters:
                parameter = self.parameters[name]
                return parameter if isinstance(parameter, arb) else Formula(parameter, {})()
            case ast.UnaryOp(ast.USub(), part):
                return self._at(part, values) * minus
            case ast.BinOp(left, ast.Add(), right):
                return total(self._at(left, values), self._at(right, values))
            case ast.BinOp(left, ast.Sub(), right):
                return total(self._at(left, values), self._at(right, values) * minus)
            case ast.BinOp(left, ast.Mult(), right):
                return product(self._at(left, values), self._at(right, values))
            case ast.BinOp(left, ast.Div(), right):
                return product(self._at(left, values), reciprocal(self._at(right, values)))
            case ast.BinOp(base, ast.Pow(), exponent) if (value := self.exact(exponent)) is not None:
                return power(self._at(base, values), value)
            case ast.Call(ast.Name(name), [part], []) if name in FUNCTIONS:
                x = self._at(part, values)
                if name == "tan":
                    return applied("sin", x) * reciprocal(applied("cos", x))
                if name == "tanh":
                    grown = applied("exp", x + x)
                    return (grown + minus) * reciprocal(grown + 1)
                return applied(name, x)
        raise Refused(f"{ast.unparse(node)!r} in {self.text!r} is not understood")


# The period of f and g in t, checked in exact arithmetic.


def require_period(g: Formula, period: str) -> None:
    """Refuse a period that f or g is not shown to have: t is in sines of rate t + phase, rate period = 2 pi m."""
    length = Formula(period, g.parameters)
    turn = monomial(length, length.tree)

    def seen(node: ast.AST) -> bool:
        """Whether a part has the period."""
        match node:
            case ast.Name("t"):
                return False
            case ast.Call(ast.Name("sin" | "cos" | "tan"), [argument]) if "t" in g.names(argument):
                frequency = rate(g, argument)
                if frequency is None or turn is None or frequency[1] + turn[1] != 1:
                    return False
                return (frequency[0] * turn[0] / 2).denominator == 1
        return all(seen(child) for child in ast.iter_child_nodes(node))

    need("period", seen(g.tree), f"{g.text} is not shown to have the period {period}")


def monomial(formula: Formula, node: ast.expr) -> tuple[Fraction, int] | None:
    """(q, k) of a part that is q pi^k, q rational."""
    if (rational := formula.exact(node)) is not None:
        return rational, 0
    match node:
        case ast.Name("pi"):
            return Fraction(1), 1
        case ast.Name(name) if name in formula.parameters:
            inner = Formula(formula.parameters[name], {})
            return monomial(inner, inner.tree)
        case ast.UnaryOp(ast.USub(), part) if (power := monomial(formula, part)) is not None:
            return -power[0], power[1]
        case ast.BinOp(left, ast.Mult() | ast.Div() as op, right):
            one, other = monomial(formula, left), monomial(formula, right)
            if one is not None and other is not None and other[0]:
                sign = 1 if isinstance(op, ast.Mult) else -1
                return one[0] * other[0] ** sign, one[1] + sign * other[1]
    return None


def rate(formula: Formula, node: ast.expr) -> tuple[Fraction, int] | None:
    """(q, k) of a part that is q pi^k t + a constant; q = 0 where it is constant."""
    if "t" not in formula.names(node):
        return Fraction(0), 0
    match node:
        case ast.Name():
            return Fraction(1), 0
        case ast.UnaryOp(ast.USub(), part) if (slope := rate(formula, part)) is not None:
            return -slope[0], slope[1]
        case ast.BinOp(left, ast.Add() | ast.Sub() as op, right):
            one, other = rate(formula, left), rate(formula, right)
            if one is None or other is None or (one[0] and other[0]):
                return None
            return one if one[0] else (other[0] * (1 if isinstance(op, ast.Add) else -1), other[1])
        case ast.BinOp(left, ast.Mult() | ast.Div() as op, right):
            inner, factor = rate(formula, left), monomial(formula, right)
            if isinstance(op, ast.Mult) and factor is None:
                inner, factor = rate(formula, right), monomial(formula, left)
            if inner is not None and factor is not None and factor[0]:
                sign = 1 if isinstance(op, ast.Mult) else -1
                return inner[0] * factor[0] ** sign, inner[1] + sign * factor[1]
    return None
