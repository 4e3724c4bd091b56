"""What a flight ends in: frozen carriers of arrays, scalars when the state was scalar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Flight:
    """First hits.

    Parameters
    ----------
    flight_time : time from launch to the hit; inf when there is none, nan beside `unresolved`.
    velocity : x' at the hit, <= 0; nan when there is no hit.
    status : int8, see `singimpact.status.Status`.
    depth : nan, or beside `unresolved` and `graze` the least x - c near the graze.
    bound : rounding bound of `depth`.
    condition : relative condition number kappa of the flight time; nan when there is no hit.
    """

    flight_time: Any
    velocity: Any
    status: Any
    depth: Any
    bound: Any
    condition: Any


@dataclass(frozen=True)
class Step(Flight):
    """A hit and the state just after it; `tau` and `v` are the next ones."""

    tau: Any
    v: Any


@dataclass(frozen=True)
class Derivative:
    """D G of the impact map: `matrix` of shape (..., 2, 2) and the `status` of the flight."""

    matrix: Any
    status: Any
