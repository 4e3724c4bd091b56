"""Boxes of flights from rest at tangency points of an analytic model, flown through the wall, in balls.

A box holds launch times and values of a number of the model. Its members that matter solve a_c(tau, number) = 0: by the
mean value theorem their deviations from the middle of the box obey

    deviation of the number = lean * deviation of tau + a small rest,

so that a box is flown as the piece of a curve. At t = 0 x - c and its first two derivatives vanish for all of them. If
x - c and x' vanish again at t, Rolle's theorem gives zeros of the third and of the fourth derivative between: as long
as one of the two keeps its sign, there is no such t.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple

from singimpact.algebra.analytic import Recorder
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import ZERO, Expression, Name, add, multiply, names_in, substitute, subtract
from singimpact.flights.enclosures.equation import Equation, programs_of
from singimpact.flights.enclosures.motion import CarriedMotion, Met, Pair, Start, added
from singimpact.flights.enclosures.tube import Tube, ball, centre, narrowed, upper
from singimpact.handed_on import flint
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE

PIECES = 5  # times at which a box may touch the wall are cut to this power of 2 of a step
CUT = 0.4817  # where a piece of a step is cut: off the middle, where no crossing is expected
NEWTON = 4  # steps of Newton's method for the time of an extremum, at most
Step = tuple[Tube, Tube, Any]  # x - c and x' on a step, and its length


class Lean(NamedTuple):
    """Deviations (tau, number) of the members of a box: `along` times a common one, `size`, and a rest of each."""

    along: Pair
    size: Any
    rest: Pair


class Tangencies:
    """a_c over boxes of (tau, number), and the derivatives of x on a flight, as programs.

    Parameters
    ----------
    model : analytic. over : "clearance" or a parameter of it.
    """

    def __init__(self, model: Oscillator, over: str) -> None:
        self.over, self.programs = over, programs_of(model, (over,))
        clearance = Name(CLEARANCE) if over == CLEARANCE else model.clearance
        f, g = substitute(model.force((over,)), {"x": add(Name("x"), clearance)}), model.forcing((over,))
        second = subtract(g, f)
        third = _along(second, second)
        recorder = Recorder()
        push = recorder.record(subtract(g, substitute(f, {"x": ZERO, "xdot": ZERO})))
        self._push = recorder.program([push, *(recorder.derivative(push, name) for name in ("t", over))]).prepared({})
        self._higher = recorder.program([recorder.record(each) for each in (third, _along(third, second))])

    def push(self, tau: Any, number: Any) -> list[Any]:
        """a_c and its derivatives by tau and by the number."""
        return self._push({"t": tau, self.over: number})

    def lean(self, tau: Any, number: Any) -> Lean | None:
        """Deviations of members with a_c = 0 from the middle of a box; None where there is none."""
        middle = centre(tau), centre(number)
        deviations = tau - middle[0], number - middle[1]
        at_middle = self.push(*middle)[0]
        a, *slopes = self.push(tau, number)
        if not a.contains(0) or not (at_middle + slopes[0] * deviations[0] + slopes[1] * deviations[1]).contains(0):
            return None
        zero = a * 0
        sizes = [0.0 if slope.contains(0) else float(abs(slope).lower()) for slope in slopes]
        if not any(sizes):
            return Lean((zero + 1, zero), deviations[0], (zero, ball(deviations[1])))
        if sizes[1] >= sizes[0]:
            return Lean((zero + 1, -slopes[0] / slopes[1]), deviations[0], (zero, ball(at_middle / slopes[1])))
        return Lean((-slopes[1] / slopes[0], zero + 1), deviations[1], (ball(at_middle / slopes[0]), zero))


class FlightFromRest(CarriedMotion):
    """A box of flights from rest.

    Parameters
    ----------
    of : the model. tau, number : balls. bits : of the steps.
    lean : of the members with a_c = 0, to which the box is then limited; without it all of the box is flown.
    """

    def __init__(self, of: Tangencies, tau: Any, number: Any, bits: int, lean: Lean | None = None) -> None:
        middle = centre(number)
        equations = Equation(of.programs, {of.over: middle}), Equation(of.programs, {of.over: number})
        deviations = {of.over: number - middle}
        super().__init__(equations, Start(tau, tau * 0), bits, coarse=bits, deviations=deviations, through=True)
        self.lean, self.of, self.number = lean, of, number
        self._higher = of._higher.prepared({of.over: number})

    def _deviation(self) -> Pair:
        if self.lean is None:
            return super()._deviation()
        (a, b), (p, q) = self.turn, self.box
        by_tau, _, by_number = self.C
        along, size, rest = self.lean
        z, v = (
            (along[0] * one + along[1] * two) * size + rest[0] * one + rest[1] * two
            for one, two in zip(by_tau, by_number, strict=True)
        )
        return z + a * p - b * q, v + b * p + a * q

    def _spread(self) -> tuple[Tube, Tube]:
        if self.lean is None:
            return super()._spread()
        value, slope = self.own
        for (psi, rate), size in zip(self.by[:2], self.delta, strict=True):
            value, slope = added(value, psi, size), added(slope, rate, size)
        along, size, rest = self.lean
        (by_tau, rate_by_tau), (by_number, rate_by_number) = self.by[2:]
        value = added(value, _combined(by_tau, by_number, along), size)
        slope = added(slope, _combined(rate_by_tau, rate_by_number, along), size)
        for (psi, rate), term in zip(self.by[2:], rest, strict=True):
            value, slope = added(value, psi, term), added(slope, rate, term)
        return value, slope

    def bend(self, s: Any, height: Any, speed: Any) -> Any:
        """x'' at a time after the step began."""
        return self.equation.acceleration(self.tau + self.time + s, height, speed)

    def higher(self, s: Any, height: Any, speed: Any) -> list[Any]:
        """x''' and x'''' then."""
        return self._higher({"t": self.tau + self.time + s, "x": height, "xdot": speed})

    def touches(self, window: tuple[Any, Any]) -> list[Any]:
        """Times, as balls, at which x - c and x' of a member may both vanish; apart from these none does.

        Parameters
        ----------
        window : times above 0.
        """
        zeros_: list[Any] = []
        near = _NearLaunch()
        while not self.time >= window[1]:
            value, slope, length = step = self.tubes()
            touching = partial(self._touching, value=value, slope=slope)
            for _, _, piece in self._divided(step, near, (0.5, PIECES), touching):
                if piece is None:
                    continue
                time = self.time + piece
                if time < window[0] or time > window[1]:
                    continue
                if zeros_ and zeros_[-1].overlaps(time):
                    zeros_[-1] = zeros_[-1].union(time)
                else:
                    zeros_.append(time)
            self.advance(centre(length))
        return zeros_

    def crossings(self, window: tuple[Any, Any]) -> tuple[list[Any], list[Any]]:
        """Times at which x = c on the flight from a swan: balls with one such time each, and balls that are undecided.

        At a swan a_c' = 0 too: the fourth derivative of x has a zero between the launch and the first crossing.
        """
        zeros_: list[Any] = []
        undecided: list[Any] = []
        near = _NearLaunch([False, True])
        while not self.time >= window[1]:
            step = self.tubes()
            for piece, alone in self._crossed(step, near):
                time = self.time + piece
                if not (time < window[0] or time > window[1]):
                    (zeros_ if alone else undecided).append(time)
            self.advance(centre(step[2]))
        return zeros_, undecided

    def _divided(
        self, step: Step, near: "_NearLaunch", cut: tuple[float, int], left: Callable[[Any], Any]
    ) -> Iterator[tuple[Any, Any, Any]]:
        """The ends of pieces of a step on which x - c and x' may vanish, and what is left of each, or None.

        Parameters
        ----------
        cut : where a piece is cut of which something is left, and to which power of 2 of the step.
        """
        value, slope, length = step
        stack, least = [(flint.arb(0), flint.arb(length))], length * flint.arb(2) ** -cut[1]
        while stack:
            a, b = stack.pop()
            piece = a.union(b)
            higher = self.higher(piece, value(piece), slope(piece)) if near else []
            if near.goes_on(higher):
                continue
            rest = left(piece)
            if rest is not None and b - a > least:
                middle = centre(a + (b - a) * cut[0])
                stack += [(middle, b), (a, middle)]
                continue
            near.end(higher)
            yield a, b, rest

    def _crossed(self, step: Step, near: "_NearLaunch") -> Iterator[tuple[Any, bool]]:
        """Pieces of a step on which x - c may vanish, and whether it is shown to do so once."""
        value, slope, _ = step

        def both(piece: Any) -> Any:
            return piece if value(piece).contains(0) and slope(piece).contains(0) else None

        for a, b, undecided in self._divided(step, near, (CUT, 2 * PIECES), both):
            piece, ends = a.union(b), value(a) * value(b)
            if undecided is not None:
                yield piece, False
            elif value(piece).contains(0) and not ends > 0:
                alone = bool(ends < 0)
                yield (narrowed(piece, value, slope) if alone else piece), alone

    def _touching(self, piece: Any, value: Tube, slope: Tube) -> Any | None:
        """Where on a piece x - c and x' may both vanish."""
        for _ in range(NEWTON):
            height, speed = value(piece), slope(piece)
            middle = centre(piece)
            if not height.contains(0) or not speed.contains(0):
                return None
            if not (value(middle) + speed * (piece - middle)).contains(0):
                return None
            bend = self.bend(piece, height, speed)
            if bend.contains(0):
                return piece
            newton = middle - slope(middle) / bend
            if not newton.overlaps(piece):
                return None
            smaller = piece.intersection(newton)
            if smaller.rad() * 1.5 > piece.rad():
                return smaller
            piece = smaller
        return piece


class _NearLaunch:
    """Which of x''' and x'''' have kept their sign since the launch."""

    def __init__(self, kept: Sequence[bool] = (True, True)) -> None:
        self.kept = list(kept)

    def __bool__(self) -> bool:
        return any(self.kept)

    def _still(self, higher: list[Any]) -> list[bool]:
        return [kept and not value.contains(0) for kept, value in zip(self.kept, higher, strict=True)]

    def goes_on(self, higher: list[Any]) -> bool:
        """Whether one of them keeps its sign on the next piece too."""
        if not higher or not any(self._still(higher)):
            return False
        self.kept = self._still(higher)
        return True

    def end(self, higher: list[Any]) -> None:
        """A piece on which none does, and after it."""
        if higher:
            self.kept = self._still(higher)


def at_time(of: Tangencies, tau: Any, number: Any, time: Any, bits: int) -> tuple[Met, Any]:
    """A box of flights at a time, and x'' then; all of the box."""
    motion = FlightFromRest(of, tau, number, bits)
    met = motion.at(time)
    return met, motion.bend(met.time - motion.time, met.height, met.speed)


def _combined(one: Tube, other: Tube, factors: Pair) -> Tube:
    errors = [
        (e * upper(factor), k) for tube, factor in zip((one, other), factors, strict=True) for e, k in tube.errors
    ]
    return Tube(one.polynomial * factors[0] + other.polynomial * factors[1], tuple(errors))


def _along(tree: Expression, second: Expression) -> Expression:
    """The derivative of a tree in t, x, x' along the motion x'' = second."""
    parts = [derivative(tree, "t")]
    if "x" in names_in(tree):
        parts.append(multiply(derivative(tree, "x"), Name("xdot")))
    if "xdot" in names_in(tree):
        parts.append(multiply(derivative(tree, "xdot"), second))
    return add(*parts)
