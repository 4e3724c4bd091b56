"""In which coordinates the impact is eta - sigma/2: those in which p still has higher terms, and no others."""

import sympy

from singimpact.paper import eta as fold_eta, next_sigma, psi_q
from singimpact.paper.routes.implicit import sigma
from singimpact.theory import fold_form

eta = fold_eta


def test_the_first_component_is_exact_before_the_higher_terms_are_removed():
    first, _ = psi_q()
    assert sympy.expand(first - (eta - sigma / 2)) == 0


def test_in_the_fold_form_without_higher_terms_it_has_quadratic_ones():
    """By the change of coordinates itself: sigma' = eta - sigma/2 with eta from T = source(sigma, eta)."""
    a2, f01 = sympy.symbols("a_d2 f_01")
    told = eta - sigma / 2 - (4 * (a2 + 6 * f01) * eta**2 - 2 * (a2 + 30 * f01) * eta * sigma
                              + 3 * (a2 + 6 * f01) * sigma**2) / 192  # fmt: skip
    assert sympy.expand(next_sigma() - told) == 0
    source = sympy.expand(fold_form(3).source)
    back = sympy.expand(next_sigma().subs(eta, source)) - (eta - sigma / 2)
    kept = [value for key, value in sympy.Poly(sympy.expand(back), sigma, eta).terms() if sum(key) <= 2]
    assert not any(kept)


def test_the_rate_along_gamma_is_the_same_in_both():
    m, s = sympy.symbols("m s")
    blown = sympy.cancel(next_sigma().subs({sigma: s, eta: s * m}, simultaneous=True) / s)
    assert sympy.expand(blown.subs(s, 0) - (m - sympy.Rational(1, 2))) == 0
