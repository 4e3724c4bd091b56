"""One flight of a linear model in strides through a table of its closed form, as kernel text: `march`, made fast.

A stride is left behind when the Bernstein coefficients of the quintic through its ends exceed the remainder of the
interpolation; else x'' keeping its sign, or a Taylor step, decides.  What is still open is asked of `march`.
"""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from typing import Any


def stride(
    launch: Any, v: float, acceleration: float, order: int, terms: int, horizon: float, ulp: float, p: Any,
    step: float, table: Any, bound: Any, X: Any, W: Any, q: Any,
) -> Any:  # fmt: skip
    """(status, flight time, velocity, depth, bound), as `march` for v > 0.

    Parameters
    ----------
    order, terms : degree of a Taylor step here, and in `march`, whose steps are longer.
    step, table : the step of the table and the table.
    bound : bounds of the fourth and the sixth derivative over a step, then 1/k!.
    """
    waves, last = (len(p) - 5) // 3, len(table) - 1
    start, z0, u0, base = 0.0, 0.0, v, 0.0
    for j in range(waves):
        W[2 * j, 0], W[2 * j + 1, 0] = launch[2 * j], launch[2 * j + 1]
    if acceleration < 0 and -16 * v > acceleration * step:
        # a low velocity is looked for near 2 v/|a|, with few terms
        code, s, slope = launched(v, acceleration, order, -4 * v / acceleration, ulp, p, bound, X, W, q)
        if code == 1 and s <= horizon:
            return 0, s, slope * s, 0.0, 0.0
    h2, sixth = step * step / 20.0, step * step * step * step * step * step / 46080.0
    # a literal 0 is a type of its own: all that takes m would be compiled twice
    z, u, e, noise, m = 0.0, v, acceleration - p[1] * v, 0.0, last - last
    while True:
        if m == last:
            # the table ends: its last state is the next start, from the closed form and so without accumulated error
            start += last * step
            z0, u0, base = renewed(launch, v, start, z, u, ulp, p, W)
            z, u, m = z0, u0, last - last
            if not abs(z) < 1e100:
                return 23, start, u, z, base
        z1 = z0 * table[m + 1, 0] + u0 * table[m + 1, 1] + table[m + 1, 2]
        u1 = z0 * table[m + 1, 3] + u0 * table[m + 1, 4] + table[m + 1, 5]
        e1 = p[3]
        for j in range(waves):
            c, s, at = W[2 * j, 0], W[2 * j + 1, 0], 8 + 8 * j
            z1 += c * table[m + 1, at] + s * table[m + 1, at + 1]
            u1 += c * table[m + 1, at + 2] + s * table[m + 1, at + 3]
            e1 += c * table[m + 1, at + 4] + s * table[m + 1, at + 5]
        e1 -= p[1] * u1 + p[2] * z1
        error = base + ulp * (abs(z0) * table[m + 1, 6] + abs(u0 * table[m + 1, 1]) + table[m + 1, 7])
        b1, b4 = z + step * u * 0.2, z1 - step * u1 * 0.2
        b2, b3 = z + step * u * 0.4 + h2 * e, z1 - step * u1 * 0.4 + h2 * e1
        # 2.3: on the first stride the remainder is compared with a multiple of the distance from the launch
        room = 2.3 * sixth * (bound[3] * abs(z) + bound[4] * abs(u) + bound[5]) + 2.0 * (noise + error)
        time = start + m * step
        if not (min(min(b1, b2), min(b3, b4)) > room and z1 > room and (z > room or time == 0.0)):
            code, s, slope = asked(v, acceleration, time, room, error, noise, z, u, e, z1, u1, e1, m,
                                   order, ulp, p, step, table, bound, X, W, q)  # fmt: skip
            if code == 2:
                return march(launch, v, 1, acceleration, terms, horizon, 10_000_000, ulp, p, X, W, q, W[:0])
            if code == 1:
                if time + s > horizon:
                    return 3, time, u, z, noise
                return 0, time + s, slope, 0.0, 0.0
        if time + step >= horizon:
            return 3, time, u, z, noise
        z, u, e, noise = z1, u1, e1, error
        m += 1


def renewed(launch: Any, v: float, start: float, z: float, u: float, ulp: float, p: Any, W: Any) -> Any:
    """(x - c, x', error) where a table begins again, and the waves turned to there."""
    for j in range((len(p) - 5) // 3):
        turn_c, turn_s = cos(p[5 + 3 * j] * start), sin(p[5 + 3 * j] * start)
        W[2 * j, 0] = launch[2 * j] * turn_c - launch[2 * j + 1] * turn_s
        W[2 * j + 1, 0] = launch[2 * j + 1] * turn_c + launch[2 * j] * turn_s
    return restart(launch, v, start, z, u, 0.0, ulp, p)


def asked(
    v: float, acceleration: float, time: float, room: float, error: float, noise: float, z: float, u: float, e: float,
    z1: float, u1: float, e1: float, m: int, order: int, ulp: float, p: Any, step: float, table: Any, bound: Any,
    X: Any, W: Any, q: Any,
) -> Any:  # fmt: skip
    """(code, s, slope) of a stride from (z, u, e) to (z1, u1, e1) that the quintic does not settle."""
    bend = step * step / 8.0 * (bound[0] * abs(z) + bound[1] * abs(u) + bound[2])
    if time == 0.0:
        # upwards and convex, or concave and above the obstacle at the end: no root
        if min(e, e1) > bend or (z1 > room and max(e, e1) < -bend):
            return 0, 0.0, 0.0
        code, s, slope = launched(v, acceleration, order, step * 17 / 16, ulp, p, bound, X, W, q)
        return code, s, slope * s
    code, s, slope = 2, 0.0, 0.0
    if z > room and abs(z1) > room:
        code, s, slope = bent_stride(z, u, e, z1, u1, e1, bend, error + noise, table, m, order, step, p, bound, X, W)
    if code == 2:
        code, s, slope = inner_stride(z, u, table, m, order, step, noise, ulp, p, bound, W, q)
    return code, s, slope


def launched(
    v: float, acceleration: float, order: int, h: float, ulp: float, p: Any, bound: Any, X: Any, W: Any, q: Any
) -> Any:
    """`first_root` of v + X_2 t + X_3 t^2 + ... on (0, h]."""
    strength = abs(p[3]) + (p[4] + p[4] * p[4] * h) * v
    for j in range((len(p) - 5) // 3):
        strength += abs(p[6 + 3 * j]) + abs(p[7 + 3 * j])
    n, ratio = 3, p[4] * h
    term = strength * h * ratio / 6
    while n < order and term > 1e-18 * v:
        n += 1
        term *= ratio * bound[6 + n] / bound[5 + n]
    series(0.0, v, n, p, bound, X, W, n - n)
    X[2] = (acceleration - p[1] * v) / 2
    X[0] = 0.0
    against, power = 0.0, 1.0
    for k in range(3, n + 1):
        power *= h
        against += (k - 1) * abs(X[k]) * power
    if 2 * against < -X[2]:
        code, s, slope = falling(X, n, v, h)
        if code != 2:
            return code, s, slope
    for k in range(n):
        q[k] = X[k + 1]
    code, s, slope, _depth, _bound = first_root(q, n - 1, h, 0.0, ulp)
    return code, s, slope


def falling(X: Any, n: int, v: float, h: float) -> Any:
    """The root on (0, h] of v + X_2 t + ... + X_n t^(n - 1), which falls there by at least |X_2|/2 a unit of time."""
    s = -v / X[2]
    for _ in range(20):
        value, slope, bend = X[n], 0.0, 0.0
        for k in range(n - 1, 0, -1):
            bend = bend * s + slope
            slope = slope * s + value
            value = value * s + X[k]
        change = -value / slope
        s += change
        if s > h:
            return 2, s, slope
        if abs(change) < 1e-9 * s:
            return 1, s, slope + 2 * bend * change
    return 2, s, 0.0


def turned(table: Any, m: int, p: Any, W: Any) -> int:
    """Cosine and sine of the waves m steps after the start go into the second half of W."""
    waves = (len(p) - 5) // 3
    for j in range(waves):
        c, s, at, top = W[2 * j, 0], W[2 * j + 1, 0], 8 + 8 * j, 2 * waves + 2 * j
        W[top, 0] = c * table[m, at + 6] - s * table[m, at + 7]
        W[top + 1, 0] = s * table[m, at + 6] + c * table[m, at + 7]
    return 2 * waves


def inner_stride(
    z: float, u: float, table: Any, m: int, order: int, step: float, noise: float, ulp: float, p: Any, bound: Any,
    W: Any, q: Any,
) -> Any:  # fmt: skip
    """The first root on a later step, from the state and the waves in the table."""
    series(z, u, order, p, bound, q, W, turned(table, m, p, W))
    code, s, slope, _depth, _bound = first_root(q, order, step * 17 / 16, noise, ulp)
    return code, s, slope


def bent_stride(
    z: float, u: float, e: float, z1: float, u1: float, e1: float, bend: float, noise: float, table: Any, m: int,
    order: int, step: float, p: Any, bound: Any, X: Any, W: Any,
) -> Any:  # fmt: skip
    """The first root on a step on which x' or x'' keeps its sign; 2 where neither may, or where rounding decides.

    `bend` bounds the distance of x'' from the line through its ends.  A falling or concave flight crosses once or not
    at all; a convex one is decided by its lowest point.
    """
    convex = min(e, e1) > bend
    falls = u + u1 + step * (max(abs(e), abs(e1)) + bend) < 0
    if not convex and not falls and not max(e, e1) < -bend:
        return 2, 0.0, 0.0
    if z1 > 0 and (not convex or u1 <= 0 or u >= 0):
        return 0, step, 0.0
    series(z, u, order, p, bound, X, W, turned(table, m, p, W))
    if z1 < 0:
        s = crossing(z, u, e, z1, u1, e1, step)
    else:
        s, depth, curve = lowest(X, order, step * u / (u - u1), step)
        if depth > 2 * noise:
            return 0, step, 0.0
        if not depth < -2 * noise:
            return 2, 0.0, 0.0
        s -= (-2 * depth / curve) ** 0.5
    return newton(X, order, s, step)


def crossing(z: float, u: float, e: float, z1: float, u1: float, e1: float, step: float) -> float:
    """Where the quintic through both ends vanishes, roughly."""
    d0, d1, c0, c1 = step * u, step * u1, step * step * e * 0.5, step * step * e1 * 0.5
    rise = z1 - z
    a3, a4 = 10 * rise - 6 * d0 - 4 * d1 - 3 * c0 + c1, -15 * rise + 8 * d0 + 7 * d1 + 3 * c0 - 2 * c1
    a5 = 6 * rise - 3 * d0 - 3 * d1 - c0 + c1
    x = z / (z - z1)
    for _ in range(3):
        value = z + x * (d0 + x * (c0 + x * (a3 + x * (a4 + x * a5))))
        slope = d0 + x * (2 * c0 + x * (3 * a3 + x * (4 * a4 + x * 5 * a5)))
        if not slope < 0:
            break
        x -= value / slope
        x = min(max(x, 0.0), 1.0)
    return x * step


def lowest(X: Any, n: int, s: float, step: float) -> Any:
    """The lowest point of a convex flight on [0, step]: place, depth, x''."""
    z, e, change = 0.0, 1.0, 0.0
    for _ in range(30):
        z, u, e = place(X, n, s)
        change = -u / e
        z += change * (u + change * e / 2)
        s = min(max(s + change, 0.0), step)
        if abs(change) < 1e-5 * step:
            break
    return s, z, e


def newton(X: Any, n: int, s: float, step: float) -> Any:
    """The only root in reach, by Newton's method; 2 when it does not settle inside the step."""
    for _ in range(12):
        z, u, e = place(X, n, s)
        if not u < 0:
            break
        change = -z / u
        # Halley's correction; a change this small leaves an error of the order of its cube
        if abs(change * e) < -u:
            change /= 1 + change * e / (2 * u)
        s += change
        if not 0 <= s <= step:
            break
        if abs(change * e) < -1e-6 * u and abs(change) < 1e-6 * step:
            z, u, e = place(X, n, s)
            change = -z / u
            return 1, s + change, u + e * change
    return 2, s, 0.0


def place(X: Any, n: int, s: float) -> Any:
    """x - c, x', x'' of a Taylor sum of even degree n, as `sums`."""
    x = s * s
    e0, e1, e2 = X[n], 0.0, 0.0
    o0, o1, o2 = 0.0, 0.0, 0.0
    for k in range(n - 2, -1, -2):
        o2 = o2 * x + o1
        o1 = o1 * x + o0
        o0 = o0 * x + X[k + 1]
        e2 = e2 * x + e1
        e1 = e1 * x + e0
        e0 = e0 * x + X[k]
    return e0 + s * o0, o0 + 2 * (s * e1 + x * o1), 2 * (e1 + 4 * x * e2) + s * (6 * o1 + 8 * x * o2)


def series(z: float, u: float, n: int, p: Any, bound: Any, X: Any, W: Any, top: int) -> None:
    """Taylor coefficients X[0..n] of x - c where cosine and sine of wave j are W[top + 2 j, 0], W[top + 2 j + 1, 0]."""
    X[2] = p[3]
    for k in range(3, n + 1):
        X[k] = 0.0
    for j in range((len(p) - 5) // 3):
        rate, c, s = p[5 + 3 * j], W[top + 2 * j, 0], W[top + 2 * j + 1, 0]
        pull, turn = p[6 + 3 * j] * c + p[7 + 3 * j] * s, rate * (p[7 + 3 * j] * c - p[6 + 3 * j] * s)
        square = -rate * rate
        for k in range(2, n, 2):
            X[k] += pull
            X[k + 1] += turn
            pull, turn = pull * square, turn * square
        if n % 2 == 0:
            X[n] += pull
    X[0], X[1] = z, u
    if p[1] == 0:
        for k in range(2, n + 1):
            X[k] -= p[2] * X[k - 2]
    else:
        for k in range(2, n + 1):
            X[k] -= p[1] * X[k - 1] + p[2] * X[k - 2]
    for k in range(2, n + 1):
        X[k] *= bound[6 + k]


def stride_all(
    launch: Any, v: Any, removed: Any, acceleration: Any, order: int, terms: int, horizon: float, ulp: float, p: Any,
    step: float, table: Any, bound: Any, X: Any, W: Any, q: Any, status: Any, numbers: Any,
) -> None:  # fmt: skip
    """`stride` for every launch; numbers[i] = flight time, velocity, depth, bound."""
    for i in range(len(v)):
        if removed[i] > 1:
            code, time, velocity, depth, error = march(
                launch[i],
                v[i],
                removed[i],
                acceleration[i],
                terms - 1 + removed[i],
                horizon,
                10_000_000,
                ulp,
                p,
                X,
                W,
                q,
                W[:0],
            )
        else:
            code, time, velocity, depth, error = stride(
                launch[i], v[i], acceleration[i], order, terms, horizon, ulp, p, step, table, bound, X, W, q
            )
        status[i] = code
        numbers[i, 0], numbers[i, 1], numbers[i, 2], numbers[i, 3] = time, velocity, depth, error
