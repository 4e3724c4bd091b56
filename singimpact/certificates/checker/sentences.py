"""The sentence of a certificate, as the programs print it: every number with its radius, a bound at its outer end."""

from __future__ import annotations

from fractions import Fraction
from typing import Any


def number(told: dict[str, str]) -> str:
    """A number with its radius."""
    return f"{told['value']} +- {told['radius']}"


def below(told: dict[str, str], digits: int = 12) -> str:
    """A decimal that is no larger than any number of a ball."""
    least = (Fraction(told["value"]) - Fraction(told["radius"])) * 10**digits // 1
    return f"{least // 10**digits}.{least % 10**digits:0{digits}d}"


def sentence(told: dict[str, Any]) -> str:
    """The statement of a certificate as a sentence."""
    return SENTENCES[told["statement"]](told)


def states(told: dict[str, Any]) -> str:
    shown = ", ".join(f"({number(each['tau'])}, {number(each['v'])})" for each in told["states"])
    return f"(tau, v) = {shown}"


def launch(told: dict[str, Any]) -> str:
    return f"({told['launch']['tau']}, {told['launch']['v']})"


def first_impact(told: dict[str, Any]) -> str:
    return f"the first impact from {launch(told)}: tau = {number(told['tau'])}, v = {number(told['v'])}"


def periodic_orbit(told: dict[str, Any]) -> str:
    which = f"({len(told['states'])}, {told['periods']})"
    return f"the {which} periodic orbit, alone within {told['unique_within']}: {states(told)}"


def chatter_limit(told: dict[str, Any]) -> str:
    return f"the chatter limit from {launch(told)}: {told['ends']} at tau = {number(told['tau'])}"


def horseshoe(told: dict[str, Any]) -> str:
    short, long = told["loops"]
    return f"a horseshoe: loops of {short} and {long} impacts, entropy >= {below(told['entropy'])}"


def event(told: dict[str, Any]) -> str:
    """The impacts of an orbit that touches the wall do not count the touch."""
    impacts = len(told["states"]) - ("unique_within" in told)
    alone = f", alone within {told['unique_within']}" if "unique_within" in told else ""
    number_of = f"{told['over']} = {number(told['parameter'])}"
    return f"a {told['kind']}: {number_of}, of an orbit of {impacts} impacts in {told['periods']} periods{alone}"


def border_orbit(told: dict[str, Any]) -> str:
    return (
        f"a border orbit: {told['over']} = {number(told['parameter'])}, from tau = {told['release']} to {told['end']}, "
        f"chatter completes {told['completes']}"
    )


def invariant_arc(told: dict[str, Any]) -> str:
    model = told["restitution"] == "model"
    which = f"r = {told['model']['restitution']}" if model else f"all r in {told['restitution']}"
    return f"gamma before tau_* = {number(told['tau'])}: {which}, S <= {told['reach']}"


SENTENCES = {
    "first impact": first_impact, "periodic orbit": periodic_orbit, "chatter limit": chatter_limit,
    "horseshoe": horseshoe, "event": event, "border orbit": border_orbit, "invariant arc": invariant_arc,
}  # fmt: skip
