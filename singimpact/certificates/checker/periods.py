"""The period of f and g in t, checked in exact arithmetic."""

import ast
from fractions import Fraction

from .formulas import Formula, need


def require_period(g: Formula, period: str) -> None:
    """Refuse a period that f or g is not shown to have: t is in sines of rate t + phase, rate period = 2 pi m."""
    length = Formula(period, g.parameters)
    turn = monomial(length, length.tree)

    def seen(node: ast.AST) -> bool:
        """Whether a part has the period."""
        match node:
            case ast.Name("t"):
                return False
            case ast.Call(ast.Name("sin" | "cos" | "tan"), [argument]) if "t" in g.names(argument):
                frequency = rate(g, argument)
                if frequency is None or turn is None or frequency[1] + turn[1] != 1:
                    return False
                return (frequency[0] * turn[0] / 2).denominator == 1
        return all(seen(child) for child in ast.iter_child_nodes(node))

    need("period", seen(g.tree), f"{g.text} is not shown to have the period {period}")


def monomial(formula: Formula, node: ast.expr) -> tuple[Fraction, int] | None:
    """(q, k) of a part that is q pi^k, q rational."""
    if (rational := formula.exact(node)) is not None:
        return rational, 0
    match node:
        case ast.Name("pi"):
            return Fraction(1), 1
        case ast.Name(name) if name in formula.parameters:
            inner = Formula(formula.parameters[name], {})
            return monomial(inner, inner.tree)
        case ast.UnaryOp(ast.USub(), part) if (power := monomial(formula, part)) is not None:
            return -power[0], power[1]
        case ast.BinOp(left, ast.Mult() | ast.Div() as op, right):
            one, other = monomial(formula, left), monomial(formula, right)
            if one is not None and other is not None and other[0]:
                sign = 1 if isinstance(op, ast.Mult) else -1
                return one[0] * other[0] ** sign, one[1] + sign * other[1]
    return None


def rate(formula: Formula, node: ast.expr) -> tuple[Fraction, int] | None:
    """(q, k) of a part that is q pi^k t + a constant; q = 0 where it is constant."""
    if "t" not in formula.names(node):
        return Fraction(0), 0
    match node:
        case ast.Name():
            return Fraction(1), 0
        case ast.UnaryOp(ast.USub(), part) if (slope := rate(formula, part)) is not None:
            return -slope[0], slope[1]
        case ast.BinOp(left, ast.Add() | ast.Sub() as op, right):
            one, other = rate(formula, left), rate(formula, right)
            if one is None or other is None or (one[0] and other[0]):
                return None
            return one if one[0] else (other[0] * (1 if isinstance(op, ast.Add) else -1), other[1])
        case ast.BinOp(left, ast.Mult() | ast.Div() as op, right):
            inner, factor = rate(formula, left), monomial(formula, right)
            if isinstance(op, ast.Mult) and factor is None:
                inner, factor = rate(formula, right), monomial(formula, left)
            if inner is not None and factor is not None and factor[0]:
                sign = 1 if isinstance(op, ast.Mult) else -1
                return inner[0] * factor[0] ** sign, inner[1] + sign * factor[1]
    return None
