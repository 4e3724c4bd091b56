"""Rebound laws inverted: on the branch from rest, to the last bits, and `no_rebound` where rho does not reach v."""

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.flights import speed_before
from singimpact.status import Status

LAWS = {
    "-tanh(v/2)": (lambda v: 2 * mpmath.atanh(v), 1.0),
    "-sin(v/2)": (lambda v: 2 * mpmath.asin(v), 1.0),
    "-v/(2+v)": (lambda v: 2 * v / (1 + v), np.inf),
    "-0.8*v+0.1*v**2": (lambda v: -4 + mpmath.sqrt(16 + 10 * v), np.inf),
    "-0.5*v+v**3/10": (lambda v: mpmath.findroot(lambda u: u / 2 - u**3 / 10 - v, 2 * v), (5 / 3) ** 0.5 / 3),
}


@pytest.mark.parametrize("law", LAWS)
def test_the_speed_before_is_right(law):
    model = si.ImpactOscillator("x", "cos(2*t)", "0.3", law)
    inverse, top = LAWS[law]
    v = np.concatenate([np.geomspace(1e-300, min(0.9 * top, 1e3), 60), [0.0]])
    found = speed_before(model, v)
    assert found[-1] == 0
    with mpmath.workdps(340):
        for value, speed in zip(v[:-1], found[:-1], strict=True):
            truth = inverse(mpmath.mpf(value))
            assert abs(speed / truth - 1) < 2e-14, value
    if np.isfinite(top):
        assert np.isnan(speed_before(model, np.array([1.001 * top, 2 * top, 1e6]))).all()


@pytest.mark.parametrize("law", ["-tanh(v/2)", "-sin(v/2)"])
@pytest.mark.parametrize("digits", [None, 20])
def test_the_greatest_rebound(law, digits):
    """tanh never reaches 1, sin does at pi; the last double below 1 is reached by both."""
    model = si.ImpactOscillator("x", "cos(2*t)", "0.3", law)
    top, below, above = (model.inverse_map(1, v, digits=digits) for v in (1.0, 1 - 2.0**-53, 1.5))
    assert above.status == Status.no_rebound
    assert below.status == Status.hit
    assert top.status == (Status.no_rebound if "tanh" in law else Status.hit)
    if "sin" in law:
        assert abs(float(top.velocity) + np.pi) < 1e-14
    for step, v in ((below, 1 - 2.0**-53),):
        again = model.impact_map(step.tau, step.v, digits=digits)
        assert abs(float(again.v) - v) < 1e-13
