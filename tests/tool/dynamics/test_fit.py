"""Numbers fitted to impacts, times and motions: errors beside their bound, refusals; derivatives by numbers."""

from __future__ import annotations

import json

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.oscillator import value_of, with_number

SETTLING = si.ImpactOscillator("x", "-cos(14/5*t)", "0.1", "0.8")
CHAOTIC = si.linear("2.8", 0, "0.8")
DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "A*cos(1.3*t)", "0.05", "0.8", {"A": "1.2"})
BOTH = ("restitution", "clearance")
SIZE = 1e-3


def noisy(orbit, rng):
    return {name: getattr(orbit, name) + rng.normal(0, SIZE, orbit.tau.size) for name in ("tau", "v")}


def off(result, true):
    """Errors of the numbers in standard deviations."""
    return [(value - value_of(true, name)) / result.error[name] for name, value in result.values.items()]


@pytest.mark.parametrize(
    ("true", "start", "over"),
    [
        (SETTLING, {"clearance": "0.15", "restitution": "0.7"}, BOTH),
        (CHAOTIC, {"clearance": "0.03", "restitution": "0.75"}, BOTH),
        (DUFFING, {"clearance": "0.06", "restitution": "0.75", "A": "1.1"}, (*BOTH, "A")),
        (CHAOTIC, {"omega": "2.79", "restitution": "0.78"}, ("restitution", "omega")),
    ],
)
def test_errors_are_those_of_the_cramer_rao_bound(true, start, over):
    orbit, scores = true.orbit("0.3", "0.4", impacts=40), []
    for seed in range(12):
        result = si.fit(true.replace(**start), noisy(orbit, np.random.default_rng(seed)), over)
        scores.append(off(result, true))
    # 12 draws of two numbers or three: a standard deviation of 1 is seen within two fifths
    assert 0.6 < np.sqrt(np.mean(np.square(scores))) < 1.3


def test_the_bound_is_that_of_the_orbit_as_a_function_of_its_first_state():
    # an orbit of a few impacts, with its derivatives by differences of whole orbits
    orbit = SETTLING.orbit("0.3", "0.4", impacts=8)
    result = si.fit(SETTLING, {"tau": orbit.tau, "v": orbit.v}, BOTH, noise=(SIZE, 2 * SIZE))
    start, step, columns = np.array([0.3, 0.4, 0.8, 0.1]), 1e-6, []
    for i in range(4):
        ends = []
        for sign in (1, -1):
            tau, v, r, c = (start + sign * step * (np.arange(4) == i)).tolist()
            moved = SETTLING.replace(restitution=r, clearance=c).orbit(tau, v, impacts=8)
            ends.append(np.concatenate([moved.tau / SIZE, moved.v / (2 * SIZE)]))
        columns.append((ends[0] - ends[1]) / (2 * step))
    slopes = np.array(columns)
    bound = np.sqrt(np.diag(np.linalg.inv(slopes @ slopes.T)))
    assert list(result.error.values()) == pytest.approx(bound[2:], rel=1e-4)
    assert list(result.values.values()) == pytest.approx([0.8, 0.1], abs=1e-9)


def test_times_alone_and_motions():
    orbit, times, motions = SETTLING.orbit("0.3", "0.4", impacts=60), [], []
    start, t = SETTLING.replace(clearance="0.15", restitution="0.7"), np.linspace(0.31, 25, 250)
    x = orbit.sample(t).x
    for seed in range(4):
        rng = np.random.default_rng(seed)
        times.append(off(si.fit(start, {"tau": orbit.tau + rng.normal(0, SIZE, 61)}, BOTH), SETTLING))
        motions.append(off(si.fit(start, {"t": t, "x": x + rng.normal(0, SIZE, t.size)}, BOTH), SETTLING))
    assert np.sqrt(np.mean(np.square(times))) < 1.7
    assert np.sqrt(np.mean(np.square(motions))) < 1.7


def test_an_impact_too_weak_to_be_seen_in_a_motion_is_put_in_or_cut():
    orbit, t = DUFFING.orbit("0.3", "0.4", impacts=20), np.linspace(0.35, 60, 900)
    data = {"t": t, "x": orbit.sample(t).x + np.random.default_rng(0).normal(0, SIZE, t.size)}
    result = si.fit(DUFFING.replace(restitution="0.75", clearance="0.06"), data, BOTH)
    assert result.missing or result.cut
    assert result.noise["x"] == pytest.approx(SIZE, rel=0.2)
    assert np.abs(off(result, DUFFING)).max() < 4


@pytest.mark.slow
def test_the_bound_is_reached_within_a_fifth():
    orbit, start = SETTLING.orbit("0.3", "0.4", impacts=59), SETTLING.replace(clearance="0.15", restitution="0.7")
    records = [noisy(orbit, np.random.default_rng(seed)) for seed in range(80)]
    scores = [off(si.fit(start, record, BOTH), SETTLING) for record in records]
    sizes = np.sqrt(np.mean(np.square(scores), axis=0))  # known to 8 %
    assert ((sizes > 0.8) & (sizes < 1.2)).all()


def test_units_and_the_order_of_columns_do_not_matter():
    # lengths a thousand times as large
    osc = si.ImpactOscillator("x", "-1000*cos(14/5*t)", 100, "0.8")
    orbit, rng = osc.orbit("0.3", 400, impacts=60), np.random.default_rng(1)
    data = {"v": orbit.v + rng.normal(0, 1000 * SIZE, 61), "tau": orbit.tau + rng.normal(0, SIZE, 61)}
    result = si.fit(osc.replace(restitution="0.75"), data, BOTH)
    assert result.noise == pytest.approx({"tau": SIZE, "v": 1000 * SIZE}, rel=0.4)
    assert np.abs(off(result, osc)).max() < 4


def test_an_orbit_without_noise_gives_its_numbers():
    result = si.fit(SETTLING.replace(restitution="0.75"), SETTLING.orbit("0.3", "0.4", impacts=30), BOTH)
    assert list(result.values.values()) == pytest.approx([0.8, 0.1], abs=1e-9)


def test_missing_impacts_are_put_in_and_chatter_cuts_the_orbit():
    orbit, rng = SETTLING.orbit("0.3", "0.4", impacts=60), np.random.default_rng(3)
    seen = np.delete(np.arange(61), [7, 20, 21, 40])
    data = {name: values[seen] for name, values in noisy(orbit, rng).items()}
    result = si.fit(SETTLING.replace(restitution="0.75"), data, BOTH)
    assert result.missing == 4
    assert result.cut == ()
    assert np.abs(off(result, SETTLING)).max() < 4
    ball = si.ImpactOscillator("1", "1.9*sin(t)", 0, "1/2")
    impacts = ball.orbit("0.3", "1.4", impacts=120)
    seen = np.flatnonzero((impacts.kind == "impact") & (impacts.v > 0.02))[:60]
    data = {name: values[seen] for name, values in noisy(impacts, rng).items()}
    result = si.fit(ball.replace(restitution="0.45"), data, ("restitution",))
    assert len(result.cut) >= 2
    assert np.abs(off(result, ball)).max() < 4


def test_results_and_their_picture(tmp_path):
    orbit = SETTLING.orbit("0.3", "0.4", impacts=30)
    result = si.fit(SETTLING, noisy(orbit, np.random.default_rng(1)), BOTH)
    assert result.noise == pytest.approx({"tau": SIZE, "v": SIZE}, rel=0.5)
    assert result.correlation[0, 0] == pytest.approx(1)
    assert abs(result.correlation[0, 1]) < 1
    assert value_of(result.model, "clearance") == result.values["clearance"]
    result.to_csv(tmp_path / "fit.csv")
    first, second, *_ = (tmp_path / "fit.csv").read_text(encoding="utf-8").splitlines()
    assert si.ImpactOscillator(**json.loads(first.removeprefix("# "))) == result.model
    assert second == "t,tau_residual,v_residual"
    axes = si.plot(result)
    assert len(axes.lines) == 2
    assert "restitution = " in repr(result)


def test_bad_input_is_refused_in_a_sentence():
    orbit = SETTLING.orbit("0.3", "0.4", impacts=10)
    data = {"tau": orbit.tau, "v": orbit.v}
    for change, words in (
        ({"data": {"v": orbit.v}}, "give arrays by name"),
        ({"data": {"tau": orbit.tau, "v": orbit.v[1:]}}, "columns of three numbers"),
        ({"data": {"tau": orbit.tau[::-1], "v": orbit.v}}, "times that rise"),
        ({"over": "restitution"}, "different names"),
        ({"over": ("colour",)}, "colour"),
        ({"noise": (1e-3,)}, "2 standard deviations above 0"),
        ({"osc": si.linear(2, -1, "1/2", upper=1)}, "one wall"),
    ):
        with pytest.raises(InputError, match=words):
            si.fit(**{"osc": SETTLING, "data": data, "over": BOTH, **change})
    flat = {"t": np.linspace(0, 10, 50), "x": np.linspace(0, 10, 50)}
    with pytest.raises(InputError, match="0 impacts"):
        si.fit(SETTLING, flat, BOTH)
    other = {"tau": np.cumsum(np.random.default_rng(0).uniform(0.1, 9, 40)), "v": np.full(40, 0.3)}
    with pytest.raises(InputError, match="start from a model nearer"):
        si.fit(SETTLING, other, BOTH)


@pytest.mark.parametrize(
    ("osc", "over"),
    [
        (si.linear("2.8", "0.1", "0.8", damping="0.1"), ("omega", "clearance", "restitution", "damping")),
        (DUFFING, ("A", *BOTH)),
        (si.ImpactOscillator("1", "G*sin(t)", 0, "-k*v + v**2/20", {"G": 2, "k": "0.6"}), ("G", "k")),
    ],
)
def test_sensitivities_are_differences(osc, over):
    tau, v = np.array([0.3, 1.1]), np.array([0.7, 0.9])
    found = osc.sensitivity(tau, v, over)
    assert found.matrix[..., :2] == pytest.approx(osc.derivative(tau, v).matrix, abs=1e-9)
    for k, name in enumerate(over):
        named, step = with_number(osc, name), 1e-6
        ends = [named.replace(**{name: value_of(named, name) + h}).impact_map(tau, v) for h in (step, -step)]
        for row, field in enumerate(("tau", "v")):
            slope = (getattr(ends[0], field) - getattr(ends[1], field)) / (2 * step)
            assert found.matrix[:, row, 2 + k] == pytest.approx(slope, abs=1e-6)
    assert found.over == over
    with pytest.raises(InputError, match="one wall"):
        si.sensitivity(si.linear(2, -1, "1/2", upper=1), 0, 1, ("clearance",))
