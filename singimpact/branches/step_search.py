"""Zeros of the test functions of events within one step of a branch, also where a function has two of them.

At both ends of a step the values and the rates of every test function are given. A step on which the cubic through
them comes near 0 without a change of sign is divided where that cubic has its extremum, until every piece has one
change of sign of a function or none.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from math import copysign, sqrt
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.closing import Loop, Turn
from singimpact.branches.continuation import Curve, Point, cubic_between, root_between
from singimpact.branches.events.kind import NUDGE, EventKind, OrbitState, Test
from singimpact.branches.solutions import AnyClosing

# Test functions of events at a point of a branch, with their rates along it.

# In place of 0 at the first point; its product with another value is not 0. Of a test that is a difference of two terms
# which are equal in models without losses a part of these terms.
LEAST, RESTING = 1e-300, 1e-8
REMEMBERED = 8  # points whose closing conditions and minima are remembered


class Key(NamedTuple):
    """Which test function: the kind of the event, impact or flight, and which of its minima."""

    kind: EventKind
    impact: int
    number: int


Tests = dict[Key, Test]


@dataclass
class EventTests:
    """Test functions of the events of a branch.

    Parameters
    ----------
    closing : of its orbits. scales : of its unknowns. kinds : of events.
    """

    closing: AnyClosing
    scales: Array
    kinds: Sequence[EventKind]
    _loops: dict[bytes, Loop] = field(default_factory=dict)
    _minima: dict[bytes, list[list[Turn]]] = field(default_factory=dict)

    def state(self, point: Point) -> OrbitState:
        """A point of the branch, with what the tests are computed from."""
        state = OrbitState(self.closing, self.scales, point.at, point.tangent)
        state.loop = self.loop(point.at)  # computed once at a point, whatever its tangent is
        return state

    def loop(self, at: Array) -> Loop:
        """The closing conditions at a point."""
        loop: Loop = self._remembered(self._loops, at, self.closing.at)
        return loop

    def minima(self, at: Array) -> list[list[Turn]]:
        """Times and heights of the local minima of each flight."""
        turns: list[list[Turn]] = self._remembered(self._minima, at, self.closing.minima)
        return turns

    def heights(self, at: Array) -> list[float]:
        """The height of the lowest minimum of each flight; inf where there is none."""
        return [min((height for _, height in turns), default=np.inf) for turns in self.minima(at)]

    def _remembered(self, store: dict[bytes, Any], at: Array, compute: Any) -> Any:
        key = at.tobytes()
        if key not in store:
            while len(store) >= REMEMBERED:
                store.pop(next(iter(store)))
            store[key] = compute(at)
        return store[key]

    def at(self, point: Point, stored: Tests | None = None) -> Tests:
        """Every test function at a point of the branch; those of a user alone where the others are stored."""
        kinds = [kind for kind in self.kinds if stored is None or kind.is_own]
        if not kinds:
            return stored or {}
        state = self.state(point)
        state.turns = self.minima(point.at)
        return (stored or {}) | {Key(kind, i, j): test for kind in kinds for i, j, test in kind.tests(state)}

    def value(self, kind: EventKind, impact: int, point: Point) -> float:
        """One test function, which is no minimum of a flight, at a point of the branch."""
        return kind.value(self.state(point), impact)

    def leaving(self, point: Point) -> Tests:
        """Every test function at the first point of a branch; one that is 0 there has the sign from which it comes."""
        tests = self.at(point)
        for key, test in tests.items():
            # this test is 0 up to rounding of its terms; without losses it is 0 everywhere, and its rate too
            conserved = key.kind.conserved
            zero = RESTING * test.size if conserved else LEAST
            if abs(test.value) < zero and (not conserved or abs(test.rate) > NUDGE * test.size):
                tests[key] = test._replace(value=-copysign(zero, test.rate))
        return tests


@dataclass(frozen=True)
class SearchSettings:
    """When a step is divided."""

    # an extremum of the cubic that is nearer to 0 than this part of the larger end
    near: float = 0.1
    # ... unless it is about as far as the nearer end, which is a value of the function itself
    computed: float = 0.9
    # pieces are no shorter than this part of the step
    least: float = 1e-6
    # points in a step at most
    most: int = 100
    # a piece in which a minimum of a flight begins or ends is divided down to this part of the step
    born: float = 1e-3
    # how far beyond a linear forecast such a minimum may rise or fall
    forecast: float = 1.5
    # an extremum this near to 0, of the values at the ends of the step, may hide two zeros: two that are 1e-3 of the
    # interval apart leave a dip of 6e-4 on a step of 2 %, and are found (2000 branches); nearer ones may not be
    doubtful: float = 1e-3
    # a difference of two terms, of their size, that is a rounding error: for r = 1 without damping the product of the
    # multipliers is 1 everywhere
    neutral: float = 1e-9
    # distances from a change of sign of a user's function, of the step, at which it is compared with that ten times
    # farther; no less than 100 times what Newton's method leaves of a point, in scaled unknowns
    beside: float = 1e-7
    resolved: float = 1e-9
    # a function whose difference is more than this part of that over ten times the distance jumps: a fourth root has
    # 0.56 ... unless the difference is less than this part of the function at the ends of the step
    unchanged: float = 0.6
    negligible: float = 1e-9


SETTINGS = SearchSettings()


@dataclass(frozen=True)
class Node:
    """A point within a step, at a distance along the tangent of its first point, with its tests by that distance."""

    along: float
    point: Point
    tests: Tests


@dataclass(frozen=True)
class Crossing:
    """A change of sign of a test function between two points of a step; the keys may differ for minima of a flight."""

    keys: tuple[Key, Key]
    low: Node
    high: Node

    @property
    def kind(self) -> EventKind:
        """Of the event."""
        return self.keys[0].kind

    @property
    def ends(self) -> tuple[Test, Test]:
        """The test at both ends."""
        return self.low.tests[self.keys[0]], self.high.tests[self.keys[1]]


@dataclass
class StepSearch:
    """Where test functions vanish within a step.

    Parameters
    ----------
    tests : of the branch. curve : the branch. here : the first point. length : of the step.
    """

    tests: EventTests
    curve: Curve
    here: Point
    length: float
    doubts: list[tuple[Key, Array]] = field(default_factory=list)
    neutral: bool = False  # whether the product of the multipliers is 1 all along the step, up to rounding

    def node(self, along: float, point: Point, tests: Tests) -> Node:
        """A point of the step; rates become those by the distance along the tangent of the first point."""
        share = float(point.tangent @ self.here.tangent)
        return Node(along, point, {key: test._replace(rate=test.rate / share) for key, test in tests.items()})

    def at(self, along: float) -> Node | None:
        """The point of the branch at a distance."""
        step = self.curve.beyond(self.here, along)
        return None if step is None else self.node(along, step[0], self.tests.at(step[0]))

    def crossings(self, before: Tests, after: Point, later: Tests) -> list[Crossing]:
        """Every change of sign in the step; `doubts` has functions that touch 0, up to rounding."""
        nodes = [self.node(0.0, self.here, before), self.node(self.length, after, later)]
        self.neutral = all(_neutral(node) for node in nodes)
        sizes = {
            key: max(abs(test.value), abs(later[key].value) if key in later else 0.0) for key, test in before.items()
        }
        i = 0
        while i < len(nodes) - 1:
            one, other = nodes[i : i + 2]
            along = self._division(one, other)
            between = None
            if along is not None and len(nodes) < SETTINGS.most:
                between = self.at(along[1])
            if between is None:
                if along is not None:
                    self.doubts.append((along[0], one.point.at))
                i += 1
            else:
                nodes.insert(i + 1, between)
        changes = [crossing for one, other in pairwise(nodes) for crossing in self._signs(one, other)]
        self._touching(nodes, sizes, {crossing.kind for crossing in changes})
        return changes

    def _touching(self, nodes: list[Node], sizes: dict[Key, float], crossed: set[EventKind]) -> None:
        """Note functions that were computed at an extremum which is 0 up to rounding."""
        for node in nodes[1:-1]:
            for key, size in sizes.items():
                test = node.tests.get(key)
                flat = test is not None and abs(test.value) < SETTINGS.doubtful * size
                if flat and key.kind not in crossed and not (self.neutral and key.kind.conserved):
                    self.doubts.append((key, node.point.at))

    def _division(self, one: Node, other: Node) -> tuple[Key, float] | None:
        """Where a piece is to be divided, and for which function; None where it has nothing more to show."""
        width = other.along - one.along
        if width <= SETTINGS.least * self.length:
            return None
        for keys in self._paired(one, other):
            tests = one.tests[keys[0]], other.tests[keys[1]]
            if self._is_neutral(keys[0], one, other):
                continue
            share = turning(*(number for test in tests for number in (test.value, test.rate * width)))
            if share is not None:
                return keys[0], one.along + width * min(max(share, 1e-3), 1 - 1e-3)
        if width > SETTINGS.born * self.length and self._impacts(one) and self._impacts(other):
            for key in self._unpaired(one, other, width):
                return key, one.along + width / 2
        return None

    def _paired(self, one: Node, other: Node) -> list[tuple[Key, Key]]:
        """Each function at one point with the same function at another."""
        return _pairs(one.tests, other.tests, not self.tests.closing.n)[0]

    def _unpaired(self, one: Node, other: Node, width: float) -> Iterator[Key]:
        """Minima at one end alone that may pass the wall on their way."""
        _, first, second = _pairs(one.tests, other.tests, not self.tests.closing.n)
        for keys, tests, sign in ((first, one.tests, 1.0), (second, other.tests, -1.0)):
            for key in keys:
                test = tests[key]
                if test.value * (test.value + sign * SETTINGS.forecast * width * test.rate) < 0:
                    yield key

    def _impacts(self, node: Node) -> bool:
        """Whether every impact has a velocity: at a graze minima begin at the wall."""
        n = self.tests.closing.n
        return not n or float(node.point.at[n : 2 * n].min()) > 0

    def _is_neutral(self, key: Key, one: Node, other: Node) -> bool:
        """Whether a test is no function to look at: rounding alone at an end of the step, or all along it."""
        ends = [node for node in (one, other) if node.along in (0.0, self.length)]
        return key.kind.conserved and (self.neutral or any(_neutral(node) for node in ends))

    def _signs(self, one: Node, other: Node) -> Iterator[Crossing]:
        """Functions that change sign between two points."""
        for keys in self._paired(one, other):
            before, after = one.tests[keys[0]], other.tests[keys[1]]
            if before.value != 0 and before.value * after.value <= 0 and not self._is_neutral(keys[0], one, other):
                yield Crossing(keys, one, other)

    def located(self, crossing: Crossing) -> tuple[float, Point] | None:
        """The distance and the point at which the test vanishes; None where it, or the curve, has no value."""
        low, high = crossing.low, crossing.high
        values = crossing.ends[0].value, crossing.ends[1].value
        return self.curve.zero(
            {0.0: self.here, low.along: low.point, high.along: high.point},
            partial(self._value, crossing),
            lambda value: root_between(value, low.along, high.along, values),
        )

    def _value(self, crossing: Crossing, along: float, point: Point) -> float:
        if crossing.ends[0].is_minimum:
            turn = self.turn(crossing, along, point)
            return np.nan if turn is None else turn[1]
        return self.tests.value(crossing.kind, crossing.keys[0].impact, point)

    def jump(self, crossing: Crossing, along: float) -> tuple[float, float] | None:
        """The values on both sides of a change of sign at which a test jumps; None where it is continuous.

        The difference across a smooth zero is ten times less over a tenth of the distance, that across a square root
        three times; across a jump it stays.
        """
        near = max(SETTINGS.beside * self.length, SETTINGS.resolved)
        values = []
        for distance in (-10 * near, -near, near, 10 * near):
            step = self.curve.beyond(self.here, along + distance)
            if step is None:  # the branch ends here: nothing lies beyond a jump
                return None
            values.append(self.tests.value(crossing.kind, 0, step[0]))
        wide, narrow = abs(values[3] - values[0]), abs(values[2] - values[1])
        size = max(abs(test.value) for test in crossing.ends)
        jumps = narrow > SETTINGS.unchanged * wide and narrow > SETTINGS.negligible * size
        return (values[1], values[2]) if jumps else None

    def turn(self, crossing: Crossing, along: float, point: Point) -> tuple[float, float] | None:
        """Time and height of the minimum that a crossing is about."""
        low, high = crossing.low.along, crossing.high.along
        fraction = (along - low) / (high - low) if high > low else 0.0
        one, other = (test.share for test in crossing.ends)
        share = one + fraction * _gap(other - one, not self.tests.closing.n)
        flight = crossing.keys[0][1]
        span = self.tests.closing.span(point.at, flight)
        turns = self.tests.minima(point.at)[flight]
        free = not self.tests.closing.n
        return min(turns, key=lambda turn: abs(_gap(turn[0] / span - share, free)), default=None)


def turning(before: float, rate: float, after: float, later: float) -> float | None:
    """Where a function may have two zeros more than its ends show, as a part of a piece of length 1.

    Parameters
    ----------
    before, rate : value and derivative at 0. after, later : at 1.

    Returns
    -------
    float : an extremum of the cubic through them that lies near 0 or beyond it. None : there is none.

    Examples
    --------
    >>> turning(1.0, -4.1, 1.0, 4.1), turning(1.0, -0.5, 1.0, 0.5), turning(1.0, 0.0, -1.0, 0.0)
    (0.5, None, None)
    """
    square, cube = cubic_between(before, rate, after, later)
    root = square * square - 3 * cube * rate
    if not root > 0:  # no extremum, or no value
        return None
    root = sqrt(root)
    far = -square - root if square > 0 else -square + root
    places = [along for along in ((far / (3 * cube) if cube else -1.0), rate / far if far else -1.0) if 0 < along < 1]
    values = [before + along * (rate + along * (square + along * cube)) for along in places]
    size, least = max(abs(before), abs(after)), min(abs(before), abs(after))
    for along, value in zip(places, values, strict=True):
        towards = value * (square + 3 * cube * along) > 0
        if towards and abs(value) < SETTINGS.near * size and abs(value) < SETTINGS.computed * least:
            return along
        if before * after > 0 and value * before < 0:
            return along
    if before * after <= 0 and len(places) == 2 and values[0] * values[1] < 0:
        first = min(zip(places, values, strict=True))
        if first[1] * before < 0 or (before == 0 and first[1] * after > 0):
            return first[0]
    return None


def _neutral(node: Node) -> bool:
    """Whether the product of the multipliers is 1 at a point, up to rounding."""
    return any(
        key.kind.conserved and not abs(test.value) >= SETTINGS.neutral * test.size for key, test in node.tests.items()
    )


def _pairs(one: Tests, other: Tests, around: bool) -> tuple[list[tuple[Key, Key]], list[Key], list[Key]]:
    """Functions at both points, and minima at one of them alone.

    Two minima of a flight are the same where each is the nearest to the other.

    Parameters
    ----------
    around : whether the orbit is one without impact.
    """
    plain = [(key, key) for key, test in one.items() if key in other and not test.is_minimum]
    pairs, first, second = [], [], []
    minima = [[key for key, test in tests.items() if test.is_minimum] for tests in (one, other)]
    for flight in sorted({key.impact for keys in minima for key in keys}):
        here, there = ([key for key in keys if key.impact == flight] for keys in minima)
        mates = {
            key: min(there, key=lambda mate: abs(_gap(one[key].share - other[mate].share, around)), default=None)
            for key in here
        }
        back = {
            key: min(here, key=lambda mate: abs(_gap(other[key].share - one[mate].share, around)), default=None)
            for key in there
        }
        same = [(key, mate) for key, mate in mates.items() if mate is not None and back[mate] == key]
        pairs += same
        first += [key for key in here if key not in {pair[0] for pair in same}]
        second += [key for key in there if key not in {pair[1] for pair in same}]
    return plain + pairs, first, second


def _gap(shares: float, around: bool) -> float:
    """A difference of two parts of a flight; of an orbit without impact, which has no first one, around it."""
    return shares - round(shares) if around else shares
