"""Many orbits at once, in doubles: lanes for linear models, one state after another for the others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.expressions import substitute
from singimpact.algebra.numbers import as_float
from singimpact.codegen.kernels import compiled
from singimpact.codegen.scalar import scalar
from singimpact.flights import lanes
from singimpact.flights.hits import EPSILON, doubles
from singimpact.flights.kernel import kernel_of, source
from singimpact.flights.launch import States, horizon_of
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.phase import reduced
from singimpact.flights.sequences import sequence
from singimpact.flights.tables import STRIDES, table_of
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.rebound import rho_of
from singimpact.status import Status

LANES = 16


@dataclass(frozen=True)
class Ends:
    """The states after the last impact flown, and 0, or the status of the flight that ended an orbit before."""

    tau: Any
    v: Any
    status: Any


def after(osc: Oscillator, tau: Any, v: Any, impacts: int) -> Ends:
    """G^impacts of states with v > 0; an orbit that meets no further impact stays where it is.

    Examples
    --------
    >>> ends = after(Oscillator("0", "-2", 0, "1/2"), [0, 1], 1, 3)
    >>> ends.tau.tolist(), ends.v.tolist()
    ([1.75, 2.75], [0.125, 0.125])
    """
    states = States.read(tau, v)
    kernel = kernel_of(osc)
    p = doubles(kernel)
    table = table_of(kernel, p)
    times, speeds = states.tau.copy(), states.v.copy()
    status = np.where(speeds > 0, np.int8(0), np.int8(Status.sticks))
    if table is None or kernel.form is None:
        for index in np.flatnonzero(status == 0):
            found = sequence(osc, times[index], speeds[index], impacts)
            status[index] = found.status
            if found.tau.size:
                times[index], speeds[index] = found.tau[-1], found.v[-1]
        return Ends(*(part.reshape(states.shape)[()] for part in (times, speeds, status)))
    shift = np.zeros(times.size) if osc.period is None else times - reduced(times, osc.period)
    padded = [np.resize(part, -(-times.size // LANES) * LANES) for part in (times - shift, speeds, status)]
    padded[2][times.size :] = Status.sticks
    _fly(osc, p, table, padded, impacts)
    parts = (padded[0][: times.size] + shift, padded[1][: times.size], padded[2][: times.size])
    return Ends(*(part.reshape(states.shape)[()] for part in parts))


def _fly(osc: Oscillator, p: Any, table: Any, padded: list[Any], impacts: int) -> None:
    kernel = kernel_of(osc)
    assert kernel.form is not None
    text, trees = scalar(rho_of(osc.restitution), "v", "rebound")
    loops = (lanes.walk, lanes.crossed, lanes.lanes)
    whole = "\n\n".join([kernel.text, text, *(source(loop) for loop in loops)])
    names = (*kernel.names, "rebound", *(loop.__name__ for loop in loops))
    w = np.array([as_float(substitute(tree, osc.parameters)) for tree in trees])
    phases, order = np.array([as_float(wave.phase) for wave in kernel.form.harmonics]), degree_for(EPSILON)
    compiled(whole, names)["lanes"](
        padded[0], padded[1], impacts, w, phases, np.zeros(max(2 * phases.size, 1)), STRIDES.order, order,
        horizon_of(osc, None), LIMITS.safety * EPSILON, p, table.step, table.rows, table.bound, np.zeros(order + 2),
        np.zeros((kernel.rows, order + 2)), np.zeros(order + 2), padded[2],
    )  # fmt: skip
