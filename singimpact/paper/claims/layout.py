"""A table of verdicts laid out for a wide terminal, a narrow one, or a pipe."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from itertools import zip_longest
from typing import NamedTuple

Painter = Callable[[str, str], str]


class Row(NamedTuple):
    """One claim as cells."""

    id: str
    statement: str
    kind: str
    verdict: str
    evidence: str
    seconds: str


@dataclass(frozen=True)
class Widths:
    """Largest widths of the columns."""

    narrow: int = 96  # columns; below, statement and evidence would get less than 25 each and a stack reads better
    evidence: int = 72  # in a pipe, longer evidence runs on instead of padding every other line
    least: int = 24  # a cell narrower than this breaks formulas at every sign


WIDTHS = Widths()
HEADER = Row("id", "statement", "", "verdict", "evidence", "seconds")


def unpainted(text: str, kind: str) -> str:  # noqa: ARG001
    """No colour."""
    return text


def laid_out(rows: list[Row], width: int | None, paint: Painter = unpainted) -> str:
    """The table as text; `width` None means lines of any length."""
    if width is None:
        return _one_line_each(rows)
    return _stacked(rows, width, paint) if width < WIDTHS.narrow else _side_by_side(rows, width, paint)


def wrapped(label: str, text: str, width: int | None) -> list[str]:
    """A labelled text, broken to the width under its label."""
    if width is None:
        return [label + text]
    return textwrap.wrap(
        text,
        max(width, len(label) + WIDTHS.least),
        initial_indent=label,
        subsequent_indent=" " * len(label),
        break_on_hyphens=False,
    )


def _columns(rows: list[Row]) -> tuple[int, int]:
    return max(len(row.id) for row in rows), max(len(row.verdict) for row in rows)


def _one_line_each(rows: list[Row]) -> str:
    table = [HEADER, *rows]
    ids, verdicts = _columns(table)
    statement = max(len(row.statement) for row in table)
    evidence = min(WIDTHS.evidence, max(len(row.evidence) for row in table))
    return "\n".join(
        f"{row.id:<{ids}}  {row.statement:<{statement}}  {row.verdict:<{verdicts}}  "
        f"{row.evidence:<{evidence}}  {row.seconds:>7}"
        for row in table
    )


def _side_by_side(rows: list[Row], width: int, paint: Painter) -> str:
    ids, verdicts = _columns([HEADER, *rows])
    free = width - ids - verdicts - 7 - 8
    statement = max(WIDTHS.least, free * 9 // 20)
    evidence = max(WIDTHS.least, free - statement)
    rule = "-" * min(width, ids + verdicts + statement + evidence + 15)
    lines: list[str] = []
    for row in [HEADER, *rows]:
        cells = zip_longest(_cell(row.statement, statement), _cell(row.evidence, evidence), fillvalue="")
        for at, (left, right) in enumerate(cells):
            head = row if at == 0 else Row("", "", "", "", "", "")
            verdict = f"{head.verdict:<{verdicts}}"
            verdict = paint(verdict, row.kind) if head.kind else verdict
            line = f"{head.id:<{ids}}  {left:<{statement}}  {verdict}  {right:<{evidence}}  {head.seconds:>7}"
            lines.append(line.rstrip())
        if row is HEADER:
            lines.append(rule)
    return "\n".join(lines)


def _stacked(rows: list[Row], width: int, paint: Painter) -> str:
    lines: list[str] = []
    for row in rows:
        lines.append(f"{row.id}  {paint(row.verdict, row.kind)}  {row.seconds} s")
        lines += wrapped("    ", row.statement, width)
        lines += wrapped("    = ", row.evidence, width)
    return "\n".join(lines)


def _cell(text: str, width: int) -> list[str]:
    return textwrap.wrap(text, width, break_on_hyphens=False) or [""]
