"""Second derivatives of G over boxes: closed forms and differences of D G lie in them."""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction
from itertools import product as pairs

import pytest

import singimpact as si
from singimpact.algebra import Balls, balls_at, constant
from singimpact.flights import Launch, Refused, certified_hit, jet_hit
from singimpact.flights.enclosures import jet_flight

HORIZON = Fraction(100)
STEP = Fraction(1, 10**8)
TINY = Fraction(1, 10**30)
MODELS = {
    "duffing": (("x + 0.1*xdot + 0.3*x**3", "A*cos(w*t)", "0.3", "0.6", {"w": "1.7", "A": 1}), ("1.9", "0.7")),
    "law": (("x + xdot**3/5", "A*cos(w*t)", "0.1", "-0.9*v + v**2/50", {"w": "2.1", "A": "1.1"}), ("0.4", "0.5")),
    "weak": (("sin(x) + 0.2*xdot", "A*cos(w*t) - 1/5", "0.2", "0.7", {"w": "1.3", "A": "0.4"}), ("0.6", "0.001")),
}


def box(state, name, radius):
    tau, v = (constant("state", part) for part in state)
    return Launch(tau, v, 1, {"tau": radius, "v": radius, name: radius})


def moved(osc, state, name, index, shift):
    """D G, columns tau, v and the number, where one of the three is another number."""
    tau, v = (Fraction(part) for part in state)
    tau, v = tau + shift * (index == 0), v + shift * (index == 1)
    if index == 2:
        now = osc.parameters[name] if name in osc.parameters else getattr(osc, name)
        osc = osc.replace(**{name: now.value + shift})
    return certified_hit(osc, box((tau, v), name, TINY), 30, HORIZON, derivative=True).derivative


def differences(osc, state, name):
    """The second derivatives [row][i][j] by differences of D G: their error is about STEP^2."""
    found = []
    for index in range(3):
        low, high = (moved(osc, state, name, index, shift) for shift in (-STEP, STEP))
        found.append([[(b - a) / Balls(200).rational(2 * STEP) for a, b in zip(*rows, strict=True)]
                      for rows in zip(low, high, strict=True)])  # fmt: skip
    return found


def far_off(osc, state, name, radius=Fraction(1, 10**13)):
    """The largest error of a second derivative, in parts of it, where its ball does not meet the difference."""
    with balls_at(200):
        truth = differences(osc, state, name)
        hit = jet_hit(osc, box(state, name, radius), HORIZON)
        worst = 0.0
        for j, row, i in pairs(range(3), (0, 1), (0, 1)):
            ball = hit.along(tuple(int(k == j) for k in range(3)))[row][i]
            right = float(truth[j][row][i].mid())
            assert ball.rad() < 1e-3 * (1 + abs(right))
            worst = max(worst, (abs(float(ball.mid()) - right) - float(ball.rad())) / (1 + abs(right)))
        return worst


@pytest.mark.parametrize("which", sorted(MODELS))
def test_they_are_the_differences_of_d_g(which):
    model, state = MODELS[which]
    osc = si.ImpactOscillator(*model)
    for name in ("A", "w", "clearance"):
        assert far_off(osc, state, name) < 1e-9


def test_they_are_those_of_the_bouncing_ball():
    """x'' = -g: T = 2 v/g and v' = r v, for all numbers of a wide box."""
    osc = si.ImpactOscillator("g", "0", 0, "1/2", {"g": 2})
    wide = Fraction(1, 10)
    hit = jet_hit(osc, box(("1", "3"), "g", wide), HORIZON)
    (by_tau, by_v), (after_tau, after_v) = hit.along((0, 0, 1))
    for v, g in pairs((2.9, 3, 3.1), (1.9, 2, 2.1)):
        assert by_v.contains(-2 / g**2)
        assert hit.slopes()[0][2].contains(-2 * v / g**2)
    assert by_tau.contains(0)
    assert after_tau.contains(0)
    assert after_v.contains(0)
    by_r = jet_hit(osc, box(("1", "3"), "restitution", wide), HORIZON)
    assert by_r.along((0, 0, 1))[1][1].contains(1)
    assert by_r.slopes()[1][2].contains(3)


def test_a_narrow_box_lies_in_a_wide_one():
    model, state = MODELS["duffing"]
    osc = si.ImpactOscillator(*model)
    narrow, wide = (jet_hit(osc, box(state, "A", Fraction(1, 10**k)), HORIZON) for k in (9, 4))
    for one, other in zip(narrow.jets, wide.jets, strict=True):
        for part, around in zip(one, other, strict=True):
            assert around.contains(part)


@pytest.mark.parametrize(
    ("room", "name", "wrong"),
    [
        (jet_flight, "factorial", lambda _: 1),
        (jet_flight, "response", lambda by_x, by_v, driven, start: _free(by_x, by_v, driven, start)),
        (jet_flight, "quotient", lambda one, other: [part / other[0] for part in one]),
    ],
)
def test_wrong_derivatives_are_seen(room, name, wrong, monkeypatch):
    """f_xx/2 taken as f_xx, a force that does not bend, a quotient of the first order."""
    monkeypatch.setattr(room, name, wrong)
    model, state = MODELS["duffing"]
    with suppress(Refused):  # the bound of the defect is too wide for any step
        assert far_off(si.ImpactOscillator(*model), state, "A") > 1e-6


def _free(by_x, by_v, driven, start):
    from singimpact.flights.enclosures.taylor_step import response

    return response(by_x, by_v, [0 * part for part in driven], start)


def test_wrong_coefficients_are_within_the_bound_of_their_defect(monkeypatch):
    """The Taylor coefficients are not trusted: with a part left out the ball is wide, and holds the truth."""
    model, state = MODELS["duffing"]
    osc, honest = si.ImpactOscillator(*model), jet_flight.response
    right = jet_hit(osc, box(state, "A", TINY), HORIZON)

    def last_is_lost(by_x, by_v, driven, start):
        found = honest(by_x, by_v, driven, start)
        return [*found[:-1], 0 * found[-1]]

    monkeypatch.setattr(jet_flight, "response", last_is_lost)
    wide = jet_hit(osc, box(state, "A", TINY), HORIZON)
    for one, other in zip(right.jets, wide.jets, strict=True):
        for part, around in zip(one, other, strict=True):
            assert around.overlaps(part)


def test_flights_that_are_not_decided_are_refused():
    osc = si.ImpactOscillator("x", "A", "-1", "1/2", {"A": 0})
    with pytest.raises(Refused):
        jet_hit(osc, box(("0", "0.001"), "A", Fraction(1, 100)), HORIZON)
    with pytest.raises(Refused, match="horizon"):
        jet_hit(si.ImpactOscillator("0", "A", 0, "1/2", {"A": 1}), box(("0", "1"), "A", TINY), Fraction(5))
