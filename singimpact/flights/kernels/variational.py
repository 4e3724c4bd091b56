"""A flight with its derivatives: plain arithmetic for doubles and mpf alike.

Columns A and B solve the homogeneous variational equation from (1, 0) and (0, 1) at the start of every step; Z is
driven by g' from (0, 0).  So the derivatives by the launch velocity and the launch time, and errors made on the way,
are carried from step to step by one matrix.  `variations`, `rounding` and `disc_of_columns` are emitted with the
recurrence of f and g; `flights.bind` puts them in the place of those here, which are of x'' = 0.
"""

from typing import Any

from singimpact.flights.kernels.linear import step_size
from singimpact.flights.kernels.steps import whole_power
from singimpact.flights.kernels.taylor import advanced


def variations(launch: Any, time: Any, z: Any, u: Any, n: int, p: Any, work: Any, columns: Any) -> None:  # noqa: ARG001
    """Taylor coefficients of x - c and of the three columns."""
    for k in range(2, n + 1):
        work.X[k] = columns.A[k] = columns.B[k] = columns.Z[k] = 0 * z


def rounding(X: Any, W: Any, unit: Any, p: Any) -> Any:  # noqa: ARG001
    """The rounding error of x'' at the start of a step."""
    return 0 * unit


def disc_of_columns(work: Any, columns: Any, n: int, R: Any, p: Any) -> Any:  # noqa: ARG001
    """Bounds of the defects of the three columns on the disc of radius R."""
    return 0 * R, 0 * R, 0 * R


def derivatives_at(launch: Any, v: Any, end: Any, p: Any, rules: Any, work: Any, columns: Any) -> Any:
    """dx/dv, dx'/dv, dx/dtau, dx'/dtau at the time `end` of one flight, and whether it got there.

    Each step is as long as the bounds on the disc allow for the flight and for all three columns.
    """
    X, W, order, ulp = work.X, work.W, rules.order, rules.ulp
    A, B, Z = columns.A, columns.B, columns.Z
    zero = 0 * v
    time, flown, z, u, longest, pace = zero, zero, zero, v, p[0] * 0 + 1, (1e300, 4.3, 1.0, 8.0)
    by_v, by_v_dot, by_tau, by_tau_dot = zero, zero + 1, zero, zero
    for _ in range(rules.budget):
        A[0], A[1], B[0], B[1], Z[0], Z[1] = zero + 1, zero, zero, zero + 1, zero, zero
        variations(launch, time, z, u, order, p, work, columns)
        h, _overlap, pace = step_size(X, W, z, order, longest, ulp, p, pace)
        if not abs(u) < 1e150 or not abs(z) < 1e150:
            break
        h = column_step(work, columns, order, h, pace[0], ulp, p)
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


def judge(launch: Any, trace: Any, p: Any, rules: Any, work: Any, columns: Any, out: Any) -> None:
    """Derivatives and errors of a flight that `taylor_flight` has traced, by shorter sums between the same states.

    Parameters
    ----------
    rules : `order` is the degree of the steps of the flight, `short` that of the columns here.
    out : becomes dx/dv, dx'/dv, dx/dtau, dx'/dtau at the hit; variances of x, x' there and their covariance; x'';
        the number of steps.

    Notes
    -----
    A step errs by the rounding of its sums, by the rounding of f and g, and by its cut-off: the difference of x'' at
    its end, by its polynomial and by the model, is that of the whole tail; it counts twice, as it keeps its sign over
    neighbouring steps.  Errors of steps are taken as independent.
    """
    X, W, A, B, Z = work.X, work.W, columns.A, columns.B, columns.Z
    order, terms = rules.order, rules.short
    unit = 2.0**-53
    by_v, by_v_dot, by_tau, by_tau_dot = 0.0, 1.0, 0.0, 0.0
    zz, zu, uu, h, before = 0.0, 0.0, 0.0, 0.0, 0.0
    steps, i, fresh = int(trace[0, 3]), 0, True
    time, z, u = 0.0, trace[0, 1], trace[0, 2]
    while True:
        A[0], A[1], B[0], B[1], Z[0], Z[1] = 1.0, 0.0, 0.0, 1.0, 0.0, 0.0
        variations(launch, time, z, u, terms, p, work, columns)
        roundoff = rounding(X, W, unit, p) if fresh else before
        if fresh and i > 0:
            cut = 2 * abs(2 * X[2] - trace[i, 3]) / order
            off_u = h * (cut + max(roundoff, before)) + unit * abs(u)
            off_z = unit * (abs(z) + h * (abs(u) + h * abs(X[2]))) + h * off_u / 2
            zz, uu = zz + off_z * off_z, uu + off_u * off_u
        if i == steps:
            break
        if fresh:
            before, h = roundoff, trace[i + 1, 0] - time
        # columns of a stiff model decay faster than the flight moves: their steps are shorter
        stiff = max(2 * abs(B[2]), (2 * abs(A[2])) ** 0.5)
        left = trace[i + 1, 0] - time
        fresh = not stiff * left > 3
        step = left if fresh else 3 / stiff
        a, a_dot, _size = advanced(A, A[0], terms, step)
        b, b_dot, _size = advanced(B, B[0], terms, step)
        d, d_dot, _size = advanced(Z, Z[0], terms, step)
        by_v, by_v_dot = a * by_v + b * by_v_dot, a_dot * by_v + b_dot * by_v_dot
        by_tau, by_tau_dot = a * by_tau + b * by_tau_dot + d, a_dot * by_tau + b_dot * by_tau_dot + d_dot
        zz, zu, uu = (a * a * zz + 2 * a * b * zu + b * b * uu,
                      a * a_dot * zz + (a * b_dot + a_dot * b) * zu + b * b_dot * uu,
                      a_dot * a_dot * zz + 2 * a_dot * b_dot * zu + b_dot * b_dot * uu)  # fmt: skip
        if fresh:
            i += 1
            time, z, u = trace[i, 0], trace[i, 1], trace[i, 2]
        else:
            z, u, _size = advanced(X, z, terms, step)
            time += step
    out[0], out[1], out[2], out[3] = by_v, by_v_dot, by_tau, by_tau_dot
    out[4], out[5], out[6], out[7], out[8] = zz, zu, uu, 2 * X[2], steps


def column_step(work: Any, columns: Any, n: int, h: Any, R: Any, ulp: Any, p: Any) -> Any:
    """The step h, made shorter until the cut-off of every column is below rounding; 0 where no disc is found."""
    X, Z = work.X, columns.Z
    for _ in range(100):
        if not h > 0:
            break
        # as in `steps.allowed_step`: Cauchy's bound of the cut-off, integrated twice
        q = h / R
        cutoff = 1.001 * h * h * whole_power(q, n - 1) / (n * (1 - q)) if q < 0.9 else 1e300 + 0 * h
        a, b, d = disc_of_columns(work, columns, n, R, p)
        # Z starts from nothing, and Z - x' solves the homogeneous equation: what a step moves either of them counts
        size = ulp * abs(X[1]) + h * (abs(X[2]) + h * (abs(X[3]) + abs(Z[2]) + h * (abs(Z[3]) + h * abs(Z[4]))))
        if a * cutoff <= 25 * ulp and b * cutoff <= 25 * ulp * h and d * cutoff <= 25 * ulp * size:
            return h
        h, R = h * 4 / 5, R * 15 / 16
    return 0 * h
