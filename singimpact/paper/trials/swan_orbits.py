"""Orbits near a negative swan on two models: the cube root in F, the eigenvalue on gamma, where orbits come to rest."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache

import numpy as np
import sympy

from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.paper.trials import true_orbits
from singimpact.theory.homogeneous import eigenvalues_on_gamma, lambda_


@lru_cache(maxsize=1)
def cube_root() -> float:
    """d log t/d log v of the flight time on sigma = 0, from v = 1e-9 to 1e-12, at the swan of x'' + x = cos 2t."""
    step = linear(2, 1, "1/2").impact_map(0.0, [1e-9, 1e-12])
    return float(np.log(step.flight_time[0] / step.flight_time[1]) / np.log(1e3))


@dataclass(frozen=True)
class Eigenvalue:
    """The larger eigenvalue of DG on gamma: of the homogeneous model, and on true orbits in many digits."""

    expected: float
    found: float


@lru_cache(maxsize=1)
def eigenvalue() -> Eigenvalue:
    """From differences of the closed form at points of gamma at the swan of the linear model, extrapolated."""
    context, origin, clearance = true_orbits.many_digits(2)
    flow = true_orbits.closed_flow(Fraction(2), clearance, origin, context)
    r, rate = context.mpf(1) / 2, true_orbits.lambda_of(0.5, 2)
    start = context.mpf(10) ** -25
    target = context.mpf(10) ** -40
    orbit = true_orbits.backwards(flow, r, -start, start**3 * 0.2, rate, 3e-2, target)
    points = []
    for sigma, v in orbit[-5:]:
        h = context.mpf(10) ** -12
        columns = []
        for d_sigma, d_v in ((h * abs(sigma), 0), (0, h * v)):
            ends = []
            for sign in (1, -1):
                s, w = sigma + sign * d_sigma, v + sign * d_v
                t, slope = true_orbits.return_time(flow, s, w, s * (rate - 1), target)
                ends.append((s + t, -r * slope))
            columns.append([(ends[0][n] - ends[1][n]) / (2 * (d_sigma + d_v)) for n in (0, 1)])
        trace, determinant = (
            columns[0][0] + columns[1][1],
            columns[0][0] * columns[1][1] - columns[0][1] * columns[1][0],
        )
        points.append((sigma, (trace + context.sqrt(trace**2 - 4 * determinant)) / 2))
    expected = float(eigenvalues_on_gamma(2)[0].subs(lambda_, sympy.Float(rate, 30)))
    return Eigenvalue(expected, float(true_orbits.extrapolated(points)))


@dataclass(frozen=True)
class Fates:
    """Numbers of orbits followed and of those that left, and the largest a where the others came to rest."""

    count: int
    lost: int
    largest: float


@lru_cache(maxsize=1)
def fates() -> Fates:
    """From sigma in {-0.05, 0.02} and v at 0.2 to 5 times the height of gamma at |sigma|, at both models' swans."""
    count, lost, largest = 0, 0, -np.inf
    for oscillator in true_orbits.MODELS.values():
        at, contact = true_orbits.contact_model(oscillator, 2)
        model = ImpactOscillator(**at.to_dict())
        height = abs(float(model.acceleration(contact, order=2))) * 0.05**3 / 12
        for sigma in (-0.05, 0.02):
            tau, v = np.full(6, contact + sigma), height * np.array([0.2, 0.5, 0.8, 1.3, 2.0, 5.0])
            for _ in range(300):
                step = model.impact_map(tau, v)
                lost += int(np.count_nonzero(np.asarray(step.flight_time) > 1.0))
                tau, v = np.asarray(step.tau), np.asarray(step.v)
            count += len(v)
            largest = max(largest, float(np.max(model.acceleration(tau))))
            lost += int(np.count_nonzero(v > 1e-8 * height))
    return Fates(count, lost, float(largest))
