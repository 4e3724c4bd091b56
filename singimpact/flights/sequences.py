"""Impacts in a row, in doubles, until one is slow, does not come, or is the last one asked for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.expressions import substitute
from singimpact.algebra.numbers import as_float
from singimpact.codegen.interpreted import function
from singimpact.codegen.scalar import scalar
from singimpact.flights import chains, counted
from singimpact.flights.causes import decoded
from singimpact.flights.in_doubles import EPSILON, doubles, remainders
from singimpact.flights.kernel import PRICES, kernel_of, source
from singimpact.flights.launch import horizon_of
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.phase import reduced
from singimpact.flights.tables import STRIDES, table_of
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.rebound import rho_of

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class Sequence:
    """Impacts after a state.

    Parameters
    ----------
    tau, v : states just after each impact. flight_time, velocity : of the flights that ended there.
    acceleration : a_c at the launch of each flight.
    status : of the flight that was not flown or did not end in an impact; 0 when all were flown or the last was slow.
    cause : why that flight is unresolved, see `singimpact.status.Cause`.
    """

    tau: Array
    v: Array
    flight_time: Array
    velocity: Array
    acceleration: Array
    status: int
    cause: int


@lru_cache(maxsize=256)
def _chained(osc: Oscillator) -> tuple[str, tuple[str, ...], Array]:
    """Kernel text with rho, names, constants of rho."""
    kernel = kernel_of(osc)
    linear = kernel.form is not None and table_of(kernel, doubles(kernel)) is not None
    text, trees = scalar(rho_of(osc.restitution), "v", "rebound")
    loops = (chains.late, chains.chain) if linear else (chains.taylor_chain,)
    whole = "\n\n".join([kernel.text, text, *(source(loop) for loop in loops)])
    names = (*kernel.names, "rebound", *(loop.__name__ for loop in loops))
    return whole, names, np.array([as_float(substitute(tree, osc.parameters)) for tree in trees])


def sequence(osc: Oscillator, tau: float, v: float, count: int, slow: float = 0.0) -> Sequence:
    """Fly at most `count` impacts from a state with v > 0; stop where the chatter left is shorter than `slow`.

    Examples
    --------
    >>> found = sequence(Oscillator("0", "-2", 0, "1/2"), 0.0, 1.0, 3)
    >>> found.tau.tolist(), found.v.tolist(), found.status
    ([1.0, 1.5, 1.75], [0.5, 0.25, 0.125], 0)
    """
    text, names, w = _chained(osc)
    kernel = kernel_of(osc)
    p, order, out = doubles(kernel), degree_for(EPSILON), np.empty((count, 5))
    start = tau if osc.period is None else float(reduced(np.array([tau]), osc.period)[0])
    work = np.zeros(order + 2), np.zeros((kernel.rows, order + 2)), np.zeros(order + 2)
    limit, ulp, loop = horizon_of(osc, None), LIMITS.safety * EPSILON, names[-1]
    fly = function(text, names, loop, count * (PRICES.stride if loop == "chain" else PRICES.taylor))
    if loop == "chain":
        table = table_of(kernel, p)
        assert table is not None
        low, phases = remainders(kernel)
        flown, status = fly(
            start, v, count, slow, w, low, phases, np.zeros(max(2 * phases.shape[1], 1)), STRIDES.order, order, limit,
            ulp, p, table.step, table.rows, table.bound, *work, out,
        )  # fmt: skip
    else:
        flown, status = fly(start, v, count, slow, w, np.zeros(1), order, limit, LIMITS.steps, ulp, p, *work, out)
    counted.add(int(flown))
    since, speed, time, velocity, acceleration = out[:flown].T
    ended, cause = (int(part[0]) for part in decoded(np.array([status])))
    return Sequence(tau + since, speed, time, velocity, acceleration, ended, cause)
