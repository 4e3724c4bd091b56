"""Thresholds at every contact order: where gamma ends, where none lies ahead, where nothing is decided."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import constant
from singimpact.contact import next_zero, swan_points_over_clearance
from singimpact.dynamics import end_of_gamma
from singimpact.status import Status


def swan(k, r="0.5"):
    """The linear model at c = 1 - 10^-k."""
    return si.linear("2.8", 1 - Fraction(1, 10**k), r)


@pytest.mark.parametrize("r", ["0.5", "0.8"])
def test_the_threshold_of_a_swan_is_the_limit_of_those_beside_it(r):
    """c = 1 - 10^-k for k = 1 to 14 moves to it, each step ten times closer."""
    at = si.threshold(si.linear("2.8", 1, r), "-0.2")
    beside = [si.threshold(swan(k, r), "-0.2") for k in range(1, 15)]
    assert {Status(found.status) for found in (at, *beside)} == {Status.complete}
    gaps = np.array([float(at.v - found.v) for found in beside]) / float(at.v)
    assert (np.diff(gaps) < 0).all()
    assert 0 < gaps[-1] < 1e-12
    assert np.allclose(gaps[4:12] / gaps[5:13], 10, rtol=0.06)  # each nearer by ten, but for a logarithm
    nearest = [si.threshold(swan(k, r), "-0.2") for k in (15, 16, 300)]
    assert all(abs(found.v - at.v) <= 5e-14 * at.v for found in nearest)


def test_the_threshold_of_a_swan_is_enclosed():
    model = si.linear("2.8", 1, "0.5")
    rough, found = si.threshold(model, "-0.2"), si.threshold(model, "-0.2", digits=18)
    assert abs(rough.v - float(found.certified.value)) <= rough.error + 1e-18
    with mpmath.workdps(25):
        assert abs(found.v - mpmath.mpf("0.0033159648641875641")) < mpmath.mpf("1e-19")


# gamma of x'' = g(t) with one power of t is one power of sigma: what the series gives is exact
@pytest.mark.parametrize(("j", "g"), [(1, "t"), *(
    pytest.param(*case, marks=pytest.mark.slow) for case in ((2, "-t**2"), (3, "t**3"), (4, "-t**4"), (5, "t**5"))
)])  # fmt: skip
@pytest.mark.parametrize("tau", ["-1", pytest.param("-0.01", marks=pytest.mark.slow)])
def test_homogeneous_models_have_the_threshold_of_their_series(j, g, tau):
    model = si.ImpactOscillator("0", g, 0, "1/2")
    found = si.threshold(model, tau)
    truth = float(abs(si.theory.gamma(order=j + 1, at=j, model=model, tau=0)[j + 1])) * abs(float(tau)) ** (j + 1)
    if found.status == Status.unresolved:  # flights at 1e-15 that doubles do not decide
        assert truth < 1e-10
        return
    assert abs(found.v - truth) <= found.error < 1e-3 * truth
    assert found.error < 1e-12 or j > 3 or tau != "-1"


@pytest.mark.slow
@pytest.mark.parametrize(("j", "g"), [(2, "-t**2"), (3, "t**3")])
def test_digits_at_higher_contact_orders(j, g):
    model = si.ImpactOscillator("0", g, 0, "1/2")
    found = si.threshold(model, -1, digits=20)
    with mpmath.workdps(30):
        truth = abs(si.theory.gamma(order=j + 1, at=j, model=model, tau=0, digits=30)[j + 1])
        assert abs(found.v - truth) <= found.error < mpmath.mpf("1e-19")


@pytest.mark.slow
def test_a_nonlinear_swan_has_a_threshold():
    duffing = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", 0, "0.6")
    (model,) = [p.oscillator("0.5") for p in swan_points_over_clearance(duffing, (Fraction(-2), Fraction(2)))
                if p.kind == "negative"]  # fmt: skip
    few, many = si.threshold(model, "-0.2"), si.threshold(model, "-0.2", digits=20)
    assert few.status == many.status == Status.complete
    assert abs(float(many.v) - few.v) <= few.error < 1e-14


@pytest.mark.parametrize(
    "model", [si.linear("2.8", 1 + Fraction(1, 10**15), "0.5"), si.ImpactOscillator("0", "-9.81", 0, "0.5"),
              si.ImpactOscillator("0", "-1 - t**2", 0, "0.5")],
)  # fmt: skip
def test_where_no_gamma_lies_ahead_the_status_is_none(model):
    found = si.threshold(model, "-0.2")
    assert found.status == Status.none
    assert np.isnan(found.v)
    assert "no gamma lies ahead" in Status(found.status).sentence


@pytest.mark.parametrize("c", [1 - Fraction(1, 10**3000), 1 + Fraction(1, 10**3000), "sin(1)**2 + cos(1)**2"])
def test_a_zero_whose_order_is_not_decided_is_unresolved(c):
    """2048 bits do not tell these from the swan at c = 1, and no exact rule does."""
    assert si.threshold(si.linear("2.8", c, "0.5"), "-0.2").status == Status.unresolved


@pytest.mark.slow
def test_a_forcing_of_no_known_period_ends_undecided():
    assert si.threshold(si.ImpactOscillator("0", "-exp(-t)", 0, "0.5"), 1).status == Status.unresolved
    assert si.threshold(si.ImpactOscillator("x", "exp(t) - 2", 0, "0.5"), 0).status == Status.complete


ORDERS = {
    "tangency": (si.linear(2, "0.3", "0.5"), "1", 1, 1),
    "next period": (si.linear(2, "0.3", "0.5"), "4.4", 1, 1),
    "swan": (si.linear("2.8", 1, "0.5"), "1e12", 2, -1),
    "narrow": (swan(300), "-0.2", 1, 1),
    "third": (si.ImpactOscillator("x", "cos(t)**3", 0, "0.5"), "2", 3, 1),
    "fourth": (si.ImpactOscillator("x", "-cos(t)**4", 0, "0.5"), "2", 4, -1),
}


@pytest.mark.parametrize("name", ORDERS)
def test_the_next_zero_and_its_order(name):
    model, tau, order, sign = ORDERS[name]
    found = next_zero(model, constant("tau", tau))
    assert (found.zero.order, found.zero.sign) == (order, sign)
    assert found.zero.tau > float(tau)
    period = float(2 * np.pi) if model.period is None else float(constant_value(model.period))
    assert found.zero.tau < float(tau) + period * (1 + 1e-12)


def constant_value(tree):
    from singimpact.algebra import as_float

    return as_float(tree)


@pytest.mark.parametrize("damping", ["0", "0.3", "-0.2"])
def test_the_end_of_gamma_is_that_of_the_series(damping):
    """The third coefficient has the sign of the damping that theory gives it."""
    model = si.linear(2, "0.3", "0.5", damping=damping)
    first, second, rate = end_of_gamma(model, next_zero(model, constant("tau", 1)).zero, 128)
    series = si.theory.gamma(order=3, model=model)
    assert float(abs(first - float(series[2]))) < 1e-15
    assert float(abs(second - float(series[3]))) < 1e-15
    assert abs(float(rate.mid()) - float(si.fixed_points.tangency("1/2", digits=20).lambda_.value)) < 1e-15


def test_a_restitution_near_zero_has_a_threshold_with_digits():
    found = si.threshold(si.linear("sqrt(2)", "1e-12", "1e-300"), "pi/2.8", digits=20)
    assert found.status in (Status.complete, Status.unresolved)
    rates = {r: end_of_gamma(si.linear(2, "0.3", r), next_zero(si.linear(2, "0.3", r), constant("tau", 1)).zero, 256)[2]
             for r in ("1e-300", "1e-20", "0.5")}  # fmt: skip
    for r, rate in rates.items():
        assert rate.rel_accuracy_bits() > 200
        known = si.fixed_points.tangency(r, digits=20).lambda_
        assert abs(float(rate.mid()) / float(known.value) - 1) < 1e-15
