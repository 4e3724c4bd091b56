"""Places for the names of points, clear of curves and of one another, and legends below the axes."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.scenes.style import BLACK, GREY, OPEN

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# Distances and directions in which a name may stand, in points of 1/72 inch, and the spacing of the samples of curves
DISTANCES, DIRECTIONS, SAMPLE = (9.0, 16.0, 26.0, 38.0, 52.0, 70.0, 90.0), 16, 2.0
LEADER = {"arrowstyle": "-", "color": GREY, "linewidth": 0.7, "shrinkA": 1, "shrinkB": 4}  # from a name to its point
LABEL: dict[str, Any] = {
    "textcoords": "offset points",
    "color": BLACK,
    "zorder": 8,
    "arrowprops": LEADER,
} | dict.fromkeys(("ha", "va"), "center")


class Names(NamedTuple):
    """written : the annotations. clear : whether none of them hides a curve, a point or another name."""

    written: list[Any]
    clear: bool


def place_labels(axes: Any, labels: Sequence[tuple[float, float, str]], size: float = 10.0) -> Names:
    """Names written beside points.

    Parameters
    ----------
    axes : with its curves drawn and its limits set. labels : x, y and the name of each point; a point outside the
        limits gets none. size : of the letters, in points.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().add_subplot()
    >>> _ = axes.plot([0, 1], [0, 1])
    >>> [name.get_text() for name in place_labels(axes, [(0.5, 0.5, "middle"), (2, 2, "outside")]).written]
    ['middle']
    """
    axes.figure.draw_without_rendering()  # sets the layout, which the distances in pixels need
    box = axes.get_window_extent()
    pixel = axes.figure.dpi / 72
    inside: list[tuple[float, float, str]] = []
    for x, y, name in labels:
        spot = axes.transData.transform((x, y))
        gaps = [axes.transData.transform(label[:2]) - spot for label in inside if label[2] == name]
        # points of one name that are nearer than 8 points of 1/72 inch are named once
        if box.padded(3.0).contains(*spot) and not any(np.hypot(*gap) < 8.0 * pixel for gap in gaps):
            inside.append((x, y, name))
    obstacles = [_curve_points(axes, SAMPLE * pixel)]
    points = np.array([axes.transData.transform((x, y)) for x, y, _ in inside]).reshape(-1, 2)
    obstacles.append(np.repeat(points, 4, axis=0))  # to hide another point is worse than to cross a curve
    taken: list[Array] = [_extent(text) for text in axes.texts]
    written, clear = [], True
    for (x, y, name), point in zip(inside, points, strict=True):
        text = axes.annotate(name, (x, y), (0, 0), fontsize=size, **LABEL)
        extent = _extent(text)
        half = (extent[2:] - extent[:2]) / 2
        offset, free = _offset(point, half, np.concatenate(obstacles), taken, (box.extents, pixel))
        clear &= free
        text.set_position(tuple(offset / pixel))
        written.append(text)
        length = np.hypot(*offset) - _reach(half, offset)
        # a name farther away than this is joined to its point by a line
        joined = bool(length > 12.0 * pixel)
        text.arrow_patch.set_visible(joined)
        middle = point + offset
        if joined:
            shares = np.linspace(0, 1, 2 + int(length / (SAMPLE * pixel)))[:, None]
            obstacles.append(point + shares * offset * (length / np.hypot(*offset)))
        taken.append(np.concatenate([middle - half, middle + half]))
    return Names(written, clear)


def legend_entries(axes: Axes) -> dict[str, Any]:
    """The words and handles of the legend that is there, or of the curves."""
    old = axes.get_legend()
    if old is None:
        handles, labels = axes.get_legend_handles_labels()
        return dict(zip(labels, handles, strict=True))
    return dict(zip([text.get_text() for text in old.get_texts()], list(old.legend_handles), strict=True))


def legend_mark(shape: str, size: float, **look: Any) -> Any:
    """A marker for a legend, open unless its colours are given."""
    from matplotlib.lines import Line2D

    return Line2D([], [], linestyle="none", marker=shape, markersize=size, **(OPEN | look))


def legend_below(axes: Axes, entries: dict[str, Any], columns: int = 3, under: float = 0.13) -> Axes:
    """The axes with a legend below them, where no curve is; `under` is its distance in heights of the axes."""
    axes.legend(
        entries.values(),
        entries.keys(),
        loc="upper center",
        bbox_to_anchor=(0.5, -under),
        ncols=columns,
        frameon=False,
        fontsize="small",
    )
    return axes


def _extent(text: Any) -> Array:
    from matplotlib.text import Text

    return np.asarray(Text.get_window_extent(text).extents)  # without the line to its point


def _reach(half: Array, offset: Array) -> float:
    """The reach of the box of a name from its middle back towards the point."""
    direction = np.abs(offset) / np.hypot(*offset)
    with np.errstate(divide="ignore"):
        return float(np.min(half / direction))


def _offset(
    point: Array, half: Array, obstacles: Array, taken: list[Array], space: tuple[Any, float]
) -> tuple[Array, bool]:
    """The offset, in pixels, of the name's middle that hides least, of those the nearest; whether it hides nothing."""
    edges, pixel = space
    # free space around a name
    margin = 2.0 * pixel
    best, least = np.array([0.0, DISTANCES[0]]), np.inf
    nearby = obstacles[np.abs(obstacles - point).max(axis=1) < DISTANCES[-1] * pixel]
    for rank, distance in enumerate(DISTANCES):
        for angle in np.pi * (0.25 + 2 * np.arange(DIRECTIONS) / DIRECTIONS):
            direction = np.array([np.cos(angle), np.sin(angle)])
            offset = direction * (distance * pixel + _reach(half, direction))
            middle = point + offset
            low, high = middle - half - margin, middle + half + margin
            hidden = int(((obstacles > low) & (obstacles < high)).all(axis=1).sum())
            crossed = sum(bool((low < other[2:]).all() and (high > other[:2]).all()) for other in taken)
            # between a point and its name no other curve should pass so near to the straight line; the point's own
            # curves are near to it by themselves
            between = _between(point, direction, (3.0 * pixel, distance * pixel), nearby, 1.5 * pixel)
            outside = bool((low < edges[:2]).any() or (high > edges[2:]).any())
            cost = hidden + 3 * between + 50 * crossed + 100 * outside + 0.2 * rank
            if cost < least:
                best, least = offset, cost
        if least < len(DISTANCES) * 0.2:
            return best, True
    return best, False


def _between(point: Array, direction: Array, ends: tuple[float, float], obstacles: Array, clear: float) -> int:
    """The number of obstacles on the straight line from a point to its name, from one distance to another."""
    along = (obstacles - point) @ direction
    aside = (obstacles - point) @ np.array([-direction[1], direction[0]])
    return int(((along > ends[0]) & (along < ends[1]) & (np.abs(aside) < clear)).sum())


def _curve_points(axes: Axes, step: float) -> Array:
    """Points of all curves and markers of axes in pixels, about `step` apart."""
    points = [np.empty((0, 2))]
    for line in axes.lines:
        data = line.get_transform().transform(np.column_stack(line.get_data()).astype(float))
        if line.get_linestyle() in ("None", "none", ""):
            points.append(data[np.isfinite(data).all(axis=1)])
            continue
        for begin, end in pairwise(data):
            length = np.hypot(*(end - begin))
            if np.isfinite(length) and length < 1e5:
                shares = np.linspace(0, 1, 2 + int(length / step))[:, None]
                points.append(begin + shares * (end - begin))
    return np.concatenate(points)
