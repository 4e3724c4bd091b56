"""Windows in which the released orbit rests: beside closed forms, scipy, and the border orbits that bound them."""

import math
import pickle

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import singimpact as si
from singimpact.inputs import InputError

BALL = si.ImpactOscillator("1", "G*sin(t)", 0, "1/2", {"G": "19/10"})
PLATEAU = (1.893700796003, 1.939751233691)  # border orbits at both ends of the window of five periods


def rests_after(G, r):
    """Periods from the release to the first lift-off after rest, of a ball on a table, by its motion in closed form."""
    release = math.asin(1 / G)

    def height(t, start, v):
        s = t - start
        return v * s - s**2 / 2 + G * (math.sin(start) + math.cos(start) * s - math.sin(t))

    start, v = release, 0.0
    while start < release + 40 * np.pi:
        pull = G * math.sin(start) - 1
        # while the table presses a flight is over after about 2 v/|a|
        step = min(0.05, v / abs(pull) / 4) if v else 0.05
        t = start + step
        while height(t, start, v) > 0:
            t += step
        if v < 1e-6 and pull < -1e-2:
            return math.ceil((start - release) / (2 * np.pi))
        end = brentq(height, t - step, t, (start, v), xtol=1e-14)
        start, v = end, -r * (v - (end - start) + G * (math.cos(start) - math.cos(end)))
    return None


def covers(windows, value):
    return any(one.low <= value <= one.high for one in windows)


def test_all_orbits_of_the_windows_of_a_ball_rest_as_they_say():
    found = si.resting_windows(BALL, "G", ("1.9", "1.94"), pieces=100, periods=8)
    assert 0.9 < found.share < 1
    (widest,) = (one for one in found if one.high - one.low > 1 / 50)
    assert widest.periods == 5
    assert widest.release == 0
    assert found.as_dict()["windows"][0].keys() == {"low", "high", "release", "periods"}
    assert pickle.loads(pickle.dumps(found)).share == found.share
    rng = np.random.default_rng(1)
    for G in rng.uniform(float(widest.low), float(widest.high), 12):
        assert rests_after(G, 0.5) == 5
    # the closed form tells windows apart: beyond the border orbit others rest at other times
    assert rests_after(2.55, 0.5) != 5


def test_no_window_reaches_a_border_orbit():
    for value in PLATEAU:
        ends = value - 1e-5, value + 1e-5
        found = si.resting_windows(BALL, "G", [f"{end:.9f}" for end in ends], pieces=40)
        assert len(found)
        assert not covers(found, value)
        assert found.share < 1
        # one side of it rests after five periods, up to a tenth of this interval
        near = min(abs(float(end) - value) for one in found if one.periods == 5 for end in (one.low, one.high))
        assert near < 2e-6


@pytest.mark.parametrize(
    ("over", "between"), [("clearance", ("0.62", "0.8")), ("restitution", ("0.4", "0.6")), ("omega", ("2.75", "2.85"))]
)
def test_windows_over_any_number(over, between):
    """Of x'' + x = cos(omega t): drawn members, flown by scipy to the time at which they are said to be released."""
    osc = si.ImpactOscillator("x", "cos(omega*t)", "0.7", "1/2", {"omega": "2.8"})
    found = si.resting_windows(osc, over, between, pieces=100)
    assert found.share > 0.9
    rng = np.random.default_rng(2)
    for one in found:
        value = rng.uniform(float(one.low), float(one.high))
        numbers = {"clearance": 0.7, "restitution": 0.5, "omega": 2.8} | {over: value}
        assert at_rest_before_release(numbers, one.periods)


def at_rest_before_release(numbers, periods):
    """Whether the released mass is at the wall at last, some time before a_c rises through zero again."""
    c, r, omega = numbers["clearance"], numbers["restitution"], numbers["omega"]
    release = (2 * np.pi - math.acos(c)) / omega
    start, v, last = release + 1e-9, 1e-18, release + periods * 2 * np.pi / omega

    def hit(_t, y):
        return y[0] - c

    hit.terminal, hit.direction = True, -1
    while start < last:
        flown = solve_ivp(
            lambda t, y: [y[1], math.cos(omega * t) - y[0]],
            (start, last),
            [c + 1e-14, v],
            events=hit,
            rtol=1e-11,
            atol=1e-14,
            max_step=0.02,
        )
        if flown.status != 1:
            return False
        start, v = flown.t[-1], -r * flown.y[1, -1]
        if v < 1e-4:
            # what is left of the chatter is less than 2 v/(|a_c| (1 - r))
            pull = c - math.cos(omega * start)
            return pull > 0 and start + 4 * v / (pull * (1 - r)) < last
    return False


def test_flights_from_other_phases_and_long_waits_are_left_open():
    """r = 0.95 at which chatter takes long: nothing is said within one period, and nothing wrong."""
    found = si.resting_windows(BALL.replace(restitution="0.95"), "G", ("1.9", "1.901"), periods=1, pieces=4)
    assert found.share == 0
    assert not found


def test_where_a_swan_takes_the_release_away_nothing_is_said():
    """At c = 1 the arc in which a_c > 0 vanishes; next to it the hop is short and rests."""
    found = si.resting_windows(si.linear("2.8", "0.7", "1/2"), "clearance", ("0.98", "1.01"), pieces=300)
    assert found[0].high > 0.99
    assert found[-1].high < 1


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"osc": BALL.replace(restitution=1)}, "restitution"),
        ({"osc": si.ImpactOscillator("1", "t**3", 0, "1/2")}, "one with a period"),
        ({"over": "mass"}, "mass"),
        ({"osc": si.linear("2.8", 0, "1/2"), "over": "clearance", "between": ("1.5", "1.6")}, "rises through zero"),
        ({"between": (2, 1)}, "low < high"),
        ({"between": ("1.9", "1.9")}, "low < high"),
        ({"pieces": 0}, "pieces"),
        ({"periods": 0}, "periods"),
    ],
)
def test_what_is_refused(change, words):
    given = {"osc": BALL, "over": "G", "between": ("1.9", "1.91")} | change
    with pytest.raises(InputError, match=words):
        si.resting_windows(**given)
