"""Periodic orbits of one impact in each period, and grazes of their branches, against closed forms."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import Any

from singimpact.bench.stress.judging import Function, Trial, moved, powers
from singimpact.branches.branch import branch
from singimpact.branches.event_curve import event_curve
from singimpact.branches.events import GRAZE
from singimpact.impact_oscillator import linear


def _periodic(place: str, points: int) -> Iterator[Trial]:
    for off in powers(max(points // 3, 2), 6):
        for side in (1,) if place == "r -> 1" else (1, -1):
            omega, clearance, r = (2.0, 0.3, 1 - off) if place == "r -> 1" else (1 + side * off, -0.5, 0.8)
            for orbit in linear(omega, clearance, r).periodic(1, 1):
                found = [float(orbit.tau[0]), float(orbit.v[0])]
                values, rounding = moved(partial(_closed_form, found), [omega, clearance, r])
                state = f"omega = {omega!r}, clearance = {clearance!r}, restitution = {r!r}"
                yield Trial(state, found, values, rounding)


def _closed_form(near: list[float], omega: Any, c: Any, r: Any) -> list[Any]:
    """tau and v of the orbit that is near: the flight A cos t + B sin t + alpha cos(omega (tau + t)) ends as it began.

    alpha omega sin(omega tau) = v (1 - r)/(2 r),  c - alpha cos(omega tau) = v (1 + r)/(2 r tan(T/2)),  T = 2 pi/omega
    """
    import mpmath

    alpha = 1 / (1 - omega**2)
    across, along = (1 - r) / (2 * r * omega), (1 + r) / (2 * r * mpmath.tan(mpmath.pi / omega))
    # (across v)^2 + (c - along v)^2 = alpha^2
    half, rest = c * along / (across**2 + along**2), (c**2 - alpha**2) / (across**2 + along**2)
    root = mpmath.sqrt(half**2 - rest)
    v = min((half + root, half - root), key=lambda each: abs(each - near[1]))
    phase = mpmath.atan2(across * v / alpha, (c - along * v) / alpha) / omega
    turn = 2 * mpmath.pi / omega
    return [phase + turn * mpmath.nint((near[0] - phase) / turn), v]


def _grazes(name: str, curve: bool, points: int) -> Iterator[Trial]:
    """The graze on the branch of (1, 1) orbits of x'' + x'/10 + x = A cos(omega t): A = |1 - omega^2 + i omega/10|."""
    for off in powers(max(points // 3, 2), 6):
        omega, r, near = {
            "v -> 0": (0.8, 0.8, off),
            "omega -> 1": (1 + off / 8, 0.8, 1e-3),
            "r -> 1": (0.8, 1 - off, 1e-3),
            "r -> 0": (0.8, off, 1e-3),
        }[name]
        touching = -math.hypot(1 - omega**2, 0.1 * omega)
        orbits = linear(omega, -1, r, damping=0.1, amplitude=touching * (1 + near)).periodic(1, 1)
        for orbit in orbits:
            grazes = branch(orbit, "amplitude", (1.2 * touching, 0.8 * touching))
            for event in grazes.events:
                if event.kind != GRAZE.name:
                    continue
                place_of = f"omega = {omega!r}, restitution = {r!r}"
                number, value = omega, event.parameter
                if curve:
                    spread = ((1.2 * touching, 0.8 * touching), (omega - 0.02, omega + 0.02))
                    at = event_curve(event, ("amplitude", "omega"), spread).parameters[-1]
                    number, value = float(at[1]), float(at[0])
                values, rounding = moved(_touching, [number, 0.1])
                yield Trial(place_of, [value], values, rounding)


def _touching(omega: Any, damping: Any) -> list[Any]:
    import mpmath

    return [-mpmath.sqrt((1 - omega**2) ** 2 + (damping * omega) ** 2)]


BRANCHES = ("v -> 0", "omega -> 1", "r -> 0", "r -> 1")
GRAZES = "its grazes are judged, which have no other states"
FUNCTIONS = (
    Function(
        "periodic",
        {place: partial(_periodic, place) for place in ("omega -> 1", "r -> 1")},
        "closed form",
        "its states are answers, not given",
    ),
    Function("branch", {place: partial(_grazes, place, False) for place in BRANCHES}, "closed form", GRAZES),
    Function(
        "event_curve",
        {place: partial(_grazes, place, True) for place in BRANCHES if place != "omega -> 1"},
        "closed form",
        GRAZES,
    ),
)
