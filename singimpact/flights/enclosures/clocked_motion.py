"""A box of flights that the wall does not stop, carried at equal times of the clock and not since the launch.

Members of a box are launched at different times. At equal time since the launch the forcing differs between them, at
every step, and its interval adds to that of the steps before. At equal times of the clock it is one number, and the
derivative by the launch time is that of a launch with x less by v and x' less by x'': it obeys the same equation as the
derivative by v, which the forcing does not drive.
"""

from __future__ import annotations

from typing import Any

from singimpact.flights.enclosures.equation import Equation, Refused
from singimpact.flights.enclosures.first_root import narrowed
from singimpact.flights.enclosures.framed_motion import FramedMotion, Pair
from singimpact.flights.enclosures.free_motion import Met
from singimpact.flights.enclosures.tube import ball, centre, upper


class ClockedMotion(FramedMotion):
    """A box of launches (tau, v), each a ball; the derivatives are those by tau and by v at equal times of the clock.

    The first step is one of equal times since the launch. At its end the clock is stopped at one time for all.
    """

    def __init__(self, equation: Equation, tau: Any, v: Any, bits: int) -> None:
        super().__init__((equation, equation), tau, v, bits, bits, {})
        zero = v * 0
        push = equation.run("forcing", t=tau)[0] - equation.run("force", x=zero, xdot=v)[0]
        self.earlier = -v, -push  # of the state at the time of the launch, by a later launch
        self.apart = upper(tau - self.middle_tau)

    @property
    def margin(self) -> Any:
        """Of the first step, a zero in this last part of it may be seen again in the next one."""
        return 3 * self.apart

    def require_above(self) -> None:
        """Flights may be below the wall."""

    def advance(self, length: Any) -> None:
        """To a time within the step; of the first step, to the time at which the last launch has flown so long."""
        if not self.launched:
            super().advance(length)
            return
        base = centre(length - self.apart)
        if not base > 0:
            raise Refused("a box of launch times is longer than a step")
        self.full = self._from_launch(base + ball(self.apart))
        self.C = [(centre(a), centre(b)) for a, b in self.full]
        z, v = (part(base) for part in self.own)
        self.middle = centre(z), centre(v)
        error = [z - self.middle[0], v - self.middle[1]]
        for (a, b), (p, q), size in zip(self.full, self.C, self.D, strict=True):
            error = [error[0] + (a - p) * size, error[1] + (b - q) * size]
        self.box, self.drives = (error[0], error[1]), [-1, -1]
        self.time, self.tau = base, self.middle_tau

    def _from_launch(self, s: Any) -> list[Pair]:
        """The columns a time after the launches."""
        (p, p_rate), (q, q_rate) = ((value(s), slope(s)) for value, slope in self.by_state)
        less, slower = self.earlier
        return [(less * p + slower * q, less * p_rate + slower * q_rate), (q, q_rate)]

    def met(self, s: Any) -> Met:
        """The box at a time s after the step began, which may be a ball; its time is that of the clock."""
        assert self.members is not None
        height, speed = (part(s) for part in self.members)
        if self.launched:
            return Met(self.tau + s, height, speed, self._from_launch(s))
        columns = self.columns_at(s)
        # by the mean value theorem each member is the centre and its columns times what it deviates
        near = [part(s) + sum((column[k] * size for column, size in zip(columns, self.D, strict=True)), s * 0)
                for k, part in enumerate(self.own)]  # fmt: skip
        return Met(self.tau + self.time + s, height.intersection(near[0]), speed.intersection(near[1]), columns)

    def hit(self, s: Any, length: Any) -> Met:
        """The same at the zeros of the members within a ball of times; narrower where each has exactly one there."""
        found = self.met(s)
        wider = centre(s) + ball(s.rad() * 2 + length * 2.0 ** -(self.bits - 4))
        if self.launched or not (found.speed < 0 and wider > 0 and wider < length):
            return found
        assert self.members is not None
        value, slope = self.members
        if not (slope(wider) < 0 and value(centre(wider.lower())) > 0 and value(centre(wider.upper())) < 0):
            return found
        own, over = narrowed(wider, *self.own), self.met(wider)
        if not over.speed < 0:
            return found
        push = self.equation.run("forcing", t=over.time)[0] - self.equation.run("force", x=s * 0, xdot=over.speed)[0]
        time, speed = own, self.own[1](own)
        for (by_height, by_speed), size in zip(over.columns, self.D, strict=True):
            late = -by_height / over.speed
            time, speed = time + late * size, speed + (by_speed + push * late) * size
        near = self.met(s.intersection(time))
        return near._replace(speed=near.speed.intersection(speed), inside=True)
