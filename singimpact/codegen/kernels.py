"""A kernel's text becomes a file in the cache folder, compiled by numba, or a namespace that runs on mpmath numbers.

A file is named by a digest of its whole text.  numba's disk cache does not see an edited callee in another file; here
there is no other file.
"""

from __future__ import annotations

import ast
import hashlib
import math
import sys
import types
from functools import lru_cache
from pathlib import Path
from types import CodeType
from typing import Any

from singimpact import cache
from singimpact.inputs import InputError, Unfinished
from singimpact.store import cache_folder, folder, passing_folder, write_text

_READY: dict[tuple[str, tuple[str, ...]], dict[str, Any]] = {}
FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "tanh", "atan", "expm1", "log1p", "sinh")
"""What a kernel's text may call on its numbers."""


def filed(text: str) -> Path | None:
    """The file that holds a kernel's text, whole, so two processes may race; None when no folder takes it."""
    name = _file_name(text)
    for passing in (False, True):
        try:
            return _placed(passing_folder() if passing else cache_folder() / "kernels", name, text)
        except (InputError, OSError) as error:  # a read-only home or a full disk must not stop a computation
            cache.not_kept(error)
    return None


@lru_cache(maxsize=256)
def _file_name(text: str) -> str:
    return f"kernel_{hashlib.sha256(text.encode()).hexdigest()[:24]}.py"


def _placed(place: Path, name: str, text: str) -> Path:
    path = folder(place) / name
    # the name is a digest of the text, so another text under it is damage
    there = path.read_bytes() if path.is_file() else None
    if there != text.encode():
        if there is not None:
            cache.damaged(path, "its text is not what was written")
        write_text(path, text)
    return path


@lru_cache(maxsize=256)
def compiled(text: str, names: tuple[str, ...]) -> dict[str, Any]:
    """The namespace of a kernel with the functions `names`, callees first, compiled by numba on their first call.

    Examples
    --------
    >>> compiled("def twice(x):\\n    return 2 * x\\n", ("twice",))["twice"](1.5)
    3.0
    """
    numba = _numba()

    from singimpact.codegen.machine_code import keep_machine_code

    path = filed(text)
    place = str(path or f"<{_file_name(text)}>")
    module = types.ModuleType(f"singimpact_{_file_name(text).removesuffix('.py')}")
    module.__file__ = place
    # code from numba's disk cache looks for the module of its function by name, in a process that never ran its text
    sys.modules[module.__name__] = module
    space = vars(module)
    space.update({name: getattr(math, name) for name in FUNCTIONS})
    if numba.config.DISABLE_JIT:  # the text runs as it stands, on arrays, with the answers that compiled code has
        space.update(WITHOUT_EXCEPTIONS)
    exec(compile(text, place, "exec"), space)
    for name in names if not numba.config.DISABLE_JIT else ():
        space[name] = numba.njit(error_model="numpy")(space[name])
        if path is not None:
            keep_machine_code(space[name])
    _READY[text, names] = space
    return space


def _numba() -> Any:
    """The compiler, or one sentence where it cannot be loaded: few flights do without it, many would take for ever."""
    try:
        import numba
    except ImportError as error:
        told = "install numba, which is among the requirements, or fly fewer states in a call"
        raise Unfinished(f"so much work needs a compiler, and numba cannot be imported ({error}): {told}") from None
    return numba


WITHOUT_EXCEPTIONS: dict[str, Any] = {
    "exp": lambda x: math.exp(x) if not x > 709.78 else math.inf,
    "log": lambda x: math.log(x) if x > 0 else math.nan,
}


def is_compiled(text: str, names: tuple[str, ...], name: str) -> bool:
    """Whether this process has compiled, or read from the cache, a function of a kernel."""
    return bool((text, names) in _READY and getattr(_READY[text, names][name], "signatures", True))


def was_compiled(text: str, name: str) -> bool:
    """Whether numba's disk cache beside the kernel's file has the function."""
    kept = cache_folder() / "kernels" / "__pycache__"
    return any(kept.glob(f"{_file_name(text).removesuffix('.py')}.{name}-*.nbc"))


def plain(text: str, functions: dict[str, Any]) -> dict[str, Any]:
    """The namespace of the same text over another arithmetic with its `functions` (sin, exp, ...); tables are lists."""
    space: dict[str, Any] = dict(functions)
    exec(_parsed(text), space)
    return space


@lru_cache(maxsize=64)
def _parsed(text: str) -> CodeType:
    return compile(nested(text), "<kernel>", "exec")


def nested(text: str) -> ast.Module:
    """The text with a[i][j] for a[i, j]: number by number, lists of lists are several times faster than arrays."""
    tree: ast.Module = _Nested().visit(ast.parse(text))
    return ast.fix_missing_locations(tree)


class _Nested(ast.NodeTransformer):
    def visit_Subscript(self, node: ast.Subscript) -> ast.Subscript:
        self.generic_visit(node)
        if not isinstance(node.slice, ast.Tuple):
            return node
        first, last = node.slice.elts
        return ast.Subscript(ast.Subscript(node.value, first, ast.Load()), last, node.ctx)
