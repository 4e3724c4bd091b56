"""One flight of a linear model in steps through a table of its closed form: `taylor_flight`, made fast.

A step holds no root when the Bernstein coefficients of the quintic Hermite interpolant through its ends exceed the
interpolation error |x^(6)| h^6/46080.  Else x'' keeping its sign decides, or a Taylor step; what is still open is left
to `taylor_flight`.
"""

from math import cos, inf, sin
from typing import Any

from singimpact.flights.kernels.linear import quiet, restart
from singimpact.flights.kernels.roots import first_root
from singimpact.flights.kernels.state import (
    A_COS,
    A_SIN,
    ACROSS,
    COSINE,
    RATE,
    SINE,
    SIZE_STEADY,
    SIZE_X,
    TURN_COS,
    TURN_SIN,
    V_BY_V,
    V_BY_X,
    V_COS,
    V_SIN,
    V_STEADY,
    X_BY_V,
    X_BY_X,
    X_COS,
    X_SIN,
    X_STEADY,
    Interval,
)
from singimpact.flights.kernels.taylor import other_root, taylor_flight


def tabulated_flight(launch: Any, v: float, height: float, acceleration: float, model: Any, work: Any) -> Any:
    """(status, flight time, velocity, depth, bound) of a flight, as `taylor_flight`.

    Parameters
    ----------
    launch : cosine and sine of every wave. v, height : x' and x - c at the start, v > 0 where height = 0.
    acceleration : a_c at the launch. model, work : see `state`.
    """
    p, table, W = model.numbers, model.table, work.W
    step, ulp, horizon = table.step, model.rules.ulp, max(model.rules.horizon, model.rules.reach * v)
    waves, last, gap = len(p.waves), len(table.rows) - 1, model.rules.gap
    start, z0, u0, base = 0.0, height, v, 0.0
    for j in range(waves):
        W[2 * j, 0], W[2 * j + 1, 0] = launch[2 * j], launch[2 * j + 1]
    if height == 0 and acceleration < 0 and -16 * v > acceleration * step and not gap < inf:
        # a low velocity returns near 2 v/|a|, and few terms are enough
        code, s, slope = root_after_launch(v, acceleration, -4 * v / acceleration, model, work)
        if code == 1 and s <= horizon:
            return 0, s, slope * s, 0.0, 0.0
    h2, sixth = step * step / 20.0, step * step * step * step * step * step / 46080.0
    # a literal 0 is a type of its own: every function that takes m would be compiled twice
    z, u, e, noise, m = height, v, acceleration - p.damping * v - p.stiffness * height, 0.0, last - last
    while True:
        if m == last:
            # the table ends: its last state is the next start, from the closed form and so without accumulated error
            start += last * step
            z0, u0, base = restarted(launch, (height, v), start, z, u, model, work)
            ahead = quiet(z0, u0, W, p)
            if ahead > last * step and not gap < inf:
                # far above the wall: tables in which no impact is possible are passed over
                if start + ahead >= horizon:
                    return 3, start, u0, z0, base
                start += ahead
                z0, u0, base = restarted(launch, (height, v), start, z0, u0, model, work)
            z, u, m = z0, u0, last - last
            # a step of few rounding units of the time hides a root: a force of 1e-65 brings the mass back at 1e62
            if not abs(z) < 1e100 or not step > 64 * ulp * start:
                return 23, start, u, z, base
        row = table.rows[m + 1]
        z1 = z0 * row[X_BY_X] + u0 * row[X_BY_V] + row[X_STEADY]
        u1 = z0 * row[V_BY_X] + u0 * row[V_BY_V] + row[V_STEADY]
        e1 = p.steady
        for j in range(waves):
            c, s, turn = W[2 * j, 0], W[2 * j + 1, 0], table.waves[m + 1][j]
            z1 += c * turn[X_COS] + s * turn[X_SIN]
            u1 += c * turn[V_COS] + s * turn[V_SIN]
            e1 += c * turn[A_COS] + s * turn[A_SIN]
        e1 -= p.damping * u1 + p.stiffness * z1
        noise1 = base + ulp * (abs(z0) * row[SIZE_X] + abs(u0 * row[X_BY_V]) + row[SIZE_STEADY])
        # Bernstein coefficients of the quintic; the outer two are z and z1
        b1, b4 = z + step * u * 0.2, z1 - step * u1 * 0.2
        b2, b3 = z + step * u * 0.4 + h2 * e, z1 - step * u1 * 0.4 + h2 * e1
        # 2.3: on the first step the remainder is compared with a multiple of the distance from the launch
        room = 2.3 * sixth * (table.sixth[0] * abs(z) + table.sixth[1] * abs(u) + table.sixth[2]) + 2.0 * (
            noise + noise1
        )
        time = start + m * step
        touches = not (min(min(b1, b2), min(b3, b4)) > room and z1 > room and (z > room or is_launch(time, z)))
        far = gap < inf and not max(max(max(b1, b2), max(b3, b4)), max(z, z1)) < gap - room
        if touches or far:
            between = Interval(time, m, z, u, e, z1, u1, e1, noise, noise1, room)
            code, s, slope = either_wall(touches, far, v, acceleration, between, model, work)
            if code == 2:
                removed, work.q[0] = (1 if height == 0 else 0), height
                return taylor_flight(
                    launch, v, removed, acceleration - p.stiffness * height, p, model.rules, work, W[:0]
                )
            if code != 0:
                if time + s > horizon:
                    return 3, time, u, z, noise
                return code - 1, time + s, slope, 0.0, 0.0
        if time + step >= horizon:
            return 3, time, u, z, noise
        z, u, e, noise = z1, u1, e1, noise1
        m += 1


def either_wall(touches: Any, far: Any, v: float, acceleration: float, between: Any, model: Any, work: Any) -> Any:
    """(code, s, slope) of the first root of a step: as `resolve_step`, or ACROSS + 1 where the other wall comes first.

    Parameters
    ----------
    touches, far : whether the step may meet the wall of the launch, and the other one.
    """
    code, s, slope = 0, 0.0, 0.0
    if touches:
        code, s, slope = resolve_step(v, acceleration, between, model, work)
    if not far or code == 2:
        return code, s, slope
    order, end = expanded(between, work.X, model, work), s if code == 1 else model.table.step * 17 / 16
    over, s_far, slope_far, _depth, _bound = other_root(
        work.X, between.z, order, end, model.rules.gap, between.noise, model.rules.ulp, work.q
    )
    if over == 0:
        return code, s, slope
    return ACROSS + 1 if over == 1 else 2, s_far, slope_far


def is_launch(time: float, z: float) -> bool:
    """Whether a step begins with a launch from the wall: the root t = 0 is no impact."""
    return time == 0.0 and z == 0.0


def restarted(launch: Any, first: Any, start: float, z: float, u: float, model: Any, work: Any) -> Any:
    """(x - c, x', error) where a table begins again; the waves in `work` are turned to there.

    Parameters
    ----------
    first : x - c and x' at the launch. start : the time since then.
    """
    p, W = model.numbers, work.W
    for j in range(len(p.waves)):
        turn_c, turn_s = cos(p.waves[j, RATE] * start), sin(p.waves[j, RATE] * start)
        W[2 * j, 0] = launch[2 * j] * turn_c - launch[2 * j + 1] * turn_s
        W[2 * j + 1, 0] = launch[2 * j + 1] * turn_c + launch[2 * j] * turn_s
    return restart(launch, first, start, z, u, 0.0, model.rules.ulp, p)


def resolve_step(v: float, acceleration: float, between: Any, model: Any, work: Any) -> Any:
    """(code, s, slope) of the first root on a step that the quintic does not settle; code 0 none, 1 root, 2 open."""
    table, e, e1, room = model.table, between.e, between.e1, between.room
    step = table.step
    # how far x'' may be from the line through its ends
    bend = step * step / 8.0 * (table.fourth[0] * abs(between.z) + table.fourth[1] * abs(between.u) + table.fourth[2])
    if is_launch(between.time, between.z):
        # upwards and convex, or concave and above the obstacle at the end: no root
        if min(e, e1) > bend or (between.z1 > room and max(e, e1) < -bend):
            return 0, 0.0, 0.0
        code, s, slope = root_after_launch(v, acceleration, step * 17 / 16, model, work)
        return code, s, slope * s
    code, s, slope = 2, 0.0, 0.0
    if between.z > room and abs(between.z1) > room:
        code, s, slope = monotone_step(between, bend, model, work)
    if code == 2:
        code, s, slope = taylor_step(between, model, work)
    return code, s, slope


def root_after_launch(v: float, acceleration: float, h: float, model: Any, work: Any) -> Any:
    """`first_root` of v + X_2 t + X_3 t^2 + ... on (0, h]."""
    p, reciprocal, X, q = model.numbers, model.table.taylor, work.X, work.q
    # the k-th coefficient of v + X_2 t + ... is at most strength (fastest)^(k - 2)/k!: terms are summed until this is
    # below 1e-18 v
    strength = abs(p.steady) + (p.fastest + p.fastest * p.fastest * h) * v
    for j in range(len(p.waves)):
        strength += abs(p.waves[j, COSINE]) + abs(p.waves[j, SINE])
    n, ratio = 3, p.fastest * h
    term = strength * h * ratio / 6
    while n < model.rules.short and term > 1e-18 * v:
        n += 1
        term *= ratio * reciprocal[n] / reciprocal[n - 1]
    series(0.0, v, n, p, reciprocal, X, work.W, n - n)
    X[2] = (acceleration - p.damping * v) / 2
    X[0] = 0.0
    against, power = 0.0, 1.0
    for k in range(3, n + 1):
        power *= h
        against += (k - 1) * abs(X[k]) * power
    if 2 * against < -X[2]:
        code, s, slope = falling_root(X, n, v, h)
        if code != 2:
            return code, s, slope
    for k in range(n):
        q[k] = X[k + 1]
    code, s, slope, _depth, _bound = first_root(q, n - 1, h, 0.0, model.rules.ulp)
    return code, s, slope


def falling_root(X: Any, n: int, v: float, h: float) -> Any:
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


def turned_waves(m: int, model: Any, work: Any) -> int:
    """Cosine and sine of the waves m steps after the start go into the second half of W; its first row is returned."""
    W, waves = work.W, len(model.numbers.waves)
    for j in range(waves):
        c, s, turn, top = W[2 * j, 0], W[2 * j + 1, 0], model.table.waves[m][j], 2 * waves + 2 * j
        W[top, 0] = c * turn[TURN_COS] - s * turn[TURN_SIN]
        W[top + 1, 0] = s * turn[TURN_COS] + c * turn[TURN_SIN]
    return 2 * waves


def expanded(between: Any, X: Any, model: Any, work: Any) -> int:
    """The degree of the Taylor coefficients of a step, which go into X."""
    order, top = model.rules.short, turned_waves(between.m, model, work)
    series(between.z, between.u, order, model.numbers, model.table.taylor, X, work.W, top)
    if between.time == 0.0:
        # at a launch x'' has more digits than the sum of the waves
        X[2] = between.e / 2
    return int(order)


def taylor_step(between: Any, model: Any, work: Any) -> Any:
    """The first root on a later step, from the state and the waves in the table."""
    order = expanded(between, work.q, model, work)
    code, s, slope, _depth, _bound = first_root(
        work.q, order, model.table.step * 17 / 16, between.noise, model.rules.ulp
    )
    return code, s, slope


def monotone_step(between: Any, bend: float, model: Any, work: Any) -> Any:
    """The first root on a step on which x' or x'' keeps its sign; 2 where neither may, or where rounding decides.

    A falling or concave flight crosses once or not at all; a convex one is decided by its lowest point.
    """
    X, step, u, e, z1, u1, e1 = work.X, model.table.step, between.u, between.e, between.z1, between.u1, between.e1
    noise = between.noise1 + between.noise
    convex = min(e, e1) > bend
    falls = u + u1 + step * (max(abs(e), abs(e1)) + bend) < 0
    if not convex and not falls and not max(e, e1) < -bend:
        return 2, 0.0, 0.0
    if z1 > 0 and (not convex or u1 <= 0 or u >= 0):
        return 0, step, 0.0
    order = expanded(between, X, model, work)
    if z1 < 0:
        s = quintic_root(between, step)
    else:
        s, depth, curve = lowest_point(X, order, step * u / (u - u1), step)
        if depth > 2 * noise:
            return 0, step, 0.0
        if not depth < -2 * noise:
            return 2, 0.0, 0.0
        # the first of the two roots of the parabola at the lowest point
        s -= (-2 * depth / curve) ** 0.5
    return newton(X, order, s, step)


def quintic_root(between: Any, step: float) -> float:
    """Where the quintic through both ends vanishes, to a few digits."""
    z, rise = between.z, between.z1 - between.z
    d0, d1 = step * between.u, step * between.u1
    c0, c1 = step * step * between.e * 0.5, step * step * between.e1 * 0.5
    a3, a4 = 10 * rise - 6 * d0 - 4 * d1 - 3 * c0 + c1, -15 * rise + 8 * d0 + 7 * d1 + 3 * c0 - 2 * c1
    a5 = 6 * rise - 3 * d0 - 3 * d1 - c0 + c1
    x = z / (z - between.z1)
    # three steps of Newton's method from the secant: about five digits, from which `newton` needs two more
    for _ in range(3):
        value = z + x * (d0 + x * (c0 + x * (a3 + x * (a4 + x * a5))))
        slope = d0 + x * (2 * c0 + x * (3 * a3 + x * (4 * a4 + x * 5 * a5)))
        if not slope < 0:
            break
        x -= value / slope
        x = min(max(x, 0.0), 1.0)
    return float(x * step)


def lowest_point(X: Any, n: int, s: float, step: float) -> Any:
    """The lowest point of a convex flight on [0, step]: place, depth, x''."""
    z, e, change = 0.0, 1.0, 0.0
    for _ in range(30):
        z, u, e = taylor_sums(X, n, s)
        change = -u / e
        z += change * (u + change * e / 2)
        s = min(max(s + change, 0.0), step)
        if abs(change) < 1e-5 * step:
            break
    return s, z, e


def newton(X: Any, n: int, s: float, step: float) -> Any:
    """The only root in reach, by Newton's method; 2 when it does not settle inside the step."""
    for _ in range(12):
        z, u, e = taylor_sums(X, n, s)
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
            z, u, e = taylor_sums(X, n, s)
            change = -z / u
            return 1, s + change, u + e * change
    return 2, s, 0.0


def taylor_sums(X: Any, n: int, s: float) -> Any:
    """x - c, x', x'' of a Taylor sum of even degree n; even and odd terms apart, as in `roots.sums`."""
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


def series(z: float, u: float, n: int, p: Any, reciprocal: Any, X: Any, W: Any, top: int) -> None:
    """Taylor coefficients X[0..n] of x - c where cosine and sine of wave j are W[top + 2 j, 0], W[top + 2 j + 1, 0].

    reciprocal : 1/k!.
    """
    # X[k] takes k! times the coefficients first: x^(k) = force^(k-2) - d x^(k-1) - k x^(k-2)
    X[2] = p.steady
    for k in range(3, n + 1):
        X[k] = 0.0
    for j in range(len(p.waves)):
        rate, c, s = p.waves[j, RATE], W[top + 2 * j, 0], W[top + 2 * j + 1, 0]
        by_cos, by_sin = p.waves[j, COSINE], p.waves[j, SINE]
        even, odd = by_cos * c + by_sin * s, rate * (by_sin * c - by_cos * s)
        square = -rate * rate
        for k in range(2, n, 2):
            X[k] += even
            X[k + 1] += odd
            even, odd = even * square, odd * square
        if n % 2 == 0:
            X[n] += even
    X[0], X[1] = z, u
    if p.damping == 0:
        for k in range(2, n + 1):
            X[k] -= p.stiffness * X[k - 2]
    else:
        for k in range(2, n + 1):
            X[k] -= p.damping * X[k - 1] + p.stiffness * X[k - 2]
    for k in range(2, n + 1):
        X[k] *= reciprocal[k]
