"""Phases in which states at the wall are compared: within a period, none without t, times where nothing repeats."""

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.flights.model_numbers import fastest_rate
from singimpact.oscillator.model import Oscillator


@dataclass(frozen=True)
class Phases:
    """Phases of a forcing with a period.

    Parameters
    ----------
    unit : the time in which differences of phases are measured: the period, else a turn of the fastest motion.
    """

    unit: float
    clocked: ClassVar[bool] = True
    repeats: ClassVar[bool] = True

    def of(self, tau: Array) -> Array:
        """The phases of times; doubles do here, and an exact reduction costs more than the flight."""
        return np.asarray(tau - self.unit * np.floor(tau / self.unit))

    def periods(self, time: Array) -> Array:
        """Whole periods nearest to a time."""
        return np.asarray(np.rint(time / self.unit))

    def off(self, tau: Array, other: Array | float) -> Array:
        """Differences of phases, in units."""
        turns = (tau - other) / self.unit
        return np.asarray(turns - np.rint(turns))


class NoPhase(Phases):
    """All times of a model without t are one phase, and orbits close after no count of periods."""

    clocked = False

    def of(self, tau: Array) -> Array:
        """Zeros."""
        return 0 * tau

    def periods(self, time: Array) -> Array:
        """Zeros."""
        return 0 * time

    def off(self, tau: Array, other: Array | float) -> Array:
        """Zeros."""
        return 0 * (tau - other)


class Times(Phases):
    """Times of a forcing that never repeats: only equal times are one phase."""

    repeats = False

    def of(self, tau: Array) -> Array:
        """The times."""
        return tau

    def off(self, tau: Array, other: Array | float) -> Array:
        """Differences of times, in units."""
        return (tau - other) / self.unit


@lru_cache(maxsize=256)
def phases_of(model: Oscillator) -> Phases:
    """The phases of a model.

    Examples
    --------
    >>> phases_of(Oscillator("x", "cos(2*t)", 0, 1)).off(np.array([0.5, 3.0]), np.pi / 2).round(3).tolist()
    [-0.341, 0.455]
    >>> phases_of(Oscillator("x", "-1", 0, 1)).off(np.array([0.5, 3.0]), np.pi / 2).tolist()
    [-0.0, 0.0]
    """
    if model.period is not None:
        return Phases(as_float(model.period))
    return (NoPhase if model.autonomous else Times)(2 * np.pi / fastest_rate(model))
