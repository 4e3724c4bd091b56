"""A kernel's text becomes a file in the cache folder, compiled by numba, or a namespace that runs on mpmath numbers.

A file is named by a digest of its whole text.  numba's disk cache does not see an edited callee in another file; here
there is no other file.
"""

from __future__ import annotations

import hashlib
import math
import os
import sys
import tempfile
import types
from functools import lru_cache
from pathlib import Path
from typing import Any

FUNCTIONS = ("sin", "cos", "tan", "exp", "log", "tanh", "atan")


@lru_cache(maxsize=1)
def _temporary_folder() -> str:
    return tempfile.mkdtemp(prefix="singimpact-")


def cache_folder() -> Path:
    """Where kernels are kept: `SINGIMPACT_CACHE`, else the user's cache folder; `off` gives a temporary one."""
    named = os.environ.get("SINGIMPACT_CACHE", "")
    if named == "off":
        return Path(_temporary_folder())
    if named:
        return Path(named)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "singimpact"


def written(text: str) -> Path:
    """The file that holds a kernel's text; written whole or not at all, so that two processes may race."""
    folder = cache_folder() / "kernels"
    path = folder / f"kernel_{hashlib.sha256(text.encode()).hexdigest()[:24]}.py"
    try:
        return _placed(path, text)
    except OSError:  # a read-only home must not stop a computation
        return _placed(Path(_temporary_folder()) / path.name, text)


def _placed(path: Path, text: str) -> Path:
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return path
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, partial = tempfile.mkstemp(dir=path.parent, suffix=".part")
    with os.fdopen(handle, "w", encoding="utf-8") as stream:
        stream.write(text)
    os.replace(partial, path)
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

    path = written(text)
    module = types.ModuleType(f"singimpact_{path.stem}")
    # numba's disk cache looks the module of a function up by its name
    sys.modules[module.__name__] = module
    space = vars(module)
    space.update({name: getattr(math, name) for name in FUNCTIONS})
    exec(compile(text, str(path), "exec"), space)
    for name in names:
        space[name] = numba.njit(cache=True, error_model="numpy")(space[name])
    return space


def plain(text: str, functions: dict[str, Any]) -> dict[str, Any]:
    """The namespace of the same text over another arithmetic, which gives `functions` (sin, exp, ...)."""
    space: dict[str, Any] = dict(functions)
    exec(compile(text, "<kernel>", "exec"), space)
    return space
