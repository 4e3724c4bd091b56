"""What `si.theory` answers: series for generic symbols, or for a model in the best numbers that it allows.

For a model they are exact when tau_* and lambda are, else mpmath numbers whose digits balls have certified.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, factorial
from typing import Any

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.certified import Certified, as_certified
from singimpact.algebra.rings import DOUBLES, EXACT
from singimpact.algebra.univariate import precision_of
from singimpact.contact.contact import Contact, contact_order, derivative_name
from singimpact.inputs import InputError, refuse
from singimpact.theory.completion import leaves, symbolic_completion
from singimpact.theory.invariant_curve import InvariantCurve, invariant_curve
from singimpact.theory.places import Place, exact_contact, multiplier, place
from singimpact.theory.power_series import TRUST, PowerSeries
from singimpact.theory.sheet import generic_sheet, sheet
from singimpact.theory.symbolic_curve import rho_names, symbolic_curve


@dataclass(frozen=True)
class OrderLimits:
    """The highest orders taken: what a minute of one core reaches, with room.

    sheet, sheet_numbers : of v_c for symbols and for a model. curve, curve_numbers : of gamma. completion, digits.
    constants : of gamma in exact constants that are not rational; above it they fill pages, and numbers are given.
    """

    sheet: int = 16
    sheet_numbers: int = 40
    curve: int = 10
    curve_numbers: int = 96
    completion: int = 8
    constants: int = 6
    completion_numbers: int = 24
    digits: int = 2000
    bits: int = 1 << 16


LIMITS = OrderLimits()


def _checked(name: str, value: Any, least: int, most: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise refuse(name, value, f"an integer from {least} to {most}")
    return value


def _without_model(tau: Any) -> None:
    if tau is not None:
        raise refuse("tau", tau, "a model too: tau names a point of it")


def v_c(order: int = 6, at: str | int = "generic", model: Any = None, tau: Any = None, digits: int = 30) -> Any:
    """v_c(tau_* + sigma, t) to total degree `order`, as a sympy expression [e:vtaylor, e:degen, e:swan].

    Parameters
    ----------
    order : int >= 1, total degree in (sigma, t) of the last term.
    at : "generic", "tangency", "swan" or a contact order.
    model : an oscillator; without one, symbols stand for the jets. tau : the point; without one the first point of
        the contact order with an invariant curve (at a regular point it must be given).
    digits : of the numbers, when they are not exact.

    Examples
    --------
    >>> v_c(order=1)
    -a*t/2
    >>> from singimpact.oscillator.model import Oscillator
    >>> v_c(order=3, at="swan", model=Oscillator("x", "cos(2*t)", 1, "1/2"), tau=0)
    sigma**2*t + 2*sigma*t**2/3 + t**3/6
    """
    j = contact_order(at)
    if model is None:
        _without_model(tau)
        found = generic_sheet(j, _checked("order", order, 1, LIMITS.sheet))
        return found.to_sympy(found.v)
    _checked("order", order, 1, LIMITS.sheet_numbers)
    where = place(model, j, tau)
    exact = exact_contact(where, order)
    if exact is not None:
        found = sheet(exact, order)
        return found.to_sympy(found.v)
    return _with_digits(lambda ring: sheet(where.contact(order, ring), order).v.terms, digits, _expression)


def _expression(terms: Mapping[tuple[int, ...], Any], digits: int) -> Any:
    import sympy

    sigma, t = sympy.symbols("sigma t")
    return sympy.Add(*(sympy.Float(_mpf(ball, digits), digits) * sigma**i * t**k for (i, k), ball in terms.items()))


def gamma(
    order: int = 6, at: str | int = "tangency", model: Any = None, tau: Any = None, digits: int = 30
) -> PowerSeries:
    """The invariant curve: v as a series in sigma; without a model in lambda and the jets.

    Parameters
    ----------
    order : the last power of sigma, above the contact order. at : "tangency", "swan" or a contact order >= 1.
    model, tau, digits : as for `v_c`.

    Examples
    --------
    >>> gamma(order=2)[2]
    -a_d1*(lambda - 1)*(lambda + 2)/6
    >>> from singimpact.oscillator.model import Oscillator
    >>> import mpmath
    >>> mpmath.nstr(gamma(order=3, model=Oscillator("x", "cos(2*t)", "0.3", "1/2"))[3], 30)
    '-0.0677530338792073239024574139756'
    """
    return _curve_series("graph", order, _curved(at), model, tau, digits)


def fibre(order: int = 6, model: Any = None, tau: Any = None, digits: int = 30) -> PowerSeries:
    """The stable fibre at a regular point: v as a series in sigma, where chatter ends at sigma = 0.

    Examples
    --------
    >>> fibre(order=1)[1]
    a*(1/2 - lambda/2)
    """
    return _curve_series("graph", order, 0, model, tau, digits)


def dynamics_on_gamma(
    order: int = 6, at: str | int = "tangency", model: Any = None, tau: Any = None, digits: int = 30
) -> PowerSeries:
    """The impact map on the invariant curve: the next sigma as a series in sigma.

    Examples
    --------
    >>> dynamics_on_gamma(order=2)[1]
    lambda
    """
    return _curve_series("motion", order, _curved(at), model, tau, digits)


def chatter_limit(order: int = 6, model: Any = None, tau: Any = None, digits: int = 30) -> PowerSeries:
    """Complete chatter from (tau, v): tau_inf - tau as a series in v.

    Parameters
    ----------
    order : the last power of v. model, digits : as for `v_c`. tau : where the first flight starts, a_c(tau) < 0.

    Examples
    --------
    >>> chatter_limit(order=1)[1]
    2/(a*(lambda - 1))
    """
    if model is None:
        _without_model(tau)
        found = symbolic_completion(_checked("order", order, 1, LIMITS.completion))
        return PowerSeries("v", order, {n: found.to_sympy(n) for n in range(1, order + 1)})
    _checked("order", order, 1, LIMITS.completion_numbers)
    if tau is None:
        raise InputError("tau is needed: give the time at which the first flight starts")
    where = place(model, 0, tau)
    multiplier(0, model.slope_at_rest())
    further = {n: abs(c) for n, c in _completed(where, order + TRUST.further, DOUBLES).items() if n > order}

    def enclosures(wanted: int) -> Any:
        return _with_digits(lambda ring: _completed(where, order, ring), wanted, _enclosed)

    try:
        numbers = {n: _shown(value) for n, value in _completed(where, order, EXACT).items()}
    except ArithmeticError:
        numbers = _with_digits(lambda ring: _completed(where, order, ring), digits, _mpfs)
    return PowerSeries("v", order, numbers, digits, further, enclosures=enclosures)


def _completed(where: Place, order: int, ring: Any) -> dict[int, Any]:
    """n -> coefficient of v^n in tau_inf - tau."""
    with precision_of(ring):
        r = where.restitution_in(ring)
        contact = where.contact(order, ring)
        one = ring.rational(Fraction(1))
        found = leaves(sheet(contact, order), r, lambda n: ring.power(one - r**n, Fraction(-1)), where.rho(order, ring))
        return {n: found[(0, n)] for n in range(1, order + 1)}


def _curved(at: str | int) -> int:
    j = contact_order(at)
    if not j:
        raise refuse("at", at, "'tangency', 'swan' or a contact order 1..12: at a regular point ask for fibre")
    return j


def _curve_series(part: str, order: int, j: int, model: Any, tau: Any, digits: int) -> PowerSeries:
    least = j + 1 if part == "graph" else 1
    top = order if part == "graph" else order + j
    if model is None:
        _without_model(tau)
        _checked("order", order, least, LIMITS.curve - (part == "motion") * j)
        symbolic = symbolic_curve(j, top)
        known = getattr(symbolic, part)
        length = int(part == "graph")
        return PowerSeries("sigma", order, {n: symbolic.to_sympy(value, length) for n, value in known.items()})
    _checked("order", order, least, LIMITS.curve_numbers)
    where = place(model, j, tau)
    rough = getattr(_curve(where, top + TRUST.further, DOUBLES), part)
    further = {n: abs(float(value)) for n, value in rough.items() if n > order}

    def numbers() -> Any:
        return _with_digits(lambda ring: getattr(_curve(where, top, ring), part), digits, _mpfs)

    def enclosures(wanted: int) -> Any:
        return _with_digits(lambda ring: getattr(_curve(where, top, ring), part), wanted, _enclosed)

    exact = _exact_curve(where, top, part)
    if exact is not None:
        return PowerSeries("sigma", order, exact, digits, further, numbers, enclosures)
    return PowerSeries("sigma", order, numbers(), digits, further, enclosures=enclosures)


def _curve(where: Place, order: int, ring: Any) -> InvariantCurve:
    """The curve in balls or doubles."""
    bits = ring.bits if isinstance(ring, Balls) else 64
    with precision_of(ring):
        found = multiplier(where.j, where.model.slope_at_rest(), bits)
        lambda_ = found if isinstance(ring, Balls) else float(found.mid())
        r = where.restitution_in(ring)
        return invariant_curve(where.contact(order, ring), lambda_, order, where.rho(order, ring), r)


def _exact_curve(where: Place, order: int, part: str) -> dict[int, Any] | None:
    """The coefficients as sympy numbers, when tau_* and lambda are exact."""
    lambda_ = multiplier(where.j, where.model.slope_at_rest())
    contact = exact_contact(where, order) if lambda_ is not None else None
    if contact is None or lambda_ is None:
        return None
    try:
        rho = where.rho(order, EXACT)
    except ArithmeticError:
        return None
    if contact.ring is EXACT:
        curve = invariant_curve(contact, lambda_, order, rho)
        return {n: _shown(value) for n, value in getattr(curve, part).items()}
    return _through_symbols(contact, lambda_, order, part, rho) if order <= LIMITS.constants else None


def _through_symbols(
    contact: Contact, lambda_: Fraction, order: int, part: str, rho: Mapping[int, Any]
) -> dict[int, Any]:
    """The curve for symbols in units of a_j, then the constants put in: a polynomial a_j has no inverse."""
    import sympy

    j, show = contact.order, contact.ring.to_sympy
    unit = Contact.generic(j, order, unit=True, more=rho_names(j, order))
    ring = unit.ring
    found = invariant_curve(unit, lambda_, order, {int(n[4:]): ring.symbol(n) for n in rho_names(j, order)})
    length = show(contact.a[j])
    values = {sympy.Symbol(derivative_name(k)): show(c) * factorial(k) / length for k, c in contact.a.items() if k > j}
    for i, k in unit.f:
        jet = contact.f.get((i, k))
        shown = 0 if jet is None else show(jet) * factorial(i) * factorial(k) * length ** (i + k - 1)
        values[sympy.Symbol(f"f_{i}{k}")] = shown
    for name in rho_names(j, order):
        values[sympy.Symbol(name)] = _shown(rho.get(int(name[4:]), Fraction(0))) * length ** (int(name[4:]) - 1)
    scale = length if part == "graph" else 1
    return {n: sympy.expand(ring.to_sympy(value).subs(values) * scale) for n, value in getattr(found, part).items()}


def _shown(value: Any) -> Any:
    import sympy

    return sympy.Rational(value.numerator, value.denominator)


def _with_digits(compute: Any, digits: int, show: Any) -> Any:
    """What `compute(ring)` gives in balls, at growing precision until each number has its digits."""
    _checked("digits", digits, 1, LIMITS.digits)
    bits = ceil(digits * 3.33) + 128
    while bits <= LIMITS.bits:
        with precision_of(Balls(bits)):
            found = compute(Balls(bits))
        if all(as_certified(ball, digits) is not None for ball in found.values()):
            return show(found, digits)
        bits *= 2
    raise InputError(f"{digits} digits are not reached with {LIMITS.bits} bits: ask for fewer, or a lower order")


def _enclosed(found: Mapping[int, Any], digits: int) -> dict[int, Certified | None]:
    return {n: as_certified(ball, digits) for n, ball in found.items()}


def _mpfs(found: Mapping[int, Any], digits: int) -> dict[int, Any]:
    return {n: _mpf(ball, digits) for n, ball in found.items()}


def _mpf(ball: Any, digits: int) -> Any:
    """A ball as an mpmath number with this many digits; zero when it holds zero, for then it is far below them."""
    import mpmath

    with mpmath.workdps(digits + 3):
        value = Fraction(0) if ball.contains(0) else as_rational(ball)
        return mpmath.mpf(value.numerator) / value.denominator
