"""The fold form of p at a tangency point to any order, with the changes of source and target that reach it.

eta -> the true fold coordinate eta sqrt(E), where v_c - P(sigma) = -k eta^2 E, E(0, 0) = 1: P is the outline, eta
counted from the true horizon.  Lengths are measured in units of k = a'/6 (x -> x/k scales the jets of f with it), so
that everything is a polynomial in the jets.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import sympy
from sympy.polys.rings import ring

from singimpact.theory.fold_route import eta, k
from singimpact.theory.implicit_route import a_symbol, sigma, t
from singimpact.theory.sheet import generic_sheet


@dataclass(frozen=True)
class FoldForm:
    """psi o p = (sigma, -w^2) in units of k: w = source(sigma, eta), psi(u, v) = (u, v - outline(u)).

    Attributes
    ----------
    order : the last degree reached. source, outline : the changes. normal : the form reached, k put back.
    residual_vanishes : psi o p + source^2 has no term up to the order. invertible : both changes are.
    identity_order : up to this order the source change agrees with the identity.
    """

    order: int
    source: Any
    outline: Any
    normal: tuple[Any, Any]
    residual_vanishes: bool
    invertible: bool
    identity_order: int


def _velocity(order: int) -> Any:
    """v_c/k at a tangency to a total degree, in (sigma, eta), lengths in units of k."""
    sheet = generic_sheet(1, order)
    return sympy.expand(sheet.to_sympy(sheet.v).subs(a_symbol(1), 6).subs(t, eta - 3 * sigma / 2))


def cubic_terms() -> dict[tuple[int, int], Any]:
    """The terms of degree 3 of p in (sigma, eta), lengths in units of k: exponents -> coefficient."""
    poly = sympy.Poly(_velocity(3), sigma, eta)
    return {key: value for key, value in poly.terms() if sum(key) == 3}


@lru_cache(maxsize=8)
def fold_form(order: int) -> FoldForm:
    """The fold form to total degree `order` >= 3.

    Examples
    --------
    >>> fold_form(4).normal, fold_form(4).residual_vanishes, fold_form(4).identity_order
    ((sigma, -eta**2*k), True, 1)
    """
    velocity = _velocity(order)
    names = sorted(velocity.free_symbols - {sigma, eta}, key=str)
    domain, S, E = ring([sigma, eta], sympy.QQ[tuple(names)])

    def cut(poly: Any, top: int) -> Any:
        return domain.from_dict({key: value for key, value in poly.items() if sum(key) <= top})

    v = domain.from_expr(velocity)
    horizon = _horizon(v, E, cut, order)
    outline = cut(v.compose(E, horizon), order)
    shifted = cut(v.compose(E, E + horizon) - outline, order)  # eta from the true horizon
    body = domain.from_dict({(i, j - 2): -value for (i, j), value in shifted.items()})
    root = _square_root(body, cut, order - 2)
    source = cut((E * root).compose(E, E - horizon), order - 1)
    residual = cut(v - outline + source**2, order)
    return FoldForm(
        order=order,
        source=source.as_expr(),
        outline=outline.as_expr(),
        normal=(sigma, sympy.expand(k * (residual - E**2).as_expr())),
        residual_vanishes=not residual,
        invertible=source.coeff(E) == 1 and source.coeff(S) == 0 and outline.coeff(S) == 0,
        identity_order=min(sum(key) for key in source - E) - 1,
    )


def _horizon(v: Any, E: Any, cut: Any, order: int) -> Any:
    """eta on the horizon as a series in sigma: dv/deta = 0, whose linear part is -2 eta."""
    slope = v.diff(E)
    found = E * 0
    for degree in range(2, order):
        found = cut(found + slope.compose(E, found) / 2, degree)
    return found


def _square_root(body: Any, cut: Any, order: int) -> Any:
    """The root of a series with constant term 1, by Newton's method for the inverse root."""
    inverse, reach = body**0, 0
    while reach < order:
        reach = 2 * reach + 1
        inverse = cut(inverse * (3 - cut(body * inverse**2, order)) / 2, order)
    return cut(body * inverse, order)
