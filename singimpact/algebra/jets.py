"""Jets: polynomials in named variables cut at a weighted order, over any ring of coefficients.

A `JetSpace` is immutable; jets of different spaces do not mix, and a space has one ring.  A jet is kept by its parts of
one weighted degree, so that a product makes no term that is cut away.  What loses order says so by its space.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.expressions import Expression, Root, evaluate
from singimpact.algebra.polynomials import Exponents, SparsePolynomials
from singimpact.algebra.precision import kept_property
from singimpact.algebra.taylor import taylor_coefficients
from singimpact.handed_on import sympy
from singimpact.inputs import need


@dataclass(frozen=True)
class JetSpace:
    """Polynomials in `variables` up to the weighted degree `order`, coefficients in `ring`.

    Parameters
    ----------
    variables : names. order : int, the last weighted degree kept.
    ring : of the coefficients. weights : one int >= 0 a variable, all 1 without; weight 0: kept to any power.

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

    @kept_property
    def polynomials(self) -> Any:
        """The ring of the terms of a jet."""
        own = getattr(self.ring, "polynomials", None)
        return own(self.variables) if own is not None else SparsePolynomials(self.variables, self.ring)

    def degree(self, exponents: Exponents) -> int:
        """The weighted degree of a monomial."""
        return sum(weight * exponent for weight, exponent in zip(self.weights, exponents, strict=True))

    def jet(self, terms: Mapping[Exponents, Any]) -> Jet:
        """The jet with these terms; terms beyond the order are dropped.

        Raises
        ------
        TypeError : a coefficient that is not of the ring.
        """
        graded: dict[int, dict[Exponents, Any]] = {}
        for key, value in terms.items():
            degree = self.degree(key)
            if degree <= self.order:
                graded.setdefault(degree, {})[key] = self.ring.element(value)
        return self.of_parts({degree: self.polynomials.from_terms(terms_) for degree, terms_ in graded.items()})

    def of_parts(self, parts: Mapping[int, Any]) -> Jet:
        """The jet with these homogeneous parts: degree -> polynomial."""
        vanishes = self.polynomials.vanishes
        return Jet(self, {d: part for d, part in parts.items() if d <= self.order and not vanishes(part)})

    def constant(self, value: Any) -> Jet:
        """A constant of the ring as a jet."""
        return self.jet({(0,) * len(self.variables): value})

    def generators(self) -> tuple[Jet, ...]:
        """The variables as jets."""
        made = zip(self.weights, self.polynomials.generators(), strict=True)
        return tuple(self.of_parts({weight: poly}) for weight, poly in made)

    def to_order(self, order: int) -> JetSpace:
        """A space of the same variables, cut at another order."""
        return self if order == self.order else JetSpace(self.variables, order, self.ring, self.weights)

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

    def root(self, tree: Root) -> Jet:
        return self.constant(self.ring.root(tree))

    def power(self, base: Jet, exponent: Fraction) -> Jet:
        if exponent.denominator == 1 and exponent >= 0:
            return base ** int(exponent)
        return self.call("power", base, exponent)

    def call(self, function: str, argument: Jet, exponent: Fraction | None = None) -> Jet:
        """function(argument), by its Taylor series at the constant term."""
        start = argument.constant_term()
        series = taylor_coefficients(function, start, self.order, self.ring, exponent)
        rest, total = argument - self.constant(start), self.constant(series[-1])
        for coefficient in reversed(series[:-1]):
            total = total * rest + self.constant(coefficient)
        return total


@dataclass(frozen=True, eq=False)
class Jet:
    """An element of a jet space, by homogeneous parts: weighted degree -> polynomial."""

    space: JetSpace
    parts: Mapping[int, Any]

    @kept_property
    def terms(self) -> Mapping[Exponents, Any]:
        """Exponents -> coefficient."""
        return {key: value for part in self.parts.values() for key, value in self.space.polynomials.terms(part).items()}

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
        parts, add = dict(self.parts), self.space.polynomials.add
        for degree, part in other.parts.items():
            parts[degree] = add(parts[degree], part) if degree in parts else part
        return self.space.of_parts(parts)

    def __neg__(self) -> Jet:
        return self.scaled(self.space.ring.rational(Fraction(-1)))

    def __sub__(self, other: Jet) -> Jet:
        return self + (-other)

    def __mul__(self, other: Jet) -> Jet:
        self._same(other)
        pairs: dict[int, list[tuple[Any, Any]]] = {}
        for degree, part in self.parts.items():
            for beside, factor in other.parts.items():
                if degree + beside <= self.space.order:
                    pairs.setdefault(degree + beside, []).append((part, factor))
        dot = self.space.polynomials.dot
        return self.space.of_parts({degree: dot(made) for degree, made in pairs.items()})

    def __truediv__(self, other: Jet) -> Jet:
        self._same(other)
        return self * other.reciprocal()

    def reciprocal(self) -> Jet:
        """1/self, part by part; the constant term must have an inverse in the ring, and no variable weight 0."""
        space = self.space
        need(0 not in space.weights, TypeError("a jet with a variable of weight 0 has no reciprocal"))
        found = start = space.power(space.constant(self.constant_term()), Fraction(-1))
        for degree in range(1, space.order + 1):
            found = found - (self * found).part(degree) * start
        return found

    def __pow__(self, exponent: int) -> Jet:
        result, square = self.space.rational(Fraction(1)), self
        while exponent:
            if exponent & 1:
                result = result * square
            exponent >>= 1
            if exponent:
                square = square * square
        return result

    def part(self, degree: int) -> Jet:
        """The part of one weighted degree."""
        return Jet(self.space, {degree: self.parts[degree]} if degree in self.parts else {})

    def cut(self, order: int) -> Jet:
        """The jet in the same variables, cut at an order that is not higher.

        Raises
        ------
        TypeError : a higher order: what lies there is not known.
        """
        if order > self.space.order:
            raise TypeError(f"a jet known to order {self.space.order} is not known to order {order}")
        return self.space.to_order(order).of_parts(self.parts)

    def scaled(self, factor: Any) -> Jet:
        """The jet times a ring element."""
        engine, value = self.space.polynomials, self.space.ring.element(factor)
        return self.space.of_parts({degree: engine.scaled(part, value) for degree, part in self.parts.items()})

    def derivative(self, variable: str) -> Jet:
        """The derivative by a variable; the order falls by its weight."""
        index = self.space.variables.index(variable)
        weight, engine = self.space.weights[index], self.space.polynomials
        parts = {degree - weight: engine.derivative(part, index) for degree, part in self.parts.items()}
        return self.space.to_order(self.space.order - weight).of_parts(parts)

    def integral(self, variable: str) -> Jet:
        """The integral by a variable from 0; the order rises by its weight."""
        index = self.space.variables.index(variable)
        weight, engine = self.space.weights[index], self.space.polynomials
        parts = {degree + weight: engine.integral(part, index) for degree, part in self.parts.items()}
        return self.space.to_order(self.space.order + weight).of_parts(parts)

    def at(self, variable: str, value: Fraction | int) -> Jet:
        """The jet with a variable of weight 0 set to a rational, or any variable set to 0."""
        index, engine = self.space.variables.index(variable), self.space.polynomials
        if self.space.weights[index] and value:
            raise TypeError(f"a jet is known near {variable} = 0 alone")
        exact = Fraction(value)
        return self.space.of_parts({degree: engine.at(part, index, exact) for degree, part in self.parts.items()})

    def compose(self, inner: Sequence[Jet]) -> Jet:
        """The jet with its variables replaced by jets without constant term, of one space.

        The order is the lower of the two: what the outer jet does not know is not made up.
        """
        target = inner[0].space
        for jet in inner:
            jet._same(inner[0])
        if any(min(jet.parts, default=weight) < weight for jet, weight in zip(inner, self.space.weights, strict=True)):
            raise TypeError("a jet is composed with jets of no lower degree than the weights of its variables")
        order = min(self.space.order, target.order)
        if all(set(jet.parts) <= {weight} for jet, weight in zip(inner, self.space.weights, strict=True)):
            return self._substituted(inner).cut(order)
        powers = [[target.rational(Fraction(1))] for _ in inner]
        total = target.jet({})
        for key, value in self.terms.items():
            term = target.constant(value)
            for index, exponent in enumerate(key):
                while len(powers[index]) <= exponent:
                    powers[index].append(powers[index][-1] * inner[index])
                term = term * powers[index][exponent] if exponent else term
            total = total + term
        return total.cut(order)

    def _substituted(self, inner: Sequence[Jet]) -> Jet:
        """A linear change: each part stays in its degree, so nothing is cut."""
        target = inner[0].space
        zero = target.polynomials.from_terms({})
        images = [jet.parts.get(weight, zero) for jet, weight in zip(inner, self.space.weights, strict=True)]
        engine = self.space.polynomials
        return target.of_parts(
            {d: engine.substituted(part, images, target.polynomials) for d, part in self.parts.items()}
        )

    def to_sympy(self, number: Callable[[Any], Any] | None = None) -> Any:
        """The jet as a sympy expression in its variables; `number` shows a coefficient, or else the ring does."""
        convert: Any = number or getattr(self.space.ring, "to_sympy", sympy.sympify)
        letters = [sympy.Symbol(name) for name in self.space.variables]
        powers = (sympy.prod(s**e for s, e in zip(letters, key, strict=True)) for key in self.terms)
        return sympy.Add(*(convert(value) * power for value, power in zip(self.terms.values(), powers, strict=True)))

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
