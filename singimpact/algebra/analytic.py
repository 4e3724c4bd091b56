"""Expressions and their derivatives as one list of operations over balls, complex balls and power series of balls.

What occurs twice is computed once, and the derivative of a function reuses its value. On a complex ball a value is
finite only where the function is analytic on all of the ball: next to a branch cut, a pole or a kink it is nan.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.expressions import Expression, Root, evaluate
from singimpact.handed_on import flint

ZERO, ONE = Fraction(0), Fraction(1)
Operation = tuple[str, tuple[Any, ...]]


class Recorder:
    """A ring whose elements are places of a list of operations; each operation occurs once.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> recorder = Recorder()
    >>> f = recorder.record(parse("exp(2*x)", ["x"]))
    >>> (slope,) = recorder.program([recorder.derivative(f, "x")])({"x": 0})
    >>> print(slope)
    2.00000000000000
    """

    def __init__(self) -> None:
        self.operations: list[Operation] = []
        self.places: dict[Operation, int] = {}
        self.slopes: dict[tuple[int, str], int] = {}

    def record(self, tree: Expression) -> Place:
        """The place of a tree's value."""
        return evaluate(tree, _Names(self), self)  # type: ignore[no-any-return]

    def alone(self, tree: Expression) -> Callable[..., Any]:
        """A tree as a function of balls, complex balls or series that are given by name."""
        program = self.program([self.record(tree)])
        return lambda **values: program(values)[0]

    def rational(self, value: Fraction) -> Place:
        return self._place("number", Fraction(value))

    def pi(self) -> Place:
        return self._place("pi")

    def root(self, tree: Root) -> Place:
        return self._place("root", tree)

    def call(self, function: str, argument: Place) -> Place:
        return self._place(function, argument.at)

    def power(self, base: Place, exponent: Fraction) -> Place:
        """Whole powers by squaring, halves by sqrt, others by exp and log."""
        if exponent < 0:
            return self.call("inverse", self.power(base, -exponent))
        if exponent.denominator == 2:
            base, exponent = self.call("sqrt", base), exponent * 2
        if exponent.denominator != 1:
            return self.call("exp", self.rational(exponent) * self.call("log", base))
        product, count = self.rational(ONE), int(exponent)
        while count:
            if count & 1:
                product = product * base
            base, count = (base * base if count > 1 else base), count >> 1
        return product

    def _place(self, kind: str, *parts: Any) -> Place:
        operation = (kind, parts)
        # hash-consing: an operation that stands already is not written again
        at = self.places.get(operation)
        if at is None:
            at = self.places[operation] = len(self.operations)
            self.operations.append(operation)
        return Place(self, at)

    def value_of(self, at: int) -> Fraction | None:
        """The rational that stands at a place, if one does."""
        kind, parts = self.operations[at]
        return parts[0] if kind == "number" else None

    def derivative(self, place: Place, name: str) -> Place:
        """The place of the derivative by a name."""
        key = (place.at, name)
        if key not in self.slopes:
            self.slopes[key] = self._slope(place, name).at
        return Place(self, self.slopes[key])

    def _slope(self, index: Place, name: str) -> Place:
        kind, parts = self.operations[index.at]
        if kind in ("number", "pi", "root", "sign"):
            return self.rational(ZERO)
        if kind == "name":
            return self.rational(Fraction(int(parts[0] == name)))
        first = Place(self, parts[0])
        if kind in "+*":
            second = Place(self, parts[1])
            one, two = self.derivative(first, name), self.derivative(second, name)
            return one + two if kind == "+" else one * second + first * two
        inner = self.derivative(first, name)
        return inner if self.value_of(inner.at) == 0 else self._outer(kind, index, first) * inner

    def _outer(self, function: str, y: Place, u: Place) -> Place:
        """The derivative of y = function(u) by u."""
        minus, one = self.rational(-ONE), self.rational(ONE)
        match function:
            case "sin":
                return self.call("cos", u)
            case "cos":
                return minus * self.call("sin", u)
            case "tan":
                return one + y * y
            case "tanh":
                return one + minus * (y * y)
            case "exp":
                return y
            case "log":
                return self.call("inverse", u)
            case "sqrt":
                return self.rational(Fraction(1, 2)) * self.call("inverse", y)
            case "atan":
                return self.call("inverse", one + u * u)
            case "inverse":
                return minus * (y * y)
        return self.call("sign", u)

    def program(self, places: Sequence[Place]) -> Program:
        """The operations that some places need."""
        needed: set[int] = set()
        stack = [index.at for index in places]
        while stack:
            at = stack.pop()
            if at not in needed:
                needed.add(at)
                stack += self._arguments(at)
        order = {old: new for new, old in enumerate(sorted(needed))}
        operations = []
        for old in sorted(needed):
            kind, parts = self.operations[old]
            operations.append((kind, tuple(order[at] for at in parts) if self._arguments(old) else parts))
        return Program(tuple(operations), tuple(order[index.at] for index in places))

    def _arguments(self, at: int) -> tuple[int, ...]:
        kind, parts = self.operations[at]
        return () if kind in ("number", "pi", "root", "name") else parts


@dataclass(frozen=True)
class Place:
    """A value of a recorder's list."""

    recorder: Recorder
    at: int

    def __add__(self, other: Place) -> Place:
        one, two = self.recorder.value_of(self.at), self.recorder.value_of(other.at)
        if one is not None and two is not None:
            return self.recorder.rational(one + two)
        if one == 0 or two == 0:
            return other if one == 0 else self
        return self.recorder._place("+", *sorted((self.at, other.at)))

    def __mul__(self, other: Place) -> Place:
        one, two = self.recorder.value_of(self.at), self.recorder.value_of(other.at)
        if one is not None and two is not None:
            return self.recorder.rational(one * two)
        if one == 0 or two == 0:
            return self.recorder.rational(ZERO)
        if one == 1 or two == 1:
            return other if one == 1 else self
        return self.recorder._place("*", *sorted((self.at, other.at)))


class _Names(dict[str, Place]):
    """Names become places when they are met."""

    def __init__(self, recorder: Recorder) -> None:
        super().__init__()
        self.recorder = recorder

    def __missing__(self, name: str) -> Place:
        return self.recorder._place("name", name)


@dataclass(frozen=True)
class Program:
    """Operations in order, each on earlier places of the list, and the places of the results."""

    operations: tuple[Operation, ...]
    results: tuple[int, ...]

    def __call__(self, values: Mapping[str, Any]) -> list[Any]:
        """The results at balls, complex balls or series; constants are made at the working precision."""
        return self.prepared({})(values)

    def prepared(self, fixed: Mapping[str, Any]) -> Callable[[Mapping[str, Any]], list[Any]]:
        """The program with what depends on `fixed` names and constants alone computed at the working precision."""
        constants: list[Any] = [None] * len(self.operations)
        left: list[tuple[int, str, tuple[Any, ...]]] = []
        open_places: set[int] = set()
        for at, (kind, parts) in enumerate(self.operations):
            waits = (
                parts[0] not in fixed
                if kind == "name"
                else any(argument in open_places for argument in parts if kind not in ("number", "root"))
            )
            if waits:
                open_places.add(at)
                left.append((at, kind, parts))
            else:
                constants[at] = _done(kind, parts, constants, fixed)
        results = self.results

        def run(values: Mapping[str, Any]) -> list[Any]:
            done = constants.copy()
            for at, kind, parts in left:
                if kind == "*":
                    done[at] = done[parts[0]] * done[parts[1]]
                elif kind == "+":
                    done[at] = done[parts[0]] + done[parts[1]]
                elif kind == "name":
                    done[at] = values[parts[0]]
                else:
                    done[at] = call(kind, done[parts[0]])
            return [done[at] for at in results]

        return run


def _done(kind: str, parts: tuple[Any, ...], done: list[Any], values: Mapping[str, Any]) -> Any:
    match kind:
        case "+":
            return done[parts[0]] + done[parts[1]]
        case "*":
            return done[parts[0]] * done[parts[1]]
        case "name":
            return values[parts[0]]
        case "number":
            return flint.arb(flint.fmpq(parts[0].numerator, parts[0].denominator))
        case "pi":
            return flint.arb.pi()
        case "root":
            from singimpact.algebra.balls import ball_of
            from singimpact.algebra.precision import bits_of_balls

            return ball_of(parts[0], bits_of_balls() + 16)
    return call(kind, done[parts[0]])


def call(function: str, u: Any) -> Any:
    """A function of a ball, a complex ball or a series, nan where it is not analytic on the whole ball.

    Examples
    --------
    >>> import flint
    >>> beside_the_cut = flint.acb(-1, flint.arb(0, 1))  # flint's own logarithm of this ball is finite
    >>> beside_the_cut.log().is_finite(), call("log", beside_the_cut).is_finite()
    (True, False)
    """
    if not isinstance(u, flint.arb | flint.acb | flint.arb_series):
        u = flint.arb(u)
    if function == "inverse":
        return 1 / u
    if function in ("abs", "sign"):
        return _of_one_sign(function, u)
    if isinstance(u, flint.acb):
        if function in ("log", "sqrt"):
            u = off_the_cut(u)
        elif function == "atan":
            u = off_the_cuts_of_atan(u)
    return _tanh(u) if function == "tanh" and isinstance(u, flint.arb_series) else getattr(u, function)()


def off_the_cut(u: flint.acb) -> flint.acb:
    """A complex ball in the right half plane; nan instead of any other: flint's log and sqrt are finite on the cut."""
    return u if u.real > 0 else flint.acb(flint.arb.nan())


def off_the_cuts_of_atan(u: flint.acb) -> flint.acb:
    """A complex ball that meets no cut of atan, which lie beyond i and -i; nan instead of any other."""
    return u if abs(u.imag) < 1 or u.real > 0 or u.real < 0 else flint.acb(flint.arb.nan())


def _of_one_sign(function: str, u: Any) -> Any:
    """|u| as u or -u, or its slope: analytic where the real part keeps its sign, nan elsewhere."""
    part = u.real if isinstance(u, flint.acb) else u[0] if isinstance(u, flint.arb_series) else u
    sign = 1 if part > 0 else -1 if part < 0 else flint.arb.nan()
    return flint.arb(sign) if function == "sign" else u * sign


def _tanh(u: flint.arb_series) -> flint.arb_series:
    """Of a series, by the exponential that is not large."""
    above = u[0].mid() > 0
    # e^{-2|u|} does not overflow, and its difference from 1 keeps its digits where |u| is large
    small = (-2 * u if above else 2 * u).exp()
    quotient = (1 - small) / (1 + small)
    return quotient if above else -quotient
