"""Lips, beaks and swallowtails of nonlinear models, all of them: boxes of flights against doubles and closed forms."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import flint
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import singimpact as si
from singimpact.algebra import Balls, balls_at, series_of_any_length
from singimpact.surface import (
    EnclosedTouches,
    Family,
    FlightFromRest,
    Tangencies,
    boxes_from_rest,
    outline_transitions as transitions_room,
    proved_touches,
    rest_flight,
    transitions,
)

DUFFING = si.ImpactOscillator("x + 0.1*xdot + x**3/10", "cos(2.8*t)", 0, "0.8")
DAMPED = si.ImpactOscillator("x + 0.1*xdot", "cos(2.8*t)", 0, "0.8")
PERIOD = float(2 * np.pi / 2.8)
WINDOW = ((0.035, 0.055), (2.0, 4.0))
OUTLINE = ("swan", "swallowtail", "tangency")
"""The kinds of which balls show that none is missing."""
STRONG = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")


def flown(tau, t, clearance):
    """x - c and x' of the Duffing oscillator at t, by scipy."""

    def moving(s, state):
        x, v = state
        return [v, np.cos(2.8 * s) - x - 0.1 * v - x**3 / 10]

    end = solve_ivp(moving, (tau, tau + t), [clearance, 0.0], "DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    return end[0] - clearance, end[1]


@pytest.mark.slow
def test_lips_and_beaks_of_a_duffing_oscillator_are_all():
    found = transitions(DUFFING, "clearance", *WINDOW, OUTLINE)
    assert sorted(each.kind for each in found) == ["beaks", "lips"]
    for each in found:
        assert np.abs(flown(each.tau, each.t, each.value)).max() < 1e-10
    assert found.doubts == ()
    assert found.complete


@pytest.mark.slow
def test_one_that_the_search_by_doubles_loses_is_said(monkeypatch):
    search = transitions_room._touches

    def losing(*given):
        return (each for each in search(*given) if each.kind != "lips")

    monkeypatch.setattr(transitions_room, "_touches", losing)
    found = transitions(DUFFING, "clearance", *WINDOW, OUTLINE)
    assert [each.kind for each in found] == ["beaks"]
    assert not found.complete
    (doubt,) = found.doubts
    assert "the list lacks lips or beaks at clearance = 0.0511908" in doubt


@pytest.mark.slow
def test_swallowtails_on_both_sides_of_the_launch_are_all(monkeypatch):
    window = "clearance", (0.82, 0.84), (-5, 5), OUTLINE
    found = transitions(STRONG, *window)
    assert [each.kind for each in found] == ["swallowtail", "swan, negative", "swallowtail"]
    assert found.complete
    search = transitions_room._crossings
    monkeypatch.setattr(transitions_room, "_crossings", lambda *given: [t for t in search(*given) if t > 0])
    (doubt,) = transitions(STRONG, *window).doubts
    assert "lacks a swallowtail at clearance = 0.829051381194, t = -4.42443" in doubt


@pytest.mark.slow
def test_boxes_of_a_linear_model_give_what_the_closed_form_gives():
    """Both sides of the launch; the same zeros from two programs that share no motion."""
    window = (0.03, 0.05), (-4.0, 4.0)
    boxes = EnclosedTouches(DAMPED, "clearance").touches(PERIOD, *window)
    closed = rest_flight(Family(DAMPED, "clearance")).touches(PERIOD, *window)
    assert boxes.complete
    assert closed.complete
    inside = [zero for zero in closed.found if 0.03 < float(zero[2].mid()) < 0.05 and abs(float(zero[1].mid())) < 4]
    assert len(boxes.found) == len(inside) == 2
    for zero in inside:
        assert any(all(a.overlaps(b) for a, b in zip(zero, other, strict=True)) for other in boxes.found)


@pytest.mark.slow
def test_next_to_the_launch_boxes_are_decided_by_the_third_and_fourth_derivative_alone(monkeypatch):
    """At t = 0 every tangency point solves the equations: without Rolle's theorem the boxes there stay open."""
    flights, short = EnclosedTouches(DUFFING, "clearance"), ((0.1, 0.14), (-0.5, 0.5))
    assert flights.touches(PERIOD, *short).complete
    monkeypatch.setattr(boxes_from_rest._NearLaunch, "__bool__", lambda _: False)
    blind = flights.touches(PERIOD, *short)
    assert not blind.complete


@pytest.mark.slow
def test_what_balls_cannot_decide_ends_soon_and_is_said():
    """Without damping both ends of the flight from rest are tangency points: the equations are not independent."""
    undamped = si.ImpactOscillator("x + x**3/10", "cos(2.8*t)", 0, "0.8")
    made = EnclosedTouches(undamped, "clearance").touches(PERIOD, (0.052, 0.0532), (3.0, 4.0))
    assert not made.complete
    assert made.looked_at < proved_touches.SETTINGS.most


def test_too_few_boxes_are_no_proof(monkeypatch):
    monkeypatch.setattr(proved_touches, "SETTINGS", replace(proved_touches.SETTINGS, most=10))
    assert not EnclosedTouches(DUFFING, "clearance").touches(PERIOD, *WINDOW).complete


def test_members_of_a_box_lie_where_it_says():
    """Launches with a_c = 0 in a box, one by one, by scipy; and the higher derivatives against differences."""
    tau, value = (Balls(48).interval(Fraction(low), Fraction(low) + Fraction(1, 64)) for low in (0.53, 0.047))
    with balls_at(48), series_of_any_length():
        of = Tangencies(DUFFING, "clearance")
        lean = of.lean(tau, value)
        flight = FlightFromRest(of, tau, value, 24, lean)
        met = flight.at(flint.arb(3))
        whole = FlightFromRest(of, tau, value, 24).at(flint.arb(3))
    assert met.height.rad() < whole.height.rad()
    count = 0
    for clearance in np.linspace(0.047, 0.047 + 1 / 64, 9):
        start = np.arccos(clearance + clearance**3 / 10) / 2.8
        if 0.53 <= start <= 0.53 + 1 / 64:
            count += 1
            height, speed = flown(start, 3.0, clearance)
            assert met.height.contains(height)
            assert met.speed.contains(speed)
    assert count > 2
    # x'' = a at the launch from rest, then a' - a/10 and a'' - (1 + 3 c^2/10) a - (the third)/10
    at, zero = flint.arb(0.537), flint.arb(0)
    with balls_at(48):
        third, fourth = FlightFromRest(of, at, flint.arb(0.0545), 24).higher(zero, zero, zero)
    push = np.cos(2.8 * 0.537) - 0.0545 - 0.0545**3 / 10
    wanted = -2.8 * np.sin(2.8 * 0.537) - push / 10
    assert abs(float(third.mid()) - wanted) < 1e-12
    bend = -(2.8**2) * np.cos(2.8 * 0.537) - (1 + 0.3 * 0.0545**2) * push
    assert abs(float(fourth.mid()) - (bend - wanted / 10)) < 1e-12
