"""Jets that are exact but not rational: polynomials in constants such as cos(12/5), or in letters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from singimpact.algebra.expressions import Expression
from singimpact.algebra.rings import EXACT, SYMBOLIC, to_sympy
from singimpact.algebra.symbols import SymbolRing
from singimpact.contact.contact import Contact, acceleration_jet, force_jet
from singimpact.oscillator.model import Oscillator


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
        import sympy

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
    return contact_in_sympy(dict(enumerate(a)), force_jet(model, j, order, SYMBOLIC), j, tau)


def contact_in_sympy(
    a: Mapping[int, Any], f: Mapping[tuple[int, int], Any], j: int, tau: Expression | None = None
) -> Contact:
    """Jets that are sympy expressions as polynomials in whatever they are made of; a_0..a_(j-1) are left out."""
    import sympy

    values: dict[Any, Any] = {("a", k): sympy.expand(value) for k, value in a.items() if k >= j}
    values |= {pair: sympy.expand(value) for pair, value in f.items()}
    ring, convert = _ring_of(list(values.values()))
    jets = {key: convert(value) for key, value in values.items() if value != 0}
    zero = ring.rational(Fraction(0))
    return Contact(
        j,
        ring,
        {k: jets.get(("a", k), zero) for k in a if k >= j},
        {(i, k): value for (i, k), value in jets.items() if i != "a"},
        tau,
    )


def _ring_of(values: list[Any]) -> tuple[Any, Any]:
    import sympy

    moving = [value for value in values if not value.is_Rational]
    if not moving:
        return EXACT, lambda value: Fraction(int(value.p), int(value.q))
    _, options = sympy.parallel_poly_from_expr(moving, domain="QQ")
    ring = ConstantRing(options.gens)
    return ring, ring.from_sympy
