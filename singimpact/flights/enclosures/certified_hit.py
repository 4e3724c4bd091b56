"""First hits enclosed to `digits` digits: the precision of the balls grows until their radii are small enough.

`first_hit` follows a flight in balls of one precision to its hit, `certified_hit` raises the precision.
"""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil, floor, log2
from typing import Any, NamedTuple, Protocol

from singimpact.algebra.balls import BITS_A_DIGIT, Balls
from singimpact.algebra.expressions import Expression, evaluate, names_in, subtract
from singimpact.algebra.precision import Ladder, balls_at, series_of_any_length
from singimpact.flights.enclosures.equation import (
    Equation,
    NoHit,
    NotAnalytic,
    Refused,
    TooLong,
    equation_of,
    programs_of,
)
from singimpact.flights.enclosures.motion import CarriedMotion, Start
from singimpact.flights.enclosures.tube import NearGraze, RootAtEnd, Tube, below, centre, divided, first_root
from singimpact.handed_on import flint
from singimpact.inputs import need
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import period_over

# Factor of a step at whose end the root may lie
SHORTER = 0.93
# Of a step: where the sign at its end is still open, the ball of the state is too wide for any step
SHORTEST = 0.05


@dataclass(frozen=True)
class EnclosureSettings:
    """Settings of the growth of the precision.

    Parameters
    ----------
    spare : bits of a step beside the digits, at first. guard : bits of the working precision beside those of a step.
    more, most : where a flight is refused, so many times the bits are tried next; and at most, with `room` beside.
    coarse : bits of the steps of a set, the derivative over which needs no more; they grow with a refusal.
    long : steps from which a point is carried in a frame, where its ball has grown.
    singular : how often more bits are tried next to a singularity, which a flight may pass or meet.
    lost, wrapped : bits that the ball of a point loses in a unit of time; flights longer than `wrapped` are carried in
        a frame from the start, whose steps take twice the time.
    steps, idle_steps : of a flight at most; and of one that doubles do not bring back.
    """

    spare: int = 8
    guard: int = 24
    more: float = 1.5
    most: int = 4
    room: int = 64
    coarse: int = 64
    long: int = 16
    lost: float = 1.2
    wrapped: float = 20.0
    singular: int = 1
    steps: int = 6000
    idle_steps: int = 500


ENCLOSURE = EnclosureSettings()


@dataclass(frozen=True)
class Launch:
    """A state, or a box of states and of numbers of the model.

    Parameters
    ----------
    tau, v : exact centres. removed : 1; from rest, the power of t in x - c.
    radii : of "tau", "v", parameters, "clearance", "restitution"; what is not named is a point.
    """

    tau: Expression
    v: Expression
    removed: int = 1
    radii: Mapping[str, Fraction] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """The numbers of the model that have a radius."""
        return tuple(name for name in self.radii if name not in ("tau", "v"))


class ProvedImpact(NamedTuple):
    """Balls of the flight time, of x' at the hit, of the next state, and D G with a column for each name after v."""

    flight_time: Any
    velocity: Any
    tau: Any
    v: Any
    derivative: list[list[Any]]
    steps: int
    bits: int


def certified_hit(
    osc: Oscillator,
    launch: Launch,
    digits: int,
    horizon: Fraction,
    *,
    derivative: bool = False,
    steps: int = ENCLOSURE.steps,
    expected: tuple[float, float] = (0.0, 1.0),
) -> ProvedImpact:
    """The first impact of a flight in balls, with so many digits where the launch is a point.

    Parameters
    ----------
    derivative : whether D G is enclosed too. steps : of a flight at most.
    expected : flight time and condition number that doubles know: they choose the first precision, and prove nothing.

    Raises
    ------
    NoHit : proved that none comes before the horizon. NotAnalytic : f or g is singular where the flight goes.
    Refused : the exact graze, or too many steps; each with its reason.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> osc = Oscillator("x + sin(x)/2", "cos(1.7*t)", "0.3", "0.6")
    >>> hit = certified_hit(osc, Launch(constant("tau", "1.4"), constant("v", "0.6")), 30, Fraction(60))
    >>> print(hit.flight_time.str(30, radius=False))
    0.812373962444622784781243163410
    """
    wanted = ceil(digits * BITS_A_DIGIT)
    least, coarse = wanted + ENCLOSURE.spare, ENCLOSURE.coarse
    most = ENCLOSURE.most * least + ENCLOSURE.room
    first = min(least + _spare(*expected), most)
    box = framed = any(launch.radii.values())
    if box:
        # digits beyond the width of a box are lost in it: derivatives over the box carry no more
        coarse = bits_of_a_set(launch, first)
    framed = framed or expected[0] > ENCLOSURE.wrapped
    singular, flown, ladder = 0, 0, Ladder(first, most)
    for bits in ladder:
        # a ball carried for so many steps has grown by the wrapping effect (Moore 1966), which a frame avoids
        framed = framed or flown > ENCLOSURE.long
        if derivative and not box:
            coarse = bits
        begun = None
        try:
            with working_at(bits + ENCLOSURE.guard):
                begun = motion_from(osc, launch, bits, coarse, derivative, framed, expected[0])
                gap = None if osc.upper is None else _ball(subtract(osc.upper, osc.clearance), bits)
                hit = first_hit(begun, Balls(bits).rational(horizon), steps, gap)
                impact = _impact(osc, launch, hit, bits)
                lack = 0 if box else _lack(impact, wanted + 1)
                if lack <= 0:
                    return impact
                why, ladder.lack, flown = f"{lack} bits of the result are lacking", lack + 6, hit.steps
        except (NoHit, TooLong):
            raise
        except Refused as reason:
            # more bits may pass a singularity that is near; one that is met they never do
            singular += isinstance(reason, NotAnalytic)
            if (box and coarse >= bits) or singular > ENCLOSURE.singular:
                raise
            why, ladder.lack = str(reason), int(bits * (ENCLOSURE.more - 1))
            coarse = min(2 * coarse, bits)
            flown = 0 if begun is None else begun.flown
    raise Refused(f"{why} (at {bits} bits)")


def bits_of_a_set(launch: Launch, bits: int) -> int:
    """Bits of the steps of a set: those that its radius leaves, at most `bits`."""
    return max(ENCLOSURE.coarse, min(bits, ENCLOSURE.guard - floor(log2(max(launch.radii.values())))))


def _spare(time: float, condition: float) -> int:
    """Bits that a flight is expected to lose: to its condition, and to the balls that wrap it at every step."""
    lost = ENCLOSURE.lost * time if time < ENCLOSURE.wrapped else 0.0
    return int(lost + log2(min(max(condition, 1.0), 2.0**200)))


@contextmanager
def working_at(bits: int) -> Iterator[None]:
    """Balls of so many bits, and series that flint does not cut."""
    with series_of_any_length(), balls_at(bits):
        yield


def motion_from(
    osc: Oscillator, launch: Launch, bits: int, coarse: int, derivative: bool, framed: bool, time: float = 0.0
) -> CarriedMotion:
    """The flight from a launch at the working precision.

    Parameters
    ----------
    bits, coarse : of the steps of a point, and of a set. derivative : whether columns are carried.
    framed : whether the state is carried in a frame; else as a ball. time : of the flight in doubles, 0 not known.
    """
    names = launch.names
    programs = programs_of(osc, names)
    if not framed and not names:
        tau, v, own = _phase(osc, launch.tau, bits, names), _ball(launch.v, bits), equation_of(osc)
        start = Start(tau, v, launch.removed, time)
        return CarriedMotion((own, own), start, bits, deviations={} if derivative else None)
    tau, v, wide_numbers = box_of(osc, launch, bits)
    numbers = {name: _ball(_number(osc, name), bits) for name in names}
    deviations = {name: _radius(launch.radii[name]) for name in names}
    own = Equation(programs, numbers)
    wide = Equation(programs, wide_numbers) if names else own
    need(v > 0 or launch.removed != 1, Refused("the launch velocity is not shown positive"))
    assert isinstance(v, flint.arb)
    carried = deviations if derivative or any(launch.radii.values()) else None
    start = Start(tau, v, launch.removed)
    return CarriedMotion((own, wide), start, bits, coarse=min(coarse, bits), deviations=carried)


def box_of(osc: Oscillator, launch: Launch, bits: int) -> tuple[Any, Any, dict[str, Any]]:
    """tau, v and the numbers that have a radius, as balls."""
    tau, v = _phase(osc, launch.tau, bits, launch.names), _ball(launch.v, bits)
    tau, v = (value + _radius(launch.radii.get(name, Fraction(0))) for name, value in (("tau", tau), ("v", v)))
    return tau, v, {name: _ball(_number(osc, name), bits) + _radius(launch.radii[name]) for name in launch.names}


def _number(osc: Oscillator, name: str) -> Expression:
    return osc.parameters[name] if name in osc.parameters else getattr(osc, name)


def _ball(tree: Expression, bits: int) -> Any:
    return evaluate(tree, {}, Balls(bits + ENCLOSURE.guard))


def _radius(size: Fraction) -> Any:
    return flint.arb(0, flint.arb(flint.fmpq(size.numerator, size.denominator)).upper()) if size else flint.arb(0)


def _phase(osc: Oscillator, tau: Expression, bits: int, names: tuple[str, ...]) -> Any:
    """A launch time less whole periods of g, so that times far from 0 lose no digits.

    Where the period depends on a number that has a radius, no time is a whole number of periods for all its values.
    """
    plain = _ball(tau, bits)
    size = abs(float(plain.mid()))
    if osc.period is None or not size > 64:
        return plain
    period = period_over(osc, names)
    if period is None or names_in(period).intersection(names):
        return plain
    # the fraction of tau/period has `digits` digits only if the number of whole periods times the period has them
    more = bits + ENCLOSURE.guard + (int(abs(plain).upper().man_exp()[1]) + 64 if size > 1e15 else 64)
    with balls_at(more + max(int(plain.mid().man_exp()[0]).bit_length(), 0)):
        exact, length = _ball(tau, more), _ball(osc.period, more)
        turns = flint.arb((exact / length).mid()).floor().unique_fmpz()
        return exact - length * turns


def _impact(osc: Oscillator, launch: Launch, hit: "BallHit", bits: int) -> ProvedImpact:
    """The state after a hit, and D G."""
    names = launch.names
    above = osc.upper is not None and bool(hit.velocity > 0)
    side = -1 if above else 1  # the law of the upper wall is that of the model with x -> -x
    law = programs_of(osc.mirrored if above else osc, names).rho.prepared(
        {name: _ball(_number(osc, name), bits) + _radius(launch.radii[name]) for name in names}
    )
    v, slope, *by_law = law({"v": side * hit.velocity})
    tau = _ball(launch.tau, bits) + _radius(launch.radii.get("tau", Fraction(0))) + hit.flight_time
    rows: list[list[Any]] = []
    if hit.derivatives:
        first = [delay + (1 if k == 0 else 0) for k, (delay, _) in enumerate(hit.derivatives)]
        second = [side * slope * change for _, change in hit.derivatives]
        for k, slope_by_number in enumerate(by_law):
            second[2 + k] += slope_by_number
        rows = [first, second]
    return ProvedImpact(hit.flight_time, hit.velocity, tau, v, rows, hit.steps, bits)


def _lack(found: ProvedImpact, wanted: int) -> int:
    """Bits that the worst of the numbers lacks; times next to 0 need as many as they can have."""
    parts = [found.flight_time, found.velocity, *([] if found.v.contains(0) else [found.v])]
    if found.tau != 0:
        parts.append(found.tau)
    return int(max(wanted - part.rel_accuracy_bits() for part in parts))


# ---- a flight in balls, followed to its first hit


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
    def at_hit(
        self, root: Any, velocity: Any, rate: Any, level: Any = None
    ) -> tuple[Any, Any, list[tuple[Any, Any]]]: ...


class BallHit(NamedTuple):
    """Flight time and velocity of the first hit, their derivatives (tau, v, names), and the steps."""

    flight_time: Any
    velocity: Any
    derivatives: list[tuple[Any, Any]]
    steps: int


def first_hit(motion: Motion, horizon: Any, steps: int, gap: Any = None) -> BallHit:
    """The first hit of every member of a set of states.

    Parameters
    ----------
    gap : x - c at the upper wall, a ball; None of a model with one wall. At the upper wall the velocity is > 0.

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
            need(inner[0].polynomial[0] > 0, Refused("the launch velocity is not shown positive"))
        else:
            inner = value, slope
        shorter, over = length, None
        while True:
            try:
                root = first_root(*inner, shorter, motion.bits)
                if gap is not None:
                    last = shorter if root is None else centre(root.upper())
                    over = first_root(*below(value, slope, gap), last, motion.bits)
                break
            except RootAtEnd:
                shorter = centre(shorter * SHORTER)
                if not shorter > length * SHORTEST:
                    raise Refused("the ball of a state grew too wide to tell the sign of x - c") from None
            except NearGraze as graze:
                after = float((motion.time + graze.at).mid())
                wall = "x - c" if gap is None else "the distance from a wall"
                raise Refused(f"{wall} and x' both vanish {after:.6g} after the launch, as far as balls tell") from None
        arrival = None
        if over is not None:
            if root is not None and not over < root:
                raise Refused("the hits of both walls are not told apart")
            arrival = motion.at_hit(over, slope(over), slope(over), gap)
        elif root is not None:
            rate, velocity = inner[1](root), slope(root)
            if first:
                velocity = velocity.intersection(root**motion.removed * rate)
            arrival = motion.at_hit(root, velocity, rate)
        if (motion.time + shorter if arrival is None else arrival[0]) > horizon:
            raise NoHit(f"no hit comes before {float(horizon.mid()):.6g}")
        if arrival is not None:
            return BallHit(*arrival, count)
        motion.advance(shorter)
    raise TooLong(f"no hit comes before {float(motion.time.mid()):.6g}, and {steps} steps in balls do not go further")
