"""The impact map of a box: of states, and of numbers of the model, with D G; every number has a proved radius."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from singimpact.algebra.certified import Certified, from_ball
from singimpact.algebra.expressions import names_in
from singimpact.algebra.numbers import as_fraction, constant, rational_near, sign_of
from singimpact.flights.enclosures.certified_hit import Launch, certified_hit
from singimpact.flights.enclosures.equation import NoHit, Refused
from singimpact.flights.horizons import horizon_of
from singimpact.flights.impact_map import checked_digits
from singimpact.inputs import InputError, require, unknown
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION
from singimpact.result import Result, in_words
from singimpact.status import Status


@dataclass(frozen=True, repr=False)
class EnclosedImpact(Result):
    """The first impact of every member of a box.

    Attributes
    ----------
    flight_time, velocity, tau, v : `Certified`: for every member the number lies within `.radius` of `.value`; None
        without a hit.
    derivative : two rows, of tau and of v after the impact, with a column for each of `names`: `Certified`.
    names : "tau", "v", then the numbers of the model that have a radius.
    status : `hit`; `no_return`: proved, no member hits before the horizon; `unresolved`, and `note` says why.
    """

    flight_time: Certified | None
    velocity: Certified | None
    tau: Certified | None
    v: Certified | None
    derivative: tuple[tuple[Certified, ...], ...]
    names: tuple[str, ...]
    status: Any
    note: str = ""

    __repr__ = in_words


def enclosed_impact(
    osc: Oscillator, tau: Any, v: Any, *, radii: Mapping[str, Any] | None = None, digits: int = 30, horizon: Any = None
) -> EnclosedImpact:
    """The first impact of all states within `radii` of (tau, v), and D G there, with proved radii.

    Parameters
    ----------
    osc : the model. tau, v : the centre, v > 0, or v = 0 from a state that leaves the wall.
    radii : name -> radius of "tau", "v", "clearance", "restitution" or a parameter; those not named are exact.
    digits : of the result of a point; of a box, those of its centre. horizon : as for the impact map.

    Returns
    -------
    EnclosedImpact : of a wide box the status is `unresolved` where some members may graze: subdivide it.

    Examples
    --------
    >>> osc = Oscillator("x + 0.1*xdot + 0.3*x**3", "cos(w*t)", "0.3", "0.6", {"w": "1.7"})
    >>> found = enclosed_impact(osc, "1.4", "0.6", radii={"v": "1e-6", "w": "1e-6"}, digits=12)
    >>> found.v
    Certified(0.348656552746 +- 6.4e-7)
    >>> [[round(float(part.value), 4) for part in row] for row in found.derivative]
    [[0.7674, 1.2585, -0.1885], [-0.1905, 0.4257, -0.2155]]
    """
    widths = {name: _radius(name, value) for name, value in (radii or {}).items()}
    _check(osc, widths)
    places, wanted = (constant("tau", tau), constant("v", v)), checked_digits(digits)
    names = ("tau", "v", *(name for name in widths if name not in ("tau", "v")))
    require(sign_of(places[1]) > 0, "v", v, "a velocity above 0, just after an impact")
    launch = Launch(*places, 1, widths)
    try:
        proof = certified_hit(osc, launch, wanted, Fraction(horizon_of(osc, horizon)), derivative=True)
    except NoHit as none:
        return _without(names, Status.no_return, f"proved: {none}")
    except (Refused, ArithmeticError, ValueError) as reason:
        return _without(names, Status.unresolved, str(reason) or type(reason).__name__)
    if not (proof.v > 0 or (osc.plastic and RESTITUTION not in widths and proof.velocity < 0)):
        return _without(names, Status.unresolved, "the velocity after the impact is not shown positive")
    numbers = [from_ball(entry, wanted) for entry in proof[:4]]
    rows = tuple(tuple(from_ball(entry, wanted) for entry in row) for row in proof.derivative)
    if not all(entry.is_finite() for row in proof.derivative for entry in row):
        return _without(names, Status.unresolved, "D G is not bounded on the box")
    time, velocity, landed, after = numbers
    return EnclosedImpact(time, velocity, landed, after, rows, names, Status.hit)


def _without(names: tuple[str, ...], status: Status, note: str) -> EnclosedImpact:
    return EnclosedImpact(None, None, None, None, (), names, status, note)


def _radius(name: str, value: Any) -> Fraction:
    """At least the number written, which may be irrational."""
    tree = constant(f"radii[{name!r}]", value)
    known = as_fraction(tree)
    return rational_near(tree, 64) * Fraction(2**32 + 1, 2**32) if known is None else known


def _check(osc: Oscillator, radii: Mapping[str, Fraction]) -> None:
    known = ["tau", "v", CLEARANCE, *([] if names_in(osc.restitution) else [RESTITUTION]), *osc.parameters]
    for name, radius in radii.items():
        if name not in known:
            raise unknown("number", name, known)
        if radius < 0:
            raise InputError(f"radii[{name!r}] = {radius} is not accepted: give a radius of at least 0")
