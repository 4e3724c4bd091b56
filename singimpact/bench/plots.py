"""Run time against error, a panel a case and a line a method; where there is no error, against size, or bars.

Method by colour and by marker, so that a grey copy tells them too; a hollow marker has missed an answer.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from singimpact.bench.measuring import Measured, Row
from singimpact.bench.report import in_words
from singimpact.scenes.style import BLACK, BLUE, DASH_DOT, DASHES, DOTS, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION

COLORS = (BLUE, VERMILLION, GREEN, PURPLE, BLACK, ORANGE, SKY, GREY)
MARKERS = "osD^vP*X"
STYLES = ("solid", DASHES, DASH_DOT, DOTS)


@dataclass(frozen=True)
class Sheet:
    """Sizes of a page of panels.

    Parameters
    ----------
    width, height : inches of a panel. columns : panels side by side. bar : inches of a bar.
    least : ratio of the ends of an axis of errors, at least.
    floor : where an error of zero is drawn, unless others are smaller still.
    """

    width: float = 4.6
    height: float = 3.5
    columns: int = 2
    bar: float = 0.34
    least: float = 1e3
    floor: float = 1e-17


SHEET = Sheet()


def plotted(measured: Measured) -> Any:
    """The matplotlib figure of a group."""
    from matplotlib.figure import Figure

    panels = {
        case: [row for row in measured.rows if row.case == case]
        for case in dict.fromkeys(r.case for r in measured.rows)
    }
    drawn = {case: rows for case, rows in panels.items() if _axis(rows) != "none"}
    bars = [row for rows in panels.values() if _axis(rows) == "none" for row in rows]
    names = list(dict.fromkeys(row.method for rows in drawn.values() for row in rows))
    rows = -(-len(drawn) // SHEET.columns)
    columns = min(SHEET.columns, max(len(drawn), 1))
    heights = [SHEET.height] * rows + ([SHEET.bar * len(bars) + 1] if bars else [])
    figure = Figure(figsize=(SHEET.width * max(columns, 1 + bool(bars)), sum(heights) + 0.6), layout="constrained")
    places = figure.add_gridspec(len(heights), columns, height_ratios=heights)
    for at, (case, part) in enumerate(drawn.items()):
        _panel(figure.add_subplot(places[at // columns, at % columns]), case, part, names)
    if bars:
        _bars(figure.add_subplot(places[len(heights) - 1, :]), bars)
    if names:
        _legend(figure, names)
    return figure


def _axis(rows: Sequence[Row]) -> str:
    """The quantity on the horizontal axis of a case."""
    if any(row.error is not None for row in rows):
        return "error"
    return "size" if len({row.size for row in rows} - {None}) > 1 else "none"


def _look(names: Sequence[str], name: str) -> dict[str, Any]:
    at = names.index(name)
    return {
        "color": COLORS[at % len(COLORS)],
        "marker": MARKERS[at % len(MARKERS)],
        "linestyle": STYLES[at % len(STYLES)],
        "linewidth": 1.2,
        "markersize": 6,
    }


def _panel(axes: Any, case: str, rows: Sequence[Row], names: Sequence[str]) -> None:
    kind, floor = _axis(rows), min([SHEET.floor, *(row.error for row in rows if row.error)])
    for name in dict.fromkeys(row.method for row in rows):
        line = [row for row in rows if row.method == name and (kind == "size" or row.error is not None)]
        if kind == "error":
            line.sort(key=lambda row: (row.error, row.microseconds))
        across = [row.error or floor if kind == "error" else float(row.size or 0) for row in line]
        look = _look(names, name)
        axes.loglog(across, [row.microseconds for row in line], **look)
        hollow = [(x, row.microseconds) for x, row in zip(across, line, strict=True) if row.missed]
        if hollow:
            axes.loglog(*zip(*hollow, strict=True), **{**look, "linestyle": "none", "markerfacecolor": "white"})
    if kind == "error":
        _widened(axes)
    axes.set_title(case, fontsize=10)
    axes.set_xlabel("relative error" if kind == "error" else "size", fontsize=9)
    axes.set_ylabel("microseconds of CPU", fontsize=9)
    axes.tick_params(which="both", labelsize=7)
    axes.grid(True, which="major", color="0.9", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def _widened(axes: Any) -> None:
    """Show three decades at least: fewer are hard to read, and labels between powers of ten would overlap."""
    from matplotlib.ticker import NullFormatter

    low, high = axes.get_xlim()
    if high < SHEET.least * low:
        middle = (low * high) ** 0.5
        axes.set_xlim(middle / SHEET.least**0.5, middle * SHEET.least**0.5)
    axes.xaxis.set_minor_formatter(NullFormatter())


def _bars(axes: Any, rows: Sequence[Row]) -> None:
    """A bar a row, its name above it and its time beside it: names are too long for an axis."""
    several = len({row.case for row in rows}) > 1
    seconds, places = [row.microseconds / 1e6 for row in rows], range(len(rows))
    axes.barh(places, seconds, height=0.4, color=SKY, edgecolor=BLACK, linewidth=0.6)
    axes.set_xscale("log")
    least = min(seconds) / 2
    axes.set_xlim(least, 3 * max(seconds))  # room for the time beside the longest
    for height, row in zip(places, rows, strict=True):
        parts = ([row.case] if several else []) + [row.method, row.setting]
        axes.text(1.02 * least, height - 0.25, ", ".join(filter(None, parts)), fontsize=7, va="bottom")
        axes.text(1.05 * row.microseconds / 1e6, height, in_words(row.microseconds), fontsize=7, va="center")
    axes.set_ylim(len(rows) - 0.4, -0.8)
    axes.set_yticks([])
    axes.set_xlabel("seconds of CPU, or of wall time where it says so", fontsize=9)
    axes.tick_params(which="both", labelsize=8)
    axes.spines[["top", "right"]].set_visible(False)


def _legend(figure: Any, names: Sequence[str]) -> None:
    from matplotlib.lines import Line2D

    keys = [Line2D([], [], label=name, **_look(names, name)) for name in names]
    keys.append(
        Line2D(
            [], [], label="hollow: missed an answer", color=BLACK, marker="o", linestyle="none", markerfacecolor="white"
        )
    )
    figure.legend(handles=keys, loc="outside lower center", ncols=2, fontsize=8, frameon=False)
