"""Which lips, beaks and swallowtails a model has in a window: all of them, by balls.

Of a linear model x - c = u(tau, t) of a flight from rest at tau is a sum of exponentials and waves; other analytic
models are flown in boxes, which are cut until each is decided.  Lips and beaks are the solutions of

    a_c(tau) = 0,   u = 0,   u_t = 0        with t != 0, in tau, t and the number that is varied,

swallowtails the zeros t != 0 of u at a swan.  At t = 0 the equations hold for every tau with a_c(tau) = 0.  There, u,
u_t and u_tt vanish at 0 and u, u_t at t, so by Rolle's theorem u_ttt has two zeros between and u_tttt one: a box whose
hull with t = 0 has u_ttt or u_tttt free of zeros holds no solution but t = 0.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.analytic import Recorder
from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, Name, multiply, names_in, number, substitute
from singimpact.algebra.isolated_zeros import (
    SETTINGS as BOXES,
    Box,
    IsolatedZeros,
    Place,
    cut,
    isolated_zeros,
    overlap,
    zeros_of,
)
from singimpact.algebra.precision import balls_at, series_of_any_length
from singimpact.flights.enclosures.equation import Refused
from singimpact.flights.enclosures.tube import upper
from singimpact.oscillator.linear import form_of, linear_flight
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE
from singimpact.progress import ProgressLine
from singimpact.surface.boxes_from_rest import FlightFromRest, Tangencies, at_time
from singimpact.surface.swan_families import MARGIN, STEPS, Family, Transition

NEAR = 1e-8  # relative distance below which an isolated zero is the transition of the list
SEARCH = replace(BOXES, bits=96, most=60_000, least=Fraction(1, 2**18))


# Boxes of flights: a box of tau and of the number is flown once through all times. It is dropped where a_c has no zero
# or no member touches the wall; what is left is isolated by Krawczyk's operator. Times below 0 are those of the model
# whose flights run backwards.


@dataclass(frozen=True)
class TouchSettings:
    """Settings of the flights over boxes and of their subdivision.

    Parameters
    ----------
    bits : of the steps of a box. fine : of those with which a zero is isolated.
    widest : part of a period of a box that is flown, at most.
    isolated : part of a period below which Krawczyk's operator is tried.
    least : part of a period below which a box stays undecided. most : boxes that are looked at, at most.
    lost : undecided ones after which the rest is undecided too: next to a degenerate transition all are.
    cut : where a box is cut, off the middle: zeros like places of symmetry.
    """

    bits: int = 24
    fine: int = 44
    widest: float = 1 / 16
    isolated: float = 1 / 32
    least: float = 2.0**-16
    most: int = 6000
    lost: int = 8
    cut: Fraction = Fraction(127, 256)


SETTINGS = TouchSettings()
# The search for zeros in a box that is cut here, with its flights, and not there.
ONE_BOX = replace(BOXES, bits=SETTINGS.fine + 24, most=1)


@dataclass(frozen=True)
class EnclosedTouches:
    """The flights from rest of an analytic model over a number, with the methods of `proved_touches.RestFlight`.

    Parameters
    ----------
    model : analytic. over : "clearance" or a parameter of it.
    """

    model: Oscillator
    over: str

    def touches(self, period: float, ends: tuple[float, float], times: tuple[float, float]) -> IsolatedZeros:
        """(tau, t, value) of all lips and beaks in a period of tau."""
        longest, zeros, undecided, count = Fraction(period), list[Place](), list[Box](), 0
        between = Fraction(ends[0]), Fraction(ends[1])
        for sign, window in _sides(times):
            tau = (-longest / MARGIN, longest * Fraction(MARGIN + 1, MARGIN))
            search = _Search(self._turned(sign), self.over, window, longest)
            searched = search.run((tau if sign > 0 else (-tau[1], -tau[0]), between))
            zeros += [(sign * tau, sign * t, value) for tau, t, value in searched.found]
            undecided += [(*(_mirrored(side, sign) for side in box[:2]), box[2]) for box in searched.undecided]
            count += searched.looked_at
        return IsolatedZeros(tuple(zeros), tuple(undecided), count)

    def swallowtails(self, tau: Any, value: Any, times: tuple[float, float]) -> IsolatedZeros:
        """All t != 0 at which the flight from a swan, given by balls, crosses x = c again."""
        zeros, undecided, count = list[Place](), list[Box](), 0
        for sign, window in _sides(times):
            count += 1
            of = Tangencies(self._turned(sign), self.over)
            try:
                with series_of_any_length(), balls_at(ONE_BOX.bits):
                    flight = FlightFromRest(of, sign * tau, value, SETTINGS.fine)
                    low, high = (Balls(ONE_BOX.bits).rational(end) for end in window)
                    crossed, left = flight.crossings((low, high))
            except (Refused, ValueError, ZeroDivisionError):
                undecided.append((_mirrored(window, sign),))
                continue
            zeros += [(sign * time,) for time in crossed]
            undecided += [(_mirrored(_ends_in_balls(time), sign),) for time in left]
        return IsolatedZeros(tuple(zeros), tuple(undecided), count)

    def _turned(self, sign: int) -> Oscillator:
        """The model, or the one whose flights are its own run backwards."""
        if sign > 0:
            return self.model
        turned = {name: multiply(number(-1), Name(name)) for name in ("xdot", "t")}
        model = self.model
        return Oscillator(
            substitute(model.f, turned),
            substitute(model.g, turned),
            model.clearance,
            1,
            model.parameters,
            period=model.period,
        )


class _Search:
    """Boxes of (tau, number) on a stack, for times above 0."""

    def __init__(self, model: Oscillator, over: str, times: tuple[Fraction, Fraction], period: Fraction) -> None:
        self.of, self.times, self.period = Tangencies(model, over), times, period
        self.balls = Balls(SETTINGS.bits + 24)

    def run(self, window: Box) -> IsolatedZeros:
        """Cut boxes until each is decided."""
        sizes = self.period, max(window[1][1] - window[1][0], self._size(window))
        stack, zeros_, undecided, count = [window], list[Place](), list[Box](), 0
        times = self.balls.rational(self.times[0]), self.balls.rational(self.times[1])
        with ProgressLine() as line, series_of_any_length():
            while stack and count < SETTINGS.most and len(undecided) < SETTINGS.lost:
                count += 1
                line.show(count, None, "boxes of flights")
                smaller = self._without_rest(stack.pop())
                if smaller is None:
                    continue
                shares = [float((high - low) / size) for (low, high), size in zip(smaller, sizes, strict=True)]
                if max(shares) <= SETTINGS.widest:
                    zeros = self._decided(smaller, times, max(shares))
                    if zeros is not None:
                        zeros_ += [zero for zero in zeros if not any(overlap(zero, other) for other in zeros_)]
                        continue
                if max(shares) < SETTINGS.least:
                    undecided.append((smaller[0], self.times, smaller[1]))
                    continue
                stack += cut(smaller, shares.index(max(shares)), SETTINGS.cut)
        undecided += [(tau, self.times, value) for tau, value in stack]
        return IsolatedZeros(tuple(zeros_), tuple(undecided), count)

    def _size(self, window: Box) -> Fraction:
        """The change of the number that weighs as much as a period: boxes along a_c = 0 are about as long both ways."""
        with balls_at(self.balls.bits):
            _, by_tau, by_value = map(upper, self.of.push(*(self.balls.interval(*ends) for ends in window)))
            ratio = by_tau / by_value
            return as_rational(ratio) * self.period if ratio.is_finite() else Fraction(0)

    def _without_rest(self, box: Box) -> Box | None:
        """The part of a box in which a_c may vanish."""
        with balls_at(self.balls.bits):
            for _ in range(3):
                balls = tuple(self.balls.interval(*ends) for ends in box)
                lean = self.of.lean(*balls)
                if lean is None:
                    return None
                (one, two), size, rest = lean
                parts = []
                for ball, along, left, ends in zip(balls, (one, two), rest, box, strict=True):
                    middle = type(ball)(ball.mid())
                    inner = middle + along * size + left
                    if not inner.overlaps(ball):
                        return None
                    low, high = _ends_in_balls(inner)
                    parts.append((max(ends[0], low), min(ends[1], high)))
                if any(low > high for low, high in parts):
                    return None
                if all(new[1] - new[0] > (old[1] - old[0]) * 3 / 4 for new, old in zip(parts, box, strict=True)):
                    return tuple(parts)
                box = tuple(parts)
        return box

    def _decided(self, box: Box, times: Any, share: float) -> Sequence[Place] | None:
        """The zeros with (tau, number) in a box; None where it is too large to tell."""
        try:
            with balls_at(self.balls.bits):
                tau, value = (self.balls.interval(*ends) for ends in box)
                lean = self.of.lean(tau, value)
                if lean is None:
                    return ()
                pieces = FlightFromRest(self.of, tau, value, SETTINGS.bits, lean).touches(times)
        except (Refused, ValueError, ZeroDivisionError):
            return None
        if not pieces:
            return ()
        if share > SETTINGS.isolated:
            return None
        zeros: list[Place] = []
        for piece in pieces:
            with balls_at(ONE_BOX.bits):
                isolated = zeros_of(_Touch(self.of), (box[0], _ends_in_balls(piece), box[1]), ONE_BOX)
            if not isolated.complete:
                return None
            zeros += isolated.found
        return zeros


class _Touch:
    """a_c = 0, x = c, x' = 0 at t over boxes of (tau, t, number): a `System`."""

    def __init__(self, of: Tangencies) -> None:
        self.of = of

    def without_zeros(self, place: Place) -> bool:
        return not self.of.push(place[0], place[2])[0].contains(0)

    def linearised(self, balls: Place, middle: Place) -> tuple[Sequence[Any], Sequence[Sequence[Any]]] | None:
        tau, t, value = balls
        try:
            over, bend = at_time(self.of, tau, value, t, SETTINGS.fine)
            at, _ = at_time(self.of, middle[0], middle[2], middle[1], SETTINGS.fine)
        except (Refused, ValueError, ZeroDivisionError):
            return None
        _, by_tau, by_value = self.of.push(tau, value)
        (a, b), _, (p, q) = over.columns
        rows = [[by_tau, by_tau * 0, by_value], [a, over.speed, p], [b, bend, q]]
        return [self.of.push(middle[0], middle[2])[0], at.height, at.speed], rows


def _sides(times: tuple[float, float]) -> Iterator[tuple[int, tuple[Fraction, Fraction]]]:
    low, high = Fraction(times[0]), Fraction(times[1])
    if high > 0:
        yield 1, (max(low, Fraction(0)), high)
    if low < 0:
        yield -1, (max(-high, Fraction(0)), -low)


def _ends_in_balls(ball: Any) -> tuple[Fraction, Fraction]:
    low, high = (as_rational(type(ball)(end)) for end in (ball.lower(), ball.upper()))
    return low, high


def _mirrored(ends: tuple[Fraction, Fraction], sign: int) -> tuple[Fraction, Fraction]:
    return ends if sign > 0 else (-ends[1], -ends[0])


@dataclass(frozen=True)
class RestFlight:
    """x - c of the flights from rest of a linear model, as formulas in tau, t and the number that is varied.

    Parameters
    ----------
    over : its name. push : a_c(tau). heights : u and its derivatives by t up to the fourth.
    """

    over: str
    push: Expression
    heights: tuple[Expression, ...]

    def touches(self, period: float, ends: tuple[float, float], times: tuple[float, float]) -> IsolatedZeros:
        """(tau, t, value) of all lips and beaks in a period of tau."""
        longest = Fraction(period)
        window = ((-longest / MARGIN, longest * Fraction(MARGIN + 1, MARGIN)), _ends(times), _ends(ends))
        names = ("tau", "t", self.over)
        excluded = _no_other_than_at_zero(self.heights[3:], names)
        return isolated_zeros((self.push, *self.heights[:2]), names, window, excluded=excluded, settings=SEARCH)

    def swallowtails(self, tau: Any, value: Any, times: tuple[float, float]) -> IsolatedZeros:
        """All t != 0 at which the flight from a swan, given by balls, crosses x = c again."""
        fixed = {"tau": tau, self.over: value}
        excluded = _no_other_than_at_zero(self.heights[4:], ("t",), fixed)
        return isolated_zeros(
            self.heights[:1], ("t",), (_ends(times),), fixed=fixed, excluded=excluded, settings=SEARCH
        )


def doubts_left(
    family: Family, ends: tuple[float, float], times: tuple[float, float], listed: Iterable[Transition]
) -> tuple[str, ...]:
    """Why lips, beaks or swallowtails may be missing in a list; nothing where balls show that none is."""
    periods = family.periods(np.linspace(*ends, STEPS + 1))
    if "t" not in names_in(family.model.forcing(() if family.over == CLEARANCE else (family.over,))):
        return ()  # a_c is constant
    if not periods:
        return (
            "lips, beaks and swallowtails are met on a grid: balls show that there are no others of models "
            "with a period alone",
        )
    flight: RestFlight | EnclosedTouches = rest_flight(family) or EnclosedTouches(family.model, family.over)
    events, length = list(listed), max(periods.values())
    proof = flight.touches(length, ends, times)
    doubts = _undecided(proof, 2, f"lips and beaks for {family.over}")
    listed_places = [
        (event.tau, event.t, event.value) for event in events if event.kind in ("lips", "beaks", "undecided")
    ]
    for zero in proof.found:
        tau, t, value = (float(number.mid()) for number in zero)
        turn = next(iter(family.periods(np.array([value])).values()), length)
        inside = -NEAR * turn <= tau < turn * (1 - NEAR) and _within(t, times) and _within(value, ends)
        if inside and not any(_near((tau, t, value), other) for other in listed_places):
            doubts.append(f"the list lacks lips or beaks at {family.over} = {value:.12g}, tau = {tau:.6g}, t = {t:.6g}")
    for swan in (event for event in events if event.kind.startswith("swan")):
        crossings = flight.swallowtails(_rounded(swan.tau), _rounded(swan.value), times)
        doubts += _undecided(crossings, 0, "swallowtails at t")
        listed_there = [(event.t,) for event in events if event.kind == "swallowtail" and event.value == swan.value]
        for (zero,) in crossings.found:
            t = float(zero.mid())
            if _within(t, times) and not any(_near((t,), other) for other in listed_there):
                doubts.append(f"the list lacks a swallowtail at {family.over} = {swan.value:.12g}, t = {t:.6g}")
    return tuple(doubts)


def _undecided(made: IsolatedZeros, which: int, what: str) -> list[str]:
    if made.complete:
        return []
    low, high = min(float(box[which][0]) for box in made.undecided), max(float(box[which][1]) for box in made.undecided)
    return [f"{what} from {low:.9g} to {high:.9g} are not decided by {made.looked_at} boxes"]


def _within(value: float, ends: tuple[float, float]) -> bool:
    return ends[0] <= value <= ends[1]


def _near(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    return all(abs(a - b) < NEAR * (1 + abs(a)) for a, b in zip(one, other, strict=True))


def _rounded(value: float) -> Any:
    """All numbers of which a double is a rounding; a swan at 0 is known to 2^-80 of the window."""
    exact, spare = Fraction(value), Fraction(abs(value)) / 2**51 + Fraction(1, 2**70)
    return Balls(SEARCH.bits).interval(exact - spare, exact + spare)


def rest_flight(family: Family) -> RestFlight | None:
    """The formulas of a family; None where the model is not linear, or the number is in its frequencies or damping.

    Examples
    --------
    >>> from singimpact.oscillator.model import Oscillator
    >>> found = rest_flight(Family(Oscillator("x", "cos(2*t)", 0, "1/2"), "clearance"))
    >>> print(found.push)
    cos(2*tau) - clearance
    """
    names = () if family.over == CLEARANCE else (family.over,)
    form = form_of(family.model.force(names), family.model.forcing(names))
    clearance = Name(CLEARANCE) if family.over == CLEARANCE else family.model.clearance
    if form is None or names_in(form.damping) or names_in(form.stiffness):
        return None
    flight = linear_flight(form, clearance)
    if flight is None:
        return None
    heights = [flight.from_rest]
    for _ in range(4):
        heights.append(derivative(heights[-1], "t"))
    return RestFlight(family.over, flight.push, tuple(heights))


def _no_other_than_at_zero(
    trees: tuple[Expression, ...], names: tuple[str, ...], fixed: dict[str, Any] | None = None
) -> Callable[[tuple[Any, ...]], bool]:
    """Whether one of the trees has no zero between a box and t = 0."""
    recorder = Recorder()
    program = recorder.program([recorder.record(tree) for tree in trees])
    with balls_at(SEARCH.bits):
        run = program.prepared(fixed or {})
    where = names.index("t")

    def excluded(place: tuple[Any, ...]) -> bool:
        hull = tuple(part.union(0) if k == where else part for k, part in enumerate(place))
        return any(not value.contains(0) for value in run(dict(zip(names, hull, strict=True))))

    return excluded


def _ends(pair: tuple[float, float]) -> tuple[Fraction, Fraction]:
    return Fraction(pair[0]), Fraction(pair[1])
