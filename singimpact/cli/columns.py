"""Rows of cells as aligned text or as a Markdown table."""

from __future__ import annotations

from collections.abc import Sequence


def columns(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Left-aligned columns two spaces apart, no trailing blanks.

    Examples
    --------
    >>> print(columns(["tau", "v"], [["0.5", "0.125"], ["10", "1"]]))
    tau  v
    0.5  0.125
    10   1
    """
    table = [list(header), *map(list, rows)]
    widths = [max(len(row[i]) for row in table) for i in range(len(header))]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in table
    )


def markdown(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Rows of cells as a table of Markdown.

    Examples
    --------
    >>> print(markdown(["tau", "v"], [["0.5", "0.125"]]))
    | tau | v |
    |---|---|
    | 0.5 | 0.125 |
    """
    lines = [list(header), *map(list, rows)]
    text = ["| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines]
    return "\n".join([text[0], "|" + "---|" * len(header), *text[1:]])
