"""A mass at rest with any signs of a, a', a'', and flights that pass the obstacle by one part in 1e15."""

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.status import Status


def sign_at_rest(a, slope, bend):
    """The first of a, a', a'' that is not zero."""
    return next((part for part in (a, slope, bend) if part), 0)


@pytest.mark.parametrize("a", [-1, 0, 1])
@pytest.mark.parametrize("slope", [-1, 0, 1])
@pytest.mark.parametrize("bend", [-1, 0, 1])
@pytest.mark.parametrize("force", ["x", "x + xdot/5 + x**3"])
def test_a_mass_at_rest_leaves_when_its_first_derivative_is_positive(force, a, slope, bend):
    jets = {"p": a, "q": slope, "s": bend}  # numbers of one text, so one kernel is compiled
    model = si.ImpactOscillator(force, "p + q*t + s*t**2 - t**4/3", 0, "0.5", parameters=jets)
    hit = model.first_hit(0, 0)
    if sign_at_rest(a, slope, bend) > 0:
        assert hit.status == Status.hit
        assert hit.flight_time > 0
        place = model.flight(0, 0, [float(hit.flight_time) / 2, float(hit.flight_time)]).x
        assert place[0] > 0
        assert abs(place[1]) < 1e-13
    else:
        assert hit.status == Status.sticks
        assert (float(hit.flight_time), float(hit.velocity)) == (0.0, 0.0)


DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")


@pytest.mark.slow
@pytest.mark.parametrize("offset", [1e-6, 1e-12, 3e-15])
@pytest.mark.parametrize("model", [si.linear(2, "0.3", "0.5"), DUFFING])
def test_both_sides_of_a_graze_are_told_apart(model, offset):
    """Run back from a touch in many digits; launched a little faster the flight passes, a little slower it hits."""
    touch = mpmath.mpf(1) / 10  # a_c > 0 there
    with mpmath.workdps(50):
        assert model.acceleration(0.1) > 0
        back = model.inverse_map("0.1", "1e-22", digits=40)
        launch, flight = back.v, touch - back.tau
        times, truth = {}, {}
        for side in (-1, 1):
            state = mpmath.nstr(back.tau, 40), mpmath.nstr(launch * (1 + side * mpmath.mpf(offset)), 40)
            found = model.first_hit(*state)
            assert found.status in (Status.hit, Status.graze, Status.unresolved)
            if found.status == Status.unresolved:
                assert abs(found.depth) < 10 * found.bound
            times[side], truth[side] = float(found.flight_time), model.first_hit(*state, digits=30).flight_time
    for side in (-1, 1):
        if np.isfinite(times[side]):
            allowed = max(1e-14, 40 * 2.0**-52 / np.sqrt(offset))
            assert abs(times[side] / float(truth[side]) - 1) < allowed, (side, float(flight))
    assert abs(float(truth[1]) - float(truth[-1])) > 0.1


def test_no_bound_is_claimed_at_resonance():
    osc = si.ImpactOscillator("x", "sin(t) + sin(3*t)/2", "-0.7", "0.8")
    assert osc.impact_map(0.3, 0.1, horizon=2.0).status == Status.no_return
