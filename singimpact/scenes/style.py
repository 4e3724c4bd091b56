"""Styles of curves: Okabe and Ito's colours, and line styles and widths that tell them apart without colour."""

from dataclasses import dataclass
from typing import Any

from singimpact.branches.events import KINDS

BLUE, VERMILLION, GREEN, PURPLE, SKY, ORANGE = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"
BLACK, GREY, SHADE, WHITE = "#000000", "#6E6E6E", "#E3E3E3", "#FFFFFF"
OPEN = {"color": BLACK, "markerfacecolor": WHITE}
"""The look of an open marker."""
DASHES, DOTS, DASH_DOT, SHORT_DASHES = (0, (5, 2)), (0, (1, 1.4)), (0, (6, 2, 1, 2)), (0, (2.6, 1.2))


ON_DARK = {BLACK: "#FFFFFF", GREY: "#A6A6A6", BLUE: "#4DA6DE", SHADE: "#3C3C3C"}
"""Replacements on a dark ground for the darkest and the lightest colours; the others are visible on both grounds."""


def on_dark(color: str) -> str:
    """A colour of this table as it is drawn on a dark ground.

    Examples
    --------
    >>> on_dark(BLACK), on_dark(ORANGE) == ORANGE
    ('#FFFFFF', True)
    """
    return ON_DARK.get(color, color)


@dataclass(frozen=True)
class Pen:
    """Colour, line style and width of a kind of curve, and what a legend calls it (empty: it is not named)."""

    color: str
    style: Any = "solid"
    width: float = 1.4
    words: str = ""

    def line(self) -> dict[str, Any]:
        """The arguments of matplotlib."""
        return {"color": self.color, "linestyle": self.style, "linewidth": self.width}

    def beads(self) -> dict[str, Any]:
        """The arguments of matplotlib for an orbit: dots in this colour, joined in their order by a thin grey line."""
        return {
            "color": GREY,
            "linewidth": 0.6,
            "marker": "o",
            "markersize": 3.5,
            "markerfacecolor": self.color,
            "markeredgecolor": self.color,
        }


PENS = {
    "H": Pen(BLUE, width=2.0, words="horizon $H$"),
    "Z": Pen(VERMILLION, DASHES, 1.8, "zero set $Z$"),
    "P": Pen(BLACK, width=1.2, words="apparent outline $P$"),
    "jump": Pen(BLACK, width=2.8, words="discontinuities of $G$: visible part of $P$"),
    "rest": Pen(GREY, width=3.6, words=r"$\Pi_0$: velocity $v = 0$"),
    "shadow": Pen(GREEN, DOTS, 3.4, "shadow of $H$"),
    "gamma": Pen(PURPLE, width=2.8, words=r"$\gamma$: threshold of complete chatter"),
    "manifold": Pen(SKY, width=1.0, words=r"stable manifolds $W^s_\tau$"),
    "loop": Pen(BLUE, DASH_DOT, 1.6, "one stable manifold"),
    "preimage": Pen(GREEN, SHORT_DASHES, 1.6, r"preimages of the discontinuity"),
    "epsilon": Pen(VERMILLION, width=2.2, words=r"$\varepsilon$: image of an interval of $\Pi_0$"),
    "orbit": Pen(ORANGE, width=1.0, words="impacts of an orbit, joined in their order"),
    "axis": Pen(GREY, width=0.8),
    "hidden": Pen(GREY, DASHES, 0.9, "edge of the part that is shown"),
    "graph": Pen(BLUE, width=2.6, words="graph"),
    "W^s": Pen(BLUE, width=1.0, words="stable manifold"),
    "W^u": Pen(VERMILLION, DASHES, 1.0, "unstable manifold"),
    "crossing": Pen(BLACK, words="crossing"),
    "certified": Pen(GREEN, words="certified orbit"),
    "before": Pen(GREY, DASHES, 1.4, "before"),
    "at": Pen(BLACK, DASH_DOT, 1.4, "at the transition"),
}
"""Curves of scenes, figures and notebooks: one look and one name wherever they are drawn."""


LINES: dict[str, tuple[Any, float]] = {"stable": ("solid", 1.8), "unstable": (DASHES, 1.5), "virtual": (DOTS, 1.3)}
"""Line style and width of a branch of periodic orbits; its colour says how many impacts in how many periods."""
ORBIT_COLORS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
ORBIT_WIDTHS = (1.0, 1.7, 0.7, 1.0, 0.7, 1.35)
"""Times the width of a line: two colours of about the same grey have widths that differ."""
LETTERS = {"clearance": "clearance $c$", "restitution": "restitution $r$"}
"""The label of an axis, for each number of a model."""
MARKS = {kind.name: kind.marker for kind in KINDS}
"""Markers of the events of a branch."""
COLORS = {"blue": BLUE, "vermillion": VERMILLION, "green": GREEN, "black": BLACK}
STYLES = {"solid": "solid", "dashes": DASHES, "dash-dot": DASH_DOT}
"""Names that kinds of events have for the colours and line styles of their curves."""
EVENT_PENS = {
    kind.name: Pen(COLORS[kind.look.color], STYLES[kind.look.style], kind.look.width)
    for kind in KINDS
    if kind.look is not None
}
"""Curves of events in two numbers, where their orbits are visible; virtual parts are dotted."""


def orbit_color(n: int, k: int) -> str:
    """The colour of orbits of n impacts in k periods, the same in every picture.

    Examples
    --------
    >>> orbit_color(1, 1) == BLUE, orbit_color(0, 1) == GREY
    (True, True)
    """
    return ORBIT_COLORS[_looks(n, k)] if n else GREY


def orbit_width(n: int, k: int) -> float:
    """Times the width of the line of a branch of such orbits.

    Examples
    --------
    >>> orbit_width(1, 1), orbit_width(1, 2)
    (1.0, 1.7)
    """
    return ORBIT_WIDTHS[_looks(n, k)] if n else 1.0


def _looks(n: int, k: int) -> int:
    return (4 * (n - 1) + k - 1) % len(ORBIT_COLORS)
