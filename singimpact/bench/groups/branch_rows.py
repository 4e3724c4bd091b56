"""`bench branches`: periodic orbits, their branches through grazes, and curves of events: each call with other numbers.

Grazes of x'' + x'/10 + x = A cos(omega t) and doublings of the bouncing ball are judged by their closed forms.
"""

import math
from collections.abc import Iterator
from functools import partial
from typing import Any

from singimpact.bench.measuring import Aim, Case, Counted, Effort, Method
from singimpact.branches.branch import branch
from singimpact.branches.event_curve import event_curve
from singimpact.branches.events import GRAZE, PERIOD_DOUBLING
from singimpact.impact_oscillator import ImpactOscillator, linear

MANY = 1000
"""Points of a branch; 200 of a curve of events."""


def cases(effort: Effort) -> Iterator[Case]:
    """Orbits of a linear model; a branch of it and of Duffing's oscillator, a point; a curve of doublings, a point."""
    calls = 2 if effort.quick else 5
    for n, k, aim in ((1, 1, 1e3), (2, 2, 3e5), (3, 3, 3e5), (4, 4, 3e5)):
        run = partial(_orbits, n, k)
        method = Method(
            "singimpact, periodic", f"n = {n}, k = {k}", run, problems=calls, draw=_Models(calls), aim=Aim(aim)
        )
        yield Case(f"linear, orbits of {n} impacts in {k} periods", [method])
    points = 200 if effort.quick else MANY
    truth = [-math.hypot(1 - 0.8**2, 0.08)]
    own = Method(
        "singimpact, branch", f"{points} points", partial(linear_branch, points), epsilon=1e-14, aim=Aim(1e6 / MANY)
    )
    yield Case("linear, a point of a branch through a graze", [own], truth, [1.0])
    duffing = Method("singimpact, branch", f"{points} points", partial(_duffing, points), aim=Aim(5e6 / MANY))
    yield Case("Duffing, a point of a branch", [duffing])
    curve = Method("singimpact, event_curve", "200 points", doubling_curve, epsilon=1e-13, aim=Aim(2e6 / 200))
    yield Case("bouncing ball, a point of a curve of doublings", [curve], [1.0], [1.0])


class _Models:
    """Models with another clearance in every call."""

    def __init__(self, count: int) -> None:
        self.count, self.drawn = count, 0

    def __call__(self) -> list[ImpactOscillator]:
        self.drawn += self.count
        return [linear("2.8", 0.1 + 1e-4 * (self.drawn + i), "0.8", amplitude=-1) for i in range(self.count)]


def _orbits(n: int, k: int, models: list[ImpactOscillator]) -> list[Any]:
    return [len(model.periodic(n, k)) for model in models]


def linear_branch(points: int) -> Counted:
    """The amplitude at the graze, and the points on both sides of it."""
    osc = linear("0.8", -1, "0.8", damping="0.1", amplitude="-0.4")
    found = branch(osc.periodic(1, 1)[0], "amplitude", (-0.6, -0.33), step=1.6 / points)
    return Counted(len(found), [event.parameter for event in found.events if event.kind == GRAZE.name])


def _duffing(points: int) -> Counted:
    osc = ImpactOscillator("x + 0.1*xdot + b*x**3", "cos(1.7*t)", "-0.3", "0.6", {"b": "0.3"})
    orbit = osc.periodic(1, 1, start=(2.12287, 1.16715))[0]
    return Counted(len(branch(orbit, "b", (0.1, 0.5), step=1.3 / points)), [])


def doubling_curve() -> Counted:
    """1, and the largest relative distance from the closed form of the doublings."""
    ball = ImpactOscillator("1", "G*cos(t)", 0, "0.5", {"G": "1.5"})
    orbits = [branch(orbit, "G", (1.4, 1.7)) for orbit in ball.periodic(1, 1)]
    (event,) = (event for family in orbits for event in family.events if event.kind == PERIOD_DOUBLING.name)
    curve = event_curve(event, ("G", "restitution"), ((0.5, 3.5), (0.1, 0.95)), step=0.012)
    off = 1.0
    for G, r in curve.parameters.tolist():
        truth = math.hypot(math.pi * (1 - r) / (1 + r), 2 * (1 + r * r) / (1 + r) ** 2)
        off = max(off, 1 + abs(G / truth - 1))
    return Counted(len(curve), [off])
