"""A kernel's text becomes a file in the cache folder, compiled by numba, or a namespace that runs on mpmath numbers.

A file is named by a digest of its whole text.  numba's disk cache does not see an edited callee in another file; here
there is no other file.
"""

from __future__ import annotations

import hashlib
import math
import sys
import types
from functools import lru_cache
from pathlib import Path
from typing import Any

from singimpact.inputs import InputError
from singimpact.store import cache_folder, folder, passing_folder, write_text

_READY: dict[tuple[str, tuple[str, ...]], dict[str, Any]] = {}
FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "tanh", "atan")


def filed(text: str) -> Path:
    """The file that holds a kernel's text; it is there whole or not at all, so two processes may race."""
    name = _file_name(text)
    try:
        return _placed(cache_folder() / "kernels", name, text)
    except InputError:  # a read-only home must not stop a computation
        return _placed(passing_folder(), name, text)


@lru_cache(maxsize=256)
def _file_name(text: str) -> str:
    return f"kernel_{hashlib.sha256(text.encode()).hexdigest()[:24]}.py"


def _placed(place: Path, name: str, text: str) -> Path:
    path = folder(place) / name
    # an equal file stays: numba's disk cache looks at its time
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
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
    import numba

    path = filed(text)
    module = types.ModuleType(f"singimpact_{path.stem}")
    module.__file__ = str(path)
    # code from numba's disk cache looks for the module of its function by name, in a process that never ran its text
    sys.modules[module.__name__] = module
    space = vars(module)
    space.update({name: getattr(math, name) for name in FUNCTIONS})
    exec(compile(text, str(path), "exec"), space)
    for name in names:
        space[name] = numba.njit(cache=True, error_model="numpy")(space[name])
    _READY[text, names] = space
    return space


def is_compiled(text: str, names: tuple[str, ...], name: str) -> bool:
    """Whether this process has compiled, or read from the cache, a function of a kernel."""
    return bool((text, names) in _READY and _READY[text, names][name].signatures)


def was_compiled(text: str, name: str) -> bool:
    """Whether numba's disk cache beside the kernel's file has the function."""
    kept = cache_folder() / "kernels" / "__pycache__"
    return any(kept.glob(f"{_file_name(text).removesuffix('.py')}.{name}-*.nbi"))


def plain(text: str, functions: dict[str, Any]) -> dict[str, Any]:
    """The namespace of the same text over another arithmetic, which gives `functions` (sin, exp, ...)."""
    space: dict[str, Any] = dict(functions)
    exec(compile(text, "<kernel>", "exec"), space)
    return space
