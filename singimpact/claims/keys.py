"""The canonical key of a claim: what its verdict depends on, so that a kept verdict serves while nothing changed.

A key is a digest of the source of the package outside `claims/sections`, of the versions of the libraries, of the
printed statement, of the code that its verifier can reach in the sections, and of the keys of what it rests on.  An
edited verifier therefore runs again, with its dependants and no others; an edit below the claims runs all again.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Mapping
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

from singimpact.cache import source_digest
from singimpact.claims.claim import Claim

LIBRARIES = ("sympy", "numpy", "scipy", "python-flint", "mpmath", "numba")
SECTIONS = "singimpact.claims.sections"
ABOVE = ("claims/sections/", "cli/", "documents/", "scenes/", "bench/", "generated/")  # what no verdict depends on


@lru_cache(maxsize=1)
def ground() -> str:
    """The digest of everything below the sections: the package's source, Python and the libraries."""
    source = source_digest(Path(__file__).parents[1], ABOVE)
    libraries = repr((sys.version_info[:2], [version(name) for name in LIBRARIES]))
    return hashlib.sha256((libraries + source).encode()).hexdigest()


def key_of(claim: Claim, below: Mapping[str, str]) -> str:
    """The key of a claim, given the keys of the claims it rests on.

    Examples
    --------
    >>> from singimpact.claims import CLAIMS
    >>> len(key_of(CLAIMS["e:yeq"], {}))
    64
    """
    told = [ground(), claim.id, claim.title, claim.section, claim.printed.latex, _told(claim.printed.value, set())]
    told += [_told(claim.verify, set()), _told(claim.corrected, set()), _told(claim.trials, set())]
    told += [below.get(name, "") for name in claim.rests_on]
    return hashlib.sha256(json.dumps(told).encode()).hexdigest()


def _told(value: Any, seen: set[int]) -> str:
    """A text that changes when a value or the code that a function can reach in the sections changes."""
    if isinstance(value, FunctionType):
        return _function(value, seen)
    if isinstance(value, tuple | list):
        return "(" + ",".join(_told(item, seen) for item in value) + ")"
    return str(value)


def _function(function: FunctionType, seen: set[int]) -> str:
    if id(function) in seen or not function.__module__.startswith("singimpact.claims"):
        return f"{function.__module__}.{function.__qualname__}"  # what stands below is in the ground's digest
    seen.add(id(function))
    parts = [function.__qualname__, _code(function.__code__)]
    parts += [_told(cell.cell_contents, seen) for cell in function.__closure__ or ()]
    if function.__module__.startswith(SECTIONS):
        names = _names(function.__code__)
        parts += [
            _told(function.__globals__[name], seen) for name in sorted(names) if _ours(function.__globals__, name)
        ]
    return "|".join(parts)


def _ours(scope: Mapping[str, Any], name: str) -> bool:
    """Whether a global name is a function or a constant of the sections themselves."""
    value = scope.get(name)
    if isinstance(value, FunctionType):
        return value.__module__.startswith(SECTIONS)
    return name in scope and name != "CLAIMS" and not isinstance(value, type | ModuleType) and not callable(value)


def _code(code: CodeType) -> str:
    constants = [_code(item) if isinstance(item, CodeType) else repr(item) for item in code.co_consts]
    return hashlib.sha256(repr((code.co_code, code.co_names, constants)).encode()).hexdigest()


def _names(code: CodeType) -> set[str]:
    found = set(code.co_names)
    for item in code.co_consts:
        if isinstance(item, CodeType):
            found |= _names(item)
    return found
