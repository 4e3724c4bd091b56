"""The first root of a function that is positive at 0, on pieces where its sign or its slope is certain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from singimpact.flights.enclosures.equation import Refused
from singimpact.flights.enclosures.tube import Tube, centre


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
    from flint import arb

    stack, least = [(arb(0), length)], length * arb(2) ** (-2 * bits // 3)
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
