"""Derivatives, condition numbers and errors of a batch of hits: `linear.response` and `hits.linear_hit`, abreast."""

from math import exp, inf

from singimpact.flights.kernels.double_double import product_twice
from singimpact.flights.kernels.hits import UNIT, at_the_hit, is_rough, rounded
from singimpact.flights.kernels.linear import (
    SOON,
    answered,
    free_motion,
    growth,
    moved_wave,
    resonant_reach,
    response_of_differences,
    strength_of,
    swung,
    widest,
)
from singimpact.flights.kernels.state import (
    ACC,
    AT,
    BY_TAU,
    BY_TAU_DOT,
    CONDITION,
    COSINE,
    FLIGHT_TIME,
    FREE,
    GROWTH,
    HEIGHT,
    LANES,
    MODE,
    RATE,
    SIDE,
    SINE,
    SLOPE,
    SPEED,
    THERE,
    TIME,
    TIME_BY_TAU,
    TIME_BY_V,
    TIME_ERROR,
    VELOCITY,
    VELOCITY_BY_TAU,
    VELOCITY_BY_V,
    VELOCITY_CONDITION,
    VELOCITY_ERROR,
    Array,
    Batch,
    Linear,
    Model,
    V,
)
from singimpact.flights.kernels.waves import quarters


def respond(model: Model, batch: Batch) -> None:
    """The derivatives of x and x' by v and tau at the hits, and x'' there."""
    lane, wave, local, p = batch.lane, batch.wave, batch.local, model.numbers
    soon, resonant = 0, 0
    reach, wide = resonant_reach(5, 0.0, p), widest(p)
    for k in range(LANES):
        is_soon = p.fastest * lane[TIME + k] < SOON
        soon += 1 if is_soon else 0
        resonant += 0 if is_soon | (min(lane[TIME + k], wide) > reach) | (lane[MODE + k] != 1.0) else 1
        lane[THERE + k] = p.steady - p.damping * lane[SPEED + k]
    if soon > 0:
        respond_soon(lane, wave, batch.series, p)
    if soon < LANES:
        move_freely(lane, p)
    for j in range(len(p.waves)):
        c, s, rate = j, len(p.waves) + j, p.waves[j, RATE]
        by_cos, by_sin = p.waves[j, COSINE], p.waves[j, SINE]
        for k in range(LANES):
            angle, rest = product_twice(rate, 0.0, lane[TIME + k], 0.0)
            local[c, k], local[s, k] = quarters(angle, rest)
        for k in range(LANES):
            turned = wave[c, k] * local[c, k] - wave[s, k] * local[s, k]
            lane[THERE + k] += by_cos * turned + by_sin * (wave[s, k] * local[c, k] + wave[c, k] * local[s, k])
        if soon == LANES:
            continue
        for k in range(LANES):
            far = p.fastest * lane[TIME + k] >= SOON
            even, odd = moved_wave(wave[c, k], wave[s, k], j, p)
            forced, moved = answered(even, odd, rate, local[c, k], local[s, k], lane[FREE + k], lane[SLOPE + k], p)
            lane[BY_TAU + k] += forced if far else 0.0
            lane[BY_TAU_DOT + k] += moved if far else 0.0
    if resonant > 0:
        respond_near_resonance(lane, wave, batch.work.launch, reach, p)
    if model.rules.gap < inf:
        reflect_response(lane, model.rules.gap, p)


def reflect_response(lane: Array, gap: float, p: Linear) -> None:
    """The derivatives at hits of the other wall, and x'' there, with x -> -x."""
    for k in range(LANES):
        side, u = lane[SIDE + k], lane[SPEED + k]
        # THERE is still the force less damping times the speed of the model with x -> -x
        force = side * (lane[THERE + k] + p.damping * u)
        lane[THERE + k] = (force if side > 0 else force + p.stiffness * gap) - p.damping * u
        lane[FREE + k] *= side
        lane[SLOPE + k] *= side
        lane[BY_TAU + k] *= side
        lane[BY_TAU_DOT + k] *= side


def respond_soon(lane: Array, wave: Array, series: Array, p: Linear) -> None:
    """The derivatives as power series in the flight time, for the fastest rate times t up to `SOON`."""
    for k in range(LANES):
        lane[FREE + k], lane[SLOPE + k], lane[BY_TAU + k], lane[BY_TAU_DOT + k] = 0.0, 0.0, 0.0, 0.0
    for i in range(len(series) - 1, -1, -1):
        by_v = series[i, 1]
        for k in range(LANES):
            t = lane[TIME + k]
            lane[SLOPE + k] = lane[SLOPE + k] * t + lane[FREE + k]
            lane[FREE + k] = lane[FREE + k] * t + by_v
            lane[BY_TAU_DOT + k] = lane[BY_TAU_DOT + k] * t + lane[BY_TAU + k]
            lane[BY_TAU + k] *= t
        for j in range(len(p.waves)):
            # cosine and sine of a phase, differentiated by the launch time
            c, s, rate = j, len(p.waves) + j, p.waves[j, RATE]
            by_cos, by_sin = rate * series[i, 3 + 2 * j], rate * series[i, 4 + 2 * j]
            for k in range(LANES):
                lane[BY_TAU + k] += by_sin * wave[c, k] - by_cos * wave[s, k]


def move_freely(lane: Array, p: Linear) -> None:
    """The derivatives by v of flights that are not soon over; those by tau become 0."""
    square = p.stiffness - p.damping * p.damping / 4
    rate = abs(square) ** 0.5
    for k in range(LANES):
        far, by_tau, by_tau_dot = p.fastest * lane[TIME + k] >= SOON, lane[BY_TAU + k], lane[BY_TAU_DOT + k]
        lane[BY_TAU + k], lane[BY_TAU_DOT + k] = 0.0 if far else by_tau, 0.0 if far else by_tau_dot
    if not square > 0:
        for k in range(LANES):
            if p.fastest * lane[TIME + k] >= SOON:
                lane[FREE + k], lane[SLOPE + k] = free_motion(lane[TIME + k], p)
        return
    for k in range(LANES):
        lane[GROWTH + k] = 1.0
    if p.damping != 0:
        for k in range(LANES):
            lane[GROWTH + k] = exp(-p.damping / 2 * lane[TIME + k])
    for k in range(LANES):
        far = p.fastest * lane[TIME + k] >= SOON
        angle, rest = product_twice(rate, 0.0, lane[TIME + k], 0.0)
        c, s = quarters(angle, rest)
        free, slope = lane[FREE + k], lane[SLOPE + k]
        swung_free, swung_slope = swung(c, s, lane[GROWTH + k], rate, p)
        lane[FREE + k], lane[SLOPE + k] = swung_free if far else free, swung_slope if far else slope


def respond_near_resonance(lane: Array, wave: Array, launch: Array, reach: float, p: Linear) -> None:
    """The derivatives of flights that are near a resonance."""
    wide = widest(p)
    for k in range(LANES):
        time = lane[TIME + k]
        if lane[MODE + k] != 1.0 or p.fastest * time < SOON or min(time, wide) > reach:
            continue
        for j in range(len(p.waves)):
            launch[2 * j], launch[2 * j + 1] = wave[j, k], wave[len(p.waves) + j, k]
        lane[FREE + k], lane[SLOPE + k], lane[BY_TAU + k], lane[BY_TAU_DOT + k] = response_of_differences(
            launch, time, p
        )


def judge_hits(lane: Array, X: Array, model: Model) -> None:
    """Columns of the hits in the rows of X; one whose errors its conditions do not explain is handed over."""
    p, rules = model.numbers, model.rules
    wide, strength = widest(p), strength_of(p)
    for k in range(LANES):
        lane[GROWTH + k] = 1.0
    if p.damping < 0 or p.stiffness < 0:
        for k in range(LANES):
            lane[GROWTH + k] = growth(lane[TIME + k], p)
    for k in range(LANES):
        v, time, u, e = lane[V + k], lane[TIME + k], lane[SPEED + k], lane[THERE + k]
        variation = lane[FREE + k], lane[SLOPE + k], lane[BY_TAU + k], lane[BY_TAU_DOT + k]
        condition, velocity_condition, time_by_tau, time_by_v, velocity_by_tau, velocity_by_v = at_the_hit(
            max(abs(lane[AT + k]), time), v, time, u, e, variation
        )
        reach = min(time, wide)
        largest = (abs(v) + p.fastest * lane[HEIGHT + k] + strength * reach) * lane[GROWTH + k]
        late, off = rounded(time, u, e, largest * reach, largest, p.fastest, rules.likely)
        rough = is_rough(late, off, condition, velocity_condition, rules)
        # as in `hits.linear_hit`
        risen = (lane[HEIGHT + k] > 0) | (lane[SIDE + k] < 0)
        rough = rough & ((time > model.table.step) | (lane[ACC + k] >= 0) | risen)
        lane[MODE + k] = 2.0 if rough & (lane[MODE + k] == 1.0) else lane[MODE + k]
        X[FLIGHT_TIME, k], X[VELOCITY, k] = time, u
        X[CONDITION, k], X[VELOCITY_CONDITION, k] = condition, velocity_condition
        X[TIME_ERROR, k], X[VELOCITY_ERROR, k] = late + UNIT, off + UNIT
        X[TIME_BY_TAU, k], X[TIME_BY_V, k] = time_by_tau, time_by_v
        X[VELOCITY_BY_TAU, k], X[VELOCITY_BY_V, k] = velocity_by_tau, velocity_by_v
