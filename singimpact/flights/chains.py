"""Impact after impact in one compiled loop, as kernel text; the launch is made from the phase, the rebound from rho."""
# mypy: disable-error-code="name-defined"
# ruff: noqa: F821

from __future__ import annotations

from typing import Any


def chain(
    tau: float, v: float, count: int, slow: float, w: Any, phases: Any, launch: Any, order: int, terms: int,
    horizon: float, ulp: float, p: Any, step: float, table: Any, bound: Any, X: Any, W: Any, q: Any, out: Any,
) -> Any:  # fmt: skip
    """(impacts flown, status of the last flight); out[i] = time since the start, v, flight time, velocity, a_c.

    Parameters
    ----------
    tau, v : the state; count : impacts at most; w : constants of rho; phases : of the waves.
    slow : stop where the rest of the chatter, if the acceleration stayed, would last less than this; 0: never.
    """
    waves = (len(p) - 5) // 3
    since, lost = 0.0, 0.0
    for i in range(count):
        a = p[3]
        for j in range(waves):
            angle = p[5 + 3 * j] * (tau + since) + phases[j]
            launch[2 * j], launch[2 * j + 1] = cos(angle), sin(angle)
            a += p[6 + 3 * j] * launch[2 * j] + p[7 + 3 * j] * launch[2 * j + 1]
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


def taylor_chain(
    tau: float, v: float, count: int, slow: float, w: Any, launch: Any, order: int,
    horizon: float, ulp: float, p: Any, X: Any, W: Any, q: Any, out: Any,
) -> Any:  # fmt: skip
    """`chain` for a Taylor flow."""
    since, lost = 0.0, 0.0
    for i in range(count):
        launch[0] = tau + since
        coefficients(launch, 0.0, 0.0, 0.0, 0.0, 2, p, X, W)
        a = 2 * X[2]
        if slow > 0 and a < 0 and 2 * v < -a * slow:
            return i, 0
        code, time, velocity, _depth, _error = march(launch, v, 1, a, order, horizon, ulp, p, X, W, q)
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
