"""Flights with two rests or more of any model with a period, over any number: met on a grid of its values.

A tacnode is a flight from rest at s with x = c, x' = 0 where dx/dv = 0 first, or for the n-th time, after s: on a grid
of s and of the number two functions vanish together.  A motion with the period T that grazes is at rest at s and at
s + T: likewise.  Three rests: at a value of the number the flights with rests at s and s + d are the zeros of
(x - c, x') in s and d; two of them are followed until their times s agree.
"""

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from singimpact.algebra.expressions import multiply, number, subtract
from singimpact.algebra.numbers import Array, as_float, sign_of
from singimpact.flights.flight_path import many_paths
from singimpact.surface.rest_flights import RestFlights
from singimpact.surface.swan_families import Family
from singimpact.surface.two_rests import GRID, LinearRests, Rests, distinct, is_whole, linear_rests, newton


@dataclass(frozen=True)
class FollowSettings:
    """The grid.

    columns : times s of a rest a period. rows : values of the number between its ends. levels : of these, where two
    rests are looked for, to be followed. fine, rate : step of d, in parts of the period or of `rate` where that is
    less, for flights turn by their own rate too. reach : distance in (s, d) between neighbouring levels below which two
    points may be one branch. push : velocity by which dx/dv is met.
    flat : a_c at both rests of a flight that may go from tangency to tangency.
    """

    columns: int = 48
    rows: int = 60
    levels: int = 20
    fine: float = 0.06
    rate: float = 2.5
    reach: float = 0.5
    push: float = 1e-4
    flat: float = 1e-2


GRID_OF = FollowSettings()


class Level(NamedTuple):
    """Two rests at one value of the number.

    value : of it. places : (s, d), shape (n, 2). signs : of a(s), a(s + d) and dx/dv there, shape (n, 3).
    """

    value: float
    places: Array
    signs: Array


class FollowedRests:
    """Two rests or more over a number.

    Parameters
    ----------
    family : the model and the number, with a period. ends : of it. gaps : the least and the longest d.
    """

    def __init__(self, family: Family, ends: tuple[float, float], gaps: tuple[float, float]) -> None:
        self.family, self.ends, self.gaps = family, ends, (max(GRID.least, gaps[0]), gaps[1])
        periods = family.periods(np.linspace(*ends, GRID_OF.rows + 1))
        self.longest, self.values = max(periods.values(), default=0.0), np.array(sorted(periods))
        self.share = np.linspace(-1 / GRID_OF.columns, 1 + 1 / GRID_OF.columns, GRID_OF.columns + 3)

    def met(self, wanted: Collection[str]) -> list[Rests]:
        """Events of the kinds "tacnode", "triple point" and "periodic graze" that are wanted."""
        events = list[Rests]()
        if len(self.values) < 2:
            return events
        if "periodic graze" in wanted and self.longest <= self.gaps[1] * (1 + GRID.whole):
            events += self._grazes()
        if "tacnode" in wanted and self.gaps[1] > self.gaps[0]:
            events += self._tacnodes()
        if "triple point" in wanted and self.gaps[1] > 2 * GRID.least:
            levels = [self._level(value) for value in self.values[:: GRID_OF.rows // GRID_OF.levels].tolist()]
            for before, after in pairwise(levels):
                events += self._triples(before, after)
        return events

    def both_ends(self, value: float, first: float, gap: float) -> Rests | None:
        """The flight from tangency to tangency there; the equations of one tangency have a double zero at it."""
        near = np.array([first, gap, value])
        if np.abs(self._pushed(near)[:2]).max() > GRID_OF.flat:
            return None
        met = newton(lambda z: np.array([self._pushed(point) for point in z]), near[None])
        if not len(met) or np.abs(met[0] - near).max() > GRID_OF.flat:
            return None
        s, d, there = met[0]
        speed = RestFlights(self.family.at(float(there))).ends(met[0, :1], met[0, 1:2])[1][0]
        return Rests("tangency to tangency", float(there), float(s), (float(d),)) if abs(speed) < GRID.wide else None

    def _pushed(self, place: Array) -> Array:
        """a(s), a(s + d) and x - c at (s, d, value)."""
        flights = RestFlights(self.family.at(float(place[2])))
        height = flights.ends(place[:1], place[1:2])[0]
        return np.append(flights.acceleration(np.array([place[0], place[0] + place[1]])), height)

    def _turn(self, value: float) -> float:
        return as_float(self.family.at(value).period)

    def _grid(self, value: float) -> tuple[Array, Array, Array, Array]:
        """s, d, and (x - c, x') of flights from rest and of such launched a little faster, shape (s, d, 2)."""
        turn = self._turn(value)
        step = GRID_OF.fine * min(turn, GRID_OF.rate)
        s, d = self.share * turn, np.arange(self.gaps[0], self.gaps[1] + step, step)
        model, zero = self.family.at(value), np.zeros(len(s))
        rows, faster = (np.stack(many_paths(model, s, zero + v, [d] * len(s))) for v in (0.0, GRID_OF.push))
        return s, d, rows, faster

    def _tacnodes(self) -> Iterator[Rests]:
        """Zeros of (x - c, x') at the times at which dx/dv vanishes for the n-th time, over s and the number."""
        rows = [_at_conjugates(*self._grid(value)[1:]) for value in self.values.tolist()]
        for n in range(min(row.shape[1] for row in rows)):
            d, height, speed = (np.stack([row[axis, n] for row in rows]) for axis in range(3))
            starts = []
            for i, at in _crossings(height, speed):
                turn, gap = self._turn(self.values[i]), float(np.interp(at, np.arange(d.shape[1]), d[i]))
                starts.append([np.interp(at, np.arange(len(self.share)), self.share) * turn, gap, self.values[i]])
            met = newton(lambda z: np.array([self._touching(point) for point in z]), np.array(starts).reshape(-1, 3))
            for s, gap, value in distinct(met):
                if self._inside(value, gap) and not is_whole(gap / self._turn(value)):
                    yield Rests("tacnode", float(value), float(s), (float(gap),))

    def _inside(self, value: float, gap: float) -> bool:
        return bool(self.ends[0] <= value <= self.ends[1] and gap > GRID.least)

    def _touching(self, place: Array) -> Array:
        flights = RestFlights(self.family.at(float(place[2])))
        height, speed = flights.ends(place[:1], place[1:2])
        return np.array([height[0], speed[0], flights.by_speed(place[:1], place[1:2])[0, 0]])

    def _level(self, value: float) -> Level:
        s, d, rows, _ = self._grid(value)
        i, j = np.nonzero(_may_vanish(rows[..., 0] / d**2, rows[..., 1] / d))
        flights = RestFlights(self.family.at(value))
        met = _rests_near(flights, np.stack([s[i] + (s[1] - s[0]) / 2, d[j] + (d[1] - d[0]) / 2], axis=1))
        turn = self._turn(value)
        inside = (met[:, 1] > self.gaps[0]) & (met[:, 1] < self.gaps[1]) & (np.abs(met[:, 0] / turn - 0.5) < 0.53)
        places = distinct(met[inside & ~is_whole(met[:, 1] / turn)])
        return Level(value, places, self._signs(flights, places))

    @staticmethod
    def _signs(flights: RestFlights, places: Array) -> Array:
        if not len(places):
            return np.empty((0, 3))
        s, d = places.T
        values = flights.acceleration(s), flights.acceleration(s + d), flights.by_speed(s, d)[:, 0]
        return np.asarray(np.sign(np.stack(values, axis=1)))

    def _triples(self, before: Level, after: Level) -> Iterator[Rests]:
        """Three rests: two branches whose times s pass one another between two values."""
        to = [_successor(before, n, after) for n in range(len(before.places))]
        for n, next_n in enumerate(to):
            for m in range(n):
                next_m = to[m]
                if next_n is None or next_m is None or abs(before.places[n, 1] - before.places[m, 1]) < GRID.least:
                    continue
                gap = before.places[n, 0] - before.places[m, 0]
                then = after.places[next_n, 0] - after.places[next_m, 0]
                if gap * then > 0 or abs(gap) > GRID_OF.reach:
                    continue
                share = gap / (gap - then) if gap != then else 0.5
                s, *d = (
                    share * (after.places[k, axis] - before.places[j, axis]) + before.places[j, axis]
                    for j, k, axis in ((n, next_n, 0), (n, next_n, 1), (m, next_m, 1))
                )
                start = np.array([s, *sorted(d), before.value + share * (after.value - before.value)])
                for s, one, two, value in newton(lambda z: np.array([self._three(point) for point in z]), start[None]):
                    gaps = np.array([one, two, two - one])
                    if self._inside(value, gaps.min()) and not is_whole(gaps / self._turn(value)).any():
                        yield Rests("triple point", float(value), float(s), (float(one), float(two)))

    def _three(self, place: Array) -> Array:
        flights = RestFlights(self.family.at(float(place[3])))
        return np.concatenate(flights.ends(np.repeat(place[:1], 2), place[1:3]))

    def _grazes(self) -> Iterator[Rests]:
        """Motions with the period T that touch the wall: x = c, x' = 0 at s and at s + T."""
        rows = [self._after_a_period(value, self.share) for value in self.values.tolist()]
        places = _crossings(np.stack([row[0] for row in rows]), np.stack([row[1] for row in rows]))
        columns = np.arange(len(self.share))
        starts = np.array([[self.values[i], np.interp(at, columns, self.share)] for i, at in places]).reshape(-1, 2)
        met = newton(lambda z: np.array([np.ravel(self._after_a_period(value, part)) for value, part in z]), starts)
        for value, part in distinct(met):
            if self._inside(value, self.longest) and abs(part - 0.5) < 0.53:
                yield Rests("periodic graze", float(value), float(part * self._turn(value)), (self._turn(value),))

    def _after_a_period(self, value: float, share: Array) -> tuple[Array, Array]:
        """x - c and x' a period after rests at some parts of it."""
        model, start = self.family.at(float(value)), np.atleast_1d(share) * self._turn(float(value))
        return RestFlights(model).ends(start, np.full(len(start), self._turn(float(value))))


def _at_conjugates(d: Array, rows: Array, faster: Array) -> Array:
    """d, x - c and x' at the n-th time at which dx/dv vanishes, shape (3, n, s); those that every flight reaches."""
    by_speed = (faster[..., 0] - rows[..., 0]) / GRID_OF.push
    crossings = []
    for one, path in zip(by_speed, rows, strict=True):
        at = np.flatnonzero(one[:-1] * one[1:] < 0)
        share = one[at] / (one[at] - one[at + 1])
        values = [
            coordinate[at] + share * (coordinate[at + 1] - coordinate[at]) for coordinate in (d, path[:, 0], path[:, 1])
        ]
        crossings.append(np.stack(values))
    least = min(crossing.shape[1] for crossing in crossings)
    return np.stack([crossing[:, :least] for crossing in crossings], axis=2)


def _crossings(height: Array, speed: Array) -> list[tuple[int, float]]:
    """Where two functions of (row, column) vanish together: a row, and the column to a fraction.

    On each row the zeros of the second one are taken, and the first one there; its sign changes from row to row.  So
    rows may be as near as one likes; on the outermost ones a small value is enough.
    """
    zeros = [_heights_at_zeros(*pair) for pair in zip(height, speed, strict=True)]
    # on the first and the last row Newton's method starts from small x - c
    crossings = [(i, at) for i in (0, len(zeros) - 1) for at, value in zeros[i] if abs(value) < 1e-3]
    for i, (before, after) in enumerate(pairwise(zeros)):
        for at, value in before:
            following = min(after, key=lambda each, at=at: abs(each[0] - at), default=None)  # type: ignore[misc]
            if following is not None and abs(following[0] - at) < 2.0 and value * following[1] <= 0:
                crossings.append((i, at if abs(value) < abs(following[1]) else following[0]))
    return crossings


def _heights_at_zeros(height: Array, speed: Array) -> list[tuple[float, float]]:
    """The zeros of the second function on a row, in columns, and the first one there; cubics through four columns."""
    heights = []
    for j in np.flatnonzero(speed[:-1] * speed[1:] <= 0).tolist():
        first = min(max(j - 1, 0), len(speed) - 4)
        nodes = np.arange(first, first + 4) - j
        rise, slip = (np.polyfit(nodes, row[first : first + 4], 3) for row in (height, speed))
        roots = np.roots(slip)
        inside = roots.real[(np.abs(roots.imag) < 1e-9) & (roots.real > -0.1) & (roots.real < 1.1)]
        heights += [(j + float(at), float(np.polyval(rise, at))) for at in inside[:1]]
    return heights


def _may_vanish(height: Array, speed: Array) -> Array:
    """Cells over which x' changes sign and x - c is near 0: its zeros touch the lines x' = 0 from one side."""
    parts = [np.stack([each[:-1, :-1], each[1:, :-1], each[:-1, 1:], each[1:, 1:]]) for each in (height, speed)]
    turns = (parts[1].min(axis=0) <= 0) & (parts[1].max(axis=0) >= 0)
    return np.asarray(turns & (np.abs(parts[0]).min(axis=0) <= np.ptp(parts[0], axis=0)))


def _rests_near(flights: RestFlights, starts: Array) -> Array:
    """Zeros of (x - c, x') in (s, d) by Newton's method with the response of the flights."""
    places, done = starts, list[Array]()
    for _ in range(GRID.most):
        if not len(places):
            break
        y, gradient, speed, bend = flights.y_and_gradient(places)
        d = places[:, 1]
        values = np.stack([y * d**2, speed], axis=1)
        height = gradient * (d**2)[:, None] + np.stack([0 * d, 2 * d * y], axis=1)
        sound = np.isfinite(values).all(axis=1) & np.isfinite(height).all(axis=1) & np.isfinite(bend).all(axis=1)
        matrices = np.stack([height, bend], axis=1)[sound]
        places = places[sound]
        moves = np.clip(-np.einsum("ijk,ik->ij", np.linalg.pinv(matrices), values[sound]), -GRID.longest, GRID.longest)
        places = places + moves
        # Newton's last step for two rests
        settled = np.abs(moves).max(axis=1, initial=0) < 1e-5
        done.append(places[settled])
        places = places[~settled & (places[:, 1] > GRID.least / 2)]
    return np.vstack([np.empty((0, 2)), *done])


def _successor(level: Level, n: int, other: Level) -> int | None:
    """The nearest point of another level with the same signs; None beyond `REACH`, or where another is nearer to it."""
    same = np.flatnonzero((other.signs == level.signs[n]).all(axis=1))
    if not same.size:
        return None
    away = np.abs(other.places[same] - level.places[n]).max(axis=1)
    best = int(same[away.argmin()])
    rivals = np.flatnonzero((level.signs == level.signs[n]).all(axis=1))
    back = np.abs(level.places[rivals] - other.places[best]).max(axis=1)
    return best if away.min() < GRID_OF.reach and rivals[back.argmin()] == n else None


# Tacnodes, triple points and periodic grazes of a family: those that are found, and why one may be missing.

MORE = ("tacnode", "triple point", "periodic graze")


def gaps_of(times: tuple[float, float]) -> tuple[float, float]:
    """The least and the longest time between two rests that a window of flight times holds, of either sign."""
    low, high = times
    inside = low <= 0 <= high
    return 0.0 if inside else min(abs(low), abs(high)), max(abs(low), abs(high))


def met_rests(
    family: Family, ends: tuple[float, float], times: tuple[float, float], wanted: Collection[str]
) -> list[Rests]:
    """Tacnodes, triple points and periodic grazes with the time from the first rest to the last in a window.

    Parameters
    ----------
    ends : of the number. times : of flights. wanted : kinds.
    """
    if family.model.period is None or not set(MORE) & set(wanted):
        return []
    gaps, linear = gaps_of(times), linear_rests(family)
    if linear is None:
        return FollowedRests(family, ends, gaps).met(wanted)
    events = linear.grazes() if "periodic graze" in wanted and gaps[1] >= linear.turn * (1 - GRID.whole) else []
    events += linear.tacnodes(gaps[1]) if "tacnode" in wanted else []
    return events + (linear.triples(gaps[1]) if "triple point" in wanted and not no_triples(linear) else [])


def no_triples(rests: LinearRests) -> bool:
    """Whether no flight of a model is at rest three times, but those that are once a period [b:events-two].

    x'' + w^2 x = h cos(2 w t + phase) + constant is the only one of which that is proved.
    """
    form = rests.form
    rates = {str(wave.rate) for wave in form.harmonics}
    if sign_of(form.damping) != 0 or len(rates) != 1 or not rests.square > 0:
        return False
    rate = form.harmonics[0].rate
    return sign_of(subtract(multiply(rate, rate), multiply(number(4), form.stiffness))) == 0


def doubts_of_rests(family: Family, times: tuple[float, float], wanted: Collection[str]) -> tuple[str, ...]:
    """Why a tacnode, a triple point or a periodic graze may be missing; nothing where it is proved that none is."""
    kinds = [kind for kind in MORE if kind in wanted]
    if not kinds:
        return ()
    if family.model.period is None:
        return (f"{_listed(kinds)} are looked for in models with a period alone",)
    linear = linear_rests(family)
    if linear is None:
        grid = f"{GRID_OF.columns} times of rest a period and {GRID_OF.rows} steps of {family.over}"
        return (f"{_listed(kinds)} are met on a grid of {grid}",)
    if "periodic graze" in kinds:
        linear.grazes()
    if "tacnode" in kinds:
        linear.tacnodes(gaps_of(times)[1])
    doubts = tuple(dict.fromkeys(linear.undecided))
    if "triple point" in kinds and not no_triples(linear):
        doubts += (f"triple points are met on a grid of step {GRID.step} in the times of rest",)
    return doubts


def _listed(kinds: list[str]) -> str:
    return " and ".join(part for part in (", ".join(f"{kind}s" for kind in kinds[:-1]), f"{kinds[-1]}s") if part)
