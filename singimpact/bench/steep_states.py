"""Random states of steep families, flown by `first_hit` and by a truth in small fixed steps: which impacts are wrong.

A case is a model and some states; it is drawn from its number and the seed alone, so cases run anywhere, in any order.
"""

from concurrent.futures import Executor
from dataclasses import dataclass
from functools import lru_cache, partial
from math import pi
from pathlib import Path
from time import process_time
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.bench.steep_families import FAMILIES, NAMES, PARAMETRIC, SMOOTH, STEEP, Family
from singimpact.bench.truth import graded_steps
from singimpact.bench.truth.graded_steps import HIT, MISS, PHASE, Motion
from singimpact.cases import sweep
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.status import Status

Generator = np.random.Generator


@dataclass(frozen=True)
class DrawSettings:
    """Settings of the random states, and the limit at which a flight time is wrong.

    Parameters
    ----------
    each : states of a model, which is made once.
    smooth : one case in so many is of a smooth family; they come on top of the steep ones.
    horizon : of each flight, in units of time.
    wrong : least relative error of a flight time that is wrong; 100 kappa epsilon counts where it is larger.
    mild : steepness up to which `unresolved` is counted apart.
    """

    each: int = 25
    smooth: int = 11
    horizon: float = 30.0
    wrong: float = 1e-9
    mild: float = 1e3


DRAW = DrawSettings()
PARAMETRIC_FROM = 10**9  # the number of the first case of the parametric families
COLUMNS = (
    "family",
    "steepness",
    "status",
    "flight_time",
    "velocity",
    "condition",
    "velocity_condition",
    "error",
    "velocity_error",
    "true_status",
    "true_time",
    "true_velocity",
    "crossed",
    "tau",
    "v",
    "case",
    "launch",
    "seconds",
    "true_seconds",
)


class Case(NamedTuple):
    """A model of a family with its numbers, and launches."""

    family: Family
    numbers: dict[str, float]
    clearance: float
    tau: Array
    v: Array

    def text(self, launch: int) -> str:
        """A launch as it is typed."""
        given = {name: self.numbers[name] for name in self.family.parameters}
        model = f'ImpactOscillator("{self.family.force}", "{self.family.forcing}", {self.clearance!r}, "1/2", {given})'
        return f"{model}.first_hit({float(self.tau[launch])!r}, {float(self.v[launch])!r}, horizon={DRAW.horizon:g})"

    def oscillator(self) -> ImpactOscillator:
        """The model as a user writes it; its floats are the numbers of the truth, bit by bit."""
        given = {name: self.numbers[name] for name in self.family.parameters}
        return ImpactOscillator(self.family.force, self.family.forcing, self.clearance, "1/2", given)

    def motion(self) -> Motion:
        """The model as the truth flies it."""
        parameters = np.array([self.numbers[name] for name in NAMES])
        layers = np.array(self.family.layers_of(self.numbers), dtype=float).reshape(-1, 5)
        return Motion(_compiled(FAMILIES.index(self.family)), parameters, layers, self.clearance)


@lru_cache(maxsize=len(FAMILIES))
def _compiled(index: int) -> Any:
    return graded_steps.compiled(FAMILIES[index].acceleration)


def family_of(number: int) -> Family:
    """The family of a case: steep ones in turn, and now and then a smooth one; parametric ones from 10^9 on."""
    if number >= PARAMETRIC_FROM:
        return PARAMETRIC[number % len(PARAMETRIC)]
    turn, place = divmod(number, DRAW.smooth)
    return SMOOTH[turn % len(SMOOTH)] if place == DRAW.smooth - 1 else STEEP[(number - turn) % len(STEEP)]


def drawn(seed: int, number: int, each: int = DRAW.each) -> Case:
    """The case of a number; layers lie where its flights go."""
    return drawn_of(family_of(number), np.random.default_rng([seed, number]), each)


def drawn_of(family: Family, rng: Generator, count: int) -> Case:
    """A random model of a family and `count` launches whose velocities differ by a factor of four at most."""
    fast = 10.0 if "friction" in family.name else 6.0
    speed = _log_uniform(rng, 0.05, fast)
    clearance = float(rng.uniform(-0.4, 0.6))
    # a flight at small v rises by about v^2/2 over its acceleration, at large v by about v
    reach = speed * speed / (speed + 1)
    numbers = {
        "mu": _log_uniform(rng, *family.strength),
        "K": _log_uniform(rng, 1.0, family.steepest),
        "a": clearance + float(rng.uniform(0.03, 0.6)) * reach,
        "b": clearance + float(rng.uniform(0.03, 0.9)) * reach,
        "w": float(rng.uniform(-0.6, 0.8)) * speed,
        "h": float(rng.uniform(0.2, 1.5)) if "h*" in family.force else 0.0,
        "s": _log_uniform(rng, 0.05, 1.0),
        "A": float(rng.uniform(0.2, 1.5)),
        "omega": float(rng.uniform(0.5, 3.0)),
        "damping": float(rng.uniform(0.0, 0.3)),
    }
    v = np.clip(speed * 2.0 ** rng.uniform(-1, 1, count), 0.05, fast)
    tau = rng.uniform(0, 6 * pi / numbers["omega"], count)
    for kind, centre, _, _, spacing in family.layers_of(numbers):
        if kind == PHASE:  # launched ahead of the layer by less than a flight takes, about pi v/(1 + v)
            turns = rng.integers(1, 4, count)
            tau = centre + turns * spacing - rng.uniform(0, 0.8, count) * pi * v / (1 + v)
    return Case(family, numbers, clearance, tau, v)


def _log_uniform(rng: Generator, low: float, high: float) -> float:
    return float(low * (high / low) ** rng.uniform())


def flown(seed: int, number: int) -> Array:
    """An array (states, COLUMNS) of a case: the package's flights beside the true ones."""
    case = drawn(seed, number)
    osc, motion = case.oscillator(), case.motion()
    begin = process_time()
    hit = osc.first_hit(case.tau, case.v, horizon=DRAW.horizon)
    spent = (process_time() - begin) / len(case.v)
    table = np.full((len(case.v), len(COLUMNS)), np.nan)
    put = {name: table[:, index] for index, name in enumerate(COLUMNS)}
    for name in ("status", "flight_time", "velocity", "condition", "velocity_condition", "error", "velocity_error"):
        values = getattr(hit, name, None)
        if values is not None:
            put[name][:] = values
    put["family"][:], put["steepness"][:] = FAMILIES.index(case.family), case.numbers["K"]
    put["tau"][:], put["v"][:], put["seconds"][:] = case.tau, case.v, spent
    put["case"][:], put["launch"][:] = number, np.arange(len(case.v))
    for index, (tau, v) in enumerate(zip(case.tau.tolist(), case.v.tolist(), strict=True)):
        begin = process_time()
        true = graded_steps.first_hit(motion, tau, v, DRAW.horizon)
        put["true_seconds"][index] = process_time() - begin
        put["true_status"][index], put["crossed"][index] = true.status, true.crossed
        put["true_time"][index], put["true_velocity"][index] = true.flight_time, true.velocity
    return table


def check(
    count: int,
    seed: int,
    executor: Executor | None = None,
    output: str | Path | None = None,
    parametric: bool = False,
) -> dict[str, Array]:
    """Fly `count` steep states, rounded up to whole cases, and a tenth more smooth ones; a named column each.

    Parameters
    ----------
    executor, output : as in `singimpact.cases.sweep`; an interrupted check goes on.
    parametric : fly the parametric families alone, a quarter of the states each.
    """
    cases = -(-count // DRAW.each)
    first, more = (PARAMETRIC_FROM, 0) if parametric else (0, cases // (DRAW.smooth - 1))
    numbers = range(first, first + cases + more)
    table = sweep(partial(flown, seed), numbers, executor, output).reshape(-1, len(COLUMNS))
    return {name: table[:, index] for index, name in enumerate(COLUMNS)}


def relative_error(found: dict[str, Array]) -> Array:
    """Relative error of flight times where both the package and the truth hit; nan elsewhere."""
    both = (found["status"] == Status.hit) & (found["true_status"] == HIT)
    with np.errstate(invalid="ignore"):
        return np.where(both, np.abs(found["flight_time"] / found["true_time"] - 1), np.nan)


def wrong(columns_: dict[str, Array]) -> Array:
    """True where the package's flight is wrong.

    Notes
    -----
    Wrong: a hit whose relative error exceeds max(1e-9, 100 kappa epsilon), or whose error or kappa is no number; a hit
    where the truth has none; any status but `hit` and `unresolved` where the truth hits before the horizon.
    """
    allowed = np.maximum(DRAW.wrong, 100 * columns_["condition"] * EPSILON)
    hit, true = columns_["status"] == Status.hit, columns_["true_status"]
    exact = relative_error(columns_) <= allowed
    ended = (columns_["status"] == Status.no_return) | (columns_["status"] == Status.escaped)
    right = np.where(true == HIT, hit & exact, ended)
    return np.asarray(~right & (columns_["status"] != Status.unresolved) & ((true == HIT) | (true == MISS)))


@dataclass(frozen=True)
class Row:
    """States of one family: counts, the largest relative error of a flight time that is not wrong, mean seconds."""

    family: str
    steep: bool
    states: int
    crossed: int
    wrong: int
    unresolved: int
    unresolved_steep: int
    undecided: int
    worst_error: float
    seconds: float
    true_seconds: float


def rows(columns_: dict[str, Array]) -> list[Row]:
    """A row a family that was flown."""
    bad, error = wrong(columns_), relative_error(columns_)
    open_ = columns_["status"] == Status.unresolved
    mild = columns_["steepness"] <= DRAW.mild
    undecided = columns_["true_status"] == graded_steps.UNDECIDED
    table = []
    for index in np.unique(columns_["family"]).astype(int):
        here = columns_["family"] == index
        fine = error[here & ~bad & np.isfinite(error)]
        table.append(
            Row(
                FAMILIES[index].name,
                FAMILIES[index].steep,
                int(here.sum()),
                int(columns_["crossed"][here].sum()),
                int(bad[here].sum()),
                int((open_ & mild)[here].sum()),
                int((open_ & ~mild)[here].sum()),
                int(undecided[here].sum()),
                float(fine.max(initial=0.0)),
                float(columns_["seconds"][here].mean()),
                float(columns_["true_seconds"][here].mean()),
            )
        )
    return table
