"""Orbits for ever, once a chatter has completed: the map from one lift-off to the next, and Lyapunov exponents.

A mass at rest lifts off where a_c becomes positive: at one of finitely many phases.  So the future of a chatter that
completes is that of its lift-off, and chatter that comes again and again is a cycle of these phases.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.contact.points import tangency_points
from singimpact.dynamics.attractors import AWAY, CHATTER, GONE, OTHER
from singimpact.dynamics.lift_off import release
from singimpact.dynamics.orbit import orbit
from singimpact.dynamics.phases import phases_of
from singimpact.flights.orbits import signed_iterate
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.status import Wall


@dataclass(frozen=True)
class LongRunSettings:
    """apart : of two orbits, relative, whose distance is watched. block, rounds : impacts between two looks, and looks;
    extended : times as many are taken while the sign of the exponent lies within its error.
    least : exponent per impact from which on an orbit is called chaotic, if it is three standard errors above 0 too.
    flown : impacts after a lift-off within which a chatter that completes is looked for.
    """

    apart: float = 1e-7
    block: int = 5
    rounds: int = 60
    extended: int = 16
    least: float = 0.01
    flown: int = 50_000


SETTINGS = LongRunSettings()


@dataclass(frozen=True)
class Future:
    """The future of a lift-off: row, the class of the orbit; time, to the next lift-off when its chatter completes."""

    row: tuple[float, ...]
    time: float


def rising_zeros(model: Oscillator) -> tuple[float, ...]:
    """The zeros at which a_c becomes positive, of one period or all of a polynomial."""
    return tuple(point.tau for point in tangency_points(model) if point.kind == "gamma")


def lift_offs(model: Oscillator) -> tuple[float, ...]:
    """The phases in one period at which a_c becomes positive.

    Examples
    --------
    >>> [round(tau, 6) for tau in lift_offs(Oscillator("x", "cos(2*t)", "0.3", "1/2"))]
    [2.508541]
    """
    return () if model.period is None else rising_zeros(model)


def lift_offs_of_walls(model: Oscillator) -> tuple[tuple[float, int], ...]:
    """Phase and wall of all lift-offs in one period."""
    alone = [model] if model.upper is None else [model.one_wall(side.name) for side in Wall]
    return tuple((phase, wall) for wall, side in enumerate(alone) for phase in lift_offs(side))


def next_lift_off(lifted: tuple[tuple[float, int], ...], tau: Array, wall: int) -> Array:
    """The place in `lifted` of the first one at a wall after times within a period; where it has none at all -1, and
    -2 for the upper one.
    """
    places = [place for place, (_, side) in enumerate(lifted) if side == wall]
    if not places:
        return np.full(tau.size, -1 - wall)
    phases = np.array([lifted[place][0] for place in places])
    return np.array(places)[np.searchsorted(phases, tau) % len(places)]


def futures(
    osc: Oscillator, lifted: tuple[tuple[float, int], ...], classify: Callable[[Array, Array], Array]
) -> list[Future]:
    """The motion after each lift-off, by the classes that `classify` gives to the state after the first impact."""
    rows = []
    for phase, wall in lifted:
        model = osc.mirrored if wall else osc
        back = as_float(model.period) / 64
        while acceleration(model, np.array([phase - back]))[0] >= 0:
            back /= 2
        begin = release(model, phase - back)
        first = orbit(model, begin, 0, impacts=1)
        if first.kind.tolist() != ["start", "impact"]:
            code = (GONE if np.isinf(first.end) else AWAY) if first.phases[-1][0] == "no_return" else OTHER
            rows.append(Future((code, 0.0, 0.0), np.nan))
            continue
        row = tuple(classify(first.tau[1:], first.speeds[1:] * (-1 if wall else 1))[0].tolist())
        time = _rest_of(model, begin) - begin if row[0] == CHATTER and row[1] >= 0 else np.nan
        rows.append(Future(row, time))
    return rows


def _rest_of(model: Oscillator, start: float) -> float:
    """The second lift-off of a mass whose chatter completes after the first; nan where none is seen to complete."""
    flown = 1
    while flown <= SETTINGS.flown:  # most chatters complete at once, others after long transients
        flown *= 16
        found = orbit(model, start, 0, impacts=flown)
        lifted = found.tau[found.kind == "release"]
        if lifted.size:
            return float(lifted[0])
    return np.nan


def settled(motions: list[Future], start: int, period: float) -> tuple[float, ...]:
    """The class of what follows a lift-off for ever: (CHATTER, least place of the cycle, its periods) for a cycle.

    Examples
    --------
    >>> settled([Future((1, 1.0, 0.0), 4.0), Future((1, 1.0, 0.0), 6.0)], 0, 3.0)
    (1, 1, 2)
    """
    path = [start]
    while True:
        future = motions[path[-1]]
        if future.row[0] != CHATTER:
            return future.row
        if not np.isfinite(future.time):
            return (OTHER, 0.0, 0.0)
        following = int(future.row[1])
        if following in path:
            cycle = path[path.index(following) :]
            return (CHATTER, min(cycle), round(sum(motions[number].time for number in cycle) / period))
        path.append(following)


def chaotic(model: Oscillator, tau: Array, v: Array, fast: float) -> Array:
    """Whether orbits have a Lyapunov exponent above 0."""
    return np.asarray(growth(model, tau, v, fast) > 0)


def growth(model: Oscillator, tau: Array, v: Array, fast: float) -> Array:
    """The signs of the Lyapunov exponents of orbits, 0 where it is open: of the mean growth of a small distance.

    Examples
    --------
    >>> settled = Oscillator("x", "cos(2*t)", "0.3", "1/2")
    >>> growth(settled, np.array([0.5]), np.array([1.0]), 1.0).tolist()
    [-1]
    """
    unit, signs = phases_of(model).unit, np.zeros(tau.size, dtype=np.int64)
    left, first = np.arange(tau.size), (np.array(tau), np.array(v))
    second = first[0] + SETTINGS.apart * unit, first[1] * (1 + SETTINGS.apart)
    growth = np.zeros((0, tau.size))
    while left.size and len(growth) < SETTINGS.rounds * SETTINGS.extended:
        rows = []
        for _ in range(SETTINGS.rounds):
            first, second, row = _grown(model, first, second, fast)
            rows.append(row)
        growth = np.concatenate([growth, rows])
        # the first quarter, in which the distance turns towards the direction that grows, is left out
        late = growth[len(growth) // 4 :] / SETTINGS.block
        mean, error = late.mean(axis=0), 3 * late.std(axis=0) / np.sqrt(len(late))
        for sign in (1, -1):
            signs[left[sign * mean > np.maximum(SETTINGS.least, error)]] = sign
        undecided = (mean <= error) & (mean + error > SETTINGS.least)  # nan where a flight does not come back
        left, growth = left[undecided], growth[:, undecided]
        first, second = ((states[0][undecided], states[1][undecided]) for states in (first, second))
    return signs


def _grown(
    model: Oscillator, first: tuple[Array, Array], second: tuple[Array, Array], fast: float
) -> tuple[tuple[Array, Array], tuple[Array, Array], Array]:
    """States and their neighbours after some impacts, neighbours set back to `apart`, and the growth of the distance.

    Benettin et al. (1980): the distance is measured, then set back along the same direction.
    """
    ends, phases = [signed_iterate(model, *states, SETTINGS.block) for states in (first, second)], phases_of(model)
    away = np.stack([phases.off(ends[1].tau, ends[0].tau), (ends[1].v - ends[0].v) / fast])
    with np.errstate(all="ignore"):
        size = np.hypot(*away)
        row = np.log(np.maximum(size, 1e-16) / SETTINGS.apart)
        step = away * np.where(size > 1e-16, SETTINGS.apart / size, 1.0)
    row[(ends[0].status != 0) | (ends[1].status != 0)] = np.nan
    tau, v = phases.of(ends[0].tau), ends[0].v
    side = np.where(v < 0, -1.0, 1.0)
    return (tau, v), (tau + step[0] * phases.unit, side * np.maximum(side * (v + step[1] * fast), 0.5 * side * v)), row
