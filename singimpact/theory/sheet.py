"""The sheet V_c' as a power series: v_c at a point of any contact order, to any order, over any ring.

No equation is solved by iteration: with launch time s and landing time e as coordinates, the flight X(u) is the
solution of X'' = a - (f - f(c, 0)) with X(s) = X(e) = 0.  Term by term in the total degree of (u, s, e) the right side
is known, and a Green's function that is a polynomial gives the next term.  Then v_c = X'(s), and the impact velocity
X'(e) is the same series with s and e exchanged.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any

from singimpact.algebra.jets import Jet, JetSpace
from singimpact.contact.contact import Contact, contact_order
from singimpact.inputs import refuse
from singimpact.theory.involution import exchanged, in_flight_time


@dataclass(frozen=True)
class Sheet:
    """v_c and the impact velocity near a contact point, cut after total degree `order` in (sigma, t).

    Attributes
    ----------
    contact : the jets it was made from. order : the last degree kept.
    nu : launch velocity as a jet in (s, e), launch and landing time after tau_*.
    """

    contact: Contact
    order: int
    nu: Jet

    @cached_property
    def v(self) -> Jet:
        """v_c(tau_* + sigma, t): launch velocity of the flight that lands after t [e:vtaylor]."""
        return in_flight_time(self.nu, self.order)

    @cached_property
    def xdot(self) -> Jet:
        """Impact velocity of the same flight: v_c after the involution [e:phi]."""
        return in_flight_time(exchanged(self.nu), self.order)

    def to_sympy(self, jet: Jet) -> Any:
        """A jet of this sheet as a sympy expression in its variables."""
        import sympy

        symbols = [sympy.Symbol(name) for name in jet.space.variables]
        convert = getattr(self.contact.ring, "to_sympy", sympy.sympify)
        return sympy.Add(
            *(
                convert(value) * sympy.prod(s**e for s, e in zip(symbols, key, strict=True))
                for key, value in jet.terms.items()
            )
        )


def sheet(contact: Contact, order: int) -> Sheet:
    """The sheet at a contact point to total degree `order`.

    Examples
    --------
    >>> from singimpact.contact.contact import Contact
    >>> tangency = sheet(Contact.generic(1, 2), 2)
    >>> print(tangency.to_sympy(tangency.v))
    -a_d1*sigma*t/2 - a_d1*t**2/6
    """
    space = JetSpace(("u", "s", "e"), order + 1, contact.ring)
    flight = _Flight(contact, space)
    launch = JetSpace(("s", "e"), order, contact.ring)
    terms: dict[tuple[int, ...], Any] = {}
    for degree in range(contact.order, order):
        for (k, i, m), value in flight.next_velocity(degree).terms.items():
            key = (k + i, m)  # u = s
            terms[key] = terms[key] + value if key in terms else value
    return Sheet(contact, order, launch.jet({key: value for key, value in terms.items() if value != 0}))


class _Flight:
    """X(u) with X(s) = X(e) = 0, by homogeneous parts in (u, s, e)."""

    def __init__(self, contact: Contact, space: JetSpace) -> None:
        self.contact, self.space = contact, space
        self.x: dict[int, Jet] = {}
        self.xdot: dict[int, Jet] = {}
        self._products: dict[tuple[int, int, int], Jet] = {}

    def next_velocity(self, degree: int) -> Jet:
        """Extend X by its part of degree `degree` + 2; returns X' of degree `degree` + 1."""
        part = self._green(self._right_side(degree))
        self.x[degree + 2] = part
        rational = self.space.ring.rational
        slope = {(k - 1, *ends): value * rational(Fraction(k)) for (k, *ends), value in part.terms.items() if k}
        self.xdot[degree + 1] = self.space.jet(slope)
        return self.xdot[degree + 1]

    def _right_side(self, degree: int) -> Jet:
        """The part of a - (f(c + X, X') - f(c, 0)) of one degree."""
        zero = self.space.jet({})
        total = self.space.jet({(degree, 0, 0): self.contact.a[degree]}) if degree in self.contact.a else zero
        for (i, k), coefficient in self.contact.f.items():
            total = total - self._product(i, k, degree).scaled(coefficient)
        return total

    def _product(self, i: int, k: int, degree: int) -> Jet:
        """The part of X^i X'^k of one degree."""
        if i + k == 0:
            return self.space.rational(Fraction(1)) if degree == 0 else self.space.jet({})
        key = (i, k, degree)
        if key not in self._products:
            parts, rest = (self.x, (i - 1, k)) if i else (self.xdot, (i, k - 1))
            total = self.space.jet({})
            for size, part in parts.items():
                if size <= degree:
                    total = total + part * self._product(*rest, degree - size)
            self._products[key] = total
        return self._products[key]

    def _green(self, right: Jet) -> Jet:
        """Solve X'' = right, X(s) = X(e) = 0: u^k -> (u^(k+2) - u h_(k+1) + s e h_k)/((k+1)(k+2))."""
        terms: dict[tuple[int, ...], Any] = {}

        def put(key: tuple[int, ...], value: Any) -> None:
            terms[key] = terms[key] + value if key in terms else value

        for (k, i, m), value in right.terms.items():
            scaled = value * self.space.ring.rational(Fraction(1, (k + 1) * (k + 2)))
            put((k + 2, i, m), scaled)
            for n in range(k + 2):
                put((1, i + n, m + k + 1 - n), -scaled)
            for n in range(k + 1):
                put((0, i + n + 1, m + k - n + 1), scaled)
        return Jet(self.space, terms)


@lru_cache(maxsize=32)
def generic_sheet(j: int, order: int) -> Sheet:
    """The sheet with symbols for all jets, at contact order j."""
    return sheet(Contact.generic(j, order), order)


def v_c(order: int = 6, at: str | int = "generic") -> Any:
    """v_c(tau_* + sigma, t) to total degree `order`, as a sympy expression [e:vtaylor, e:degen, e:swan].

    Parameters
    ----------
    order : int >= 1, total degree in (sigma, t) of the last term.
    at : "generic", "tangency", "swan" or a contact order.

    Examples
    --------
    >>> v_c(order=1)
    -a*t/2
    """
    if not isinstance(order, int) or isinstance(order, bool) or not 1 <= order <= 40:
        raise refuse("order", order, "an integer from 1 to 40")
    found = generic_sheet(contact_order(at), order)
    return found.to_sympy(found.v)
