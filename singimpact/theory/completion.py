"""Complete chatter at a regular point: where it ends, tau_inf(tau, v), and the foliation whose leaves it runs along.

tau_inf is constant along an orbit: with K(sigma, v) = tau_inf - tau_*, and (sigma, t) on the sheet,

    K(sigma + t, rho(xdot)) = K(sigma, v_c),    K(sigma, 0) = sigma.

By the degree in (sigma, v) the coefficient of sigma^i v^n is met first beside t^n sigma^i, with the factor r^n - 1.
The level sets of K are the stable fibres.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import comb
from typing import Any

from singimpact.algebra.interpolation import RationalCoefficients, interpolated
from singimpact.algebra.jets import Jet, JetSpace
from singimpact.algebra.polynomials import Exponents
from singimpact.contact.contact import Contact
from singimpact.theory.sheet import Sheet, sheet
from singimpact.theory.symbolic_curve import in_length, rho_names


def foliation(
    contact: Contact, restitution: Any, inverse_gap: Callable[[int], Any], order: int, rho: Mapping[int, Any]
) -> Jet:
    """K(sigma, v) to total degree `order`, a jet in (sigma, v).

    Parameters
    ----------
    contact : at contact order 0; a_0 must have an inverse in its ring.
    restitution : r. inverse_gap : n -> 1/(1 - r^n). rho : k -> coefficient of v^k in rho, k >= 2.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> bouncing = Contact(0, EXACT, {0: Fraction(-2)}, {})
    >>> print(foliation(bouncing, Fraction(1, 2), lambda n: 1 / (1 - Fraction(1, 2)**n), 3, {}))
    sigma + (2)*v
    """
    found = leaves(sheet(contact, order), restitution, inverse_gap, rho)
    return JetSpace(("sigma", "v"), order, contact.ring).jet(found)


def leaves(
    made: Sheet, restitution: Any, inverse_gap: Callable[[int], Any], rho: Mapping[int, Any]
) -> dict[Exponents, Any]:
    """The coefficients of K from the sheet: (i, n) -> that of sigma^i v^n."""
    contact, order, space = made.contact, made.order, made.v.space
    one = space.rational(Fraction(1))
    sigma, t = space.generators()
    launch, rebound = _powers(made.v, order), _powers(_rebound(made, restitution, rho), order)
    before, after = _powers(sigma, order), _powers(sigma + t, order)
    step = contact.ring.power(contact.a[0], Fraction(-1)) * contact.ring.rational(Fraction(-2))
    found: dict[Exponents, Any] = {(1, 0): contact.ring.rational(Fraction(1))}
    gap = t * one  # K after the impact less K before, for the K found so far
    for degree in range(1, order + 1):
        missed = dict(gap.part(degree).terms)
        for n in range(1, degree + 1):
            i = degree - n
            if (i, n) not in missed:
                continue
            lead = missed[(i, n)] * inverse_gap(n)  # the value times (-a_0/2)^n
            found[(i, n)] = value = lead * step**n
            for q in range(1, i + 1):  # what it adds beside later unknowns of this degree: r^n (sigma + t)^i t^n
                key, more = (i - q, n + q), lead * restitution**n * contact.ring.rational(Fraction(comb(i, q)))
                missed[key] = missed[key] + more if key in missed else more
            if degree < order:
                gap = gap + (after[i] * rebound[n] - before[i] * launch[n]).scaled(value)
    zero = contact.ring.rational(Fraction(0))
    return {(0, n): zero for n in range(1, order + 1)} | found


def _powers(jet: Jet, order: int) -> list[Jet]:
    found = [jet.space.rational(Fraction(1))]
    for _ in range(order):
        found.append(found[-1] * jet)
    return found


def _rebound(made: Sheet, restitution: Any, rho: Mapping[int, Any]) -> Jet:
    """rho(xdot) as a jet in (sigma, t)."""
    powers = _powers(made.xdot, max(rho, default=1))
    total = -powers[1].scaled(restitution)
    for k, value in rho.items():
        total = total + powers[k].scaled(value)
    return total


@dataclass(frozen=True)
class SymbolicCompletion:
    """tau_inf - tau in powers of v for all jets and all r, lengths measured so that a = 1.

    Attributes
    ----------
    order : last power of v. names : of the jets, without a. coefficients : n -> coefficient of v^n, rational in r.
    """

    order: int
    names: tuple[str, ...]
    coefficients: Mapping[int, RationalCoefficients]

    def to_sympy(self, power: int) -> Any:
        """The coefficient of v^power in lambda = r and the jets."""
        return in_length(self.coefficients[power], self.names, 0, -power)


@lru_cache(maxsize=8)
def symbolic_completion(order: int) -> SymbolicCompletion:
    """tau_inf - tau to v^order for generic jets: at whole r, interpolated over powers of 1 - r^n.

    Examples
    --------
    >>> symbolic_completion(1).to_sympy(1)
    2/(a*(lambda - 1))
    """
    rho = rho_names(0, order)
    contact = Contact.generic(0, order, unit=True, more=rho)
    ring, made = contact.ring, sheet(contact, order)
    bent = {int(name[4:]): ring.symbol(name) for name in rho}

    def values_at(node: int) -> list[Any]:
        r = Fraction(node)
        found = leaves(made, ring.rational(r), lambda n: ring.rational(1 / (1 - r**n)), bent)
        return [found[(0, n)].to_dict() for n in range(1, order + 1)]

    found = interpolated(values_at, [_denominator(n) for n in range(1, order + 1)])
    return SymbolicCompletion(order, ring.names, dict(enumerate(found, 1)))


def _denominator(power: int) -> Any:
    """A multiple of the denominator of the coefficient of v^power: roots of unity of order n count every n levels."""
    import flint

    total = flint.fmpq_poly([1])
    for n in range(1, power + 1):
        total = total * flint.fmpq_poly(flint.fmpz_poly.cyclotomic(n)) ** (power // n)
    return total
