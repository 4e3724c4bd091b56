"""Motions of a model without t that meet no wall: they settle on a cycle or at a rest off the wall, or return.

Motions in the plane of x and x' do not cross, so the minima of x along one of them form a monotone sequence.  Minima
that converge above the wall are followed to their limit, which is extrapolated from the ratio of their last two steps.
"""

from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.dynamics.attractors import AWAY, CYCLE, LEVEL, STILL, STUCK
from singimpact.dynamics.phases import phases_of
from singimpact.flights.flat_numbers import gap_of
from singimpact.flights.flight_path import acceleration_off_wall, followed
from singimpact.flights.horizons import horizon_of
from singimpact.oscillator.model import Oscillator


@dataclass(frozen=True)
class FreeSettings:
    """When a motion without impact is decided; lengths are relative to the range of x - c on the stretch."""

    # samples at first; 2048 at most in a turn
    samples: int = 256
    # samples follow the motion where the trapezoidal rule for x' misses x by less than this
    missed: float = 0.02
    block: int = 500  # motions that are sampled together
    # distance of the limit of the minima, and size of a cycle; periods are then right to 1e-8
    limit: float = 1e-9
    small: float = 1e-5
    # step of a neighbour that must come nearer to the cycle in one turn
    beside: float = 1e-3
    level: float = 1e-6  # of its distance; nearer to 1 all orbits close
    # distance from an attracting rest off the wall, in units of its height
    near: float = 1e-2
    # steps of Newton's method
    newton: int = 30


SETTINGS = FreeSettings()


def free_fates(model: Oscillator, height: Array, xdot: Array) -> Array:
    """Rows (code, a, b), shape (n, 3), of motions off the wall: CYCLE with its period and least x - c; STILL with x - c
    and 0; LEVEL; AWAY of motions that are not decided before the horizon; STUCK of those that doubles do not hold; nan
    of motions that come to the wall.

    Parameters
    ----------
    model : one without t. height, xdot : x - c >= 0 and x', shape (n,). With two walls a motion may come to either.

    Examples
    --------
    >>> model = Oscillator("x - (1 - x**2)*xdot", "0", -3, 1)
    >>> free_fates(model, np.array([3.1]), np.array([0.0]))[0, 1].round(6).tolist()
    6.663287
    """
    rows = _fates(model, height, xdot)
    if model.upper is not None:  # and as seen from the upper wall, which decides where it says that the motion comes
        above = _fates(model.mirrored, gap_of(model)[0] - height, -xdot)
        open_ = ~np.isin(above[:, 0], (CYCLE, STILL, LEVEL))
        rows[open_] = above[open_]
    return rows


def _fates(model: Oscillator, height: Array, xdot: Array) -> Array:
    rows = np.full((height.size, 3), np.nan)
    for first in range(0, height.size, SETTINGS.block):
        chosen = np.arange(first, min(first + SETTINGS.block, height.size))
        # turns of the fastest motion that are followed first, then twice as many
        state, span, time = np.stack([height, xdot], axis=1)[chosen], 8 * phases_of(model).unit, 0.0
        while chosen.size and time < horizon_of(model, None):
            times, way = _followed(model, state, span)
            decided = _decided(model, times, way)
            rows[chosen] = decided
            going = decided[:, 0] == AWAY
            chosen, state = chosen[going], way[going, -1]
            time, span = time + span, 2 * span
    return rows


def _moved(model: Oscillator, state: Array, times: Array) -> Array:
    """x - c and x', shape (n, m, 2), at times (n, m) after states (n, 2); the wall is not felt."""
    n, m = times.shape
    z, u = state.T
    with np.errstate(all="ignore"):
        flat = followed(model, np.zeros(n), u.copy(), np.full(n, m), np.ascontiguousarray(times.ravel()), z)
    return flat.reshape(n, m, 2)


def _followed(model: Oscillator, state: Array, span: float) -> tuple[Array, Array]:
    """Times and states of motions, as dense as they bend."""
    count = SETTINGS.samples
    while True:
        times = np.linspace(0, span, count + 1)
        way = np.concatenate([state[:, None], _moved(model, state, np.broadcast_to(times[1:], (len(state), count)))], 1)
        z, u = way[..., 0], way[..., 1]
        with np.errstate(all="ignore"):
            miss = np.abs(np.diff(z) - (u[:, 1:] + u[:, :-1]) / 2 * times[1]).max(axis=1)
            coarse = (miss > SETTINGS.missed * np.ptp(z, axis=1)).any()
        if not coarse or count * phases_of(model).unit > 2048 * span:
            return times, way
        count *= 2


def _decided(model: Oscillator, times: Array, way: Array) -> Array:
    """The rows of motions after one stretch of them."""
    rows = np.zeros((len(way), 3))
    rows[:, 0] = AWAY
    height = np.ptp(way[..., 0], axis=1)
    rest, at_rest = _rests(model, way)
    rows[at_rest] = np.stack([np.full(rest.size, STILL), rest, 0 * rest], axis=1)[at_rest]
    lows = _minima(model, times, way)
    (early, first), (before, middle), (after, last) = np.moveaxis(lows, 0, -1)
    with np.errstate(all="ignore"):
        step, ratio = last - middle, np.abs((last - middle) / (middle - first))
        equal, tail = np.abs(step) < 1e-13 * height, ratio / (1 - ratio)
        left = np.where(equal, 0.0, np.abs(step) * tail)
        period = after - before + np.where(equal, 0.0, (after - 2 * before + early) * tail)
        converged = (left < SETTINGS.limit * height) & ((ratio < 1) | (left == 0))
        closed = converged & (height > SETTINGS.small * last) & (last > 2 * left)
        # a neighbour comes nearer in a turn, as it does not where all orbits close
        beside = np.where(closed, last + SETTINGS.beside * height, np.nan)
    near = np.flatnonzero(closed & ~at_rest)
    turned = _turned(model, beside[near], period[near])
    with np.errstate(all="ignore"):
        share = np.abs(turned - last[near]) / (SETTINGS.beside * height[near])
    rows[near[np.abs(share - 1) < SETTINGS.level], 0] = LEVEL
    near = near[share <= 1 - SETTINGS.level]
    rows[near] = np.stack([np.full(near.size, CYCLE), period[near], last[near]], axis=1)
    with np.errstate(invalid="ignore"):
        rows[(way[..., 0] < 0).any(axis=1) | (lows[:, :, 1] < 0).any(axis=1)] = np.nan
    rows[~np.isfinite(way).all(axis=(1, 2)) & ~np.isnan(rows[:, 0])] = STUCK, 0.0, 0.0
    return rows


def _turned(model: Oscillator, low: Array, period: Array) -> Array:
    """The next minimum after minima that lie beside a cycle of a period."""
    times = np.linspace(0, 1.5, SETTINGS.samples)[None] * period[:, None]
    start = np.stack([low, 0 * low], axis=1)
    if not low.size:
        return low
    way = np.concatenate([start[:, None], _moved(model, start, times[:, 1:])], axis=1)
    return _minima(model, times, way)[:, -1, 1]


def _minima(model: Oscillator, times: Array, way: Array) -> Array:
    """Time and x - c of the last three minima of motions, shape (n, 3, 2); nan where there are fewer."""
    out = np.full((len(way), 3, 2), np.nan)
    u = way[..., 1]
    with np.errstate(invalid="ignore"):
        which, index = np.nonzero((u[:, :-1] < 0) & (u[:, 1:] >= 0))
    counts = np.bincount(which, minlength=len(way))
    slot = 2 - (np.cumsum(counts)[which] - 1 - np.arange(which.size))
    which, index, slot = (column[slot >= 0] for column in (which, index, slot))
    grid = np.broadcast_to(times, u.shape)
    width, state = grid[which, index + 1] - grid[which, index], way[which, index]
    later = width * u[which, index] / (u[which, index] - u[which, index + 1])
    low, ends = state, [0 * width, width]
    for _ in range(SETTINGS.newton if which.size else 0):  # Newton's method for x' = 0, within a bracket
        low = _moved(model, state, later[:, None])[:, 0]
        falls = low[:, 1] < 0
        ends = [np.where(falls, later, ends[0]), np.where(falls, ends[1], later)]
        with np.errstate(all="ignore"):
            aim = later - low[:, 1] / acceleration_off_wall(model, *low.T)
        inside = (aim >= ends[0]) & (aim <= ends[1])
        later, before = np.where(inside, aim, (ends[0] + ends[1]) / 2), later
        # the step, in units of the bracket, after which the method has converged
        if (np.abs(later - before) <= 1e-12 * width).all():
            break
    out[which, slot, 0], out[which, slot, 1] = grid[which, index] + later, low[:, 0]
    return out


def _rests(model: Oscillator, way: Array) -> tuple[Array, Array]:
    """x - c of the rest off the wall beside motions, and whether it attracts and they end near and come nearer."""
    half = way.shape[1] // 2
    z, step = way[:, half:, 0].mean(axis=1), 1e-6
    with np.errstate(all="ignore"):
        for _ in range(SETTINGS.newton):
            size = step * np.maximum(np.abs(z), 1e-3)
            ahead, behind = (acceleration_off_wall(model, z + side * size, 0 * z) for side in (1, -1))
            z = z - acceleration_off_wall(model, z, 0 * z) * 2 * size / (ahead - behind)
        size = step * np.maximum(np.abs(z), 1e-3)
        stiff = (acceleration_off_wall(model, z - size, 0 * z) - acceleration_off_wall(model, z + size, 0 * z)) / (
            2 * size
        )
        rate = np.sqrt(stiff)
        loss = (acceleration_off_wall(model, z, -size * rate) - acceleration_off_wall(model, z, size * rate)) / (
            2 * size * rate
        )
        away = np.maximum(np.abs(way[..., 0] - z[:, None]), np.abs(way[..., 1]) / rate[:, None])
        now, before = away[:, -half // 2 :].max(axis=1), away[:, half : -half // 2].max(axis=1)
        balanced = np.abs(acceleration_off_wall(model, z, 0 * z)) < 1e-9 * stiff * np.maximum(np.abs(z), 1e-3)
        comes = (z > 0) & (stiff > 0) & (loss > 1e-6 * rate) & balanced & (now < before) & (now < SETTINGS.near * z)
    return z, comes
