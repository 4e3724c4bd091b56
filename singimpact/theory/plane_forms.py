"""Normal forms of p and phi, with the changes of source and target that reach them, as sympy expressions.

p is folded at a tangency point.  Its cusps lie off the tau-axis, where a flight lands on a tangency point at rest; the
cusps of phi are their mirror images under the involution.  At a cusp the germ is given by its own jets.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from typing import Any

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.algebra.gathering import gathering, remembered
from singimpact.algebra.jets import Jet, JetSpace
from singimpact.algebra.long_sums import LongSum
from singimpact.algebra.polynomials import Exponents
from singimpact.algebra.rings import EXACT, SymbolRing
from singimpact.contact.contact import Contact, contact_order, derivative_name
from singimpact.germs import NormalForm, normal_form as reduced
from singimpact.inputs import InputError, checked_keywords, refuse, require, whole
from singimpact.theory.completion import length_weight
from singimpact.theory.contact_points import exact_contact, place
from singimpact.theory.impact_sheet import Sheet, sheet
from singimpact.theory.power_series import sympy_digits, with_digits

HIGHEST = {"tangency": 12, "cusp": 8}  # for symbols: seconds; each order takes about twice the one before
HIGHEST_NUMBERS = 30


# The fold form of p at a tangency point to any order, with the changes of source and target that reach it. The true
# fold coordinate is T with v_c - P(sigma) = -k T^2: P is the outline, T = eta + ... vanishes on the horizon. Lengths
# are measured in units of k = a'/6 (x -> x/k scales the jets of f with it), so that everything is a polynomial in the
# jets.

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
        return LongSum.of(sympy.expand(unit * self.outline.subs(jets, simultaneous=True)))


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
    return {key: value for key, value in sympy.Poly(folded, sigma, eta).terms() if sum(key) == 3}


@remembered
def fold_form(order: int) -> FoldForm:
    """The fold form to total degree `order` >= 3.

    Examples
    --------
    >>> fold_form(4).normal, fold_form(4).residual_vanishes, fold_form(4).identity_order
    ((sigma, -eta**2*k), True, 1)
    """
    sheet_ = _sheet(order)
    form = reduced(sheet_.v, 2)
    source = _in_eta(form.source)
    bent = source - source.space.generators()[1]
    lead = sheet_.contact.ring.to_sympy(form.lead)
    shown, outline = _shown(source, sheet_), sheet_.to_sympy(form.offset)
    if gathering():  # p in the old coordinates is the fold in the new ones
        in_old = At(sheet_.to_sympy(sheet_.v), {t: eta - 3 * sigma / 2})
        substitution(At(lead * T**2 + outline, {T: shown}), in_old, order=order, small=[sigma, eta])
    return FoldForm(
        order=order,
        source=LongSum.of(shown),
        outline=LongSum.of(outline),
        normal=(sigma, sympy.expand(k * (sheet_.to_sympy(form.residual) + lead * eta**2))),
        residual_vanishes=form.reached,
        invertible=form.invertible and form.offset.coefficient((1, 0)) == 0,
        identity_order=min(bent.parts) - 1,
    )


@dataclass(frozen=True)
class ShownForm:
    """psi o (u, w) = (u, T^2) or (A, T^3 + A T) up to the order; psi takes off the offset and divides by lead.

    Attributes
    ----------
    kind : "fold" or "cusp". order : the last degree reached.
    source : T(u, t). unfolding : A(u) at a cusp, else None. offset : B(u), the outline of p at a fold. lead : w_0m.
    normal : the form reached. residual_vanishes, invertible : what was checked of it.
    """

    kind: str
    order: int
    source: Any
    unfolding: Any
    offset: Any
    lead: Any
    normal: tuple[Any, Any]
    residual_vanishes: bool
    invertible: bool


@checked_keywords
def normal_form(
    order: int = 4, at: str | int = "tangency", model: Any = None, tau: Any = None, digits: int = 30
) -> FoldForm | ShownForm:
    """The fold form of p at a tangency, or the cusp form of p or phi at a cusp, to total degree `order`.

    Parameters
    ----------
    order : int >= 3. at : "tangency" (or 1) or "cusp".
    model, tau, digits : at a tangency, as for `v_c`; the form is then in (sigma, t) with numbers.

    Returns
    -------
    FoldForm for symbols at a tangency, in (sigma, eta); else ShownForm.  At a cusp the germ is (u, w(u, t)), where u
    is what p or phi keeps, t runs along the kernel, and w_ik are the coefficients of w, in units of w_03.

    Examples
    --------
    >>> normal_form(order=3).normal
    (sigma, -eta**2*k)
    >>> cusp = normal_form(order=3, at="cusp")
    >>> cusp.normal, cusp.source
    ((U, T**3 + T*U), t + u*w_12/3)
    """
    name = "cusp" if at == "cusp" else "tangency"
    if name == "tangency" and contact_order(at) != 1:
        raise refuse("at", at, "'tangency' or 'cusp': where p or phi has a normal form")
    order = whole("order", order, 3, HIGHEST[name] if model is None else HIGHEST_NUMBERS)
    if model is not None:
        if name == "cusp":
            raise InputError("at = 'cusp' takes no model: the cusps of a model are among its singular points")
        return _of_model(order, model, tau, digits)
    require(tau is None, "tau", tau, "a model too: tau names a point of it")
    return fold_form(order) if name == "tangency" else cusp_form(order)


@lru_cache(maxsize=8)
def cusp_form(order: int) -> ShownForm:
    """The cusp form of a germ whose coefficients are symbols, w_03 = 1."""
    keys = [(i, n - i) for n in range(1, order + 1) for i in range(n + 1) if (i, n - i) not in ((0, 1), (0, 2), (0, 3))]
    ring = SymbolRing(tuple(f"w_{i}{k}" for i, k in keys))
    space = JetSpace(("u", "t"), order, ring)
    germ: dict[Exponents, Any] = {key: ring.symbol(name) for key, name in zip(keys, ring.names, strict=True)}
    return shown_form(reduced(space.jet({(0, 3): ring.rational(Fraction(1)), **germ}), 3))


def _of_model(order: int, model: Any, tau: Any, digits: int) -> ShownForm:
    """The fold form of p at a tangency point of a model: exact where the jets are rational, else with digits."""
    where = place(model, 1, tau)
    contact = exact_contact(where, order)
    if contact is not None and contact.ring is EXACT:
        return shown_form(reduced(sheet(contact, order).v, 2))

    def shown(found: NormalForm, digits: int) -> ShownForm:
        return shown_form(found, lambda ball: sympy_digits(ball, digits))

    return with_digits(  # type: ignore[no-any-return]
        lambda ring: reduced(sheet(where.contact(order, ring), order).v, 2),
        digits,
        shown,
        lambda form: [form.lead, *form.source.terms.values(), *form.offset.terms.values()],
    )


def shown_form(form: NormalForm, number: Callable[[Any], Any] | None = None) -> ShownForm:
    """A normal form of `germs` in sympy.

    Parameters
    ----------
    number : shows a coefficient; without it the ring's own way.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> u, t = JetSpace(("u", "t"), 4, EXACT).generators()
    >>> shown_form(reduced(t * t + u * t, 2)).offset
    -u**2/4
    """
    jets = [form.source, form.offset, *form.unfolding.values(), form.residual]
    source, offset, *unfolding, residual = (jet.to_sympy(number) for jet in jets)
    lead = form.source.space.constant(form.lead).to_sympy(number)
    T, U, u = sympy.Symbol("T"), sympy.Symbol("U"), sympy.Symbol(form.source.space.variables[0])
    left = 0 if form.reached else residual / lead
    return ShownForm(
        kind={2: "fold", 3: "cusp"}[form.power],
        order=form.residual.space.order,
        source=source,
        unfolding=unfolding[0] if unfolding else None,
        offset=offset,
        lead=lead,
        normal=(U, T**3 + U * T + left) if unfolding else (u, T**2 + left),
        residual_vanishes=form.reached,
        invertible=form.invertible,
    )
