"""A flight carried as a centre, deviations of its launch and a rotated box: of long flights and of boxes.

    (z, z') lies in  m + sum_j C_j D_j + Q b,

m and the columns C_j exact, D_j the deviations of tau, v and numbers of the model, b a box in the frame Q that turns
with the flow. A step maps m with all bits; by the mean value theorem the rest is multiplied by the derivative of the
step over the whole set, for which few bits are enough. The radii then grow as the flow itself stretches, where a
ball would be wrapped in a larger one at every step.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from singimpact.algebra.precision import balls_at
from singimpact.flights.enclosures.equation import Equation, Refused
from singimpact.flights.enclosures.first_root import narrowed
from singimpact.flights.enclosures.taylor_step import Column, Step, step
from singimpact.flights.enclosures.tube import Tube, centre, divided, height, speed, upper

Pair = tuple[Any, Any]


class FramedMotion:
    """A set of states, by its centre and what it deviates.

    Parameters
    ----------
    equations : the model with the centres of its numbers, and with the balls.
    tau, v : the launch, balls. bits : of the centre's steps. coarse : of the steps of the set.
    deviations : name -> ball round 0, of the names of the equation; None for a point without derivatives. removed : 1,
        or the power of t in z from rest, of a point alone: next to a zero of a_c are launches of another kind.
    """

    def __init__(
        self, equations: tuple[Equation, Equation], tau: Any, v: Any, bits: int, coarse: int,
        deviations: Mapping[str, Any] | None, removed: int = 1,
    ) -> None:  # fmt: skip
        from flint import arb

        (self.of_centre, self.equation), self.bits, self.coarse = equations, bits, coarse
        self.step: Step | None = None
        self.wide: Step | None = None
        self.members: tuple[Tube, Tube] | None = None  # z and z' of all members on the step
        self.removed, self.time, self.flown = removed, arb(0), 0
        self.tau, self.middle_tau = tau, tau
        self.middle: Pair = arb(0), centre(v)
        self.drives: list[int] = []
        self.D: list[Any] = []
        self.turn: Pair = arb(1), arb(0)  # Q = ((a, -b), (b, a))
        self.box: Pair = arb(0), v - self.middle[1]
        if deviations is not None:
            self.middle_tau, self.box = centre(tau), (arb(0), arb(0))
            names = self.equation.names
            self.drives = [0, -1, *range(1, len(names) + 1)]
            self.D = [tau - self.middle_tau, v - self.middle[1], *(deviations[name] for name in names)]
        self.full: list[Pair] = [(arb(0), arb(int(drive == -1))) for drive in self.drives]
        self.C: list[Pair] = list(self.full)

    @property
    def launched(self) -> bool:
        """Whether the next step is the first."""
        return bool(self.time == 0)

    def _deviation(self) -> Pair:
        """A box around the set less its centre."""
        (a, b), (p, q) = self.turn, self.box
        z, v = a * p - b * q, b * p + a * q
        for (cz, cv), size in zip(self.C, self.D, strict=True):
            z, v = z + cz * size, v + cv * size
        return z, v

    def tubes(self, most: Any = None) -> tuple[Tube, Tube, Any]:
        """z and z' of all members on the next step, and its length."""
        from flint import arb

        removed = self.removed if self.launched else 1
        z, v = self.middle
        own = step(self.of_centre, (self.middle_tau + self.time, z, v), (), self.bits, most, removed, last=self.step)
        self.delta = self._deviation()
        one, zero = arb(1), arb(0)
        launches = [Column((one, zero), -1), Column((zero, one), -1)]
        launches += [Column((zero, zero), drive) for drive in self.drives if drive >= 0]
        with balls_at(self.coarse + 24):
            hull = self.tau + self.time, z + self.delta[0], v + self.delta[1]
            wide = step(self.equation, hull, launches, self.coarse, own.length, removed, last=self.wide)
        self.step, self.wide = own, wide
        columns = [(height(P, K), speed(P, K)) for P, K in zip(wide.columns, wide.column_bounds, strict=True)]
        self.by_state, self.by_drive = columns[:2], columns[2:]
        self.own = height(own.coefficients, own.bound), speed(own.coefficients, own.bound)
        value, slope = self._spread()
        self.members = value, slope
        return value, slope, wide.length

    def _spread(self) -> tuple[Tube, Tube]:
        """z and z' of all members on the step, from those of the centre."""
        value, slope = self.own
        for (psi, rate), size in zip(self.by_state, self.delta, strict=True):
            value, slope = added(value, psi, size), added(slope, rate, size)
        sizes = [size for size, drive in zip(self.D, self.drives, strict=True) if drive >= 0]
        for (psi, rate), size in zip(self.by_drive, sizes, strict=True):
            value, slope = added(value, psi, size), added(slope, rate, size)
        return value, slope

    def columns_at(self, length: Any) -> list[Pair]:
        """The derivatives of z and z' by tau (at equal time since the launch), v and names, at a time in the step."""
        flow, driven = self._responses(length)
        return [self._mapped(flow, each, driven.get(drive)) for each, drive in zip(self.full, self.drives, strict=True)]

    def _responses(self, length: Any) -> tuple[list[list[Any]], dict[int, Pair]]:
        """The derivatives by the state at the beginning of the step, and by what drives it."""
        flow = [[part(length) for part in column] for column in self.by_state]  # flow[j] = column j
        driven = {drive: (value(length), slope(length)) for drive, (value, slope) in zip(
            [drive for drive in self.drives if drive >= 0], self.by_drive, strict=True)}  # fmt: skip
        return flow, driven

    def advance(self, length: Any) -> None:
        """To a time within the step."""
        flow, driven = self._responses(length)
        self.full = [self._mapped(flow, each, driven.get(drive)) for each, drive in zip(
            self.full, self.drives, strict=True)]  # fmt: skip
        # the part of each column that rounding moves goes into the box of errors, the rest stays a point: Lohner's set,
        # x + C D + Q box
        images = [self._mapped(flow, each, driven.get(drive)) for each, drive in zip(self.C, self.drives, strict=True)]
        self.C = [(centre(a), centre(b)) for a, b in images]
        z, v = (part(length) for part in self.own)
        self.middle = centre(z), centre(v)
        error = [z - self.middle[0], v - self.middle[1]]
        for (a, b), (p, q), size in zip(images, self.C, self.D, strict=True):
            error = [error[0] + (a - p) * size, error[1] + (b - q) * size]
        self._turned(flow, error)
        self.time = self.time + length
        self.require_above()

    def require_above(self) -> None:
        """Refuse a set that may be on the wall at the end of a step."""
        if not self.middle[0] + self._deviation()[0] > 0:
            raise Refused("x - c is not shown positive at the end of a step")

    @staticmethod
    def _mapped(flow: list[list[Any]], pair: Pair, driven: Pair | None) -> Pair:
        image = [flow[0][k] * pair[0] + flow[1][k] * pair[1] for k in (0, 1)]
        return (image[0], image[1]) if driven is None else (image[0] + driven[0], image[1] + driven[1])

    def _turned(self, flow: list[list[Any]], error: list[Any]) -> None:
        """The box in a new frame, whose first axis is the image of the longer side."""
        (a, b), box = self.turn, self.box
        # Lohner (1987): the image of a box is a thin parallelogram; a frame along its longer side wraps it closely
        sides = self._mapped(flow, (a, b), None), self._mapped(flow, (-b, a), None)
        lengths = [float(abs(side[0]).mid() + abs(side[1]).mid()) * float(part.rad())
                   for side, part in zip(sides, box, strict=True)]  # fmt: skip
        longer = sides[0] if lengths[0] >= lengths[1] else sides[1]
        p, q = centre(longer[0]), centre(longer[1])
        size = float((p * p + q * q).sqrt().mid())
        if not 0 < size < float("inf"):
            raise Refused("the frame of the flight is lost")
        p, q = (type(p)(float((part / size).mid())) for part in (p, q))
        norm = p * p + q * q
        parts = []
        for row in ((p, q), (-q, p)):
            inner = [(row[0] * side[0] + row[1] * side[1]) * part for side, part in zip(sides, box, strict=True)]
            parts.append((inner[0] + inner[1] + row[0] * error[0] + row[1] * error[1]) / norm)
        self.turn, self.box = (p, q), (parts[0], parts[1])

    def at_hit(self, root: Any, velocity: Any, rate: Any) -> tuple[Any, Any, list[Pair]]:
        """Time since the launch, velocity, and the derivatives of both in the order tau, v, names, over the set."""
        total = self.time + root
        f, g = self.equation.run("force", x=velocity * 0, xdot=velocity)[0], self.equation.run(
            "forcing", t=self.tau + total)[0]  # fmt: skip
        pairs: list[Pair] = []
        for value, slope in (*self.by_state, *self.by_drive):
            if not self.launched:
                delay = -value(root) / rate
            elif not pairs:
                delay = root * 0  # the height of a launch does not deviate
            elif self.removed == 1:  # psi/z' = (psi/s)/y', with all its digits as v -> 0
                delay = -divided(value, slope, 1)[0](root) / rate
            else:
                delay = -value(root) / velocity
            pairs.append((delay, slope(root) + (g - f) * delay))
        by_state, by_drive = pairs[:2], dict(zip([d for d in self.drives if d >= 0], pairs[2:], strict=True))
        by = [self._hit_by(by_state, each, by_drive.get(d)) for each, d in zip(self.full, self.drives, strict=True)]
        return *self._by_mean_value(root, velocity, by_state, by_drive), by

    @staticmethod
    def _hit_by(by_state: list[Pair], pair: Pair, driven: Pair | None) -> Pair:
        delay, change = (by_state[0][k] * pair[0] + by_state[1][k] * pair[1] for k in (0, 1))
        return (delay, change) if driven is None else (delay + driven[0], change + driven[1])

    def _by_mean_value(self, root: Any, velocity: Any, by_state: list[Pair], by_drive: Any) -> Pair:
        """Time since the launch and velocity: those of the centre, which hits as every member does, and a deviation."""
        value, slope = self.own
        if self.launched:
            y, y_slope = divided(value, slope, self.removed)
            own = narrowed(root, y, y_slope)
            own_velocity = own**self.removed * y_slope(own)
        else:
            own = narrowed(root, value, slope)
            own_velocity = slope(own)
        (a, b), (p, q) = self.turn, self.box
        off = [self._hit_by(by_state, (a * p - b * q, b * p + a * q), None)]
        off += [tuple(part * size for part in self._hit_by(by_state, each, by_drive.get(d)))
                for each, d, size in zip(self.C, self.drives, self.D, strict=True)]  # fmt: skip
        later, faster = sum((each[0] for each in off), root * 0), sum((each[1] for each in off), root * 0)
        return self.time + root.intersection(own + later), velocity.intersection(own_velocity + faster)


def added(tube: Tube, column: Tube, size: Any) -> Tube:
    """A tube with a column times a deviation."""
    if size == 0:
        return tube
    largest = upper(size)
    return Tube(tube.polynomial + column.polynomial * size,
                (*tube.errors, *((largest * e, k) for e, k in column.errors)))  # fmt: skip
