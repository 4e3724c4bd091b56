"""`Window` and `Curve`: a part of a plane, and an ordered polyline on an exact curve."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.inputs import refuse, require

SURFACE, STATES = ("tau", "t"), ("tau", "v")  # the axes of the two planes: launches with flight times, and launches


def window_ends(name: str, window: Any) -> tuple[float, float]:
    """The two ends (low, high) of a window, as numbers.

    Parameters
    ----------
    name : of the quantity, for the error message. window : two numbers in any form that the package takes.

    Raises
    ------
    InputError : not two numbers, or not in rising order.

    Examples
    --------
    >>> window_ends("v", (0, "1/2"))
    (0.0, 0.5)
    """
    if not isinstance(window, tuple | list) or len(window) != 2:
        raise refuse(f"window of {name}", window, "two numbers, the lower end first")
    low, high = (as_float(constant(f"window of {name}", end)) for end in window)
    require(low < high, f"window of {name}", window, "two numbers, the lower end first")
    return low, high


@dataclass(frozen=True)
class ResolutionSettings:
    """Resolutions of curves, as parts of the window."""

    usual: float = 1 / 800  # half the width of a line in a picture as wide as a page
    coarsest: float = 1 / 16  # a coarser polyline does not show a curve
    finest: float = 1e-6  # a curve through the window has about 1/(6 resolution) vertices


RESOLUTION = ResolutionSettings()


@dataclass(frozen=True)
class Window:
    """A part of a plane, and the smallest length in it that matters.

    Attributes
    ----------
    x, y : (low, high) of the two axes: tau and t on V_c', tau and v in the plane of states.
    resolution : a length in units of the window, that is a share of its side; of the longer one where both axes have
        one unit.  Chords of a curve stay within half of it.
    """

    x: tuple[float, float]
    y: tuple[float, float]
    resolution: float = RESOLUTION.usual

    @classmethod
    def read(cls, x: Any, y: Any, resolution: Any = RESOLUTION.usual, axes: tuple[str, str] = SURFACE) -> "Window":
        """A window from what a user gives; `axes` are the names of the two ranges.

        Raises
        ------
        InputError : ends that are no numbers in rising order, or a resolution outside 1e-6..1/16.

        Examples
        --------
        >>> Window.read(("-pi", "pi"), (-2, 2)).x[1]
        3.141592653589793
        """
        ends = window_ends(axes[0], x), window_ends(axes[1], y)
        share = as_float(constant("resolution", resolution))
        if not RESOLUTION.finest <= share <= RESOLUTION.coarsest:
            raise refuse("resolution", resolution, "a share of the window from 1e-6 to 1/16")
        return cls(*ends, share)

    @property
    def sides(self) -> Array:
        """The lengths of both sides, each in its own unit."""
        return np.array([self.x[1] - self.x[0], self.y[1] - self.y[0]])

    @property
    def longer(self) -> float:
        """The length of the longer side, where both have one unit."""
        return float(self.sides.max())

    @property
    def least(self) -> float:
        """The resolution in the unit of the axes, where both have one."""
        return self.longer * self.resolution


@dataclass(frozen=True)
class Mark:
    """A vertex of a curve with a name: cusp, crossing, end, tangency, A, B, ..."""

    index: int
    name: str


@dataclass(frozen=True)
class Curve:
    """An ordered polyline whose vertices lie on an exact curve.

    Attributes
    ----------
    name : Z, H, P, ... points : shape (n, 2). axes : names of the two columns.
    marks : named vertices. closed : the last vertex is the first again.
    tolerance : bound on the distance of a vertex from the curve, measured.
    first_hits : what `visible` is, or a function that finds it: its flights are flown when somebody asks.
    """

    name: str
    points: Array
    axes: tuple[str, str]
    marks: tuple[Mark, ...] = ()
    closed: bool = False
    tolerance: float = 0.0
    first_hits: Array | Callable[[], Array] = field(default_factory=lambda: np.zeros(0, dtype=bool), repr=False)

    @cached_property
    def visible(self) -> Array:
        """Bool for each vertex: it is a first hit."""
        return self.first_hits() if callable(self.first_hits) else self.first_hits

    def __len__(self) -> int:
        return len(self.points)

    def __repr__(self) -> str:
        ends = [", ".join(f"{place:.6g}" for place in self.points[end]) for end in (0, -1)] if len(self) else []
        where = "closed" if self.closed else f"from ({ends[0]}) to ({ends[1]})" if ends else "empty"
        return f"Curve({self.name}: {len(self)} points in ({', '.join(self.axes)}), {where})"

    def marked(self, name: str) -> Array:
        """The vertices with a mark of this name, shape (m, 2)."""
        return self.points[[mark.index for mark in self.marks if mark.name == name]]

    def parts(self, chosen: Array) -> "Iterable[Curve]":
        """The parts of consecutive chosen vertices."""
        edges = np.flatnonzero(np.diff(np.concatenate(([0], chosen.astype(np.int8), [0]))))
        for start, stop in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
            marks = tuple(Mark(m.index - start, m.name) for m in self.marks if start <= m.index < stop)
            whole = self.closed and stop - start == len(self)
            yield Curve(
                self.name, self.points[start:stop], self.axes, marks, whole, self.tolerance, self.visible[start:stop]
            )


def distances(points: Array, line: Array) -> Array:
    """Distances of points, shape (n, 2), from a polyline, shape (m, 2) with m > 1.

    Examples
    --------
    >>> distances(np.array([[0.5, 1.0], [3.0, 0.0]]), np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5]])).tolist()
    [0.7071067811865476, 2.0]
    """
    start, step = line[:-1], np.diff(line, axis=0)
    away = points[:, None] - start
    along = np.sum(away * step, axis=2) / np.maximum(np.sum(step**2, axis=1), 1e-300)
    off = away - np.clip(along, 0.0, 1.0)[..., None] * step
    nearest: Array = np.sqrt(np.sum(off**2, axis=2)).min(axis=1)
    return nearest
