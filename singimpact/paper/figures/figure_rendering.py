"""Pictures drawn by matplotlib at the size of a printed page: letters clear of curves, a legend in words below."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.paper.figures.panel import Line, Panel, Picture
from singimpact.scenes import BLACK, GREY, HATCH, PENS, SURFACE, WHITE, darken, on_dark, place_labels


@dataclass(frozen=True)
class PrintSettings:
    """Sizes on paper."""

    width: float = 6.9  # inches of several panels beside each other: the text of a journal's page
    single: float = 4.8  # inches of one panel
    ratio: float = 0.76  # height of a panel over its width
    small_ratio: float = 1.0  # the same of panels that are narrower than 2 inches
    type: float = 8.0  # points, of all letters but those along the axes
    title: float = 9.0  # points, of the title of a figure beyond the paper
    small: float = 7.0  # points, of the numbers along the axes and the legend
    line: float = 0.68  # of the pens' widths, which are made for pictures of 8 inches on a screen
    dot: float = 3.2  # points, the diameter of a named point
    edge: float = 0.03  # of a panel: an arrow nearer to its edge than this would be cut
    letter: float = 3.7  # points, the mean width of a letter of the legend


PRINT = PrintSettings()
NOTHING: dict[str, Any] = {"frame_on": False, "xticks": (), "yticks": ()}  # of axes that hold a legend alone


@contextmanager
def _settings(serif: bool, dark: bool) -> Iterator[None]:
    """matplotlib's own settings, while a figure is drawn; colours are made those of a dark ground at the end."""
    import matplotlib

    ink, ground, grid = (on_dark(color) if dark else color for color in (BLACK, WHITE, HATCH))
    chosen: dict[str, Any] = {
        "font.size": PRINT.type,
        "axes.titlesize": PRINT.type,
        "axes.labelsize": PRINT.type,
        "figure.titlesize": PRINT.title,
        "xtick.labelsize": PRINT.small,
        "ytick.labelsize": PRINT.small,
        "legend.fontsize": PRINT.small,
        "legend.frameon": False,
        "legend.handlelength": 3,
        "axes.linewidth": 0.6,
        "axes.edgecolor": ink,
        "xtick.major.width": 0.6,
        "ytick.major.width": 0.6,
        "grid.linewidth": 0.5,
        "grid.color": grid,
        **dict.fromkeys((f"axes3d.{axis}axis.panecolor" for axis in "xyz"), ground),
    }
    if serif:
        chosen |= {"font.family": "STIXGeneral", "mathtext.fontset": "stix"}
    with matplotlib.rc_context(cast(Any, chosen)):
        yield


def _halo() -> list[Any]:
    from matplotlib import patheffects

    return [patheffects.withStroke(linewidth=2, foreground=WHITE)]


def drawn(picture: Picture, serif: bool = False, dark: bool = False) -> Any:
    """The matplotlib figure of a picture, at the size at which it is printed.

    Parameters
    ----------
    serif : letters as in a journal (STIX). dark : light lines on a dark ground.
    """
    from matplotlib.figure import Figure

    columns = min(picture.columns, len(picture.panels))
    rows = -(-len(picture.panels) // columns)
    width = PRINT.single if columns == 1 else PRINT.width
    entries = _entries(picture)
    across = _columns(list(entries), width)
    beyond = isinstance(picture.number, str)  # a figure without a caption in the paper
    below = not picture.legend and len(picture.panels) == rows * columns
    more = (0.17 * -(-len(entries) // across) + 0.1) * below + 0.25 * beyond  # inches of the legend and the title
    ratio = PRINT.ratio if width / columns > 2 else PRINT.small_ratio
    with _settings(serif, dark):
        figure = Figure(figsize=(width, ratio * width / columns * rows + more), dpi=200, layout="constrained")
        flat = []
        for n, panel in enumerate(picture.panels):
            if panel.mesh is not None:
                _solid(figure.add_subplot(rows, columns, n + 1, projection="3d"), panel)
            else:
                flat.append((figure.add_subplot(rows, columns, n + 1), panel))
                _flat(*flat[-1])
        if beyond:
            figure.suptitle(picture.title)
        if below:
            figure.legend(entries.values(), list(entries), loc="outside lower center", ncols=across, columnspacing=1.5)
        else:  # in the panel, or where the last row has none
            free: Any = flat[-1][0] if picture.legend else figure.add_subplot(rows, columns, rows * columns, **NOTHING)
            free.legend(entries.values(), list(entries), loc=picture.legend or "center")
        figure.draw_without_rendering()
        figure.set_layout_engine("none")  # the letters are placed for this layout, and the numbers of the axes are made
        for axes, panel in flat:
            _letters(axes, panel)
    if dark:
        darken(figure)
    return figure


def legend_words(picture: Picture) -> list[str]:
    """The entries of the legend of a picture, in the order of its lines."""
    return list(_entries(picture))


def _entries(picture: Picture) -> dict[str, Any]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    entries: dict[str, Any] = {}
    for panel in picture.panels:
        for line in panel.lines:
            entries.setdefault(line.words or PENS[line.pen].words, Line2D([], [], **_stroke(line)))
        for region in panel.regions:
            entries.setdefault(region.words, Patch(facecolor=region.tone))
    entries.pop("", None)
    return entries


def _columns(entries: list[str], width: float) -> int:
    """The number of columns of a legend that fit into a width in inches."""
    longest = max((len(re.sub(r"\\[a-z]+|[${}^]", "", words)) for words in entries), default=1)
    return int(np.clip(72 * width / (PRINT.letter * longest + 45), 1, max(len(entries), 1)))


def _stroke(line: Line) -> dict[str, Any]:
    if not line.beads:
        look = PENS[line.pen].line()
        return look | {"linewidth": PRINT.line * look["linewidth"]}
    joined = "solid" if len(line.points) > 1 else "none"
    return PENS[line.pen].beads() | {"linestyle": joined, "markersize": PRINT.dot}


def _flat(axes: Any, panel: Panel) -> None:
    (left, right), (low, high) = panel.box
    for region in panel.regions:
        axes.fill(*region.points.T, facecolor=region.tone, edgecolor="none", linewidth=0, zorder=1)
    if low <= 0 <= high:
        axes.axhline(0, color=GREY, linewidth=0.6, zorder=1.5)
    axes.set(xlim=(left, right), ylim=(low, high), title=panel.title, xlabel=panel.x, ylabel=panel.y)
    for line in panel.lines:
        axes.plot(*line.points.T, **_stroke(line), zorder=3)
        if line.arrow:
            _arrow(axes, line, panel)
    for dot in panel.dots:
        axes.plot(*dot.place, "o", color=BLACK, markersize=PRINT.dot, zorder=10, clip_on=False)
    axes.spines[["top", "right"]].set_visible(False)
    axes.locator_params(nbins=5 if axes.bbox.width > 150 * axes.figure.dpi / 72 else 4)


def _arrow(axes: Any, line: Line, panel: Panel) -> None:
    """An arrowhead, where it is not cut by the edge."""
    place, back = _place(line.points, line.at), _place(line.points, line.at - 1e-3)
    sides = [(low + PRINT.edge * (high - low), high - PRINT.edge * (high - low)) for low, high in panel.box]
    if all(low < x < high for (low, high), x in zip(sides, place, strict=True)):
        style = {"arrowstyle": "-|>", "color": PENS[line.pen].color, "linewidth": 0.8, "mutation_scale": 8}
        axes.annotate("", place, back, arrowprops=style, zorder=7, annotation_clip=True)


def _letters(axes: Any, panel: Panel) -> None:
    """Names of regions where they were put, those of points and curves clear of what is drawn."""
    for region in panel.regions:
        if region.label:
            position = region.place if region.place is not None else tuple(region.points.mean(axis=0))
            axes.text(*position, region.label, ha="center", va="center", path_effects=_halo(), zorder=8)
    if panel.note:
        axes.text(0.5, 0.62, panel.note, transform=axes.transAxes, ha="center", color=GREY)
    named = [(*dot.place, dot.letter) for dot in panel.dots if dot.letter]
    lettered = {line.label: line for line in panel.lines if line.label}
    named += [(*_place(line.points, line.at), label) for label, line in lettered.items()]
    for text in place_labels(axes, named, size=PRINT.type).written:
        line = lettered.get(text.get_text())
        text.set(color=PENS[line.pen].color if line else BLACK, path_effects=_halo(), zorder=9)


def _place(points: Array, share: float) -> tuple[float, float]:
    """A place on a polyline, by a share of its vertices."""
    at = np.clip(share, 0, 1) * (len(points) - 1)
    x, y = (float(np.interp(at, np.arange(len(points)), column)) for column in points.T)
    return x, y


def _solid(axes: Any, panel: Panel) -> None:
    """A surface in (tau, v, t), lines on it as polylines in space."""
    assert panel.mesh is not None
    axes.plot_surface(
        *panel.mesh, color=SURFACE, alpha=0.5, linewidth=0.2, edgecolor=GREY, shade=False, rstride=3, cstride=3
    )
    for line in panel.lines:
        axes.plot(*line.points.T, **_stroke(line), zorder=10)
        if line.label:
            position = line.points[int(line.at * (len(line.points) - 1))]
            axes.text(*position, f"  {line.label}", va="center", path_effects=_halo(), zorder=20)
    axes.set(xlim=panel.box[0], ylim=panel.box[1], xlabel=panel.x, ylabel=panel.y, zlabel="$t$")
    axes.locator_params(nbins=4)
    axes.view_init(elev=22, azim=-22)
    axes.set_box_aspect(None, zoom=1.15)
