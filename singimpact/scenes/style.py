"""Styles of curves: Okabe and Ito's colours, and line styles and widths that tell them apart without colour."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.branches.events import KINDS

BLUE, VERMILLION, GREEN, PURPLE, SKY, ORANGE = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"
YELLOW, SURFACE = "#F0E442", "#BBD9EE"
BLACK, GREY, HATCH, SHADE, WALL, WHITE = "#000000", "#6E6E6E", "#BFBFBF", "#E3E3E3", "#EBEBEB", "#FFFFFF"
OPEN: dict[str, Any] = {"color": BLACK, "markerfacecolor": WHITE}  # a marker
DASHES, DOTS, DASH_DOT, SHORT_DASHES = (0, (5, 2)), (0, (1, 1.4)), (0, (6, 2, 1, 2)), (0, (2.6, 1.2))


# Classes of states that settle on no periodic orbit.
CLASSES = {
    "not decided": "#F2F2F2",
    "sensitive": "#E6E6E6",
    "unresolved": "#FAFAFA",
    "never returns": WHITE,
    "no impact": WHITE,
    "chaotic": "#C9C9C9",
    "continuum": "#D9D9D9",
    "rest": BLACK,
}
CHATTERED = (BLACK, "#3D3D3D", "#6B6B6B")  # chatter for ever, of one lift-off or another
CLASS_ORBITS = (ORANGE, BLUE, SKY, VERMILLION, GREEN, PURPLE, YELLOW, "#8C8C8C")  # neighbours differ in lightness
# on a dark ground: colours that are too dark or too light there; the others are visible on both grounds
ON_DARK = {BLUE: "#4DA6DE", SURFACE: "#2F5D7C"}
# white and black there, as red, green and blue: not grey, so that no colour is replaced twice
DARK_GROUND, DARK_INK = (0x14, 0x18, 0x1C), (0xF2, 0xF4, 0xF6)


def on_dark(color: str) -> str:
    """A colour as it is drawn on a dark ground: greys change places, light ones with dark ones.

    Examples
    --------
    >>> on_dark(BLACK), on_dark(WHITE), on_dark(ORANGE) == ORANGE
    ('#F2F4F6', '#14181C', True)
    """
    red, green, blue = (int(color[at : at + 2], 16) / 255 for at in (1, 3, 5))
    if not red == green == blue:
        return ON_DARK.get(color, color)
    mixed = (round(ink + red * (ground - ink)) for ground, ink in zip(DARK_GROUND, DARK_INK, strict=True))
    return "#" + "".join(f"{light:02X}" for light in mixed)


def darken(figure: Any) -> None:
    """Replace the colours of a figure that is drawn by those of a dark ground."""
    from matplotlib.patheffects import withStroke
    from matplotlib.text import Annotation

    arrows = [text.arrow_patch for text in figure.findobj(Annotation) if text.arrow_patch is not None]
    for artist in [*figure.findobj(), *arrows]:
        for name in ("color", "facecolor", "edgecolor", "markerfacecolor", "markeredgecolor"):
            if hasattr(artist, f"get_{name}") and hasattr(artist, f"set_{name}"):
                colors = _replaced(getattr(artist, f"get_{name}")())
                artist.set(**{name: colors[0] if len(colors) == 1 else colors} if colors else {})
        if artist.get_path_effects():
            artist.set_path_effects([withStroke(linewidth=3, foreground=on_dark(WHITE))])
    for axes in figure.axes:
        axes.tick_params(which="both", colors=on_dark(BLACK))  # also of the ticks that are made later
        for image in axes.images:
            pixels = np.asarray(image.get_array())
            classes, at = np.unique(pixels.reshape(-1, pixels.shape[-1]), axis=0, return_inverse=True)
            image.set_data(np.array(_replaced(classes))[at.ravel()].reshape(*pixels.shape[:2], 4))


def _replaced(colors: Any) -> list[tuple[float, ...]]:
    """Colours on a dark ground, as red, green, blue and opacity."""
    from matplotlib.colors import to_hex, to_rgb, to_rgba_array

    return [(*to_rgb(on_dark(to_hex(color).upper())), float(color[3])) for color in to_rgba_array(colors)]


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


# Curves of scenes, figures and notebooks: one look and one name wherever they are drawn.
PENS = {
    "H": Pen(BLUE, width=2.0, words="horizon $H$"),
    "Z": Pen(VERMILLION, DASHES, 1.8, "zero set $Z$"),
    "P": Pen(BLACK, width=1.2, words="apparent outline $P$"),
    "jump": Pen(BLACK, width=2.8, words="discontinuities of $G$: visible part of $P$"),
    "rest": Pen(GREY, width=3.6, words=r"$\Pi_0$: velocity $v = 0$"),
    "shadow": Pen(GREEN, DOTS, 3.4, "shadow of $H$"),
    "cut": Pen(ORANGE, DASH_DOT, 2.2, "cut: the flight grazes the other wall"),
    "beyond": Pen(GREY, DOTS, 1.0, "beyond the cut: the flight meets the other wall"),
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
    "(1, 1) orbits, stable": Pen(BLUE, width=2.0, words="(1, 1) orbits, stable"),
    "(1, 1) orbits, unstable": Pen(BLUE, DASHES, 1.4, words="(1, 1) orbits, unstable"),
    "(1, 2) orbits, stable": Pen(VERMILLION, width=2.0, words="(1, 2) orbits, stable"),
    "(1, 2) orbits, unstable": Pen(VERMILLION, DASHES, 1.4, words="(1, 2) orbits, unstable"),
    "(2, 2) orbits, stable": Pen(GREEN, width=2.0, words="(2, 2) orbits, stable"),
    "(2, 2) orbits, unstable": Pen(GREEN, DASHES, 1.4, words="(2, 2) orbits, unstable"),
}


# Line style and width of a branch of periodic orbits; its colour says how many impacts in how many periods.
LINES: dict[str, tuple[Any, float]] = {"stable": ("solid", 1.8), "unstable": (DASHES, 1.5), "virtual": (DOTS, 1.3)}
ORBIT_COLORS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY)
# Times the width of a line: two colours of about the same grey have widths that differ.
ORBIT_WIDTHS = (1.0, 1.7, 0.7, 1.0, 0.7, 1.35)
# The label of an axis, for each number of a model.
LETTERS = {"clearance": "clearance $c$", "restitution": "restitution $r$"}
MARKS = {kind.name: kind.marker for kind in KINDS}  # markers of the events of a branch
COLORS = {"blue": BLUE, "vermillion": VERMILLION, "green": GREEN, "black": BLACK, "purple": PURPLE}
# Names that kinds of events have for the colours and line styles of their curves.
STYLES = {"solid": "solid", "dashes": DASHES, "dash-dot": DASH_DOT}
# Curves of events in two numbers, where their orbits are visible; virtual parts are dotted.
EVENT_PENS = {
    kind.name: Pen(COLORS[kind.look.color], STYLES[kind.look.style], kind.look.width)
    for kind in KINDS
    if kind.look is not None
}


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


def new_axes(width: float, height: float, dpi: int = 150) -> Any:
    """Axes of a figure of so many inches that no window shows."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=dpi, layout="constrained").add_subplot()
