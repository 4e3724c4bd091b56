"""Thresholds by the compiled loop: halving, Newton's method with the series, and a bracket that both sides decide."""

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import constant
from singimpact.contact import next_zero
from singimpact.dynamics import threshold
from singimpact.flights import REACH, SERIES, TERMS_OF_GAMMA, Search, over_floats
from singimpact.flights.compiled_model import compiled_model
from singimpact.status import Status

MODELS = {
    **{f"r = {r}": (si.linear("2.8", 0, r), 0.9) for r in ("0.01", "0.3", "0.5", "0.8", "0.99")},
    "damped": (si.linear(2, "0.3", "0.6", damping="0.3"), 1.2),
    "two waves": (si.ImpactOscillator("x", "cos(2*t) + sin(6*t)/9", "0.4", "0.5"), 1.6),
    "swan": (si.linear("2.8", 1, "0.5"), -0.2),
    "many periods": (si.linear("2.8", 0, "0.5"), 3001.2),
}


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """What all linear models share."""
    model = compiled_model(MODELS["swan"][0])
    for name in (model.main, "search_entry"):
        model.machine.compile_here(name)


def halved_alone(monkeypatch):
    monkeypatch.setattr(threshold, "_series", lambda *_: (0.0, [0.0] * TERMS_OF_GAMMA))


@pytest.mark.parametrize("name", MODELS)
def test_the_series_leads_to_the_velocity_that_halving_finds(name, monkeypatch):
    osc, tau = MODELS[name]
    found = threshold.threshold(osc, tau)
    halved_alone(monkeypatch)
    plain = threshold.threshold(osc, tau)
    assert found.status == plain.status == Status.complete
    assert abs(found.v - plain.v) <= min(found.error, plain.error)
    assert found.error < 2 * plain.error


@pytest.mark.parametrize("name", ["r = 0.01", "r = 0.5", "r = 0.8", "damped", "two waves", "swan"])
def test_the_error_holds_the_true_error(name):
    osc, tau = MODELS[name]
    for place in (tau, tau + 0.013, tau + 0.11):
        found, true = threshold.threshold(osc, place), threshold.threshold(osc, place, digits=20)
        assert 0 < abs(true.v - mpmath.mpf(float(found.v))) <= found.error < 1e-12


def inside(osc, tau):
    """The kernels over lists, the numbers they take, and a bracket that is wide."""
    model, zero = compiled_model(osc), next_zero(osc, constant("tau", tau)).zero
    settings = threshold.SEARCH.short, threshold.SEARCH.narrow, 20_000.0, threshold.SEARCH.coarse
    reach, series = threshold._series(osc, zero)
    search = Search([*settings, reach, float(zero.order), *map(float, series)], model.rho.tolist())
    wide = 0.0, -float(osc.acceleration(tau)) * (zero.tau - tau) / 2, zero.tau - tau
    return over_floats(), search, wide, (model.interpreter.model, model.interpreter.work()[0])


CURVED = {
    "Duffing": (si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.8"), "1.2"),
    "far below": (si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.2"), "0.9"),
    "next to its end": (si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.8"), "2.775"),
    "tanh": (si.ImpactOscillator("x + 0.2*tanh(5*xdot)", "cos(1.7*t)", "0.3", "0.5"), "1.4"),
    "swan": (si.ImpactOscillator("x**3", "cos(2*t)", "1", "0.6"), "-0.5"),
}


@pytest.mark.parametrize("name", CURVED)
@pytest.mark.parametrize("factor", [1.0, 1 + 1e-10, 0.9, 0.0])
def test_nonlinear_velocities_are_those_that_halving_finds(name, factor, monkeypatch):
    """Whatever the series says: the sides are decided by flights."""
    osc, tau = CURVED[name]
    series = threshold._series

    def scaled(*given):
        reach, coefficients = series(*given)
        return reach, [factor * float(each) for each in coefficients]

    monkeypatch.setattr(threshold, "_series", scaled)
    found = threshold.threshold(osc, tau)
    halved_alone(monkeypatch)
    plain = threshold.threshold(osc, tau)
    assert found.status == plain.status == Status.complete
    assert abs(found.v - plain.v) <= found.error + plain.error
    assert found.error < 8 * plain.error


def test_newtons_method_spares_most_of_the_halvings(monkeypatch):
    """Sides that are decided, by flights of orbits, for a nonlinear model."""
    osc, tau = CURVED["Duffing"]
    asked, side = [], threshold._Sides.of
    monkeypatch.setattr(threshold._Sides, "of", lambda sides, v: asked.append(v) or side(sides, v))
    threshold.threshold(osc, tau)
    assert len(asked) < 20
    asked.clear()
    halved_alone(monkeypatch)
    threshold.threshold(osc, tau)
    assert len(asked) > 45


@pytest.mark.parametrize("name", ["r = 0.5", "r = 0.8", "damped", "swan"])
def test_newtons_method_meets_the_series(name):
    osc, tau = MODELS[name]
    kernels, search, (_, _, end), over = inside(osc, tau)
    true = float(threshold.threshold(osc, tau, digits=18).v)
    assert 0.01 < search.settings[REACH] < 1
    assert kernels["on_gamma"](tau, true * (1 + 1e-4), end, search, *over) == pytest.approx(true, rel=3e-15)
    miss, slope = kernels["missed"](tau, true, end, search, *over)
    other, _ = kernels["missed"](tau, true * (1 + 1e-6), end, search, *over)
    assert (other - miss) / (1e-6 * true) == pytest.approx(slope, rel=1e-4)
    assert abs(miss) < 1e-13 * true * slope
    away = kernels["on_gamma"](tau, true / 2, end, search, *over)
    assert np.isnan(away) or away == pytest.approx(true, rel=3e-15)


@pytest.mark.parametrize("factor", [1 + 1e-10, 1 - 1e-10, 1 + 1e-3, 0.0])
def test_a_wrong_series_moves_no_bracket(factor):
    """The sides are decided by flights: the series only says where to look."""
    osc, tau = MODELS["r = 0.5"]
    kernels, search, (low, high, end), over = inside(osc, tau)
    true = float(threshold.threshold(osc, tau, digits=18).v)
    search.settings[SERIES:] = [part * factor for part in search.settings[SERIES:]]
    low, high, code = kernels["bracket_gamma"](tau, low, high, end, search, *over)
    assert code == 0
    assert high - low <= threshold.SEARCH.narrow * high
    assert low - 2e-15 * true < true < high + 2e-15 * true


def test_a_good_series_leaves_few_sides_to_decide(monkeypatch):
    osc, tau = MODELS["r = 0.8"]
    kernels, search, (low, high, end), over = inside(osc, tau)
    asked, side = [], kernels["side_of_gamma"]
    monkeypatch.setitem(kernels, "side_of_gamma", lambda *given: asked.append(given[1]) or side(*given))
    kernels["bracket_gamma"](tau, low, high, end, search, *over)
    assert len(asked) < 24
    asked.clear()
    search.settings[REACH] = 0.0
    kernels["bracket_gamma"](tau, low, high, end, search, *over)
    assert len(asked) > 45


@pytest.mark.parametrize("name", ["r = 0.5", "damped", "two waves"])
def test_the_short_flight_of_a_side_is_the_plain_one(name):
    osc, _ = MODELS[name]
    kernels, _, _, (model, work) = inside(osc, MODELS[name][1])
    random, short = np.random.default_rng(1), 0
    for tau, v in zip(random.uniform(0, 6, 60).tolist(), (10 ** random.uniform(-9, 0, 60)).tolist(), strict=True):
        code, a, time, u = kernels["plain_hit"](tau, 0.0, v, model, work)
        known, there = kernels["linear_hit"](tau, 0.0, v, 0.0, 0.0, model, work)
        assert (code, a) == (known, there)
        if code == 0:
            assert (time, u) == (work.hit[0], work.hit[1])
        short += a < 0 and -16 * v > a * model.table.step
    assert short > 10
