"""Text of functions over numbers of any kind: arrays become lists of lists, which are several times faster there."""

import ast
from functools import lru_cache
from types import CodeType
from typing import Any

# The functions of one number that emitted text and kernels call
FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "tanh", "atan", "expm1", "log1p", "sinh")


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
    """The syntax tree, changed to a[i][j] for a[i, j]."""
    # in place, and not by a `NodeTransformer`: every new process waits for this before its first answer
    for node in ast.walk(tree):
        if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Tuple):
            *first, node.slice = node.slice.elts
            for index in first:
                node.value = ast.copy_location(ast.Subscript(node.value, index, ast.Load()), node)
    return tree
