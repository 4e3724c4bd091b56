"""A period doubling of periodic orbits over a number of the model, by a change of sign on a curve of orbits.

With the number anywhere in a short interval, Krawczyk's operator shows one orbit in a box for each of its values: they
form a curve.  With M the derivative of the return map, t its trace and d its determinant, the test 1 + t + d, which is
0 where -1 is a multiplier, is continuous on the curve.  It has opposite signs at the ends of the interval, so it
vanishes between them.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from flint import arb, arb_mat

from .formulas import Formula, Refused, Wrong, ball
from .motion import Model, size, within
from .periodic_orbit import krawczyk
from .periods import require_period
from .told import compared

KINDS = ("period-doubling",)
PART = 512  # of the radii: half of the interval of the number
ROUNDS = 40  # of Newton's method and of secants


class Family:
    """The orbits of a model over a number, between which and an orbit of so many periods there is nothing to choose."""

    def __init__(self, told: dict[str, Any], bits: int) -> None:
        self.told, self.bits, self.over = told["model"], bits, told["over"]
        model = Model(self.told)
        if self.over not in model.g.parameters:
            raise Wrong(f"{self.over} is no parameter of the model")
        others = {name: text for name, text in model.g.parameters.items() if name != self.over}
        require_period(Formula(model.g.text, others), told["period"])  # whatever the number is
        self.span = Formula(told["period"], others)() * int(told["periods"])

    def model(self, value: Any) -> Model:
        """The model with a ball for the number."""
        return Model({**self.told, "parameters": {**self.told["parameters"], self.over: value}})

    def over_box(self, value: Any, point: list[Any], radius: Any) -> tuple[Any, list[Any]]:
        """M over a box, and Krawczyk's image of the box less its centre."""
        slopes, image = krawczyk(self.model(value), point, [radius] * len(point), self.span, self.bits)
        total = arb_mat([[1, 0], [0, 1]])
        for slope in slopes:
            total = arb_mat(slope) * total
        return total, image

    def test(self, total: Any) -> Any:
        """What vanishes at the event."""
        trace, determinant = total[0, 0] + total[1, 1], total.det()
        return 1 + trace + determinant

    def solved(self, value: Any, point: list[Any]) -> tuple[list[Any], Any]:
        """About the orbit, by Newton's method, and the middle of its test: nothing is shown."""
        small = arb(2) ** -(self.bits - 12)
        for _ in range(ROUNDS):
            total, image = self.over_box(value, point, small)
            point = [arb((x + part).mid()) for x, part in zip(point, image, strict=True)]
            if all(size(part) < 4 * small for part in image):
                return point, arb(self.test(total).mid())
        raise Refused("Newton's method does not come to an orbit")

    def require_inside(self, value: Any, point: list[Any], radius: Any) -> tuple[Any, list[Any]]:
        """M and the orbits less the centre, where one orbit is shown in the box for each value of a ball."""
        total, image = self.over_box(value, point, radius)
        if not all(abs(part) < radius for part in image):
            raise Refused("Krawczyk's operator does not map the box of the curve into itself")
        return total, image


def event(model: Model, told: dict[str, Any], bits: int) -> None:  # noqa: ARG001
    """That an event with its number and an orbit within the radii exists."""
    if told["kind"] not in KINDS or int(told["periods"]) < 1 or not told["states"]:
        raise Wrong(f"an event is a {' or '.join(KINDS)} of an orbit that has impacts and closes after periods")
    family, numbers = Family(told, bits), [state[name] for state in told["states"] for name in ("tau", "v")]
    value, radius = (ball(Fraction(told["parameter"][part])) for part in ("value", "radius"))
    narrow = min((ball(Fraction(each["radius"])) for each in numbers), key=float) / 4
    half, own = arb((min(radius, narrow, key=float) / PART).mid()), arb(2) ** -(bits - 20)
    if not own < half / PART:
        raise Refused("too few bits")
    value, point = crossing(family, arb(value.mid()), [ball(Fraction(each["value"])) for each in numbers], half)
    narrow = arb(narrow.mid())
    _, image = family.require_inside(value + within(half), point, narrow)
    signs = []
    for side in (-1, 1):
        at = value + side * half
        end, _ = family.solved(at, point)
        found, _ = family.require_inside(at, end, own)
        if not all(abs(a - b) + own < narrow for a, b in zip(end, point, strict=True)):
            raise Refused("an orbit beside the event is not shown to lie on the curve")
        test = family.test(found)
        signs.append(1 if test > 0 else -1 if test < 0 else 0)
    if sorted(signs) != [-1, 1]:
        raise (Wrong if abs(sum(signs)) == 2 else Refused)("the test is not shown to change its sign")
    states = {f"state {k}": (x + part, each)
              for k, (x, part, each) in enumerate(zip(point, image, numbers, strict=True))}  # fmt: skip
    compared({told["over"]: (value + within(half), told["parameter"]), **states})


def crossing(family: Family, value: Any, point: list[Any], close: Any) -> tuple[Any, list[Any]]:
    """A number and an orbit at which the test is about 0, by secants: nothing is shown."""
    point, test = family.solved(value, point)
    other = arb((value + arb(2) ** -(family.bits // 3)).mid())
    for _ in range(ROUNDS):
        point, after = family.solved(other, point)
        if test == after:
            break
        step = arb((after * (other - value) / (test - after)).mid())
        value, test, other = other, after, arb((other + step).mid())
        if abs(step) < close / 16:
            return other, family.solved(other, point)[0]
    raise Refused("no number is found at which the test vanishes")
