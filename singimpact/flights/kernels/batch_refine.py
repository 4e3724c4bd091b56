"""Roots of a batch: of x - c, or of (x - c)/t on the first step, where t = 0 is no hit.

One step of Halley's method from the root of the quintic leaves an error of 1e-9 steps at most, or the state is handed
over; the second step then is exact to rounding.
"""

from singimpact.flights.kernels.state import (
    BATCH_ORDER,
    E0,
    E1,
    LANES,
    MODE,
    PLACE,
    SIDE,
    SPEED,
    TIME,
    TURN_COS,
    TURN_SIN,
    U0,
    U1,
    WALL,
    Z0,
    Z1,
    Array,
    Batch,
    Mirror,
)


def turn_waves(lane: Array, wave: Array, local: Array, turns: Array) -> None:
    """The waves at the start of the step that holds the root."""
    count = len(wave) // 2
    for j in range(count):
        c, s = j, count + j
        for k in range(LANES):
            m = int(lane[PLACE + k])
            local[c, k], local[s, k] = turns[m, j, TURN_COS], turns[m, j, TURN_SIN]
        for k in range(LANES):
            turn_c, turn_s = local[c, k], local[s, k]
            local[c, k] = wave[c, k] * turn_c - wave[s, k] * turn_s
            local[s, k] = wave[s, k] * turn_c + wave[c, k] * turn_s


def expand(lane: Array, local: Array, series: Array, mirror: Mirror, X: Array) -> None:
    """Taylor coefficients of x - c at the start of the step."""
    count = len(local) // 2
    for i in range(3, len(series)):
        by_z, by_u, rest, other = series[i, 0], series[i, 1], series[i, 2], mirror.series[i, 2]
        for k in range(LANES):
            X[i, k] = lane[Z0 + k] * by_z + lane[U0 + k] * by_u + (rest if lane[WALL + k] > 0 else other)
        for j in range(count):
            c, s, by_c, by_s = j, count + j, series[i, 3 + 2 * j], series[i, 4 + 2 * j]
            for k in range(LANES):
                X[i, k] += local[c, k] * by_c + local[s, k] * by_s
    for k in range(LANES):
        X[0, k], X[1, k] = lane[Z0 + k], lane[U0 + k]
        # known to full relative accuracy on the first step
        X[2, k] = 0.5 * lane[E0 + k]


def reflect_hits(lane: Array, X: Array, gap: float) -> None:
    """States that stand before a root of x - c = gap go on with x -> -x, as those of a lower wall; mode 4 becomes 1."""
    for k in range(LANES):
        over = lane[MODE + k] == 4.0
        side, lift = -1.0 if over else 1.0, gap if over else 0.0
        lane[SIDE + k], lane[MODE + k] = side, 1.0 if over else lane[MODE + k]
        lane[Z0 + k], lane[Z1 + k] = lift + side * lane[Z0 + k], lift + side * lane[Z1 + k]
        lane[U0 + k], lane[U1 + k] = side * lane[U0 + k], side * lane[U1 + k]
        lane[E0 + k], lane[E1 + k] = side * lane[E0 + k], side * lane[E1 + k]
    for i in range(BATCH_ORDER + 1):
        for k in range(LANES):
            X[i, k] *= lane[SIDE + k]
    for k in range(LANES):
        X[0, k] = lane[Z0 + k]


def quintic_guess(lane: Array, step: float, launched: float) -> None:
    """TIME becomes the root of the quintic on the step; launched : see `Batch`."""
    for k in range(LANES):
        first = (lane[PLACE + k] == launched) & (lane[SIDE + k] > 0)
        z0, rise = lane[Z0 + k], lane[Z1 + k] - lane[Z0 + k]
        d0, d1 = step * lane[U0 + k], step * lane[U1 + k]
        c0, c1 = step * step * lane[E0 + k] * 0.5, step * step * lane[E1 + k] * 0.5
        a3, a4 = 10 * rise - 6 * d0 - 4 * d1 - 3 * c0 + c1, -15 * rise + 8 * d0 + 7 * d1 + 3 * c0 - 2 * c1
        a5 = 6 * rise - 3 * d0 - 3 * d1 - c0 + c1
        y = -d0 / c0 if first else -z0 / rise
        z0, d0, c0 = (d0 if first else z0), (c0 if first else d0), (a3 if first else c0)
        a3, a4, a5 = (a4 if first else a3), (a5 if first else a4), (0.0 if first else a5)
        y = y if (y > 0) & (y < 1) else 0.5
        for _ in range(2):
            value = z0 + y * (d0 + y * (c0 + y * (a3 + y * (a4 + y * a5))))
            slope = d0 + y * (2 * c0 + y * (3 * a3 + y * (4 * a4 + y * 5 * a5)))
            bend = 2 * c0 + y * (6 * a3 + y * (12 * a4 + y * 20 * a5))
            # Halley's method: twice triples the digits of the secant, to six
            y -= 2 * value * slope / (2 * slope * slope - value * bend)
            y = y if y > 0 else 0.0
            y = y if y < 1 else 1.0
        lane[TIME + k] = y * step


def refine_roots(batch: Batch, step: float, horizon: float) -> None:
    """TIME and SPEED of the hit; a state whose steps are not as small as they must be is handed over."""
    lane = batch.lane
    halley_step(batch, step, 1e-2)
    # the error of the root becomes the cube of this, and that of the velocity its square
    halley_step(batch, step, 2e-8)
    for k in range(LANES):
        x = lane[TIME + k]
        lane[TIME + k] = lane[PLACE + k] * step + x
        good = (x > 0) & (x <= step) & (lane[TIME + k] <= horizon)
        lane[MODE + k] = 2.0 if (lane[MODE + k] == 1.0) & (not good) else lane[MODE + k]


def halley_step(batch: Batch, step: float, small: float) -> None:
    """A step of Halley's method for TIME, and SPEED there; it must be this small, in steps of the table."""
    lane, X, launched = batch.lane, batch.X, batch.launched
    for k in range(LANES):
        first = (lane[PLACE + k] == launched) & (lane[SIDE + k] > 0)
        x = lane[TIME + k]
        value, slope, bend = X[BATCH_ORDER, k], 0.0, 0.0
        for i in range(BATCH_ORDER - 1, 0, -1):
            bend = bend * x + slope
            slope = slope * x + value
            value = value * x + X[i, k]
        bend, slope, value = (
            bend if first else bend * x + slope, slope if first else slope * x + value,
            value if first else value * x + X[0, k],
        )  # fmt: skip
        scale = x if first else step
        change = -value / slope
        # bend is half the second derivative
        change = change / (1 + change * bend / slope)
        good = (slope < 0) & (abs(change * bend) < -small * slope) & (abs(change) < small * scale)
        x += change
        slope += 2 * bend * change
        lane[TIME + k], lane[SPEED + k] = x, slope * x if first else slope
        lane[MODE + k] = 2.0 if (lane[MODE + k] == 1.0) & (not good) else lane[MODE + k]
