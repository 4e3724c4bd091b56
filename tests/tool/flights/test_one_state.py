"""One state in floats, and few states: against the roads of arrays, against mpmath, and what a call may cost."""

import time

import mpmath
import numpy as np
import pytest

from singimpact.impact_oscillator import ImpactOscillator, linear

MODELS = [linear("2.8", "0.3", "0.8"), ImpactOscillator("x + x**3", "cos(t)", 0, "0.8"),
          ImpactOscillator("sin(x) + xdot/10", "cos(t) - 1/3", "1/10", "0.8")]  # fmt: skip
RNG_STATES = 60


def states(seed, late=400.0):
    rng = np.random.default_rng(seed)
    return zip(rng.uniform(-late, late, RNG_STATES).tolist(), rng.uniform(0.05, 2, RNG_STATES).tolist(), strict=True)


def same(one, other):
    return one == other or (one != one and other != other)


@pytest.mark.parametrize("model", MODELS)
def test_derivative_of_one_state_is_that_of_an_array(model):
    for tau, v in states(1):
        one, array = model.derivative(tau, v), model.derivative(np.array([tau]), np.array([v]))
        assert one.status == array.status[0]
        assert np.array_equal(one.matrix, array.matrix[0], equal_nan=True)


@pytest.mark.parametrize("model", MODELS)
def test_inverse_of_one_state_is_that_of_an_array(model):
    for tau, v in states(2):
        one, array = model.inverse_map(tau, v), model.inverse_map(np.array([tau]), np.array([v]))
        for name in ("tau", "v", "flight_time", "velocity", "status", "condition", "error", "depth", "cause"):
            assert same(getattr(one, name), getattr(array, name)[0]), name


@pytest.mark.parametrize("model", MODELS)
def test_launch_of_floats_is_that_of_exact_numbers(model):
    for (t, speed), (_, x) in zip(states(3, 40.0), states(4), strict=True):
        start = x + 0.3, 3 * speed - 3, t
        one, exact = model.launch(*start), model.launch(np.array(start[0], dtype=object), *start[1:])
        for name in ("tau", "v", "flight_time", "velocity", "status", "cause"):
            assert same(getattr(one, name), getattr(exact, name)), name


@pytest.mark.parametrize("tau", [0.3, -63.0, 1e3, 2.0**30 + 0.25])
def test_acceleration_at_one_time(tau):
    model = linear("2.8", "0.3", "0.8")
    with mpmath.workdps(40):
        truth = mpmath.cos(mpmath.mpf("2.8") * mpmath.mpf(tau)) - mpmath.mpf("0.3")
    one, array = model.acceleration(tau), model.acceleration(np.array([tau]))[0]
    assert isinstance(one, np.float64)
    assert one == array
    assert abs(one - truth) < 2.0**-52 * 2.8 * 64  # half a unit of the largest phase that is not reduced


@pytest.mark.parametrize("model", MODELS)
def test_few_states_are_those_of_many(model):
    tau, v = np.array(list(states(5))).T
    many, few = model.impact_map(tau, v), model.impact_map(tau[:10].copy(), v[:10].copy())
    for name in ("tau", "v", "flight_time", "status", "cause", "depth", "condition", "velocity_error"):
        assert np.array_equal(getattr(many, name)[:10], getattr(few, name), equal_nan=True), name


@pytest.mark.parametrize("model", [linear(2, "0.3", "0.5"), linear("2.8", "-0.1", "0.9", damping="0.1")])
def test_an_orbit_alone_is_that_of_a_batch(model):
    """After few impacts: later ones of a chaotic orbit depend on roundings."""
    tau, v = np.array(list(states(6, 6.0))).T
    batch = model.iterate(tau, v, 5)
    for index in range(RNG_STATES):
        alone = model.iterate(tau[index], v[index], 5)
        assert alone.status == batch.status[index]
        assert alone.tau == pytest.approx(batch.tau[index], abs=1e-11, nan_ok=True)
        assert alone.v == pytest.approx(batch.v[index], abs=1e-11, nan_ok=True)


def test_bad_numbers_are_refused_as_before():
    for call in (MODELS[0].derivative, MODELS[0].inverse_map, MODELS[0].impact_map):
        for tau, v in ((0.1, -0.5), (float("nan"), 0.5), (float("inf"), 0.5), (0.1, float("nan"))):
            with pytest.raises(ValueError, match="is not accepted"):
                call(tau, v)
    with pytest.raises(ValueError, match=r"x = 0.1 is not accepted"):
        MODELS[0].launch(0.1, 0.0, 0.0)
    with pytest.raises(ValueError, match="is not accepted"):
        MODELS[0].acceleration(float("nan"))


def cost_beside(call, reference):
    """CPU time of a call of one state beside that of another: both in turn, for a busy machine changes its speed."""
    pairs = np.random.default_rng(7).uniform(0.2, 2, (50, 2)).tolist()
    ratios = []
    for _ in range(25):
        times = [time.process_time()]
        for chosen in (call, reference):
            for pair in pairs:
                chosen(*pair)
            times.append(time.process_time())
        ratios.append((times[1] - times[0]) / (times[2] - times[1]))
    return np.median(ratios)


@pytest.mark.parametrize("model", MODELS[:2])
def test_calls_of_one_state_cost_a_few_first_hits(model):
    """Before one road for floats they cost 10 to 35 of them."""
    assert cost_beside(model.derivative, model.first_hit) < 9
    assert cost_beside(model.inverse_map, model.first_hit) < 8
    assert cost_beside(lambda x, t: model.launch(x + 0.3, 0.5, t), model.first_hit) < 10
    assert cost_beside(lambda t, _: model.acceleration(t), model.first_hit) < 3
