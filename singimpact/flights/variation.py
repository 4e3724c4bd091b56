"""A flight of a known length with its derivatives, as kernel text: plain arithmetic for doubles and mpf alike.

Y and Z are the derivatives of x by the launch velocity and by the launch time, x and x' at the launch kept.
"""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from math import nan
from typing import Any


def respond(launch: Any, v: Any, end: Any, order: int, ulp: Any, p: Any, X: Any, W: Any, Y: Any, Z: Any) -> Any:
    """dx/dv, dx'/dv, dx/dtau, dx'/dtau at the time `end` of one flight, and whether it got there."""
    zero = 0 * v
    time, z, u, longest = zero, zero, v, p[0] * 0 + 1
    Y[0], Y[1], Z[0], Z[1] = zero, zero + 1, zero, zero
    for _ in range(10_000_000):
        variations(launch, time, z, u, zero, order, p, X, W, Y, Z)
        h = step_size(X, z, order, longest, ulp, p)
        # the derivatives converge where the flight does, a little more slowly
        h = h * 7 / 8
        if not h > 0 or not abs(u) < 1e150 or not abs(z) < 1e150:
            break
        last = time + h >= end
        if last:
            h = end - time
        z, u, _size = advanced(X, z, order, h)
        Y[0], Y[1], _size = advanced(Y, Y[0], order, h)
        Z[0], Z[1], _size = advanced(Z, Z[0], order, h)
        if last:
            return Y[0], Y[1], Z[0], Z[1], True
        time += h
        longest = 2 * h
    return Y[0], Y[1], Z[0], Z[1], False


def respond_all(
    launch: Any, v: Any, end: Any, order: int, ulp: Any, p: Any, X: Any, W: Any, Y: Any, Z: Any, out: Any
) -> None:
    """`respond` for every launch."""
    for i in range(len(v)):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], reached = respond(
            launch[i], v[i], end[i], order, ulp, p, X, W, Y, Z
        )
        if not reached:
            out[i, 0] = out[i, 1] = out[i, 2] = out[i, 3] = nan
