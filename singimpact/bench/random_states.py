"""Random states of linear and cubic models, beside one wall, between two, or at rest on a plastic one.

A case is a model and some states; it is drawn from its number and the seed alone, so cases run anywhere, in any order.
Rows and listed states serve the steep families too (`bench.steep_states`).
Truth: the closed forms and Taylor steps of `truth.first_hit` in balls of 60 digits, which share nothing with the
package.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, replace
from functools import partial
from math import acos, inf, pi
from pathlib import Path
from typing import Any

import flint
import numpy as np

from singimpact.algebra import Array, balls_at
from singimpact.bench.stress.flown import hit_trial
from singimpact.bench.stress.judging import BITS, Launch, Trial
from singimpact.bench.truth.first_hit import first_hit
from singimpact.cases import sweep
from singimpact.status import Status

EACH = 25  # states of a case, whose model is made once
SHOWN = 5  # states of each sort that are written out, each of another kind
# `wrong`, `unresolved` (by the package) and `undecided` (by the truth) are 0 or 1, `crossed` is 1 where a flight
# crossed a steep layer, `ratio` is the error in units of what is allowed
COLUMNS = ("case", "launch", "crossed", "wrong", "unresolved", "undecided", "ratio")
SORTS = ("wrong", "unresolved", "undecided")


@dataclass(frozen=True)
class Row:
    """States of one kind: how many, how many of each sort, and the largest error of one that is not wrong."""

    kind: str
    states: int
    crossed: int
    wrong: int
    unresolved: int
    undecided: int
    worst: float


@dataclass(frozen=True)
class RandomStates:
    """States that were flown.

    Parameters
    ----------
    columns : those of COLUMNS, and others of the family. kind_of : the kind of a case.
    text_of : a state as it is typed, from its case and launch.
    """

    columns: dict[str, Array]
    kind_of: Callable[[int], str]
    text_of: Callable[[int, int], str]

    @property
    def kinds(self) -> Array:
        """The kind of each state."""
        return np.array([self.kind_of(int(number)) for number in self.columns["case"]])

    def rows(self) -> list[Row]:
        """A row a kind, in the order of the cases."""
        kinds, table = self.kinds, []
        for kind in dict.fromkeys(kinds.tolist()):
            here = {name: self.columns[name][kinds == kind] for name in COLUMNS}
            right = here["ratio"][(here["wrong"] == 0) & np.isfinite(here["ratio"])]
            counts = {name: int(here[name].sum()) for name in ("crossed", *SORTS)}
            table.append(Row(kind, len(here["case"]), worst=float(right.max(initial=0.0)), **counts))
        return table

    def listed(self) -> dict[str, list[str]]:
        """States of each sort as they are typed: a few, each of another kind, and all that the truth leaves open."""
        kinds, texts = self.kinds, {}
        for sort in SORTS:
            states = self.columns[sort].nonzero()[0]
            # what the truth does not decide is rare, and each such state is a fault of the truth
            if sort != "undecided":
                states = states[np.unique(kinds[states], return_index=True)[1]][:SHOWN]
            pairs = zip(self.columns["case"][states], self.columns["launch"][states], strict=True)
            texts[sort] = [self.text_of(int(number), int(launch)) for number, launch in pairs]
        return texts

    def as_data(self) -> dict[str, Any]:
        """The rows and the listed states as plain data."""
        return {"rows": [asdict(row) for row in self.rows()], "listed": self.listed()}


@dataclass(frozen=True)
class Draw:
    """Settings of the random states.

    Parameters
    ----------
    cubic : one case in so many is of the cubic oscillator, whose truth takes a hundred times longer.
    horizon : of the cubic oscillator, which is damped: many flights never return, and the truth follows them slowly.
    tries : draws for a state that grazes, before another model is taken.
    allowed, wrong : units of `Trial` that are allowed, and that are a wrong root.
    """

    cubic: int = 25
    horizon: float = 60.0
    tries: int = 12
    allowed: float = 10.0
    wrong: float = 1000.0


DRAW = Draw()
REGIMES = ("generic", "low", "graze", "long")
# Of each the number of its first case, what follows the names of its kinds, and its regimes.
#
# Plastic states are at rest on the wall: anywhere, where a_c presses, and just after and before a zero of a_c.
FAMILIES = {
    "reference": (0, "", REGIMES),
    "between-walls": (10**9, " between walls", (*REGIMES, "narrow", "wide")),
    "plastic": (2 * 10**9, " with restitution 0", ("anywhere", "pressed", "rising", "falling")),
}
State = tuple[float, float]
UPPER_LAW = 0.7  # restitution of the upper wall
NEAR_ZERO = 1e-6  # |a_c| where the mass lands, next to which it may be released at once or a period later


class Model(Launch):
    """An oscillator of a family between its walls, and the wall of the launches; with one wall `upper` is None."""

    @property
    def horizon(self) -> float:
        """Of its flights."""
        return 2000 * pi / self.omega if self.family == "linear" and self.upper is None else DRAW.horizon

    @property
    def pull(self) -> flint.arb:
        """f(c, 0), a ball: a_c = cos(omega t) - f(c, 0)."""
        c = flint.arb(self.clearance)
        return c + (flint.arb(3) / 10 * c**3 if self.family == "cubic" else 0)

    def next_release(self, time: flint.arb) -> flint.arb:
        """The time from which on a_c > 0: `time`, or the next zero of a_c, in balls."""
        turn, zero = 2 * flint.arb.pi() / self.omega, self.pull.acos() / self.omega
        turns = ((time + zero) / turn).floor()  # periods since the last rise of a_c
        return time if time - turns * turn < zero else (turns + 1) * turn - zero

    def quiet_after_rest(self) -> float:
        """A time for which a mass that leaves at a zero of a_c stays off the wall: its third derivative is positive."""
        third: float = self.motion(0.0, 0.0).third(0.0, 0.0, 0.25)
        rise: float = self.omega * (1 - float(self.pull) ** 2) ** 0.5
        return min(rise / (2 * (self.omega**2 + 2 * third + third**2)), 0.25)


def check(
    count: int, seed: int, executor: Executor | None = None, output: str | Path | None = None, family: str = "reference"
) -> RandomStates:
    """Fly `count` states, rounded up to whole cases.

    Parameters
    ----------
    executor, output : as in `singimpact.cases.sweep`; an interrupted check goes on.
    family : see `FAMILIES`.
    """
    first = FAMILIES[family][0]
    table = sweep(partial(flown, seed), range(first, first - (-count // EACH)), executor, output)
    columns = dict(zip(COLUMNS, table.reshape(-1, len(COLUMNS)).T, strict=True))
    return RandomStates(columns, kind_of, lambda number, launch: str(launches(seed, number)[launch]))


def kind_of(number: int) -> str:
    """Family and regime of a case."""
    force = "cubic" if number % DRAW.cubic == 0 else "linear"
    turn = number // DRAW.cubic if force == "cubic" else number
    _, added, regimes = FAMILIES[_family(number)]
    return f"{force} {regimes[turn % len(regimes)]}{added}"


def _family(number: int) -> str:
    return max((first, name) for name, (first, _, _) in FAMILIES.items() if first <= number)[1]


def launches(seed: int, number: int) -> list[Model]:
    """The launches of a case, which have one model."""
    force, regime = kind_of(number).split()[:2]
    rng, family = np.random.default_rng([seed, number]), _family(number)
    if family == "plastic":
        model, states = _at_rest(rng, force, regime)
    else:
        model, states = _drawn(rng, force, regime, family == "between-walls")
    return [replace(model, tau=tau, v=v) for tau, v in states]


def flown(seed: int, number: int) -> Array:
    """An array (states, COLUMNS) of a case."""
    trials = (releases if _family(number) == "plastic" else impacts)(launches(seed, number))
    return np.array([[number, launch, 0.0, *judged(trial)] for launch, trial in enumerate(trials)])


def judged(trial: Trial) -> tuple[bool, bool, bool, float]:
    """Whether a state is wrong, unresolved, or undecided by the truth; and its error in units of what is allowed.

    Examples
    --------
    >>> judged(Trial("", [1 + 2.0**-50], [1.0], [0.0]))[0], judged(Trial("", [1 + 2.0**-40], [1.0], [0.0]))[0]
    (False, True)
    """
    status, right = trial.status
    # a touch that no width of a step tells from a miss is a graze to the truth, and may be either
    unresolved, undecided = status == Status.unresolved, right == Status.graze != status
    units = 0.0 if unresolved or undecided else trial.units
    return units > DRAW.wrong, unresolved, undecided, units / DRAW.allowed


def impacts(drawn: list[Model]) -> list[Trial]:
    """Impacts of launches of one model."""
    model, (tau, v) = drawn[0], np.array([(launch.tau, launch.v) for launch in drawn]).T
    wall = None if model.upper is None else model.wall
    step: Any = model.model.impact_map(tau, v, horizon=model.horizon, wall=wall)
    other = np.zeros(tau.shape, bool) if step.wall is None else step.wall != model.wall
    # x' up from the wall of the launch
    restitution = np.where(other ^ bool(model.wall), model.upper_restitution or model.restitution, model.restitution)
    velocity = np.where(other, step.v, -step.v) / restitution
    trials = []
    for launch, *end in zip(drawn, step.status.tolist(), step.flight_time.tolist(), velocity.tolist(), strict=True):
        with balls_at(launch.bits):
            trials.append(hit_trial(launch, *end))
    return trials


def releases(drawn: list[Model]) -> list[Trial]:
    """Releases from rest with restitution 0: where they land, and the release after that."""
    step = drawn[0].model.replace(restitution=0).release_map(np.array([launch.tau for launch in drawn]))
    with balls_at(BITS):
        return [
            release_trial(launch, int(status), float(landing), float(later))
            for launch, status, landing, later in zip(drawn, step.status, step.landing, step.tau, strict=True)
        ]


def release_trial(launch: Model, status: int, landing: float, later: float) -> Trial:
    """The landing and the next release that doubles give.  Call it with the working precision set."""
    leaves = launch.next_release(flint.arb(launch.tau))
    motion = launch.motion(leaves, 0.0)
    true = first_hit(motion, 0.0, launch.horizon, 0.0 if leaves == launch.tau else launch.quiet_after_rest())
    if true is None:
        early = status == Status.hit and landing - float(leaves) < launch.horizon
        return Trial(str(launch), status=(status, int(Status.no_return) if early else status))
    if status != Status.hit:
        return Trial(str(launch), status=(status, int(Status.hit)))
    (time, velocity), lands = true, leaves + true[0]
    after, moved = launch.next_release(lands), time + abs(motion.variations(time)[0][0] / velocity * leaves)
    # where a_c is 0 up to the error of the landing, both may be right
    count = 2 if abs(float(launch.motion(lands, 0.0).at(0)[2])) > NEAR_ZERO else 1
    return Trial(str(launch), [landing, later][:count], [lands, after][:count], [moved, moved][:count])


def _drawn(rng: np.random.Generator, family: str, regime: str, between: bool) -> tuple[Model, list[State]]:
    """A model with one wall or two, and states (tau, v) at one of them."""
    model, gap = (_between if between else _alone)(rng, family, regime)
    states: list[State] = []
    for _ in range(DRAW.tries * EACH):
        tau, v = float(rng.uniform(-1, 1) * 2 * pi / model.omega), float(rng.uniform(0.01, 3))
        if regime == "low" and between:
            v = float(10 ** rng.uniform(-150, -3))
        elif regime == "low":
            v = float(10 ** rng.uniform(-12, -3) if rng.random() < 0.9 else 10 ** rng.uniform(-300, -12))
        elif regime == "narrow":  # as fast as what reaches the other wall, or a tenth or ten times that
            v = float((2 * gap) ** 0.5 * 10 ** rng.uniform(-1, 1))
        elif regime == "wide":
            v *= gap
        states += _grazing(rng, model, tau) if regime == "graze" else [(tau, v)]
        if len(states) == EACH:
            return model, states
    return _drawn(rng, family, regime, between)  # few flights of that model touch: another one


def _alone(rng: np.random.Generator, family: str, regime: str) -> tuple[Model, float]:
    """A model with one wall, and inf for the distance of another one."""
    if regime != "long":
        return Model(family, float(rng.uniform(0.3, 3.5)), float(rng.uniform(-0.9, 0.9))), inf
    near = [1.0, 1 + 1e-12, 1 - 1e-12, 1 + 10 ** rng.uniform(-9, -1.3), 1 - 10 ** rng.uniform(-9, -1.3)]
    omega = float(rng.choice(near))
    return Model(family, omega, float(-rng.uniform(3, 60) if family == "linear" else -rng.uniform(0.7, 1.6))), inf


def _between(rng: np.random.Generator, family: str, regime: str) -> tuple[Model, float]:
    """A model with two walls, and their distance."""
    omega, clearance = float(rng.uniform(0.3, 3.5)), float(rng.uniform(-0.9, 0.9))
    sizes = {"low": (-12, 0.5), "narrow": (-12, -1), "wide": (0, 6 if family == "linear" else 1.5)}
    gap = 10 ** rng.uniform(*sizes.get(regime, (-1.3, 0.5)))
    if regime == "long":  # inside the walls for many turns, at a resonance
        omega = float(1 + rng.choice([0, 1, -1]) * 10 ** rng.uniform(-9, -1.3))
        clearance, gap = (-10, 30) if family == "linear" else (-1, 3)
    elif regime == "graze" and rng.random() < 0.5:
        gap = 10 ** rng.uniform(-9, 0)
    upper = float(clearance + gap)
    return Model(
        family, omega, float(clearance), upper=upper, wall=int(rng.integers(2)), upper_restitution=UPPER_LAW
    ), gap


def _grazing(rng: np.random.Generator, model: Model, tau: float) -> Iterator[State]:
    """A state that a flight run backwards from a touch at tau started from, moved off it by 1e-10 to 1e-4."""
    touched = model if model.upper is None else replace(model, wall=1 - model.wall)
    hit = touched.before_touch(tau)
    if hit is not None:
        v = -float(hit[1]) * (1 + float(rng.choice([-1, 1])) * 10 ** rng.uniform(-10, -4))
        yield tau - float(hit[0]), v


def _at_rest(rng: np.random.Generator, family: str, regime: str) -> tuple[Model, list[State]]:
    """A model with restitution 0, and times at which its mass rests on the wall."""
    model = Model(family, float(rng.uniform(0.3, 3.5)), float(rng.uniform(-0.7, 0.7)))
    # a_c is positive before the phase `zero`, and from its opposite on
    turn, zero = 2 * pi / model.omega, acos(float(model.pull)) / model.omega
    near = 10 ** rng.uniform(-14, -1, EACH)
    phases = {
        "anywhere": rng.uniform(0, turn, EACH),
        "pressed": rng.uniform(zero, turn - zero, EACH),
        "rising": -zero + near,
        "falling": zero - near,
    }
    times = phases[regime] + turn * rng.integers(-3, 4, EACH)
    return model, [(time, 0.0) for time in times.tolist()]
