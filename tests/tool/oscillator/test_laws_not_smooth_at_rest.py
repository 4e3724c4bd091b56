"""Laws with powers of v that are not whole: accepted by their slope at rest, refused where a series is needed."""

from fractions import Fraction

import numpy as np
import pytest

import singimpact as si
from singimpact.algebra import EXACT
from singimpact.contact import series_of_rho
from singimpact.inputs import InputError

SLOPES = {
    "-v*(1 - 0.3*(-v)**(1/5))": 1,
    "-v + 0.3*(-v)**1.2": 1,  # 0.3 w^(6/5), w = -v, is a gain
    "-v*(1 - 0.3*(-v)**0.1)": 1,
    "-v*(1 - 0.3*sqrt(-v))": 1,
    "-0.8*v - 0.1*(-v)**(3/2)": Fraction(4, 5),
    "-0.5*v - v**2*sqrt(-v)": Fraction(1, 2),
    "-v*(1 - 0.3*(v**2)**0.1)": 1,
    "-v*(1 - C*(-v)**q)*exp(v)": 1,
    "-v*(1 - C*(-v)**q - C*(-v)**(3*q))": 1,
    "0.8*abs(v)": Fraction(4, 5),
}


def model(rho, f="x", g="sin(t)"):
    values = {"C": "0.3", "q": "1/5"}
    return si.ImpactOscillator(f, g, 0, rho, {name: value for name, value in values.items() if f"{name}*" in rho})


@pytest.mark.parametrize("rho", SLOPES)
def test_the_slope_at_rest_is_exact(rho):
    values = {"C": "0.3", "q": "1/5"} if "C" in rho else {}
    osc = si.ImpactOscillator("x", "sin(t)", 0, rho, values)
    assert str(osc.slope_at_rest()) == str(float(SLOPES[rho])).replace(".0", "")
    matrix = osc.derivative(-1.0, 0.0).matrix
    assert matrix[1, 1] == float(SLOPES[rho])


@pytest.mark.parametrize(
    "rho", ["(-v)**1.2", "sqrt(-v)", "-1.1*v + (-v)**1.5", "-v*log(-v)", "-v + sqrt(-v)", "0.8*v", "1 + (-v)**1.5"]
)
def test_other_slopes_are_refused(rho):
    with pytest.raises(InputError, match="rho'\\(0\\) < 0"):
        model(rho)


@pytest.mark.parametrize("rho", ["-v*(1 - 0.3*(-v)**(1/5))", "-0.8*v - 0.1*(-v)**(3/2)"])
@pytest.mark.parametrize(
    "task",
    [
        lambda osc: si.theory.gamma(order=3, at="tangency", model=osc),
        lambda osc: si.theory.chatter_limit(order=3, model=osc, tau=-1),
        lambda osc: osc.chatter_limit(-1.3, "0.0001", digits=20),
        lambda osc: si.threshold(osc, -1, digits=20),
        lambda osc: si.grown_gamma(osc),
    ],
)
def test_series_are_refused_by_name(rho, task):
    with pytest.raises(
        InputError, match=r"^restitution = '.*' is not accepted here: .* whole, .* smooth there, such as [^\n]*$"
    ):
        task(model(rho))


def test_a_smooth_law_written_with_roots_has_a_series():
    assert series_of_rho(model("0.8*abs(v)"), 4, EXACT) == {1: Fraction(-4, 5)}
    assert series_of_rho(model("-0.8*v*cos(sqrt(-v))"), 3, EXACT) == {
        1: Fraction(-4, 5), 2: Fraction(-2, 5), 3: Fraction(-1, 30)
    }  # fmt: skip
    plain, rooted = (si.theory.gamma(order=5, at="tangency", model=model(rho)) for rho in ("0.8", "0.8*abs(v)"))
    assert [plain[n] for n in range(2, 6)] == [rooted[n] for n in range(2, 6)]
    ends = [model(rho).chatter_limit(-1.3, 1e-3).tau for rho in ("-0.8*v", "0.8*abs(v)")]
    assert ends[0] == pytest.approx(ends[1], rel=1e-15)


def test_flights_with_digits_are_certified():
    osc = model("-v*(1 - 0.3*(-v)**(1/5))")
    plain, many = osc.impact_map(-1, 0.25), osc.impact_map(-1, "0.25", digits=30)
    assert float(many.v) == pytest.approx(plain.v, rel=1e-14)
    assert float(many.certified.v.radius) < 1e-29
    back = osc.inverse_map(plain.tau, plain.v)
    assert np.allclose([back.tau, back.v], [-1, 0.25], rtol=1e-12)
