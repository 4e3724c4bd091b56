"""Pictures of basins, also before and after a transition of P, and of regions; classes differ in lightness too."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from singimpact.branches.transitions import BothSides
from singimpact.dynamics import Basins, BasinsOver, ClassGrid, Regions
from singimpact.inputs import require
from singimpact.oscillator.moving_number import value_of, with_number
from singimpact.scenes import style
from singimpact.scenes.label_places import legend_below, legend_entries
from singimpact.scenes.scene import LAYERS, Scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MEASURES = {
    "lyapunov": "larger exponent, per unit of time",
    "rest": "share of time at rest",
    "impacts": "impacts a period",
}
LABELS = {
    "tau": r"launch phase $\tau$",
    "v": "launch velocity $v$",
    "x": "$x$ at the start",
    "xdot": "$x'$ at the start",
}


def draw_regions(result: Regions, axes: Any = None) -> Any:
    """Regions over two numbers: their classes, or a number with its scale; returns the matplotlib axes.

    On axes with curves over the same numbers these stay above the regions.
    """
    if result.values is None:
        return draw_basins(result, axes)
    axes = style.new_axes(7.2, 5.2) if axes is None else axes
    image = axes.imshow(
        result.values,
        origin="lower",
        extent=_box(result),
        aspect="auto",
        interpolation="nearest",
        cmap="cividis",
        gid="regions",
    )
    axes.figure.colorbar(image, ax=axes, label=MEASURES.get(result.of, result.of))
    (across, _), (up, _) = result.sides
    axes.set(xlabel=style.LETTERS.get(across, across), ylabel=style.LETTERS.get(up, up))
    return axes


def draw_basins(found: ClassGrid, axes: Any = None, colors: Sequence[str] | None = None) -> Any:
    """The classes of a grid of states as a picture; returns the matplotlib axes.

    `colors` : of the classes, in the order of `found.classes`; those of `class_colors` without it.
    """
    colors = class_colors([found])[0] if colors is None else list(colors)
    layers = [(found.codes == code, f"{name}, {100 * share:.3g} %") for code, name, share in found.classes]
    return _painted(found, layers, colors, axes)


def draw_basins_over(result: BasinsOver, axes: Axes) -> Axes:
    """Shares of basins over a number, stacked, the largest lowest, with standard errors of their sums."""
    order, names, _ = zip(*result.classes, strict=True)
    shares = result.share[:, list(order)].T
    layers = axes.stackplot(
        result.values, shares, colors=class_colors([result])[0], edgecolor=style.WHITE, linewidth=0.4, step="mid"
    )
    sums, n = shares.cumsum(axis=0), result.codes.shape[1]
    for below in sums[:-1]:
        # one state more in and one more out, as in `BasinsOver.error`
        likely = (n * below + 1) / (n + 2)
        error = np.sqrt(likely * (1 - likely) / (n + 3)) * ((below > 0) & (below < 1))
        axes.errorbar(result.values, below, error, fmt="none", ecolor=style.BLACK, elinewidth=0.7, gid="standard error")
    axes.set(xlabel=style.LETTERS.get(result.over, result.over), ylabel="share of the states", ylim=(0, 1))
    axes.set_xlim(result.values[0], result.values[-1])
    return legend_below(axes, dict(list(zip(names, layers, strict=True))[:12]), 3 if max(map(len, names)) < 36 else 2)


def class_colors(several: Sequence[ClassGrid]) -> list[list[str]]:
    """Colours of the classes of some basins, each in the order of its `classes`; one (n, k) has one colour in all.

    Examples
    --------
    >>> class_colors([])
    []
    """
    used, shades, colorings = {"orbit": 0, "chatter": 0}, dict[Any, str](), []
    for basins in several:
        colors, names = [], list[Any]()
        for code, _, _ in basins.classes:
            attractor = basins.attractors[code]
            kind, name = attractor.kind, (attractor.kind, attractor.n, attractor.k)
            names.append(name)
            key = (*name, names.count(name))  # the second of two equal (n, k)
            if key not in shades:
                palette = style.CHATTERED if kind == "chatter" else style.CLASS_ORBITS
                family = "chatter" if kind == "chatter" else "orbit"
                shades[key] = style.CLASSES.get(kind) or palette[used[family] % len(palette)]
                if kind not in style.CLASSES:
                    used[family] += 1
            colors.append(shades[key])
        colorings.append(colors)
    return colorings


def draw_first_chatter(found: Basins, axes: Any = None) -> Any:
    """Where the first chatter completes, whatever the orbit does afterwards; returns the matplotlib axes."""
    chosen = found.first_chatter_completes
    named = [(chosen, "first chatter completes"), (~chosen, "it does not")]
    layers = [(where, f"{name}, {100 * where.mean():.3g} %") for where, name in named]
    return _painted(found, layers, [style.VERMILLION, style.CLASSES["not decided"]], axes)


def _box(found: ClassGrid) -> tuple[float, float, float, float]:
    """The ends of both axes, half a cell beyond the first and last values."""
    ends = [(values[0], values[-1], np.diff(values[:2])[0] / 2) for _, values in found.sides]
    (left, right, wide), (low, high, tall) = ends
    return left - wide, right + wide, low - tall, high + tall


def _painted(basins: ClassGrid, layers: list[tuple[Any, str]], colors: list[str], axes: Any) -> Any:
    from matplotlib.colors import to_rgb
    from matplotlib.patches import Patch

    axes = style.new_axes(7.2, 5.2) if axes is None else axes
    image, entries = np.empty((*basins.codes.shape, 3)), dict[str, Any]()
    for (where, label), color in zip(layers, colors, strict=True):
        image[where] = to_rgb(color)
        entries[label] = Patch(facecolor=color, edgecolor=style.GREY, label=label)
    axes.imshow(
        image, origin="lower", extent=_box(basins), aspect="auto", interpolation="nearest", gid="basins", zorder=0
    )
    names = [name for name, _ in basins.sides]
    labels = {**style.LETTERS, **(LABELS if isinstance(basins, Basins) else {})}
    axes.set(**dict(zip(("xlabel", "ylabel"), (labels.get(name, name) for name in names), strict=True)))
    shown = dict(list(entries.items())[:12])
    return legend_below(axes, shown, 3 if max(map(len, shown)) < 36 else 2)


# The plane of states before and after a transition of P: basins, the outline P, the tears of the map and gamma.

CURVES = {"outline": "hidden", "discontinuities": "jump", "gamma": "gamma"}  # layers over basins, and their pens
WIDTHS = {"outline": 0.9, "discontinuities": 2.0, "gamma": 1.3}
FAINT = 0.45  # opacity of basins below curves


def draw_both_sides(sides: BothSides, axes: Any) -> Any:
    """Draw both planes; returns the two axes.

    Parameters
    ----------
    axes : two of matplotlib.
    """
    pair = np.ravel(axes)
    require(pair.size == 2, "axes", f"{pair.size} of them", "two: those before and after the transition")
    for one, model, side, colors in zip(pair, sides.models, sides.basins, class_colors(sides.basins), strict=True):
        _draw(one, model, side, colors)
        value = value_of(with_number(model, sides.over), sides.over)
        one.set_title(f"{sides.over} = {value:.6g}")
    first = min(side.tau[0] for side in sides.basins)
    for one in pair:
        phase = first + np.mod(sides.transition.tau - first, np.ptp(sides.basins[0].tau))
        one.plot(phase, 0.0, "^", **style.OPEN, markersize=7, clip_on=False, zorder=8)
        one.set_xlabel(rf"launch phase $\tau$; {sides.transition.kind} at the triangle")
    pair[1].set_ylabel("")
    return pair


def _draw(axes: Any, model: Any, side: Basins, colors: list[str]) -> None:
    draw_basins(side, axes, colors)
    axes.images[-1].set_alpha(FAINT)
    half = (side.tau[1] - side.tau[0]) / 2
    tau, speeds = (side.tau[0] - half, side.tau[-1] + half), (0.0, float(side.v[-1] + (side.v[1] - side.v[0]) / 2))
    scene = Scene(model, tuple(CURVES), tau, v=speeds, pixels=600)
    limits, entries = (axes.get_xlim(), axes.get_ylim()), legend_entries(axes)
    for handle in entries.values():
        handle.set_alpha(FAINT)
    for name, pen in CURVES.items():
        layer, look = LAYERS[name], style.PENS[pen].line() | {"linewidth": WIDTHS[name]}
        for curve in scene.results.get(layer.need):
            (line,) = axes.plot(*curve.points.T, **look, zorder=4)
            entries.setdefault(layer.label, line)
    axes.set(xlim=limits[0], ylim=limits[1])
    legend_below(axes, entries, 2, 0.14)
