"""Fixed points of the blown-up maps and their multipliers, as numbers with a certified radius, to any number of digits.

Everything follows from lambda, the root in (0, 1) of lambda^(j+1) P_j - r Q_j, and from u = 1 - lambda, the root of
the same polynomial shifted to 1: so nothing is lost as r -> 0 or as r -> 1.  Isolation is `algebra.univariate`.
As functions of r (`of_m`, `series`, `minimal_polynomial`) they are in `multipliers`, and reached from here too.
"""

from __future__ import annotations  # flint and sympy are loaded when they are used

from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

from singimpact.algebra.balls import BITS_A_DIGIT, Balls
from singimpact.algebra.certified import Certified as Certified, as_certified
from singimpact.algebra.numbers import as_fraction, constant
from singimpact.algebra.precision import balls_at
from singimpact.algebra.univariate import real_roots
from singimpact.contact.contact import contact_order
from singimpact.handed_on import flint
from singimpact.inputs import InputError, checked_keywords, need, refuse, require, whole
from singimpact.result import Result, columns_of, in_words

GUARD_BITS = 32  # beside the digits asked for; the loop adds more when a radius is still too large
MOST_DIGITS = 100_000
LEAST = Fraction(1, 10**308)  # isolating the roots of a smaller r takes minutes, then hours


class _Enclosures(Result):
    """Certified numbers by name."""

    __repr__ = in_words

    def as_dict(self) -> dict[str, Any]:
        """Names as on the paper's page -> value and radius as text."""
        return {name.rstrip("_"): enclosure for name, enclosure in super().as_dict().items()}

    def arrays(self) -> dict[str, tuple[tuple[str, ...], Any]]:
        """A row for each name, with value and radius as text."""
        rows = [{"name": name, **enclosure} for name, enclosure in self.as_dict().items()]
        return {name: (("row",), column) for name, column in columns_of(rows).items()}


@dataclass(frozen=True, repr=False)
class TangencyFixedPoints(_Enclosures):
    """At a tangency: solutions of the cubic, multipliers at m3, zeros of Q_r(1, m)."""

    m1: Certified
    m2: Certified
    m3: Certified
    lambda_: Certified
    mu: Certified
    m_minus: Certified
    m_plus: Certified
    one_minus_lambda: Certified
    mu_minus_one: Certified


@dataclass(frozen=True, repr=False)
class SwanFixedPoints(_Enclosures):
    """At a swan: the fixed point m_* in (-1, 0) and its multipliers."""

    m_star: Certified
    lambda_: Certified
    mu: Certified
    one_minus_lambda: Certified
    mu_minus_one: Certified


@dataclass(frozen=True, repr=False)
class Multipliers(_Enclosures):
    """On gamma (lambda) and across it (mu) at a contact of any order, and what they lack of 1."""

    lambda_: Certified
    mu: Certified
    one_minus_lambda: Certified
    mu_minus_one: Certified


def as_dict(points: TangencyFixedPoints | SwanFixedPoints | Multipliers) -> dict[str, dict[str, str]]:
    """Names as on the paper's page -> value and radius as text."""
    return points.as_dict()


@checked_keywords
def tangency(r: Any, digits: int = 50) -> TangencyFixedPoints:
    """m1, m2, m3, lambda, mu, m_minus, m_plus at a tangency point [e:meq, e:fixm].

    Parameters
    ----------
    r : restitution, a rational number from 1e-308 to below 1: text, int, Fraction, or a float for its binary value.
    digits : significant digits, 1 to 100000; radius <= 10^-digits |value|.

    Examples
    --------
    >>> print(tangency("1/2", digits=20).m3)
    1.1604422497237431884
    """
    rate, precision = _restitution(r), whole("digits", digits, 1, MOST_DIGITS)

    def enclosures(balls: Balls) -> dict[str, Any]:
        found, lowered = _multipliers(1, rate, balls), flint.fmpq_poly([-1, 2]) / 2  # m - 1/2
        low, middle, _ = real_roots(_fixed_polynomial(1, rate)(lowered), balls)  # in m = lambda + 1/2
        r = flint.fmpq(rate.numerator, rate.denominator)
        Q = flint.fmpq_poly([-r, -r, 2 * r + flint.fmpq(9, 4)])  # Q_r(1, y + 1/2) = r (2y + 1)(y - 1) + (9/4) y^2
        minus, plus = real_roots(Q(lowered), balls)
        third = found["lambda_"] + balls.rational(Fraction(1, 2))
        return found | {"m1": low, "m2": middle, "m3": third, "m_minus": minus, "m_plus": plus}

    return TangencyFixedPoints(**_certified(enclosures, precision))


@checked_keywords
def swan(r: Any, digits: int = 50) -> SwanFixedPoints:
    """m_*, lambda and mu at a swan point [s5-jacobian].

    Parameters as in `tangency`.

    Examples
    --------
    >>> print(swan("0.5", digits=20).m_star)
    -0.25629759628453099805
    """
    rate, precision = _restitution(r), whole("digits", digits, 1, MOST_DIGITS)

    def enclosures(balls: Balls) -> dict[str, Any]:
        found = _multipliers(2, rate, balls)
        return found | {"m_star": -found["one_minus_lambda"]}

    return SwanFixedPoints(**_certified(enclosures, precision))


def multipliers(at: str | int, r: Any, digits: int = 50) -> Multipliers:
    """lambda and mu at any contact order j >= 1: r = lambda^(j+1) P_j/Q_j.

    Parameters
    ----------
    at : "tangency", "swan" or a contact order. r, digits : as in `tangency`.

    Examples
    --------
    >>> print(multipliers(3, "1/2", digits=20).lambda_)
    0.79433819166467074201
    """
    j, rate, precision = contact_order(at), _restitution(r), whole("digits", digits, 1, MOST_DIGITS)
    require(j, "at", at, "a contact order 1..12: at a regular point lambda is r")
    return Multipliers(**_certified(lambda balls: _multipliers(j, rate, balls), precision))


def __getattr__(name: str) -> Any:
    if name in ("of_m", "series", "minimal_polynomial"):  # their file loads sympy
        from singimpact.theory import multipliers as functions

        return getattr(functions, name)
    raise AttributeError(f"module 'singimpact.theory.fixed_points' has no attribute {name!r}")


def _restitution(value: Any) -> Fraction:
    accepted = "a rational number with 1e-308 <= r < 1, such as '1/2', '0.7' or 0.5"
    try:
        rate = as_fraction(constant("r", value))
    except InputError:
        raise refuse("r", value, accepted) from None
    if rate is None or not LEAST <= rate < 1:
        raise refuse("r", value, accepted)
    return rate


@cache
def _P_and_Q(j: int) -> tuple[flint.fmpz_poly, flint.fmpz_poly]:
    """P_j = sum (j+1-i) lambda^i, and Q_j, its reversal."""
    coefficients = [j + 1 - i for i in range(j + 1)]
    return flint.fmpz_poly(coefficients), flint.fmpz_poly(coefficients[::-1])


def _fixed_polynomial(j: int, rate: Fraction) -> flint.fmpq_poly:
    P, Q = map(flint.fmpq_poly, _P_and_Q(j))
    return flint.fmpq_poly([0] * (j + 1) + [1]) * P - Q * flint.fmpq(rate.numerator, rate.denominator)


def _multipliers(j: int, rate: Fraction, balls: Balls) -> dict[str, Any]:
    """lambda, 1 - lambda, mu, mu - 1 at contact order j, each without cancellation."""
    equation = _fixed_polynomial(j, rate)
    (multiplier,) = [root for root in real_roots(equation, balls) if root > 0]  # one change of sign
    flipped = equation(flint.fmpq_poly([1, -1]))  # in u = 1 - lambda
    (gap,) = [root for root in real_roots(flipped, balls) if root > 0 and root < 1]
    above, below = (polynomial(multiplier) for polynomial in _P_and_Q(j))
    return {
        "lambda_": multiplier,
        "one_minus_lambda": gap,
        "mu": (above / below) ** 2 / multiplier,
        "mu_minus_one": gap * _quotient(j)(multiplier) / (multiplier * below**2),
    }


@cache
def _quotient(j: int) -> flint.fmpz_poly:
    """(P_j^2 - lambda Q_j^2)/(1 - lambda): all its coefficients are positive."""
    P, Q = _P_and_Q(j)
    quotient, rest = divmod(P**2 - flint.fmpz_poly([0, 1]) * Q**2, flint.fmpz_poly([1, -1]))
    need(not rest, ArithmeticError("P^2 - lambda Q^2 is not divisible by 1 - lambda"))
    return quotient


def _certified(enclosures: Any, digits: int) -> dict[str, Certified]:
    """Balls at growing precision until each is narrow enough."""
    bits = int(digits * BITS_A_DIGIT) + GUARD_BITS
    while True:
        with balls_at(bits):
            found = enclosures(Balls(bits))
        results = {name: as_certified(ball, digits) for name, ball in found.items()}
        if all(result is not None for result in results.values()):
            return {name: result for name, result in results.items() if result is not None}
        bits += bits // 4 + GUARD_BITS
