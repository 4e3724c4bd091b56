"""A horseshoe next to a homoclinic orbit, proved by sets whose images cross one another.

A set is a parallelogram c + A (x_u, x_s), |x_u| <= a, |x_s| <= b. A map f crosses from X to Y if in Y's coordinates

    |offset_s| + |m21| a_X + |m22| b_X < b_Y,      |m11| a_X - |m12| b_X - |offset_u| > a_Y

for the offset of f(c_X) from c_Y and every matrix (m_ij) of the hull of A_Y^-1 D f(X) A_X: the image of each curve in X
from side to side has a piece in Y from side to side. N lies round the saddle, B_j, ..., B_(k-1) round impacts of the
orbit; B_j and N are disjoint. If

    N -> N  by G^n,      N -> B_j  by G^n,      B_i -> B_(i+1)  by G,      B_(k-1) -> N  by G,

there is for every sequence of short loops (n impacts) and long ones (n + k - j) a state of N that follows it: nested
pieces of one curve. Two sequences part at the first loop that differs, one in N, one in B_j, at a positive distance. So
the entropy of G is at least ln x, where x^-n + x^-(n + k - j) = 1. No theorem about homoclinic points is used.

For all values p of a number of the model within h of a middle the centres move, c(p) = c + c' (p - middle), and the
offset gains at most h |D_z G c'_X + D_p G - c'_Y|, by the mean value theorem. An interval is cut into such pieces.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from itertools import product, takewhile
from math import ceil, sqrt
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra import BITS_A_DIGIT, Array, Certified, as_rational, balls_at, from_ball, names_in, rational_ends
from singimpact.branches.ball_closing import POINT, EnclosedMap
from singimpact.branches.enclosed_crossing import prolonged
from singimpact.branches.krawczyk import least, proved, upper
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.saddle_cones import Cones, Pair, derivative_over, image_of
from singimpact.dynamics.invariant_arcs import model_step
from singimpact.flights.derivative import derivative, sensitivity
from singimpact.flights.enclosures.equation import Refused
from singimpact.handed_on import flint
from singimpact.inputs import need, require
from singimpact.oscillator import RESTITUTION, Oscillator, period_over, value_of, with_number
from singimpact.result import Result


@dataclass(frozen=True)
class HorseshoeSettings:
    """Sets that are tried.

    Parameters
    ----------
    digits : of the images. near : digits that choose how near to the saddle the orbit is followed.
    widest : the largest N, relative to the period. share : of the gaps beside it that B_j fills.
    widths : of the other sets at most, relative to N: an impact of a turn may shorten what the whole turn stretches.
    margin : by how much a set is narrower, and higher, than the image that crosses it.
    halvings : of an interval of a number, at most. rounds : of Newton's method for the orbit at a middle.
    """

    digits: int = 20
    near: int = 24
    widest: float = 0.1
    share: Fraction = Fraction(1, 2)
    widths: tuple[int, ...] = (1, 5)
    margin: Fraction = Fraction(9, 10)
    halvings: int = 12
    rounds: int = 6


SETTINGS = HorseshoeSettings()


@dataclass(frozen=True)
class CrossedSet(Result):
    """A parallelogram of states that an image crosses.

    Attributes
    ----------
    centre : (tau, v). frame : columns along which the map stretches and contracts. radii : a and b along them.
    drift : by which the centre moves with a number of the model, if it is for all values of an interval.
    """

    centre: Pair
    frame: tuple[Pair, Pair]
    radii: Pair
    drift: Pair = POINT

    @property
    def box(self) -> Pair:
        """Radii in tau and in v of a box around it."""
        (a, b), (c, d) = self.frame
        return abs(a) * self.radii[0] + abs(b) * self.radii[1], abs(c) * self.radii[0] + abs(d) * self.radii[1]

    @property
    def corners(self) -> Array:
        """In doubles, shape (4, 2), in order."""
        signs = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)])
        frame, radii = (np.array([[float(x) for x in row] for row in rows]) for rows in (self.frame, [self.radii]))
        return np.asarray([float(x) for x in self.centre] + (signs * radii[0]) @ frame.T)


@dataclass(frozen=True)
class Horseshoe(Result):
    """Proved chaos: every sequence of two loops is followed by an orbit.

    Attributes
    ----------
    loops : impacts of the short loop, next to the saddle, and of the long one, along the homoclinic orbit.
    entropy : `Certified` lower bound of the topological entropy of the impact map, per impact.
    sets : N and the sets of the long loop, in their order. oscillator : the model.
    reach : by which a number may differ from the model's, where it is one of a family: the sets move with it.
    """

    loops: tuple[int, int]
    entropy: Certified
    sets: tuple[CrossedSet, ...]
    oscillator: Oscillator
    reach: Fraction = Fraction(0)

    def __repr__(self) -> str:
        return (
            f"<certified horseshoe: loops of {self.loops[0]} and {self.loops[1]} impacts in any order, "
            f"entropy >= {float(self.entropy.value):.6g}>"
        )


@dataclass(frozen=True)
class HorseshoeFamily(Result):
    """Proved chaos for all values of a number of the model: horseshoes whose sets follow it.

    Attributes
    ----------
    over : the number. between : the ends of its interval, as rationals.
    entropy : `Certified` lower bound of the topological entropy, per impact, the least of the pieces.
    pieces : a horseshoe for each piece of the interval, at its middle, in their order. oscillator : the model.
    """

    over: str
    between: Pair
    entropy: Certified
    pieces: tuple[Horseshoe, ...]
    oscillator: Oscillator

    def __repr__(self) -> str:
        low, high = map(float, self.between)
        return (
            f"<certified horseshoes for all {self.over} in [{low:.9g}, {high:.9g}], pieces: {len(self.pieces)}, "
            f"entropy >= {float(self.entropy.value):.6g}>"
        )


def horseshoe(saddle: PeriodicOrbit, states: Array) -> Horseshoe | str:
    """The horseshoe next to a homoclinic orbit, proved; or the reason why it is not.

    Parameters
    ----------
    saddle : that it leaves and comes back to. states : its impacts from saddle to saddle, shape (N + 1, 2), about.
    """
    bits = ceil(SETTINGS.digits * BITS_A_DIGIT) + 64
    with balls_at(bits):
        return proved(lambda: _crossed(_followed(saddle, states, bits)))  # type: ignore[no-any-return]


def horseshoe_family(saddle: PeriodicOrbit, states: Array, over: Any, between: Any) -> HorseshoeFamily | str:
    """Horseshoes next to a homoclinic orbit for all values of a number, proved; or the reason why they are not.

    Parameters
    ----------
    saddle, states : as of `horseshoe`, of one value of the number.
    over : restitution, clearance or a parameter that the period does not depend on. between : its least and largest.
    """
    osc = with_number(saddle.oscillator, over)
    moving = period_over(osc, (over,))
    free = moving is not None and over not in names_in(moving)
    require(free, "over", over, "a number that the period does not depend on")
    limits = " in (0, 1]" if over == RESTITUTION else ""
    ends = rational_ends("between", between, f"two rational numbers low < high{limits}")
    require(not limits or 0 < ends[0] < ends[1] <= 1, "between", between, f"two rational numbers low < high{limits}")
    bits = ceil(SETTINGS.digits * BITS_A_DIGIT) + 64
    with balls_at(bits):
        return proved(lambda: _pieces(replace(saddle, oscillator=osc), states, over, ends, bits))  # type: ignore[no-any-return]


def _pieces(saddle: PeriodicOrbit, states: Array, over: str, between: Pair, bits: int) -> HorseshoeFamily:
    """The interval is halved where no horseshoe is proved; each piece starts from the orbit of the one before."""
    route = _followed(saddle, states, bits, over)
    pieces, todo, least = list[Horseshoe](), [between], (between[1] - between[0]) / 2**SETTINGS.halvings
    while todo:
        low, high = todo.pop()
        middle, reach = (low + high) / 2, (high - low) / 2
        try:
            pieces.append(_crossed(there := route.at(middle, reach)))
            route = there
        except Refused:
            if reach < least:
                raise
            todo += [(middle, high), (low, middle)]
    entropy = min((piece.entropy for piece in pieces), key=lambda bound: float(bound.value))
    return HorseshoeFamily(over, between, entropy, tuple(pieces), saddle.oscillator)


def _followed(saddle: PeriodicOrbit, states: Array, bits: int, over: str = "") -> "_Route":
    """The homoclinic orbit from next to the saddle until next to it, as a route for sets."""
    cones = Cones(saddle, SETTINGS.digits, bits)
    return _Route(cones, prolonged(cones, cones, states, SETTINGS.near)[1], over, POINT[0])


def _crossed(route: "_Route") -> Horseshoe:
    """The first N, from wide to narrow, for which all sets are crossed."""
    n, why = route.n, "no impact of the orbit is near enough to the saddle"
    for j, widest in product(range(n * ((len(route.states) - 1) // n), -1, -n), SETTINGS.widths):
        size = abs(route.places[j, 0])
        if not (abs(route.places[j, 1]) < 0.1 * size < 0.1 * SETTINGS.widest * route.period):
            continue
        try:
            return route.looped(j, Fraction(size / sqrt(route.far)), widest)
        except Refused as reason:
            why = str(reason)
    raise Refused(why)


class _Image(NamedTuple):
    """Of a set, in the coordinates of the next one: offset and bounds of the matrix, as rationals."""

    u: Fraction
    s: Fraction
    stretched: Fraction
    across: Fraction
    along: Fraction
    shrunk: Fraction

    def width(self, radii: Pair) -> Fraction:
        """To which the image reaches on both sides."""
        return self.stretched * radii[0] - self.across * radii[1] - self.u

    def height(self, radii: Pair) -> Fraction:
        """Beyond which the image has no state."""
        return self.s + self.along * radii[0] + self.shrunk * radii[1]


class _Route:
    """Impacts of a homoclinic orbit, with directions, and how they move with a number of the model."""

    def __init__(self, cones: Cones, states: Array, over: str, reach: Fraction) -> None:
        osc, balls = cones.saddle.oscillator, cones.map.balls
        self.cones, self.states, self.reach = cones, states, reach
        self.map = EnclosedMap(osc, SETTINGS.digits, balls.bits, over, reach) if over else cones.map
        self.n, self.period = int(cones.saddle.n), float(cones.map.period)
        self.far = abs(float(cones.orbit.multipliers[0][0].value))  # type: ignore[index]
        away = states - [*map(float, cones.centre)]
        away[:, 0] -= self.period * np.rint(away[:, 0] / self.period)
        self._along, self._across = np.array(cones.coordinates, dtype=float)
        self.places = away @ np.stack([self._along, self._across], axis=1)
        self.slopes = derivative(osc, states[:-1, 0], states[:-1, 1]).matrix
        self.drifts, self.homes = np.zeros_like(states), np.zeros((self.n, 2))
        if over:
            # of the saddle: its image moves as it does; of the orbit: it stays homoclinic, to first order
            turn = [_shifts(osc, state, over) for state in zip(cones.saddle.tau, cones.saddle.v, strict=True)]
            total = reduce(lambda done, step: step @ done, turn)
            self.homes[0] = np.linalg.solve(np.eye(2) - total[:2, :2], total[:2, 2])
            for i in range(1, self.n):
                self.homes[i] = (turn[i - 1] @ [*self.homes[i - 1], 1])[:2]
            by_number = np.array([_shifts(osc, state, over)[:2, 2] for state in states[:-1]])
            self.drifts = self._moved(by_number, [self._across @ self.homes[0], self._along @ self.homes[0]])

    def _moved(self, changes: Array, ends: Sequence[float]) -> Array:
        """Changes of the states where images change, with parts along W^s at the start, along W^u at the end."""
        count = len(self.states)
        matrix, goal = np.zeros((2 * count, 2 * count)), np.array([*changes.ravel(), *ends])
        for i, slope in enumerate(self.slopes):
            matrix[2 * i : 2 * i + 2, 2 * i : 2 * i + 4] = np.hstack([-slope, np.eye(2)])
        matrix[-2, :2], matrix[-1, -2:] = self._across, self._along
        return np.asarray(np.linalg.solve(matrix, goal).reshape(count, 2))

    def at(self, value: Fraction, reach: Fraction) -> "_Route":
        """The orbit of another value of the number, by Newton's method: nothing is shown."""
        saddle, over = self.cones.saddle, self.map.over
        shift = float(value) - value_of(saddle.oscillator, over)
        osc = saddle.oscillator.replace(**{over: value})
        tau, v = np.array([saddle.tau, saddle.v], dtype=float) + shift * self.homes.T
        cones = Cones(replace(saddle, oscillator=osc, tau=tau, v=v), SETTINGS.digits, self.map.balls.bits)
        states = self.states + shift * self.drifts
        for _ in range(SETTINGS.rounds):
            need((states[:, 1] > 0).all(), Refused(f"no orbit is found at {over} = {float(value):.6g}"))
            route = _Route(cones, states, "", reach)
            missed = model_step(osc, states[:-1]) - states[1:]
            missed[:, 0] -= self.period * np.rint(missed[:, 0] / self.period)
            states = states + route._moved(missed, [-route.places[0, 1], -route.places[-1, 0]])
        return _Route(cones, states, over, reach)

    def looped(self, j: int, a: Fraction, widest: int) -> Horseshoe:
        """The loops through an N of this size and the impact j; `Refused` where a set is not crossed."""
        home = CrossedSet(self.cones.centre, _rows(self.cones.frame), (a, a), _pair(self.homes[0]))
        ends = range(len(self.states) - 1, j, -self.n)
        back = list(takewhile(lambda k: np.abs(self.places[k]).max() <= a / 2, ends))
        if not back or len(back) == len(ends):
            raise Refused("the orbit does not leave the set round the saddle and come back")
        frames, sets, last = self._frames(j, back[-1]), [home], self._image(home, home, self.n)
        if not (last.width(home.radii) > a and last.height(home.radii) < a):
            raise Refused("the set round the saddle does not cross itself")
        for i, frame in enumerate(frames):
            new = CrossedSet(_pair(self.states[j + i]), frame, POINT, _pair(self.drifts[j + i]))
            seen = self._image(sets[-1], new, 1 if i else self.n)
            width = (
                self._beside(new, seen, home)
                if i == 0
                else min(SETTINGS.margin * seen.width(sets[-1].radii), widest * a)
            )
            if not width > 0:
                raise Refused(f"the image of the set before impact {j + i} does not stretch")
            radii = width, seen.height(sets[-1].radii) / SETTINGS.margin
            sets.append(replace(new, radii=_pair(radii)))
            if i == 0 and not self._apart(sets[-1], home):
                raise Refused("the first set of the long loop is not apart from that round the saddle")
        seen = self._image(sets[-1], home, 1)
        if not (seen.width(sets[-1].radii) > a and seen.height(sets[-1].radii) < a):
            raise Refused("the image of the last set does not cross that round the saddle")
        loops = self.n, self.n + len(frames)
        return Horseshoe(loops, _entropy(*loops), tuple(sets), self.cones.saddle.oscillator, self.reach)

    def _frames(self, j: int, k: int) -> list[tuple[Pair, Pair]]:
        """Columns next to the tangents of W^u and W^s at the impacts j ... k - 1."""
        E = np.array([[float(part) for part in row] for row in self.cones.frame])
        ahead, behind = [E[:, 0]], [E[:, 1]]
        for slope in self.slopes[j : k - 1]:
            ahead.append(_unit(slope @ ahead[-1]))
        for slope in self.slopes[j:k][::-1]:
            behind.append(_unit(np.linalg.solve(slope, behind[-1])))
        return [_rows(np.stack(pair, axis=1).tolist()) for pair in zip(ahead, behind[:0:-1], strict=True)]

    def _image(self, one: CrossedSet, other: CrossedSet, impacts: int) -> _Image:
        """The image of one set under n impacts, in the coordinates of another one."""
        landed = image_of(self.map, one.centre, impacts)
        off = [entry - self.map.balls.rational(centre) for entry, centre in zip(landed, other.centre, strict=True)]
        off[0] -= round(float(off[0].mid()) / self.period) * self.map.period
        (a, b), (c, d) = other.frame
        det = a * d - b * c
        inverse = self.cones.matrix(((d / det, -b / det), (-c / det, a / det)))
        way = self.reach * abs(one.drift[0]), self.reach * abs(one.drift[1])  # of the centre
        box = one.box[0] + way[0], one.box[1] + way[1]
        M = derivative_over(self.map, one.centre, box, impacts).table()
        if self.map.over:  # D along the way of the centre alone is narrower than over the set
            D = derivative_over(self.map, one.centre, way, impacts).table()
            rates = [self.map.balls.rational(rate) for rate in (*one.drift, *other.drift)]
            moved = [row[0] * rates[0] + row[1] * rates[1] + row[2] for row in D[:2]]
            spread = self.map.balls.interval(-self.reach, self.reach)
            off = [entry + spread * (rate - goal) for entry, rate, goal in zip(off, moved, rates[2:], strict=True)]
        offset = inverse * flint.arb_mat([[entry] for entry in off])
        M = inverse * flint.arb_mat([row[:2] for row in M[:2]]) * self.cones.matrix(one.frame)
        u, s, m12, m21, m22 = (upper(entry) for entry in (offset[0, 0], offset[1, 0], M[0, 1], M[1, 0], M[1, 1]))
        need(not M[0, 0].contains(0) and M[0, 0].is_finite(), Refused("a set is not shown to be stretched"))
        return _Image(u, s, least(M[0, 0]), m12, m21, m22)

    def _beside(self, first: CrossedSet, seen: _Image, home: CrossedSet) -> Fraction:
        """Half width of B_j: it stays within the image of N, and `_apart` tests that it stays beside N."""
        gap = abs(as_rational(self._xi(first.centre))) - home.radii[0]
        return SETTINGS.share * min(gap, SETTINGS.margin * seen.width(home.radii))

    def _xi(self, state: Pair) -> Any:
        off = state[0] - self.cones.centre[0]
        tau = self.map.balls.rational(off) - round(float(off) / self.period) * self.map.period
        row = [self.map.balls.rational(part) for part in self.cones.coordinates[0]]
        return row[0] * tau + row[1] * self.map.balls.rational(state[1] - self.cones.centre[1])

    def _apart(self, one: CrossedSet, home: CrossedSet) -> bool:
        """Whether every |xi| of a set is above that of N."""
        row = self.cones.coordinates[0]
        spread = [abs(row[0] * one.frame[0][q] + row[1] * one.frame[1][q]) * one.radii[q] for q in (0, 1)]
        drift = [x - y for x, y in zip(one.drift, home.drift, strict=True)]
        spread.append(self.reach * abs(row[0] * drift[0] + row[1] * drift[1]))
        return least(self._xi(one.centre)) - sum(spread) > home.radii[0]


def _rows(frame: Any) -> tuple[Pair, Pair]:
    (a, b), (c, d) = frame
    return (Fraction(a), Fraction(b)), (Fraction(c), Fraction(d))


def _pair(numbers: Iterable[Any]) -> Pair:
    """Doubles, which are short to write; sets are far wider than their rounding."""
    first, second = (Fraction(float(x)) for x in numbers)
    return first, second


def _shifts(osc: Oscillator, state: Iterable[Any], over: str) -> Array:
    """D G by the state and a number, which stays."""
    tau, v = state
    return np.vstack([sensitivity(osc, float(tau), float(v), (over,)).matrix, [0, 0, 1]])


def _unit(vector: Array) -> Array:
    return np.asarray(vector / np.abs(vector).max())


def _entropy(short: int, long: int) -> Certified:
    """ln x for x^-short + x^-long = 1, x > 1, in balls."""
    low, high = flint.arb(1), flint.arb(2)  # 1 + 1 > 1, and 2^-short + 2^-long <= 1
    for _ in range(60):
        middle = ((low + high) / 2).mid()
        if middle**-short + middle**-long > 1:
            low = middle
        else:
            high = middle
    return from_ball(low.union(high).log(), 15)
