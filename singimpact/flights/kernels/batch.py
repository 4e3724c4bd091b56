"""Many orbits in lock-step batches of 64 states, so that one instruction serves several of them: `tabulated`, abreast.

A state whose step needs more than a plain crossing is handed to `tabulated_flight`.  The numbers of a state stand in
rows of one array, `lane[ROW + k]`: the compiler then sees that rows do not overlap.  Loops over the batch count to a
constant too large to be unrolled, and sum integers: both keep them vectors.
"""

from __future__ import annotations

from typing import Any

from singimpact.flights.kernels.batch_isolate import isolate
from singimpact.flights.kernels.batch_refine import expand, quintic_guess, refine_roots, turn_waves
from singimpact.flights.kernels.lanes import (
    ACC,
    LANES,
    LOST,
    MODE,
    SINCE,
    SIZE,
    SPEED,
    TIME,
    TURNS,
    V,
)
from singimpact.flights.kernels.orbits import rebound
from singimpact.flights.kernels.state import COSINE, PHASE, RATE, SINE
from singimpact.flights.kernels.tabulated import tabulated_flight
from singimpact.flights.kernels.waves import NEAREST, in_quarter, phase_of, wall_acceleration


def fly_batches(tau: Any, v: Any, count: int, w: Any, model: Any, batch: Any, status: Any) -> None:
    """Fly `count` impacts from every state; tau, v become the last states, status what ended an orbit, 0 otherwise.

    Parameters
    ----------
    tau, v : as many as a multiple of `LANES`. w : constants of rho.
    model, batch : see `state`.
    """
    lane, wave, p, work = batch.lane, batch.wave, model.numbers, batch.work
    step, turn, horizon = batch.table.step, batch.turn, model.rules.horizon
    for b in range(0, len(v), LANES):
        for k in range(LANES):
            lane[V + k], lane[SINCE + k], lane[LOST + k], lane[TURNS + k] = v[b + k], 0.0, 0.0, 0.0
            lane[MODE + k] = 0.0 if status[b + k] == 0 else 3.0
        for _ in range(count):
            launch_phases(b, tau, lane, wave, model, step)
            if isolate(lane, wave, p, model.rules.ulp, batch.table) == 0:
                break
            turn_waves(lane, wave, batch.local, batch.table.waves)
            expand(lane, batch.local, batch.series, batch.X)
            quintic_guess(lane, step)
            refine_roots(lane, batch.X, step, horizon)
            for k in range(LANES):
                if lane[MODE + k] != 2.0:
                    continue
                at_low = late(tau[b + k], lane[SINCE + k], lane[LOST + k])
                a = wall_acceleration(tau[b + k] + lane[SINCE + k], at_low, p, model.rest, work.launch)
                code, lane[TIME + k], lane[SPEED + k], _depth, _error = tabulated_flight(
                    work.launch, lane[V + k], a, model, work.flight
                )
                if code != 0:
                    status[b + k], lane[MODE + k] = code, 3.0
            for k in range(LANES):
                v[b + k] = v[b + k] if lane[MODE + k] == 3.0 else rebound(lane[SPEED + k], w)
            for k in range(LANES):
                if lane[MODE + k] != 3.0 and not v[b + k] > 0:
                    status[b + k] = 8
            advance_times(b, v, lane, turn)
            for k in range(LANES):
                lane[MODE + k] = 0.0 if status[b + k] == 0 else 3.0
        for k in range(LANES):
            tau[b + k] += (lane[SINCE + k] - lane[LOST + k]) + lane[TURNS + k] * (turn[0] + turn[1])


def advance_times(b: int, v: Any, lane: Any, turn: Any) -> None:
    """Times since the start move on, compensated; whole periods are taken off, so that phases keep their digits."""
    for k in range(LANES):
        # Kahan's sum, as in `orbits.later`
        increment = (lane[TIME + k] if lane[MODE + k] != 3.0 else 0.0) - lane[LOST + k]
        total = lane[SINCE + k] + increment
        lost = (total - lane[SINCE + k]) - increment
        n = (total * turn[2] + NEAREST) - NEAREST
        lane[SINCE + k], lane[LOST + k] = total - n * turn[0], lost + n * turn[1]
        lane[TURNS + k] += n
        lane[V + k] = v[b + k]


def launch_phases(b: int, tau: Any, lane: Any, wave: Any, model: Any, step: float) -> None:
    """`wall_acceleration` of a batch; a state whose slow return needs a_c to more than doubles is handed over."""
    p, low = model.numbers, model.rest
    for k in range(LANES):
        lane[ACC + k], lane[SIZE + k] = p.steady, abs(p.steady)
    for j in range(len(p.waves)):
        rate, rate_low, phase, phase_low = p.waves[j, RATE], low.waves[j, RATE], p.waves[j, PHASE], low.waves[j, PHASE]
        by_cos, by_sin, c, s = p.waves[j, COSINE], p.waves[j, SINE], 2 * j, 2 * j + 1
        for k in range(LANES):
            t = tau[b + k] + lane[SINCE + k]
            angle, rest = phase_of(
                t, late(tau[b + k], lane[SINCE + k], lane[LOST + k]), rate, rate_low, phase, phase_low
            )
            lane[MODE + k] = 2.0 if (lane[MODE + k] == 0.0) & (abs(angle) > 1e6) else lane[MODE + k]
            n = (angle * 0.6366197723675814 + NEAREST) - NEAREST
            quarter = n - 4 * ((n * 0.25 + NEAREST) - NEAREST)
            cosine, sine = in_quarter(angle, rest, n)
            odd = abs(quarter) == 1
            turned_c, turned_s = (sine if odd else cosine), (cosine if odd else sine)
            wave[c, k] = -turned_c if (quarter == 1) | (abs(quarter) == 2) else turned_c
            wave[s, k] = -turned_s if (quarter == -1) | (abs(quarter) == 2) else turned_s
            lane[ACC + k] += by_cos * wave[c, k] + by_sin * wave[s, k]
            lane[SIZE + k] += abs(by_cos * wave[c, k]) + abs(by_sin * wave[s, k])
    for k in range(LANES):
        cancels = (32 * abs(lane[ACC + k]) < lane[SIZE + k]) & (lane[V + k] < step * lane[SIZE + k])
        lane[MODE + k] = 2.0 if (lane[MODE + k] == 0.0) & cancels else lane[MODE + k]


def late(t: float, since: float, lost: float) -> float:
    """The rounding error of t + since - lost as a double."""
    total = t + since
    part = total - t
    return (t - (total - part)) + (since - part) - lost
