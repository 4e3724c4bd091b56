"""Complete chatter at a regular point: where it ends, tau_inf(tau, v), and the foliation whose leaves it runs along.

tau_inf is constant along an orbit: with K(sigma, v) = tau_inf - tau_*, and (sigma, t) on the sheet,

    K(sigma + t, rho(xdot)) = K(sigma, v_c),    K(sigma, 0) = sigma.

By the degree in (sigma, v) the coefficient of sigma^i v^n is met first beside t^n sigma^i, with the factor r^n - 1.
The level sets of K are the stable fibres.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from math import comb, prod
from typing import Any

from singimpact.algebra.interpolation import RationalCoefficients, in_lowest_terms
from singimpact.algebra.jets import Jet
from singimpact.algebra.polynomials import Exponents
from singimpact.contact.contact import Contact, derivative_name
from singimpact.handed_on import flint
from singimpact.theory.gamma_in_symbols import in_length, length_weight, rho_names
from singimpact.theory.impact_sheet import Sheet, sheet


def leaves(
    sheet_: Sheet, restitution: Any, inverse_gap: Callable[[int], Any], rho: Mapping[int, Any]
) -> dict[Exponents, Any]:
    """The coefficients of K to the order of a sheet at contact order 0: (i, n) -> that of sigma^i v^n.

    Parameters
    ----------
    sheet_ : over a ring in which a_0 has an inverse.
    restitution : r. inverse_gap : n -> 1/(1 - r^n). rho : k -> coefficient of v^k in rho, k >= 2.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> bouncing = sheet(Contact(0, EXACT, {0: Fraction(-2)}, {}), 2)
    >>> leaves(bouncing, Fraction(1, 2), lambda n: 1 / (1 - Fraction(1, 2)**n), {})[(0, 1)]
    Fraction(2, 1)
    """
    contact, order, space = sheet_.contact, sheet_.order, sheet_.v.space
    one = space.rational(Fraction(1))
    sigma, t = space.generators()
    launch, rebound = _powers(sheet_.v, order), _powers(_rebound(sheet_, restitution, rho), order)
    before, after = _powers(sigma, order), _powers(sigma + t, order)
    step = contact.ring.power(contact.a[0], Fraction(-1)) * contact.ring.rational(Fraction(-2))
    coefficients: dict[Exponents, Any] = {(1, 0): contact.ring.rational(Fraction(1))}
    gap = t * one  # K after the impact less K before, for the K found so far
    for degree in range(1, order + 1):
        missed = dict(gap.part(degree).terms)
        for n in range(1, degree + 1):
            i = degree - n
            if (i, n) not in missed:
                continue
            lead = missed[(i, n)] * inverse_gap(n)  # the value times (-a_0/2)^n
            coefficients[(i, n)] = value = lead * step**n
            for q in range(1, i + 1):  # what it adds beside later unknowns of this degree: r^n (sigma + t)^i t^n
                key, more = (i - q, n + q), lead * restitution**n * contact.ring.rational(Fraction(comb(i, q)))
                missed[key] = missed[key] + more if key in missed else more
            if degree < order:
                gap = gap + (after[i] * rebound[n] - before[i] * launch[n]).scaled(value)
    zero = contact.ring.rational(Fraction(0))
    return {(0, n): zero for n in range(1, order + 1)} | coefficients


def by_velocity(contact: Contact, restitution: Any, rho: Mapping[int, Any], order: int) -> dict[int, Any]:
    """n -> coefficient of v^n in tau_inf - tau, for n up to `order`, over the ring of a regular contact point.

    Parameters
    ----------
    contact : the launch, at contact order 0. restitution : r < 1. rho : k -> coefficient of v^k in rho, k >= 2.

    Examples
    --------
    >>> from singimpact.algebra.rings import DOUBLES
    >>> by_velocity(Contact(0, DOUBLES, {0: -2.0}, {}), 0.5, {}, 2)
    {1: 2.0, 2: 0.0}
    """
    ring = contact.ring
    one = ring.rational(Fraction(1))
    K = leaves(sheet(contact, order), restitution, lambda n: ring.power(one - restitution**n, Fraction(-1)), rho)
    return {n: K[(0, n)] for n in range(1, order + 1)}


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
    """tau_inf - tau to v^order for generic jets, one coefficient after the other.

    The coefficient c_n of v^n is a function of the phase tau, so one launch at sigma = 0 fixes it:

        sum_n c_n(tau) v_c(0, t)^n = t + sum_n c_n(tau + t) rho(xdot(0, t))^n.

    Examples
    --------
    >>> symbolic_completion(1).to_sympy(1)
    2/(a*(lambda - 1))
    """
    jets = _LaunchJets(order)
    numerators: list[_Numerator] = []
    for power in range(1, order + 1):
        total = jets.one if power == 1 else jets.zero
        for n, coefficient in enumerate(
            numerators, 1
        ):  # Horner: what stands for c_n is divided by the gaps up to n alone
            total = total * (jets.one - jets.lambda_**n) if n > 1 else total
            total = total + coefficient.later(power) - coefficient.value * jets.launch[n][power]
        numerators.append(_Numerator(jets, power, total * (-2) ** power))  # v_c(0, t) = -t/2 + ... in units of a
    coefficients = {n: jets.over_gaps(numerator.value, n) for n, numerator in enumerate(numerators, 1)}
    return SymbolicCompletion(order, jets.names, coefficients)


class _LaunchJets:
    """The launch from sigma = 0: polynomials in the jets, in units of a = 1, and in lambda.

    Attributes
    ----------
    names : of the jets. launch, rebound : n -> coefficients in t of the n-th power of either velocity.
    """

    def __init__(self, order: int) -> None:
        rho = rho_names(0, order)
        contact = Contact.generic(0, order, unit=True, more=(*rho, "lambda"))
        self.ring, self.order = contact.ring, order
        self.names = self.ring.names[:-1]
        self.zero, self.one = (self.ring.rational(Fraction(n)) for n in (0, 1))
        self.lambda_, sheet_ = self.ring.symbol("lambda"), sheet(contact, order)
        starts = (jet.at("sigma", 0) for jet in (sheet_.v, sheet_.xdot))
        launch, impact = ([start.coefficient((0, k)) for k in range(order + 1)] for start in starts)
        rebound, power = [-self.lambda_ * value for value in impact], impact
        for name in rho:
            power = self._product(power, impact)
            rebound = [x + self.ring.symbol(name) * y for x, y in zip(rebound, power, strict=True)]
        self.launch, self.rebound = self._powers_of(launch), self._powers_of(rebound)

    def _product(self, left: list[Any], right: list[Any]) -> list[Any]:
        found = [self.zero] * (self.order + 1)
        for i, value in enumerate(left):
            for k in range(self.order + 1 - i if value else 0):
                found[i + k] = found[i + k] + value * right[k]
        return found

    def _powers_of(self, line: list[Any]) -> dict[int, list[Any]]:
        found = {1: line}
        for n in range(2, self.order + 1):
            found[n] = self._product(found[n - 1], line)
        return found

    def derivative(self, value: Any, power: int) -> Any:
        """By the phase of a coefficient of v^power that was written for a = 1."""
        moved, length = self.zero, value * -power
        for name in self.names:
            slope = value.derivative(name)
            if not slope:
                continue
            length = length + slope * self.ring.symbol(name) * length_weight(name)
            if name.startswith("a_d"):
                moved = moved + slope * self.ring.symbol(derivative_name(int(name[3:]) + 1))
        return moved + length * self.ring.symbol(derivative_name(1))

    def over_gaps(self, value: Any, power: int) -> RationalCoefficients:
        """A polynomial over (1 - lambda)(1 - lambda^2) ... (1 - lambda^power), by monomials of the jets."""
        numerators: dict[Exponents, list[Any]] = {}
        size = value.degrees()[-1] + 1
        for key, coefficient in value.to_dict().items():
            numerators.setdefault(key[:-1], [0] * size)[key[-1]] = coefficient
        gaps = (flint.fmpq_poly([1] + [0] * (n - 1) + [-1]) for n in range(1, power + 1))
        below = prod(gaps, start=flint.fmpq_poly([1]))
        return RationalCoefficients(
            {key: in_lowest_terms(flint.fmpq_poly(numerators[key]), below) for key in sorted(numerators)}
        )


@dataclass(frozen=True)
class _Numerator:
    """c_power times (1 - lambda) ... (1 - lambda^power), and its derivatives by the phase over their factorials."""

    jets: _LaunchJets
    power: int
    value: Any
    derivatives: list[Any] = field(default_factory=list)

    def later(self, power: int) -> Any:
        """The coefficient of t^power in c(tau + t) times the power of the rebound velocity."""
        derivatives, total = self.derivatives, self.jets.zero
        if not derivatives:
            derivatives.append(self.value)
        for k in range(power - self.power + 1):
            if k == len(derivatives):
                derivatives.append(self.jets.derivative(derivatives[-1], self.power) / k)
            total = total + derivatives[k] * self.jets.rebound[self.power][power - k]
        return total
