"""A kernel's text run as it stands, on Python's floats and lists: the same operations in the same order, not compiled.

Compiling takes seconds and loading what was compiled half of one; a few thousand flights are over before.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.codegen.kernels import FUNCTIONS, WITHOUT_EXCEPTIONS, compiled, is_compiled, nested, was_compiled

LEFT_TO_NUMBA = (ZeroDivisionError, OverflowError, ValueError, TypeError)
"""What Python refuses where doubles have an answer: 1/0, exp(1000), log(-1), a comparison of (-1)**0.5."""


@dataclass(frozen=True)
class Patience:
    """How much of a text's work is interpreted in a process before it is compiled, in microseconds of interpretation.

    Attributes
    ----------
    fresh : about what compiling a text takes (measured 9 s for a linear model, 3 s for a flow in Taylor steps): whoever
        has the compiler to wait for as well then waits at most about twice as long as was necessary.
    kept : what numba's import and reading its cache take (0.6 s measured).
    """

    fresh: float = 3e6
    kept: float = 0.6e6


PATIENCE = Patience()
_SPENT: dict[str, float] = {}


def function(text: str, names: tuple[str, ...], name: str, cost: float) -> Callable[..., Any]:
    """The function `name` of a kernel, compiled or interpreted, whichever is ready sooner for work of this cost.

    Parameters
    ----------
    text, names : as for `compiled`. name : one of them. cost : of the work, in microseconds, when it is interpreted.

    Returns
    -------
    function : of the same arguments; it writes to arrays that the text of the function itself writes to.

    Examples
    --------
    >>> out = np.zeros(1)
    >>> function("def twice(x, out):\\n    out[0] = 2 * x\\n", ("twice",), "twice", 1.0)(1.5, out)
    >>> float(out[0])
    3.0
    """
    if is_compiled(text, names, name) or not _patient(text, name, cost):
        return compiled(text, names)[name]  # type: ignore[no-any-return]
    call, written = _interpreted(text, name)

    def run(*given: Any) -> Any:
        listed = [_plain(each) for each in given]
        try:
            result = call(*listed)
            for at in written:
                given[at][...] = listed[at]
        except LEFT_TO_NUMBA:
            return compiled(text, names)[name](*given)
        return result

    return run


def in_floats(text: str) -> dict[str, Any]:
    """The functions of a kernel on Python's floats and lists of lists, never compiled.

    Examples
    --------
    >>> in_floats("def first(W):\\n    return W[0, 0]\\n")["first"]([[1.5]])
    1.5
    """
    return _space(text)[1]


def forget() -> None:
    """Count what was interpreted from the start again, as a new process does."""
    _SPENT.clear()


def _patient(text: str, name: str, cost: float) -> bool:
    spent = _SPENT.get(text, 0.0) + cost
    if spent > PATIENCE.fresh or (spent > PATIENCE.kept and was_compiled(text, name)):
        return False
    _SPENT[text] = spent
    return True


def _plain(given: Any) -> Any:
    return given.tolist() if isinstance(given, np.ndarray | np.generic) else given


@lru_cache(maxsize=512)
def _interpreted(text: str, name: str) -> tuple[Callable[..., Any], tuple[int, ...]]:
    """The function, and which of its arguments it writes to, as a row or entry by entry."""
    tree, space = _space(text)
    (made,) = (part for part in tree.body if isinstance(part, ast.FunctionDef) and part.name == name)
    rows = {target: root for node in ast.walk(made) for target, root in _bound(node)}
    stored = {_root(node) for node in ast.walk(made) if isinstance(node, ast.Subscript) and _is_target(node)}
    stored |= {rows[each] for each in stored & rows.keys()}
    return space[name], tuple(at for at, each in enumerate(made.args.args) if each.arg in stored)


def _is_target(node: ast.Subscript) -> bool:
    return isinstance(node.ctx, ast.Store)


def _root(node: ast.AST) -> str:
    while isinstance(node, ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def _bound(node: ast.AST) -> list[tuple[str, str]]:
    """Names that an assignment gives to a row of an array, with the array."""
    if not isinstance(node, ast.Assign):
        return []
    target, value = node.targets[0], node.value
    both = isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple)
    pairs = zip(target.elts, value.elts, strict=True) if both else [(target, value)]  # type: ignore[attr-defined]
    return [(to.id, _root(of)) for to, of in pairs if isinstance(to, ast.Name) and isinstance(of, ast.Subscript)]


@lru_cache(maxsize=64)
def _space(text: str) -> tuple[ast.Module, dict[str, Any]]:
    tree = nested(text)
    space: dict[str, Any] = {name: getattr(math, name) for name in FUNCTIONS}
    space.update(WITHOUT_EXCEPTIONS)
    exec(compile(tree, "<kernel>", "exec"), space)
    return tree, space
