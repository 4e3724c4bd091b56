"""The velocity on gamma over a phase of a linear model: halving, and Newton's method with the series at its end.

Next to gamma each halving takes the longest flights: where the series is known, all but the first and the last of them
are left out.
"""

from math import nan
from typing import Any

from singimpact.flights.kernels.hits import NOT_REFINED, linear_hit
from singimpact.flights.kernels.orbits import hit_later, later, launched, rebound
from singimpact.flights.kernels.state import (
    FLIGHT_TIME,
    TIME_BY_TAU,
    TIME_BY_V,
    VELOCITY,
    VELOCITY_BY_TAU,
    VELOCITY_BY_V,
)
from singimpact.flights.kernels.tabulated import root_after_launch
from singimpact.flights.kernels.waves import wall_acceleration

# Codes of `side_of_gamma`.
BELOW, ABOVE, SPENT = 50, 51, 52
# Settings: the part of the time to the end in which chatter must end, the relative width to stop at, impacts flown at
# most from one velocity, the width to begin Newton's method at, the distance from the end at which the series holds (0:
# none is known), the contact order j, and the series from sigma^(j + 1) on.
WITHIN, NARROW, SPENDING, COARSE, REACH, CONTACT, SERIES = range(7)
# Coefficients of the series.
TERMS_OF_GAMMA = 18
SETTINGS_OF_GAMMA = SERIES + TERMS_OF_GAMMA
# A step of Newton's method below this part of v is the last: the next would be its square.
SETTLED = 1e-9


def side_of_gamma(tau: float, v: float, end: float, most: int, search: Any, model: Any, work: Any) -> int:
    """BELOW: chatter from (tau, v) completes before `end`; ABOVE: an impact comes after it; else the code of a flight.

    Parameters
    ----------
    end : time after tau at which gamma ends. most : impacts flown at most; then the code is SPENT.
    search : settings and the constants of rho, see `state.Search`.
    """
    since, lost = 0.0, 0.0
    for _ in range(most):
        t, t_low = launched(tau, since, lost, model)
        code, a, time, u = plain_hit(t, t_low, v, model, work)
        if a < 0 and 2 * v < -a * model.rules.lost * search.settings[WITHIN] * (end - since):
            return BELOW
        if code == 3:  # no further impact: contact is lost
            return ABOVE
        if code != 0:
            return int(code)
        since, lost = later(since, lost, time)
        v = rebound(u, search.rho)
        if since - lost >= end:
            return ABOVE
        if not v > 0:
            return 8
    return SPENT


def plain_hit(t: float, t_low: float, v: float, model: Any, work: Any) -> Any:
    """(code, a_c at the launch, flight time, velocity): `linear_hit`, without its conditions where the flight is short.

    The first root after a launch that is pressed back within a step is a short series, and is never refined.
    """
    a = wall_acceleration(t, t_low, model.numbers, model.rest, work.launch)
    if a < 0 and -16 * v > a * model.table.step:
        for j in range(2 * len(model.numbers.waves)):
            work.flight.W[j, 0] = work.launch[j]
        roots, s, slope = root_after_launch(v, a, -4 * v / a, model, work.flight)
        if roots == 1 and s <= model.table.step:
            return 0, a, s, slope * s
    code, a = linear_hit(t, t_low, v, 0.0, 0.0, model, work)
    code = 0 if code == NOT_REFINED else code
    return code, a, work.hit[FLIGHT_TIME], work.hit[VELOCITY]


def bracket_gamma(tau: float, low: float, high: float, end: float, search: Any, model: Any, work: Any) -> Any:
    """(low, high, code): an interval of velocities around gamma at tau, below and above it, made narrow.

    Parameters
    ----------
    search : as in `side_of_gamma`.
    """
    if search.settings[REACH] > 0:
        low, high, code = halved(tau, low, high, end, search.settings[COARSE], search, model, work)
        if code != 0:
            return low, high, code
        v = on_gamma(tau, (low + high) / 2, end, search, model, work)
        if low < v < high:
            low, high = beside(tau, v, low, high, end, search, model, work)
    return halved(tau, low, high, end, search.settings[NARROW], search, model, work)


def beside(tau: float, v: float, low: float, high: float, end: float, search: Any, model: Any, work: Any) -> Any:
    """(low, high): velocities on both sides of gamma, the nearest to v that are, at steps eight times longer each."""
    h, under, over = search.settings[NARROW], False, False
    while h < search.settings[COARSE] and not (under and over):
        if not under:
            least = max(v * (1 - h), low)
            code = (
                side_of_gamma(tau, least, end, int(search.settings[SPENDING]), search, model, work)
                if least > low
                else BELOW
            )
            under = code != ABOVE
            if code == BELOW:
                low = least
            elif code == ABOVE:
                high, over = least, True
        if not over:
            most = min(v * (1 + h), high)
            code = (
                side_of_gamma(tau, most, end, int(search.settings[SPENDING]), search, model, work)
                if most < high
                else ABOVE
            )
            over = code != BELOW
            if code == ABOVE:
                high = most
            elif code == BELOW:
                low, under = most, True
        h *= 8
    return low, high


def halved(tau: float, low: float, high: float, end: float, narrow: float, search: Any, model: Any, work: Any) -> Any:
    """(low, high, code): an interval around gamma halved until its relative width is `narrow`, or a code is open."""
    while high - low > narrow * high:
        middle = (low + high) / 2
        code = side_of_gamma(tau, middle, end, int(search.settings[SPENDING]), search, model, work)
        if code == BELOW:
            low = middle
        elif code == ABOVE:
            high = middle
        else:
            return low, high, code
    return low, high, 0


def on_gamma(tau: float, v: float, end: float, search: Any, model: Any, work: Any) -> float:
    """The velocity over tau whose orbit meets the series of gamma near its end; nan where Newton's method fails."""
    for _ in range(8):
        miss, slope = missed(tau, v, end, search, model, work)
        change = miss / slope
        v -= change
        if not v > 0:
            return nan
        if abs(change) < SETTLED * v:
            return v
    return nan


def missed(tau: float, v: float, end: float, search: Any, model: Any, work: Any) -> Any:
    """v - gamma where the orbit from (tau, v) comes within REACH of the end, and its derivative by the first v."""
    since, lost, by_tau, by_v, hit = 0.0, 0.0, 0.0, 1.0, work.hit
    for _ in range(int(search.settings[SPENDING])):
        sigma = (since - lost) - end
        if -sigma <= search.settings[REACH]:
            break
        code, a = hit_later(tau, since, lost, v, 0.0, model, work)
        short = 2 * v < -a * model.rules.lost * search.settings[WITHIN] * -sigma
        if (code != 0) or a >= 0 or short:
            return nan, nan
        # the chain rule through the impact: the pair (by_tau, by_v) is D G^n applied to (0, 1)
        late = hit[TIME_BY_TAU] * by_tau + hit[TIME_BY_V] * by_v
        by_v = -search.rho[0] * (hit[VELOCITY_BY_TAU] * by_tau + hit[VELOCITY_BY_V] * by_v)
        by_tau += late
        since, lost = later(since, lost, hit[FLIGHT_TIME])
        v = rebound(hit[VELOCITY], search.rho)
        if not v > 0:
            return nan, nan
    sigma = (since - lost) - end
    if not (sigma < 0 and -sigma <= search.settings[REACH]):
        return nan, nan
    # Horner's scheme for gamma = sigma^(j + 1) P(sigma), and for P'
    total, along = 0.0, 0.0
    for i in range(TERMS_OF_GAMMA - 1, -1, -1):
        along = along * sigma + total
        total = total * sigma + search.settings[SERIES + i]
    power = sigma ** search.settings[CONTACT]
    return v - total * power * sigma, by_v - power * ((search.settings[CONTACT] + 1) * total + sigma * along) * by_tau
