"""Krawczyk's operator: a zero of F that is proved to exist, alone in a box, or one for each value of a held unknown.

Y is about the inverse of D F at the centre x. If, for a box X round x,

    x - Y F(x) + (1 - Y D F(X)) (X - x)   lies inside X,

there is one zero of F in X and no other. Where one unknown is held, at any value within d of its centre, F(x) gains the
term D F(X) e (-d ... d), e that unknown, and there is one zero for each of its values: a curve, which has no end in X.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil
from typing import Any, Protocol

import numpy as np

from singimpact.algebra import BITS_A_DIGIT, Balls, Certified, as_rational, balls_at, from_ball
from singimpact.branches.ball_closing import BallClosing, return_slope
from singimpact.flights.enclosures.equation import Refused
from singimpact.handed_on import flint
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result

Point = list[Fraction]
Radius = Fraction | Sequence[Fraction]  # of every unknown, or one for each


@dataclass(frozen=True)
class KrawczykSettings:
    """Boxes that are tried.

    Parameters
    ----------
    first : radius, of times and velocities, of the boxes over which Y is computed.
    widest, narrowest, shrink : of the boxes in which the zero is shown to be the only one.
    rounds : of Newton's method, each of which gains about as many digits as `first` has.
    margin : of the last box, over the step that Newton's method would still take.
    """

    first: Fraction = Fraction(1, 10**10)
    widest: Fraction = Fraction(1, 10**3)
    narrowest: Fraction = Fraction(1, 10**9)
    shrink: int = 4
    rounds: int = 40
    margin: int = 4


KRAWCZYK = KrawczykSettings()
ORBIT = "the box into itself: the orbit may be double, or graze"  # what is not shown where a box is refused


class Equations(Protocol):
    """F in balls."""

    @property
    def balls(self) -> Balls: ...

    def miss(self, point: Point) -> Any:
        """F at a point, as a column."""

    def slopes(self, point: Point, radius: Any) -> Any:
        """The data from which D F over a box round a point is made; `Refused` where it is not bounded."""

    def matrix(self, slopes: Any) -> Any:
        """D F, with a column for each unknown, the held one among them."""


@dataclass(frozen=True)
class Image:
    """Krawczyk's operator on a box: its centre, the zero less the centre, and the slopes over the box."""

    centre: Point
    offsets: list[Any]
    slopes: Any


class Krawczyk:
    """F with Y at a point near its zero.

    Parameters
    ----------
    equations : F, of as many equations as there are unknowns, or of one less: then the unknown is held by which the
        curve of zeros goes fastest. near : about the zero. small : wanted of it.
    radii : of the box that contains all that is within a distance; the distance itself for every unknown without it.
    """

    def __init__(
        self,
        equations: Equations,
        near: Point,
        small: Fraction,
        radii: Callable[[Fraction], Radius] = lambda distance: distance,
    ) -> None:
        self.radii = radii
        slopes = equations.matrix(equations.slopes(near, radii(KRAWCZYK.first)))
        held = _fastest(slopes) if slopes.nrows() < len(near) else None
        self.equations, self.small, self.held = equations, small, held
        self.free = [index for index in range(len(near)) if index != held]
        self.Y = _middles(_middles(self._columns(slopes, self.free)).inv())
        self.tangent = [Fraction(0)] * len(near)
        if held is not None:
            for index, rate in zip(self.free, (self.Y * self._columns(slopes, [held])).entries(), strict=True):
                self.tangent[index] = -as_rational(rate)
            self.tangent[held] = Fraction(1)

    def moved(self, point: Point, shift: Fraction) -> Point:
        """About the zero where the held unknown has another value."""
        balls = self.equations.balls
        moved = [as_rational(balls.rational(x + part * shift)) for x, part in zip(point, self.tangent, strict=True)]
        if self.held is not None:
            moved[self.held] = point[self.held] + shift
        return moved

    def tangent_over(self, matrix: Any) -> list[Any]:
        """The vector that D F maps to 0, its held component 1, where D F is one of the matrices over a box.

        Raises
        ------
        ZeroDivisionError : the columns of the free unknowns may be dependent.
        """
        assert self.held is not None
        rates = (self.Y * self._columns(matrix, self.free)).solve(self.Y * self._columns(matrix, [self.held])).entries()
        return [*(-rate for rate in rates[: self.held]), flint.arb(1), *(-rate for rate in rates[self.held :])]

    @staticmethod
    def _columns(matrix: Any, kept: list[int]) -> Any:
        return flint.arb_mat([[row[j] for j in kept] for row in matrix.table()])

    def solved(self, point: Point) -> Point:
        """A zero to the digits wanted, by Newton's method with Y: nothing is proved here."""
        balls = self.equations.balls
        for _ in range(KRAWCZYK.rounds):
            move = [as_rational(change) for change in self.step(point)]
            point = list(point)
            for index, change in zip(self.free, move, strict=True):
                point[index] = as_rational(balls.rational(point[index] - change))
            if all(abs(change) < self.small for change in move):
                return point
        raise Refused("Newton's method does not come to the digits")

    def step(self, point: Point) -> list[Any]:
        """The step that Newton's method would still take."""
        return (self.Y * self.equations.miss(point)).entries()  # type: ignore[no-any-return]

    def image(self, point: Point, step: list[Any], radius: Radius, spread: Fraction = Fraction(0)) -> Image | None:
        """The image of a box; None where it does not lie inside.

        Parameters
        ----------
        step : of Newton's method at the point. spread : of the held unknown, at most the radius.
        """
        try:
            slopes = self.equations.slopes(point, radius)
        except Refused:
            return None
        matrix = self.equations.matrix(slopes)
        size, balls = len(self.free), self.equations.balls
        one = flint.arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])
        rest = one - self.Y * self._columns(matrix, self.free)
        widths = [radius] * len(point) if isinstance(radius, Fraction) else list(radius)
        radii, drift = [widths[index] for index in self.free], [flint.arb(0)] * size
        spreads = (rest * flint.arb_mat([[_round(balls, entry)] for entry in radii])).entries()
        if self.held is not None and spread:
            drift = [entry * _round(balls, spread) for entry in (self.Y * self._columns(matrix, [self.held])).entries()]
        off = [wide + moved - s for s, moved, wide in zip(step, drift, spreads, strict=True)]
        inside = all(entry.is_finite() and abs(entry) < balls.rational(r) for entry, r in zip(off, radii, strict=True))
        return Image(point, off, slopes) if inside else None

    def tight(self, point: Point, step: list[Any], radius: Radius, box: str = ORBIT) -> Image:
        """The image of a box, with a reason where the box is refused."""
        found = self.image(point, step, radius)
        if found is None:
            raise Refused(f"Krawczyk's operator does not map {box}")
        return found

    def enclosed(self, near: Point, box: str = ORBIT) -> tuple[Point, list[Any], Fraction, Image]:
        """A zero to the digits wanted, the step left, the radius of its box, and the image of that box."""
        point = self.solved(near)
        step = self.step(point)
        # wide enough for a zero so near
        own = max(KRAWCZYK.margin * max(map(upper, step)), self.small / 10)
        return point, step, own, self.tight(point, step, own, box)

    def unique_within(self, point: Point, step: list[Any], own: Fraction, spread: Fraction = Fraction(0)) -> Fraction:
        """The widest radius tried within which the zero is the only one; what fails is tried seldom, for it is slow.

        Parameters
        ----------
        own : a radius for which it is shown. spread : part of the radius in which the held unknown varies: the zeros
            within the radius are then those of one curve.
        """
        radii = [KRAWCZYK.widest]
        while radii[-1] > max(KRAWCZYK.narrowest, own):
            radii.append(radii[-1] / KRAWCZYK.shrink)
        radii = [radius for radius in radii if radius > max(KRAWCZYK.narrowest, own)]
        low, high = 0, len(radii)  # the widest that is shown is one of these, or `own`
        at = low
        while low < high:
            if self.image(point, step, self.radii(radii[at]), radii[at] * spread) is not None:
                high = at
            else:
                low = at + 1
            at = (low + high) // 2
        return radii[high] if high < len(radii) else own


def upper(ball: Any) -> Fraction:
    """A rational that is at least the size of every number in a ball.

    Examples
    --------
    >>> import flint
    >>> 1.75 <= upper(flint.arb(-1.5, 0.25)) < 1.76
    True
    """
    return as_rational(flint.arb(abs(ball).upper()))


def least(ball: Any) -> Fraction:
    """A rational that is at most the size of every number in a ball."""
    return as_rational(flint.arb(abs(ball).lower()))


def proved(attempt: Callable[[], Any]) -> Any:
    """The result of an attempt, or the reason as text."""
    try:
        return attempt()
    except (Refused, ZeroDivisionError) as reason:
        return str(reason)


def _fastest(slopes: Any) -> int:
    """The largest component of the vector that a matrix with one column too many maps to 0, in doubles."""
    rows = np.array([[float(part) for part in row] for row in _middles(slopes).table()])
    return int(np.argmax(np.abs(np.linalg.svd(rows)[2][-1])))


def _round(balls: Balls, radius: Fraction) -> Any:
    return flint.arb(0, balls.rational(radius).upper())


def _middles(matrix: Any) -> Any:
    return flint.arb_mat([[flint.arb(part.mid()) for part in row] for row in matrix.table()])


# A periodic orbit that is proved to exist, alone in a box, with its multipliers, by Krawczyk's operator.
#
# The unknowns are all states of the orbit: no box is carried from impact to impact, so unstable orbits need no care.


@dataclass(frozen=True)
class EnclosedOrbit(Result):
    """A periodic orbit that exists.

    Attributes
    ----------
    tau, v : `Certified` states just after its impacts. unique_within : no other orbit of so many impacts and periods
        has all its states within this distance, in tau and in v, of these.
    multipliers : two pairs (real part, imaginary part) of `Certified`; None where they may be equal.
    stable : whether both are proved to be below 1 in size; False where one is proved to be above; else None.
    oscillator, k : the model, and after how many periods the orbit closes. word : walls of its impacts, between two.
    """

    tau: tuple[Certified, ...]
    v: tuple[Certified, ...]
    unique_within: Fraction
    multipliers: tuple[tuple[Certified, Certified], ...] | None
    stable: bool | None
    oscillator: Oscillator | None = field(default=None, repr=False)
    k: int = 1
    word: tuple[int, ...] = field(default=(), repr=False)


def enclosed_orbit(
    osc: Oscillator, times: Any, speeds: Any, k: int, digits: int, word: tuple[int, ...] = ()
) -> EnclosedOrbit | str:
    """The orbit next to some states, proved; or the reason why it is not.

    Parameters
    ----------
    osc : the model. times, speeds : of n impacts, about. k : periods of the forcing. digits : of the states.
    word : the walls of the impacts, of a model with two.

    Examples
    --------
    >>> found = enclosed_orbit(Oscillator("x + x**3/10", "cos(4*t)", 0, "1/2"), [1.087], [0.497], 2, 25)
    >>> print(found.v[0], found.stable)
    0.4968833769630701986638762 True
    """
    states = [Fraction(float(coordinate)) for pair in zip(times, speeds, strict=True) for coordinate in pair]
    bits = ceil(digits * BITS_A_DIGIT) + 64
    with balls_at(bits):
        return proved(lambda: _enclosed(BallClosing(osc, k, digits, bits, word=word), states, digits))  # type: ignore[no-any-return]


def _enclosed(orbit: BallClosing, states: list[Fraction], digits: int) -> EnclosedOrbit:
    operator = Krawczyk(orbit, states, Fraction(1, 10 ** (digits + 2)))
    states, step, own, tight = operator.enclosed(states)
    orbit.first_hits(states, own)
    unique = operator.unique_within(states, step, own)
    numbers = [
        from_ball(orbit.balls.rational(x) + offset, digits) for x, offset in zip(states, tight.offsets, strict=True)
    ]
    multipliers, stable = _multipliers(return_slope(tight.slopes), digits)
    return EnclosedOrbit(
        tuple(numbers[::2]), tuple(numbers[1::2]), unique, multipliers, stable, orbit.osc, orbit.spans.k, orbit.word
    )


def _multipliers(total: Any, digits: int) -> tuple[Any, bool | None]:
    """Eigenvalues of the derivative of the return map, and whether they lie within the unit circle."""
    half, determinant = (total[0, 0] + total[1, 1]) / 2, total.det()
    under = half * half - determinant
    if under > 0:
        far = half + under.sqrt() if half > 0 else half - under.sqrt()
        pairs = [(far, flint.arb(0)), (determinant / far, flint.arb(0))]
    elif under < 0:
        pairs = [(half, (-under).sqrt()), (half, -(-under).sqrt())]
    else:
        return None, None
    sizes = [(a * a + b * b) for a, b in pairs]
    stable = True if all(size < 1 for size in sizes) else False if any(size > 1 for size in sizes) else None
    return tuple((from_ball(a, digits), from_ball(b, digits)) for a, b in pairs), stable
