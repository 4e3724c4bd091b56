"""Maps made of jets: inverse of a map, a variable made implicit, derivations, and the blow-up (s, s m)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from singimpact.algebra.jets import Jet, JetSpace


def inverse_map(images: Sequence[Jet]) -> tuple[Jet, ...]:
    """The inverse of x -> (images), a map of as many variables as images that fixes 0.

    Raises
    ------
    ValueError : its linear part has no inverse over the ring.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> x, y = JetSpace(("x", "y"), 3, EXACT).generators()
    >>> print(*inverse_map([x, y - x * x]), sep=", ")
    x, y + x**2
    """
    space = images[0].space
    linear = _inverse([[image.coefficient(key) for key in _units(space)] for image in images], space.ring)
    target = space.generators()
    inverse = _applied(linear, target)
    for degree in range(2, space.order + 1):
        missed = [image.compose(inverse).part(degree) for image in images]
        inverse = [jet - step for jet, step in zip(inverse, _applied(linear, missed), strict=True)]
    return tuple(inverse)


def _units(space: JetSpace) -> list[tuple[int, ...]]:
    size = len(space.variables)
    return [tuple(int(i == k) for k in range(size)) for i in range(size)]


def _applied(matrix: Sequence[Sequence[Any]], jets: Sequence[Jet]) -> list[Jet]:
    empty = jets[0].space.jet({})
    return [sum((jet.scaled(entry) for entry, jet in zip(row, jets, strict=True)), empty) for row in matrix]


def _inverse(matrix: list[list[Any]], ring: Any) -> list[list[Any]]:
    """By elimination; a pivot that is zero, or not seen to be different from it, is passed over."""
    size = len(matrix)
    unit = [[ring.rational(Fraction(int(i == k))) for k in range(size)] for i in range(size)]
    rows = [row + beside for row, beside in zip(matrix, unit, strict=True)]
    for column in range(size):
        pivot = next((i for i in range(column, size) if rows[i][column] != 0), None)
        if pivot is None:
            raise ValueError("the linear part of the map has no inverse")
        rows[column], rows[pivot] = rows[pivot], rows[column]
        factor = ring.power(rows[column][column], Fraction(-1))
        rows[column] = [value * factor for value in rows[column]]
        for i in range(size):
            if i != column:
                rows[i] = [a - rows[i][column] * b for a, b in zip(rows[i], rows[column], strict=True)]
    return [row[size:] for row in rows]


def implicit(equation: Jet, variable: str) -> Jet:
    """The jet y(x) with equation(x, y(x)) = 0, in the same space, where `variable` does not occur in it.

    The coefficient of `variable` alone must have an inverse, and the equation no constant term.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> x, y = JetSpace(("x", "y"), 4, EXACT).generators()
    >>> print(implicit(y - x - y * y, "y"))
    x + x**2 + (2)*x**3 + (5)*x**4
    """
    space = equation.space
    index = space.variables.index(variable)
    slope = equation.coefficient(_units(space)[index])
    factor = space.ring.power(slope, Fraction(-1))
    inner = list(space.generators())
    inner[index] = space.jet({})
    for degree in range(1, space.order + 1):
        inner[index] = inner[index] - equation.compose(inner).part(degree).scaled(factor)
    return inner[index]


def derivation(jet: Jet, images: Mapping[str, Jet]) -> Jet:
    """Sum of the derivatives by each variable times its image, to the order that is known then.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> x, y = JetSpace(("x", "y"), 3, EXACT).generators()
    >>> print(derivation(x * x * y, {"x": y, "y": x}))
    x**3 + (2)*x*y**2
    """
    weights = dict(zip(jet.space.variables, jet.space.weights, strict=True))
    order = min(jet.space.order - weights[name] + min(image.parts, default=0) for name, image in images.items())
    space = jet.space.to_order(min(order, *(image.space.order for image in images.values())))
    total = space.jet({})
    for name, image in images.items():
        total = total + Jet(space, jet.derivative(name).parts) * Jet(space, image.parts)
    return total


def blow_up(jet: Jet, s: str = "s", m: str = "m") -> Jet:
    """A jet in two variables of weight 1 in the chart (s, s m): graded by s alone.

    Examples
    --------
    >>> from singimpact.algebra.rings import EXACT
    >>> x, y = JetSpace(("x", "y"), 3, EXACT).generators()
    >>> print(blow_up(x * y + y * y * y))
    s**2*m + s**3*m**3
    """
    space = JetSpace((s, m), jet.space.order, jet.space.ring, (1, 0))
    first, slope = space.generators()
    return jet.compose((first, first * slope))


def divided(jet: Jet, variable: str, power: int) -> Jet:
    """The jet divided by a power of a variable that divides it; the order falls by its weight.

    Raises
    ------
    ValueError : a term is not divisible.
    """
    index = jet.space.variables.index(variable)
    fallen = jet.space.to_order(jet.space.order - power * jet.space.weights[index])
    terms = {tuple(e - power * (i == index) for i, e in enumerate(key)): value for key, value in jet.terms.items()}
    if any(key[index] < 0 for key in terms):
        raise ValueError(f"a term is not divisible by {variable}**{power}")
    return fallen.jet(terms)
