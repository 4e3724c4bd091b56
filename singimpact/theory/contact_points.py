"""A model at a contact point, in the best numbers there are: rationals, exact constants of sympy, or balls."""

from __future__ import annotations  # flint and sympy are loaded when they are used

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import factorial
from typing import Any

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Expression, evaluate
from singimpact.algebra.jets import JetSpace
from singimpact.algebra.numbers import as_float, as_fraction, compare, constant, tree_of
from singimpact.algebra.precision import balls_at, kept_property
from singimpact.algebra.rings import DOUBLES, EXACT, SYMBOLIC, Doubles, SymbolRing, to_sympy
from singimpact.algebra.solving import newton_in_balls
from singimpact.algebra.univariate import precision_of
from singimpact.contact.contact import (
    NAMED_ORDERS,
    TASK,
    Contact,
    acceleration_jet,
    derivative_name,
    force_jet,
    series_of_rho,
)
from singimpact.contact.points import TangencyPoint, tangency_points
from singimpact.contact.zero_ahead import ContactZero
from singimpact.handed_on import flint, sympy
from singimpact.inputs import InputError, need, refuse, require, require_known
from singimpact.oscillator.model import Oscillator, require_smooth_rho

NEAR = 1e-7  # a tau given as a double names the tangency point this close to it, in units of 1 + |tau|
LEAST = Fraction(1, 2**4096)  # halving for a multiplier ends here
ZERO_BITS = 512  # a value whose ball of so many bits holds 0 is taken as the zero that the contact order requires
KINDS = {1: ("gamma", "a' > 0"), 2: ("degenerate", "a'' < 0")}


@dataclass(frozen=True)
class Place:
    """A point of contact order j of a model.

    Attributes
    ----------
    model, j : as given. exact : tau_* as a constant tree, or None. point : the tangency point otherwise.
    """

    model: Oscillator
    j: int
    exact: Expression | None
    point: TangencyPoint | ContactZero | None

    @property
    def tau(self) -> float:
        """tau_* as a double."""
        return as_float(self.exact) if self.exact is not None else self.point.tau  # type: ignore[union-attr]

    def tau_in(self, ring: Any) -> Any:
        """tau_* in a ring: of rationals when it is written as one, of balls always."""
        if isinstance(ring, Doubles):
            return self.tau
        if self.exact is not None:
            return evaluate(self.exact, {}, ring)
        if isinstance(ring, Balls) and self.point is not None:
            return self.point.ball(ring.bits)
        raise ArithmeticError("tau_* is not rational")

    def contact(self, order: int, ring: Any) -> Contact:
        """The jets there, in a ring.

        Raises
        ------
        ArithmeticError : they are not all in the ring.
        """
        with precision_of(ring):
            return Contact.of(self.model, self.tau_in(ring), self.j, order, ring)

    def restitution_in(self, ring: Any) -> Any:
        """r = -rho'(0) in a ring; the series in which it stands is one of a rho that is smooth at rest."""
        require_smooth_rho(self.model, TASK)
        return evaluate(self.model.slope_at_rest(), {}, ring)

    def rho(self, order: int, ring: Any) -> dict[int, Any]:
        """k -> coefficient of v^k in rho, for k >= 2 and k (j + 1) <= order."""
        top = order // (self.j + 1)
        if top < 2:
            return {}
        with precision_of(ring):
            return {k: value for k, value in series_of_rho(self.model, top, ring).items() if k > 1}


def place(model: Any, j: int, tau: Any) -> Place:
    """The point of contact order j of a model that `tau` names, or its first with an invariant curve.

    Raises
    ------
    InputError : not a model; no such point; a_c does not vanish there to this order.
    """
    require(isinstance(model, Oscillator), "model", model, "an ImpactOscillator")
    if tau is None:
        return Place(model, j, None, _first(model, j))
    exact = constant("tau", tau)
    if not j or _vanishes(model, exact, j):
        return Place(model, j, exact, None)
    near = [p for p in tangency_points(model) if abs(p.tau - as_float(exact)) <= NEAR * (1 + abs(p.tau))]
    if not near or (near[0].kind == "degenerate") != (j > 1):
        jet = acceleration_jet(model, as_float(exact), max(j - 1, 0), DOUBLES)
        values = ", ".join(f"{float(value):.3g}" for value in jet)
        raise InputError(f"tau = {exact} is not of contact order {j}: a_c and its derivatives there are {values}")
    return Place(model, j, None, near[0])


def ending_gamma(where: Place) -> Place:
    """The place, when a gamma ends there: a_c < 0 before it, so a^(j) > 0 at an odd contact order, < 0 at an even one.

    Raises
    ------
    InputError : a_c is positive before it, or its j-th derivative is zero to ZERO_BITS.

    Examples
    --------
    >>> model = Oscillator("x", "cos(2*t)", "0.3", "1/2")
    >>> ending_gamma(place(model, 1, None)).j
    1
    """
    j, balls = where.j, Balls(ZERO_BITS)
    with precision_of(balls):
        lead = acceleration_jet(where.model, where.tau_in(balls), j, balls)[j]
    wanted = 1 if j % 2 else -1
    if lead * wanted > 0:
        return where
    name = "a" + "'" * j if j < 4 else f"a^({j})"
    at = str(where.exact) if where.exact is not None else f"{where.tau:.6g}"
    if lead.contains(0):
        raise InputError(f"tau = {at}: {name} = 0 too, so that the contact order is above {j}: give a higher at=")
    kind = {1: "a tangency of the kind foliation", 2: "a positive swan"}.get(j, f"a point of contact order {j}")
    wording = f"{kind} with {name} {'<' if wanted > 0 else '>'} 0, and a_c > 0 on its left"
    needed = f"{name} {'>' if wanted > 0 else '<'} 0, where a_c < 0 on the left"
    raise InputError(f"tau = {at} is {wording}: no gamma ends there; give a point with {needed}")


def points_of(model: Oscillator, tau: Any) -> list[int]:
    """The contact orders 0, 1, 2 to look at: that of tau, or those of the model's points with an invariant curve."""
    if tau is not None:
        return [next(j for j in (2, 1, 0) if j == 0 or _is_place(model, j, tau))]
    found = [j for j in KINDS if _is_place(model, j, None)]
    need(found, InputError("a_c of this model has no tangency or swan point with an invariant curve: give tau"))
    return found


def _is_place(model: Oscillator, j: int, tau: Any) -> bool:
    try:
        place(model, j, tau)
    except InputError:
        return False
    return True


def _first(model: Oscillator, j: int) -> TangencyPoint:
    if j not in KINDS:
        raise InputError(f"tau is needed at contact order {j}: give tau=")
    kind, wording = KINDS[j]
    points = [point for point in tangency_points(model) if point.kind == kind]
    if j == 2:
        points = [point for point in points if acceleration_jet(model, point.tau, 2, DOUBLES)[2] < 0]
    if not points:
        name = next(name for name, order in NAMED_ORDERS.items() if order == j)
        raise InputError(f"a_c of this model has no {name} point with {wording}: give tau= or another clearance")
    return points[0]


def _vanishes(model: Oscillator, tau: Expression, j: int) -> bool:
    """Whether a_c and its first j - 1 derivatives are zero at an exact tau: in rationals, or to ZERO_BITS."""
    balls = Balls(ZERO_BITS)
    with precision_of(balls):
        return all(bool(value.contains(0)) for value in acceleration_jet(model, tau, j - 1, balls))


def exact_contact(where: Place, order: int) -> Contact | None:
    """The jets as rationals, or as polynomials in exact constants of sympy; None when tau_* is not exact."""
    try:
        return where.contact(order, EXACT)
    except ArithmeticError:
        if where.exact is None:
            return None
    try:
        return contact_of_constants(where.model, where.exact, where.j, order)
    except ArithmeticError:  # tau_* or c is a root without another name
        return None


def multiplier(j: int, r: Expression, bits: int | None = None) -> Any:
    """lambda in (0, 1) with r = lambda^(j+1) P_j/Q_j: a rational or None; a ball when bits are given.

    Examples
    --------
    >>> from singimpact.algebra.expressions import number
    >>> multiplier(1, number(Fraction(5, 16))), multiplier(1, number(Fraction(1, 3)))
    (Fraction(1, 2), None)
    """
    require(compare(r, 1) < 0, "restitution", r, "a number r < 1 here: at r = 1 no curve is invariant and attracting")
    if bits is None:
        return _rational_multiplier(j, as_fraction(r))
    with balls_at(bits):
        return _multiplier_ball(j, evaluate(r, {}, Balls(bits)), bits)


def _equation(j: int) -> tuple[list[int], list[int]]:
    """Coefficients of lambda^(j+1) P_j and of Q_j."""
    return [0] * (j + 1) + [j + 1 - i for i in range(j + 1)], [i + 1 for i in range(j + 1)]


def _rational_multiplier(j: int, r: Fraction | None) -> Fraction | None:
    if r is None:
        return None
    above, below = map(flint.fmpq_poly, _equation(j))
    roots = (above - below * flint.fmpq(r.numerator, r.denominator)).roots()
    return next((Fraction(int(root.p), int(root.q)) for root, _ in roots if 0 < root < 1), None)


def _multiplier_ball(j: int, r: flint.arb, bits: int) -> flint.arb:
    """Halving to a short interval, then Newton's method on balls, which proves the root."""
    above, below = (flint.arb_poly(coefficients) for coefficients in _equation(j))
    poly = above - below * r
    slope = poly.derivative()
    low, high = Fraction(0), Fraction(1)
    ball = Balls(bits).interval(low, high)
    # r = 1e-300 has its root at 1e-150: until the slope keeps its sign there, Newton's step would divide by 0
    while high - low > Fraction(1, 2**64) or (not slope(ball) > 0 and high > LEAST):
        middle = (low + high) / 2
        low, high = (low, middle) if poly(Balls(bits).rational(middle)) > 0 else (middle, high)
        ball = Balls(bits).interval(low, high)
    return newton_in_balls(poly, slope, ball)


# Jets that are exact but not rational: polynomials in constants such as cos(12/5), or in letters.


class ConstantRing(SymbolRing):
    """Q[constants]: a SymbolRing whose names stand for sympy expressions.

    Examples
    --------
    >>> import sympy
    >>> ring = ConstantRing((sympy.cos(2),))
    >>> ring.to_sympy(ring.from_sympy(sympy.cos(2)**2/3 + 1))
    cos(2)**2/3 + 1
    """

    def __init__(self, constants: Sequence[Any]) -> None:
        super().__init__(tuple(f"constant_{n}" for n in range(len(constants))))
        self.constants = tuple(constants)

    def from_sympy(self, value: Any) -> Any:
        """A sympy polynomial in the constants as an element."""
        total = self.rational(Fraction(0))
        for key, coefficient in sympy.Poly(value, *self.constants, domain="QQ").terms():
            term = self.rational(Fraction(int(coefficient.p), int(coefficient.q)))
            for name, exponent in zip(self.names, key, strict=True):
                term *= self.symbol(name) ** int(exponent)
            total += term
        return total

    def letters(self) -> list[Any]:
        """The constants."""
        return list(self.constants)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ConstantRing) and self.constants == other.constants

    def __hash__(self) -> int:
        return hash(self.constants)


def contact_of_constants(model: Oscillator, tau: Expression, j: int, order: int) -> Contact:
    """The jets of a model at an exact tau as polynomials in constants, or as rationals when they are."""
    a = acceleration_jet(model, to_sympy(tau), max(order - 1, j), SYMBOLIC)
    return contact_in_sympy(dict(enumerate(a)), force_jet(model, j, order, SYMBOLIC, tau=to_sympy(tau)), j, tau)


def contact_in_sympy(
    a: Mapping[int, Any], f: Mapping[tuple[int, ...], Any], j: int, tau: Expression | None = None
) -> Contact:
    """Jets that are sympy expressions as polynomials in whatever they are made of; a_0..a_(j-1) are left out."""
    values: dict[Any, Any] = {("a", k): sympy.expand(value) for k, value in a.items() if k >= j}
    values |= {pair: sympy.expand(value) for pair, value in f.items()}
    ring, convert = _ring_of(list(values.values()))
    jets = {key: convert(value) for key, value in values.items() if value != 0}
    zero = ring.rational(Fraction(0))
    return Contact(
        j,
        ring,
        {k: jets.get(("a", k), zero) for k in a if k >= j},
        {key: value for key, value in jets.items() if key[0] != "a"},
        tau,
    )


def _ring_of(values: list[Any]) -> tuple[Any, Any]:
    moving = [value for value in values if not value.is_Rational]
    if not moving:
        return EXACT, lambda value: Fraction(int(value.p), int(value.q))
    _, options = sympy.parallel_poly_from_expr(moving, domain="QQ")
    ring = ConstantRing(options.gens)
    return ring, ring.from_sympy


# A model whose parameters stay letters: its jets in place of the generic ones. Without a point of the tau-axis the
# derivatives of a_c stay letters too, the first of them zero by the contact order.

TAKEN = re.compile(r"sigma|lambda|eta|a|a_d\d+|f_\d+|rho_\d+")


@dataclass(frozen=True)
class LetteredModel:
    """A model at contact order j with the parameters `keep` as letters.

    Parameters
    ----------
    tau : None, or text or a sympy expression in the letters, at which a_c and j - 1 derivatives vanish identically.

    Raises
    ------
    InputError : a name in `keep` is no parameter; a_c does not vanish at tau for all values of the letters.
    """

    model: Oscillator
    keep: Sequence[str]
    j: int
    tau: Any = None

    def __post_init__(self) -> None:
        require(isinstance(self.model, Oscillator), "model", self.model, "an ImpactOscillator")
        if isinstance(self.keep, str) or not isinstance(self.keep, Sequence) or not self.keep:
            raise refuse("keep", self.keep, "a sequence of names of parameters")
        if self.model.parametric:
            raise refuse("keep", self.keep, "no names for a model in whose f t occurs; its series have numbers")
        require_known("parameter", self.keep, self.model.parameters)
        for name in self.keep:
            if TAKEN.fullmatch(name):
                raise refuse("keep", name, "a parameter whose name is no letter of the series: give it another name")

    @kept_property
    def _tau(self) -> Any:
        return None if self.tau is None else to_sympy(tree_of(self.tau, self.keep, "tau"))

    def acceleration(self, order: int) -> dict[int, Any]:
        """k -> a_c^(k)(tau_*)/k! for k = j..order."""
        if self._tau is None:
            return {k: sympy.Symbol(derivative_name(k)) / factorial(k) for k in range(self.j, order + 1)}
        derivatives = [sympy.expand(c) for c in acceleration_jet(self.model, self._tau, order, SYMBOLIC, self.keep)]
        if any(value != 0 for value in derivatives[: self.j]):
            listed = ", ".join(str(value) for value in derivatives[: self.j])
            raise InputError(
                f"tau = {self.tau} is not of contact order {self.j} for all values of the letters: {listed}"
            )
        return {k: value for k, value in enumerate(derivatives) if k >= self.j}

    def contact(self, order: int) -> Contact:
        """The jets as polynomials, for a sheet to this order."""
        try:
            return self._polynomial(order)
        except ArithmeticError:  # sin, a root or pi: sympy names what the jets are polynomials in
            a = self.acceleration(max(order - 1, self.j))
            return contact_in_sympy(a, force_jet(self.model, self.j, order, SYMBOLIC, self.keep), self.j)

    def _polynomial(self, order: int) -> Contact:
        """Without sympy, when f is a polynomial and the derivatives of a_c stay letters."""
        need(self.tau is None, ArithmeticError("tau is given"))
        names = [derivative_name(k) for k in range(self.j, max(order, self.j + 1))]
        ring = SymbolRing((*names, *self.keep))
        a = {k: ring.symbol(name) * ring.rational(Fraction(1, factorial(k))) for k, name in enumerate(names, self.j)}
        return Contact(self.j, ring, a, force_jet(self.model, self.j, order, ring, self.keep))

    def values(self, order: int) -> dict[Any, Any]:
        """Generic symbol (a_dk, f_ik, rho_n) -> what this model has there."""
        jets_ = {}
        if self._tau is not None:
            jets = self.acceleration(order)
            jets_ = {sympy.Symbol(derivative_name(k)): value * factorial(k) for k, value in jets.items()}
        f = force_jet(self.model, self.j, order, SYMBOLIC, self.keep)
        for i in range(order + 1):
            for k in range(order + 1 - i):
                jets_[sympy.Symbol(f"f_{i}{k}")] = f.get((i, k), 0) * factorial(i) * factorial(k)
        return jets_ | self._rho(order)

    def _rho(self, order: int) -> dict[Any, Any]:
        require_smooth_rho(self.model, TASK)
        space = JetSpace(("v",), order, SYMBOLIC)
        letters = {name: space.constant(SYMBOLIC.symbol(name)) for name in self.keep}
        jet = space.evaluate(self.model.rho(self.keep), {"v": space.generators()[0], **letters})
        return {sympy.Symbol(f"rho_{n}"): jet.coefficient((n,)) for n in range(2, order + 1)}

    def put_in(self, order: int) -> Callable[[Any], Any]:
        """Takes an expression in the generic symbols to this model's."""
        values = self.values(order)
        return lambda expression: expression.subs(values, simultaneous=True)
