"""The orbit at a point that solves closing conditions, and the conditions that an orbit solves."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches.closing import Closing, FreeClosing
from singimpact.branches.limit_cycle import CycleClosing
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.resting import free_orbit_at
from singimpact.branches.wall_closing import WallClosing, closing_of_word
from singimpact.flights.family import family
from singimpact.flights.impact_map import impact_map
from singimpact.flights.walls import at_walls
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION
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
