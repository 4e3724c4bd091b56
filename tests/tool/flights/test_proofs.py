"""Bounds that make a flight's answer a proof, at states where a weaker bound would say what is false."""

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.flights import first_root, never_returns
from singimpact.oscillator import Oscillator, linear_form
from singimpact.status import Status


@pytest.mark.parametrize("degree", [12, 20, 28])
@pytest.mark.parametrize("rise", [0.0, 1.0, 10.0])
@pytest.mark.parametrize("depth", [1e-6, 1e-4, 1e-2])
def test_no_root_is_jumped_where_a_high_power_bends_the_end_of_a_step(degree, rise, depth):
    """1 + b s - (1 + b)(1 + depth) s^n is negative at 1: the bound of q''' must hold up to the end of the step."""
    q = [1.0, rise] + [0.0] * (degree - 1)
    q[degree] = -(1 + rise) * (1 + depth)
    code, place, *_ = first_root(q, degree, 1.0, 0.0, 1e-16)
    assert code == 1
    with mpmath.workdps(30):
        left = mpmath.polyval([mpmath.mpf(c) for c in reversed(q)], mpmath.mpf(place))
        assert abs(left) < 1e-13 * degree * (1 + rise)


STIFF = Oscillator("100*x", "cos(t)/1000", "-1", 1)


def test_a_stiff_mass_that_comes_back_is_not_proved_to_stay_away():
    """x'' + 100 x = 0 from its place of rest, 1 above the wall: at 50 a second it swings 5, at 8 a second 0.8."""
    one, zero = np.array([1.0]), np.array([0.0])
    for speed, stays in ((50.0, False), (12.0, False), (8.0, True)):
        proved = never_returns(STIFF, linear_form(STIFF), zero, zero, one, speed * one)
        assert bool(proved[0]) is stays


def test_a_soft_mass_that_comes_back_is_not_proved_to_stay_away():
    soft = Oscillator("x/100", "cos(t)/1000", "-1", 1)
    one, zero = np.array([1.0]), np.array([0.0])
    assert not never_returns(soft, linear_form(soft), zero, zero, one, 0.5 * one)[0]  # it swings 5


def test_what_is_left_over_must_be_more_than_rounding_of_what_it_is_left_over_from():
    """A place of rest 1e12 above the wall and a swing of 1e12 - 1: nothing that doubles could tell from coming back."""
    far = Oscillator("x", "cos(2*t)/1000", "-1e12", 1)
    one, zero = np.array([1.0]), np.array([0.0])
    assert not never_returns(far, linear_form(far), zero, zero, one, zero)[0]


@pytest.mark.parametrize("digits", [30, 60, 120])
def test_the_velocity_before_an_impact_has_the_digits_asked_for(digits):
    before = si.ImpactOscillator("x", "cos(2*t)", "0.3", "-0.8*v + v**2/10").inverse_map("1", "1/2", digits=digits)
    with mpmath.workdps(digits + 10):
        after = -mpmath.mpf("0.8") * before.velocity + before.velocity**2 / 10
        assert abs(after - mpmath.mpf("0.5")) < mpmath.mpf(10) ** (1 - digits)


def test_a_velocity_that_no_impact_leaves_with_is_no_rebound():
    model = si.ImpactOscillator("x", "cos(2*t)", "0.3", "-0.8*v - v**2/5")
    found = model.inverse_map([1.0, 1.0], [2.0, 0.5])  # no rebound is faster than 0.8
    assert found.status[0] == Status.no_rebound
    assert np.isnan(found.v[0])
    assert found.status[1] == Status.hit
