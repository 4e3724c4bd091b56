"""The sheet: two routes agree, the involution gives phi, and the leading parts are those of the homogeneous models."""

from fractions import Fraction

import pytest
import sympy

from singimpact.contact import Contact
from singimpact.inputs import InputError
from singimpact.oscillator import Oscillator
from singimpact.paper import a_symbol, phi_c, v_c as route_v_c
from singimpact.theory import (
    P,
    Q,
    generic_sheet,
    iota,
    lambda_,
    launch_velocity,
    leading_coefficient,
    mu_of_lambda,
    r_of_lambda,
    sheet,
    v_c,
)

sigma, t = sympy.symbols("sigma t")


@pytest.mark.parametrize("order", [1, 2, 3, 4, 5])
def test_boundary_value_route_is_the_implicit_route(order):
    assert sympy.expand(v_c(order) - route_v_c(order)) == 0


@pytest.mark.parametrize("order", [3, 4])
def test_phi_by_the_involution_is_phi_the_long_way(order):
    found = generic_sheet(0, order)
    assert sympy.expand(found.to_sympy(found.xdot) - phi_c(order)[1]) == 0


@pytest.mark.parametrize(("at", "j"), [("tangency", 1), ("swan", 2), (3, 3)])
def test_zeros_set_first_are_zeros_set_last(at, j):
    zeros = {a_symbol(n): 0 for n in range(j)}
    assert sympy.expand(v_c(6, at) - v_c(6).subs(zeros)) == 0


@pytest.mark.parametrize("j", [0, 1, 2, 3])
def test_leading_part_is_the_homogeneous_model(j):
    found = generic_sheet(j, j + 1)
    model = a_symbol(j) / sympy.factorial(j) * launch_velocity(j, sigma, sigma + t)
    assert sympy.expand(found.to_sympy(found.v) - model) == 0


def test_involution_is_its_own_inverse():
    assert tuple(sympy.expand(part) for part in iota(*iota(sigma, t))) == (sigma, t)


@pytest.mark.parametrize("j", [0, 1, 2, 3, 4])
def test_closed_forms_in_lambda(j):
    p = sum((j + 1 - i) * lambda_**i for i in range(j + 1))
    q = sum((i + 1) * lambda_**i for i in range(j + 1))
    assert sympy.expand(P(j) - p) == 0 == sympy.expand(Q(j) - q)
    assert sympy.cancel(r_of_lambda(j) - lambda_ ** (j + 1) * p / q) == 0
    assert sympy.cancel(mu_of_lambda(j) - (p / q) ** 2 / lambda_) == 0
    assert sympy.cancel(leading_coefficient(j) - (1 - lambda_) * p / ((j + 1) * (j + 2))) == 0


def test_model_with_numbers_is_the_generic_one_with_its_jets():
    from singimpact.algebra import EXACT

    osc = Oscillator("x + 0.1*xdot + 0.3*x**3", "sin(1.7*t) + 1/2", "0.3", "0.6")
    found = sheet(Contact.of(osc, Fraction(0), 0, 4, EXACT), 4)
    c, w = sympy.Rational(3, 10), sympy.Rational(17, 10)
    jets = {"a_d1": w, "a_d2": 0, "a_d3": -(w**3)}
    jets["a"] = sympy.Rational(1, 2) - c - sympy.Rational(3, 10) * c**3
    jets |= {"f_10": 1 + sympy.Rational(9, 10) * c**2, "f_01": sympy.Rational(1, 10), "f_20": sympy.Rational(9, 5) * c,
             "f_02": 0, "f_11": 0, "f_03": 0}  # fmt: skip
    expected = v_c(4).subs({sympy.Symbol(name): value for name, value in jets.items()})
    assert sympy.expand(found.to_sympy(found.v) - expected) == 0


@pytest.mark.parametrize(
    ("keywords", "told"),
    [
        ({"order": 0}, "order = 0"),
        ({"order": -1}, "order = -1"),
        ({"order": "x"}, "order = 'x'"),
        ({"at": "nowhere"}, "at = 'nowhere'"),
        ({"at": -1}, "at = -1"),
        ({"at": True}, "at = True"),
    ],
)
def test_bad_input_is_one_line(keywords, told):
    with pytest.raises(InputError) as refusal:
        v_c(**keywords)
    assert told in str(refusal.value)
