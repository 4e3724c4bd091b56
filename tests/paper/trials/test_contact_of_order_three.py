"""The border orbit between the swans of a contact of order three: its order over flights, and both limits of r."""

from fractions import Fraction
from math import gamma, isclose

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.paper import elastic

SWAN = 2 / 3**1.5


def cubic(r, q="-0.25"):
    return si.ImpactOscillator("0", "t**3 - t + q", 0, r, {"q": q})


def kappa(r, ends=("-0.3848", "-0.1295"), points=5):
    (found,) = si.border_orbits(cubic(r), "q", ends, points=points)
    return float(found.parameter)


def test_it_falls_with_r_from_the_landing_to_the_swan():
    """As b:three-one says; each is the only one among 40 values of q."""
    values = [kappa(r, points=40) for r in ("0.001", "0.1", "0.3", "0.5", "0.7", "0.9", "0.99")]
    assert (np.diff(values) < 0).all()
    assert -SWAN < values[-1] < values[0] < -56 / 57**1.5


def test_without_rebound_it_is_a_series_in_the_root_of_r():
    """The coefficients of b:three-rest: what they leave falls like r^(3/2)."""
    first, second = -225 * 19**0.5 / 13718, -2625 * 57**0.5 / 260642 - 225 * 38**0.5 / 109744
    left = []
    for exponent in (4, 6, 8):
        (found,) = si.border_orbits(cubic(f"1e-{exponent}"), "q", ("-0.15", "-0.129"), points=5, digits=25)
        root = mpmath.mpf(10) ** (-exponent // 2)
        left.append((found.parameter + 56 / mpmath.mpf(57) ** 1.5 - first * root - second * root**2) / root**3)
    assert abs(left[0] - left[1]) < 0.1 * abs(left[1])
    # another coefficient would leave more and more
    wrong = float(left[2]) + 1e-6 * 1e8
    assert abs(float(left[2]) / float(left[1]) - 1) < 0.2 < abs(wrong / float(left[1]) - 1)


def near_one(u):
    """C of kappa + 2/3^(3/2) = C (1 - r)^(6/7), from the adiabatic invariant u of the elastic ball in a swan.

    With t_2 - t_1 = 2h the invariant v/|a_c|^(1/3) begins as h^(7/3) u/12^(2/3), and it falls by half of 1 - r times
    the integral of |a_c|^(2/3) up to the third zero, that of (x (1 - x)^2)^(2/3); and kappa + 2/3^(3/2) is 27/2 h^2 of
    the value at the swan.
    """
    used = gamma(5 / 3) * gamma(7 / 3) / gamma(4)
    return SWAN * 13.5 * (12 ** (2 / 3) * used / (2 * u)) ** (6 / 7)


def test_where_nothing_is_lost_it_is_the_curve_of_swans():
    """Supported by numbers: the average over many impacts has no bound here."""
    low, high = elastic().invariant
    assert Fraction(low) < Fraction(high)
    constant = near_one(float(low))
    assert isclose(constant, 0.284428145, abs_tol=1e-8)
    assert isclose(near_one(float(high)), constant, abs_tol=1e-7)
    ratios = [(kappa(r, ("-0.3849", "-0.37")) + SWAN) / (1 - float(r)) ** (6 / 7) / constant for r in ("0.99", "0.999")]
    assert ratios[0] < ratios[1] < 1
    assert 1 - ratios[1] < 0.25 * (1 - ratios[0])
    assert 1 - ratios[1] < 0.002


@pytest.mark.parametrize("r", [0.2, 0.5, 0.9])
def test_flights_are_ordered_by_the_place_of_the_first_zero(r):
    """In units of t_3 - t_2 landings are later and flights longer the earlier the first zero is."""
    orbits = []
    for first in (1.30, 1.35, 1.40):
        osc = si.ImpactOscillator("0", f"t*(t + 1)*(t + {first})", 0, repr(r))
        flown = osc.orbit(-first, 0, impacts=6)
        orbits.append(np.array(flown.tau[1:7]))
    for earlier, later in zip(orbits[1:], orbits, strict=False):
        count = min(earlier.size, later.size)
        assert count >= 2
        assert (earlier[:count] > later[:count]).all()
        assert (np.diff(earlier[:count]) > np.diff(later[:count])).all()
