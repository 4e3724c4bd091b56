"""The orbit at a point that solves closing conditions, and the conditions that an orbit solves."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches.closing import Closing, Flown, FreeClosing
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.resting import free_orbit_at
from singimpact.branches.wall_closing import WallClosing, closing_of_word
from singimpact.flights import at_walls, fastest_rate, iterates
from singimpact.flights.family import family
from singimpact.flights.impact_map import impact_map
from singimpact.oscillator import CLEARANCE, RESTITUTION, Oscillator, acceleration_at
from singimpact.status import Status

AnyClosing = Closing | FreeClosing


@dataclass(frozen=True)
class VisibleSettings:
    """When the next impact of the impact map is that of a closed orbit."""

    # relative difference of equal flight times: next to a graze a rounding error changes the hit by its square root
    near: float = 1e-6
    # depth below the wall of a flight that touches it
    touching: float = 1e-9


SETTINGS = VisibleSettings()


def closing_of(osc: Oscillator, word: tuple[int, ...], k: int, over: Sequence[str]) -> AnyClosing:
    """The closing conditions of impacts at the walls of a word, or of no impact, in k periods."""
    n = len(word)
    if n and osc.upper is not None:
        return closing_of_word(osc, word, k, over)
    if n and osc.autonomous:
        return CycleClosing(family(osc, tuple(over)), n, k)
    if n:
        return Closing(family(osc, tuple(over)), n, k)
    return FreeClosing(
        family(osc, (CLEARANCE, *(name for name in over if name not in (CLEARANCE, RESTITUTION)))), tuple(over), k
    )


def point_of(closing: AnyClosing, orbit: PeriodicOrbit) -> Array:
    """The unknowns of an orbit with impacts."""
    assert isinstance(closing, Closing)
    times, speeds = (np.asarray(row, dtype=float) for row in (orbit.tau, orbit.v))
    return closing.point(times, speeds, orbit.period)


def orbit_of(closing: AnyClosing, point: Array, seen: bool | None = None) -> PeriodicOrbit:
    """The orbit at a closed point, with its model; `seen` as in `orbit_at`."""
    if isinstance(closing, Closing):
        return orbit_at(closing, point, seen=seen)
    found = free_orbit_at(closing, point)
    return found if seen is None else replace(found, visible=seen)


def orbit_at(closing: Closing, point: Array, osc: Oscillator | None = None, seen: bool | None = None) -> PeriodicOrbit:
    """The orbit at a closed point, its first impact the one of the least phase.

    Parameters
    ----------
    seen : whether it is visible; found from true first hits without it, which takes seconds at some grazes.
    """
    n, k = closing.n, closing.k
    osc = osc or closing.family.oscillator(closing.values(point))
    loop = closing.at(point)
    flights = closing.flights(point)
    launches, speeds, times = (np.array([flight[i] for flight in flights]) for i in (0, 2, 3))
    first = int(np.argmin(launches))
    order = [(first + i) % n for i in range(n)]
    tau = launches[first] + np.concatenate([[0.0], np.cumsum(times[order])[:-1]])
    seen = visible(closing, point, osc) if seen is None else seen
    return PeriodicOrbit(
        tau,
        speeds[order],
        _plain(loop.multipliers(partial(closing.product, point))),
        float(np.abs(loop.miss).max()),
        np.int8(Status.hit),
        osc,
        n,
        k,
        visible=seen,
        span=None if closing.clocked else float(point[0]),
        wall=None if osc.upper is None else np.array(closing.word, np.int8)[order],
    )


def visible(closing: Closing, point: Array, osc: Oscillator) -> bool:
    """Whether every flight of a closed point first meets the wall at the next impact, with all v >= 0.

    A first hit that doubles leave open is judged by the lowest place of the flight between its impacts.

    Examples
    --------
    >>> osc = Oscillator("x", "cos(4*t)", 0, "1/2")
    >>> closing = Closing(family(osc), 1, 2)
    >>> visible(closing, np.array([3 * np.pi / 8, 8 / 15]), osc)
    True
    """
    tau, _arrival, v, times = (np.array(column) for column in zip(*closing.flights(point), strict=True))
    if not ((v >= 0) & (times > 0)).all():
        return False
    launches = (float(tau[0]), float(v[0])) if tau.size == 1 else (tau, v)  # two floats are faster
    walls = np.array(closing.word) if isinstance(closing, WallClosing) else None
    step = impact_map(osc, *launches) if walls is None else at_walls(impact_map, osc, walls, launches)
    flown, status = np.atleast_1d(step.flight_time), np.atleast_1d(step.status)
    with np.errstate(invalid="ignore"):
        same = (np.abs(flown - times) <= SETTINGS.near * times) & np.isin(status, (Status.hit, Status.graze))
        if walls is not None:
            same &= step.wall == np.roll(walls, -1)
    left = status == Status.unresolved
    if not (same | left).all():
        return False
    heights = closing.heights(point) if left.any() else []
    open_ = np.resize(left, len(heights))  # of each flight, seen from both walls
    return all(height >= -SETTINGS.touching for (_, height), doubtful in zip(heights, open_, strict=True) if doubtful)


def _plain(multipliers: Array) -> Array:
    """Real numbers if all imaginary parts vanish."""
    return multipliers.real if not multipliers.imag.any() else multipliers


def orbit_period(orbit: PeriodicOrbit) -> float:
    """The period of the forcing of an orbit's model."""
    return as_float(orbit.oscillator.period)


# Limit cycles of models without a clock: neither f nor g depends on t, and the period is one of the unknowns.
#
# The closing conditions are those of `closing`, with the first impact at time 0 and the period T in its place among
# the unknowns.  The return map is one of the velocity alone: a cycle has one multiplier beside the trivial 1 of the
# flow.


@dataclass(frozen=True)
class CycleSettings:
    """Settings of the search for limit cycles."""

    # velocities of the grid, over |a_c| by the fastest rate; where a_c = 0, over that rate times |c| or 1
    low: float = 1e-4
    high: float = 1e3
    starts: int = 2000
    # halvings of a bracket before Newton's method
    halvings: int = 12
    # velocities that return with themselves up to this part: where two neighbours do, orbits form a continuum
    equal: float = 1e-11
    # a velocity below this part of the fastest rate is that of a graze
    graze: float = 1e-10


CYCLES = CycleSettings()


@dataclass(frozen=True)
class CycleClosing(Closing):
    """Closing conditions of a cycle of n impacts; a point is T, tau_2, ..., tau_n, v_1, ..., v_n and the numbers."""

    clocked = False

    def times(self, point: Array) -> Array:
        """The times of the impacts, the first 0."""
        return np.concatenate([[0.0], point[1 : self.n]])

    def period(self, point: Array) -> float:
        """The period over k."""
        return float(point[0]) / self.k

    def point(self, times: Array, speeds: Array, span: float) -> Array:
        """Unknowns of an orbit."""
        return np.concatenate([[span], times[1:] - times[0], speeds])

    def grazes(self, point: Array) -> bool:
        """Whether a velocity is rounding."""
        return bool(np.abs(point[self.n : 2 * self.n]).min() < CYCLES.graze * self.family.fastest)

    def _slopes_of_period(self, point: Array) -> Array:  # noqa: ARG002
        return np.zeros(len(self.over))

    def flights(self, point: Array) -> list[Flown]:
        """All flights; every launch is at time 0, because no flight depends on its time."""
        times = [*self.times(point).tolist(), float(point[0])]
        spans, speeds = np.diff(times).tolist(), point[self.n : 2 * self.n].tolist()
        return [(0.0, 0.0, v, span) for v, span in zip(speeds, spans, strict=True)]


def cycles_found(osc: Oscillator, n: int) -> tuple[list[Array], bool]:
    """Points of limit cycles of n impacts, from sign changes of v^(n) - v over a grid, and whether a continuum closes.

    Examples
    --------
    >>> (point,), continuum = cycles_found(Oscillator("x - (1 - x**2)*xdot", "0", "-1.5", "0.8"), 1)
    >>> round(float(point[0]), 8), round(float(point[1]), 8)  # T and v
    (4.81893846, 1.68586826)
    >>> cycles_found(Oscillator("x", "0", "-1/2", 1), 1)  # without losses every orbit closes
    ([], True)
    """
    closing, rate = CycleClosing(family(osc), n, n), fastest_rate(osc)
    size = abs(acceleration_at(osc, 0.0)) / rate or rate * max(abs(as_float(osc.clearance)), 1.0)
    v = size * np.geomspace(CYCLES.low, CYCLES.high, CYCLES.starts)
    gain = _returned(osc, v, n) - v
    equal = np.abs(gain) <= CYCLES.equal * v
    rounding = equal[:-1] & equal[1:]
    jump = np.flatnonzero(((gain[:-1] > 0) != (gain[1:] > 0)) & ~rounding)
    jump = jump[np.isfinite(gain[jump]) & np.isfinite(gain[jump + 1])]
    low, high, rises = v[jump], v[jump + 1], gain[jump] > 0
    for _ in range(CYCLES.halvings):
        middle = (low + high) / 2
        above = (_returned(osc, middle, n) > middle) == rises
        low, high = np.where(above, middle, low), np.where(above, high, middle)
    ends = iterates(osc, np.zeros(low.size), (low + high) / 2, n, keep=True)
    points = []
    for times, speeds in zip(ends.tau.T[ends.status == Status.hit], ends.v.T[ends.status == Status.hit], strict=True):
        root = closing.newton(closing.point(times[:-1], speeds[:-1], float(times[-1])))
        if root is not None:
            points.append(root[0])
    return points, bool(rounding.any())


def _returned(osc: Oscillator, v: Array, n: int) -> Array:
    """Velocities after n impacts; nan where an impact does not come."""
    ends = iterates(osc, np.zeros(v.size), v, n, keep=False)
    return np.where(ends.status == Status.hit, ends.v, np.nan)
