"""An expression as the source of a function of numbers, its constant parts as an argument."""

import math
from collections.abc import Callable
from fractions import Fraction

from singimpact.algebra.expressions import Call, Expression, Name, Number, Power, Product, Sum, names_in
from singimpact.algebra.numbers import as_float
from singimpact.codegen.over_lists import FUNCTIONS, plain

MATH = {name: getattr(math, name) for name in FUNCTIONS}


def scalar(tree: Expression, variables: tuple[str, ...], name: str) -> tuple[str, tuple[Expression, ...]]:
    """The text of `name(*variables, w)` and the trees whose values fill w: models that differ in numbers share a text.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> text, constants = scalar(parse("-r*v + 3*v**2", ["r", "v"]), ("v",), "rho")
    >>> print(text, *constants)
    def rho(v, w):
        return w[0] * w[1] * v + w[2] * (v**2)
     -1 r 3
    """
    constants: list[Expression] = []
    body = _source(tree, frozenset(variables), constants)
    return f"def {name}({', '.join(variables)}, w):\n    return {body}\n", tuple(constants)


def in_floats(tree: Expression, *variables: str) -> Callable[..., float]:
    """An expression as a Python function of floats; nan where it is no real number in doubles.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> root = in_floats(parse("sqrt(v)/2", ["v"]), "v")
    >>> root(9.0), root(-9.0)
    (1.5, nan)
    """
    text, trees = scalar(tree, variables, "value")
    function, constants = plain(text, MATH)["value"], [as_float(constant) for constant in trees]

    def value(*numbers: float) -> float:
        try:
            result = function(*numbers, constants)
        except (ArithmeticError, ValueError):
            return math.nan
        return result if isinstance(result, float) else math.nan  # a root of a negative number is complex

    return value


def _source(tree: Expression, variables: frozenset[str], constants: list[Expression]) -> str:
    if not variables & names_in(tree):
        if tree not in constants:
            constants.append(tree)
        return f"w[{constants.index(tree)}]"
    match tree:
        case Name(name):
            return name
        case Sum(terms):
            return " + ".join(_source(term, variables, constants) for term in terms)
        case Product(factors):
            return " * ".join(_bracketed(factor, variables, constants) for factor in factors)
        case Power(base, Number(exponent)) if exponent.denominator == 1 and exponent > 0:
            return f"{_bracketed(base, variables, constants)}**{exponent}"
        case Power(base, Number(Fraction(numerator=-1, denominator=1))):
            return f"1 / {_bracketed(base, variables, constants)}"
        case Power(base, exponent):
            return "**".join(_bracketed(operand, variables, constants) for operand in (base, exponent))
        case Call("sqrt", argument):
            return f"({_source(argument, variables, constants)}) ** 0.5"
        case Call(function, argument):
            return f"{function}({_source(argument, variables, constants)})"
    raise TypeError(f"not an expression: {tree!r}")


def _bracketed(tree: Expression, variables: frozenset[str], constants: list[Expression]) -> str:
    text = _source(tree, variables, constants)
    return text if " " not in text and "**" not in text else f"({text})"
