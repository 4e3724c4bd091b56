"""The sheet V_c' as a power series: v_c at a point of any contact order, to any order, over any ring.

No equation is solved by iteration.  The flight from sigma that lands after t is X = c + t Y(z) at the time sigma + z t,
so the unit interval carries the boundary value problem

    Y'' = t [a(sigma + z t) - (f(c + t Y, Y', sigma + z t) - f(c, 0, sigma + z t))],    Y(0) = Y(1) = 0.

Part by part in the degree of (sigma, t) the right side is known, and two integrals in z give the next part.  Then
v_c = Y'(0), and the impact velocity Y'(1) is v_c after the involution.  Y with both velocities is the certificate that
a sheet leaves where one is gathered.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.gathering import gathering, remembered
from singimpact.algebra.jets import Jet, JetSpace
from singimpact.algebra.precision import kept_property
from singimpact.algebra.rings import Exact, SymbolRing
from singimpact.contact.contact import Contact

# The involution iota(sigma, t) = (sigma + t, -t): it exchanges launch and landing, and turns p into phi. In the
# coordinates (s, e), launch time and landing time, iota is the exchange of s and e.


def iota(sigma: Any, t: Any) -> tuple[Any, Any]:
    """(sigma + t, -t), for numbers, jets or sympy objects alike.

    Examples
    --------
    >>> iota(*iota(2, 3))
    (2, 3)
    """
    return sigma + t, -t


@dataclass(frozen=True)
class Sheet:
    """v_c and the impact velocity near a contact point, cut after total degree `order` in (sigma, t).

    Attributes
    ----------
    contact : the jets it was made from. order : the last degree kept.
    v : v_c(tau_* + sigma, t), launch velocity of the flight that lands after t, a jet in (sigma, t) [e:vtaylor].
    """

    contact: Contact
    order: int
    v: Jet

    @kept_property
    def xdot(self) -> Jet:
        """Impact velocity of the same flight: v_c after the involution [e:phi]."""
        return self.v.compose(iota(*self.v.space.generators()))

    @property
    def p(self) -> tuple[Jet, Jet]:
        """p_c: (sigma, t) -> (sigma, v_c) [e:proj]."""
        return self.v.space.generators()[0], self.v

    @property
    def phi(self) -> tuple[Jet, Jet]:
        """phi_c: (sigma, t) -> (sigma + t, impact velocity) [e:phi]."""
        sigma, t = self.v.space.generators()
        return sigma + t, self.xdot

    def to_sympy(self, jet: Jet) -> Any:
        """A jet of this sheet as a sympy expression in its variables."""
        return jet.to_sympy()


def sheet(contact: Contact, order: int) -> Sheet:
    """The sheet at a contact point to total degree `order`.

    Examples
    --------
    >>> from singimpact.contact.contact import Contact
    >>> tangency = sheet(Contact.generic(1, 2), 2)
    >>> print(tangency.to_sympy(tangency.v))
    -a_d1*sigma*t/2 - a_d1*t**2/6
    """
    space = JetSpace(("sigma", "t"), order, contact.ring)
    flight = _Flight(contact, space)
    certified = gathering() and isinstance(contact.ring, SymbolRing | Exact)  # balls and doubles prove no identity
    parts, rise = dict[int, Any](), dict[Any, Any]()
    for degree in range(contact.order, order):
        twice = flight.twice_integrated(degree)
        launch = flight.launch(twice)
        if certified:
            rise |= flight.engine.terms(flight.rise(twice, launch))
        parts[degree + 1] = flight.engine.without(launch, 0, space.polynomials)
        if degree + 1 < order:
            flight.extend(degree, twice, launch)
    result = Sheet(contact, order, space.of_parts(parts))
    if certified:
        from singimpact.algebra import derivations  # loads sympy

        derivations.flight(contact, order, rise, result.v.terms, result.xdot.terms)
    return result


class _Flight:
    """Y on the unit interval, by parts of one degree in (sigma, t): X = t Y starts at j + 2, X' = Y' at j + 1."""

    def __init__(self, contact: Contact, space: JetSpace) -> None:
        self.contact, ring = contact, contact.ring
        self.engine = JetSpace(("z", "sigma", "t"), space.order, ring, (0, 1, 1)).polynomials
        self.z, sigma, self.t = self.engine.generators()
        self._clock = self.engine.add(self.engine.dot([(self.z, self.t)]), sigma)
        self._powers = [self.engine.constant(ring.rational(Fraction(1)))]
        self._minus = ring.rational(Fraction(-1))
        self._force = {pair: self.engine.constant(-value) for pair, value in contact.f.items()}
        self._products = dict[tuple[int, int, int], Any]()
        self.x, self.xdot = dict[int, Any](), dict[int, Any]()

    def twice_integrated(self, degree: int) -> Any:
        """The right side of one degree, integrated twice from z = 0."""
        return self.engine.integral(self.engine.integral(self._right_side(degree), 0), 0)

    def launch(self, twice: Any) -> Any:
        """The part of Y'(0): Y = twice - z twice(1), and both integrals start from 0."""
        return self.engine.scaled(self.engine.at(twice, 0, Fraction(1)), self._minus)

    def rise(self, twice: Any, launch: Any) -> Any:
        """The part of Y, from its double integral and its part of Y'(0)."""
        return self.engine.add(twice, self.engine.dot([(self.z, launch)]))

    def extend(self, degree: int, twice: Any, launch: Any) -> None:
        """X of degree + 2 and X' of degree + 1, from the double integral of this degree."""
        y = self.rise(twice, launch)
        self.xdot[degree + 1] = self.engine.derivative(y, 0)
        self.x[degree + 2] = self.engine.dot([(self.t, y)])

    def _right_side(self, degree: int) -> Any:
        """The part of t [a - (f - f(c, 0))] that comes from the bracket of this degree."""
        while len(self._powers) <= degree:
            self._powers.append(self.engine.dot([(self._powers[-1], self._clock)]))
        pairs = []
        if degree in self.contact.a:
            pairs.append((self._powers[degree], self.engine.constant(self.contact.a[degree])))
        for (i, k, *late), coefficient in self._force.items():
            m = sum(late)
            product = self._product(i, k, degree - m)
            if product is not None:
                pairs.append((self.engine.dot([(product, self._powers[m])]) if m else product, coefficient))
        return self.engine.dot([(self.t, self.engine.dot(pairs))])

    def _product(self, i: int, k: int, degree: int) -> Any:
        """The part of X^i X'^k of one degree; None when there is none."""
        j = self.contact.order
        if degree < i * (j + 2) + k * (j + 1):
            return None
        if i + k == 1:
            return (self.x if i else self.xdot).get(degree)
        key = (i, k, degree)
        if key not in self._products:
            parts, rest = (self.x, (i - 1, k)) if i else (self.xdot, (i, k - 1))
            products = (
                (factor, self._product(*rest, degree - size)) for size, factor in parts.items() if size < degree
            )
            pairs = [pair for pair in products if pair[1] is not None]
            self._products[key] = self.engine.dot(pairs) if pairs else None
        return self._products[key]


@remembered
def generic_sheet(j: int, order: int) -> Sheet:
    """The sheet with symbols for all jets, at contact order j."""
    return sheet(Contact.generic(j, order), order)
