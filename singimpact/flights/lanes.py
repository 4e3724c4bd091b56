"""Orbits of many states in lock-step lanes, as kernel text: `strides`, sixteen abreast, so that one instruction serves
many lanes.  A lane that needs more than a plain crossing is handed to `stride`.
"""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from typing import Any


def lanes(
    tau: Any, v: Any, count: int, w: Any, phases: Any, launch: Any, order: int, terms: int, horizon: float, ulp: float,
    p: Any, step: float, table: Any, bound: Any, X: Any, W: Any, q: Any, status: Any,
) -> None:  # fmt: skip
    """Fly `count` impacts from every state; tau, v become the last states, status what ended an orbit, 0 otherwise.

    The number of states is a multiple of 16.
    """
    waves, size, last = (len(p) - 5) // 3, 16, len(table) - 1
    c, s, acc = empty((waves + 1, size)), empty((waves + 1, size)), empty(size)
    state, polynomial = empty((8, size)), empty((order + 1, size))
    mode, place = empty(size), empty(size)
    since, lost = empty(size), empty(size)
    for b in range(0, len(v), size):
        for k in range(size):
            since[k], lost[k] = 0.0, 0.0
        for _ in range(count):
            alive = 0
            for k in range(size):
                acc[k] = p[3]
                mode[k] = 0.0 if status[b + k] == 0 else 3.0
                alive += status[b + k] == 0
            if alive == 0:
                break
            for j in range(waves):
                for k in range(size):
                    angle = p[5 + 3 * j] * (tau[b + k] + since[k]) + phases[j]
                    c[j, k], s[j, k] = cos(angle), sin(angle)
                    acc[k] += p[6 + 3 * j] * c[j, k] + p[7 + 3 * j] * s[j, k]
            walk(v[b : b + size], acc, c, s, p, step, last, ulp, table, bound, state, mode, place)
            crossed(c, s, p, step, order, table, bound, state, polynomial, mode, place)
            for k in range(size):
                if mode[k] == 3.0:
                    continue
                time, velocity = place[k] * step + state[0, k], state[1, k]
                if mode[k] != 1.0 or time > horizon:
                    for j in range(waves):
                        launch[2 * j], launch[2 * j + 1] = c[j, k], s[j, k]
                    code, time, velocity, _depth, _error = stride(
                        launch, v[b + k], acc[k], order, terms, horizon, ulp, p, step, table, bound, X, W, q
                    )
                    if code != 0:
                        status[b + k] = code
                        continue
                part = time - lost[k]
                total = since[k] + part
                lost[k] = (total - since[k]) - part
                since[k] = total
                v[b + k] = rebound(velocity, w)
                if not v[b + k] > 0:
                    status[b + k] = 8
        for k in range(size):
            tau[b + k] += since[k]


def walk(
    v: Any, acc: Any, c: Any, s: Any, p: Any, step: float, last: int, ulp: float, table: Any, bound: Any, state: Any,
    mode: Any, place: Any,
) -> None:  # fmt: skip
    """All lanes go on while their strides hold no root; mode 1: a plain crossing in the stride, 2: ask `stride`."""
    size = 16
    waves = (len(p) - 5) // 3
    z, u, e, z1, u1, e1 = empty(size), empty(size), empty(size), empty(size), empty(size), empty(size)
    h2 = step * step / 20.0
    fourth, sixth = step * step / 8.0, step * step * step * step * step * step / 46080.0
    damping, stiffness = p[1], p[2]
    g3, g4, g5, f0, f1, f2 = bound[3], bound[4], bound[5], bound[0], bound[1], bound[2]
    for k in range(size):
        z[k], u[k], e[k] = 0.0, v[k], acc[k] - damping * v[k]
        place[k] = 0.0
    for m in range(last):
        r1, r2, r4, r5, r7 = table[m + 1, 1], table[m + 1, 2], table[m + 1, 4], table[m + 1, 5], table[m + 1, 7]
        push, first = p[3], m == 0
        for k in range(size):
            z1[k], u1[k], e1[k] = v[k] * r1 + r2, v[k] * r4 + r5, push
        for j in range(waves):
            at = 8 + 8 * j
            t0, t1, t2 = table[m + 1, at], table[m + 1, at + 1], table[m + 1, at + 2]
            t3, t4, t5 = table[m + 1, at + 3], table[m + 1, at + 4], table[m + 1, at + 5]
            for k in range(size):
                z1[k] += c[j, k] * t0 + s[j, k] * t1
                u1[k] += c[j, k] * t2 + s[j, k] * t3
                e1[k] += c[j, k] * t4 + s[j, k] * t5
        going = 0.0
        for k in range(size):
            e1[k] -= damping * u1[k] + stiffness * z1[k]
            b1, b4 = z[k] + step * u[k] * 0.2, z1[k] - step * u1[k] * 0.2
            b2, b3 = z[k] + step * u[k] * 0.4 + h2 * e[k], z1[k] - step * u1[k] * 0.4 + h2 * e1[k]
            noise = 4.0 * ulp * (abs(v[k] * r1) + r7)
            room = 2.3 * sixth * (g3 * abs(z[k]) + g4 * abs(u[k]) + g5) + noise
            bend = fourth * (f0 * abs(z[k]) + f1 * abs(u[k]) + f2)
            above = (z[k] > room) | first
            clear = (b1 > room) & (b2 > room) & (b3 > room) & (b4 > room) & (z1[k] > room) & above
            convex = (e[k] > bend) & (e1[k] > bend)
            concave = (e[k] < -bend) & (e1[k] < -bend)
            steepest = abs(e[k]) if abs(e[k]) > abs(e1[k]) else abs(e1[k])
            falls = u[k] + u1[k] + step * (steepest + bend) < 0
            rises = (u1[k] <= 0) | (u[k] >= 0)
            free = (z1[k] > room) & above & (concave | falls | (convex & rises))
            start = convex & first
            running = mode[k] == 0.0
            go = running & (clear | free | start)
            plain = running & (not go) & (not first) & above & (z1[k] < -room) & (concave | convex | falls)
            stop = running & (not go)
            mode[k] = (1.0 if plain else 2.0) if stop else mode[k]
            state[2, k] = z[k] if stop else state[2, k]
            state[3, k] = u[k] if stop else state[3, k]
            state[4, k] = e[k] if stop else state[4, k]
            state[5, k] = z1[k] if stop else state[5, k]
            state[6, k] = u1[k] if stop else state[6, k]
            state[7, k] = e1[k] if stop else state[7, k]
            place[k] += 1.0 if go else 0.0
            going += 1.0 if go else 0.0
            z[k], u[k], e[k] = z1[k], u1[k], e1[k]
        if going == 0.0:
            return
    for k in range(size):
        mode[k] = 2.0 if mode[k] == 0.0 else mode[k]


def crossed(
    c: Any, s: Any, p: Any, step: float, order: int, table: Any, bound: Any, state: Any, X: Any, mode: Any, place: Any
) -> None:
    """Newton's method for the lanes in mode 1: state[0] is the time in the stride, state[1] the velocity."""
    size = 16
    waves = (len(p) - 5) // 3
    x, x2 = empty(size), empty(size)
    E0, E1, E2, O0, O1, O2 = empty(size), empty(size), empty(size), empty(size), empty(size), empty(size)
    for i in range(2, order + 1):
        for k in range(size):
            X[i, k] = 0.0
    for k in range(size):
        X[0, k], X[1, k], X[2, k] = state[2, k], state[3, k], p[3]
    for j in range(waves):
        at, rate = 8 + 8 * j, p[5 + 3 * j]
        for k in range(size):
            m = int(place[k])
            cosine = c[j, k] * table[m, at + 6] - s[j, k] * table[m, at + 7]
            sine = s[j, k] * table[m, at + 6] + c[j, k] * table[m, at + 7]
            E0[k] = p[6 + 3 * j] * cosine + p[7 + 3 * j] * sine
            O0[k] = rate * (p[7 + 3 * j] * cosine - p[6 + 3 * j] * sine)
        square = -rate * rate
        for i in range(2, order, 2):
            for k in range(size):
                X[i, k] += E0[k]
                X[i + 1, k] += O0[k]
                E0[k] *= square
                O0[k] *= square
        for k in range(size):
            X[order, k] += E0[k]
    damping, stiffness = p[1], p[2]
    for i in range(2, order + 1):
        for k in range(size):
            X[i, k] -= damping * X[i - 1, k] + stiffness * X[i - 2, k]
    for i in range(2, order + 1):
        factor = bound[6 + i]
        for k in range(size):
            X[i, k] *= factor
    for k in range(size):
        z, rise = state[2, k], state[5, k] - state[2, k]
        d0, d1 = step * state[3, k], step * state[6, k]
        c0, c1 = step * step * state[4, k] * 0.5, step * step * state[7, k] * 0.5
        a3, a4 = 10 * rise - 6 * d0 - 4 * d1 - 3 * c0 + c1, -15 * rise + 8 * d0 + 7 * d1 + 3 * c0 - 2 * c1
        a5 = 6 * rise - 3 * d0 - 3 * d1 - c0 + c1
        y = -z / rise
        for _ in range(3):
            value = z + y * (d0 + y * (c0 + y * (a3 + y * (a4 + y * a5))))
            slope = d0 + y * (2 * c0 + y * (3 * a3 + y * (4 * a4 + y * 5 * a5)))
            y = y - value / slope if slope < 0 else y
            y = y if y > 0 else 0.0
            y = y if y < 1 else 1.0
        x[k] = y * step
    for turn in range(3):
        for k in range(size):
            x2[k] = x[k] * x[k]
            E0[k], E1[k], E2[k], O0[k], O1[k], O2[k] = X[order, k], 0.0, 0.0, 0.0, 0.0, 0.0
        for i in range(order - 2, -1, -2):
            for k in range(size):
                O2[k] = O2[k] * x2[k] + O1[k]
                O1[k] = O1[k] * x2[k] + O0[k]
                O0[k] = O0[k] * x2[k] + X[i + 1, k]
                E2[k] = E2[k] * x2[k] + E1[k]
                E1[k] = E1[k] * x2[k] + E0[k]
                E0[k] = E0[k] * x2[k] + X[i, k]
        for k in range(size):
            z = E0[k] + x[k] * O0[k]
            u = O0[k] + 2 * (x[k] * E1[k] + x2[k] * O1[k])
            e = 2 * (E1[k] + 4 * x2[k] * E2[k]) + x[k] * (6 * O1[k] + 8 * x2[k] * O2[k])
            shift = -z / u
            if turn < 2:
                shift = shift / (1 + shift * e / (2 * u))
                inside = (u < 0) & (x[k] + shift >= 0) & (x[k] + shift <= step)
                near = (abs(shift * e) < -1e-6 * u) & (abs(shift) < 1e-6 * step)
                good = inside & ((turn == 0) | near)
                mode[k] = 2.0 if (mode[k] == 1.0) & (not good) else mode[k]
            state[1, k] = u + e * shift
            x[k] = x[k] + shift
    for k in range(size):
        state[0, k] = x[k]
