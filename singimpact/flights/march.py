"""One flight as a chain of Taylor steps, as kernel text: plain arithmetic for doubles and mpf alike.

The first step works on (x - c)/t^removed, where the trivial root t = 0 is gone: full relative accuracy at v = 1e-300.
The functions `coefficients`, `step_size` and `restart` belong to the flow that the text is joined to.
"""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from typing import Any


def march(
    launch: Any, v: Any, removed: int, acceleration: Any, order: int, horizon: Any, ulp: Any, p: Any,
    X: Any, W: Any, q: Any,
) -> Any:  # fmt: skip
    """(status, flight time, velocity, depth, bound) of the flight from x = c with velocity v.

    Parameters
    ----------
    launch : what the flow wants to know of the launch. v : velocity >= 0.
    removed : how often t = 0 is a root of x - c: 1 for v > 0, more for a mass that lifts off at rest.
    acceleration : a_c at the launch when it is known better than the flow computes it, else nan.
    order, ulp : degree of a step; relative rounding error allowed for.
    p : numbers of the model. X, W, q : work arrays.

    Notes
    -----
    Without a hit the state some time before the horizon is given, for `flights.escape`: time, x', x - c, its bound.
    """
    zero = 0 * v
    time, z, u, noise, shift = zero, zero, v, zero, zero
    if acceleration == acceleration:
        coefficients(launch, time, z, zero, zero, order - order + 2, p, X, W)  # a literal 2 is compiled for itself
        shift = acceleration / 2 - X[2]
    longest = p[0] * 0 + 1
    for _ in range(10_000_000):
        coefficients(launch, time, z, u, shift, order, p, X, W)
        h = step_size(X, z, order, longest, ulp, p)
        # a step that time cannot tell from none: the flight leaves every range there
        if not h > ulp * time or not abs(u) < 1e150 or not abs(z) < 1e150:
            return 5, time, u, z, noise
        if h > 2 * (horizon - time):
            h = 2 * (horizon - time)
        q[0] = z
        for k in range(order + 1 - removed):
            if k + removed > 0:
                q[k] = X[k + removed]
        # a little past the step, so that a root on its end is not lost between two steps
        code, s, slope, depth, bound = first_root(q, order - removed, h * 17 / 16, noise, ulp)
        if code > 0:
            raised = 1 + zero
            for _k in range(removed):
                raised *= s
            if code == 2:
                return 5, time + s, slope * raised, depth * raised, bound * raised
            if time + s > horizon:
                return 3, time, u, z, noise
            return 0, time + s, slope * raised, zero, zero
        if time + h >= horizon:
            return 3, time, u, z, noise
        z, u, size = advanced(X, z, order, h)
        time += h
        z, u, noise = restart(launch, v, time, z, u, noise + ulp * size, ulp, p)
        longest, shift, removed = 2 * h, zero, 0
    return 5, time, u, z, noise


def advanced(X: Any, z: Any, order: int, h: Any) -> Any:
    """x - c and x' at the end of a step, with the size of the terms summed."""
    value, slope, size = X[order], 0 * h, abs(X[order])
    for k in range(order - 1, -1, -1):
        part = X[k] if k > 0 else z
        slope = slope * h + value
        value = value * h + part
        size = size * h + abs(part)
    return value, slope, size


def run(
    launch: Any, v: Any, removed: Any, acceleration: Any, order: int, horizon: Any, ulp: Any, p: Any,
    X: Any, W: Any, q: Any, status: Any, numbers: Any,
) -> None:  # fmt: skip
    """`march` for every launch; numbers[i] = flight time, velocity, depth, bound."""
    for i in range(len(v)):
        code, time, velocity, depth, bound = march(
            launch[i], v[i], removed[i], acceleration[i], order, horizon, ulp, p, X, W, q
        )
        status[i] = code
        numbers[i, 0], numbers[i, 1], numbers[i, 2], numbers[i, 3] = time, velocity, depth, bound


def follow(launch: Any, v: Any, times: Any, order: int, ulp: Any, p: Any, X: Any, W: Any, out: Any) -> None:
    """x - c and x' at `times`, which run away from 0 in one direction; the obstacle is not felt."""
    zero = 0 * v
    time, z, u = zero, zero, v
    longest = p[0] * 0 + 1
    i = 0
    while i < len(times):
        coefficients(launch, time, z, u, zero, order, p, X, W)
        h = step_size(X, z, order, longest, ulp, p)
        if not h > 0 or not abs(u) < 1e150 or not abs(z) < 1e150:
            break
        forward = times[len(times) - 1] >= 0
        while i < len(times) and abs(times[i] - time) <= h:
            out[i, 0], out[i, 1], _size = advanced(X, z, order, times[i] - time)
            i += 1
        longest = 2 * h
        h = h if forward else -h
        z, u, _size = advanced(X, z, order, h)
        time += h
        z, u, _noise = restart(launch, v, time, z, u, zero, ulp, p)
