"""Flights at rest on arrays: against an integrator of scipy, and against flights one by one."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from singimpact.flights import NotTogether, in_step, path, rest_flights, runs_on_arrays, together
from singimpact.flights.model_numbers import recurrence_of
from singimpact.oscillator import Oscillator

DUFFING = Oscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t) + 0.2*t", "0.7", 1)
BENT = Oscillator("x*exp(-x**2) + atan(xdot)", "sin(2*t)", "0.7", 1)


@pytest.mark.parametrize("model", [DUFFING, BENT, Oscillator("x", "cos(2*t)", "0.7", 1)])
def test_place_and_velocity_with_their_derivatives(model):
    rng = np.random.default_rng(5)
    clearance, tau, times = rng.uniform(0.5, 0.9, 12), rng.uniform(-3, 3, 12), rng.uniform(-2, 2, 12)
    found = rest_flights(model, clearance, tau, np.arange(12), times)
    for n in range(12):
        moved, step = model.replace(clearance=float(clearance[n])), 1e-5
        single = path(moved, float(tau[n]), 0, float(times[n]))
        assert found[n, 0] == pytest.approx(single.x - clearance[n], rel=1e-11, abs=1e-12)
        assert found[n, 1] == pytest.approx(single.xdot, rel=1e-11, abs=1e-12)
        ahead = path(moved, float(tau[n]), step, float(times[n]))
        assert found[n, 2] == pytest.approx((ahead.x - single.x) / step, rel=1e-3, abs=1e-3)
        assert found[n, 3] == pytest.approx((ahead.xdot - single.xdot) / step, rel=1e-3, abs=1e-3)


def test_against_an_integrator():
    found = rest_flights(DUFFING, np.array([0.7]), np.array([0.4]), np.zeros(3, int), np.array([1.0, 2.5, 4.0]))

    def field(t, y):
        return [y[1], np.cos(1.7 * t) + 0.2 * t - y[0] - 0.1 * y[1] - 0.3 * y[0] ** 3]

    truth = solve_ivp(field, (0.4, 4.4), [0.7, 0.0], "DOP853", [1.4, 2.9, 4.4], rtol=1e-12, atol=1e-13).y
    assert np.abs(found[:, 0] + 0.7 - truth[0]).max() < 1e-10
    assert np.abs(found[:, 1] - truth[1]).max() < 1e-10


def test_a_step_that_is_too_long_is_noticed(monkeypatch):
    monkeypatch.setattr(together, "SETTINGS", replace(together.SETTINGS, cautious=3.0))
    with pytest.raises(NotTogether):
        rest_flights(DUFFING, np.array([0.7]), np.array([0.4]), np.zeros(1, int), np.array([9.0]))


def test_what_is_not_analytic_is_flown_one_by_one():
    for text in ("tanh(x)", "sqrt(x + 2)", "log(x + 2)"):
        assert not runs_on_arrays(recurrence_of(Oscillator(text, 0, 0, 1)))
    assert in_step(Oscillator("tanh(x)", 0, 0, 1), [lambda meeting: meeting] * 2) == [None, None]


def test_an_error_of_one_task_reaches_the_caller():
    def fails(_meeting):
        raise KeyError("one")

    def flies(meeting):
        return meeting.rest_flights(0.7, np.zeros(1), np.zeros(1, int), np.ones(1))

    with pytest.raises(KeyError, match="one"):
        in_step(DUFFING, [flies, fails, flies])
