"""Transitions of P over a number: swans where they are known, swallowtails beside them, lips by what is born."""

import numpy as np
import pytest

import singimpact as si
from singimpact.inputs import InputError
from singimpact.surface.impact_surface import ImpactSurface
from singimpact.surface.transitions import swan_curves, transitions

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(w*t)", "0.3", "0.6", parameters={"w": "1.7"})


def test_swans_of_the_linear_oscillator_over_the_clearance():
    found = transitions(si.linear(2, "0.3", "0.5"), "clearance", ("-1.2", "1.2"), (-3, 3))
    swans = [each for each in found if each.kind.startswith("swan")]
    assert [each.kind for each in swans] == ["swan, positive", "swan, negative"]
    assert np.abs([swans[0].value + 1, swans[1].value - 1, swans[0].tau - np.pi / 2, swans[1].tau]).max() < 1e-10


def test_swallowtails_are_the_crossings_of_the_flight_from_the_swan():
    found = transitions(DUFFING, "clearance", ("0.7", "0.95"))
    swan = next(each for each in found if each.kind.startswith("swan"))
    tails = [each for each in found if each.kind == "swallowtail"]
    assert len(tails) == 3
    assert {each.value for each in tails} == {swan.value}
    model = DUFFING.replace(clearance=swan.value)
    assert all(abs(float(model.flight(swan.tau, 0, each.t).x) - swan.value) < 1e-9 for each in tails)


def test_a_piece_of_z_is_born_in_the_lips_that_are_found():
    (lips,) = [each for each in transitions(DUFFING, "w", ("1.9", "2.2")) if each.kind in ("lips", "beaks")]
    assert lips.kind == "lips"
    pieces = []
    for shift in (-2e-5, 2e-5):
        model = DUFFING.replace(w=lips.value + shift)
        window = (lips.tau - 0.4, lips.tau + 0.4), (lips.t - 0.4, lips.t + 0.4)
        pieces.append(sum(curve.closed for curve in ImpactSurface(model, *window).zero_set))
    assert sorted(pieces) == [0, 1]


def test_curves_of_swan_points_over_two_numbers():
    """f(c) = max of g: c + 0.3 c^3 = 1 whatever w; over the height h of the forcing c + 0.3 c^3 = h."""
    model = si.ImpactOscillator("x + 0.3*x**3", "h*cos(w*t)", 0, "0.6", parameters={"w": "1.7", "h": 1})
    (level,) = swan_curves(model, ("clearance", "w"), ((0, 2), (1, 2)))
    assert np.abs(level.points[:, 0] + 0.3 * level.points[:, 0] ** 3 - 1).max() < 1e-12
    curves = swan_curves(model, ("h", "clearance"), (("0.2", "2"), ("0.3", "0.9")))
    points = max(curves, key=len).points
    assert np.abs(points[:, 0] - points[:, 1] - 0.3 * points[:, 1] ** 3).max() < 1e-12
    assert len(points) > 40


@pytest.mark.parametrize(
    ("ask", "told"),
    [
        (lambda: transitions(DUFFING, "q", (0, 1)), "q"),
        (lambda: transitions(DUFFING, "w", (2, 1)), "two numbers"),
        (
            lambda: transitions(si.ImpactOscillator("k*x", "t**2 - 1", 0, "0.5", parameters={"k": 1}), "k", (1, 2)),
            "not seen to be periodic",
        ),
    ],
)
def test_refusals(ask, told):
    with pytest.raises(InputError, match=told):
        ask()
