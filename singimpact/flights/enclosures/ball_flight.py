"""A flight in balls followed to its first hit."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from singimpact.flights.enclosures.equation import NoHit, Refused, TooLong
from singimpact.flights.enclosures.first_root import NearGraze, RootAtEnd, first_root
from singimpact.flights.enclosures.tube import Tube, centre, divided

SHORTER = 0.93  # of a step at whose end the root may lie
SHORTEST = 0.05  # of a step: where its sign at the end is still open, the ball of the state is too wide for any step


class Motion(Protocol):
    """A set of states that is carried from step to step."""

    time: Any
    bits: int
    removed: int
    flown: int

    @property
    def launched(self) -> bool: ...
    def tubes(self, most: Any = None) -> tuple[Tube, Tube, Any]: ...
    def advance(self, length: Any) -> None: ...
    def at_hit(self, root: Any, velocity: Any, rate: Any) -> tuple[Any, Any, list[tuple[Any, Any]]]: ...


class BallHit(NamedTuple):
    """Flight time and velocity of the first hit, their derivatives (tau, v, names), and the steps."""

    flight_time: Any
    velocity: Any
    derivatives: list[tuple[Any, Any]]
    steps: int


def first_hit(motion: Motion, horizon: Any, steps: int) -> BallHit:
    """The first hit of every member of a set of states.

    Raises
    ------
    NoHit : proved that none comes before the horizon. Refused : these bits, or so many steps, do not decide it.
    """
    for count in range(1, steps + 1):
        motion.flown = count
        value, slope, length = motion.tubes()
        first = motion.launched
        if first:
            inner = divided(value, slope, motion.removed)
            if not inner[0].polynomial[0] > 0:
                raise Refused("the launch velocity is not shown positive")
        else:
            inner = value, slope
        shorter = length
        while True:
            try:
                root = first_root(*inner, shorter, motion.bits)
                break
            except RootAtEnd:
                shorter = centre(shorter * SHORTER)
                if not shorter > length * SHORTEST:
                    raise Refused("the ball of a state grew too wide to tell the sign of x - c") from None
            except NearGraze as graze:
                after = float((motion.time + graze.at).mid())
                raise Refused(f"x - c and x' both vanish {after:.6g} after the launch, as far as balls tell") from None
        if root is not None:
            rate = inner[1](root)
            velocity = slope(root)
            if first:
                velocity = velocity.intersection(root**motion.removed * rate)
            time, velocity, derivatives = motion.at_hit(root, velocity, rate)
            if time > horizon:
                raise NoHit(f"no hit comes before {float(horizon.mid()):.6g}")
            return BallHit(time, velocity, derivatives, count)
        if motion.time + shorter > horizon:
            raise NoHit(f"no hit comes before {float(horizon.mid()):.6g}")
        motion.advance(shorter)
    raise TooLong(f"no hit comes before {float(motion.time.mid()):.6g}, and {steps} steps in balls do not go further")
