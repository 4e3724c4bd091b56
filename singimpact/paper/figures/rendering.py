"""Pictures drawn by matplotlib: letters with a halo, regions with hatches, no legend where a letter can stand."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.paper.figures.panel import Dot, Line, Panel, Picture, Region
from singimpact.scenes.style import PENS

WIDTH, HEIGHT = 4.3, 3.4  # of a panel, in inches
LETTER = 12


def drawn(picture: Picture) -> Any:
    """The matplotlib figure of a picture."""
    from matplotlib.figure import Figure

    count = len(picture.panels)
    columns = min(picture.columns, count)
    rows = -(-count // columns)
    size = (6.6, 5.0) if count == 1 else (WIDTH * columns, HEIGHT * rows)
    figure = Figure(figsize=size, dpi=150, layout="constrained")
    for n, panel in enumerate(picture.panels):
        if panel.mesh is not None:
            _solid(figure.add_subplot(rows, columns, n + 1, projection="3d"), panel)
        else:
            _flat(figure.add_subplot(rows, columns, n + 1), panel)
    return figure


def _halo() -> list[Any]:
    from matplotlib import patheffects

    return [patheffects.withStroke(linewidth=3, foreground="white")]


def _flat(axes: Any, panel: Panel) -> None:
    (left, right), (low, high) = panel.box
    for region in panel.regions:
        _region(axes, region)
    if low <= 0 <= high:
        axes.axhline(0, color="0.35", linewidth=0.9, zorder=1.5)
    for line in panel.lines:
        _line(axes, line)
    for dot in panel.dots:
        _dot(axes, dot)
    axes.set(xlim=(left, right), ylim=(low, high), title=panel.title)
    axes.set_xlabel(panel.x)
    axes.set_ylabel(panel.y)
    axes.spines[["top", "right"]].set_visible(False)
    axes.locator_params(nbins=5)
    if not panel.ticks:
        axes.set_xticks([])
        axes.set_yticks([])


def _region(axes: Any, region: Region) -> None:
    axes.fill(*region.points.T, facecolor=region.tone, edgecolor="0.55" if region.hatch else "none", hatch=region.hatch,
              linewidth=0, zorder=1)  # fmt: skip
    if region.label:
        place = region.place if region.place is not None else tuple(region.points.mean(axis=0))
        axes.annotate(region.label, place, ha="center", va="center", fontsize=LETTER, path_effects=_halo(), zorder=8)


def _line(axes: Any, line: Line) -> None:
    x, y = line.points.T
    axes.plot(x, y, **PENS[line.pen].line(), zorder=3)
    place, back = _place(line.points, line.at), _place(line.points, line.at - 1e-3)
    if line.label:
        dark = line.pen in ("gamma", "manifold", "before", "at", "hidden")
        axes.annotate(line.label, place, line.shift, textcoords="offset points", fontsize=LETTER,
                      color="black" if dark else PENS[line.pen].color, path_effects=_halo(), zorder=9,
                      annotation_clip=True)  # fmt: skip
    if line.arrow:
        look = {"arrowstyle": "-|>", "color": PENS[line.pen].color, "linewidth": 1.2, "mutation_scale": 13}
        axes.annotate("", place, back, arrowprops=look, zorder=7, annotation_clip=True)


def _place(points: Any, share: float) -> tuple[float, float]:
    """A place on a polyline, by a share of its vertices."""
    at = np.clip(share, 0, 1) * (len(points) - 1)
    x, y = (float(np.interp(at, np.arange(len(points)), column)) for column in points.T)
    return x, y


def _dot(axes: Any, dot: Dot) -> None:
    axes.plot(*dot.place, "o", color="black", markersize=4.5, zorder=10, clip_on=False)
    axes.annotate(dot.letter, dot.place, dot.shift, textcoords="offset points", fontsize=LETTER, path_effects=_halo(),
                  zorder=11, ha="right" if dot.shift[0] < 0 else "left",
                  va="top" if dot.shift[1] < 0 else "bottom")  # fmt: skip


def _solid(axes: Any, panel: Panel) -> None:
    """A surface in (tau, v, t), lines on it as polylines in space."""
    assert panel.mesh is not None
    tau, v, t = panel.mesh
    axes.plot_surface(tau, v, t, color="#BBD9EE", alpha=0.5, linewidth=0.25, edgecolor="0.5", shade=False,
                      rstride=3, cstride=3)  # fmt: skip
    for line in panel.lines:
        axes.plot(*line.points.T, **PENS[line.pen].line(), zorder=10)
        if line.label:
            place = line.points[int(line.at * (len(line.points) - 1))]
            axes.text(
                *(place + np.array([0.015, 0.004, 0.02])), line.label, fontsize=LETTER, path_effects=_halo(), zorder=20
            )
    (left, right), (low, high) = panel.box
    axes.set(xlim=(left, right), ylim=(low, high))
    axes.set_xlabel(panel.x)
    axes.set_ylabel(panel.y)
    axes.set_zlabel("$t$")
    axes.view_init(elev=26, azim=-68)
