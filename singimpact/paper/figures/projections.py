"""p and phi at points of V' of a model that is linear in x: two flights give the launch velocity of any return."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.flights.flight_path import many_paths
from singimpact.oscillator.model import Oscillator

Array = np.ndarray[Any, Any]


def launch_and_landing(model: Oscillator, points: Array) -> tuple[Array, Array]:
    """v and x' at the return, of flights from tau that are back at c after t; 0 at t = 0.

    Examples
    --------
    >>> launch_and_landing(Oscillator("0", "-2", 0, 1), np.array([[0.0, 3.0], [1.0, 0.0]]))
    (array([3., 0.]), array([-3., -0.]))
    """
    tau, t = points.T
    times = [np.array([time if time else 1.0]) for time in t.tolist()]
    rest, fast = (
        np.array([path[0] for path in many_paths(model, tau, np.full(len(tau), v), times)]) for v in (0.0, 1.0)
    )
    v = np.where(t == 0, 0.0, -rest[:, 0] / (fast[:, 0] - rest[:, 0]))
    return v, np.where(t == 0, -0.0, rest[:, 1] + v * (fast[:, 1] - rest[:, 1]))


def projected(model: Oscillator, points: Array) -> Array:
    """p: (tau, t) -> (tau, v)."""
    return np.stack([points[:, 0], launch_and_landing(model, points)[0]], axis=1)


def reset(model: Oscillator, points: Array) -> Array:
    """phi: (tau, t) -> (tau + t, x')."""
    return np.stack([points.sum(axis=1), launch_and_landing(model, points)[1]], axis=1)


def rebounded(points: Array, restitution: float) -> Array:
    """R: (tau, x') -> (tau, -r x')."""
    return np.stack([points[:, 0], -restitution * points[:, 1] + 0.0], axis=1)
