"""Jets: polynomials in named variables cut at a weighted order, over any ring of coefficients.

A `JetSpace` is immutable; jets of different spaces do not mix.  The coefficients may be rationals, doubles, mpmath
numbers, balls, or polynomials in symbols: only + - * and the ring's own functions are used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.expressions import Expression, evaluate
from singimpact.algebra.taylor import taylor_coefficients

Exponents = tuple[int, ...]


@dataclass(frozen=True)
class JetSpace:
    """Polynomials in `variables` up to the weighted degree `order`, coefficients in `ring`.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> space = JetSpace(("s", "t"), 2, EXACT)
    >>> s, t = space.generators()
    >>> print((s + t) * (s + t) * s + t)
    t
    """

    variables: tuple[str, ...]
    order: int
    ring: Any
    weights: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if not self.weights:
            object.__setattr__(self, "weights", (1,) * len(self.variables))

    def degree(self, exponents: Exponents) -> int:
        """The weighted degree of a monomial."""
        return sum(weight * exponent for weight, exponent in zip(self.weights, exponents, strict=True))

    def jet(self, terms: Mapping[Exponents, Any]) -> Jet:
        """The jet with these terms; terms beyond the order are dropped."""
        return Jet(self, {key: value for key, value in terms.items() if self.degree(key) <= self.order})

    def constant(self, value: Any) -> Jet:
        """A constant of the ring as a jet."""
        return Jet(self, {(0,) * len(self.variables): value})

    def generators(self) -> tuple[Jet, ...]:
        """The variables as jets."""
        size, one = len(self.variables), self.ring.rational(Fraction(1))
        return tuple(self.jet({tuple(int(i == j) for j in range(size)): one}) for i in range(size))

    def evaluate(self, tree: Expression, values: Mapping[str, Jet]) -> Jet:
        """The jet of an expression; names not in `values` are an error.

        Raises
        ------
        NotSmooth : the expression has no Taylor series there (abs or sqrt at 0).
        """
        value = evaluate(tree, values, self)
        return value if isinstance(value, Jet) else self.constant(value)

    # -- the ring protocol: an expression tree is evaluated over a jet space like over any ring
    def rational(self, value: Fraction) -> Jet:
        return self.constant(self.ring.rational(value))

    def pi(self) -> Jet:
        return self.constant(self.ring.pi())

    def power(self, base: Jet, exponent: Fraction) -> Jet:
        if exponent.denominator == 1 and exponent >= 0:
            return base ** int(exponent)
        return self.composed("power", base, exponent)

    def call(self, function: str, argument: Jet) -> Jet:
        return self.composed(function, argument, None)

    def composed(self, function: str, argument: Jet, exponent: Fraction | None) -> Jet:
        """function(argument), by its Taylor series at the constant term."""
        start = argument.constant_term()
        series = taylor_coefficients(function, start, self.order, self.ring, exponent)
        rest = argument - self.constant(start)
        total = self.constant(series[-1])
        for coefficient in reversed(series[:-1]):
            total = total * rest + self.constant(coefficient)
        return total


@dataclass(frozen=True, eq=False)
class Jet:
    """An element of a jet space: exponents -> coefficient."""

    space: JetSpace
    terms: Mapping[Exponents, Any]

    def constant_term(self) -> Any:
        """The coefficient of 1."""
        return self.coefficient((0,) * len(self.space.variables))

    def coefficient(self, exponents: Sequence[int]) -> Any:
        """One coefficient; zero of the ring when the term is absent."""
        found = self.terms.get(tuple(exponents))
        return self.space.ring.rational(Fraction(0)) if found is None else found

    def _same(self, other: Jet) -> None:
        if other.space is not self.space and other.space != self.space:
            raise TypeError(f"jets of different spaces do not mix: {self.space} and {other.space}")

    def __add__(self, other: Jet) -> Jet:
        self._same(other)
        terms = dict(self.terms)
        for key, value in other.terms.items():
            terms[key] = terms[key] + value if key in terms else value
        return Jet(self.space, terms)

    def __neg__(self) -> Jet:
        return Jet(self.space, {key: -value for key, value in self.terms.items()})

    def __sub__(self, other: Jet) -> Jet:
        return self + (-other)

    def __mul__(self, other: Jet) -> Jet:
        self._same(other)
        space = self.space
        terms: dict[Exponents, Any] = {}
        right = [(key, space.degree(key), value) for key, value in other.terms.items()]
        for key, value in self.terms.items():
            room = space.order - space.degree(key)
            for other_key, degree, other_value in right:
                if degree <= room:
                    total = tuple(i + j for i, j in zip(key, other_key, strict=True))
                    product = value * other_value
                    terms[total] = terms[total] + product if total in terms else product
        return Jet(space, terms)

    def __pow__(self, exponent: int) -> Jet:
        result, square = self.space.rational(Fraction(1)), self
        while exponent:
            if exponent & 1:
                result = result * square
            exponent >>= 1
            if exponent:
                square = square * square
        return result

    def scaled(self, factor: Any) -> Jet:
        """The jet times a ring element."""
        return Jet(self.space, {key: value * factor for key, value in self.terms.items()})

    def compose(self, inner: Sequence[Jet]) -> Jet:
        """The jet with its variables replaced by jets without constant term, of one space."""
        target = inner[0].space
        powers = [[target.rational(Fraction(1))] for _ in inner]
        total = target.jet({})
        for key, value in self.terms.items():
            term = target.constant(value)
            for index, exponent in enumerate(key):
                while len(powers[index]) <= exponent:
                    powers[index].append(powers[index][-1] * inner[index])
                term = term * powers[index][exponent] if exponent else term
            total = total + term
        return total

    def __str__(self) -> str:
        shown = []
        for key in sorted(self.terms, key=lambda k: (self.space.degree(k), tuple(-e for e in k))):
            value = self.terms[key]
            if value == 0:
                continue
            monomial = "*".join(
                name if exponent == 1 else f"{name}**{exponent}"
                for name, exponent in zip(self.space.variables, key, strict=True)
                if exponent
            )
            shown.append(monomial if monomial and value == 1 else f"({value})*{monomial}" if monomial else f"{value}")
        return " + ".join(shown) or "0"
