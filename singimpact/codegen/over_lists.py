"""Text of functions over numbers of any kind: arrays become lists of lists, which are several times faster there."""

from __future__ import annotations

import ast
from functools import lru_cache
from types import CodeType
from typing import Any

FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "tanh", "atan", "expm1", "log1p", "sinh")
"""The functions of one number that emitted text and kernels call."""


def plain(text: str, functions: dict[str, Any]) -> dict[str, Any]:
    """The namespace of a text over an arithmetic with its `functions` (sin, exp, ...).

    Examples
    --------
    >>> plain("def corner(a):\\n    return a[1, 1]\\n", {})["corner"]([[1, 2], [3, 4]])
    4
    """
    space: dict[str, Any] = dict(functions)
    exec(_compiled(text), space)
    return space


@lru_cache(maxsize=64)
def _compiled(text: str) -> CodeType:
    return compile(nested(ast.parse(text)), "<kernel>", "exec")


def nested(tree: ast.Module) -> ast.Module:
    """A syntax tree with a[i][j] for a[i, j]."""
    found: ast.Module = _Nested().visit(tree)
    return ast.fix_missing_locations(found)


class _Nested(ast.NodeTransformer):
    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        self.generic_visit(node)
        if not isinstance(node.slice, ast.Tuple):
            return node
        value: ast.expr = node.value
        *first, last = node.slice.elts
        for index in first:
            value = ast.Subscript(value, index, ast.Load())
        return ast.Subscript(value, last, node.ctx)
