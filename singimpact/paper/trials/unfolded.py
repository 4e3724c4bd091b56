"""Orbits of the universal unfolded swan: what is visible, where gamma ends, the stable manifold through A."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import sympy
from scipy.optimize import brentq

from singimpact.algebra.solving import halved
from singimpact.impact_oscillator import ImpactOscillator, universal
from singimpact.paper.trials import true_orbits

SEED = 20072
NEAR = 0.01  # of the way to A or B: chatter that ends so soon ends before either


def negative(r: str) -> ImpactOscillator:
    """x'' = -12 (t^2 - 1): kappa = -1."""
    return universal(-1, r)


@dataclass(frozen=True)
class Visibility:
    """Points of V' with v >= 0 and t > 0: how many, and how many are on the wrong side of the loop ADCBA."""

    count: int
    inside: int
    wrong: int


@lru_cache(maxsize=1)
def visibility() -> Visibility:
    """Random points (sigma, t), visible when the first hit from (sigma, v) comes at t, against the loop."""
    rng = np.random.default_rng(SEED)
    sigma, t = rng.uniform(-4, 2, 3000), rng.uniform(0.01, 6, 3000)
    v = t * (6 * (sigma**2 - 1) + 4 * sigma * t + t**2)
    keep = v > 1e-6
    sigma, t, v = sigma[keep], t[keep], v[keep]
    times = np.asarray(negative("1/2").first_hit(sigma, v).flight_time)
    seen = np.abs(times - t) < 1e-7 * (1 + t)
    inside = _winds(_loop(), sigma, t)
    return Visibility(len(t), int(inside.sum()), int(np.count_nonzero(seen == inside)))


def _loop(points: int = 2000) -> Any:
    """The closed polygon A-D (horizon), D-C (shadow), C-B (zero set), B-A, in (sigma, t)."""
    on_horizon = np.linspace(0, 4, points)
    sigma = (
        -(4 * on_horizon + np.sqrt(36 - 2 * on_horizon**2)) / 6
    )  # H: 6 sigma^2 + 8 sigma t + 3 t^2 = 6, through A and D
    shadow = np.column_stack([sigma, -4 * sigma - 2 * on_horizon])[::-1]
    launch = np.linspace(-1, 1, points)
    zero_set = np.column_stack([launch, -2 * launch + np.sqrt(6 - 2 * launch**2)])
    return np.vstack([np.column_stack([sigma, on_horizon]), shadow, zero_set])


def _winds(loop: Any, x: Any, y: Any) -> Any:
    """Whether points lie inside a polygon: crossings of a ray, counted."""
    x0, y0 = loop.T
    x1, y1 = np.roll(loop, -1, axis=0).T
    with np.errstate(divide="ignore", invalid="ignore"):
        spans = (y0[:, None] > y) != (y1[:, None] > y)
        at = (x1 - x0)[:, None] * (y - y0[:, None]) / (y1 - y0)[:, None] + x0[:, None]
        return np.count_nonzero(spans & (x < at), axis=0) % 2 == 1


@lru_cache(maxsize=8)
def foot(r: str, sigma: float = -1.0, v: float = 0.0) -> float:
    """Where chatter from (sigma, v) comes to rest in the negative swan; for A itself this is X."""
    osc, tau, speed = negative(r), sigma, v
    for _ in range(2000):
        step = osc.impact_map(tau, speed)
        tau, speed = float(step.tau), float(step.v)
        if speed < 1e-14:
            break
    return tau - 2 * speed / (float(osc.acceleration(tau)) * (1 - float(sympy.Rational(r))))


@lru_cache(maxsize=1)
def tangency_at_A() -> tuple[float, float]:
    """v/(sigma + 1)^2 on the stable manifold through A, to the left and to the right of A, extrapolated; r = 1/2."""
    goal = foot("1/2")
    sides = []
    for side in (-1, 1):
        ratios = []
        for h in (0.02, 0.01):

            def miss(ratio: float, place: float = -1 + side * h, unit: float = h * h) -> float:
                return foot("1/2", place, ratio * unit) - goal

            ratios.append(brentq(miss, 10.5, 13.5, xtol=1e-9))
        sides.append(2 * ratios[1] - ratios[0])
    return sides[0], sides[1]


@lru_cache(maxsize=8)
def gamma_end(r: str, v: float = 0.0, narrow: float = 1e-12) -> float:
    """sigma in (E', A) from which, at velocity v, the positive swan's orbit runs along gamma into B: by bisection."""
    low, high = halved(lambda sigma: not completes(r, sigma, v), -float(np.sqrt(3)) + 1e-9, -1 - 1e-9, narrow)
    return (low + high) / 2


def completes(r: str, sigma: float, v: float = 0.0) -> bool:
    """Whether chatter from (sigma, v) in the positive swan is complete before B."""
    osc, tau, rate = universal(1, r), sigma, float(Fraction(r))
    for _ in range(400):
        step = osc.impact_map(tau, v)
        tau, v = float(step.tau), float(step.v)
        if not np.isfinite(tau) or tau > 1:
            return False
        # with the acceleration that presses here chatter ends after 2v/(|a|(1 - r)); over a hundredth of the way to A
        # or B that acceleration changes by 2 %, and each impact still takes the velocity down
        if v < NEAR * 6 * (1 - tau * tau) * (1 - abs(tau)) * (1 - rate):
            return True
    return False


@dataclass(frozen=True)
class Crossings:
    """How often the arc R(phi(AE)) meets the outline p(BE) over A..B, and its slope at A; the worst over some r."""

    counts: tuple[int, ...]
    slope: float


@lru_cache(maxsize=1)
def epsilon() -> Crossings:
    """For r = 0.1, 0.5, 0.9, kappa = 1: both curves as functions of time on (-1, 1)."""
    # outline p(BE): H through B and E; phi(AE) is the other branch, launched backwards
    t = np.linspace(0, 2 * np.sqrt(3), 40001)
    sigma = (-4 * t + np.sqrt(36 - 2 * t**2)) / 6
    outline = -t * (6 * (sigma**2 - 1) + 4 * sigma * t + t**2)
    launch = np.linspace(-1, -np.sqrt(3), 40001)
    flight = -2 * launch - np.sqrt(np.maximum(6 - 2 * launch**2, 0))
    place, speed = launch + flight, flight * (6 * (launch**2 - 1) + 8 * launch * flight + 3 * flight**2)
    order = np.argsort(sigma)
    grid = np.linspace(-0.999, 0.999, 4001)
    counts = []
    for r in (0.1, 0.5, 0.9):
        arc = np.interp(grid, place, -r * speed)
        difference = arc - np.interp(grid, sigma[order], outline[order])
        counts.append(int(np.count_nonzero(np.sign(difference[1:]) != np.sign(difference[:-1]))))
    return Crossings(tuple(counts), float(-0.5 * speed[40] / (place[40] + 1)))


@dataclass(frozen=True)
class Preimages:
    """On the line sigma = -1 - h: v/h^2 on delta, G^-1(delta), G^-2(delta), ..., and on gamma, as h -> 0; r = 1/2.

    Attributes
    ----------
    heights : of delta and its inverse images, at h = 0.001. farther : the first two at h = 0.002.
    gamma : that of gamma. factor : the last ratio of distances to gamma.
    """

    heights: tuple[float, ...]
    farther: tuple[float, ...]
    gamma: float
    factor: float


@lru_cache(maxsize=1)
def preimages() -> Preimages:
    """Jumps of the number of impacts before the long flight over A."""
    rate = true_orbits.lambda_of(0.5, 1)
    limit = 24 * (1 - rate) * (2 + rate) / 6
    heights, farther = _jump_heights(1e-3, limit, 7), _jump_heights(2e-3, limit, 2)
    factor = (heights[-1] - limit) / (heights[-2] - limit)
    return Preimages(heights, farther, limit, factor)


def _jump_heights(h: float, limit: float, jumps: int) -> tuple[float, ...]:
    """v/h^2 at the first jumps on the line sigma = -1 - h, from delta downwards to `limit`."""
    heights, high = [], 24 * 0.4
    for count in range(1, jumps + 1):
        low, top = _jump(h, count, limit, high)
        heights.append((low + top) / 2)
        high = low
    return tuple(heights)


def _jump(h: float, count: int, low: float, high: float) -> tuple[float, float]:
    """Neighbouring v/h^2 above which fewer than `count` impacts follow."""
    return halved(lambda height: _impacts_before_leaving(-1 - h, height * h * h) >= count, low, high, 1e-14)


def _impacts_before_leaving(sigma: float, v: float, most: int = 60) -> int:
    """How many short flights an orbit near A makes before one that takes longer than 1."""
    osc, tau, speed = negative("1/2"), sigma, v
    for count in range(most):
        step = osc.impact_map(tau, speed)
        if float(step.flight_time) > 1:
            return count
        tau, speed = float(step.tau), float(step.v)
    return most


@dataclass(frozen=True)
class Loops:
    """Crossings of the stable manifold through A with lines sigma = const, r = 1/2.

    Attributes
    ----------
    around : (above delta, below it down to 0.8 of its height) on lines that delta meets.
    beyond : crossings within the loop's reach on two lines to the left of D', the second one past the loop's end.
    between : crossings between successive inverse images of delta, towards gamma, on the line sigma = -1.02.
    """

    around: tuple[tuple[int, int], ...]
    beyond: tuple[int, int]
    between: tuple[int, ...]


@lru_cache(maxsize=1)
def loops() -> Loops:
    """Signs of foot - X along the lines."""
    around = tuple((_crossings(s, 1.0, 2.0), _crossings(s, 0.8, 1.0)) for s in (-1.05, -1.8, -2.7))
    beyond = _crossings(-4.5, 0.98, 1.3), _crossings(-5.0, 0.98, 1.3)
    unit = 0.02**2 / _outline(-1.02)
    edges = [height * unit for height in preimages().heights[1:5]]
    return Loops(around, beyond, tuple(_crossings(-1.02, low, high) for high, low in pairwise(edges)))


def _outline(sigma: float) -> float:
    """v on delta over sigma in (-3, -1); to the left of D' the value that the end of delta would have there."""
    t = np.linspace(0, 4, 20001)
    flight = float(np.interp(-sigma, (4 * t + np.sqrt(36 - 2 * t**2)) / 6, t))
    return flight * (6 * (sigma**2 - 1) + 4 * sigma * flight + flight**2)


def _crossings(sigma: float, low: float, high: float, coarse: int = 76, fine: int = 20) -> int:
    """How often foot - X changes sign, without a jump, for v between two multiples of the outline's.

    Looked for between neighbours of a coarse grid whose signs differ: a jump may stand beside a crossing.
    """
    count, unit = 0, _outline(sigma)
    v = unit * np.linspace(low, high, coarse * fine)[1:-1]
    places = [*range(0, len(v) - 1, fine), len(v) - 1]
    off = _off(sigma, v[places])
    for at in np.flatnonzero(np.sign(off[1:]) != np.sign(off[:-1])):
        near = _off(sigma, v[places[at] : places[at + 1] + 1])
        count += int(np.count_nonzero((np.sign(near[1:]) != np.sign(near[:-1])) & (np.abs(np.diff(near)) < 0.5)))
    return count


def _off(sigma: float, v: Any) -> Any:
    """foot - X over one phase."""
    return _feet(negative("1/2"), np.full_like(v, sigma), v) - foot("1/2")


def _feet(osc: ImpactOscillator, tau: Any, v: Any) -> Any:
    """Where chatter from arrays of states comes to rest, r = 1/2; what is left at v < 1e-7 is 4v/|a|, to 1e-13."""
    tau, v = np.array(tau), np.array(v)
    for _ in range(120):
        flying = np.flatnonzero(v > 1e-7)
        if not flying.size:
            break
        step = osc.impact_map(tau[flying], v[flying])
        tau[flying], v[flying] = step.tau, step.v
    return tau - 2 * v / (osc.acceleration(tau) * 0.5)
