"""The published errors are errors: each term of them is needed by some state."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics import ENDING
from singimpact.dynamics.chatter import _abreast
from singimpact.dynamics.remaining import law_coefficients, remaining
from singimpact.flights import States

EPSILON = 2.0**-52


@pytest.mark.parametrize("r", ["0.5", *(pytest.param(r, marks=pytest.mark.slow) for r in ("0.9", "0.1"))])
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
    from singimpact.dynamics import Study, chattering
    from singimpact.dynamics.settling import SETTINGS

    model = si.ImpactOscillator("x", "cos(2*t)", "0.3", "1/2")
    slow = SETTINGS.rest / 2
    rests = chattering(Study(model, (), 1.0, 100), np.array([0.1, 1.5]), np.array([slow, slow]))
    assert rests.tolist() == [False, True]


def test_a_chatter_is_summed_up_only_where_the_last_term_is_below_rounding():
    """Starts of all speeds: some have a last term between one rounding and a hundred when they are first looked at."""
    for v in np.geomspace(1e-6, 5e-3, 40):
        model = si.linear("2.8", 0, "0.8")
        flown = next(_abreast(model, States.of(model, 0.9, float(v)), 10_000, [0]))
        found = flown.ended()
        series = found.error - flown.rounding(float(found.tau), found.status)
        assert series <= ENDING.trust * EPSILON * abs(float(found.tau)) / 4 * (1 + 1e-6) + 1e-22


def test_the_rounding_of_nearly_a_bouncing_ball_is_that_of_each_impact():
    """tau_inf = tau + 2 v/(g (1 - r)) from every impact: each brings the roundings of its tau and of its v."""
    ball, r, g = si.ImpactOscillator("0", "-2 + t/1000", 0, "1/2"), 0.5, 2.0  # constant gravity needs no impact
    flown = next(_abreast(ball, States.of(ball, 0.0, 0.01), 10_000, [0]))
    found = flown.ended()
    times, speeds = np.array(flown.times), np.array(flown.speeds)
    expected = ENDING.trust * EPSILON * ((2 * times + 4 * speeds * 2 / (g * (1 - r))).sum() + found.tau)
    assert len(times) == 2
    assert flown.rounding(float(found.tau), found.status) == pytest.approx(expected, rel=1e-4)


def test_what_is_summed_up_is_right_to_its_order():
    """Every derivative of f, g and rho enters: the error falls by 2^5 when v is halved."""
    f = "7*x + 2*xdot + 3*xdot**2 + 5*xdot**3 + 11*x*xdot + 3*x**2"
    model = si.ImpactOscillator(f, "cos(2*t) - 4 + t**3", "1/10", "-v*(1 + v + 3*v**2 + 2*v**3)/2")
    off = []
    for v in (Fraction(1, 100), Fraction(1, 200)):
        truth = model.chatter_limit("1/2", str(v), digits=25).tau - mpmath.mpf("0.5")
        left, error = (float(part[0]) for part in remaining(model, np.array([0.5]), np.array([float(v)])))
        off.append(abs(float(truth) - left))
        assert off[-1] < 3 * error
    assert off[0] / off[1] == pytest.approx(32, rel=0.2)


def test_a_small_last_term_is_not_taken_for_the_error():
    """Its coefficient vanishes here: the error is what the terms v and v^3 let expect of it, |t_3| |t_3/t_1|^(1/2)."""
    model = si.ImpactOscillator("xdot**2", "-2", 0, "1/2")
    left, error = (float(part[0]) for part in remaining(model, np.array([0.0]), np.array([0.05])))
    third = left - 0.1
    assert third != 0
    assert error == pytest.approx(abs(third) * (abs(third) / 0.1) ** 0.5, rel=1e-9)


@pytest.mark.parametrize("law", ["-0.8*v*exp(v)", "-v/(2 + v)", "-0.8*v*sqrt(1 + v)"])
def test_coefficients_of_a_law_by_derivatives_are_those_of_its_expansion(law, monkeypatch):
    osc = si.ImpactOscillator("x", "cos(t)", 0, law)
    expanded = law_coefficients(osc)
    monkeypatch.setattr(type(osc), "rho_at_rest", lambda _: None)
    assert law_coefficients(osc) == pytest.approx(expanded)
    assert expanded["rho_2"] * expanded["rho_3"] != 0
