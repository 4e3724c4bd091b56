"""Events with two rests of any model: against elimination where the model is linear, and against scipy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.surface import Family, FollowedRests, linear_rests, newton, transitions

LIGHT = si.ImpactOscillator("x + 0.04*xdot", "cos(2.8*t) + 0.5*cos(5.6*t + 2)", 0, "0.8")
DUFFING = si.ImpactOscillator("x + 0.1*xdot + x**3/10", "cos(2.8*t)", 0, "0.8")


@pytest.mark.slow
def test_tacnodes_and_grazes_of_a_linear_model_are_those_of_the_elimination():
    """Flights met on a grid, without the closed form."""
    family, ends = Family(LIGHT, "clearance"), (-0.2, 0.2)
    wanted = [*linear_rests(family).grazes(), *linear_rests(family).tacnodes(3.5)]
    wanted = sorted(each.value for each in wanted if ends[0] < each.value < ends[1])
    found = [each.value for each in FollowedRests(family, ends, (2.2, 3.5)).met(["tacnode", "periodic graze"])]
    assert sorted({round(value, 9) for value in found}) == pytest.approx(wanted, abs=2e-9)


@pytest.mark.slow
def test_a_triple_point_of_a_linear_model_is_met_too():
    family = Family(LIGHT, "clearance")
    found = FollowedRests(family, (-1.2, -1.0), (0.0, 7.0)).met(["triple point"])
    assert min(abs(each.value + 1.1285458) for each in found) < 1e-6


def flown(tau, t, clearance):
    """x - c, x', dx/dv and dx'/dv of the Duffing oscillator at t, by scipy."""

    def moving(s, state):
        x, v, y, w = state
        return [v, np.cos(2.8 * s) - x - 0.1 * v - x**3 / 10, w, -0.1 * w - (1 + 0.3 * x**2) * y]

    end = solve_ivp(moving, (tau, tau + t), [clearance, 0.0, 0.0, 1.0], "DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    return end - [clearance, 0, 0, 0]


@pytest.mark.slow
def test_tacnodes_of_a_duffing_oscillator():
    found = transitions(DUFFING, "clearance", ("0.045", "0.055"), (3, 4), ["tacnode", "periodic graze"])
    (met,) = found
    x, v, by_speed, _ = flown(met.tau, met.t, met.value)
    assert np.abs([x, v, by_speed]).max() < 1e-10
    assert (met.kind, met.visible) == ("tacnode, opposite", False)
    assert flown(met.tau, met.t, met.value)[3] < 0
    assert "grid of 48 times of rest a period and 60 steps of clearance" in found.doubts[0]


@pytest.mark.slow
def test_a_graze_and_its_mirror_image():
    """x -> -x, t -> t + T/2 turns the Duffing oscillator into itself: values come in pairs, of which one is seen."""
    found = transitions(DUFFING, "clearance", ("-0.2", "0.2"), (-4, 4), ["tacnode", "periodic graze"])
    for event in ("tacnode", "periodic graze"):
        one, other = (each for each in found if each.event == event)
        assert one.value == pytest.approx(-other.value, abs=1e-11)
    assert [each.visible for each in found if each.event == "periodic graze"] == [True, False]
    for each in found:
        assert np.abs(flown(each.tau, each.t, each.value)[:2]).max() < 1e-10


@pytest.mark.slow
def test_events_over_a_rate():
    """Over omega, where the period moves: each solves its equations; the graze is that of the steady motion."""
    damped = si.ImpactOscillator("x + 0.1*xdot", "cos(w*t)", "0.3", "0.6", parameters={"w": "1.7"})
    found = transitions(damped, "w", ("1.9", "2.3"), (-5, 5), ["tacnode", "periodic graze"])
    assert {each.event for each in found} == {"tacnode", "periodic graze"}
    for each in found:
        model = damped.replace(w=each.value)
        x, v = model.flight(each.tau, 0, each.t)
        assert max(abs(x - 0.3), abs(v)) < 1e-10
        if each.event == "periodic graze":
            assert np.hypot(1 - each.value**2, 0.1 * each.value) == pytest.approx(1 / 0.3, rel=1e-11)


def test_a_flight_from_tangency_to_tangency_is_one_transition():
    """x'' + x = cos(w t) over w: at c = -0.0461684 the flight of w = 2.8, a double zero of the equations of one."""
    model = si.ImpactOscillator("x", "cos(w*t)", -0.04616841181796276, "0.8", parameters={"w": "2.8"})
    family = Family(model, "w")
    met = FollowedRests(family, (2.7, 2.9), (3.0, 4.0)).both_ends(2.8001, 1.666, 3.3991)
    assert met is not None
    assert met.value == pytest.approx(2.8, abs=1e-11)
    assert FollowedRests(family, (2.7, 2.9), (3.0, 4.0)).both_ends(2.8001, 1.3, 3.3991) is None


def test_newton_drops_what_does_not_settle():
    """Where the derivative vanishes no move is made, and nothing is found."""
    found = newton(lambda z: np.stack([z[:, 0] ** 2 + 1, z[:, 1]], axis=1), np.array([[0.0, 0.2], [2.0, 1.0]]))
    assert found.shape == (0, 2)


@pytest.mark.parametrize("kinds", ["tacnodes", ["swan", "lips"], 3])
def test_kinds_that_are_none_are_refused(kinds):
    from singimpact.inputs import InputError

    with pytest.raises(InputError, match=r"kinds = .* is not accepted: give some of swan, swallowtail, tangency"):
        transitions(LIGHT, "clearance", (0, 1), kinds=kinds)
