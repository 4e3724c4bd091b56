"""The stable manifold of X at an unfolded negative swan: its heights over lines before A on true orbits.

A line lies h half distances of A and B before A, and heights are v/(a'(A) (A - tau)^2).
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise
from math import log
from typing import NamedTuple

import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics import swan_configuration
from singimpact.oscillator import Oscillator, acceleration
from singimpact.paper import System, generations, inner_start, resting_times

RATES = ("3/10", "1/2", "4/5")
GENERATIONS = 4
LINES = (1e-3, 5e-4)  # h
REST = 1e-8  # half distances behind A from which an orbit at rest is followed: its foot is X to 1e-16
STEPS = 8  # of the secant method; 5 reach rounding
FLIGHTS = 2000  # of an orbit at most, until the rest of its chatter is summed up
SLOW = 1e-9  # the velocity from which on it is, behind B


Swan = System  # with an unfolded negative swan near t = 0
SWANS = (
    Swan("x'' = 12(1 - t^2), c = 0", "0", "-12*(t**2 - 1)", "0"),
    Swan("x'' + x = cos 2t, c = 19/20", "x", "cos(2*t)", "0.95"),
    Swan("x'' + x'/10 + x + 3x^3/10 = (13/10) cos 2t, c = 19/20", "x + 0.1*xdot + 0.3*x**3", "1.3*cos(2*t)", "0.95"),
)


@dataclass(frozen=True)
class Heights:
    """Crossings of W^s(X) with two lines before A: GENERATIONS outer ones, then as many inner ones.

    Attributes
    ----------
    lines : h. found : a row of heights for each line. left : |foot - X| at them.
    """

    lines: tuple[float, ...]
    found: tuple[tuple[float, ...], ...]
    left: float


class _Setting(NamedTuple):
    osc: Oscillator
    A: float
    B: float
    slope: float  # a'(A)
    X: float


@cache
def _setting(swan: Swan, rate: str) -> _Setting:
    osc = swan.over(swan.clearance, rate)
    near = swan_configuration(osc, near=0)
    slope = float(acceleration(osc, np.array([near.A]), order=1)[0])
    (foot,) = _feet(osc, near.B, np.array([near.A + REST * (near.B - near.A) / 2]), np.zeros(1)).tolist()
    return _Setting(osc, near.A, near.B, slope, foot)


def _feet(osc: Oscillator, B: float, tau: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Where orbits come to rest behind B."""
    return resting_times(osc, tau, v, FLIGHTS, SLOW, B)


@cache
def heights(swan: Swan, rate: str) -> Heights:
    """The crossings nearest to the heights of the limit, by the secant method."""
    at, r = _setting(swan, rate), float(Fraction(rate))
    starts = np.array([*generations(0.5, r, GENERATIONS), *generations(inner_start(r), r, GENERATIONS)])
    line, start = np.repeat(LINES, starts.size), np.tile(starts, len(LINES))
    reach = line * (at.B - at.A) / 2

    def miss(w: np.ndarray) -> np.ndarray:
        return _feet(at.osc, at.B, at.A - reach, w * at.slope * reach**2) - at.X

    last, now = start, start + 0.1 * line
    before, off = miss(last), miss(now)
    for _ in range(STEPS):
        change = np.where(off == before, 0.0, off * (now - last) / np.where(off == before, 1.0, off - before))
        last, before, now = now, off, now - change
        off = miss(now)
    rows = now.reshape(len(LINES), -1)
    return Heights(LINES, tuple(tuple(row.tolist()) for row in rows), float(np.abs(off).max()))


def test_heights_are_ordered_about_their_tears():
    for r in (0.1, 0.3, 0.5, 0.8, 0.95):
        outer, tears, inner = (generations(start, r, 6) for start in (0.5, 0.375, inner_start(r)))
        falling = [w for triple in zip(outer, tears, inner, strict=True) for w in triple]
        assert all(one > two for one, two in pairwise(falling))
        rate = float(si.fixed_points.tangency(str(r)).lambda_.value)
        assert falling[-1] > (1 - rate) * (2 + rate) / 6


@pytest.mark.slow
def test_heights_on_true_orbits_agree_with_the_known_ones():
    """r = 1/2 in the universal model: (true - limit)/h at the first crossings, to four digits."""
    found = heights(SWANS[0], "1/2")
    limits = [*generations(0.5, 0.5, GENERATIONS), *generations(inner_start(0.5), 0.5, GENERATIONS)]
    slopes = (np.array(found.found[0]) - limits) / found.lines[0]
    assert np.allclose(slopes[[0, 1, 4, 5]], [0.1191, 0.0843, 0.1378, 0.0805], atol=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("swan", SWANS, ids=[swan.name for swan in SWANS])
def test_heights_on_true_orbits_differ_from_those_of_the_limit_to_first_order(swan, rate):
    r = float(Fraction(rate))
    found = heights(swan, rate)
    assert found.left < 1e-12
    errors = np.array(found.found) - [*generations(0.5, r, GENERATIONS), *generations(inner_start(r), r, GENERATIONS)]
    orders = np.log(np.abs(errors[0] / errors[1])) / log(found.lines[0] / found.lines[1])
    assert np.all(np.abs(orders - 1) < 0.1)


@pytest.mark.slow
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("swan", SWANS, ids=[swan.name for swan in SWANS])
def test_feet_beside_gamma_shrink_by_the_square_of_lambda(swan, rate):
    """Foot - X where ln delta/ln mu takes four phases in three successive periods, over one line above gamma."""
    at, both = _setting(swan, rate), si.fixed_points.tangency(rate)
    tau, mu = at.A - 0.05 * (at.B - at.A) / 2, float(both.mu.value)
    edge = float(si.threshold(at.osc, tau).v)
    distances = [1e-3 * mu ** -(period + np.array([0.0, 0.25, 0.5, 0.75])) for period in range(3)]
    rows = np.array([_feet(at.osc, at.B, np.full(4, tau), edge * (1 + delta)) - at.X for delta in distances])
    off = np.abs(rows[1:] / rows[:-1] / float(both.lambda_.value) ** 2 - 1)
    assert np.all(off < 0.02)
    assert np.all(off[1] < off[0])
    assert (rows[0] > 0).any()
    assert (rows[0] < 0).any()
