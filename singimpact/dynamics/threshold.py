"""The velocity of gamma at a phase: chatter completes below it, and is interrupted by lift-off above it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto
from functools import lru_cache
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import Expression
from singimpact.algebra.numbers import EPSILON, Array, as_float, as_mpf, compare, constant
from singimpact.algebra.precision import digits_at, for_user
from singimpact.contact.zero_ahead import ContactZero, next_zero
from singimpact.dynamics import enclosed
from singimpact.dynamics.remaining import chatter_completes, power_of_gamma, rest_after
from singimpact.flights.blocks import gathered
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.derivative import derivative
from singimpact.flights.flat_numbers import gap_of
from singimpact.flights.impact_map import checked_digits, impact_map
from singimpact.flights.kernels.gamma import TERMS_OF_GAMMA
from singimpact.flights.orbits import orbit_segment
from singimpact.flights.states import require_room
from singimpact.inputs import InputError, checked_keywords, takes_two_walls, whole
from singimpact.oscillator.model import Oscillator, require_rebound, require_smooth_rho
from singimpact.oscillator.wall_acceleration import acceleration, sign_of_acceleration
from singimpact.result import Result, in_words
from singimpact.status import Status, Wall
from singimpact.theory.contact_points import Place
from singimpact.theory.formulas import curve_at


@dataclass(frozen=True)
class Search:
    """Settings of the decision on which side of gamma an orbit is, and of the bracket of v."""

    narrow: float = 4 * EPSILON  # relative width of the last bracket; rounding errors decide in narrower ones
    # impacts of the first block; each block is twice as long as the one before, up to the longest
    block: int = 16
    longest: int = 4096
    impacts: int = 640_000  # default limit for one velocity; r = 0.9999 takes 400 000
    # chatter completes if its predicted time is below this part of the time to the end of gamma; on gamma the part is
    # above 2/(j + 2) at contact order j
    short: float = 1 / 64
    # where r = 1 that part is 3/(3 + (2 + q) j) on gamma, above 1/(j + 1); speeds fall so slowly that 1/64 comes late
    part: float = 8.0
    # halvings towards undecided velocities where r = 1: impacts until a side is decided grow like a power of 1/distance
    elastic: int = 8
    edges: int = 40  # bisections towards velocities whose side doubles do not decide
    widest: float = 1e-3  # relative error of v at most; the status is `unresolved` beyond it
    # relative width of the bracket in which Newton's method starts; the series of gamma applies at a distance ten times
    # larger
    coarse: float = 2.0**-12
    bits: int = 128  # of the balls in which that series is computed
    # nonlinear models: width of the bracket in which Newton's method starts, half widths about its root
    rough: float = 2.0**-5
    widths: tuple[float, ...] = (2 * EPSILON, 16 * EPSILON, 256 * EPSILON)
    over: float = 1e-3  # a chatter is over for this when less is left of it, of the time on which a_c changes


SEARCH = Search()

# Status -> why a threshold has no velocity
NOTES = {
    int(Status.none): "a_c has no zero ahead into which gamma runs, so that a chatter here comes to rest",
    int(Status.unresolved): "the next zero of a_c, its order, or the two sides of gamma are not decided",
}


@dataclass(frozen=True, repr=False)
class Threshold(Result):
    """The velocity `v`, an estimate of its `error`, and a status: `complete`; `none` where no gamma lies ahead;
    `other_wall` where a second wall is met from v on, below gamma;
    `unresolved` where the next zero of a_c, its contact order or the two sides of gamma are not decided.

    `certified` is v with a proved radius, with digits= where the restitution is a number: the interval contains a
    velocity from which chatter completes and one from which the mass lifts off before.
    """

    v: Any
    error: Any
    status: Any
    certified: Any = None

    @property
    def note(self) -> str:
        """Why there is no velocity; "" where there is one, and for an array."""
        return NOTES.get(int(self.status), "") if np.ndim(self.status) == 0 else ""

    def __repr__(self) -> str:
        return f"{in_words(self)}{f': {self.note}' if self.note else ''}"


@checked_keywords
@takes_two_walls
def threshold(
    osc: Oscillator, tau: Any, *, digits: int | None = None, impacts: int = SEARCH.impacts, wall: object = None
) -> Threshold:
    """The velocity on gamma at tau: its orbit converges to the next zero of a_c.

    Gamma ends where a_c rises through zero (contact order 1, 3, ...) or touches it from below (2, 4, ...: a swan).

    Parameters
    ----------
    osc : the model, r < 1, or r = 1 with a loss C |v|^q, q < 1, at low speed.
    tau : a phase with a_c(tau) < 0, or an array of them: the fields then have its shape.
    digits : decimal digits; v is then an mpmath number.
    impacts : at most for one velocity; if they do not decide the side the status is `unresolved`.
    wall : of a model with two: "lower" (also without it) or "upper". Gamma is that of this wall alone; chatter from
        64 speeds below it is looked at, and where one meets the other wall v is the least such speed, in doubles.

    Examples
    --------
    >>> found = threshold(Oscillator("x", "cos(2.8*t)", 0, "0.5"), "pi/2.8")
    >>> print(f"{found.v:.13f}")
    0.1008699912693
    """
    osc = osc.seen_from(wall)
    if isinstance(tau, list | tuple | np.ndarray) and np.ndim(tau):
        require_room(("tau", tau))
        thresholds = [threshold(osc, one, digits=digits, impacts=impacts) for one in np.asarray(tau).ravel().tolist()]
        return gathered(Threshold, thresholds, np.shape(tau))  # type: ignore[no-any-return]
    if osc.upper is not None:
        alone = threshold(osc.one_wall(), tau, digits=digits, impacts=impacts)
        return _between_walls(osc, constant("tau", tau), replace(alone, certified=None))
    require_rebound(osc, "a threshold between complete and incomplete chatter")
    phase, most = constant("tau", tau), whole("impacts", impacts, 1, 10**7)
    if sign_of_acceleration(osc, phase) >= 0:
        raise InputError(
            f"tau = {tau} is not accepted: give a phase with a_c(tau) < 0, at which a mass at rest stays on the wall"
        )
    if not chatter_completes(osc):
        raise InputError(
            f"restitution = {osc.restitution} is not accepted: chatter completes only for rho'(0) > -1, or where the "
            "loss at low speed is C |v|^q with q < 1"
        )
    if digits is not None:
        require_smooth_rho(osc, "a threshold with digits=")
    ahead = next_zero(osc, phase)
    if ahead.zero is None:
        return _without(Status.none if ahead.decided else Status.unresolved)
    rough = _bisected(osc, as_float(phase), ahead.zero, most)
    if digits is None or rough.status != Status.complete:
        return rough
    return _enclosed(osc, phase, rough, ahead.zero, checked_digits(digits)) or _refined(
        osc, phase, rough, ahead.zero, digits
    )


def _between_walls(osc: Oscillator, phase: Expression, alone: Threshold) -> Threshold:
    """The threshold of the lower wall alone, or the least launch speed from which the upper wall is met before.

    Parameters
    ----------
    osc : with two walls. alone : the threshold of the model with the lower one.
    """
    ahead, tau = next_zero(osc, phase), as_float(phase)
    end = np.inf if ahead.zero is None else ahead.zero.tau
    if alone.status == Status.unresolved:
        return alone

    def is_met(v: float) -> bool:
        start, speed = tau, v
        for count, over in ((SEARCH.longest, SEARCH.over), (1, 0.0)):  # flights of the rest are lower than its first
            segment = orbit_segment(osc, start, speed, count, over)
            if ((segment.wall == Wall.upper) & (segment.tau < end)).any():
                return True
            if segment.tau.size:
                start, speed = float(segment.tau[-1]), float(segment.v[-1])
        return False

    top = float(alone.v)
    if alone.status == Status.none:
        top = float(np.sqrt(-2 * acceleration(osc, np.array([tau]))[0] * gap_of(osc)[0]))
        while not is_met(top) and top < 1e12:
            top *= 2
    # launch speeds up to gamma whose chatter is looked at for impacts with a second wall
    speeds = np.linspace(0.0, top, 65).tolist()
    first = next((at for at, v in enumerate(speeds[1:], start=1) if is_met(v)), None)
    if first is None:
        return alone
    low, high = speeds[first - 1], speeds[first]
    # halvings of the step in which such an impact appears
    for _ in range(60):
        middle = (low + high) / 2
        if not low < middle < high:
            break
        low, high = (low, middle) if is_met(middle) else (middle, high)
    # the height of a flight is known to roundings of both places, and rises with v like the time to its highest point
    size = gap_of(osc)[0] + 2 * abs(as_float(osc.clearance)) + high**2
    error = high - low + 128 * EPSILON * (high + size / high)
    return Threshold(np.float64(high), np.float64(error), np.int8(Status.other_wall))


def _without(status: Status) -> Threshold:
    return Threshold(np.nan, np.nan, np.int8(status))


def _enclosed(osc: Oscillator, place: Expression, rough: Threshold, end: ContactZero, digits: int) -> Threshold | None:
    """The threshold in balls, where the model allows it."""
    found = enclosed.threshold(osc, place, rough.v, end, digits) if enclosed.enclosable(osc) else None
    if found is None:
        return None
    with digits_at(digits) as mp:
        value, radius = mp.convert(found.value), mp.convert(found.radius)
        error = radius + abs(value) * mp.mpf(10) ** -digits
        return Threshold(for_user(+value), for_user(error), np.int8(Status.complete), found)


class _Side(Enum):
    """The side of an orbit: chatter completes before the end of gamma; the orbit passes the end; doubles do not decide
    one of its flights; or the impacts flown do not decide."""

    below = auto()
    above = auto()
    near = auto()
    exhausted = auto()


def _bisected(osc: Oscillator, tau: float, zero: ContactZero, impacts: int) -> Threshold:
    sides, end = _Sides(osc, tau, zero, impacts), zero.tau
    low, high = 0.0, -float(acceleration(osc, np.array([tau]))[0]) * (end - tau) / 4
    if not 0 < high < np.inf:
        return _without(Status.unresolved)
    while (side := sides.of(high)) != _Side.above:
        low, high = high, 2 * high
        if side != _Side.below or high > 1e12:
            return _without(Status.unresolved)
    low, high = sides.bracket(low, high)
    rough = sides.reach > 0
    while high - low > SEARCH.narrow * high:
        if rough and high - low < SEARCH.rough * high:
            low, high, rough = *sides.around_root(low, high), False
            continue
        middle = (low + high) / 2
        side = sides.of(middle)
        if side == _Side.exhausted and not sides.elastic:
            return _without(Status.unresolved)
        if side in (_Side.near, _Side.exhausted):
            low, high = (sides.edge(decided, middle) for decided in (low, high))
            break
        low, high = (low, middle) if side == _Side.above else (middle, high)
    v = (low + high) / 2
    # v on gamma is proportional to (end - tau)^n: a rounding error of tau is multiplied by n v/(end - tau)
    n = power_of_gamma(osc, zero.order)
    error = high - low + EPSILON * (8 * v + 2 * n * v * abs(tau) / (end - tau))
    if not error < SEARCH.widest * v:
        return _without(Status.unresolved)
    return Threshold(np.float64(v), np.float64(error), np.int8(Status.complete))


class _Sides:
    """The sides of gamma on which velocities at one phase lie."""

    def __init__(self, osc: Oscillator, tau: float, zero: ContactZero, impacts: int) -> None:
        self.osc, self.tau, self.zero, self.impacts = osc, tau, zero, impacts
        self.end, self.elastic = zero.tau, compare(osc.slope_at_rest(), 1) == 0
        self.model = compiled_model(osc)
        smooth = self.model.constant_restitution and not self.elastic and abs(tau) < self.model.nearest
        reach, balls = _series(osc, replace(zero, turns=0)) if smooth else (0.0, [0.0] * TERMS_OF_GAMMA)
        self.reach, self.series = reach, [float(ball) for ball in balls]

    def bracket(self, low: float, high: float) -> tuple[float, float]:
        """The narrowest bracket of gamma that the compiled loop of a linear model decides."""
        # the loop knows the time left of a chatter from r alone
        if abs(self.tau) >= self.model.nearest or not self.model.linear or self.elastic:
            return low, high
        settings = SEARCH.short, SEARCH.narrow, float(self.impacts), SEARCH.coarse
        series, ahead = (self.reach, float(self.zero.order), *self.series), self.end - self.tau
        brackets = self.model.brackets(np.array([self.tau]), np.array([[low, high, ahead]]), (*settings, *series))
        return (low, high) if brackets is None else (float(brackets[0][0, 0]), float(brackets[0][0, 1]))

    def around_root(self, low: float, high: float) -> tuple[float, float]:
        """A narrow bracket about the velocity from which an orbit meets the series of gamma, or else the given one."""
        v = (low + high) / 2
        # steps of Newton's method
        for _ in range(8):
            change = self.miss(v)
            v = min(max(v - change, low), high)
            if abs(change) <= SEARCH.narrow * v:
                break
        for width in SEARCH.widths:
            below, above = v * (1 - width), v * (1 + width)
            if low < below and above < high and self.of(below) == _Side.below and self.of(above) == _Side.above:
                return below, above
        return low, high

    def miss(self, v: float) -> float:
        """The distance in v from the series of gamma where an orbit comes near the end, over its derivative by v."""
        segment = orbit_segment(self.osc, self.tau, v, SEARCH.block)
        taus, speeds = np.append(self.tau, segment.tau), np.append(v, segment.v)
        if not (near := np.flatnonzero((self.end - taus < self.reach) & (taus < self.end))).size:
            return np.inf
        column, count = np.array([0.0, 1.0]), int(near[0])
        for matrix in derivative(self.osc, taus[:count], speeds[:count]).matrix if count else ():
            column = matrix @ column
        miss, slope = _miss(taus[count] - self.end, speeds[count], column, (self.zero.order + 1, self.series))
        return float(miss / slope) if slope else np.inf

    def edge(self, decided: float, near: float) -> float:
        """A velocity whose side is decided, next to the interval around gamma in which it is not.

        Parameters
        ----------
        decided, near : a velocity whose side is decided, and one where it is not.
        """
        for _ in range(SEARCH.elastic if self.elastic else SEARCH.edges):
            middle = (decided + near) / 2
            if self.of(middle) in (_Side.below, _Side.above):
                decided = middle
            else:
                near = middle
        return decided

    def of(self, v: float) -> _Side:
        """The side on which v lies."""
        osc, tau, end = self.osc, self.tau, self.end
        short = 1 / (SEARCH.part * (self.zero.order + 1)) if self.elastic else SEARCH.short
        block, remaining = SEARCH.block, self.impacts
        while remaining > 0:
            segment = orbit_segment(osc, tau, v, block)
            if np.any(segment.tau >= end):
                return _Side.above
            left = rest_after(osc, segment.v[:-1], segment.acceleration[1:])
            pressed = segment.acceleration[1:] < 0
            if np.any(pressed & (left < short * (end - segment.tau[:-1]))):
                return _Side.below
            if segment.tau.size:
                tau, v = float(segment.tau[-1]), float(segment.v[-1])
            if segment.status:
                if segment.status != Status.unresolved:
                    return _Side.above
                # undecided, or an overflow long after the end: only the motion before the end of gamma matters
                step = impact_map(osc, tau, v, horizon=max(end - tau, EPSILON * abs(end)))
                if step.status in (Status.no_return, Status.escaped):
                    return _Side.above
                if step.status != Status.hit:
                    return _Side.near
                tau, v = float(step.tau), float(step.v)
            block, remaining = min(2 * block, SEARCH.longest), remaining - block
        return _Side.exhausted


@lru_cache(maxsize=256)
def _series(osc: Oscillator, zero: ContactZero, bits: int = SEARCH.bits) -> tuple[float, list[Any]]:
    """The distance from the end of gamma within which the series has half of the bits, or 0; the coefficients."""
    first, last = zero.order + 1, zero.order + TERMS_OF_GAMMA
    graph = curve_at(Place(osc, zero.order, None, zero), last, Balls(bits)).graph
    g = [graph[n].mid() for n in range(first, last + 1)]
    if not (all(ball.is_finite() for ball in g) and float(g[0])):
        return 0.0, g
    # the last two coefficients, because every other one vanishes for symmetric forcing; further ones are taken as large
    wanted = EPSILON / 4 if bits == SEARCH.bits else 2.0 ** (32 - bits)
    sizes = [(wanted * abs(float(g[0] / g[n]))) ** (1 / (n + 1)) for n in (len(g) - 2, len(g) - 1) if float(g[n])]
    return min(sizes, default=1.0), g


def _refined(osc: Oscillator, phase: Any, rough: Threshold, end: ContactZero, digits: int) -> Threshold:
    """The threshold in many digits: Newton's method for the velocity from which an orbit meets the series of gamma."""
    with digits_at(digits + 20) as mp:
        start, v, small = as_mpf(phase, mp), mp.mpf(float(rough.v)), mp.mpf(10) ** (-digits - 1)
        bits, change = mp.prec + 32, mp.mpf(float(rough.error))
        reach, balls = _series(osc, end, bits)
        stop, g = _middle(end.moved(bits), mp), [_middle(ball, mp) for ball in balls] if reach else []
        # steps of Newton's method, each of which gives ten digits
        for _ in range(100 if reach else 0):
            tau, speed, column = start, v, np.array([0.0, 1.0])
            # as far as the orbit is beside gamma for all that is known of v
            while stop - tau >= reach and 0 < abs(column[1] * change) < speed / 100:
                column = derivative(osc, float(tau), float(speed)).matrix @ column
                step = impact_map(osc, tau, speed, digits=mp.dps - 5)
                tau, speed = mp.convert(step.tau), mp.convert(step.v)
            miss, slope = _miss(tau - stop, speed, column, (end.order + 1, g))
            # Newton's method goes elsewhere, or its slope is below the range of doubles
            if not slope or not abs(miss / slope) < rough.v / 2:
                break
            change = miss / slope
            v -= change
            if abs(change) < small * v:
                with digits_at(digits):
                    return Threshold(for_user(+v), for_user(2 * abs(change) + small * v), np.int8(Status.complete))
    return _without(Status.unresolved)


def _miss(sigma: Any, v: Any, column: Array, series: tuple[int, Sequence[Any]]) -> tuple[Any, float]:
    """The distance of a state at sigma and v from gamma, and its derivative by the first velocity.

    Parameters
    ----------
    column : the derivatives of this state by the first velocity. series : the lowest power, and coefficients.
    """
    first, g = series
    along = sum(c * (first + k) * sigma ** (first + k - 1) for k, c in enumerate(g))
    slope = float(column[1]) - float(along) * float(column[0])
    return v - sum(c * sigma ** (first + k) for k, c in enumerate(g)), slope


def _middle(ball: Any, mp: Any) -> Any:
    value = as_rational(ball)
    return mp.mpf(value.numerator) / value.denominator
