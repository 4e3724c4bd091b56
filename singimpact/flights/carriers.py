"""What a flight ends in: frozen carriers of arrays, scalars when the state was scalar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.notebook import table
from singimpact.status import Status, status_array


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

    def __post_init__(self) -> None:
        object.__setattr__(self, "status", status_array(self.status))

    def _repr_html_(self) -> str:
        names = [name for name in ("flight_time", "velocity", "tau", "v") if hasattr(self, name)]
        columns = [np.ravel(getattr(self, name)) for name in names]
        words = [Status(value).name for value in np.ravel(self.status).tolist()]
        rows = [[*map(_shown, numbers), word] for *numbers, word in zip(*columns, words, strict=True)]
        return table([*names, "status"], rows, f"{type(self).__name__} of {len(rows)}")


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

    def __post_init__(self) -> None:
        object.__setattr__(self, "status", status_array(self.status))


def _shown(number: Any) -> str:
    return f"{number:.12g}" if isinstance(number, float) else str(number)
