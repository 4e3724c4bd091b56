"""Impact after impact in one loop: the launch is made from the phase, the rebound from rho."""

from __future__ import annotations

from math import nan
from typing import Any

from singimpact.flights.kernels.double_double import sum_twice
from singimpact.flights.kernels.hits import NOT_REFINED, next_hit
from singimpact.flights.kernels.state import (
    CONDITION,
    FLIGHT_TIME,
    TIME_BY_TAU,
    TIME_BY_V,
    TIME_ERROR,
    VELOCITY,
    VELOCITY_BY_TAU,
    VELOCITY_BY_V,
)
from singimpact.flights.kernels.waves import reduced_twice


def rebound(velocity: float, w: Any) -> float:
    """rho(velocity) of a constant restitution w[0], where the last number of w is 0; else of a law."""
    if w[len(w) - 1] == 0:
        return float(abs(w[0] * velocity))
    return law(velocity, w)


def law(velocity: float, w: Any) -> float:  # noqa: ARG001
    """nan: `flights.bind` puts an emitted rho in this place, or a call of the address that is the last number of w."""
    return nan


def orbit_segment(tau: float, v: float, near: float, w: Any, model: Any, work: Any, out: Any) -> Any:
    """(impacts flown, code of the last flight) of one orbit, at most one impact a row of `out`.

    Parameters
    ----------
    tau, v : the state. w : constants of rho. out : row i becomes the time since the start, v, flight time, velocity,
        a_c at the launch, kappa and the error of the flight time, and the derivatives of the flight time and of the
        velocity by tau and v of impact i; the last six are of linear models.
    near : the orbit ends, with code PRESSED, where the chatter left is short, see `hits.linear_hit`.
    """
    since, lost = 0.0, 0.0
    for i in range(len(out)):
        code, a = hit_later(tau, since, lost, v, near, model, work)
        if code != 0:
            return i, code
        since, lost = later(since, lost, work.hit[FLIGHT_TIME])
        v = rebound(work.hit[VELOCITY], w)
        record(out[i], since, v, a, work.hit)
        if not v > 0:
            return i + 1, 8
    return len(out), 0


def hit_later(tau: float, since: float, lost: float, v: float, near: float, model: Any, work: Any) -> Any:
    """`hits.next_hit` of a launch at tau + since - lost.

    A hit that is not refined, for want of a table, is within a few roundings more: it counts as a hit.
    """
    t, t_low = launched(tau, since, lost, model)
    code, a = next_hit(t, t_low, v, near, model, work)
    return 0 if code == NOT_REFINED else code, a


def launched(tau: float, since: float, lost: float, model: Any) -> Any:
    """(t, t_low): tau + since - lost, reduced by the period."""
    at, at_low = sum_twice(tau, 0.0, since, -lost)
    t, t_low = reduced_twice(at, model.turn)
    return sum_twice(t, t_low, at_low, 0.0)


def iterate(tau: Any, v: Any, count: int, w: Any, model: Any, work: Any, status: Any) -> None:
    """`count` impacts from every state; tau, v become the last states, status what ended an orbit before, else 0."""
    for i in range(len(tau)):
        since, lost = 0.0, 0.0
        for _ in range(count):
            if status[i] != 0:
                break
            status[i], _a = hit_later(tau[i], since, lost, v[i], 0.0, model, work)
            if status[i] == 0:
                since, lost = later(since, lost, work.hit[FLIGHT_TIME])
                v[i] = rebound(work.hit[VELOCITY], w)
                if not v[i] > 0:
                    status[i] = 8
        tau[i] += since - lost


def later(since: float, lost: float, time: float) -> Any:
    """since + time, and what the sum has lost: a thousand impacts would lose a thousand roundings of tau."""
    part = time - lost
    total = since + part
    return total, (total - since) - part


def record(row: Any, since: float, v: float, a: float, hit: Any) -> None:
    """One impact of an orbit as a row."""
    row[0], row[1], row[2], row[3], row[4] = since, v, hit[FLIGHT_TIME], hit[VELOCITY], a
    row[5], row[6] = hit[CONDITION], hit[TIME_ERROR]
    row[7], row[8], row[9], row[10] = hit[TIME_BY_TAU], hit[TIME_BY_V], hit[VELOCITY_BY_TAU], hit[VELOCITY_BY_V]
