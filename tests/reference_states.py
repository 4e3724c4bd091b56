"""Reference states with their true impacts, tagged by what makes them hard."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from singimpact.bench import Problem
from singimpact.impact_oscillator import ImpactOscillator, linear

REGIMES = {
    "generic": "nothing special",
    "chatter": "v from 1e-12 to 1e-3: the root is 1e-12 away from the trivial one",
    "graze": "1e-10 to 1e-4 from the apparent outline: a nearly double root",
    "long": "near resonance: many periods without impact",
}
NUMBERS = ("omega", "clearance", "restitution", "tau", "v")


@dataclass(frozen=True)
class Reference(Problem):
    """A state and where it goes; numbers of the state are exact doubles, the truth is decimal text.

    Parameters
    ----------
    regime : a key of `REGIMES`. flight_time, v_next : 40 digits for the family `linear`, 17 for `duffing`.
    """

    regime: str
    flight_time: str
    v_next: str

    def model(self) -> ImpactOscillator:
        """The oscillator."""
        if self.family == "linear":
            return linear(self.omega, self.clearance, self.restitution)
        force = "x + 0.1*xdot + 0.3*x**3"
        return ImpactOscillator(force, "cos(omega*t)", self.clearance, self.restitution, {"omega": self.omega})


@lru_cache(maxsize=4)
def states(family: str) -> tuple[Reference, ...]:
    """The 2000 states of the family `linear`, or the states of `duffing`."""
    place = Path(__file__).parent / "data" / f"impact_map_{family}.csv"
    with place.open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    return tuple(
        Reference(family, *(float(row[name]) for name in NUMBERS), row["regime"], row["flight_time"], row["v_next"])
        for row in rows
    )
