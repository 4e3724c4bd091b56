"""A wall that moves, against motions in the frame at rest."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError

G = 9.81


def test_orbits_are_those_in_the_frame_at_rest():
    numbers = {"k": 2, "d": "0.1", "a": "0.3"}
    shaken = si.shaken_wall("k*x + d*xdot + 1/5", "cos(2*t)/2", "a*sin(2*t) - 1/4", "0.7", numbers)
    assert isinstance(shaken.oscillator, si.ImpactOscillator)
    wall, speed = (lambda t: 0.3 * np.sin(2 * t) - 0.25), (lambda t: 0.6 * np.cos(2 * t))

    def falls(t, y):
        return [y[1], np.cos(2 * t) / 2 - 2 * y[0] - 0.1 * y[1] - 0.2]

    def meets(t, y):
        return y[0] - wall(t)

    meets.terminal, meets.direction = True, -1
    t, y = 0.0, [0.5, 0.2]
    relative = shaken.relative(t, *y)
    assert relative == (0.75, pytest.approx(-0.4))
    orbit = shaken.oscillator.orbit(x=relative.x, xdot=relative.xdot, t=t, impacts=5)
    assert set(orbit.kind.tolist()) == {"start", "impact"}
    for k in range(1, 6):
        flight = solve_ivp(falls, (t, t + 30), y, "DOP853", rtol=3e-14, atol=1e-15, events=meets,
                           max_step=0.05, dense_output=True)  # fmt: skip
        times = np.linspace(t, flight.t[-1], 7)[1:-1]
        assert shaken.sample(orbit, times).x == pytest.approx(flight.sol(times)[0], abs=1e-10)
        assert shaken.sample(orbit, times).xdot == pytest.approx(flight.sol(times)[1], abs=1e-10)
        t = flight.t[-1]
        assert orbit.tau[k] == pytest.approx(t, abs=1e-10)
        y = [wall(t), speed(t) - 0.7 * (flight.y[1, -1] - speed(t))]
        place = shaken.back(orbit.tau[k], 0, orbit.v[k])
        assert place == (pytest.approx(y[0], abs=1e-10), pytest.approx(y[1], abs=1e-10))


def test_a_ball_on_a_shaken_table_bounces_once_a_period():
    # cos(omega tau) = pi g (1 - r)/((1 + r) A omega^2): the table throws the ball so that it falls for one period
    r, A, omega = 0.8, 0.1, 8.0
    phase = np.arccos(np.pi * G * (1 - r) / ((1 + r) * A * omega**2)) / omega
    up = np.pi * G / omega  # of the ball, just after the impact
    table = si.shaken_wall("0", "-g0", "A*sin(w*t)", "4/5", {"g0": "9.81", "A": "0.1", "w": 8})
    y, v = table.relative(phase, A * np.sin(omega * phase), up)
    assert y == 0
    step = table.oscillator.impact_map(phase, float(v))
    assert float(step.tau) == pytest.approx(phase + 2 * np.pi / omega, rel=1e-14)
    assert float(step.v) == pytest.approx(float(v), rel=1e-13)
    found = table.oscillator.periodic(1, 1)
    assert any(abs(each.v[0] - v) < 1e-12 and abs(each.tau[0] - phase) < 1e-12 for each in found)


def test_a_ball_locks_where_the_table_falls_slower_than_it():
    # Luck and Mehta: chatter completes, and the ball leaves where A omega^2 sin(omega t) = g
    r, A, omega = 0.5, 0.1, 12.0
    table = si.shaken_wall("0", "-g0", "A*sin(w*t)", "1/2", {"g0": "9.81", "A": "0.1", "w": 12})
    assert A * omega**2 > G
    orbit = table.oscillator.orbit(0.3, 0.1, impacts=200)
    lifted = orbit.tau[orbit.kind == "release"]
    assert lifted.size >= 2
    phases = np.mod(lifted * omega, 2 * np.pi)
    assert phases == pytest.approx(np.full(lifted.size, np.arcsin(G / (A * omega**2))), abs=1e-11)
    assert si.lyapunov(table.oscillator, 0.3, 0.1).superstable
    rest = next(phase for phase in orbit.phases if phase[0] == "sticking")
    inside = np.linspace(rest[1], rest[2], 5)[1:-1]
    assert table.sample(orbit, inside).x == pytest.approx(A * np.sin(omega * inside), abs=1e-15)
    assert table.sample(orbit, inside).xdot == pytest.approx(A * omega * np.cos(omega * inside), abs=1e-14)
    assert r == 0.5


def test_a_wall_at_rest_only_moves_the_clearance():
    moved = si.shaken_wall("x**3 + xdot/10", "cos(2*t)", "c", "0.6", {"c": "0.25"})
    plain = si.ImpactOscillator("x**3 + xdot/10", "cos(2*t)", "0.25", "0.6")
    a, b = moved.oscillator.impact_map(0.3, 1.5), plain.impact_map(0.3, 1.5)
    assert (a.tau, a.v) == pytest.approx((float(b.tau), float(b.v)), rel=1e-13)
    assert moved.back(a.tau).x == 0.25


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (("x", "0", "abs(sin(t))", "1/2"), "is not smooth where abs changes sign"),
        (("x", "0", "x*t", "1/2"), "the symbol 'x' has no value"),
        (("x", "0", "sin(t)", "1/2", {"b": 1}), "unknown parameter 'b'"),
        (("x", "0", "sin(t)", "3/2"), "restitution = '3/2' is not accepted"),
    ],
)
def test_what_cannot_be_written_is_refused_in_a_sentence(given, told):
    with pytest.raises(InputError, match=told):
        si.shaken_wall(*given)
