"""A flight with its derivatives, as kernel text: plain arithmetic for doubles and mpf alike.

Columns A and B solve the homogeneous variational equation from (1, 0) and (0, 1) at the start of every step; Z is
driven by g' from (0, 0).  So the derivatives by the launch velocity and the launch time, and errors made on the way,
are carried from step to step by one matrix.
"""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from math import nan
from typing import Any


def respond(
    launch: Any, v: Any, end: Any, order: int, budget: int, ulp: Any, p: Any, X: Any, W: Any, A: Any, B: Any, Z: Any
) -> Any:
    """dx/dv, dx'/dv, dx/dtau, dx'/dtau at the time `end` of one flight, and whether it got there.

    Each step is as long as the bounds on the disc allow for the flight and for all three columns.
    """
    zero = 0 * v
    time, flown, z, u, longest, pace = zero, zero, zero, v, p[0] * 0 + 1, (1e300, 4.3, 1.0, 8.0)
    by_v, by_v_dot, by_tau, by_tau_dot = zero, zero + 1, zero, zero
    for _ in range(budget):
        A[0], A[1], B[0], B[1], Z[0], Z[1] = zero + 1, zero, zero, zero + 1, zero, zero
        variations(launch, time, z, u, order, p, X, W, A, B, Z)
        h, _overlap, pace = step_size(X, W, z, order, longest, ulp, p, pace)
        if not abs(u) < 1e150 or not abs(z) < 1e150:
            break
        h = column_step(X, W, A, B, Z, order, h, pace[0], ulp, p)
        if not h > ulp * time:
            break
        last = flown + h >= end
        if last:
            h = end - flown
        # a step between two phases as they are rounded: a pulse feels their difference from the sum of steps
        rounded = (launch[0] + (time + h)) - (launch[0] + time)
        if not last and abs(rounded - h) < h / 1000000:
            time, h = time + h, rounded
        else:
            time = time + h
        z, u, _size = advanced(X, z, order, h)
        a, a_dot, _size = advanced(A, A[0], order, h)
        b, b_dot, _size = advanced(B, B[0], order, h)
        d, d_dot, _size = advanced(Z, Z[0], order, h)
        by_v, by_v_dot = a * by_v + b * by_v_dot, a_dot * by_v + b_dot * by_v_dot
        by_tau, by_tau_dot = a * by_tau + b * by_tau_dot + d, a_dot * by_tau + b_dot * by_tau_dot + d_dot
        if last:
            return by_v, by_v_dot, by_tau, by_tau_dot, True
        flown, longest = flown + h, 2 * h
    return by_v, by_v_dot, by_tau, by_tau_dot, False


def judge(
    launch: Any, trace: Any, order: int, terms: int, p: Any, X: Any, W: Any, A: Any, B: Any, Z: Any, out: Any
) -> None:
    """Derivatives and errors of a flight that `march` has traced, by steps of fewer terms between the same states.

    Parameters
    ----------
    order, terms : degree of the steps of the flight, and of the columns here.
    out : becomes dx/dv, dx'/dv, dx/dtau, dx'/dtau at the hit; variances of x, x' there and their covariance; x'';
        the number of steps.

    Notes
    -----
    A step errs by the rounding of its sums, by the rounding of f and g, and by its cut-off: the difference of x'' at
    its end, by its polynomial and by the model, is that of the whole tail; it counts twice, as it keeps its sign over
    neighbouring steps.  Errors of steps are taken as independent.
    """
    unit = 2.0**-53
    by_v, by_v_dot, by_tau, by_tau_dot = 0.0, 1.0, 0.0, 0.0
    zz, zu, uu, h, before = 0.0, 0.0, 0.0, 0.0, 0.0
    steps, i, fresh = int(trace[0, 3]), 0, True
    time, z, u = 0.0, trace[0, 1], trace[0, 2]
    while True:
        A[0], A[1], B[0], B[1], Z[0], Z[1] = 1.0, 0.0, 0.0, 1.0, 0.0, 0.0
        variations(launch, time, z, u, terms, p, X, W, A, B, Z)
        known = rounding(X, W, unit, p) if fresh else before
        if fresh and i > 0:
            cut = 2 * abs(2 * X[2] - trace[i, 3]) / order
            off_u = h * (cut + max(known, before)) + unit * abs(u)
            off_z = unit * (abs(z) + h * (abs(u) + h * abs(X[2]))) + h * off_u / 2
            zz, uu = zz + off_z * off_z, uu + off_u * off_u
        if i == steps:
            break
        if fresh:
            before, h = known, trace[i + 1, 0] - time
        # columns of a stiff model decay faster than the flight moves: their steps are shorter
        stiff = max(2 * abs(B[2]), (2 * abs(A[2])) ** 0.5)
        left = trace[i + 1, 0] - time
        fresh = not stiff * left > 3
        part = left if fresh else 3 / stiff
        a, a_dot, _size = advanced(A, A[0], terms, part)
        b, b_dot, _size = advanced(B, B[0], terms, part)
        d, d_dot, _size = advanced(Z, Z[0], terms, part)
        by_v, by_v_dot = a * by_v + b * by_v_dot, a_dot * by_v + b_dot * by_v_dot
        by_tau, by_tau_dot = a * by_tau + b * by_tau_dot + d, a_dot * by_tau + b_dot * by_tau_dot + d_dot
        zz, zu, uu = (a * a * zz + 2 * a * b * zu + b * b * uu,
                      a * a_dot * zz + (a * b_dot + a_dot * b) * zu + b * b_dot * uu,
                      a_dot * a_dot * zz + 2 * a_dot * b_dot * zu + b_dot * b_dot * uu)  # fmt: skip
        if fresh:
            i += 1
            time, z, u = trace[i, 0], trace[i, 1], trace[i, 2]
        else:
            z, u, _size = advanced(X, z, terms, part)
            time += part
    out[0], out[1], out[2], out[3] = by_v, by_v_dot, by_tau, by_tau_dot
    out[4], out[5], out[6], out[7], out[8] = zz, zu, uu, 2 * X[2], steps


def column_step(X: Any, W: Any, A: Any, B: Any, Z: Any, n: int, h: Any, R: Any, ulp: Any, p: Any) -> Any:
    """The step h, made shorter until the cut-off of every column is below rounding; 0 where no disc is found."""
    for _ in range(100):
        if not h > 0:
            break
        q = h / R
        part = 1.001 * h * h * q ** (n - 1) / (n * (1 - q)) if q < 0.9 else 1e300 + 0 * h
        a, b, d = disc_of_columns(X, W, A, B, Z, n, R, p)
        # Z starts from nothing, and Z - x' solves the homogeneous equation: what a step moves either of them counts
        size = ulp * abs(X[1]) + h * (abs(X[2]) + h * (abs(X[3]) + abs(Z[2]) + h * (abs(Z[3]) + h * abs(Z[4]))))
        if a * part <= 25 * ulp and b * part <= 25 * ulp * h and d * part <= 25 * ulp * size:
            return h
        h, R = h * 4 / 5, R * 15 / 16
    return 0 * h


def respond_all(
    launch: Any, v: Any, end: Any, order: int, budget: int, ulp: Any, p: Any, X: Any, W: Any, A: Any, B: Any, Z: Any,
    out: Any,
) -> None:  # fmt: skip
    """`respond` for every launch."""
    for i in range(len(v)):
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], reached = respond(
            launch[i], v[i], end[i], order, budget, ulp, p, X, W, A, B, Z
        )
        if not reached:
            out[i, 0] = out[i, 1] = out[i, 2] = out[i, 3] = nan
