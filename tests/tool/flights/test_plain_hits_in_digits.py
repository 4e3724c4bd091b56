"""`digits=` of one state: the short way gives what an array of states gives, and proves it once."""

import pytest

import singimpact as si
from singimpact.flights import proof
from singimpact.status import Status

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")
WALL = si.ImpactOscillator("sin(x)", "-2", "0.5", "-0.8*v*exp(-v)")


@pytest.mark.parametrize("osc", [DUFFING, WALL], ids=["Duffing", "a law, constant g"])
@pytest.mark.parametrize(("tau", "v"), [("1.4", "0.005"), (1.3, 0.6), ("-7000.25", "0.01"), (1.4, 1e-9)])
def test_one_state_is_as_in_an_array(osc, tau, v):
    alone, both = osc.impact_map(tau, v, digits=25), osc.impact_map([tau, tau], [v, v], digits=25)
    for name in ("flight_time", "velocity", "tau", "v", "certified"):
        assert getattr(alone, name) == getattr(both, name)[0], name
    for name in ("status", "condition", "velocity_condition", "time_error", "velocity_error", "cause"):
        assert getattr(alone, name) == getattr(both, name)[1], name
    assert dict(alone.notes) == {index: note for index, note in both.notes.items() if index == 0}


def test_a_state_that_balls_refuse_is_tried_once(monkeypatch):
    """Here the rebound is not positive; the reason is that of the array."""
    from singimpact.flights import in_digits

    tried = []
    monkeypatch.setattr(in_digits, "proof", lambda *given: tried.append(1) or proof(*given))
    law = si.ImpactOscillator("x + x**3/10", "cos(1.7*t)", 0, "-0.8*v - v**2")  # a rebound that is not positive
    alone = law.impact_map("0.2", "2", digits=20)
    assert len(tried) == 1
    both = law.impact_map(["0.2", "0.2"], ["2", "2"], digits=20)
    assert alone.status == both.status[0] == Status.no_rebound
    assert alone.notes[0] == both.notes[1]
    assert alone.certified is None
