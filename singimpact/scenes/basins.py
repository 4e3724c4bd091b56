"""Pictures of basins and of bifurcations: classes told apart by lightness too, values by position alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from singimpact.dynamics.basins import Basins
from singimpact.dynamics.bifurcation import Bifurcation
from singimpact.scenes.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILLION

FIXED = {"not decided": "#F2F2F2", "never returns": "#FFFFFF", "chaotic": "#C9C9C9", "rest": BLACK}
CHATTERED = (BLACK, "#3D3D3D", "#6B6B6B")  # chatter for ever, of one lift-off or another
ORBITS = (ORANGE, BLUE, SKY, VERMILLION, GREEN, PURPLE, "#F0E442", "#8C8C8C")  # neighbours differ in lightness
LETTERS = {"clearance": "clearance $c$", "restitution": "restitution $r$"}


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
    used, known, found = dict.fromkeys(("orbit", "chatter"), 0), dict[Any, str](), []
    for each in several:
        colors, names = [], list[Any]()
        for code, _, _ in each.classes:
            attractor = each.attractors[code]
            kind, name = attractor.kind, (attractor.kind, attractor.n, attractor.k)
            names.append(name)
            key = (*name, names.count(name))  # the second of two equal (n, k)
            if key not in known:
                palette = ORBITS if kind == "orbit" else CHATTERED
                known[key] = FIXED.get(kind) or palette[used[kind] % len(palette)]
                if kind in used:
                    used[kind] += 1
            colors.append(known[key])
        found.append(colors)
    return found


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


def draw_bifurcation(found: Bifurcation, axes: Any = None) -> Any:
    """Velocities after the impacts of settled orbits, ends of complete chatter on the axis."""
    axes = _new_axes(8.0, 4.6) if axes is None else axes
    values = np.repeat(found.values, found.events.shape[1])
    _, v, ended = found.events.reshape(-1, 3).T
    resting = ended == 1.0
    axes.plot(values[~resting], v[~resting], ",", color=BLACK, label="impacts", rasterized=True)
    axes.plot(values[~resting], v[~resting], "o", color=BLACK, markersize=0.7, markeredgewidth=0, rasterized=True)
    if found.direction == "both":
        back = np.arange(values.size) >= values.size // 2
        down = back & ~resting
        axes.plot(values[down], v[down], "o", color=BLUE, markersize=0.7, markeredgewidth=0, label="on the way down",
                  rasterized=True)  # fmt: skip
    if resting.any():
        axes.plot(values[resting], v[resting], "|", color=VERMILLION, markersize=7, label="end of complete chatter",
                  clip_on=False, rasterized=True)  # fmt: skip
    axes.set_xlabel(LETTERS.get(found.over, found.over))
    axes.set_ylabel("velocity $v$ after an impact")
    axes.set_xlim(found.values.min(), found.values.max())
    axes.set_ylim(bottom=0)
    if not np.isfinite(v).any():
        axes.text(0.5, 0.5, "no orbit of this window has an impact", transform=axes.transAxes, ha="center")
    axes.legend(loc="best", fontsize="small", markerscale=2)
    return axes


def _new_axes(width: float, height: float) -> Any:
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=150, layout="constrained").add_subplot()
