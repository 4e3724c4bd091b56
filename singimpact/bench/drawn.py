"""Models and random states of the rows that a user's own loop is compared with: other states for every timed call.

x'' + x = cos 2.8t and x'' + x'/10 + x + 3x^3/10 = cos 1.7t over the wall at 0.3, and x'' + x = cos 2t over the wall at
0.7, whose orbits chatter, rest and lift off again and again.  The numbers are doubles: a peer and the truth have the
same ones.
"""

import csv
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from math import acos, pi
from pathlib import Path

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.machine import compilable
from singimpact.impact_oscillator import ImpactOscillator, linear

# A state of a model as every peer takes it, and reference values by name.

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


CHATTERING = "linear, chattering"
OMEGAS = {"linear": 2.8, "duffing": 1.7, CHATTERING: 2.0}
CLEARANCES = {"linear": 0.3, "duffing": 0.3, CHATTERING: 0.7}
RESTITUTIONS = (0.5, 0.7, 0.9, 0.99, 0.999)  # of the models that timed calls take in turn


def counted(count: int, noun: str) -> str:
    """A number of things.

    Examples
    --------
    >>> counted(1, "state"), counted(20, "phase")
    ('1 state', '20 phases')
    """
    return f"{count} {noun}{'' if count == 1 else 's'}"


@lru_cache(maxsize=64)
def model(family: str, restitution: float) -> ImpactOscillator:
    """The oscillator of a family, with its tables and the code that flies it."""
    if family == "duffing":
        force = "x + 0.1*xdot + 0.3*x**3"
        osc = ImpactOscillator(force, "cos(omega*t)", CLEARANCES[family], restitution, {"omega": OMEGAS[family]})
    else:
        osc = linear(OMEGAS[family], CLEARANCES[family], restitution)
    compile_entries(osc)
    osc.impact_map(0.5, 1.0)
    return osc


@dataclass(frozen=True)
class States:
    """States of one model; `problems` gives them to a peer."""

    family: str
    restitution: float
    tau: Array
    v: Array

    @property
    def osc(self) -> ImpactOscillator:
        """Their model."""
        return model(self.family, self.restitution)

    def problems(self) -> list[Problem]:
        """A problem a state, as a peer takes it."""
        numbers = self.family, OMEGAS[self.family], CLEARANCES[self.family], self.restitution
        return [Problem(*numbers, tau, v) for tau, v in zip(self.tau.tolist(), self.v.tolist(), strict=True)]


def _pressed(rng: np.random.Generator, family: str, count: int) -> Array:
    """Phases in the middle of the time that a_c presses, less some for the force of Duffing's model."""
    begin, end = pressing(family)
    return begin + (end - begin) * rng.uniform(0.2, 0.7, count)


def pressing(family: str) -> tuple[float, float]:
    """Zeros of cos(omega tau) - clearance: it falls through the first one and rises through the second."""
    omega, angle = OMEGAS[family], acos(CLEARANCES[family])
    return angle / omega, (2 * pi - angle) / omega


KINDS: dict[str, Callable[[np.random.Generator, str, float, int], tuple[Array, Array]]] = {
    "generic": lambda rng, family, _, count: (
        rng.uniform(0, 2 * pi / OMEGAS[family], count),
        rng.uniform(0.05, 2, count),
    ),
    "v from 1e-8 to 1e-2": lambda rng, family, _, count: (
        rng.uniform(0, 2 * pi / OMEGAS[family], count),
        10 ** rng.uniform(-8, -2, count),
    ),
    "tau within 1e6": lambda rng, _, __, count: (rng.uniform(-1e6, 1e6, count), rng.uniform(0.05, 2, count)),
    # where a_c presses, and so slow that the impacts accumulate before it ceases to
    "chattering": lambda rng, family, restitution, count: (
        _pressed(rng, family, count),
        (1 - restitution) * rng.uniform(0.01, 0.05, count),
    ),
}


@dataclass
class Draws:
    """The states of one timed call after the other: the first call of every method has the same ones.

    Parameters
    ----------
    family, kind, count : of a call. `kind` is a key of `KINDS`. restitution : without it one of `RESTITUTIONS` in turn.
    """

    family: str
    kind: str
    count: int
    restitution: float | None = None
    turn: int = field(default=0, init=False)

    def __call__(self) -> States:
        """The next ones."""
        rng = np.random.default_rng([self.turn, *map(ord, self.kind)])
        restitution = self.restitution or RESTITUTIONS[self.turn % len(RESTITUTIONS)]
        tau, v = KINDS[self.kind](rng, self.family, restitution, LARGEST)
        self.turn += 1
        model(self.family, restitution)  # built outside the clock
        return States(self.family, restitution, tau[: self.count], v[: self.count])


LARGEST = 100_000  # states that are drawn, so that a method of fewer states has the first ones of the others


def compile_entries(osc: ImpactOscillator) -> None:
    """Load the code that flies a model, or compile it where none comes with the package."""
    if compilable():
        flown = compiled_model(osc)
        for name in flown.machine.emitted.entries:
            flown.machine.compile_here(name)
        for part in (*flown.recurrences, *flown.laws):
            if part is not None:
                part.compile_here()
