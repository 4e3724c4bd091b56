"""Curves of events in two numbers against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

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


def test_bad_input(events) -> None:
    with pytest.raises(InputError, match="two different numbers"):
        si.event_curve(events["graze"], ("amplitude", "amplitude"))
    with pytest.raises(InputError, match="a fold, doubling, graze"):
        si.event_curve("graze", ("amplitude", "omega"))
