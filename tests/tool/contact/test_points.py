"""Tangency and swan points: none missed, kinds, degenerate points, any digits."""

from fractions import Fraction
from math import acos, pi

import mpmath
import numpy as np
import pytest

from singimpact.algebra import EXACT
from singimpact.contact import Contact, swan_points_over_clearance, tangency_points
from singimpact.inputs import InputError
from singimpact.oscillator import Oscillator


def test_linear_oscillator():
    points = tangency_points(Oscillator("x", "cos(2*t)", "0.3", "1/2"))
    assert points.kind == ("foliation", "gamma")
    assert points.tau == pytest.approx([acos(0.3) / 2, pi - acos(0.3) / 2], rel=1e-15)
    with mpmath.workdps(50):
        assert abs(points[1].value(45) - (mpmath.pi - mpmath.acos(mpmath.mpf(3) / 10) / 2)) < 1e-44


@pytest.mark.parametrize("seed", range(6))
def test_none_is_missed_on_random_forcings(seed):
    """Sign changes on a fine grid find no zero that the balls did not."""
    rng = np.random.default_rng(seed)
    terms = [
        f"{a:.6f}*cos({n}*t + {p:.6f})"
        for n, a, p in zip(range(1, 6), rng.normal(size=5), rng.uniform(0, 6, 5), strict=True)
    ]
    osc = Oscillator("x", " + ".join(terms).replace("+ -", "- "), f"{rng.normal() / 2:.6f}", 1)
    points = tangency_points(osc)
    times = np.linspace(0, 2 * pi, 20001)[:-1]
    from singimpact.algebra import DOUBLES, evaluate
    from singimpact.contact import acceleration

    values = np.broadcast_to(evaluate(acceleration(osc), {"t": times}, DOUBLES), times.shape)
    assert len(points) == np.count_nonzero(np.sign(values) != np.sign(np.roll(values, 1)))
    assert np.abs(evaluate(acceleration(osc), {"t": points.tau}, DOUBLES)).max(initial=0) < 1e-13


def test_double_zero_is_degenerate_and_a_near_one_is_not():
    assert tangency_points(Oscillator("x", "cos(2*t)", 1, 1)).kind == ("degenerate",)
    assert tangency_points(Oscillator("x", "cos(2*t)", "1.000000000000001", 1)) == ()
    assert tangency_points(Oscillator("x", "cos(2*t)", "0.999999999999999", 1)).kind == ("foliation", "gamma")


def test_polynomial_forcing_has_all_real_zeros():
    points = tangency_points(Oscillator("0", "-12*(t**2 - 1)", 0, "1/2"))
    assert points.kind == ("gamma", "foliation")
    assert points.tau.tolist() == [-1, 1]


def test_no_tangency():
    assert tangency_points(Oscillator("x", "cos(2*t)", 2, 1)) == ()
    assert tangency_points(Oscillator("0", "-9.81", 0, 1)) == ()


def test_swan_points_of_both_models():
    swans = swan_points_over_clearance(
        Oscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", 0, 1), (Fraction(-2), Fraction(2))
    )
    assert [swan.kind for swan in swans] == ["negative", "positive"]
    c = swans[0].clearance
    assert c + 0.3 * c**3 == pytest.approx(1, rel=1e-15)
    assert swans[0].tau == pytest.approx(0, abs=1e-16)


def test_contact_of_a_model_that_vanishes_further_is_refused():
    with pytest.raises(InputError, match="contact order"):
        Contact.of(Oscillator("x", "t**5", 0, 1), Fraction(0), 1, 3, EXACT)


def test_contact_of_a_model_that_is_not_smooth_is_refused():
    with pytest.raises(InputError, match="smooth"):
        Contact.of(Oscillator("x + sqrt(x)", "cos(t)", 0, 1), Fraction(0), 0, 3, EXACT)
    with pytest.raises(InputError, match="abs"):
        Contact.of(Oscillator("x + abs(xdot)", "cos(t)", 0, 1), Fraction(0), 0, 3, EXACT)
