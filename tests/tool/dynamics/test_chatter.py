"""Complete chatter and thresholds: to the reference digits, with errors that are honest."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from singimpact.bench import values
from singimpact.dynamics import chatter_limit
from singimpact.dynamics.threshold import threshold
from singimpact.impact_oscillator import ImpactOscillator, linear, universal
from singimpact.inputs import InputError
from singimpact.status import Status

BALL = ImpactOscillator("0", "-9.81", 0, "0.9")
CASES = {
    "near": (linear("2.8", 0, "0.8"), "0.9", "0.0001", "0.901229076799750500564385390033"),
    "far": (linear("2.8", 0, "0.8"), "0.9", "0.005", "0.959359234422082626031840228653"),
    "ball": (BALL, "sqrt(2/9.81)", "0.9*sqrt(2*9.81)", "8.5789491787288871846"),
    **{f"r={r}": (linear(2, "0.3", r), "1.2", "0.01", values()[f"chatter.tau_inf.linear[w=2,c=0.3,r={r}](1.2,0.01)"])
       for r in ("0.5", "0.9")},
    **{f"swan, r={r}": (universal(-1, r), -1, 0, values()[f"negswan.model.X.r={r}"]) for r in ("0.1", "0.9")},
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_error_estimate_is_honest_and_small(name: str) -> None:
    osc, tau, v, truth = CASES[name]
    found = chatter_limit(osc, tau, v)
    assert found.status == Status.complete
    with mpmath.workdps(40):
        error = abs(mpmath.mpf(float(found.tau)) - mpmath.mpf(truth))
        assert error <= found.error
        assert error < 1e-15 * abs(mpmath.mpf(truth)) * 10
    assert found.error < 2e-12


@pytest.mark.parametrize("name", CASES)
def test_digits(name: str) -> None:
    osc, tau, v, truth = CASES[name]
    digits = 17 if name == "ball" else 25
    found = chatter_limit(osc, tau, v, digits=digits)
    with mpmath.workdps(40):
        error = abs(found.tau - mpmath.mpf(truth))
        assert error <= found.error <= mpmath.mpf(10) ** (1 - digits) * abs(found.tau)


def test_nonlinear_model_and_restitution_by_expression() -> None:
    osc = ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "-0.6*v + v**2/9")
    few, many = chatter_limit(osc, "1.5", "0.05"), chatter_limit(osc, "1.5", "0.05", digits=25)
    assert few.status == many.status == Status.complete
    assert abs(float(many.tau - mpmath.mpf(float(few.tau)))) <= few.error < 1e-12


def test_contact_is_lost() -> None:
    osc = linear("2.8", 0, "0.8")
    found = chatter_limit(osc, 1.2, 0.3)
    assert found.status == Status.lifts_off
    assert osc.acceleration(found.tau) >= 0
    assert np.isnan(chatter_limit(ImpactOscillator("0", "1", 0, "0.5"), 0, 1).tau)


def test_threshold() -> None:
    osc = linear("2.8", 0, "0.5")
    found = threshold(osc, "pi/2.8")
    with mpmath.workdps(30):
        truth = mpmath.mpf("0.1008699912692559258909")
        assert abs(found.v - truth) <= found.error < 1e-13
    below, above = (chatter_limit(osc, "pi/2.8", float(found.v) * factor) for factor in (1 - 1e-9, 1 + 1e-9))
    assert (below.status, above.status) == (Status.complete, Status.lifts_off)


@pytest.mark.slow
def test_threshold_with_digits() -> None:
    found = threshold(linear("2.8", 0, "0.5"), "pi/2.8", digits=22)
    with mpmath.workdps(30):
        assert abs(found.v - mpmath.mpf("0.1008699912692559258909")) < 1e-22


def test_bad_input() -> None:
    with pytest.raises(InputError, match="at which a mass at rest stays on the wall"):
        threshold(linear("2.8", 0, "0.5"), 0)
    with pytest.raises(InputError, match="restitution"):
        threshold(linear("2.8", 0, 1), "pi/2.8")


def test_arrays_of_states_and_phases() -> None:
    """One result whose fields have the shape of the states."""
    osc, tau = linear("2.8", 0, "0.5"), np.array([[0.9, 1.0], [1.1, 0.2]])
    found = chatter_limit(osc, tau, 0.005)
    each = [chatter_limit(osc, one, 0.005) for one in tau.ravel().tolist()]
    assert found.tau.shape == found.status.shape == (2, 2)
    assert found.tau.ravel().tolist() == [one.tau for one in each]
    assert found.sentence.shape == (2, 2)
    phases = threshold(osc, [0.9, 1.2])
    assert phases.v.tolist() == [threshold(osc, phase).v for phase in (0.9, 1.2)]
    assert phases.status.tolist() == [Status.complete] * 2


def test_a_threshold_near_restitution_one_is_right_or_unresolved() -> None:
    """v/(1 - r) has a limit for r -> 1, which 64 000 impacts missed in silence."""
    near = {r: threshold(linear("2.8", 0, r), "pi/2.8") for r in ("0.999", "0.9998")}
    slope = {r: float(found.v) / (1 - float(r)) for r, found in near.items()}
    assert abs(slope["0.999"] / slope["0.9998"] - 1) < 1e-7
    assert threshold(linear("2.8", 0, "0.9998"), "pi/2.8", impacts=1000).status == Status.unresolved


def test_a_million_impacts_may_be_made_fewer() -> None:
    osc = linear("pi/2.8", "1e5", "0.999999")
    found = chatter_limit(osc, "0.3", "0.3", impacts=500)
    assert found.status == Status.unresolved
    assert 500 <= found.impacts < 1000
    for wrong in (0, 1.5, True):
        with pytest.raises(InputError, match="impacts"):
            chatter_limit(osc, "0.3", "0.3", impacts=wrong)  # type: ignore[arg-type]


def test_a_forcing_slower_than_any_number_is_no_error() -> None:
    assert threshold(linear("1e-300", 1, "0.5"), "0.3").status == Status.unresolved
