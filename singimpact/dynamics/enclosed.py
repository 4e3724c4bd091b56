"""Chatter limits and thresholds, enclosed: flights in balls, and the rest of a chatter between bounds.

While a_c stays between -A and -a on what is left of a chatter and q = A/a (both enlarged for damping and height), each
flight takes between 2v/A and 2v/a and returns between v/q and q v.  So the rest lies between 2v/(A (1 - r/q)) and
2v/(a (1 - r q)): its width is of second order in v, and half the digits asked for have to be flown.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from math import ceil, log, log2
from typing import Any, TypeVar

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.certified import Certified, as_certified, from_ends
from singimpact.algebra.expressions import Expression, evaluate, names_in
from singimpact.algebra.numbers import as_float, sign_of
from singimpact.algebra.precision import Ladder, balls_at
from singimpact.contact.zero_ahead import ContactZero
from singimpact.flights.enclosures.analytic_flow import AnalyticFlow
from singimpact.flights.orbits import orbit_segment
from singimpact.flights.states import States
from singimpact.oscillator.model import Oscillator
from singimpact.theory.contact_points import Place
from singimpact.theory.formulas import curve_at
from singimpact.theory.gamma_series import multiplier_across

# A velocity near gamma in many digits: its orbit is flown to where the series of gamma is as good.
#
# Each impact multiplies the relative distance from gamma, and takes the orbit nearer to the end of gamma: some thirty
# flights give thirty digits.  Doubles say beforehand how many, and with which slope the miss answers to the velocity.
# Nothing is proved here.


@dataclass(frozen=True)
class GuideSettings:
    """Settings of an orbit along gamma.

    Parameters
    ----------
    terms : of the series of gamma, and one more for so many digits. impacts : flown in doubles at most.
    rough : the relative error of a velocity in doubles. drift : the largest relative distance from gamma.
    spare : digits beyond those asked for.
    """

    terms: int = 12
    digits: int = 3
    impacts: int = 400
    rough: float = 1e-14
    drift: float = 1e-3
    spare: int = 4


SETTINGS = GuideSettings()


@dataclass(frozen=True)
class Guide:
    """An orbit along gamma.

    Parameters
    ----------
    series : coefficients of gamma in balls, from sigma^(j + 1) on. order : j. end : of gamma, a ball.
    impacts : flown before v is compared with the series. slope : of the difference by the first v.
    growth : of the logarithm to base 2 of the relative distance from gamma, by an impact.
    """

    series: tuple[Any, ...]
    order: int
    end: Any
    impacts: int
    slope: float
    growth: float


@lru_cache(maxsize=64)
def _series(osc: Oscillator, end: ContactZero, terms: int, bits: int) -> tuple[Any, ...]:
    """`terms` coefficients of gamma at its end, in balls."""
    curve = curve_at(Place(osc, end.order, None, end), end.order + terms, Balls(bits))
    return tuple(curve.graph[n] for n in range(end.order + 1, end.order + terms + 1))


def guided(osc: Oscillator, tau: Expression, v: float, end: ContactZero, digits: int) -> Guide | None:
    """The guide from (tau, v) along gamma for so many digits; None where doubles do not get there.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> from singimpact.contact.zero_ahead import next_zero
    >>> osc, tau = Oscillator("x", "cos(2.8*t)", 0, "0.5"), constant("tau", "pi/2.8")
    >>> found = guided(osc, tau, 0.10086999126925593, next_zero(osc, tau).zero, 30)
    >>> 5 < found.impacts < 40
    True
    """
    bits = ceil(digits * 3.33) + 64
    series = _series(osc, end, SETTINGS.terms + digits // SETTINGS.digits, bits)
    g, j, r = [float(coefficient.mid()) for coefficient in series], end.order, as_float(osc.restitution)
    segment = orbit_segment(osc, as_float(tau), v, SETTINGS.impacts)
    wanted, column, sizes, chosen = v * 10.0 ** -(digits + SETTINGS.spare), (0.0, 1.0), [], None
    rows = zip(segment.tau.tolist(), segment.v.tolist(), segment.slopes.T.tolist(), strict=True)
    for n, (time, speed, (a, b, c, d)) in enumerate(rows, 1):
        sigma = time - end.tau
        # D G of each impact applied to (0, 1): how the state answers to the first velocity
        column = (1 + a) * column[0] + b * column[1], -r * (c * column[0] + d * column[1])
        along = sum((j + 1 + i) * coefficient * sigma ** (j + i) for i, coefficient in enumerate(g))
        slope = column[1] - along * column[0]
        # beyond this the distance from gamma has grown so far that the doubles of the guide tell nothing
        if not (sigma < 0 < speed and abs(slope) * SETTINGS.rough * v < SETTINGS.drift * speed):
            break
        sizes.append(abs(slope) / speed)
        cut = max(abs(coefficient * sigma ** (j + 1 + i)) for i, coefficient in enumerate(g[-2:], len(g) - 2))
        if chosen is None and cut < wanted * abs(slope):
            chosen = n, slope
    if chosen is None or not sizes[-1] > sizes[len(sizes) // 2]:
        return None
    growth = log2(sizes[-1] / sizes[len(sizes) // 2]) / (len(sizes) - 1 - len(sizes) // 2)
    return Guide(series, j, end.moved(bits), *chosen, growth)


def spread(flow: AnalyticFlow, tau: Expression, v: Fraction, guide: Guide, digits: int) -> int:
    """Bits that balls lose on the way of an orbit which leaves gamma, a velocity apart from it by the last digit."""
    time, speed, widths = evaluate(tau, {}, flow.balls), flow.number(v), []
    for _ in range(guide.impacts):
        hit = flow.first_hit(time, speed)
        if hit is None or hit.time is None:
            break
        time, speed = time + hit.time, -flow.r * hit.velocity
        widths.append(-speed.rel_accuracy_bits())
    half = len(widths) // 2
    # so many flights show how balls spread
    if len(widths) < 6:
        return 0
    by_impact = float(widths[-1] - widths[half]) / (len(widths) - 1 - half)
    return ceil((digits + 1) * log2(10) / guide.growth * by_impact)


def newton(flow: AnalyticFlow, tau: Expression, rough: float, guide: Guide, digits: int) -> Fraction | None:
    """The velocity on gamma to so many digits, by Newton's method on the miss after the flights of a guide."""
    start, v = evaluate(tau, {}, flow.balls).mid(), flow.number(Fraction(rough))
    small, last = Fraction(1, 10 ** (digits + SETTINGS.spare - 1)), None
    # steps of Newton's method
    for _ in range(8):
        miss = _miss(flow, start, v, guide)
        if miss is None:
            return None
        change = (miss / guide.slope).mid()
        v, size = (v - change).mid(), abs(as_rational(change / v))
        if last is not None and min(size, size * size / last if last else 0) < small:
            return as_rational(v) if v > 0 else None
        if not size < SETTINGS.drift:
            return None
        last = size
    return None


def _miss(flow: AnalyticFlow, time: Any, speed: Any, guide: Guide) -> Any | None:
    """v - gamma after the flights; None where one is not decided or passes the end."""
    for _ in range(guide.impacts):
        hit = flow.first_hit(time, speed, guide.end - time)
        if hit is None or hit.time is None:
            return None
        time, speed = (time + hit.time).mid(), (-flow.r * hit.velocity).mid()
    sigma, total = time - guide.end, flow.number(Fraction(0))
    for coefficient in reversed(guide.series):
        total = total * sigma + coefficient
    return speed - total * sigma ** (guide.order + 1)


Found = TypeVar("Found")


@dataclass(frozen=True)
class BallOrbits:
    """Limits of the cost of an enclosed orbit.

    Parameters
    ----------
    impacts : flown at most; r = 0.999 to 30 digits takes 35 000. bits : of the balls at most, per digit asked for.
    spare : bits beside the digits. wide : the window on which the rest is bounded, in units of its first guess.
    """

    impacts: int = 200_000
    bits: int = 64
    spare: int = 64
    wide: int = 3


ORBITS = BallOrbits()


def enclosable(osc: Oscillator) -> bool:
    """Whether orbits of a model can be flown in balls: its restitution is a number below 1."""
    return not names_in(osc.restitution) and as_float(osc.restitution) < 1


def with_more_bits(
    attempt: Callable[[AnalyticFlow], Found | None], osc: Oscillator, digits: int, expected: int = 0
) -> Found | None:
    """attempt(flow) at growing precision, from that which is expected to be enough, until it decides."""
    first = max(ceil(digits * 3.33), expected) + ORBITS.spare
    for bits in Ladder(first, ORBITS.bits * (digits + 32)):
        with balls_at(bits):
            answer = attempt(AnalyticFlow(osc, bits))
        if answer is not None:
            return answer
    return None


@dataclass(frozen=True)
class EnclosedLimit:
    """Where a chatter ends: the time, the impacts flown, and whether contact was lost there instead."""

    tau: Certified
    impacts: int
    lost: bool


def chatter_limit(osc: Oscillator, states: States, digits: int) -> EnclosedLimit | None:
    """The accumulation time of chatter, or the impact at which a_c no longer presses; None when neither was proved.

    Parameters
    ----------
    osc : the model. states : one launch, see `States.of`. digits : of the result.

    Examples
    --------
    >>> osc = Oscillator("x", "cos(2.8*t)", 0, "0.8")
    >>> print(chatter_limit(osc, States.of(osc, "0.9", "0.005"), 30).tau)
    0.959359234422082626031840228653
    """
    tau, v, removed = states.exact_tau(0), states.exact_v(0), 1
    if not sign_of(v):
        if states.rest[0].sign <= 0:
            return None
        removed = states.rest[0].order + 2
    return with_more_bits(lambda flow: _chatter(flow, tau, v, removed, digits), osc, digits)


def _chatter(flow: AnalyticFlow, tau: Expression, v: Expression, removed: int, digits: int) -> EnclosedLimit | None:
    time, speed = (evaluate(tree, {}, flow.balls) for tree in (tau, v))
    slow: Any = None
    for count in range(ORBITS.impacts):
        a = flow.acceleration(time)
        if count and not (a > 0 or a < 0):
            return None  # whether contact is lost at this impact is not decided
        if count and a > 0:
            end = as_certified(time, digits)
            return None if end is None else EnclosedLimit(end, count, True)
        if a < 0 and (slow is None or speed < slow) and (left := remaining(flow, time, speed)) is not None:
            end = as_certified(time + left, digits)
            if end is not None:
                return EnclosedLimit(end, count, False)
            if left.rad() < time.rad():
                return None  # the flights have lost the digits, and further ones do not give them back
            # the width falls like v^2: it is not looked at again until it is nearly small enough
            wanted = max(abs(time + left).upper() / 10**digits, time.rad())
            # at twice the velocity at which bounds are expected to be narrow enough they are made next
            slow = 2 * speed * (wanted / left.rad()).sqrt()
        hit = flow.first_hit(time, speed, removed=removed)
        if hit is None or hit.time is None:
            return None
        time, speed, removed = time + hit.time, -flow.r * hit.velocity, 1
        if not speed > 4 * speed.rad():
            return None
    return None


def remaining(flow: AnalyticFlow, tau: Any, v: Any) -> Any | None:
    """A ball that contains what is left of a chatter from (tau, v); None when the bounds do not close.

    The bounds hold on a window; they close when what is left, by these bounds, fits into the window.
    """
    window = (ORBITS.wide * 2 * v / (abs(flow.acceleration(tau)) * (1 - flow.r))).upper()
    # |x-dot| <= 2v and 0 <= x - c <= v window on the way, which q < 2 below confirms
    low, high = flow.pressing(tau, window, v)
    if not low > 0:
        return None
    q = high / low
    if not (q < 2 and flow.r * q < 1):
        return None
    least, most = 2 * v / (high * (1 - flow.r / q)), 2 * v / (low * (1 - flow.r * q))
    return least.union(most) if most < window else None


def threshold(osc: Oscillator, tau: Expression, rough: Any, end: ContactZero, digits: int) -> Certified | None:
    """The v over tau in radius of which lie one from which chatter completes before `end` and one that flies
    past it: both proved.

    Parameters
    ----------
    rough : the v found in doubles. end : the zero of a_c into which gamma runs.
    """
    guide = guided(osc, tau, float(rough), end, digits)
    near, lost = None, 0
    if guide is not None:
        bits = ceil(digits * 3.33) + ORBITS.spare
        with balls_at(bits):
            flow = AnalyticFlow(osc, bits)
            near = newton(flow, tau, float(rough), guide, digits)
            lost = 0 if near is None else spread(flow, tau, near, guide, digits)
    if near is None:
        near = with_more_bits(lambda flow: _searched(_Gamma(osc, flow, end), tau, rough, digits), osc, digits)
    if near is None:
        return None
    margin = abs(near) / (4 * 10**digits)

    def side_of(v: Fraction) -> int | None:
        def attempt(flow: AnalyticFlow) -> int | None:
            return side(flow, end.moved(flow.balls.bits), evaluate(tau, {}, flow.balls), flow.number(v))

        return with_more_bits(attempt, osc, digits, lost)

    low, high = near - margin, near + margin
    return from_ends(low, high, digits) if side_of(low) == -1 and side_of(high) == 1 else None


def end_of_gamma(osc: Oscillator, end: ContactZero, bits: int) -> tuple[Any, Any, Any]:
    """The first two coefficients of gamma at the zero of a_c where it ends, and lambda, in balls of `theory.gamma`.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> from singimpact.contact.zero_ahead import next_zero
    >>> osc = Oscillator("x + 0.1*xdot", "cos(2*t)", "0.3", "1/2")
    >>> [round(float(part.mid()), 12) for part in end_of_gamma(osc, next_zero(osc, constant("tau", 1)).zero, 128)]
    [0.287254555699, -0.071343715825, 0.660442249724]
    """
    j, balls = end.order, Balls(bits)
    curve = curve_at(Place(osc, j, None, end), j + 2, balls)
    return curve.graph[j + 1], curve.graph[j + 2], curve.lambda_


class _Gamma:
    """gamma near its end, v = sigma^(j+1) (first + second sigma) + ..., and the flights that follow it, in balls."""

    def __init__(self, osc: Oscillator, flow: AnalyticFlow, end: ContactZero) -> None:
        self.flow, self.order, self.end = flow, end.order, end.moved(flow.balls.bits)
        self.first, self.second, self.rate = end_of_gamma(osc, end, flow.balls.bits)

    def missed(self, tau: Any, impacts: int, start: Fraction) -> Any | None:
        """v - gamma after some impacts; None when a flight was not decided or passes the end."""
        v = self.flow.number(start)
        for _ in range(impacts):
            hit = self.flow.first_hit(tau, v, self.end - tau)
            if hit is None or hit.time is None:
                return None
            tau, v = tau + hit.time, -self.flow.r * hit.velocity
        sigma = tau - self.end
        return v - sigma ** (self.order + 1) * (self.first + self.second * sigma)


def _searched(gamma: _Gamma, tau: Expression, rough: Any, digits: int) -> Fraction | None:
    """A v near gamma, by secants: nothing is proved here."""
    start, balls = evaluate(tau, {}, gamma.flow.balls), gamma.flow.balls
    return searched(partial(gamma.missed, start), Fraction(float(rough)), (gamma.order, gamma.rate), digits, balls)


def searched(
    missed: Callable[[int, Fraction], Any], rough: Fraction, contact: tuple[int, Any], digits: int, balls: Balls
) -> Fraction | None:
    """A positive number at which an orbit runs along gamma, by secants; None where these balls do not give it.

    Parameters
    ----------
    missed : how far from gamma's first two terms the orbit of a number is after so many impacts; None: not known.
        The more impacts, the less the cut of gamma matters.
    rough : the number in doubles. contact : order of the zero where gamma ends, and lambda there. digits : wanted.
    """
    rate = float(contact[1].mid())
    forgotten = max(rate**2 / multiplier_across(contact[0], rate), 1e-300)  # by each impact, of the error in the cut
    most = ceil((digits + 3) * log(10) / -log(forgotten))
    # impacts along gamma in the first search: they shrink sigma to a twelfth, so that the two terms come near to it for
    # r near 1 too, where each impact shrinks it by little
    v, impacts, step = rough, max(6, ceil(2.4 / -log(rate))), Fraction(1, 10**12)
    while True:
        impacts = min(impacts, most)
        reached = max(Fraction(forgotten**impacts), Fraction(1, 10 ** (digits + 3))) / 10
        root = _secant(partial(missed, impacts), v, v * step, v * reached, balls)
        if root is None or impacts == most:
            return root
        impacts, step = ceil(impacts * 1.5), max(abs(root - v) / v / 10**4, Fraction(1, 10 ** (2 * digits)))
        v = root


def _secant(
    miss: Callable[[Fraction], Any], v: Fraction, step: Fraction, small: Fraction, balls: Balls
) -> Fraction | None:
    """A zero of miss near v, to `small`; None when it is not defined there, or these balls do not give it so well."""
    other, value = v + step, miss(v)
    # steps of each search
    for _ in range(6):
        beyond = miss(other)
        if value is None or beyond is None or not abs(beyond - value) > 0:
            return None
        change = balls.rational(other - v) * beyond / (beyond - value)
        if not change.is_finite() or change.rad() > balls.rational(small):
            return None
        v, value, other = other, beyond, as_rational(balls.rational(other) - change)
        if abs(other - v) < small:
            break
    return other


def side(flow: AnalyticFlow, end: Any, time: Any, speed: Any) -> int | None:
    """-1 when chatter from a state completes before the end of gamma, 1 when a flight passes it, None undecided.

    Parameters
    ----------
    end : of gamma. time, speed : the state. All are balls.
    """
    for _ in range(ORBITS.impacts):
        if not time < end or not speed > 4 * speed.rad():
            return None
        left = _left_before(flow, time, speed, end)
        if left is not None and time + left < end:
            return -1
        hit = flow.first_hit(time, speed, end - time)
        if hit is None:
            return None
        if hit.time is None or time + hit.time > end:
            return 1
        time, speed = time + hit.time, -flow.r * hit.velocity
    return None


def _left_before(flow: AnalyticFlow, time: Any, speed: Any, end: Any) -> Any | None:
    """`remaining`, where its window lies before a zero of a_c: next to gamma it does not, and no bounds close."""
    a = flow.acceleration(time)
    if not (a < 0 and ORBITS.wide * 2 * speed < -a * (1 - flow.r) * (end - time)):
        return None
    return remaining(flow, time, speed)
