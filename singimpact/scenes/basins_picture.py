"""Pictures of basins: classes differ in lightness too."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from singimpact.dynamics.basins_of_attraction import Basins
from singimpact.scenes.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION

FIXED = {
    "not decided": "#F2F2F2",
    "sensitive": "#E6E6E6",
    "unresolved": "#FAFAFA",
    "never returns": "#FFFFFF",
    "no impact": "#FFFFFF",
    "chaotic": "#C9C9C9",
    "rest": BLACK,
}
CHATTERED = (BLACK, "#3D3D3D", "#6B6B6B")  # chatter for ever, of one lift-off or another
ORBITS = (ORANGE, BLUE, SKY, VERMILLION, GREEN, PURPLE, "#F0E442", "#8C8C8C")  # neighbours differ in lightness


def draw_basins(found: Basins, axes: Any = None, colors: Sequence[str] | None = None) -> Any:
    """The classes of a grid of states as a picture; returns the matplotlib axes.

    `colors` : of the classes, in the order of `found.classes`; those of `class_colors` without it.
    """
    colors = class_colors([found])[0] if colors is None else list(colors)
    layers = [(found.codes == code, f"{name}, {100 * share:.3g} %") for code, name, share in found.classes]
    return _painted(found, layers, colors, axes)


def class_colors(several: Sequence[Basins]) -> list[list[str]]:
    """Colours of the classes of some basins, each in the order of its `classes`; one (n, k) has one colour in all.

    Examples
    --------
    >>> class_colors([])
    []
    """
    used, shades, found = dict.fromkeys(("orbit", "chatter"), 0), dict[Any, str](), []
    for each in several:
        colors, names = [], list[Any]()
        for code, _, _ in each.classes:
            attractor = each.attractors[code]
            kind, name = attractor.kind, (attractor.kind, attractor.n, attractor.k)
            names.append(name)
            key = (*name, names.count(name))  # the second of two equal (n, k)
            if key not in shades:
                palette = ORBITS if kind == "orbit" else CHATTERED
                shades[key] = FIXED.get(kind) or palette[used[kind] % len(palette)]
                if kind in used:
                    used[kind] += 1
            colors.append(shades[key])
        found.append(colors)
    return found


def draw_first_chatter(found: Basins, axes: Any = None) -> Any:
    """Where the first chatter completes, whatever the orbit does afterwards; returns the matplotlib axes."""
    chosen = found.first_chatter_completes
    named = [(chosen, "first chatter completes"), (~chosen, "it does not")]
    layers = [(where, f"{name}, {100 * where.mean():.3g} %") for where, name in named]
    return _painted(found, layers, [VERMILLION, "#F2F2F2"], axes)


def _painted(basins: Basins, layers: list[tuple[Any, str]], colors: list[str], axes: Any) -> Any:
    from matplotlib.colors import to_rgb
    from matplotlib.patches import Patch

    axes = _new_axes(7.2, 5.2) if axes is None else axes
    image, patches = np.empty((*basins.codes.shape, 3)), []
    for (where, label), color in zip(layers, colors, strict=True):
        image[where] = to_rgb(color)
        patches.append(Patch(facecolor=color, edgecolor="0.4", label=label))
    half_tau, half_v = np.diff(basins.tau[:2])[0] / 2, np.diff(basins.v[:2])[0] / 2
    box = (basins.tau[0] - half_tau, basins.tau[-1] + half_tau, basins.v[0] - half_v, basins.v[-1] + half_v)
    axes.imshow(image, origin="lower", extent=box, aspect="auto", interpolation="nearest")
    axes.set_xlabel(r"launch phase $\tau$")
    axes.set_ylabel("launch velocity $v$")
    axes.legend(
        handles=patches[:12], loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=3, frameon=False, fontsize="small"
    )
    return axes


def _new_axes(width: float, height: float) -> Any:
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=150, layout="constrained").add_subplot()
