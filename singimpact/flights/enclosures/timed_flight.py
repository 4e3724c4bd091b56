"""Flights to a given time in balls: where they touch the wall, the time of a hit is no smooth function, and z, z' are.

z = x - c,   z'   at a time T after the launch,   with their derivatives by tau, v, and numbers of the model.
"""

from fractions import Fraction
from math import ceil
from typing import Any, NamedTuple

from singimpact.algebra.balls import BITS_A_DIGIT
from singimpact.algebra.precision import Ladder
from singimpact.flights.enclosures.certified_hit import ENCLOSURE, Launch, bits_of_a_set, motion_from, working_at
from singimpact.flights.enclosures.equation import Refused
from singimpact.flights.enclosures.motion import CarriedMotion, Pair
from singimpact.flights.enclosures.tube import NearGraze, RootAtEnd, Tube, below, centre, divided, first_root
from singimpact.inputs import need
from singimpact.oscillator.model import Oscillator

NEAR = 0.8  # of the time that is left: a step that would end beyond this part of it goes half of the way
HALVINGS = 30  # of the last piece, on which z'' > 0 is shown


class Arrival(NamedTuple):
    """Balls of z, z', z'' at the time, and of the derivatives of z and z' by tau, v, names.

    The derivatives by tau are those at equal time since the launch.
    """

    height: Any
    velocity: Any
    acceleration: Any
    columns: list[Pair]


class Walls(NamedTuple):
    """The walls that a flight may meet.

    Parameters
    ----------
    gap : z at another wall, a ball; None of a model with one. across : whether the flight ends there.
    """

    gap: Any = None
    across: bool = False


ONE_WALL = Walls()


def timed_flight(osc: Oscillator, launch: Launch, time: Any, digits: int, *, derivative: bool = False) -> Arrival:
    """A flight at a given time; contact with the wall is allowed at its end only.

    Parameters
    ----------
    time : a ball. digits : after the point, of z and z' of a launch that is a point.
    derivative : whether the derivatives are enclosed too.

    Raises
    ------
    Refused : x - c is not shown positive at the end of a step before the time; or the digits are not reached.

    Examples
    --------
    >>> from singimpact.algebra.numbers import constant
    >>> from singimpact.algebra.balls import Balls
    >>> launch, osc = Launch(constant("tau", 0), constant("v", 1)), Oscillator("x", "0", 0, 1)
    >>> print(timed_flight(osc, launch, Balls(100).rational(Fraction(1)), 20).height.str(20, radius=False))
    0.84147098480789650665
    """
    first = ceil(digits * BITS_A_DIGIT) + ENCLOSURE.spare
    most, box = ENCLOSURE.most * first + ENCLOSURE.room, any(launch.radii.values())
    small = Fraction(1, 10**digits)
    for bits in Ladder(first, most, lambda before: min(int(before * ENCLOSURE.more), most)):
        why = "the digits are not reached"
        try:
            arrival = _flown(osc, launch, time, bits, derivative)
            if box or all(component.rad() < float(small) for component in (arrival.height, arrival.velocity)):
                return arrival
        except Refused as reason:
            if box:
                raise
            why = str(reason)
    raise Refused(f"{why} (at {bits} bits)")


def touches_first(
    osc: Oscillator, launch: Launch, time: Any, digits: int, *, crosses: bool = False, walls: Walls = ONE_WALL
) -> None:
    """Show that z > 0 between the launch and a time at which z = 0, and z' = 0 unless it crosses the wall.

    The caller has proved what holds at the time. z > 0 is shown up to a last piece, and there z'' > 0: a function with
    z = z' = 0 at its end is then positive on it. Where it crosses the wall z' < 0 on the last piece. At another wall
    the distance from that stands for z, and the distance from the wall that is not met is positive throughout.

    Raises
    ------
    Refused : some member of the box may meet the wall before, or is pressed to it where it touches.
    """
    bits = ceil(digits * BITS_A_DIGIT) + ENCLOSURE.spare
    with working_at(bits + ENCLOSURE.guard):
        motion = _begun(osc, launch, bits, False)
        while True:
            inner, length = _step(motion)
            left = time - motion.time
            met, others = inner, []
            if walls.gap is not None:
                met, others = below(*motion.members, walls.gap), [inner]
                if not walls.across:
                    met, others = inner, [met]
            reaches = _reaches(length, left)
            for other in others:
                _above(motion, other, centre(left.upper()) if reaches else _piece(length, left), crosses)
            if reaches:
                return _touches_in_step(motion, met, left, crosses, walls.across)
            piece = _piece(length, left)
            _above(motion, met, piece, crosses)
            motion.advance(piece)


def _touches_in_step(motion: CarriedMotion, inner: tuple[Tube, Tube], left: Any, crosses: bool, across: bool) -> None:
    """Show that the distance from the wall is positive in the step of the touching point."""
    last, side = centre(left), -1 if across else 1
    for _ in range(HALVINGS):
        before = centre(left - last)
        during = before.union(left)
        if side * motion.members[1](during) < 0 if crosses else side * _acceleration(motion, during) > 0:
            if before > 0:
                _above(motion, inner, before, crosses)
            return
        last = last / 2
    need(not crosses, Refused("the mass is not shown to fall onto the wall at the impact"))
    raise Refused("the mass is not shown to be driven off the wall where it touches it")


def _begun(osc: Oscillator, launch: Launch, bits: int, derivative: bool) -> CarriedMotion:
    coarse = bits_of_a_set(launch, bits) if any(launch.radii.values()) else bits
    return motion_from(osc, launch, bits, coarse, derivative, True)


def _flown(osc: Oscillator, launch: Launch, time: Any, bits: int, derivative: bool) -> Arrival:
    with working_at(bits + ENCLOSURE.guard):
        motion = _begun(osc, launch, bits, derivative)
        while True:
            _, length = _step(motion)
            left = time - motion.time
            if _reaches(length, left):
                z, v = (member(left) for member in motion.members)
                columns = motion.columns_at(left) if derivative else []
                return Arrival(z, v, _acceleration(motion, left), columns)
            motion.advance(_piece(length, left))


def _step(motion: CarriedMotion) -> tuple[tuple[Tube, Tube], Any]:
    """z and its slope on the next step, without the zero of the launch; and the length of the step."""
    motion.flown += 1
    if motion.flown > ENCLOSURE.steps:
        raise Refused(f"{ENCLOSURE.steps} steps in balls do not reach the time")
    value, slope, length = motion.tubes()
    if not motion.launched:
        return (value, slope), length
    inner = divided(value, slope, motion.removed)
    need(inner[0].polynomial[0] > 0, Refused("the mass is not shown to leave the wall"))
    return inner, length


def _reaches(length: Any, left: Any) -> bool:
    return bool(left.upper() <= length)


def _piece(length: Any, left: Any) -> Any:
    """The length of this step: not so near the time that the height there is rounding."""
    return length if length < left * NEAR else centre(left / 2)


def _above(motion: CarriedMotion, inner: tuple[Tube, Tube], length: Any, crosses: bool) -> None:
    """Show that there is no zero up to a length."""
    ends = "its impact" if crosses else "it touches it"
    try:
        root = first_root(*inner, length, motion.bits)
    except (NearGraze, RootAtEnd) as near:
        if crosses and isinstance(near, NearGraze):
            after = float((motion.time + near.at).mid())
            raise Refused(f"x - c and x' both vanish {after:.6g} after the launch, as far as balls tell") from None
        raise Refused(f"the flight is not shown to be above the wall before {ends}") from None
    if root is not None:
        raise Refused(f"the flight meets the wall before {ends}")


def _acceleration(motion: CarriedMotion, during: Any) -> Any:
    """z'' at times since the beginning of the step."""
    z, v = (part(during) for part in motion.members)
    return motion.equation.acceleration(motion.tau + motion.time + during, z, v)
