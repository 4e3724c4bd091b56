"""The zero of a_c that a double stands for: a launch at rest next to a zero of a_c is a launch from that zero.

No double is pi/2: a mass released at the double next to a zero of a_c would fly or stick by the sign of a rounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import ulp
from typing import Any

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import Expression, Number
from singimpact.algebra.taylor import NotSmooth
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import around

HIGHEST = 6
"""The highest order of a zero that is recognised."""


@dataclass(frozen=True)
class Zero:
    """A time, and order and sign of the first derivative of a_c that is not zero there."""

    tau: Expression
    order: int
    sign: int


@lru_cache(maxsize=1024)
def zero_beside(osc: Oscillator, tau: float, bits: int) -> Zero | None:
    """The zero of a_c within one ulp of a double; None where there is none, or where it is not decided.

    Parameters
    ----------
    osc : the model. tau : a finite double. bits : the zero is returned to 2^-bits.

    Notes
    -----
    A derivative of a_c that is a ball without 0 over the two ulps makes the derivative below it monotone: one change of
    its sign is one zero.  At a multiple zero the lower derivatives are taken as zero when they are below 2^(-bits/2).

    Examples
    --------
    >>> from math import pi
    >>> zero = zero_beside(Oscillator("x", "cos(t)", 0, 1), 3 * pi / 2, 200)
    >>> zero.order, zero.sign
    (1, 1)
    >>> print(zero_beside(Oscillator("x", "cos(t)", 0, 1), 4.7123889803847, 200))
    None
    """
    centre, reach = Fraction(tau), Fraction(ulp(tau))
    try:
        order, leading = _leading(osc, centre - reach, centre + reach)
        if not order or not _changes_sign(osc, centre - reach, centre + reach, order - 1):
            return None
        zero = _refined(osc, centre, reach, order - 1, bits)
        lower = [_derivative(osc, zero, zero, below, bits) for below in range(order - 1)]
    except NotSmooth:
        return None
    if any(abs(part) > Balls(bits).rational(Fraction(1, 2 ** (bits // 2))) for part in lower):
        return None
    return Zero(Number(zero), order, 1 if leading > 0 else -1)


def _leading(osc: Oscillator, low: Fraction, high: Fraction) -> tuple[int, Any]:
    """The first derivative of a_c that is not zero anywhere from low to high; (0, ...) also where none is found."""
    for order in range(HIGHEST + 1):
        ball = _derivative(osc, low, high, order, 128)
        if ball.is_finite() and not ball.contains(0):
            return order, ball
    return 0, None


def _changes_sign(osc: Oscillator, low: Fraction, high: Fraction, order: int) -> bool:
    first, last = (_derivative(osc, end, end, order, 512) for end in (low, high))
    return bool((first < 0 and last > 0) or (first > 0 and last < 0))


def _refined(osc: Oscillator, start: Fraction, reach: Fraction, order: int, bits: int) -> Fraction:
    """Newton's method for the simple zero of a derivative that is monotone within reach of the start."""
    zero, precision = start, 128
    while True:
        values = [_derivative(osc, zero, zero, order + k, precision) for k in range(2)]
        zero = min(max(zero - as_rational(values[0]) / as_rational(values[1]), start - reach), start + reach)
        zero = as_rational(Balls(2 * precision).rational(zero))
        if precision > 2 * bits:
            return zero
        precision *= 2


def _derivative(osc: Oscillator, low: Fraction, high: Fraction, order: int, bits: int) -> Any:
    balls = Balls(bits)
    return around(osc, balls.interval(low, high), order, balls)
