"""Which visible transition a negative swan of a linear model meets first, on ten models."""

from __future__ import annotations

from functools import cache

from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.claims.claim import Check, Statement, in_section
from singimpact.paper.claims.verifiers import every
from singimpact.surface.outline_transitions import transitions
from singimpact.surface.swan_families import Transition

claim = in_section("beyond")
MODELS = (
    ("x", "cos(2*t)"),
    ("x", "cos(3.3*t)"),
    ("x + 0.1*xdot", "cos(2.8*t)"),
    ("x + 0.1*xdot", "cos(3.6*t)"),
    ("x + 0.3*xdot", "cos(1.5*t)"),
    ("x + 0.1*xdot", "cos(2.8*t) + 0.2*cos(5.6*t + 1)"),
    ("x + 0.1*xdot", "cos(3.6*t) + 0.2*cos(7.2*t + 1)"),
    ("x + 0.2*xdot", "cos(4.4*t) + 0.1*cos(8.8*t + 2)"),
    ("x + 0.2*xdot", "cos(3.3*t) + 0.15*cos(6.6*t - 1)"),
    ("x + 0.05*xdot", "cos(2.2*t) + 0.22*cos(4.4*t + 1/2)"),
)
REACH = 10


@cache
def first_met(f: str, g: str) -> Transition:
    """The first visible transition below the highest negative swan over the clearance."""
    model = ImpactOscillator(f, g, 0, "1/2")
    found = transitions(model, "clearance", ("-1.2", "1.5"), (-REACH, REACH)).visible
    swan = max(each.value for each in found if each.kind == "swan, negative")
    return max((each for each in found if each.value < swan), key=lambda each: each.value)


def _kinds(stated: frozenset[str]) -> Check:
    """The kinds that are met first."""
    met = {f"x'' + {f} = {g}": first_met(f, g) for f, g in MODELS}
    kinds = {each.event for each in met.values()}
    told = ", ".join(f"{each.event} at {each.value:.6f}" for each in met.values())
    return every([(f"{len(met)} models: {told}", kinds == stated)], "supported")


CLAIMS = (
    claim(
        "b:events-met",
        "as c moves on from a negative swan of a linear oscillator, its arc first meets a tacnode, a tangency or a "
        "periodic graze, and never a triple point",
        Statement(
            r"\text{first visible: tacnode, tangency first, tangency last, tangency to tangency, periodic graze}",
            frozenset({"tacnode", "tangency first", "tangency last", "tangency to tangency", "periodic graze"}),
        ),
        _kinds,
        (
            frozenset({"tacnode", "tangency first", "tangency last", "periodic graze"}),
            frozenset({"tacnode", "tangency first", "tangency last", "tangency to tangency", "triple point"}),
        ),
        ("b:events-critical",),
    ),
)
