"""The plane of states before and after a transition of P: basins, the outline P, the tears of the map and gamma."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.branches.transitions import BothSides
from singimpact.dynamics.basins_of_attraction import Basins
from singimpact.inputs import refuse
from singimpact.oscillator.moving_number import value_of, with_number
from singimpact.scenes.basins_picture import class_colors, draw_basins
from singimpact.scenes.layers import LAYERS
from singimpact.scenes.scene import Scene
from singimpact.scenes.style import BLACK, PENS

CURVES = {"outline": "hidden", "discontinuities": "jump", "gamma": "gamma"}
"""Layers over basins, and the pens that draw them."""
WIDTHS = {"outline": 0.9, "discontinuities": 2.0, "gamma": 1.3}
FAINT = 0.45
"""Opacity of basins below curves."""


def draw_both_sides(found: BothSides, axes: Any) -> Any:
    """Draw both planes; returns the two axes.

    Parameters
    ----------
    axes : two of matplotlib.
    """
    pair = np.ravel(axes)
    if pair.size != 2:
        raise refuse("axes", f"{pair.size} of them", "two: those before and after the transition")
    for one, model, side, colors in zip(pair, found.models, found.basins, class_colors(found.basins), strict=True):
        _draw(one, model, side, colors)
        value = value_of(with_number(model, found.over), found.over)
        one.set_title(f"{found.over} = {value:.6g}")
    first = min(side.tau[0] for side in found.basins)
    for one in pair:
        phase = first + np.mod(found.transition.tau - first, np.ptp(found.basins[0].tau))
        one.plot(phase, 0.0, "^", color=BLACK, markerfacecolor="white", markersize=7, clip_on=False, zorder=8)
        one.set_xlabel(rf"launch phase $\tau$; {found.transition.kind} at the triangle")
    pair[1].set_ylabel("")
    return pair


def _draw(axes: Any, model: Any, side: Basins, colors: list[str]) -> None:
    draw_basins(side, axes, colors)
    axes.images[-1].set_alpha(FAINT)
    half = (side.tau[1] - side.tau[0]) / 2
    tau, speeds = (side.tau[0] - half, side.tau[-1] + half), (0.0, float(side.v[-1] + (side.v[1] - side.v[0]) / 2))
    scene = Scene(model, tuple(CURVES), tau, v=speeds, pixels=600)
    limits, legend = (axes.get_xlim(), axes.get_ylim()), axes.get_legend()
    handles, labels = list(legend.legend_handles), [text.get_text() for text in legend.get_texts()]
    for handle in handles:
        handle.set_alpha(FAINT)
    for name, pen in CURVES.items():
        layer, lines = LAYERS[name], list[Any]()
        for curve in scene.results.get(layer.need):
            lines += axes.plot(*curve.points.T, **PENS[pen].line() | {"linewidth": WIDTHS[name]}, zorder=4)
        if lines:
            handles.append(lines[0])
            labels.append(layer.label)
    axes.set_xlim(*limits[0])
    axes.set_ylim(*limits[1])
    axes.legend(
        handles, labels, loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, frameon=False, fontsize="small"
    )
