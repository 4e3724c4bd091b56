"""Multipliers as functions of r: exact in m, series at both ends, algebraic; against certified values."""

from fractions import Fraction

import mpmath
import pytest
import sympy

from singimpact.inputs import InputError
from singimpact.theory import minimal_polynomial, of_m, series, swan, tangency

PLACES = {"tangency": (tangency, 1), "swan": (swan, 2)}
NAMES = {"lambda": "lambda_", "m3": "m3", "m_star": "m_star", "mu": "mu"}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("quantity", ["lambda", "mu", "point"])
@pytest.mark.parametrize("order", [0, 3, 8, 15])
def test_series_at_zero_has_the_order_it_says(place, quantity, order):
    quantity = {"tangency": "m3", "swan": "m_star"}[place] if quantity == "point" else quantity
    find, j = PLACES[place]
    coefficients = series(quantity, 0, order, place)
    with mpmath.workdps(170):
        misses = []
        for power in (12, 15):
            r = Fraction(1, 10**power)
            w = (mpmath.mpf(10) ** -power / (j + 1)) ** (mpmath.mpf(1) / (j + 1))
            true = getattr(find(r, 160), NAMES[quantity]).value * (w if quantity == "mu" else 1)
            misses.append((abs(true - evaluated(coefficients, w)), w))
        slope = mpmath.log(misses[0][0] / misses[1][0]) / mpmath.log(misses[0][1] / misses[1][1])
        assert slope > order + 0.9


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("quantity", ["lambda", "mu"])
@pytest.mark.parametrize("order", [1, 4, 12])
def test_series_at_one_has_the_order_it_says(place, quantity, order):
    find, _ = PLACES[place]
    coefficients = series(quantity, 1, order, place)
    with mpmath.workdps(140):
        misses = [
            abs(
                getattr(find(1 - Fraction(1, 10**n), 130), NAMES[quantity]).value
                - evaluated(coefficients, mpmath.mpf(10) ** -n)
            )
            for n in (3, 4)
        ]
        assert float(mpmath.log10(misses[0] / misses[1])) == pytest.approx(order + 1, abs=0.2)


def evaluated(coefficients, x):
    return sum((mpmath.mpf(c.numerator) / c.denominator * x**n for n, c in enumerate(coefficients)), mpmath.mpf(0))


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("quantity", ["lambda", "mu"])
def test_minimal_polynomial_vanishes_and_is_irreducible(place, quantity):
    poly = minimal_polynomial(quantity, place)
    x, r = sympy.symbols("x r")
    value = getattr(PLACES[place][0]("1/3", 60), NAMES[quantity]).value
    with mpmath.workdps(60):
        assert (
            abs(mpmath.mpf(str(sympy.N(poly.as_expr().subs({r: sympy.Rational(1, 3), x: sympy.Float(value, 60)}), 55))))
            < 1e-45
        )
    assert len(sympy.factor_list(poly.as_expr())[1]) == 1


def test_functions_of_m():
    found = of_m("swan")
    m = sympy.Symbol("m")
    assert sympy.cancel(found["r"] - (m + 1) ** 3 * (m**2 + 4 * m + 6) / (3 * m**2 + 8 * m + 6)) == 0
    assert found["lambda"] == m + 1


def test_any_contact_order():
    assert series("lambda", 1, 1, 5)[0] == 1
    assert minimal_polynomial("lambda", 3).degree() == 7


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("x", 0, 3), "quantity = 'x'"),
        (("lambda", 2, 3), "end = 2"),
        (("lambda", 0, -1), "order = -1"),
        (("m_star", 0, 3), "quantity = 'm_star'"),
        (("lambda", 0, 3, "generic"), "at = 'generic'"),
    ],
)
def test_bad_input_is_one_line(arguments, told):
    with pytest.raises(InputError) as refusal:
        series(*arguments)
    assert told in str(refusal.value)
