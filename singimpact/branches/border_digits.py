"""Released orbits in many digits: the number of a border orbit, and a proof that one lies in a ball.

The proof, of analytic models whose restitution is a number.  (1) For every value in the ball the orbit comes to the
same impact, transversally, after which a_c presses up to the zero where gamma ends.  (2) At one end of the ball its
chatter completes before that zero, at the other a flight passes it.  While a_c presses every impact is transversal, for
x'' = a_c < 0 where x' = 0 at the wall; so each fate of (2) belongs to an open set of values, and between the two ends
lies a value with neither: its impacts are infinitely many and accumulate at the zero.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice
from math import ceil, isfinite, log10
from typing import Any, NamedTuple

from singimpact.algebra import (
    BITS_A_DIGIT,
    Balls,
    Certified,
    Ladder,
    Number,
    as_rational,
    balls_at,
    digits_at,
    exact,
    for_user,
    from_ends,
    newton_in_balls,
)
from singimpact.branches.resting import Return, clock
from singimpact.contact.zero_ahead import ContactZero, next_zero
from singimpact.dynamics.enclosed import enclosable, end_of_gamma, searched, side
from singimpact.flights.enclosures.analytic_flow import AnalyticFlow
from singimpact.flights.impact_map import impact_map
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status


@dataclass(frozen=True)
class DigitSettings:
    """Limits of digits and bits.

    Parameters
    ----------
    spare : digits beyond those asked for. bits : of the balls of a proof at most, per digit asked for.
    before : a zero of a_c is looked for from so far before it, in periods: doubles know it to 1e-16.
    around : half the width of the ball in which a zero of a_c is isolated. pieces : of a time in which a_c presses.
    """

    spare: int = 15
    bits: int = 64
    before: float = 2.0**-20
    around: Fraction = Fraction(1, 2**30)
    pieces: int = 4000


SETTINGS = DigitSettings()


class Landing(NamedTuple):
    """The state after an impact: its time less that of the zero where gamma ends, and its velocity; balls."""

    sigma: Any
    v: Any


@dataclass(frozen=True)
class InDigits:
    """A border orbit in many digits: value and error for a user, the value as a rational, and what was proved.

    Parameters
    ----------
    note : why nothing was proved, where `certified` is None.
    """

    value: Any
    error: Any
    exact: Fraction
    certified: Certified | None
    note: str


class DigitOrbits:
    """Released orbits next to a return, for balls of so many bits; nothing is proved by them.

    Parameters
    ----------
    found : a return. digits : that the states have.
    """

    def __init__(self, found: Return, digits: int) -> None:
        self.found, self.digits = found, digits + SETTINGS.spare
        self.bits = ceil(self.digits * BITS_A_DIGIT) + 64
        self.balls = Balls(self.bits)

    def landings(self, value: Fraction, count: int) -> list[Landing]:
        """The states after at most `count` impacts, up to the first one beyond the zero where gamma ends."""
        model = self.found.releases.model(value)
        # a search that goes too far leaves the models in which the orbit is released
        if not all(map(isfinite, self.found.ends(model))):
            return []
        with balls_at(self.bits):
            start, end = self._zeros(model)
            zero, rows = end.moved(self.bits), list[Landing]()
            fly = self._in_balls if enclosable(model) else self._in_digits
            for time, v in islice(fly(model, start), count):
                rows.append(Landing((time - zero).mid(), v))
                if rows[-1].sigma > 0:
                    break
            return rows

    def missed(self, impacts: int, value: Fraction) -> Any | None:
        """v less the first two terms of gamma so many impacts after the orbit came back; None where it has passed."""
        rows = self.landings(value, self.found.entry + impacts)
        if len(rows) < self.found.entry + impacts or not rows[-1].sigma < 0:
            return None
        model = self.found.releases.model(value)
        with balls_at(self.bits):
            _, end = self._zeros(model)
            first, second, _ = end_of_gamma(model, end, self.bits)
            sigma, v = rows[-1]
            return (v - sigma**2 * (first + second * sigma)).mid()

    def contact(self) -> tuple[int, Any]:
        """The order of the zero where gamma ends, and lambda there."""
        model = self.found.releases.model(self.found.value)
        with balls_at(self.bits):
            _, end = self._zeros(model)
            return end.order, end_of_gamma(model, end, self.bits)[2]

    def _zeros(self, model: Oscillator) -> tuple[ContactZero, ContactZero]:
        """The zeros of a_c where the orbit begins and ends."""
        before = SETTINGS.before * clock(model)
        found = [next_zero(model, Number(Fraction(time - before))).zero for time in self.found.ends(model)]
        if found[0] is None or found[1] is None or found[1].order != 1:
            raise ArithmeticError("a zero of a_c is not isolated")
        return found[0], found[1]

    def _in_balls(self, model: Oscillator, start: ContactZero) -> Iterator[tuple[Any, Any]]:
        """Time and velocity after each impact."""
        flow = AnalyticFlow(model, self.bits)
        time, v, removed = start.moved(self.bits).mid(), flow.number(Fraction(0)), start.order + 2
        hit = flow.first_hit(time, v, removed=removed)
        while hit is not None and hit.time is not None:
            time, v, removed = (time + hit.time).mid(), (-flow.r * hit.velocity).mid(), 1
            yield time, v
            hit = flow.first_hit(time, v, removed=removed)

    def _in_digits(self, model: Oscillator, start: ContactZero) -> Iterator[tuple[Any, Any]]:
        """Time and velocity after each impact, by mpmath numbers."""
        step = impact_map(model, start.tau, 0, digits=self.digits)
        while step.status == Status.hit:
            time, v = (self.balls.rational(exact("tau", coordinate)) for coordinate in (step.tau, step.v))
            yield time, v
            step = impact_map(model, step.tau, step.v, digits=self.digits)


def in_digits(returned: Return, scale: float, digits: int) -> InDigits | None:
    """The value of the number at a border orbit, in many digits; None where it is not reached.

    Parameters
    ----------
    returned : the return in doubles. scale : the change of the number that changes v by itself. digits : of the result.
    """
    middle, unit = Fraction(returned.value), Fraction(scale)
    extra = max(0, ceil(log10(scale / abs(returned.value)))) + 1 if returned.value else 0
    orbits = DigitOrbits(returned, digits + extra)
    # v/gamma is a positive number; its relative error is in `searched`
    with balls_at(orbits.bits):
        near = searched(
            lambda impacts, share: orbits.missed(impacts, middle + (share - 1) * unit),
            Fraction(1),
            orbits.contact(),
            digits + extra,
            orbits.balls,
        )
    if near is None:
        return None
    exactly = middle + (near - 1) * unit
    proof, note = _proved(returned, exactly, digits)
    with digits_at(digits) as mp:
        if proof is not None:
            value = mp.convert(proof.value)
            error = mp.convert(proof.radius) + abs(value) * mp.mpf(10) ** -digits
        else:
            value = mp.mpf(exactly.numerator) / exactly.denominator
            error = mp.mpf(10) ** -digits * max(abs(value), mp.mpf(scale))
        return InDigits(for_user(+value), for_user(+error), exact("parameter", +value), proof, note)


def _proved(returned: Return, near: Fraction, digits: int) -> tuple[Certified | None, str]:
    """A ball about a value in which a border orbit is proved to be, or why there is none."""
    model = returned.releases.model(near)
    if not enclosable(model):
        return None, "not certified: balls fly orbits of models with a number below 1 for restitution"
    margin = abs(near) / (4 * 10**digits)
    low, high = near - margin, near + margin
    times = returned.ends(model)
    sides: dict[Fraction, int | None] = {low: None, high: None}
    followed = False
    # the fates of both ends are open while rounding is wider than their distance from gamma
    for bits in Ladder(ceil(digits * BITS_A_DIGIT) + 64, SETTINGS.bits * (digits + 32)):
        with balls_at(bits):
            followed = followed or _followed(_flow(returned, (low, high), bits), times, returned.entry) is not None
            for value, fate in sides.items():
                sides[value] = fate or _fate(_flow(returned, (value, value), bits), times, returned.entry)
        if followed and None not in sides.values():
            break
    else:
        return None, f"not certified: balls of {bits} bits do not decide what the orbits next to it do"
    if (sides[low], sides[high]) != (returned.side, -returned.side):
        return None, "not certified: the orbits on both sides of it have one fate"
    return from_ends(low, high, digits), ""


def _flow(found: Return, ends: tuple[Fraction, Fraction], bits: int) -> AnalyticFlow:
    """The flow of all values from one to another."""
    low, high = ends
    if low == high:
        return AnalyticFlow(found.releases.model(low), bits)
    ball = Balls(bits).interval(low, high)
    return AnalyticFlow(found.releases.model((low + high) / 2), bits, (found.releases.over, ball))


def _fate(flow: AnalyticFlow, times: tuple[float, float], entry: int) -> int | None:
    """-1 where chatter completes before the second zero, 1 where a flight passes it; None undecided."""
    reached = _followed(flow, times, entry)
    return None if reached is None else side(flow, reached[2], *reached[:2])


def _followed(flow: AnalyticFlow, times: tuple[float, float], entry: int) -> tuple[Any, Any, Any] | None:
    """Time and velocity of an impact of the released orbit, and the zero of a_c before which a_c presses.

    Parameters
    ----------
    times : of the release and of that zero, in doubles. entry : the number of the impact.
    """
    start, end = (rising_zero(flow, time) for time in times)
    if start is None or end is None:
        return None
    time, v, removed = start, flow.number(Fraction(0)), 3
    for _ in range(entry):
        hit = flow.first_hit(time, v, removed=removed)
        if hit is None or hit.time is None or not hit.velocity < 0:
            return None
        time, v, removed = time + hit.time, -flow.r * hit.velocity, 1
    return (time, v, end) if presses(flow.acceleration, time, end, SETTINGS.around) else None


def rising_zero(flow: AnalyticFlow, near: float, around: Fraction = SETTINGS.around) -> Any | None:
    """The zero of a_c next to a double, where it is the only one and a_c rises; for every value in the flow's balls."""
    middle = flow.number(Fraction(near))
    reach = flow.number(around)
    low, high = middle - reach, middle + reach
    if not (flow.acceleration(low) < 0 and flow.acceleration(high) > 0 and flow.acceleration(low.union(high), 1) > 0):
        return None
    zero = newton_in_balls(flow.acceleration, lambda t: flow.acceleration(t, 1), low.union(high))
    # so a_c is known to rise from half of `around` before the zero of each value: `presses` looks no farther
    return zero if zero is not None and abs(zero - middle) < reach / 2 else None


def presses(acceleration: Callable[..., Any], time: Any, end: Any, around: Fraction) -> bool:
    """Whether a_c < 0 from a time up to a zero where it rises, as `rising_zero` found it."""
    high = as_rational(end) - around / 2
    pieces, left = [(as_rational(time.lower()), high)], SETTINGS.pieces
    balls = Balls(128)
    while pieces and left:
        low, top = pieces.pop()
        left -= 1
        # next to the zero itself a_c is known to rise, so pieces end `around` before it
        if low >= top or acceleration(balls.interval(low, top)) < 0:
            continue
        middle = (low + top) / 2
        pieces += [(low, middle), (middle, top)]
    return not pieces
