"""What was measured, as tables of text cells and as plain data."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from singimpact.bench.exponents import exponents
from singimpact.bench.measuring import Measured, Row

HEADER = ("case", "method", "setting", "microseconds", "error", "wrong", "missed", "times the first", "quartiles")
GROWTH = ("case", "method", "time grows with the power", "+-", "from", "to")
Table = tuple[tuple[str, ...], list[list[str]]]

NOTE = (
    "CPU time of one problem, median of the rounds; error relative, median of the problems; wrong: off by more than ten"
    " times condition times epsilon, or no answer; missed: of these, off by more than 1 %."
)


def tables(found: Measured) -> list[Table]:
    """Header and cells: the rows, then the exponents where there are such."""
    made: list[Table] = [(HEADER, [_cells(row) for row in found.rows])]
    fits = exponents(found.rows)
    if fits:
        cells = [[fit.case, fit.method, f"{fit.exponent:.2f}", f"{fit.error:.2f}", f"{fit.least:g}", f"{fit.most:g}"]
                 for fit in fits]  # fmt: skip
        made.append((GROWTH, cells))
    return made


def _cells(row: Row) -> list[str]:
    judged = row.wrong is not None
    return [
        row.case,
        row.method,
        row.setting,
        f"{row.microseconds:.3g}" if row.microseconds < 1e3 else f"{row.microseconds:.0f}",
        "" if row.error is None else f"{row.error:.1e}",
        f"{row.wrong}/{row.of}" if judged else "",
        f"{row.missed}/{row.of}" if judged else "",
        f"{row.ratio:.3g}",
        f"{row.spread[0]:.3g} to {row.spread[1]:.3g}",
    ]


def skipped(found: Measured) -> str:
    """One line a peer that is not installed."""
    return "\n".join(f"{found.group}: {name} is not installed, skipped" for name in found.skipped)


def as_data(found: Measured) -> dict[str, Any]:
    """Rows, exponents and what was skipped, as JSON takes them."""
    fits = [{"group": found.group, **asdict(fit)} for fit in exponents(found.rows)]
    return {"rows": [asdict(row) for row in found.rows], "exponents": fits, "skipped": list(found.skipped)}
