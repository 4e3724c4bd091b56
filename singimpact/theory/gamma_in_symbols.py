"""gamma with symbols for all jets and for r, written through lambda: solved at whole lambda, and interpolated.

Lengths are first measured so that a_j = 1; that symbol is put back at the end, for everything is homogeneous in it.
The denominators are known beforehand: powers of the divisors that the solver meets, and of lambda.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from functools import lru_cache
from math import comb, factorial
from typing import Any

from singimpact.algebra.interpolation import RationalCoefficients, interpolated
from singimpact.algebra.precision import kept_property
from singimpact.algebra.rings import sympy_rational
from singimpact.contact.contact import Contact, derivative_name
from singimpact.handed_on import flint, sympy
from singimpact.theory.gamma_series import InvariantCurve, P, Q, invariant_curve

WHOLLY_FACTORED = 12  # degree of a numerator up to which it is written as a product of irreducible factors
ROOTS = (Fraction(0), Fraction(1), Fraction(-1), Fraction(-2), Fraction(-1, 2))


class SymbolicCurve:
    """gamma (the fibre for j = 0) for all jets and all r at once, to sigma^order in v.

    Attributes
    ----------
    j : contact order. order : last power of sigma in v. names : symbols of the jets, without that of a_j.
    """

    def __init__(self, j: int, order: int) -> None:
        self.j, self.order = j, order
        self._contact = Contact.generic(j, order, unit=True, more=rho_names(j, order))
        self._rho = {int(name[4:]): self._contact.ring.symbol(name) for name in rho_names(j, order)}
        self._solved: dict[int, InvariantCurve] = {}
        self.names: tuple[str, ...] = self._contact.ring.names

    @kept_property
    def graph(self) -> Mapping[int, RationalCoefficients]:
        """n -> coefficient of sigma^n in v."""
        return self._read("graph", self.j + 1)

    @kept_property
    def motion(self) -> Mapping[int, RationalCoefficients]:
        """n -> coefficient of sigma^n in sigma + T(sigma)."""
        return self._read("motion", 1)

    def _read(self, part: str, first: int) -> Mapping[int, RationalCoefficients]:
        levels = range(self.order - self.j)

        def values_at(node: int) -> list[Any]:
            return [getattr(self._at(node), part)[first + n].to_dict() for n in levels]

        found = interpolated(values_at, [_denominator(self.j, level) for level in levels])
        return dict(enumerate(found, first))

    def _at(self, node: int) -> InvariantCurve:
        if node not in self._solved:
            self._solved[node] = invariant_curve(self._contact, Fraction(node), self.order, self._rho)
        return self._solved[node]

    def to_sympy(self, coefficient: RationalCoefficients, of_length: int) -> Any:
        """A coefficient as a sympy expression in lambda and the jets; `of_length` 1 in the graph, 0 in the motion."""
        return in_length(coefficient, self.names, self.j, of_length)


def in_length(coefficient: RationalCoefficients, names: tuple[str, ...], j: int, of_length: int) -> Any:
    """A coefficient found with a_j = 1 as a sympy expression, for any a_j: it scales as a length to `of_length`."""
    from singimpact.algebra.long_sums import Products

    products, unit = Products(), sympy.Symbol(derivative_name(j))
    symbols, weights = [sympy.Symbol(name) for name in names], [length_weight(name) for name in names]
    total, lengths = [], dict[tuple[int, int], tuple[Any, Any]]()
    for key, (above, below) in coefficient.terms.items():
        content, factors = factored(above)
        mark = below.degree(), int(below(2))  # the same few denominators come again and again; they are whole
        if mark not in lengths or lengths[mark][0] != below:
            lengths[mark] = below, factored(below, below.degree())
        under, divisors = lengths[mark][1]
        present = [(index, int(e)) for index, e in enumerate(key) if e]  # most exponents are 0
        power = of_length + sum(weights[index] * e for index, e in present)
        jets = [(symbols[index], e) for index, e in present] + ([(unit, power)] if power else [])
        bases = [*factors, *((base, -e) for base, e in divisors), *jets]
        total.append(products.term(content / under / sympy.Integer(factorial(j)) ** power, bases))
    return products.summed(total)


def length_weight(name: str) -> int:
    """The power of the unit of length, a_j, that a jet measured in it carries."""
    head, _, digits = name.partition("_")
    if head == "a":
        return -1
    return int(digits) - 1 if head == "rho" else int(digits[0]) + int(digits[1]) - 1


def factored(poly: flint.fmpq_poly, wholly: int = WHOLLY_FACTORED) -> tuple[Any, list[tuple[Any, int]]]:
    """An fmpq_poly in lambda as a rational and powers of its factors, in sympy.

    Above the degree `wholly` only factors of degree 1 that are often met are looked for: to show that the rest has none
    takes longer than all else, and it hardly ever has one.
    """
    constant, factors = poly.factor() if poly.degree() <= wholly else _split_by_roots(poly)
    single = len(factors) == 1 and factors[0][1] == 1
    if single and any(factors[0][0].coeffs()[:-1]):  # as in sympy, a rational goes into a sum
        return sympy.S.One, [(_in_lambda(tuple((int(c.p), int(c.q)) for c in poly.coeffs())), 1)]
    shown = [(_in_lambda(tuple((int(c.p), 1) for c in factor.coeffs())), int(e)) for factor, e in factors]
    return sympy_rational(int(constant.p), int(constant.q)), shown


def _split_by_roots(poly: flint.fmpq_poly) -> tuple[flint.fmpq, list[tuple[flint.fmpq_poly, int]]]:
    """A rational, the powers of factors with the roots `ROOTS`, and the rest, as flint's `factor` gives them."""
    rest, factors = poly.numer(), []
    for root in ROOTS:
        factor, times = flint.fmpz_poly([-root.numerator, root.denominator]), 0
        while rest(flint.fmpq(root.numerator, root.denominator)) == 0:
            rest, times = rest // factor, times + 1
        if times:
            factors.append((flint.fmpq_poly(factor), times))
    content = rest.content() * (1 if rest.leading_coefficient() > 0 else -1)
    if rest.degree() > 0:
        factors.append((flint.fmpq_poly(rest // content), 1))
    return flint.fmpq(content) / poly.denom(), factors


@lru_cache(maxsize=4096)
def _in_lambda(coefficients: tuple[tuple[int, int], ...]) -> Any:
    """The polynomial in lambda with these coefficients, as numerators and denominators."""
    from singimpact.algebra.long_sums import polynomial

    return polynomial(sympy.Symbol("lambda"), coefficients)


def rho_names(j: int, order: int) -> tuple[str, ...]:
    """Symbols rho_k of the coefficients of v^k, k >= 2, that gamma to sigma^order contains."""
    return tuple(f"rho_{k}" for k in range(2, order // (j + 1) + 1))


def divisor(j: int, level: int) -> flint.fmpq_poly:
    """The divisor that the solver meets at a level, as an fmpq_poly in lambda, free of lambda and lambda - 1."""
    x = flint.fmpq_poly([0, 1])
    time = x - 1
    launch = sum((time ** (k + 1) * -_over(j, k, (k + 1) * (k + 2)) for k in range(j + 1)), x * 0)
    launch_tangent = sum((time**k * -_over(j, k, k + 2) for k in range(j + 1)), x * 0)
    impact_tangent = sum((time**k * (_over(j, k, k + 2) * (k + 1)) for k in range(j + 1)), x * 0)
    landing = launch * x**j * (j + 1) + launch_tangent * x ** (j + level + 1)
    product: flint.fmpq_poly = x ** (j + 1) * P(j, x) * impact_tangent + Q(j, x) * landing
    for factor in (x, x - 1):
        while (product % factor).is_zero():
            product = product // factor
    return product / product.leading_coefficient()


def _over(j: int, k: int, below: int) -> flint.fmpq:
    return flint.fmpq(comb(j, k), below)


def _denominator(j: int, level: int) -> flint.fmpq_poly:
    """A multiple of the denominator of tau_level: each divisor as often as the levels below can bring it in."""
    total = flint.fmpq_poly([0, 1]) ** level
    for below in range(1, level + 1):
        total = total * divisor(j, below) ** (level // below)
    return total


@lru_cache(maxsize=16)
def symbolic_curve(j: int, order: int) -> SymbolicCurve:
    """gamma at contact order j to sigma^order, j + 1 <= order.

    Examples
    --------
    >>> curve = symbolic_curve(1, 3)
    >>> curve.to_sympy(curve.graph[2], 1)
    -a_d1*(lambda - 1)*(lambda + 2)/6
    """
    return SymbolicCurve(j, order)
