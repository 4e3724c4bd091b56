"""Kinds of number a tree is evaluated over: exact rationals, doubles and arrays, mpmath numbers, sympy objects.

Balls have a file of their own (`balls`), jets too (`jets`).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import inf
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Expression, Root, evaluate
from singimpact.algebra.polynomials import PackedPolynomials


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
        if exponent.denominator != 1:
            raise ArithmeticError("a root is not rational")
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

    def __mul__(self, factor: Fraction) -> Angle:
        return Angle(self.turns * factor)

    __rmul__ = __mul__

    def __add__(self, other: Angle) -> Angle:
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
        import sympy

        return sympy.Symbol(name)

    def element(self, value: Any) -> Any:
        """A sympy object without a float in it, or a rational of Python."""
        import sympy

        found = self.rational(value) if isinstance(value, Fraction) else sympy.sympify(value)
        if found.has(sympy.Float):
            raise TypeError(f"{value!r} is not exact")
        return found

    def rational(self, value: Fraction) -> Any:
        import sympy

        return sympy.Rational(value.numerator, value.denominator)

    def pi(self) -> Any:
        import sympy

        return sympy.pi

    def power(self, base: Any, exponent: Fraction) -> Any:
        return base ** self.rational(exponent)

    def call(self, function: str, argument: Any) -> Any:
        import sympy

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
    import sympy

    from singimpact.algebra.expressions import names_in

    return evaluate(tree, {name: sympy.Symbol(name) for name in names_in(tree)}, SYMBOLIC)
