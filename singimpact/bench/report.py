"""Measurements as tables, plain data and plots."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import NullFormatter

from singimpact.bench.measuring import Measured, Row
from singimpact.scenes.style import BLACK, DASH_DOT, DASHES, DOTS, GREY, OPEN, ORBIT_COLORS, SHADE, SKY, WHITE

HEADER = ("case", "method", "setting", "time", "to reach", "error", "wrong", "missed", "times the first", "quartiles")
GROWING = ("regions", "ensemble", "fit")  # groups whose cases are measured at several numbers of one kind of problem
Table = tuple[tuple[str, ...], list[list[str]]]

NOTE = (
    "CPU time of one problem, median of the rounds; error relative, median of the problems; wrong: off by more than ten"
    " times condition times epsilon, or no answer; missed: of these, off by more than 1 %."
)
AIMED = (
    "To reach: a time at most, with no answer wrong; reached or missed as measured"
    " here, on this machine and under its load."
)


def table(measured: Measured) -> Table:
    """Header and cells, a line a row."""
    return HEADER, [_cells(row) for row in measured.rows]


def in_words(microseconds: float) -> str:
    """A time with its unit, in three digits.

    Examples
    --------
    >>> in_words(0.4912), in_words(1291.6), in_words(42183319.0)
    ('0.491 us', '1.29 ms', '42.2 s')
    """
    factor, unit = (1, "us") if microseconds < 999.5 else (1e3, "ms") if microseconds < 999.5e3 else (1e6, "s")
    value = microseconds / factor
    return f"{value:.3g} {unit}" if value < 999.5 else f"{value:.0f} {unit}"


def _cells(row: Row) -> list[str]:
    judged = row.wrong is not None
    return [
        row.case,
        row.method,
        row.setting,
        in_words(row.microseconds),
        _aim(row),
        "" if row.error is None else f"{row.error:.1e}",
        f"{row.wrong}/{row.of}" if judged else "",
        f"{row.missed}/{row.of}" if judged else "",
        f"{row.ratio:.3g}",
        f"{row.spread[0]:.3g} to {row.spread[1]:.3g}",
    ]


def _aim(row: Row) -> str:
    """The figure to reach, and whether it is reached."""
    if row.reached is None:
        return ""
    return f"{in_words(row.aim.microseconds or 0)}: {'reached' if row.reached else 'missed'}"


def reached(found: Measured) -> str:
    """The number of aims that are reached, and the rows that miss theirs; empty without aims."""
    aimed = [row for row in found.rows if row.reached is not None]
    if not aimed:
        return ""
    count = sum(bool(row.reached) for row in aimed)
    short = [f"missed: {row.case}, {row.method}, {row.setting}" for row in aimed if not row.reached]
    return "\n".join([f"{AIMED} {count} of {len(aimed)} are reached.", *short])


def growth(found: Measured) -> list[tuple[str, str, float]]:
    """Case, method and the power of the number of its problems like which its whole time grows, by least squares."""
    powers = []
    for name in dict.fromkeys((row.case, row.method) for row in found.rows):
        sizes, times = np.log(
            [(row.problems, row.microseconds) for row in found.rows if (row.case, row.method) == name]
        ).T
        if found.group in GROWING and np.ptp(sizes) > 0:
            powers.append((*name, float(np.polyfit(sizes, sizes + times, 1)[0])))
    return powers


def skipped(found: Measured) -> str:
    """One line a peer that is not installed."""
    return "\n".join(f"{found.group}: {name} is not installed, skipped" for name in found.skipped)


def as_data(found: Measured) -> dict[str, list[Any]]:
    """Rows, what was skipped and how times grow, as JSON takes them."""
    powers = [dict(zip(("case", "method", "power"), each, strict=True)) for each in growth(found)]
    return {"rows": [asdict(row) for row in found.rows], "skipped": list(found.skipped), "growth": powers}


# Run time against error, a panel a case and a line a method; bars where there is no error. Method by
# colour and by marker, so that a grey copy tells them too; a hollow marker has missed an answer.

COLORS = (*ORBIT_COLORS, BLACK, GREY)
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

    width: float = 3.9
    height: float = 3.0
    columns: int = 3
    bar: float = 0.34
    least: float = 1e3
    floor: float = 1e-17


SHEET = Sheet()


def plotted(measured: Measured) -> Figure:
    """The matplotlib figure of a group."""
    panels = {
        case: [row for row in measured.rows if row.case == case]
        for case in dict.fromkeys(r.case for r in measured.rows)
    }
    drawn = {case: rows for case, rows in panels.items() if any(row.error is not None for row in rows)}
    bars = [row for case, rows in panels.items() if case not in drawn for row in rows]
    names = list(dict.fromkeys(row.method for rows in drawn.values() for row in rows))
    rows = -(-len(drawn) // SHEET.columns)
    columns = min(SHEET.columns, max(len(drawn), 1))
    heights = [SHEET.height] * rows + ([SHEET.bar * len(bars) + 1] if bars else [])
    figure = Figure(figsize=(SHEET.width * max(columns, 1 + bool(bars)), sum(heights) + 0.6), layout="constrained")
    places = figure.add_gridspec(len(heights), columns, height_ratios=heights)
    for at, (case, panel) in enumerate(drawn.items()):
        _panel(figure.add_subplot(places[at // columns, at % columns]), case, panel, names)
    if bars:
        _bars(figure.add_subplot(places[len(heights) - 1, :]), bars)
    if names:
        _legend(figure, names)
    return figure


def _look(names: Sequence[str], name: str) -> dict[str, Any]:
    at = names.index(name)
    return {
        "color": COLORS[at % len(COLORS)],
        "marker": MARKERS[at % len(MARKERS)],
        "linestyle": STYLES[at % len(STYLES)],
        "linewidth": 1.2,
        "markersize": 6,
    }


def _panel(axes: Axes, case: str, rows: Sequence[Row], names: Sequence[str]) -> None:
    floor = min([SHEET.floor, *(row.error for row in rows if row.error)])
    for name in dict.fromkeys(row.method for row in rows):
        line = [row for row in rows if row.method == name and row.error is not None]
        line.sort(key=lambda row: (row.error, row.microseconds))
        across = [row.error or floor for row in line]
        look = _look(names, name)
        axes.loglog(across, [row.microseconds for row in line], **look)
        hollow = [(x, row.microseconds) for x, row in zip(across, line, strict=True) if row.missed]
        if hollow:
            axes.loglog(*zip(*hollow, strict=True), **{**look, "linestyle": "none", "markerfacecolor": WHITE})
    _widened(axes)
    axes.set_title(case, fontsize=10)
    axes.set_xlabel("relative error", fontsize=9)
    axes.set_ylabel("microseconds of CPU", fontsize=9)
    axes.tick_params(which="both", labelsize=7)
    axes.grid(True, which="major", color=SHADE, linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)


def _widened(axes: Axes) -> None:
    """Show three decades at least: fewer are hard to read, and labels between powers of ten would overlap."""
    low, high = axes.get_xlim()
    if high < SHEET.least * low:
        middle = (low * high) ** 0.5
        axes.set_xlim(middle / SHEET.least**0.5, middle * SHEET.least**0.5)
    axes.xaxis.set_minor_formatter(NullFormatter())


def _bars(axes: Axes, rows: Sequence[Row]) -> None:
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


def _legend(figure: Figure, names: Sequence[str]) -> None:
    keys = [Line2D([], [], label=name, **_look(names, name)) for name in names]
    keys.append(Line2D([], [], label="hollow: missed an answer", marker="o", linestyle="none", **OPEN))
    figure.legend(handles=keys, loc="outside lower center", ncols=2, fontsize=8, frameon=False)
