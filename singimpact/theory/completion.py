"""Complete chatter at a regular point: where it ends, tau_inf(tau, v), and the foliation whose leaves it runs along.

tau_inf is constant along an orbit: with K(sigma, v) = tau_inf - tau_*, and (sigma, t) on the sheet,

    K(sigma + t, rho(xdot)) = K(sigma, v_c),    K(sigma, 0) = sigma.

By the degree in (sigma, v) the coefficient of sigma^i v^n is met first beside t^n sigma^i, with the factor r^n - 1.
The level sets of K are the stable fibres.

Before it: gamma with symbols for all jets and for r, written through lambda: solved at whole lambda, and interpolated.
Lengths are first measured so that a_j = 1; that symbol is put back at the end, for everything is homogeneous in it.
The denominators are known beforehand: powers of the divisors that the solver meets, and of lambda.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from math import comb, factorial, prod
from typing import Any

from singimpact.algebra.interpolation import RationalCoefficients, in_lowest_terms, interpolated
from singimpact.algebra.jets import Jet
from singimpact.algebra.polynomials import Exponents
from singimpact.algebra.precision import kept_property
from singimpact.algebra.rings import sympy_rational
from singimpact.contact.contact import Contact, derivative_name
from singimpact.handed_on import flint, sympy
from singimpact.theory.gamma_series import InvariantCurve, P, Q, invariant_curve
from singimpact.theory.impact_sheet import Sheet, sheet

WHOLLY_FACTORED = 12  # degree of a numerator up to which it is written as a product of irreducible factors
ROOTS = (Fraction(0), Fraction(1), Fraction(-1), Fraction(-2), Fraction(-1, 2))


class SymbolicCurve:
    """gamma (the fibre for j = 0) for all jets and all r at once, to sigma^order in v.

    Attributes
    ----------
    j : contact order. order : last power of sigma in v. names : symbols of the jets, without that of a_j.
    """

    def __init__(self, j: int, order: int) -> None:
        self.j, self.order = j, order
        self._contact = Contact.generic(j, order, unit=True, more=rho_names(j, order))
        self._rho = {int(name[4:]): self._contact.ring.symbol(name) for name in rho_names(j, order)}
        self._solved: dict[int, InvariantCurve] = {}
        self.names: tuple[str, ...] = self._contact.ring.names

    @kept_property
    def graph(self) -> Mapping[int, RationalCoefficients]:
        """n -> coefficient of sigma^n in v."""
        return self._read("graph", self.j + 1)

    @kept_property
    def motion(self) -> Mapping[int, RationalCoefficients]:
        """n -> coefficient of sigma^n in sigma + T(sigma)."""
        return self._read("motion", 1)

    def _read(self, part: str, first: int) -> Mapping[int, RationalCoefficients]:
        levels = range(self.order - self.j)

        def values_at(node: int) -> list[Any]:
            return [getattr(self._at(node), part)[first + n].to_dict() for n in levels]

        found = interpolated(values_at, [_denominator(self.j, level) for level in levels])
        return dict(enumerate(found, first))

    def _at(self, node: int) -> InvariantCurve:
        if node not in self._solved:
            self._solved[node] = invariant_curve(self._contact, Fraction(node), self.order, self._rho)
        return self._solved[node]

    def to_sympy(self, coefficient: RationalCoefficients, of_length: int) -> Any:
        """A coefficient as a sympy expression in lambda and the jets; `of_length` 1 in the graph, 0 in the motion."""
        return in_length(coefficient, self.names, self.j, of_length)


def in_length(coefficient: RationalCoefficients, names: tuple[str, ...], j: int, of_length: int) -> Any:
    """A coefficient found with a_j = 1 as a sympy expression, for any a_j: it scales as a length to `of_length`."""
    from singimpact.algebra.long_sums import Products

    products, unit = Products(), sympy.Symbol(derivative_name(j))
    symbols, weights = [sympy.Symbol(name) for name in names], [length_weight(name) for name in names]
    total, lengths = [], dict[tuple[int, int], tuple[Any, Any]]()
    for key, (above, below) in coefficient.terms.items():
        content, factors = factored(above)
        mark = below.degree(), int(below(2))  # the same few denominators come again and again; they are whole
        if mark not in lengths or lengths[mark][0] != below:
            lengths[mark] = below, factored(below, below.degree())
        under, divisors = lengths[mark][1]
        present = [(index, int(e)) for index, e in enumerate(key) if e]  # most exponents are 0
        power = of_length + sum(weights[index] * e for index, e in present)
        jets = [(symbols[index], e) for index, e in present] + ([(unit, power)] if power else [])
        bases = [*factors, *((base, -e) for base, e in divisors), *jets]
        total.append(products.term(content / under / sympy.Integer(factorial(j)) ** power, bases))
    return products.summed(total)


def length_weight(name: str) -> int:
    """The power of the unit of length, a_j, that a jet measured in it carries."""
    head, _, digits = name.partition("_")
    if head == "a":
        return -1
    return int(digits) - 1 if head == "rho" else int(digits[0]) + int(digits[1]) - 1


def factored(poly: flint.fmpq_poly, wholly: int = WHOLLY_FACTORED) -> tuple[Any, list[tuple[Any, int]]]:
    """An fmpq_poly in lambda as a rational and powers of its factors, in sympy.

    Above the degree `wholly` only factors of degree 1 that are often met are looked for: to show that the rest has none
    takes longer than all else, and it hardly ever has one.
    """
    constant, factors = poly.factor() if poly.degree() <= wholly else _split_by_roots(poly)
    single = len(factors) == 1 and factors[0][1] == 1
    if single and any(factors[0][0].coeffs()[:-1]):  # as in sympy, a rational goes into a sum
        return sympy.S.One, [(_in_lambda(tuple((int(c.p), int(c.q)) for c in poly.coeffs())), 1)]
    shown = [(_in_lambda(tuple((int(c.p), 1) for c in factor.coeffs())), int(e)) for factor, e in factors]
    return sympy_rational(int(constant.p), int(constant.q)), shown


def _split_by_roots(poly: flint.fmpq_poly) -> tuple[flint.fmpq, list[tuple[flint.fmpq_poly, int]]]:
    """A rational, the powers of factors with the roots `ROOTS`, and the rest, as flint's `factor` gives them."""
    rest, factors = poly.numer(), []
    for root in ROOTS:
        factor, times = flint.fmpz_poly([-root.numerator, root.denominator]), 0
        while rest(flint.fmpq(root.numerator, root.denominator)) == 0:
            rest, times = rest // factor, times + 1
        if times:
            factors.append((flint.fmpq_poly(factor), times))
    content = rest.content() * (1 if rest.leading_coefficient() > 0 else -1)
    if rest.degree() > 0:
        factors.append((flint.fmpq_poly(rest // content), 1))
    return flint.fmpq(content) / poly.denom(), factors


@lru_cache(maxsize=4096)
def _in_lambda(coefficients: tuple[tuple[int, int], ...]) -> Any:
    """The polynomial in lambda with these coefficients, as numerators and denominators."""
    from singimpact.algebra.long_sums import polynomial

    return polynomial(sympy.Symbol("lambda"), coefficients)


def rho_names(j: int, order: int) -> tuple[str, ...]:
    """Symbols rho_k of the coefficients of v^k, k >= 2, that gamma to sigma^order contains."""
    return tuple(f"rho_{k}" for k in range(2, order // (j + 1) + 1))


def divisor(j: int, level: int) -> flint.fmpq_poly:
    """The divisor that the solver meets at a level, as an fmpq_poly in lambda, free of lambda and lambda - 1."""
    x = flint.fmpq_poly([0, 1])
    time = x - 1
    launch = sum((time ** (k + 1) * -_over(j, k, (k + 1) * (k + 2)) for k in range(j + 1)), x * 0)
    launch_tangent = sum((time**k * -_over(j, k, k + 2) for k in range(j + 1)), x * 0)
    impact_tangent = sum((time**k * (_over(j, k, k + 2) * (k + 1)) for k in range(j + 1)), x * 0)
    landing = launch * x**j * (j + 1) + launch_tangent * x ** (j + level + 1)
    product: flint.fmpq_poly = x ** (j + 1) * P(j, x) * impact_tangent + Q(j, x) * landing
    for factor in (x, x - 1):
        while (product % factor).is_zero():
            product = product // factor
    return product / product.leading_coefficient()


def _over(j: int, k: int, below: int) -> flint.fmpq:
    return flint.fmpq(comb(j, k), below)


def _denominator(j: int, level: int) -> flint.fmpq_poly:
    """A multiple of the denominator of tau_level: each divisor as often as the levels below can bring it in."""
    total = flint.fmpq_poly([0, 1]) ** level
    for below in range(1, level + 1):
        total = total * divisor(j, below) ** (level // below)
    return total


@lru_cache(maxsize=16)
def symbolic_curve(j: int, order: int) -> SymbolicCurve:
    """gamma at contact order j to sigma^order, j + 1 <= order.

    Examples
    --------
    >>> curve = symbolic_curve(1, 3)
    >>> curve.to_sympy(curve.graph[2], 1)
    -a_d1*(lambda - 1)*(lambda + 2)/6
    """
    return SymbolicCurve(j, order)


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
