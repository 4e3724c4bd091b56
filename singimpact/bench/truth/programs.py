"""An expression and its derivatives as one list of operations, run over balls, complex boxes or power series.

Parts that occur twice are computed once. Where a function is not analytic on all of a complex box, its value is nan.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint

from singimpact.algebra.expressions import Expression, evaluate

Operation = tuple[str, tuple[Any, ...]]


@dataclass(frozen=True)
class Program:
    """Operations in order, each on earlier places of the list, and the places of the results."""

    operations: tuple[Operation, ...]
    results: tuple[int, ...]

    @classmethod
    def of(cls, trees: Sequence[Expression]) -> Program:
        """The program of some trees.

        Examples
        --------
        >>> from singimpact.algebra.parsing import parse
        >>> len(Program.of([parse("tanh(x)**2", ["x"]), parse("1 + tanh(x)", ["x"])]).operations)
        5
        """
        recorder = _Recorder()
        names = _Names(recorder)
        results = tuple(evaluate(tree, names, recorder).place for tree in trees)
        return cls(tuple(recorder.places), results)

    def run(self, values: Mapping[str, Any]) -> list[Any]:
        """The results where names have values; constants are made at the working precision."""
        done: list[Any] = []
        for kind, parts in self.operations:
            if kind == "+":
                done.append(done[parts[0]] + done[parts[1]])
            elif kind == "*":
                done.append(done[parts[0]] * done[parts[1]])
            elif kind == "name":
                done.append(values[parts[0]])
            elif kind == "number":
                done.append(_number(parts[0]))
            elif kind == "power":
                done.append(power(done[parts[0]], parts[1]))
            else:
                done.append(call(kind, done[parts[0]]))
        return [done[index] for index in self.results]


def call(function: str, z: Any) -> Any:
    """sin, cos, tan, exp, log, sqrt, atan or tanh of a ball, a complex box or a series of balls."""
    if function in ("log", "sqrt"):
        z = _off_the_cut(z)
    if isinstance(z, flint.acb) and function == "atan" and not (abs(z.imag) < 1 or z.real > 0 or z.real < 0):
        return flint.acb(flint.arb.nan())  # the box may meet the cuts of atan, beyond i and -i
    if function == "tanh" and isinstance(z, flint.arb_series):
        # the exponential that is not large, so that nothing overflows and 1 + it is far from 0
        small = (-2 * z if z[0].mid() > 0 else 2 * z).exp()
        quotient = (1 - small) / (1 + small)
        return quotient if z[0].mid() > 0 else -quotient
    return getattr(z, function)()


def power(base: Any, exponent: Fraction) -> Any:
    """base^exponent; powers that are not whole need a base off the negative axis."""
    if exponent.denominator > 2:
        return (_number(exponent) * call("log", base)).exp()
    root = call("sqrt", base) if exponent.denominator == 2 else base
    count = abs(exponent.numerator)
    product = root * root if count > 1 else root
    for _ in range(count - 2):
        product = product * root
    return product if exponent > 0 else 1 / product


def _off_the_cut(z: Any) -> Any:
    """The box itself, or nan unless it is proved to have Re > 0, because flint's log is finite across its cut."""
    return flint.acb(flint.arb.nan()) if isinstance(z, flint.acb) and not z.real > 0 else z


def _number(value: Fraction | None) -> Any:
    """A rational at the working precision; None stands for pi."""
    return flint.arb.pi() if value is None else flint.arb(flint.fmpq(value.numerator, value.denominator))


class _Recorder:
    """A ring whose elements are places of a list of operations."""

    def __init__(self) -> None:
        self.places: dict[Operation, int] = {}

    def place(self, kind: str, *parts: Any) -> _Place:
        return _Place(self, self.places.setdefault((kind, parts), len(self.places)))

    def rational(self, value: Fraction) -> _Place:
        return self.place("number", Fraction(value))

    def pi(self) -> _Place:
        return self.place("number", None)

    def power(self, base: _Place, exponent: Fraction) -> _Place:
        return self.place("power", base.place, exponent)

    def call(self, function: str, argument: _Place) -> _Place:
        return self.place(function, argument.place)

    def root(self, tree: Expression) -> _Place:
        raise TypeError(f"the root {tree} has no program")


@dataclass(frozen=True)
class _Place:
    recorder: _Recorder
    place: int

    def __add__(self, other: _Place) -> _Place:
        return self.recorder.place("+", self.place, other.place)

    def __mul__(self, other: _Place) -> _Place:
        return self.recorder.place("*", self.place, other.place)


class _Names(dict[str, _Place]):
    """Names become places when they are met."""

    def __init__(self, recorder: _Recorder) -> None:
        super().__init__()
        self.recorder = recorder

    def __missing__(self, name: str) -> _Place:
        return self.recorder.place("name", name)
