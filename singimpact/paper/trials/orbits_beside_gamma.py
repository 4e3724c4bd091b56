"""Orbits that start beside gamma, on six oscillators: where chatter below it ends, how many impacts follow above it."""

from dataclasses import dataclass
from functools import cache
from math import ceil, log

import numpy as np

from singimpact.algebra.numbers import constant
from singimpact.contact.zero_ahead import next_zero
from singimpact.dynamics.chatter import chatter_limit
from singimpact.dynamics.threshold import threshold
from singimpact.flights.orbits import orbit_segment
from singimpact.paper.trials.true_orbits import System
from singimpact.theory.fixed_points import multipliers

RATES = ("3/10", "1/2", "4/5")
NEAR = 1e-8  # the larger distance from gamma; the other is smaller by this factor, and the rounding of v is 1e-16
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


@cache
def beside(start: Start, rate: str) -> Beside:
    """Two orbits below gamma and two above it."""
    at = multipliers(start.order, rate, 20)
    lambda_, mu = float(at.lambda_.value), float(at.mu.value)
    osc = start.over(start.clearance, rate)
    end = next_zero(osc, constant("tau", start.tau)).zero
    assert end is not None
    assert end.order == start.order
    edge = float(threshold(osc, start.tau).v)
    first = int(log(1 / NEAR) / log(mu))
    steps = ceil(log(APART) / log(mu))
    gaps, counts = [], []
    for power in (first, first + steps):
        below, above = edge * (1 - mu**-power), edge * (1 + mu**-power)
        gaps.append(end.tau - float(chatter_limit(osc, start.tau, below).tau))
        counts.append(int(np.count_nonzero(orbit_segment(osc, start.tau, above, IMPACTS).tau < end.tau)))
    return Beside(lambda_, mu, steps, log(gaps[0] / gaps[1]) / log(mu) / steps, (counts[0], counts[1]))
