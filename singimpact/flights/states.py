"""States that flights start from: read once, checked, broadcast; a mass at rest at a zero of a_c."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.expressions import Expression, Number
from singimpact.algebra.numbers import (
    Array,
    as_float,
    as_fraction,
    constant,
    float_array,
    rational_near,
    require_unmasked,
    sign_of,
)
from singimpact.flights.blocks import LEAST
from singimpact.flights.limits import LIMITS
from singimpact.inputs import InputError, refuse, require_memory
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import phase_of
from singimpact.oscillator.wall_acceleration import Zero, acceleration, sign_of_acceleration, zero_beside

# Periods from which on launch times are reduced exactly: kernels reduce those before, to twice a double's bits
FAR = 2.0**25


# Numbers that every machine holds: of fewer the memory is not looked at
FEW = 1 << 22


@dataclass(frozen=True)
class States:
    """Launch states, flat, with the shape they came in; `exact_tau`, `exact_v` give what was written.

    tau holds the doubles that flights start from: of a launch time that no double holds, such as "1000000000000000.3",
    the phase within a period; `turns` is what it lies before the launch time, whole periods.

    `rest` gives, for each launch at rest, its exact time with sign and order of the first derivative of a_c that is not
    zero (sign 0: none was found).

    Examples
    --------
    >>> states = States.read(["pi/2", 1], 0.5)
    >>> states.shape, str(states.exact_tau(0))
    ((2,), '0.5*pi')
    """

    tau: Array
    v: Array
    shape: tuple[int, ...]
    written: tuple[Any, Any]
    rest: Mapping[int, Zero] = field(default_factory=dict)
    turns: Any = 0.0

    @staticmethod
    def of(osc: Oscillator, tau: Any, v: Any, digits: int | None = None) -> "States":
        """`read`, and what a model does with a mass at rest: next to a zero of a_c, a double is that zero."""
        if _doubles(tau) and _doubles(v) and tau.shape == v.shape and tau.size:
            times, speeds = tau.ravel(), v.ravel()
            moving = np.minimum.reduce(speeds) > 0 and np.maximum.reduce(speeds) < np.inf  # not so where one is nan
            if moving and np.maximum.reduce(np.abs(times)) < late(osc):
                return States(times, speeds, tau.shape, (times, speeds))
        states = States.read(tau, v).in_period(osc)
        if states.v.all():
            return states
        resting = np.flatnonzero(states.v == 0)
        rest = _clear(osc, states, resting)
        for index in [index for index in resting.tolist() if index not in rest]:
            moving = sign_of(states.exact_v(index)) > 0  # less than the smallest double
            zero = None if moving else _zero_beside(osc, states.written[0][index], digits)
            tau = states.exact_tau(index)
            rest[index] = zero or Zero(tau, *reversed(at_rest(osc, tau)))
        return replace(states, rest=rest)

    @staticmethod
    def read(tau: Any, v: Any) -> "States":
        """Check and broadcast a caller's tau and v."""
        require_room(("tau", tau), ("v", v))
        if _plain(tau) and _plain(v) and tau.shape == v.shape and (v >= 0).all():  # arrays of doubles as they stand
            return States(tau.ravel(), v.ravel(), tau.shape, (tau.ravel(), v.ravel()))
        raw = as_written("tau", tau), as_written("v", v)
        try:
            written = np.broadcast_arrays(*raw)
        except ValueError:
            raise InputError(
                f"tau of shape {raw[0].shape} and v of shape {raw[1].shape} do not broadcast: give shapes that do"
            ) from None
        shape = written[0].shape
        times, speeds = (
            np.broadcast_to(float_array(name, values), shape).ravel()
            for name, values in zip(("tau", "v"), raw, strict=True)
        )
        if speeds.size and speeds.min() < 0:
            raise refuse("v", float(speeds[speeds < 0][0]), "velocities >= 0, just after an impact")
        return States(times, speeds, shape, (written[0].ravel(), written[1].ravel()))

    def in_period(self, osc: Oscillator) -> "States":
        """These launches; those beyond a period that no double holds, and late ones, start from their phase.

        Examples
        --------
        >>> states = States.read([2**53 + 1, "0.3", 7.0], 1).in_period(Oscillator("x", "cos(2*t)", 0, 1))
        >>> states.tau.tolist(), (states.tau + states.turns).tolist()
        ([-1.1276428765770465, 0.3, 7.0], [9007199254740992.0, 0.3, 7.0])
        """
        if osc.period is None or not self.tau.size:
            return self
        rough, far = self._rough(), np.flatnonzero(np.abs(self.tau) >= late(osc))
        if not rough.size and not far.size:
            return self
        tau, turns = self.tau.copy(), np.zeros(self.tau.size)
        for index in np.union1d(rough[np.abs(self.tau[rough]) > late(osc) / FAR], far).tolist():
            exact, double = self._exactly(index), Fraction(float(tau[index]))
            if exact != double or abs(double) >= late(osc):
                tau[index] = phase_of(exact, osc.period)
                turns[index] = float(exact - Fraction(float(tau[index])))
        return replace(self, tau=tau, turns=turns) if turns.any() else self

    def below_doubles(self) -> Array:
        """The rounding error of each launch time as a double."""
        low = np.zeros(self.tau.size)
        for index in self._rough().tolist():
            low[index] = float(self._exactly(index) - Fraction(float(self.tau[index])))
        return low

    def _rough(self) -> Array:
        """Launches whose time is not given as a double, nor as an integer that is one."""
        times = self.written[0]
        if times.dtype.kind == "f":
            return np.zeros(0, dtype=np.int64)
        if times.dtype.kind in "iu":
            return np.flatnonzero(np.abs(self.tau) >= 2.0**53)
        inexact = [not isinstance(time, float | np.floating) for time in times.tolist()]
        return np.flatnonzero(np.array(inexact, dtype=bool))

    def _exactly(self, index: int) -> Fraction:
        tree = constant("tau", self.written[0][index])
        exact = as_fraction(tree)
        return rational_near(tree, 256) if exact is None else exact

    def exact_tau(self, index: int) -> Expression:
        """tau as it was written, or the zero of a_c that it stands for."""
        return self.rest[index].tau if index in self.rest else constant("tau", self.written[0][index])

    def given(self, index: int) -> tuple[Any, Any]:
        """tau and v as they came."""
        return self.written[0][index], self.written[1][index]

    def exact_v(self, index: int) -> Expression:
        """v as it was written."""
        return constant("v", self.written[1][index])


@lru_cache(maxsize=256)
def late(osc: Oscillator) -> float:
    """The size of launch times from which on they are reduced exactly; inf without a period."""
    return np.inf if osc.period is None else FAR * as_float(osc.period)


def require_room(*numbers: tuple[str, Any]) -> None:
    """Refuse arguments with so many numbers together that no memory holds their results.

    Examples
    --------
    >>> require_room(("tau", np.zeros((1000, 1))), ("v", 0.1))
    """
    arrays = [value for _, value in numbers if isinstance(value, np.ndarray)]
    if not arrays or math.prod(array.size for array in arrays) < FEW:
        return
    names = " and ".join(filter(None, (", ".join(name for name, _ in numbers[:-1]), numbers[-1][0])))
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays))
    except ValueError:
        return  # refused where they are used
    require_memory(names, shape, LEAST)


def _plain(values: Any) -> bool:
    return _doubles(values) and bool(np.isfinite(values).all())


def _doubles(values: Any) -> bool:
    return type(values) is np.ndarray and values.dtype == np.float64


def _clear(osc: Oscillator, states: States, resting: Array) -> dict[int, Zero]:
    """Of doubles at rest those where a_c changes by less than half within 8 ulps: no zero is near, its sign decides."""
    times, speeds = states.written
    if times.dtype != float or speeds.dtype.kind not in "fiu":
        return {}
    tau = states.tau[resting]
    with np.errstate(all="ignore"):
        here, before, after = (acceleration(osc, tau + 8 * step * np.spacing(tau)) for step in (0, -1, 1))
        clear = (np.abs(before - here) < np.abs(here) / 2) & (np.abs(after - here) < np.abs(here) / 2)
    written, signs = times[resting[clear]].tolist(), np.sign(here[clear]).astype(int).tolist()
    zeros = [Zero(Number(Fraction(time)), 0, sign) for time, sign in zip(written, signs, strict=True)]
    return dict(zip(resting[clear].tolist(), zeros, strict=True))


def _zero_beside(osc: Oscillator, written: Any, digits: int | None) -> Zero | None:
    if not isinstance(written, float | np.floating):
        return None  # numbers given as text are exact
    return zero_beside(osc, float(written), 256 + 4 * (digits if isinstance(digits, int) else 15))


def as_written(name: str, value: Any) -> Array:
    require_unmasked(name, value)
    if isinstance(value, Expression):
        boxed = np.empty((), dtype=object)
        boxed[()] = value
        return boxed
    try:
        array = np.asarray(value)
    except ValueError:
        raise refuse(name, value, "a number or an array of numbers") from None
    listed = isinstance(value, list | tuple)
    whole = listed and array.dtype.kind == "f" and bool((np.abs(array) >= 2.0**53).any())
    if array.dtype.kind in "USc" or (array.dtype.kind == "O" and listed) or whole:
        # numpy turns a list of text and numbers into text of numbers, and a float written out is not that float; in a
        # list with floats it rounds large integers
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
