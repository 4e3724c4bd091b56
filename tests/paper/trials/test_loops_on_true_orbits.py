"""Orbits of the universal unfolded swan: what is proved of stable manifolds, their loops and gamma holds on them."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import sympy
from first_order_feet import limit_of
from scipy.optimize import brentq

from singimpact.impact_oscillator import universal
from singimpact.paper.trials import true_orbits
from singimpact.status import Status
from singimpact.theory import lambda_, mu_of_lambda

TEAR = 1e-6  # relative distance from a discontinuity at which its sides are looked at


def halved(stays, low, high, width):
    """Neighbours (low, high) where `stays` ends to hold, as near as `width` of them allows."""
    while high - low > width * abs(high):
        middle = (low + high) / 2
        if not low < middle < high:
            break
        low, high = (middle, high) if stays(middle) else (low, middle)
    return low, high


@lru_cache(maxsize=1)
def tangency_at_A() -> tuple[float, float]:
    """v/(sigma + 1)^2 on the stable manifold through A, to the left and to the right of A, extrapolated; r = 1/2."""
    goal = limit_of("1/2")
    sides = []
    for side in (-1, 1):
        ratios = []
        for h in (0.02, 0.01):

            def miss(ratio: float, place: float = -1 + side * h, unit: float = h * h) -> float:
                return limit_of("1/2", place, ratio * unit) - goal

            ratios.append(brentq(miss, 10.5, 13.5, xtol=1e-9))
        sides.append(2 * ratios[1] - ratios[0])
    return sides[0], sides[1]


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
    return Preimages(heights, farther, limit, (heights[-1] - limit) / (heights[-2] - limit))


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
    """The number of short flights of an orbit near A before one that takes longer than 1."""
    osc, tau, speed = universal(-1, "1/2"), sigma, v
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


@dataclass(frozen=True)
class Beyond:
    """Stable manifolds of points Y to the right of X on the line sigma = -1.02, r = 1/2.

    Attributes
    ----------
    excess : Y - X. crossings : of each manifold, above the fifth inverse image of delta.
    tears : foot - X just below and just above delta and its first inverse images.
    """

    excess: tuple[float, ...]
    crossings: tuple[int, ...]
    tears: tuple[tuple[float, float], ...]


@lru_cache(maxsize=1)
def beyond() -> Beyond:
    """Where feet exceed X between the inverse images of delta, and what they are next to these."""
    place, unit = -1.02, 0.02**2 / _outline(-1.02)
    edges = [height * unit for height in preimages().heights[:6]]
    excess = (1e-4, 5e-5, 1e-5, 5e-6, 1.5e-6)
    counts = tuple(sum(_crossings(place, low, high, more=y) for high, low in pairwise(edges)) for y in excess)
    jumps = [_edge(place, count) for count in range(1, 6)]
    sides = [np.array([low * (1 - TEAR), high * (1 + TEAR)]) for low, high in jumps]
    tears = [tuple(_off(place, pair)) for pair in sides]
    return Beyond(excess, counts, tuple((float(low), float(high)) for low, high in tears))


def _edge(sigma: float, count: int) -> tuple[float, float]:
    """Neighbouring velocities above which fewer than `count` impacts precede the flight over A."""
    return halved(lambda v: _impacts_before_leaving(sigma, v) >= count, 0.0, _outline(sigma) * 1.5, 1e-15)


@lru_cache(maxsize=4)
def feet_on_the_landing_arc(r: str) -> tuple[float, ...]:
    """dK/ds along R(D''C''), s its length and K the foot: from C'' to B, at 59 places, the last 1e-4 from B in t."""
    osc, rate = universal(-1, r), float(sympy.Rational(r))
    grazing = 4 - np.geomspace(4, 1e-4, 60)
    sigma = -(4 * grazing + np.sqrt(36 - 2 * grazing**2)) / 6
    flight = -4 * sigma - 2 * grazing
    tau, v = sigma + flight, rate * flight * (flight - grazing) ** 2
    return tuple(np.diff(osc.chatter_limit(tau, v).tau) / np.hypot(np.diff(tau), np.diff(v)))


@lru_cache(maxsize=4)
def fates(r: str) -> dict[float, tuple[bool, ...]]:
    """In the positive swan, over lines sigma = const in S': whether chatter is complete before B, v rising to p(BE)."""
    osc, found = universal(1, r), {}
    for sigma in (-1.3, -1.1, -0.9, -0.4, 0.2, 0.7, 0.98):
        flight = (-8 * sigma + np.sqrt(72 - 8 * sigma**2)) / 6
        top = -flight * (6 * (sigma**2 - 1) + 4 * sigma * flight + flight**2)
        v = top * np.arange(1, 80) / 80
        ends = osc.chatter_limit(np.full_like(v, sigma), v)
        found[sigma] = tuple(((ends.status == Status.complete) & (ends.tau < 1)).tolist())
    return found


def _crossings(sigma: float, low: float, high: float, coarse: int = 76, fine: int = 20, more: float = 0.0) -> int:
    """The number of sign changes of foot - X - more without a jump, for v between two multiples of the outline's.

    Looked for between neighbours of a coarse grid whose signs differ: a jump may stand beside a crossing.
    """
    count, unit = 0, _outline(sigma)
    v = unit * np.linspace(low, high, coarse * fine)[1:-1]
    places = [*range(0, len(v) - 1, fine), len(v) - 1]
    off = _off(sigma, v[places]) - more
    for at in np.flatnonzero(np.sign(off[1:]) != np.sign(off[:-1])):
        near = _off(sigma, v[places[at] : places[at + 1] + 1]) - more
        count += int(np.count_nonzero((np.sign(near[1:]) != np.sign(near[:-1])) & (np.abs(np.diff(near)) < 0.5)))
    return count


def _off(sigma: float, v: Any) -> Any:
    """foot - X over one phase, r = 1/2; chatter below v = 1e-7 is summed up to 1e-13."""
    return true_orbits.resting_times(universal(-1, "1/2"), np.full_like(v, sigma), v, 120, 1e-7) - limit_of("1/2")


RATES = ("1/10", "1/2", "9/10")


def test_crossings_are_counted_and_jumps_are_not(monkeypatch):
    def off(_sigma, v):
        return np.where(v < 0.5, np.sin(7 * np.pi * v), 5.0 * np.sign(v - 0.75))

    monkeypatch.setitem(_crossings.__globals__, "_off", off)
    monkeypatch.setitem(_crossings.__globals__, "_outline", lambda _: 1.0)
    assert _crossings(-2.0, 0.05, 1.0) == 3


@pytest.mark.slow
def test_the_manifold_through_A_is_tangent_there():
    left, right = tangency_at_A()
    assert abs(left - 12) < 0.1
    assert abs(right - 12) < 0.1


@pytest.mark.slow
def test_a_loop_goes_around_each_inverse_image_of_the_tear():
    found = loops()
    assert all(pair == (1, 1) for pair in found.around)
    assert found.beyond == (2, 0)
    assert set(found.between) == {2}


@pytest.mark.slow
def test_the_inverse_images_of_the_tear_fall_to_gamma():
    found = preimages()
    expected = 1 / float(mu_of_lambda(1).subs(lambda_, true_orbits.lambda_of(0.5, 1)))
    assert found.factor == pytest.approx(expected, abs=0.02)
    assert abs(found.factor - true_orbits.lambda_of(0.5, 1)) > 0.1
    for near, far in zip(found.heights, found.farther, strict=False):
        assert far == pytest.approx(near, rel=0.02)


@pytest.mark.slow
def test_manifolds_behind_X_meet_no_tear_and_gain_two_crossings_for_each():
    counts = beyond()
    assert all(side < 0 for sides in counts.tears for side in sides)
    assert counts.crossings == tuple(2 * count for count in range(len(counts.crossings)))


@pytest.mark.slow
@pytest.mark.parametrize("rate", RATES)
def test_the_end_of_chatter_falls_along_the_landing_arc(rate):
    assert all(change < 0 for change in feet_on_the_landing_arc(rate))


@pytest.mark.slow
@pytest.mark.parametrize("rate", RATES)
def test_gamma_separates_what_rests_on_AB_from_what_leaves(rate):
    lines = fates(rate)
    changes = [sum(one != other for one, other in pairwise(feet)) for feet in lines.values()]
    assert max(changes) == 1
    for feet, changed in zip(lines.values(), changes, strict=True):
        assert not changed or (feet[0], feet[-1]) == (True, False)
        assert changed or not any(feet)  # left of gamma all of it leaves
