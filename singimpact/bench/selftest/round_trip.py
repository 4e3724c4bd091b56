"""Flights forward and back: `inverse_map` of the impact gives the launch, within what rounding explains.

No independent truth: both flights, D G and the error estimates are those of the package.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.bench.selftest.draws import DRAW, Flown
from singimpact.bench.selftest.rows import Row, Tally
from singimpact.oscillator.rebound import rho_of
from singimpact.status import Status

EPSILON = 2.0**-52
NAME = "flown forward and back"
Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class RoundTripSettings:
    """Tolerances of a launch that was flown forward and back.

    Parameters
    ----------
    rounding : of the landing state and of the flight back, in units of epsilon: the 10 of 10 kappa epsilon.
    lost : where rounding explains more than this part of v or of the flight time, the map is not linear over it, and
        the flight back may even miss the obstacle: such a state is undecided.
    """

    rounding: float = 10.0
    lost: float = 1e-2


ROUND_TRIP = RoundTripSettings()


def row(flown: Flown) -> Row:
    """The row of the table."""
    tally = Tally(NAME)
    hit = np.flatnonzero(flown.step.status == Status.hit)
    for begin in range(0, hit.size, DRAW.together):
        if tally.late:
            tally.leave("CPU time used up", hit.size - begin)
            break
        _judge(flown, hit[begin : begin + DRAW.together], tally)
    result = tally.row()
    return result if hit.size else Row(NAME, note="no flight that was drawn returns")


def _judge(flown: Flown, places: Array, tally: Tally) -> None:
    osc, step, horizon = flown.osc, flown.step, flown.scales.horizon
    back = osc.inverse_map(step.tau[places], step.v[places], horizon=2 * horizon)
    (by_tau, by_v), trip = allowed(flown, places)
    for at, index in enumerate(places.tolist()):
        tau, v, time = flown.tau[index], flown.v[index], step.flight_time[index]
        status = Status(int(back.status[at]))
        state = f"{flown.call(index)} and back: tau {float(back.tau[at])!r}, v {float(back.v[at])!r}, {status.name}"
        if np.isnan(by_tau[at] + by_v[at]):
            state += "; derivative or an error of the flight is nan, so nothing says how near that must be"
        if status == Status.unresolved:
            tally.leave("unresolved")
        elif by_v[at] > ROUND_TRIP.lost * v or by_tau[at] > ROUND_TRIP.lost * time:
            tally.leave("rounding explains any difference")
        elif _other_branch(step.velocity[index], back.velocity[at], trip):
            tally.leave("another velocity rebounds alike")
        elif status != Status.hit:
            tally.judge(np.inf, state)
        else:
            tally.judge(max(abs(back.tau[at] - tau) / by_tau[at], abs(back.v[at] - v) / by_v[at]), state)


def _other_branch(velocity: float, before: float, trip: bool) -> bool:
    """Whether rho is no number and inverse_map took another of the velocities that rebound alike."""
    return trip and abs(before - velocity) > 1e-6 * abs(velocity) and not np.isnan(before)


def allowed(flown: Flown, places: Array) -> tuple[tuple[Array, Array], bool]:
    """Tolerances of tau and v after a flight forward and back, and whether rho is an expression.

    Notes
    -----
    The errors of the landing are `time_error` and `velocity_error` and a rounding; the flight back adds a rounding of
    its own; both are carried to the launch by the inverse of D G.
    """
    osc, step, tau, v = flown.osc, flown.step, flown.tau[places], flown.v[places]
    (a, b), (c, d) = np.moveaxis(osc.derivative(tau, v, horizon=flown.scales.horizon).matrix, (-2, -1), (0, 1))
    with np.errstate(all="ignore"):
        inverse = np.abs(np.array([[d, -b], [-c, a]]) / (a * d - b * c))
        time, landed, speed = (getattr(step, name)[places] for name in ("flight_time", "tau", "v"))
        rounding = ROUND_TRIP.rounding * EPSILON
        late = step.time_error[places] * time + rounding * np.maximum(np.abs(landed), time)
        fast = (step.velocity_error[places] + rounding) * speed
        by_tau = inverse[0, 0] * late + inverse[0, 1] * fast + rounding * np.maximum(np.abs(tau), time)
        by_v = inverse[1, 0] * late + inverse[1, 1] * fast + rounding * v
    return (by_tau, by_v), str(rho_of(osc.restitution)) != str(rho_of(osc.slope_at_rest()))
