"""Letters and lines that the sections share."""

from __future__ import annotations

from typing import Any

import sympy

from singimpact.documents.breaking import PAGE, lines_of, width
from singimpact.paper.routes.implicit import f_symbol


def with_b(expression: Any) -> Any:
    """The damping in the paper's letter: f_01 = -b."""
    return sympy.expand(expression.subs(f_symbol(0, 1), -sympy.Symbol("b")))


def rows(left: str, parts: list[str], remainder: int | None = None) -> tuple[str, ...]:
    """``left = parts[0] + parts[1] + ... + O(remainder)``, one part a line, the signs under the first part.

    Examples
    --------
    >>> rows("v", ["a", "-b"], 3)
    ('v ={}& a', '& - b + O(3)')
    """
    first, *rest = parts
    signed = [first, *(f"- {entry[1:]}" if entry.startswith("-") else f"+ {entry}" for entry in rest)]
    if remainder is not None:
        signed[-1] += f" + O({remainder})"
    room = PAGE.line - width(left) - PAGE.sign
    lines = [
        rf"& \quad {line}" if at else f"& {line}" for entry in signed for at, line in enumerate(lines_of(entry, room))
    ]
    return (f"{left} ={{}}{lines[0]}", *lines[1:])
