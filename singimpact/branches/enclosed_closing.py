"""All orbits of one or two impacts in k periods of an analytic model, in a window of velocities: isolated by balls.

A box of states just after an impact is flown through the wall to the end of the k periods. It holds no orbit if the
flight is below the wall on its way, or misses its own state at the end. With two impacts each time at which the first
flight may meet the wall is tried; the orbit is looked for from the faster of its two impacts.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np

from singimpact.algebra import Array, Balls, as_float, balls_at, evaluate, series_of_any_length
from singimpact.algebra.isolated_zeros import SETTINGS as BOXES, IsolatedZeros, Place, zeros_of
from singimpact.flights import (
    CarriedMotion,
    Equation,
    Met,
    Refused,
    Start,
    Tube,
    centre,
    divided,
    narrowed,
    programs_of,
)
from singimpact.handed_on import flint
from singimpact.inputs import need
from singimpact.oscillator.model import Oscillator

BITS = 30
SEARCH = replace(BOXES, bits=BITS + 24, least=Fraction(1, 2**16), most=100_000, lost=20)
PIECES = 6  # times at which the first flight may meet the wall are cut to this power of 2 of a step
# A step whose end may be an impact ends at this part of the time before it, or not if that is less of the step.
BEFORE, LEAST = 0.9, 0.05
WIDEST = 0.3  # boxes wider than this, of a period or of the highest velocity, are not flown


class ClosingBoxes:
    """The closing conditions of one or two impacts over boxes of (tau, v): a `System`.

    Parameters
    ----------
    osc : an analytic model. n, k : impacts, 1 or 2, in k periods. speeds : the window of v of every impact.
    """

    def __init__(self, osc: Oscillator, n: int, k: int, speeds: tuple[Fraction, Fraction]) -> None:
        assert osc.period is not None
        programs = programs_of(osc, ())
        self.n, self.equation, self.law = n, Equation(programs, {}), programs.rho.prepared({})
        self.balls = Balls(SEARCH.bits)
        self.span = evaluate(osc.period, {}, self.balls) * k
        self.period, (self.low, self.high) = as_float(osc.period), (self.balls.rational(part) for part in speeds)

    def without_zeros(self, place: Place) -> bool:
        """Whether no orbit starts in a box."""
        tau, v = place
        if float(tau.rad()) > WIDEST * self.period or float(v.rad()) > WIDEST * float(self.high):
            return False
        with series_of_any_length():
            try:
                return not any(self._may_close(v, end) for _, end in self._ends(tau, v, visible=True))
            except (Refused, ValueError, ZeroDivisionError):
                return False

    def linearised(self, box: Place, middle: Place) -> tuple[Sequence[Any], Sequence[Sequence[Any]]] | None:
        """The miss at the middle, and its derivatives over the box; None unless one sequence of impacts may close."""
        with series_of_any_length():
            try:
                over = [final for final in self._ends(*box, visible=False) if self._may_close(box[1], final[1])]
                if len(over) != 1:
                    return None
                ((first, end),) = over
                if first is not None and not (first.speed < 0 and first.inside and first.time - box[0] < self.span):
                    return None
                rows = self._slopes(box, first, end)
                at = [
                    final
                    for met, final in self._ends(*middle, visible=False)
                    if first is None or met is None or met.time.overlaps(first.time)
                ]
                if len(at) != 1:
                    return None
                return [at[0].height, self._after(at[0].speed)[0] - middle[1]], rows
            except (Refused, ValueError, ZeroDivisionError):
                return None

    def states(self, place: Place) -> list[float]:
        """tau and v of each impact of the solution in a ball, as `branches.closing` orders them."""
        tau, v = place
        with series_of_any_length():
            ways = [first for first, end in self._ends(tau, v, visible=False) if self._may_close(v, end)]
            if ways[0] is None:
                return [float(tau.mid()), float(v.mid())]
            return [float(part.mid()) for part in (tau, ways[0].time, v, self._after(ways[0].speed)[0])]

    def _may_close(self, v: Any, end: Met) -> bool:
        return end.height.contains(0) and (self._after(end.speed)[0] - v).contains(0)  # type: ignore[no-any-return]

    def _after(self, speed: Any) -> Any:
        """The velocity after an impact, and its derivative."""
        return self.law({"v": speed})[:2]

    def _ends(self, tau: Any, v: Any, *, visible: bool) -> Iterator[tuple[Met | None, Met]]:
        """The first impact, of two, and the end, for each way in which the box may fly; visible ones alone, or all."""
        if self.n == 1:
            end = self._end((tau, v), tau + self.span, visible)
            if end is not None:
                yield None, end
            return
        for first in self._impacts(tau, v):
            after = self._after(first.speed)[0]
            if visible and (after < self.low or after > self.high or after > v):
                continue
            end = self._end((first.time, after), tau + self.span, visible)
            if end is not None:
                yield first, end

    def _motion(self, tau: Any, v: Any) -> CarriedMotion:
        """The flights of a box of launches, at equal times of the clock."""
        equations = self.equation, self.equation
        return CarriedMotion(equations, Start(tau, v), BITS, coarse=BITS, deviations={}, clocked=True)

    def _end(self, launch: tuple[Any, Any], clock: Any, visible: bool) -> Met | None:
        """The box at a time of the clock, which may be a ball; None where all of it is below the wall before."""
        motion = self._motion(*launch)
        left = clock - launch[0]
        if not left > 0:  # members whose first impact is later than the end are no orbits
            left = (left * 0).union(left.upper())
        while True:
            height, _, length = motion.tubes()
            if left < length or left.upper() <= length:
                met = motion.met(left)
                return None if visible and met.speed > 0 else met
            first = left.lower()
            stop = length if length <= first else first
            need(stop > 0, Refused("the end of the last flight is not within a step"))
            # all members are behind the wall here: none of them is an orbit
            if visible and height(stop) < 0:
                return None
            motion.advance(centre(stop))
            left = clock - motion.middle_tau - motion.time

    def _impacts(self, tau: Any, v: Any) -> Iterator[Met]:
        """Where the flight may meet the wall, until all of it is below."""
        motion, end = self._motion(tau, v), tau + self.span
        while not motion.middle_tau + motion.time > end:
            height, speed, length = motion.tubes()
            value, rate = divided(height, speed, 1) if motion.launched else (height, speed)
            pieces, slow, below = _zeros(value, rate, length, partial(self._other_speed, speed))
            stop, margin = length, motion.margin if motion.launched else length * 0
            if pieces and not below and not pieces[-1] < length - margin:
                # a zero at the end of a step may leave it between members: a step that begins before holds it whole
                before = centre(pieces[-1].lower() * BEFORE)
                if before > length * LEAST + margin:
                    stop = before
                    del pieces[-1]
            for s in pieces:
                stays = s > 0 and s < length and not any(s.overlaps(other) for other in slow)
                impact = motion.hit(s, length)
                impact = impact._replace(inside=bool(stays))
                if not impact.speed > 0 and not impact.time > end:
                    yield impact
            if below:
                return
            motion.advance(stop)

    def _other_speed(self, speed: Tube, during: Any) -> bool:
        """Whether no velocity after an impact at these times is in the window."""
        after = self._after(speed(during))[0]
        return bool(after < self.low or after > self.high)

    def _slopes(self, box: Place, first: Met | None, end: Met) -> list[list[Any]]:
        """Derivatives of x - c at the end, and of what v misses, by tau and v."""
        rate, last = self._after(end.speed)[1], self._force(box[0] + self.span, end)
        by = []
        for k in (0, 1):
            if first is None:
                height, speed = end.columns[k]
            else:
                push, bend = self._after(first.speed)[1], self._force(first.time, first)
                # the first impact moves by this, and the second launch with it
                (a, b), (p, q) = end.columns
                late = -first.columns[k][0] / first.speed
                fast = push * (first.columns[k][1] + bend * late)
                height, speed = a * late + p * fast, b * late + q * fast
            # the end is k periods after the launch
            by.append((height + (1 - k) * end.speed, speed + (1 - k) * last))
        return [[column[0] for column in by], [rate * column[1] - k for k, column in enumerate(by)]]

    def _force(self, t: Any, at: Met) -> Any:
        """x'' on the wall."""
        return self.equation.acceleration(t, at.speed * 0, at.speed)


def closed_boxes(
    osc: Oscillator, n: int, k: int, speeds: tuple[Fraction, Fraction]
) -> tuple[list[Array], IsolatedZeros]:
    """All solutions of the closing conditions, virtual ones too, and the boxes that are not decided.

    Parameters
    ----------
    osc : an analytic model. n, k : impacts, 1 or 2, in k periods. speeds : the window of v of every impact.

    Examples
    --------
    >>> osc = Oscillator("x + x**3/10", "cos(4*t)", 0, "0.5")
    >>> found, boxes = closed_boxes(osc, 1, 1, (Fraction(1, 2), Fraction(1)))
    >>> found, boxes.complete
    ([], True)
    """
    period = Fraction(as_float(osc.period))
    window = (-period / 64, period * Fraction(65, 64)), speeds
    with balls_at(SEARCH.bits):
        system = ClosingBoxes(osc, n, k, speeds)
        zeros = zeros_of(system, window, SEARCH, (period, speeds[1]))
        return [np.array(system.states(zero)) for zero in zeros.found], zeros


def _zeros(value: Tube, rate: Tube, length: Any, other: Callable[[Any], bool]) -> tuple[list[Any], list[Any], bool]:
    """Where on (0, length] some member of a box may vanish, and whether all of them are negative after that.

    Pieces that are left out since `other` holds on them come second.
    """
    zeros: list[Any] = []
    left_out: list[Any] = []
    stack, least = [(flint.arb(0), length)], length * flint.arb(2) ** -PIECES
    while stack:
        a, b = stack.pop()
        piece = a.union(b)
        here, slope = value(piece), rate(piece)
        if here > 0:
            continue
        if here < 0:
            return zeros, left_out, True
        if other(piece):
            left_out.append(piece)
            continue
        if slope < 0 or slope > 0:
            try:
                piece = narrowed(piece, value, rate)
            except ValueError:  # Newton's ball and the piece are apart: no zero
                continue
        elif b - a > least:
            middle = centre((a + b) / 2)
            stack += [(middle, b), (a, middle)]
            continue
        if zeros and zeros[-1].overlaps(piece):
            zeros[-1] = zeros[-1].union(piece)
        else:
            zeros.append(piece)
    return zeros, left_out, False
