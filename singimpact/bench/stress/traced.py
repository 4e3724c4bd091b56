"""Vertices of the zero set and of the outline against the closed form of the flight from rest, solved in mpmath."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from singimpact.bench.stress.judging import Function, Trial, moved, powers
from singimpact.bench.stress.launches import Launch
from singimpact.surface.impact_surface import ImpactSurface

Spot = tuple[Launch, tuple[float, float], tuple[float, float]]
"""A model, and the windows of tau and t that are traced."""
NEAR: dict[str, Callable[[float], Spot]] = {
    "t -> 0": lambda off: (Launch("linear", clearance=0.5), (0.2, 0.6), (-off, off)),
    "omega -> 1": lambda off: (Launch("linear", omega=1 + off, clearance=0.5), (0.0, 6.0), (-3.0, 3.0)),
    "a' -> 0": lambda off: (
        Launch("linear", clearance=1 - off),
        (-2 * off**0.5, 2 * off**0.5),
        (-4 * off**0.5, 4 * off**0.5),
    ),
}
LAST = {"t -> 0": 6, "omega -> 1": 10, "a' -> 0": 8}
VERTICES, LEAST_TURN = 8, 0.1


def _judged(outline: bool, place: str, points: int) -> Iterator[Trial]:
    """Of Z one coordinate over the other is judged, of P v over the phase, except next to a cusp where P turns back."""
    for off in powers(min(points, 6), LAST[place]):
        launch, tau, t = NEAR[place](off)
        surface = ImpactSurface(launch.model, tau, t, 1 / 400)
        for line, image in zip(surface.zero_set, surface.outline, strict=True):
            for index in np.linspace(0, len(line) - 1, VERTICES).astype(int).tolist():
                vertex, landing = line.points[index].tolist(), image.points[index].tolist()
                if vertex[1] and not (outline and _turns(launch, vertex)):
                    yield _on_outline(launch, vertex, landing) if outline else _on_zero_set(launch, vertex)


def _turns(launch: Launch, vertex: list[float]) -> bool:
    """Whether the phase tau + t hardly changes along Z."""
    by_tau, by_t = _slope(launch, vertex, 0), _slope(launch, vertex, 1)
    return abs(by_t - by_tau) < LEAST_TURN * float(np.hypot(by_tau, by_t))


def _on_zero_set(launch: Launch, vertex: list[float]) -> Trial:
    steep = abs(_slope(launch, vertex, 0)) > abs(_slope(launch, vertex, 1))
    fixed, sought = (1, 0) if steep else (0, 1)

    def solved(omega: Any, c: Any, given: Any) -> list[Any]:
        def place(value: Any) -> tuple[Any, Any]:
            return (value, given) if steep else (given, value)

        return [_solved(omega, c, place, vertex[sought])]

    return Trial(
        _told(launch, vertex), [vertex[sought]], *moved(solved, [launch.omega, launch.clearance, vertex[fixed]])
    )


def _on_outline(launch: Launch, vertex: list[float], landing: list[float]) -> Trial:
    """v over the phase of the vertex."""

    def solved(omega: Any, c: Any, phase: Any) -> list[Any]:
        def place(t: Any) -> tuple[Any, Any]:
            return phase - t, t

        return [_flight(omega, c, *place(_solved(omega, c, place, vertex[1])))[1]]

    return Trial(_told(launch, vertex), [landing[1]], *moved(solved, [launch.omega, launch.clearance, landing[0]]))


def _told(launch: Launch, vertex: list[float]) -> str:
    return f"omega = {launch.omega!r}, clearance = {launch.clearance!r}, tau = {vertex[0]!r}, t = {vertex[1]!r}"


def _solved(omega: Any, c: Any, place: Callable[[Any], tuple[Any, Any]], near: float) -> Any:
    """The value beside a double whose place is on Z."""
    import mpmath

    def height(value: Any) -> Any:
        tau, t = place(value)
        return _flight(omega, c, tau, t)[0] / t**2

    return mpmath.findroot(height, mpmath.mpf(near), solver="newton", tol=mpmath.mpf(10) ** -100)


def _slope(launch: Launch, vertex: list[float], which: int) -> float:
    """dy/dtau or dy/dt, y = (x - c)/t^2."""
    import mpmath

    with mpmath.workdps(60):
        c, omega = mpmath.mpf(launch.clearance), mpmath.mpf(launch.omega)
        point = [mpmath.mpf(value) for value in vertex]

        def height(value: Any) -> Any:
            tau, t = (value, point[1]) if which == 0 else (point[0], value)
            return _flight(omega, c, tau, t)[0] / t**2

        return float(mpmath.diff(height, point[which]))


def _flight(omega: Any, c: Any, tau: Any, t: Any) -> tuple[Any, Any]:
    """x - c and x' at t after rest at tau, of x'' + x = cos(omega t)."""
    import mpmath

    size = 1 / (1 - omega**2)
    start, rate = c - size * mpmath.cos(omega * tau), omega * size * mpmath.sin(omega * tau)
    at = omega * (tau + t)
    x = size * mpmath.cos(at) + start * mpmath.cos(t) + rate * mpmath.sin(t)
    return x - c, -omega * size * mpmath.sin(at) - start * mpmath.sin(t) + rate * mpmath.cos(t)


FORMULA, ALONE = (
    "the closed form in mpmath",
    "curves of a model: no launch velocity, no r; v of the outline at the flight's end",
)
FUNCTIONS = (
    Function("zero_set", {place: partial(_judged, False, place) for place in NEAR}, FORMULA, ALONE),
    Function("outline", {place: partial(_judged, True, place) for place in NEAR}, FORMULA, ALONE),
)
