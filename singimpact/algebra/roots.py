"""Real roots of polynomials with rational coefficients: isolated by flint, refined by Newton's method on balls."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cmp_to_key
from typing import Any

from singimpact.algebra.balls import Balls
from singimpact.algebra.precision import balls_at
from singimpact.algebra.solving import newton_in_balls

FIRST_BITS = 128


def real_roots(coefficients: Sequence[Fraction], balls: Balls) -> list[Any]:
    """The real roots in increasing order, each in a ball that contains no other root.

    Parameters
    ----------
    coefficients : from the constant one up; a polynomial without multiple real roots.

    Examples
    --------
    >>> [float(root.mid()) for root in real_roots([Fraction(-2), Fraction(0), Fraction(1)], Balls(80))]
    [-1.4142135623730951, 1.4142135623730951]
    """
    import flint

    poly: Any = flint.fmpq_poly([flint.fmpq(c.numerator, c.denominator) for c in coefficients]).numer()
    isolated: list[Any] = [root.real for root, _ in poly.complex_roots() if root.imag == 0]
    ordered = sorted(isolated, key=cmp_to_key(_order))
    return [refined(poly, root, balls.bits) for root in ordered]


def _order(left: Any, right: Any) -> int:
    return -1 if left < right else 1


def refined(poly: Any, isolated: Any, bits: int) -> Any:
    """The one root of an integer polynomial in an isolating ball, to about `bits` bits relative to its size."""
    root, work, slope = isolated, min(FIRST_BITS, bits + 32), poly.derivative()
    while True:
        with balls_at(work):
            root = newton_in_balls(poly, slope, root)
        if work == bits + 32:
            return root
        work = min(2 * work, bits + 32)
