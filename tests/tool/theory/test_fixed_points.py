"""Fixed points: against the reference values, honest radii, nothing lost at the ends of (0, 1)."""

from fractions import Fraction

import mpmath
import pytest

from singimpact.inputs import InputError
from singimpact.theory import as_dict, fixed_points, swan, tangency

NAMES = {"lambda": "lambda_", "mstar": "m_star"}


def test_reference_values(reference):
    checked = 0
    with mpmath.workdps(60):
        for key, text in reference.items():
            place, _, rest = key.partition(".")
            name, _, rate = rest.partition(".r=")
            if place not in ("tangency", "swan") or not rate:
                continue
            points = (tangency if place == "tangency" else swan)(rate, digits=38)
            found = getattr(points, NAMES.get(name, name), None)
            if found is not None:
                assert abs(found.value - mpmath.mpf(text)) < 1e-37 * abs(mpmath.mpf(text))
                checked += 1
    assert checked == 27


@pytest.mark.parametrize("rate", ["0.1", "1/2", "0.9", "1e-30", 1 - Fraction(1, 10**30), 0.3])
@pytest.mark.parametrize("place", [tangency, swan])
def test_radius_is_honest_and_small(place, rate):
    few, many = as_numbers(place(rate, 25)), as_numbers(place(rate, 80))
    with mpmath.workdps(120):
        for name, (value, radius) in few.items():
            assert abs(value - many[name][0]) <= radius + many[name][1]
            assert 0 <= radius <= mpmath.mpf(10) ** -25 * abs(value)


def as_numbers(points):
    return {name: (getattr(points, name).value, getattr(points, name).radius) for name in points.__dataclass_fields__}


def test_text_lies_within_its_radius():
    exact = tangency("0.7", 60)
    with mpmath.workdps(80):
        for name, told in as_dict(tangency("0.7", 20)).items():
            true = getattr(exact, {"lambda": "lambda_"}.get(name, name)).value
            assert (
                abs(mpmath.mpf(told["value"]) - true) <= mpmath.mpf(told["radius"]) <= mpmath.mpf(10) ** -20 * abs(true)
            )


@pytest.mark.parametrize("rate", ["1e-30", 1 - Fraction(1, 10**30)])
def test_small_quantities_keep_their_digits(rate):
    points = tangency(rate, 30)
    with mpmath.workdps(60):
        if rate == "1e-30":  # lambda^2 (lambda + 2) = r (2 lambda + 1)
            x = points.lambda_.value
            assert abs(x**2 * (x + 2) / (mpmath.mpf(10) ** -30 * (2 * x + 1)) - 1) < 1e-28
        else:  # 1 - lambda = 3 (1 - r)/5 + O(2)
            assert abs(points.one_minus_lambda.value * mpmath.mpf(10) ** 30 - mpmath.mpf(3) / 5) < 1e-28


@pytest.mark.parametrize("rate", [0, 1, 1.2, "x", "pi/4", None, float("nan")])
def test_restitution_out_of_range_is_one_line(rate):
    with pytest.raises(InputError, match=r"r = .* is not accepted: give a rational number"):
        tangency(rate)


@pytest.mark.parametrize("digits", [0, -3, 10**9, 2.5, "many"])
def test_digits_out_of_range_is_one_line(digits):
    with pytest.raises(InputError, match=r"digits = .* is not accepted"):
        swan("1/2", digits)


@pytest.mark.parametrize("j", [1, 2, 3, 7])
@pytest.mark.parametrize("r", ["1/2", "1e-20", Fraction(10**20 - 1, 10**20)])
def test_multipliers_at_any_contact_order(j, r):
    few, many = (fixed_points.multipliers(j, r, digits) for digits in (25, 70))
    for name in ("lambda_", "mu", "one_minus_lambda", "mu_minus_one"):
        assert getattr(few, name).contains(getattr(many, name).value)
    with mpmath.workdps(200):
        rate = many.lambda_.value
        P, Q = (sum(c * rate**i for i, c in enumerate(part)) for part in (range(j + 1, 0, -1), range(1, j + 2)))
        assert (
            abs(rate ** (j + 1) * P / Q / mpmath.mpf(Fraction(r).numerator) * Fraction(r).denominator - 1)
            < mpmath.mpf(10) ** -60
        )
        assert abs(many.mu.value * rate * Q**2 / P**2 - 1) < mpmath.mpf(10) ** -60


def test_functions_of_r_are_reached_from_here():
    assert fixed_points.series("lambda", 1, 1) == [1, Fraction(-3, 5)]
    assert str(fixed_points.of_m()["r"]) == "(2*m - 1)**2*(2*m + 3)/(16*m)"
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        fixed_points.nothing  # noqa: B018
    with pytest.raises(InputError, match="contact order"):
        fixed_points.multipliers(0, "1/2")
