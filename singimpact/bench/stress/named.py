"""Numbers with a name: a_c, tangency and swan points, fixed points, points of an unfolded swan, vertices of curves."""

from collections.abc import Callable, Iterator
from dataclasses import fields
from functools import partial
from typing import Any

import mpmath
import numpy as np

from singimpact.bench.stress.judging import Judge, Trial, moved, powers
from singimpact.bench.stress.launches import Launch, both
from singimpact.contact.points import tangency_points
from singimpact.dynamics.unfolded_swan import swan_configuration
from singimpact.impact_oscillator import universal
from singimpact.paper.routes import unfolding
from singimpact.studies import swan_points
from singimpact.surface.impact_surface import ImpactSurface
from singimpact.theory import fixed_points


def _acceleration(place: str, points: int) -> Iterator[Trial]:
    """a_c, a_c' and a_c'' from the formula of g in 60 digits."""
    for launch in both(place, points):
        values, rounding = moved(partial(_derivatives, launch), [launch.tau])
        found = [float(launch.model.acceleration(launch.tau, order)) for order in range(3)]
        yield Trial(str(launch), found, values, rounding)


def _derivatives(launch: Launch, tau: Any) -> list[Any]:
    w, c = mpmath.mpf(launch.omega), mpmath.mpf(launch.clearance)
    pull = c if launch.family == "linear" else c + 3 * c**3 / 10
    cosine, sine = mpmath.cos(w * tau), mpmath.sin(w * tau)
    return [cosine - pull, -w * sine, -w * w * cosine]


def _tangency_points(name: str, points: int) -> Iterator[Trial]:
    for off in powers(points, 13):
        for family, clearance in (("linear", 1 - off), ("linear", off - 1), ("cubic", 0.8 - off)):
            launch = Launch(
                family, 1 + off if name == "omega -> 1" else 2.8, off if name == "omega -> 1" else clearance
            )

            def zeros(omega: Any, c: Any, family: str = family) -> list[Any]:
                angle = mpmath.acos(c if family == "linear" else c + 3 * c**3 / 10)
                return [angle / omega, (2 * mpmath.pi - angle) / omega]

            values, rounding = moved(zeros, [launch.omega, launch.clearance])
            yield Trial(str(launch), tangency_points(launch.model).tau.tolist(), values, rounding)


def _swan_points(_: str, points: int) -> Iterator[Trial]:
    """c_0 + k c_0^3 = 1 at tau = 0, and -1 at pi/omega."""
    for off in powers(points, 13):
        for omega in (1 + off, 1 - off):
            swans = swan_points("x + k*x**3", "cos(omega*t)", {"k": off, "omega": omega})

            def true(k: Any, w: Any) -> list[Any]:
                c = mpmath.findroot(lambda x: x + k * x**3 - 1, 1)
                return [mpmath.mpf(0), mpmath.pi / w, c, -c]

            values, rounding = moved(true, [off, omega])
            computed = [swan.tau for swan in swans] + [swan.clearance for swan in swans]
            yield Trial(f"k = {off!r}, omega = {omega!r}", computed, values, rounding)


def _fixed_points(at: str, place: str, points: int) -> Iterator[Trial]:
    for off in powers(points, 15):
        r = off if place == "r -> 0" else 1 - off
        found = getattr(fixed_points, at)(r)
        values, rounding = moved(partial(_numbers, at), [r])
        with mpmath.workdps(30):
            given = [float(getattr(found, field.name).value) for field in fields(found)]
        yield Trial(f"r = {r!r}", given, values, rounding)


def _numbers(at: str, r: Any) -> list[Any]:
    """In the order of the fields, from the roots that mpmath finds of the paper's polynomials in lambda."""
    j = 1 if at == "tangency" else 2
    p = [mpmath.mpf(j + 1 - i) for i in range(j + 1)]  # of P, constant term first; Q is its reversal
    coefficients = [*reversed(p), *(mpmath.mpf(0) for _ in range(j + 1))]
    for i in range(j + 1):
        coefficients[2 * j + 1 - i] -= r * p[j - i]
    roots = mpmath.polyroots(coefficients, maxsteps=500, extraprec=600)
    real = sorted(mpmath.re(root) for root in roots if abs(mpmath.im(root)) < mpmath.mpf(10) ** -40)
    lam = real[-1]
    above, below = (mpmath.polyval(polynomial, lam) for polynomial in (p[::-1], p))
    mu = (above / below) ** 2 / lam
    if j == 2:
        return [lam - 1, lam, mu, 1 - lam, mu - 1]
    half = mpmath.mpf(1) / 2
    root = mpmath.sqrt(r * r + 4 * r * (2 * r + mpmath.mpf(9) / 4))
    outer = [(r + side * root) / (2 * (2 * r + mpmath.mpf(9) / 4)) + half for side in (-1, 1)]
    return [real[0] + half, real[1] + half, lam + half, lam, mu, *outer, 1 - lam, mu - 1]


def _swan_configuration(_: str, points: int) -> Iterator[Trial]:
    """A to E of x'' = 12 kappa (t^2 - 1), which are algebraic."""
    with mpmath.workdps(60):
        truth = [mpmath.mpf(str(part.evalf(60))) for name in "ABCDE" for part in getattr(unfolding, name)]
    for kappa in [-1.0, *(-off for off in powers(max(points // 4, 2), 6))]:
        found = swan_configuration(universal(kappa, "0.5")).points
        given = np.ravel([found[name] for name in "ABCDE"]).tolist()
        yield Trial(f"kappa = {kappa!r}", given, truth, [1 + abs(value) for value in truth])


# Vertices of the zero set and of the outline against the closed form of the flight from rest, solved in mpmath.

Spot = tuple[Launch, tuple[float, float], tuple[float, float]]  # a model, and the windows of tau and t that are traced
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

    def height(value: Any) -> Any:
        tau, t = place(value)
        return _flight(omega, c, tau, t)[0] / t**2

    return mpmath.findroot(height, mpmath.mpf(near), solver="newton", tol=mpmath.mpf(10) ** -100)


def _slope(launch: Launch, vertex: list[float], which: int) -> float:
    """dy/dtau or dy/dt, y = (x - c)/t^2."""
    with mpmath.workdps(60):
        c, omega = mpmath.mpf(launch.clearance), mpmath.mpf(launch.omega)
        point = [mpmath.mpf(value) for value in vertex]

        def height(value: Any) -> Any:
            tau, t = (value, point[1]) if which == 0 else (point[0], value)
            return _flight(omega, c, tau, t)[0] / t**2

        return float(mpmath.diff(height, point[which]))


def _flight(omega: Any, c: Any, tau: Any, t: Any) -> tuple[Any, Any]:
    """x - c and x' at t after rest at tau, of x'' + x = cos(omega t)."""
    size = 1 / (1 - omega**2)
    start, rate = c - size * mpmath.cos(omega * tau), omega * size * mpmath.sin(omega * tau)
    at = omega * (tau + t)
    x = size * mpmath.cos(at) + start * mpmath.cos(t) + rate * mpmath.sin(t)
    return x - c, -omega * size * mpmath.sin(at) - start * mpmath.sin(t) + rate * mpmath.cos(t)


JUDGES: dict[str, Judge] = {
    "acceleration": _acceleration,
    "tangency_points": _tangency_points,
    "swan_points": _swan_points,
    "fixed_points.tangency": partial(_fixed_points, "tangency"),
    "fixed_points.swan": partial(_fixed_points, "swan"),
    "swan_configuration": _swan_configuration,
    "zero_set": partial(_judged, False),
    "outline": partial(_judged, True),
}
