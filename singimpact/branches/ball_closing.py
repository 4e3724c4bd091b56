"""Closing conditions in balls: F and D F of n impacts in k periods, over the states and a number of the model.

    F_i = G(tau_i, v_i) - (tau_(i+1), v_(i+1)),       k periods P taken off where the orbit closes.

All flights are first hits, for balls that prove nothing else are refused. Of an orbit that touches the wall with v = 0
the touching point is launched from, at rest, and the last flight ends there by x - c = x' = 0: both conditions are
smooth, where G is not.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.balls import Balls
from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, evaluate, names_in, number
from singimpact.branches.enclosed_map import SPARE
from singimpact.flights.enclosures.certified_hit import Launch, certified_hit
from singimpact.flights.enclosures.jet_flight import JetHit, jet_hit
from singimpact.flights.enclosures.timed_flight import Arrival, timed_flight, touches_first
from singimpact.flights.horizons import horizon_of
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import common_period

CONDITION = 2.0**6
"""Condition number that is expected of a flight: with it most flights have their digits at the first precision."""


class Spans:
    """k periods of the forcing, and their derivative by a number of the model.

    Parameters
    ----------
    osc : a model with a period. k : periods. over : the number, or None.

    Examples
    --------
    >>> osc = Oscillator("x", "cos(w*t)", 0, 1, {"w": 2})
    >>> [part.str(10, radius=False) for part in Spans(osc, 2, "w").at(Balls(64).rational(Fraction(4)), Balls(64))]
    ['3.141592654', '-0.7853981634']
    """

    def __init__(self, osc: Oscillator, k: int, over: str | None) -> None:
        assert osc.period is not None
        self.k, self.over = k, over
        self.tree: Expression = osc.period
        if over is not None and over in names_in(osc.g):
            moving = common_period(osc.forcing((over,)))
            if moving is None:
                raise ArithmeticError(f"how the period depends on {over} is not known")
            self.tree = moving

    def at(self, value: Any, balls: Balls) -> tuple[Any, Any]:
        """k P and its derivative, where the number is a ball."""
        values = {} if self.over is None else {self.over: value}
        length = evaluate(self.tree, values, balls) * self.k
        if self.over is None or self.over not in names_in(self.tree):
            return length, length * 0
        slope = evaluate(derivative(self.tree, self.over), values, balls) * self.k
        return (length, slope) if length > 0 else (-length, -slope)


class BallClosing:
    """F and D F of the closing conditions of n impacts.

    Parameters
    ----------
    osc : the model. k : periods. digits : of the states. bits : of the balls.
    over : the number of the model that is an unknown, the last one; or None.

    The unknowns are tau_1, v_1, ..., tau_n, v_n and the number.
    """

    def __init__(self, osc: Oscillator, k: int, digits: int, bits: int, over: str | None = None) -> None:
        self.osc, self.digits, self.over = osc, digits, over
        self._balls = Balls(bits)
        self.spans = Spans(osc, k, over)
        self.horizon = Fraction(horizon_of(osc, None))

    @property
    def balls(self) -> Balls:
        """The ring of the numbers."""
        return self._balls

    def model(self, point: list[Fraction]) -> Oscillator:
        """The model with the number of a point."""
        return self.osc if self.over is None else self.osc.replace(**{self.over: point[-1]})

    def span(self, point: list[Fraction], radius: Fraction = Fraction(0)) -> tuple[Any, Any]:
        """k P and its derivative over a box."""
        value = None if self.over is None else self.balls.interval(point[-1] - radius, point[-1] + radius)
        return self.spans.at(value, self.balls)

    def states(self, point: list[Fraction]) -> list[tuple[Fraction, Fraction]]:
        """tau_i, v_i of a point."""
        count = len(point) // 2
        return [(point[2 * i], point[2 * i + 1]) for i in range(count)]

    def launch(self, state: tuple[Fraction, Fraction], radius: Fraction) -> Launch:
        """The box of a radius round a state and the number; from rest where v is 0."""
        rests = not state[1]
        names = [name for name in ("tau", None if rests else "v", self.over) if name is not None]
        radii = dict.fromkeys(names, radius) if radius else {}
        return Launch(number(state[0]), number(state[1]), 2 if rests else 1, radii)

    def hit(self, point: list[Fraction], index: int, radius: Fraction = Fraction(0)) -> Any:
        """The impact after a state of a point, with D G over the box where there is a radius."""
        states = self.states(point)
        launch, last = self.launch(states[index], radius), index == len(states) - 1
        time = float(states[(index + 1) % len(states)][0] - states[index][0])
        time += float(self.span(point)[0].mid()) if last else 0.0
        return certified_hit(
            self.model(point), launch, self.digits + SPARE, self.horizon, derivative=bool(radius),
            expected=(max(time, 0.0), CONDITION),
        )  # fmt: skip

    def miss(self, point: list[Fraction]) -> Any:
        """F at a point, as a column."""
        import flint

        states, rows = self.states(point), []
        for i in range(len(states)):
            hit = self.hit(point, i)
            tau, v = (self.balls.rational(part) for part in states[(i + 1) % len(states)])
            later = self.span(point)[0] if i == len(states) - 1 else 0
            rows += [[hit.tau - tau - later], [hit.v - v]]
        return flint.arb_mat(rows)

    def slopes(self, point: list[Fraction], radius: Fraction) -> tuple[list[list[list[Any]]], Any]:
        """D G over the box round each state, with a third column for the number; and the derivative of k P."""
        count = len(self.states(point))
        return [self.hit(point, i, radius).derivative for i in range(count)], self.span(point, radius)[1]

    def bends(self, point: list[Fraction], radius: Fraction) -> tuple[list[JetHit], Any]:
        """G with D G and D^2 G over the box round each state, by the number too; and the derivative of k P."""
        model = self.model(point)
        hits = [jet_hit(model, self.launch(state, radius), self.horizon) for state in self.states(point)]
        return hits, self.span(point, radius)[1]

    def matrix(self, slopes: tuple[list[list[list[Any]]], Any]) -> Any:
        """D F from the D G: blocks beside the diagonal, less the identity."""
        import flint

        blocks, longer = slopes
        size = 2 * len(blocks)
        rows = [[flint.arb(0)] * (size + (self.over is not None)) for _ in range(size)]
        for i, block in enumerate(blocks):
            for p in (0, 1):
                for q in (0, 1):
                    rows[2 * i + p][2 * i + q] += block[p][q]
                rows[2 * i + p][(2 * i + 2 + p) % size] -= 1
                if self.over is not None:
                    rows[2 * i + p][-1] += block[p][2]
        if self.over is not None:
            rows[-2][-1] -= longer
        return flint.arb_mat(rows)


def return_slope(slopes: tuple[list[list[list[Any]]], Any]) -> Any:
    """The derivative of the return map: the product of the D G."""
    import flint

    total = flint.arb_mat([[1, 0], [0, 1]])
    for block in slopes[0]:
        total = flint.arb_mat([row[:2] for row in block]) * total
    return total


@dataclass(frozen=True)
class TouchingSlopes:
    """D G of the flights that end in an impact, D of the one that ends at the touching point, and of k P."""

    blocks: list[list[list[Any]]]
    arrival: Arrival
    longer: Any


class TouchingClosing(BallClosing):
    """The same of an orbit that touches the wall at its first point, with v_1 = 0.

    The unknowns are tau_1, then tau_2, v_2, ..., tau_n, v_n, and the number.
    """

    def states(self, point: list[Fraction]) -> list[tuple[Fraction, Fraction]]:
        """tau_i, v_i of a point, those of the touching point first."""
        count = (len(point) - 2) // 2
        return [(point[0], Fraction(0)), *((point[2 * i + 1], point[2 * i + 2]) for i in range(count))]

    def arrival(self, point: list[Fraction], radius: Fraction) -> Arrival:
        """The last flight at the time of the touching point, k periods later."""
        launch, time = self._last(point, radius)
        return timed_flight(self.model(point), launch, time, self.digits + SPARE, derivative=bool(radius))

    def _last(self, point: list[Fraction], radius: Fraction) -> tuple[Launch, Any]:
        """The launch of the last flight, and its time."""
        tau, v = self.states(point)[-1]
        ends = [self.balls.interval(part - radius, part + radius) for part in (point[0], tau)]
        return self.launch((tau, v), radius), self.span(point, radius)[0] + (ends[0] - ends[1] if len(point) > 2 else 0)

    def touches(self, point: list[Fraction], radius: Fraction) -> None:
        """Refuse a box unless the last flight of each of its orbits is above the wall until it touches it."""
        launch, time = self._last(point, radius)
        touches_first(self.model(point), launch, time, self.digits + SPARE)

    def miss(self, point: list[Fraction]) -> Any:
        import flint

        rows = []
        for i, after in enumerate(self.states(point)[1:]):
            hit = self.hit(point, i)
            rows += [[hit.tau - self.balls.rational(after[0])], [hit.v - self.balls.rational(after[1])]]
        last = self.arrival(point, Fraction(0))
        return flint.arb_mat([*rows, [last.height], [last.velocity]])

    def slopes(self, point: list[Fraction], radius: Fraction) -> Any:
        blocks = [self.hit(point, i, radius).derivative for i in range(len(self.states(point)) - 1)]
        return TouchingSlopes(blocks, self.arrival(point, radius), self.span(point, radius)[1])

    def matrix(self, slopes: Any) -> Any:
        import flint

        assert isinstance(slopes, TouchingSlopes)
        size = 2 * len(slopes.blocks) + 2
        rows = [[flint.arb(0)] * size for _ in range(size)]
        for i, block in enumerate(slopes.blocks):
            for p in (0, 1):
                if i:
                    rows[2 * i + p][2 * i - 1] += block[p][0]
                    rows[2 * i + p][2 * i] += block[p][1]
                else:
                    rows[p][0] += block[p][0]
                rows[2 * i + p][2 * i + 1 + p] -= 1
                rows[2 * i + p][-1] += block[p][2]
        last, alone = slopes.arrival, size == 2
        for p, by_time in enumerate((last.velocity, last.acceleration)):
            by_tau, by_v, by_number = (column[p] for column in last.columns)
            row = rows[size - 2 + p]
            if alone:
                row[0] += by_tau
            else:
                row[0] += by_time
                row[-3] += by_tau - by_time
                row[-2] += by_v
            row[-1] += by_number + slopes.longer * by_time
        return flint.arb_mat(rows)
