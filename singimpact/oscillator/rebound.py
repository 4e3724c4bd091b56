"""The restitution v -> rho(v): a number r for rho = -r v, or an expression in the velocity v < 0 before the impact."""

from fractions import Fraction
from functools import lru_cache
from typing import Any

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, Name, evaluate, multiply, names_in, number, substitute
from singimpact.algebra.numbers import compare, constant, tree_of
from singimpact.algebra.puiseux import Puiseux, expansion
from singimpact.inputs import InputError, refuse, require

ACCEPTED = (
    "a number from 0 to 1, or an expression rho in v with rho(0) = 0 and -1 <= rho'(0) < 0, such as -0.8*v + v**2"
)
# terms of the expansion of rho at rest: more where the first ones cancel, fewer where their coefficients become long
TERMS = (6, 24, 2)


def read(value: Any, parameters: dict[str, Expression], name: str = "restitution") -> Expression:
    """A restitution as a constant tree or a tree in v, checked at v = 0.

    Parameters
    ----------
    name : of the argument.

    Examples
    --------
    >>> print(read("-0.8*v + b*v**2", {"b": number(1)}))
    -0.8*v + b*v**2
    """
    try:
        tree = tree_of(value, ("v", *parameters), name)
        if "v" not in names_in(tree):
            tree = constant(name, value)
    except InputError as error:
        if callable(value) or (isinstance(value, str) and "v" in value):
            raise
        raise refuse(name, value, ACCEPTED) from error
    good = _good(substitute(tree, parameters)) if "v" in names_in(tree) else compare(tree, 0) >= 0 >= compare(tree, 1)
    require(good, name, value, ACCEPTED)
    return tree


@lru_cache(maxsize=256)
def is_zero(restitution: Expression) -> bool:
    """Whether a restitution is the number 0."""
    return not names_in(restitution) and compare(restitution, 0) == 0


def rho_of(restitution: Expression) -> Expression:
    """rho as a tree in v."""
    return restitution if "v" in names_in(restitution) else multiply(number(-1), restitution, Name("v"))


def _good(rho: Expression) -> bool:
    series = expanded(rho)
    if series is not None:
        (power, slope) = series.terms[0]
        return power == 1 and compare(slope, 0) > 0 >= compare(slope, 1)
    rest = {"v": number(0)}
    try:
        start, slope = _value(substitute(rho, rest)), _value(substitute(derivative(rho, "v"), rest))
        return compare(start, 0) == 0 and compare(slope, 0) < 0 <= compare(slope, -1)
    except (ArithmeticError, ValueError):
        return False


@lru_cache(maxsize=256)
def expanded(rho: Expression) -> Puiseux | None:
    """rho(-w) in rational powers of w > 0; None where it has no such expansion, or none of its terms is found.

    Examples
    --------
    >>> print(expanded(tree_of("-v + 0.3*(-v)**1.2", ("v",))))
    1*w**(1) + (0.3)*w**(6/5)
    """
    for count in TERMS:
        try:
            series = expansion(rho, "v", -1, count)
        except (ArithmeticError, ValueError):
            continue
        if series.terms:
            return series
    return None


@lru_cache(maxsize=256)
def at_rest(restitution: Expression, parameters: tuple[tuple[str, Expression], ...]) -> Puiseux | None:
    """rho(-w) as in `expanded`, of a restitution as a model keeps it."""
    return expanded(substitute(rho_of(restitution), dict(parameters)))


def _value(tree: Expression) -> Expression:
    """A constant as a rational when it is one: products with 0 and sin(0) stand unevaluated in a tree."""
    from singimpact.algebra.rings import EXACT

    try:
        return number(Fraction(evaluate(tree, {}, EXACT)))
    except ArithmeticError:
        return tree


@lru_cache(maxsize=256)
def slope_at_rest(restitution: Expression, parameters: tuple[tuple[str, Expression], ...]) -> Expression:
    """-rho'(0), the r of an impact that is slow enough."""
    if not names_in(restitution):
        return restitution
    found = at_rest(restitution, parameters)
    if found is not None:
        return found.terms[0][1]
    slope = substitute(derivative(restitution, "v"), {"v": number(0), **dict(parameters)})
    return multiply(number(-1), _value(slope))
