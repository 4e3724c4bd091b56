"""The program that a student writes: classical Runge-Kutta steps in loops that numba compiles.

A step is a thousandth of a period; an impact is the step after which x < c, with Newton's method for the time in it.
"""

from math import cos, isnan, nan, pi
from typing import Any

import numpy as np
from numba import njit

from singimpact.algebra.numbers import Array
from singimpact.bench.drawn import Problem

STEPS = 1000  # of a period
LONGEST = 300  # periods after which a flight is given up


def _step(t: float, x: float, u: float, h: float, n: Array) -> tuple[float, float]:
    """One step; n has omega, clearance, damping, cubic stiffness and amplitude."""
    a1 = n[4] * cos(n[0] * t) - x - n[2] * u - n[3] * x**3
    y, w = x + h / 2 * u, u + h / 2 * a1
    a2 = n[4] * cos(n[0] * (t + h / 2)) - y - n[2] * w - n[3] * y**3
    z, s = x + h / 2 * w, u + h / 2 * a2
    a3 = n[4] * cos(n[0] * (t + h / 2)) - z - n[2] * s - n[3] * z**3
    q, p = x + h * s, u + h * a3
    a4 = n[4] * cos(n[0] * (t + h)) - q - n[2] * p - n[3] * q**3
    return x + h / 6 * (u + 2 * w + 2 * s + p), u + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)


def _flight(tau: float, v: float, n: Array) -> tuple[float, float]:
    """The time of flight and the velocity at the impact; nan where there is none."""
    h = 2 * pi / n[0] / STEPS
    t, x, u = tau, n[1], v
    for _ in range(LONGEST * STEPS):
        y, w = step(t, x, u, h, n)
        if y < n[1]:
            # from the end of the step: from its start the first step of a flight would find the launch
            s = h
            for _ in range(20):
                s -= (y - n[1]) / w
                y, w = step(t, x, u, s, n)
            return t + s - tau, w
        t, x, u = t + h, y, w
    return nan, nan


def _flights(tau: Array, v: Array, n: Array) -> Array:
    """Times of flight of arrays of states."""
    times = np.empty(tau.size)
    for k in range(tau.size):
        times[k] = flight(tau[k], v[k], n)[0]
    return times


def _orbit(tau: float, v: float, impacts: int, r: float, n: Array) -> Array:
    """Times and velocities after so many impacts, shape (impacts, 2); the last rows are nan where the orbit is lost."""
    rows = np.full((impacts, 2), nan)
    for k in range(impacts):
        time, w = flight(tau, v, n)
        tau, v = tau + time, -r * w
        if isnan(time) or v < 1e-9:  # it sits on the wall
            break
        rows[k] = tau, v
    return rows


# Python's functions stay as they are written; these are what runs
step: Any = njit(_step)
flight: Any = njit(_flight)
flights: Any = njit(_flights)
orbit: Any = njit(_orbit)


def numbers(family: str, omega: float, clearance: float, amplitude: float = 1.0) -> Array:
    """Numbers of x'' + d x' + x + k x^3 = amplitude cos(omega t) for the loops; d and k are 0 but for Duffing."""
    return np.array([omega, clearance, *((0.1, 0.3) if family == "duffing" else (0.0, 0.0)), amplitude])


def fly(problem: Problem) -> tuple[float, float]:
    """Time of flight and velocity of a problem, as other peers give them."""
    time, velocity = flight(problem.tau, problem.v, numbers(problem.family, problem.omega, problem.clearance))
    return float(time), float(velocity)
