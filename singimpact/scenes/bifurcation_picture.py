"""Pictures of bifurcation diagrams: velocities and phases of settled orbits, branches of periodic orbits over them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from singimpact.branches.branch import Branch
from singimpact.dynamics.bifurcation_diagram import Bifurcation
from singimpact.scenes.branch_picture import HEIGHTS, draw_branches
from singimpact.scenes.style import BLACK, BLUE, GREY, LETTERS, VERMILLION

SIZE = (8.0, 6.4)
"""Inches."""
SPREAD = 60_000.0
"""Impacts per square inch of area of their dots: few get large dots, many small ones."""


def bifurcation_sheet(diagram: Bifurcation, branches: Sequence[Branch] = ()) -> Any:
    """The figure of a diagram: velocities above, phases below, and branches over both.

    Parameters
    ----------
    diagram : of `bifurcation`. branches : over the same number.

    Examples
    --------
    >>> from singimpact.dynamics.bifurcation_diagram import bifurcation
    >>> from singimpact.oscillator.model import Oscillator
    >>> found = bifurcation(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance", (0.2, 0.3), 2, impacts=60, kept=4)
    >>> [axes.get_ylabel() for axes in bifurcation_sheet(found).axes]
    ['velocity $v$ after an impact', 'phase of an impact, in periods']
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE, dpi=150, layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    for axes, height in ((below, "phase"), (above, "v")):
        draw_bifurcation(diagram, axes, height)
        handles, labels = axes.get_legend_handles_labels()
        if branches:
            shown = draw_branches(branches, axes, height).get_legend()
            handles, labels = shown.legend_handles, [text.get_text() for text in shown.get_texts()]
        if axes.get_legend() is not None:
            axes.get_legend().remove()
    above.set_xlabel("")
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False, fontsize="small", markerscale=2)
    return figure


def draw_bifurcation(diagram: Bifurcation, axes: Any, height: str = "v") -> Any:
    """Velocities after the impacts of settled orbits, or their phases; ends of complete chatter in another colour."""
    values = np.repeat(diagram.values, diagram.events.shape[1])
    phase, v, ended = diagram.events.reshape(-1, 3).T
    places = (
        v
        if height == "v"
        else phase / np.repeat(np.broadcast_to(diagram.periods, diagram.values.shape), diagram.events.shape[1])
    )
    resting = ended == 1.0
    inches = float(np.prod(axes.figure.get_size_inches()))
    size = float(np.clip(np.sqrt(SPREAD * inches / max(values.size, 1)) / 20, 0.9, 3.0))
    dots = {"marker": "o", "linestyle": "none", "markersize": size, "markeredgewidth": 0, "rasterized": True}
    axes.plot(values[~resting], places[~resting], color=BLACK, label="impact", **dots)
    if diagram.direction == "both":
        down = (np.arange(values.size) >= values.size // 2) & ~resting
        axes.plot(values[down], places[down], color=BLUE, label="impact, on the way down", **dots)
    if resting.any():
        axes.plot(
            values[resting],
            places[resting],
            color=VERMILLION,
            label="end of complete chatter",
            clip_on=False,
            **(dots | {"markersize": 1.5 * size}),
        )
    axes.set_xlabel(LETTERS.get(diagram.over, diagram.over))
    axes.set_ylabel(HEIGHTS[height])
    axes.set_xlim(diagram.values.min(), diagram.values.max())
    if height == "v":
        axes.set_ylim(bottom=0)
    else:
        axes.set_ylim(0, 1)
    if not np.isfinite(v).any():
        axes.text(0.5, 0.5, "no orbit of this window has an impact", transform=axes.transAxes, ha="center", color=GREY)
    if len(axes.get_legend_handles_labels()[1]) > 1:
        axes.legend(loc="best", fontsize="small", markerscale=2)
    return axes
