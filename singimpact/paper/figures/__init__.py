"""The paper's figures 1 to 17, and B1 to B11 beyond it, from computed data of real oscillators.

Not here: what they show (`surface`, `dynamics`), what is claimed of it (`paper.claims`), pictures of a user's model
(`scenes`).
"""

from pathlib import Path
from typing import Any

from singimpact import cache
from singimpact.handed_on import names_of
from singimpact.inputs import checked_keywords, refuse
from singimpact.paper.figures.panel import CAPTIONS, Dot, Line, Panel, Picture, Region
from singimpact.scenes.layer_data import key_of
from singimpact.store import cache_folder

# Files of this room, and the figures of each: `figure_3` is in `contact_figures`.
FILES: dict[str, tuple[int | str, ...]] = {
    "outlines": (1, 2, 9, 10),
    "contact_figures": (3, 4, 5, 6, 7, 8),
    "swan_figures": tuple(range(11, 18)),
    "beyond_figures": tuple(f"B{n}" for n in range(1, 12)),
}
FIGURES = tuple(range(1, 18))  # the numbers of the paper's figures
BEYOND = FILES["beyond_figures"]  # the names of figures of what the paper does not have


ACCEPTED = f"a number from {min(FIGURES)} to {max(FIGURES)}, or {BEYOND[0]} to {BEYOND[-1]} for those beyond the paper"


def picture(number: Any) -> Picture:
    """The data of one of the paper's figures, or of one beyond it.

    Raises
    ------
    InputError : neither a number from 1 to 17 nor a name of `BEYOND`.
    """
    number = {str(key): key for key in FIGURES}.get(number, number) if isinstance(number, str) else number
    if isinstance(number, bool) or not isinstance(number, int | str) or number not in (*FIGURES, *BEYOND):
        raise refuse("figure", number, ACCEPTED)
    file = next(file for file, numbers in FILES.items() if number in numbers)
    # loaded here, because the file loads what computes
    data: Picture = names_of(__name__, {file: f"figure_{number}"})(f"figure_{number}")()
    return data


@checked_keywords
def figure(number: Any, *, serif: bool = False, dark: bool = False) -> Any:
    """One of the paper's figures as a matplotlib figure, at the size of a printed page; "B1" to "B11" are beyond it.

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
    # captions are no source to the digest, which reads programs and pages alone
    key = key_of(number, cache.source_digest(Path(__file__).parent), CAPTIONS.read_text(encoding="utf-8"))
    file = cache_folder() / "figures" / f"{key}.figure"
    content = cache.recall(file)
    if content is not None:
        stored: Picture = cache.unpacked(content, KINDS)
        return stored
    computed = picture(number)
    cache.keep(file, cache.packed(computed))
    return computed
