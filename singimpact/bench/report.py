"""Measurements as tables of text cells and as plain data, with the exponents of power laws through measured times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from math import sqrt
from typing import Any

import numpy as np

from singimpact.bench.measuring import Measured, Row

HEADER = ("case", "method", "setting", "time", "to reach", "error", "wrong", "missed", "times the first", "quartiles")
GROWTH = ("case", "method", "time grows with the power", "+-", "the work with", "from", "to")
Table = tuple[tuple[str, ...], list[list[str]]]

NOTE = (
    "CPU time of one problem, median of the rounds; error relative, median of the problems; wrong: off by more than ten"
    " times condition times epsilon, or no answer; missed: of these, off by more than 1 %."
)
AIMED = (
    "To reach: a time at most, with no answer wrong, or times the first row at least; reached or missed as measured"
    " here, on this machine and under its load."
)


# Growth of cost: the exponent of a power law through measured times, with its standard error.


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


def tables(measured: Measured) -> list[Table]:
    """Header and cells: the rows, then the exponents where there are such."""
    result: list[Table] = [(HEADER, [_cells(row) for row in measured.rows])]
    fits = exponents(measured.rows)
    if fits:
        cells = [
            [
                fit.case,
                fit.method,
                f"{fit.exponent:.2f}",
                f"{fit.error:.2f}",
                f"{fit.work:.2f}",
                f"{fit.least:g}",
                f"{fit.most:g}",
            ]
            for fit in fits
        ]
        result.append((GROWTH, cells))
    return result


def in_words(microseconds: float) -> str:
    """A time with its unit, in three digits.

    Examples
    --------
    >>> in_words(0.4912), in_words(1291.6), in_words(42183319.0)
    ('0.491 us', '1.29 ms', '42.2 s')
    """
    factor, unit = (1, "us") if microseconds < 999.5 else (1e3, "ms") if microseconds < 999.5e3 else (1e6, "s")
    value = microseconds / factor
    return f"{value:.3g} {unit}" if value < 999.5 else f"{value:.0f} {unit}"


def _cells(row: Row) -> list[str]:
    judged = row.wrong is not None
    return [
        row.case,
        row.method,
        row.setting,
        in_words(row.microseconds),
        _aim(row),
        "" if row.error is None else f"{row.error:.1e}",
        f"{row.wrong}/{row.of}" if judged else "",
        f"{row.missed}/{row.of}" if judged else "",
        f"{row.ratio:.3g}",
        f"{row.spread[0]:.3g} to {row.spread[1]:.3g}",
    ]


def _aim(row: Row) -> str:
    """The figure to reach, and whether it is reached."""
    if row.reached is None:
        return ""
    figure = f"{row.aim.times:g} times" if row.aim.times is not None else in_words(row.aim.microseconds or 0)
    return f"{figure}: {'reached' if row.reached else 'missed'}"


def reached(found: Measured) -> str:
    """The number of aims that are reached, and the rows that miss theirs; empty without aims."""
    aimed = [row for row in found.rows if row.reached is not None]
    if not aimed:
        return ""
    count = sum(bool(row.reached) for row in aimed)
    short = [f"missed: {row.case}, {row.method}, {row.setting}" for row in aimed if not row.reached]
    return "\n".join([f"{AIMED} {count} of {len(aimed)} are reached.", *short])


def skipped(found: Measured) -> str:
    """One line a peer that is not installed."""
    return "\n".join(f"{found.group}: {name} is not installed, skipped" for name in found.skipped)


def as_data(found: Measured) -> dict[str, Any]:
    """Rows, exponents and what was skipped, as JSON takes them."""
    fits = [{"group": found.group, **asdict(fit)} for fit in exponents(found.rows)]
    return {
        "rows": [asdict(row) for row in found.rows],
        "exponents": fits,
        "skipped": list(found.skipped),
        "notes": list(found.notes),
    }
