"""The phase of a launch, reduced without loss: tau is an exact number, however large."""

import math
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression
from singimpact.algebra.numbers import rational_near

TURNS = 2.0**20
"""Periods within which a period in two doubles is enough: phases above its part 1/TURNS keep to 2^-10 of a unit."""


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
    size, rest = _in_doubles(period)
    result = np.array(tau, dtype=float)
    far = np.flatnonzero(np.abs(result) > size)
    if far.size:
        left = np.fmod(result[far], size)  # exact, and so is the difference below
        left -= np.where(np.abs(left) > size / 2, np.copysign(size, left), 0.0)
        turns = np.rint((result[far] - left) / size)
        phases = left - turns * rest
        near = np.minimum(np.abs(phases), np.abs(np.abs(phases) - size / 2))  # to a multiple, or half-way between two
        doubtful = (np.abs(turns) > TURNS) | (near < size / TURNS)
        for index in np.flatnonzero(doubtful).tolist():
            phases[index] = phase_of(Fraction(float(result[far[index]])), period)
        result[far] = phases
    return result


@lru_cache(maxsize=256)
def _in_doubles(period: Expression) -> tuple[float, float]:
    """The period as a double, inf where none is as large, and the part that it leaves out."""
    exact = rational_near(period, 256)
    try:
        size = float(exact)
    except OverflowError:
        return math.inf, 0.0
    return size, float(exact - Fraction(size))


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
    scaled: int = round(rational_near(period, bits + 80) * 2**bits)
    return scaled
