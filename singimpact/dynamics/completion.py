"""The completion map: when infinitely many impacts accumulate, from the sheet's series at a regular point.

In (sigma, t), launch phase and flight time, the accumulation time M is invariant: M(sigma - t, t) = M(sigma, t') with
v_c(sigma, t') = rho(v_c(sigma, -t)).  Power by power in t this is linear in the next coefficient, with factor 1 - r^n.
"""

from __future__ import annotations

from fractions import Fraction
from math import comb
from typing import Any

from singimpact.algebra.expressions import evaluate, names_in
from singimpact.algebra.jets import Jet, JetSpace
from singimpact.contact.contact import Contact
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.rho_series import series_of_rho
from singimpact.theory.impact_sheet import sheet


def completion(osc: Oscillator, tau: Any, order: int, ring: Any) -> list[Any]:
    """c_1, ..., c_order of tau_inf - tau = c_1 t + c_2 t^2 + ..., t the time of the flight that starts at tau.

    Parameters
    ----------
    osc : the model; r < 1. tau : element of the ring with a_c(tau) < 0. ring : doubles or mpmath numbers.

    Examples
    --------
    >>> from singimpact.algebra.rings import DOUBLES
    >>> completion(Oscillator("0", "-2", 0, "1/2"), 0.0, 2, DOUBLES)
    [2.0, 0.0]
    """
    found = sheet(Contact.of(osc, tau, 0, order, ring), order)
    # launch velocity over t: v_c = t V
    space = JetSpace(("sigma", "t"), order, ring)
    V = space.jet({(i, k - 1): value for (i, k), value in found.v.terms.items() if k})
    number = ring.rational
    back = space.jet({(i, k): value * number(Fraction((-1) ** k)) for (i, k), value in found.v.terms.items() if k})
    later = _next_time(space, V, _rebound(osc, space, back))
    return _invariant(space, later, order)


def _rebound(osc: Oscillator, space: JetSpace, velocity: Jet) -> Jet:
    if not names_in(osc.restitution):
        return velocity.scaled(-evaluate(osc.restitution, {}, space.ring))
    line = JetSpace(("v",), space.order, space.ring)
    # rho(0) = 0 exactly: a series without a constant term
    found = series_of_rho(osc, space.order, space.ring)
    return line.jet({(k,): value for k, value in found.items()}).compose([velocity])


def _next_time(space: JetSpace, V: Jet, velocity: Jet) -> Jet:
    """t' with t' V(sigma, t') = velocity; every round settles one more degree."""
    sigma, later = space.generators()[0], space.jet({})
    for _ in range(space.order):
        later = velocity * space.power(V.compose([sigma, later]), Fraction(-1))
    return later


def _invariant(space: JetSpace, later: Jet, order: int) -> list[Any]:
    """The coefficients at sigma = 0 of M with M(sigma - t, t) = M(sigma, t'), M(sigma, 0) = sigma."""
    one = space.ring.rational(Fraction(1))
    parts: list[dict[int, Any]] = [{1: one}]
    powers = [space.rational(Fraction(1))]
    for n in range(1, order + 1):
        powers.append(powers[-1] * later)
        total: dict[int, Any] = {}
        for i in range(1, n + 1):
            for k, value in parts[n - i].items():
                if k >= i:
                    factor = space.ring.rational(Fraction((-1) ** (i + 1) * comb(k, i)))
                    total[k - i] = total.get(k - i, 0 * one) + value * factor
        for m in range(1, n):
            for (i, power), value in powers[m].terms.items():
                for k, other in parts[m].items() if power == n else ():
                    total[k + i] = total.get(k + i, 0 * one) + value * other
        lost = one - powers[n].coefficient((0, n))
        parts.append({k: value / lost for k, value in total.items() if k <= order - n})
    return [part.get(0, 0 * one) for part in parts[1:]]
