"""Figure numbers and the functions that compute them, found when they are asked for."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from singimpact import cache
from singimpact.inputs import checked_keywords, refuse
from singimpact.paper.figures.panel import Dot, Line, Panel, Picture, Region
from singimpact.scenes.layer_data import key_of
from singimpact.store import cache_folder

FIGURES = tuple(range(1, 18))
"""The numbers of the paper's figures."""
BEYOND = ("B1", "B2", "B3", "B4", "B5", "B6", "B7", "B8", "B9")
"""The names of figures of what the paper does not have."""


ACCEPTED = f"a number from {min(FIGURES)} to {max(FIGURES)}, or {BEYOND[0]} to {BEYOND[-1]} for those beyond the paper"


def _function(number: int | str) -> Callable[[], Picture]:
    if isinstance(number, str):
        return _beyond(number)
    from singimpact.paper.figures import (  # they load what computes
        contact_figures,
        outlines,
        swan_figures,
        unfolded_figures,
    )

    functions: dict[int, Callable[[], Picture]] = {
        1: outlines.figure_1,
        2: outlines.figure_2,
        3: contact_figures.figure_3,
        4: contact_figures.figure_4,
        5: contact_figures.figure_5,
        6: contact_figures.figure_6,
        7: contact_figures.figure_7,
        8: contact_figures.figure_8,
        9: outlines.figure_9,
        10: outlines.figure_10,
        11: swan_figures.figure_11,
        12: swan_figures.figure_12,
        13: unfolded_figures.figure_13,
        14: swan_figures.figure_14,
        15: swan_figures.figure_15,
        16: unfolded_figures.figure_16,
        17: unfolded_figures.figure_17,
    }
    return functions[number]


def _beyond(name: str) -> Callable[[], Picture]:
    from singimpact.paper.figures import beyond_figures, corrections

    functions: dict[str, Callable[[], Picture]] = {
        "B1": corrections.figure_B1,
        "B2": corrections.figure_B2,
        "B3": corrections.figure_B3,
        "B4": beyond_figures.figure_B4,
        "B5": beyond_figures.figure_B5,
        "B6": beyond_figures.figure_B6,
        "B7": beyond_figures.figure_B7,
        "B8": beyond_figures.figure_B8,
        "B9": beyond_figures.figure_B9,
    }
    return functions[name]


def picture(number: Any) -> Picture:
    """The data of one of the paper's figures, or of one beyond it.

    Raises
    ------
    InputError : neither a number from 1 to 17 nor a name of `BEYOND`.
    """
    number = {str(key): key for key in FIGURES}.get(number, number) if isinstance(number, str) else number
    if isinstance(number, bool) or not isinstance(number, int | str) or number not in (*FIGURES, *BEYOND):
        raise refuse("figure", number, ACCEPTED)
    return _function(number)()


@checked_keywords
def figure(number: Any, *, serif: bool = False, dark: bool = False) -> Any:
    """One of the paper's figures as a matplotlib figure, at the size of a printed page; "B1" to "B9" are beyond it.

    Parameters
    ----------
    number : from 1 to 17, or the name of a figure beyond the paper.
    serif : letters as in a journal (STIX). dark : light lines on a dark ground.

    Examples
    --------
    >>> len(figure(12).axes)
    4
    """
    from singimpact.paper.figures.figure_rendering import drawn

    return drawn(picture(number), serif, dark)


# Figures kept in the user's cache folder as numbers, so that an interrupted run continues where it stopped.

KINDS = (Picture, Panel, Line, Region, Dot)


def kept_picture(number: int | str) -> Picture:
    """The data of a figure as `picture` gives them, from the cache when they were computed before."""
    place = cache_folder() / "figures" / f"{key_of(number, cache.source_digest(Path(__file__).parent))}.figure"
    content = cache.recall(place)
    if content is not None:
        found: Picture = cache.unpacked(content, KINDS)
        return found
    made = picture(number)
    cache.keep(place, cache.packed(made))
    return made
