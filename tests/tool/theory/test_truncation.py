"""Truncation measured in 100 digits: the residual under the true map falls with the first omitted term."""

from fractions import Fraction

import mpmath
import pytest

import singimpact as si
from singimpact.algebra import Balls, as_rational
from singimpact.theory import gamma

MODELS = {
    "linear": si.linear(2, "0.3", "0.5"),
    "damped Duffing": si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6"),
    "nonlinear restitution": si.ImpactOscillator("x", "cos(2*t)", "0.3", "-0.5*v + 0.2*v**2"),
}
DIGITS = 100


@pytest.mark.parametrize("order", [4, 8, 12, 16])
@pytest.mark.parametrize("name", MODELS)
def test_residual_of_invariance_has_the_slope_of_the_first_omitted_term(name, order):
    model = MODELS[name]
    long = gamma(order=order + 4, model=model, digits=DIGITS)
    series = gamma(order=order, model=model, digits=DIGITS)
    first = next(n for n in range(order + 1, order + 5) if long[n] != 0)
    point = next(p for p in si.tangency_points(model) if p.kind == "gamma")
    with mpmath.workdps(DIGITS + 10):
        tau = exact(as_rational(point.ball(Balls(400).bits)))
        sizes = [Fraction(-1, 1000), Fraction(-1, 2000)]
        missed = [residual(model, series, tau, exact(sigma)) for sigma in sizes]
        slope = mpmath.log(abs(missed[0] / missed[1]), 2)
    assert abs(slope - first) < 0.1


def exact(value):
    return mpmath.mpf(value.numerator) / value.denominator


def residual(model, series, tau, sigma):
    """v after the true map less the series there."""
    step = model.impact_map(tau + sigma, series(sigma), digits=DIGITS)
    return step.v - series(step.tau - tau)
