"""Numbers with a name: a_c, tangency and swan points, fixed points, the points of an unfolded swan."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from functools import partial
from typing import Any

import numpy as np

from singimpact.bench.stress.judging import Function, Trial, moved, powers
from singimpact.bench.stress.launches import Launch, both
from singimpact.contact.points import tangency_points
from singimpact.dynamics.unfolded_swan import swan_configuration
from singimpact.impact_oscillator import universal
from singimpact.paper.routes import unfolding
from singimpact.studies import swan_points
from singimpact.theory import fixed_points


def _acceleration(place: str, points: int) -> Iterator[Trial]:
    """a_c, a_c' and a_c'' from the formula of g in 60 digits."""
    for launch in both(place, points):
        values, rounding = moved(partial(_derivatives, launch), [launch.tau])
        found = [float(launch.model.acceleration(launch.tau, order)) for order in range(3)]
        yield Trial(str(launch), found, values, rounding)


def _derivatives(launch: Launch, tau: Any) -> list[Any]:
    import mpmath

    w, c = mpmath.mpf(launch.omega), mpmath.mpf(launch.clearance)
    pull = c if launch.family == "linear" else c + 3 * c**3 / 10
    cosine, sine = mpmath.cos(w * tau), mpmath.sin(w * tau)
    return [cosine - pull, -w * sine, -w * w * cosine]


def _tangency_points(name: str, points: int) -> Iterator[Trial]:
    import mpmath

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
    import mpmath

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
    import mpmath

    for off in powers(points, 15):
        r = off if place == "r -> 0" else 1 - off
        found = getattr(fixed_points, at)(r)
        values, rounding = moved(partial(_numbers, at), [r])
        with mpmath.workdps(30):
            given = [float(getattr(found, field.name).value) for field in fields(found)]
        yield Trial(f"r = {r!r}", given, values, rounding)


def _numbers(at: str, r: Any) -> list[Any]:
    """In the order of the fields, from the roots that mpmath finds of the paper's polynomials in lambda."""
    import mpmath

    j = 1 if at == "tangency" else 2
    p = [mpmath.mpf(j + 1 - i) for i in range(j + 1)]  # of P, constant term first; Q is its reversal
    coefficients = [*reversed(p), *(mpmath.mpf(0) for _ in range(j + 1))]
    for i in range(j + 1):
        coefficients[2 * j + 1 - i] -= r * p[j - i]
    roots = mpmath.polyroots(coefficients, maxsteps=500, extraprec=600)
    real = sorted(mpmath.re(root) for root in roots if abs(mpmath.im(root)) < mpmath.mpf(10) ** -40)
    lam = real[-1]
    above, below = (mpmath.polyval(part, lam) for part in (p[::-1], p))
    mu = (above / below) ** 2 / lam
    if j == 2:
        return [lam - 1, lam, mu, 1 - lam, mu - 1]
    half = mpmath.mpf(1) / 2
    root = mpmath.sqrt(r * r + 4 * r * (2 * r + mpmath.mpf(9) / 4))
    outer = [(r + side * root) / (2 * (2 * r + mpmath.mpf(9) / 4)) + half for side in (-1, 1)]
    return [real[0] + half, real[1] + half, lam + half, lam, mu, *outer, 1 - lam, mu - 1]


def _swan_configuration(_: str, points: int) -> Iterator[Trial]:
    """A to E of x'' = 12 kappa (t^2 - 1), which are algebraic."""
    import mpmath

    with mpmath.workdps(60):
        truth = [mpmath.mpf(str(part.evalf(60))) for name in "ABCDE" for part in getattr(unfolding, name)]
    for kappa in [-1.0, *(-off for off in powers(max(points // 4, 2), 6))]:
        found = swan_configuration(universal(kappa, "0.5")).points
        given = np.ravel([found[name] for name in "ABCDE"]).tolist()
        yield Trial(f"kappa = {kappa!r}", given, truth, [1 + abs(value) for value in truth])


FORMULA = "the formula in mpmath"
FUNCTIONS = (
    Function(
        "acceleration",
        {place: partial(_acceleration, place) for place in ("omega -> 1", "a -> 0", "a' -> 0", "huge tau")},
        FORMULA,
        "takes tau alone: no v, no flight, no r",
    ),
    Function(
        "tangency_points",
        {place: partial(_tangency_points, place) for place in ("omega -> 1", "a' -> 0")},
        FORMULA,
        "takes a model alone: no state, no flight, no r",
    ),
    Function(
        "swan_points",
        {"omega -> 1": partial(_swan_points, "omega -> 1")},
        FORMULA,
        "a' = 0 there always; takes f and g alone: no state, no flight, no r",
    ),
    *(
        Function(
            f"fixed_points.{at}",
            {place: partial(_fixed_points, at, place) for place in ("r -> 0", "r -> 1")},
            "roots by mpmath",
            "takes r alone",
        )
        for at in ("tangency", "swan")
    ),
    Function(
        "swan_configuration",
        {"a' -> 0": partial(_swan_configuration, "a' -> 0")},
        "closed form of section 6",
        "points of one model: no state, no r",
    ),
)
