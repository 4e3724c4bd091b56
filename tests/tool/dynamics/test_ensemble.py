"""Ensembles beside orbits one by one, a closed form, and the counts of what they count."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.status import Status

BALL = si.ImpactOscillator("1", "1.9*sin(t)", 0, "1/2")
MODELS = {
    "a ball": BALL,
    "linear": si.linear("2.8", 0, "0.8"),
    "resting": si.linear(2, "0.3", "0.5"),
    "two walls": si.linear("2.8", "-0.4", "0.6", upper="0.4"),
    "Duffing": si.ImpactOscillator("x + x**3", "cos(1.7*t)", "0.3", "0.6"),
    "no clock": si.ImpactOscillator("x - (1 - x**2)*xdot", "0", "-1.5", "0.6"),
    "plastic": si.linear(2, "0.3", 0),
}


@pytest.mark.parametrize("name", MODELS)
def test_ends_and_rests_are_those_of_each_orbit(name):
    osc, rng, until, count = MODELS[name], np.random.default_rng(3), 25.0, 12
    tau, v = rng.uniform(0, 6, count), rng.uniform(0, 1.5, count)
    v[:3] = 0
    times = np.linspace(0, until, 201)
    found = si.ensemble(osc, tau, v, until=until, sample=times)
    for index in range(count):
        orbit = osc.orbit(tau[index], v[index], impacts=200)
        flown = (times >= tau[index]) & (times <= orbit.end)
        path = orbit.sample(times[flown])
        assert np.abs(path.x - found.x[flown, index]).max() < 1e-6
        away = (np.abs(times[flown, None] - orbit.tau) > 1e-3).all(axis=1)
        away &= path.x > float(osc.clearance.value) + 1e-4
        assert np.abs(path.xdot - found.xdot[flown, index])[away].max(initial=0) < 1e-5
        assert np.isnan(found.x[times < tau[index], index]).all()
        if found.status[index] == 0:  # the first impact after the end
            after = np.flatnonzero((orbit.tau >= until) & np.isin(orbit.kind, ("impact", "graze")))[0]
            assert found.tau[index] == pytest.approx(orbit.tau[after], abs=1e-6)
            assert found.v[index] == pytest.approx(orbit.v[after], abs=1e-6)
        ends = orbit.tau[orbit.kind == "complete"]
        before = ends[ends < until]
        if before.size:
            assert found.first_rest[index] == pytest.approx(before[0], abs=1e-7)
        elif osc.restitution != MODELS["plastic"].restitution:
            assert found.first_rest[index] > until
    assert ((found.tau >= until) | (found.status != 0)).all()


def test_a_ball_under_gravity_rests_where_the_sum_of_its_impacts_says():
    v = np.linspace(0.1, 2, 50)
    found = si.ensemble(si.ImpactOscillator("0", "-2", 0, "1/2"), 0, v, until=10)
    assert found.first_rest == pytest.approx(2 * v, rel=1e-13)  # v (1 + r + r^2 + ...) with a = -2
    assert (found.status == Status.sticks).all()
    assert found.survival.share == pytest.approx(1 - np.arange(51) / 50)


def test_a_spectrum_has_the_line_of_a_sine_and_all_of_its_power():
    # without impact, once free motion has died out
    osc = si.ImpactOscillator("x + 0.2*xdot", "cos(2*t)", -3, "0.5")
    times = 200 + np.arange(4096) * 2 * np.pi / 64
    found = si.ensemble(osc, [0.0, 1.0], 0.1, until=times[-1] + 1, sample=times)
    power = found.spectrum
    assert power.frequency[power.power.argmax()] == pytest.approx(2, abs=2 * power.frequency[1])
    amplitude = 1 / np.hypot(3, 0.4)
    assert power.power.sum() * power.frequency[1] == pytest.approx(amplitude**2 / 2, rel=1e-3)
    density, across, up = found.density(20)
    assert (density * np.diff(across)[:, None] * np.diff(up)).sum() == pytest.approx(1)


def test_a_mass_that_rests_for_ever_stands_in_the_samples():
    ball = si.ImpactOscillator("0", "-2", 0, "1/2")
    found = si.ensemble(ball, 0, [0, 1, 2], until=10, sample=np.linspace(0, 10, 101))
    assert found.x[found.t[:, None] > np.array([0, 2, 4])].max() == 0
    assert np.isfinite(found.x).all()
    above = si.ImpactOscillator("0", "2", -1, "1/2", upper=0)  # the same below a ceiling
    upper = si.ensemble(above, 0, [0, 1, 2], until=10, sample=np.linspace(0, 10, 101), wall="upper")
    assert upper.x[:, :2] == pytest.approx(-found.x[:, :2], abs=1e-12)


def test_samples_once_a_period_are_those_of_a_section(tmp_path):
    osc = MODELS["linear"]
    found = si.ensemble(osc, [0.1, 0.2], 0.5, until=20, sample="pi/8")
    section = osc.orbit(0.2, 0.5, impacts=40).section("pi/8")
    assert found.t == pytest.approx(section.t[: found.t.size])
    assert found.x[:, 1] == pytest.approx(section.x[: found.t.size], abs=1e-9)
    found.to_npz(tmp_path / "ends.npz")
    assert np.load(tmp_path / "ends.npz")["x"].shape == found.x.shape == (found.t.size, 2)
    with pytest.raises(InputError, match="times of samples"):
        si.ensemble(osc, 0.1, 0.5, until=5).density()
    with pytest.raises(InputError, match="evenly spaced"):
        si.ensemble(osc, 0.1, 0.5, until=5, sample=[0.5, 1, 3]).spectrum  # noqa: B018
    with pytest.raises(InputError, match="an array of times"):
        si.ensemble(osc, 0.1, 0.5, impacts=5, sample=0)


def test_impacts_are_as_many_as_asked_for():
    found = si.ensemble(MODELS["linear"], np.linspace(0, 2, 30), 0.5, impacts=100)
    assert ((found.impacts >= 100) & (found.impacts <= 101)).all()


def test_the_escape_rate_is_that_of_the_survival():
    rng = np.random.default_rng(0)
    found = si.ensemble(BALL, rng.uniform(0, 6.28, 4000), rng.uniform(0, 3, 4000), until=300)
    rate, error = found.escape_rate(after=40)
    survival = found.survival
    late = (survival.t > 40) & (survival.t < 200)
    slope = np.polyfit(survival.t[late], np.log(survival.share[late]), 1)[0]
    assert -slope == pytest.approx(rate, abs=5 * error)
    assert error < rate / 20


def test_random_restitution_and_kicks_are_those_of_the_seed_whatever_the_executor():
    tau, v = np.linspace(0, 6, 3000), np.full(3000, 0.8)
    noise = {
        "restitution": lambda rng, size: rng.uniform(0.6, 0.8, size),
        "kick": lambda rng, size: 0.01 * rng.normal(size=size),
        "generator": 5,
    }
    one = si.ensemble(MODELS["linear"], tau, v, until=20, random=noise)
    with ThreadPoolExecutor(2) as pool:
        other = si.ensemble(MODELS["linear"], tau, v, until=20, random=noise, executor=pool)
    assert (one.tau == other.tau).all()
    assert (one.tau != si.ensemble(MODELS["linear"], tau, v, until=20).tau).all()
    # restitutions that are all one number are that of the model
    plain = si.ensemble(MODELS["linear"], tau, v, until=9, random={"restitution": lambda rng, size: np.full(size, 0.8)})  # noqa: ARG005
    assert plain.tau == pytest.approx(si.ensemble(MODELS["linear"], tau, v, until=9).tau, abs=1e-9)


def test_a_family_has_an_orbit_of_each_model():
    many = BALL.replace(restitution="0.4").over(restitution=np.linspace(0.3, 0.6, 5))
    found = si.ensemble(many, 0.3, np.full((4, 5), 0.7), until=30)
    assert found.tau.shape == (4, 5)
    for index in range(5):
        alone = si.ensemble(many[index], 0.3, 0.7, until=30)
        assert found.tau[2, index] == pytest.approx(float(alone.tau), abs=1e-9)


def test_results_go_to_files_and_bad_input_is_refused(tmp_path):
    found = si.ensemble(MODELS["linear"], [0.1, 0.2], 0.5, until=20)
    found.to_csv(tmp_path / "ends.csv")
    first = (tmp_path / "ends.csv").read_text(encoding="utf-8").partition("\n")[0]
    assert si.ImpactOscillator(**json.loads(first.removeprefix("# "))) == MODELS["linear"]
    found.to_npz(tmp_path / "ends.npz")
    assert np.load(tmp_path / "ends.npz")["tau"].shape == (2,)
    assert "2 orbits" in repr(found)
    assert set(found.averages) == {"impacts", "v", "rest"}
    for change, words in (
        ({"until": None}, "a time, or impacts="),
        ({"impacts": 3}, "a time, or impacts="),
        ({"until": -1}, "a time after all starts"),
        ({"threads": 2}, "executor or output"),
    ):
        with pytest.raises(InputError, match=words):
            si.ensemble(MODELS["linear"], 0.1, 0.5, **{"until": 5, **change})


@pytest.mark.parametrize(
    ("random", "words"),
    [
        ({"restituton": np.random.default_rng}, "random ="),
        ([np.random.default_rng], "random ="),
        ({"restitution": 0.5}, "random ="),
        ({"generator": "x"}, "generator = 'x'"),
        ({"generator": -1}, "generator = -1"),
        ({"restitution": lambda _, size: np.full(size, 1.5)}, "2 finite numbers from 0 to 1"),
        ({"restitution": lambda _, size: np.full(size, np.nan)}, "2 finite numbers from 0 to 1"),
        ({"restitution": lambda _, size: np.full(size + 1, 0.5)}, "2 finite numbers from 0 to 1"),
        ({"kick": lambda _, size: np.full(size, np.inf)}, "kick ="),
    ],
)
def test_what_is_random_is_refused_where_it_is_none_of_the_kinds(random, words):
    with pytest.raises(InputError, match=words):
        si.ensemble(MODELS["linear"], 0, [1, 2], until=20, random=random)


def test_shapes_that_do_not_broadcast_are_refused():
    for osc, tau in ((MODELS["linear"], [0, 1, 2]), (MODELS["linear"].over(omega=[2, 3, 4]), 0)):
        with pytest.raises(InputError, match="do not broadcast"):
            si.ensemble(osc, tau, [1, 2], until=20)
