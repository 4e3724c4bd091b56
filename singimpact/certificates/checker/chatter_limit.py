"""The end of a chatter: flights in balls, and the rest of it between bounds.

Let -A <= x'' <= -a < 0 for t in [tau, tau + W], c <= x <= c + v W, |x'| <= 2 v, and q = sqrt(A/a).  A flight from v
then takes between 2 v/A and 2 v/a.  It rises to a height between v^2/(2 A) and v^2/(2 a) and falls from there, so it
lands with between v/q and q v.  After an impact with restitution r the velocity is between r v/q and r q v.  If q < 2
and r q < 1, what is left of the chatter lies between 2 v/(A (1 - r/q)) and 2 v/(a (1 - r q)), as long as that is
below W.
"""

from typing import Any

from .formulas import Refused, need
from .motion import Model, next_state, size, within
from .told import compared, launched, lies_within, read

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
