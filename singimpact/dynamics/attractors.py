"""Periodic attractors, and a neighbourhood of each from which orbits converge to it.

The periodic orbit beside a state that almost returns to itself is found by Newton's method for its period:

    G^n(tau, v) = (tau + k T, v)        (tau, v) -= (D G^n - 1)^-1 (G^n - id - (k T, 0))

An orbit that passes beside a fold returns to 1e-6 for thousands of turns although no periodic orbit is there, and next
to a doubling a state comes nearer by turns of 2n impacts where n close the orbit. The distance of a return shows
neither.

States are (tau, x') just after impacts, x' < 0 at an upper wall.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.dynamics.phases import Phases, phases_of
from singimpact.flights.derivative import derivative
from singimpact.flights.orbits import signed_iterate
from singimpact.oscillator.model import Oscillator

# Classes of states that reach no periodic orbit: not settled, chatter that completes, no period and neighbours that
# separate, proved never to return, no impact before the horizon, a flight that is unresolved, decided by rounding;
# without a clock a cycle that does not touch the wall, a rest off the wall, and closed orbits beside closed orbits;
# with a forcing that never repeats a response to which neighbours come, and one with rests again and again
OTHER, CHATTER, CHAOS, GONE, AWAY, STUCK, SENSITIVE, CYCLE, STILL, LEVEL, RESPONSE, RESTING = range(12)
PLACES = 1000  # a class (n, k) is coded n * PLACES + k


@dataclass(frozen=True)
class AttractorSettings:
    """most_impacts : largest n of an (n, k) orbit that is recognised. close : relative distance of equal states.
    catch : how near to an attractor an orbit is looked upon as caught, relative, when the corners of that neighbourhood
        are seen to come in; a tenth of it is tried next, down to `close`.
    turns : of the attractor, in which they must come into half of it; the later ones where multipliers are near 1.
    """

    most_impacts: int = 8
    close: float = 1e-6
    catch: float = 1e-2
    turns: tuple[int, ...] = (6, 30, 150)


SETTINGS = AttractorSettings()


@dataclass(frozen=True)
class Attractor:
    """code : its class. tau, v : its states, tau within a period. catch : relative size of its neighbourhood."""

    code: int
    tau: Array
    v: Array
    catch: float


def closing_orbits(
    model: Oscillator, tau: Array, v: Array, fast: float, most: int = SETTINGS.most_impacts
) -> tuple[Array, Array, Array]:
    """(n, k) of the attracting orbit beside states that return to themselves, else OTHER; and its tau and v."""
    codes, tau, v = _returns(model, tau, v, fast, most), np.array(tau, dtype=float), np.array(v, dtype=float)
    near = np.flatnonzero(codes != OTHER)
    beside = nearby_orbits(model, tau[near], v[near], *divmod(codes[near], PLACES), fast)
    there = beside.found
    codes[near[there]] = (beside.n * PLACES + beside.k)[there]
    tau[near[there]], v[near[there]] = beside.tau[there], beside.v[there]
    codes[near[~there & ~beside.returned]] = OTHER
    return codes, tau, v


def _returns(model: Oscillator, tau: Array, v: Array, fast: float, most: int) -> Array:
    """(n, k) of states that return to themselves, else OTHER."""
    phases = phases_of(model)
    codes = np.full(tau.size, OTHER, dtype=np.int32)
    home = phases.of(tau)
    at, speed, flown = home, v, np.zeros(tau.size)
    for n in range(1, most + 1):
        if (codes != OTHER).all():
            break
        ends = signed_iterate(model, at, speed, 1)
        flown += ends.tau - at
        at, speed, k = phases.of(ends.tau), ends.v, phases.periods(flown)
        near = apart((at, speed), (home, v), phases, fast) < SETTINGS.close
        new = near & (codes == OTHER) & (k >= phases.clocked) & (k < PLACES)
        codes[new] = (n * PLACES + k[new]).astype(np.int32)
    return codes


def caught(known: list[Attractor], model: Oscillator, tau: Array, v: Array, fast: float) -> Array:
    """The index in `known` of the attractor whose converging neighbourhood holds a state, else -1."""
    places = np.full(tau.size, -1, dtype=np.int32)
    for place, attractor in enumerate(known):
        places[within(attractor, model, tau, v, fast, attractor.catch)] = place
    return places


def within(attractor: Attractor, model: Oscillator, tau: Array, v: Array, fast: float, size: float) -> Array:
    """Whether states lie nearer than `size`, relative, to a state of the attractor."""
    phases, near = phases_of(model), np.zeros(tau.size, dtype=bool)
    for state in zip(attractor.tau.tolist(), attractor.v.tolist(), strict=True):
        near |= apart((tau, v), state, phases, fast) < size
    return near


def apart(states: Any, others: Any, phases: Phases, fast: float) -> Array:
    """Distances of states: phases in their units, velocities in units of `fast`; the larger counts; inf of two walls.

    Examples
    --------
    >>> apart((np.array([7.1, 0.5]), np.array([1.0, 2.0])), (0.1, 1.0), Phases(7.0), 4.0).round(9).tolist()
    [0.0, 0.25]
    """
    away = np.maximum(np.abs(phases.off(states[0], others[0])), np.abs(states[1] - others[1]) / fast)
    return np.where(np.less(states[1], 0) != np.less(others[1], 0), np.inf, away)


def new_attractors(
    model: Oscillator, tau: Array, v: Array, fast: float, most: int = SETTINGS.most_impacts
) -> list[Attractor]:
    """The attractors that some of these states have reached."""
    found: list[Attractor] = []
    codes, tau, v = closing_orbits(model, tau, v, fast, most)
    for index in np.flatnonzero(codes != OTHER).tolist():
        if caught(found, model, tau[index : index + 1], v[index : index + 1], fast)[0] < 0:
            found.append(_surrounded(model, int(codes[index]), tau[index], v[index], fast))
    return found


def states_of(model: Oscillator, code: int, tau: float, v: float) -> tuple[Array, Array]:
    """The states of all impacts of a periodic orbit, from one of them on."""
    states = [(tau, v)]
    for _ in range(code // PLACES - 1):
        ends = signed_iterate(model, *states[-1], 1)
        states.append((float(ends.tau), float(ends.v)))
    times, speeds = np.array(states).T
    return times, speeds


def _surrounded(model: Oscillator, code: int, tau: float, v: float, fast: float) -> Attractor:
    """An attractor with the largest neighbourhood whose border is observed to contract."""
    unit, count = phases_of(model).unit, code // PLACES
    times, speeds = states_of(model, code, tau, v)
    size, sizes = SETTINGS.catch, np.abs(speeds)[:, None]
    while size > SETTINGS.close:
        attractor = Attractor(code, times, speeds, size)
        edge = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]) * size
        start = (
            times[:, None] + unit * edge[:, 0],
            np.sign(speeds)[:, None] * np.maximum(sizes + fast * edge[:, 1], 1e-3 * sizes),
        )
        at, speed, turned = start[0].ravel(), start[1].ravel(), 0
        for turns in SETTINGS.turns:
            ends = signed_iterate(model, at, speed, (turns - turned) * count)
            if not (ends.status == 0).all() or not within(attractor, model, ends.tau, ends.v, fast, 2 * size).all():
                break
            if within(attractor, model, ends.tau, ends.v, fast, size / 2).all():
                return attractor
            at, speed, turned = ends.tau, ends.v, turns
        size /= 10
    return Attractor(code, times, speeds, SETTINGS.close)


# ---- the periodic orbit beside a state that almost returns to itself


@dataclass(frozen=True)
class NearbySettings:
    """closed : relative residual of an orbit, some
    10^5 roundings. near : relative distance within which it is looked for. neutral : size of a multiplier up to which
    an orbit attracts or is neutral. same : relative residual of an orbit after fewer impacts that close it too.
    returned : relative residual of a state that has settled where no orbit is found, as next to a graze.
    """

    closed: float = 1e-11
    near: float = 1e-2
    neutral: float = 1 + 1e-7
    same: float = 1e-8
    returned: float = 1e-10


NEARBY = NearbySettings()


@dataclass(frozen=True)
class Nearby:
    """tau, v : states of the orbits. n, k : their least impacts and periods. found : whether one attracts.
    residual : relative distance, after n impacts, of the states that were given.
    """

    tau: Array
    v: Array
    n: Array
    k: Array
    found: Array
    residual: Array

    @property
    def returned(self) -> Array:
        """Whether the states that were given return by themselves, up to rounding."""
        return self.residual < NEARBY.returned


def nearby_orbits(model: Oscillator, tau: Array, v: Array, n: Array, k: Array, fast: float) -> Nearby:
    """Periodic orbits of n impacts in k periods beside states, all of shape (m,).

    Examples
    --------
    >>> model = Oscillator("x", "cos(2*t)", "0.3", "1/2")
    >>> end = signed_iterate(model, np.array([0.3]), np.array([1.5]), 30)
    >>> beside = nearby_orbits(model, end.tau, end.v, np.array([2]), np.array([2]), 2.0)
    >>> bool(beside.found[0]), int(beside.n[0])
    (True, 1)
    """
    phases = phases_of(model)
    scale = np.array([phases.unit, fast])
    starts = np.stack([phases.of(tau), v], axis=-1)
    states, attracting = starts.copy(), np.zeros(tau.size, dtype=bool)
    first, left = np.full(tau.size, np.inf), np.arange(tau.size)
    # steps of Newton's method; at a doubling each halves the distance
    for step in range(30):
        residual, slopes = _return(model, states[left], n[left], k[left])
        away = np.abs(residual / scale).max(axis=1, initial=0.0)
        if step == 0:
            first[:] = away
        # |multipliers| <= size where both roots of z^2 - s z + p are within the circle of that radius
        with np.errstate(invalid="ignore"):
            size, trace, area = NEARBY.neutral, np.trace(slopes, axis1=1, axis2=2), np.linalg.det(slopes)
        attracts = (np.abs(area) <= size**2) & (np.abs(trace) * size <= size**2 + area)
        closed = away < NEARBY.closed
        attracting[left[closed]] = attracts[closed]
        aim = states[left] + _newton(residual, slopes)
        there = np.abs((aim - starts[left]) / scale).max(axis=1, initial=0.0) < NEARBY.near
        going = ~closed & there & ((aim[:, 1] < 0) == (starts[left, 1] < 0))
        left = left[going]
        if not left.size:
            break
        states[left] = aim[going]
    n, k = _least(model, states, (n, k), attracting, fast)
    return Nearby(states[:, 0], states[:, 1], n, k, attracting, first)


def _newton(residual: Array, slopes: Array) -> Array:
    """Newton's step of each state; nan where the matrix has no inverse."""
    (a, b), (c, d) = np.moveaxis(slopes - np.eye(2), 0, -1)
    with np.errstate(all="ignore"):
        area = a * d - b * c
        p, q = residual.T
        return np.stack([(b * q - d * p) / area, (c * p - a * q) / area], axis=-1)


def _return(model: Oscillator, states: Array, n: Array, k: Array) -> tuple[Array, Array]:
    """G^n(tau, v) - (tau + k T, v) and D G^n; nan where a flight ends before. Without a clock, those of v alone."""
    phases = phases_of(model)
    at, speed = states.T.copy()
    slopes = np.broadcast_to(np.eye(2), (len(states), 2, 2)).copy()
    for count in range(int(n.max(initial=0))):
        going = np.flatnonzero((n > count) & ~np.isnan(speed))
        if going.size:
            walls = None if model.upper is None else np.signbit(speed[going]).astype(np.int8)
            slopes[going] = derivative(model, at[going], np.abs(speed[going]), wall=walls).matrix @ slopes[going]
            ends = signed_iterate(model, at[going], speed[going], 1)
            at[going], speed[going] = ends.tau, np.where(ends.status == 0, ends.v, np.nan)
    # D G is by v, which is -x' at an upper wall
    sides = np.where(states[:, 1] < 0, -1.0, 1.0)
    slopes[:, 0, 1] *= sides
    slopes[:, 1, 0] *= sides
    missed = np.stack([at - states[:, 0] - k * phases.unit, speed - states[:, 1]], axis=-1)
    if not phases.clocked:
        missed[:, 0], slopes[:, 0], slopes[:, 1, 0] = 0.0, 0.0, 0.0
    return missed, slopes


def neutral(model: Oscillator, n: Array, v: Array) -> Array:
    """Whether cycles of n impacts of a model without a clock, from v, come to their neighbours no nearer in a turn.

    Examples
    --------
    >>> neutral(Oscillator("x", "0", -1, 1), np.array([1]), np.array([0.5])).tolist()  # each orbit closes
    [True]
    """
    slopes = _return(model, np.stack([0 * v, v], axis=1), n, 0 * n)[1]
    return np.asarray(slopes[:, 1, 1] > 2 - NEARBY.neutral)


def _least(
    model: Oscillator, states: Array, numbers: tuple[Array, Array], attracting: Array, fast: float
) -> tuple[Array, Array]:
    """The least impacts and periods of the orbits that were found."""
    n, k = (column.copy() for column in numbers)
    at, speed = states.T.copy()
    several = np.flatnonzero(attracting & (n > 1))
    for count in range(1, int(n[several].max(initial=1))):
        ends = signed_iterate(model, at[several], speed[several], 1)
        at[several], speed[several] = ends.tau, ends.v
        whole = (n[several] % count == 0) & (k[several] * count % n[several] == 0)
        closes = apart((ends.tau, ends.v), states[several].T, phases_of(model), fast) < NEARBY.same
        least = several[whole & closes]
        n[least], k[least] = count, k[least] * count // n[least]
        several = several[~(whole & closes) & (n[several] > count)]
        if not several.size:
            break
    return n, k
