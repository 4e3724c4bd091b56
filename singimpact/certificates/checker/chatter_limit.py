"""The end of a chatter: flights in balls, and the rest of it between bounds. Border orbits, beside which it changes.

Let -A <= x'' <= -a < 0 for t in [tau, tau + W], c <= x <= c + v W, |x'| <= 2 v, and q = sqrt(A/a).  A flight from v
then takes between 2 v/A and 2 v/a.  It rises to a height between v^2/(2 A) and v^2/(2 a) and falls from there, so it
lands with between v/q and q v.  After an impact with restitution r the velocity is between r v/q and r q v.  If q < 2
and r q < 1, what is left of the chatter lies between 2 v/(A (1 - r/q)) and 2 v/(a (1 - r q)), as long as that is
below W.
"""

from fractions import Fraction
from typing import Any

from flint import arb

from .formulas import Dual, Refused, ball, need
from .motion import Flight, Model, compared, launched, lies_within, next_state, read, size, within

IMPACTS = 200_000  # at most


def chatter_limit(model: Model, content: dict[str, Any], bits: int) -> None:
    """Check that the impacts from the launch accumulate at tau, or that a_c > 0 first at the impact at tau."""
    (tau, v), written = launched(content, moving=True), read(content["tau"])
    r = model.ratio()
    for count in range(IMPACTS):
        a = model.push(tau, v * 0)
        if count and a > 0:
            require(content, "lift-off")
            return compared({"tau": (tau, content["tau"])})
        if count and not a < 0:
            raise Refused("whether an impact lifts off is not decided")
        left = rest(model, tau, v, a, r) if a < 0 else None
        if left is not None:
            require(content, "accumulation")
            if lies_within(tau + left, content["tau"]):
                return None
            if not written.overlaps(tau + left) or tau.rad() > written.rad():  # more impacts make it no narrower
                return compared({"tau": (tau + left, content["tau"])})
        tau, v = next_state(model, tau, v, bits)
    raise Refused(f"{IMPACTS} impacts do not come to an end")


def require(content: dict[str, Any], ends: str) -> None:
    """Refuse another end than the one that is shown."""
    need("ends", content["ends"] == ends, f"the chatter ends in {ends}")


def rest(model: Model, tau: Any, v: Any, a: Any, r: Any) -> Any:
    """A ball with what is left of a chatter; None where the bounds do not close."""
    if not r < 1:
        return None
    window = size(4 * v / (a * (r - 1)))
    pull = -model.push(tau.union(tau + window), within(2 * v), model.c().union(model.c() + v * window))
    low, high = pull.lower(), pull.upper()
    if not low > 0:
        return None
    q = (high / low).sqrt()
    if not (q < 2 and r * q < 1):
        return None
    least, most = 2 * v / (high * (1 - r / q)), 2 * v / (low * (1 - r * q))
    return least.union(most) if most < window else None


# A border orbit: released at rest where a_c rises through zero, its impacts accumulate exactly where it does so again.
#
# It exists for some value of a number within its radius.  For every value there the orbit comes to the same impact,
# transversally, after which a_c < 0 up to the later zero; so all impacts before that zero depend on the value without a
# jump, for x'' = a_c < 0 wherever one touches the wall.  At one end of the radius chatter completes before the zero, at
# the other a flight passes it.  Both fates belong to open sets of values, so between the ends lies one with neither.

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
