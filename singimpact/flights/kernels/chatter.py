"""Chatter of a linear model to its end in one loop: impacts, the series for the remaining time, and its error.

Every flight leaves a row, so that its rounding is carried to the end by D G afterwards: products of D G from the start
would have to be inverted, and lose all digits after a hundred impacts.
"""

from math import inf, log, nan
from typing import Any

from singimpact.flights.kernels.hits import NOT_REFINED, PRESSED, UNIT, linear_hit
from singimpact.flights.kernels.orbits import later, launched, rebound
from singimpact.flights.kernels.state import (
    COSINE,
    FLIGHT_TIME,
    RATE,
    SINE,
    TIME_BY_TAU,
    TIME_BY_V,
    VELOCITY,
    VELOCITY_BY_TAU,
    VELOCITY_BY_V,
)
from singimpact.generated.completion import linear_chatter_terms

# Codes of `chatter_end`: the rest is summed up; a_c no longer presses; all impacts are flown; a term leaves the range
# of doubles; more impacts than rows; the orbit repeats itself.
COMPLETED, LIFTED, EXHAUSTED, TOO_WIDE, NO_ROOM, REPEATS = 60, 61, 62, 63, 64, 65
# Settings: the part of the time on which a_c changes that the chatter left must be below to be summed up (0 for never),
# impacts flown at most, and the factor by which errors are called larger.
NEAR, MOST, TRUST = range(3)
SETTINGS_OF_CHATTER = 3
# Impacts flown at most between two sums.
BLOCK = 4096
# An orbit repeats itself whose phase, in periods, and velocity come back to this: it neither accumulates nor lifts off,
# for a chatter multiplies velocities by r.
CLOSE = 1e-13


def linear_limits(tau: Any, v: Any, search: Any, model: Any, work: Any, rows: Any, out: Any, status: Any) -> int:
    """`chatter_end` of many states; out : (3, n), the end, its error and the impacts flown."""
    others = 0
    for i in range(len(tau)):
        status[i], out[0, i], out[1, i], out[2, i] = chatter_end(tau[i], v[i], search, model, work, rows)
        others += 1 if status[i] != COMPLETED else 0
    return others


def chatter_end(tau: float, v: float, search: Any, model: Any, work: Any, rows: Any) -> Any:
    """(code, end, error, impacts) of the chatter from (tau, v), v > 0.

    Parameters
    ----------
    search : settings NEAR and following, and r alone in rho.
    rows : scratch, shape (n, 6): time since the start, v and the slopes of each flight.

    Returns
    -------
    code : one of the six above, or that of a flight, see `hits.linear_hit`.
    """
    r = search.rho[0]
    near, most, trust = search.settings[NEAR], int(search.settings[MOST]), search.settings[TRUST]
    since, lost, n, look = 0.0, 0.0, 0, -1
    # Brent's search for a cycle: states are compared with the one after the last power of two
    mark, t_marked, v_marked = 0, nan, nan
    while True:
        t, t_low = launched(tau, since, lost, model)
        if abs(t - t_marked) <= CLOSE * model.turn[0] and abs(v - v_marked) <= CLOSE * v:
            return REPEATS, tau, 0.0, n
        if n >= 2 * mark:
            mark, t_marked, v_marked = n, t, v
        code, a = linear_hit(t, t_low, v, 0.0, near if look < 0 else (inf if n == look else 0.0), model, work)
        # the wall no longer presses: the mass has left it, or leaves it now
        if n > 0 and a >= 0:
            end = tau + (since - lost)
            error = carried_rounding(tau, since - lost, n, 0.0, r, rows, 0.0) + UNIT * abs(end)
            return LIFTED, end, trust * error, n
        if n == look and code != PRESSED:
            return TOO_WIDE, tau, 0.0, n
        if code == PRESSED:
            left, error = chatter_left(v, a, r, model.numbers, work.launch)
            size = abs(tau + since)
            if error <= UNIT * max(size, left) / 4 or v < 1e-290:
                end = tau + ((since - lost) + left)
                error += carried_rounding(tau, since - lost, n, -2 / a / model.rules.lost, r, rows, v) + UNIT * abs(end)
                return COMPLETED, end, trust * error, n
            if not error < inf:
                return TOO_WIDE, tau, 0.0, n
            # each impact multiplies v by about r, and the last term of the series by r^4: so many impacts bring it
            # below rounding
            count = min(log(error / (UNIT * size / 8 + 1e-300)) / (-4 * log(r)), BLOCK, most - n)
            look = n + (int(count) + 1 if count > int(count) else max(int(count), 1))
        if n >= most:
            return EXHAUSTED, tau, 0.0, n
        if n >= len(rows):
            return NO_ROOM, tau, 0.0, n
        if code == PRESSED:
            code, a = linear_hit(t, t_low, v, 0.0, 0.0, model, work)
        if code != 0 and code != NOT_REFINED:
            return code, tau, 0.0, n
        keep_flight(rows[n], since - lost, v, work.hit)
        since, lost = later(since, lost, work.hit[FLIGHT_TIME])
        v = rebound(work.hit[VELOCITY], search.rho)
        n += 1
        if not v > 0:
            return 8, tau, 0.0, n - 1


def chatter_left(v: float, a: float, r: float, p: Any, launch: Any) -> Any:
    """The time left of a chatter with a_c < 0, and the size of the last term of its series: `dynamics.remaining`."""
    a_d1, a_d2, a_d3 = 0.0, 0.0, 0.0
    for j in range(len(p.waves)):
        rate, c, s = p.waves[j, RATE], launch[2 * j], launch[2 * j + 1]
        across, along = p.waves[j, SINE] * c - p.waves[j, COSINE] * s, p.waves[j, COSINE] * c + p.waves[j, SINE] * s
        a_d1 += rate * across
        a_d2 -= rate * rate * along
        a_d3 -= rate * rate * rate * across
    first, second, third, last = linear_chatter_terms(v, r, a, a_d1, a_d2, a_d3, p.damping, p.stiffness)
    # a coefficient may happen to be small, so the size of this term is estimated from the term before
    likely = abs(third) * abs(third / first) ** 0.5
    # the larger of the two, and nan where one of them is
    error = likely if not likely <= abs(last) else abs(last)
    return first + (second + (third + last)), error


def carried_rounding(tau: float, since: float, n: int, by_v: float, r: float, rows: Any, v: float) -> float:
    """The rounding of every impact, in units of it, carried to the end by D G.

    Parameters
    ----------
    since, v : of the last state, after n impacts; v = 0 where the end does not depend on it. by_v : the derivative of
        the end by it.
    """
    # backwards: (by_tau, by_v) is the gradient of the end by the state before impact i, one vector times D G an impact
    by_tau, total = 1.0, abs(tau + since) + since + 4 * abs(by_v) * v
    for i in range(n - 1, -1, -1):
        a, b, c, d = rows[i, 2], rows[i, 3], -r * rows[i, 4], -r * rows[i, 5]
        by_tau, by_v = by_tau * (1 + a) + by_v * c, by_tau * b + by_v * d
        total += abs(by_tau) * (abs(tau + rows[i, 0]) + rows[i, 0]) + 4 * abs(by_v) * rows[i, 1]
    return float(UNIT * total)


def keep_flight(row: Any, since: float, v: float, hit: Any) -> None:
    """One flight as a row."""
    row[0], row[1], row[2], row[3] = since, v, hit[TIME_BY_TAU], hit[TIME_BY_V]
    row[4], row[5] = hit[VELOCITY_BY_TAU], hit[VELOCITY_BY_V]
