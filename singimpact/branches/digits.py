"""A periodic orbit and its multipliers in many digits, by Newton's method in balls: nothing is proved."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from math import ceil

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
    small, miss, status = Fraction(1, 10 ** (digits + SPARE)), Fraction(float(rough.miss)), Status.unresolved
    half: Fraction | None = None
    product = Fraction(0)
    bits = ceil((digits + SPARE) * BITS_A_DIGIT) + 64
    with balls_at(bits):
        closing = BallClosing(osc, rough.k, digits + SPARE, bits)
        # refused where the orbit is virtual, or a flight is not shown to be its own: the status says so
        with suppress(Refused, ZeroDivisionError, ValueError):
            states = Krawczyk(closing, states, small).solved(states)
            miss = max(abs(as_rational(residual)) for residual in closing.miss(states).entries())
            total = return_slope(closing.slopes(states, small))
            half, product = as_rational((total[0, 0] + total[1, 1]) / 2), as_rational(total.det())
            closing.first_hits(states, small)
            status = Status.hit
    with digits_at(digits + 15) as mp:
        if half is None:
            multipliers = [mp.convert(complex(multiplier)) for multiplier in rough.multipliers]
        else:
            root = mp.sqrt(mp.mpc(mp.convert(half * half - product)))
            multipliers = [half + root, half - root]
        numbers = [mp.convert(state) for state in states]
        missed = mp.convert(miss)
    with digits_at(digits):
        tau, v, sizes = (
            np.array([for_user(+number) for number in row], dtype=object)
            for row in (numbers[::2], numbers[1::2], multipliers)
        )
        return replace(rough, tau=tau, v=v, multipliers=sizes, miss=for_user(+missed), status=np.int8(status))
