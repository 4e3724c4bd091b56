"""Barriers of strong damping: the fastest launch that they keep up, and pieces that cover all of [0, Z]."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from singimpact.algebra import Balls
from singimpact.flights.no_return import barrier
from singimpact.oscillator import Oscillator

# the model; f at z = x - c and x', and the ends of g
MODELS = {
    "cubic": (Oscillator("x + x**3/10 + 1000*xdot", "cos(t)", -1, 1),
              lambda z, u: (z - 1) + (z - 1) ** 3 / 10 + 1000 * u, (-1, 1)),
    "weak": (Oscillator("x + x**3/4 + 6*xdot", "cos(t)/4", -1, 1),
             lambda z, u: (z - 1) + (z - 1) ** 3 / 4 + 6 * u, (-0.25, 0.25)),
    "steep": (Oscillator("3*x + x**3 + 8*xdot + xdot**3", "cos(3*t)/2", "-1/2", 1),
              lambda z, u: 3 * (z - 0.5) + (z - 0.5) ** 3 + 8 * u + u**3, (-0.5, 0.5)),
    "nearly free": (Oscillator("x/50 + x**3/50 + 9*xdot", "1/10 + cos(t)/20", 0, 1),
                    lambda z, u: z / 50 + z**3 / 50 + 9 * u, (0.05, 0.15)),
    "slow": (Oscillator("x/200 + x**3/10**6 + 0.4*xdot", "1/10 + cos(t)/20", 0, 1),
             lambda z, u: z / 200 + z**3 / 10**6 + 0.4 * u, (0.05, 0.15)),
}  # fmt: skip


@pytest.mark.parametrize("name", MODELS)
def test_the_fastest_launch_is_that_of_the_inequalities_at_many_places(name):
    osc, f, (low, high) = MODELS[name]
    slopes, found = [2.0**k for k in barrier.SEARCH.slopes], []
    for height in (2.0**k for k in barrier.SEARCH.heights):
        z = np.linspace(0, height, 20_001)
        if any(np.all(low - f(z, -s * z) - s**2 * z > 0) for s in slopes):
            rest = height - z
            found += [s * height for s in reversed(slopes) if np.all(high - f(z, s * rest) + s**2 * rest < 0)]
        if found:
            break
    assert barrier.fastest_kept(osc) == found[0]


def test_what_fails_on_a_part_of_the_interval_does_not_hold():
    balls = Balls(64)

    def above(low):
        return lambda piece: bool(piece > balls.rational(low))

    assert barrier._on_pieces(above(Fraction(-1, 100)), balls, 4.0, barrier.Operations(MODELS["weak"][0]))
    assert not barrier._on_pieces(above(Fraction(1, 100)), balls, 4.0, barrier.Operations(MODELS["weak"][0]))
    assert not barrier._on_pieces(
        lambda piece: bool(piece < balls.rational(Fraction(399, 100))),
        balls,
        4.0,
        barrier.Operations(MODELS["weak"][0]),
    )
