"""A polynomial in two variables on arrays of doubles: a matrix of coefficients and Horner's rule, in place.

A polynomial written out in its jets costs hundreds of times more; here a model's jets enter once, correctly rounded.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np


class Horner:
    """sum coefficients[i, k] x^i y^k, evaluated at arrays.

    Parameters
    ----------
    terms : (i, k) -> double, or what `float` takes (a Fraction is rounded correctly).

    Examples
    --------
    >>> Horner({(0, 1): 2, (2, 1): 0.5})(np.array([1.0, 2.0]), np.array([1.0, 1.0])).tolist()
    [2.5, 4.0]
    """

    def __init__(self, terms: Mapping[tuple[int, ...], Any]) -> None:
        rows: dict[int, dict[int, float]] = {}
        for (i, k), value in terms.items():
            rows.setdefault(k, {})[i] = float(value)
        self._first = min(rows, default=0)
        top = max(rows, default=0)
        # from the highest power of y down: [c_i of x^i, highest first]
        self._rows = [self._row(rows.get(k, {})) for k in range(top, self._first - 1, -1)]

    @staticmethod
    def _row(row: Mapping[int, float]) -> list[float]:
        return [row.get(i, 0.0) for i in range(max(row, default=0), -1, -1)]

    def __call__(self, x: Any, y: Any) -> Any:
        """The values at broadcast arrays of doubles."""
        first, second = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        total, row = np.zeros(first.shape), np.empty(first.shape)
        for n, coefficients in enumerate(self._rows):
            if n:
                total *= second
            row.fill(coefficients[0])
            for value in coefficients[1:]:
                row *= first
                row += value
            total += row
        for _ in range(self._first):
            total *= second
        return total
