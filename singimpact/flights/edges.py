"""D G where it is one-sided: at a graze, and at rest on the obstacle."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.flights.launch import States
from singimpact.flights.tangent import rebound_slope, touching
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

Array = np.ndarray[Any, Any]


def fill(osc: Oscillator, states: States, time: Array, status: Array, matrix: Array) -> None:
    """Put the one-sided derivatives of touching and resting states into `matrix`."""
    touch, rest = np.flatnonzero(status == Status.graze), np.flatnonzero(status == Status.sticks)
    if touch.size:
        matrix[touch] = _at_touch(*touching(osc, states.tau[touch], states.v[touch], time[touch]))
    if rest.size:
        matrix[rest] = _at_rest(osc, acceleration(osc, states.tau[rest]))


def _at_touch(by_tau: Array, by_v: Array) -> Array:
    """On the side that hits, T = T_0 - sqrt(2 depth/x'') and v' = r sqrt(2 depth x''), where depth falls with x."""
    with np.errstate(invalid="ignore"):
        steep = [np.where(part == 0, 0.0, np.sign(part) * np.inf) for part in (by_tau, by_v)]
    return np.stack([1 + steep[0], steep[1], -steep[0], -steep[1]], axis=-1).reshape(-1, 2, 2)


def _at_rest(osc: Oscillator, push: Array) -> Array:
    """From v > 0: G = (tau - 2 v/a + ..., r v + ...)."""
    slope = rebound_slope(osc, np.zeros(push.shape))
    with np.errstate(divide="ignore"):
        delay = np.where(push < 0, -2 / push, np.inf)
    one = np.ones(push.shape)
    return np.stack([one, delay, 0 * one, -slope], axis=-1).reshape(-1, 2, 2)
