"""Named points of unfolded swans: exact ones of the universal model, references of a real one, and its limit."""

import mpmath
import numpy as np
import pytest

import singimpact as si
from singimpact.dynamics import swan_configuration
from singimpact.inputs import InputError

R3 = 3**0.5
UNIVERSAL = {
    "points": {"A": (-1, 0), "B": (1, 0), "C": (-1, 4), "D": (-3, 4), "E": (-R3, 2 * R3)},
    "projected": {"A": (-1, 0), "B": (1, 0), "C": (-1, 0), "D": (-3, 64), "E": (-R3, 0)},
    "reset": {"A": (-1, 0), "B": (1, 0), "C": (3, -64), "D": (1, 0), "E": (R3, 0)},
}


@pytest.mark.parametrize("part", UNIVERSAL)
@pytest.mark.parametrize("kappa", [-1, 1])
def test_points_of_the_universal_model(kappa, part):
    swan = swan_configuration(si.universal(kappa, "0.5"))
    assert swan.kind == ("negative" if kappa < 0 else "positive")
    for name, (first, second) in UNIVERSAL[part].items():
        turned = second if part == "points" else -kappa * second
        assert np.abs(np.array(getattr(swan, part)[name]) - (first, turned)).max() < 1e-12


@pytest.mark.parametrize("r", ["0.1", "0.9"])
def test_foot_of_the_manifold_through_a(r, reference):
    swan = swan_configuration(si.universal(-1, r))
    assert pytest.approx((3, 64 * float(r)), abs=1e-12) == swan.Q
    assert abs(swan.X - float(reference[f"negswan.model.X.r={r}"])) < 1e-12


def test_negative_swan_of_the_linear_oscillator(reference):
    swan = swan_configuration(si.linear(2, "0.99", "0.5"), near=0)
    expected = {"D.tau": swan.projected["D"][0], "D.v": swan.projected["D"][1], "C2.tau": swan.reset["C"][0],
                "C2.v": swan.reset["C"][1]}  # fmt: skip
    for name, value in expected.items():
        assert abs(value - float(reference[f"negswan.{name}[w=2,c=0.99]"])) < 1e-12
    assert abs(swan.X - float(reference["negswan.X[w=2,c=0.99,r=0.5]"])) < 1e-12


def test_positive_swan_of_the_linear_oscillator(reference):
    swan = swan_configuration(si.linear(2, "-0.99", "0.5"), near="pi/2")
    assert abs(swan.points["E"][0] - float(reference["posswan.E.tau[w=2,c=-0.99]"])) < 1e-12
    assert swan.points["E"][0] < swan.gamma_end < swan.A < swan.N[0] < swan.B


def test_gamma_of_the_universal_positive_swan():
    swan = swan_configuration(si.universal(1, "0.5"))
    assert abs(swan.gamma_end + 1.3851) < 1e-4
    tau, v = swan.N
    near = si.universal(1, "0.5").first_hit(tau, v - 1e-9)  # N is on P: the flight from it grazes
    assert abs(float(near.velocity)) < 1e-3


@pytest.mark.parametrize("which", ["negative", "positive"])
def test_real_oscillators_tend_to_the_universal_model(which):
    """In units of half the distance of A and B, D and X (or E and gamma's end) converge as that distance squared."""
    sign = 1 if which == "negative" else -1
    missed = []
    for gap in ("1e-2", "1e-3"):
        top = mpmath.mpf(sign) + mpmath.mpf("0.025")  # of the forcing at the swan
        model = si.ImpactOscillator("x", "cos(2*t) + cos(4*t)/40", str(top - sign * mpmath.mpf(gap)), "0.5")
        swan = swan_configuration(model, near=0 if sign > 0 else "pi/2")
        middle, half = (swan.A + swan.B) / 2, (swan.B - swan.A) / 2
        value = (swan.X if sign > 0 else swan.gamma_end) - middle
        limit = 4.047656283302458 if sign > 0 else -1.385133587664357
        missed.append((half, abs(value / half - limit)))
    rate = np.log(missed[0][1] / missed[1][1]) / np.log(missed[0][0] / missed[1][0])
    assert abs(rate - 2) < 0.1


def test_refusals():
    with pytest.raises(InputError, match="fewer than two tangency points"):
        swan_configuration(si.linear(2, "1.5", "0.5"))
    with pytest.raises(InputError, match="model = 3"):
        swan_configuration(3)
