"""The derivative of an expression tree by one of its names."""

from singimpact.algebra.expressions import (
    MINUS_ONE,
    ONE,
    ZERO,
    Call,
    Expression,
    Name,
    Power,
    Product,
    Sum,
    add,
    multiply,
    names_in,
    number,
    power,
    subtract,
)


def derivative(tree: Expression, name: str) -> Expression:
    """d tree/d name, as it comes out of the rules; |u| gives u/|u|.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> print(derivative(parse("a*x**3 + sin(2*x)", ["a", "x"]), "x"))
    3*a*x**2 + 2*cos(2*x)
    """
    if name not in names_in(tree):
        return ZERO
    match tree:
        case Name():
            return ONE
        case Sum(terms):
            return add(*(derivative(term, name) for term in terms))
        case Product(factors):
            return add(*(_one_changed(factors, index, name) for index in range(len(factors))))
        case Power(base, exponent):
            if name not in names_in(exponent):
                return multiply(exponent, power(base, add(exponent, MINUS_ONE)), derivative(base, name))
            return multiply(power(base, exponent), derivative(multiply(exponent, Call("log", base)), name))
        case Call(function, argument):
            return multiply(_outer(function, argument), derivative(argument, name))
    raise TypeError(f"not an expression: {tree!r}")


def _one_changed(factors: tuple[Expression, ...], index: int, name: str) -> Expression:
    changed = derivative(factors[index], name)
    return ZERO if changed == ZERO else multiply(*factors[:index], *factors[index + 1 :], changed)


def _outer(function: str, u: Expression) -> Expression:
    """The derivative of a function of the whitelist at u."""
    inverse = power(u, MINUS_ONE) if u != ZERO else u
    match function:
        case "sin":
            return Call("cos", u)
        case "cos":
            return multiply(MINUS_ONE, Call("sin", u))
        case "exp":
            return Call("exp", u)
        case "tan":
            return add(ONE, power(Call("tan", u), number(2)))
        case "tanh":
            return subtract(ONE, power(Call("tanh", u), number(2)))
        case "atan":
            return power(add(ONE, power(u, number(2))), MINUS_ONE)
        case "log":
            return inverse
        case "sqrt":
            return power(multiply(number(2), Call("sqrt", u)), MINUS_ONE)
    return multiply(u, power(Call("abs", u), MINUS_ONE))
