"""Where a claim stands in the paper: page, equation, theorem and line, for a reader with the paper beside him."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path

PAPER = "D. R. J. Chillingworth, Dynamics of an impact oscillator near a degenerate graze"
VERSION = (
    "Preprint submitted to Nonlinearity. Numbers of equations and theorems are those of its LaTeX source; pages are "
    "those of the source set in the class article at 12 pt (24 pages), and may differ by one or two in print."
)


@dataclass(frozen=True)
class Place:
    """Where a claim stands in the paper.

    Attributes
    ----------
    page : of the preprint, see `VERSION`. line : of its LaTeX source. equations : the numbers of the displayed
        equations that hold the claim, empty where it stands in the text. statement : such as "Theorem 4.1", or "".
    """

    page: int
    line: int
    equations: tuple[int, ...]
    statement: str

    def __str__(self) -> str:
        return ", ".join(part for part in (f"p. {self.page}", self.statement, self.numbers) if part)

    @property
    def numbers(self) -> str:
        """The numbers of the equations, as they are printed.

        Examples
        --------
        >>> place_of("s4-blowup").numbers, str(place_of("t:t2-fixed"))
        ('(24), (25)', 'p. 11, Theorem 4.1')
        """
        return ", ".join(f"({number})" for number in self.equations)


@cache
def _places() -> dict[str, Place]:
    lines = json.loads(Path(__file__).with_name("places.json").read_text(encoding="utf-8"))
    return {
        line["id"]: Place(line["page"], line["line"], tuple(line["equations"]), line["statement"]) for line in lines
    }


def place_of(claim: str) -> Place:
    """The place of a claim of the paper, by its id.

    Raises
    ------
    KeyError : a claim that the paper does not have.
    """
    return _places()[claim]
