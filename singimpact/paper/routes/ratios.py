"""Successive flights near a contact point at leading order, by the times of launch and landing relative to it.

Near a tangency (j = 1) or swan point (j = 2) a launch at sigma < 0 is written sigma = -S, its landing -l S.  Then

    v_c(-S, (1 - l) S) = b S^(j+1) (W(l) + O(S)),    x-dot at landing = -b S^(j+1) (U(l) + O(S)),

with b > 0 and O(S) smooth in (S, l), since v_c has the factor t and no terms of degree <= j.  The next landing ratio l1
solves l^(j+1) W(l1) = r U(l) + O(S).  For launches at sigma >= 0, and at a tangency with a' < 0, the forms of degree
j + 1 in (sigma, t) serve as they are.
"""

from typing import Any, NamedTuple

import sympy

from singimpact.algebra.derivations import At, substitution
from singimpact.paper.routes import fold, swan
from singimpact.paper.routes.equations import equation
from singimpact.paper.routes.implicit import X, Y, sigma, t

l = sympy.Symbol("l")  # noqa: E741 - the paper's letter is taken by the rays; landing time over launch time


class Speeds(NamedTuple):
    """Launch and landing speed of a flight, in units of b > 0: forms in (sigma, t), or polynomials in l."""

    launch: Any
    landing: Any


@equation("ratios-tangency")
def _at_tangency() -> Speeds:
    found = Speeds(*(sympy.expand(sign * part[1] / fold.k) for sign, part in ((1, fold.p()), (-1, fold.phi()))))
    substitution(At(fold.k * X, {X: found.launch}), fold.p()[1])
    substitution(At(-fold.k * X, {X: found.landing}), fold.phi()[1])
    return found


@equation("ratios-swan")
def _at_swan() -> Speeds:
    blown = (swan.p_blown_up()[1], -swan.phi_blown_up()[1])
    found = Speeds(*(sympy.expand(sympy.expand(sigma**3 * part.subs(swan.m, t / sigma))) for part in blown))
    for form, part in zip(found, blown, strict=True):
        substitution(At(form, {sigma: swan.s, t: swan.s * swan.m}), At(swan.s**3 * X, {X: part}))
    return found


def forms(j: int) -> Speeds:
    """Speeds of the flight from sigma that lands after t, in units of |a'|/6 (j = 1) or |a''|/24 (j = 2).

    The wall acceleration is a' sigma with a' > 0, or a'' sigma^2/2 with a'' < 0: negative for sigma < 0.

    Examples
    --------
    >>> forms(1).launch, forms(2).launch
    (-3*sigma*t - t**2, 6*sigma**2*t + 4*sigma*t**2 + t**3)
    """
    return _at_tangency() if j == 1 else _at_swan()


def by_ratio(j: int) -> Speeds:
    """(W, U): speeds of the flight from -1 to -l, in the units of `forms`.

    Examples
    --------
    >>> [sympy.factor(part) for part in by_ratio(1)]
    [-(l - 1)*(l + 2), -(l - 1)*(2*l + 1)]
    """
    flight = {sigma: sympy.Integer(-1), t: 1 - l}
    speeds = Speeds(*(sympy.expand(speed.subs(flight)) for speed in forms(j)))
    for form, speed in zip(forms(j), speeds, strict=True):
        substitution(At(form, flight), speed)
    return speeds


def reduced(j: int) -> Speeds:
    """(P, Q) with W = (1 - l) P and U = (1 - l) Q: v_c and the landing velocity have the factor t.

    Examples
    --------
    >>> reduced(2)
    Speeds(launch=l**2 + 2*l + 3, landing=3*l**2 + 2*l + 1)
    """
    speeds = Speeds(*(sympy.expand(sympy.cancel(speed / (1 - l))) for speed in by_ratio(j)))
    for whole, speed in zip(by_ratio(j), speeds, strict=True):
        substitution(At((1 - l) * X, {X: speed}), whole)
    return speeds


def restitution_of_ratio(j: int) -> Any:
    """r for which flights with the same ratio l follow one another: l^(j+1) P/Q.

    Examples
    --------
    >>> restitution_of_ratio(1)
    l**2*(l + 2)/(2*l + 1)
    """
    launch, landing = reduced(j)
    restitution = sympy.factor(l ** (j + 1) * launch / landing)
    substitution(At(X * by_ratio(j).landing, {X: restitution}), l ** (j + 1) * by_ratio(j).launch)
    return restitution


def multiplier(j: int) -> Any:
    """d l1/dl at l1 = l, the factor by which a small difference from gamma's ratio grows in one impact.

    Examples
    --------
    >>> multiplier(1)
    (l + 2)**2/(l*(2*l + 1)**2)
    """
    launch, landing = by_ratio(j)
    by_old = sympy.diff(l ** (j + 1), l) * launch - restitution_of_ratio(j) * sympy.diff(landing, l)
    factor_ = sympy.factor(sympy.cancel(-by_old / (l ** (j + 1) * sympy.diff(launch, l))))
    e = sympy.Symbol("e")  # a flight of ratio l + e is followed by one of ratio l + found e
    moved = At(l ** (j + 1) * launch.subs(l, X), {l: l + e, X: l + factor_ * e})
    again = At(X * landing.subs(l, Y), {Y: l + e, X: restitution_of_ratio(j)})
    substitution(moved, again, order=1, small=[e])
    return factor_
