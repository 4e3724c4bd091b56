"""The derivative of the impact map over a ball of states, and of a motion that touches the wall.

A ball of launches round a centre is flown with the centre: at the end of a step the distance of x from that of the
centre is at most the distance of the launches times a bound of the derivatives by them, by the mean value theorem.
"""

from collections.abc import Sequence
from typing import Any

from flint import arb

from .formulas import Dual, Refused, need
from .motion import Flight, Model, ends, first_root, landed, tiny


class Beside(Flight):
    """The motion of a ball of launches, with that of a centre, which is flown at the same times after the launch."""

    def __init__(self, model: Model, launch: tuple[Any, Any], bits: int, columns: int, centre: tuple[Any, Any]) -> None:
        super().__init__(model, *launch, bits, columns)
        self.centre, self.v, self.push = Flight(model, *centre, bits), launch[1], model.push(*launch)
        self.off = [ball_ - point for ball_, point in zip(launch, centre, strict=True)]

    def step(self) -> Any:
        """The polynomials of both on the next step, and its length."""
        return min(super().step(), self.centre.step(), key=float)

    def move(self, s: Any) -> None:
        """To a time of the step, x and x' narrowed by the mean value theorem."""
        super().move(s)
        self.centre.move(s)
        x, speed = self.x, self.speed
        bend = self.model.push(self.tau + self.passed, speed[0], x[0])
        narrowed = []
        for component, rate, own in ((x, speed[0], self.centre.x[0]), (speed, bend, self.centre.speed[0])):
            # a later launch is, at its own time, later along the motion, and less by v and by x'' at the start
            by_tau = rate - self.v * component[1] - self.push * component[2]
            narrowed.append(component[0].intersection(own + by_tau * self.off[0] + component[2] * self.off[1]))
        x[0], speed[0] = narrowed


def by_launch(model: Model, tau: Any, v: Any, columns: Sequence[tuple[Any, Any]]) -> list[tuple[Any, Any]]:
    """The derivatives of x and x' by tau, v and a number, from those by x, x' at the launch and the number."""
    (p, p_dot), (q, q_dot), *rest = columns
    start = model.push(tau, v)
    # a later launch is, at its time, a launch with x less by v and x' less by x''
    return [(-v * p - start * q, -v * p_dot - start * q_dot), (q, q_dot), *rest]


def impact(model: Model, tau: Any, v: Any, bits: int, centre: tuple[Any, Any] | None = None) -> list[list[Any]]:
    """The derivative of the impact map over a ball of states: rows of the next tau and v, columns of tau, v, number."""
    carried = 3 if model.over else 2
    motion = Flight(model, tau, v, bits, carried) if centre is None else Beside(model, (tau, v), bits, carried, centre)
    time, speed, columns = motion.first_hit()
    there, side = landed(model, motion)
    rebound = there.rebound(Dual(speed * side, [side, 0]), **there.moved(0, 1))
    end = model.push(tau + time, speed, model.c() + model.gap if motion.across else None)
    late = [-x / speed for x, _ in by_launch(model, tau, v, columns)]
    faster = [w + end * shift for (_, w), shift in zip(by_launch(model, tau, v, columns), late, strict=True)]
    after = [rebound.slopes[0] * shift for shift in faster]
    return [late, [*after[:2], *(shift + rebound.slopes[1] for shift in after[2:])]]


def touching(model: Model, launch: tuple[Any, Any], time: Any, bits: int, columns: int) -> list[tuple[Any, Any]]:
    """x - c, x' and the derivatives of x, x' at a time before which x > c is shown, if x - c = x' = 0 then.

    Up to a last piece x > c; on it x'' > 0.
    """
    motion = Flight(model, *launch, bits, columns)
    while True:
        h, left = motion.step(), time - motion.passed
        if not left.upper() <= h:
            h = arb(min(h, left * arb(0.8), key=float).mid())
            U, h = motion.root(h)
            need("before", U is None, "the motion meets the wall before it touches it", Refused)
            motion.advance(h)
            continue
        for k in range(1, 30):
            last = arb((left * (1 - arb(2) ** -k)).mid())
            x, speed = ends(motion.X, motion.K, last.union(left))
            if model.push(launch[0] + motion.passed + last.union(left), speed[0], x[0]) > 0:
                root = first_root(motion.y, motion.slope, last, tiny(last, bits)) if last > 0 else None
                need("just before", root is None, "the motion meets the wall before it touches it", Refused)
                x, speed = ends(motion.X, motion.K, left)
                return [(x[0] - motion.c, speed[0]), *zip(x[1:], speed[1:], strict=True)]
        raise Refused("that the mass is driven off the wall where it touches it is not shown")
