"""The data of a figure before it is drawn: panels of lines, regions and letters."""

import tomllib
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.documents.rendering import environment
from singimpact.scenes.style import SHADE

ARCS = 500  # points across, for invariant arcs: half of what a panel has, less than the width of a line
Point = tuple[float, float]


@dataclass(frozen=True)
class Line:
    """A polyline.

    pen : its look. name : for the data. label : a letter set beside the vertex `at` (a share of the vertices). arrow :
    at that vertex. words : what the legend calls it, if that is not what the pen is called. beads : the vertices are an
    orbit, drawn as dots that a thin grey line joins.
    """

    points: Array
    pen: str
    name: str = ""
    label: str = ""
    at: float = 0.5
    arrow: bool = False
    words: str = ""
    beads: bool = False


@dataclass(frozen=True)
class Region:
    """A filled polygon. tone : a colour. label : set at `place`. words : in the legend."""

    points: Array
    tone: str = SHADE
    label: str = ""
    place: Point | None = None
    words: str = ""


@dataclass(frozen=True)
class Dot:
    """A named point."""

    letter: str
    place: Point


@dataclass(frozen=True)
class Panel:
    """One plane of a figure.

    box : what is shown, (x, y). lines, regions, dots : in the order of drawing. mesh : a surface in space, seen from
    the side. note : words in the middle of a panel that shows little or nothing.
    """

    box: tuple[Point, Point]
    x: str = r"$\tau$"
    y: str = "$v$"
    title: str = ""
    lines: list[Line] = field(default_factory=list)
    regions: list[Region] = field(default_factory=list)
    dots: list[Dot] = field(default_factory=list)
    mesh: tuple[Array, Array, Array] | None = None
    note: str = ""


@dataclass(frozen=True)
class Picture:
    """A figure of the paper.

    Attributes
    ----------
    number : in the paper, or B1, B2, ... beyond it. title : what it shows. claims : ids of what it illustrates.
    model : text of the oscillator. panels : with their rows and columns. facts : numbers that the figure shows, for
    tests. caption : what is seen where, in sentences with formulas between dollars. legend : where it stands in the
    last panel, as matplotlib calls places; without one it stands below the panels, or where the last row has none.
    """

    number: int | str
    title: str
    claims: tuple[str, ...]
    model: str
    panels: list[Panel]
    columns: int = 1
    facts: dict[str, float] = field(default_factory=dict)
    caption: str = ""
    legend: str = ""

    def to_dict(self) -> dict[str, Any]:
        """The data as plain lists and numbers."""
        return {
            "figure": self.number,
            "title": self.title,
            "caption": self.caption,
            "claims": list(self.claims),
            "model": self.model,
            "facts": self.facts,
            "panels": [
                {
                    "title": panel.title,
                    "axes": [panel.x, panel.y],
                    "box": panel.box,
                    "curves": [
                        {"name": line.name or line.label, "points": line.points.tolist()} for line in panel.lines
                    ],
                    "regions": [{"name": region.label, "points": region.points.tolist()} for region in panel.regions],
                    "points": {dot.letter: list(dot.place) for dot in panel.dots},
                }
                for panel in self.panels
            ],
        }


CAPTIONS = Path(__file__).with_name("captions.toml")


@cache
def _captions() -> dict[str, dict[str, Any]]:
    return tomllib.loads(CAPTIONS.read_text(encoding="utf-8"))


def picture_of(
    number: int | str, model: str, panels: list[Panel], facts: dict[str, float] | None = None, **values: str
) -> Picture:
    """A figure with its title, claims and caption from `captions.toml`.

    Parameters
    ----------
    number, model, panels, facts : as in `Picture`. values : texts that stand in its caption, beside `facts`.
    """
    words = dict(_captions()[str(number)])
    caption = environment().from_string(words.pop("caption")).render(facts=facts, **values)
    claims = tuple(words.pop("claims"))
    return Picture(
        number, claims=claims, model=model, panels=panels, facts=facts or {}, caption=" ".join(caption.split()), **words
    )


def arc(points: Array, start: Point, end: Point, avoid: Point) -> Array:
    """The stretch of a closed polyline from the vertex nearest to a point to that nearest to another.

    Parameters
    ----------
    avoid : a place on the other stretch.

    Examples
    --------
    >>> square = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]], dtype=float)
    >>> arc(square, (0, 0), (1, 1), (0, 1)).tolist()
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]
    """
    ring = points[:-1]
    scale = np.ptp(ring, axis=0)

    def nearest(place: Point) -> int:
        return int(np.argmin(np.hypot(*((ring - place) / scale).T)))

    first, last, other = nearest(start), nearest(end), nearest(avoid)
    turned = np.roll(ring, -first, axis=0)
    span, away = (last - first) % len(ring), (other - first) % len(ring)
    if away > span:
        return turned[: span + 1]
    return np.vstack([turned[span:], turned[:1]])[::-1]
