"""Polynomials whose coefficients are rational functions of one letter, from their values at whole numbers.

The denominators are known beforehand, so a numerator is interpolated; its degree is not known, so nodes are added until
the last divided differences vanish, and every coefficient must agree with two nodes more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from singimpact.algebra.polynomials import Exponents

Value = dict[Exponents, Any]

BATCH = 6  # nodes added at a time
CHECKS = 2  # nodes that are not used for the interpolation and must agree
WEIGHTS = (1 << 61) - 1  # a prime: powers modulo it have no pattern
MOST_NODES = 600  # more than order 12 takes; a wrong denominator would go on for ever


@dataclass(frozen=True)
class RationalCoefficients:
    """Monomial -> (numerator, denominator), fmpq_poly in the letter, without common factors."""

    terms: dict[Exponents, tuple[Any, Any]]

    def at(self, value: Any) -> Value:
        """The polynomial at a value of the letter."""
        return {key: above(value) / below(value) for key, (above, below) in self.terms.items()}


def interpolated(
    values_at: Callable[[int], Sequence[Value]], denominators: Sequence[Any]
) -> list[RationalCoefficients]:
    """Polynomials in the letter from their values at 2, 3, 4, ...

    Parameters
    ----------
    values_at : the values of all of them at a whole number, monomial -> fmpq.
    denominators : fmpq_poly, one each: a multiple of the true one.

    Raises
    ------
    ArithmeticError : a denominator is not a multiple of the true one.

    Examples
    --------
    >>> import flint
    >>> half = lambda node: [{(1,): flint.fmpq(node**2, node + 1)}]
    >>> found = interpolated(half, [flint.fmpq_poly([1, 1])])
    >>> found[0].terms[(1,)]
    (x^2, x + 1)
    """
    nodes: list[int] = []
    seen: list[Sequence[Value]] = []
    while len(nodes) < MOST_NODES:
        for _ in range(BATCH):
            nodes.append(2 + len(nodes))
            seen.append(values_at(nodes[-1]))
        columns = [[values[index] for values in seen] for index in range(len(denominators))]
        sizes = _sizes(nodes, columns, denominators)
        if sizes is not None:
            made = zip(sizes, columns, denominators, strict=True)
            found = [_one(nodes[:size], column[:size], below) for size, column, below in made]
            if all(_agrees(one, nodes, column) for one, column in zip(found, columns, strict=True)):
                return found
    raise ArithmeticError("the denominators given are not those of the values")


def _sizes(nodes: Sequence[int], columns: Sequence[Sequence[Value]], denominators: Sequence[Any]) -> list[int] | None:
    """How many nodes each polynomial takes, or None when there are too few for one; the last takes the most."""
    sizes: list[int] = []
    for column, below in zip(reversed(columns), reversed(denominators), strict=True):
        row = [sum(value * _weight(key) for key, value in values.items()) for values in column]
        differences = _differences(nodes, _scaled(nodes, row, below))
        if any(value != 0 for value in differences[-CHECKS:]):
            return None
        sizes.append(max((n for n, value in enumerate(differences) if value != 0), default=0) + 1)
    return sizes[::-1]


def _agrees(found: RationalCoefficients, nodes: Sequence[int], values: Sequence[Value]) -> bool:
    """Whether every monomial has its value at the last nodes, which the interpolation did not use."""
    import flint

    for node, value in zip(nodes[-CHECKS:], values[-CHECKS:], strict=True):
        shown = found.at(flint.fmpq(node))
        if any(shown.get(key, 0) != value.get(key, 0) for key in shown.keys() | value.keys()):
            return False
    return True


@lru_cache(maxsize=4096)
def _weight(key: Exponents) -> int:
    """One combination of all monomials shows the highest degree, unless it cancels: weights without a pattern."""
    powers = (pow(2 * place + 3, 40 * int(exponent) + 17, WEIGHTS) for place, exponent in enumerate(key) if exponent)
    return 1 + sum(powers)


def _scaled(nodes: Sequence[int], row: Sequence[Any], below: Any) -> list[Any]:
    import flint

    return [value * below(flint.fmpq(node)) for node, value in zip(nodes, row, strict=True)]


def _one(nodes: Sequence[int], values: Sequence[Value], below: Any) -> RationalCoefficients:
    """One polynomial from the nodes that it takes."""
    import flint

    zero, found = flint.fmpq(0), {}
    for key in sorted({key for value in values for key in value}):
        row = _scaled(nodes, [value.get(key, zero) for value in values], below)
        above = _newton(nodes, _differences(nodes, row))
        common = above.gcd(below)
        found[key] = _whole(above // common, below // common)
    return RationalCoefficients(found)


def _whole(above: Any, below: Any) -> tuple[Any, Any]:
    """The same quotient with a denominator whose coefficients are whole numbers without common factor."""
    factor = (below / below.leading_coefficient()).denom() / below.leading_coefficient()
    return above * factor, below * factor


def _differences(nodes: Sequence[int], row: Sequence[Any]) -> list[Any]:
    used = list(row)
    for step in range(1, len(nodes)):
        for place in range(len(nodes) - 1, step - 1, -1):
            used[place] = (used[place] - used[place - 1]) / (nodes[place] - nodes[place - step])
    return used


def _newton(nodes: Sequence[int], differences: Sequence[Any]) -> Any:
    """The polynomial of these divided differences."""
    import flint

    total = flint.fmpq_poly([differences[-1]])
    for place in range(len(nodes) - 2, -1, -1):
        total = total * flint.fmpq_poly([-nodes[place], 1]) + differences[place]
    return total
