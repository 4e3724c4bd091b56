"""That g has a period, in exact arithmetic."""

from __future__ import annotations

import ast

from .formulas import Formula, Refused


def require_period(g: Formula, period: str) -> None:
    """Refuse a period that g is not shown to have: t is in sines of rate t + phase, rate period = 2 pi m."""
    length = Formula(period, g.parameters)
    turn = length.monomial(length.tree)

    def seen(node: ast.AST) -> bool:
        """Whether a part has the period."""
        match node:
            case ast.Name("t"):
                return False
            case ast.Call(ast.Name("sin" | "cos" | "tan"), [argument]) if "t" in g.names(argument):
                rate = g.rate(argument)
                if rate is None or turn is None or rate[1] + turn[1] != 1:
                    return False
                return (rate[0] * turn[0] / 2).denominator == 1
        return all(seen(part) for part in ast.iter_child_nodes(node))

    if not seen(g.tree):
        raise Refused(f"g = {g.text} is not shown to have the period {period}")
