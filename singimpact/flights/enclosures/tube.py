"""A function known as a polynomial and a bound of the distance from it; its first root; and what balls are read as.

The first root is isolated on pieces where the sign of the function or of its slope is certain.
"""

from dataclasses import dataclass
from typing import Any

from singimpact.flights.enclosures.equation import Refused
from singimpact.handed_on import flint


class Tube:
    """A function within sum e s^k of a polynomial on [0, h], with (e, k) its errors.

    Examples
    --------
    >>> import flint
    >>> tube = Tube(flint.arb_poly([1, 2]), ((flint.arb(1) / 8, 2),))
    >>> print(tube(flint.arb(1)))
    [3e+0 +/- 0.126]
    """

    __slots__ = ("_whole", "errors", "polynomial")

    def __init__(self, polynomial: Any, errors: tuple[tuple[Any, int], ...]) -> None:
        self.polynomial, self.errors, self._whole = polynomial, errors, polynomial
        # an error e s^k is a ball in the coefficient of s^k: one evaluation then gives polynomial and errors
        for e, k in errors:
            self._whole += flint.arb_poly([*[0] * k, ball(e)])

    def __call__(self, s: Any) -> Any:
        return self._whole(s)


def height(coefficients: list[Any], bound: Any) -> Tube:
    """z on a step: |z - P| <= K s^(n+1)/(n+1), n the degree of P."""
    n = len(coefficients) - 1
    return Tube(flint.arb_poly(coefficients), ((bound / (n + 1), n + 1),))


def speed(coefficients: list[Any], bound: Any) -> Tube:
    """z' on a step: |z' - P'| <= K s^n."""
    return Tube(flint.arb_poly(coefficients).derivative(), ((bound, len(coefficients) - 1),))


def divided(tube: Tube, slope: Tube, removed: int) -> tuple[Tube, Tube]:
    """y = z/s^p and y' = (z' - p z/s)/s^p, where the first p coefficients of z are exactly 0."""
    y = flint.arb_poly([tube.polynomial[k] for k in range(removed, tube.polynomial.degree() + 1)])
    value = tuple((e, k - removed) for e, k in tube.errors)
    rate = tuple((e, k - removed) for e, k in slope.errors)
    rate += tuple((removed * e, k - removed - 1) for e, k in tube.errors)
    return Tube(y, value), Tube(y.derivative(), rate)


def below(tube: Tube, slope: Tube, place: Any) -> tuple[Tube, Tube]:
    """place - z and its slope."""
    return Tube(place - tube.polynomial, tube.errors), Tube(-slope.polynomial, slope.errors)


def upper(value: Any) -> Any:
    """An exact upper bound of the modulus of a ball or of a complex ball."""
    return abs(value).upper()


def ball(bound: Any) -> Any:
    """The ball round 0 of a radius."""
    return flint.arb(0, upper(bound))


def centre(value: Any) -> Any:
    """The midpoint of a ball, exact."""
    return flint.arb(value.mid())


# ---- the first root of a function that is positive at 0


@dataclass(frozen=True)
class RootSettings:
    """Settings of the subdivision of pieces.

    Parameters
    ----------
    split : where a piece is cut; a launch at round numbers has no root there.
    apart : where two pieces with a root at their common end are made to meet instead.
    pieces : at most. narrowings : of the piece with the root, at most.
    """

    split: float = 0.4817
    apart: float = 0.3
    pieces: int = 4000
    narrowings: int = 100


ROOT = RootSettings()


class NearGraze(Refused):
    """Value and slope both meet 0 at a time."""

    def __init__(self, at: Any) -> None:
        super().__init__("value and slope both meet 0")
        self.at = at


class RootAtEnd(Exception):
    """The sign at the end of the step is open: the root may lie there."""


def first_root(value: Tube, slope: Tube, length: Any, bits: int) -> Any | None:
    """A ball with exactly one root, the first on (0, length]; None where there is none.

    Raises
    ------
    NearGraze : a piece of length 2^(-2 bits/3) is not decided. RootAtEnd : take a shorter step.

    Notes
    -----
    Existence is a change of sign where the slope is negative; Newton's method narrows what is already shown.
    """
    stack, least = [(flint.arb(0), length)], length * flint.arb(2) ** (-2 * bits // 3)
    for _ in range(ROOT.pieces):
        if not stack:
            return None
        a, b = stack.pop()
        piece, middle = a.union(b), centre(a + (b - a) * ROOT.split)
        rate = slope(piece)
        # no root on this piece: the value is positive throughout, by itself, by the mean value form, or since it rises
        # from there
        if value(piece) > 0 or value(middle) + rate * (piece - middle) > 0 or (rate > 0 and value(a) > 0):
            continue
        if rate < 0:
            last = value(b)
            if last > 0:
                continue
            if last < 0 and value(a) > 0:
                return narrowed(piece, value, slope)
            if not stack:
                raise RootAtEnd
            if b - a < least:
                raise NearGraze(a)
            # the sign at b is open, as the root may be b itself: this piece and the next are cut at another place
            _, after = stack.pop()
            b = centre(b + (after - b) * ROOT.apart)
            stack += [(b, after), (a, b)]
            continue
        if b - a < least:
            raise NearGraze(a)
        stack += [(middle, b), (a, middle)]
    raise NearGraze(a)


def narrowed(piece: Any, value: Tube, slope: Tube) -> Any:
    """A smaller ball with the one root of a piece."""
    for _ in range(ROOT.narrowings):
        middle = centre(piece)
        # interval Newton: the root lies in both balls
        newton = middle - value(middle) / slope(piece)
        if not newton.is_finite():
            return piece
        smaller = piece.intersection(newton)
        if smaller.rad() * 1.5 > piece.rad():
            return smaller
        piece = smaller
    return piece
