"""x and x' of orbits at times against scipy and closed forms; sections; the file of events; the text of an orbit."""

from __future__ import annotations

import csv

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.inputs import InputError

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")


def followed(acceleration, clearance, r, state, times):
    """x, x' at times by DOP853 from event to event; an independent orbit from x = clearance."""

    def down(_t, y):
        return y[0] - clearance

    down.terminal, down.direction = True, -1
    t, y, found = times[0], list(state), np.full((times.size, 2), np.nan)
    while t < times[-1]:
        # one short step off the wall, for an event at its start would end it
        done = solve_ivp(lambda s, y: [y[1], acceleration(s, *y)], (t, times[-1]), y, "DOP853", rtol=1e-13, atol=1e-14,
                         events=down, dense_output=True, max_step=0.05)  # fmt: skip
        inside = (times >= t) & (times <= done.t[-1])
        found[inside] = done.sol(times[inside]).T
        t, y = done.t[-1], [clearance, -r * done.y[1, -1]]
    return found


@pytest.mark.parametrize(
    ("osc", "acceleration", "c", "r"),
    [
        (si.linear("2.8", 0, "0.8"), lambda t, x, _u: np.cos(2.8 * t) - x, 0.0, 0.8),
        (si.linear("2.8", "-0.2", "0.8", damping="0.1"), lambda t, x, u: np.cos(2.8 * t) - x - 0.1 * u, -0.2, 0.8),
        (DUFFING, lambda t, x, u: np.cos(1.7 * t) - x - 0.1 * u - 0.3 * x**3, 0.3, 0.6),
    ],
)
def test_samples_of_flights_are_those_of_small_steps(osc, acceleration, c, r):
    orbit = osc.orbit(0.1, 1.5, impacts=8)
    assert set(orbit.kind.tolist()) == {"start", "impact"}
    times = np.linspace(0.1, float(orbit.tau[6]), 400)[:-1]
    path = orbit.sample(times)
    witness = followed(acceleration, c, r, (c, 1.5), times)
    assert np.abs(path.x - witness[:, 0]).max() < 1e-9
    assert np.abs(path.xdot - witness[:, 1]).max() < 1e-9


def ball(t, r=0.5, g=2.0, v=1.0):
    """Height and velocity of a bouncing ball launched with v at 0: closed form within its chatter."""
    k = np.floor(np.log(1 - t * g * (1 - r) / (2 * v)) / np.log(r))
    speed, since = v * r**k, t - 2 * v * (1 - r**k) / (g * (1 - r))
    return speed * since - g * since**2 / 2, speed - g * since


def test_summed_chatter_is_flown_where_it_is_sampled():
    model = si.ImpactOscillator("0", "-2", "0.25", "1/2")
    orbit = model.orbit(0, 1)
    assert orbit.kind.tolist() == ["start", "complete"]
    t = np.array([0.3, 1.2, 1.6, 1.9, 1.99, 1.9999])
    path, (height, speed) = orbit.sample(t), ball(t)
    assert path.x - 0.25 == pytest.approx(height, abs=1e-15)
    assert path.xdot == pytest.approx(speed, abs=1e-14)
    last = orbit.sample([2 - 1e-15, 2.0, 7.0])
    assert last.x.tolist() == [0.25] * 3
    assert np.abs(last.xdot) == pytest.approx(0, abs=4e-15)


def test_chatter_again_and_again_rests_where_the_phases_say():
    orbit = si.linear("0.9", "0.2", "0.4").orbit("0.3", "0.4", impacts=60)
    seen = set()
    for kind, start, end in orbit.phases:
        inside = orbit.sample(start + (end - start) * np.array([0.25, 0.5, 0.75]))
        seen.add(kind)
        if kind == "sticking":
            assert inside.x.tolist() == [0.2] * 3
            assert inside.xdot.tolist() == [0.0] * 3
        elif kind == "flight":
            assert (inside.x > 0.2).all()
        else:
            assert inside.x.max() > 0.2  # the impacts of the sum are flown
    assert seen == {"flight", "chatter", "sticking"}


def test_samples_keep_the_shape_and_know_their_ends():
    osc = si.linear("2.8", 0, "0.8")
    orbit = osc.orbit(0.1, 0.5, impacts=3)
    grid = orbit.sample([[5.0, 0.2], [0.0, 99.0]])
    assert grid.x.shape == (2, 2)
    assert np.isnan(grid.x).tolist() == [[False, False], [True, True]]
    assert grid.x[0, 1] == osc.flight(0.1, 0.5, 0.2 - 0.1).x
    at = orbit.sample(orbit.tau)
    assert at.x.tolist() == [0.0] * 4
    assert at.xdot.tolist() == orbit.v.tolist()
    assert np.ndim(orbit.sample(0.2).x) == 0


def test_a_flight_without_return_is_sampled_to_its_horizon():
    away = si.ImpactOscillator("0", "1", 0, "1/2").orbit(0, 1)
    assert away.phases[-1][0] == "no_return"
    assert away.end == np.inf  # proved
    assert away.sample(10.0) == (60.0, 11.0)
    shown = si.linear(2, "-3", "0.5").orbit(0, 1, horizon=2)
    assert shown.end == 2.0
    assert np.isnan(shown.sample([1.9, 2.1]).x).tolist() == [False, True]


def test_a_section_is_one_state_a_period(tmp_path):
    osc = si.linear(2, "-0.1", "0.8", damping="0.05")
    orbit = osc.orbit(0, 1, impacts=60)
    section = orbit.section("pi/4")
    assert np.diff(section.t) == pytest.approx(np.pi, rel=1e-12)
    assert np.mod(section.t - np.pi / 4 + 1, np.pi) == pytest.approx(1, abs=1e-12)
    assert section.x.tolist() == orbit.sample(section.t).x.tolist()
    assert orbit.section().t[0] == 0.0  # the start is at this phase
    section.to_csv(tmp_path / "s.csv")
    with (tmp_path / "s.csv").open(newline="") as stream:
        table = list(csv.DictReader(stream))
    assert [float(row["xdot"]) for row in table] == section.xdot.tolist()
    with pytest.raises(InputError, match="one with a period: a section has one state a period"):
        si.universal(-1, "0.5").orbit(-1, 1).section()
    with pytest.raises(InputError, match="phase = 'half' is not accepted"):
        orbit.section("half")


def test_events_are_written_whole(tmp_path):
    orbit = si.linear("0.9", "0.2", "0.4").orbit("0.3", "0.4", impacts=60)
    orbit.to_csv(tmp_path / "o.csv")
    with (tmp_path / "o.csv").open(newline="") as stream:
        table = list(csv.DictReader(stream))
    assert [float(row["tau"]) for row in table] == orbit.tau.tolist()
    assert [row["kind"] for row in table] == orbit.kind.tolist()
    with pytest.raises(InputError, match="cannot be written"):
        orbit.to_csv(tmp_path / "none" / "o.csv")


def test_an_orbit_prints_in_few_words():
    text = repr(si.linear("2.8", 0, "0.8").orbit(0.1, 0.5, impacts=1000))
    assert text.count("\n") < 3
    assert "1000 impacts" in text
    assert "all flights asked for were flown" in text
    assert "at rest from there on" in repr(si.ImpactOscillator("0", "-2", 0, "1/2").orbit(0, 1))
