"""How curves look: Okabe and Ito's colours, and line styles and widths that tell them apart without colour."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

BLUE, VERMILLION, GREEN, PURPLE, SKY, ORANGE = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"
BLACK, GREY, SHADE = "#000000", "#6E6E6E", "#E3E3E3"
DASHES, DOTS, DASH_DOT = (0, (5, 2)), (0, (1, 1.4)), (0, (6, 2, 1, 2))
INK = 0.85  # of a letter's halo, so that a curve behind it does not cut it


@dataclass(frozen=True)
class Pen:
    """Colour, line style and width of a kind of curve."""

    color: str
    style: Any = "solid"
    width: float = 1.4

    def line(self) -> dict[str, Any]:
        """The arguments of matplotlib."""
        return {"color": self.color, "linestyle": self.style, "linewidth": self.width}


PENS = {
    "H": Pen(BLUE, width=2.0),
    "Z": Pen(VERMILLION, DASHES, 1.8),
    "P": Pen(BLACK, width=1.2),
    "jump": Pen(BLACK, width=2.8),
    "shadow": Pen(GREEN, DOTS, 2.4),
    "gamma": Pen(PURPLE, width=2.8),
    "manifold": Pen(SKY, width=1.0),
    "loop": Pen(BLUE, DASH_DOT, 1.6),
    "epsilon": Pen(VERMILLION, width=2.2),
    "orbit": Pen(ORANGE, DASH_DOT, 1.0),
    "axis": Pen(GREY, width=0.8),
    "hidden": Pen(GREY, DASHES, 0.9),
    "graph": Pen(BLUE, width=1.8),
    "before": Pen(GREY, DASHES, 1.4),
    "at": Pen(GREY, DASH_DOT, 1.4),
}
