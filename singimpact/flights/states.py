"""States that flights start from: read once, checked, broadcast; a mass at rest at a zero of a_c."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression
from singimpact.algebra.numbers import constant, float_array, sign_of
from singimpact.flights.limits import LIMITS
from singimpact.inputs import InputError, refuse
from singimpact.oscillator.acceleration import sign_of_acceleration
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.nearest_zero import Zero, zero_beside


@dataclass(frozen=True)
class States:
    """Launch states, flat, with the shape they came in; `exact_tau`, `exact_v` give what was written.

    `rest` gives, for each launch at rest, its exact time with sign and order of the first derivative of a_c that is not
    zero (sign 0: none was found).

    Examples
    --------
    >>> states = States.read(["pi/2", 1], 0.5)
    >>> states.shape, str(states.exact_tau(0))
    ((2,), '0.5*pi')
    """

    tau: np.ndarray[Any, Any]
    v: np.ndarray[Any, Any]
    shape: tuple[int, ...]
    written: tuple[Any, Any]
    rest: Mapping[int, Zero] = field(default_factory=dict)

    @staticmethod
    def of(osc: Oscillator, tau: Any, v: Any, digits: int | None = None) -> States:
        """`read`, and what a model does with a mass at rest: next to a zero of a_c, a double is that zero."""
        states = States.read(tau, v)
        if states.v.all():
            return states
        resting = np.flatnonzero(states.v == 0)
        rest = {}
        for index in resting.tolist():
            moving = sign_of(states.exact_v(index)) > 0  # less than the smallest double
            zero = None if moving else _zero_beside(osc, states.written[0][index], digits)
            tau = states.exact_tau(index)
            rest[index] = zero or Zero(tau, *reversed(at_rest(osc, tau)))
        return replace(states, rest=rest)

    @staticmethod
    def read(tau: Any, v: Any) -> States:
        """Check and broadcast a caller's tau and v."""
        if _plain(tau) and _plain(v) and tau.shape == v.shape and (v >= 0).all():  # arrays of doubles as they stand
            return States(tau.ravel(), v.ravel(), tau.shape, (tau.ravel(), v.ravel()))
        raw = _raw("tau", tau), _raw("v", v)
        try:
            written = np.broadcast_arrays(*raw)
        except ValueError:
            raise InputError(
                f"tau of shape {raw[0].shape} and v of shape {raw[1].shape} do not broadcast: give shapes that do"
            ) from None
        shape = written[0].shape
        times, speeds = (
            np.broadcast_to(float_array(name, part), shape).ravel()
            for name, part in zip(("tau", "v"), raw, strict=True)
        )
        if speeds.size and speeds.min() < 0:
            raise refuse("v", float(speeds[speeds < 0][0]), "velocities >= 0, just after an impact")
        return States(times, speeds, shape, (written[0].ravel(), written[1].ravel()))

    def exact_tau(self, index: int) -> Expression:
        """tau as it was written, or the zero of a_c that it stands for."""
        if index in self.rest:
            return self.rest[index].tau
        return constant("tau", self.written[0][index])

    def given(self, index: int) -> tuple[Any, Any]:
        """tau and v as they came."""
        return self.written[0][index], self.written[1][index]

    def exact_v(self, index: int) -> Expression:
        """v as it was written."""
        return constant("v", self.written[1][index])


def _plain(values: Any) -> bool:
    return type(values) is np.ndarray and values.dtype == np.float64 and bool(np.isfinite(values).all())


def _zero_beside(osc: Oscillator, written: Any, digits: int | None) -> Zero | None:
    if not isinstance(written, float | np.floating):
        return None  # numbers given as text are exact
    return zero_beside(osc, float(written), 256 + 4 * (digits if isinstance(digits, int) else 15))


def _raw(name: str, value: Any) -> np.ndarray[Any, Any]:
    if isinstance(value, Expression):
        boxed = np.empty((), dtype=object)
        boxed[()] = value
        return boxed
    try:
        array = np.asarray(value)
    except ValueError:
        raise refuse(name, value, "a number or an array of numbers") from None
    if array.dtype.kind in "USc" or (array.dtype.kind == "O" and isinstance(value, list | tuple)):
        # numpy turns a list of text and numbers into text of numbers, and a float written out is not that float
        array = np.array(value, dtype=object)
    return array


def at_rest(osc: Oscillator, tau: Expression) -> tuple[int, int]:
    """(sign, order) of the first derivative of a_c that is not zero; sign 0: none was found.

    Examples
    --------
    >>> at_rest(Oscillator("x", "sin(t)", 0, 1), constant("tau", 0))
    (1, 1)
    """
    for order in range(LIMITS.derivatives_at_rest + 1):
        sign = sign_of_acceleration(osc, tau, order)
        if sign:
            return sign, order
    return 0, 0
