"""The reference cases: states with their true impacts, tagged by what makes them hard, and named values."""

import csv
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.inputs import InputError, unknown

DATA = Path(__file__).parent / "data"
FAMILIES = ("linear", "duffing")
REGIMES = {
    "generic": "nothing special",
    "chatter": "v from 1e-12 to 1e-3: the root is 1e-12 away from the trivial one",
    "graze": "1e-10 to 1e-4 from the apparent outline: a nearly double root",
    "long": "near resonance: many periods without impact",
}


@dataclass(frozen=True)
class Problem:
    """A state and where it goes; numbers of the state are exact doubles, the truth is decimal text.

    Parameters
    ----------
    family : `linear` (x'' + x) or `duffing` (x'' + 0.1 x' + x + 0.3 x^3), forced by cos(omega t).
    regime : a key of `REGIMES`.
    flight_time, v_next : 40 digits for `linear`, 17 for `duffing`.
    """

    family: str
    regime: str
    omega: float
    clearance: float
    restitution: float
    tau: float
    v: float
    flight_time: str
    v_next: str

    def model(self) -> ImpactOscillator:
        """The oscillator."""
        if self.family == "linear":
            return linear(self.omega, self.clearance, self.restitution)
        force = "x + 0.1*xdot + 0.3*x**3"
        return ImpactOscillator(force, "cos(omega*t)", self.clearance, self.restitution, {"omega": self.omega})


@lru_cache(maxsize=4)
def states(family: str) -> tuple[Problem, ...]:
    """The states of a family.

    Examples
    --------
    >>> len(states("linear")), states("duffing")[0].regime
    (2000, 'generic')
    """
    if family not in FAMILIES:
        raise unknown("family", family, FAMILIES)
    return tuple(_problem(family, row) for row in _rows(f"impact_map_{family}.csv"))


def _problem(family: str, row: dict[str, str]) -> Problem:
    numbers = {name: float(row[name]) for name in ("omega", "clearance", "restitution", "tau", "v")}
    return Problem(family=family, regime=row["regime"], flight_time=row["flight_time"], v_next=row["v_next"], **numbers)


@lru_cache(maxsize=1)
def values() -> dict[str, str]:
    """Named values, as decimal text of 30 digits or more.

    Examples
    --------
    >>> values()["G.duffing(1.5,1e-3).v"][:20]
    '0.000600256662344163'
    """
    return {row["name"]: row["value"] for row in _rows("values.csv")}


def _rows(name: str) -> list[dict[str, Any]]:
    if not (DATA / name).exists():
        raise InputError(f"the reference states {name} are not in the wheel: install from the source distribution")
    with (DATA / name).open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))
