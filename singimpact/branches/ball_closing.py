"""Closing conditions in balls: F and D F of n impacts in k periods, over the states and a number of the model.

    z(T_i) = 0,   rho(z'(T_i)) = v_(i+1),   z = x - c,   T_i = tau_(i+1) - tau_i,   tau_(n+1) = tau_1 + k P,

as in doubles (`closing`). They are smooth where the orbit touches the wall: v_1 = 0 is then known, and no unknown. That
flights are above the wall until they meet it is shown apart, by `first_hits`. `EnclosedMap` is the impact map over
boxes, for orbits that need not close.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from singimpact.algebra import Balls, Expression, derivative, evaluate, names_in, number, subtract
from singimpact.flights import (
    Arrival,
    JetHit,
    Launch,
    ProvedImpact,
    Refused,
    Walls,
    certified_hit,
    horizon_of,
    jet_hit,
    programs_of,
    timed_flight,
    touches_first,
)
from singimpact.handed_on import flint
from singimpact.oscillator import Oscillator, period_over

SPARE = 6  # digits of a flight beside those of the states
POINT = (Fraction(0), Fraction(0))


class EnclosedMap:
    """G and D G of a model over boxes, in balls of one precision.

    Parameters
    ----------
    osc : the model. digits : of the image of a point. bits : of the balls.
    over, reach : over boxes this number of the model lies so far from its value at most, and D G has a column for it.
    """

    def __init__(self, osc: Oscillator, digits: int, bits: int, over: str = "", reach: Fraction = Fraction(0)) -> None:
        assert osc.period is not None
        self.osc, self.digits, self.balls, self.over, self.reach = osc, digits, Balls(bits), over, reach
        self.period = evaluate(osc.period, {}, self.balls)
        self.horizon = Fraction(horizon_of(osc, None))

    def __call__(self, state: Sequence[Fraction], radii: Sequence[Fraction] = POINT) -> ProvedImpact:
        """The image of a box, with D G unless it is a point; `Refused` where a member is not shown to hit."""
        box = any(radii)
        spread = {"tau": radii[0], "v": radii[1]} | ({self.over: self.reach} if self.over else {})
        launch = Launch(number(state[0]), number(state[1]), 1, spread if box else {})
        return certified_hit(self.osc, launch, self.digits + SPARE, self.horizon, derivative=box)


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
        self.k, self.over = k, over
        moving = osc.period if over is None else period_over(osc, (over,))
        if moving is None:
            raise ArithmeticError(f"how the period depends on {over} is not known")
        self.tree: Expression = moving

    def at(self, value: Any, balls: Balls) -> tuple[Any, Any]:
        """k P and its derivative, where the number is a ball."""
        values = {} if self.over is None else {self.over: value}
        length = evaluate(self.tree, values, balls) * self.k
        if self.over is None or self.over not in names_in(self.tree):
            return length, length * 0
        slope = evaluate(derivative(self.tree, self.over), values, balls) * self.k
        return (length, slope) if length > 0 else (-length, -slope)


class Slopes(NamedTuple):
    """The flights and slopes from which D F over a box is made.

    Parameters
    ----------
    blocks : D G of each flight; none where an orbit touches the wall. ends : z and z' of each flight at its end.
    laws : the velocity after it, the slope of rho, and its derivative by the number. longer : that of k P.
    """

    blocks: list[list[list[Any]]]
    ends: list[Arrival]
    laws: list[list[Any]]
    longer: Any


class BallClosing:
    """F and D F of the closing conditions of n impacts.

    Parameters
    ----------
    osc : the model. k : periods. digits : of the states. bits : of the balls.
    over : the number of the model that is an unknown, the last one; or None. Between two walls it moves neither wall.
    word : the walls of the impacts, of a model with two; a flight from the upper one is one of the model with x -> -x.

    The unknowns are tau_1, v_1, ..., tau_n, v_n and the number.
    """

    touches = False

    def __init__(
        self, osc: Oscillator, k: int, digits: int, bits: int, over: str | None = None, word: tuple[int, ...] = ()
    ) -> None:
        self.osc, self.digits, self.over, self.word = osc, digits, over, word
        if osc.upper is not None and over is not None and over not in osc.parameters:
            raise Refused(f"orbits between two walls over the {over} are not enclosed, only those over a parameter")
        self.balls = Balls(bits)
        self.spans = Spans(osc, k, over)
        self.horizon = Fraction(horizon_of(osc, None))
        self.gap = None if osc.upper is None else evaluate(subtract(osc.upper, osc.clearance), {}, self.balls)

    def model(self, point: list[Fraction], impact: int = 0) -> Oscillator:
        """The model with the number of a point, whose lower wall is that of an impact."""
        osc = self.osc if self.over is None else self.osc.replace(**{self.over: point[-1]})
        return osc.mirrored if self.word and self.word[impact % len(self.word)] else osc

    def crosses(self, flight: int) -> bool:
        """Whether a flight ends at the other wall."""
        return bool(self.word) and self.word[flight] != self.word[(flight + 1) % len(self.word)]

    def number(self, point: list[Fraction], radius: Fraction) -> dict[str, Any]:
        """The number over a box, by its name."""
        return {} if self.over is None else {self.over: self.balls.interval(point[-1] - radius, point[-1] + radius)}

    def span(self, point: list[Fraction], radius: Fraction = Fraction(0)) -> tuple[Any, Any]:
        """k P and its derivative over a box."""
        return self.spans.at(self.number(point, radius).get(self.over or ""), self.balls)

    def states(self, point: list[Fraction]) -> list[tuple[Fraction, Fraction]]:
        """tau_i, v_i of a point."""
        numbers = list(point if self.over is None else point[:-1])
        if self.touches:
            numbers.insert(1, Fraction(0))
        return list(zip(numbers[::2], numbers[1::2], strict=True))

    def launch(self, state: tuple[Fraction, Fraction], radius: Fraction) -> Launch:
        """The box of a radius round a state and the number; from rest where v is 0."""
        rests = not state[1]
        names = [name for name in ("tau", None if rests else "v", self.over) if name is not None]
        radii = dict.fromkeys(names, radius) if radius else {}
        return Launch(number(state[0]), number(state[1]), 2 if rests else 1, radii)

    def flights(self, point: list[Fraction], radius: Fraction) -> list[tuple[Launch, Any]]:
        """The launch and the time of each flight over a box."""
        states, span = self.states(point), self.span(point, radius)[0]
        launches = [self.launch(state, radius) for state in states]
        if len(states) == 1:  # tau_1 is no part of the time, whose ball would be wider for it
            return [(launches[0], span)]
        times = [self.balls.interval(tau - radius, tau + radius) for tau, _ in states]
        times.append(times[0] + span)
        return [(launch, times[i + 1] - times[i]) for i, launch in enumerate(launches)]

    def ends(self, point: list[Fraction], radius: Fraction) -> tuple[list[Arrival], list[list[Any]]]:
        """z and z' at the end of each flight over a box; the velocity after it, and its derivatives."""
        ends, laws, numbers = [], [], self.number(point, radius)
        for i, (launch, time) in enumerate(self.flights(point, radius)):
            ends.append(timed_flight(self.model(point, i), launch, time, self.digits + SPARE, derivative=bool(radius)))
            law = programs_of(self.model(point, i + 1), tuple(numbers)).rho.prepared(numbers)
            side = -1 if self.crosses(i) else 1
            v, slope, *by_number = law({"v": side * ends[-1].velocity})
            laws.append([v, side * slope, *by_number])
        return ends, laws

    def first_hits(self, point: list[Fraction], radius: Fraction) -> None:
        """Refuse a box unless each flight of its orbits is between the walls, or above the one, until it meets one."""
        flights = self.flights(point, radius)
        for i, (launch, time) in enumerate(flights):
            crosses = not (self.touches and i == len(flights) - 1)
            walls = Walls(self.gap, self.crosses(i))
            touches_first(self.model(point, i), launch, time, self.digits + SPARE, crosses=crosses, walls=walls)

    def miss(self, point: list[Fraction]) -> Any:
        """F at a point, as a column."""
        states, rows = self.states(point), []
        for i, (end, law) in enumerate(zip(*self.ends(point, Fraction(0)), strict=True)):
            place = self.gap if self.crosses(i) else 0
            rows += [[end.height - place], [law[0] - self.balls.rational(states[(i + 1) % len(states)][1])]]
        return flint.arb_mat(rows)

    def slopes(self, point: list[Fraction], radius: Fraction) -> Slopes:
        """The derivatives of each flight over the box round each state and the number; and of k P."""
        ends, laws = self.ends(point, radius)
        blocks = [] if self.touches else [_impact(end, law) for end, law in zip(ends, laws, strict=True)]
        return Slopes(blocks, ends, laws, self.span(point, radius)[1])

    def bends(self, point: list[Fraction], radius: Fraction) -> list[JetHit]:
        """G with D G and D^2 G over the box round each state, by the number too."""
        return [
            jet_hit(self.model(point, i), self.launch(state, radius), self.horizon, self.crosses(i))
            for i, state in enumerate(self.states(point))
        ]

    def matrix(self, slopes: Slopes) -> Any:
        """D F, without the column of v_1 where the orbit touches the wall."""
        size = 2 * len(slopes.ends)
        rows = [[flint.arb(0)] * (size + (self.over is not None)) for _ in range(size)]
        for i, (end, law) in enumerate(zip(slopes.ends, slopes.laws, strict=True)):
            for p, (by_time, factor) in enumerate(((end.velocity, 1), (end.acceleration, law[1]))):
                row, late = rows[2 * i + p], by_time * factor
                by_tau, by_v, *by_number = (column[p] * factor for column in end.columns)
                row[2 * i] += by_tau - late
                row[2 * i + 1] += by_v
                row[(2 * i + 2) % size] += late
                if by_number:
                    # the last flight ends k periods later, and rho has the number too
                    row[-1] += by_number[0] + (law[2] if p else 0)
                    row[-1] += late * slopes.longer if 2 * i + 2 == size else 0
            rows[2 * i + 1][(2 * i + 3) % size] -= 1
        return flint.arb_mat([row[:1] + row[2:] for row in rows] if self.touches else rows)


class TouchingClosing(BallClosing):
    """Closing conditions of an orbit that touches the wall at its first point, with v_1 = 0.

    The unknowns are tau_1, then tau_2, v_2, ..., tau_n, v_n, and the number.
    """

    touches = True


def _impact(end: Arrival, law: list[Any]) -> list[list[Any]]:
    """D G of a flight from the derivatives at its end: the hit moves by -dz/z'."""
    rows: list[list[Any]] = [[], []]
    for index, (height, velocity) in enumerate(end.columns):
        late = -height / end.velocity
        rows[0].append(late + (index == 0))
        rows[1].append(law[1] * (velocity + end.acceleration * late) + (law[2] if index == 2 else 0))
    return rows


def return_slope(slopes: Any) -> Any:
    """The derivative of the return map: the product of the D G."""
    total = flint.arb_mat([[1, 0], [0, 1]])
    for block in slopes[0]:
        total = flint.arb_mat([row[:2] for row in block]) * total
    return total
