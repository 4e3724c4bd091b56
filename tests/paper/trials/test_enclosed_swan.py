"""The end of gamma in the unfolded positive swan: brackets in balls, against chatter flown by another routine."""

from fractions import Fraction

import numpy as np
import pytest
from flint import arb

from singimpact.algebra import balls_at
from singimpact.impact_oscillator import universal
from singimpact.paper import BITS, LAST, Side, bracket
from singimpact.paper.trials import enclosed_swan
from singimpact.status import Status

RATES = ["1/10", "1/2", "7/10"]


def completes(rate, sigma):
    """Whether chatter from rest is complete before B; a flight that lifts off or does not return is none."""
    found = universal(1, rate).chatter_limit(sigma, 0)
    return found.status == Status.complete and float(found.tau) < 1


@pytest.mark.slow
@pytest.mark.parametrize("rate", RATES)
def test_orbits_on_both_sides_are_flown_as_proved(rate):
    found = bracket(rate)
    assert found.high - found.low < Fraction(1, 100)
    for h in (found.low / 9, found.low / 2, found.low * 99 / 100, found.low):
        assert completes(rate, -1 - h)
    for h in (found.high, found.high * 101 / 100, (found.high + LAST) / 2, LAST):
        assert not completes(rate, -1 - h)


@pytest.mark.slow
def test_a_restitution_near_one_has_a_bracket():
    found = bracket("9/10")
    assert float(found.low) < 0.1426034 < float(found.high) < float(found.low) + 0.03


@pytest.mark.parametrize("rate", RATES)
def test_balls_hold_the_orbits_that_are_flown(rate):
    """States after 1, 2, 3 impacts from rest at several h of an interval, and their derivative by differences."""
    low, high = Fraction(2, 100), Fraction(21, 1000)
    osc, r = universal(1, rate), float(Fraction(rate))
    with balls_at(BITS):
        h = arb(0.02).union(arb(0.021))
        box = enclosed_swan._Orbit.at_rest(enclosed_swan._ball(Fraction(rate)), h)
        starts = np.linspace(float(low), float(high), 5)
        tau, v = -1 - starts, np.zeros(5)
        for _ in range(3):
            step = osc.first_hit(tau, v)
            tau, v = tau + np.asarray(step.flight_time), -r * np.asarray(step.velocity)
            y, w = (tau + 1) / starts, v / starts**2
            for ball, values in ((box.y, y), (box.w, w)):
                assert all(abs(arb(x) - ball.mid()) <= ball.rad() + 1e-6 for x in values)
                assert ball.rad() < 0.3
            for ball, values in ((box.dy, y), (box.dw, w)):
                slopes = np.diff(values) / np.diff(starts)
                assert all(abs(arb(x) - ball.mid()) <= ball.rad() + 1e-3 * (1 + abs(x)) for x in slopes)
            box = box.after()


def test_intervals_across_the_end_are_not_decided():
    with balls_at(BITS):
        r = enclosed_swan._ball(Fraction(1, 2))
        assert enclosed_swan._side(r, Fraction(38, 100), Fraction(39, 100)) is None
        assert enclosed_swan._side(r, Fraction(1, 10), Fraction(101, 1000)) == Side.complete
        assert enclosed_swan._side(r, Fraction(1, 2), Fraction(501, 1000)) == Side.left


def test_the_bounds_are_needed(monkeypatch):
    """With windows that are too short no chatter is seen to complete, with too few impacts no orbit."""
    monkeypatch.setattr(enclosed_swan, "EFFORT", enclosed_swan.Effort(narrow=Fraction(1, 50), wide=(0.5,)))
    assert bracket.__wrapped__("1/2") is None
    monkeypatch.setattr(enclosed_swan, "EFFORT", enclosed_swan.Effort(narrow=Fraction(1, 50), impacts=0))
    assert bracket.__wrapped__("1/2") is None
