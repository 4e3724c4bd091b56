"""A state of a model as every peer takes it, and reference values by name."""

import csv
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

VALUES = Path(__file__).parent / "data" / "values.csv"


@dataclass(frozen=True)
class Problem:
    """A state and its model; numbers are exact doubles.

    Parameters
    ----------
    family : `linear` (x'' + x) or `duffing` (x'' + 0.1 x' + x + 0.3 x^3), forced by cos(omega t).
    """

    family: str
    omega: float
    clearance: float
    restitution: float
    tau: float
    v: float


@lru_cache(maxsize=1)
def values() -> dict[str, str]:
    """Named values, as decimal text of 30 digits or more.

    Examples
    --------
    >>> values()["G.duffing(1.5,1e-3).v"][:20]
    '0.000600256662344163'
    """
    with VALUES.open(newline="", encoding="utf-8") as stream:
        return {row["name"]: row["value"] for row in csv.DictReader(stream)}
