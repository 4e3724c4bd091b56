"""Whole intervals of a number of the model for which the released orbit comes to rest again, proved.

After an impact the states of all members of an interval lie in one set

    tau = a + b d + e,  v = a' + b' d + e',  |d| <= h,

d the number less that of the middle, h half the length of the interval, with bounds of e and e'; a set that starts as a
parallelogram has two more terms of this kind. The next impact takes this set to another one: its centre is the image of
the middle's, and by the mean value theorem (b, b') is taken by D G, in balls over a box that holds the set; what these
balls are wide joins e. The mass is at rest where a_c presses from an impact up to a zero of a_c, and bounds of what is
left of the chatter end before that zero (`enclosed.side`).

Next to a release x - c is of third order in the time since then, for each member at its own release: terms of second
order, which other members of the box have, are left out.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import number
from singimpact.algebra.numbers import rational_ends
from singimpact.algebra.precision import balls_at
from singimpact.branches.border_digits import presses, rising_zero
from singimpact.branches.resting import Released, Releases, clock
from singimpact.dynamics.enclosed import enclosable, side
from singimpact.dynamics.long_run import rising_zeros
from singimpact.flights.enclosures.analytic_flow import AnalyticFlow
from singimpact.flights.enclosures.certified_hit import Launch, ProvedImpact, certified_hit
from singimpact.flights.enclosures.equation import NoHit, Refused
from singimpact.flights.horizons import horizon_of
from singimpact.inputs import checked_keywords, require, whole
from singimpact.oscillator.model import Oscillator, require_rebound
from singimpact.oscillator.moving_number import with_number
from singimpact.result import Result, Results

BITS, DIGITS = 100, 20  # of balls, and of the flights of middles
AROUND = 7, 10, 13  # a zero of a_c is alone in so much of the period on both sides: powers of 1/2 that are tried
LATE = 30  # impacts, after the first that may be followed by rest, at which bounds of the chatter are tried
WIDE = 3  # sets are followed while the velocity of the middle is so many times the largest distance from it


@dataclass(frozen=True, order=True)
class RestingWindow(Result):
    """An interval of the number, the index of the release, and after how many periods a_c next lifts the mass off.

    For all numbers of low <= number <= high the orbit released at that zero of a_c comes to rest, first before that
    time. `periods` is a whole number where both zeros are one in the period.
    """

    low: Fraction
    high: Fraction
    release: int
    periods: float


class RestingWindows(Results, list[RestingWindow]):
    """Windows in order, those that touch joined.

    Parameters
    ----------
    between : the interval that was searched. releases : in a period.
    """

    called = "windows"

    def __init__(self, windows: Iterable[RestingWindow], between: tuple[Fraction, Fraction], releases: int) -> None:
        super().__init__(windows)
        self.between, self.releases = between, releases

    @property
    def share(self) -> Fraction:
        """Of the interval, times the releases, that the windows cover."""
        return sum(one.high - one.low for one in self) / (self.releases * (self.between[1] - self.between[0]))


class Line(NamedTuple):
    """A phase or a velocity of all members: centre + the sum of slope d + e, |e| <= error, |d| <= its half."""

    centre: Fraction
    slopes: tuple[Fraction, ...]
    error: Fraction

    def reach(self, halves: Sequence[Fraction]) -> Fraction:
        """The largest distance of a member from the centre."""
        return sum((abs(slope) * half for slope, half in zip(self.slopes, halves, strict=True)), self.error)


Lines = tuple[Line, Line]
"""A set of states, (tau, v)."""


@checked_keywords
def resting_windows(
    osc: Oscillator, over: str, between: tuple[Any, Any], *, periods: int = 10, pieces: int = 1000
) -> RestingWindows:
    """Intervals of a number for all of which a released orbit comes to rest again: proved, and not said of others.

    Parameters
    ----------
    osc : analytic, with a period and a number r < 1. over : the number: "clearance", "restitution" or a parameter.
    between : (low, high), rational. periods : within which the orbit rests.
    pieces : the interval is halved where it is not decided, down to its length over `pieces`.

    Returns
    -------
    list of `RestingWindow`, with `.share`. A window is open in the parameter, and every border orbit lies outside.

    Raises
    ------
    InputError : a model that balls do not fly or without a period; ends that are none, or between which nothing is
        released.

    Examples
    --------
    >>> ball = Oscillator("1", "G*sin(t)", 0, "1/2", {"G": "19/10"})
    >>> found = resting_windows(ball, "G", ("1.9", "1.901"), pieces=4)
    >>> [(float(one.low), float(one.high), one.periods) for one in found], found.share
    ([(1.9, 1.901, 5.0)], Fraction(1, 1))
    """
    require(isinstance(osc, Oscillator), "osc", osc, "an ImpactOscillator")
    require_rebound(osc, "rest after chatter")
    accepted = "one with a period, whose restitution is a number below 1"
    require(osc.period is not None and enclosable(osc), "model", osc, accepted)
    ends = rational_ends("between", between, "two rational numbers low < high")
    osc = with_number(osc, over)
    releases = Releases(osc, over, whole("periods", periods, 1, 1000))
    least = (ends[1] - ends[0]) / whole("pieces", pieces, 1, 10**6)
    phases = max((rising_zeros(releases.model(value)) for value in (sum(ends) / 2, *ends)), key=len)
    require(bool(phases), "between", between, f"values of {over} for which a_c rises through zero at some time")
    windows = [
        RestingWindow(low, high, index, after)
        for index in range(len(phases))
        for low, high, after in _joined(_searched(releases, phases, index, ends, least))
    ]
    return RestingWindows(windows, ends, len(phases))


def _searched(
    releases: Releases, phases: tuple[float, ...], index: int, ends: tuple[Fraction, Fraction], least: Fraction
) -> Iterator[tuple[Fraction, Fraction, float]]:
    # pieces that are proved, in order, and the periods from the release to the end of rest
    pieces = [ends]
    while pieces:
        low, high = pieces.pop()
        middle = (low + high) / 2
        model = releases.model(middle)
        near = releases.followed(model, phases)
        # next to a swan releases are not followed from far, and may have vanished
        if not np.isfinite(near).all():
            near = rising_zeros(model)
        orbit = releases.orbit(model, near, index) if len(near) == len(phases) else None
        if orbit is not None and orbit.place and _rests(releases, orbit, (low, high)):
            yield low, high, float(round((orbit.zeros[orbit.place - 1] - orbit.tau) / clock(model), 9))
        elif high - low > least:
            pieces += [(middle, high), (low, middle)]


def _joined(pieces: Iterable[tuple[Fraction, Fraction, float]]) -> list[tuple[Fraction, Fraction, float]]:
    joined: list[tuple[Fraction, Fraction, float]] = []
    for low, high, after in pieces:
        begun = joined and joined[-1][1:] == (low, after)
        joined.append((joined.pop()[0] if begun else low, high, after))
    return joined


def _rests(releases: Releases, orbit: Released, ends: tuple[Fraction, Fraction]) -> bool:
    # whether all members come to rest before that zero of a_c before which the orbit of the middle does
    low, high = ends
    half, balls = (high - low) / 2, Balls(BITS)
    period = Fraction(clock(orbit.model))
    with balls_at(BITS):
        flow = AnalyticFlow(orbit.model, BITS, (releases.over, balls.interval(low, high)))
        times = orbit.tau, float(orbit.zeros[orbit.place - 1])
        for around in (period / 2**power for power in AROUND):
            start, end = (rising_zero(flow, time, around) for time in times)
            if start is not None and end is not None:
                break
        own = rising_zero(AnalyticFlow(orbit.model, BITS), orbit.tau)
        if start is None or end is None or own is None:
            return False
        entry, pressing = orbit.entry(orbit.place), False
        for impact, (tau, v) in enumerate(released_sets(orbit.model, releases.over, half, (own, start)), 1):
            if impact < entry:
                continue
            time, speed = (
                balls.interval(line.centre - line.reach([half]), line.centre + line.reach([half])) for line in (tau, v)
            )
            pressing = pressing or presses(flow.acceleration, time, end, around)
            if not pressing or impact > entry + LATE:
                return False
            fate = side(flow, end, time, speed)
            if fate is not None:
                return fate < 0
    return False


def released_sets(model: Oscillator, over: str, half: Fraction, start: tuple[Any, Any]) -> Iterator[Lines]:
    """The sets after each impact, as far as they are narrow, of orbits that are released.

    Parameters
    ----------
    model, over, half : that of the middle, the number, and half the length of its interval.
    start : the release of the middle, and that of all: balls.
    """
    at, nothing = _middle(start[0]), Fraction(0)
    off, moved = (as_rational(abs(zero - Balls(BITS).rational(at)).upper()) for zero in start)
    return flown_sets(model, over, [half], (Line(at, (nothing,), moved), Line(nothing, (nothing,), nothing)), off)


def flown_sets(
    model: Oscillator, over: str, halves: Sequence[Fraction], lines: Lines, released: Fraction | None = None
) -> Iterator[Lines]:
    """The sets after each impact of those that start in one.

    Parameters
    ----------
    halves : of the number first, then of what else the set has slopes by.
    released : of a set of releases, how far that of the middle may be from the centre.
    """
    horizon, removed = Fraction(horizon_of(model, None)), 1 if released is None else 3
    while True:
        tau, v = lines
        launch = partial(Launch, number(tau.centre), number(v.centre), removed)
        radii = {"tau": tau.reach(halves), "v": v.reach(halves), over: halves[0]}
        if released is not None:
            del radii["v"]
        try:
            middle = certified_hit(model, launch({} if released is None else {"tau": released}), DIGITS, horizon)
            members = certified_hit(model, launch(radii), DIGITS, horizon, derivative=True)
        except (Refused, NoHit):
            return
        if not all(by.is_finite() for row in members.derivative for by in row):
            return
        lines, released, removed = _taken(members, middle, lines, halves), None, 1
        if not lines[1].centre > WIDE * lines[1].reach(halves):
            return
        yield lines


def _taken(members: ProvedImpact, middle: ProvedImpact, lines: Lines, halves: Sequence[Fraction]) -> Lines:
    # the image of a set
    rational = Balls(BITS).rational
    images = []
    for (by_tau, by_v, by_number), image in zip(members.derivative, (middle.tau, middle.v), strict=True):
        by_state = list(zip((by_tau, by_v), lines, strict=True))
        slopes = [sum(by * rational(line.slopes[i]) for by, line in by_state) for i in range(len(halves))]
        slopes[0] += by_number
        centre, along = _middle(image), [_middle(slope) for slope in slopes]
        error = abs(image - rational(centre)) + sum(abs(by) * rational(line.error) for by, line in by_state)
        for slope, straight, half in zip(slopes, along, halves, strict=True):
            error += abs(slope - rational(straight)) * rational(half)
        images.append(Line(centre, tuple(along), as_rational(error.upper())))
    return images[0], images[1]


def _middle(ball: Any) -> Fraction:
    return Fraction(float(ball.mid()))
