"""`ImpactSurface`: the curves on V_c' in a window, each computed once, when it is first asked for.

Z comes from flights launched at rest.  The involution iota(tau, t) = (tau + t, -t) takes it to the horizon H; the
velocity x' at the other end takes it to the outline P = p(H) = phi(Z).  Nothing is flown twice.

Points of Z that have a name become vertices: where a_c = 0, and where the flight is at rest again.

tangency   (tau_*, 0): Z leaves the axis; p is folded along the horizon through it
cusp       (tau_*, t), t != 0: a cusp of phi; its mirror image on H is a cusp of p, its image on P a cusp of P
rest       x' = 0 at t != 0: P crosses Pi_0, and Z meets the mirror image of itself
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.contact.points import TangencyPoint, tangency_points
from singimpact.flights.impact_map import first_hit
from singimpact.flights.inverse_map import backwards
from singimpact.flights.model_numbers import fastest_rate
from singimpact.inputs import checked_keywords, require, takes_two_walls
from singimpact.oscillator.model import Oscillator
from singimpact.surface.curve import RESOLUTION, STATES, SURFACE, Curve, Mark, Window
from singimpact.surface.other_wall import TO_LAND, TO_LAUNCH, OtherWall, at_lower_wall
from singimpact.surface.rest_flights import RestFlights
from singimpact.surface.tracing import Polyline, traced

# The points of Z that have a name become its vertices.

CLOSE = 1e-9  # a vertex this near to a named one makes way for it
SETTLED = 1e-14  # Newton's last step, relative to 1 + |place|


def _parts(line: Curve, chosen: Array) -> list[Curve]:
    """The parts of consecutive chosen vertices, their new ends marked "cut"."""
    last = len(line) - 1
    if line.closed and not chosen.all():  # begins where it is not chosen
        first = int(np.argmin(chosen))
        turned = (np.arange(last + 1) + first) % last
        marks = tuple(Mark((mark.index - first) % last, mark.name) for mark in line.marks)
        line, chosen = replace(line, points=line.points[turned], marks=marks, closed=False), chosen[turned]
    pieces = [piece for piece in line.parts(chosen) if len(piece) > 1]
    for at, piece in enumerate(pieces):
        new = {0, len(piece) - 1} - {mark.index for mark in piece.marks}
        if not piece.closed:
            pieces[at] = replace(piece, marks=(*piece.marks, *(Mark(end, "cut") for end in new)))
    return pieces


@dataclass(frozen=True)
class _Named:
    after: int
    point: tuple[float, float]
    velocity: float
    name: str


def named(line: Polyline, zeros: Sequence[float], flights: RestFlights) -> Curve:
    """The line with its named points as vertices, and the column x' at the other end of the flight.

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
    return Curve("lines", np.column_stack([points, column]), SURFACE, tuple(marks), line.closed, line.tolerance)


def _without_crowds(
    points: Array, column: Array, vertices: list[_Named], closed: bool
) -> tuple[Array, Array, list[_Named]]:
    """The line without vertices that nearly coincide with a named one."""
    stays = np.ones(len(points), dtype=bool)
    for vertex in vertices:
        pair = np.array([vertex.after, vertex.after + 1])
        stays[pair[np.abs(points[pair] - vertex.point).max(axis=1) < CLOSE]] = False
    if not closed:
        stays[[0, -1]] = True
    shift = np.cumsum(~stays)
    moved = [replace(vertex, after=max(vertex.after - int(shift[vertex.after]), 0)) for vertex in vertices]
    points, column = points[stays], column[stays]
    if closed and len(points) and not np.array_equal(points[0], points[-1]):
        points, column = np.vstack([points, points[:1]]), np.append(column, column[:1])
    return points, column, moved


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
    for i in np.flatnonzero((column[:-1] * column[1:] < 0) & (points[:-1, 1] * points[1:, 1] > 0)).tolist():
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
        move = np.linalg.solve(flights.rest_matrix(one, at, velocity), -np.array([height[0], velocity[0]]))
        tau, t = tau + float(move[0]), t + float(move[1])
        if np.abs(move).max() <= SETTLED * 10 * (1 + abs(t)):
            return tau, t
    return None


@dataclass(frozen=True)
class Cusp:
    """A flight from rest at a tangency point that crosses c again: phi has a cusp there, p at its mirror image.

    Attributes
    ----------
    tau, t : the point of Z, a_c(tau) = 0: the cusp of phi [p:phising]. velocity : x' at the other end.
    """

    tau: float
    t: float
    velocity: float

    @property
    def of_p(self) -> tuple[float, float]:
        """The cusp of p, on H: (tau, t) of the flight that lands at rest on the tangency point."""
        return self.tau + self.t, -self.t

    @property
    def image(self) -> tuple[float, float]:
        """(tau, v) of the cusp of P, the image of both."""
        return self.tau + self.t, self.velocity


NOWHERE = np.zeros(0, dtype=bool)
CELLS_A_RADIAN = 6  # of the sketch, of the fastest rate that the model shows
SAME = 1e-6  # a vertex is the first hit when that comes at its time: two crossings nearer than this are one


class ImpactSurface:
    """V_c' of a model in a window of the (tau, t)-plane.

    Parameters
    ----------
    osc : the oscillator. tau, t : ends of the window; t of either sign, or a polynomial's zeros are cut off.
    resolution : a share of the window's longer side; chords of the curves stay within half of it.
    wall : of a model with two: the one that the surface is of, "lower" (also without it) or "upper".

    Attributes
    ----------
    window : as read. flights : computed so far. model : whose lower wall is this one, with x -> -x at an upper wall.

    Notes
    -----
    A flight that meets the other wall leaves V_c': all curves end at the `cut`, to within one chord.

    Examples
    --------
    >>> surface = ImpactSurface(Oscillator("0", "12*(t**2 - 1)", 0, "1/2"), (-4, 4), (-6, 6))
    >>> [(curve.closed, len(curve.marked("tangency"))) for curve in surface.zero_set]
    [(True, 2)]
    """

    @checked_keywords
    @takes_two_walls
    def __init__(
        self, osc: Oscillator, tau: Any, t: Any, resolution: Any = RESOLUTION.usual, *, wall: object = None
    ) -> None:
        require(isinstance(osc, Oscillator), "osc", osc, "an ImpactOscillator")
        self.model, self.window = osc.seen_from(wall), Window.read(tau, t, resolution)
        self._rest = RestFlights(self.model)
        self._other = None if osc.upper is None else OtherWall(self.model)

    def __repr__(self) -> str:
        (a, b), (c, d) = self.window.x, self.window.y
        return (
            f"ImpactSurface(tau from {a:.6g} to {b:.6g}, t from {c:.6g} to {d:.6g}, clearance {self.model.clearance})"
        )

    def take(self, **found: list[Any]) -> None:
        """Use lines, horizon, ... of the same model and window that were computed before."""
        vars(self).update(found)

    @property
    def flights(self) -> int:
        """Flights computed so far."""
        return self._rest.flown

    @cached_property
    def tangencies(self) -> tuple[TangencyPoint, ...]:
        """The zeros of a_c with tau in the window, those of one period repeated."""
        return tuple(point for point, _ in self.placed_tangencies)

    @cached_property
    def placed_tangencies(self) -> list[tuple[TangencyPoint, float]]:
        """Each zero of a_c with its time in the window: that of its own period, moved by whole ones."""
        points = tangency_points(self.model)
        low, high = self.window.x
        if self.model.period is None:
            return [(point, point.tau) for point in points if low <= point.tau <= high]
        period = as_float(self.model.period)
        turns = range(int(np.floor(low / period)) - 1, int(np.ceil(high / period)) + 1)
        found = [(point, point.tau + n * period) for n in turns for point in points]
        return [(point, tau) for point, tau in found if low <= tau <= high]

    @cached_property
    def lines(self) -> list[Curve]:
        """Z with its named points and a column x' at the other end; H and P follow from it by symmetry."""
        return self.divided[0]

    @cached_property
    def divided(self) -> tuple[list[Curve], list[Curve]]:
        """`lines`, and those parts of Z whose flights meet the other wall."""
        plain = traced(self._rest.grid, self._rest.y_and_gradient, self.window, self._cell, self._speed)
        zeros = [tau for _, tau in self.placed_tangencies]
        lines = [named(line, zeros, self._rest) for line in plain]
        if self._other is None:
            return lines, []
        met = [self._other.is_met(*line.points[:, :2].T) for line in lines]
        inside, outside = (
            [piece for line, chosen in zip(lines, sides, strict=True) for piece in _parts(line, chosen)]
            for sides in ([~chosen for chosen in met], met)
        )
        return inside, outside

    @property
    def _cell(self) -> float:
        return 1 / (CELLS_A_RADIAN * fastest_rate(self.model))

    @cached_property
    def _speed(self) -> float:
        """A size of the velocities in the window, for the spacing of P."""
        tau = np.linspace(*self.window.x, 65)
        return float(np.abs(self._rest.acceleration(tau)).max() * max(map(abs, self.window.y)) / 8 or 1.0)

    @cached_property
    def zero_set(self) -> list[Curve]:
        """Z: (tau, t) with v_c = 0, t != 0; `visible` where it is a first hit [s2-zero-set]."""
        first = partial(self._are_first, model=self.model, sign=1)
        return [_curve("Z", line.points[:, :2], SURFACE, line, partial(first, line)) for line in self.lines]

    @cached_property
    def horizon(self) -> list[Curve]:
        """H = iota(Z): (tau, t) where the flight lands with velocity 0; `visible` where it does so first."""
        first = partial(self._are_first, model=backwards(self.model), sign=-1)
        return [_curve("H", _involved(line), SURFACE, line, partial(first, line)) for line in self.lines]

    @cached_property
    def outline(self) -> list[Curve]:
        """P = p(H) = phi(Z): (tau, v) of the launches that graze."""
        pairs = ((line, partial(getattr, back, "visible")) for line, back in zip(self.lines, self.horizon, strict=True))
        return [
            _curve("P", np.stack([line.points[:, :2].sum(axis=1), line.points[:, 2]], axis=1), STATES, line, visible)
            for line, visible in pairs
        ]

    @cached_property
    def beyond(self) -> list[Curve]:
        """The parts of Z and H that a second wall takes away: their flights meet it."""
        lines = [replace(line, marks=()) for line in self.divided[1]]
        return [
            _curve("beyond", points, SURFACE, line)
            for line in lines
            for points in (line.points[:, :2], _involved(line))
        ]

    @cached_property
    def cut(self) -> list[Curve]:
        """The edge of V_c' at a second wall: (tau, t) of flights from impact to impact that graze it on their way."""
        return self._cut(TO_LAND, SURFACE)

    def _cut(self, columns: tuple[int, int], axes: tuple[str, str]) -> list[Curve]:
        pieces = [] if self._other is None else self._other.cut(self.window, columns, self._cell)
        return [Curve("cut", piece, axes, first_hits=np.ones(len(piece), dtype=bool)) for piece in pieces]

    @cached_property
    def discontinuities(self) -> list[Curve]:
        """The discontinuities of G: the visible part of P, and the launches that graze a second wall, named "cut"."""
        visible = [part for curve in self.outline for part in curve.parts(_to_the_end(curve)) if len(part) > 1]
        return visible + self._cut(TO_LAUNCH, STATES)

    @cached_property
    def cusps(self) -> list[Cusp]:
        """The cusps of p and phi in the window."""
        cusps = [
            Cusp(*map(float, line.points[mark.index]))
            for line in self.lines
            for mark in line.marks
            if mark.name == "cusp"
        ]
        return sorted(cusps, key=lambda cusp: (cusp.tau, cusp.t))

    @cached_property
    def shadow(self) -> list[Curve]:
        """The next hit behind the visible horizon, for the same launches: curves in (tau, t)."""
        found = []
        for line, curve in zip(self.lines, self.horizon, strict=True):
            ahead = self._hits(self.model, line.points[:, 0], curve.visible)
            behind = np.stack([curve.points[:, 0], curve.points[:, 1] + ahead], axis=1)
            made = Curve("S", behind, SURFACE, (), curve.closed, line.tolerance, curve.visible)
            found += [part for part in made.parts(curve.visible & np.isfinite(ahead)) if len(part) > 1]
        return found

    def _are_first(self, line: Curve, model: Oscillator, sign: int) -> Array:
        """Whether t, of that sign, is the first hit of the flight from rest; run back, the graze is first then."""
        tau, t = sign * line.points[:, :2].T
        hits = self._hits(model, tau, t > 0)
        with np.errstate(invalid="ignore"):
            return np.asarray(np.isfinite(hits) & (t > 0) & (np.abs(hits - t) <= SAME * (1 + t)))

    def _hits(self, model: Oscillator, tau: Array, wanted: Array) -> Array:
        """The times of first hits from rest; nan where there is none or it is not requested."""
        self._rest.flown += int(wanted.sum())
        times = np.full(len(tau), np.nan)
        hit = first_hit(model, tau[wanted], np.zeros(int(wanted.sum())))
        times[wanted] = np.where(at_lower_wall(hit), hit.flight_time, np.nan)
        return times


def _involved(line: Curve) -> Array:
    """The vertices of H that belong to those of Z."""
    return np.stack([line.points[:, :2].sum(axis=1), -line.points[:, 1]], axis=1)


def _curve(
    name: str, points: Array, axes: tuple[str, str], line: Curve, first: Callable[[], Array] | Array = NOWHERE
) -> Curve:
    return Curve(name, points, axes, line.marks, line.closed, line.tolerance, first)


def _to_the_end(curve: Curve) -> Array:
    """The visible parts, extended to the named vertices at their ends: a tangency, a cusp, rest."""
    chosen = curve.visible.copy()
    for mark in curve.marks:
        beside = [mark.index - 1, mark.index + 1]
        if mark.name not in ("end", "cut") and any(0 <= i < len(curve) and curve.visible[i] for i in beside):
            chosen[mark.index] = True
    return chosen
