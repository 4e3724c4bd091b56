"""First hits with digits that are proved: by the closed form of a linear model, else by enclosures of its flights."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import ceil, inf
from typing import Any, NamedTuple

from singimpact.algebra.balls import BITS_A_DIGIT
from singimpact.algebra.certified import from_ball
from singimpact.algebra.expressions import Expression, evaluate
from singimpact.algebra.numbers import sign_of
from singimpact.algebra.precision import balls_at
from singimpact.flights.balls import linear_flow
from singimpact.flights.enclosures.certified_hit import ENCLOSURE, Launch, certified_hit
from singimpact.flights.enclosures.equation import NoHit, Refused, programs_of
from singimpact.flights.results import CertifiedImpact
from singimpact.flights.states import States
from singimpact.oscillator.linear import linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.nearest_zero import Zero

SPARE_BITS = (64, 320)  # beyond `digits`: in the first attempt, and for large phases and grazes, which lose more


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
    """What balls prove of a flight.

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
    if linear_form(osc) is not None and (found := _closed_form(osc, launch, rest, digits, horizon)) is not None:
        return _named(found, osc, launch)
    try:
        hit = certified_hit(
            osc, Launch(*launch, removed), digits, Fraction(horizon),
            steps=ENCLOSURE.idle_steps if rough is None else ENCLOSURE.steps, expected=_expected(rough),
        )  # fmt: skip
    except NoHit as none:
        return Proof(None, None, None, f"proved: {none}", missed=True)
    except (Refused, ArithmeticError, ValueError, TypeError) as reason:  # a ball that left the domain of a function
        return Proof(None, None, None, str(reason) or type(reason).__name__)
    return _named(_with_numbers((hit.flight_time, hit.velocity, hit.tau, hit.v), digits), osc, launch)


def _named(found: Proof, osc: Oscillator, launch: tuple[Expression, Expression]) -> Proof:
    """With the model and the launch, which a certificate names."""
    if found.impact is None:
        return found
    return found._replace(impact=replace(found.impact, oscillator=osc, launch=launch))


def _expected(rough: tuple[float, float] | None) -> tuple[float, float]:
    """Flight time and condition number of a hit from double precision, where it decides the flight."""
    if rough is None:
        return inf, 1.0
    time, condition = rough
    return (time, condition if condition > 1 else 1.0) if time > 0 else (0.0, 1.0)


def _with_numbers(balls: tuple[Any, Any, Any, Any], digits: int) -> Proof:
    time, velocity, _, v = balls
    if not v > 0:
        return Proof(time, velocity, None, "the velocity after the impact is not shown positive")
    flight_time, speed, tau, after = (from_ball(each, digits) for each in balls)
    return Proof(time, velocity, CertifiedImpact(flight_time, speed, tau, after))


def _closed_form(
    osc: Oscillator, launch: tuple[Expression, Expression], rest: Zero | None, digits: int, horizon: float
) -> Proof | None:
    """The first hit of a linear model, unless the flight is too long for one expansion or near a graze."""
    tau, v = launch
    rest = rest or Zero(tau, -1, 1)
    for bits in (ceil(digits * BITS_A_DIGIT) + spare for spare in SPARE_BITS):
        flow = linear_flow(osc, bits)
        if flow is None or rest.sign <= 0:
            return None
        with balls_at(bits):
            at, speed = (evaluate(tree, {}, flow.balls) for tree in (tau, v))
            hit = flow.first_hit(at, speed, flow.number(Fraction(horizon)), rest.order + 2)
            if hit is None:
                return None
            if hit.time is None:
                return Proof(None, None, None, f"proved: no hit comes before {horizon:.6g}", missed=True)
            bounce = programs_of(osc, ()).rho({"v": hit.velocity})[0]
            found = hit.time, hit.velocity, at + hit.time, bounce
        needed = (*found[:2], *([] if bounce.contains(0) else [bounce]))
        if all(part.rel_accuracy_bits() > digits * BITS_A_DIGIT + 4 for part in needed):
            return _with_numbers(found, digits)
    return None
