"""The closing conditions of an orbit without impact: x and x' come back after k periods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.branches.closing import Loop, Turn, minima_of
from singimpact.flights.family import Family
from singimpact.oscillator.moving_number import CLEARANCE

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class FreeClosing:
    """Points are x and x' at time 0, and the free parameters.

    Parameters
    ----------
    family : over the clearance, which stands for the place of the launch, and the numbers that move flights.
    over : the free parameters; the clearance among them changes the wall alone.
    """

    family: Family
    over: tuple[str, ...]
    k: int
    n: int = 0

    def values(self, point: Array) -> dict[str, float]:
        """The free parameters."""
        return dict(zip(self.over, point[2:].tolist(), strict=True))

    def launch(self, point: Array) -> dict[str, float]:
        """The numbers of the family for a launch at x."""
        values = {name: value for name, value in self.values(point).items() if name in self.family.over}
        return values | {CLEARANCE: float(point[0])}

    def at(self, point: Array) -> Loop:
        """The conditions and their derivatives at a point."""
        values = self.launch(point)
        period = self.family.period(values)
        end = self.family.end(values, 0.0, float(point[1]), self.k * period.value)
        flow = np.stack([end.by_numbers[self.family.over.index(CLEARANCE)] + np.array([1.0, 0.0]), end.by_v], axis=1)
        slope = np.zeros((2, 2 + len(self.over)))
        slope[:, :2] = flow - np.eye(2)
        for column, name in enumerate(self.over):
            if name != CLEARANCE and name in self.family.over:
                at = self.family.over.index(name)
                slope[:, 2 + column] = end.by_numbers[at] + self.k * period.slopes[at] * end.by_time
        return Loop(np.array([end.place[0], end.place[1] - point[1]]), slope, -np.eye(2))

    def heights(self, point: Array) -> list[tuple[float, float]]:
        """The lowest place of the orbit: its time, and x - c there."""
        return [min(self.minima(point)[0], key=lambda turn: turn[1], default=(np.nan, np.inf))]

    def minima(self, point: Array) -> list[list[Turn]]:
        """All local minima of the orbit: time and x - c, each once."""
        values = self.launch(point)
        span = self.span(point)
        wall = self.values(point).get(CLEARANCE, self.family.start[CLEARANCE])
        rise = float(point[0]) - wall
        turns = minima_of(self.family, values, (0.0, float(point[1]), 1.5 * span))
        # one span that begins away from 0: a minimum at time 0 is not between two samples
        turns = [turn for turn in turns if not turn[0] < span / 4 and not turn[0] >= 5 * span / 4]
        return [[(time, height + rise) for time, height in turns]]

    def rise(self, point: Array, direction: Array, flight: int, time: float) -> float:  # noqa: ARG002
        """The rate at which x - c at a time changes as the point moves: see `Closing.rise`."""
        end = self.family.end(self.launch(point), 0.0, float(point[1]), time)
        moved = dict(zip(self.over, direction[2:].tolist(), strict=True))
        wall = moved.get(CLEARANCE, 0.0)
        rates = [float(direction[0]) if name == CLEARANCE else moved.get(name, 0.0) for name in self.family.over]
        return float(np.dot(rates, end.by_numbers[:, 0]) + end.by_v[0] * direction[1] + direction[0] - wall)

    def span(self, point: Array, flight: int = 0) -> float:  # noqa: ARG002
        """The time of k periods."""
        return self.k * self.family.period(self.launch(point)).value

    def scales(self, point: Array) -> Array:
        """Sizes of the parts of a point."""
        size = max(abs(float(point[0])), abs(float(point[1])), 1e-3)
        return np.concatenate([np.full(2, size), np.ones(len(self.over))])
