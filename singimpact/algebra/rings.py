"""Kinds of number a tree is evaluated over: rationals, doubles and arrays, mpmath numbers, sympy objects, polynomials.

Balls have a file of their own (`balls`), jets too (`jets`).
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import inf
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Expression, Root, evaluate, names_in
from singimpact.algebra.polynomials import PackedPolynomials
from singimpact.algebra.precision import kept_property
from singimpact.handed_on import flint, sympy
from singimpact.inputs import need


class Exact:
    """Rationals; what is not rational raises."""

    def element(self, value: Any) -> Fraction:
        """A number that is of this ring; a float is not, whatever its value."""
        if isinstance(value, int | Fraction) and not isinstance(value, bool):
            return Fraction(value)
        raise TypeError(f"{value!r} is not an exact rational")

    def polynomials(self, variables: tuple[str, ...]) -> PackedPolynomials:
        return PackedPolynomials(variables)

    def rational(self, value: Fraction) -> Fraction:
        return value

    def pi(self) -> Any:
        raise ArithmeticError("pi is not rational")

    def power(self, base: Any, exponent: Fraction) -> Any:
        need(exponent.denominator == 1, ArithmeticError("a root is not rational"))
        return base ** int(exponent)

    def call(self, function: str, argument: Any) -> Any:
        if function == "abs":
            return abs(argument)
        at_zero = {"sin": 0, "tan": 0, "tanh": 0, "atan": 0, "cos": 1, "exp": 1, "sqrt": 0}
        if argument == 0 and function in at_zero:
            return Fraction(at_zero[function])
        if argument == 1 and function in ("log", "sqrt"):
            return Fraction(int(function == "sqrt"))
        raise ArithmeticError(f"{function} of a rational is not rational")

    def root(self, tree: Root) -> Any:
        raise ArithmeticError(f"{tree} is not written as a rational")


@dataclass(frozen=True)
class Angle:
    """A rational multiple of pi."""

    turns: Fraction

    def __mul__(self, factor: Fraction) -> "Angle":
        return Angle(self.turns * factor)

    __rmul__ = __mul__

    def __add__(self, other: "Angle") -> "Angle":
        return Angle(self.turns + other.turns) if isinstance(other, Angle) else NotImplemented


class ExactAtAngles(Exact):
    """Rationals, and sines and cosines of multiples of pi/6 that are rational; what is none raises.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> evaluate(parse("3*cos(2*pi/3) + sin(5*pi)", []), {}, ExactAtAngles())
    Fraction(-3, 2)
    """

    def pi(self) -> Angle:
        return Angle(Fraction(1))

    def call(self, function: str, argument: Any) -> Any:
        if not isinstance(argument, Angle):
            return super().call(function, argument)
        sixths = 6 * argument.turns - (3 if function == "cos" else 0)  # cos(x) = -sin(x - pi/2)
        values = {0: 0, 1: 1, 3: 2, 5: 1, 6: 0, 7: -1, 9: -2, 11: -1}
        if function not in ("sin", "cos") or sixths.denominator > 1 or int(sixths) % 12 not in values:
            raise ArithmeticError(f"{function} of this angle is not rational")
        return Fraction(values[int(sixths) % 12], 2 if function == "sin" else -2)


class Doubles:
    """Python floats and numpy arrays."""

    def element(self, value: Any) -> Any:
        """A number that is of this ring, or a rational of Python."""
        if isinstance(value, float | int | np.ndarray | np.floating | np.integer):
            return value
        if isinstance(value, Fraction):
            return float(value)
        raise TypeError(f"{value!r} is not a double")

    def rational(self, value: Fraction) -> float:
        try:
            return float(value)
        except OverflowError:  # atan of such a number is a double all the same
            return inf if value > 0 else -inf

    def pi(self) -> float:
        return np.pi

    def power(self, base: Any, exponent: Fraction) -> Any:
        if exponent.denominator == 1 and abs(exponent) <= 64:
            try:
                return base ** int(exponent) if exponent > 0 else 1.0 / base ** int(-exponent)
            except (OverflowError, ZeroDivisionError):  # Python's floats; numpy's are inf then
                pass
        with np.errstate(all="ignore"):
            return np.power(base, float(exponent))

    def call(self, function: str, argument: Any) -> Any:
        return getattr(np, {"atan": "arctan"}.get(function, function))(argument)

    def root(self, tree: Root) -> float:
        return float(Balls(128).root(tree).mid())


@dataclass(frozen=True)
class Multiprecision:
    """mpmath numbers of one context."""

    context: Any

    def element(self, value: Any) -> Any:
        """A number that is of this ring, or a rational of Python."""
        if isinstance(value, Fraction):
            return self.rational(value)
        if isinstance(value, int | self.context.mpf):
            return value
        raise TypeError(f"{value!r} is not a number of this mpmath context")

    def rational(self, value: Fraction) -> Any:
        return self.context.mpf(value.numerator) / value.denominator

    def pi(self) -> Any:
        return +self.context.pi

    def power(self, base: Any, exponent: Fraction) -> Any:
        return base ** int(exponent) if exponent.denominator == 1 else base ** self.rational(exponent)

    def call(self, function: str, argument: Any) -> Any:
        return (
            abs(argument)
            if function == "abs"
            else getattr(self.context, {"log": "ln"}.get(function, function))(argument)
        )

    def root(self, tree: Root) -> Any:
        mantissa, exponent = Balls(self.context.prec + 32).root(tree).mid().man_exp()
        return self.context.ldexp(self.context.mpf(int(mantissa)), int(exponent))


class Symbolic:
    """sympy objects."""

    def symbol(self, name: str) -> Any:
        """A letter."""
        return sympy.Symbol(name)

    def element(self, value: Any) -> Any:
        """A sympy object without a float in it, or a rational of Python."""
        found = self.rational(value) if isinstance(value, Fraction) else sympy.sympify(value)
        if found.has(sympy.Float):
            raise TypeError(f"{value!r} is not exact")
        return found

    def rational(self, value: Fraction) -> Any:
        return sympy.Rational(value.numerator, value.denominator)

    def pi(self) -> Any:
        return sympy.pi

    def power(self, base: Any, exponent: Fraction) -> Any:
        return base ** self.rational(exponent)

    def call(self, function: str, argument: Any) -> Any:
        return getattr(sympy, "Abs" if function == "abs" else function)(argument)

    def root(self, tree: Root) -> Any:
        raise ArithmeticError(f"{tree} is not written with functions")


EXACT, DOUBLES, SYMBOLIC = Exact(), Doubles(), Symbolic()


def to_sympy(tree: Expression) -> Any:
    """The tree as a sympy expression in plain symbols.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> to_sympy(parse("x**2/2", ["x"]))
    x**2/2
    """
    return evaluate(tree, {name: sympy.Symbol(name) for name in names_in(tree)}, SYMBOLIC)


# Polynomials in symbols with rational coefficients, as a ring of coefficients: python-flint's fmpq_mpoly.


class SymbolRing:
    """The ring Q[names].

    Examples
    --------
    >>> ring = SymbolRing(("a", "b"))
    >>> ring.to_sympy(ring.symbol("a") * ring.rational(Fraction(1, 2)))
    a/2
    """

    def __init__(self, names: tuple[str, ...]) -> None:
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
        return [sympy.Symbol(name) for name in self.names]

    def to_sympy(self, value: Any) -> Any:
        """A polynomial of the ring as a sympy expression."""
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
    return sympy.Rational(above, below)
