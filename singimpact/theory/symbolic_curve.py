"""gamma with symbols for all jets and for r, written through lambda: solved at whole lambda, and interpolated.

Lengths are first measured so that a_j = 1; that symbol is put back at the end, for everything is homogeneous in it.
The denominators are known beforehand: powers of the divisors that the solver meets, and of lambda.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import comb, factorial
from typing import Any

from singimpact.algebra.interpolation import RationalCoefficients, interpolated
from singimpact.contact.contact import Contact, derivative_name
from singimpact.theory.invariant_curve import invariant_curve


@dataclass(frozen=True)
class SymbolicCurve:
    """gamma (the fibre for j = 0) for all jets and all r at once.

    Attributes
    ----------
    j : contact order. order : last power of sigma in v. names : symbols of the jets, without that of a_j.
    graph : n -> coefficient of sigma^n in v. motion : the same for sigma + T(sigma).
    """

    j: int
    order: int
    names: tuple[str, ...]
    graph: Mapping[int, RationalCoefficients]
    motion: Mapping[int, RationalCoefficients]

    def to_sympy(self, coefficient: RationalCoefficients, of_length: int) -> Any:
        """A coefficient as a sympy expression in lambda and the jets; `of_length` 1 in the graph, 0 in the motion."""
        return in_length(coefficient, self.names, self.j, of_length)


def in_length(coefficient: RationalCoefficients, names: tuple[str, ...], j: int, of_length: int) -> Any:
    """A coefficient found with a_j = 1 as a sympy expression, for any a_j: it scales as a length to `of_length`."""
    import sympy

    symbols, weights = [sympy.Symbol(name) for name in names], [length_weight(name) for name in names]
    unit = sympy.Symbol(derivative_name(j)) / factorial(j)
    total = []
    for key, (above, below) in coefficient.terms.items():
        power = of_length + sum(w * e for w, e in zip(weights, key, strict=True))
        jets = [s ** int(e) for s, e in zip(symbols, key, strict=True) if e]
        total.append(sympy.Mul(factored(above) / factored(below), *jets, unit**power))
    return sympy.Add(*total)


def length_weight(name: str) -> int:
    """The power of the unit of length, a_j, that a jet measured in it carries."""
    head, _, digits = name.partition("_")
    if head == "a":
        return -1
    return int(digits) - 1 if head == "rho" else int(digits[0]) + int(digits[1]) - 1


def factored(poly: Any) -> Any:
    """An fmpq_poly in lambda as a sympy product of its factors."""
    import sympy

    return _factored(tuple((int(c.p), int(c.q)) for c in poly.coeffs())) if poly else sympy.S.Zero


@lru_cache(maxsize=4096)
def _factored(coefficients: tuple[tuple[int, int], ...]) -> Any:
    """From the coefficients, as numerators and denominators: denominators come again and again."""
    import flint
    import sympy

    from singimpact.algebra.long_sums import Monomials

    in_lambda = Monomials([sympy.Symbol("lambda")])
    constant, factors = flint.fmpq_poly([flint.fmpq(*pair) for pair in coefficients]).factor()
    shown = [
        in_lambda.summed({(n,): sympy.Integer(int(c.p)) for n, c in enumerate(each.coeffs()) if c}) ** int(e)
        for each, e in factors
    ]
    return sympy.Rational(int(constant.p), int(constant.q)) * sympy.prod(shown)


def rho_names(j: int, order: int) -> tuple[str, ...]:
    """Symbols rho_k of the coefficients of v^k, k >= 2, that gamma to sigma^order contains."""
    return tuple(f"rho_{k}" for k in range(2, order // (j + 1) + 1))


def divisor(j: int, level: int) -> Any:
    """The divisor that the solver meets at a level, as an fmpq_poly in lambda, free of lambda and lambda - 1."""
    import flint

    x = flint.fmpq_poly([0, 1])
    time = x - 1
    launch = sum((time ** (k + 1) * -_over(j, k, (k + 1) * (k + 2)) for k in range(j + 1)), x * 0)
    launch_tangent = sum((time**k * -_over(j, k, k + 2) for k in range(j + 1)), x * 0)
    impact_tangent = sum((time**k * (_over(j, k, k + 2) * (k + 1)) for k in range(j + 1)), x * 0)
    P = sum((x**i * (j + 1 - i) for i in range(j + 1)), x * 0)
    Q = sum((x**i * (i + 1) for i in range(j + 1)), x * 0)
    found = x ** (j + 1) * P * impact_tangent + Q * (launch * x**j * (j + 1) + launch_tangent * x ** (j + level + 1))
    for factor in (x, x - 1):
        while (found % factor).is_zero():
            found = found // factor
    return found / found.leading_coefficient()


def _over(j: int, k: int, below: int) -> Any:
    import flint

    return flint.fmpq(comb(j, k), below)


def _denominator(j: int, level: int) -> Any:
    """A multiple of the denominator of tau_level: each divisor as often as the levels below can bring it in."""
    import flint

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
    contact = Contact.generic(j, order, unit=True, more=rho_names(j, order))
    rho = {int(name[4:]): contact.ring.symbol(name) for name in rho_names(j, order)}
    levels = range(order - j)

    def values_at(node: int) -> list[Any]:
        curve = invariant_curve(contact, Fraction(node), order, rho)
        return [curve.graph[j + 1 + n].to_dict() for n in levels] + [curve.motion[1 + n].to_dict() for n in levels]

    denominators = [_denominator(j, level) for level in levels]
    found = interpolated(values_at, denominators * 2)
    graph = {j + 1 + n: found[n] for n in levels}
    return SymbolicCurve(j, order, contact.ring.names, graph, {1 + n: found[len(levels) + n] for n in levels})
