"""The published errors are errors: each term of them is needed by some state."""

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics.attractors import CHATTER, OTHER
from singimpact.dynamics.chatter import ENDING, _Flown
from singimpact.flights.states import States

EPSILON = 2.0**-52


@pytest.mark.parametrize("r", ["0.5", "0.9", "0.1"])
def test_the_error_of_a_chatter_limit_holds_the_rounding_of_the_speed(r):
    """From tau = 0 the time is exact and nearly all of the error is that of v, carried to the end: 2 v/(|a|(1 - r))."""
    model = si.ImpactOscillator("0", "-2 + t/1000", 0, r)
    found = si.ImpactOscillator.chatter_limit(model, 0, 1e-6)
    slope = (float(model.chatter_limit(0, 1.01e-6).tau) - float(model.chatter_limit(0, 0.99e-6).tau)) / 2e-8
    assert slope == pytest.approx(1 / (1 - float(r)), rel=1e-3)
    assert found.error >= ENDING.trust * EPSILON * 4 * 1e-6 * slope * 0.999


@pytest.mark.parametrize("turns", [1000, 100_000])
def test_the_error_of_a_threshold_holds_the_rounding_of_the_phase(turns):
    """A phase of a hundred thousand periods is a double with an error that moves v by more than the bisection does."""
    tau = f"pi/2.8 + {turns}*2*pi/2.8"
    rough = si.threshold(si.linear("2.8", 0, "0.5"), tau)
    exact = si.threshold(si.linear("2.8", 0, "0.5"), "pi/2.8", digits=20)
    with mpmath.workdps(25):
        off = abs(mpmath.mpf(float(rough.v)) - exact.v)
        assert off <= rough.error
        assert off > 1e-14  # the bracket alone is narrower
    assert rough.error < 1e-9


def test_slow_states_that_are_not_pressed_do_not_chatter():
    """At rest speed with a_c > 0 a mass lifts off: it is not in complete chatter."""
    from singimpact.dynamics.basins import SETTINGS, _chattering

    model = si.ImpactOscillator("x", "cos(2*t)", "0.3", "1/2")
    slow = SETTINGS.rest / 2
    codes = _chattering(model, np.array([0.1, 1.5]), np.array([slow, slow]), 1.0)
    assert codes.tolist() == [OTHER, CHATTER]


def test_a_chatter_is_summed_up_only_where_the_last_term_is_below_rounding():
    """Starts of all speeds: some have a last term between one rounding and a hundred when they are first looked at."""
    for v in np.geomspace(1e-6, 5e-3, 40):
        model = si.linear("2.8", 0, "0.8")
        flown = _Flown(model, States.of(model, 0.9, float(v)), 10_000)
        found = flown.limit()
        series = found.error - flown.rounding(float(found.tau), found.status)
        assert series <= ENDING.trust * EPSILON * abs(float(found.tau)) / 4 * (1 + 1e-6) + 1e-22
