"""An event of periodic orbits over a number of the model.

Fold, period-doubling, torus: one unknown is held anywhere in a short interval, v after the first impact at a fold, else
the number.  Krawczyk's operator shows one orbit in a box for each of its values: they form a curve.  With M the
derivative of the return map, t its trace and d its determinant, the test

    fold  1 - t + d,        period-doubling  1 + t + d,        torus  1 - d, where t^2 < 4 d,

is 0 where 1 or -1 is a multiplier, or two complex ones have the product 1.  It is continuous on the curve and has
opposite signs at the ends of the interval, so it vanishes between them.

Graze, hidden impact: an orbit touches the wall in its first state.  v = 0 is held there, the number is an unknown, and
Krawczyk's operator shows one such orbit in a box.
"""

from fractions import Fraction
from typing import Any

from flint import arb

from .formulas import Formula, Refused, Wrong, ball, need, require_period
from .motion import Model, compared, size, within
from .periodic_orbit import Orbits, require_shortest, return_map, walls_of
from .schema import CURVED, TOUCHING

PART = 512  # of the radii: half of the interval of the held unknown
ROUNDS = 12  # of Newton's method and of secants


def event(model: Model, content: dict[str, Any], bits: int) -> None:
    """Check that an event exists whose number and orbit lie within the radii."""
    kind, over, touches = content["kind"], content["over"], content["kind"] in TOUCHING
    others = {name: text for name, text in model.g.parameters.items() if name != over}
    free = len(others) < len(model.g.parameters) and over not in model.c.names()
    need("over", free, f"{over} is no parameter of the model, or moves the wall")
    require_period(Formula(model.g.text, others), content["period"])  # whatever the number is
    numbers = [state[name] for state in content["states"] for name in ("tau", "v")] + [content["parameter"]]
    point, radii = ([ball(Fraction(number[field])) for number in numbers] for field in ("value", "radius"))
    family = Model(content["model"], over, point[-1])
    span, held = Formula(content["period"], others)() * int(content["periods"]), -1 if kind in CURVED[1:] else 1
    orbits = Orbits(family, span, bits, held % len(point), touches, walls_of(content))
    if touches:
        near = [ball(Fraction(content["unique_within"]))] * len(point)
        near[1] = radii[1] = arb(0)
        orbits.alone(point, [near, radii])
        return
    require_shortest(point[:-1], radii, span, int(content["periods"]))
    enclosures = Curve(orbits, kind).event(point, radii)
    compared({f"number {k + 1}": pair for k, pair in enumerate(zip(enclosures, numbers, strict=True))})


class Curve:
    """The orbits next to a fold, period doubling or torus."""

    def __init__(self, orbits: Orbits, kind: str) -> None:
        self.orbits, self.kind, self.bits = orbits, kind, orbits.bits

    def test(self, slopes: list[Any]) -> Any:
        """The function that vanishes at the event."""
        total = return_map(slopes)
        trace, determinant = total[0, 0] + total[1, 1], total.det()
        complex_ = self.kind != "torus" or trace * trace < 4 * determinant
        need("complex", complex_, "the multipliers are not shown to be complex", Refused)
        return 1 + {"fold": -trace, "period-doubling": trace, "torus": -2 * determinant}[self.kind] + determinant

    def moved(self, point: list[Any], shift: Any) -> list[Any]:
        """The point with another value of the held unknown."""
        return [arb((x + shift).mid()) if k == self.orbits.held else x for k, x in enumerate(point)]

    def solved(self, point: list[Any]) -> tuple[list[Any], Any]:
        """About the orbit, by Newton's method, and the middle of its test: nothing is shown."""
        small = arb(2) ** -(self.bits - 12)
        for _ in range(ROUNDS):
            slopes, image = self.orbits.krawczyk(point, [small] * len(point))
            point = [arb((x + part).mid()) for x, part in zip(point, image, strict=True)]
            if all(size(part) < 4 * small for part in image):
                return point, arb(self.test(slopes).mid())
        raise Refused("Newton's method does not come to an orbit")

    def crossing(self, point: list[Any], close: Any) -> list[Any]:
        """An orbit at which the test is about 0, by secants: nothing is shown."""
        (point, test), step = self.solved(point), arb(2) ** -(self.bits // 3)
        for _ in range(ROUNDS):
            point, after = self.solved(self.moved(point, step))
            if test == after:
                break
            step, test = arb((after * step / (test - after)).mid()), after
            if abs(step) < close / 16:
                return self.solved(self.moved(point, step))[0]
        raise Refused("no orbit is found at which the test vanishes")

    def inside(self, point: list[Any], radius: Any, half: Any) -> list[Any]:
        """The orbits less the centre, where one is shown in the box for each value of the held unknown."""
        slopes, image = self.orbits.krawczyk(point, [radius] * len(point), half)
        inside = all(abs(part) < radius for part in image)
        need("curve", inside, "Krawczyk's operator does not map the box of the curve into itself", Refused)
        self.test(slopes)  # along the whole curve a torus has complex multipliers
        return image

    def sign(self, point: list[Any], radius: Any) -> int:
        """The sign of the test of the one orbit in a box; 0 : not shown.  Krawczyk's operator narrows the box."""
        box = [x if k == self.orbits.held else x + within(radius) for k, x in enumerate(point)]
        while True:
            centre = [arb(x.mid()) for x in box]
            slopes, image = self.orbits.krawczyk(centre, [arb(x.rad()) for x in box])
            test = self.test(slopes)
            narrower = [x.intersection(middle + offset) for x, middle, offset in zip(box, centre, image, strict=True)]
            if test > 0 or test < 0 or not any(a.rad() * 2 < b.rad() for a, b in zip(narrower, box, strict=True)):
                return 1 if test > 0 else -1 if test < 0 else 0
            box = narrower

    def event(self, point: list[Any], radii: list[Any]) -> list[Any]:
        """Balls of the event, within the radii round a point if all goes well."""
        narrow = arb((min(radii, key=float) / 4).mid())
        half = arb((narrow / PART).mid())
        if not arb(2) ** -(self.bits - 20) < half / PART:
            raise Refused("too few bits")
        written, point = point, self.crossing(point, half)
        if not all(abs(x - centre) < 4 * radius for x, centre, radius in zip(point, written, radii, strict=True)):
            raise Wrong("the test does not vanish near the orbit that is written")
        image = self.inside(point, narrow, half * arb(1.01))  # its ends are beyond those below
        signs = [self.sign(self.moved(point, side * half), narrow) for side in (-1, 1)]
        error = Wrong if abs(sum(signs)) == 2 else Refused
        need("change of sign", sorted(signs) == [-1, 1], "the test is not shown to change its sign", error)
        return [x + offset for x, offset in zip(point, image, strict=True)]
