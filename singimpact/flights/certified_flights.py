"""First hits with digits that are proved by enclosures of their flights."""

from __future__ import annotations

from fractions import Fraction
from math import inf
from typing import Any, NamedTuple

from singimpact.algebra.certified import from_ball
from singimpact.algebra.expressions import Expression
from singimpact.algebra.numbers import sign_of
from singimpact.flights.enclosures.certified_hit import ENCLOSURE, Launch, ProvedImpact, certified_hit
from singimpact.flights.enclosures.equation import NoHit, Refused
from singimpact.flights.results import CertifiedImpact
from singimpact.flights.states import States
from singimpact.oscillator.model import Oscillator


class Proof(NamedTuple):
    """Balls of the flight time and of x' at the first hit and what they certify; or None for all, and why.

    `impact` is None beside a hit whose rebound is not shown positive. `missed` : proved, no hit before the horizon.
    """

    flight_time: Any
    velocity: Any
    impact: CertifiedImpact | None
    reason: str = ""
    missed: bool = False


def proof(
    osc: Oscillator, states: States, index: int, digits: int, horizon: float, rough: tuple[float, float] | None
) -> Proof:
    """The proof of a flight in balls.

    Parameters
    ----------
    horizon : no hit is looked for beyond. rough : flight time and condition number of the velocity in doubles, None
        where they find no hit; they choose the first precision.

    Examples
    --------
    >>> osc = Oscillator("x + x**3", "cos(1.7*t)", "0.3", "1/2")
    >>> print(proof(osc, States.of(osc, "1.4", "0.6"), 0, 20, 60.0, None).impact.tau)
    2.2817511466168335788
    """
    rest, launch = states.rest.get(index), (states.exact_tau(index), states.exact_v(index))
    standing = rest is not None and sign_of(launch[1]) == 0
    if standing and rest is not None and rest.sign <= 0:
        return Proof(None, None, None, "the mass is at rest and does not leave the wall")
    removed = rest.order + 2 if standing and rest is not None else 1
    try:
        hit = certified_hit(
            osc,
            Launch(*launch, removed),
            digits,
            Fraction(horizon),
            steps=ENCLOSURE.idle_steps if rough is None else ENCLOSURE.steps,
            expected=_expected(rough),
        )
    except NoHit as none:
        return Proof(None, None, None, f"proved: {none}", missed=True)
    except (Refused, ArithmeticError, ValueError, TypeError) as reason:  # a ball that left the domain of a function
        return Proof(None, None, None, str(reason) or type(reason).__name__)
    return _certified(hit, digits, osc, launch)


def _expected(rough: tuple[float, float] | None) -> tuple[float, float]:
    """Flight time and condition number of a hit from double precision, where it decides the flight."""
    if rough is None:
        return inf, 1.0
    time, condition = rough
    return (time, condition if condition > 1 else 1.0) if time > 0 else (0.0, 1.0)


def _certified(hit: ProvedImpact, digits: int, osc: Oscillator, launch: tuple[Expression, Expression]) -> Proof:
    """The proof of a hit, with the model and the launch, which a certificate names."""
    if not hit.v > 0:
        return Proof(hit.flight_time, hit.velocity, None, "the velocity after the impact is not shown positive")
    time, velocity, tau, v = (from_ball(ball, digits) for ball in (hit.flight_time, hit.velocity, hit.tau, hit.v))
    return Proof(hit.flight_time, hit.velocity, CertifiedImpact(time, velocity, tau, v, osc, launch))
