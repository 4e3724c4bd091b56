"""The unfolded positive swan in balls: from which states at rest behind A chatter is complete before B, proved.

kappa = 1 and sigma = -1 + h y, time h T, velocity h^2 w; rest at sigma = -1 - h is y = -1, w = 0, and all is smooth at
h = 0.  A flight from (y, w) is at the wall after T where

    p(T) = w + (6 h y^2 - 12 y) T + (4 h y - 4) T^2 + h T^3 = 0,

and lands with T p'(T).  For w > 0 the cubic has a negative root and so two positive ones or none: the root with p' < 0
is the first.  An interval of h is carried as an orbit from its middle and a ball for the derivative of all orbits by h.
"""

from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction
from functools import lru_cache
from typing import Any

from flint import arb, fmpq

from singimpact.algebra.precision import balls_at

BITS = 80
LAST = Fraction(2, 3)  # h from which the first impact comes at B or later: sigma = -5/3 lands at 1


class Side(Enum):
    """The common fate of all orbits of an interval of h."""

    complete = "chatter is complete before B"
    left = "no impact follows before B"


@dataclass(frozen=True)
class Bracket:
    """From rest at -1 - h chatter is complete for 0 < h <= low, orbits pass B for high <= h; on `boxes` intervals."""

    low: Fraction
    high: Fraction
    boxes: int


@dataclass(frozen=True)
class Effort:
    """Limits of the division of intervals and of the orbits.

    Parameters
    ----------
    narrow : width in h at which the division stops. impacts : at most for one interval. pieces : into which the time to
        B is cut where no impact is to be shown. wide : windows tried for what chatter is left, in 2w/(|a| (1 - r)).
    """

    narrow: Fraction = Fraction(1, 10000)
    impacts: int = 400
    pieces: int = 24
    wide: tuple[float, ...] = (1.3, 1.8, 2.6, 4.0)


EFFORT = Effort()


@lru_cache(maxsize=16)
def bracket(rate: str) -> Bracket | None:
    """The bracket of the end of gamma for a restitution 0 < r < 1; None where intervals are not decided in this order.

    Examples
    --------
    >>> found = bracket("1/2")
    >>> float(found.low) < 0.3851336 < float(found.high), found.high - found.low < Fraction(1, 200)
    (True, True)
    """
    with balls_at(BITS):
        r = _ball(Fraction(rate))
        pieces, todo = list[tuple[Fraction, Fraction, Side | None]](), [(Fraction(0), LAST)]
        while todo:
            low, high = todo.pop()
            side = _side(r, low, high)
            if side is None and high - low > EFFORT.narrow:
                middle = (low + high) / 2
                todo += [(middle, high), (low, middle)]  # the lower one is taken next, so they come in order
            else:
                pieces.append((low, high, side))
    open_ = [(low, high) for low, high, side in pieces if side is None]
    if not open_:
        return None
    low, high = open_[0][0], open_[-1][1]
    in_order = all(
        side == (Side.complete if end <= low else Side.left) for _, end, side in pieces if not low < end <= high
    )
    return Bracket(low, high, len(pieces)) if in_order and low > 0 and high < LAST else None


def _ball(value: Fraction) -> arb:
    return arb(fmpq(value.numerator, value.denominator))


def _side(r: arb, low: Fraction, high: Fraction) -> Side | None:
    """The common fate of all orbits from rest at -1 - h, h between two numbers; None when it is not decided."""
    middle, radius = _ball((low + high) / 2), _ball((high - low) / 2)
    spread = arb(0).union(radius).union(-radius)
    h = middle + spread
    point, box = _Orbit.at_rest(r, middle), _Orbit.at_rest(r, h)
    for _ in range(EFFORT.impacts):
        if point is None or box is None:
            return None
        box = box.narrowed(point.y + box.dy * spread, point.w + box.dw * spread)
        if box.y * h > 2 or _passes(box):
            return Side.left
        if not (box.y > 0 and box.w > 0):
            return None
        if _completes(box):
            return Side.complete
        point, box = point.after(), box.after()
    return None


@dataclass(frozen=True)
class _Orbit:
    """A state after an impact, or a ball of states, with the derivative by h along the family of orbits from rest."""

    r: Any
    h: Any
    y: Any
    w: Any
    dy: Any
    dw: Any

    @staticmethod
    def at_rest(r: arb, h: arb) -> "_Orbit | None":
        """After the first impact: T is the smaller root of 12 + 6h - (4 + 4h) T + h T^2."""
        under = 16 - 16 * h - 8 * h * h
        if not under > 0:
            return None
        time = (24 + 12 * h) / (4 + 4 * h + under.sqrt())
        slope = 2 * h * time - 4 - 4 * h  # the negative root of `under`
        rate = -(6 - 4 * time + time * time) / slope
        bend = 2 * time + 2 * h * rate - 4
        w = -r * time * time * slope
        return _Orbit(r, h, time - 1, w, rate, -r * (2 * time * rate * slope + time * time * bend))

    def narrowed(self, y: arb, w: arb) -> "_Orbit":
        """A state with narrower balls for y and w that also hold all states, by the mean value theorem."""
        return replace(self, y=self.y.intersection(y), w=self.w.intersection(w))

    def p(self, time: arb) -> Any:
        """The height over the flight time."""
        return (
            self.w + ((6 * self.h * self.y - 12) * self.y + ((4 * self.h * self.y - 4) + self.h * time) * time) * time
        )

    def slope(self, time: arb) -> Any:
        """p'."""
        return (6 * self.h * self.y - 12) * self.y + (8 * self.h * self.y - 8 + 3 * self.h * time) * time

    def after(self) -> "_Orbit | None":
        """After the next impact; None where its time is not enclosed or p' < 0 is not shown."""
        time = self._time()
        if time is None:
            return None
        h, y, r = self.h, self.y, self.r
        slope = self.slope(time)
        by_y = (12 * h * y - 12 + 4 * h * time) * time
        by_h = (6 * y * y + (4 * y + time) * time) * time
        rate = -(by_y * self.dy + self.dw + by_h) / slope
        bend = (
            (12 * h * y - 12) * self.dy
            + 6 * y * y
            + 8 * (self.dy * h * time + y * time)
            + 3 * time * time
            + (8 * h * y - 8 + 6 * h * time) * rate
        )
        return _Orbit(r, h, y + time, -r * time * slope, self.dy + rate, -r * (rate * slope + time * bend))

    def _time(self) -> Any | None:
        """A ball with the first root of p for all states, by Newton's interval step."""
        at = _first_root(float(self.w.mid()), float(self.h.mid()), float(self.y.mid()))
        if at is None:
            return None
        centre, slope = arb(at), self.slope(arb(at))
        if not slope < 0:
            return None
        value = self.p(centre)
        reach = (value / slope).abs_upper()
        for _ in range(8):
            reach = reach * arb(1.25) + arb(2) ** (8 - BITS)
            trial = centre + arb(0).union(reach).union(-reach)
            steep = self.slope(trial)
            if not steep < 0:
                return None
            time = centre - value / steep
            if trial.contains_interior(time):
                return time if time > 0 else None
            reach = (time - centre).abs_upper()
        return None


def _first_root(w: float, h: float, y: float) -> float | None:
    """The first positive root of p in doubles, by Newton's steps from that of p cut short; None if lost."""
    linear, square = 6 * h * y * y - 12 * y, 4 * h * y - 4
    if square >= 0 <= linear:
        return None
    time = -w / linear if square >= 0 else 2 * w / ((linear * linear - 4 * square * w) ** 0.5 - linear)
    for _ in range(60):
        value = w + (linear + (square + h * time) * time) * time
        slope = linear + (2 * square + 3 * h * time) * time
        if slope >= 0:
            return None
        step = -value / slope
        time += step
        if abs(step) <= 1e-15 * abs(time):
            break
    return time if time > 0 else None


def _passes(box: _Orbit) -> bool:
    """Whether p > 0 up to B: no state of the box hits the wall before."""
    if not box.h > 0:
        return False
    end = (2 / box.h - box.y).abs_upper()
    for n in range(EFFORT.pieces):
        piece = (end * n / EFFORT.pieces).union(end * (n + 1) / EFFORT.pieces)
        if not box.p(piece) > 0:
            return False
    return True


def _completes(box: _Orbit) -> bool:
    """Whether chatter from all states is complete before B, by bounds of |a| on a window that holds all of it.

    In units of h |a| = 12 y (2 - h y), which is concave, so its least value is at an end.  With l <= |a| <= u a flight
    takes 2w/l at the most and lands with w sqrt(u/l) at the most.
    """
    press = 12 * box.y * (2 - box.h * box.y)
    if not press > 0:
        return False
    for wide in EFFORT.wide:
        window = (wide * 2 * box.w / (press * (1 - box.r))).abs_upper()
        last = box.y + window
        at_end = 12 * last * (2 - box.h * last)
        if not (at_end > 0 and last * box.h < 2):
            continue
        least = press.lower().min(at_end.lower())
        most = 12 * last.upper() * (2 - box.h * box.y).upper()
        factor = box.r * (most / least).sqrt()
        if factor < 1 and 2 * box.w / (least * (1 - factor)) < window:
            return True
    return False
