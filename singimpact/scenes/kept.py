"""Curves kept in the user's cache folder, under what they depend on; arrays alone, never pickled objects."""

from __future__ import annotations

import hashlib
import json
from functools import lru_cache
from importlib.metadata import version
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from singimpact import cache
from singimpact.store import cache_folder
from singimpact.surface.curve import Curve, Mark

ABOVE = ("paper/", "documents/", "scenes/", "bench/", "cli/", "generated/")  # rooms that no curve depends on


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
    with np.load(BytesIO(content), allow_pickle=False) as found:
        heads = json.loads(str(found["heads"]))
        return [_curve(head, found[f"p{n}"], found[f"v{n}"]) for n, head in enumerate(heads)]


def keep(key: str, curves: list[Curve]) -> None:
    """Put curves on disk; a cache that cannot be written is no reason to fail."""
    arrays: dict[str, Any] = {f"p{n}": curve.points for n, curve in enumerate(curves)}
    arrays |= {f"v{n}": curve.visible for n, curve in enumerate(curves)}
    stream = BytesIO()
    np.savez(stream, heads=json.dumps([_head(curve) for curve in curves]), **arrays)
    cache.keep(_place(key), stream.getvalue())


def _place(key: str) -> Path:
    return cache_folder() / "curves" / f"{key}.curves"


def _head(curve: Curve) -> dict[str, Any]:
    marks = [[mark.index, mark.name] for mark in curve.marks]
    return {"name": curve.name, "axes": curve.axes, "marks": marks, "closed": curve.closed,
            "tolerance": curve.tolerance}  # fmt: skip


def _curve(head: dict[str, Any], points: Any, visible: Any) -> Curve:
    marks = tuple(Mark(int(index), str(name)) for index, name in head["marks"])
    first, second = head["axes"]
    return Curve(head["name"], points, (first, second), marks, head["closed"], head["tolerance"], visible)
