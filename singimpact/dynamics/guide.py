"""A velocity near gamma in many digits: its orbit is flown to where the series of gamma is as good.

Each impact multiplies the relative distance from gamma, and takes the orbit nearer to the end of gamma: some thirty
flights give thirty digits.  Doubles say beforehand how many, and with which slope the miss answers to the velocity.
Nothing is proved here.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import ceil, log2
from typing import Any

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import Expression, evaluate
from singimpact.algebra.numbers import as_float
from singimpact.contact.zero_ahead import ContactZero
from singimpact.flights.enclosures.analytic_flow import AnalyticFlow
from singimpact.flights.orbits import orbit_segment
from singimpact.oscillator.model import Oscillator
from singimpact.theory.contact_points import Place
from singimpact.theory.formulas import curve_at


@dataclass(frozen=True)
class GuideSettings:
    """Settings of an orbit along gamma.

    Parameters
    ----------
    terms : of the series of gamma, and one more for so many digits. impacts : flown in doubles at most.
    rough : the relative error of a velocity in doubles. drift : the largest relative distance from gamma.
    spare : digits beyond those asked for. steps : of Newton's method. least : flights that show how balls spread.
    """

    terms: int = 12
    digits: int = 3
    impacts: int = 400
    rough: float = 1e-14
    drift: float = 1e-3
    spare: int = 4
    steps: int = 8
    least: int = 6


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
    if len(widths) < SETTINGS.least:
        return 0
    by_impact = float(widths[-1] - widths[half]) / (len(widths) - 1 - half)
    return ceil((digits + 1) * log2(10) / guide.growth * by_impact)


def newton(flow: AnalyticFlow, tau: Expression, rough: float, guide: Guide, digits: int) -> Fraction | None:
    """The velocity on gamma to so many digits, by Newton's method on the miss after the flights of a guide."""
    start, v = evaluate(tau, {}, flow.balls).mid(), flow.number(Fraction(rough))
    small, last = Fraction(1, 10 ** (digits + SETTINGS.spare - 1)), None
    for _ in range(SETTINGS.steps):
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
