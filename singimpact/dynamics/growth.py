"""An invariant curve of a map, grown image by image from a fundamental piece, and cut at discontinuities.

The images of a fundamental piece follow one another without a gap.  A piece is a function of one parameter s. At a
discontinuity between two neighbours in s the flight grazes, and the curve is split there by its hit history.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.surface.curve import Window, distances


@dataclass(frozen=True)
class GrowthSettings:
    """Settings of the growth of curves; lengths are in units of the resolution of the window."""

    longest: float = 8.0  # maximal chord length
    bend: float = 0.5  # deviation of a vertex from the chord of its neighbours that is refined
    graze: float = 0.01  # an arc ends at a graze like a square root: its end is located to within this length
    most: int = 4000  # points of a piece at most
    generations: int = 60  # images at most


SETTINGS = GrowthSettings()
# Ends of a piece: that of its fundamental piece, or an earlier cut; a discontinuity; the edge of the window that is
# followed; a point without an image
NATURAL, TORN, LEFT, LOST = "", "torn", "left", "lost"


@dataclass(frozen=True)
class Piece:
    """A stretch of one generation: parameters s in order, their points, how often the map takes them to the start.

    Parameters
    ----------
    ends : how its first and its last point came to be ends. coarse : points ran out before it was resolved.
    """

    s: Array
    points: Array
    generation: int
    ends: tuple[str, str] = (NATURAL, NATURAL)
    coarse: bool = False


@dataclass(frozen=True)
class Carried:
    """A curve that a map carries over itself.

    Parameters
    ----------
    window : its sides and resolution are the units of length.
    start : points of the fundamental piece, from s. step : points of the next generation, from those of a generation
        and its number; nan where there are none.
    shown : which points lie where the curve is resolved. followed : which are carried on. most : points of a piece.
    located : discontinuities are located to the graze, or to rounding in s, not only to the resolution.
    """

    window: Window
    start: Callable[[Array], Array]
    step: Callable[[Array, int], Array]
    shown: Callable[[Array], Array]
    followed: Callable[[Array], Array]
    most: int = SETTINGS.most
    located: bool = False

    def image(self, s: Array, generation: int) -> Array:
        """The points of a generation."""
        points = self.start(s)
        for count in range(generation):
            points = self.step(points, count)
        return points

    def first(self, inner: float, outer: float) -> Piece:
        """The fundamental piece between two values of s."""
        # points of the fundamental piece, 100 resolutions apart
        count = max(4, round(1 / self.window.resolution) // 100 + 1)
        s = np.linspace(inner, outer, count)
        return Piece(s, self.start(s), 0)

    def refined(self, piece: Piece) -> Piece:
        """A piece refined to the resolution, without a discontinuity."""
        s, points, coarse = self._refined(piece.s, piece.points, piece.generation)
        return Piece(s, points, piece.generation, piece.ends, coarse)

    def images(self, piece: Piece) -> list[Piece]:
        """The image of a piece, refined to the resolution, in parts without a discontinuity."""
        generation = piece.generation + 1
        s, points, coarse = self._refined(piece.s, self.step(piece.points, piece.generation), generation)
        # neighbours in s so far apart have a discontinuity between them
        jump = np.hypot(*(np.diff(points, axis=0) / self.window.sides).T) > 8.0 * self.window.resolution
        torn: Array = np.asarray(jump & (np.abs(np.diff(s)) <= closest(self.window) * np.ptp(piece.s)))
        if self.located and torn.any():
            s, points, torn = self._located(s, points, np.flatnonzero(torn), generation)
        finite: Array = np.asarray(np.isfinite(points).all(axis=1))
        with np.errstate(invalid="ignore"):
            followed: Array = finite & self.followed(points)
        cuts: Array = np.flatnonzero(torn | ~followed[1:] | ~followed[:-1]) + 1
        parts = [
            indices for indices in np.split(np.arange(len(s)), cuts) if len(indices) > 1 and followed[indices].all()
        ]

        def end(beyond: int, before: str) -> str:
            if not 0 <= beyond < len(s):
                return before
            return TORN if followed[beyond] else LEFT if finite[beyond] else LOST

        return [
            Piece(
                s[indices],
                points[indices],
                generation,
                (end(int(indices[0]) - 1, piece.ends[0]), end(int(indices[-1]) + 1, piece.ends[1])),
                coarse or piece.coarse,
            )
            for indices in parts
        ]

    def _refined(self, s: Array, points: Array, generation: int) -> tuple[Array, Array, bool]:
        """Midpoints put in until chords are short or straight enough for the resolution, or their ends close in s."""
        least = closest(self.window) * np.ptp(s)
        for _ in range(60):
            at = np.flatnonzero(self._too_coarse(points) & (np.abs(np.diff(s)) > least))
            if not at.size:
                return s, points, False
            if len(s) + at.size > self.most:
                return s, points, True
            middle = (s[at] + s[at + 1]) / 2
            s, points = np.insert(s, at + 1, middle), np.insert(points, at + 1, self.image(middle, generation), axis=0)
        return s, points, False

    def _located(self, s: Array, points: Array, at: Array, generation: int) -> tuple[Array, Array, Array]:
        """Further points on both sides of discontinuities, by bisection in s, and the chords across them.

        A middle belongs to the end that it is nearer to. A curve that ends like a square root gets points in geometric
        sequence.
        """
        ends = [s[at].copy(), s[at + 1].copy()]
        places = [points[at].copy(), points[at + 1].copy()]
        low = SETTINGS.graze * self.window.resolution * self.window.sides[1]
        more = [(s, points)]
        # halvings of s at a discontinuity
        for _ in range(60):
            middle = (ends[0] + ends[1]) / 2
            apart = (middle != ends[0]) & (middle != ends[1])
            # an end at rest is where a flight grazes: nearer to it flights are dear, and the curve is no longer
            apart &= np.minimum(places[0][:, 1], places[1][:, 1]) > low
            if not apart.any():
                break
            image = np.full(places[0].shape, np.nan)
            image[apart] = self.image(middle[apart], generation)
            gaps = [np.hypot(*((image - end_points) / self.window.sides).T) for end_points in places]
            first = gaps[0] <= gaps[1]  # of nan neither is true
            for end, chosen in ((0, first), (1, gaps[0] > gaps[1])):
                ends[end][chosen], places[end][chosen] = middle[chosen], image[chosen]
                more.append((middle[chosen], image[chosen]))
        s, points = np.concatenate([segment[0] for segment in more]), np.vstack([segment[1] for segment in more])
        order = np.argsort(s, kind="stable") if ends[0][0] < ends[1][0] else np.argsort(-s, kind="stable")
        return s[order], points[order], np.isin(s[order][:-1], ends[0])

    def _too_coarse(self, points: Array) -> Array:
        """Chords too long for the resolution, or at a bend beyond it; or with one end that is not known."""
        resolution = self.window.resolution
        finite: Array = np.asarray(np.isfinite(points).all(axis=1))
        near: Array = np.logical_or(self.shown(points), ~finite)
        step = np.diff(points, axis=0) / self.window.sides
        length = np.hypot(*step.T)
        with np.errstate(all="ignore"):
            cross = np.abs(step[:-1, 0] * step[1:, 1] - step[:-1, 1] * step[1:, 0])
            off = cross / np.maximum(np.hypot(*(step[:-1] + step[1:]).T), 1e-300)
        bend = np.zeros(len(length), dtype=bool)
        bend[:-1] |= off > SETTINGS.bend * resolution
        bend[1:] |= off > SETTINGS.bend * resolution
        coarse = (length > min(SETTINGS.longest * resolution, 1 / 25)) | (bend & (length > resolution))
        return np.asarray((near[:-1] | near[1:]) & ((finite[:-1] != finite[1:]) | (finite[:-1] & finite[1:] & coarse)))


def closest(window: Window) -> float:
    """The step in s, as a part of a piece, below which neighbours far apart in the window lie beside a discontinuity.

    Examples
    --------
    >>> closest(Window((0, 1), (0, 1), 0.01))
    1e-08
    """
    return float((SETTINGS.graze * window.resolution) ** 2)


def held(window: Window, points: Array) -> Array:
    """Which points lie in the window; v has no lower end, for no state has v < 0."""
    tau, v = points.T
    return np.asarray((tau >= window.x[0]) & (tau <= window.x[1]) & (v <= window.y[1]))


def adds(piece: Piece, before: list[Piece], window: Window) -> bool:
    """Whether a piece is resolved from those of one generation before, so that growing it on adds something new.

    Loops of stable manifolds accumulate on gamma: each generation has one more, soon nearer than a line is wide.
    """
    seen = piece.points[held(window, piece.points)] / window.sides
    gaps = [distances(seen, old.points / window.sides) for old in before]
    # nearer to the generation before the growth ends
    return not len(seen) or bool(np.min(gaps, axis=0).max() > 0.25 * window.resolution)
