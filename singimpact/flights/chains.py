"""Impact after impact in one compiled loop, as kernel text; the launch is made from the phase, the rebound from rho."""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from typing import Any


def chain(
    tau: float, v: float, count: int, slow: float, w: Any, low: Any, phases: Any, launch: Any, order: int, terms: int,
    horizon: float, ulp: float, p: Any, step: float, table: Any, bound: Any, X: Any, W: Any, q: Any, out: Any,
) -> Any:  # fmt: skip
    """(impacts flown, status of the last flight); out[i] = time since the start, v, flight time, velocity, a_c.

    Parameters
    ----------
    tau, v : the state; count : impacts at most; w : constants of rho; low, phases : as in `pull`.
    slow : stop where the rest of the chatter, if the acceleration stayed, would last less than this; 0: never.
    """
    since, lost = 0.0, 0.0
    for i in range(count):
        a = pull(tau + since, late(tau, since, lost), p, low, phases, launch)
        if slow > 0 and a < 0 and 2 * v < -a * slow:
            return i, 0
        code, time, velocity, _depth, _error = stride(
            launch, v, a, order, terms, horizon, ulp, p, step, table, bound, X, W, q
        )
        if code != 0:
            return i, code
        # compensated: a thousand impacts would lose a thousand roundings of tau
        part = time - lost
        total = since + part
        lost = (total - since) - part
        since = total
        v = rebound(velocity, w)
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], out[i, 4] = since, v, time, velocity, a
        if not v > 0:
            return i + 1, 8
    return count, 0


def late(t: float, since: float, lost: float) -> float:
    """What t + since - lost is more than the double t + since."""
    total = t + since
    part = total - t
    return (t - (total - part)) + (since - part) - lost


def taylor_chain(
    tau: float, v: float, count: int, slow: float, w: Any, launch: Any, order: int,
    horizon: float, budget: int, ulp: float, p: Any, X: Any, W: Any, q: Any, out: Any,
) -> Any:  # fmt: skip
    """`chain` for a Taylor flow."""
    since, lost = 0.0, 0.0
    for i in range(count):
        launch[0] = tau + since
        coefficients(launch, 0.0, 0.0, 0.0, 0.0, order - order + 2, p, X, W)
        a = 2 * X[2]
        if slow > 0 and a < 0 and 2 * v < -a * slow:
            return i, 0
        code, time, velocity, _depth, _error = march(launch, v, 1, a, order, horizon, budget, ulp, p, X, W, q, W[:0])
        if code != 0:
            return i, code
        part = time - lost
        total = since + part
        lost = (total - since) - part
        since = total
        v = rebound(velocity, w)
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], out[i, 4] = since, v, time, velocity, a
        if not v > 0:
            return i + 1, 8
    return count, 0


def taylor_ends(
    tau: Any, v: Any, count: int, w: Any, launch: Any, order: int, horizon: float, budget: int, ulp: float, p: Any,
    X: Any, W: Any, q: Any, out: Any, status: Any,
) -> None:  # fmt: skip
    """`taylor_chain` for every state: tau, v become the last states, status what ended an orbit before, else 0."""
    for i in range(len(tau)):
        if status[i] != 0:
            continue
        flown, code = taylor_chain(tau[i], v[i], count, 0.0, w, launch, order, horizon, budget, ulp, p, X, W, q, out)
        status[i] = code
        if flown > 0:
            tau[i] += out[flown - 1, 0]
            v[i] = out[flown - 1, 1]
