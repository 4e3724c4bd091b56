"""Linear models recognised, others not; accelerations at full accuracy."""

from __future__ import annotations

import numpy as np
import pytest

from singimpact.oscillator import Oscillator, acceleration, linear_form


@pytest.mark.parametrize("f", ["x**2", "x*xdot", "sin(x)", "1/(1 + x)", "exp(xdot)"])
def test_not_linear_in_the_state(f: str) -> None:
    assert linear_form(Oscillator(f, "cos(t)", 0, 1)) is None


@pytest.mark.parametrize("g", ["t", "cos(t)**2", "exp(t)", "cos(t**2)", "cos(t)*sin(t)"])
def test_not_a_sum_of_harmonics(g: str) -> None:
    assert linear_form(Oscillator("x", g, 0, 1)) is None


def test_parts_are_collected() -> None:
    forcing = "3*(cos(w*t) - 1) + sin(2*t + 1)/2"
    form = linear_form(Oscillator("2*(x + k*xdot) + x - 1", forcing, 0, 1, {"k": 5, "w": 7}))
    assert form is not None
    assert (str(form.stiffness), str(form.damping), str(form.constant)) == ("3", "10", "-2")
    assert [(str(h.rate), str(h.cosine), str(h.sine)) for h in form.harmonics] == [("7", "3", "0"), ("2", "0", "0.5")]


def test_acceleration_does_not_cancel() -> None:
    osc = Oscillator("x", "cos(t)", 1, 1)
    tau = np.array([1e-3, 1e-9, 1e-150])
    assert acceleration(osc, tau).tolist() == pytest.approx((-2 * np.sin(tau / 2) ** 2).tolist(), rel=1e-15, abs=0)


def test_derivatives_of_acceleration() -> None:
    osc = Oscillator("x", "cos(2*t)", 0, 1)
    assert acceleration(osc, np.array([0.3]), 3)[0] == pytest.approx(8 * np.sin(0.6), rel=1e-15)
    assert acceleration(osc, np.array([1e22]))[0] == pytest.approx(np.cos(2e22), rel=1e-15)
