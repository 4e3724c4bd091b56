"""The foot X of the universal negative swan in balls, for all r of an interval, and the elastic ball that it tends to.

A flight of length t that lands at sigma is followed by one of length t', t' (q + 4 sigma t' + t'^2) = r t
(q - 4 sigma t + t^2), q = 6 (sigma^2 - 1).  (sigma + t', t') rises with sigma, t and r (claim b:foot-monotone), so X
does with r: two values of r enclose X between them.
"""

import itertools
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

from flint import arb, arb_series, fmpq

from singimpact.algebra import as_rational, balls_at

START = 3, 4  # landing and length of the flight from rest at A, for every r


@dataclass(frozen=True)
class Effort:
    """Precision, and how far orbits are followed.

    Parameters
    ----------
    bits : of the balls; errors grow tenfold in 30 flights as r -> 1. near : the rest of the way to X as a part of X at
        which the bounds for it are taken. growth : of 1/(1 - r) from one value of r to the next. grain : denominator
        of the values of r. impacts, elastic_bits : of the elastic orbit.
    """

    bits: int = 192
    near: float = 1 / 256
    growth: Fraction = Fraction(201, 200)
    grain: int = 10**5
    impacts: int = 1000
    elastic_bits: int = 384


EFFORT = Effort()


@dataclass(frozen=True)
class Box:
    """All r of an interval, and bounds of X for them."""

    r: tuple[Fraction, Fraction]
    low: Fraction
    high: Fraction


def _next_length(sigma: arb, t: arb, rate: arb) -> arb:
    """The length of the flight after one of length t that lands at sigma: Newton's method, then one step in balls."""
    q = 6 * (sigma * sigma - 1)
    goal = rate * t * (q - 4 * sigma * t + t * t)
    length = (goal / q).mid()
    for _ in range(60):
        value = length * (q + length * (4 * sigma + length)) - goal
        moved = (length - value / (q + length * (8 * sigma + 3 * length))).mid()
        if abs(moved - length) <= abs(length) * _TINY:
            break
        length = moved
    # the left side rises with t at a rate of q and more: so far lies the root
    value = length * (q + length * (4 * sigma + length)) - goal
    hull = length + (abs(value) / q) * arb(0, 1)
    return length - value / (q + hull * (8 * sigma + 3 * hull))


_TINY = 1e-25  # relative step of Newton's method after which the next one is exact to all bits


@cache
def foot(rate: Fraction, near: float = EFFORT.near) -> tuple[Fraction, Fraction]:
    """Bounds of X for one r.

    Raises
    ------
    ArithmeticError : the balls grow too wide.

    Examples
    --------
    >>> low, high = foot(Fraction(1, 2), 1e-5)
    >>> float(low) < 4.0476562833 < float(high), float(high - low) < 1e-8
    (True, True)
    """
    with balls_at(EFFORT.bits):
        r = arb(fmpq(rate.numerator, rate.denominator))
        sigma, t = (arb(start) for start in START)
        while True:
            rest = r * t / (1 - r)  # each flight is shorter than r times the last (claim s6n-X)
            if rest < near * sigma:
                break
            if not (t > 0 and sigma.rad() < 1e-6):
                raise ArithmeticError(f"the balls at r = {rate} grow too wide")
            t = _next_length(sigma, t, r)
            sigma = sigma + t
        # t' >= r t (1 - slack t), and slack falls with sigma
        slack = (4 * sigma * (1 + r) + r * r * t) / (6 * (sigma * sigma - 1))
        low, high = sigma + rest * (1 - slack * t / (1 - r)), sigma + rest
        return as_rational(low.lower()), as_rational(high.upper())


def covering(low: Fraction, high: Fraction) -> list[Box]:
    """X over an interval of r, 0 < low < high < 1, by boxes between neighbouring values of r.

    Examples
    --------
    >>> boxes = covering(Fraction(1, 10), Fraction(1, 8))
    >>> boxes[0].r[0], boxes[-1].r[1], all(one.r[1] == two.r[0] for one, two in zip(boxes, boxes[1:]))
    (Fraction(1, 10), Fraction(1, 8), True)
    """
    rates = [low]
    while rates[-1] < high:
        gap = (1 - rates[-1]) / EFFORT.growth
        rates.append(min(1 - Fraction(int(gap * EFFORT.grain), EFFORT.grain), high))
    return [Box((one, two), foot(one)[0], foot(two)[1]) for one, two in itertools.pairwise(rates)]


def scaled(bound: Fraction, rate: Fraction, power: Fraction) -> arb:
    """The ball of bound (1 - r)^power."""
    with balls_at(EFFORT.bits):
        rest, exponent = 1 - rate, fmpq(power.numerator, power.denominator)
        return arb(fmpq(bound.numerator, bound.denominator)) * arb(fmpq(rest.numerator, rest.denominator)) ** arb(
            exponent
        )


@dataclass(frozen=True)
class Elastic:
    """The elastic orbit from rest at A.

    Attributes
    ----------
    invariant : bounds of the limit of u = v/|a|^(1/3) at its impacts. impacts : flown. ratio : t/sigma of the last.
    third : a bound of |ln(u'/u)|/(t/sigma)^3 for this and all later flights.
    """

    invariant: tuple[Fraction, Fraction]
    impacts: int
    ratio: float
    third: float


def _growth(ratio: Any, small: Any) -> Any:
    """ln of u after a flight over u before it, as a function of t/sigma = ratio and of small = 1/sigma^2."""
    rest = 1 - small
    before, after = 6 * rest + 4 * ratio + ratio * ratio, 6 * rest + 8 * ratio + 3 * ratio * ratio
    return after.log() - before.log() - (((1 + ratio) * (1 + ratio) - small) / rest).log() / 3


@cache
def elastic() -> Elastic:
    """u tends to a limit: it changes by the third order of t/sigma in a flight, and the sum of these is bounded.

    With sigma_(m+1) = sigma_m + t_m and t_m falling, the sum of (t_m/sigma_m)^3 from m = n on is at most t_n^2 times
    the sum of t_m/sigma_m^3, and that is at most (1 + t_n/sigma_n)^3/(2 sigma_n^2).
    """
    with balls_at(EFFORT.elastic_bits):
        one = arb(1)
        sigma, t = (arb(start) for start in START)
        for _ in range(EFFORT.impacts):
            last = sigma
            t = _next_length(sigma, t, one)
            sigma = sigma + t
        # the flight from `last` to sigma: u at its launch
        ratio, small = t / last, 1 / (last * last)
        u = t * (6 * (last * last - 1) + 4 * last * t + t * t) / (12 * (last * last - 1)).root(3)
        reach, below = arb(0).union(ratio), arb(0).union(small)
        third = abs(_growth(arb_series([reach, arb(1)], 4), arb_series([below], 4))[3])
        spread = third * (1 + ratio) ** 3 * ratio * ratio / 2
        ball = u * (spread * arb(0, 1)).exp()
        return Elastic(
            (as_rational(ball.lower()), as_rational(ball.upper())), EFFORT.impacts, float(ratio), float(third.upper())
        )
