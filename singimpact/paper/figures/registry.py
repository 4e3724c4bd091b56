"""Figure numbers and the functions that compute them, found when they are asked for."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from singimpact.inputs import refuse
from singimpact.paper.figures.panel import Picture

FIGURES = tuple(range(1, 18))
"""The numbers of the paper's figures."""
BEYOND_FIGURES = ("B7", "B8")
"""Those of theorems that the paper does not have."""


def _function(number: int | str) -> Callable[[], Picture]:
    from singimpact.paper.figures import contact, met, outlines, sections, swans, unfolded  # they load what computes

    functions: dict[int | str, Callable[[], Picture]] = {
        1: outlines.figure_1,
        2: outlines.figure_2,
        3: contact.figure_3,
        4: contact.figure_4,
        5: contact.figure_5,
        6: contact.figure_6,
        7: contact.figure_7,
        8: contact.figure_8,
        9: sections.figure_9,
        10: sections.figure_10,
        11: swans.figure_11,
        12: swans.figure_12,
        13: unfolded.figure_13,
        14: swans.figure_14,
        15: swans.figure_15,
        16: unfolded.figure_16,
        17: unfolded.figure_17,
        "B7": met.figure_b7,
        "B8": met.figure_b8,
    }
    return functions[number]


def picture(number: Any) -> Picture:
    """The data of one of the paper's figures, or of one beyond it.

    Raises
    ------
    InputError : neither a number from 1 to 17 nor one of `BEYOND_FIGURES`.
    """
    whole = isinstance(number, int) and not isinstance(number, bool) and number in FIGURES
    if not whole and not (isinstance(number, str) and number in BEYOND_FIGURES):
        beyond = ", ".join(BEYOND_FIGURES)
        raise refuse("figure", number, f"a number from {min(FIGURES)} to {max(FIGURES)}, or one of {beyond}")
    return _function(number)()


def figure(number: Any, *, serif: bool = False, dark: bool = False) -> Any:
    """One of the paper's figures as a matplotlib figure, at the size of a printed page.

    Parameters
    ----------
    number : from 1 to 17, or one of `BEYOND_FIGURES`. serif : letters as in a journal (STIX). dark : light lines on
        a dark ground.

    Examples
    --------
    >>> len(figure(12).axes)
    4
    """
    from singimpact.paper.figures.rendering import Look, drawn

    return drawn(picture(number), Look(serif, dark))
