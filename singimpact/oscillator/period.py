"""The common period of f and g in t: found from their frequencies, or checked when it is given; phases within it.

The phase of a launch is reduced without loss: tau is an exact number, however large.
"""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from math import ceil, gcd, inf, lcm
from typing import Any

import numpy as np

from singimpact.algebra.expressions import (
    Call,
    Expression,
    Name,
    Number,
    Pi,
    Product,
    Sum,
    add,
    children,
    multiply,
    names_in,
    number,
    power,
    substitute,
    subtract,
)
from singimpact.algebra.numbers import Array, compare, constant, rational_near
from singimpact.inputs import InputError, require, shown


def affine(tree: Expression, names: Sequence[str]) -> tuple[Expression, ...] | None:
    """The coefficients of names, and what is left, of a sum of multiples of them; None where it is none.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> [str(part) for part in affine(parse("2*(x + 3) - k*xdot", ("x", "xdot", "k")), ("x", "xdot"))]
    ['2', '-k', '6']
    """
    if not names_in(tree).intersection(names):
        return *(number(0) for _ in names), tree
    if isinstance(tree, Name):
        return *(number(int(tree.name == name)) for name in names), number(0)
    if isinstance(tree, Sum):
        parts = [affine(term, names) for term in tree.terms]
        forms = [form for form in parts if form is not None]
        return tuple(add(*column) for column in zip(*forms, strict=True)) if len(forms) == len(parts) else None
    if isinstance(tree, Product):
        moving = [factor for factor in tree.factors if names_in(factor).intersection(names)]
        inner = affine(moving[0], names) if len(moving) == 1 else None
        if inner is not None:
            rest = [factor for factor in tree.factors if factor is not moving[0]]
            return tuple(multiply(*rest, coefficient) for coefficient in inner)
    return None


def _frequencies(tree: Expression) -> list[Expression] | None:
    """Rates of the circular functions through which t enters; None when t enters in another way."""
    if "t" not in names_in(tree):
        return []
    if isinstance(tree, Call) and tree.function in ("sin", "cos", "tan"):
        inner = affine(tree.argument, ("t",))
        if inner is not None:
            return [multiply(number(2), inner[0]) if tree.function == "tan" else inner[0]]
    if isinstance(tree, Name):
        return None
    frequencies: list[Expression] = []
    for child in children(tree):
        rates = _frequencies(child)
        if rates is None:
            return None
        frequencies.extend(rates)
    return frequencies


def _split(rate: Expression) -> tuple[Fraction, Expression]:
    """rate = rational * rest, the rest free of rational factors."""
    if isinstance(rate, Number):
        return rate.value, number(1)
    if isinstance(rate, Product) and isinstance(rate.factors[0], Number):
        return rate.factors[0].value, multiply(*rate.factors[1:])
    return Fraction(1), rate


def moving_in_time(force: Expression, forcing: Expression) -> dict[str, Expression]:
    """f and g by name; f is left out where t does not occur in it."""
    return {"g": forcing, **({"f": force} if "t" in names_in(force) else {})}


def period_of(*trees: Expression) -> Expression | None:
    """The period 2 pi/(greatest common frequency), or None when t occurs in no tree, or one is not seen to be periodic.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> print(period_of(parse("cos(3*t) + sin(4.5*t)", ["t"])))
    (4/3)*pi
    >>> print(period_of(parse("t*cos(t)", ["t"])))
    None
    """
    period = common_period(*trees)
    if period is None:
        return None
    return period if compare(period, 0) > 0 else multiply(number(-1), period)


def common_period(*trees: Expression) -> Expression | None:
    """A common period of trees in t, up to its sign; their rates may hold letters.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> print(common_period(parse("cos(w*t) + sin(2*w*t)", ["w", "t"])))
    2*pi/w
    """
    rates = [_frequencies(tree) for tree in trees]
    if None in rates:
        return None
    moving = [_split(rate) for some in rates for rate in some or [] if rate != number(0)]
    if not moving or any(rest != moving[0][1] for _, rest in moving):
        return None
    sizes = [abs(size) for size, _ in moving]
    common = Fraction(gcd(*(size.numerator for size in sizes)), lcm(*(size.denominator for size in sizes)))
    return multiply(number(2 / common), Pi(), power(moving[0][1], number(-1)))


def oscillates(*trees: Expression) -> bool:
    """Whether t enters through circular functions of multiples of t alone, with a common period or without.

    Examples
    --------
    >>> from singimpact.algebra.parsing import parse
    >>> [oscillates(parse(text, ["t"])) for text in ("cos(t) + cos(sqrt(2)*t)", "t**2")]
    [True, False]
    """
    return all(_frequencies(tree) is not None for tree in trees)


def checked_period(trees: Mapping[str, Expression], value: Any, computed: Expression | None) -> Expression:
    """A period the caller gives, refused when f or g does not repeat with it at some sample times."""
    period = constant("period", value)
    require(compare(period, 0) > 0, "period", value, "a positive number")
    for name, tree in trees.items():
        if "t" in names_in(tree) and period != computed and not _repeats(tree, period):
            later = "g(t + period) = g(t)" if name == "g" else "f(x, xdot, t + period) = f(x, xdot, t)"
            raise InputError(
                f"period = {shown(value)} is not a period of {name} = {shown(str(tree))}: give one with {later}"
            )
    return period


def _repeats(tree: Expression, period: Expression) -> bool:
    from singimpact.algebra.balls import Balls

    balls = Balls(256)
    for numerator in (1, 17, 35, 52, 71, 97):
        start = number(Fraction(numerator, 53))
        state = {"x": number(Fraction(numerator, 101)), "xdot": number(Fraction(numerator, 103))}
        later = substitute(tree, {"t": add(start, period), **state})
        difference = balls.evaluate(subtract(later, substitute(tree, {"t": start, **state})), {})
        if not difference.is_finite() or not abs(difference) < balls.rational(Fraction(1, 10**30)):
            return False
    return True


# Periods within which a period in two doubles is enough: phases above its part 1/TURNS keep to 2^-10 of a unit
TURNS = 2.0**20


def reduced(tau: Array, period: Expression) -> Array:
    """tau minus the nearest multiple of the period, each to half a unit in the last place.

    Parameters
    ----------
    tau : doubles, taken exactly; within one period of zero they are left alone, since -1e-20 plus a period is lost.
    period : constant tree, > 0.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> reduced(np.array([1e22, -1e-20]), constant("period", "2*pi")).tolist()
    [-1.020177392559087, -1e-20]
    """
    size, rest = _in_doubles(period)
    result = np.array(tau, dtype=float)
    far = np.flatnonzero(np.abs(result) > size)
    if far.size:
        left = np.fmod(result[far], size)  # exact, and so is the difference below
        left -= np.where(np.abs(left) > size / 2, np.copysign(size, left), 0.0)
        turns = np.rint((result[far] - left) / size)
        phases = left - turns * rest
        near = np.minimum(np.abs(phases), np.abs(np.abs(phases) - size / 2))  # to a multiple, or half-way between two
        for index in np.flatnonzero((np.abs(turns) > TURNS) | (near < size / TURNS)).tolist():
            phases[index] = phase_of(Fraction(float(result[far[index]])), period)
        result[far] = phases
    return result


@lru_cache(maxsize=256)
def _in_doubles(period: Expression) -> tuple[float, float]:
    """The period as a double, inf where none is as large, and the part that it leaves out."""
    exact = rational_near(period, 256)
    try:
        size = float(exact)
    except OverflowError:
        return inf, 0.0
    return size, float(exact - Fraction(size))


def phase_of(tau: Fraction, period: Expression) -> float:
    """An exact time minus the nearest multiple of the period, to half a unit in the last place.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> phase_of(Fraction(10**20 + 1, 10), constant("period", "3/10"))
    -0.1
    """
    # digits before the binary point, and for a result as small as the least distance of doubles from a multiple
    bits = 64 * (3 + max(ceil(tau).bit_length(), 0) // 64) + 64
    while abs(_scaled(period, bits)) < 2**192:  # a short period needs more digits behind the binary point
        bits *= 2
    scaled, exact = _scaled(period, bits), tau * 2**bits
    turns = round(exact / scaled)
    return float((exact - turns * scaled) / 2**bits)


@lru_cache(maxsize=1024)
def _scaled(period: Expression, bits: int) -> int:
    """The integer nearest to period * 2^bits."""
    scaled: int = round(rational_near(period, bits + 80) * 2**bits)
    return scaled
