"""Flights of undamped linear models that come back to their launch at rest after the common period of all motions.

There the flight touches the obstacle as it left it: a graze of any order.  No number of digits tells it from a near
miss; the common period does.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from math import factorial, isqrt, lcm, sqrt

import numpy as np

from singimpact.algebra.expressions import Expression, Number, Pi, multiply, number, power
from singimpact.algebra.numbers import as_float, as_fraction, sign_of
from singimpact.oscillator.linear import LinearForm, linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import Zero, acceleration


def touches_again(osc: Oscillator, rest: Zero, time: float) -> Expression | None:
    """The time at which a flight launched at rest touches the obstacle again as it left it.

    Parameters
    ----------
    osc : the model. rest : the launch. time : the flight was seen above the obstacle until then, and not decided there.

    Returns
    -------
    Expression or None : the common period, where x - c is proved positive from `time` up to it.

    Examples
    --------
    >>> osc = Oscillator("x", "cos(2*t)", -1, "1/2")
    >>> print(touches_again(osc, Zero(multiply(number(Fraction(1, 2)), Pi()), 2, 1), 6.2831))
    2*pi
    """
    form, period = linear_form(osc), common_period(osc)
    if form is None or period is None or rest.sign <= 0 or rest.order % 2:
        return None
    gap = abs(as_float(period) - time)
    order = rest.order + 2
    leading = float(acceleration(osc, np.array([as_float(rest.tau)]), rest.order)[0])
    # backwards from the touch: x - c >= leading s^order/order! - bound s^(order + 1)/(order + 1)!
    bound = _largest_derivative(form, as_float(osc.clearance), order + 1)
    return period if 2 * bound * gap < leading * factorial(order + 1) / factorial(order) else None


@lru_cache(maxsize=256)
def common_period(osc: Oscillator) -> Expression | None:
    """The least common period of free motion and forcing of an undamped linear model; None when there is none.

    Examples
    --------
    >>> print(common_period(Oscillator("x", "cos(2.8*t)", 0, 1)))
    10*pi
    >>> print(common_period(Oscillator("x + 0.1*xdot", "cos(2.8*t)", 0, 1)))
    None
    """
    form = linear_form(osc)
    if form is None or sign_of(form.damping) or sign_of(form.stiffness) <= 0:
        return None
    turns, stiffness = 1, as_fraction(form.stiffness)
    for wave in form.harmonics:
        rate = as_fraction(wave.rate)
        ratio = None if rate is None or not stiffness else _rational_root(rate * rate / stiffness)
        if ratio is None or ratio == 1:
            return None  # no common period, or resonance
        turns = lcm(turns, ratio.denominator)
    root = None if not stiffness else _rational_root(stiffness)
    slowness = power(form.stiffness, Number(Fraction(-1, 2))) if root is None else number(1 / root)
    return multiply(number(2 * turns), Pi(), slowness)


def _rational_root(value: Fraction) -> Fraction | None:
    root = Fraction(isqrt(value.numerator), isqrt(value.denominator))
    return root if root * root == value else None


def _largest_derivative(form: LinearForm, clearance: float, order: int) -> float:
    """A bound, for all times, of a derivative of a flight launched at rest."""
    stiffness = as_float(form.stiffness)
    rate, offset = sqrt(stiffness), as_float(form.constant) / stiffness
    waves = [(as_float(wave.rate), np.hypot(as_float(wave.cosine), as_float(wave.sine))) for wave in form.harmonics]
    answers = [(abs(speed), size / abs(stiffness - speed * speed)) for speed, size in waves]
    free = abs(clearance - offset) + sum(size * (1 + speed / rate) for speed, size in answers)
    return float(free * rate**order + sum(size * speed**order for speed, size in answers))
