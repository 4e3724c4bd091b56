"""Steep states with 20 and with 40 digits: enclosed, and told apart where they differ."""

from dataclasses import replace

import mpmath
import numpy as np
import pytest

from singimpact.algebra import Certified
from singimpact.bench import STEEP, family_of, steep_digits


def test_each_steep_family_is_drawn():
    assert {family_of(number) for number in steep_digits.cases_of(20)} == set(STEEP)


@pytest.mark.slow
def test_a_few_states_are_enclosed_by_both():
    found = steep_digits.check(6, 1)
    assert (found.states, found.enclosed, found.refused, found.apart) == (6, 6, (), 0)
    assert 0 < found.seconds[0] <= found.seconds[1]
    assert steep_digits.check(0, 1).states == 0
    smooth = steep_digits.check(4, 1, steep=False)
    assert (smooth.states, smooth.refused, smooth.apart) == (4, (), 0)
    assert not any(family_of(number).steep for number in steep_digits.cases_of(4, steep=False))


@pytest.mark.parametrize("name", ["flight_time", "v"])
def test_a_number_outside_its_radius_is_seen(name, monkeypatch):
    """The second enclosure moved by a thousandth of itself."""
    from singimpact.impact_oscillator import ImpactOscillator

    honest = ImpactOscillator.first_hit

    def moved(osc, *at, digits, horizon):
        hit = honest(osc, *at, digits=digits, horizon=horizon)
        part = getattr(hit.certified, name)
        if digits == steep_digits.MORE:
            wrong = Certified(part.value * mpmath.mpf("1.001"), part.radius, part.digits)
            hit.__dict__["certified"] = replace(hit.certified, **{name: wrong})
        return hit

    assert not steep_digits.flown(1, 1)[2]
    monkeypatch.setattr(ImpactOscillator, "first_hit", moved)
    assert steep_digits.flown(1, 1)[2]


def test_refused_states_and_misses_are_counted():
    columns = {"status": [0, 0, 3, 5], "enclosed": [2, 1, 0, 0], "apart": [0, 0, 0, 1], "time": [2, 1, np.inf, np.nan],
               "seconds": [0.2, 1, 1, 1], "more_seconds": [0.4, 1, 1, 1]}  # fmt: skip
    arrays = {name: np.array(part, dtype=float) for name, part in columns.items()}
    found = steep_digits.summary(arrays, [3, 5, 8, 13])
    assert (found.states, found.enclosed, found.misses, found.refused, found.apart) == (4, 1, 1, (5, 13), 1)
    assert (found.seconds[1], found.more_seconds[1]) == (0.1, 0.2)
