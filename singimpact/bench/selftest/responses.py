"""The derivative D G, and the law of rebound, of one model.

Truth of D G: central differences of fixed-step flights, with rho evaluated by Python. Truth of the rebound: rho
evaluated by Python at the velocity of the hit. Shared with the package: f, g and rho as expression trees.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.bench.selftest.draws import Flown, against_plain_orbits
from singimpact.bench.selftest.rows import Row, Tally
from singimpact.bench.truth.plain_orbits import PlainOrbits
from singimpact.status import Status

Array = np.ndarray[Any, Any]
DERIVATIVE, REBOUND = "D G against differences", "rebound"


@dataclass(frozen=True)
class ResponseSettings:
    """The number of states, and the tolerances of their comparison."""

    states: int = 100
    # of an entry, relative to its natural size, beside the error of the differences
    wrong: float = 1e-6
    # a larger error of a difference, relative to the size of its entry, decides nothing
    bent: float = 1e-2
    # relative difference of v' from rho(velocity): rho is evaluated in another order
    rebound: float = 1e-12
    # the same where rho cancels: so many roundings of the sizes of its slope and v
    rounding: float = 32.0


RESPONSES = ResponseSettings()


@against_plain_orbits(DERIVATIVE)
def derivatives(flown: Flown, plain: PlainOrbits) -> Row:
    """All four entries of `osc.derivative`."""
    tally = Tally(DERIVATIVE)
    places = np.flatnonzero(flown.step.status == Status.hit)[: RESPONSES.states]
    if not places.size:
        return Row(DERIVATIVE, note="no flight that was drawn returns")
    matrices = flown.osc.derivative(flown.tau[places], flown.v[places], horizon=flown.scales.horizon).matrix
    tally.restart()
    for done, at in enumerate(places.tolist()):
        if tally.late:
            tally.leave("CPU time used up", places.size - done)
            break
        _matrix(flown, plain, at, matrices[done], tally)
    return tally.row()


def _matrix(flown: Flown, plain: PlainOrbits, at: int, matrix: Array, tally: Tally) -> None:
    tau, v = float(flown.tau[at]), float(flown.v[at])
    quotients, hit = plain.difference_quotients(tau, v), plain.impact(tau, v)
    if quotients is None or not np.isfinite(hit.v):
        tally.leave("a flight beside it does not return")
        return
    true, error = quotients
    sizes = np.outer([hit.time, hit.v], [plain.rate, 1 / v]) + np.abs(true)
    if not (error <= RESPONSES.bent * sizes).all():
        tally.leave("the map bends within a difference")
        return
    ratio = float(np.max(np.abs(matrix - true) / (RESPONSES.wrong * sizes + 10 * error)))
    state = flown.call(at, "derivative")
    tally.judge(ratio, f"{state}: {matrix.round(9).tolist()}, differences {true.round(9).tolist()}")


@against_plain_orbits(REBOUND)
def rebounds(flown: Flown, plain: PlainOrbits) -> Row:
    """The state after a hit: tau + T, and rho of the velocity."""
    tally, step = Tally(REBOUND), flown.step
    for at in np.flatnonzero((step.status == Status.hit) | (step.status == Status.no_rebound)).tolist():
        velocity, v = float(step.velocity[at]), float(step.v[at])
        true = plain.rebound(velocity)
        state = f"{flown.call(at)}: velocity {velocity!r}, after it {v!r}, rho is {true!r}"
        if step.status[at] == Status.no_rebound:
            tally.judge(0.0 if not true > 0 else np.inf, state)
            continue
        beside = [plain.rebound(velocity * (1 + s * 2.0**-44)) for s in (-1, 1)]
        # 2^-44 is 256 roundings
        near = RESPONSES.rebound * true + RESPONSES.rounding / 256 * max(abs(end - true) for end in beside)
        passed = flown.tau[at] + step.flight_time[at]
        late = 4 * 2.0**-52 * (abs(flown.tau[at]) + step.flight_time[at])
        tally.judge(float(max(abs(v - true) / near, abs(step.tau[at] - passed) / late)), state)
    row = tally.row()
    return row if row.tried else Row(REBOUND, note="no flight that was drawn returns")
