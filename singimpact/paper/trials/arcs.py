"""The impact map of the package near tangency and swan points: eigenvalues on gamma, lift-off, leaves."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import numpy as np
import sympy

from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.paper.trials import true_orbits
from singimpact.paper.trials.true_sheet import Place, foliated, tangencies
from singimpact.theory.multipliers import eigenvalues_on_gamma, lambda_


def _on_gamma(place: Place) -> list[tuple[float, float]]:
    """Points of gamma up to sigma = -0.02, found by following G backwards."""
    flow = true_orbits.scipy_flow(place.model, place.tau)
    start = true_orbits.SETTINGS.start[0]
    return true_orbits.backwards(flow, place.r, -start, place.coefficient * start**2, place.multiplier, 0.02)


@dataclass(frozen=True)
class EigenvalueCase:
    """The larger eigenvalue of DG at points of gamma, extrapolated to w_*."""

    name: str
    r: float
    found: float


@lru_cache(maxsize=1)
def eigenvalues() -> tuple[EigenvalueCase, ...]:
    """From differences of the impact map at points of gamma on both models."""
    return tuple(EigenvalueCase(point.name, point.r, _limiting_eigenvalue(point)) for point in tangencies())


def _limiting_eigenvalue(point: Place) -> float:
    def image(sigma: float, v: float) -> tuple[float, float]:
        step = point.model.impact_map(point.tau + sigma, v)
        return float(step.tau), float(step.v)

    return _extrapolated_eigenvalue(image, _on_gamma(point)[-4:], 1e-5)


def _extrapolated_eigenvalue(image: Callable[[Any, Any], Any], points: list[tuple[Any, Any]], step: Any) -> float:
    """The larger eigenvalue of a map at points, by central differences in proportion to sigma and v, at sigma = 0."""
    values = []
    for sigma, v in points:
        columns = []
        for d_sigma, d_v in ((step * abs(sigma), 0), (0, step * v)):
            ends = image(sigma + d_sigma, v + d_v), image(sigma - d_sigma, v - d_v)
            columns.append([(ahead - behind) / (2 * (d_sigma + d_v)) for ahead, behind in zip(*ends, strict=True)])
        (a, c), (b, d) = columns
        values.append((sigma, (a + d + ((a - d) ** 2 + 4 * b * c) ** 0.5) / 2))
    return float(true_orbits.extrapolated(values))


LIFT_OFF = {
    "x'' + x = sin 2t": ("x", "sin(2*t)"),
    "damped Duffing, sin 1.7t": ("x + 0.1*xdot + 0.3*x**3", "sin(1.7*t)"),
}


@lru_cache(maxsize=1)
def lift_off() -> tuple[tuple[str, float], ...]:
    """(model, flight time) of the first hit from (tau_*, 0), on models for which tau_* = 0 is a double exactly."""
    models = {name: ImpactOscillator(f, g, 0, "0.5") for name, (f, g) in LIFT_OFF.items()}
    return tuple((name, float(model.impact_map(0.0, 0.0).flight_time)) for name, model in models.items())


# Orbits near a negative swan on two models: the cube root in F, the eigenvalue on gamma, where orbits come to rest.


@lru_cache(maxsize=1)
def cube_root() -> float:
    """d log t/d log v of the flight time on sigma = 0, from v = 1e-9 to 1e-12, at the swan of x'' + x = cos 2t."""
    step = linear(2, 1, "1/2").impact_map(0.0, [1e-9, 1e-12])
    return float(np.log(step.flight_time[0] / step.flight_time[1]) / np.log(1e3))


@lru_cache(maxsize=1)
def eigenvalue() -> tuple[float, float]:
    """The larger eigenvalue of DG on gamma at the swan of the linear model: of the homogeneous one, and on true orbits.

    The second is extrapolated from differences of the closed form at points of gamma in many digits.
    """
    context, origin, clearance = true_orbits.many_digits(2)
    flow = true_orbits.closed_flow(Fraction(2), clearance, origin, context)
    r, rate = context.mpf(1) / 2, true_orbits.lambda_of(0.5, 2)
    start = context.mpf(10) ** -25
    target = context.mpf(10) ** -40
    orbit = true_orbits.backwards(flow, r, -start, start**3 * 0.2, rate, 3e-2, target)

    def image(s: Any, v: Any) -> tuple[Any, Any]:
        t, slope = true_orbits.return_time(flow, s, v, s * (rate - 1), target)
        return s + t, -r * slope

    expected = float(eigenvalues_on_gamma(2)[0].subs(lambda_, sympy.Float(rate, 30)))
    return expected, _extrapolated_eigenvalue(image, orbit[-5:], context.mpf(10) ** -12)


# Orbits near a tangency with a' < 0 on two models: no jumps, chatter, and leaves followed backwards.


@dataclass(frozen=True)
class Leaf:
    """A leaf from its foot tau_* + foot on Pi_0 backwards to tau_* + end on Pi_0."""

    name: str
    foot: float
    end: float


@lru_cache(maxsize=1)
def leaves() -> tuple[Leaf, ...]:
    """Launch from rest at tau_* + end, end < 0, where a > 0; chatter comes to rest at the foot of the leaf."""
    ends, cases = np.array([-0.04, -0.02, -0.01]), []
    for point in foliated():
        feet = true_orbits.resting_times(point.model, point.tau + ends, np.zeros(3), 400, 1e-13) - point.tau
        cases += [Leaf(point.name, *pair) for pair in zip(feet.tolist(), ends.tolist(), strict=True)]
    return tuple(cases)
