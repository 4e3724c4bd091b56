"""The next sigma in the coordinates of the fold form without higher terms: what the claims on psi q are read in."""

from typing import Any

import sympy

from singimpact.paper.routes.equations import equation
from singimpact.paper.routes.fold import eta
from singimpact.paper.routes.implicit import sigma
from singimpact.theory.plane_forms import fold_form


@equation("s4-next-sigma")
def next_sigma() -> Any:
    """The next sigma in the coordinates of the fold form without higher terms, to second order, lengths in units of k.

    In (sigma, eta), eta = 3 sigma/2 + t, it is eta - sigma/2 exactly; the source change eta -> T(sigma, eta) of
    `fold_form`, which keeps the phase sigma, gives it quadratic terms, so that s' = (m - 1/2) s + O(s^2) there.
    Another T that keeps sigma is (1 + c sigma + ...) T, which moves the term in sigma eta alone.

    Examples
    --------
    >>> poly = sympy.Poly(next_sigma(), sigma, eta)
    >>> poly.coeff_monomial(eta), poly.coeff_monomial(sigma), poly.coeff_monomial(eta**2)
    (1, -1/2, -a_d2/48 - f_01/8)
    """
    source = sympy.Poly(fold_form(3).source, sigma, eta)
    bent = sum(value * sigma**i * eta**n for (i, n), value in source.terms() if i + n == 2)
    return sympy.expand(eta - sigma / 2 - bent)


def next_sigma_remainder(leading: sympy.Expr) -> tuple[Any, dict[tuple[int, int], Any]]:
    """(lowest degree, its terms) of `next_sigma` minus a polynomial; the degree is oo where nothing is left.

    Examples
    --------
    >>> next_sigma_remainder(eta - sigma / 2)[0], next_sigma_remainder(next_sigma())[0]
    (2, oo)
    """
    terms = {key: value for key, value in sympy.Poly(next_sigma() - leading, sigma, eta).terms() if value != 0}
    lowest = min((sum(key) for key in terms), default=sympy.oo)
    return lowest, {key: value for key, value in terms.items() if sum(key) == lowest}
