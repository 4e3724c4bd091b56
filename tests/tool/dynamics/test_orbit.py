"""Orbits: impacts in order, rest, chatter summed up, against the reference values."""

from __future__ import annotations

import numpy as np
import pytest

from singimpact.bench import values
from singimpact.dynamics import release
from singimpact.impact_oscillator import ImpactOscillator, linear, universal
from singimpact.inputs import InputError


def accumulation(orbit) -> float:
    return float(orbit.tau[list(orbit.kind).index("complete")])


@pytest.mark.parametrize("r", ["0.5", "0.9"])
def test_accumulation_time(r: str) -> None:
    found = accumulation(linear(2, "0.3", r).orbit("1.2", "0.01", impacts=160))
    assert found == pytest.approx(float(values()[f"chatter.tau_inf.linear[w=2,c=0.3,r={r}](1.2,0.01)"]), rel=1e-14)


@pytest.mark.parametrize(("v", "truth"), [("0.005", 0.959359234422082626), ("0.0001", 0.901229076799750500564)])
def test_published_accumulation_times(v: str, truth: float) -> None:
    assert accumulation(linear("2.8", 0, "0.8").orbit("0.9", v, impacts=80)) == pytest.approx(truth, rel=1e-14)


@pytest.mark.parametrize("r", ["0.1", "0.9"])
def test_foot_of_the_stable_manifold_of_the_unfolded_swan(r: str) -> None:
    orbit = universal(-1, r).orbit(-1, 0, impacts=200)
    assert accumulation(orbit) == pytest.approx(float(values()[f"negswan.model.X.r={r}"]), rel=1e-14)
    assert orbit.phases[-1][::2] == ("sticking", np.inf)


def test_bouncing_ball() -> None:
    # dropped from height 1: the first impact at sqrt(2/g), then the Zeno time of the reference
    ball = ImpactOscillator("0", "-9.81", 0, "0.9")
    orbit = ball.orbit("sqrt(2/9.81)", "0.9*sqrt(2*9.81)")
    assert accumulation(orbit) == pytest.approx(8.5789491787288871846, rel=1e-13)


def test_events_and_phases_agree() -> None:
    orbit = linear("0.9", "0.2", "0.4").orbit("0.3", "0.4", impacts=60)
    assert orbit.kind[0] == "start"
    assert {"impact", "complete", "release"} <= set(orbit.kind)
    assert np.all(np.diff(orbit.tau) > 0)
    assert [phase[1] for phase in orbit.phases] == orbit.tau[: len(orbit.phases)].tolist()
    assert [phase[2] for phase in orbit.phases[: len(orbit.tau) - 1]] == orbit.tau[1:].tolist()
    model = orbit.oscillator
    assert model.acceleration(orbit.tau[orbit.kind == "release"]) == pytest.approx(0, abs=1e-13)


def test_impacts_are_those_of_the_map() -> None:
    osc = linear("2.8", 0, "0.8")
    orbit = osc.orbit(0.3, 0.4, impacts=5)
    for index in range(5):
        step = osc.impact_map(orbit.tau[index], orbit.v[index])
        # the orbit keeps what the double of tau leaves out
        assert step.tau == pytest.approx(orbit.tau[index + 1], rel=1e-14)
        assert step.v == pytest.approx(orbit.v[index + 1], rel=1e-13)


def test_release() -> None:
    assert release(ImpactOscillator("x", "sin(t)", 0, 1), 4.0, 10.0) == pytest.approx(2 * np.pi, rel=1e-15)
    assert release(ImpactOscillator("x", "-1 - t**2", 0, 1), 0.0, 10.0) == np.inf
    assert release(ImpactOscillator("x**3", "exp(t) - 5", 1, 1), 0.0, 10.0) == pytest.approx(np.log(6), rel=1e-15)


def test_elastic_impacts_never_complete() -> None:
    orbit = ImpactOscillator("0", "-2", 0, 1).orbit(0, 1e-30, impacts=10)
    assert orbit.kind.tolist() == ["start"] + ["impact"] * 10


@pytest.mark.parametrize("impacts", [-1, 2.5, True, 10**9])
def test_bad_count(impacts: object) -> None:
    with pytest.raises(InputError, match="impacts"):
        linear(2, 0, 1).orbit(0, 1, impacts=impacts)


def test_one_state_at_a_time() -> None:
    with pytest.raises(InputError, match="one state"):
        linear(2, 0, 1).orbit([0, 1], 1)


def test_an_orbit_whose_last_flight_ends_a_chatter_ends_at_the_lift_off() -> None:
    osc = linear(2, "0.7", "0.5")
    impacts = int(np.flatnonzero(osc.orbit(0, 0.3).kind == "complete")[1]) - 1  # the first lift-off is no flight
    orbit = osc.orbit(0, 0.3, impacts=impacts)
    assert orbit.kind.tolist()[-2:] == ["complete", "release"]
    assert len(orbit.phases) == orbit.tau.size - 1


def test_what_follows_a_lift_off_is_repeated() -> None:
    osc = linear(2, "0.9", "0.5")
    orbit = osc.orbit(0.31, 0.5, impacts=400)
    assert np.count_nonzero(orbit.kind != "release") == 401
    assert [phase[1] for phase in orbit.phases] == orbit.tau[:-1].tolist()
    assert [phase[2] for phase in orbit.phases] == orbit.tau[1:].tolist()
    for index in np.flatnonzero(orbit.kind == "release")[5:40:7]:
        # flown again from the state before: the same events
        again = osc.orbit(orbit.tau[index - 2], orbit.v[index - 2], impacts=12)
        kinds = again.kind.tolist()[1:]
        assert kinds == orbit.kind[index - 1 :].tolist()[: len(kinds)]
        assert again.tau[1:] == pytest.approx(orbit.tau[index - 1 :][: len(kinds)], rel=1e-14)
        assert again.v[1:] == pytest.approx(orbit.v[index - 1 :][: len(kinds)], rel=1e-11, abs=1e-300)


@pytest.mark.parametrize("impacts", [37, 38, 39, 40, 41])
def test_a_shorter_orbit_is_the_beginning_of_a_longer_one(impacts: int) -> None:
    osc = linear(2, "0.9", "0.5")
    short, long = osc.orbit(0.31, 0.5, impacts=impacts), osc.orbit(0.31, 0.5, impacts=300)
    count = short.tau.size
    assert short.kind.tolist() == long.kind[:count].tolist()
    assert short.tau == pytest.approx(long.tau[:count], rel=1e-15)
    assert np.count_nonzero(short.kind != "release") - 1 == impacts
