"""Starts off the wall, Lyapunov exponents, periodic orbits and grazes of their branches, against closed forms."""

import math
from collections.abc import Iterator
from functools import partial
from typing import Any

import mpmath

from singimpact.bench.stress.judging import Judge, Trial, moved, powers
from singimpact.branches.branch import branch
from singimpact.branches.event_curve import event_curve
from singimpact.branches.events import GRAZE
from singimpact.dynamics.lyapunov import lyapunov
from singimpact.impact_oscillator import ImpactOscillator, linear

# A start off the wall is judged against free fall, a sum of Lyapunov exponents against the contraction rate of areas.

IMPACTS = 300


def _launched(place: str, points: int) -> Iterator[Trial]:
    """x'' = -2: from x with x' the fall lasts (x' + sqrt(x'^2 + 4 x))/2."""
    for off in powers(points, 300 if place == "t -> 0" else 12):
        r = 1 - off if place == "r -> 1" else off if place == "r -> 0" else 0.5
        x, speed = (off, off**0.5) if place == "t -> 0" else (1.0, 0.3)
        found = ImpactOscillator("0", "-2", 0, r).launch(x, speed, 0.0)
        values, rounding = moved(_fall, [x, speed, r])
        state = f"x = {x!r}, xdot = {speed!r}, restitution = {r!r}"
        yield Trial(state, [float(found.flight_time), float(found.v)], values, rounding)


def _fall(x: Any, speed: Any, r: Any) -> list[Any]:
    root = mpmath.sqrt(speed**2 + 4 * x)
    return [(speed + root) / 2, r * root]


def _exponents(place: str, points: int) -> Iterator[Trial]:
    """Their sum over all impacts is 2 n ln r + ln(v_0/v_n) - damping T."""
    for off in powers(max(points // 4, 2), 5):
        r = 1 - off if place == "r -> 1" else 0.8
        omega = 1 + off if place == "omega -> 1" else 2.8
        found = lyapunov(linear(omega, "0.1", r, damping="0.05"), 0.3, 0.5, IMPACTS)
        shrinking = partial(_shrinking, found.impacts)
        values, rounding = moved(shrinking, [r, found.start[1], found.last[1], found.time])
        total = float(found.exponents.sum() * found.time)
        yield Trial(f"omega = {omega!r}, restitution = {r!r}", [total], values, rounding)


def _shrinking(impacts: int, r: Any, first: Any, last: Any, time: Any) -> list[Any]:
    return [2 * impacts * mpmath.log(r) + mpmath.log(first / last) - time / 20]


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
    alpha = 1 / (1 - omega**2)
    across, along = (1 - r) / (2 * r * omega), (1 + r) / (2 * r * mpmath.tan(mpmath.pi / omega))
    # (across v)^2 + (c - along v)^2 = alpha^2
    half, rest = c * along / (across**2 + along**2), (c**2 - alpha**2) / (across**2 + along**2)
    root = mpmath.sqrt(half**2 - rest)
    v = min((half + root, half - root), key=lambda each: abs(each - near[1]))
    phase = mpmath.atan2(across * v / alpha, (c - along * v) / alpha) / omega
    turn = 2 * mpmath.pi / omega
    return [phase + turn * mpmath.nint((near[0] - phase) / turn), v]


def _grazes(curve: bool, name: str, points: int) -> Iterator[Trial]:
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
                values, rounding = moved(lambda w, d: [-mpmath.sqrt((1 - w**2) ** 2 + (d * w) ** 2)], [number, 0.1])
                yield Trial(place_of, [value], values, rounding)


JUDGES: dict[str, Judge] = {
    "launch": _launched,
    "lyapunov": _exponents,
    "periodic": _periodic,
    "branch": partial(_grazes, False),
    "event_curve": partial(_grazes, True),
}
