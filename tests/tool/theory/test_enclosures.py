"""Coefficients and points with a certified radius: against references, against more digits, against other routes."""

from fractions import Fraction

import mpmath
import pytest

import singimpact as si
from singimpact.algebra import Certified, from_ends
from singimpact.bench import values
from singimpact.inputs import InputError

DUFFING = si.ImpactOscillator("x + 0.1*xdot + 0.3*x**3", "cos(1.7*t)", "0.3", "0.6")
REFERENCE = {
    "gamma.C2[linear w=2,c=0.3,r=0.5]": (si.linear(2, "0.3", "0.5"), 2),
    "gamma.C3[linear w=2,c=0.3,r=0.5]": (si.linear(2, "0.3", "0.5"), 3),
    "gamma.C2[linear w=2,c=0.3,r=0.9]": (si.linear(2, "0.3", "0.9"), 2),
    "gamma.C3[linear w=2,c=0.3,r=0.9]": (si.linear(2, "0.3", "0.9"), 3),
    "gamma.C2[duffing w=1.7,c=0.3,r=0.6,d=0.1,k3=0.3]": (DUFFING, 2),
}


@pytest.mark.parametrize("name", REFERENCE)
def test_gamma_contains_the_reference(name):
    model, power = REFERENCE[name]
    found = si.theory.gamma(order=4, model=model).certified(35)[power]
    truth = Fraction(values()[name])
    known = Certified(found.value, found.radius + abs(found.value) * mpmath.mpf(10) ** -38, 35)  # it has 40 digits
    assert known.contains(truth)
    assert not known.contains(truth * (1 + Fraction(1, 10**30)))
    assert found.radius <= mpmath.mpf(10) ** -35 * abs(found.value)


@pytest.mark.parametrize("at", ["tangency", "swan"])
def test_coefficients_with_more_digits_lie_within(at):
    model = DUFFING if at == "tangency" else si.linear(2, 1, "0.7")
    series = si.theory.gamma(order=8, at=at, model=model)
    few, many = series.certified(20), series.certified(60)
    assert few.keys() == many.keys()
    for power, found in few.items():
        assert found.contains(many[power].value)
        assert many[power].value == 0 or not found.contains(many[power].value * (1 + mpmath.mpf(10) ** -15))


def test_exact_coefficients_lie_within():
    model = si.universal(-1, "5/16")  # lambda = 1/2 at the tangency, so gamma is rational
    series = si.theory.gamma(order=5, model=model, tau=-1)
    for power, found in series.certified(30).items():
        assert found.contains(Fraction(int(series[power].p), int(series[power].q)))


def test_motion_fibre_and_chatter_limit_too():
    model = si.linear(2, "0.3", "0.5")
    assert str(si.theory.dynamics_on_gamma(order=2, model=model).certified(20)[1]) == "0.66044224972374318838"
    fibre = si.theory.fibre(order=2, model=model, tau="1.2").certified(25)
    limit = si.theory.chatter_limit(order=2, model=model, tau="1.2").certified(25)
    with mpmath.workdps(200):
        a = mpmath.cos(mpmath.mpf("2.4")) - mpmath.mpf("0.3")
        assert fibre[1].contains(a / 4)
        assert limit[1].contains(-4 / a)
        assert not limit[1].contains(4 / a)


def test_the_slope_of_the_stable_fibre_is_the_reference():
    """alpha = 2/((1 - r) a): sigma = alpha v + ... on the fibre, whose graph is v = sigma/alpha + ..."""
    found = si.theory.fibre(order=3, model=DUFFING, tau="1.5").certified(38)[1]
    alpha = Fraction(values()["Ws.alpha[duffing d=1.5, tau=1.5]"])
    known = Certified(found.value, found.radius + abs(found.value) * mpmath.mpf(10) ** -38, 38)
    assert known.contains(1 / alpha)
    assert not known.contains(1 / alpha + Fraction(1, 10**30))


def test_tangency_points_any_digits():
    points = si.tangency_points(si.linear(2, "0.3", "0.9"))
    truth = values()["gamma.tau_star[linear w=2,c=0.3,r=0.9]"]
    (_, found) = points.certified(38)
    assert str(found)[:39] == truth[:39]
    assert points[1].certified(20).contains(points[1].certified(300).value)
    assert points[1].certified(300).radius <= mpmath.mpf(10) ** -300 * 3
    with mpmath.workdps(300):
        assert points[1].certified(100).contains(mpmath.pi - mpmath.acos(mpmath.mpf(3) / 10) / 2)
        assert (
            not points[1].certified(100).contains(mpmath.pi - mpmath.acos(mpmath.mpf(3) / 10) / 2 + mpmath.mpf("1e-90"))
        )


def test_digits_of_a_point_are_checked():
    with pytest.raises(InputError, match="digits = 0"):
        si.tangency_points(si.linear(2, "0.3", "0.9")).certified(0)
    with pytest.raises(InputError, match="digits = 'many'"):
        si.tangency_points(si.linear(2, "0.3", "0.9"), digits="many")


def test_symbols_have_no_radius():
    with pytest.raises(InputError, match="model="):
        si.theory.gamma(order=3).certified()


def test_ends_are_kept():
    found = from_ends(Fraction(1, 3), Fraction(1, 3) + Fraction(1, 10**12), 12)
    assert found.contains(Fraction(1, 3))
    assert found.contains(Fraction(1, 3) + Fraction(1, 10**12))
    assert not found.contains(Fraction(1, 3) - Fraction(1, 10**16))
