"""An event of a branch that is proved: its parameter and states in balls.

Graze, hidden impact: the touching point is launched from, at rest, and the orbit is closed there; the parameter is an
unknown, and Krawczyk's operator shows one such orbit in a box, and no other.

Fold, period-doubling, torus: one of the unknowns, s, is held at each value of a short interval, and Krawczyk's operator
shows one orbit for each: a curve of orbits. With M the derivative of the return map, t its trace and d its determinant,

    fold   1 - t + d,      period-doubling   1 + t + d,      torus   1 - d, where t^2 < 4 d,

is continuous on that curve, and has opposite signs at its ends. So it vanishes between them. At a fold dp/ds is this
number times another that does not vanish on the box: p turns back. All orbits in the box lie on the curve. The rate of
the number along it, from first and second derivatives of all flights over the box (`rate_over`), has one sign: the
number vanishes once, and the event is the only one.
"""

from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra import BITS_A_DIGIT, Balls, Certified, as_rational, balls_at, from_ball
from singimpact.branches.ball_closing import BallClosing, TouchingClosing, return_slope
from singimpact.branches.events.table import kind_of
from singimpact.branches.krawczyk import KRAWCZYK, Krawczyk, Point
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.flights.enclosures.equation import Refused
from singimpact.handed_on import flint
from singimpact.inputs import need
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result, in_words


@dataclass(frozen=True)
class EventSettings:
    """Settings of the search for a change of sign.

    Parameters
    ----------
    apart : of the held unknown, between the first two orbits of a secant. secants : at most.
    middle : how near the middle of the interval the event is, in half lengths.
    spare, more, most : digits of the orbits at the ends beside those asked for; where the signs there are open so many
        more, and at most so many.
    reach : radius of the box of the curve, over half the length of the interval of the held unknown.
    rounding : of the largest velocity; a velocity that is further below 0 is that of a virtual orbit.
    """

    apart: Fraction = Fraction(1, 10**8)
    secants: int = 12
    middle: Fraction = Fraction(1, 1000)
    spare: int = 10
    more: int = 10
    most: int = 60
    reach: int = 4
    rounding: float = 1e-6


SETTINGS = EventSettings()


@dataclass(frozen=True, repr=False)
class EnclosedEvent(Result):
    """An event that exists.

    Attributes
    ----------
    kind, over : of the event, and the number of the model. parameter : its value, `Certified`.
    tau, v : `Certified` states just after the impacts, all of which are first hits. Of a graze or hidden impact the
        first is the touching point, with v = 0.
    unique_within : no other event of this kind has its parameter and its states within this distance, in tau and in v,
        of these.
    curve_within : at a fold, period-doubling or torus, all orbits of so many impacts and periods that have their
        parameter and their states within this distance of these lie on one curve, on which the event is; None at a
        graze or hidden impact.
    shown : what is proved, in a sentence. oscillator, k : a model of the branch, and after how many periods the orbit
        closes. word : walls of its impacts, between two walls.
    """

    kind: str
    over: str
    parameter: Certified
    tau: tuple[Certified, ...]
    v: tuple[Certified, ...]
    unique_within: Fraction
    shown: str
    curve_within: Fraction | None = None
    oscillator: Oscillator | None = field(default=None, repr=False)
    k: int = field(default=1, repr=False)
    word: tuple[int, ...] = field(default=(), repr=False)

    __repr__ = in_words


def enclosed_event(kind: str, orbit: PeriodicOrbit, over: str, parameter: float, digits: int) -> EnclosedEvent | str:
    """The event next to an orbit, proved; or the reason why it is not.

    Parameters
    ----------
    kind : the name of a kind that has a proof. Where the orbit touches the wall one state has v = 0, up to rounding.
    orbit : in doubles. over, parameter : the number of its model, and its value about. digits : of the result.

    Examples
    --------
    >>> from singimpact.branches.periodic import periodic
    >>> from singimpact.oscillator.model import Oscillator
    >>> model = Oscillator("x + 0.1*xdot", "-A*cos(0.8*t)", -1, "0.8", {"A": "0.369"})
    >>> (found,) = [each for each in periodic(model, 1, 1) if each.v[0] < 0.5]
    >>> print(enclosed_event("graze", found, "A", 0.3687, 20).parameter)
    0.36878177829171549240
    """
    speeds = np.asarray(orbit.v, dtype=float)
    if kind_of(kind).touches:  # the velocity of the touching point is rounding
        speeds = np.delete(speeds, np.argmin(np.abs(speeds)))
    if speeds.size and speeds.min() < -SETTINGS.rounding * np.abs(speeds).max():
        return f"an impact has the velocity {speeds.min():.6g}"
    if orbit.oscillator.parametric:
        return f"f = {orbit.oscillator.f} depends on t: second derivatives of flights are enclosed for f in x and xdot"
    with balls_at(ceil((digits + SETTINGS.most) * BITS_A_DIGIT) + 64):
        try:
            if kind_of(kind).touches:
                return _touching(kind, orbit, over, parameter, digits)
            return _Curve(kind, orbit, over, digits).event(parameter)
        except (ArithmeticError, ValueError) as reason:  # refused, a singular matrix, a ball that left a domain
            return str(reason) or type(reason).__name__


def _states(orbit: PeriodicOrbit) -> list[Fraction]:
    pairs = zip(np.asarray(orbit.tau, dtype=float), np.asarray(orbit.v, dtype=float), strict=True)
    return [Fraction(float(part)) for pair in pairs for part in pair]


def _numbers(balls: Balls, centre: Point, offsets: list[Any], digits: int) -> list[Certified]:
    return [from_ball(balls.rational(x) + part, digits) for x, part in zip(centre, offsets, strict=True)]


# ---- grazes


def _touching(kind: str, orbit: PeriodicOrbit, over: str, parameter: float, digits: int) -> EnclosedEvent | str:
    bits = ceil(digits * BITS_A_DIGIT) + 64
    with balls_at(bits):
        first = int(np.argmin(np.abs(np.asarray(orbit.v, dtype=float))))
        word = orbit.walls[first:] + orbit.walls[:first]
        closing = TouchingClosing(orbit.oscillator, orbit.k, digits, bits, over, word)
        near = _from_touching_point(orbit, closing, Fraction(float(parameter)))
        operator = Krawczyk(closing, near, Fraction(1, 10 ** (digits + 2)))
        point, step, own, tight = operator.enclosed(near, "the box into itself: the graze may be degenerate, or be two")
        closing.first_hits(point, own)
        unique = operator.unique_within(point, step, own)
        tau, *rest = _numbers(closing.balls, point, tight.offsets, digits)
        return EnclosedEvent(
            kind,
            over,
            rest[-1],
            (tau, *rest[:-1:2]),
            (from_ball(closing.balls.rational(Fraction(0)), digits), *rest[1:-1:2]),
            unique,
            kind_of(kind).proof,
            None,
            orbit.oscillator,
            orbit.k,
            word,
        )


def _from_touching_point(orbit: PeriodicOrbit, closing: TouchingClosing, parameter: Fraction) -> Point:
    """The states in their order from the touching point on, whose v = 0 is left out; then the parameter."""
    states = _states(orbit)
    pairs = list(zip(states[::2], states[1::2], strict=True))
    first = min(range(len(pairs)), key=lambda i: abs(pairs[i][1]))
    later = as_rational(closing.span([parameter])[0])
    turned = [*pairs[first:], *((tau + later, v) for tau, v in pairs[:first])]
    return [turned[0][0], *(part for pair in turned[1:] for part in pair), parameter]


# ---- folds, doublings, tori


class _End(NamedTuple):
    """An orbit beside an event: a box that contains it and no other, and the sign of the test, 0 where it is open."""

    point: Point
    own: Fraction
    sign: int


class _Curve:
    """The orbits next to a fold, doubling or torus."""

    def __init__(self, kind: str, orbit: PeriodicOrbit, over: str, digits: int) -> None:
        self.kind, self.orbit, self.over, self.digits = kind, orbit, over, digits

    def event(self, parameter: float) -> EnclosedEvent | str:
        near = [*_states(self.orbit), Fraction(float(parameter))]
        half = Fraction(1, 10 ** (self.digits + 2))
        spare = SETTINGS.spare
        while spare <= SETTINGS.most:
            operator = self._operator(near, spare)
            near = self._crossing(operator, near, half * SETTINGS.middle)
            ends = [self._end(operator, near, shift) for shift in (-half, half)]
            if all(end.sign for end in ends):
                break
            spare += SETTINGS.more
        else:
            return "the test of the event is not told from 0 next to it: the event may be double"
        if ends[0].sign == ends[1].sign:
            return "the test of the event has one sign on both sides of it"
        return self._proved(operator, near, ends, half)

    def _operator(self, near: Point, spare: int) -> Krawczyk:
        """The closing conditions where the unknown is held by which the curve goes."""
        digits = self.digits + spare
        bits = ceil(digits * BITS_A_DIGIT) + 64
        closing = BallClosing(self.orbit.oscillator, self.orbit.k, digits, bits, self.over, self.orbit.walls)
        return Krawczyk(closing, near, Fraction(1, 10 ** (digits + 2)))

    def _test(self, slopes: Any) -> Any:
        """The function that vanishes at the event, over a box."""
        return kind_of(self.kind).of_return_map(return_slope(slopes))

    def _crossing(self, operator: Krawczyk, near: Point, close: Fraction) -> Point:
        """An orbit where the test vanishes up to `close` in the held unknown, by secants: nothing is proved here."""
        balls = operator.equations.balls

        def test(point: Point) -> Fraction:
            return as_rational(self._test(operator.equations.slopes(point, operator.small)))

        one = operator.solved(near)
        other = operator.solved(operator.moved(one, SETTINGS.apart))
        values = test(one), test(other)
        assert operator.held is not None
        for _ in range(SETTINGS.secants):
            need(values[0] != values[1], Refused("the test of the event does not vary next to it"))
            gap = other[operator.held] - one[operator.held]
            shift = as_rational(balls.rational(values[1] * gap / (values[0] - values[1])))
            one, other = other, operator.solved(operator.moved(other, shift))
            if abs(shift * gap) < close:  # about the error that a secant leaves
                return other
            values = values[1], test(other)
        raise Refused("the event is not reached from here")

    def _end(self, operator: Krawczyk, near: Point, shift: Fraction) -> _End:
        """An orbit beside the event, proved, with the sign of the test there."""
        box = "the box of an orbit beside the event into itself"
        point, _, own, tight = operator.enclosed(operator.moved(near, shift), box)
        value = self._test(tight.slopes)
        return _End(point, own, 1 if value > 0 else -1 if value < 0 else 0)

    def _proved(self, operator: Krawczyk, near: Point, ends: list[_End], half: Fraction) -> EnclosedEvent | str:
        """The curve of orbits from one end to the other."""
        radius = SETTINGS.reach * half
        for end in ends:
            if any(abs(a - b) + end.own > radius for a, b in zip(end.point, near, strict=True)):
                return "an orbit beside the event is not shown to lie on its curve"
        step = operator.step(near)
        curve = operator.image(near, step, radius, half)
        if curve is None:
            return "Krawczyk's operator does not map the box of the curve of orbits into itself"
        refusal = kind_of(self.kind).refusal(return_slope(curve.slopes))
        if refusal:
            return refusal
        closing = operator.equations
        assert isinstance(closing, BallClosing)
        closing.first_hits(near, radius)
        balls, offsets = closing.balls, list(curve.offsets)
        assert operator.held is not None
        offsets.insert(operator.held, balls.interval(-half, half))
        *states, parameter = _numbers(balls, near, offsets, self.digits)
        curved = operator.unique_within(near, step, radius, Fraction(1, SETTINGS.reach))
        alone = self._monotone_within(operator, near, step, (radius, curved))
        if alone is None:
            return "the test of the event is not shown to vary at a rate of one sign: there may be more events than one"
        return EnclosedEvent(
            self.kind,
            self.over,
            parameter,
            tuple(states[::2]),
            tuple(states[1::2]),
            alone / SETTINGS.reach,
            kind_of(self.kind).proof,
            curved / SETTINGS.reach,
            self.orbit.oscillator,
            self.orbit.k,
            self.orbit.walls,
        )

    def _monotone_within(
        self, operator: Krawczyk, near: Point, step: list[Any], between: tuple[Fraction, Fraction]
    ) -> Fraction | None:
        """A radius of a box on which the test varies along the curve at a rate of one sign; None where none is.

        The curve is shown to stay in that box too: between two events on it the rate is one of those over the box.
        """
        closing, (least, radius) = operator.equations, between
        assert isinstance(closing, BallClosing)
        while True:
            try:
                rate = rate_over(self.kind, closing, operator, near, radius)
                if operator.image(near, step, radius, radius / SETTINGS.reach) is not None and (rate > 0 or rate < 0):
                    return radius
            except (ArithmeticError, ValueError):  # refused, or a matrix that may be singular, over so wide a box
                pass
            if radius <= least:
                return None
            smaller = radius / KRAWCZYK.shrink
            radius = smaller if smaller > max(KRAWCZYK.narrowest, least) else least


# ---- what vanishes at an event of the return map


def rate_over(kind: str, closing: BallClosing, operator: Krawczyk, point: Point, radius: Fraction) -> Any:
    """The rate of the test along the curve of orbits by the held unknown, over a box.

    The curve has the tangent u with D F u = 0, the held component 1. Along it D G changes by D^2 G u.

    Raises
    ------
    Refused : a flight over the box is not enclosed. ZeroDivisionError : D F may be singular on it.
    """
    hits = closing.bends(point, radius)
    tangent = operator.tangent_over(closing.matrix(closing.slopes(point, radius)))
    total, change = flint.arb_mat([[1, 0], [0, 1]]), flint.arb_mat([[0, 0], [0, 0]])
    for i, hit in enumerate(hits):
        slopes = flint.arb_mat([row[:2] for row in hit.slopes()])
        moved = flint.arb_mat(hit.along((tangent[2 * i], tangent[2 * i + 1], tangent[-1])))
        total, change = slopes * total, moved * total + slopes * change
    return kind_of(kind).rate_of_return_map(total, change)
