"""A polynomial in two variables on arrays of doubles: a matrix of coefficients and Horner's rule, in place.

A polynomial written out in its jets costs hundreds of times more; here a model's jets enter once, correctly rounded.
Where the polynomial nearly vanishes its terms cancel: then two doubles a number keep what one would lose.
"""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np

Array = np.ndarray[Any, np.dtype[np.float64]]
Side = Array | float
Pair = tuple[Side, Side]
SPLIT = 2.0**27 + 1  # a double as two halves whose products are exact


class Horner:
    """sum coefficients[i, k] x^i y^k, evaluated at arrays.

    Parameters
    ----------
    terms : (i, k) -> double, or what `float` takes (a Fraction is rounded correctly).
    compensated : carry a second double for each number. The error is then below 2 epsilon times the value plus
        some epsilon^2 times the sum of the moduli of the terms, at about ten times the cost; |x|, |y|, values and
        coefficients must stay below 1e150 and, where not zero, above 1e-140, or what underflows is lost.

    Examples
    --------
    >>> Horner({(0, 1): 2, (2, 1): 0.5})(np.array([1.0, 2.0]), np.array([1.0, 1.0])).tolist()
    [2.5, 4.0]
    >>> far = {(0, 0): Fraction(-1, 3), (1, 0): Fraction(1)}
    >>> bool(Horner(far, compensated=True)(1 / 3, 0.0) == float(Fraction(1 / 3) - Fraction(1, 3)))
    True
    """

    def __init__(self, terms: Mapping[tuple[int, ...], Any], compensated: bool = False) -> None:
        self.compensated = compensated
        rows: dict[int, dict[int, Any]] = {}
        for (i, k), value in terms.items():
            rows.setdefault(k, {})[i] = value
        self._first = min(rows, default=0)
        # from the highest power of y down: [c_i of x^i, highest first]
        self._rows = [
            [_two_doubles(row.get(i, 0)) for i in range(max(row, default=0), -1, -1)]
            for row in (rows.get(k, {}) for k in range(max(rows, default=0), self._first - 1, -1))
        ]

    def __call__(self, x: Any, y: Any) -> Array:
        """The values at broadcast arrays of doubles."""
        first, second = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        return self._twice(first, second) if self.compensated else self._once(first, second)

    def _once(self, first: Array, second: Array) -> Array:
        total, row = np.zeros(first.shape), np.empty(first.shape)
        for n, coefficients in enumerate(self._rows):
            if n:
                total *= second
            row.fill(coefficients[0][0])
            for value, _ in coefficients[1:]:
                row *= first
                row += value
            total += row
        for _ in range(self._first):
            total *= second
        return total

    def _twice(self, first: Array, second: Array) -> Array:
        zero = np.zeros(first.shape)
        total: Pair = zero, zero
        for coefficients in self._rows:
            row: Pair = zero, zero
            for value in coefficients:
                row = _plus(_times(row, first), value)
            total = _plus(_times(total, second), row)
        for _ in range(self._first):
            total = _times(total, second)
        return np.asarray(total[0] + total[1])


def _two_doubles(value: Any) -> tuple[float, float]:
    """A number as the nearest double and the rest as one."""
    high = float(value)
    return high, float(value - Fraction(high)) if isinstance(value, Fraction) else 0.0


def _plus(left: Pair, right: Pair) -> Pair:
    """The sum of two pairs, the rounding error of the leading sum kept."""
    total = left[0] + right[0]
    part = total - left[0]
    error = (left[0] - (total - part)) + (right[0] - part)
    return _tidy(total, error + (left[1] + right[1]))


def _times(left: Pair, factor: Side) -> Pair:
    """A pair times a double, the rounding error of the leading product kept."""
    product = left[0] * factor
    a, b = _halves(left[0]), _halves(factor)
    error = ((a[0] * b[0] - product) + a[0] * b[1] + a[1] * b[0]) + a[1] * b[1]
    return _tidy(product, error + left[1] * factor)


def _halves(value: Side) -> Pair:
    moved = SPLIT * value
    high = moved - (moved - value)
    return high, value - high


def _tidy(high: Side, low: Side) -> Pair:
    total = high + low
    return total, low - (total - high)
