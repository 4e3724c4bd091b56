"""Orbits of many states in lock-step lanes, as kernel text: `strides`, sixty-four abreast, so that one instruction
serves eight lanes.  A lane that needs more than a plain crossing is handed to `stride`.

What a lane knows stands in rows of one array, `lane[ROW + k]`: the compiler then sees that rows do not overlap.  Loops
over lanes count to a constant too large to be unrolled, and sum integers: both keep them vectors.
"""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from typing import Any

LANES = 64
ROWS = (
    "V", "ACC", "SIZE", "SINCE", "LOST", "TURNS", "MODE", "PLACE", "TIME", "SPEED",
    "Z0", "U0", "E0", "Z1", "U1", "E1", "ROOM",
)  # fmt: skip
"""v, a_c and the size of its terms at the launch; time since the start with what its sum has lost and whole periods
taken off; what becomes of the flight (0 flies, 1 a plain crossing, 2 ask `stride`, 3 over), the stride it is in, the
hit; x - c, x' and x'' at both ends of that stride, what x - c must exceed."""
CONSTANTS = "\n".join([f"LANES = {LANES}", *(f"{name} = {LANES * at}" for at, name in enumerate(ROWS))])


def lanes(
    tau: Any, v: Any, count: int, w: Any, p: Any, low: Any, phases: Any, turn: Any, step: float, table: Any,
    bound: Any, series: Any, slow: Any, order: int, terms: int, horizon: float, ulp: float, lane: Any, wave: Any,
    local: Any, X: Any, launch: Any, Y: Any, W: Any, q: Any, status: Any,
) -> None:  # fmt: skip
    """Fly `count` impacts from every state; tau, v become the last states, status what ended an orbit, 0 otherwise.

    Parameters
    ----------
    tau, v : as many as a multiple of `LANES`. w : constants of rho. p, low, phases : as in `pull`.
    turn : a period of the waves in two parts, the first of 33 bits, and how many there are in a unit of time; or 0s.
    step, table, bound, series : the lanes' table. slow : step, table, bound of `stride`.
    lane, wave, local, X : room for `ROWS`, the waves at the launches and at the strides of the hits, Taylor
        coefficients. launch, Y, W, q : room for `stride`.
    """
    for b in range(0, len(v), LANES):
        for k in range(LANES):
            lane[V + k], lane[SINCE + k], lane[LOST + k], lane[TURNS + k] = v[b + k], 0.0, 0.0, 0.0
            lane[MODE + k] = 0.0 if status[b + k] == 0 else 3.0
        for _ in range(count):
            phased(b, tau, lane, wave, p, low, phases, step)
            if walk(lane, wave, p, step, len(table) - 1, ulp, table, bound) == 0:
                break
            turned_to(lane, wave, local, table)
            expanded(lane, local, series, X)
            guess(lane, step)
            polish(lane, X, step, horizon)
            for k in range(LANES):
                if lane[MODE + k] != 2.0:
                    continue
                a = pull(tau[b + k] + lane[SINCE + k], late(tau[b + k], lane[SINCE + k], lane[LOST + k]), p, low,
                         phases, launch)  # fmt: skip
                code, lane[TIME + k], lane[SPEED + k], _depth, _error = stride(
                    launch, lane[V + k], a, order, terms, horizon, ulp, p, slow[0], slow[1], slow[2], Y, W, q
                )
                if code != 0:
                    status[b + k], lane[MODE + k] = code, 3.0
            for k in range(LANES):
                v[b + k] = v[b + k] if lane[MODE + k] == 3.0 else rebound(lane[SPEED + k], w)
            for k in range(LANES):
                if lane[MODE + k] != 3.0 and not v[b + k] > 0:
                    status[b + k] = 8
            landed(b, v, lane, turn)
            for k in range(LANES):
                lane[MODE + k] = 0.0 if status[b + k] == 0 else 3.0
        for k in range(LANES):
            tau[b + k] += (lane[SINCE + k] - lane[LOST + k]) + lane[TURNS + k] * (turn[0] + turn[1])


def landed(b: int, v: Any, lane: Any, turn: Any) -> None:
    """Times since the start move on, compensated; whole periods are taken off, so that phases keep their digits."""
    for k in range(LANES):
        part = (lane[TIME + k] if lane[MODE + k] != 3.0 else 0.0) - lane[LOST + k]
        total = lane[SINCE + k] + part
        lost = (total - lane[SINCE + k]) - part
        n = (total * turn[2] + 6755399441055744.0) - 6755399441055744.0
        lane[SINCE + k], lane[LOST + k] = total - n * turn[0], lost + n * turn[1]
        lane[TURNS + k] += n
        lane[V + k] = v[b + k]


def phased(b: int, tau: Any, lane: Any, wave: Any, p: Any, low: Any, phases: Any, step: float) -> None:
    """`pull` for all lanes; one whose slow return needs more than doubles say of a_c is handed over."""
    for k in range(LANES):
        lane[ACC + k], lane[SIZE + k] = p[3], abs(p[3])
    for j in range((len(p) - 5) // 3):
        rate, rate_low, phase, phase_low = p[5 + 3 * j], low[5 + 3 * j], phases[0, j], phases[1, j]
        by_cos, by_sin, c, s = p[6 + 3 * j], p[7 + 3 * j], 2 * j, 2 * j + 1
        for k in range(LANES):
            t = tau[b + k] + lane[SINCE + k]
            angle, rest = phase_of(
                t, late(tau[b + k], lane[SINCE + k], lane[LOST + k]), rate, rate_low, phase, phase_low
            )
            lane[MODE + k] = 2.0 if (lane[MODE + k] == 0.0) & (abs(angle) > 1e6) else lane[MODE + k]
            n = (angle * 0.6366197723675814 + 6755399441055744.0) - 6755399441055744.0
            quarter = n - 4 * ((n * 0.25 + 6755399441055744.0) - 6755399441055744.0)
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
