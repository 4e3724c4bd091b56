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


@pytest.mark.parametrize("clearance", ["0.58", "0.605", "-0.3", "0.9"])
def test_a_double_next_to_a_zero_of_a_c_is_that_zero(clearance):
    """At rest a mass leaves from every zero at which a_c rises, whatever the last bit of the double says."""
    model = si.linear("2.8", clearance, "0.5")
    points = si.tangency_points(model)
    for tau, kind in zip(points.tau, points.kind, strict=True):
        for place in (np.nextafter(tau, -10), tau, np.nextafter(tau, 10)):
            if abs(mpmath.mpf(place) - exact_zero(clearance, place)) > np.spacing(place):
                continue
            hit, precise = model.first_hit(place, 0.0), model.first_hit(float(place), 0, digits=30)
            assert hit.status == precise.status == (Status.hit if kind == "gamma" else Status.sticks)
            if kind == "gamma":
                truth = model.first_hit(mpmath.nstr(exact_zero(clearance, place), 45), "1e-60", digits=20).flight_time
                assert abs(precise.flight_time / truth - 1) < 1e-18
                assert abs(hit.flight_time / float(truth) - 1) < 1e-14
                assert model.chatter_limit(place, 0).impacts > 0


def exact_zero(clearance, near):
    """The zero of cos(2.8 t) - c next to a double, in 50 digits."""
    with mpmath.workdps(50):
        return mpmath.findroot(lambda t: mpmath.cos(mpmath.mpf("2.8") * t) - mpmath.mpf(clearance), near, tol=1e-90)


def test_what_is_written_exactly_is_meant_exactly():
    model = si.linear("2.8", "0.58", "0.5")
    tau = float(si.tangency_points(model).tau[1])
    zero = exact_zero("0.58", tau)
    with mpmath.workdps(40):
        before, after = (mpmath.nstr(zero + side * mpmath.mpf("1e-25"), 40) for side in (-1, 1))
    assert model.first_hit(before, 0).status == Status.sticks
    assert model.first_hit(after, 0).status == Status.hit


@pytest.mark.parametrize(
    "omega", ["2", *(pytest.param(each, marks=pytest.mark.slow) for each in ("3", "1/3", "0.1", "5"))]
)
@pytest.mark.parametrize("digits", [None, 25])
def test_a_flight_that_comes_back_to_rest_grazes_after_the_common_period(omega, digits):
    """From a positive swan, of fourth order; from a_c > 0, of second: both touch as they left."""
    model = si.linear(omega, -1, "1/2")
    turns = {"1/3": 3, "0.1": 10}.get(omega, 1)
    for tau in (f"pi/({omega})", np.pi / float(ratio(omega))):
        hit = model.first_hit(tau, 0, digits=digits)
        assert hit.status == Status.graze
        assert abs(hit.flight_time - 2 * np.pi * turns) < 1e-14 * turns
        if digits:
            with mpmath.workdps(30):
                assert abs(hit.flight_time - 2 * mpmath.pi * turns) < mpmath.mpf(10) ** -22


def ratio(text):
    top, _, bottom = text.partition("/")
    return mpmath.mpf(top) / mpmath.mpf(bottom or 1)


@pytest.mark.parametrize("change", ["2*xdot/10**12", "x/10**12"])
def test_without_a_common_period_a_flight_from_a_swan_is_no_graze(change):
    """A little damping or detuning: the touch of fourth order is missed or becomes a hit."""
    model = si.ImpactOscillator(f"x + {change}", "cos(2*t)", -1, "1/2")
    hit = model.first_hit("pi/2", 0, digits=30, horizon=20)
    assert hit.status != Status.graze or abs(hit.flight_time - 2 * np.pi) > 1e-3
