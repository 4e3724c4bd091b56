"""Figures kept in the user's cache folder as numbers, so that an interrupted run continues where it stopped."""

from __future__ import annotations

from pathlib import Path

from singimpact import cache
from singimpact.paper.figures.panel import Dot, Line, Panel, Picture, Region
from singimpact.paper.figures.registry import picture
from singimpact.scenes.stored_layers import key_of
from singimpact.store import cache_folder

KINDS = (Picture, Panel, Line, Region, Dot)


def kept_picture(number: int | str) -> Picture:
    """The data of a figure as `registry.picture` gives them, from the cache when they were computed before."""
    place = cache_folder() / "figures" / f"{key_of(number, cache.source_digest(Path(__file__).parent))}.figure"
    content = cache.recall(place)
    if content is not None:
        found: Picture = cache.unpacked(content, KINDS)
        return found
    made = picture(number)
    cache.keep(place, cache.packed(made))
    return made
