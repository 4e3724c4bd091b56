"""Periodic orbits of one impact a period, of x'' + x = cos(omega t), beside their closed form."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

from singimpact.bench.stress.judging import Function, Trial, moved, powers
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


FUNCTIONS = (
    Function("periodic", {place: partial(_periodic, place) for place in ("omega -> 1", "r -> 1")}, "closed form",
             "its states are answers, not given"),
)  # fmt: skip
