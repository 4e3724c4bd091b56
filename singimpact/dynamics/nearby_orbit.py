"""The periodic orbit beside a state that almost returns to itself: Newton's method for its period, and its stability.

    G^n(tau, v) = (tau + k T, v)        (tau, v) -= (D G^n - 1)^-1 (G^n - id - (k T, 0))

An orbit that passes beside a fold returns to 1e-6 for thousands of turns although no periodic orbit is there, and next
to a doubling a state comes nearer by turns of 2n impacts where n close the orbit.  The distance of a return shows
neither.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.flights.derivative import derivative
from singimpact.flights.orbits import iterate
from singimpact.oscillator.model import Oscillator

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class NearbySettings:
    """steps : of Newton's method; at a doubling each halves the distance. closed : relative residual of an orbit, some
    10^5 roundings. near : relative distance within which it is looked for. neutral : size of a multiplier up to which
    an orbit attracts or is neutral. same : relative residual of an orbit after fewer impacts that close it too.
    returned : relative residual of a state that has settled where no orbit is found, as next to a graze.
    """

    steps: int = 30
    closed: float = 1e-11
    near: float = 1e-2
    neutral: float = 1 + 1e-7
    same: float = 1e-8
    returned: float = 1e-10


SETTINGS = NearbySettings()


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
        return self.residual < SETTINGS.returned


def nearby_orbits(model: Oscillator, tau: Array, v: Array, n: Array, k: Array, fast: float) -> Nearby:
    """Periodic orbits of n impacts in k periods beside states, all of shape (m,).

    Examples
    --------
    >>> model = Oscillator("x", "cos(2*t)", "0.3", "1/2")
    >>> end = iterate(model, np.array([0.3]), np.array([1.5]), 30)
    >>> beside = nearby_orbits(model, end.tau, end.v, np.array([2]), np.array([2]), 2.0)
    >>> bool(beside.found[0]), int(beside.n[0])
    (True, 1)
    """
    assert model.period is not None
    period, scale = as_float(model.period), np.array([as_float(model.period), fast])
    tau = tau - period * np.floor(tau / period)
    starts = np.stack([tau, v], axis=-1)
    states, attracting = starts.copy(), np.zeros(tau.size, dtype=bool)
    first, left = np.full(tau.size, np.inf), np.arange(tau.size)
    for step in range(SETTINGS.steps):
        residual, slopes = _return(model, states[left], n[left], k[left])
        away = np.abs(residual / scale).max(axis=1, initial=0.0)
        if step == 0:
            first[:] = away
        # |multipliers| <= size where both roots of z^2 - s z + p are within the circle of that radius
        size, trace, area = SETTINGS.neutral, np.trace(slopes, axis1=1, axis2=2), np.linalg.det(slopes)
        attracts = (np.abs(area) <= size**2) & (np.abs(trace) * size <= size**2 + area)
        closed = away < SETTINGS.closed
        attracting[left[closed]] = attracts[closed]
        moved = _newton(residual, slopes)
        aim = states[left] + moved
        there = np.abs((aim - starts[left]) / scale).max(axis=1, initial=0.0) < SETTINGS.near
        going = ~closed & there & (aim[:, 1] > 0)
        left = left[going]
        if not left.size:
            break
        states[left] = aim[going]
    n, k = _least(model, states, n, k, attracting, scale)
    return Nearby(states[:, 0], states[:, 1], n, k, attracting, first)


def _newton(residual: Array, slopes: Array) -> Array:
    """Newton's step of each state; nan where the matrix has no inverse."""
    (a, b), (c, d) = np.moveaxis(slopes - np.eye(2), 0, -1)
    with np.errstate(all="ignore"):
        area = a * d - b * c
        p, q = residual.T
        return np.stack([(b * q - d * p) / area, (c * p - a * q) / area], axis=-1)


def _return(model: Oscillator, states: Array, n: Array, k: Array) -> tuple[Array, Array]:
    """G^n(tau, v) - (tau + k T, v) and D G^n; nan where a flight ends before."""
    assert model.period is not None
    at, speed = states.T.copy()
    slopes = np.broadcast_to(np.eye(2), (len(states), 2, 2)).copy()
    for count in range(int(n.max(initial=0))):
        going = np.flatnonzero((n > count) & (speed > 0))
        if going.size:
            slopes[going] = derivative(model, at[going], speed[going]).matrix @ slopes[going]
            ends = iterate(model, at[going], speed[going], 1)
            at[going], speed[going] = ends.tau, np.where(ends.status == 0, ends.v, np.nan)
    return np.stack([at - states[:, 0] - k * as_float(model.period), speed - states[:, 1]], axis=-1), slopes


def _least(
    model: Oscillator, states: Array, n: Array, k: Array, attracting: Array, scale: Array
) -> tuple[Array, Array]:
    """The least impacts and periods of the orbits that were found."""
    assert model.period is not None
    n, k = n.copy(), k.copy()
    at, speed = states.T.copy()
    several = np.flatnonzero(attracting & (n > 1))
    for count in range(1, int(n[several].max(initial=1))):
        ends = iterate(model, at[several], speed[several], 1)
        at[several], speed[several] = ends.tau, ends.v
        whole = (n[several] % count == 0) & (k[several] * count % n[several] == 0)
        periods = k[several] * count // n[several]
        off = np.stack([at[several] - states[several, 0] - periods * scale[0], speed[several] - states[several, 1]])
        least = whole & (np.abs(off / scale[:, None]).max(axis=0) < SETTINGS.same)
        n[several[least]], k[several[least]] = count, periods[least]
        several = several[~least & (n[several] > count)]
        if not several.size:
            break
    return n, k
