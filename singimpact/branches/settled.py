"""The periodic orbit on which an orbit settles, with its multipliers: its impacts may be as weak as doubles allow."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches.orbits import PeriodicOrbit, chatter_orbit
from singimpact.branches.resting import SAME_PHASE
from singimpact.dynamics.lift_off import turns_between
from singimpact.dynamics.orbit import Orbit, orbit
from singimpact.flights.derivative import derivative
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status


@dataclass(frozen=True)
class SettledSettings:
    """When an orbit has settled.

    Parameters
    ----------
    impacts, rounds : flown at a time, and how often, where the orbit comes nearer to a periodic one.
    most : impacts of the periodic orbits that are looked for.
    near : two states nearer than this are one, in periods and in units of the largest velocity. nearing : those of an
        orbit on its way to a periodic one are so near.
    """

    impacts: int = 2000
    rounds: int = 8
    most: int = 250
    near: float = 1e-10
    nearing: float = 1e-5


SETTINGS = SettledSettings()


def settled_orbit(osc: Oscillator, tau: Any, v: Any = 0) -> PeriodicOrbit | None:
    """The periodic orbit on which the orbit of a state settles; None where none of at most 250 impacts is found.

    Notes
    -----
    Multipliers are those of the product of D G along the orbit, which keeps the relative accuracy of weak impacts;
    closing conditions lose it where x - c is below a rounding of x.

    Examples
    --------
    >>> found = settled_orbit(Oscillator("x", "cos(4*t)", 0, "1/2"), 0, 1)
    >>> print(found.n, found.k, f"{found.v[0]:.12f}")
    1 2 0.533333333333
    """
    assert osc.period is not None
    period, n = as_float(osc.period), 0
    for _ in range(SETTINGS.rounds):
        flown = orbit(osc, tau, v, impacts=SETTINGS.impacts)
        if (lifted := flown.tau[flown.kind == "release"]).size > 1:
            return _with_rest(osc, lifted, period)
        if flown.tau.size <= SETTINGS.impacts or not (flown.kind[-2 * SETTINGS.most :] == "impact").all():
            return None
        distance = _distances(flown, period)
        # an orbit that turns as it comes nearer is sooner near after two rounds than after one: the first n counts
        near = np.flatnonzero(distance < SETTINGS.nearing)
        if not near.size:
            return None
        n = int(near[0]) + 1
        if distance[n - 1] < SETTINGS.near:
            return _closed(osc, flown, n, period)
        tau, v = float(flown.tau[-1]), float(flown.v[-1])
        tau -= period * np.floor(tau / period)
    near = np.flatnonzero(distance < SETTINGS.near)
    return _closed(osc, flown, int(near[0]) + 1, period) if near.size else None


def _distances(flown: Orbit, period: float) -> Array:
    """Distances of the last state from those 1, 2, ... impacts before, phases apart from whole periods."""
    times, speeds = flown.tau, flown.v
    before = slice(-2, -SETTINGS.most - 2, -1)
    apart = (times[-1] - times[before]) / period
    fast = float(speeds[-SETTINGS.most :].max())
    return np.asarray(np.maximum(np.abs(apart - np.rint(apart)), np.abs(speeds[before] - speeds[-1]) / fast))


def _closed(osc: Oscillator, flown: Orbit, n: int, period: float) -> PeriodicOrbit:
    """The last n impacts as a periodic orbit, the one of the least phase first."""
    times, speeds = flown.tau, flown.v
    turns = (times[-1] - times[-1 - n]) / period
    k, first = int(np.rint(turns)), int(np.argmin(np.mod(times[-n:], period)))
    at = slice(-2 * n + first, -n + first) if first else slice(-n, None)
    tau, v = times[at] - period * np.floor(times[at][0] / period), speeds[at]
    miss = max(abs(float(turns) - k) * period, abs(float(speeds[-1] - speeds[-1 - n])))
    return PeriodicOrbit(tau, v, _multipliers(osc, tau, v), miss, np.int8(Status.hit), osc, n, k)


def _multipliers(osc: Oscillator, tau: Array, v: Array) -> Array:
    """The eigenvalues of the product of D G, the larger first."""
    product, determinant = np.eye(2), 1.0
    for matrix in derivative(osc, tau, v).matrix:
        product = matrix @ product
        determinant *= float(np.linalg.det(matrix))
    half = float(np.trace(product)) / 2
    root = np.sqrt(complex(half * half - determinant))
    first = half + root if half > 0 else half - root
    eigenvalues = np.array([first, determinant / first if first else 0.0])
    return eigenvalues.real if not eigenvalues.imag.any() else eigenvalues


def _with_rest(osc: Oscillator, lifted: Array, period: float) -> PeriodicOrbit | None:
    """The orbit of a mass that lifts off again and again at the same phases."""
    last = float(lifted[-1])
    for earlier in lifted[-2::-1].tolist():
        k, miss = turns_between(earlier, last, period)
        if miss < SAME_PHASE * period:
            return chatter_orbit(osc, last, k, miss)
    return None
