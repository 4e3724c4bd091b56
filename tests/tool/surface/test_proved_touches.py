"""That no lips, beaks or swallowtail of a linear model is missing: by balls, against what the grid meets."""

from __future__ import annotations

import numpy as np
import pytest

import singimpact as si
from singimpact.algebra.isolated_zeros import isolated_zeros
from singimpact.paper import damped
from singimpact.surface import Family, RestFlight, RestFlights, Transitions, doubts_left, rest_flight, transitions

pytestmark = pytest.mark.slow  # seconds together: .ci/check runs them

DAMPED = si.ImpactOscillator("x + 0.1*xdot", "cos(2.8*t)", 0, "0.8")
WINDOW = ((-0.14, 0.14), (-6.0, 6.0))
OUTLINE = ("swan", "swallowtail", "tangency")
"""The kinds of which balls show that none is missing."""


@pytest.fixture(scope="module")
def four() -> Transitions:
    return transitions(DAMPED, "clearance", *WINDOW, OUTLINE)


def test_two_lips_and_two_beaks_are_all(four):
    assert sorted(each.kind for each in four) == ["beaks", "beaks", "lips", "lips"]
    assert four.swans_complete
    assert four.complete
    assert four.doubts == ()


@pytest.mark.parametrize("left_out", range(4))
def test_one_that_the_list_lacks_is_said(four, left_out):
    missing = four[left_out]
    (doubt,) = doubts_left(Family(DAMPED, "clearance"), *WINDOW, [each for each in four if each is not missing])
    assert f"lacks lips or beaks at clearance = {missing.value:.12g}" in doubt


def test_all_three_kinds_of_figure_2():
    """Lips and beaks over the rate, a swallowtail over the clearance; the same window with one of them left out."""
    over_rate = transitions(damped(), "w", (1.9, 2.3), (0, 8), OUTLINE)
    assert {each.kind for each in over_rate} == {"lips", "beaks"}
    assert over_rate.doubts == over_rate.notes  # of the period, which moves with w
    over_clearance = transitions(damped(), "clearance", (0.9, 1.1), (-8, 8), OUTLINE)
    tail = next(each for each in over_clearance if abs(each.t - 5.1927096149235386) < 1e-12)
    assert tail.kind == "swallowtail"
    assert over_clearance.complete
    (doubt,) = doubts_left(
        Family(damped(), "clearance"), (0.9, 1.1), (-8.0, 8.0), [each for each in over_clearance if each is not tail]
    )
    assert "lacks a swallowtail at clearance = 1, t = 5.19271" in doubt


@pytest.mark.parametrize(
    ("f", "g"),
    [("x + 0.1*xdot", "cos(2.8*t) + 1/3"), ("2*x + 3*xdot", "cos(t)"), ("x + 2*xdot", "cos(t) + sin(3*t)/4"),
     ("-x", "cos(2*t + 1)"), ("x", "cos(2.8*t)")],
)  # fmt: skip
def test_the_closed_form_is_the_motion(f, g):
    """Underdamped, overdamped, critical and repelling models against flights in Taylor steps."""
    osc = si.ImpactOscillator(f, g, "0.1", "0.5")
    flight = rest_flight(Family(osc, "clearance"))
    from singimpact.algebra import DOUBLES, evaluate

    tau, t = np.array([0.3, 1.1, 2.0]), np.array([0.7, 2.5, -1.2])
    x, v = RestFlights(osc).ends(tau, t)
    for tree, wanted in zip(flight.heights, (x, v), strict=False):
        found = [evaluate(tree, {"tau": a, "t": b, "clearance": 0.1}, DOUBLES) for a, b in zip(tau, t, strict=True)]
        assert np.abs(np.array(found) - wanted).max() < 1e-11 * (1 + np.abs(wanted).max())


def test_next_to_the_launch_boxes_are_decided_by_the_third_and_fourth_derivative_alone():
    """At t = 0 every tangency point solves the equations: without Rolle's theorem the boxes there stay open."""
    flight = rest_flight(Family(DAMPED, "clearance"))
    period = float(2 * np.pi / 2.8)
    assert flight.touches(period, (0.1, 0.14), (-1.0, 1.0)).complete
    blind = RestFlight(flight.over, flight.push, (*flight.heights[:3], *(flight.push,) * 2))
    assert not blind.touches(period, (0.1, 0.14), (-1.0, 1.0)).complete


def test_what_is_not_proved_is_said():
    # a forcing without a period has transitions too, and nothing is proved of them
    polynomial = transitions(si.ImpactOscillator("x", "t**2 - t**3/3", 0, "0.5"), "clearance", (-0.2, 0.2), (-1, 1))
    assert polynomial.swans_complete
    assert not polynomial.complete
    assert "met on a grid" in polynomial.doubts[0]
    assert transitions(si.ImpactOscillator("x", 1, 0, "0.5"), "clearance", (-0.2, 0.2), (-1, 1), OUTLINE).complete
    # both ends of this flight are tangency points at one value: the equations are not independent there
    undamped = transitions(si.linear("2.8", 0, "0.8"), "clearance", (-0.14, 0.14), (-6, 6))
    assert "lips and beaks for clearance from -0.0461688" in undamped.doubts[0]
    assert rest_flight(Family(si.ImpactOscillator("x", "cos(t)", 0, 1), "clearance")) is None  # resonance
    assert rest_flight(Family(si.ImpactOscillator("k*x", "cos(2*t)", 0, "0.5", {"k": 1}), "k")) is None


def test_a_system_whose_zeros_are_known():
    from fractions import Fraction

    from singimpact.algebra import parse

    names, side = ("x", "y", "z"), (Fraction(-2), Fraction(2))
    trees = [parse(text, names) for text in ("x**2 + y**2 + z**2 - 3", "x*y - z", "x - y")]
    made = isolated_zeros(trees, names, (side,) * 3)
    wanted = [(1, 1, 1), (-1, -1, 1)]
    assert made.complete
    assert sorted(tuple(round(float(part.mid())) for part in zero) for zero in made.found) == sorted(wanted)
    assert all(part.rad() < 1e-30 for zero in made.found for part in zero)
    double = isolated_zeros([parse("x**2 - 2*x + 1", ["x"])], ("x",), (side,))
    assert not double.complete
    assert double.found == ()
