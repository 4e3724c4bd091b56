"""A box of flights that the wall does not stop: where they are at a time, and their derivatives there."""

from __future__ import annotations

from typing import Any, NamedTuple

from singimpact.flights.enclosures.equation import Refused
from singimpact.flights.enclosures.framed_motion import FramedMotion, Pair
from singimpact.flights.enclosures.tube import centre


class Met(NamedTuple):
    """A time after the launch, x - c and x' then, and the derivatives of both by the launch time, velocity, numbers.

    inside : whether the time is apart from both ends of its step, so that no zero leaves it between members of a box.
    """

    time: Any
    height: Any
    speed: Any
    columns: list[Pair]
    inside: bool = True


class FreeMotion(FramedMotion):
    """A box of flights that goes on through the wall."""

    def require_above(self) -> None:
        """Flights may be below the wall."""

    def met(self, s: Any) -> Met:
        """The box at a time s after the step began, which may be a ball."""
        assert self.members is not None
        height, speed = (part(s) for part in self.members)
        return Met(self.time + s, height, speed, self.columns_at(s))

    def at(self, time: Any) -> Met:
        """The box at a time, which may be a ball.

        Raises
        ------
        Refused : no step contains all of the ball.
        """
        first, last = time.lower(), time.upper()
        while True:
            length = self.tubes()[2]
            if length >= last - self.time:
                return self.met(time - self.time)
            left = first - self.time
            stop = length if length <= left else left
            if not stop > 0:
                raise Refused("the time is not within a step")
            self.advance(centre(stop))
