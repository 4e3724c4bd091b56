"""Curves kept in the user's cache folder, under what they depend on; arrays alone, never pickled objects."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from singimpact import cache
from singimpact.store import cache_folder
from singimpact.surface.curve import Curve, Mark

LIBRARIES = ("numpy", "numba", "contourpy")
ABOVE = ("paper/", "documents/", "scenes/", "bench/", "cli/")  # rooms that no curve depends on


def key_of(*parts: Any) -> str:
    """A digest of texts, of the source below the pictures and of the versions of what computes.

    Examples
    --------
    >>> key_of("horizon", 1) == key_of("horizon", 1), len(key_of("horizon", 2))
    (True, 64)
    """
    return cache.key_of(parts, LIBRARIES, ABOVE)


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
