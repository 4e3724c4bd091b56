"""Orbits beside gamma: below it chatter ends by the exponent that is proved, above it each factor mu gives one."""

from dataclasses import dataclass
from functools import cache
from math import ceil, log

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import as_float
from singimpact.paper import System

RATES = ("3/10", "1/2", "4/5")
DISTANCE = 1e-8  # the larger distance from gamma; the other is smaller by this factor, and the rounding of v is 1e-16
APART = 30
IMPACTS = 400  # flown above gamma


Start = System  # gamma ends at its contact point
STARTS = (
    Start("x'' + x = cos 2t, c = 3/10", "x", "cos(2*t)", "0.3", 1, 5.4),
    Start("x'' + x'/5 + x = cos 2.8t + sin(t)/5, c = 0", "x + 0.2*xdot", "cos(2.8*t) + 0.2*sin(t)", "0", 1, 1.4),
    Start("x'' + x'/10 + x + 3x^3/10 = cos 2.8t, c = 0", "x + 0.1*xdot + 0.3*x**3", "cos(2.8*t)", "0", 1, 1.4),
    Start("x'' + x = cos 2t, c = 1", "x", "cos(2*t)", "1", 2, -0.3),
    Start("x'' + x'/2 + x = cos 2t, c = 1", "x + 0.5*xdot", "cos(2*t)", "1", 2, -0.3),
    Start("x'' + x'/10 + x + 3x^3/10 = (13/10) cos 2t, c = 1", "x + 0.1*xdot + 0.3*x**3", "1.3*cos(2*t)", "1", 2, -0.3),
)


@dataclass(frozen=True)
class Beside:
    """Orbits at relative distances delta and delta/mu^steps from gamma.

    Attributes
    ----------
    lambda_, mu : multipliers at the end of gamma. steps : how many factors mu lie between the distances.
    slope : of ln(tau_* - tau_inf) against ln delta, below. impacts : before tau_*, above.
    """

    lambda_: float
    mu: float
    steps: int
    slope: float
    impacts: tuple[int, int]


def end_of_gamma(osc, start):
    """The contact point ahead of a start: a tangency, or the swan at 0."""
    if start.order == 2:
        return 0.0
    period = as_float(osc.period)
    ends = [point.tau for point in si.tangency_points(osc) if str(point.kind) == "gamma"]
    return min(at + period * ceil((start.tau - at) / period) for at in ends)


@cache
def beside(start: Start, rate: str) -> Beside:
    """Two orbits below gamma and two above it."""
    at = si.fixed_points.multipliers(start.order, rate, 20)
    lambda_, mu = float(at.lambda_.value), float(at.mu.value)
    osc = si.ImpactOscillator(start.f, start.g, start.clearance, rate)
    end = end_of_gamma(osc, start)
    edge = float(si.threshold(osc, start.tau).v)
    first = int(log(1 / DISTANCE) / log(mu))
    steps = ceil(log(APART) / log(mu))
    gaps, counts = [], []
    for power in (first, first + steps):
        below, above = edge * (1 - mu**-power), edge * (1 + mu**-power)
        gaps.append(end - float(osc.chatter_limit(start.tau, below).tau))
        counts.append(int(np.sum(osc.orbit(start.tau, above, IMPACTS).tau < end)))
    return Beside(lambda_, mu, steps, log(gaps[0] / gaps[1]) / log(mu) / steps, (counts[0], counts[1]))


def test_the_holder_exponent_at_j_1():
    found = beside(STARTS[0], "1/2")
    assert abs(log(1 / found.lambda_) / log(found.mu) - 0.603031) < 1e-6
    assert abs(found.slope - 0.603031) < 1e-5


@pytest.mark.slow
@pytest.mark.parametrize("rate", ["3/10", "1/2", "4/5"])
@pytest.mark.parametrize("start", STARTS, ids=[start.name for start in STARTS])
def test_orbits_beside_gamma_end_by_the_exponent_and_gain_an_impact_for_each_factor(start, rate):
    orbits = beside(start, rate)
    assert orbits.slope == pytest.approx(log(1 / orbits.lambda_) / log(orbits.mu), abs=1e-5)
    assert orbits.impacts[1] - orbits.impacts[0] == orbits.steps


def test_the_holder_exponent_in_many_digits():
    """In balls, 1e-9 to 3e-11 from gamma, by the public functions."""
    osc = si.linear(2, "0.3", "0.5")
    at = si.fixed_points.multipliers(1, "1/2", 30)
    edge = si.threshold(osc, "5.4", digits=30).v
    gaps = []
    for power in (26, 31):
        with mpmath.workdps(35):
            v = mpmath.mpf(edge) * (1 - mpmath.mpf(at.mu.value) ** -power)
            limit = osc.chatter_limit("5.4", mpmath.nstr(v, 32), digits=25)
            zero = 2 * mpmath.pi - mpmath.acos(mpmath.mpf(3) / 10) / 2
            gaps.append(float(zero - mpmath.mpf(limit.tau)))
    slope = log(gaps[0] / gaps[1]) / (5 * log(float(at.mu.value)))
    assert abs(slope - log(1 / float(at.lambda_.value)) / log(float(at.mu.value))) < 1e-5
