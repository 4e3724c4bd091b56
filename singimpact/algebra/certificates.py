"""Signs of polynomials on intervals, proved: exact root counts (Sturm) and signs at rational points.

A statement "for all r in (0, 1)" about rational functions of one variable ends here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy


@dataclass(frozen=True)
class SignCertificate:
    """A polynomial keeps one sign on an open interval.

    Attributes
    ----------
    polynomial, variable, low, high : the statement. sample, sign : a rational point inside and the sign there.
    inside : the number of distinct real roots in the open interval; the certificate is good when it is 0.
    """

    polynomial: Any
    variable: Any
    low: Any
    high: Any
    sample: Any
    sign: int
    inside: int

    @property
    def good(self) -> bool:
        """No root inside and a sign that is not 0."""
        return self.inside == 0 and self.sign != 0


def sign_on(expression: Any, variable: Any, low: Any, high: Any) -> SignCertificate:
    """The sign of a polynomial or rational function on the open interval (low, high).

    Parameters
    ----------
    expression : polynomial or rational function with rational coefficients; of a quotient the product is taken, which
        has the same sign.
    low, high : rationals; infinite ends are allowed.

    Examples
    --------
    >>> x = sympy.Symbol("x")
    >>> sign_on(x * (1 - x), x, 0, 1).good, sign_on(x - sympy.Rational(1, 2), x, 0, 1).good
    (True, False)
    """
    numerator, denominator = sympy.fraction(sympy.cancel(sympy.together(expression)))
    poly = sympy.Poly(sympy.expand(numerator * denominator), variable, domain="QQ")
    ends = [sympy.sympify(low), sympy.sympify(high)]
    inside = roots_inside(poly, *ends)
    sample = _between(*ends)
    value = poly.eval(sample)
    return SignCertificate(poly.as_expr(), variable, ends[0], ends[1], sample, int(sympy.sign(value)), inside)


def roots_inside(poly: Any, low: Any, high: Any) -> int:
    """The number of distinct real roots in the open interval, exactly."""
    if poly.is_zero:
        raise ArithmeticError("the zero polynomial has no sign")
    if poly.degree() == 0:
        return 0
    finite = [end for end in (low, high) if end.is_finite]
    total = poly.count_roots(low if low.is_finite else None, high if high.is_finite else None)
    return int(total) - sum(1 for end in finite if poly.eval(end) == 0)


def _between(low: Any, high: Any) -> Any:
    if low.is_finite and high.is_finite:
        return (low + high) / 2
    if low.is_finite:
        return low + 1
    return high - 1 if high.is_finite else sympy.Integer(0)


def positive_on(expression: Any, variable: Any, low: Any, high: Any) -> bool:
    """Proved to be positive on the open interval."""
    certificate = sign_on(expression, variable, low, high)
    return certificate.good and certificate.sign > 0


def negative_on(expression: Any, variable: Any, low: Any, high: Any) -> bool:
    """Proved to be negative on the open interval."""
    return positive_on(-expression, variable, low, high)


def value_at(expression: Any, variable: Any, point: Any) -> Any:
    """The limit of a rational function at a point: its value after common factors are cancelled, or infinity.

    Examples
    --------
    >>> x = sympy.Symbol("x")
    >>> value_at((x**2 - 1) / (x - 1), x, 1), value_at(1 / x, x, 0)
    (2, zoo)
    """
    numerator, denominator = sympy.fraction(sympy.cancel(sympy.together(expression)))
    below = denominator.subs(variable, point)
    return sympy.zoo if below == 0 else sympy.cancel(numerator.subs(variable, point) / below)
