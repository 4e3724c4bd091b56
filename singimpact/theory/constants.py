"""Jets that are exact but not rational: polynomials in constants such as cos(12/5), or in letters."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import factorial
from typing import Any

from singimpact.algebra.expressions import Expression
from singimpact.algebra.jets import JetSpace
from singimpact.algebra.numbers import tree_of
from singimpact.algebra.precision import kept_property
from singimpact.algebra.rings import EXACT, SYMBOLIC, SymbolRing, to_sympy
from singimpact.contact.contact import Contact, acceleration_jet, derivative_name, force_jet
from singimpact.handed_on import sympy
from singimpact.inputs import InputError, refuse, require_known
from singimpact.oscillator.model import Oscillator, require_smooth_rho
from singimpact.oscillator.rho_series import TASK


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
        if not isinstance(self.model, Oscillator):
            raise refuse("model", self.model, "an ImpactOscillator")
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
        if self.tau is not None:
            raise ArithmeticError("tau is given")
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
