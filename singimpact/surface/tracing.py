"""A level set y = 0 in the plane as polylines: contour lines of a grid, then Newton's method, then refinement.

The contour lines are contourpy's. Small components between the samples are searched: a sample with smaller |y| than
all neighbours, and the same sign, is followed to the extremum on finer grids until the sign changes.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.inputs import Unfinished
from singimpact.surface.curve import Window

# Points -> y, its gradient, a further column, and the gradient of that.
Gradient = Callable[[Array], tuple[Array, Array, Array, Array]]
Grid = Callable[[Array, Array], Array]


@dataclass(frozen=True)
class TraceSettings:
    """Accuracy, spacing and cost of a traced curve."""

    close: float = 4e-13  # last Newton step of a vertex on the curve, relative to 1 + |coordinates|
    halvings: int = 10  # of a chord at most
    deviation: float = 0.5  # of a chord from the curve, in units of the resolution of the window
    longest: float = 6.0  # chord length, in the same units: the end of a visible part is located to within one chord
    across: float = (
        0.8  # largest sine between a chord of the contour lines and the curve, at the end where it is smaller
    )
    # divisions of a cell along tau (at most) and along t. Contour lines cut a thin component to pieces; following it by
    # continuation costs more flights than further columns, and one flight gives a whole column
    finer_tau: int = 8
    finer_t: int = 4


SETTINGS = TraceSettings()


class Untraced(Unfinished):
    """A curve that was not followed to the resolution of the window, in a window that was accepted."""


@dataclass(frozen=True)
class Polyline:
    """Vertices on the curve, a further column (x' there), whether the curve is closed, the largest last Newton step."""

    points: Array
    column: Array
    closed: bool
    tolerance: float


def traced(grid: Grid, gradient: Gradient, window: Window, cell: float, scale: float = 1.0) -> list[Polyline]:
    """The level set in a window.

    Parameters
    ----------
    grid, gradient : y on a grid; y, its gradient, a further column and the gradient of that at points.
    cell : the largest cell that resolves y. scale : of the column, beside the size of the window, for the spacing.
    """
    from contourpy import LineType, contour_generator

    axes = _axes(window, cell)
    values = grid(*axes)
    small = (_followed(seed, gradient, window, size) for seed, size in _small_ones(grid, axes, values, window))
    contours = contour_generator(*axes, values, line_type=LineType.Separate).lines(0.0)
    sketched = (*(_thinned(np.asarray(line), window.least) for line in contours if len(line) > 1), *small)
    refined = [one for line in sketched if (one := _on_curve(line, gradient, window, scale, cell)) is not None]
    lines_: list[Polyline] = []
    for line in sorted(refined, key=lambda one: -float(np.ptp(one.points, axis=0).sum())):
        if not any(_repeats(line, longer) for longer in lines_):
            lines_.append(line)
    return lines_


def _repeats(new: Polyline, old: Polyline) -> bool:
    """Whether a line lies on another: a component may be found from two extrema."""
    near = np.abs(old.points[:, None] - new.points[None, :: max(len(new.points) // 4, 1)]).max(axis=2).min(axis=0)
    return bool((near <= np.abs(np.diff(old.points, axis=0)).max()).all())


def _axes(window: Window, cell: float) -> tuple[Array, Array]:
    def axis(ends: tuple[float, float], finer: float) -> Array:
        # and at most
        return np.linspace(*ends, min(int(np.ceil(finer * cells(ends))), 600) + 1)

    def cells(ends: tuple[float, float]) -> int:
        # cells on a side of the grid, at least
        return max(int(np.ceil((ends[1] - ends[0]) / cell)), 40)

    # columns no wider than the longest chord: a finer resolution finds smaller components
    chords = window.sides[0] / (SETTINGS.longest * window.least)
    finer = float(np.clip(chords / cells(window.x), 1, SETTINGS.finer_tau))
    return axis(window.x, finer), axis(window.y, SETTINGS.finer_t)


def _thinned(line: Array, least: float) -> Array:
    """The contour line without vertices that deviate by less than half the resolution; every vertex costs flights."""
    if len(line) < 8:
        return line
    limit, indices = 0.5 * least, {0, len(line) // 3, 2 * len(line) // 3, len(line) - 1}
    waiting = list(pairwise(sorted(indices)))
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        chord = line[last] - line[first]
        inner = line[first + 1 : last] - line[first]
        away = np.abs(inner[:, 0] * chord[1] - inner[:, 1] * chord[0]) / max(np.hypot(*chord), 1e-300)
        if away.max() > limit or np.hypot(*chord) > SETTINGS.longest * least:
            middle = (first + last) // 2
            indices.add(middle)
            waiting += [(first, middle), (middle, last)]
    return line[sorted(indices)]


def _small_ones(
    grid: Grid, axes: tuple[Array, Array], values: Array, window: Window, depth: int = 0
) -> list[tuple[Array, float]]:
    """For each extremum a point beside a component that the contour lines may have missed, and a first step length."""
    tau, t = axes
    loops: list[tuple[Array, float]] = []
    for i, j in _extrema(values):
        small = Window(
            (tau[max(j - 1, 0)], tau[min(j + 1, len(tau) - 1)]),
            (t[max(i - 1, 0)], t[min(i + 1, len(t) - 1)]),
            window.resolution,
        )
        finer = np.linspace(*small.x, 17), np.linspace(*small.y, 17)
        inner = grid(*finer)
        if inner.min() < 0 < inner.max():
            index = np.unravel_index(np.argmax(inner if values[i, j] < 0 else -inner), inner.shape)
            loops.append((np.array([finer[0][index[1]], finer[1][index[0]]]), float(np.ptp(finer[0])) / 16))
        # refinements of the grid around an extremum of y
        elif depth < 3 and np.abs(inner).min() < 0.5 * np.abs(values[i, j]):
            fine = _axes(small, (small.x[1] - small.x[0]) / 16)
            loops += _small_ones(grid, fine, grid(*fine), small, depth + 1)
    return loops


def _followed(seed: Array, gradient: Gradient, window: Window, size: float) -> Array:
    """The curve through the point next to a seed, step by step along it, until it closes or leaves the window."""
    place, _, step, slope = newton(seed[None], gradient)
    if step[0] > SETTINGS.close:
        return place[:0]
    ahead = _walked(place[0], _along(slope[0]), 1, gradient, window, size)
    if len(ahead) > 1 and np.array_equal(ahead[0], ahead[-1]):
        return ahead
    return np.vstack([_walked(place[0], _along(slope[0]), -1, gradient, window, size)[:0:-1], ahead])


def _walked(start: Array, along: Array, side: int, gradient: Gradient, window: Window, size: float) -> Array:
    line, h, ahead = [start], size / 4, side * along
    # steps along a small component, at most
    for _ in range(2000):
        point, _, step, slope = newton((line[-1] + h * ahead)[None], gradient)
        turned = side * _along(slope[0])
        # a step ends where the cosine of the angle between its tangents is smaller
        if step[0] > SETTINGS.close or ahead @ turned < 0.9 or np.hypot(*(point[0] - line[-1])) > 2 * h:
            h /= 2
            continue
        line.append(point[0])
        ahead, h = turned, min(h * 1.4, size)
        if len(line) > 4 and np.hypot(*(line[-1] - line[0])) < h:
            return np.array([*line, line[0]])
        if not (window.x[0] <= point[0, 0] <= window.x[1] and window.y[0] <= point[0, 1] <= window.y[1]):
            break
    return np.array(line)


def _along(slope: Array) -> Array:
    return np.asarray(np.array([slope[1], -slope[0]]) / np.hypot(*slope))


def _extrema(values: Array) -> list[tuple[int, int]]:
    """Interior samples with |y| below that of all neighbours, which have its sign, and near zero for their spread."""
    size, inner = np.abs(values), np.s_[1:-1, 1:-1]
    shifted = [
        (
            size[1 + di : size.shape[0] - 1 + di, 1 + dj : size.shape[1] - 1 + dj],
            values[1 + di : size.shape[0] - 1 + di, 1 + dj : size.shape[1] - 1 + dj],
        )
        for di in (-1, 0, 1)
        for dj in (-1, 0, 1)
        if di or dj
    ]
    good = np.ones(size[inner].shape, dtype=bool)
    spread = np.zeros(size[inner].shape)
    for magnitude, value in shifted:
        good &= (magnitude >= size[inner]) & (np.sign(value) == np.sign(values[inner]))
        spread = np.maximum(spread, magnitude - size[inner])
    good &= size[inner] < 2 * spread
    return [(int(i) + 1, int(j) + 1) for i, j in zip(*np.nonzero(good), strict=True)]


def _on_curve(line: Array, gradient: Gradient, window: Window, scale: float, cell: float) -> Polyline | None:
    if len(line) < 2:
        return None
    points, column, step, slope = newton(line, gradient)
    if not _in_order(points, step, slope):  # thinner than a cell: the contour lines have cut it to pieces
        line = _followed(line[0], gradient, window, max(cell / 4, SETTINGS.longest * window.least))
        if len(line) < 3:
            return None
        points, column, step, _ = newton(line, gradient)
    closed = bool(np.abs(points[0] - points[-1]).max() < 1e-9) and len(points) > 3
    if closed:
        points[-1], column[-1] = points[0], column[0]
    points, column = _spaced(points, column, gradient, window, scale)
    return Polyline(points, column, closed, float(step.max()))


def _in_order(points: Array, step: Array, slope: Array) -> bool:
    """Whether all vertices have converged, and every chord is nearly tangent at one end; at a tip not at both."""
    if step.max() > SETTINGS.close:
        return False
    chord = np.diff(points, axis=0)
    length = np.hypot(*chord.T)
    with np.errstate(all="ignore"):
        along = [np.abs((chord * side).sum(axis=1)) / (length * np.hypot(*side.T)) for side in (slope[:-1], slope[1:])]
    return bool(np.all((np.minimum(*along) < SETTINGS.across) | (length < 1e-9)))


def newton(points: Array, gradient: Gradient) -> tuple[Array, Array, Array, Array]:
    """Points moved onto the curve, the further column and the gradient there; the last step over 1 + |coordinates|.

    In the order points, column, last step, gradient.
    """
    points, step, slopes = points.copy(), np.full(len(points), np.inf), np.full(points.shape, np.nan)
    column = np.full(len(points), np.nan)
    moving = np.arange(len(points))
    # steps of Newton's method
    for _ in range(12):
        y, slope, value, bend = gradient(points[moving])
        slopes[moving], column[moving] = slope, value
        move, value = _step(y, slope, value, bend)
        size = np.hypot(*move.T) / (1 + np.abs(points[moving]).max(axis=1))
        sound = np.isfinite(size)
        points[moving[sound]] += move[sound]
        column[moving[sound]] = value[sound]
        step[moving] = np.where(sound, size, np.inf)
        moving = moving[sound & (size > SETTINGS.close / 8)]
        if not moving.size:
            break
    return points, column, step, slopes


def _step(y: Array, slope: Array, column: Array, bend: Array) -> tuple[Array, Array]:
    """The Newton step to the curve, and the column there to first order."""
    with np.errstate(all="ignore"):
        move = -(y / (slope**2).sum(axis=1))[:, None] * slope
        return move, column + (bend * move).sum(axis=1)


def _spaced(points: Array, column: Array, gradient: Gradient, window: Window, scale: float) -> tuple[Array, Array]:
    """Insert vertices until no chord deviates from the curve by more than half the resolution."""
    limit = SETTINGS.deviation * window.least
    checked = np.zeros(len(points) - 1, dtype=bool)  # chords that are accurate enough
    for _ in range(SETTINGS.halvings):
        open_ = np.flatnonzero(~checked)
        if not open_.size:
            return points, column
        middle = (points[open_] + points[open_ + 1]) / 2
        half = (column[open_] + column[open_ + 1]) / 2
        chord = np.hypot(*(points[open_ + 1] - points[open_]).T)
        long = chord > SETTINGS.longest * window.least

        def shows(away: Array, apart: Array) -> Array:
            """Whether the deviation of a chord exceeds the limit."""
            return np.hypot(away, apart / scale * window.longer) > limit

        # the deviation of a chord is estimated by one Newton step from its midpoint; most chords need no more
        move, value = _step(*gradient(middle))
        near = np.hypot(*move.T) < chord
        added = ~near | shows(np.hypot(*move.T), value - half) | long
        start = np.where(near[:, None], middle + move, middle)  # a step longer than the chord is no estimate
        points_, value, step, _ = newton(start[added], gradient)
        away = np.hypot(*(points_ - middle[added]).T)
        sound = (step < SETTINGS.close) & (away < chord[added]) & (shows(away, value - half[added]) | long[added])
        added[added] = sound
        checked[open_[~added]] = True
        at = open_[added] + 1
        points, column = np.insert(points, at, points_[sound], axis=0), np.insert(column, at, value[sound])
        split = np.insert(checked, at, False)
        split[at + np.arange(at.size) - 1] = False
        checked = split
    if not checked.all():
        most = 2**SETTINGS.halvings
        raise Untraced(
            f"a curve in tau = {window.x}, t = {window.y} still leaves its chords by more than {limit:.2g} "
            f"with each cut into {most}: choose a coarser resolution or a smaller window"
        )
    return points, column
