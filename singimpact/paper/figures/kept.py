"""Figures kept in the user's cache folder as numbers, so that a run that was cut off goes on where it was."""

from __future__ import annotations

import json
from dataclasses import fields, is_dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from singimpact import cache
from singimpact.paper.figures.panel import Dot, Line, Panel, Picture, Region
from singimpact.paper.figures.registry import picture
from singimpact.scenes.kept import key_of
from singimpact.store import cache_folder

KINDS = {kind.__name__: kind for kind in (Picture, Panel, Line, Region, Dot)}


def kept_picture(number: int) -> Picture:
    """The data of a figure as `registry.picture` gives them, from the cache when they were computed before."""
    place = cache_folder() / "figures" / f"{key_of(number, cache.source_digest(Path(__file__).parent))}.figure"
    content = cache.recall(place)
    if content is not None:
        return unpacked(content)
    made = picture(number)
    cache.keep(place, packed(made))
    return made


def packed(made: Picture) -> bytes:
    """The bytes of a figure: a tree of JSON, and the arrays beside it.

    Examples
    --------
    >>> shown = Picture(1, "a line", (), "", [Panel(((0, 1), (0, 1)), lines=[Line(np.eye(2), "P")])])
    >>> unpacked(packed(shown)).to_dict() == shown.to_dict()
    True
    """
    arrays: list[Any] = []
    tree = _tree(made, arrays)
    stream = BytesIO()
    np.savez(stream, tree=json.dumps(tree), **{f"a{n}": array for n, array in enumerate(arrays)})
    return stream.getvalue()


def unpacked(content: bytes) -> Picture:
    """The figure of such bytes."""
    with np.load(BytesIO(content), allow_pickle=False) as found:
        made: Picture = _grown(json.loads(str(found["tree"])), found)
    return made


def _tree(thing: Any, arrays: list[Any]) -> Any:
    """Every object becomes a list that begins with its kind."""
    if isinstance(thing, np.ndarray):
        arrays.append(thing)
        return ["array", len(arrays) - 1]
    if is_dataclass(thing):
        return [type(thing).__name__, {each.name: _tree(getattr(thing, each.name), arrays) for each in fields(thing)}]
    if isinstance(thing, dict):
        return ["dict", {key: _tree(value, arrays) for key, value in thing.items()}]
    if isinstance(thing, list | tuple):
        return [type(thing).__name__, [_tree(each, arrays) for each in thing]]
    return thing.item() if isinstance(thing, np.generic) else thing


def _grown(tree: Any, arrays: Any) -> Any:
    if not isinstance(tree, list):
        return tree
    kind, inside = tree
    if kind == "array":
        return arrays[f"a{inside}"]
    if isinstance(inside, dict):
        parts = {key: _grown(value, arrays) for key, value in inside.items()}
        return KINDS[kind](**parts) if kind in KINDS else parts
    parts_in_order = [_grown(each, arrays) for each in inside]
    return tuple(parts_in_order) if kind == "tuple" else parts_in_order
