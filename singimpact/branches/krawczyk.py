"""Krawczyk's operator: a system of equations has one zero in a box and no other, proved.

Y is about the inverse of D F at the centre x of a box X. If

    x - Y F(x) + (1 - Y D F(X)) (X - x)   lies inside X,

there is one zero of F in X and no other, and every matrix in D F(X) is regular, so D F is at the zero.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

from singimpact.algebra.balls import Balls, as_rational
from singimpact.flights.enclosures.equation import Refused


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


class System(Protocol):
    """F and D F in balls.

    Methods
    -------
    miss : F at a point, as a column; a ball contains F of whatever is known by a ball.
    slopes, matrix : what D F over a box is made of, and D F made of it; `Refused` where it has no bound.
    radii : of the unknowns, for a box that contains every orbit whose states are within a distance.
    """

    @property
    def balls(self) -> Balls: ...
    def miss(self, at: list[Fraction]) -> Any: ...
    def slopes(self, at: list[Fraction], radii: Sequence[Fraction]) -> Any: ...
    def matrix(self, slopes: Any) -> Any: ...
    def radii(self, distance: Fraction) -> list[Fraction]: ...


@dataclass(frozen=True)
class Zero:
    """A zero that exists.

    Attributes
    ----------
    at : rational centre. offsets : balls of the zero less the centre. slopes : of the system, over a box around it.
    """

    at: list[Fraction]
    offsets: list[Any]
    slopes: Any


class Krawczyk:
    """Newton's method with one matrix, and the operator, for one system."""

    def __init__(self, system: System, start: list[Fraction]) -> None:
        self.system = system
        matrix = system.matrix(system.slopes(start, system.radii(KRAWCZYK.first)))
        self.Y = _middles(_middles(matrix).inv())

    def centre(self, start: list[Fraction], digits: int) -> list[Fraction]:
        """The end of Newton's method: its next step is below 10^-(digits + 2)."""
        at, small, balls = start, Fraction(1, 10 ** (digits + 2)), self.system.balls
        for _ in range(KRAWCZYK.rounds):
            move = [as_rational(part) for part in self.step(at)]
            at = [as_rational(balls.rational(x - part)) for x, part in zip(at, move, strict=True)]
            if all(abs(part) < small for part in move):
                return at
        raise Refused("Newton's method does not come to the digits")

    def step(self, at: list[Fraction]) -> list[Any]:
        """Y F(x)."""
        return list((self.Y * self.system.miss(at)).entries())

    def image(self, at: list[Fraction], step: list[Any], radii: Sequence[Fraction]) -> Zero | None:
        """The zero in the box of these radii; None where the box is not mapped into itself."""
        import flint

        try:
            slopes = self.system.slopes(at, radii)
        except Refused:
            return None
        size, spans = len(at), [self.system.balls.rational(each) for each in radii]
        unit = flint.arb_mat(size, size, [int(i == j) for i in range(size) for j in range(size)])
        rest = unit - self.Y * self.system.matrix(slopes)
        boxes = flint.arb_mat([[flint.arb(0, each.upper())] for each in spans])
        off = [spread - s for s, spread in zip(step, (rest * boxes).entries(), strict=True)]
        inside = all(part.is_finite() and abs(part) < r for part, r in zip(off, spans, strict=True))
        return Zero(at, off, slopes) if inside else None

    def tight(self, at: list[Fraction], step: list[Any], radii: Sequence[Fraction]) -> Zero:
        """As `image`, with a reason where the box is refused."""
        found = self.image(at, step, radii)
        if found is None:
            raise Refused("Krawczyk's operator does not map the box into itself: the orbit may be double, or graze")
        return found

    def unique_within(self, at: list[Fraction], step: list[Any], least: Fraction) -> Fraction:
        """The widest distance within which the zero is the only one; `least` is known to be one."""
        distance = KRAWCZYK.widest
        while distance > max(KRAWCZYK.narrowest, least):
            if self.image(at, step, self.system.radii(distance)) is not None:
                return distance
            distance /= KRAWCZYK.shrink
        return least


def upper(number: Any) -> Fraction:
    """A rational that is at least the size of every number in a ball.

    Examples
    --------
    >>> import flint
    >>> 1.75 <= upper(flint.arb(-1.5, 0.25)) < 1.76
    True
    """
    import flint

    return as_rational(flint.arb(abs(number).upper()))


def least(number: Any) -> Fraction:
    """A rational that is at most the size of every number in a ball."""
    import flint

    return as_rational(flint.arb(abs(number).lower()))


def proved(attempt: Callable[[], Any]) -> Any:
    """The result of an attempt, or the reason as text."""
    try:
        return attempt()
    except (Refused, ZeroDivisionError) as reason:
        return str(reason)


def _middles(matrix: Any) -> Any:
    import flint

    return flint.arb_mat([[flint.arb(part.mid()) for part in row] for row in matrix.table()])
