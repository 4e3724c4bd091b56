"""The phase of a launch, reduced without loss: tau is an exact number, however large."""

from __future__ import annotations

import math
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression


def reduced(tau: np.ndarray[Any, Any], period: Expression) -> np.ndarray[Any, Any]:
    """tau minus the nearest multiple of the period, each to half a unit in the last place.

    Parameters
    ----------
    tau : doubles, taken exactly; within one period of zero they are left alone, since -1e-20 plus a period is lost.
    period : constant tree, > 0.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> reduced(np.array([1e22, -1e-20]), constant("period", "2*pi")).tolist()
    [-1.020177392559087, -1e-20]
    """
    try:
        size = _scaled(period, 64) / 2**64
    except OverflowError:  # no double is beyond such a period
        size = math.inf
    result = np.array(tau, dtype=float)
    for index in np.flatnonzero(np.abs(result) > size):
        result[index] = phase_of(Fraction(float(result[index])), period)
    return result


def phase_of(tau: Fraction, period: Expression) -> float:
    """An exact time minus the nearest multiple of the period, to half a unit in the last place.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> phase_of(Fraction(10**20 + 1, 10), constant("period", "3/10"))
    -0.1
    """
    # digits before the binary point, and for a result as small as the least distance of doubles from a multiple
    bits = 64 * (3 + max(math.ceil(tau).bit_length(), 0) // 64) + 64
    while abs(_scaled(period, bits)) < 2**192:  # a short period needs more digits behind the binary point
        bits *= 2
    scaled, exact = _scaled(period, bits), tau * 2**bits
    turns = round(exact / scaled)
    return float((exact - turns * scaled) / 2**bits)


@lru_cache(maxsize=1024)
def _scaled(period: Expression, bits: int) -> int:
    """The integer nearest to period * 2^bits."""
    from singimpact.algebra.numbers import rational_near

    scaled: int = round(rational_near(period, bits + 80) * 2**bits)
    return scaled
