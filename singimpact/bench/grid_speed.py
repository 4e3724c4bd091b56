"""A grid of orbits against a peer in the same run: impacts a second on one core, compile time left out."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from singimpact.bench.peers import taylor_events
from singimpact.bench.problems import Problem
from singimpact.flights.grids import after
from singimpact.impact_oscillator import linear


@dataclass(frozen=True)
class Grid:
    """How large the grid is, and how many of its states the peer is given."""

    side: int = 300
    impacts: int = 200
    few: int = 100
    few_impacts: int = 30


GRID = Grid()


@dataclass(frozen=True)
class Rate:
    """Million impacts a second of CPU time."""

    method: str
    states: int
    impacts: int
    millions_a_second: float


def compare_grid(grid: Grid = GRID) -> list[Rate]:
    """x'' + x = cos 2.8 t, c = 0, r = 0.8, v from 0.05 to 2: lanes, then heyoka with a terminal event an impact."""
    osc = linear("2.8", 0, "0.8")
    tau, v = (part.ravel() for part in np.meshgrid(np.linspace(0, 2.2, grid.side), np.linspace(0.05, 2, grid.side)))
    after(osc, tau[:16], v[:16], 1)
    spent = -time.thread_time()
    after(osc, tau, v, grid.impacts)
    spent += time.thread_time()
    chosen = np.linspace(0, tau.size - 1, grid.few).astype(int)
    fly = taylor_events.stepper("linear")
    heyoka = -time.thread_time()
    for start, speed in zip(tau[chosen].tolist(), v[chosen].tolist(), strict=True):
        for _ in range(grid.few_impacts):
            problem = Problem("linear", "generic", 2.8, 0.0, 0.8, start, max(speed, 1e-3), "0", "0")
            time_flown, velocity = fly(problem)
            start, speed = (start + time_flown) % (2 * np.pi / 2.8), 0.8 * abs(velocity)
    heyoka += time.thread_time()
    own = tau.size * grid.impacts / spent / 1e6
    return [Rate("singimpact lanes", tau.size, grid.impacts, own),
            Rate("heyoka", grid.few, grid.few_impacts, grid.few * grid.few_impacts / heyoka / 1e6)]  # fmt: skip
