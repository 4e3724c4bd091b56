"""One flight as a chain of Taylor steps: plain arithmetic for doubles and mpf alike.

The first step works on (x - c)/t^removed, where the trivial root t = 0 is gone: full relative accuracy at v = 1e-300.
`coefficients`, `step_size`, `singular_part` and `restart` are those of linear models here; `flights.bind` puts the
emitted recurrence of another model in their place.

Of a model with two walls the polynomial of each step is looked through for both, the nearer one first.

Statuses of `taylor_flight` are those of `status.Status`, and without a hit it gives the state some time before the
horizon, for `flights.no_return`: time, x', x - c, its bound.  21 : the steps are spent; 22 : no step next to a
singularity, with the part of f and g that is singular in place of the bound; 23 : out of the range of numbers.
"""

from math import inf
from typing import Any

from singimpact.flights.kernels.linear import coefficients, quiet, restart, singular_part, step_size
from singimpact.flights.kernels.roots import first_root
from singimpact.flights.kernels.state import ACROSS


def taylor_flight(
    launch: Any, v: Any, removed: int, acceleration: Any, p: Any, rules: Any, work: Any, trace: Any
) -> Any:
    """(status, flight time, velocity, depth, bound) of the flight from x = c, or from above, with velocity v.

    Parameters
    ----------
    launch : cosine and sine of every wave, or the time of the launch. v : velocity >= 0.
    removed : how often t = 0 is a root of x - c: 1 for v > 0, more for a mass that lifts off at rest; 0 for a start off
        the wall with any v, whose x - c is work.q[0].
    acceleration : a_c at the launch when it is known better than the flow computes it, else nan.
    p : numbers of the model. rules : `state.Rules`. work : `state.Work`.
    trace : where its rows suffice, row i becomes time, x - c, x' at the start of step i and x'' there by the polynomial
        of the step before; the row of the hit ends it, and entry [0, 3] counts the steps.
    """
    X, W, q, order, ulp = work.X, work.W, work.q, rules.order, rules.ulp
    horizon, zero = max(rules.horizon, rules.reach * v), 0 * v
    time, z, u, noise, shift, z_lost, u_lost = zero, zero, v, zero, zero, zero, zero
    if removed == 0:
        z = q[0]
    start = z, v
    if acceleration == acceleration:
        # the difference of the two values of a_c shifts X[2] on the first step: near a zero of a_c the recurrence has
        # few digits of it
        coefficients(launch, time, z, zero, zero, order - order + 2, p, work)  # a literal 2 is compiled for itself
        shift = acceleration / 2 - X[2]
    longest, pace, bend = p[0] * 0 + 1, (1e300, 4.3, 1.0, 8.0), zero
    for count in range(rules.budget):
        coefficients(launch, time, z, u, shift, order, p, work)
        note(trace, count, time, z, u, bend)
        h, overlap, pace = step_size(X, W, z, order, longest, ulp, p, pace)
        if not abs(u) < 1e150 or not abs(z) < 1e150:
            return 23, time, u, z, noise
        if count % 64 == 63:
            ahead = quiet(z, u, W, p)
            if ahead > 64 * h and not rules.gap < inf:
                # far above the wall: a time in which no impact is possible is passed over
                if time + ahead >= horizon:
                    return 3, time, u, z, noise
                time += ahead
                z, u, noise = restart(launch, start, time, z, u, noise, ulp, p)
                continue
        # a step below one rounding unit of the time
        if not h > ulp * time:
            return 22, time, u, z, zero + singular_part(X, W, order, max(h, ulp * (time + ulp)), p)
        # a step beyond the horizon decides nothing more; twice, so that the last one is not cut to rounding
        if h > 2 * (horizon - time):
            h = 2 * (horizon - time)
        q[0] = z
        for k in range(0 if removed else 1, order + 1 - removed):
            q[k] = X[k + removed]
        # a little past the step, so that a root on its end is not lost between two steps
        code, s, slope, depth, bound = first_root(q, order - removed, h * overlap, noise, ulp)
        other = other_root_before(code, s, h * overlap, X, z, noise, rules, q)
        if other[0] > 0:
            return met_across(other, (time, u, z, noise), rules, horizon, X, order, trace, count)
        if code > 0:
            # q was (x - c)/t^removed: at its root x' = t^removed q'
            raised = 1 + zero
            for _k in range(removed):
                raised *= s
            if code == 2:
                return 5, time + s, slope * raised, depth * raised, bound * raised
            if time + s > horizon:
                return 3, time, u, z, noise
            if count + 1 < len(trace):
                note(trace, count + 1, time + s, zero, slope * raised, curvature(X, order, s))
                trace[0, 3] = zero + count + 1
            return 0, time + s, slope * raised, zero, zero
        if time + h >= horizon:
            return 3, time, u, z, noise
        bend = curvature(X, order, h) if count + 1 < len(trace) else zero
        z, z_lost, u, u_lost, size = moved(X, z, z_lost, u, u_lost, order, h)
        time += h
        z, u, noise = restart(launch, start, time, z, u, noise + ulp * size, ulp, p)
        longest, shift, removed = 2 * h, zero, 0
    return 21, time, u, z, noise


def other_root_before(code: Any, s: Any, h: Any, X: Any, z: Any, noise: Any, rules: Any, q: Any) -> Any:
    """`other_root` up to s where its code is that of a root, else up to h; code 0 of a model with one wall."""
    order = rules.order
    if not rules.gap < inf or highest(X, z, order, h) + noise < rules.gap:
        return 0, h, h, h, h
    return other_root(X, z, order, s if code > 0 else h, rules.gap, noise, rules.ulp, q)


def highest(X: Any, z: Any, n: int, h: Any) -> Any:
    """A bound of x - c on a step."""
    size = abs(X[n])
    for k in range(n - 1, 0, -1):
        size = size * h + abs(X[k])
    return z + size * h


def other_root(X: Any, z: Any, n: int, last: Any, gap: Any, noise: Any, ulp: Any, q: Any) -> Any:
    """`first_root` of gap - (x - c) on (0, last]; q is scratch."""
    q[0] = gap - z
    for k in range(1, n + 1):
        q[k] = -X[k]
    return first_root(q, n, last, noise + ulp * gap, ulp)


def met_across(root: Any, start: Any, rules: Any, horizon: Any, X: Any, order: int, trace: Any, count: int) -> Any:
    """The result of `taylor_flight` at a root of gap - (x - c); the velocity is that of the model with x -> -x.

    Parameters
    ----------
    root : of `other_root`, with code 1 or 2. start : time, x', x - c and its error at the start of step `count`.
    """
    (code, s, slope, depth, bound), (time, u, z, noise) = root, start
    if time + s > horizon:
        return 3, time, u, z, noise
    if code == 2:
        return ACROSS + 5, time + s, slope, depth, bound
    if count + 1 < len(trace):
        note(trace, count + 1, time + s, time * 0 + rules.gap, -slope, curvature(X, order, s))
        trace[0, 3] = time * 0 + count + 1
    return ACROSS, time + s, slope, time * 0, time * 0


def note(trace: Any, row: int, time: Any, z: Any, u: Any, bend: Any) -> None:
    """A row of the trace, if it has that many."""
    if row < len(trace):
        trace[row, 0], trace[row, 1], trace[row, 2], trace[row, 3] = time, z, u, bend


def advanced(X: Any, z: Any, order: int, h: Any) -> Any:
    """x - c and x' at the end of a step, with the size of the terms summed."""
    value, slope, size = X[order], 0 * h, abs(X[order])
    for k in range(order - 1, -1, -1):
        part = X[k] if k > 0 else z
        slope = slope * h + value
        value = value * h + part
        size = size * h + abs(part)
    return value, slope, size


def moved(X: Any, z: Any, z_lost: Any, u: Any, u_lost: Any, n: int, h: Any) -> Any:
    """x - c and x' at the end of a step, each with what its sum has lost, and the size of the terms summed."""
    rise, turn, size = X[n], n * X[n], abs(X[n])
    for k in range(n - 1, 0, -1):
        rise = rise * h + X[k]
        size = size * h + abs(X[k])
        if k > 1:
            turn = turn * h + k * X[k]
    # Kahan's sum: what the addition to z rounds away is subtracted from the next increment
    increment = rise * h - z_lost
    total = z + increment
    z_lost = (total - z) - increment
    change = turn * h - u_lost
    speed = u + change
    u_lost = (speed - u) - change
    return total, z_lost, speed, u_lost, size * h + abs(z)


def curvature(X: Any, n: int, s: Any) -> Any:
    """x'' of the polynomial."""
    value = 0 * s
    for k in range(n, 1, -1):
        value = value * s + k * (k - 1) * X[k]
    return value


def follow(launch: Any, v: Any, times: Any, p: Any, rules: Any, work: Any, out: Any) -> None:
    """x - c and x' at `times`, which run away from 0 in one direction, from x - c = work.q[0]; no obstacle is felt."""
    X, W, order, ulp = work.X, work.W, rules.order, rules.ulp
    zero = 0 * v
    time, z, u = zero, work.q[0], v
    start, longest, pace = (z, v), p[0] * 0 + 1, (1e300, 4.3, 1.0, 8.0)
    i = 0
    while i < len(times):
        coefficients(launch, time, z, u, zero, order, p, work)
        h, _overlap, pace = step_size(X, W, z, order, longest, ulp, p, pace)
        if not h > 0 or not abs(u) < 1e150 or not abs(z) < 1e150:
            break
        # backwards in time a step has the same length and the other sign: the discs are symmetric
        forward = times[len(times) - 1] >= 0
        while i < len(times) and abs(times[i] - time) <= h:
            out[i, 0], out[i, 1], _size = advanced(X, z, order, times[i] - time)
            i += 1
        longest = 2 * h
        h = h if forward else -h
        z, u, _size = advanced(X, z, order, h)
        time += h
        z, u, _noise = restart(launch, start, time, z, u, zero, ulp, p)
