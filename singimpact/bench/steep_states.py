"""Random states of steep families, whose first hits in doubles are judged by small fixed steps."""

from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from math import pi
from pathlib import Path
from typing import NamedTuple

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.bench.random_states import EACH, RandomStates
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
    smooth : one case in so many is of a smooth family; they come on top of the steep ones.
    horizon : of each flight, in units of time.
    wrong : least relative error of a flight time that is wrong; 100 kappa epsilon counts where it is larger.
    """

    smooth: int = 11
    horizon: float = 30.0
    wrong: float = 1e-9


DRAW = DrawSettings()
PARAMETRIC_FROM = 10**9  # the number of the first case of the parametric families
COLUMNS = (
    "family",
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
        return Motion(graded_steps.compiled(self.family.acceleration), parameters, layers, self.clearance)


def family_of(number: int) -> Family:
    """The family of a case: steep ones in turn, and now and then a smooth one; parametric ones from 10^9 on."""
    if number >= PARAMETRIC_FROM:
        return PARAMETRIC[number % len(PARAMETRIC)]
    turn, place = divmod(number, DRAW.smooth)
    return SMOOTH[turn % len(SMOOTH)] if place == DRAW.smooth - 1 else STEEP[(number - turn) % len(STEEP)]


def drawn(seed: int, number: int, each: int = EACH) -> Case:
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
            tau = centre + rng.integers(1, 4, count) * spacing - rng.uniform(0, 0.8, count) * pi * v / (1 + v)
    return Case(family, numbers, clearance, tau, v)


def _log_uniform(rng: Generator, low: float, high: float) -> float:
    return float(low * (high / low) ** rng.uniform())


def flown(seed: int, number: int) -> Array:
    """An array (states, COLUMNS) of a case: the package's flights beside the true ones."""
    case = drawn(seed, number)
    osc, motion = case.oscillator(), case.motion()
    hit = osc.first_hit(case.tau, case.v, horizon=DRAW.horizon)
    table = np.full((len(case.v), len(COLUMNS)), np.nan)
    put = {name: table[:, index] for index, name in enumerate(COLUMNS)}
    for name in ("status", "flight_time", "velocity", "condition", "velocity_condition", "error", "velocity_error"):
        values = getattr(hit, name, None)
        if values is not None:
            put[name][:] = values
    put["family"][:], put["tau"][:], put["v"][:] = FAMILIES.index(case.family), case.tau, case.v
    put["case"][:], put["launch"][:] = number, np.arange(len(case.v))
    for index, (tau, v) in enumerate(zip(case.tau.tolist(), case.v.tolist(), strict=True)):
        true = graded_steps.first_hit(motion, tau, v, DRAW.horizon)
        put["true_status"][index], put["crossed"][index] = true.status, true.crossed
        put["true_time"][index], put["true_velocity"][index] = true.flight_time, true.velocity
    return table


def check(
    count: int,
    seed: int,
    executor: Executor | None = None,
    output: str | Path | None = None,
    parametric: bool = False,
) -> RandomStates:
    """Fly `count` steep states, rounded up to whole cases, and a tenth more smooth ones.

    Parameters
    ----------
    executor, output : as in `singimpact.cases.sweep`; an interrupted check goes on.
    parametric : fly the parametric families alone, a quarter of the states each.
    """
    cases = -(-count // EACH)
    first, more = (PARAMETRIC_FROM, 0) if parametric else (0, cases // (DRAW.smooth - 1))
    numbers = range(first, first + cases + more)
    table = sweep(partial(flown, seed), numbers, executor, output).reshape(-1, len(COLUMNS))
    columns = dict(zip(COLUMNS, table.T, strict=True))
    columns["wrong"] = wrong(columns)
    columns["unresolved"] = columns["status"] == Status.unresolved
    columns["undecided"] = columns["true_status"] == graded_steps.UNDECIDED
    columns["ratio"] = relative_error(columns) / allowed(columns)
    return RandomStates(columns, lambda number: family_of(number).name, lambda *at: drawn(seed, at[0]).text(at[1]))


def allowed(columns_: dict[str, Array]) -> Array:
    """Relative error of a flight time up to which it is right: max(1e-9, 100 kappa epsilon)."""
    return np.maximum(DRAW.wrong, 100 * columns_["condition"] * EPSILON)


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
    hit, true = columns_["status"] == Status.hit, columns_["true_status"]
    exact = relative_error(columns_) <= allowed(columns_)
    ended = (columns_["status"] == Status.no_return) | (columns_["status"] == Status.escaped)
    right = np.where(true == HIT, hit & exact, ended)
    return np.asarray(~right & (columns_["status"] != Status.unresolved) & ((true == HIT) | (true == MISS)))
