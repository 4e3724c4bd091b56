"""Pictures of basins: classes differ in lightness too."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.dynamics.basins import Basins
from singimpact.scenes.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION

FIXED = {"not decided": "#F2F2F2", "never returns": "#FFFFFF", "chaotic": "#C9C9C9", "rest": BLACK}
CHATTERED = (BLACK, "#3D3D3D", "#6B6B6B")  # chatter for ever, of one lift-off or another
ORBITS = (ORANGE, BLUE, SKY, VERMILLION, GREEN, PURPLE, "#F0E442", "#8C8C8C")  # neighbours differ in lightness


def draw_basins(found: Basins, axes: Any = None) -> Any:
    """The classes of a grid of states as a picture; returns the matplotlib axes."""
    colors, used = [], dict.fromkeys(("orbit", "chatter"), 0)
    for code, _, _ in found.classes:
        kind = found.attractors[code].kind
        palette = ORBITS if kind == "orbit" else CHATTERED
        colors.append(FIXED.get(kind) or palette[used[kind] % len(palette)])
        if kind in used:
            used[kind] += 1
    layers = [(found.codes == code, f"{name}, {100 * share:.3g} %") for code, name, share in found.classes]
    return _painted(found, layers, colors, axes)


def draw_first_chatter(found: Basins, axes: Any = None) -> Any:
    """Where the first chatter completes, whatever the orbit does afterwards; returns the matplotlib axes."""
    chosen = found.first_chatter_completes
    named = [(chosen, "first chatter completes"), (~chosen, "it does not")]
    layers = [(where, f"{name}, {100 * where.mean():.3g} %") for where, name in named]
    return _painted(found, layers, [VERMILLION, "#F2F2F2"], axes)


def _painted(found: Basins, layers: list[tuple[Any, str]], colors: list[str], axes: Any) -> Any:
    from matplotlib.colors import to_rgb
    from matplotlib.patches import Patch

    axes = _new_axes(7.2, 5.2) if axes is None else axes
    image, patches = np.empty((*found.codes.shape, 3)), []
    for (where, label), color in zip(layers, colors, strict=True):
        image[where] = to_rgb(color)
        patches.append(Patch(facecolor=color, edgecolor="0.4", label=label))
    half_tau, half_v = np.diff(found.tau[:2])[0] / 2, np.diff(found.v[:2])[0] / 2
    box = (found.tau[0] - half_tau, found.tau[-1] + half_tau, found.v[0] - half_v, found.v[-1] + half_v)
    axes.imshow(image, origin="lower", extent=box, aspect="auto", interpolation="nearest")
    axes.set_xlabel(r"launch phase $\tau$")
    axes.set_ylabel("launch velocity $v$")
    axes.legend(handles=patches[:12], loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=3, frameon=False,
                fontsize="small")  # fmt: skip
    return axes


def _new_axes(width: float, height: float) -> Any:
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=150, layout="constrained").add_subplot()
