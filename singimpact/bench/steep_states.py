"""Random states of steep families, whose first hits in doubles are judged by small fixed steps.

The families' texts, in `data/steep_families.toml`, are read by the package in its way and by the truth as Python does.
A family's plain function gives x'' from t, x, x' and the numbers of `NAMES`, in that order; a test compares it with
what the package evaluates. Its layers say where the acceleration varies on a length of about 1/K; `truth.graded_steps`
grades its steps by them. The smooth families measure cost; they have no layer.
"""

import re
import tomllib
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from math import pi
from pathlib import Path
from typing import NamedTuple

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.bench.random_states import EACH, RandomStates
from singimpact.bench.truth import graded_steps
from singimpact.bench.truth.graded_steps import BEYOND, HIT, MISS, PHASE, POSITION, VELOCITY, Acceleration, Motion
from singimpact.bench.truth.plain_orbits import python_function
from singimpact.cases import sweep
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.status import Status

Numbers = Mapping[str, float]
Layer = tuple[float, float, float, float, float]  # kind, centre, width, stiffness, spacing
# a, b: positions of layers; w: velocity of a layer; h, s: height and width of the peak of Stribeck's friction
NAMES = ("mu", "K", "a", "b", "w", "h", "s", "A", "omega", "damping")


@dataclass(frozen=True)
class Family:
    """Models that share one text.

    Parameters
    ----------
    force, forcing : f(x, xdot) and g(t) as the package reads them.
    acceleration : g - f as a plain function.
    layers : names of `LAYERS`.
    strength : range of mu, log-uniform.
    steepest : largest K; the smallest is 1.
    """

    name: str
    force: str
    forcing: str
    acceleration: Acceleration
    strength: tuple[float, float]
    layers: tuple[str, ...] = ()
    steepest: float = 1e4

    @property
    def steep(self) -> bool:
        """Whether the family has layers; the others measure cost."""
        return "K" in self.parameters

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of `NAMES` that occur in the text."""
        return tuple(name for name in NAMES if name in words(f"{self.force} {self.forcing}"))

    def layers_of(self, n: Numbers) -> list[Layer]:
        """Rows of `Motion.layers` from the numbers of a model."""
        return [LAYERS[name](n) for name in self.layers]


# where the acceleration varies steeply: at x' = 0, x = a and b, beyond a without end, at omega t = 0 mod 2 pi and
# pi/2 mod pi, at x' = w, and at x' = 0 of a friction of size A/10
LAYERS: dict[str, Callable[[Numbers], Layer]] = {
    "friction": lambda n: (VELOCITY, 0.0, 1 / n["K"], n["mu"] * n["K"] * (1 + n["h"]), 0.0),
    "stop": lambda n: (POSITION, n["a"], 1 / n["K"], n["mu"] * n["K"], 0.0),
    "second stop": lambda n: (POSITION, n["b"], 1 / n["K"], n["mu"] * n["K"], 0.0),
    "beyond": lambda n: (BEYOND, n["a"], 1 / n["K"], 0.0, 0.0),
    "pulse": lambda n: (PHASE, 0.0, 1 / (n["K"] * n["omega"]), 0.0, 2 * pi / n["omega"]),
    "switch": lambda n: (PHASE, pi / 2 / n["omega"], 1 / (n["K"] * n["omega"]), 0.0, pi / n["omega"]),
    "velocity bump": lambda n: (VELOCITY, n["w"], 1 / n["K"], n["mu"] * n["K"] * n["w"], 0.0),
    "drag": lambda n: (VELOCITY, 0.0, 1 / n["K"], n["A"] * n["K"] / 10, 0.0),
}


# terms that lose digits or overflow in doubles, and the same numbers without that
ACCURATE = {
    "K**2*(cos(omega*t) - 1)": "-2*(K*sin(omega*t/2))**2",
    "log(1 + exp(K*(x - a)))": "(max(K*(x - a), 0.0) + log1p(exp(-abs(K*(x - a)))))",
}


def acceleration(force: str, forcing: str) -> Acceleration:
    """g - f as a plain Python function of t, x, x' and the numbers of `NAMES`, from the texts as Python reads them.

    Examples
    --------
    >>> acceleration("x + mu*xdot", "A*cos(omega*t)")(0.0, 1.0, 2.0, [0.5, 0, 0, 0, 0, 0, 0, 4.0, 1.0, 0])
    2.0
    """
    text = f"{forcing} - ({force})"
    for term, accurate in ACCURATE.items():
        text = text.replace(term, accurate)
    numbers = "".join(f"    {name} = p[{at}]\n" for at, name in enumerate(NAMES) if name in words(text))
    return python_function("acceleration", f"def acceleration(t, x, xdot, p):\n{numbers}    return {text}\n")


def words(text: str) -> set[str]:
    """The names that occur in a text."""
    return set(re.findall(r"[A-Za-z]\w*", text))


def _families(kind: str) -> tuple[Family, ...]:
    return tuple(
        Family(
            **fields | {"strength": tuple(fields["strength"]), "layers": tuple(fields.get("layers", ()))},
            acceleration=acceleration(fields["force"], fields["forcing"]),
        )
        for fields in TEXTS[kind]
    )


TEXTS = tomllib.loads((Path(__file__).parent / "data" / "steep_families.toml").read_text(encoding="utf-8"))
# the last ones have t in f, or no t at all
STEEP, SMOOTH, PARAMETRIC = map(_families, ("steep", "smooth", "parametric"))
FAMILIES = STEEP + SMOOTH + PARAMETRIC

# Random models of the families, and launches.

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
_COLUMNS = (
    "family status flight_time velocity condition velocity_condition error velocity_error true_status "
    "true_time true_velocity crossed tau v case launch"
)
COLUMNS = tuple(_COLUMNS.split())


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
    count: int, seed: int, executor: Executor | None = None, output: str | Path | None = None, parametric: bool = False
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
