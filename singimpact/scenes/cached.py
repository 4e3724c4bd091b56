"""Curves kept in the user's cache folder, under what they depend on; arrays alone, never pickled objects."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from singimpact import cache
from singimpact.store import cache_folder
from singimpact.surface.curve import Curve, Mark

ABOVE = ("paper/", "documents/", "scenes/", "bench/", "cli/")  # rooms that no curve depends on


def key_of(*parts: Any) -> str:
    """A digest of texts, of the source below the pictures and of the versions of what computes.

    Examples
    --------
    >>> key_of("horizon", 1) == key_of("horizon", 1), len(key_of("horizon", 2))
    (True, 64)
    """
    return hashlib.sha256(json.dumps([ground(), *map(repr, parts)]).encode()).hexdigest()


@lru_cache(maxsize=1)
def ground() -> str:
    """The versions of the libraries, and the digest of the package's source below the pictures."""
    libraries = repr([version(name) for name in ("numpy", "numba", "contourpy")])
    return libraries + cache.source_digest(Path(__file__).parents[1], ABOVE)


def recall(key: str) -> list[Curve] | None:
    """The curves under a key, or None when there are none or the file is damaged."""
    content = cache.recall(_place(key))
    if content is None:
        return None
    found: list[Curve] = cache.unpacked(content, (Curve, Mark))
    return found


def keep(key: str, curves: list[Curve]) -> None:
    """Put curves on disk, with what is visible of them; a cache that cannot be written is no reason to fail."""
    cache.keep(_place(key), cache.packed([replace(curve, first_hits=curve.visible) for curve in curves]))


def _place(key: str) -> Path:
    return cache_folder() / "curves" / f"{key}.curves"
