"""The closing conditions of an orbit without impact: x and x' come back after k periods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.branches.closing import Loop, lowest
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
        for place, name in enumerate(self.over):
            if name != CLEARANCE and name in self.family.over:
                at = self.family.over.index(name)
                slope[:, 2 + place] = end.by_numbers[at] + self.k * period.slopes[at] * end.by_time
        return Loop(np.array([end.place[0], end.place[1] - point[1]]), slope, -np.eye(2))

    def heights(self, point: Array) -> list[tuple[float, float]]:
        """The lowest place of the orbit: its time, and x - c there."""
        values = self.launch(point)
        span = self.k * self.family.period(values).value
        wall = self.values(point).get(CLEARANCE, self.family.start[CLEARANCE])
        time, height = lowest(self.family, values, (0.0, float(point[1]), 1.5 * span))
        return [(time, height + float(point[0]) - wall)]

    def scales(self, point: Array) -> Array:
        """Sizes of the parts of a point."""
        size = max(abs(float(point[0])), abs(float(point[1])), 1e-3)
        return np.concatenate([np.full(2, size), np.ones(len(self.over))])
