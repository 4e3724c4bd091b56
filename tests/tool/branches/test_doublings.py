"""Cascades of period doublings, beside a bouncing ball that shares no code with the package."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import singimpact as si

RESTITUTION = 0.5
FEIGENBAUM = 4.669201609
BALL = si.ImpactOscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.4"})
WALLS = si.linear("2.8", "-0.5", "0.8", upper="0.7", amplitude=4)


@pytest.fixture(scope="module")
def found():
    return si.cascade(si.branch(BALL.periodic(1, 1)[1], "G", (1.2, 2)), doublings=5)


def next_impact(G, tau, v):
    """The next impact of a ball that begins at x = 0, by a search for the first sign change of its height."""

    def height(s):
        return (v + G * math.sin(-tau)) * s - s * s / 2 - G * (math.cos(tau + s) - math.cos(tau))

    step = 0.05
    s = step if v > 0.2 else 1e-3
    while height(s + step) > 0:
        s += step
    s = brentq(height, s, s + step, xtol=1e-14)
    arrived = v - s + G * (math.sin(tau + s) - math.sin(tau))
    return tau + s, -RESTITUTION * arrived


def period_of(G, tau, v, most=32):
    """The number of impacts after which the orbit that a state settles on repeats; 0 where it is more."""
    for _ in range(3000):
        tau, v = next_impact(G, tau, v)
    first = v
    for n in range(1, most + 1):
        tau, v = next_impact(G, tau, v)
        if abs(v - first) < 1e-7:
            return n
    return 0


def test_between_doublings_a_ball_repeats_after_twice_as_many_impacts(found):
    assert [int(event.orbit.n) for event in found.events] == [1, 2, 4, 8, 16]
    for doubling, following, n in zip(found.events, found.parameter[1:], (2, 4, 8, 16), strict=False):
        at = (doubling.parameter + following) / 2
        tau, v = float(doubling.orbit.tau[0]), float(doubling.orbit.v[0])
        assert period_of(at, tau, v) == n
        # beyond the next doubling, by an eighth of the distance, it does not
        assert period_of(following + (following - doubling.parameter) / 8, tau, v) != n


def test_the_first_doubling_has_a_closed_form_and_the_ratios_tend_to_feigenbaum(found):
    r = RESTITUTION
    first = math.hypot(math.pi * (1 - r) / (1 + r), 2 * (1 + r**2) / (1 + r) ** 2)
    assert found.parameter[0] == pytest.approx(first, rel=1e-11)
    assert np.abs(found.ratios / FEIGENBAUM - 1)[-1] < 5e-3
    assert found.limit == pytest.approx(1.70493189, abs=3e-6)
    assert "as many as asked for: 5" in repr(found)


def test_a_cascade_goes_on_from_any_of_its_doublings(found):
    again = si.cascade(found.events[1], doublings=2)
    np.testing.assert_allclose(again.parameter, found.parameter[1:3], rtol=1e-10)
    assert np.isnan(again.limit)
    assert np.isnan(again.ratios).all()


def test_a_cascade_between_walls_ends_where_orbits_become_virtual():
    (start, *_) = WALLS.periodic("lu", 1)
    short = si.cascade(si.branch(start))
    assert [int(event.orbit.n) for event in short.events] == [2, 4, 8]
    assert short.note.startswith("the (16, 8) orbits are virtual where they double")
    assert all(event.orbit.visible for event in short.events)


def test_a_doubling_with_no_coefficient_ends_a_cascade():
    resonant = si.linear(2, 0, "0.7")  # the flights between impacts of (1, 1) orbits last a whole period of x'' + x = 0
    (doubled,) = si.cascade(si.branch(resonant.periodic(1, 1)[0])).events
    assert doubled.criticality == "degenerate"


def test_tables_have_a_row_a_doubling(found):
    table = found.table()
    assert table["n"].tolist() == [1, 2, 4, 8, 16]
    assert np.isnan(table["ratios"][:2]).all()
    np.testing.assert_allclose(table["ratios"][2:], FEIGENBAUM, rtol=0.02)


@pytest.mark.parametrize("start", [3, si.branch(BALL.periodic(1, 1)[1], "G", (1.38, 1.42))])
def test_what_has_no_doubling_is_refused(start):
    with pytest.raises(si.InputError, match=r"^start = .* is not accepted: give a period doubling of orbits"):
        si.cascade(start)


def test_numbers_of_doublings_are_checked(found):
    with pytest.raises(si.InputError, match="doublings"):
        si.cascade(found.events[0], doublings=0)
