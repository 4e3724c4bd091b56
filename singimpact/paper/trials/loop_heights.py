"""The stable manifold of X at an unfolded negative swan: heights over lines before A.

A line lies h half distances of A and B before A, and heights are v/(a'(A) (A - tau)^2).
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from math import sqrt
from typing import NamedTuple

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.dynamics.unfolded_swan import swan_configuration
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.paper.trials.true_orbits import System, resting_times

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


def preimage(w: float, r: float) -> float:
    """The height whose image under the one-dimensional map is w: (2r + 6w) l^2 = r(1 + l), w' = (1-l)(2+l)/6.

    Examples
    --------
    >>> round(preimage(0.5, 0.5), 6)
    0.233462
    """
    lead = 2 * r + 6 * w
    ratio = (r + sqrt(r * r + 4 * r * lead)) / (2 * lead)
    return (1 - ratio) * (2 + ratio) / 6


def generations(w: float, r: float, count: int = GENERATIONS) -> list[float]:
    """A height and its inverse images.

    Examples
    --------
    >>> [round(each, 4) for each in generations(0.375, 0.5, 3)]
    [0.375, 0.216, 0.1777]
    """
    heights_ = [w]
    while len(heights_) < count:
        heights_.append(preimage(heights_[-1], r))
    return heights_


def inner_start(r: float) -> float:
    """The height below the tear whose flight lands behind A on W^s(X): r(1 + l - 2 l^2) = 3 l^2, -1/2 < l < 0."""
    ratio = (r - sqrt(r * r + 4 * r * (3 + 2 * r))) / (2 * (3 + 2 * r))
    return (1 - ratio) * (2 + ratio) / 6


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


def _feet(osc: Oscillator, B: float, tau: Array, v: Array) -> Array:
    """Where orbits come to rest behind B."""
    return resting_times(osc, tau, v, FLIGHTS, SLOW, B)


@cache
def heights(swan: Swan, rate: str) -> Heights:
    """The crossings nearest to the heights of the limit, by the secant method."""
    at, r = _setting(swan, rate), float(Fraction(rate))
    starts = np.array([*generations(0.5, r), *generations(inner_start(r), r)])
    line, start = np.repeat(LINES, starts.size), np.tile(starts, len(LINES))
    reach = line * (at.B - at.A) / 2

    def miss(w: Array) -> Array:
        return _feet(at.osc, at.B, at.A - reach, w * at.slope * reach**2) - at.X

    last, now = start, start + 0.1 * line
    before, off = miss(last), miss(now)
    for _ in range(STEPS):
        change = np.where(off == before, 0.0, off * (now - last) / np.where(off == before, 1.0, off - before))
        last, before, now = now, off, now - change
        off = miss(now)
    rows = now.reshape(len(LINES), -1)
    return Heights(LINES, tuple(tuple(row.tolist()) for row in rows), float(np.abs(off).max()))
