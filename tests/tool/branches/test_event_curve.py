"""Curves of events in two numbers against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import root

import singimpact as si
from singimpact.inputs import InputError

MODEL = si.linear(1, -1, "0.8", damping="0.1", amplitude="-0.12")


@pytest.fixture(scope="module")
def events():
    found = si.branch(MODEL.periodic(1, 1)[0], "amplitude", (-0.3, -0.05))
    return {event.kind: event for event in found.events}


@pytest.mark.parametrize("kind", ["graze", "fold", "period-doubling"])
def test_folds_and_doublings_leave_the_grazes_at_resonance(events, kind: str) -> None:
    curve = si.event_curve(events[kind], ("amplitude", "omega"), ((-0.3, -0.05), (0.9, 1.1)))
    A, w = curve.parameters.T
    if kind == "graze":
        assert pytest.approx(np.hypot(1 - w * w, 0.1 * w), rel=1e-12) == -A
    damped = np.sqrt(1 - 0.05**2)
    (resonant,) = (each for each in curve.special if each.kind == "resonant graze")
    assert resonant.parameters[1] == pytest.approx(damped, rel=1e-10)
    assert -resonant.parameters[0] == pytest.approx(np.hypot(1 - damped**2, 0.1 * damped), rel=1e-10)


def test_doublings_of_the_bouncing_ball() -> None:
    ball = si.ImpactOscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.5"})
    for orbit in ball.periodic(1, 1):
        found = si.branch(orbit, "G", (1.2, 2.0))
        for event in found.events:
            curve = si.event_curve(event, ("G", "restitution"), ((0.5, 3), (0.2, 0.9)))
            G, r = curve.parameters.T
            assert len(curve) > 20
            if event.kind == "period-doubling":
                truth = np.hypot(np.pi * (1 - r) / (1 + r), 2 * (1 + r * r) / (1 + r) ** 2)
                assert pytest.approx(truth, rel=1e-11) == G
            if event.kind == "fold":
                assert pytest.approx(np.pi * (1 - r) / (1 + r), rel=1e-11) == G


@pytest.mark.slow
def test_two_folds_of_a_forcing_with_two_harmonics_meet_in_a_cusp() -> None:
    w, r = 2.8, 0.8
    osc = si.ImpactOscillator("x", "cos(2.8*t) + b*cos(5.6*t + 1)", "-0.1", "0.8", {"b": 3})
    orbit = max(osc.periodic(1, 1), key=lambda orbit: orbit.v[0])
    folds = [event for event in si.branch(orbit, "clearance", (-9, 9)).events if event.kind == "fold"]
    assert len(folds) == 4
    curve = si.event_curve(folds[1], ("clearance", "b"), ((-9, 9), (0.1, 4)))
    # an impact a period at phase tau needs c = p - K p', p the periodic motion without impact
    K = (1 + r) / (1 - r) / np.tan(np.pi / w)

    def clearance(tau, b, order):
        first, second = 1 / (1 - w * w), b / (1 - 4 * w * w)
        turn, angle, twice = order * np.pi / 2, w * tau, 2 * w * tau + 1
        p = first * w**order * np.cos(angle + turn) + second * (2 * w) ** order * np.cos(twice + turn)
        slope = first * w ** (order + 1) * np.cos(angle + turn + np.pi / 2)
        slope += second * (2 * w) ** (order + 1) * np.cos(twice + turn + np.pi / 2)
        return p - K * slope

    c, b = curve.parameters.T
    tau = curve.tau[:, 0]
    assert clearance(tau, b, 0) == pytest.approx(c, abs=1e-11)
    assert clearance(tau, b, 1) == pytest.approx(np.zeros(len(b)), abs=1e-10)
    cusps = [each for each in curve.special if each.kind == "cusp"]
    (cusp,) = cusps
    solution = root(lambda at: [clearance(at[0], at[1], 1), clearance(at[0], at[1], 2)],
                    [tau[cusp.index], cusp.parameters[1]], tol=1e-13)  # fmt: skip
    assert solution.success
    assert cusp.parameters[1] == pytest.approx(solution.x[1], abs=1e-9)
    assert cusp.parameters[0] == pytest.approx(clearance(*solution.x, 0), abs=1e-9)


def test_bad_input(events) -> None:
    with pytest.raises(InputError, match="two different numbers"):
        si.event_curve(events["graze"], ("amplitude", "amplitude"))
    with pytest.raises(InputError, match="a fold, doubling, torus, graze"):
        si.event_curve("graze", ("amplitude", "omega"))


def test_a_graze_is_not_a_resonance(events) -> None:
    for event in events.values():
        curve = si.event_curve(event, ("amplitude", "omega"), ((-0.3, -0.05), (0.9, 1.1)))
        assert [(point.kind, point.label) for point in curve.special] == [("resonant graze", "")]
