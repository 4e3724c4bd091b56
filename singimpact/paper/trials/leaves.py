"""Orbits near a tangency with a' < 0 on two models: no jumps, chatter, and leaves followed backwards."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.contact.points import tangency_points
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.paper.trials import true_orbits


def places() -> list[tuple[str, ImpactOscillator, float, float]]:
    """(name, model, tau_*, k) at the first tangency with a' < 0."""
    found = []
    for name, oscillator in true_orbits.MODELS.items():
        model = ImpactOscillator(**oscillator.to_dict())
        tau = next(point.tau for point in tangency_points(model) if point.kind == "foliation")
        found.append((name, model, tau, float(model.acceleration(tau, order=1)) / 6))
    return found


@dataclass(frozen=True)
class Steps:
    """The number of neighbouring states compared, and the largest change of the flight time between them."""

    states: int
    largest: float


@lru_cache(maxsize=1)
def no_jumps() -> Steps:
    """Neighbouring flight times on a grid with |sigma| <= 0.05 and v up to 4 |k| sigma^2 at its corner."""
    states, largest = 0, 0.0
    for _, model, tau, k in places():
        sigma = np.linspace(-0.05, 0.05, 81)
        v = np.linspace(0, 4 * abs(k) * 0.05**2, 61)[1:]
        times = np.asarray(model.impact_map((tau + sigma)[:, None], v[None, :]).flight_time)
        states += times.size
        largest = max(largest, float(np.abs(np.diff(times, axis=0)).max()), float(np.abs(np.diff(times, axis=1)).max()))
    return Steps(states, largest)


@dataclass(frozen=True)
class Iterates:
    """Largest v over arcs after some impacts, as a part of its start; the factor of the last impacts."""

    count: int
    last: float
    factor: float


@lru_cache(maxsize=1)
def iterates() -> Iterates:
    """Arcs p(t = l sigma), 0 < sigma <= 0.05, for l = 0.1, 0.5, 2, followed together."""
    count, last, factor = 40, 0.0, 0.0
    for _, model, point, k in places():
        for ell in (0.1, 0.5, 2.0):
            sigma = np.linspace(0.002, 0.05, 25)
            tau, v = point + sigma, -k * (3 * ell + ell**2) * sigma**2
            start, sizes = v.max(), []
            for _ in range(count):
                step = model.impact_map(tau, v)
                tau, v = np.asarray(step.tau), np.asarray(step.v)
                sizes.append(float(v.max()))
            last = max(last, sizes[-1] / start)
            factor = max(factor, sizes[-1] / sizes[-2])
    return Iterates(count, last, factor)


@dataclass(frozen=True)
class Leaf:
    """A leaf from its foot tau_* + foot on Pi_0 backwards to tau_* + end on Pi_0."""

    name: str
    foot: float
    end: float


@lru_cache(maxsize=1)
def ends() -> tuple[Leaf, ...]:
    """Launch from rest at tau_* + end, end < 0, where a > 0; chatter comes to rest at the foot of the leaf."""
    rows = []
    for name, model, point, _ in places():
        r = as_float(model.restitution)
        for end in (-0.04, -0.02, -0.01):
            tau, v = point + end, 0.0
            for _ in range(400):
                step = model.impact_map(tau, v)
                tau, v = float(step.tau), float(step.v)
                if v < 1e-13:
                    break
            rest = tau - 2 * v / (float(model.acceleration(tau)) * (1 - r))
            rows.append(Leaf(name, rest - point, end))
    return tuple(rows)
