"""`Contact`: the jets of an oscillator at a point of the tau-axis, zeros of its contact order first; rho at rest."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import factorial
from typing import Any

from singimpact.algebra.expressions import Expression, evaluate, number, substitute, subtract
from singimpact.algebra.jets import JetSpace
from singimpact.algebra.numbers import sign_of
from singimpact.algebra.puiseux import NoExpansion, Puiseux, expansion
from singimpact.algebra.rings import SymbolRing
from singimpact.algebra.taylor import NotSmooth
from singimpact.algebra.univariate import precision_of
from singimpact.inputs import InputError, refuse
from singimpact.oscillator.model import Oscillator, not_smooth, require_smooth_rho, require_smooth_text

TASK = "a power series"
NAMED_ORDERS = {"generic": 0, "regular": 0, "tangency": 1, "swan": 2}


def acceleration(oscillator: Oscillator, keep: Collection[str] = ()) -> Expression:
    """a_c(t) = g(t) - f(c, 0) as a tree in t, and in the parameters in `keep`.

    Examples
    --------
    >>> print(acceleration(Oscillator("x", "cos(2*t)", "0.3", 1)))
    cos(2*t) - 0.3
    """
    return rest_acceleration(oscillator.force(keep), oscillator.forcing(keep), oscillator.clearance)


def rest_acceleration(f: Expression, g: Expression, clearance: Expression) -> Expression:
    """g(t) - f(clearance, 0) as a tree, for any trees."""
    return subtract(g, substitute(f, {"x": clearance, "xdot": number(0)}))


def contact_order(at: str | int) -> int:
    """The contact order j that a name or a number means.

    Examples
    --------
    >>> contact_order("swan"), contact_order(3)
    (2, 3)
    """
    if isinstance(at, str) and at in NAMED_ORDERS:
        return NAMED_ORDERS[at]
    if isinstance(at, int) and not isinstance(at, bool) and 0 <= at <= 12:
        return at
    raise refuse("at", at, "'generic', 'tangency', 'swan' or a contact order 0..12")


def derivative_name(order: int) -> str:
    """The symbol for the derivative of a_c of this order at tau_*: a, a_d1, a_d2, ..."""
    return f"a_d{order}" if order else "a"


@dataclass(frozen=True)
class Contact:
    """Jets at a point of contact order j: a_0 = ... = a_{j-1} = 0, a_j != 0.

    Attributes
    ----------
    order : the contact order j.
    ring : the ring of the coefficients.
    a : k -> a^(k)(tau_*)/k!, from k = j on.
    f : (i, k) -> f_ik/(i! k!) at (c, 0), (0, 0) left out; where t occurs in f, at (c, 0, tau_*), with
        derivatives by t under (i, k, m) -> f_ikm/(i! k! m!), m >= 1.
    tau : the point as an exact constant; None for a generic one.
    """

    order: int
    ring: Any
    a: Mapping[int, Any]
    f: Mapping[tuple[int, ...], Any]
    tau: Expression | None = None

    @classmethod
    def generic(cls, j: int, order: int, unit: bool = False, more: tuple[str, ...] = ()) -> "Contact":
        """Symbols for all jets that the sheet to total order `order` contains.

        Parameters
        ----------
        unit : lengths measured so that a_j = 1. more : names that the ring has beside the jets.
        """
        powers = range(j, max(order, j + 1))
        pairs = _pairs(j, order)
        free = [k for k in powers if k > j or not unit]
        ring = SymbolRing((*(derivative_name(k) for k in free), *(f"f_{i}{k}" for i, k in pairs), *more))
        a = {k: ring.symbol(derivative_name(k)) * ring.rational(Fraction(1, factorial(k))) for k in free}
        f: dict[tuple[int, ...], Any] = {
            (i, k): ring.symbol(f"f_{i}{k}") * ring.rational(Fraction(1, factorial(i) * factorial(k))) for i, k in pairs
        }
        return cls(j, ring, {j: ring.rational(Fraction(1)), **a} if unit else a, f)

    @classmethod
    def of(cls, oscillator: Oscillator, tau: Any, j: int, order: int, ring: Any) -> "Contact":
        """The jets of a model at tau, evaluated in `ring`; the first j of a_c are set to zero.

        Parameters
        ----------
        tau : constant tree, or an element of the ring.
        """
        require_smooth_text(oscillator.force(), "f")
        require_smooth_text(oscillator.forcing(), "g")
        with precision_of(ring):
            a = acceleration_jet(oscillator, tau, max(order - 1, j), ring)
            f = force_jet(oscillator, j, order, ring, tau=tau)
        jets = {k: value for k, value in enumerate(a) if k >= j}
        if order > j and all(value == 0 for value in jets.values()):
            raise InputError(
                f"the contact order at tau = {tau} is above {max(order - 1, j)}: a_c vanishes to that order"
            )
        return cls(j, ring, jets, f, tau)


def _pairs(j: int, order: int) -> list[tuple[int, int]]:
    """Indices of the jets of f that enter the sheet to total order `order`: X has degree j + 2, X' degree j + 1."""
    return [(i, k) for i in range(order) for k in range(order) if i + k and i * (j + 2) + k * (j + 1) + 1 <= order]


def acceleration_jet(oscillator: Oscillator, tau: Any, order: int, ring: Any, keep: Collection[str] = ()) -> list[Any]:
    """a_c^(k)(tau)/k! for k = 0..order; parameters in `keep` are symbols of the ring."""
    start = evaluate(tau, {}, ring) if isinstance(tau, Expression) else tau
    space = JetSpace(("u",), order, ring)
    (u,) = space.generators() if order else (space.jet({}),)
    letters = {name: space.constant(ring.symbol(name)) for name in keep}
    jet = space.evaluate(acceleration(oscillator, keep), {"t": space.constant(start) + u, **letters})
    return [jet.coefficient((k,)) for k in range(order + 1)]


def force_jet(
    oscillator: Oscillator, j: int, order: int, ring: Any, keep: Collection[str] = (), tau: Any = None
) -> dict[tuple[int, ...], Any]:
    """(i, k) -> f_ik/(i! k!) at (c, 0), for the pairs that the sheet to total order `order` needs.

    Parameters
    ----------
    tau : the time at which f is developed, where t occurs in it: the keys are as those of `Contact.f`.
    """
    if oscillator.parametric:
        return _moving_force_jet(oscillator, j, order, ring, tau)
    pairs = _pairs(j, order)
    top = max((i + k for i, k in pairs), default=0)
    if not top:
        return {}
    space = JetSpace(("X", "V"), top, ring)
    X, V = space.generators()
    start = space.constant(evaluate(oscillator.clearance, {}, ring))
    letters = {name: space.constant(ring.symbol(name)) for name in keep}
    jet = space.evaluate(oscillator.force(keep), {"x": start + X, "xdot": V, **letters})
    return {pair: jet.terms[pair] for pair in pairs if pair in jet.terms}


def _moving_force_jet(oscillator: Oscillator, j: int, order: int, ring: Any, tau: Any) -> dict[tuple[int, ...], Any]:
    # sigma and t have degree 1, X and X' what they have on a flight; f is multiplied by t in the equation of the sheet
    space = JetSpace(("X", "V", "u"), max(order - 1, 1), ring, (j + 2, j + 1, 1))
    X, V, u = space.generators()
    start, place = (
        evaluate(each, {}, ring) if isinstance(each, Expression) else each for each in (tau, oscillator.clearance)
    )
    state = {"x": space.constant(place) + X, "xdot": V, "t": space.constant(start) + u}
    terms = space.evaluate(oscillator.force(), state).terms
    return {(i, k, m) if m else (i, k): value for (i, k, m), value in terms.items() if i + k}


def series_of_rho(osc: Oscillator, order: int, ring: Any) -> dict[int, Any]:
    """k -> coefficient of v^k in rho, for 1 <= k <= order, those that are not 0.

    Raises
    ------
    InputError : rho has powers of v that are not whole.
    ArithmeticError : a coefficient is not in the ring.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> series_of_rho(Oscillator("x", "cos(t)", 0, "-v*cos(sqrt(-v))"), 3, EXACT)
    {1: Fraction(-1, 1), 2: Fraction(-1, 2), 3: Fraction(-1, 24)}
    """
    require_smooth_rho(osc, TASK)
    space = JetSpace(("v",), order, ring)
    try:
        jet = space.evaluate(osc.rho(), {"v": space.generators()[0]})
        return {k: value for k in range(1, order + 1) if (value := jet.coefficient((k,))) != 0}
    except NotSmooth:  # a part of the formula is not smooth, although rho is: |v|, or cos(sqrt(-v))
        terms = {int(e): c for e, c in _rho_up_to(osc, order).terms if e <= order and sign_of(c)}
        return {k: (-1) ** k * evaluate(value, {}, ring) for k, value in terms.items()}


def _rho_up_to(osc: Oscillator, order: int) -> Puiseux:
    """rho(-w) up to w^order; parts of the formula have roots of w, so more terms of them are needed."""
    for more in (1, 2, 4):
        try:
            found = expansion(osc.rho(), "v", -1, more * (order + 2))
        except NoExpansion:
            break
        if found.whole and (found.bound is None or found.bound > order):
            return found
    raise not_smooth(osc, TASK)
