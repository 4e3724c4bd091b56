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
    "W^s": Pen(BLUE, width=1.0),
    "W^u": Pen(VERMILLION, width=1.0),
    "crossing": Pen(BLACK),
    "before": Pen(GREY, DASHES, 1.4),
    "at": Pen(GREY, DASH_DOT, 1.4),
}


LINES: dict[str, tuple[Any, float]] = {"stable": ("solid", 1.8), "unstable": (DASHES, 1.5), "virtual": (DOTS, 1.3)}
"""Line style and width of a branch of periodic orbits; its colour says how many impacts in how many periods."""
ORBIT_COLORS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
LETTERS = {"clearance": "clearance $c$", "restitution": "restitution $r$"}
"""What an axis of a number of the model is called."""
MARKS = {
    "fold": "o",
    "period-doubling": "s",
    "torus": "D",
    "graze": "^",
    "hidden impact": "v",
}
"""Markers of the events of a branch."""
EVENT_PENS = {
    "fold": Pen(BLUE, width=1.8),
    "period-doubling": Pen(VERMILLION, DASHES, 1.8),
    "graze": Pen(BLACK, width=1.4),
    "hidden impact": Pen(GREEN, DASH_DOT, 1.6),
}
"""Curves of events in two numbers, where their orbits are visible; virtual parts are dotted."""


def orbit_color(n: int, k: int) -> str:
    """The colour of orbits of n impacts in k periods, the same in every picture.

    Examples
    --------
    >>> orbit_color(1, 1) == BLUE, orbit_color(0, 1) == GREY
    (True, True)
    """
    return ORBIT_COLORS[(4 * (n - 1) + k - 1) % len(ORBIT_COLORS)] if n else GREY
