"""The paper's steps: what each derives, that it was derived, and where gamma's numbers come from."""

import mpmath
import pytest
import sympy

from singimpact.paper import (
    Dh_bar,
    derived_from,
    equation,
    f_map,
    g_map,
    h_bar,
    m as swan_m,
    mbar,
    mu_of_m,
    r as route_r,
    r_of_m,
    watched,
)
from singimpact.paper.routes import fold
from singimpact.theory import eigenvalues_on_gamma, fold_form, lambda_, mu_of_lambda, r_of_lambda

m, r = fold.m, route_r


def test_saddle_multiplier_is_that_of_the_homogeneous_model():
    half = sympy.Rational(1, 2)
    assert sympy.cancel(fold.N_r_at_fixed_points().subs(m, lambda_ + half) - mu_of_lambda(1)) == 0
    assert sympy.cancel(fold.r_of_m().subs(m, lambda_ + half) - r_of_lambda(1)) == 0
    assert sympy.cancel(mu_of_m().subs(swan_m, lambda_ - 1) - mu_of_lambda(2)) == 0
    assert sympy.cancel(r_of_m().subs(swan_m, lambda_ - 1) - r_of_lambda(2)) == 0


def test_swan_jacobian_at_the_fixed_point_is_f_prime_over_g_prime():
    f, g = f_map(), g_map()
    assert sympy.cancel(Dh_bar()[1, 1] - sympy.diff(f, swan_m) / sympy.diff(g, swan_m)) == 0
    assert sympy.cancel(h_bar() - (f - g.subs(swan_m, mbar)) * (1 + swan_m) ** 3) == 0


def test_h_prime_is_smooth_across_the_fixed_ray_of_the_axis():
    assert fold.h_blown_up()[1].subs({m: sympy.Rational(3, 2)}) == sympy.Rational(3, 2)


@pytest.mark.parametrize("order", [3, 4, 5])
def test_fold_form_leaves_nothing(order):
    form = fold_form(order)
    assert form.residual_vanishes
    assert form.invertible
    assert form.identity_order == 1


def test_outline_to_third_order():
    a2, f_v = sympy.Symbol("a_d2"), sympy.Symbol("f_01")
    outline = sympy.Poly(fold_form(4).outline, fold.sigma)
    assert sympy.expand(outline.coeff_monomial(fold.sigma**3) - sympy.Rational(3, 64) * (3 * a2 - 6 * f_v)) == 0


def test_equations_know_what_they_were_derived_from():
    fold.Q_r()
    assert {"e:pdef", "e:defq"} <= derived_from("e:qdef")
    assert watched(fold.Q_r)[1] == {"e:qdef"}


def test_an_equation_is_computed_once():
    calls = []
    once = equation("e:test")(lambda: calls.append(1) or 7)
    assert [once(), once()] == [7, 7]
    assert calls == [1]


def test_eigenvalue_on_gamma(reference):
    """The limit of the larger eigenvalue of DG along gamma is not 1."""
    for rate in ("0.1", "0.5", "0.9"):
        at = mpmath.findroot(
            sympy.lambdify(lambda_, r_of_lambda(1) - sympy.Rational(rate), "mpmath"), (0.01, 0.999), solver="anderson"
        )
        found = eigenvalues_on_gamma(1)[0].subs(lambda_, sympy.Float(at, 30)).evalf(15)
        assert abs(found - mpmath.mpf(reference[f"tangency.DGeig_big.r={rate}"])) < 1e-12
