"""Polynomials that jets are made of: packed ones of python-flint for exact coefficients, sparse ones for others.

A ring may bring its own by a method `polynomials(variables)`; what such an object must answer is what both classes
here answer.  No polynomial is ever tested for being zero by a tolerance.
"""

from __future__ import annotations  # flint and sympy are loaded when they are used

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from singimpact.handed_on import flint

Exponents = tuple[int, ...]


class PackedPolynomials:
    """Polynomials in `variables` over Q or over Q[names]: one fmpq_mpoly holds variables and names alike.

    Examples
    --------
    >>> packed = PackedPolynomials(("s", "t"))
    >>> packed.terms(packed.dot([(packed.from_terms({(1, 0): 2}), packed.from_terms({(0, 1): Fraction(1, 3)}))]))
    {(1, 1): Fraction(2, 3)}
    """

    def __init__(self, variables: tuple[str, ...], names: tuple[str, ...] = (), inner: Any = None) -> None:
        self.size = len(variables)
        self._variables = tuple(f"jet {name}" for name in variables)  # a symbol may bear the name of a variable
        self._inner = inner
        self._context = flint.fmpq_mpoly_ctx.get((*self._variables, *names), "degrevlex")

    def generators(self) -> tuple[flint.fmpq_mpoly, ...]:
        """The variables."""
        return tuple(self._context.gens()[: self.size])

    def constant(self, value: Any) -> Any:
        """A coefficient as a polynomial."""
        if self._inner is not None and not isinstance(value, int | Fraction):
            return value.project_to_context(self._context)
        return self._context.constant(_fmpq(value))

    def coefficient(self, poly: flint.fmpq_mpoly) -> flint.fmpq_mpoly:
        """A polynomial over Q[names] in which no variable occurs, as a coefficient: the other way round."""
        return poly.project_to_context(self._inner)

    def from_terms(self, terms: Mapping[Exponents, Any]) -> flint.fmpq_mpoly:
        """Exponents -> coefficient, as a polynomial."""
        if self._inner is None:
            return self._context.from_dict({key: _fmpq(value) for key, value in terms.items()})
        tail = (0,) * (self._context.nvars() - self.size)
        total = self._context.constant(0)
        for key, value in terms.items():
            total += self.constant(value) * self._context.from_dict({(*key, *tail): 1})
        return total

    def terms(self, poly: flint.fmpq_mpoly) -> dict[Exponents, Any]:
        """A polynomial as exponents -> coefficient, the nonzero ones."""
        if self._inner is None:
            return {tuple(map(int, key)): Fraction(int(value.p), int(value.q)) for key, value in poly.to_dict().items()}
        parts: dict[Exponents, dict[Exponents, Any]] = {}
        for key, value in poly.to_dict().items():
            parts.setdefault(tuple(map(int, key[: self.size])), {})[key[self.size :]] = value
        return {key: self._inner.from_dict(part) for key, part in parts.items()}

    def dot(self, pairs: Iterable[tuple[flint.fmpq_mpoly, flint.fmpq_mpoly]]) -> flint.fmpq_mpoly:
        """The sum of the products of pairs, added like with like: a sum copies what it is added to."""
        waiting: list[Any] = []
        for left, right in pairs:
            product = left * right
            while waiting and len(waiting[-1]) <= 2 * len(product):
                product = waiting.pop() + product
            waiting.append(product)
        total = self._context.constant(0)
        while waiting:
            total = waiting.pop() + total
        return total

    def add(self, left: flint.fmpq_mpoly, right: flint.fmpq_mpoly) -> flint.fmpq_mpoly:
        return left + right

    def scaled(self, poly: flint.fmpq_mpoly, factor: Any) -> Any:
        """The polynomial times a coefficient."""
        return poly * self.constant(factor)

    def vanishes(self, poly: Any) -> bool:
        return bool(poly == 0)

    def derivative(self, poly: flint.fmpq_mpoly, index: int) -> flint.fmpq_mpoly:
        return poly.derivative(self._variables[index])

    def integral(self, poly: flint.fmpq_mpoly, index: int) -> flint.fmpq_mpoly:
        """The integral from 0."""
        return poly.integral(self._variables[index])

    def at(self, poly: flint.fmpq_mpoly, index: int, value: Fraction) -> flint.fmpq_mpoly:
        """The polynomial with one variable set to a rational."""
        return poly.subs({self._variables[index]: _fmpq(value)})

    def without(self, poly: flint.fmpq_mpoly, index: int, target: PackedPolynomials) -> flint.fmpq_mpoly:
        """The polynomial, free of one variable, as one of `target`, which has the others."""
        assert poly.degrees()[index] <= 0
        return poly.project_to_context(target._context)

    def substituted(
        self, poly: flint.fmpq_mpoly, images: Sequence[flint.fmpq_mpoly], target: PackedPolynomials
    ) -> flint.fmpq_mpoly:
        """The polynomial with its variables replaced by polynomials of `target`, over the same coefficients."""
        return poly.compose(*images, *target._context.gens()[target.size :], ctx=target._context)


def _fmpq(value: int | Fraction) -> flint.fmpq:
    return flint.fmpq(value.numerator, value.denominator)


class SparsePolynomials:
    """Polynomials as exponents -> coefficient, over any ring: only + - * of its elements are used.

    Examples
    --------
    >>> from singimpact.algebra.rings import DOUBLES
    >>> sparse = SparsePolynomials(("s",), DOUBLES)
    >>> sparse.derivative({(3,): 0.5}, 0)
    {(2,): 1.5}
    """

    def __init__(self, variables: tuple[str, ...], ring: Any) -> None:
        self.size, self._ring = len(variables), ring

    def generators(self) -> tuple[dict[Exponents, Any], ...]:
        """The variables."""
        one = self._ring.rational(Fraction(1))
        return tuple({tuple(int(i == k) for k in range(self.size)): one} for i in range(self.size))

    def constant(self, value: Any) -> dict[Exponents, Any]:
        """A coefficient as a polynomial."""
        return {(0,) * self.size: value}

    def from_terms(self, terms: Mapping[Exponents, Any]) -> dict[Exponents, Any]:
        return dict(terms)

    def terms(self, poly: dict[Exponents, Any]) -> dict[Exponents, Any]:
        return poly

    def dot(self, pairs: Iterable[tuple[Mapping[Exponents, Any], Mapping[Exponents, Any]]]) -> dict[Exponents, Any]:
        """The sum of the products of pairs."""
        total: dict[Exponents, Any] = {}
        for left, right in pairs:
            for key, value in left.items():
                for other, factor in right.items():
                    place = tuple(i + k for i, k in zip(key, other, strict=True))
                    total[place] = total[place] + value * factor if place in total else value * factor
        return total

    def add(self, left: Mapping[Exponents, Any], right: Mapping[Exponents, Any]) -> dict[Exponents, Any]:
        total = dict(left)
        for key, value in right.items():
            total[key] = total[key] + value if key in total else value
        return total

    def scaled(self, poly: Mapping[Exponents, Any], factor: Any) -> dict[Exponents, Any]:
        """The polynomial times a coefficient."""
        return {key: value * factor for key, value in poly.items()}

    def vanishes(self, poly: Mapping[Exponents, Any]) -> bool:
        return not poly

    def derivative(self, poly: Mapping[Exponents, Any], index: int) -> dict[Exponents, Any]:
        return {
            _moved(key, index, -1): value * self._ring.rational(Fraction(key[index]))
            for key, value in poly.items()
            if key[index]
        }

    def integral(self, poly: Mapping[Exponents, Any], index: int) -> dict[Exponents, Any]:
        """The integral from 0."""
        return {
            _moved(key, index, 1): value * self._ring.rational(Fraction(1, key[index] + 1))
            for key, value in poly.items()
        }

    def at(self, poly: Mapping[Exponents, Any], index: int, value: Fraction) -> dict[Exponents, Any]:
        """The polynomial with one variable set to a rational."""
        total: dict[Exponents, Any] = {}
        for key, coefficient in poly.items():
            place = _moved(key, index, -key[index])
            term = coefficient if value == 1 else coefficient * self._ring.rational(value ** key[index])
            total[place] = total[place] + term if place in total else term
        return total

    def without(self, poly: Mapping[Exponents, Any], index: int, target: SparsePolynomials) -> dict[Exponents, Any]:
        """The polynomial, free of one variable, as one of `target`, which has the others."""
        assert target.size == self.size - 1
        assert not any(key[index] for key in poly)
        return {(*key[:index], *key[index + 1 :]): value for key, value in poly.items()}

    def substituted(self, poly: Mapping[Exponents, Any], images: Sequence[Any], target: SparsePolynomials) -> Any:
        """The polynomial with its variables replaced by polynomials of `target`, over the same coefficients."""
        one = target.constant(self._ring.rational(Fraction(1)))
        powers = [[one] for _ in images]
        total: dict[Exponents, Any] = {}
        for key, value in poly.items():
            term = one
            for index, exponent in enumerate(key):
                while len(powers[index]) <= exponent:
                    powers[index].append(target.dot([(powers[index][-1], images[index])]))
                term = target.dot([(term, powers[index][exponent])]) if exponent else term
            total = target.add(total, target.scaled(term, value))
        return total


def _moved(key: Exponents, index: int, step: int) -> Exponents:
    return (*key[:index], key[index] + step, *key[index + 1 :])
