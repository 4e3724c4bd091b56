"""Chatter and gamma of laws that are not smooth at rest, against long flights and against exact sums."""

import math

import numba
import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics import chatter_completes, chatter_left, rest_after, sum_of_speeds
from singimpact.flights import orbit_segment, over_floats, rebound
from singimpact.flights.compiled_model import compiled_model
from singimpact.inputs import InputError
from singimpact.status import Cause, Status

LAWS = {
    "-v*(1 - 0.3*(-v)**0.1)": 0.01,
    "-v*(1 - 0.3*(-v)**(1/5))": 3e-4,
    "-v*(1 - 0.3*(-v)**0.2 + 0.1*(-v)**0.3*exp(v))": 3e-4,
    "-v/(1 + (-v)**0.2)": 3e-4,
    "-v*(1 - 2*(-v)**0.3)": 3e-4,
    "-0.8*v - 0.1*(-v)**1.1": 3e-4,
    "-0.8*v - 0.3*(-v)**1.5": 3e-4,
    "-0.8*v - v**2*sqrt(-v)": 3e-4,
}


def model(rho, f="x", g="sin(t)"):
    return si.ImpactOscillator(f, g, 0, rho)


@pytest.mark.parametrize("rho", LAWS)
@pytest.mark.parametrize("f", ["x", pytest.param("x + 0.3*xdot + 0.2*x**2", marks=pytest.mark.slow)])
def test_the_limit_is_the_same_from_every_impact_and_its_error_covers_it(rho, f):
    osc, tau, v = model(rho, f), -1.3, LAWS[rho]
    end = osc.chatter_limit(tau, v)
    assert end.status == Status.complete
    assert end.error < 1e-10
    flown = orbit_segment(osc, tau, v, 300)
    assert np.all(flown.tau <= end.tau + end.error)
    for n in (3, 10, 30, 100, 300):
        if n <= flown.tau.size and flown.v[n - 1] > 1e-280:
            left, error = chatter_left(osc, float(flown.tau[n - 1]), float(flown.v[n - 1]))
            assert abs(flown.tau[n - 1] + left - end.tau) <= error + end.error
            again = osc.chatter_limit(float(flown.tau[n - 1]), float(flown.v[n - 1]))
            assert abs(again.tau - end.tau) <= again.error + end.error


@pytest.mark.parametrize("rho", LAWS)
def test_the_sum_of_speeds_is_that_of_the_speeds(rho):
    osc, speeds = model(rho, "0", "-2"), [1e-9]
    flown = compiled_model(osc)
    plain, w = over_floats("", flown.emitted[0].rho)["law"], flown.rho.tolist()
    while speeds[-1] > 1e-13 and len(speeds) < 3000:
        speeds.append(plain(-speeds[-1], w))
    terms = sum_of_speeds(osc)
    first, last = (sum(s * v**p for p, s in terms) for v in (speeds[0], speeds[-1]))
    assert first - last == pytest.approx(math.fsum(speeds[:-1]), rel=1e-6)


@pytest.mark.parametrize(
    ("rho", "completes"),
    [("-v*(1 - 0.3*(-v)**0.9)", True), ("-v - v**2/5", False), ("-v - (-v)**1.2/5", True), ("-v + v**2/5", False),
     (1, False), ("0.999", True), ("-0.9*v + (-v)**1.5", True), ("-v*(1 - 0.3*(-v)**1.5)", False),
     ("-v*(1 + 0.3*(-v)**0.2)", False)],
)  # fmt: skip
def test_what_completes(rho, completes):
    """w (1 - C w^q) with q < 1 and C > 0 does; with q >= 1 the times of flight have an infinite sum."""
    assert chatter_completes(model(rho)) == completes


def test_without_an_end_the_answer_is_unresolved():
    end = model("-v*(1 + v/5)").chatter_limit(-1.3, 1e-4, impacts=2000)
    assert (end.status, end.cause) == (Status.unresolved, Cause.impacts_exhausted)
    slow = model("-v*(1 - 0.3*sqrt(-v))").chatter_limit(-1.3, 3e-5, impacts=2000)
    assert (slow.status, slow.cause) == (Status.unresolved, Cause.impacts_exhausted)
    with pytest.raises(InputError, match="q < 1"):
        si.threshold(model("-v*(1 + v/5)"), -1.0)
    with pytest.raises(InputError, match="exponents need r < 1"):
        si.lyapunov(model("-v*(1 - 0.3*(-v)**0.2)"), 0.1, 0.5, impacts=100)


def test_the_time_left_under_constant_acceleration():
    osc = model("-v*(1 - 0.3*(-v)**0.2)", "0", "-2")
    v = np.array([1e-12, 1e-14])
    assert rest_after(osc, v, -2 * np.ones(2)) == pytest.approx(2 * v**0.8 / (0.8 * 0.3 * 2), rel=0.02)
    assert not np.isfinite(rest_after(model(1), v, -np.ones(2))).any()


@pytest.mark.parametrize("rho", ["-v*(1 - 0.3*(-v)**0.1)", "-v*(1 - 2*(-v)**0.2)", "-0.8*v - 0.3*(-v)**1.5"])
def test_the_threshold_separates_complete_chatter_from_lift_off(rho):
    osc = model(rho)
    found = si.threshold(osc, -0.05, impacts=20_000)
    assert found.status == Status.complete
    assert found.error < 1e-3 * found.v
    below = osc.chatter_limit(-0.05, found.v * (1 - 1e-3))
    assert below.status == Status.complete
    assert below.tau < 0
    assert orbit_segment(osc, -0.05, found.v * (1 + 1e-3), 4000).tau.max() > 0


@pytest.mark.parametrize(
    "rho",
    ["-v*(1 - 0.3*(-v)**(1/5))", "-v*(1 - 0.3*sqrt(-v))", "-0.8*v - 0.1*(-v)**(3/2)", "-v*(1 - 0.3*(-v)**0.1)",
     "-v*(1 - 0.3*(-v)**0.2*exp(v))", "-v*(1 - 0.2*abs(v)**0.2 - 0.1*(v**2)**0.35)"],
)  # fmt: skip
def test_compiled_and_interpreted_laws_are_the_same_to_the_bit(rho):
    flown = compiled_model(model(rho))
    text, w = flown.emitted[0].rho, flown.rho
    functions = {"exp": math.exp, "abs": abs}
    exec(text, functions)
    fast, plain = numba.njit(error_model="numpy")(functions["law"]), over_floats("", text)["law"]
    v = -np.concatenate([[0.0, -0.0, 5e-324, 1e-310], 10 ** np.random.default_rng(1).uniform(-300, 0, 3000)])
    slow = np.array([plain(speed, w.tolist()) for speed in v.tolist()])
    assert np.array_equal([fast(speed, w) for speed in v], slow)
    assert slow[0] == slow[1] == 0
    # numpy has a power of its own: one rounding apart
    assert np.allclose(rebound(model(rho), v), slow, rtol=2.0**-51, atol=5e-324)
