"""Numbers with a name: a_c, tangency and swan points, fixed points, points of an unfolded swan, vertices of curves.

Starts off the wall, Lyapunov exponents, periodic orbits and grazes of their branches are judged against closed forms.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import fields
from functools import partial
from typing import Any

import mpmath
import numpy as np

from singimpact.bench.stress.judging import Judge, Launch, Trial, both, moved, powers
from singimpact.branches.branch import branch
from singimpact.branches.event_curve import event_curve
from singimpact.branches.events import GRAZE
from singimpact.contact.points import tangency_points
from singimpact.dynamics.lyapunov import lyapunov
from singimpact.dynamics.unfolded_swan import swan_configuration
from singimpact.impact_oscillator import ImpactOscillator, linear, universal
from singimpact.paper.routes import unfolding
from singimpact.studies import swan_points
from singimpact.surface.impact_surface import ImpactSurface
from singimpact.theory import fixed_points

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
        for orbit in linear(omega, -1, r, damping=0.1, amplitude=touching * (1 + near)).periodic(1, 1):
            for event in branch(orbit, "amplitude", (1.2 * touching, 0.8 * touching)).events:
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
    "launch": _launched,
    "lyapunov": _exponents,
    "periodic": _periodic,
    "branch": partial(_grazes, False),
    "event_curve": partial(_grazes, True),
    "acceleration": _acceleration,
    "tangency_points": _tangency_points,
    "swan_points": _swan_points,
    "fixed_points.tangency": partial(_fixed_points, "tangency"),
    "fixed_points.swan": partial(_fixed_points, "swan"),
    "swan_configuration": _swan_configuration,
    "zero_set": partial(_judged, False),
    "outline": partial(_judged, True),
}
