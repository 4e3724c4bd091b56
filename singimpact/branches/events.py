"""Events of a branch of periodic orbits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.switching import graze_time, others
from singimpact.inputs import refuse


@dataclass(frozen=True, eq=False)
class Event:
    """An event at a point of a branch.

    Parameters
    ----------
    kind : "fold" (two orbits meet), "period-doubling" (multiplier -1), "torus" (two multipliers on the unit circle),
        "graze" (an impact of the orbit has no velocity), "hidden impact" (a flight touches the wall on its way).
    parameter : the value of the parameter. orbit : the orbit. index : it lies after this point of the branch.
    impact : which impact grazes, or after which one the flight does, from 0: a column of `tau` and `v` of the branch
        (an orbit itself begins at its least phase). time : of a hidden impact after its launch.
    """

    kind: str
    parameter: float
    orbit: PeriodicOrbit
    index: int
    impact: int = 0
    time: float = np.nan
    over: str = ""

    def others(self) -> list[PeriodicOrbit]:
        """Orbits of the other branches that meet this one here, to be followed by `branch`.

        Returns
        -------
        list : at a doubling the orbit of 2n impacts in 2k periods next to it; at a graze the orbit without that impact;
            at a hidden impact the orbit with an impact there. Empty at folds and tori.
        """
        return others(self.kind, self.orbit, self.over, self.parameter)

    @property
    def graze_time(self) -> float:
        """When the orbit touches the wall, of a graze or a hidden impact: `at` of `singimpact.theory.grazing_map`."""
        if self.kind not in ("graze", "hidden impact"):
            raise refuse("event", self.kind, "a graze or a hidden impact")
        return graze_time(self.kind, self.orbit)

    def __repr__(self) -> str:
        which = f" of impact {self.impact + 1}" if self.kind == "graze" and self.orbit.n else ""
        return f"<{self.kind}{which} at {self.over} = {self.parameter:.12g}>"
