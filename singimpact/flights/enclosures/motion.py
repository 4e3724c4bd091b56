"""A set of flights carried from step to step: as a ball, or as a centre, deviations of its launch and a rotated box.

In a frame (z, z') lies in  m + sum_j C_j D_j + Q b,

m and the columns C_j exact, D_j the deviations of tau, v and numbers of the model, b a box in the frame Q that turns
with the flow (Lohner 1987). A step maps m with all bits; by the mean value theorem the rest is multiplied by the
derivative of the step over the whole set, for which few bits are enough. The radii then grow as the flow itself
stretches, where a ball is wrapped in a larger one at every step: a ball is for points that do not fly for long.

Members of a box are launched at different times. At equal time since the launch the forcing differs between them, at
every step, and its interval adds to that of the steps before. At equal times of the clock it is one number, and the
derivative by the launch time is that of a launch with x less by v and x' less by x'': it obeys the same equation as the
derivative by v, which the forcing does not drive.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from singimpact.algebra.precision import balls_at
from singimpact.flights.enclosures.equation import Equation, Refused
from singimpact.flights.enclosures.taylor_step import Column, Step, step
from singimpact.flights.enclosures.tube import Tube, ball, below, centre, divided, height, narrowed, speed, upper
from singimpact.handed_on import flint
from singimpact.inputs import need

Pair = tuple[Any, Any]


class Start(NamedTuple):
    """A launch.

    tau, v : time and velocity, balls. removed : 1, or the power of t in z from rest, of a point alone: next to a zero
        of a_c are launches of another kind. expected : the flight time in doubles, or 0.
    """

    tau: Any
    v: Any
    removed: int = 1
    expected: float = 0.0


class Met(NamedTuple):
    """A time, x - c and x' then, and the derivatives of both by the launch time, velocity, numbers.

    time : after the launch; of a clocked motion that of the clock.
    inside : whether the time is apart from both ends of its step, so that no zero leaves it between members of a box.
    """

    time: Any
    height: Any
    speed: Any
    columns: list[Pair]
    inside: bool = True


class CarriedMotion:
    """A set of flights from a launch, and the derivatives of its members.

    Parameters
    ----------
    equations : the model with the centres of its numbers, and with the balls. bits : of a step of the centre.
    coarse : bits of the steps of the set, which is then carried in a frame; None: as a ball.
    deviations : name -> ball round 0, of the names of the equation; None for a point without derivatives. Those are by
        tau, v and the names; the one by tau is at equal time since the launch, of a clocked motion of the clock.
    through : whether the flights go on through the wall.
    clocked : whether the set is carried at equal times of the clock; the first step is one of equal times since the
        launch, at whose end the clock is stopped at one time for all. Such a motion has a frame and goes through.
    """

    def __init__(
        self,
        equations: tuple[Equation, Equation],
        start: Start,
        bits: int,
        *,
        coarse: int | None = None,
        deviations: Mapping[str, Any] | None = None,
        through: bool = False,
        clocked: bool = False,
    ) -> None:
        (self.of_centre, self.equation), self.bits, self.coarse = equations, bits, coarse
        self.through, self.clocked = through or clocked, clocked
        tau, v, self.removed, self.expected = start
        self.time, self.flown = flint.arb(0), 0
        self.step: Step | None = None
        self.wide: Step | None = None
        self.tau, self.middle_tau, self.middle = tau, tau, (flint.arb(0), v)
        names = self.equation.names
        self.drives: list[int] = [] if deviations is None else [0, -1, *range(1, len(names) + 1)]
        self.full: list[Pair] = [(flint.arb(0), flint.arb(int(drive == -1))) for drive in self.drives]
        self.D: list[Any] = []
        self.C: list[Pair] = []
        self.turn: Pair = flint.arb(1), flint.arb(0)  # Q = ((a, -b), (b, a))
        self.box: Pair = flint.arb(0), flint.arb(0)
        if coarse is not None:
            self.middle = flint.arb(0), centre(v)
            self.box = flint.arb(0), v - self.middle[1]
        if coarse is not None and deviations is not None:
            self.middle_tau, self.box = centre(tau), (flint.arb(0), flint.arb(0))
            self.D = [tau - self.middle_tau, v - self.middle[1], *(deviations[name] for name in names)]
            self.C = list(self.full)
        if clocked:
            # of the state at the time of the launch, by a later launch
            self.earlier = -v, -self.equation.acceleration(tau, v * 0, v)
            self.apart = upper(tau - self.middle_tau)

    @property
    def launched(self) -> bool:
        """Whether the next step is the first."""
        return bool(self.time == 0)

    @property
    def margin(self) -> Any:
        """Of the first step of a clocked motion, a zero in this last part of it may be seen again in the next one."""
        return 3 * self.apart

    # ---- steps

    def tubes(self, most: Any = None) -> tuple[Tube, Tube, Any]:
        """z and z' of all members on the next step, and its length."""
        removed = self.removed if self.launched else 1
        state = self.middle_tau + self.time, *self.middle
        columns = self._launches() if self.coarse is None else []
        expected = self.expected - float(self.time)
        own = step(self.of_centre, state, columns, self.bits, most, removed, expected, self.step)
        self.wide = own if self.coarse is None else self._of_set(own.length, removed)
        self.step, self.own = own, (height(own.coefficients, own.bound), speed(own.coefficients, own.bound))
        series = zip(self.wide.columns, self.wide.column_bounds, strict=True)
        self.by = [(height(P, K), speed(P, K)) for P, K in series]
        self.members = self.own if self.coarse is None else self._spread()
        return *self.members, self.wide.length

    def _launches(self) -> list[Column]:
        """Derivatives that a step carries: in a frame by its first state and by what drives it, else columns."""
        if self.coarse is None:
            return [Column(pair, drive) for pair, drive in zip(self.full, self.drives, strict=True)]
        one, zero = flint.arb(1), flint.arb(0)
        return [
            Column((one, zero), -1),
            Column((zero, one), -1),
            *(Column((zero, zero), drive) for drive in self.drives if drive >= 0),
        ]

    def _of_set(self, length: Any, removed: int) -> Step:
        """The step of the whole set, with few bits."""
        assert self.coarse is not None
        self.delta = self._deviation()
        z, v = self.middle
        with balls_at(self.coarse + 24):
            hull = self.tau + self.time, z + self.delta[0], v + self.delta[1]
            return step(self.equation, hull, self._launches(), self.coarse, length, removed, last=self.wide)

    def _deviation(self) -> Pair:
        """A box around the set less its centre."""
        (a, b), (p, q) = self.turn, self.box
        z, v = a * p - b * q, b * p + a * q
        for (cz, cv), size in zip(self.C, self.D, strict=True):
            z, v = z + cz * size, v + cv * size
        return z, v

    def _spread(self) -> tuple[Tube, Tube]:
        """z and z' of all members on the step, from those of the centre."""
        value, slope = self.own
        for (psi, rate), size in zip(self.by[:2], self.delta, strict=True):
            value, slope = added(value, psi, size), added(slope, rate, size)
        sizes = [size for size, drive in zip(self.D, self.drives, strict=True) if drive >= 0] if self.D else []
        for (psi, rate), size in zip(self.by[2:], sizes, strict=True):
            value, slope = added(value, psi, size), added(slope, rate, size)
        return value, slope

    def columns_at(self, length: Any) -> list[Pair]:
        """The derivatives of z and z' by tau, v and names, at a time in the step."""
        if self.clocked and self.launched:
            return self._from_launch(length)
        return self._images(self.full, self._responses(length))

    def _responses(self, length: Any) -> list[Pair]:
        """The derivatives that the step has, at a time in it."""
        return [(value(length), slope(length)) for value, slope in self.by]

    def _images(self, columns: list[Pair], responses: list[Pair]) -> list[Pair]:
        """Columns from the beginning of the step to where its derivatives are given; without a frame those are it."""
        if self.coarse is None:
            return responses
        driven = dict(zip([drive for drive in self.drives if drive >= 0], responses[2:], strict=True))
        return [_mapped(responses, pair, driven.get(drive)) for pair, drive in zip(columns, self.drives, strict=True)]

    def _from_launch(self, s: Any) -> list[Pair]:
        """The columns of a clocked motion a time after the launches."""
        (p, p_rate), (q, q_rate) = ((value(s), slope(s)) for value, slope in self.by[:2])
        less, slower = self.earlier
        return [(less * p + slower * q, less * p_rate + slower * q_rate), (q, q_rate)]

    def advance(self, length: Any) -> None:
        """To a time within the step; of a clocked motion's first one, until the last launch has flown so long."""
        if self.clocked and self.launched:
            self._stop_clock(length)
            return
        responses = self._responses(length)
        self.full = self._images(self.full, responses)
        error = self._to(length, self._images(self.C, responses) if self.C else [])
        if self.coarse is not None:
            self._turned(responses, error)
        self.time = self.time + length
        if not self.through and not self.middle[0] + self._deviation()[0] > 0:
            raise Refused("x - c is not shown positive at the end of a step")

    def _stop_clock(self, length: Any) -> None:
        """To the time of the clock at which the last launch has flown so long."""
        base = centre(length - self.apart)
        need(base > 0, Refused("a box of launch times is longer than a step"))
        self.full = self._from_launch(base + ball(self.apart))
        error = self._to(base, self.full)
        self.box, self.drives = (error[0], error[1]), [-1, -1]
        self.time, self.tau = base, self.middle_tau

    def _to(self, length: Any, images: list[Pair]) -> list[Any]:
        """Move the centre and the columns, and return what they do not hold: the errors of both."""
        z, v = (tube(length) for tube in self.own)
        if self.coarse is None:
            self.middle = z, v
            return []
        # what rounding moves of each column goes into the box of errors, the rest stays a point: Lohner's set,
        # x + C D + Q box
        self.C = [(centre(a), centre(b)) for a, b in images]
        self.middle = centre(z), centre(v)
        error = [z - self.middle[0], v - self.middle[1]]
        for (a, b), (p, q), size in zip(images, self.C, self.D, strict=True):
            error = [error[0] + (a - p) * size, error[1] + (b - q) * size]
        return error

    def _turned(self, flow: list[Pair], error: list[Any]) -> None:
        """The box in a new frame, whose first axis is the image of the longer side."""
        (a, b), box = self.turn, self.box
        # the image of a box is a thin parallelogram; a frame along its longer side wraps it closely
        sides = _mapped(flow, (a, b)), _mapped(flow, (-b, a))
        lengths = [
            float(abs(side[0]).mid() + abs(side[1]).mid()) * float(width.rad())
            for side, width in zip(sides, box, strict=True)
        ]
        longer = sides[0] if lengths[0] >= lengths[1] else sides[1]
        p, q = centre(longer[0]), centre(longer[1])
        size = float((p * p + q * q).sqrt().mid())
        need(0 < size < float("inf"), Refused("the frame of the flight is lost"))
        p, q = (type(p)(float((x / size).mid())) for x in (p, q))
        norm = p * p + q * q
        turned = []
        for row in ((p, q), (-q, p)):
            inner = [(row[0] * side[0] + row[1] * side[1]) * width for side, width in zip(sides, box, strict=True)]
            turned.append((inner[0] + inner[1] + row[0] * error[0] + row[1] * error[1]) / norm)
        self.turn, self.box = (p, q), (turned[0], turned[1])

    # ---- states at hits and at times

    def at_hit(self, root: Any, velocity: Any, rate: Any, level: Any = None) -> tuple[Any, Any, list[Pair]]:
        """Time since the launch, velocity, and the derivatives of both in the order tau, v, names, over the set.

        Parameters
        ----------
        root : the time since the step began. velocity : z' there. rate : z' there, or y' on the first step.
        level : z there; None for 0, at the wall of the launch.
        """
        total = self.time + root
        if not self.by:
            return total, velocity, []
        push = self.equation.acceleration(self.tau + total, velocity * 0 if level is None else level, velocity)
        pairs: list[Pair] = []
        for value, slope in self.by:
            if not self.launched or level is not None:
                delay = -value(root) / rate
            elif self.coarse is not None and not pairs:
                delay = root * 0  # the height of a launch does not deviate
            elif self.removed == 1:  # psi/z' = (psi/s)/y', with all its digits as v -> 0
                delay = -divided(value, slope, 1)[0](root) / rate
            else:
                delay = -value(root) / velocity
            pairs.append((delay, slope(root) + push * delay))
        by = self._images(self.full, pairs)
        if self.coarse is None:
            return total, velocity, by
        return *self._by_mean_value(root, velocity, pairs, level), by

    def _by_mean_value(self, root: Any, velocity: Any, pairs: list[Pair], level: Any) -> Pair:
        """Time since the launch and velocity: those of the centre, which hits as every member does, and a deviation."""
        value, slope = self.own
        if level is not None:
            own = narrowed(root, *below(value, slope, level))
            own_velocity = slope(own)
        elif self.launched:
            y, y_slope = divided(value, slope, self.removed)
            own = narrowed(root, y, y_slope)
            own_velocity = own**self.removed * y_slope(own)
        else:
            own = narrowed(root, value, slope)
            own_velocity = slope(own)
        (a, b), (p, q) = self.turn, self.box
        off = [_mapped(pairs, (a * p - b * q, b * p + a * q))]
        images = self._images(self.C, pairs) if self.C else []
        off += [(late * size, fast * size) for (late, fast), size in zip(images, self.D, strict=True)]
        later, faster = (sum((pair[k] for pair in off), root * 0) for k in (0, 1))
        return self.time + root.intersection(own + later), velocity.intersection(own_velocity + faster)

    def met(self, s: Any) -> Met:
        """The set at a time s after the step began, which may be a ball."""
        z, v = (tube(s) for tube in self.members)
        columns = self.columns_at(s)
        if not self.clocked:
            return Met(self.time + s, z, v, columns)
        if not self.launched:
            # by the mean value theorem each member is the centre and its columns times what it deviates
            near = [
                tube(s) + sum((column[k] * size for column, size in zip(columns, self.D, strict=True)), s * 0)
                for k, tube in enumerate(self.own)
            ]
            z, v = z.intersection(near[0]), v.intersection(near[1])
        return Met(self.tau + self.time + s, z, v, columns)

    def at(self, time: Any) -> Met:
        """The set at a time after the launch, which may be a ball.

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
            need(stop > 0, Refused("the time is not within a step"))
            self.advance(centre(stop))

    def hit(self, s: Any, length: Any) -> Met:
        """A clocked set at the zeros of its members within a ball of times, where each has exactly one: narrower."""
        here = self.met(s)
        wider = centre(s) + ball(s.rad() * 2 + length * 2.0 ** -(self.bits - 4))
        if self.launched or not (here.speed < 0 and wider > 0 and wider < length):
            return here
        value, slope = self.members
        if not (slope(wider) < 0 and value(centre(wider.lower())) > 0 and value(centre(wider.upper())) < 0):
            return here
        own, over = narrowed(wider, *self.own), self.met(wider)
        if not over.speed < 0:
            return here
        push = self.equation.acceleration(over.time, s * 0, over.speed)
        time, fast = own, self.own[1](own)
        for (by_height, by_speed), size in zip(over.columns, self.D, strict=True):
            late = -by_height / over.speed
            time, fast = time + late * size, fast + (by_speed + push * late) * size
        near = self.met(s.intersection(time))
        return near._replace(speed=near.speed.intersection(fast), inside=True)


def added(tube: Tube, column: Tube, size: Any) -> Tube:
    """A tube with a column times a deviation."""
    if size == 0:
        return tube
    largest = upper(size)
    return Tube(
        tube.polynomial + column.polynomial * size, (*tube.errors, *((largest * e, k) for e, k in column.errors))
    )


def _mapped(flow: list[Pair], pair: Pair, driven: Pair | None = None) -> Pair:
    """The image of a pair by the derivative of the flow, with what drives it."""
    image = [flow[0][k] * pair[0] + flow[1][k] * pair[1] for k in (0, 1)]
    return (image[0], image[1]) if driven is None else (image[0] + driven[0], image[1] + driven[1])
