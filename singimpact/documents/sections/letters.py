"""Letters and lines that the sections share."""

from __future__ import annotations

from typing import Any

import sympy

from singimpact.theory.implicit_route import f_symbol


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
    lines = [f"{left} ={{}}& {parts[0]}"]
    lines += [f"& - {part[1:]}" if part.startswith("-") else f"& + {part}" for part in parts[1:]]
    if remainder is not None:
        lines[-1] += f" + O({remainder})"
    return tuple(lines)
