"""The fold form of p at a tangency point to any order, with the changes of source and target that reach it.

The true fold coordinate is T with v_c - P(sigma) = -k T^2: P is the outline, T = eta + ... vanishes on the horizon.
Lengths are measured in units of k = a'/6 (x -> x/k scales the jets of f with it), so that everything is a polynomial
in the jets.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.algebra.gathering import gathering, remembered
from singimpact.algebra.jets import Jet
from singimpact.contact.contact import Contact, derivative_name
from singimpact.germs.germ_forms import normal_form
from singimpact.theory.gamma_in_symbols import length_weight
from singimpact.theory.impact_sheet import Sheet, sheet

sigma, t, eta, k = sympy.symbols("sigma t eta k")
T = sympy.Symbol("T")  # the true fold coordinate, in certificates


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

    @property
    def outline_of_p(self) -> Any:
        """The outline v = P(sigma) in the jets as they are, no unit of length taken out.

        Examples
        --------
        >>> sympy.Poly(fold_form(3).outline_of_p, sigma).coeff_monomial(sigma**2)
        3*a_d1/8
        """
        unit = sympy.Symbol(derivative_name(1)) / 6
        names = [str(letter) for letter in self.outline.free_symbols - {sigma}]
        jets = {sympy.Symbol(name): sympy.Symbol(name) * unit ** length_weight(name) for name in names}
        return sympy.expand(unit * self.outline.subs(jets, simultaneous=True))


def _sheet(order: int) -> Sheet:
    """The sheet at a tangency to a total degree, lengths in units of k: a' = 6."""
    contact = Contact.generic(1, order, unit=True)
    return sheet(replace(contact, a={**contact.a, 1: contact.ring.rational(Fraction(6))}), order)


def _in_eta(jet: Jet) -> Jet:
    """A jet in (sigma, t) with t = eta - 3 sigma/2; its second variable is then eta."""
    first, second = jet.space.generators()
    return jet.compose((first, second - first.scaled(Fraction(3, 2))))


def _shown(jet: Jet, made: Sheet) -> Any:
    return made.to_sympy(jet).xreplace({t: eta})


@remembered
def cubic_terms() -> dict[tuple[int, int], Any]:
    """The terms of degree 3 of p in (sigma, eta), lengths in units of k: exponents -> coefficient."""
    made = _sheet(3)
    folded = _shown(_in_eta(made.v), made)
    substitution(At(made.to_sympy(made.v), {t: eta - 3 * sigma / 2}), folded)
    poly = sympy.Poly(folded, sigma, eta)
    return {key: value for key, value in poly.terms() if sum(key) == 3}


@remembered
def fold_form(order: int) -> FoldForm:
    """The fold form to total degree `order` >= 3.

    Examples
    --------
    >>> fold_form(4).normal, fold_form(4).residual_vanishes, fold_form(4).identity_order
    ((sigma, -eta**2*k), True, 1)
    """
    sheet_ = _sheet(order)
    form = normal_form(sheet_.v, 2)
    source = _in_eta(form.source)
    bent = source - source.space.generators()[1]
    lead = sheet_.contact.ring.to_sympy(form.lead)
    shown, outline = _shown(source, sheet_), sheet_.to_sympy(form.offset)
    if gathering():  # p in the old coordinates is the fold in the new ones
        in_old = At(sheet_.to_sympy(sheet_.v), {t: eta - 3 * sigma / 2})
        substitution(At(lead * T**2 + outline, {T: shown}), in_old, order=order, small=[sigma, eta])
    return FoldForm(
        order=order,
        source=shown,
        outline=outline,
        normal=(sigma, sympy.expand(k * (sheet_.to_sympy(form.residual) + lead * eta**2))),
        residual_vanishes=form.reached,
        invertible=form.invertible and form.offset.coefficient((1, 0)) == 0,
        identity_order=min(bent.parts) - 1,
    )
