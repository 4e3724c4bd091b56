"""Polynomials in one variable: each ring's fastest kind under one set of names, and real roots of rational ones.

Solvers run on them level by level: `number` is what scalars of the solver are made of, `poly` what its polynomials are;
+ - * of both are Python's own.
"""

from __future__ import annotations  # flint and sympy are loaded when they are used

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from fractions import Fraction
from functools import cmp_to_key
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.precision import balls_at
from singimpact.algebra.rings import Doubles, Exact, SymbolRing
from singimpact.algebra.solving import newton_in_balls
from singimpact.handed_on import flint


class ExactUnivariate:
    """fmpq_poly over fmpq.

    Examples
    --------
    >>> exact = ExactUnivariate()
    >>> exact.at_one(exact.integral(exact.poly([1, 2, 3])))
    3
    """

    def number(self, value: Any) -> Any:
        """A scalar from a rational of Python or an element of the ring."""
        return flint.fmpq(value.numerator, value.denominator) if isinstance(value, int | Fraction) else value

    def poly(self, coefficients: Sequence[Any]) -> Any:
        """The polynomial with these coefficients, from the constant one on."""
        return flint.fmpq_poly([self.number(value) for value in coefficients])

    def integral(self, poly: flint.fmpq_poly) -> flint.fmpq_poly:
        """The integral from 0."""
        return poly.integral()

    def derivative(self, poly: flint.fmpq_poly) -> flint.fmpq_poly:
        return poly.derivative()

    def at_one(self, poly: flint.fmpq_poly) -> Any:
        return poly(self.number(1))

    def element(self, number: Any) -> Any:
        """A scalar as an element of the ring."""
        return Fraction(int(number.p), int(number.q))


class BallUnivariate(ExactUnivariate):
    """arb_poly over arb, at the precision that is set."""

    def number(self, value: int | Fraction | flint.arb) -> flint.arb:
        return flint.arb(super().number(value)) if isinstance(value, int | Fraction) else value

    def poly(self, coefficients: Sequence[int | Fraction | flint.arb]) -> flint.arb_poly:
        return flint.arb_poly([self.number(value) for value in coefficients])

    def element(self, number: flint.arb) -> flint.arb:
        return number


class ArrayPoly:
    """Coefficients in an array of doubles or of objects, from the constant one on."""

    __slots__ = ("values",)

    def __init__(self, values: np.ndarray[Any, Any]) -> None:
        self.values = values

    def __add__(self, other: ArrayPoly) -> ArrayPoly:
        if len(self.values) < len(other.values):
            return other + self
        total = self.values.copy()
        total[: len(other.values)] += other.values
        return ArrayPoly(total)

    def __mul__(self, other: Any) -> ArrayPoly:
        if isinstance(other, ArrayPoly):
            return ArrayPoly(np.convolve(self.values, other.values))
        return ArrayPoly(self.values * other)


class ArrayUnivariate:
    """Doubles, or numbers of an mpmath context in arrays of objects."""

    def __init__(self, ring: Any, kind: Any) -> None:
        self._ring, self._kind = ring, kind

    def number(self, value: Any) -> Any:
        return self._ring.rational(Fraction(value)) if isinstance(value, int | Fraction) else value

    def poly(self, coefficients: Sequence[Any]) -> ArrayPoly:
        return ArrayPoly(np.array([self.number(value) for value in coefficients] or [self.number(0)], dtype=self._kind))

    def integral(self, poly: ArrayPoly) -> ArrayPoly:
        """The integral from 0."""
        size = np.arange(1, len(poly.values) + 1)
        return ArrayPoly(np.concatenate([np.zeros(1, self._kind), poly.values / size.astype(self._kind)]))

    def derivative(self, poly: ArrayPoly) -> ArrayPoly:
        return ArrayPoly((poly.values * np.arange(len(poly.values)))[1:])

    def at_one(self, poly: ArrayPoly) -> Any:
        return poly.values.sum()

    def element(self, number: Any) -> Any:
        return number if self._kind is object else float(number)


class SymbolUnivariate:
    """fmpq_mpoly in z and the names of a ring of symbols; scalars are kept there too."""

    def __init__(self, ring: SymbolRing) -> None:
        self._packed = ring.polynomials(("z",))
        (self._z,) = self._packed.generators()
        self._target = ring

    def number(self, value: Any) -> Any:
        if isinstance(value, int | Fraction):
            return flint.fmpq(value.numerator, value.denominator)
        return value if isinstance(value, flint.fmpq) else self._packed.constant(value)

    def poly(self, coefficients: Sequence[Any]) -> Any:
        total, power = self._packed.constant(0), self._packed.constant(1)
        for value in coefficients:
            total, power = total + power * self.number(value), power * self._z
        return total

    def integral(self, poly: flint.fmpq_mpoly) -> flint.fmpq_mpoly:
        """The integral from 0."""
        return self._packed.integral(poly, 0)

    def derivative(self, poly: flint.fmpq_mpoly) -> flint.fmpq_mpoly:
        return self._packed.derivative(poly, 0)

    def at_one(self, poly: flint.fmpq_mpoly) -> flint.fmpq_mpoly:
        return self._packed.at(poly, 0, Fraction(1))

    def element(self, number: flint.fmpq | flint.fmpq_mpoly) -> Any:
        if isinstance(number, flint.fmpq):
            return self._target.rational(Fraction(int(number.p), int(number.q)))
        return self._packed.coefficient(number)


def univariate(ring: Any) -> Any:
    """The polynomials in one variable over a ring.

    Examples
    --------
    >>> from singimpact.algebra.rings import DOUBLES
    >>> univariate(DOUBLES).at_one(univariate(DOUBLES).poly([1, 2]))
    np.float64(3.0)
    """
    if isinstance(ring, Exact):
        return ExactUnivariate()
    if isinstance(ring, Balls):
        return BallUnivariate()
    if isinstance(ring, SymbolRing):
        return SymbolUnivariate(ring)
    return ArrayUnivariate(ring, np.float64 if isinstance(ring, Doubles) else object)


@contextmanager
def precision_of(ring: Any) -> Iterator[None]:
    """Arithmetic of balls at the precision of their ring; nothing for the other rings."""
    with balls_at(ring.bits) if isinstance(ring, Balls) else nullcontext():
        yield


# Real roots of polynomials with rational coefficients: isolated by flint, refined by Newton's method on balls.

FIRST_BITS = 128


def real_roots(polynomial: flint.fmpq_poly, balls: Balls) -> list[flint.arb]:
    """The real roots in increasing order, each in a ball that contains no other root.

    Parameters
    ----------
    polynomial : one without multiple real roots.

    Examples
    --------
    >>> import flint
    >>> [float(root.mid()) for root in real_roots(flint.fmpq_poly([-2, 0, 1]), Balls(80))]
    [-1.4142135623730951, 1.4142135623730951]
    """
    poly: Any = polynomial.numer()
    isolated: list[Any] = [root.real for root, _ in poly.complex_roots() if root.imag == 0]
    return [refined(poly, root, balls.bits) for root in sorted(isolated, key=cmp_to_key(_order))]


def _order(left: flint.arb, right: flint.arb) -> int:
    return -1 if left < right else 1


def refined(poly: flint.fmpz_poly, isolated: flint.arb, bits: int) -> flint.arb:
    """The one root of an integer polynomial in an isolating ball, to about `bits` bits relative to its size."""
    root, work, slope = isolated, min(FIRST_BITS, bits + 32), poly.derivative()
    while True:
        with balls_at(work):
            root = newton_in_balls(poly, slope, root)
        if work == bits + 32:
            return root
        work = min(2 * work, bits + 32)
