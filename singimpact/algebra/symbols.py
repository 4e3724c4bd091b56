"""Polynomials in symbols with rational coefficients, as a ring of coefficients: python-flint's fmpq_mpoly."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import Any

from singimpact.algebra.polynomials import PackedPolynomials
from singimpact.algebra.precision import kept_property
from singimpact.algebra.rings import EXACT


class SymbolRing:
    """The ring Q[names].

    Examples
    --------
    >>> ring = SymbolRing(("a", "b"))
    >>> ring.to_sympy(ring.symbol("a") * ring.rational(Fraction(1, 2)))
    a/2
    """

    def __init__(self, names: tuple[str, ...]) -> None:
        import flint

        self.names = names
        self._context = flint.fmpq_mpoly_ctx.get(names, "degrevlex")
        self._symbols = dict(zip(names, self._context.gens(), strict=True))

    def element(self, value: Any) -> Any:
        """A polynomial of this ring, or a rational of Python; a float is refused."""
        if isinstance(value, int | Fraction) and not isinstance(value, bool):
            return self.rational(Fraction(value))
        if getattr(value, "context", None) is None or value.context() is not self._context:
            raise TypeError(f"{value!r} is not a polynomial in {', '.join(self.names)} over the rationals")
        return value

    def polynomials(self, variables: tuple[str, ...]) -> PackedPolynomials:
        return PackedPolynomials(variables, self.names, self._context)

    def power(self, base: Any, exponent: Fraction) -> Any:
        """A power; a negative one of a constant alone."""
        if exponent.denominator == 1 and exponent >= 0:
            return base ** int(exponent)
        if exponent.denominator == 1 and base.is_constant() and base != 0:
            return self._context.constant(base.coeffs()[0] ** int(exponent))
        raise ArithmeticError(f"({base})**({exponent}) is not a polynomial")

    def symbol(self, name: str) -> Any:
        """One of the names as a polynomial."""
        return self._symbols[name]

    def rational(self, value: Fraction) -> Any:
        import flint

        return self._context.constant(flint.fmpq(value.numerator, value.denominator))

    def pi(self) -> Any:
        raise ArithmeticError("pi is not a polynomial")

    def call(self, function: str, argument: Any) -> Any:
        """A function of a constant polynomial whose value is rational; others are no polynomials."""
        if argument.is_constant():
            (start,) = argument.coeffs() or [0]
            return self.rational(EXACT.call(function, Fraction(int(start.numerator), int(start.denominator))))
        raise ArithmeticError(f"{function}({argument}) is not a polynomial")

    def letters(self) -> list[Any]:
        """Names -> the symbols that sympy shows for them."""
        import sympy

        return [sympy.Symbol(name) for name in self.names]

    def to_sympy(self, value: Any) -> Any:
        """A polynomial of the ring as a sympy expression."""
        import sympy

        terms = {key: sympy_rational(int(c.p), int(c.q)) for key, c in value.to_dict().items()}
        if self._monomials is not None:
            return self._monomials.summed(terms)
        letters = self.letters()
        return sympy.Add(
            *(c * sympy.prod(s ** int(e) for s, e in zip(letters, key, strict=True)) for key, c in terms.items())
        )

    @kept_property
    def _monomials(self) -> Any:
        """The sums that need no sympy to put in order; None when a name stands for more than a symbol."""
        import sympy

        from singimpact.algebra.long_sums import Monomials

        letters = self.letters()
        return Monomials(letters) if all(type(letter) is sympy.Symbol for letter in letters) else None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SymbolRing) and self.names == other.names

    def __hash__(self) -> int:
        return hash(self.names)


@lru_cache(maxsize=65_536)
def sympy_rational(above: int, below: int) -> Any:
    """A rational of sympy; the same few come again and again."""
    import sympy

    return sympy.Rational(above, below)
