"""Impact after impact in one loop: the launch is made from the phase, the rebound from rho."""

from __future__ import annotations

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

BELOW, ABOVE, SPENT = 50, 51, 52
"""Codes of `side_of_gamma`."""
WITHIN, WIDTH, MOST = range(3)
"""Settings of `bracket_gamma`: the part of the time to the end of gamma in which chatter must end; the relative width
to stop at; the impacts flown at most from one velocity."""


def rebound(velocity: float, w: Any) -> float:
    """rho(velocity) of a constant restitution w[0]; `flights.bind` puts an emitted rho in its place."""
    return float(abs(w[0] * velocity))


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
    at, at_low = sum_twice(tau, 0.0, since, -lost)
    t, t_low = reduced_twice(at, model.turn)
    t, t_low = sum_twice(t, t_low, at_low, 0.0)
    code, a = next_hit(t, t_low, v, near, model, work)
    return 0 if code == NOT_REFINED else code, a


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


def side_of_gamma(tau: float, v: float, end: float, settings: Any, w: Any, model: Any, work: Any) -> int:
    """BELOW: chatter from (tau, v) completes before `end`; ABOVE: an impact comes after it; else the code of a flight.

    Parameters
    ----------
    end : time after tau at which gamma ends. settings : after MOST impacts the code is SPENT. w : constants of rho.
    """
    since, lost = 0.0, 0.0
    for _ in range(int(settings[MOST])):
        code, a = hit_later(tau, since, lost, v, 0.0, model, work)
        if a < 0 and 2 * v < -a * model.rules.lost * settings[WITHIN] * (end - since):
            return BELOW
        if code == 3:  # no further impact: contact is lost
            return ABOVE
        if code != 0:
            return int(code)
        since, lost = later(since, lost, work.hit[FLIGHT_TIME])
        v = rebound(work.hit[VELOCITY], w)
        if since - lost >= end:
            return ABOVE
        if not v > 0:
            return 8
    return SPENT


def bracket_gamma(tau: float, given: Any, settings: Any, w: Any, model: Any, work: Any) -> Any:
    """(low, high, code): an interval of velocities around gamma at tau, halved until it is narrow.

    Parameters
    ----------
    given : a velocity below gamma, one above it, and the time to its end. settings, w : as in `side_of_gamma`.
    """
    low, high, end = given[0], given[1], given[2]
    while high - low > settings[WIDTH] * high:
        middle = (low + high) / 2
        code = side_of_gamma(tau, middle, end, settings, w, model, work)
        if code == BELOW:
            low = middle
        elif code == ABOVE:
            high = middle
        else:
            return low, high, code
    return low, high, 0


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
