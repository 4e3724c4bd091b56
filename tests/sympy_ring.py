"""Rationals whose jets are made of sympy's own polynomials: a second engine that shares no code with the first."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from singimpact.algebra import Exact, Exponents


class SympyExact(Exact):
    """The rationals; jets over them are kept in `sympy.ring`.

    Examples
    --------
    >>> from singimpact.algebra.jets import JetSpace
    >>> s, t = JetSpace(("s", "t"), 3, SympyExact()).generators()
    >>> print((s + t) ** 2)
    s**2 + (2)*s*t + t**2
    """

    def polynomials(self, variables: tuple[str, ...]) -> SympyPolynomials:  # type: ignore[override]
        return SympyPolynomials(variables)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SympyExact)

    def __hash__(self) -> int:
        return hash(SympyExact)


class SympyPolynomials:
    """What `PackedPolynomials` answers, by sympy's sparse polynomials."""

    def __init__(self, variables: tuple[str, ...]) -> None:
        from sympy import QQ
        from sympy.polys.rings import ring

        self.size = len(variables)
        self._field = QQ
        self._ring, *self._variables = ring(list(variables), QQ)

    def generators(self) -> tuple[Any, ...]:
        """The variables."""
        return tuple(self._variables)

    def constant(self, value: Any) -> Any:
        """A coefficient as a polynomial."""
        return self._ring(self._field(value.numerator, value.denominator))

    def from_terms(self, terms: Mapping[Exponents, Any]) -> Any:
        """Exponents -> coefficient, as a polynomial."""
        made = {key: self._field(value.numerator, value.denominator) for key, value in terms.items() if value}
        return self._ring.from_dict(made)

    def terms(self, poly: Any) -> dict[Exponents, Any]:
        """A polynomial as exponents -> coefficient, the nonzero ones."""
        return {tuple(key): Fraction(int(c.numerator), int(c.denominator)) for key, c in poly.items()}

    def dot(self, pairs: Iterable[tuple[Any, Any]]) -> Any:
        """The sum of the products of pairs."""
        total = self._ring.zero
        for left, right in pairs:
            total += left * right
        return total

    def add(self, left: Any, right: Any) -> Any:
        return left + right

    def scaled(self, poly: Any, factor: Any) -> Any:
        """The polynomial times a coefficient."""
        return poly * self._field(factor.numerator, factor.denominator)

    def vanishes(self, poly: Any) -> bool:
        return not poly

    def derivative(self, poly: Any, index: int) -> Any:
        return poly.diff(self._variables[index])

    def integral(self, poly: Any, index: int) -> Any:
        """The integral from 0."""
        unit = tuple(int(i == index) for i in range(self.size))
        return self._ring.from_dict(
            {tuple(a + b for a, b in zip(key, unit, strict=True)): c / (key[index] + 1) for key, c in poly.items()}
        )

    def at(self, poly: Any, index: int, value: Fraction) -> Any:
        """The polynomial with one variable set to a rational."""
        return poly.compose(self._variables[index], self.constant(value))

    def without(self, poly: Any, index: int, target: SympyPolynomials) -> Any:
        """The polynomial, free of one variable, as one of `target`, which has the others."""
        return target._ring.from_dict({(*key[:index], *key[index + 1 :]): value for key, value in poly.items()})

    def substituted(self, poly: Any, images: Sequence[Any], target: SympyPolynomials) -> Any:
        """The polynomial with its variables replaced by polynomials of `target`."""
        total = target._ring.zero
        for key, value in poly.items():
            term = target._ring(value)
            for image, exponent in zip(images, key, strict=True):
                term *= image**exponent if exponent else 1
            total += term
        return total
