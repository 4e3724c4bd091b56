"""Large arrays of linear models: states abreast have the hits, errors and derivatives of one state at a time."""

from time import process_time

import numpy as np
import pytest

import singimpact as si

NEAR = "two waves, one near a resonance"
MODELS = {
    "damped": si.ImpactOscillator("x + xdot/5", "cos(1.3*t)", "1/5", "4/5"),
    "undamped": si.ImpactOscillator("x", "cos(2.7*t)", "-1/10", "4/5"),
    NEAR: si.ImpactOscillator("x + xdot/10", "cos(t) + 3*sin(2*t)/10", "1/10", "7/10"),
    "at a resonance": si.ImpactOscillator("x", "cos(t)/3", "3/10", "4/5"),
    "ball": si.ImpactOscillator("0", "-1 + 2*cos(t)", 0, "4/5"),
    "friction alone": si.ImpactOscillator("xdot", "cos(t) - 1/5", "1/10", "4/5"),
    "overdamped": si.ImpactOscillator("x + 3*xdot", "-1/2 + cos(t)", 0, "4/5"),
    "critical": si.ImpactOscillator("x + 2*xdot", "cos(1.7*t) - 1/5", 0, "4/5"),
    "growing": si.ImpactOscillator("x - xdot/10", "cos(1.7*t)", "-3/10", "4/5"),
    "saddle": si.ImpactOscillator("-x/5 + xdot/5", "-1/2 + cos(t)", "-3/10", "4/5"),
    "stiff": si.ImpactOscillator("100*x + xdot", "30*cos(1.7*t) + sin(9*t)", "1/10", "4/5"),
    "no forcing": si.ImpactOscillator("x + xdot/7", "-1/3", "1/10", "4/5"),
}
TENS = 60


def drawn_states(seed):
    """States of all sizes of velocities and launch times, a multiple of ten."""
    draw = np.random.default_rng(seed)
    tau = np.concatenate(
        [draw.uniform(0, 6, 4 * TENS), draw.normal(0, 50, 3 * TENS), draw.uniform(-1e6, 1e6, 3 * TENS)]
    )
    return tau, 10 ** draw.uniform(-8, 1.3, tau.size)


def ten_by_ten(call, tau, v):
    """The results of arrays that are too small to fly abreast."""
    return [call(*part) for part in zip(tau.reshape(-1, 10), v.reshape(-1, 10), strict=True)]


def together(parts, name):
    return np.concatenate([getattr(part, name) for part in parts])


@pytest.mark.parametrize("name", MODELS)
def test_hits_are_those_of_small_arrays(name):
    osc, (tau, v) = MODELS[name], drawn_states(1)
    hits, few = osc.first_hit(tau, v), ten_by_ten(osc.first_hit, tau, v)
    assert np.array_equal(hits.status, together(few, "status"))
    hit = hits.status == si.Status.hit
    assert hit.sum() > 200
    for field, error in (("flight_time", "error"), ("velocity", "velocity_error")):
        one, other = getattr(hits, field)[hit], together(few, field)[hit]
        allowed = getattr(hits, error)[hit] + together(few, error)[hit]
        assert np.all(np.abs(one - other) <= allowed * np.abs(other))
    for field in ("condition", "velocity_condition", "error", "velocity_error"):
        assert np.allclose(getattr(hits, field)[hit], together(few, field)[hit], rtol=1e-9), field


@pytest.mark.parametrize("name", MODELS)
def test_derivatives_are_those_of_small_arrays(name):
    osc, (tau, v) = MODELS[name], drawn_states(2)
    matrices = osc.derivative(tau, v).matrix
    few = together(ten_by_ten(osc.derivative, tau, v), "matrix")
    assert np.allclose(matrices, few, rtol=1e-10, atol=1e-11, equal_nan=True)
    spoilt = matrices * (1 + 1e-9)
    assert not np.allclose(spoilt, few, rtol=1e-10, atol=1e-11, equal_nan=True)


@pytest.mark.parametrize("name", MODELS)
def test_errors_bound_what_more_digits_show(name):
    osc, (tau, v) = MODELS[name], drawn_states(3)
    hits = osc.first_hit(tau, v)
    for index in np.random.default_rng(4).choice(np.flatnonzero(hits.status == si.Status.hit), 12):
        exact = osc.first_hit(tau[index], v[index], digits=30)
        time, velocity = float(exact.flight_time), float(exact.velocity)
        # a double nearest to the exact value is off by half a unit itself
        assert abs(hits.flight_time[index] - time) <= (hits.error[index] + 2e-16) * time
        assert abs(hits.velocity[index] - velocity) <= (hits.velocity_error[index] + 2e-16) * abs(velocity)


def test_errors_grow_with_the_motion():
    """In the longest of these flights the free motion grows 40 to 200 times."""
    osc, draw = MODELS["saddle"], np.random.default_rng(8)
    tau, v = draw.uniform(0, 6, 20_000), draw.uniform(0.5, 2.5, 20_000)
    hits = osc.first_hit(tau, v)
    hit = np.flatnonzero(hits.status == si.Status.hit)
    longest = hit[np.argsort(hits.flight_time[hit])[-15:]]
    assert hits.flight_time[longest].min() > 10
    for index in longest:
        exact, one = (osc.first_hit(float(tau[index]), float(v[index]), digits=digits) for digits in (30, None))
        for time, error in ((hits.flight_time[index], hits.error[index]), (one.flight_time, one.error)):
            assert abs(time - float(exact.flight_time)) <= error * time


@pytest.mark.parametrize("name", ["damped", "ball", "friction alone", "critical"])
def test_orbits_abreast_keep_the_digits_of_velocities(name):
    """The velocity at a root is the slope there, not one that a derivative from before the last step has moved."""
    osc, draw = MODELS[name], np.random.default_rng(5)
    tau, v = draw.uniform(0, 6, 3000), draw.uniform(0.01, 2, 3000)
    ends, hits = osc.iterate(tau, v, 1), osc.first_hit(tau, v)
    off = np.abs(ends.v / together(ten_by_ten(osc.impact_map, tau, v), "v") - 1)
    hit = hits.status == si.Status.hit
    assert np.all(off[hit] <= hits.velocity_error[hit])


def test_states_do_not_depend_on_their_neighbours():
    """Nor on where an array begins, on the number of threads, or on the last batch, which is filled from before."""
    osc, (tau, v) = MODELS[NEAR], drawn_states(6)
    v[7] = 0.0
    hits = osc.first_hit(tau, v)
    for chosen in (slice(1, None), slice(0, 64), slice(3, 132), slice(None, None, -1)):
        part = osc.first_hit(tau[chosen], v[chosen])
        for field in ("flight_time", "velocity", "condition", "error", "status"):
            assert np.array_equal(getattr(part, field), getattr(hits, field)[chosen], equal_nan=field != "status")
    many = np.tile(tau, 20), np.tile(v, 20)
    one, three = osc.first_hit(*many, threads=1), osc.first_hit(*many, threads=3)
    assert np.array_equal(one.velocity, three.velocity, equal_nan=True)
    assert np.array_equal(one.velocity[: tau.size], hits.velocity, equal_nan=True)


def cost(call, repeats=7):
    """CPU time of a call, the best of several."""
    times = []
    for _ in range(repeats):
        begun = process_time()
        call()
        times.append(process_time() - begun)
    return min(times)


@pytest.mark.parametrize(
    ("name", "least", "most"),
    [("damped", 0.1, 2), (NEAR, 0.1, 2), (NEAR, 1e-6, 1e-2)],
)
def test_errors_and_derivatives_cost_less_than_the_flight(name, least, most):
    """Beside orbits of two impacts, an impact, whose kernel computes neither: 1.3 to 1.7 times."""
    osc, draw = MODELS[name], np.random.default_rng(7)
    tau, v = draw.uniform(0, 6, 20_000), draw.uniform(least, most, 20_000)
    osc.iterate(tau, v, 2, threads=1)
    hits, orbits = cost(lambda: osc.first_hit(tau, v, threads=1)), cost(lambda: osc.iterate(tau, v, 2, threads=1))
    assert hits < 2.4 * orbits / 2
