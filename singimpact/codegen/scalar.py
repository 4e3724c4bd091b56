"""An expression as the source of one function of one number, its constant parts as an argument."""

import math
from collections.abc import Callable
from fractions import Fraction

from singimpact.algebra.expressions import Call, Expression, Name, Number, Power, Product, Sum, names_in
from singimpact.algebra.numbers import as_float
from singimpact.codegen.over_lists import FUNCTIONS, plain

MATH = {name: getattr(math, name) for name in FUNCTIONS}


def scalar(tree: Expression, variable: str, name: str) -> tuple[str, tuple[Expression, ...]]:
    """The text of `name(variable, w)` and the trees whose values fill w: models that differ in numbers share a text.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> text, constants = scalar(parse("-r*v + 3*v**2", ["r", "v"]), "v", "rho")
    >>> print(text, *constants)
    def rho(v, w):
        return w[0] * w[1] * v + w[2] * (v**2)
     -1 r 3
    """
    constants: list[Expression] = []
    body = _source(tree, variable, constants)
    return f"def {name}({variable}, w):\n    return {body}\n", tuple(constants)


def in_floats(tree: Expression, variable: str) -> Callable[[float], float]:
    """An expression as a Python function of one float; nan where it is no real number in doubles.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> root = in_floats(parse("sqrt(v)/2", ["v"]), "v")
    >>> root(9.0), root(-9.0)
    (1.5, nan)
    """
    text, trees = scalar(tree, variable, "value")
    function, constants = plain(text, MATH)["value"], [as_float(constant) for constant in trees]

    def value(number: float) -> float:
        try:
            result = function(number, constants)
        except (ArithmeticError, ValueError):
            return math.nan
        return result if isinstance(result, float) else math.nan  # a root of a negative number is complex

    return value


def _source(tree: Expression, variable: str, constants: list[Expression]) -> str:
    if variable not in names_in(tree):
        if tree not in constants:
            constants.append(tree)
        return f"w[{constants.index(tree)}]"
    match tree:
        case Name():
            return variable
        case Sum(terms):
            return " + ".join(_source(term, variable, constants) for term in terms)
        case Product(factors):
            return " * ".join(_bracketed(factor, variable, constants) for factor in factors)
        case Power(base, Number(exponent)) if exponent.denominator == 1 and exponent > 0:
            return f"{_bracketed(base, variable, constants)}**{exponent}"
        case Power(base, Number(Fraction(numerator=-1, denominator=1))):
            return f"1 / {_bracketed(base, variable, constants)}"
        case Power(base, exponent):
            powers = (_bracketed(operand, variable, constants) for operand in (base, exponent))
            return "**".join(powers)
        case Call("sqrt", argument):
            return f"({_source(argument, variable, constants)}) ** 0.5"
        case Call(function, argument):
            return f"{function}({_source(argument, variable, constants)})"
    raise TypeError(f"not an expression: {tree!r}")


def _bracketed(tree: Expression, variable: str, constants: list[Expression]) -> str:
    text = _source(tree, variable, constants)
    return text if " " not in text and "**" not in text else f"({text})"
