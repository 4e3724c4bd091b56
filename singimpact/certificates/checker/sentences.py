"""The sentence of a certificate, as the programs print it: every number with its radius, a bound at its outer end."""

from fractions import Fraction
from typing import Any


def number(written: dict[str, str]) -> str:
    """A number with its radius."""
    return f"{written['value']} +- {written['radius']}"


def below(written: dict[str, str], digits: int = 12) -> str:
    """A decimal that is no larger than any number of a ball."""
    least = (Fraction(written["value"]) - Fraction(written["radius"])) * 10**digits // 1
    return f"{least // 10**digits}.{least % 10**digits:0{digits}d}"


def sentence(content: dict[str, Any]) -> str:
    """The statement of a certificate as a sentence."""
    return SENTENCES[content["statement"]](content)


def states(content: dict[str, Any]) -> str:
    shown = ", ".join(f"({number(each['tau'])}, {number(each['v'])})" for each in content["states"])
    return f"(tau, v) = {shown}"


def launch(content: dict[str, Any]) -> str:
    return f"({content['launch']['tau']}, {content['launch']['v']})"


def first_impact(content: dict[str, Any]) -> str:
    return f"the first impact from {launch(content)}: tau = {number(content['tau'])}, v = {number(content['v'])}"


def periodic_orbit(content: dict[str, Any]) -> str:
    which = f"({len(content['states'])}, {content['periods']})"
    return f"the {which} periodic orbit, alone within {content['unique_within']}: {states(content)}"


def chatter_limit(content: dict[str, Any]) -> str:
    return f"the chatter limit from {launch(content)}: {content['ends']} at tau = {number(content['tau'])}"


def horseshoe(content: dict[str, Any]) -> str:
    short, long = content["loops"]
    return f"a horseshoe: loops of {short} and {long} impacts, entropy >= {below(content['entropy'])}"


def event(content: dict[str, Any]) -> str:
    """The impacts of an orbit that touches the wall do not count the touch."""
    impacts = len(content["states"]) - ("unique_within" in content)
    alone = f", alone within {content['unique_within']}" if "unique_within" in content else ""
    number_of = f"{content['over']} = {number(content['parameter'])}"
    return f"a {content['kind']}: {number_of}, of an orbit of {impacts} impacts in {content['periods']} periods{alone}"


def border_orbit(content: dict[str, Any]) -> str:
    return (
        f"a border orbit: {content['over']} = {number(content['parameter'])}, "
        f"from tau = {content['release']} to {content['end']}, chatter completes {content['completes']}"
    )


def invariant_arc(content: dict[str, Any]) -> str:
    model = content["restitution"] == "model"
    which = f"r = {content['model']['restitution']}" if model else f"all r in {content['restitution']}"
    return f"gamma before tau_* = {number(content['tau'])}: {which}, S <= {content['reach']}"


SENTENCES = {
    "first impact": first_impact,
    "periodic orbit": periodic_orbit,
    "chatter limit": chatter_limit,
    "horseshoe": horseshoe,
    "event": event,
    "border orbit": border_orbit,
    "invariant arc": invariant_arc,
}
