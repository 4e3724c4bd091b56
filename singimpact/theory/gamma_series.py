"""The invariant curve gamma at a point of contact order j >= 1, and the stable fibre at j = 0, by one online solver.

On the curve the flight from sigma takes T(sigma) = sigma tau(sigma), so sigma -> sigma + T(sigma) is the motion on it,
with multiplier lambda = 1 + tau(0).  The flight is solved as in `sheet`, with T in place of t, and in levels: what is
written X = sigma^(j+2) (level 0 + level 1 sigma + ...).  Level m of

    rho(U(sigma)) = W(sigma + T(sigma)),    W launch velocity, U impact velocity of the flight from sigma,

is linear in the coefficient tau_m; its factor is a multiple of Q_j^2 lambda^m' - P_j^2, which has no zero in (0, 1).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import comb
from typing import Any

from singimpact.algebra.taylor import dot
from singimpact.algebra.univariate import precision_of, univariate
from singimpact.contact.contact import Contact


@dataclass(frozen=True)
class InvariantCurve:
    """gamma near a contact point: v = sum graph[n] sigma^n, cut after sigma^order.

    Attributes
    ----------
    contact : the jets it was made from. order : the last power of sigma in the graph.
    lambda_, mu : multipliers along the curve and across it (of the blown-up map). restitution : r = -rho'(0).
    flight_time : n -> coefficient of sigma^n in T, n = 1, 2, ... graph : the same for v.
    """

    contact: Contact
    order: int
    lambda_: Any
    mu: Any
    restitution: Any
    flight_time: Mapping[int, Any]
    graph: Mapping[int, Any]

    @property
    def motion(self) -> dict[int, Any]:
        """sigma -> sigma + T(sigma), the impact map on the curve: n -> coefficient."""
        return {**self.flight_time, 1: self.lambda_}


def restitution_of(j: int, lambda_: Any) -> Any:
    """r = lambda^(j+1) P_j/Q_j for a number lambda of any kind.

    Examples
    --------
    >>> from fractions import Fraction
    >>> restitution_of(1, Fraction(1, 2))
    Fraction(5, 16)
    """
    return lambda_ ** (j + 1) * P(j, lambda_) / Q(j, lambda_)


def multiplier_across(j: int, lambda_: Any) -> Any:
    """mu = (P_j/Q_j)^2/lambda."""
    return (P(j, lambda_) / Q(j, lambda_)) ** 2 / lambda_


def P(j: int, lambda_: Any) -> Any:
    return sum((lambda_**i * (j + 1 - i) for i in range(1, j + 1)), lambda_ * 0 + (j + 1))


def Q(j: int, lambda_: Any) -> Any:
    return sum((lambda_**i * (i + 1) for i in range(1, j + 1)), lambda_ * 0 + 1)


def invariant_curve(
    contact: Contact, lambda_: Any, order: int, rho: Mapping[int, Any] | None = None, restitution: Any = None
) -> InvariantCurve:
    """The invariant curve of a contact point, to sigma^order.

    Parameters
    ----------
    contact : jets to this order at least; over symbols, a_j must be the number 1 (`Contact.scaled`).
    lambda_ : in (0, 1), a rational of Python or an element of the ring; a rational one over symbols.
    order : int > j. rho : k -> coefficient of v^k in rho, k >= 2. restitution : r, when it is known better than
        by its formula in lambda.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> from fractions import Fraction
    >>> free = Contact(1, EXACT, {1: Fraction(6)}, {})
    >>> curve = invariant_curve(free, Fraction(1, 2), 4)
    >>> curve.graph[2], curve.graph[3], curve.restitution
    (Fraction(5, 4), Fraction(0, 1), Fraction(5, 16))
    """
    with precision_of(contact.ring):
        solver = _Solver(contact, lambda_, order, rho or {}, restitution)
        for level in range(1, order - contact.order):
            solver.step(level)
        return solver.curve()


class _Solver:
    """Tables of levels, each extended by one a step."""

    def __init__(self, contact: Contact, lambda_: Any, order: int, rho: Mapping[int, Any], restitution: Any) -> None:
        self.contact, self.order, self.j = contact, order, contact.order
        self.polys = univariate(contact.ring)
        number = self.polys.number
        self.lambda_ = number(lambda_)
        self.r = restitution_of(self.j, self.lambda_) if restitution is None else number(restitution)
        self.rho = {k: number(value) for k, value in rho.items() if k * (self.j + 1) <= order}
        self.a = {k: number(value) for k, value in contact.a.items() if k < order}
        self.force = {pair: number(-value) for pair, value in contact.f.items() if self._shift(*pair) < order - self.j}
        one, size = number(1), order + 1
        self.zero = number(0)
        self.tau = [self.lambda_ - one]
        self.tau_powers = [[one]] + [[self.tau[0] ** q] for q in range(1, size)]
        self.motion_powers = [[one]] + [[self.lambda_**p] for p in range(1, size)]
        self.products: dict[tuple[int, int], list[Any]] = {}
        self.bracket = [self._bracket(0)]
        self.y, self.slope, self.launch, self.impact = (list[Any]() for _ in range(4))
        self.impact_powers: dict[int, list[Any]] = {1: self.impact}
        self._tangent()
        self._extend(0)

    def _shift(self, i: int, k: int, m: int = 0) -> int:
        """The number of levels by which X^i X'^k t^m lies above a_j."""
        return i * (self.j + 2) + k * (self.j + 1) + m - self.j

    def _tangent(self) -> None:
        """The derivative of level 0 by tau_0, which is that of level m by tau_m."""
        j, start, z = self.j, self.tau[0], self.polys.poly([0, 1])
        lead = [self.a[j] * (start**q * comb(j, q)) for q in range(j + 1)]
        self.bracket_tangent = self.polys.poly([0] + [self.a[j] * (start**q * (j * comb(j - 1, q))) for q in range(j)])
        twice = self.polys.integral(self.polys.integral(self.polys.poly(lead) + self.bracket_tangent * start))
        self.launch_tangent = self.polys.at_one(twice) * -1
        self.y_tangent = twice + z * self.launch_tangent
        self.impact_tangent = self.polys.at_one(self.polys.derivative(self.y_tangent))

    def step(self, level: int) -> None:
        """Level `level` with tau_level = 0, then the equation of this level for tau_level, then what it changes."""
        for table, base in ((self.tau_powers, self.tau), (self.motion_powers, [self.lambda_, *self.tau[1:]])):
            table[0].append(self.zero)
            for power in range(1, self.order - level + 1):
                table[power].append(self.zero if power == 1 else dot(base, table[power - 1][level:0:-1]))
        self.tau.append(self.zero)
        self.bracket.append(self._bracket(level))
        self._extend(level)
        landing = dot(self.launch, [self.motion_powers[self.j + 1 + n][level - n] for n in range(level + 1)])
        self._correct(level, (landing - self._rebound(level)) * (1 / self._divisor(level)))

    def _bracket(self, level: int) -> Any:
        """a(sigma + z T) - (f - f(c, 0)) at one level, a polynomial in z."""
        j, coefficients = self.j, []
        for q in range(j + level + 1):
            total = self.zero
            for k in range(max(q, j), j + level + 1):
                if k in self.a:
                    total = total + self.a[k] * (self.tau_powers[q][level - (k - j)] * comb(k, q))
            coefficients.append(total)
        polynomial = self.polys.poly(coefficients)
        for key, value in self.force.items():
            shift = self._shift(*key)
            if shift <= level:
                polynomial = polynomial + self._product_in_time(*key, level=level - shift) * value
        return polynomial

    def _product_in_time(self, i: int, k: int, m: int = 0, *, level: int) -> Any:
        """One level of (tau y)^i y'^k (1 + z tau)^m."""
        if not m:
            return self._product(i, k, level)
        terms = [
            self._product(i, k, level - n)
            * self.polys.poly(
                [self.tau_powers[q][n] * comb(m, q) if n < len(self.tau_powers[q]) else self.zero for q in range(m + 1)]
            )
            for n in range(level + 1)
        ]
        return sum(terms[1:], terms[0])

    def _product(self, i: int, k: int, level: int) -> Any:
        """One level of (tau y)^i y'^k."""
        if not i and k == 1:
            return self.slope[level]
        known = self.products.setdefault((i, k), [])
        while len(known) <= level:
            known.append(self._next_product(i, k, len(known)))
        return known[level]

    def _next_product(self, i: int, k: int, level: int) -> Any:
        if (i, k) == (1, 0):
            return dot(self.y[: level + 1], self.tau[level::-1])
        lefts = [self._product(1, 0, n) for n in range(level + 1)] if i else self.slope[: level + 1]
        below = (i - 1, k) if i else (0, k - 1)
        return dot(lefts, [self._product(*below, level - n) for n in range(level + 1)])

    def _extend(self, level: int) -> None:
        """y at a level from y'' = tau(sigma) bracket, y(0) = y(1) = 0."""
        twice = self.polys.integral(self.polys.integral(dot(self.bracket[level::-1], self.tau)))
        launch = self.polys.at_one(twice) * -1
        self.y.append(twice + self.polys.poly([0, 1]) * launch)
        self.slope.append(self.polys.derivative(self.y[level]))
        self.launch.append(launch)
        self.impact.append(self.polys.at_one(self.slope[level]))

    def _rebound(self, level: int) -> Any:
        """One level of rho(U)."""
        total = self.impact[level] * self.r * -1
        for k, value in self.rho.items():
            below = level - (k - 1) * (self.j + 1)
            if below >= 0:
                total = total + self._impact_power(k, below) * value
        return total

    def _impact_power(self, k: int, level: int) -> Any:
        known = self.impact_powers.setdefault(k, [])
        while k > 1 and len(known) <= level:
            at = len(known)
            known.append(dot(self.impact[: at + 1], [self._impact_power(k - 1, at - n) for n in range(at + 1)]))
        return known[level]

    def _divisor(self, level: int) -> Any:
        """The factor of tau_level in rebound - landing: never zero for lambda in (0, 1)."""
        j, power = self.j, self.lambda_**self.j
        landing = self.launch_tangent * (power * self.lambda_ ** (level + 1)) + self.launch[0] * (power * (j + 1))
        divisor = self.impact_tangent * self.r * -1 - landing
        # over symbols with a_j = 1 it is a number of the prime field
        return divisor.coeffs()[0] if hasattr(divisor, "is_constant") else divisor

    def _correct(self, level: int, tau: Any) -> None:
        """Put tau_level into every table that knew it as zero."""
        self.tau[level] = tau
        self.launch[level] = self.launch[level] + self.launch_tangent * tau
        if level == self.order - self.j - 1:
            return  # the last level: nothing reads its tables, which are the longest
        for power in range(1, self.order - level + 1):
            self.tau_powers[power][level] += tau * (self.tau[0] ** (power - 1) * power)
            self.motion_powers[power][level] += tau * (self.lambda_ ** (power - 1) * power)
        self.bracket[level] = self.bracket[level] + self.bracket_tangent * tau
        self.y[level] = self.y[level] + self.y_tangent * tau
        self.slope[level] = self.polys.derivative(self.y[level])
        self.impact[level] = self.impact[level] + self.impact_tangent * tau

    def curve(self) -> InvariantCurve:
        """The curve in the ring's own elements."""
        element, j = self.polys.element, self.j
        return InvariantCurve(
            contact=self.contact,
            order=self.order,
            lambda_=element(self.lambda_),
            mu=element(multiplier_across(j, self.lambda_)),
            restitution=element(self.r),
            flight_time={n + 1: element(value) for n, value in enumerate(self.tau)},
            graph={j + 1 + n: element(value) for n, value in enumerate(self.launch)},
        )
