"""Limit cycles of models without a clock: neither f nor g depends on t, and the period is one of the unknowns.

The closing conditions are those of `closing`, with the first impact at time 0 and the period T in its place among the
unknowns.  The return map is one of the velocity alone, so a cycle has one multiplier beside the trivial 1 of the flow.
"""

from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches.closing import Closing, Flown
from singimpact.flights.family import family
from singimpact.flights.model_numbers import fastest_rate
from singimpact.flights.orbits import iterates
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration_at
from singimpact.status import Status


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


SETTINGS = CycleSettings()


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
        return bool(np.abs(point[self.n : 2 * self.n]).min() < SETTINGS.graze * self.family.fastest)

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
    v = size * np.geomspace(SETTINGS.low, SETTINGS.high, SETTINGS.starts)
    gain = _returned(osc, v, n) - v
    equal = np.abs(gain) <= SETTINGS.equal * v
    rounding = equal[:-1] & equal[1:]
    jump = np.flatnonzero(((gain[:-1] > 0) != (gain[1:] > 0)) & ~rounding)
    jump = jump[np.isfinite(gain[jump]) & np.isfinite(gain[jump + 1])]
    low, high, rises = v[jump], v[jump + 1], gain[jump] > 0
    for _ in range(SETTINGS.halvings):
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
