"""Starts off the wall: closed forms, scipy with events, grazes, flights without return; orbits from there."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError
from singimpact.status import Status

BALL = si.ImpactOscillator("0", "-9.81", "0.1", "0.9")
DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")


def by_small_steps(acceleration, clearance, x, u, t, longest=40.0):
    """Time and velocity of the first downward crossing by DOP853; None without one."""

    def wall(_t, y):
        return y[0] - clearance

    wall.terminal, wall.direction = True, -1
    found = solve_ivp(lambda s, y: [y[1], acceleration(s, *y)], (t, t + longest), (x, u), "DOP853", rtol=3e-14,
                      atol=1e-15, events=wall, max_step=0.05)  # fmt: skip
    return (found.t_events[0][0], found.y_events[0][0][1]) if found.t_events[0].size else None


def test_a_ball_dropped_from_a_height():
    # a ball of radius 0.1 whose centre is at 1: it falls by h = 0.9
    first = BALL.launch(x=1, xdot=0, t=0)
    assert first.status == Status.hit
    assert first.flight_time == pytest.approx(np.sqrt(2 * 0.9 / 9.81), rel=4e-16)
    assert first.velocity == pytest.approx(-np.sqrt(2 * 0.9 * 9.81), rel=4e-16)
    assert first.v == pytest.approx(0.9 * np.sqrt(2 * 0.9 * 9.81), rel=4e-16)
    orbit = BALL.orbit(x=1, xdot=0, t=0)
    zeno = np.sqrt(2 * 0.9 / 9.81) * (1 + 0.9) / (1 - 0.9)
    end = orbit.kind.tolist().index("complete")
    assert orbit.tau[end] == pytest.approx(zeno, rel=1e-15)
    assert orbit.phases[-1][0] == "sticking"
    fall = np.linspace(0, 0.4, 9)
    assert orbit.sample(fall).x == pytest.approx(1 - 9.81 * fall**2 / 2, abs=4e-16)
    assert orbit.sample(fall).xdot == pytest.approx(-9.81 * fall, abs=2e-15)
    assert orbit.sample([-0.1, 9.0]).x.tolist()[1] == 0.1


@pytest.mark.parametrize(
    ("osc", "acceleration"),
    [
        (si.linear("2.8", "-0.2", "0.8"), lambda t, x, _u: np.cos(2.8 * t) - x),
        (si.linear(2, "-0.5", "0.8", damping="0.3", phase="0.4"), lambda t, x, u: np.cos(2 * t + 0.4) - x - 0.3 * u),
        (DUFFING, lambda t, x, u: np.cos(1.7 * t) - x - 0.1 * u - 0.3 * x**3),
    ],
)
def test_first_impacts_are_those_of_small_steps(osc, acceleration):
    c = float(str(osc.clearance))
    random = np.random.default_rng(5)
    x, u, t = c + random.uniform(1e-3, 2, 30), random.uniform(-2, 2, 30), random.uniform(0, 6, 30)
    found = osc.launch(x, u, t)
    assert found.tau.shape == (30,)
    for k in range(30):
        truth = by_small_steps(acceleration, c, x[k], u[k], t[k])
        if truth is None:
            assert found.status[k] != Status.hit
            continue
        if abs(truth[1]) < 1e-4:
            continue
        assert found.status[k] == Status.hit
        assert found.tau[k] == pytest.approx(truth[0], abs=1e-11 / abs(truth[1]))
        assert found.velocity[k] == pytest.approx(truth[1], abs=1e-10 / abs(truth[1]))
    one = osc.launch(float(x[0]), float(u[0]), float(t[0]))
    assert (one.tau, one.v) == pytest.approx((found.tau[0], found.v[0]), rel=1e-14)


@pytest.mark.parametrize("osc", [si.linear("2.8", "-0.2", "0.8", damping="0.1"), DUFFING])
def test_a_start_on_a_flight_from_the_wall_meets_its_impact(osc):
    tau, v = 0.3, 1.5
    step = osc.impact_map(tau, v)
    for part in (0.01, 0.3, 0.7, 0.99):
        time = part * float(step.flight_time)
        place = osc.flight(tau, v, time)
        found = osc.launch(place.x, place.xdot, tau + time)
        assert found.tau == pytest.approx(float(step.tau), rel=1e-13)
        assert found.v == pytest.approx(float(step.v), rel=1e-12)


@pytest.mark.parametrize("osc", [si.linear("2.8", "-0.2", "0.8", damping="0.1"), DUFFING])
def test_an_orbit_from_a_flight_is_the_orbit_of_that_flight(osc):
    whole, time = osc.orbit(0.3, 1.5, impacts=6), 0.4
    place = whole.sample(0.3 + time)
    part = osc.orbit(x=place.x, xdot=place.xdot, t=0.3 + time, impacts=6)
    assert part.kind.tolist() == whole.kind.tolist()
    assert part.tau[1:] == pytest.approx(whole.tau[1:], rel=1e-11)
    t = np.linspace(0.3 + time, float(whole.tau[3]), 50)[:-1]
    assert part.sample(t).x == pytest.approx(whole.sample(t).x, abs=1e-11)
    assert part.sample(t).xdot == pytest.approx(whole.sample(t).xdot, abs=1e-11)
    axes = si.plot(part)
    assert axes.lines[0].get_ydata()[0] == pytest.approx(float(place.x), abs=1e-15)


@pytest.mark.slow
def test_grazes_are_decided():
    rising = si.ImpactOscillator("0", "2", 0, "1/2")  # x = 1 + u t + t^2 touches 0 for u = -2
    below, exact, above = (rising.launch(1, u, 0) for u in (-2 - 1e-9, -2, -2 + 1e-9))
    assert below.status == Status.hit
    assert below.flight_time == pytest.approx(1 - np.sqrt(1e-9 + 2.5e-19), rel=1e-7)
    assert (exact.status, exact.flight_time, exact.v) == (Status.graze, 1.0, 0.0)
    assert above.status == Status.escaped
    assert np.isinf(above.tau)
    # two roots within 1e-7 of each other, at a touching free oscillation of amplitude 1 about 0
    swing = si.ImpactOscillator("x", "0", -1, "1/2", period=1)
    shallow = swing.launch("1 + 1e-14", 0, 0)
    assert shallow.status == Status.hit
    assert shallow.flight_time == pytest.approx(np.pi, abs=3e-7)
    assert swing.launch("1 - 1e-14", 0, 0).status in (Status.no_return, Status.escaped)


def test_flights_without_return_are_said():
    away = si.ImpactOscillator("0", "1", 0, "1/2").launch(1, 0, 0)
    assert (away.status, away.flight_time) == (Status.escaped, np.inf)
    assert np.isnan(away.v)
    assert "never to return" in away.sentence
    late = BALL.launch(1, 0, 0, horizon="0.2")
    assert late.status == Status.no_return
    orbit = BALL.orbit(x=1, xdot=0, t=0, horizon="0.2")
    assert orbit.end == 0.2
    assert np.isnan(orbit.sample([0.1, 0.3]).x).tolist() == [False, True]


def test_starts_on_the_wall_are_those_of_the_impact_map():
    osc = si.linear("2.8", 0, "0.8")
    step = osc.impact_map(0.3, 1.5)
    found = osc.launch([0, 0], [1.5, -1.5], 0.3)
    assert (found.tau[0], found.v[0]) == (step.tau, step.v)
    assert (found.tau[1], found.v[1]) == (0.3, 0.8 * 1.5)
    orbit = osc.orbit(x=0, xdot=-1, t=0, impacts=2)
    assert orbit.tau[:2].tolist() == [0.0, 0.0]
    assert orbit.v[:2].tolist() == [-1.0, 0.8]


def test_a_law_of_restitution_is_used():
    osc = si.ImpactOscillator("0", "-2", 0, "-0.8*v + 0.1*v**2")
    assert osc.launch(4, 0, 0).v == pytest.approx(0.8 * 4 + 0.1 * 16, rel=1e-15)


def test_bad_input_is_refused_in_a_sentence():
    with pytest.raises(InputError, match=r"x = 0 is not accepted: give places at or above the wall, x >= 0\.1"):
        BALL.launch(0, 0, 0)
    with pytest.raises(InputError, match="give shapes that broadcast"):
        BALL.launch([1, 2], [1, 2, 3], 0)
    with pytest.raises(InputError, match="an orbit starts from tau and v, or off the wall"):
        BALL.orbit(x=1, xdot=0)
    with pytest.raises(InputError, match="an orbit starts from tau and v, or off the wall"):
        BALL.orbit(0, 1, x=1, xdot=0, t=0)
    with pytest.raises(InputError, match="an orbit starts from one state, give three numbers"):
        BALL.orbit(x=[1, 2], xdot=0, t=0)
    with pytest.raises(InputError, match="xdot"):
        BALL.launch(1, "fast", 0)
