"""Steps of a batch: each state goes on while its step holds no root, by the quintic p through both ends of the step
(its x, x', x'') and the bounds of Hermite interpolation

    |x - p| <= M h^6/46080,   |x' - p'| <= M h^5 sqrt(5)/30000,   |x'' - p''| <= M h^4/1920,   M >= |x^(6)|

on the Bernstein coefficients of p, p', p''.
"""

from math import inf

from singimpact.flights.kernels.state import (
    A_COS,
    A_SIN,
    ACC,
    BOUND,
    COSINE,
    E0,
    E1,
    HEIGHT,
    LANES,
    MODE,
    PLACE,
    RATE,
    SINE,
    SIZE_STEADY,
    SIZE_X,
    U0,
    U1,
    V_BY_V,
    V_BY_X,
    V_COS,
    V_SIN,
    V_STEADY,
    WALL,
    X_BY_V,
    X_BY_X,
    X_COS,
    X_SIN,
    X_STEADY,
    Z0,
    Z1,
    Array,
    Batch,
    Linear,
    Mirror,
    Table,
    V,
)


def isolate(batch: Batch, p: Linear, ulp: float, gap: float) -> int:
    """The number of states that fly; each then stands before a root (mode 1, or 4 of x - c = gap) or is left to
    `tabulated_flight` (2).
    """
    lane, wave, table, launched = batch.lane, batch.wave, batch.table, batch.launched
    step, last, jerk, highest = table.step, len(table.rows) - 1, 0.0, 0.0
    # 2.3: on the first stride the remainder is compared with a multiple of the distance from the launch
    sixth = 2.3 * step * step * step * step * step * step / 46080.0
    by_x, by_u = sixth * table.sixth[0], sixth * table.sixth[1]
    mirror, steady = batch.mirror, sixth * max(table.sixth[2], batch.mirror.table.sixth[2])
    for j in range(len(p.waves)):
        jerk += p.waves[j, RATE] * (abs(p.waves[j, COSINE]) + abs(p.waves[j, SINE]))
    flying = 0
    for k in range(LANES):
        lane[Z0 + k], lane[U0 + k], lane[E0 + k] = 0.0, lane[V + k], lane[ACC + k] - p.damping * lane[V + k]
        lane[PLACE + k] = 0.0
        flying += 1 if lane[MODE + k] != 3.0 else 0
    if launched < 0:
        highest = lift_starts(lane, p)
    for m in range(last):
        ahead(lane, wave, p, table, mirror, m + 1)
        row = table.rows[m + 1]
        if launched < 0:
            lift(lane, p, row)
        by_v, size = 4 * ulp * abs(row[X_BY_V]), max(row[SIZE_STEADY], mirror.table.rows[m + 1, SIZE_STEADY])
        rest = 4 * ulp * (size + highest * row[SIZE_X]) + steady
        if gap < inf:
            watch_other_wall(lane, step, gap, by_x, by_u, by_v, rest)
        going, doubtful = go_on(lane, step, by_x, by_u, by_v, rest)
        if doubtful > 0:
            going += judge_steps(lane, step, jerk, p, launched)
        if going == 0:
            break
    for k in range(LANES):
        lane[MODE + k] = 2.0 if lane[MODE + k] == 0.0 else lane[MODE + k]
    return flying


def ahead(lane: Array, wave: Array, p: Linear, table: Table, mirror: Mirror, m: int) -> None:
    """x - c, x' and x'' of the states that go on, m steps after their launch."""
    damping, stiffness, row = p.damping, p.stiffness, table.rows[m]
    z_by_v, u_by_v, z_rest, u_rest = row[X_BY_V], row[V_BY_V], row[X_STEADY], row[V_STEADY]
    z_other, u_other = mirror.table.rows[m, X_STEADY], mirror.table.rows[m, V_STEADY]
    e_by_v, e_rest = -damping * u_by_v - stiffness * z_by_v, p.steady - damping * u_rest - stiffness * z_rest
    e_other = mirror.steady - damping * u_other - stiffness * z_other
    for k in range(LANES):
        # what `if` chooses from is computed first: a choice between computations would become slow masked stores
        go, v, z, u, e = lane[MODE + k] == 0.0, lane[V + k], lane[Z1 + k], lane[U1 + k], lane[E1 + k]
        here = lane[WALL + k] > 0
        z1 = v * z_by_v + (z_rest if here else z_other)
        u1 = v * u_by_v + (u_rest if here else u_other)
        e1 = v * e_by_v + (e_rest if here else e_other)
        lane[Z1 + k], lane[U1 + k], lane[E1 + k] = z1 if go else z, u1 if go else u, e1 if go else e
    for j in range(len(p.waves)):
        turn, c, s = table.waves[m][j], j, len(p.waves) + j
        z_by_c, z_by_s, u_by_c, u_by_s = turn[X_COS], turn[X_SIN], turn[V_COS], turn[V_SIN]
        e_by_c = turn[A_COS] - damping * u_by_c - stiffness * z_by_c
        e_by_s = turn[A_SIN] - damping * u_by_s - stiffness * z_by_s
        for k in range(LANES):
            go, cosine, sine = lane[MODE + k] == 0.0, wave[c, k], wave[s, k]
            z, u = cosine * z_by_c + sine * z_by_s, cosine * u_by_c + sine * u_by_s
            e = cosine * e_by_c + sine * e_by_s
            lane[Z1 + k] += z if go else 0.0
            lane[U1 + k] += u if go else 0.0
            lane[E1 + k] += e if go else 0.0


def lift_starts(lane: Array, p: Linear) -> float:
    """The largest height; every state starts at its own."""
    highest = 0.0
    for k in range(LANES):
        height = lane[HEIGHT + k]
        lane[Z0 + k] = height
        lane[E0 + k] -= p.stiffness * height
        highest = height if height > highest else highest
    return highest


def lift(lane: Array, p: Linear, row: Array) -> None:
    """`ahead` of states that start at a height."""
    by_z, by_u = row[X_BY_X], row[V_BY_X]
    by_e = -p.damping * by_u - p.stiffness * by_z
    for k in range(LANES):
        height = lane[HEIGHT + k] if lane[MODE + k] == 0.0 else 0.0
        lane[Z1 + k] += height * by_z
        lane[U1 + k] += height * by_u
        lane[E1 + k] += height * by_e


def watch_other_wall(lane: Array, step: float, gap: float, by_x: float, by_u: float, by_v: float, rest: float) -> None:
    """States that may come to x - c = gap on their step: mode 4 where x rises through it, else 2.

    The differences of the Bernstein coefficients are those of x': x rises where they are above `room`, and is concave
    where their differences are below it, see `judge_steps`. A concave x that is above the gap in the middle of the step
    has risen through it once before.
    """
    fifth, twentieth = step * 0.2, step * step / 20.0
    for k in range(LANES):
        z0, u0, e0 = lane[Z0 + k], lane[U0 + k], lane[E0 + k]
        z1, u1, e1 = lane[Z1 + k], lane[U1 + k], lane[E1 + k]
        b1, b4 = z0 + fifth * u0, z1 - fifth * u1
        b2, b3 = 2 * b1 - z0 + twentieth * e0, 2 * b4 - z1 + twentieth * e1
        low, high = (b1 if b1 > b2 else b2), (b3 if b3 > b4 else b4)
        high = high if high > low else low
        high = high if high > z1 else z1
        room = by_x * abs(z0) + by_u * abs(u0) + by_v * abs(lane[V + k]) + rest
        rises = (b1 > z0) & (b2 - b1 > room) & (b3 - b2 > room) & (b4 - b3 > room) & (z1 - b4 > room)
        rises = rises & ((b1 - z0 > room) | (z0 == 0.0)) & (z0 < gap - room) & (z1 > gap + room)
        concave = (twentieth * e0 < -room) & (b3 - 2 * b2 + b1 < -room) & (b4 - 2 * b3 + b2 < -room)
        concave = concave & (twentieth * e1 < -room) & (z0 < gap - room)
        half = (z0 + 5 * b1 + 10 * b2 + 10 * b3 + 5 * b4 + z1) / 32
        near = (lane[MODE + k] == 0.0) & (not (high < gap - room))
        kind = 4.0 if rises | (concave & (half > gap + 5 * room)) else 2.0
        lane[MODE + k] = kind if near else lane[MODE + k]


def go_on(lane: Array, step: float, by_x: float, by_u: float, by_v: float, rest: float) -> tuple[int, int]:
    """The number of states that go on, by the Bernstein coefficients of p alone, and of the doubtful ones: mode -1."""
    fifth, twentieth = step * 0.2, step * step / 20.0
    going, doubtful = 0, 0
    for k in range(LANES):
        z0, u0, e0 = lane[Z0 + k], lane[U0 + k], lane[E0 + k]
        z1, u1, e1 = lane[Z1 + k], lane[U1 + k], lane[E1 + k]
        b1, b4 = z0 + fifth * u0, z1 - fifth * u1
        b2, b3 = 2 * b1 - z0 + twentieth * e0, 2 * b4 - z1 + twentieth * e1
        low, high = (b1 if b1 < b2 else b2), (b3 if b3 < b4 else b4)
        low = low if low < high else high
        low = low if low < z1 else z1
        room = by_x * abs(z0) + by_u * abs(u0) + by_v * abs(lane[V + k]) + rest
        lane[BOUND + k] = room
        # nan is doubtful
        flies, go = lane[MODE + k] == 0.0, (lane[MODE + k] == 0.0) & (low > room)
        going += 1 if go else 0
        doubtful += 1 if flies & (not go) else 0
        lane[MODE + k] = -1.0 if flies & (not go) else lane[MODE + k]
        lane[PLACE + k] += 1.0 if go else 0.0
        lane[Z0 + k], lane[U0 + k], lane[E0 + k] = z1 if go else z0, u1 if go else u0, e1 if go else e0
    return going, doubtful


def judge_steps(lane: Array, step: float, jerk: float, p: Linear, first: float) -> int:
    """The number of doubtful states that go on after all; the others stand before a root or are handed over.

    The differences d and c of the Bernstein coefficients are those of p' and p''; `room` covers their bounds too.  When
    at most one d is neither clearly > 0 before nor clearly < 0 after, x rises, stays within 3 room, and falls: what
    comes above 4 room meets no root if it ends above and one if it ends below.

    At a launch x = 0 and x' = v are exact.  |x' - p'| <= min(sqrt(5)/30000, y/1920) M h^5 at t = y h is below the room
    of all d but the first, times the sum of their Bernstein polynomials: d_0 > 0 is clear.  A launch with x'' = e < 0
    stays concave up to t = 4 v/|e|, and is below the wall there, if |x^(3)| <= J until then and 8 v J <= e^2.

    Parameters
    ----------
    jerk : the largest derivative of the force. first : see `Batch.launched`.
    """
    # the control points: b0 = x, b1 = x + h x'/5, b2 = x + 2 h x'/5 + h^2 x''/20, and the same from the other end
    fifth, twentieth, going = step * 0.2, step * step / 20.0, 0
    damping, stiffness = abs(p.damping), abs(p.stiffness)
    for k in range(LANES):
        z0, u0, e0 = lane[Z0 + k], lane[U0 + k], lane[E0 + k]
        z1, u1, e1 = lane[Z1 + k], lane[U1 + k], lane[E1 + k]
        v, room, launched = lane[V + k], lane[BOUND + k], lane[PLACE + k] == first
        d0, d4, c0, c3 = fifth * u0, fifth * u1, twentieth * e0, twentieth * e1
        b1, b4, d1, d3 = z0 + d0, z1 - d4, d0 + c0, d4 - c3
        b2, b3 = b1 + d1, b4 - d3
        d2 = b3 - b2
        c1, c2 = d2 - d1, d3 - d2
        clear = (b1 > room) & (b2 > room) & (b3 > room) & (b4 > room) & ((z0 > room) | launched)
        concave = (c0 < -room) & (c1 < -room) & (c2 < -room) & (c3 < -room)
        convex = (c0 > room) & (c1 > room) & (c2 > room) & (c3 > room)
        up_then_down = ((d0 > room) | (d1 < -room) | launched) & ((d1 > room) | (d2 < -room))
        up_then_down = up_then_down & ((d2 > room) | (d3 < -room)) & ((d3 > room) | (d4 < -room))
        # p after a quarter and half of the step
        quarter = (243 * z0 + 405 * b1 + 270 * b2 + 90 * b3 + 15 * b4 + z1) / 1024
        half = (z0 + 5 * b1 + 10 * b2 + 10 * b3 + 5 * b4 + z1) / 32
        high = (z0 > 4 * room) | (launched & ((quarter > 5 * room) | (half > 5 * room)))
        rises = (up_then_down & high) | (concave & ((z0 > room) | launched))
        bound = jerk + 2 * damping * abs(e0) + 5 * stiffness * v
        pressed = launched & (8 * v * bound <= e0 * e0) & (4 * v <= -e0 * step)
        single = pressed | ((rises | (convex & (z0 > room))) & (z1 < -room))
        go = (lane[MODE + k] == -1.0) & (((z1 > room) & (clear | rises)) | (convex & launched)) & (not pressed)
        kind = 0.0 if go else 1.0 if single else 2.0
        lane[MODE + k] = kind if lane[MODE + k] == -1.0 else lane[MODE + k]
        going += 1 if go else 0
        lane[PLACE + k] += 1.0 if go else 0.0
        lane[Z0 + k], lane[U0 + k], lane[E0 + k] = z1 if go else z0, u1 if go else u0, e1 if go else e0
    return going
