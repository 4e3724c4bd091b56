"""Flights of a linear model that are proved never to return, by bounds on what the free motion can still do.

x - c = steady + drift + free motion + waves, each part bounded from below for all later times; the flight has been
followed without impact to the time at which the bounds are taken.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float, sign_of
from singimpact.flights.model_numbers import turn
from singimpact.flights.phase import reduced
from singimpact.oscillator.linear import LinearForm, at_rest
from singimpact.oscillator.model import Oscillator

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class MarginSettings:
    """`part` of the size of all terms must be left over: 2^20 roundings, far above what the few operations here do."""

    part: float = 2.0**-32


MARGIN = MarginSettings()


def never_returns(osc: Oscillator, form: LinearForm, tau: Array, time: Array, z: Array, u: Array) -> Array:
    """Whether flights in the state x - c = z, x' = u, `time` after their launch at tau, are proved to stay above c.

    Returns
    -------
    array of bool; False means nothing but that this bound does not prove it.

    Examples
    --------
    >>> from singimpact.oscillator.linear import linear_form
    >>> osc, one = Oscillator("0", "1 + cos(t)", 0, 1), np.array([1.0])
    >>> never_returns(osc, linear_form(osc), one, 10 * one, 40 * one, 10 * one).tolist()
    [True]
    """
    damping, stiffness = as_float(form.damping), as_float(form.stiffness)
    h = as_float(at_rest(form, osc.clearance))
    position, speed, bound = np.zeros(z.shape), np.zeros(z.shape), 0.0
    with np.errstate(all="ignore"):
        for wave in form.harmonics:
            rate = as_float(wave.rate)
            angle = rate * (reduced(tau, turn(wave.rate)) + time) + as_float(wave.phase)
            reply = stiffness - rate * rate + 1j * damping * rate
            if not reply:
                return np.zeros(z.shape, bool)  # resonance: the forced motion grows without a bound
            answer = (as_float(wave.cosine) - 1j * as_float(wave.sine)) / reply
            turned = answer * np.exp(1j * angle)
            position, speed, bound = position + turned.real, speed + (1j * rate * turned).real, bound + abs(answer)
        low, size = _lowest(
            sign_of(form.stiffness), sign_of(form.damping), stiffness, damping, h, z - position, u - speed
        )
        return np.asarray(low - bound > MARGIN.part * (size + bound + np.abs(z)))


def _lowest(k_sign: int, d_sign: int, k: float, d: float, h: float, z: Array, u: Array) -> tuple[Array, Array]:
    """A lower bound, for all later times, of the solution of z'' + d z' + k z = h; and the size of its terms."""
    never = np.full(z.shape, -np.inf), np.abs(z)
    if k_sign > 0:
        free = np.hypot(z - h / k, u / np.sqrt(k))  # the energy does not grow
        return (h / k - free, np.abs(h / k) + free) if d_sign >= 0 else never
    if k_sign < 0:
        root = np.sqrt(d * d / 4 - k)
        a, b = -d / 2 + root, -d / 2 - root
        growing, fading = (u - b * (z - h / k)) / (a - b), (a * (z - h / k) - u) / (a - b)
        low = np.where(growing > 0, growing + np.minimum(fading, 0) + h / k, -np.inf)
        return low, np.abs(growing) + np.abs(fading) + np.abs(h / k)
    if d_sign == 0:
        deepest = z - np.where(u < 0, u * u / (2 * h) if h > 0 else np.inf, 0.0)
        return (deepest if h >= 0 else never[0]), np.abs(z) + np.abs(deepest)
    if d_sign > 0 and h >= 0:
        fading = (h / d - u) / d
        return z - fading + np.minimum(fading, 0), np.abs(z) + 2 * np.abs(fading)
    return never
