"""Germs of maps of the plane (u, t) -> (u, w(u, t)): recognised as fold, cusp, lips, beaks, swallowtail.

Not here: jets (`algebra`), the maps p and phi whose germs these are (`theory`), curves of singular points (`surface`).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.jets import Jet, JetSpace
from singimpact.algebra.polynomials import Exponents

# The normal form of a germ (u, t) -> (u, w(u, t)) with w(0, t) = lead t^m + ...: fold (m = 2), cusp (m = 3), and on.
#
# One theorem for all of them: w = lead (T^m + A_(m-2)(u) T^(m-2) + ... + A_1(u) T) + B(u) with a new coordinate T(u,
# t).  It is found one power of u after another: what is still missing there is divided by m T^(m-1), and the rest of
# that division is what A and B must take.


@dataclass(frozen=True)
class NormalForm:
    """psi o (u, w) o chi = (u, T^2) for a fold, (U, T^3 + U T) for a cusp, up to the order of w.

    Attributes
    ----------
    power : m. lead : w_0m.
    source : T(u, t), known to degree order - m + 1; the new source coordinates are (u, T), at a cusp (A_1(u), T).
    unfolding : i -> A_i(u), i = 1..m - 2. offset : B(u): the target change takes it off and divides by lead.
    residual : w - lead (T^m + sum A_i T^i) - B: zero when the form is reached.
    """

    power: int
    lead: Any
    source: Jet
    unfolding: Mapping[int, Jet]
    offset: Jet
    residual: Jet

    @property
    def reached(self) -> bool:
        """Whether nothing is left up to the order; with balls, nothing that is told from zero."""
        return all(_may_vanish(value) for value in self.residual.terms.values())

    @property
    def invertible(self) -> bool:
        """Whether both changes are: T by t, and at a cusp A_1 by u."""
        changes = [self.source.coefficient((0, 1)), *(part.coefficient((1, 0)) for part in self.unfolding.values())]
        return not any(_may_vanish(value) for value in changes)


def _may_vanish(value: Any) -> bool:
    return bool(value.contains(0)) if hasattr(value, "contains") else bool(value == 0)


def normal_form(w: Jet, power: int) -> NormalForm:
    """The form of a jet in two variables (u, t) with w_01 = ... = w_0(m-1) = 0 and w_0m invertible; m = power >= 2.

    Raises
    ------
    ArithmeticError : w_0m has no inverse in the ring.
    ValueError : a lower power of t alone occurs, or the order is below m.

    Examples
    --------
    >>> from singimpact.algebra.jets import JetSpace
    >>> from singimpact.algebra.rings import EXACT
    >>> u, t = JetSpace(("u", "t"), 4, EXACT).generators()
    >>> found = normal_form(t**3 + u * t + u * t * t, 3)
    >>> print(found.source, found.unfolding[1], found.offset, found.reached, sep="; ")
    (1/3)*u + t; u + (-1/3)*u**2; (-1/3)*u**2 + (2/27)*u**3; True
    """
    space, ring, top = w.space, w.space.ring, w.space.order
    if top < power or any(not _may_vanish(w.coefficient((0, k))) for k in range(1, power)):
        raise ValueError(f"w must be a jet of order >= {power} in which no power of t alone below {power} occurs")
    lead = w.coefficient((0, power))
    shape = w.scaled(ring.power(lead, Fraction(-1)))
    start = _root(_row(shape, 0)[power:], power, ring)  # T = t start(t) at u = 0
    source: dict[Exponents, Any] = {(0, k + 1): value for k, value in enumerate(start)}
    powers = _powers([*start, *[ring.rational(Fraction(0))] * power], power, ring)
    parts: list[dict[Exponents, Any]] = [{} for _ in range(power - 1)]
    for n in range(top + 1):
        missing = _row(shape - _form(space, source, parts), n)
        for i, jet in enumerate(parts):
            if missing:
                jet[(n, 0)] = missing[0]
                # (missing - missing[0] series)/t: the constant terms cancel
                missing = [value - missing[0] * term for value, term in zip(missing, powers[i], strict=False)][1:]
        for k, value in enumerate(_quotient(missing, powers[power - 1], ring)):
            step = value * ring.rational(Fraction(1, power))
            source[(n, k)] = source[(n, k)] + step if (n, k) in source else step
    residual = w - _form(space, source, parts).scaled(lead)
    unfolding = {i: space.jet(parts[i]) for i in range(1, power - 1)}
    truncated = space.to_order(top - power + 1)
    return NormalForm(power, lead, truncated.jet(source), unfolding, space.jet(parts[0]).scaled(lead), residual)


def _row(jet: Jet, n: int) -> list[Any]:
    """The coefficients of u^n t^k, k = 0, 1, ..."""
    return [jet.coefficient((n, k)) for k in range(jet.space.order - n + 1)]


def _form(space: JetSpace, source: Mapping[Exponents, Any], parts: Sequence[Mapping[Any, Any]]) -> Jet:
    """T^m + sum A_i T^i + B/lead."""
    T = space.jet(source)
    total = T ** (len(parts) + 1)
    for i, part in enumerate(parts):
        total = total + space.jet(part) * T**i
    return total


def _root(series: Sequence[Any], power: int, ring: Any) -> list[Any]:
    """The root of a series with constant term 1, by the recurrence that y' s power = s' y gives."""
    found = [ring.rational(Fraction(1))]
    for k in range(1, len(series)):
        rates = (ring.rational(Fraction(i - power * (k - i), power * k)) for i in range(1, k + 1))
        terms = (series[i] * found[k - i] * rate for i, rate in enumerate(rates, 1))
        found.append(sum(terms, ring.rational(Fraction(0))))
    return found


def _powers(series: Sequence[Any], count: int, ring: Any) -> list[list[Any]]:
    zero = ring.rational(Fraction(0))
    found = [[ring.rational(Fraction(1)), *[zero] * (len(series) - 1)]]
    for _ in range(count - 1):
        last = found[-1]
        found.append([sum((last[i] * series[k - i] for i in range(k + 1)), zero) for k in range(len(series))])
    return found


def _quotient(above: Sequence[Any], below: Sequence[Any], ring: Any) -> list[Any]:
    """The quotient of series, below with constant term 1, to the length that both know."""
    found: list[Any] = []
    for k in range(min(len(above), len(below))):
        known = (found[i] * below[k - i] for i in range(k))
        found.append(above[k] - sum(known, ring.rational(Fraction(0))))
    return found


# The singularity that a map (u, t) -> (u, w(u, t)) has at 0, read off the derivatives of w by real signs.

KINDS = ("regular", "fold", "cusp", "lips", "beaks", "swallowtail", "degenerate")


def sign(value: Any) -> int:
    """-1, 0 or 1; a ball that holds zero and more has no sign.

    Raises
    ------
    ArithmeticError : the sign is not decided.
    """
    if value > 0 or value < 0:
        return 1 if value > 0 else -1
    if value == 0:
        return 0
    raise ArithmeticError(f"the sign of {value} is not decided: more bits are needed")


def recognised(w: Jet, sign_of: Callable[[Any], int] = sign) -> str:
    """The kind of the germ of (u, w) at 0, for a jet in (u, t) known to order 4.

    Parameters
    ----------
    w : the jet. sign_of : decides signs of the ring's elements.

    Notes
    -----
    The singular set is w_t = 0.  It is smooth at fold, cusp (w = t^3 + u t) and swallowtail (t^4 + u t); at lips
    (t^3 + u^2 t) it is an isolated point, at beaks (t^3 - u^2 t) it crosses itself.

    Examples
    --------
    >>> from singimpact.algebra.jets import JetSpace
    >>> from singimpact.algebra.rings import EXACT
    >>> u, t = JetSpace(("u", "t"), 4, EXACT).generators()
    >>> [recognised(w) for w in (t * t, t**3 + u * t, t**3 + u * u * t, t**3 - u * u * t, t**4 + u * t)]
    ['fold', 'cusp', 'lips', 'beaks', 'swallowtail']
    """
    if w.space.order < 4:
        raise TypeError("a jet of order 4 is needed: the swallowtail shows there")

    def at(i: int, k: int) -> int:
        return sign_of(w.coefficient((i, k)))

    if at(0, 1):
        return "regular"
    if at(0, 2):
        return "fold"
    if at(1, 1):
        return "cusp" if at(0, 3) else "swallowtail" if at(0, 4) else "degenerate"
    # the Hessian of w_t, whose half is 3 w_03 t^2 + 2 w_12 u t + w_21 u^2
    third, mixed, slope = (w.coefficient(key) for key in ((0, 3), (1, 2), (2, 1)))
    definite = sign_of(third * slope * 3 - mixed * mixed) if at(0, 3) else 0
    return "lips" if definite > 0 else "beaks" if definite < 0 else "degenerate"
