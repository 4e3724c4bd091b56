"""Growth of cost: the exponent of a power law through measured times, with its standard error."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np

from singimpact.bench.measuring import Row


@dataclass(frozen=True)
class Exponent:
    """microseconds ~ size^exponent, fitted over sizes `least` to `most`; `error` is the standard error.

    `work` is the exponent of what there is to compute, e.g. of the number of terms: what explains the growth.
    """

    case: str
    method: str
    exponent: float
    error: float
    least: float
    most: float
    points: int
    work: float


def fitted(sizes: Sequence[float], times: Sequence[float]) -> tuple[float, float]:
    """Slope of the least-squares line through (log size, log time), and its standard error.

    Parameters
    ----------
    sizes, times : positive numbers, three or more.

    Examples
    --------
    >>> slope, error = fitted([1, 2, 4, 8], [3, 12, 48, 192])
    >>> round(slope, 12), error < 1e-12
    (2.0, True)
    """
    x, y = np.log(sizes), np.log(times)
    away = x - x.mean()
    squares = float(away @ away)
    slope = float(away @ y) / squares
    left = y - y.mean() - slope * away
    return slope, sqrt(float(left @ left) / (len(x) - 2) / squares)


def exponents(rows: Sequence[Row]) -> list[Exponent]:
    """An exponent for each method of each case that was measured at three sizes or more."""
    rows_ = []
    for case, method in dict.fromkeys((row.case, row.method) for row in rows if row.size is not None):
        line = [
            (row.size, row.microseconds, row.work or row.size)
            for row in rows
            if (row.case, row.method) == (case, method) and row.size is not None
        ]
        sizes = [size for size, _, _ in line]
        if len(set(sizes)) >= 3:
            slope, error = fitted(sizes, [spent for _, spent, _ in line])
            work, _ = fitted(sizes, [work for _, _, work in line])
            rows_.append(Exponent(case, method, slope, error, min(sizes), max(sizes), len(line), work))
    return rows_
