"""`Window` and `Curve`: where to look, and an ordered polyline on an exact curve."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float, constant
from singimpact.inputs import refuse

Array = np.ndarray[Any, Any]
SURFACE, STATES = ("tau", "t"), ("tau", "v")
"""The axes of the two planes: launches with flight times, and launches."""


def window_ends(name: str, given: Any) -> tuple[float, float]:
    """The two ends (low, high) of a window, as numbers.

    Parameters
    ----------
    name : of what runs between them, for the refusal. given : two numbers in any form that the package takes.

    Raises
    ------
    InputError : not two numbers, or not in rising order.

    Examples
    --------
    >>> window_ends("v", (0, "1/2"))
    (0.0, 0.5)
    """
    if not isinstance(given, tuple | list) or len(given) != 2:
        raise refuse(f"window of {name}", given, "two numbers, the lower end first")
    low, high = (as_float(constant(f"window of {name}", end)) for end in given)
    if not low < high:
        raise refuse(f"window of {name}", given, "two numbers, the lower end first")
    return low, high


@dataclass(frozen=True)
class Window:
    """A part of the (tau, t)-plane, and how many points a picture of it is wide.

    Parameters
    ----------
    tau, t : (low, high). pixels : curves are drawn to half of such a point.
    """

    tau: tuple[float, float]
    t: tuple[float, float]
    pixels: int = 800

    @classmethod
    def read(cls, tau: Any, t: Any, pixels: Any = 800) -> Window:
        """A window from what a user gives.

        Raises
        ------
        InputError : ends that are no numbers in rising order, or a size outside 16..20000.

        Examples
        --------
        >>> Window.read(("-pi", "pi"), (-2, 2)).tau[1]
        3.141592653589793
        """
        if isinstance(pixels, bool) or not isinstance(pixels, int) or not 16 <= pixels <= 20000:
            raise refuse("pixels", pixels, "an integer from 16 to 20000")
        return cls(window_ends("tau", tau), window_ends("t", t), pixels)

    @property
    def pixel(self) -> float:
        """The size of a point of the picture, in units of time."""
        return max(self.tau[1] - self.tau[0], self.t[1] - self.t[0]) / self.pixels


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

    def marked(self, name: str) -> Array:
        """The vertices with a mark of this name, shape (m, 2)."""
        return self.points[[mark.index for mark in self.marks if mark.name == name]]

    def parts(self, chosen: Array) -> Iterable[Curve]:
        """The stretches of consecutive vertices that are chosen."""
        edges = np.flatnonzero(np.diff(np.concatenate(([0], chosen.astype(np.int8), [0]))))
        for start, stop in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
            marks = tuple(Mark(m.index - start, m.name) for m in self.marks if start <= m.index < stop)
            whole = self.closed and stop - start == len(self)
            yield Curve(self.name, self.points[start:stop], self.axes, marks, whole, self.tolerance,
                        self.visible[start:stop])  # fmt: skip


def distances(points: Array, line: Array) -> Array:
    """Of points, shape (n, 2), from a polyline, shape (m, 2) with m > 1.

    Examples
    --------
    >>> distances(np.array([[0.5, 1.0], [3.0, 0.0]]), np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.5]])).tolist()
    [0.7071067811865476, 2.0]
    """
    start, step = line[:-1], np.diff(line, axis=0)
    away = points[:, None] - start
    along = np.sum(away * step, axis=2) / np.maximum(np.sum(step**2, axis=1), 1e-300)
    off = away - np.clip(along, 0.0, 1.0)[..., None] * step
    found: Array = np.sqrt(np.sum(off**2, axis=2)).min(axis=1)
    return found
