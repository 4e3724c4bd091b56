"""The series of `si.theory`: for generic symbols, or for a model in the best numbers that it allows.

For a model they are exact when tau_* and lambda are, else mpmath numbers whose digits balls have certified.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from math import factorial
from typing import Any

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.horner import Horner
from singimpact.algebra.jets import Jet
from singimpact.algebra.rings import DOUBLES, EXACT
from singimpact.algebra.univariate import precision_of
from singimpact.contact.contact import TASK, Contact, contact_order, derivative_name
from singimpact.handed_on import sympy
from singimpact.inputs import InputError, checked_keywords, need, refuse, require, whole
from singimpact.oscillator.model import require_smooth_rho
from singimpact.theory.completion import by_velocity, rho_names, symbolic_completion, symbolic_curve
from singimpact.theory.contact_points import LetteredModel, Place, ending_gamma, exact_contact, multiplier, place
from singimpact.theory.gamma_series import InvariantCurve, invariant_curve
from singimpact.theory.impact_sheet import generic_sheet, sheet
from singimpact.theory.power_series import TRUST, PowerSeries, all_certified, all_digits, sympy_digits, with_digits


@dataclass(frozen=True)
class OrderLimits:
    """The highest orders taken: what a minute of one core reaches, with room.

    sheet, sheet_numbers : of v_c for symbols and for a model. curve, curve_numbers : of gamma. completion.
    constants : of gamma in exact constants that are not rational; above it they fill pages, and numbers are given.
    """

    sheet: int = 16
    sheet_numbers: int = 40
    curve: int = 10
    curve_numbers: int = 96
    completion: int = 8
    constants: int = 6
    completion_numbers: int = 24


LIMITS = OrderLimits()
TWO_DOUBLES = 34  # digits that two doubles hold
DOUBLE = 20  # digits of which a double is the correct rounding, but for one in a thousand


def _lettered(model: Any, tau: Any, keep: Sequence[str], j: int) -> LetteredModel | None:
    """The model whose parameters stay letters, when there are such."""
    if isinstance(keep, str) or keep:
        return LetteredModel(model, keep, j, tau)
    if model is None and tau is not None:
        raise refuse("tau", tau, "a model too: tau names a point of it")
    return None


@checked_keywords
def v_c(
    order: int = 6,
    at: str | int = "generic",
    model: Any = None,
    tau: Any = None,
    digits: int = 30,
    keep: Sequence[str] = (),
) -> Any:
    """v_c(tau_* + sigma, t) to total degree `order`, as a sympy expression [e:vtaylor, e:degen, e:swan].

    Parameters
    ----------
    order : int >= 1, total degree in (sigma, t) of the last term.
    at : "generic", "tangency", "swan" or a contact order.
    model : an oscillator; without one, symbols stand for the jets. tau : the point; without one the first point of
        the contact order with an invariant curve (at a regular point it must be given).
    digits : of the numbers, when they are not exact.
    keep : parameters of the model that stay letters; without tau the derivatives of a_c are then symbols too.

    Examples
    --------
    >>> v_c(order=1)
    -a*t/2
    >>> from singimpact.oscillator.model import Oscillator
    >>> v_c(order=3, at="swan", model=Oscillator("x", "cos(2*t)", 1, "1/2"), tau=0)
    sigma**2*t + 2*sigma*t**2/3 + t**3/6
    >>> v_c(order=3, at="swan", model=Oscillator("x", "b*t**2", 0, "1/2", {"b": 1}), tau=0, keep=["b"])
    -b*sigma**2*t/2 - b*sigma*t**2/3 - b*t**3/12
    """
    j = contact_order(at)
    lettered = _lettered(model, tau, keep, j)
    if lettered is not None or model is None:
        order = whole("order", order, 1, LIMITS.sheet)
        return _symbolic_v_c(j, order) if lettered is None else _long(sheet(lettered.contact(order), order).v)
    order = whole("order", order, 1, LIMITS.sheet_numbers)
    where = place(model, j, tau)
    exact = exact_contact(where, order)
    if exact is not None:
        return sheet(exact, order).v.to_sympy()
    return with_digits(
        lambda ring: sheet(where.contact(order, ring), order).v,
        digits,
        lambda jet, digits: jet.to_sympy(lambda ball: sympy_digits(ball, digits)),
        lambda jet: jet.terms.values(),
    )


@lru_cache(maxsize=32)
def _symbolic_v_c(j: int, order: int) -> Any:
    """v_c for symbols; sympy objects do not change, so one serves all who ask."""
    return _long(generic_sheet(j, order).v)


def _long(jet: Jet) -> Any:
    from singimpact.algebra.long_sums import LongSum

    return LongSum.of(jet.to_sympy())


@checked_keywords
def v_c_on_arrays(
    order: int = 8,
    at: str | int = "generic",
    model: Any = None,
    tau: Any = None,
    impact: bool = False,
    compensated: bool = False,
) -> Horner:
    """v_c of a model as a function of arrays (sigma, t) of doubles, its coefficients correctly rounded.

    Parameters
    ----------
    order, at, model, tau : as for `v_c`; the model is needed. impact : the impact velocity instead.
    compensated : keep full accuracy next to Z and P, where the terms cancel, at about ten times the cost.

    Returns
    -------
    callable : (sigma, t), broadcast arrays of doubles -> array of velocities.

    Examples
    --------
    >>> from singimpact.oscillator.model import Oscillator
    >>> v = v_c_on_arrays(3, "swan", Oscillator("x", "cos(2*t)", 1, "1/2"), tau=0)
    >>> v([0.5, 0.0], 0.6).round(12).tolist()
    [0.306, 0.036]
    """
    j, velocity = contact_order(at), "xdot" if impact else "v"
    order = whole("order", order, 1, LIMITS.sheet_numbers)
    where = place(model, j, tau)
    exact = exact_contact(where, order)
    if exact is not None and exact.ring is EXACT:
        return Horner(getattr(sheet(exact, order), velocity).terms, compensated)
    return with_digits(  # type: ignore[no-any-return]
        lambda ring: getattr(sheet(where.contact(order, ring), order), velocity),
        TWO_DOUBLES,
        lambda jet, _: Horner({key: as_rational(ball) for key, ball in jet.terms.items()}, compensated),
        lambda jet: jet.terms.values(),
    )


@checked_keywords
def gamma(
    order: int = 6,
    at: str | int = "tangency",
    model: Any = None,
    tau: Any = None,
    digits: int = 30,
    keep: Sequence[str] = (),
) -> PowerSeries:
    """The invariant curve: v as a series in sigma; without a model in lambda and the jets.

    Parameters
    ----------
    order : the last power of sigma, above the contact order. at : "tangency", "swan" or a contact order >= 1.
    model, tau, digits, keep : as for `v_c`; with letters, lambda stands for the restitution.

    Raises
    ------
    InputError : no gamma ends there: a^(j) < 0 at an odd contact order j (a foliation), a^(j) > 0 at an even one.

    Examples
    --------
    >>> gamma(order=2)[2]
    -a_d1*(lambda - 1)*(lambda + 2)/6
    >>> from singimpact.oscillator.model import Oscillator
    >>> import mpmath
    >>> mpmath.nstr(gamma(order=3, model=Oscillator("x", "cos(2*t)", "0.3", "1/2"))[3], 30)
    '-0.0677530338792073239024574139756'
    """
    return _curve_series("graph", order, _curved(at), model, tau, digits, keep)


@checked_keywords
def fibre(
    order: int = 6, model: Any = None, tau: Any = None, digits: int = 30, keep: Sequence[str] = ()
) -> PowerSeries:
    """The stable fibre at a regular point: v as a series in sigma, where chatter ends at sigma = 0.

    Examples
    --------
    >>> fibre(order=1)[1]
    a*(1/2 - lambda/2)
    """
    return _curve_series("graph", order, 0, model, tau, digits, keep)


@checked_keywords
def dynamics_on_gamma(
    order: int = 6,
    at: str | int = "tangency",
    model: Any = None,
    tau: Any = None,
    digits: int = 30,
    keep: Sequence[str] = (),
) -> PowerSeries:
    """The impact map on the invariant curve: the next sigma as a series in sigma.

    Examples
    --------
    >>> dynamics_on_gamma(order=2)[1]
    lambda
    """
    return _curve_series("motion", order, _curved(at), model, tau, digits, keep)


@checked_keywords
def chatter_limit(
    order: int = 6, model: Any = None, tau: Any = None, digits: int = 30, keep: Sequence[str] = ()
) -> PowerSeries:
    """Complete chatter from (tau, v): tau_inf - tau as a series in v.

    Parameters
    ----------
    order : the last power of v. model, digits, keep : as for `v_c`. tau : where the first flight starts, a_c(tau) < 0.

    Examples
    --------
    >>> chatter_limit(order=1)[1]
    2/(a*(lambda - 1))
    """
    lettered = _lettered(model, tau, keep, 0)
    if lettered is not None or model is None:
        return _with_letters("v", order, _symbolic_chatter(whole("order", order, 1, LIMITS.completion)), lettered)
    order = whole("order", order, 1, LIMITS.completion_numbers)
    need(tau is not None, InputError("tau is needed: give the time at which the first flight starts"))
    where = place(model, 0, tau)
    require_smooth_rho(model, TASK)
    multiplier(0, model.slope_at_rest())
    further = {n: abs(c) for n, c in _completed(where, order + TRUST.further, DOUBLES).items() if n > order}

    def enclosures(wanted: int) -> Any:
        return with_digits(lambda ring: _completed(where, order, ring), wanted, all_certified)

    try:
        numbers = {n: _shown(value) for n, value in _completed(where, order, EXACT).items()}
    except ArithmeticError:
        numbers = with_digits(lambda ring: _completed(where, order, ring), digits, all_digits)
    return PowerSeries("v", order, numbers, digits, further, enclosures=enclosures)


@lru_cache(maxsize=16)
def _symbolic_chatter(order: int) -> Mapping[int, Any]:
    return {n: symbolic_completion(order).to_sympy(n) for n in range(1, order + 1)}


def _completed(where: Place, order: int, ring: Any) -> dict[int, Any]:
    """n -> coefficient of v^n in tau_inf - tau."""
    with precision_of(ring):
        return by_velocity(where.contact(order, ring), where.restitution_in(ring), where.rho(order, ring), order)


def _curved(at: str | int) -> int:
    j = contact_order(at)
    require(j, "at", at, "'tangency', 'swan' or a contact order 1..12: at a regular point ask for fibre")
    return j


def _with_letters(
    variable: str, order: int, coefficients: Mapping[int, Any], lettered: LetteredModel | None
) -> PowerSeries:
    """A series in the generic symbols, or in the letters of a model."""
    if lettered is None:
        return PowerSeries(
            variable, order, dict(coefficients)
        )  # a copy, so that a change by the caller does not change the cached series
    put_in = lettered.put_in(order + lettered.j)
    return PowerSeries(variable, order, {n: put_in(value) for n, value in coefficients.items()})


def _curve_series(name: str, order: int, j: int, model: Any, tau: Any, digits: int, keep: Sequence[str]) -> PowerSeries:
    least = j + 1 if name == "graph" else 1
    order = whole("order", order, least, LIMITS.curve_numbers)
    top = order if name == "graph" else order + j
    lettered = _lettered(model, tau, keep, j)
    if lettered is not None or model is None:
        order = whole("order", order, least, LIMITS.curve - (name == "motion") * j)
        return _with_letters("sigma", order, _symbolic_part(name, j, top), lettered)
    order = whole("order", order, least, LIMITS.curve_numbers)
    where = ending_gamma(place(model, j, tau)) if j else place(model, j, tau)
    rough = getattr(curve_at(where, top + TRUST.further, DOUBLES), name)
    further = {n: abs(float(value)) for n, value in rough.items() if n > order}

    def coefficients(ring: Any) -> Any:
        return getattr(curve_at(where, top, ring), name)

    numbers = partial(with_digits, coefficients, digits, all_digits)
    enclosures = partial(with_digits, coefficients, show=all_certified)

    exact = _exact_curve(where, top, name)
    if exact is not None:
        return PowerSeries("sigma", order, exact, digits, further, numbers, enclosures)
    return PowerSeries("sigma", order, numbers(), digits, further, enclosures=enclosures)


@lru_cache(maxsize=32)
def _symbolic_part(part: str, j: int, order: int) -> Mapping[int, Any]:
    """The graph or the motion in lambda and the jets, from gamma to sigma^order."""
    symbolic = symbolic_curve(j, order)
    return {n: symbolic.to_sympy(value, int(part == "graph")) for n, value in getattr(symbolic, part).items()}


def arc_in_numbers(order: int, j: int, model: Any, tau: Any = None) -> tuple[PowerSeries, PowerSeries]:
    """The invariant curve and the motion on it in correctly rounded doubles: what `gamma` and `fibre` are at numbers.

    Parameters
    ----------
    order : the last power of sigma. j : contact order, 0 for the stable fibre. model, tau : as for `v_c`.

    Examples
    --------
    >>> from singimpact.oscillator.model import Oscillator
    >>> graph, motion = arc_in_numbers(3, 1, Oscillator("x", "cos(2*t)", "0.3", "1/2"))
    >>> round(graph[3], 15), round(motion[1], 15)
    (-0.067753033879207, 0.660442249723743)
    """
    order = whole("order", order, j + 1, LIMITS.curve_numbers)
    where = ending_gamma(place(model, j, tau)) if j else place(model, j, tau)
    rough = curve_at(where, order + j + TRUST.further, DOUBLES)

    def doubles(curve: InvariantCurve, _: int) -> list[PowerSeries]:
        return [
            PowerSeries(
                "sigma",
                order,
                {
                    n: 0.0 if ball.contains(0) else float(ball.mid())
                    for n, ball in getattr(curve, name).items()
                    if n <= order
                },
                DOUBLE,
                {n: abs(float(value)) for n, value in getattr(rough, name).items() if n > order},
            )
            for name in ("graph", "motion")
        ]

    graph, motion = with_digits(
        lambda ring: curve_at(where, order + j, ring),
        DOUBLE,
        doubles,
        lambda found: (*found.graph.values(), *found.motion.values()),
    )
    return graph, motion


def curve_at(where: Place, order: int, ring: Any) -> InvariantCurve:
    """The invariant curve to sigma^order at a place of a model, in balls or doubles.

    Examples
    --------
    >>> from singimpact.oscillator.model import Oscillator
    >>> found = curve_at(place(Oscillator("x", "cos(2*t)", "0.3", "1/2"), 1, None), 3, DOUBLES)
    >>> round(found.graph[3], 15), round(found.lambda_, 15)
    (-0.067753033879207, 0.660442249723743)
    """
    bits = ring.bits if isinstance(ring, Balls) else 64
    with precision_of(ring):
        require_smooth_rho(where.model, TASK)
        ball = multiplier(where.j, where.model.slope_at_rest(), bits)
        lambda_ = ball if isinstance(ring, Balls) else float(ball.mid())
        r = where.restitution_in(ring)
        return invariant_curve(where.contact(order, ring), lambda_, order, where.rho(order, ring), r)


def _exact_curve(where: Place, order: int, name: str) -> dict[int, Any] | None:
    """The coefficients as sympy numbers, when tau_* and lambda are exact."""
    require_smooth_rho(where.model, TASK)
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
        return {n: _shown(value) for n, value in getattr(curve, name).items()}
    # the generic series has no symbols for derivatives of f by t
    through = order <= LIMITS.constants and not where.model.parametric
    return _through_symbols(contact, lambda_, order, name, rho) if through else None


def _through_symbols(
    contact: Contact, lambda_: Fraction, order: int, quantity: str, rho: Mapping[int, Any]
) -> dict[int, Any]:
    """The curve for symbols in units of a_j, then the constants put in: a polynomial a_j has no inverse."""
    j, show = contact.order, contact.ring.to_sympy
    unit = Contact.generic(j, order, unit=True, more=rho_names(j, order))
    ring = unit.ring
    curve = invariant_curve(unit, lambda_, order, {int(n[4:]): ring.symbol(n) for n in rho_names(j, order)})
    length = show(contact.a[j])
    values = {sympy.Symbol(derivative_name(k)): show(c) * factorial(k) / length for k, c in contact.a.items() if k > j}
    for i, k in unit.f:
        jet = contact.f.get((i, k))
        shown = 0 if jet is None else show(jet) * factorial(i) * factorial(k) * length ** (i + k - 1)
        values[sympy.Symbol(f"f_{i}{k}")] = shown
    for name in rho_names(j, order):
        values[sympy.Symbol(name)] = _shown(rho.get(int(name[4:]), Fraction(0))) * length ** (int(name[4:]) - 1)
    scale = length if quantity == "graph" else 1
    return {n: sympy.expand(ring.to_sympy(value).subs(values) * scale) for n, value in getattr(curve, quantity).items()}


def _shown(value: Any) -> Any:
    return sympy.Rational(value.numerator, value.denominator)
