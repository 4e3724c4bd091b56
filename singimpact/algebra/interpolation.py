"""Polynomials whose coefficients are rational functions of one letter, from their values at one large prime.

The denominators are known beforehand.  A numerator with small whole coefficients is read from its value at a prime B:
they are its digits to the base B.  A fraction among them is a large digit, from which Euclid's algorithm finds its
denominator.  How large the coefficients are is not known, so B grows until every digit is far below it, and each
coefficient must agree at another number, which is a root of what is wrong only by chance.
"""

from __future__ import annotations  # flint and sympy are loaded when they are used

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import lcm
from typing import Any

from singimpact.algebra.polynomials import Exponents
from singimpact.handed_on import flint

Value = dict[Exponents, Any]


@dataclass(frozen=True)
class ReadingSettings:
    """Settings of the reading of coefficients.

    Parameters
    ----------
    bases : primes; coefficients of gamma to sigma^8 have 66 bits. A wrong denominator would go on for ever.
    spare : bits of a base that a digit leaves unused: a chance agreement has the probability 2^-spare.
    node : a number that is not used for reading, and at which every coefficient must agree.
    """

    bases: tuple[int, ...] = (
        2**127 - 1,
        2**192 - 237,
        2**256 - 189,
        2**384 - 317,
        2**521 - 1,
        2**1279 - 1,
        2**2203 - 1,
    )
    spare: int = 24
    node: int = 1009


READING = ReadingSettings()


@dataclass(frozen=True)
class RationalCoefficients:
    """Monomial -> (numerator, denominator), fmpq_poly in the letter, without common factors."""

    terms: dict[Exponents, tuple[Any, Any]]

    def at(self, value: int | flint.fmpq) -> Value:
        """The polynomial at a value of the letter."""
        return {key: above(value) / below(value) for key, (above, below) in self.terms.items()}


def interpolated(
    values_at: Callable[[int], Sequence[Value]], denominators: Sequence[flint.fmpq_poly]
) -> list[RationalCoefficients]:
    """Polynomials in the letter from their values at a large whole number.

    Parameters
    ----------
    values_at : the values of all of them at a whole number, monomial -> fmpq.
    denominators : fmpq_poly, one each: a multiple of the true one.

    Raises
    ------
    ArithmeticError : a denominator is not a multiple of the true one.

    Examples
    --------
    >>> import flint
    >>> half = lambda node: [{(1,): flint.fmpq(node**2, node + 1)}]
    >>> found = interpolated(half, [flint.fmpq_poly([1, 1])])
    >>> found[0].terms[(1,)]
    (x^2, x + 1)
    """
    checked: Sequence[Value] | None = None
    for base in READING.bases:
        rows = [
            {key: value * below(flint.fmpq(base)) for key, value in values.items()}
            for values, below in zip(values_at(base), denominators, strict=True)
        ]
        coefficients: list[RationalCoefficients] | None = _read(rows, denominators, base)
        if coefficients is not None:
            checked = checked or values_at(READING.node)
            if all(_agrees(one, READING.node, values) for one, values in zip(coefficients, checked, strict=True)):
                return coefficients
    raise ArithmeticError("the denominators given are not those of the values")


def _read(
    rows: Sequence[Mapping[Exponents, flint.fmpq]], denominators: Sequence[flint.fmpq_poly], base: int
) -> list[RationalCoefficients] | None:
    """The coefficients from the values of their numerators; None when the base is too small for one."""
    below, coefficients = 1, []
    for row, denominator in zip(rows, denominators, strict=True):
        terms = {}
        for key in sorted(row):
            read = _fractions(int(row[key].p), lcm(below, int(row[key].q)) // int(row[key].q), base)
            if read is None:
                return None
            digits, factor = read
            below = factor * int(row[key].q)
            if digits:
                terms[key] = in_lowest_terms(flint.fmpq_poly(digits, below), denominator)
        coefficients.append(RationalCoefficients(terms))
    return coefficients


def _fractions(value: int, factor: int, base: int) -> tuple[list[flint.fmpz], int] | None:
    """The digits of a multiple of a whole number, by a factor that makes all of them small; None without such a one."""
    small = base >> READING.spare
    while factor < small:
        digits = _digits(value * factor, base)
        large = next((digit for digit in digits if abs(digit) > small), None)
        if large is None:
            return digits, factor
        more = _denominator(int(large), base)
        if more == 1:
            return None
        factor *= more
    return None


def _digits(value: int, base: int) -> list[flint.fmpz]:
    """The digits of a whole number, from the last one on, each of size at most base/2.

    Examples
    --------
    >>> _digits(97, 10), _digits(-97, 10)
    ([-3, 0, 1], [3, 0, -1])
    """
    digits, left, whole, half = [], flint.fmpz(value), flint.fmpz(base), flint.fmpz(base // 2)
    while left:
        left, digit = divmod(left, whole)
        if digit > half:
            left, digit = left + 1, digit - whole
        digits.append(digit)
    return digits


def _denominator(residue: int, base: int) -> int:
    """The denominator of the fraction with this residue whose terms have the smallest product: Euclid's longest step.

    Examples
    --------
    >>> _denominator(pow(35, -1, 2**127 - 1) * 22, 2**127 - 1)
    35
    """
    above, below, longest, denominator = (base, residue % base), (0, 1), 0, 1
    while above[1]:
        step = above[0] // above[1]
        if step > longest:
            longest, denominator = step, abs(below[1])
        above, below = (above[1], above[0] - step * above[1]), (below[1], below[0] - step * below[1])
    return denominator


def in_lowest_terms(above: flint.fmpq_poly, below: flint.fmpq_poly) -> tuple[flint.fmpq_poly, flint.fmpq_poly]:
    """A quotient without common factor; the coefficients of its denominator are whole and have none either.

    Examples
    --------
    >>> import flint
    >>> in_lowest_terms(flint.fmpq_poly([0, 2, 2]), flint.fmpq_poly([2, 4, 2]))
    (x, x + 1)
    """
    common = above.gcd(below)
    above, below = above // common, below // common
    factor = (below / below.leading_coefficient()).denom() / below.leading_coefficient()
    return above * factor, below * factor


def _agrees(found: RationalCoefficients, node: int, values: Value) -> bool:
    """Whether every monomial has its value at a node that was not used for reading."""
    shown = found.at(flint.fmpq(node))
    return not any(shown.get(key, 0) != values.get(key, 0) for key in shown.keys() | values.keys())
