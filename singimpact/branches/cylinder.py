"""Polylines on the cylinder of phases and velocities: how near points are to them, and where two of them cross.

Points are (tau, v), shape (m, 2); sides are the period and the unit of v.  Lengths are in these units.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

Array = np.ndarray[Any, Any]
ROUND = (1.0, 0.0)  # the circumference of a cylinder of placed points, and none along it, for scipy's trees
TREES = 8  # more trees than this are joined to one: it is searched faster


def apart(differences: Array, sides: Array) -> Array:
    """Lengths of differences of states, the shortest way round the cylinder."""
    away = differences / sides
    away[..., 0] -= np.rint(away[..., 0])
    return np.asarray(np.hypot(away[..., 0], away[..., 1]))


def placed(points: Array, sides: Array) -> Array:
    """Phases in [0, 1) and velocities, in units of the sides.

    Examples
    --------
    >>> placed(np.array([[-0.5, 1.0]]), np.array([2.0, 4.0])).tolist()
    [[0.75, 0.25]]
    """
    scaled = points / sides
    scaled[:, 0] -= np.floor(scaled[:, 0])
    scaled[:, 0][scaled[:, 0] >= 1.0] = 0.0  # -1e-20 and its like
    return np.asarray(scaled)


def filled(line: Array, sides: Array, fine: float) -> tuple[Array, Array]:
    """Placed points along a polyline, neighbours at most `fine` apart, and the chord of each.

    Examples
    --------
    >>> points, chords = filled(np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5]]), np.ones(2), 0.5)
    >>> points.tolist(), chords.tolist()
    ([[0.0, 0.0], [0.5, 0.0], [0.0, 0.0], [0.0, 0.5]], [0, 0, 1, 1])
    """
    step = np.diff(line, axis=0)
    counts = np.maximum(1, np.ceil(np.hypot(*(step / sides).T) / fine)).astype(int)
    chords = np.repeat(np.arange(len(step)), counts)
    share = (np.arange(len(chords)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[chords]
    points = np.vstack([line[chords] + share[:, None] * step[chords], line[-1:]])
    return placed(points, sides), np.append(chords, max(len(step) - 1, 0))


@dataclass
class Nearby:
    """Polylines that are there, and whether others are apart from them.

    Parameters
    ----------
    sides : of the cylinder. near : points nearer than this to a polyline are on it, to a fifth.
    """

    sides: Array
    near: float
    trees: list[Any] = field(default_factory=list)

    def add(self, lines: Sequence[Array]) -> None:
        """Polylines more."""
        from scipy.spatial import KDTree

        if lines:
            points = np.vstack([filled(line, self.sides, self.near)[0] for line in lines])
            self.trees.append(KDTree(points, boxsize=ROUND))
        if len(self.trees) > TREES:
            self.trees = [KDTree(np.vstack([tree.data for tree in self.trees]), boxsize=ROUND)]

    def all_on(self, points: Array) -> bool:
        """Whether every point is on a polyline."""
        left = placed(points, self.sides)
        for tree in self.trees:
            # points half of `near` along the line from a filled one are 1.12 near away at most
            left = left[~np.isfinite(tree.query(left, distance_upper_bound=1.2 * self.near)[0])]
            if not len(left):
                return True
        return not len(left)


def distances(points: Array, lines: Sequence[Array], sides: Array, fine: float) -> Array:
    """Of points from the nearest of some polylines, shape (m,).

    Parameters
    ----------
    fine : the nearest chord is looked for among points so far apart; it does not limit the accuracy by more than its
        square.

    Examples
    --------
    >>> line = np.array([[0.5, 0.0], [0.9, 0.0], [1.2, 0.0]])
    >>> distances(np.array([[0.1, 0.3], [0.7, 0.1]]), [line], np.ones(2), 0.01).round(12).tolist()
    [0.3, 0.1]
    """
    from scipy.spatial import KDTree

    if not lines:
        return np.full(len(points), np.inf)
    parts = [filled(line, sides, fine) for line in lines]
    first = np.cumsum([0, *(len(line) for line in lines[:-1])])  # of each line among all vertices
    vertices = np.vstack(lines) / sides
    chords = np.concatenate([samples[1] + at for samples, at in zip(parts, first, strict=True)])
    last = np.concatenate(
        [np.full(len(samples[1]), at + len(line) - 2) for samples, at, line in zip(parts, first, lines, strict=True)]
    )
    begin = np.concatenate([np.full(len(samples[1]), at) for samples, at in zip(parts, first, strict=True)])
    at = placed(points, sides)
    nearest = KDTree(np.vstack([samples[0] for samples in parts]), boxsize=ROUND).query(at)[1]
    best = np.full(len(points), np.inf)
    for shift in (-1, 0, 1):
        chord = np.clip(chords[nearest] + shift, begin[nearest], np.maximum(last[nearest], begin[nearest]))
        start, step = vertices[chord], vertices[np.minimum(chord + 1, len(vertices) - 1)] - vertices[chord]
        away = at - start
        away[:, 0] -= np.rint(away[:, 0] - step[:, 0] / 2)
        along = np.sum(away * step, axis=1) / np.maximum(np.sum(step**2, axis=1), 1e-300)
        best = np.minimum(best, np.hypot(*(away - np.clip(along, 0, 1)[:, None] * step).T))
    return best


@dataclass(frozen=True)
class Meeting:
    """Chords that cross: their places among those of either side, and how far along each the point is, in [0, 1)."""

    one: Array
    other: Array
    along: Array
    across: Array


def meetings(one: tuple[Array, Array], other: tuple[Array, Array]) -> Meeting:
    """Crossings of chords, given by starts and steps in units of the sides, each of shape (m, 2).

    Examples
    --------
    >>> level, upright = np.array([[[0.9, 0.5]], [[0.2, 0.0]]]), np.array([[[0.0, 0.4]], [[0.0, 0.2]]])
    >>> found = meetings(tuple(level), tuple(upright))
    >>> found.along.round(12).tolist(), found.across.round(12).tolist()
    ([0.5], [0.5])
    """
    from scipy.spatial import KDTree

    none = np.zeros(0, dtype=int)
    if not len(one[0]) or not len(other[0]):
        return Meeting(none, none, np.zeros(0), np.zeros(0))
    trees = [KDTree(placed(start + step / 2, np.ones(2)), boxsize=ROUND) for start, step in (one, other)]
    reach = sum(float(np.hypot(*step.T).max()) for _, step in (one, other)) / 2
    pairs = trees[0].query_ball_tree(trees[1], reach)
    i = np.repeat(np.arange(len(pairs)), [len(partners) for partners in pairs])
    j = np.array([k for partners in pairs for k in partners], dtype=int)
    u, w = one[1][i], other[1][j]
    gap = other[0][j] - one[0][i]
    gap[:, 0] -= np.rint(gap[:, 0] + (w - u)[:, 0] / 2)
    with np.errstate(all="ignore"):
        area = u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0]
        along = (gap[:, 0] * w[:, 1] - gap[:, 1] * w[:, 0]) / area
        across = (gap[:, 0] * u[:, 1] - gap[:, 1] * u[:, 0]) / area
    hit = np.flatnonzero((along >= 0) & (along < 1) & (across >= 0) & (across < 1))
    return Meeting(i[hit], j[hit], along[hit], across[hit])
