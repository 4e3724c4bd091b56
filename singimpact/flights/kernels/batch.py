"""Many flights in lock-step batches of 64 states, so that one instruction serves several of them: `tabulated`, abreast.

A state whose step needs more than a plain crossing is handed to `tabulated_flight`.  The numbers of a state stand in
rows of one array, `lane[ROW + k]`: the compiler then sees that rows do not overlap.  Loops over the batch count to a
constant too large to be unrolled, and sum integers: both keep them vectors.
"""

from math import inf
from typing import Any

from singimpact.flights.kernels.batch_isolate import isolate
from singimpact.flights.kernels.batch_refine import (
    expand,
    quintic_guess,
    refine_roots,
    reflect_hits,
    turn_waves,
)
from singimpact.flights.kernels.batch_response import judge_hits, respond
from singimpact.flights.kernels.hits import AT_REST, linear_hit
from singimpact.flights.kernels.orbits import rebound
from singimpact.flights.kernels.state import (
    ACC,
    ACROSS,
    AT,
    COSINE,
    HEIGHT,
    LANES,
    LATE,
    LOST,
    MODE,
    PHASE,
    RATE,
    SIDE,
    SINCE,
    SINE,
    SIZE,
    SPEED,
    TIME,
    TURNS,
    WALL,
    Array,
    Batch,
    Model,
    V,
)
from singimpact.flights.kernels.tabulated import tabulated_flight
from singimpact.flights.kernels.waves import NEAREST, phase_of, quarters, reduced_twice, wall_acceleration


def hit_batches(tau: Array, v: Array, heights: Array, model: Model, batch: Batch, out: Array, status: Array) -> int:
    """`entries.linear_hits` of `LANES` states or more; the last batch flies some states again."""
    lane, work, count, others = batch.lane, batch.work, len(tau), 0
    for begin in range(0, count, LANES):
        b = min(begin, count - LANES)
        for k in range(LANES):
            lane[AT + k], lane[LATE + k] = reduced_twice(tau[b + k], model.turn)
            lane[V + k] = v[b + k]
            lane[HEIGHT + k] = heights[b + k] if batch.launched < 0 else 0.0
            lane[MODE + k] = 0.0 if (v[b + k] > 0) | (batch.launched < 0) else 3.0
            lane[SIDE + k], lane[WALL + k] = 1.0, 1.0
        if fly_batch(model, batch) > 0:
            respond(model, batch)
            judge_hits(lane, batch.X, model)
            for row in range(10):
                columns = out[row, b : b + LANES]
                for k in range(LANES):
                    columns[k] = batch.X[row, k]
        for k in range(LANES):
            status[b + k] = (0 if lane[SIDE + k] > 0 else ACROSS) if lane[MODE + k] == 1.0 else AT_REST
            if lane[MODE + k] != 2.0:
                continue
            status[b + k], _a = linear_hit(
                lane[AT + k], lane[LATE + k], lane[V + k], lane[HEIGHT + k], 0.0, model, work
            )
            for row in range(10):
                out[row, b + k] = work.hit[row]
    for i in range(count):
        others += 1 if status[i] != 0 else 0
    return others


def fly_batches(
    tau: Array, v: Array, count: int, laws: Any, models: Any, batch: Batch, sides: Array, status: Array
) -> None:
    """Fly `count` impacts from every state, as `orbits.iterate`; tau, v are as many as a multiple of `LANES`."""
    lane, turn = batch.lane, batch.turn
    for b in range(0, len(v), LANES):
        for k in range(LANES):
            lane[V + k], lane[SINCE + k], lane[LOST + k], lane[TURNS + k] = v[b + k], 0.0, 0.0, 0.0
            lane[MODE + k], lane[SIDE + k], lane[WALL + k] = 0.0 if status[b + k] == 0 else 3.0, 1.0, 1.0
        for _ in range(count):
            for k in range(LANES):
                lane[AT + k] = tau[b + k] + lane[SINCE + k]
                lane[LATE + k] = late(tau[b + k], lane[SINCE + k], lane[LOST + k])
            if fly_batch(models[0], batch) == 0:
                break
            for k in range(LANES):
                if lane[MODE + k] == 2.0:
                    code = fly_alone(k, models[0], batch) if lane[WALL + k] > 0 else fly_alone(k, models[1], batch)
                    if code != 0:
                        status[b + k], lane[MODE + k] = code, 3.0
            if models[0].rules.gap < inf:
                # SIDE is -1 of a hit of the wall across, where the next flight starts
                for k in range(LANES):
                    lane[WALL + k] *= lane[SIDE + k] if lane[MODE + k] != 3.0 else 1.0
                bounce(lane, -1.0, laws[1])
            bounce(lane, 1.0, laws[0])
            advance_times(lane, turn)
            for k in range(LANES):
                if lane[MODE + k] == 5.0:
                    status[b + k], lane[MODE + k] = 8, 3.0
        for k in range(LANES):
            v[b + k] = lane[V + k]
            tau[b + k] += (lane[SINCE + k] - lane[LOST + k]) + lane[TURNS + k] * (turn[0] + turn[1])
            sides[b + k] = 0.0 if lane[WALL + k] > 0 else 1.0


def bounce(lane: Array, wall: float, w: Array) -> None:
    """The velocities of the states that have come to a wall become those after the impact."""
    if w[len(w) - 1] == 0:
        for k in range(LANES):
            hit, after = (lane[MODE + k] != 3.0) & (lane[WALL + k] == wall), abs(w[0] * lane[SPEED + k])
            lane[V + k] = after if hit else lane[V + k]
        return
    for k in range(LANES):
        if lane[MODE + k] != 3.0 and lane[WALL + k] == wall:
            lane[V + k] = rebound(lane[SPEED + k], w)


def fly_alone(k: int, model: Model, batch: Batch) -> int:
    """The code of the flight of a state by `tabulated_flight`; a hit fills TIME, SPEED and SIDE."""
    lane, work = batch.lane, batch.work
    a = wall_acceleration(lane[AT + k], lane[LATE + k], model.numbers, model.rest, work.launch)
    code, lane[TIME + k], lane[SPEED + k], _depth, _error = tabulated_flight(
        work.launch, lane[V + k], 0.0, a, model, work.flight
    )
    lane[SIDE + k] = -1.0 if code == ACROSS else 1.0
    return 0 if code == ACROSS else int(code)


def fly_batch(model: Model, batch: Batch) -> int:
    """The number of states that fly: TIME and SPEED of a hit where the mode becomes 1."""
    lane, wave, table = batch.lane, batch.wave, batch.table
    launch_phases(lane, wave, model, batch.mirror.steady, table.step)
    flying = isolate(batch, model.numbers, model.rules.ulp, model.rules.gap)
    if flying > 0:
        turn_waves(lane, wave, batch.local, table.waves)
        expand(lane, batch.local, batch.series, batch.mirror, batch.X)
        if model.rules.gap < inf:
            reflect_hits(lane, batch.X, model.rules.gap)
        quintic_guess(lane, table.step, batch.launched)
        refine_roots(batch, table.step, model.rules.horizon)
    return flying


def advance_times(lane: Array, turn: Array) -> None:
    """Times since the start move on, compensated; whole periods are taken off, so that phases keep their digits."""
    for k in range(LANES):
        # Kahan's sum, as in `orbits.later`
        increment = (lane[TIME + k] if lane[MODE + k] != 3.0 else 0.0) - lane[LOST + k]
        total = lane[SINCE + k] + increment
        lost = (total - lane[SINCE + k]) - increment
        n = (total * turn[2] + NEAREST) - NEAREST
        lane[SINCE + k], lane[LOST + k] = total - n * turn[0], lost + n * turn[1]
        lane[TURNS + k] += n
    for k in range(LANES):
        mode, moves = lane[MODE + k], lane[V + k] > 0
        lane[MODE + k] = 3.0 if mode == 3.0 else 0.0 if moves else 5.0


def launch_phases(lane: Array, wave: Array, model: Model, other: float, step: float) -> None:
    """`wall_acceleration` of a batch; a state whose slow return needs a_c to more than doubles is handed over."""
    p, low = model.numbers, model.rest
    for k in range(LANES):
        steady = p.steady if lane[WALL + k] > 0 else other
        lane[ACC + k], lane[SIZE + k] = steady, abs(steady)
    for j in range(len(p.waves)):
        rate, rate_low, phase, phase_low = p.waves[j, RATE], low.waves[j, RATE], p.waves[j, PHASE], low.waves[j, PHASE]
        by_cos, by_sin, c, s = p.waves[j, COSINE], p.waves[j, SINE], j, len(p.waves) + j
        for k in range(LANES):
            angle, rest = phase_of(lane[AT + k], lane[LATE + k], rate, rate_low, phase, phase_low)
            lane[MODE + k] = 2.0 if (lane[MODE + k] == 0.0) & (abs(angle) > 1e6) else lane[MODE + k]
            cosine, sine = quarters(angle, rest)
            wave[c, k], wave[s, k] = lane[WALL + k] * cosine, lane[WALL + k] * sine
            lane[ACC + k] += by_cos * wave[c, k] + by_sin * wave[s, k]
            lane[SIZE + k] += abs(by_cos * wave[c, k]) + abs(by_sin * wave[s, k])
    for k in range(LANES):
        cancels = (32 * abs(lane[ACC + k]) < lane[SIZE + k]) & (abs(lane[V + k]) < step * lane[SIZE + k])
        lane[MODE + k] = 2.0 if (lane[MODE + k] == 0.0) & cancels else lane[MODE + k]


def late(t: float, since: float, lost: float) -> float:
    """The rounding error of t + since - lost as a double."""
    total = t + since
    part = total - t
    return (t - (total - part)) + (since - part) - lost
