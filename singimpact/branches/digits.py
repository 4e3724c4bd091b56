"""A periodic orbit and its multipliers in many digits, by Newton's method in balls: nothing is proved."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import ceil
from typing import Any

import numpy as np

from singimpact.algebra.balls import BITS_A_DIGIT, as_rational
from singimpact.algebra.precision import balls_at, digits_at, for_user
from singimpact.branches.ball_closing import BallClosing, return_slope
from singimpact.branches.krawczyk import Krawczyk
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.flights.enclosures.equation import Refused
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

SPARE = 5
"""Digits of the states beside those asked for."""


def in_digits(osc: Oscillator, rough: PeriodicOrbit, digits: int) -> PeriodicOrbit:
    """The orbit and its multipliers in many digits; `unresolved` where the next impacts are not its own to these."""
    states = [Fraction(float(number)) for state in zip(rough.tau, rough.v, strict=True) for number in state]
    status, trace, determinant = Status.unresolved, Fraction(0), Fraction(0)
    small, miss = Fraction(1, 10 ** (digits + SPARE)), Fraction(float(rough.miss))
    multipliers: list[Any] | None = None
    bits = ceil((digits + SPARE) * BITS_A_DIGIT) + 64
    with balls_at(bits):
        closing = BallClosing(osc, rough.k, digits + SPARE, bits)
        try:
            states = Krawczyk(closing, states, small).solved(states)
            miss = max(abs(as_rational(part)) for part in closing.miss(states).entries())
            total = return_slope(closing.slopes(states, small))
            trace, determinant = as_rational(total[0, 0] + total[1, 1]), as_rational(total.det())
            closing.first_hits(states, small)
            status = Status.hit
        except (Refused, ZeroDivisionError, ValueError):
            multipliers = list(rough.multipliers)
    with digits_at(digits + 15) as mp:
        if multipliers is None:
            half, product = _mpf(trace / 2, mp), _mpf(determinant, mp)
            root = mp.sqrt(mp.mpc(half * half - product))
            multipliers = [half + root, half - root]
        numbers = [_mpf(state, mp) for state in states]
        missed = _mpf(miss, mp)
    with digits_at(digits):
        tau, v, sizes = (np.array([for_user(+number) for number in row], dtype=object)
                         for row in (numbers[::2], numbers[1::2], multipliers))  # fmt: skip
        return replace(rough, tau=tau, v=v, multipliers=sizes, miss=for_user(+missed), status=np.int8(status))


def _mpf(number: Fraction, mp: Any) -> Any:
    return mp.mpf(number.numerator) / number.denominator
