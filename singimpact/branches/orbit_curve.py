"""A curve of periodic orbits, followed in both directions over one number of a model or two."""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.closing import Closing
from singimpact.branches.continuation import Curve, Point
from singimpact.branches.solutions import AnyClosing


@dataclass(frozen=True)
class BranchSettings:
    """Step sizes and tolerances of a branch, and of a curve of events."""

    # largest step, as a part of the width of the interval, of a period and of the largest velocity
    step: float = 0.02
    # half width of the default interval, as a part of the parameter, or of 1 if it is 0
    around: float = 0.5
    # flight time, in periods, below which two impacts have met
    shortest: float = 1e-9
    # height above the wall that is a rounding error
    touching: float = 1e-12
    # the same at a located event
    located: float = 1e-9
    # distance of a multiplier from the unit circle that may be a rounding error
    neutral: float = 1e-9
    # events of a step that are nearer to each other, of its length, have no point between them
    together: float = 1e-7
    # steps after which a curve may have come back to its start
    before_closing: int = 9


SETTINGS = BranchSettings()


class Step(NamedTuple):
    """A step of the curve: the point before it, its length, the point after it, and whether an interval ends there."""

    here: Point
    length: float
    after: Point
    is_last: bool


class OrbitCurve(ABC):
    """Orbits along a curve; the last unknowns are the numbers, each of which stays in its interval.

    Parameters
    ----------
    closing : of the orbits. ends : of the interval of each number. step : the largest one.
    most : points in each direction. `notes` says how the curve ends.
    """

    def __init__(self, closing: AnyClosing, ends: Sequence[tuple[float, float]], step: float, most: int) -> None:
        self.closing, self.ends, self.step, self.most = closing, ends, step, most
        self.scales, self.notes = np.zeros(0), list[str]()

    # ---- what a curve is

    @abstractmethod
    def conditions(self, point: Array) -> tuple[Array, Array]:
        """The equations of the curve where every flight has a length, and their derivatives."""

    @abstractmethod
    def row(self, point: Point) -> Any:
        """A point of the curve with what is computed of it."""

    @abstractmethod
    def side(self, curve: Curve, start: Point, sign: float) -> list[Any]:
        """The rows in one direction, those of events among them."""

    # ---- how it is followed

    def equations(self, point: Array) -> tuple[Array, Array]:
        """The equations of the curve; nan where a flight has collapsed."""
        if not self.is_sound(point):
            return np.full(len(point) - 1, np.nan), np.full((len(point) - 1, len(point)), np.nan)
        return self.conditions(point)

    def is_sound(self, point: Array) -> bool:
        """Whether no flight has shrunk to nothing, and the walls are apart."""
        if not isinstance(self.closing, Closing) or not self.closing.has_room(point):
            return not isinstance(self.closing, Closing)
        period = self.closing.period(point)
        return not any(flight[3] < SETTINGS.shortest * period for flight in self.closing.flights(point))

    def scaled(self, guess: Array) -> None:
        """Compute the scales of the unknowns: those of the numbers are the lengths of their intervals."""
        self.scales = self.closing.scales(guess)
        self.scales[-len(self.ends) :] = [high - low for low, high in self.ends]

    def begin(self, guess: Array) -> Point | None:
        """The point of the curve next to a guess, from which the first number increases."""
        upwards = np.zeros(len(guess))
        upwards[-len(self.ends)] = self.scales[-len(self.ends)]
        return self._curve().begin(guess, upwards)

    def _curve(self) -> Curve:
        n = self.closing.n
        return Curve(self.equations, self.scales, self.step, slice(n, 2 * n) if n else slice(0, 2))

    def both_sides(self, start: Point) -> list[Any]:
        """The rows in both directions from a start, in the order of the curve."""
        rows = [self.row(start)]
        for sign in (-1.0, 1.0):
            side = self.side(self._curve(), Point(start.at, sign * start.tangent), sign)
            rows = side[::-1] + rows if sign < 0 else rows + side
            if self.notes and self.notes[-1].startswith("closed"):
                break
        return rows

    def walked(self, curve: Curve, start: Point) -> Iterator[tuple[Point, float, Point]]:
        """Steps in one direction."""
        return curve.walk(start, self.most)

    def steps(self, curve: Curve, start: Point) -> Iterator[Step]:
        """The steps in one direction, the last of which ends where an interval does."""
        last = start
        for index, (here, length, after) in enumerate(self.walked(curve, start)):
            crossed = self._outside(after.at)
            if crossed is not None:
                end = self._end(curve, here, length, after)
                if end is not None:
                    yield Step(here, *end, True)
                which, goal = crossed
                interval = "the end of its interval" if len(self.ends) > 1 else "the end of the interval"
                if end is None and len(self.ends) == 1:
                    goal, interval = here.at[-1], "next to the end of the interval"
                self.notes.append(f"ends at {self.closing.over[which]} = {goal:.12g}, {interval}")
                return
            yield Step(here, length, after, False)
            last = after
            if index > SETTINGS.before_closing and self._again(curve, start, here, after):
                noun = "branch" if len(self.ends) == 1 else "curve"
                self.notes.append(f"closed: the {noun} comes back to where it began")
                return
        numbers = ", ".join(f"{value:.12g}" for value in last.at[-len(self.ends) :])
        where = f"{self.closing.over[0]} = {numbers}" if len(self.ends) == 1 else f"({numbers})"
        self.notes.append(f"at {where}: {self._collapsed(last) or curve.note}")

    def _collapsed(self, last: Point) -> str:
        """Why flights have no value just beyond the last point of a branch."""
        if not isinstance(self.closing, Closing) or len(self.ends) > 1:
            return ""
        shortest = min(flight[3] for flight in self.closing.flights(last.at))
        return "two impacts meet: a flight shrinks to nothing" if shortest < 1e-3 * self.closing.period(last.at) else ""

    def _outside(self, at: Array) -> tuple[int, float] | None:
        """A number that is outside its interval, and the end beyond which it is."""
        for which, (low, high) in enumerate(self.ends):
            value = float(at[len(at) - len(self.ends) + which])
            if not low <= value <= high:
                return which, low if value < low else high
        return None

    def _end(self, curve: Curve, here: Point, length: float, after: Point) -> tuple[float, Point] | None:
        """The length of a step, and its point, at which a number is at the end of its interval."""
        which, goal = self._outside(after.at) or (0, 0.0)
        index = len(here.at) - len(self.ends) + which
        ends = float(here.at[index] - goal), float(after.at[index] - goal)
        if ends[0] == 0:
            return None
        crossed = curve.located(here, length, lambda point: float(point.at[index] - goal), ends)
        if crossed is not None and len(self.ends) == 1:  # another branch that begins there has the same double
            crossed[1].at[index] = goal
        return crossed

    def _again(self, curve: Curve, start: Point, here: Point, after: Point) -> bool:
        """Whether a step passes the start, perhaps some periods later."""
        gap, n = (start.at - here.at) / curve.scales, self.closing.n
        if isinstance(self.closing, Closing) and self.closing.clocked:
            period = self.closing.period(after.at) / curve.scales[0]
            gap[:n] -= period * np.rint(gap[0] / period)
        return curve.passes(start, here, after, gap)


def places(listed: Sequence[bool]) -> list[int]:
    """The index of each row among the listed ones; of one that is not listed that of the row before it.

    Examples
    --------
    >>> places([True, False, True, False])
    [0, 0, 1, 1]
    """
    return [int(index) for index in np.cumsum(listed) - 1]
