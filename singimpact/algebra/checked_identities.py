"""The checks of identities: two different quotients are equal, or two compositions are, exactly or to an order.

Where a relation is given, of degree 2 in the last variable, the identity holds at both its roots.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from singimpact.algebra.plain import Terms, cut, plus, substituted, terms, times, weight

ONE = Fraction(1)


class Cut(NamedTuple):
    """The truncation: terms of weighted degree <= order; all terms for None."""

    weights: Sequence[int]
    order: int | None

    def of(self, poly: Terms) -> Terms:
        return cut(poly, *self)

    def lowest(self, poly: Terms) -> Terms:
        """The part without small variables: where it is not 0, a denominator is invertible as a series."""
        return poly if self.order is None else cut(poly, self.weights, 0)

    def spared(self, *polys: Terms) -> bool:
        """Whether no small variable occurs."""
        return self.order is None or not any(weight(key, self.weights) for poly in polys for key in poly)


def identity(data: Mapping[str, Any]) -> bool:
    """Two different quotients are equal; one that is equal to itself says nothing."""
    size = len(data["variables"])
    left, right = ((terms(data[side][0]), terms(data[side][1])) for side in ("left", "right"))
    return left != right and _equal(left, right, data["relation"], Cut((0,) * size, None))


def composed(data: Mapping[str, Any]) -> bool:
    """outer(images) of the left side is that of the right side, which has another outer function or other images."""
    truncation = Cut(tuple(data["weights"]), data["order"])
    if len(truncation.weights) != len(data["variables"]) or not all(
        type(weight_) is int and weight_ >= 0 for weight_ in truncation.weights
    ):
        raise ValueError("weights are whole numbers >= 0, one a variable")
    if truncation.order is not None and (type(truncation.order) is not int or truncation.order < 0):
        raise ValueError("an order is a whole number >= 0, or null")
    if truncation.order is None and any(truncation.weights):
        raise ValueError("weights without an order")
    sides = []
    for side in ("left", "right"):
        images = {index: (terms(pair[0]), terms(pair[1])) for index, pair in data[side]["images"]}
        if len(images) != len(data[side]["images"]) or not all(
            0 <= index < len(truncation.weights) for index in images
        ):
            raise ValueError("a variable with two images, or none of the variables")
        if not all(_invertible(below, data["relation"], truncation) for _, below in images.values()):
            return False
        above, below = (substituted(terms(coefficient), images, *truncation) for coefficient in data[side]["outer"])
        sides.append((times(above[0], below[1]), times(below[0], above[1])))
    return data["left"] != data["right"] and _equal(sides[0], sides[1], data["relation"], truncation)


def _equal(left: tuple[Terms, Terms], right: tuple[Terms, Terms], relation: Any, truncation: Cut) -> bool:
    """multiplier times the difference over the common denominator is cofactor times relation, to the order."""
    difference = truncation.of(plus(times(left[0], right[1]), times(right[0], left[1]), -ONE))
    if not (_invertible(left[1], relation, truncation) and _invertible(right[1], relation, truncation)):
        return False
    if relation is None:
        return not difference
    multiplier, cofactor, zero = (terms(factor) for factor in relation)
    of_a_root = max(key[-1] for key in zero) == 2 and not any(key[-1] for key in multiplier)
    sound = bool(multiplier) and of_a_root and truncation.spared(multiplier, zero)
    return sound and truncation.of(times(multiplier, difference)) == truncation.of(times(cofactor, zero))


def _invertible(below: Terms, relation: Any, kept: Cut) -> bool:
    """Whether a denominator is not 0, to lowest order and at both roots of the relation."""
    lowest = kept.lowest(below)
    return bool(_norm(lowest, terms(relation[2])) if relation is not None else lowest)


def _norm(poly: Terms, relation: Terms) -> Terms:
    """A multiple of the product of the values at both roots of a quadratic in the last variable; {} when one is 0."""
    if not poly:
        return {}
    c0, c1, c2 = (_coefficient(relation, n) for n in range(3))
    parts = [_coefficient(poly, n) for n in range(max([key[-1] for key in poly] + [1]) + 1)]
    while len(parts) > 2:  # c2 poly = (c2 w^2 + c1 w + c0)(top w^n) + a poly of a lower degree
        top = parts.pop()
        parts = [times(c2, conjugate) for conjugate in parts]
        parts[-1], parts[-2] = plus(parts[-1], times(top, c1), -ONE), plus(parts[-2], times(top, c0), -ONE)
    b0, b1 = parts
    return plus(plus(times(c2, times(b0, b0)), times(c1, times(b0, b1)), -ONE), times(c0, times(b1, b1)))


def _coefficient(poly: Terms, power: int) -> Terms:
    return {(*key[:-1], 0): value for key, value in poly.items() if key[-1] == power}
