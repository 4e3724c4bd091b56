"""D G against differences of the many-digit map, at grazes and at rest; condition numbers of every model."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from singimpact.flights.derivative import derivative
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.status import Status

MODELS = {
    "linear": linear("2.8", "0.1", "0.8"),
    "damped": linear("1.3", "0.2", "0.7", damping="0.3"),
    "polynomial": ImpactOscillator("x**3 - x + xdot*x/5", "cos(2*t)", "0.1", "-0.8*v + v**2/50"),
    "functions": ImpactOscillator("sin(x) + atan(xdot)/3", "cos(2*t) - 0.2*t", "-0.1", "0.8"),
}


def difference(osc, tau, v, which):
    step = mpmath.mpf(10) ** -15
    with mpmath.workdps(45):
        ends = []
        for sign in (1, -1):
            moved = (mpmath.mpf(tau) + sign * step * (which == 0), mpmath.mpf(v) * (1 + sign * step * (which == 1)))
            ends.append(osc.impact_map(*moved, digits=40))
        scale = 2 * step * (1 if which == 0 else mpmath.mpf(v))
        return [float((ends[0].tau - ends[1].tau) / scale), float((ends[0].v - ends[1].v) / scale)]


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("v", [1e-6, 0.4])
def test_derivative_is_the_limit_of_differences(name: str, v: float) -> None:
    osc = MODELS[name]
    found = derivative(osc, 0.9, v)
    assert found.status == Status.hit
    truth = np.array([difference(osc, 0.9, v, 0), difference(osc, 0.9, v, 1)]).T
    assert found.matrix == pytest.approx(truth, rel=1e-9, abs=1e-13)


def test_derivative_has_the_shape_of_the_states() -> None:
    found = derivative(MODELS["linear"], np.linspace(0, 1, 3)[:, None], [0.1, 0.2])
    assert found.matrix.shape == (3, 2, 2, 2)
    assert found.matrix[1, 0] == pytest.approx(derivative(MODELS["linear"], 0.5, 0.1).matrix, rel=1e-14)


def test_one_sided_derivatives() -> None:
    touch = derivative(ImpactOscillator("0", "6*t - 12", 0, "0.5"), 0, 9)
    assert touch.status == Status.graze
    assert np.isinf(touch.matrix[:, 1]).all()
    assert np.sign(touch.matrix[:, 1]).tolist() == [1, -1]
    rest = derivative(ImpactOscillator("0", "-2", 0, "0.5"), 0, 0)
    assert rest.status == Status.sticks
    assert rest.matrix.tolist() == [[1, 1], [0, 0.5]]


def test_condition_of_a_model_by_its_taylor_flow_is_that_of_the_closed_form() -> None:
    series = ImpactOscillator("x + 0*x + x**3/10**40", "cos(2.8*t)", "0.1", "0.8")
    tau, v = np.linspace(0, 2, 9), np.geomspace(1e-9, 2, 9)
    one, two = MODELS["linear"].first_hit(tau, v).condition, series.first_hit(tau, v).condition
    assert one == pytest.approx(two, rel=1e-7)
