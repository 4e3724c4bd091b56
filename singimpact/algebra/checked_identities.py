"""The checks of identities: two different quotients are equal, or two compositions are, exactly or to an order.

Where a relation is given, of degree 2 in the last variable, the identity holds at both its roots.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from singimpact.algebra.plain import (
    Terms,
    at,
    cut,
    line,
    plus,
    powers,
    short_times,
    slope,
    substituted,
    terms,
    times,
    weight,
)

ONE, ZERO = Fraction(1), Fraction(0)


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


# The checks of motions: a polynomial solves x'' + f(x, x') = a at the wall, as an initial or a boundary value problem.
#
# The equation is data: `acceleration` has the polynomials a_n of a = sum a_n (tau - tau_*)^n, and `force` the f_ik of
# f(c + x, x') - f(c, 0) = sum f_ik x^i x'^k.  The residual is formed here, from these and the motion alone.


def motion(data: Mapping[str, Any]) -> bool:
    """x = height(sigma, v, t) leaves 0 with velocity v and solves the equation at the time sigma + t, to the order.

    With launch = v_c(sigma, t) the motion is back after t: height/t = 0 at v = launch; landing is x' there.
    """
    size, weights, order = _layout(data, (1, None, 1))
    height = terms(data["height"])
    speed = slope(height, 2)
    clock = plus(line(ZERO, 1, 0, size), line(ZERO, 1, 2, size))
    pushed = _pushed(data, height, speed, clock, weights, order)
    residual = cut(plus(slope(speed, 2), pushed, -ONE), weights, None if order is None else order - 1)
    starts = not at(height, 2, ZERO) and at(speed, 2, ZERO) == line(ZERO, 1, 1, size)
    if residual or not starts or data["launch"] is None:
        return not residual and starts and data["landing"] is None
    launch = terms(data["launch"])
    if any(key[1] for key in launch) or any(weight(key, weights) < weights[1] for key in launch):
        return False  # then terms that were cut away could come back to a lower degree
    quotient = {(*key[:2], key[2] - 1, *key[3:]): value for key, value in height.items()}
    images = {1: (launch, {(0,) * size: ONE})}
    back, _ = substituted(quotient, images, weights, order)
    if data["landing"] is None:
        return not back
    landed, _ = substituted(speed, images, weights, order)
    return not back and cut(landed, weights, order) == cut(terms(data["landing"]), weights, order)


def flight(data: Mapping[str, Any]) -> bool:
    """x = t rise(z; sigma, t), z = time/t, is at the wall at z = 0 and z = 1 and solves the equation at sigma + z t.

    launch and landing are its velocities there.
    """
    size, weights, order = _layout(data, (0, 1, 1))
    rise = terms(data["rise"])
    speed, t = slope(rise, 0), line(ZERO, 1, 2, size)
    clock = plus(line(ZERO, 1, 1, size), times(line(ZERO, 1, 0, size), t))
    pushed = times(t, _pushed(data, times(t, rise), speed, clock, weights, order))
    if cut(plus(slope(speed, 0), pushed, -ONE), weights, order):
        return False
    ends = [cut(at(series, 0, end), weights, order) for series in (rise, speed) for end in (ZERO, ONE)]
    stated = [{}, {}, *(cut(terms(data[name]), weights, order) for name in ("launch", "landing"))]
    return ends == stated


def _layout(data: Mapping[str, Any], first: Sequence[int | None]) -> tuple[int, tuple[int, ...], int | None]:
    """(variables, weights, order); the first three variables have weights, the letters of the equation have none."""
    size, weights, order = len(data["variables"]), tuple(data["weights"]), data["order"]
    right = all(
        weight >= 1 if wanted is None else weight == wanted for weight, wanted in zip(weights, first, strict=False)
    )
    if order is None and weights[:3] != (1, 1, 1):
        raise ValueError("weights without an order")
    if len(weights) != size or any(type(weight) is not int for weight in weights) or any(weights[3:]) or not right:
        raise ValueError(f"weights {weights} are not those of a motion")
    if order is not None and (type(order) is not int or order < 1):
        raise ValueError("an order is a whole number >= 1, or null")
    return size, weights, order


def _pushed(
    data: Mapping[str, Any], x: Terms, speed: Terms, clock: Terms, weights: Sequence[int], order: int | None
) -> Terms:
    """a - (f - f(c, 0)) on a motion, at the time `clock` after tau_*, cut; the state may not occur in the jets."""
    acceleration, force = [terms(jet) for jet in data["acceleration"]], data["force"]
    pairs, jets = [tuple(pair) for pair, _ in force], [terms(jet) for _, jet in force]
    if any(any(key[:3]) for jet in (*acceleration, *jets) for key in jet):
        raise ValueError("a jet that depends on the state")
    if len(set(pairs)) < len(pairs) or not all(type(n) is int and n >= 0 for pair in pairs for n in pair):
        raise ValueError("powers of x and x' that are not whole, negative, or occur twice")
    if (0, 0) in pairs:
        raise ValueError("f(c, 0) belongs to the acceleration")
    tops = [max((pair[n] for pair in pairs), default=0) for n in (0, 1)]
    xs, speeds = (powers(base, top, weights, order) for base, top in zip((x, speed), tops, strict=True))
    total: Terms = {}
    for jet, power in zip(acceleration, powers(clock, len(acceleration), weights, order), strict=False):
        total = plus(total, times(jet, power))
    for (i, k), jet in zip(pairs, jets, strict=True):
        total = plus(total, times(jet, short_times(xs[i], speeds[k], weights, order)), -ONE)
    return total
