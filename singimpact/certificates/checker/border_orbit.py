"""A border orbit: released at rest where a_c rises through zero, its impacts accumulate exactly where it does so again.

It exists for some value of a number within its radius.  For every value there the orbit comes to the same impact,
transversally, after which a_c < 0 up to the later zero; so all impacts before that zero depend on the value without a
jump, for x'' = a_c < 0 wherever one touches the wall.  At one end of the radius chatter completes before the zero, at
the other a flight passes it.  Both fates belong to open sets of values, so between the ends lies one with neither.
"""

from fractions import Fraction
from typing import Any

from flint import arb

from .chatter_limit import IMPACTS, rest
from .formulas import Dual, Refused, ball, need
from .motion import Flight, Model, next_state
from .told import read

AROUND = Fraction(1, 2**30)  # of the time that is written, in which a zero of a_c lies
PIECES = 4000  # of a time in which a_c < 0
COMPLETES, PASSES = "chatter completes", "a flight passes"
SIDES = {"above": [PASSES, COMPLETES], "below": [COMPLETES, PASSES]}


def border_orbit(_model: Model, content: dict[str, Any], bits: int) -> None:
    """Check that a border orbit exists within the radius of the number, and on which side chatter completes."""
    value, radius = (Fraction(content["parameter"][part]) for part in ("value", "radius"))
    came_back(Model(content["model"], content["over"], read(content["parameter"])), content, bits)
    ends = [
        fate(Model(content["model"], content["over"], ball(end)), content, bits)
        for end in (value - radius, value + radius)
    ]
    need("fates", ends == SIDES[content["completes"]], f"at the ends of the radius {ends[0]} and {ends[1]}")


def came_back(model: Model, content: dict[str, Any], bits: int) -> tuple[Any, Any, Any]:
    """The state after the last impact that is counted, and the zero of a_c up to which a_c < 0 then."""
    tau, end = (rising_zero(model, Fraction(content[name])) for name in ("release", "end"))
    v, removed = arb(0), 3
    for _ in range(int(content["impacts"])):
        time, velocity, _ = Flight(model, tau, v, bits, removed=removed).first_hit()
        tau, v, removed = tau + time, model.rebound(velocity), 0
    need("back", tau < end, "that the orbit comes back before the end is not shown", Refused)
    require_pressing(model, tau, end)
    return tau, v, end


def rising_zero(model: Model, near: Fraction) -> Any:
    """The one zero of a_c near a time, where it rises."""
    low, high = ball(near - AROUND), ball(near + AROUND)
    U, still = low.union(high), arb(0)

    def rate(time: Any) -> Any:
        found = model.g(t=Dual(time, [arb(1)]))
        return found.slopes[0] if isinstance(found, Dual) else arb(0)

    rises = model.push(low, still) < 0 and model.push(high, still) > 0 and rate(U) > 0
    need("rises", rises, f"a_c is not shown to rise through zero once near {float(near)}", Refused)
    while True:
        middle = arb(U.mid())
        smaller = U.intersection(middle - model.push(middle, still) / rate(U))
        if smaller.rad() * 1.5 > U.rad():
            return smaller
        U = smaller


def require_pressing(model: Model, tau: Any, end: Any) -> None:
    """Refuse a time up to the zero at which a_c < 0 is not shown; it rises next to the zero."""
    pieces = [(arb(tau.lower()), arb(end.lower()) - ball(AROUND / 2))]
    for _ in range(PIECES):
        if not pieces:
            return
        low, high = pieces.pop()
        if low < high and not model.push(low.union(high), arb(0)) < 0:
            middle = arb(((low + high) / 2).mid())
            pieces += [(low, middle), (middle, high)]
    raise Refused("a_c < 0 up to the end is not shown")


def fate(model: Model, content: dict[str, Any], bits: int) -> str:
    """The fate of the orbit of one value before the later zero."""
    (tau, v, end), r = came_back(model, content, bits), model.ratio()
    for _ in range(IMPACTS):
        left = rest(model, tau, v, model.push(tau, v * 0), r)
        if left is not None and tau + left < end:
            return COMPLETES
        tau, v = next_state(model, tau, v, bits)
        if tau > end:
            return PASSES
        if not tau < end:
            break
    raise Refused("what the orbit of an end of the radius does is not decided")
