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
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import product, takewhile
from math import ceil, sqrt
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.balls import BITS_A_DIGIT, as_rational
from singimpact.algebra.certified import Certified, from_ball
from singimpact.algebra.numbers import Array
from singimpact.algebra.precision import balls_at
from singimpact.branches.enclosed_crossing import prolonged
from singimpact.branches.krawczyk import least, proved, upper
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.saddle_cones import Cones, Pair, derivative_over, image_of
from singimpact.flights.derivative import derivative
from singimpact.flights.enclosures.equation import Refused
from singimpact.handed_on import flint
from singimpact.inputs import need
from singimpact.oscillator.model import Oscillator
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
    """

    digits: int = 20
    near: int = 24
    widest: float = 0.1
    share: Fraction = Fraction(1, 2)
    widths: tuple[int, ...] = (1, 5)
    margin: Fraction = Fraction(9, 10)


SETTINGS = HorseshoeSettings()


@dataclass(frozen=True)
class CrossedSet(Result):
    """A parallelogram of states that an image crosses.

    Attributes
    ----------
    centre : (tau, v). frame : columns along which the map stretches and contracts. radii : a and b along them.
    """

    centre: Pair
    frame: tuple[Pair, Pair]
    radii: Pair

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
    """

    loops: tuple[int, int]
    entropy: Certified
    sets: tuple[CrossedSet, ...]
    oscillator: Oscillator

    def __repr__(self) -> str:
        return (
            f"<certified horseshoe: loops of {self.loops[0]} and {self.loops[1]} impacts in any order, "
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
        return proved(lambda: _search(saddle, states, bits))  # type: ignore[no-any-return]


def _search(saddle: PeriodicOrbit, states: Array, bits: int) -> Horseshoe:
    """The first N, from wide to narrow, for which all sets are crossed."""
    cones = Cones(saddle, SETTINGS.digits, bits)
    _, states, _ = prolonged(cones, cones, states, SETTINGS.near)
    route = _Route(cones, states)
    n, why = int(saddle.n), "no impact of the orbit is near enough to the saddle"
    for j, widest in product(range(n * ((len(states) - 1) // n), -1, -n), SETTINGS.widths):
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
    """Impacts of a homoclinic orbit, with directions."""

    def __init__(self, cones: Cones, states: Array) -> None:
        self.cones, self.states, self.map = cones, states, cones.map
        self.n, self.period = int(cones.saddle.n), float(cones.map.period)
        self.far = abs(float(cones.orbit.multipliers[0][0].value))  # type: ignore[index]
        away = states - [float(part) for part in cones.centre]
        away[:, 0] -= self.period * np.rint(away[:, 0] / self.period)
        self.places = away @ np.array([[float(part) for part in row] for row in cones.coordinates]).T
        self.slopes = derivative(cones.saddle.oscillator, states[:-1, 0], states[:-1, 1]).matrix

    def looped(self, j: int, a: Fraction, widest: int) -> Horseshoe:
        """The loops through an N of this size and the impact j; `Refused` where a set is not crossed."""
        home = CrossedSet(self.cones.centre, _rows(self.cones.frame), (a, a))
        ends = range(len(self.states) - 1, j, -self.n)
        back = list(takewhile(lambda k: np.abs(self.places[k]).max() <= a / 2, ends))
        if not back or len(back) == len(ends):
            raise Refused("the orbit does not leave the set round the saddle and come back")
        frames, sets, last = self._frames(j, back[-1]), [home], self._image(home, home, self.n)
        if not (last.width(home.radii) > a and last.height(home.radii) < a):
            raise Refused("the set round the saddle does not cross itself")
        for i, frame in enumerate(frames):
            centre = tuple(Fraction(float(coordinate)) for coordinate in self.states[j + i])
            new = CrossedSet(centre, frame, (Fraction(0), Fraction(0)))  # type: ignore[arg-type]
            seen = self._image(sets[-1], new, 1 if i else self.n)
            width = (
                self._beside(new, seen, home)
                if i == 0
                else min(SETTINGS.margin * seen.width(sets[-1].radii), widest * a)
            )
            if not width > 0:
                raise Refused(f"the image of the set before impact {j + i} does not stretch")
            radii = width, seen.height(sets[-1].radii) / SETTINGS.margin
            # doubles, which are short to write; the margins are far wider than their rounding
            sets.append(CrossedSet(new.centre, frame, (Fraction(float(radii[0])), Fraction(float(radii[1])))))
            if i == 0 and not self._apart(sets[-1], home):
                raise Refused("the first set of the long loop is not apart from that round the saddle")
        seen = self._image(sets[-1], home, 1)
        if not (seen.width(sets[-1].radii) > a and seen.height(sets[-1].radii) < a):
            raise Refused("the image of the last set does not cross that round the saddle")
        loops = self.n, self.n + len(frames)
        return Horseshoe(loops, _entropy(*loops), tuple(sets), self.cones.saddle.oscillator)

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
        offset = inverse * flint.arb_mat([[entry] for entry in off])
        M = inverse * derivative_over(self.map, one.centre, one.box, impacts) * self.cones.matrix(one.frame)
        u, s, m12, m21, m22 = (upper(entry) for entry in (offset[0, 0], offset[1, 0], M[0, 1], M[1, 0], M[1, 1]))
        need(not M[0, 0].contains(0) and M[0, 0].is_finite(), Refused("a set is not shown to be stretched"))
        return _Image(u, s, least(M[0, 0]), m12, m21, m22)

    def _beside(self, first: CrossedSet, seen: _Image, home: CrossedSet) -> Fraction:
        """Half width of B_j: it stays within the image of N, and `_apart` tests that it stays beside N."""
        gap = abs(as_rational(self._xi(first.centre))) - home.radii[0]
        return SETTINGS.share * min(gap, SETTINGS.margin * seen.width(home.radii))

    def _xi(self, state: Pair) -> Any:
        """A ball of xi of a state."""
        off = state[0] - self.cones.centre[0]
        tau = self.map.balls.rational(off) - round(float(off) / self.period) * self.map.period
        row = [self.map.balls.rational(part) for part in self.cones.coordinates[0]]
        return row[0] * tau + row[1] * self.map.balls.rational(state[1] - self.cones.centre[1])

    def _apart(self, one: CrossedSet, home: CrossedSet) -> bool:
        """Whether every |xi| of a set is above that of N."""
        row = self.cones.coordinates[0]
        spread = [abs(row[0] * one.frame[0][q] + row[1] * one.frame[1][q]) * one.radii[q] for q in (0, 1)]
        return least(self._xi(one.centre)) - sum(spread) > home.radii[0]


def _rows(frame: Any) -> tuple[Pair, Pair]:
    (a, b), (c, d) = frame
    return (Fraction(a), Fraction(b)), (Fraction(c), Fraction(d))


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
