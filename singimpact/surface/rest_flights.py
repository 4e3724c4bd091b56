"""Flights launched at rest: Z is where they cross x = c again, and every other curve follows from them.

    F(tau, t) = x(t) - c for the flight from (c, 0) at tau,   y = F/t^2,   y(tau, 0) = a_c(tau)/2

t may be negative: the flight that ends at rest, run back.  y removes the launch itself, which is a double zero.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import evaluate
from singimpact.algebra.numbers import Array, as_float
from singimpact.algebra.rings import DOUBLES
from singimpact.contact.contact import acceleration
from singimpact.flights.flight_path import ends, many_paths
from singimpact.flights.inverse_map import backwards
from singimpact.flights.response import variations
from singimpact.oscillator.model import Oscillator


@dataclass
class RestFlights:
    """Flights of a model that start at rest, counted.

    Attributes
    ----------
    model : the oscillator. flown : flights computed so far.
    """

    model: Oscillator
    flown: int = 0
    _acceleration: Any = field(init=False, repr=False)
    _slope: Any = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self._acceleration = acceleration(self.model)
        self._slope = derivative(self._acceleration, "t")

    def acceleration(self, tau: Array) -> Array:
        """a_c(tau)."""
        return np.asarray(evaluate(self._acceleration, {"t": tau}, DOUBLES) + 0.0 * tau)

    def grid(self, tau: Array, t: Array) -> Array:
        """y at all pairs, shape (len(t), len(tau)); t increasing, 0 may be among them."""
        heights = np.empty((len(t), len(tau)))
        heights[t == 0] = self.acceleration(tau) / 2
        for side in (np.flatnonzero(t > 0), np.flatnonzero(t < 0)[::-1]):
            if side.size:
                self.flown += len(tau)
                paths = many_paths(self.model, tau, np.zeros(len(tau)), [t[side]] * len(tau))
                heights[side] = np.array([path[:, 0] for path in paths]).T / (t[side] ** 2)[:, None]
        return heights

    def ends(self, tau: Array, t: Array) -> tuple[Array, Array]:
        """x - c and x' at time t of the flight from tau, one pair each."""
        self.flown += len(tau)
        return ends(self.model, tau, np.zeros(len(tau)), t)[:2]

    def by_speed(self, tau: Array, t: Array) -> Array:
        """Derivatives of x and x' at time t by the launch velocity, shape (n, 2)."""
        slopes = np.empty((len(tau), 2))
        for side, model, turn in ((t >= 0, self.model, 1), (t < 0, backwards(self.model), -1)):
            if side.any():
                at = np.abs(t[side])
                slopes[side] = variations(model, turn * tau[side], np.zeros(at.size), at)[:, :2] * [turn, 1]
        return slopes

    def rest_matrix(self, tau: Array, t: Array, velocity: Array) -> Array:
        """The derivative of (F, x') by (tau, t) for one flight, shape (2, 2)."""
        by_speed, push = self.by_speed(tau, t)[0], float(self.acceleration(tau)[0])
        state = {"x": as_float(self.model.clearance), "xdot": velocity[0], "t": tau[0] + t[0]}
        there = float(evaluate(self.model.forcing(), state, DOUBLES) - evaluate(self.model.force(), state, DOUBLES))
        return np.array([[velocity[0] - push * by_speed[0], velocity[0]], [there - push * by_speed[1], there]])

    def y_and_gradient(self, points: Array) -> tuple[Array, Array, Array, Array]:
        """y, its gradient by (tau, t), x' and its gradient at points; at t = 0 by their limits, where a_c = 0."""
        tau, t = points.T
        there = t != 0
        y, gradient, velocity = self.acceleration(tau) / 2, np.empty((len(t), 2)), np.zeros(len(t))
        bend = np.zeros((len(t), 2))
        slope = np.asarray(evaluate(self._slope, {"t": tau}, DOUBLES) + 0.0 * tau)
        gradient[:, 0], gradient[:, 1] = slope / 2, slope / 6
        tau, t = tau[there], t[there]
        self.flown += len(tau)
        height, velocity[there], late = ends(self.model, tau, np.zeros(len(tau)), t)
        push, by_speed = self.acceleration(tau), self.by_speed(tau, t)
        # the launch moved at rest is a launch with -a
        by_tau = velocity[there] - push * by_speed[:, 0]
        bend[there] = np.stack([late - push * by_speed[:, 1], late], axis=1)
        y[there] = height / t**2
        gradient[there] = np.stack([by_tau / t**2, velocity[there] / t**2 - 2 * y[there] / t], axis=1)
        return y, gradient, velocity, bend
