"""Formulas that a changed sign or factor left standing: each is compared with another route to the same number."""

from fractions import Fraction

import mpmath
import pytest
import sympy

from singimpact.algebra import EXACT
from singimpact.contact import Contact
from singimpact.paper import A, E
from singimpact.paper.routes import swan
from singimpact.theory import (
    DG_on_ray,
    eigenvalues_on_gamma,
    fixed_points,
    invariant_curve,
    lambda_ as homogeneous_lambda_,
    launch_velocity,
    mu_of_lambda,
    r_of_lambda,
)

lambda_ = homogeneous_lambda_


@pytest.mark.parametrize("j", [1, 2, 3])
@pytest.mark.parametrize("r", ["1/2", "1/50", "0.97"])
def test_mu_minus_one_is_mu_less_one(j, r):
    found = fixed_points.multipliers(j, r, 40)
    with mpmath.workdps(60):
        assert abs(found.mu_minus_one.value - (found.mu.value - 1)) <= found.mu_minus_one.radius + found.mu.radius


def rate_across(j, at):
    """d w'/d w of the blown-up map of x'' = s^j at its fixed point, with w = v/sigma^(j+1): by the landing ratio e."""
    e = sympy.Symbol("e")
    launch, impact = launch_velocity(j, 1, e), -launch_velocity(j, e, 1)
    r = r_of_lambda(j).subs(lambda_, at)
    after = sympy.diff(r * impact / e ** (j + 1), e)
    return sympy.cancel(after / sympy.diff(launch, e)).subs(e, at)


@pytest.mark.parametrize("j", [1, 2, 3, 4])
def test_mu_is_the_rate_across_the_invariant_curve(j):
    rate = Fraction(3, 5)
    curve = invariant_curve(Contact(j, EXACT, {j: Fraction(2)}, {}), rate, j + 2)
    assert sympy.Rational(curve.mu.numerator, curve.mu.denominator) == rate_across(j, sympy.Rational(3, 5))
    assert mu_of_lambda(j).subs(lambda_, sympy.Rational(3, 5)) == rate_across(j, sympy.Rational(3, 5))


def test_the_jacobian_at_the_swan_is_the_derivative_of_the_new_m():
    """h_bar(m, mbar) = 0 defines the new m: implicit differentiation at the fixed point, for several r."""
    m, mbar, r = swan.m, swan.mbar, swan.r
    equation = swan.h_bar()
    implicit = -sympy.diff(equation, m) / sympy.diff(equation, mbar)
    at = {mbar: m, r: swan.r_of_m()}
    assert sympy.cancel(implicit.subs(at) - swan.Dh_bar()[1, 1].subs(r, swan.r_of_m())) == 0
    assert sympy.cancel(swan.mu_of_m() - implicit.subs(at)) == 0


@pytest.mark.parametrize("j", [1, 2])
def test_both_eigenvalues_on_gamma_are_those_of_the_matrix(j):
    larger, smaller = eigenvalues_on_gamma(j)
    matrix = DG_on_ray(j)
    at = {lambda_: sympy.Rational(2, 3)}
    assert sympy.simplify((larger * smaller - matrix.det()).subs(at)) == 0
    assert sympy.simplify((larger + smaller - matrix.trace()).subs(at)) == 0
    assert float(larger.subs(at)) > float(smaller.subs(at))


def test_E_is_a_flight_forward_in_time():
    """On H and Z both, with t > 0, and launched before the first tangency: its mirror image has t < 0."""
    assert float(E[1]) > 0
    assert float(E[0]) < float(A[0])
    assert sympy.expand(E[0] + E[1]) == sympy.sqrt(3)
