"""Steep layers, kinks, domains, budgets: what a flight says is so, or it says that it does not know."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest
from witness import integrate

import singimpact as si
from singimpact.flights import allowed, recurrence_of
from singimpact.status import Cause, Status

LAYERS = [  # f, g, tau, v, flight time by a Runge-Kutta method with steps of 0.002
    ("x+tanh(50*xdot)/10", "cos(t)", "0.3", 1, 2.927786),
    ("x+3*tanh(xdot/0.2)/10", "cos(2*t)", "0.4", 10, 3.093533),
    ("x+5*(1+tanh(100*(x-1/2)))", "cos(t)", "0.3", 2, 0.907115),
    ("x", "-1/5+10*exp(1000*(cos(t)-1))", 4.5, 1, 3.546468),
    ("x+5*exp(-400*(x-1/2)**2)", "cos(t)", "0.3", 2, 2.975379),
    ("x+5*exp(-6400*(x-1/2)**2)", "cos(t)", "0.3", 2, 3.000055),
]
KINKS = [
    ("sqrt(x**2)", "-1/2", -1, 0, 3, 0.358025), ("5*sqrt(x**2)", "-1/2", -1, 0, 3, None),
    ("x", "(cos(t)**2)**(1/2)-1", "1/5", "0.3", 3, np.pi / 2 - 0.3),
    ("x+sqrt(xdot**2)*xdot/10", "cos(2*t)", "1/5", "1.2", 3, 1.239082),
    ("x", "sqrt(sin(t)**2)-1", "1/5", "0.3", 3, np.pi - 0.3), ("x", "sqrt(1+cos(t))-1", "1/5", "0.3", 3, np.pi - 0.3),
]  # fmt: skip


# The usual step rule of Taylor integrators, in place of the package's: a step is chosen by its last two terms. Nothing
# looks at the step afterwards, so it passes over a layer whose terms are below rounding where it begins.

RULE = """
def step_size_of_discs(X, W, z, n, longest, ulp, p, pace):
    h = longest
    for _ in range(2):
        size = abs(z) + h * (abs(X[1]) + h * (abs(X[2]) + h * abs(X[3])))
        k = 4
        while size == 0 and k < n - 1:
            size = abs(X[k]) * h**k
            k += 1
        for k in range(n - 1, n + 1):
            if X[k] != 0:
                fit = (ulp * size / (8 * abs(X[k]))) ** (1 / (k + 0 * h))
                if not fit >= h:
                    h = fit
    return h, 17 / 16, pace
"""
"""The step on which the last two terms are below ulp/8 times the first ones, at most `longest`."""


@pytest.fixture
def last_terms(monkeypatch):
    """Flights in Taylor steps take this rule."""

    def ruled(osc):
        flow = recurrence_of(osc)
        return replace(flow, source=f"{flow.source}\n{RULE}")

    for room in ("compiled_model", "multiprecision"):
        monkeypatch.setattr(f"singimpact.flights.{room}.recurrence_of", ruled)
    forget()
    yield
    monkeypatch.undo()
    forget()


def forget():
    allowed.cache_clear()
    sys.modules[allowed.__module__].compiled_model.cache_clear()


@pytest.mark.parametrize(("f", "g", "tau", "v", "time"), LAYERS)
def test_layers_are_not_jumped_over(f, g, tau, v, time) -> None:
    osc = si.ImpactOscillator(f, g, 0, "1/2")
    hit = osc.first_hit(tau, v)
    assert hit.status == Status.hit
    assert hit.flight_time == pytest.approx(time, abs=1e-6)
    exact = osc.first_hit(tau, v, digits=20)
    assert abs(float(exact.flight_time) / hit.flight_time - 1) <= hit.time_error
    assert abs(float(exact.velocity) / hit.velocity - 1) <= hit.velocity_error
    # the way there, by an integrator that evaluates f and g alone
    times = np.linspace(0.1, 1, 5) * hit.flight_time
    x, xdot = integrate(osc, float(tau), float(v), times)
    path = osc.flight(tau, v, times)
    assert path.x == pytest.approx(x, abs=2e-4)
    assert path.xdot == pytest.approx(xdot, abs=2e-2)


@pytest.mark.usefixtures("last_terms")
def test_the_usual_step_rule_jumps_over_them() -> None:
    """The check can fail: with steps chosen by their last terms the same flights are wrong."""
    hits = [si.ImpactOscillator(f, g, 0, "1/2").first_hit(tau, v).flight_time for f, g, tau, v, _ in LAYERS]
    assert sum(abs(hit - layer[-1]) > 1e-5 for hit, layer in zip(hits, LAYERS, strict=True)) >= 4


def test_the_derivative_is_that_of_the_flight() -> None:
    osc = si.ImpactOscillator("x+tanh(xdot/0.05)/10", "cos(t)", 0, "1/2")
    step, small = osc.derivative("0.3", 1), 1e-6
    ends = [osc.impact_map(0.3, 1 + sign * small) for sign in (1, -1)]
    assert step.matrix[0, 1] == pytest.approx((ends[0].tau - ends[1].tau) / (2 * small), rel=1e-7)
    before = osc.inverse_map(*(lambda s: (s.tau, s.v))(osc.impact_map(0.4, 1)))
    assert (before.tau, before.v) == (pytest.approx(0.4, abs=1e-11), pytest.approx(1, abs=1e-11))


@pytest.mark.parametrize(("f", "g", "c", "tau", "v", "time"), KINKS)
def test_a_kink_is_named_with_its_phase(f, g, c, tau, v, time) -> None:
    osc = si.ImpactOscillator(f, g, c, "1/2")
    for digits in (None, 20):
        hit = osc.first_hit(tau, v, digits=digits)
        assert (int(hit.status), int(hit.cause)) == (Status.unresolved, Cause.kink)
        assert "sqrt" in hit.sentence or "(cos(t)**2)" in hit.sentence
        if time is not None:
            assert f"({time:.6g} after the launch" in hit.sentence
        assert "kink at t = " in hit.sentence


@pytest.mark.parametrize(
    ("f", "g", "c", "part"),
    [("log(2-x)", "cos(t)", 0, "log(-x + 2)"), ("sqrt(1-x)", "cos(t)", 0, "sqrt(-x + 1)"),
     ("x", "log(3-t)", 0, "log(-t + 3)"), ("x", "1/(3-t)", 0, "(-t + 3)**(-1)"), ("x", "tan(t)", 0, "tan(t)")],
)  # fmt: skip
def test_the_end_of_a_domain_is_named(f, g, c, part) -> None:
    hit = si.ImpactOscillator(f, g, c, "1/2").first_hit("0.3", 3)
    assert (int(hit.status), int(hit.cause)) == (Status.unresolved, Cause.domain_left)
    assert hit.sentence.startswith(f"{part} is singular at t = ")
    assert "osc.flight(" in hit.sentence


def test_finite_time_blow_up_is_no_number() -> None:
    hit = si.ImpactOscillator("-xdot**2+x", "cos(t)", 0, "1/2").first_hit("0.3", 3)
    assert (int(hit.status), int(hit.cause)) == (Status.unresolved, Cause.domain_left)
    assert "grows beyond every bound" in hit.sentence


def test_a_budget_says_how_far_the_flight_came() -> None:
    osc = si.ImpactOscillator("x-1000*(1-x**2)*xdot", "cos(t)", 0, "1/2")
    few = osc.first_hit("0.3", 1, steps=500)
    assert (int(few.status), int(few.cause)) == (Status.unresolved, Cause.step_budget)
    assert "the flight came to t = " in few.sentence
    assert "type steps=" in few.sentence
    with pytest.raises(ValueError, match="steps = 0"):
        osc.first_hit("0.3", 1, steps=0)
    many = si.ImpactOscillator("x+x**3", "cos(t)", 0, "1/2").first_hit([0, 1], 1, steps=2)
    assert list(many.cause) == [Cause.step_budget] * 2
    assert many.sentence.shape == (2,)


@pytest.mark.slow
def test_a_long_flight_keeps_its_errors() -> None:
    """More steps than the 400 that are traced at first."""
    osc = si.ImpactOscillator("x+x**3/90", "cos(t)/9+sin(300*t)/5+3/2", -1, "1/2")
    assert osc.first_hit("0.3", 1, steps=400).cause == Cause.step_budget
    hit, more = osc.first_hit("0.3", 1), osc.first_hit("0.3", 1, digits=18)
    assert hit.status == Status.hit
    assert 1 <= hit.condition < 100
    assert abs(float(more.flight_time) / hit.flight_time - 1) <= hit.time_error < 1e-11


@pytest.mark.slow
def test_a_mass_that_cannot_come_back_is_not_flown() -> None:
    barred = si.ImpactOscillator("x+x**3/10+1000*xdot", "cos(t)", -1, "1/2")
    assert list(barred.first_hit(0, [0.5, 1]).status) == [Status.escaped] * 2
    pendulum = si.ImpactOscillator("sin(x)", "cos(t)", 0, "1/2")
    assert pendulum.first_hit("0.3", 100).status == Status.no_return
    # neither proof holds where the mass does come back
    assert pendulum.first_hit("0.3", 1).status == Status.hit
    assert si.ImpactOscillator("x+x**3/10+1000*xdot", "2*cos(t)", -1, "1/2").first_hit(3, 0.001).status == Status.hit


@pytest.mark.slow
def test_both_bounds_against_flights() -> None:
    """Whatever is said to stay up stays up, by flights: near the edge of both proofs."""
    from singimpact.flights import kept_up, stays_up

    rng = np.random.default_rng(3)
    for _ in range(20):
        k, a, w = rng.uniform(0.5, 2), rng.uniform(0.2, 2), rng.uniform(0.5, 3)
        osc = si.ImpactOscillator("k*sin(x)", "a*cos(w*t)", 0, 1, {"k": k, "a": a, "w": w})
        v = np.geomspace(1, 60, 12)
        horizon = 20.0
        said = stays_up(osc, v, horizon)
        height = np.array([osc.flight(0.7, speed, np.linspace(0.01, horizon, 400)).x.min() for speed in v])
        assert np.all(height[said] > 0)
        damped = si.ImpactOscillator("x + d*xdot + x**3/5", "a*cos(w*t)", -1 - a, 1, {"d": 4 + 8 * k, "a": a, "w": w})
        kept = kept_up(damped, np.array([0.1, 1.0]))
        for speed in np.array([0.1, 1.0])[kept]:
            low = damped.flight(0.7, speed, np.linspace(0.01, 60, 600)).x.min()
            assert low > -1 - a


def test_release_from_rest_sees_a_pulse() -> None:
    from scipy.optimize import brentq

    from singimpact.dynamics import release

    osc = si.ImpactOscillator("x", "-1/5+10*exp(1000*(cos(t)-1))", 0, "1/2")
    true = brentq(lambda t: -0.2 + 10 * np.exp(1000 * (np.cos(t) - 1)), 6, 6.28)
    assert release(osc, 1.0) == pytest.approx(true, abs=1e-13)
