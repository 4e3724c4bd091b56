"""Starts off the wall against free fall, and sums of Lyapunov exponents against the contraction rate of areas."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from singimpact.bench.stress.judging import Function, Trial, moved, powers
from singimpact.dynamics.lyapunov import lyapunov
from singimpact.impact_oscillator import ImpactOscillator, linear

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
    import mpmath

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
    import mpmath

    return [2 * impacts * mpmath.log(r) + mpmath.log(first / last) - time / 20]


FUNCTIONS = (
    Function(
        "launch",
        {place: partial(_launched, place) for place in ("t -> 0", "r -> 0", "r -> 1")},
        "closed form",
        "its first impact is judged, of a fall; others are those of first_hit",
    ),
    Function(
        "lyapunov",
        {place: partial(_exponents, place) for place in ("omega -> 1", "r -> 1")},
        "closed form",
        "the sum of both is judged, along one orbit",
    ),
)
