"""Numbers as unevaluated sums of two doubles (about 32 digits), from error-free sums and products.

The products split a double into halves of 26 bits (Dekker), so that no fused operation is needed and every platform
gives the same bits.
"""

from typing import Any


def sum_twice(a: float, a_low: float, b: float, b_low: float) -> Any:
    """a + a_low + b + b_low as two doubles.

    Examples
    --------
    >>> sum_twice(1.0, 0.0, 2.0**-60, 0.0) == (1.0, 2.0**-60)
    True
    """
    total = a + b
    # Knuth's exact sum: total + rest = a + b whichever is larger
    rounded_b = total - a
    rest = ((a - (total - rounded_b)) + (b - rounded_b)) + (a_low + b_low)
    high = total + rest
    return high, rest - (high - total)


def product_twice(a: float, a_low: float, b: float, b_low: float) -> Any:
    """(a + a_low) (b + b_low) as two doubles.

    Examples
    --------
    >>> product_twice(1 + 2.0**-40, 0.0, 1 + 2.0**-40, 0.0) == (1 + 2.0**-39, 2.0**-80)
    True
    """
    total = a * b
    # 2^27 + 1 splits a double into two halves of 26 bits (Veltkamp); their four products are exact
    big = 134217729.0 * a
    a_high = big - (big - a)
    big = 134217729.0 * b
    b_high = big - (big - b)
    a_rest, b_rest = a - a_high, b - b_high
    rest = ((a_high * b_high - total) + a_high * b_rest + a_rest * b_high) + a_rest * b_rest
    rest += a * b_low + a_low * b
    high = total + rest
    return high, rest - (high - total)


def divided(a: float, a_low: float, k: int) -> Any:
    """(a + a_low)/k as two doubles."""
    # one step of long division: the remainder of the double quotient gives the low part
    high = a / k
    back, back_low = product_twice(high, 0.0, 1.0 * k, 0.0)
    rest = (((a - back) - back_low) + a_low) / k
    total = high + rest
    return total, rest - (total - high)
