"""The velocity on gamma over a phase: just below it chatter completes, just above it contact is lost before."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.certified import Certified
from singimpact.algebra.expressions import Expression
from singimpact.algebra.numbers import as_float, as_mpf, compare, constant
from singimpact.algebra.rings import Multiprecision
from singimpact.contact.contact import acceleration_jet, force_jet
from singimpact.dynamics import enclosed
from singimpact.dynamics.rest import release
from singimpact.flights.hits import checked_digits, derivative, impact_map
from singimpact.flights.sequences import sequence
from singimpact.inputs import InputError, whole
from singimpact.oscillator.acceleration import acceleration, sign_of_acceleration
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

EPSILON = 2.0**-52


@dataclass(frozen=True)
class Search:
    """How the two sides are told apart, and how v is refined.

    Parameters
    ----------
    narrow : the last bracket, relative; narrower ones are decided by rounding.
    block, longest : impacts flown at a time, twice as many each time up to the longest; blocks of 64 spent three
        quarters of the time between the blocks.
    impacts : flown at most from one velocity, unless told otherwise; r = 0.9999 takes 400 000.
    short : chatter that would end in this part of the time to the end of gamma does; on gamma the part is above 1/2.
    first, more, rounds : impacts of the first refinement, more each time, at most.
    """

    narrow: float = 4 * EPSILON
    block: int = 64
    longest: int = 4096
    impacts: int = 640_000
    short: float = 1 / 64
    first: int = 6
    more: int = 4
    rounds: int = 2000


SEARCH = Search()


@dataclass(frozen=True)
class Threshold:
    """The velocity `v`, an estimate of its `error`, and `complete`, or `unresolved` when no threshold was found.

    `certified` has v with a proved radius, when digits were asked for and the model is linear: within it lie a velocity
    from which chatter completes and one from which contact is lost before.
    """

    v: Any
    error: Any
    status: Any
    certified: Certified | None = None


def threshold(osc: Oscillator, tau: Any, *, digits: int | None = None, impacts: int = SEARCH.impacts) -> Threshold:
    """The v whose orbit runs along gamma into the next zero of a_c with a_c' > 0.

    Parameters
    ----------
    osc : the model, r < 1. tau : a phase with a_c(tau) < 0. digits : decimal digits; v is then an mpmath number.
    impacts : flown at most from one velocity; where they do not tell the sides apart the status is `unresolved`.

    Examples
    --------
    >>> found = threshold(Oscillator("x", "cos(2.8*t)", 0, "0.5"), "pi/2.8")
    >>> print(f"{found.v:.13f}")
    0.1008699912693
    """
    place, most = constant("tau", tau), whole("impacts", impacts, 1, 10**7)
    if sign_of_acceleration(osc, place) >= 0:
        raise InputError(f"tau = {tau} is not accepted: give a phase at which a_c presses, a_c(tau) < 0")
    if compare(osc.slope_at_rest(), 1) == 0:
        raise InputError(f"restitution = {osc.restitution} is not accepted: chatter completes only for rho'(0) > -1")
    start = as_float(place)
    end = release(osc, start)
    if not np.isfinite(end):
        return Threshold(np.nan, np.nan, np.int8(Status.unresolved))
    found = _bisected(osc, start, end, most)
    if digits is None or found.status != Status.complete:
        return found
    return _enclosed(osc, place, found, end, checked_digits(digits)) or _refined(osc, place, found, digits)


def _enclosed(osc: Oscillator, place: Expression, rough: Threshold, end: float, digits: int) -> Threshold | None:
    """The threshold in balls, where the model allows it."""
    import mpmath

    found = enclosed.threshold(osc, place, rough.v, end, digits) if enclosed.enclosable(osc) else None
    if found is None:
        return None
    with mpmath.workdps(digits):
        error = found.radius + abs(found.value) * mpmath.mpf(10) ** -digits
        return Threshold(+found.value, error, np.int8(Status.complete), found)


def _bisected(osc: Oscillator, tau: float, end: float, impacts: int) -> Threshold:
    low, high = 0.0, -float(acceleration(osc, np.array([tau]))[0]) * (end - tau) / 4
    while not (lifted := _lifts(osc, tau, high, end, impacts)):
        low, high = high, 2 * high
        if lifted is None or high > 1e12:
            return Threshold(np.nan, np.nan, np.int8(Status.unresolved))
    while high - low > SEARCH.narrow * high:
        middle = (low + high) / 2
        lifted = _lifts(osc, tau, middle, end, impacts)
        if lifted is None:
            return Threshold(np.nan, np.nan, np.int8(Status.unresolved))
        low, high = (low, middle) if lifted else (middle, high)
    v = (low + high) / 2
    # gamma is at most quadratic in the distance to its end, so a rounding of tau moves v by 2 v/(end - tau) of it
    error = high - low + EPSILON * (8 * v + 4 * v * abs(tau) / (end - tau))
    return Threshold(np.float64(v), np.float64(error), np.int8(Status.complete))


def _lifts(osc: Oscillator, tau: float, v: float, end: float, impacts: int) -> bool | None:
    """Whether contact is lost before chatter from (tau, v) completes; None when the impacts flown do not tell."""
    lost = 1 - as_float(osc.slope_at_rest())
    block, remaining = SEARCH.block, impacts
    while remaining > 0:
        found = sequence(osc, tau, v, block)
        if found.status or np.any(found.tau >= end):
            return True
        with np.errstate(divide="ignore"):
            left = -2 * found.v[:-1] / (found.acceleration[1:] * lost)
        if np.any(left < SEARCH.short * (end - found.tau[:-1])):
            return False
        tau, v = float(found.tau[-1]), float(found.v[-1])
        block, remaining = min(2 * block, SEARCH.longest), remaining - block
    return None


def _refined(osc: Oscillator, place: Any, rough: Threshold, digits: int) -> Threshold:
    """Gamma repels: the more impacts are flown, the less it matters how well its end is known."""
    import mpmath

    with mpmath.workdps(digits + 20):
        tau, v = as_mpf(place, mpmath.mp), mpmath.mpf(float(rough.v))
        goal = _Gamma(osc, release(osc, float(tau)))
        small, change = mpmath.mpf(10) ** (-digits - 1), mpmath.inf
        for count in range(SEARCH.first, SEARCH.rounds, SEARCH.more):
            miss, slope = goal.miss(tau, v, count)
            last, change = change, abs(miss / slope)
            v -= miss / slope
            if max(change, last * change / v) < small * v and last < mpmath.mpf(10) ** (-digits // 2) * v:
                break
    with mpmath.workdps(digits):
        return Threshold(+v, 2 * change + small * v, np.int8(Status.complete))


class _Gamma:
    """The end of gamma at a tangency, v = g_2 sigma^2 + g_3 sigma^3 + ..., at the working precision."""

    def __init__(self, osc: Oscillator, tau: float) -> None:
        import mpmath

        self.osc, ring = osc, Multiprecision(mpmath.mp)
        self.tau = mpmath.mpf(tau)
        for _ in range(4 + mpmath.mp.dps // 15):
            value, slope = acceleration_jet(osc, self.tau, 1, ring)
            self.tau -= value / slope
        _, a1, a2 = acceleration_jet(osc, self.tau, 2, ring)
        r = as_mpf(osc.slope_at_rest(), mpmath.mp)
        root = mpmath.findroot(lambda x: x * x * (x + 2) - r * (2 * x + 1), float(np.sqrt(float(r))))
        damping = force_jet(osc, 0, 2, ring).get((0, 1), mpmath.mpf(0))
        self.g2 = a1 * (1 - root) * (2 + root) / 6
        self.g3 = self.g2 * (6 * a2 - a1 * damping) / (8 * a1)

    def miss(self, tau: Any, v: Any, count: int) -> tuple[Any, Any]:
        """v - gamma after `count` impacts, and its derivative by the first v."""
        import mpmath

        column = np.array([0.0, 1.0])
        for _ in range(count):
            column = derivative(self.osc, float(tau), float(v)).matrix @ column
            step = impact_map(self.osc, tau, v, digits=mpmath.mp.dps - 5)
            tau, v = step.tau, step.v
        sigma = tau - self.tau
        along = 2 * self.g2 * sigma + 3 * self.g3 * sigma**2
        return v - sigma**2 * (self.g2 + self.g3 * sigma), float(column[1]) - along * float(column[0])
