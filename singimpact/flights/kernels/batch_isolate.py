"""Steps of a batch: each state goes on while its step holds no root, by the quintic p through both ends of the step
(its x, x', x'') and the bounds of Hermite interpolation

    |x - p| <= M h^6/46080,   |x' - p'| <= M h^5 sqrt(5)/30000,   |x'' - p''| <= M h^4/1920,   M >= |x^(6)|

on the Bernstein coefficients of p, p', p''.
"""

from __future__ import annotations

from typing import Any

from singimpact.flights.kernels.lanes import ACC, BOUND, E0, E1, LANES, MODE, PLACE, U0, U1, Z0, Z1, V
from singimpact.flights.kernels.state import (
    A_COS,
    A_SIN,
    SIZE_STEADY,
    V_BY_V,
    V_COS,
    V_SIN,
    V_STEADY,
    X_BY_V,
    X_COS,
    X_SIN,
    X_STEADY,
)


def isolate(lane: Any, wave: Any, p: Any, ulp: float, table: Any) -> int:
    """The number of states that fly; each then stands before a root (mode 1) or is left to `tabulated_flight` (2)."""
    step, last = table.step, len(table.rows) - 1
    # 2.3: on the first stride the remainder is compared with a multiple of the distance from the launch
    sixth = 2.3 * step * step * step * step * step * step / 46080.0
    by_x, by_u, steady = sixth * table.sixth[0], sixth * table.sixth[1], sixth * table.sixth[2]
    flying = 0
    for k in range(LANES):
        lane[Z0 + k], lane[U0 + k], lane[E0 + k] = 0.0, lane[V + k], lane[ACC + k] - p.damping * lane[V + k]
        lane[PLACE + k] = 0.0
        flying += 1 if lane[MODE + k] != 3.0 else 0
    for m in range(last):
        ahead(lane, wave, p, table, m + 1)
        row = table.rows[m + 1]
        by_v, rest = 4 * ulp * abs(row[X_BY_V]), 4 * ulp * row[SIZE_STEADY] + steady
        if doubtful(lane, step, by_x, by_u, by_v, rest) > 0:
            judged(lane, step, m == 0)
        going = 0
        for k in range(LANES):
            go = lane[MODE + k] == 0.0
            lane[PLACE + k] += 1.0 if go else 0.0
            lane[Z0 + k] = lane[Z1 + k] if go else lane[Z0 + k]
            lane[U0 + k] = lane[U1 + k] if go else lane[U0 + k]
            lane[E0 + k] = lane[E1 + k] if go else lane[E0 + k]
            going += 1 if go else 0
        if going == 0:
            break
    for k in range(LANES):
        lane[MODE + k] = 2.0 if lane[MODE + k] == 0.0 else lane[MODE + k]
    return flying


def ahead(lane: Any, wave: Any, p: Any, table: Any, m: int) -> None:
    """x - c, x' and x'' of the states that go on, m steps after their launch."""
    damping, stiffness, force, row = p.damping, p.stiffness, p.steady, table.rows[m]
    z_by_v, z_rest, u_by_v, u_rest = row[X_BY_V], row[X_STEADY], row[V_BY_V], row[V_STEADY]
    for k in range(LANES):
        go = lane[MODE + k] == 0.0
        lane[Z1 + k] = lane[V + k] * z_by_v + z_rest if go else lane[Z1 + k]
        lane[U1 + k] = lane[V + k] * u_by_v + u_rest if go else lane[U1 + k]
        lane[E1 + k] = force if go else lane[E1 + k]
    for j in range(len(p.waves)):
        turn, c, s = table.waves[m][j], 2 * j, 2 * j + 1
        z_by_c, z_by_s, u_by_c, u_by_s = turn[X_COS], turn[X_SIN], turn[V_COS], turn[V_SIN]
        e_by_c, e_by_s = turn[A_COS], turn[A_SIN]
        for k in range(LANES):
            go = lane[MODE + k] == 0.0
            lane[Z1 + k] += wave[c, k] * z_by_c + wave[s, k] * z_by_s if go else 0.0
            lane[U1 + k] += wave[c, k] * u_by_c + wave[s, k] * u_by_s if go else 0.0
            lane[E1 + k] += wave[c, k] * e_by_c + wave[s, k] * e_by_s if go else 0.0
    for k in range(LANES):
        lane[E1 + k] -= damping * lane[U1 + k] + stiffness * lane[Z1 + k] if lane[MODE + k] == 0.0 else 0.0


def doubtful(lane: Any, step: float, by_x: float, by_u: float, by_v: float, rest: float) -> int:
    """The number of states that cannot go on by the Bernstein coefficients of p alone."""
    fifth, twentieth = step * 0.2, step * step / 20.0
    count = 0
    for k in range(LANES):
        z0, z1 = lane[Z0 + k], lane[Z1 + k]
        b1, b4 = z0 + fifth * lane[U0 + k], z1 - fifth * lane[U1 + k]
        b2, b3 = 2 * b1 - z0 + twentieth * lane[E0 + k], 2 * b4 - z1 + twentieth * lane[E1 + k]
        low, high = (b1 if b1 < b2 else b2), (b3 if b3 < b4 else b4)
        low = low if low < high else high
        low = low if low < z1 else z1
        room = by_x * abs(z0) + by_u * abs(lane[U0 + k]) + by_v * lane[V + k] + rest
        lane[BOUND + k] = room
        # nan counts
        count += 0 if (low > room) | (lane[MODE + k] != 0.0) else 1
    return count


def judged(lane: Any, step: float, first: bool) -> None:
    """Set the mode of each state: 0 where it goes on.

    The differences d and c of the Bernstein coefficients are those of p' and p''; `room` covers their bounds too.  When
    at most one d is neither clearly > 0 before nor clearly < 0 after, x rises, stays within 3 room, and falls: what
    begins above 4 room meets no root if it ends above and one if it ends below.
    """
    # the control points: b0 = x, b1 = x + h x'/5, b2 = x + 2 h x'/5 + h^2 x''/20, and the same from the other end
    fifth, twentieth, launched = step * 0.2, step * step / 20.0, 1.0 if first else 0.0
    for k in range(LANES):
        z0, z1, room = lane[Z0 + k], lane[Z1 + k], lane[BOUND + k]
        d0, d4, c0, c3 = fifth * lane[U0 + k], fifth * lane[U1 + k], twentieth * lane[E0 + k], twentieth * lane[E1 + k]
        b1, b4, d1, d3 = z0 + d0, z1 - d4, d0 + c0, d4 - c3
        b2, b3 = b1 + d1, b4 - d3
        d2 = b3 - b2
        c1, c2 = d2 - d1, d3 - d2
        clear = (b1 > room) & (b2 > room) & (b3 > room) & (b4 > room) & ((z0 > room) | (launched == 1.0))
        concave = (c0 < -room) & (c1 < -room) & (c2 < -room) & (c3 < -room)
        convex = (c0 > room) & (c1 > room) & (c2 > room) & (c3 > room)
        up_then_down = ((d0 > room) | (d1 < -room)) & ((d1 > room) | (d2 < -room))
        up_then_down = up_then_down & ((d2 > room) | (d3 < -room)) & ((d3 > room) | (d4 < -room))
        single = (up_then_down & (z0 > 4 * room)) | (concave & ((z0 > room) | (launched == 1.0)))
        go = ((z1 > room) & (clear | single)) | (convex & (launched == 1.0))
        kind = 1.0 if (single | (convex & (z0 > room))) & (z1 < -room) else 2.0
        kind = 0.0 if go else kind
        lane[MODE + k] = kind if lane[MODE + k] == 0.0 else lane[MODE + k]
