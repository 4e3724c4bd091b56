"""A level set y = 0 in the plane as polylines: a sketch on a grid, then Newton onto it, then the spacing.

The sketch is contourpy's.  What a grid can miss is looked for: a sample of |y| smaller than its neighbours', and of one
sign with them, is followed to the extremum, and where the sign changes there a finer grid is laid.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.inputs import InputError
from singimpact.surface.curve import Window

Array = np.ndarray[Any, Any]
Gradient = Callable[[Array], tuple[Array, Array, Array]]  # points -> y, gradient, further column
Grid = Callable[[Array, Array], Array]


@dataclass(frozen=True)
class TraceSettings:
    """close : Newton's last step, relative to 1 + |place|, of a vertex that counts as on the curve.
    rounds : of Newton, and of halving. deviation : of a chord from the curve, in points of the picture.
    finest : times a grid is made finer around an extremum of y or where Newton leaves its cell.
    """

    close: float = 4e-13
    rounds: int = 12
    halvings: int = 10
    deviation: float = 0.25
    finest: int = 3
    least_cells: int = 40
    most_cells: int = 600


SETTINGS = TraceSettings()


@dataclass(frozen=True)
class Polyline:
    """Vertices on the curve, what came with them (x' there), whether it closes, the worst last step of Newton."""

    points: Array
    column: Array
    closed: bool
    tolerance: float


def traced(grid: Grid, gradient: Gradient, window: Window, cell: float, scale: float = 1.0) -> list[Polyline]:
    """The level set in a window.

    Parameters
    ----------
    grid, gradient : y on a grid, and y, its gradient and a further column at points.
    cell : the largest cell that resolves y. scale : of the column, beside the size of the window, for the spacing.
    """
    found: list[Polyline] = []
    for line in (*_sketched(grid, window, cell), *_small_ones(grid, window, cell)):
        made = _on_curve(line, gradient, window, scale)
        if made is not None and not any(_repeats(made, other) for other in found):
            found.append(made)
    return found


def _repeats(new: Polyline, old: Polyline) -> bool:
    """Whether a line lies on another: a piece may be found from two extrema."""
    near = np.abs(old.points[:, None] - new.points[None, :: max(len(new.points) // 4, 1)]).max(axis=2).min(axis=0)
    step = np.abs(np.diff(old.points, axis=0)).max()
    return bool((near <= step).all())


def _axes(window: Window, cell: float) -> tuple[Array, Array]:
    def axis(low: float, high: float) -> Array:
        cells = int(np.clip(np.ceil((high - low) / cell), SETTINGS.least_cells, SETTINGS.most_cells))
        return np.linspace(low, high, cells + 1)

    return axis(*window.tau), axis(*window.t)


def _sketched(grid: Grid, window: Window, cell: float) -> list[Array]:
    from contourpy import LineType, contour_generator

    tau, t = _axes(window, cell)
    made = contour_generator(tau, t, grid(tau, t), line_type=LineType.Separate).lines(0.0)
    return [np.asarray(line) for line in made if len(line) > 1]


def _small_ones(grid: Grid, window: Window, cell: float, depth: int = 0) -> list[Array]:
    """Closed pieces inside one cell of the sketch: found by a finer grid around each extremum of one sign."""
    tau, t = _axes(window, cell)
    values = grid(tau, t)
    found: list[Array] = []
    for i, j in _extrema(values):
        small = Window((tau[max(j - 1, 0)], tau[min(j + 1, len(tau) - 1)]),
                       (t[max(i - 1, 0)], t[min(i + 1, len(t) - 1)]), window.pixels)  # fmt: skip
        inner = grid(*(np.linspace(*ends, 17) for ends in (small.tau, small.t)))
        if inner.min() < 0 < inner.max():
            found += _sketched(grid, small, (small.tau[1] - small.tau[0]) / 32)
        elif depth < SETTINGS.finest and np.abs(inner).min() < 0.5 * np.abs(values[i, j]):
            found += _small_ones(grid, small, (small.tau[1] - small.tau[0]) / 16, depth + 1)
    return found


def _extrema(values: Array) -> list[tuple[int, int]]:
    """Interior samples with |y| below that of all neighbours, which have its sign, and near zero for their spread."""
    size, inner = np.abs(values), np.s_[1:-1, 1:-1]
    shifted = [
        (size[1 + di : size.shape[0] - 1 + di, 1 + dj : size.shape[1] - 1 + dj],
         values[1 + di : size.shape[0] - 1 + di, 1 + dj : size.shape[1] - 1 + dj])
        for di in (-1, 0, 1) for dj in (-1, 0, 1) if di or dj
    ]  # fmt: skip
    good = np.ones(size[inner].shape, dtype=bool)
    spread = np.zeros(size[inner].shape)
    for magnitude, value in shifted:
        good &= (magnitude >= size[inner]) & (np.sign(value) == np.sign(values[inner]))
        spread = np.maximum(spread, magnitude - size[inner])
    good &= size[inner] < 2 * spread
    return [(int(i) + 1, int(j) + 1) for i, j in zip(*np.nonzero(good), strict=True)]


def _on_curve(line: Array, gradient: Gradient, window: Window, scale: float) -> Polyline | None:
    closed = bool(np.allclose(line[0], line[-1], atol=1e-12)) and len(line) > 3
    start = line[:-1] if closed else line
    points, column, step = newton(start, gradient)
    good = step < SETTINGS.close
    points, column = points[good], column[good]
    if len(points) < 2:
        return None
    if closed:
        points, column = np.vstack([points, points[:1]]), np.append(column, column[:1])
    points, column = _spaced(points, column, gradient, window, scale)
    return Polyline(points, column, closed, float(step[good].max()))


def newton(points: Array, gradient: Gradient) -> tuple[Array, Array, Array]:
    """Points moved onto the curve along the gradient; the further column there; the last step over 1 + |place|."""
    points, step = points.copy(), np.full(len(points), np.inf)
    column = np.full(len(points), np.nan)
    moving = np.arange(len(points))
    for _ in range(SETTINGS.rounds):
        y, slope, column[moving] = gradient(points[moving])
        with np.errstate(all="ignore"):
            move = -(y / (slope**2).sum(axis=1))[:, None] * slope
        size = np.hypot(*move.T) / (1 + np.abs(points[moving]).max(axis=1))
        sound = np.isfinite(size)
        points[moving[sound]] += move[sound]
        step[moving] = np.where(sound, size, np.inf)
        moving = moving[sound & (size > SETTINGS.close / 8)]
        if not moving.size:
            break
    return points, column, step


def _spaced(points: Array, column: Array, gradient: Gradient, window: Window, scale: float) -> tuple[Array, Array]:
    """Vertices added where a chord leaves the curve by more than the picture shows, dropped where they crowd."""
    limit = SETTINGS.deviation * window.pixel
    checked = np.zeros(len(points) - 1, dtype=bool)  # chords known to be good
    for _ in range(SETTINGS.halvings):
        open_ = np.flatnonzero(~checked)
        if not open_.size:
            return points, column
        middle = (points[open_] + points[open_ + 1]) / 2
        place, value, step = newton(middle, gradient)
        half = (column[open_] + column[open_ + 1]) / 2
        far = np.hypot(np.hypot(*(place - middle).T), (value - half) / scale * window.pixel * window.pixels)
        chord = np.hypot(*(points[open_ + 1] - points[open_]).T)
        sound = (step < SETTINGS.close) & (np.hypot(*(place - middle).T) < chord)
        added = sound & (far > limit)
        checked[open_[~added]] = True
        at = open_[added] + 1
        points, column = np.insert(points, at, place[added], axis=0), np.insert(column, at, value[added])
        split = np.insert(checked, at, False)
        split[at + np.arange(at.size) - 1] = False
        checked = split
    if not checked.all():
        raise InputError(f"a curve is not drawn to {window.pixels} points by halving its chords: choose fewer")
    return points, column
