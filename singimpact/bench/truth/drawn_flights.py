"""Truths of drawn states in balls, with condition numbers of their own: hits, derivatives of the map, impacts in a row.

    kappa = 1 + (|dF/dtau| max(|tau|, T) + |dF/dv| v)/|F|

for a value F after a time T, where tau counts within one period of the forcing: a double is an exact time, and what is
lost by rounding omega tau is an error.
"""

from collections.abc import Callable, Sequence
from math import log2, pi
from typing import Any

import flint

from singimpact.algebra.precision import balls_at
from singimpact.bench.drawn import CLEARANCES, OMEGAS, States
from singimpact.bench.truth.first_hit import Cubic, Linear, first_hit

BITS = 320
HORIZON = 2000.0
SMALL = 10.0**-25  # relative step of a difference; the values have 60 digits and more
DIGITS = 40
Truth = tuple[list[str], list[float]]
# From a state in balls to values and the times at which they are reached.
Values = Callable[[Any, Any], tuple[list[Any], list[Any]]]


def hits(states: States, count: int) -> Truth:
    """Flight times of the first states, as decimal text, and their condition numbers.

    Examples
    --------
    >>> from singimpact.bench.drawn import Draws
    >>> truth, kappas = hits(Draws("linear", "generic", 3)(), 1)
    >>> len(truth[0]) > DIGITS, 1 < kappas[0] < 100
    (True, True)
    """

    def values(tau: Any, v: Any) -> tuple[list[Any], list[Any]]:
        time, _, _ = _hit(states, tau, v)
        return [time], [time]

    return _judged(states, count, values)


def derivatives(states: States, count: int) -> Truth:
    """The four entries of D G at the first states of a linear model, row by row."""

    def values(tau: Any, v: Any) -> tuple[list[Any], list[Any]]:
        time, u, motion = _hit(states, tau, v)
        e, r = motion.at(time)[2], flint.arb(states.restitution)
        (z_by_tau, u_by_tau), (z_by_v, u_by_v) = motion.variations(time)
        time_by_tau, time_by_v = -z_by_tau / u, -z_by_v / u
        rows = [1 + time_by_tau, time_by_v, -r * (u_by_tau + e * time_by_tau), -r * (u_by_v + e * time_by_v)]
        return rows, [time] * 4

    return _judged(states, count, values)


def impacts(states: States, count: int, wanted: Sequence[int]) -> Truth:
    """The times of the impacts with the numbers `wanted`, from 1, of the orbits of the first states."""

    def values(tau: Any, v: Any) -> tuple[list[Any], list[Any]]:
        times = []
        for number in range(1, max(wanted) + 1):
            time, u, _ = _hit(states, tau, v)
            tau, v = tau + time, -flint.arb(states.restitution) * u
            if number in wanted:
                times.append(tau)
        return times, times

    return _judged(states, count, values)


def _hit(states: States, tau: Any, v: Any) -> tuple[Any, Any, Any]:
    """Time, velocity and motion of a flight that hits."""
    made = Cubic if states.family == "duffing" else Linear
    motion: Any = made(OMEGAS[states.family], CLEARANCES[states.family], tau, v)
    found = first_hit(motion, float(v), HORIZON)
    if found is None:
        raise ArithmeticError(f"no hit from {float(tau)!r}, {float(v)!r} within {HORIZON}")
    return *found, motion


def _judged(states: States, count: int, values: Values) -> Truth:
    truth: list[str] = []
    kappas: list[float] = []
    for tau, v in zip(states.tau[:count].tolist(), states.v[:count].tolist(), strict=True):
        with balls_at(BITS + int(8 * max(-log2(v), 0))):
            found, times = values(flint.arb(tau), flint.arb(v))
            truth += [each.str(DIGITS, radius=False) for each in found]
            kappas += _conditions(states, (tau, v), values, (found, times))
    return truth, kappas


def _conditions(states: States, state: tuple[float, float], values: Values, found: Any) -> list[float]:
    tau, v = (flint.arb(part) for part in state)
    period = 2 * pi / OMEGAS[states.family]
    small = flint.arb(SMALL)
    by_tau, by_v = values(tau + small, v)[0], values(tau, v * (1 + small))[0]
    near = abs(state[0] - period * round(state[0] / period))
    return [
        1 + float((abs(a - value) / small * max(near, float(time)) + abs(b - value) / small) / abs(value))
        for value, time, a, b in zip(*found, by_tau, by_v, strict=True)
    ]
