"""One flight of a linear model in strides through a table of its closed form, as kernel text: `march`, made fast.

A stride is left behind when the Bernstein coefficients of the quintic through its ends exceed the remainder of the
interpolation; else a Taylor step from the table's state decides, and what that leaves open is asked of `march`.
"""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from typing import Any


def stride(
    launch: Any, v: float, acceleration: float, order: int, horizon: float, ulp: float, p: Any,
    step: float, table: Any, bound: Any, X: Any, W: Any, q: Any,
) -> Any:  # fmt: skip
    """(status, flight time, velocity, depth, bound), as `march` for v > 0.

    Parameters
    ----------
    step, table, bound : the step of the table, the table, bounds of x'''' and x^(6) over a step.
    """
    waves = (len(p) - 5) // 3
    last = len(table) - 1
    start, z0, u0, base = 0.0, 0.0, v, 0.0
    for j in range(waves):
        W[2 * j, 0], W[2 * j + 1, 0] = launch[2 * j], launch[2 * j + 1]
    sixth = step * step * step * step * step * step / 46080.0
    z, u, e = 0.0, v, acceleration - p[1] * v
    m = 0
    while True:
        if m == last:
            # the table ends: its last state is the next start, from the closed form and so without accumulated error
            start += last * step
            z0, u0, base = restart(launch, v, start, z, u, 0.0, ulp, p)
            for j in range(waves):
                turn_c, turn_s = cos(p[5 + 3 * j] * start), sin(p[5 + 3 * j] * start)
                W[2 * j, 0] = launch[2 * j] * turn_c - launch[2 * j + 1] * turn_s
                W[2 * j + 1, 0] = launch[2 * j + 1] * turn_c + launch[2 * j] * turn_s
            z, u, m = z0, u0, 0
            if not abs(z) < 1e100:
                return 5, start, u, z, base
        row = table[m + 1]
        z1 = z0 * row[0] + u0 * row[1] + row[2]
        u1 = z0 * row[3] + u0 * row[4] + row[5]
        push = p[3]
        for j in range(waves):
            c, s, at = W[2 * j, 0], W[2 * j + 1, 0], 8 + 8 * j
            z1 += c * row[at] + s * row[at + 1]
            u1 += c * row[at + 2] + s * row[at + 3]
            push += c * row[at + 4] + s * row[at + 5]
        e1 = push - p[1] * u1 - p[2] * z1
        b1, b4 = z + step * u * 0.2, z1 - step * u1 * 0.2
        b2, b3 = z + step * (0.4 * u + step * 0.05 * e), z1 - step * (0.4 * u1 - step * 0.05 * e1)
        noise = base + ulp * (abs(z0) * row[6] + abs(u0 * row[1]) + row[7])
        # 2.3: on the first stride the remainder is compared with a multiple of the distance from the launch
        room = 2.3 * sixth * (bound[3] * abs(z) + bound[4] * abs(u) + bound[5]) + 4.0 * noise
        lowest = min(min(b1, b2), min(b3, b4))
        time = start + m * step
        if not (lowest > room and z1 > room and (z > room or time == 0.0)):
            if time == 0.0:
                code, s, slope, depth, error = first_stride(v, acceleration, order, step, ulp, p, X, W, q)
            else:
                code, s, slope, depth, error = inner_stride(z, u, table[m], order, step, noise, ulp, p, X, W, q)
            if code == 2:
                return march(launch, v, 1, acceleration, order, horizon, ulp, p, X, W, q)
            if code == 1:
                if time + s > horizon:
                    return 3, time, u, z, noise
                return 0, time + s, slope, 0.0, 0.0
        if time + step >= horizon:
            return 3, time, u, z, noise
        z, u, e = z1, u1, e1
        m += 1


def first_stride(
    v: float, acceleration: float, order: int, step: float, ulp: float, p: Any, X: Any, W: Any, q: Any
) -> Any:
    """The first root of (x - c)/t on the first step; a low velocity is looked for near 2 v/|a| with few terms."""
    if acceleration < 0:
        near = -4 * v / acceleration
        if near < step / 4:
            code, s, slope, depth, error = launched(v, acceleration, order, near, ulp, p, X, W, q)
            if code != 0:
                return code, s, slope * s, depth * s, error * s
    code, s, slope, depth, error = launched(v, acceleration, order, step * 17 / 16, ulp, p, X, W, q)
    return code, s, slope * s, depth * s, error * s


def launched(v: float, acceleration: float, order: int, h: float, ulp: float, p: Any, X: Any, W: Any, q: Any) -> Any:
    """`first_root` of v + X_2 t + X_3 t^2 + ... on (0, h]."""
    waves = (len(p) - 5) // 3
    strength = abs(p[3]) + (p[4] + p[4] * p[4] * h) * v
    for j in range(waves):
        strength += abs(p[6 + 3 * j]) + abs(p[7 + 3 * j])
    n, term, turned = 2, strength * h * 0.5, p[4] * h
    while n < order and term > 1e-18 * v:
        n += 1
        term *= turned / n
    series(0.0, v, n, p, X, W)
    X[2] = (acceleration - p[1] * v) / 2
    for k in range(n):
        q[k] = X[k + 1]
    return first_root(q, n - 1, h, 0.0, ulp)


def inner_stride(
    z: float, u: float, row: Any, order: int, step: float, noise: float, ulp: float, p: Any, X: Any, W: Any, q: Any
) -> Any:
    """The first root on a later step, from the state and the waves in the table."""
    waves = (len(p) - 5) // 3
    top = 2 * waves
    for j in range(waves):
        c, s, at = W[2 * j, 0], W[2 * j + 1, 0], 8 + 8 * j
        W[top + 2 * j, 0] = c * row[at + 6] - s * row[at + 7]
        W[top + 2 * j + 1, 0] = s * row[at + 6] + c * row[at + 7]
    series(z, u, order, p, q, W[top:])
    return first_root(q, order, step * 17 / 16, noise, ulp)


def series(z: float, u: float, n: int, p: Any, X: Any, W: Any) -> None:
    """Taylor coefficients X[0..n] of x - c where cosine and sine of the waves are W[2 j, 0], W[2 j + 1, 0]."""
    X[0], X[1] = z, u
    for k in range(n - 1):
        total = p[3] if k == 0 else 0.0
        X[k + 2] = (total - p[1] * (k + 1) * X[k + 1] - p[2] * X[k]) / ((k + 1) * (k + 2))
        # the waves are added below: theirs is a loop of its own, so that no chain is longer than it must be
        for j in range((len(p) - 5) // 3):
            rate = p[5 + 3 * j]
            c, s = W[2 * j, k], W[2 * j + 1, k]
            X[k + 2] += (p[6 + 3 * j] * c + p[7 + 3 * j] * s) / ((k + 1) * (k + 2))
            W[2 * j, k + 1], W[2 * j + 1, k + 1] = -rate * s / (k + 1), rate * c / (k + 1)


def stride_all(
    launch: Any, v: Any, removed: Any, acceleration: Any, order: int, horizon: float, ulp: float, p: Any,
    step: float, table: Any, bound: Any, X: Any, W: Any, q: Any, status: Any, numbers: Any,
) -> None:  # fmt: skip
    """`stride` for every launch; numbers[i] = flight time, velocity, depth, bound."""
    for i in range(len(v)):
        if removed[i] > 1:
            code, time, velocity, depth, error = march(
                launch[i], v[i], removed[i], acceleration[i], order, horizon, ulp, p, X, W, q
            )
        else:
            code, time, velocity, depth, error = stride(
                launch[i], v[i], acceleration[i], order, horizon, ulp, p, step, table, bound, X, W, q
            )
        status[i] = code
        numbers[i, 0], numbers[i, 1], numbers[i, 2], numbers[i, 3] = time, velocity, depth, error
