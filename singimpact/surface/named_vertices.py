"""The points of Z that have a name become vertices: where a_c = 0, and where the flight is at rest again.

tangency   (tau_*, 0): Z leaves the axis; p is folded along the horizon through it
cusp       (tau_*, t), t != 0: a cusp of phi; its mirror image on H is a cusp of p, its image on P a cusp of P
rest       x' = 0 at t != 0: P crosses Pi_0, and Z meets the mirror image of itself
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.surface.curve import Mark
from singimpact.surface.rest_flights import RestFlights
from singimpact.surface.tracing import Polyline

Array = np.ndarray[Any, Any]
CLOSE = 1e-9  # a vertex this near to a named one makes way for it
SETTLED = 1e-14  # Newton's last step, relative to 1 + |place|


@dataclass(frozen=True)
class NamedLine:
    """A polyline on Z with its named vertices; column holds x' at the other end of the flight."""

    points: Array
    column: Array
    closed: bool
    tolerance: float
    marks: tuple[Mark, ...]


@dataclass(frozen=True)
class _Named:
    after: int
    point: tuple[float, float]
    velocity: float
    name: str


def named(line: Polyline, zeros: Sequence[float], flights: RestFlights) -> NamedLine:
    """The line with its named points as vertices.

    Parameters
    ----------
    zeros : of a_c, those whose tau is in reach of the line.
    """
    clear = np.abs(line.points[:, 1]) > CLOSE
    points, column = line.points[clear], line.column[clear]
    if line.closed and not clear[0]:
        points, column = np.vstack([points, points[:1]]), np.append(column, column[:1])
    vertices = [*_tangencies(points, zeros), *_cusps(points, zeros, flights), *_rests(points, column, flights)]
    points, column, vertices = _without_crowds(points, column, vertices, line.closed)
    vertices.sort(key=lambda vertex: (vertex.after, np.hypot(*(np.array(vertex.point) - points[vertex.after]))))
    at = np.array([vertex.after + 1 for vertex in vertices], dtype=int)
    marks = [
        Mark(int(index) + shift, vertex.name) for shift, (index, vertex) in enumerate(zip(at, vertices, strict=True))
    ]
    if vertices:
        points = np.insert(points, at, np.array([vertex.point for vertex in vertices]), axis=0)
        column = np.insert(column, at, [vertex.velocity for vertex in vertices])
    if not line.closed:
        marks += [Mark(0, "end"), Mark(len(points) - 1, "end")]
    return NamedLine(points, column, line.closed, line.tolerance, tuple(marks))


def _without_crowds(
    points: Array, column: Array, vertices: list[_Named], closed: bool
) -> tuple[Array, Array, list[_Named]]:
    """The line without vertices that nearly coincide with a named one."""
    stays = np.ones(len(points), dtype=bool)
    for vertex in vertices:
        pair = np.array([vertex.after, vertex.after + 1])
        near = pair[np.abs(points[pair] - vertex.point).max(axis=1) < CLOSE]
        stays[near] = False
    if not closed:
        stays[[0, -1]] = True
    shift = np.cumsum(~stays)
    moved = [
        _Named(vertex.after - int(shift[vertex.after]), vertex.point, vertex.velocity, vertex.name)
        for vertex in vertices
    ]
    points, column = points[stays], column[stays]
    if closed and len(points) and not np.array_equal(points[0], points[-1]):
        points, column = np.vstack([points, points[:1]]), np.append(column, column[:1])
    return points, column, [_Named(max(e.after, 0), e.point, e.velocity, e.name) for e in moved]


def _tangencies(points: Array, zeros: Sequence[float]) -> list[_Named]:
    """The crossing of the line with the axis that is nearest to each zero of a_c."""
    vertices = []
    sides = np.flatnonzero(points[:-1, 1] * points[1:, 1] < 0)
    for tau in zeros:
        gaps = [
            abs(points[i : i + 2, 0].mean() - tau) - 2 * np.abs(np.diff(points[i : i + 2], axis=0)).sum() for i in sides
        ]
        if gaps and min(gaps) <= CLOSE:
            vertices.append(_Named(int(sides[int(np.argmin(gaps))]), (tau, 0.0), 0.0, "tangency"))
    return vertices


def _cusps(points: Array, zeros: Sequence[float], flights: RestFlights) -> list[_Named]:
    made = []
    for tau in zeros:
        offset = points[:, 0] - tau
        for i in np.flatnonzero((offset[:-1] >= 0) != (offset[1:] >= 0)).tolist():
            share = offset[i] / (offset[i] - offset[i + 1]) if offset[i] != offset[i + 1] else 0.5
            t = float(points[i, 1] + share * (points[i + 1, 1] - points[i, 1]))
            if points[i, 1] * points[i + 1, 1] > 0 and (settled := crossing(flights, tau, t)) is not None:
                made.append(_Named(i, (tau, settled[0]), settled[1], "cusp"))
    return made


def crossing(flights: RestFlights, tau: float, t: float) -> tuple[float, float] | None:
    """The crossing of x = c near t of the flight from tau, with x' there."""
    for _ in range(20):
        height, velocity = flights.ends(np.array([tau]), np.array([t]))
        change = -float(height[0] / velocity[0])
        t += change
        if abs(change) <= SETTLED * (1 + abs(t)):
            return t, float(velocity[0])
    return None


def _rests(points: Array, column: Array, flights: RestFlights) -> list[_Named]:
    made = []
    turns = np.flatnonzero((column[:-1] * column[1:] < 0) & (points[:-1, 1] * points[1:, 1] > 0))
    for i in turns.tolist():
        share = column[i] / (column[i] - column[i + 1])
        settled = _rest(flights, points[i] + share * (points[i + 1] - points[i]))
        if settled is not None:
            made.append(_Named(i, settled, 0.0, "rest"))
    return made


def _rest(flights: RestFlights, vertex: Array) -> tuple[float, float] | None:
    """x = c and x' = 0 together: Newton's method in (tau, t)."""
    tau, t = map(float, vertex)
    for _ in range(20):
        one, at = np.array([tau]), np.array([t])
        height, velocity = flights.ends(one, at)
        matrix = flights.rest_matrix(one, at, velocity)
        move = np.linalg.solve(matrix, -np.array([height[0], velocity[0]]))
        tau, t = tau + float(move[0]), t + float(move[1])
        if np.abs(move).max() <= SETTLED * 10 * (1 + abs(t)):
            return tau, t
    return None
