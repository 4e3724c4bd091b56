"""Random states, flown by the impact map and by the slow one of `bench.truth`: what is wrong, how large the errors are.

A case is a model and some states; it is drawn from its number and the seed alone, so cases run anywhere, in any order.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from math import acos, inf, log2, nan, pi
from typing import Any

import flint
import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.algebra.precision import balls_at
from singimpact.bench.stress.launches import CUBIC, Launch
from singimpact.bench.truth.first_hit import Above, Cubic, Linear, first_hit, first_of_both
from singimpact.cases import sweep
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.status import Status


@dataclass(frozen=True)
class Draw:
    """Settings of the random states.

    Parameters
    ----------
    each : states of a model, which is made once.
    cubic : one case in so many is of the cubic oscillator, whose truth takes a hundred times longer.
    bits : of the balls for v near 1; small v take more.
    horizon : of the cubic oscillator, which is damped: many flights never return, and the truth follows them slowly.
    tries : draws for a state that grazes, before another model is taken.
    wrong : a flight time that is off by this part, and by more than a hundred times what is allowed, is a wrong root.
    """

    each: int = 25
    cubic: int = 25
    bits: int = 320
    horizon: float = 60.0
    tries: int = 12
    wrong: float = 1e-6


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
COLUMNS = ("status", "time_error", "velocity_error", "wrong", "tau", "v", "depth", "bound")


class Model(Launch):
    """An oscillator of a family between its walls, and the wall of the launches; with one wall `upper` is None."""

    @property
    def horizon(self) -> float:
        """Of its flights."""
        return 2000 * pi / self.omega if self.family == "linear" and self.upper is None else DRAW.horizon

    def oscillator(self) -> ImpactOscillator:
        """The model as a user writes it."""
        law = None if self.upper is None else "0.7"
        if self.family == "linear":
            return linear(self.omega, self.clearance, "0.8", upper=law and (self.upper, law))
        walls = {"upper": self.upper, "upper_restitution": law}
        return ImpactOscillator(CUBIC, "cos(omega*t)", self.clearance, "0.8", {"omega": self.omega}, **walls)

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

    def back_from_touch(self, tau: float) -> Linear | Cubic:
        """The flight backwards from a touch of the wall at tau, or of the other wall where there is one."""
        return (self if self.upper is None else replace(self, wall=1 - self.wall)).motion(-tau, 0.0, -1)


def check(count: int, seed: int, executor: Any = None, output: Any = None, family: str = "reference") -> list[Row]:
    """Fly `count` states, rounded up to whole cases; a row a kind of state.

    Parameters
    ----------
    executor, output : as in `singimpact.cases.sweep`; an interrupted check goes on.
    family : see `FAMILIES`.
    """
    first = FAMILIES[family][0]
    numbers = range(first, first - (-count // DRAW.each))
    table = sweep(partial(case, seed), numbers, executor, output)
    kinds = [kind_of(number) for number in numbers]
    return [_row(kind, table, kinds) for kind in dict.fromkeys(kinds)]


def kind_of(number: int) -> str:
    """Family and regime of a case."""
    force = "cubic" if number % DRAW.cubic == 0 else "linear"
    turn = number // DRAW.cubic if force == "cubic" else number
    _, added, regimes = FAMILIES[_family(number)]
    return f"{force} {regimes[turn % len(regimes)]}{added}"


def _family(number: int) -> str:
    return max((first, name) for name, (first, _, _) in FAMILIES.items() if first <= number)[1]


def case(seed: int, number: int) -> Array:
    """An array (states, COLUMNS); errors in units of what is allowed."""
    force, regime = kind_of(number).split()[:2]
    rng, family = np.random.default_rng([seed, number]), _family(number)
    if family == "plastic":
        model = Model(force, float(rng.uniform(0.3, 3.5)), float(rng.uniform(-0.7, 0.7)))
        return np.array(release_rows(model, rng, regime))
    model, states = _drawn(rng, force, regime, family == "between-walls")
    tau, v = np.array(states).T
    wall = None if model.upper is None else model.wall
    osc: Any = model.oscillator()
    step = osc.impact_map(tau, v, horizon=model.horizon, wall=wall)
    walls = np.zeros(len(states)) if step.wall is None else step.wall
    rows = []
    for index, (start, speed) in enumerate(states):
        fields = (step.status, step.flight_time, step.v, walls, step.depth, step.bound)
        one = [float(np.ravel(field)[index]) for field in fields]
        rows.append([one[0], *_errors(model, start, speed, one), start, speed, *one[4:]])
    return np.array(rows)


def _drawn(
    rng: np.random.Generator, family: str, regime: str, between: bool
) -> tuple[Model, list[tuple[float, float]]]:
    """A model with one wall or two, and states (tau, v) at one of them."""
    model, gap = (_between if between else _alone)(rng, family, regime)
    states: list[tuple[float, float]] = []
    for _ in range(DRAW.tries * DRAW.each):
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
        if len(states) == DRAW.each:
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
    return Model(family, omega, float(clearance), upper=upper, wall=int(rng.integers(2))), gap


def _grazing(rng: np.random.Generator, model: Model, tau: float) -> Iterator[tuple[float, float]]:
    """A state that a flight run backwards from a touch at tau started from, moved off it by 1e-10 to 1e-4."""
    with balls_at(DRAW.bits):
        motion = model.back_from_touch(tau)
        if not motion.at(0)[2] > 1e-3:
            return
        found = first_hit(motion if model.upper is None else Above(motion, model.gap), 0.0, 60.0)
    if found is not None:
        v = -float(found[1]) * (1 + float(rng.choice([-1, 1])) * 10 ** rng.uniform(-10, -4))
        yield tau - float(found[0]), v


def _errors(model: Model, tau: float, v: float, step: list[float]) -> tuple[float, float, float]:
    """Errors of flight time and velocity in units of max(1e-14, 10 kappa eps), max(1e-13, 10 kappa eps); 1 if wrong.

    Parameters
    ----------
    step : status, flight time, v and wall of the impact that the package has.
    """
    status, time, next_v, wall = step[:4]
    period = 2 * pi / model.omega
    with balls_at(DRAW.bits + int(4 * max(-log2(v), 0))):
        motion = model.motion(tau, v)
        truth = first_of_both(motion, v, model.horizon, model.gap)
        if truth is None:
            return 0.0, 0.0, float(status not in (Status.no_return, Status.escaped, Status.unresolved))
        if status != Status.hit:
            return 0.0, 0.0, float(status != Status.unresolved)
        true_wall = model.wall ^ bool(truth[1] > 0)
        rebound = flint.arb(7 if true_wall else 8) / 10
        off = float(abs(flint.arb(time) / truth[0] - 1)), float(abs(flint.arb(next_v) / (abs(truth[1]) * rebound) - 1))
        kappa = _conditions(motion, truth, (abs(tau - period * round(tau / period)), v))
    allowed = [max(least, 10 * k * EPSILON) for least, k in zip((1e-14, 1e-13), kappa, strict=True)]
    elsewhere = wall != true_wall or (off[0] > DRAW.wrong and off[0] > 100 * allowed[0])
    return off[0] / allowed[0], off[1] / allowed[1], float(elsewhere)


def _conditions(motion: Any, truth: tuple[Any, Any], state: tuple[float, float]) -> tuple[float, float]:
    """kappa of the flight time and of the velocity."""
    # in balls: a return after 1e-188 leaves derivatives that no double holds
    (time, u), e = truth, motion.at(truth[0])[2]
    sizes, total = (max(state[0], float(time)), state[1]), [1.0, 1.0]
    for (z_by, u_by), size in zip(motion.variations(time), sizes, strict=True):
        time_by = -z_by / u
        total[0] += float(abs(time_by / time) * size)
        total[1] += float(abs((u_by + e * time_by) / u) * size)
    return total[0], total[1]


def release_rows(model: Model, rng: np.random.Generator, regime: str) -> list[list[float]]:
    """Rows as those of `case`, of releases from rest with restitution 0; in place of v the next release."""
    # a_c is positive before the phase `zero`, and from its opposite on
    turn, zero = 2 * pi / model.omega, acos(float(model.pull)) / model.omega
    near = 10 ** rng.uniform(-14, -1, DRAW.each)
    phases = {
        "anywhere": rng.uniform(0, turn, DRAW.each),
        "pressed": rng.uniform(zero, turn - zero, DRAW.each),
        "rising": -zero + near,
        "falling": zero - near,
    }
    times = phases[regime] + turn * rng.integers(-3, 4, DRAW.each)
    releases = model.oscillator().replace(restitution=0).release_map(times)
    with balls_at(DRAW.bits):
        return [
            [float(status), *_release_errors(model, tau, float(landing), float(later), int(status)), tau, 0.0, nan, nan]
            for tau, landing, later, status in zip(times, releases.landing, releases.tau, releases.status, strict=True)
        ]


def _release_errors(model: Model, tau: float, landing: float, later: float, status: int) -> tuple[float, float, float]:
    """Errors of the landing and of the release after it, in units of what is allowed; 1 if wrong."""
    leaves = model.next_release(flint.arb(float(tau)))
    motion = model.motion(leaves, 0.0)
    truth = first_hit(motion, 0.0, model.horizon, 0.0 if leaves == tau else model.quiet_after_rest())
    if truth is None:
        return 0.0, 0.0, float(status == Status.hit and landing - float(leaves) < model.horizon)
    if status != Status.hit:
        return 0.0, 0.0, float(status != Status.unresolved)
    time, lands = float(truth[0]), leaves + truth[0]
    kappa = 1 + abs(float(motion.variations(truth[0])[0][0] / truth[1] * leaves)) / time
    allowed = max(1e-14, 10 * EPSILON * (kappa + abs(landing) / time))
    off = abs(float(flint.arb(landing) - lands)) / time / allowed
    push, after = float(model.motion(lands, 0.0).at(0)[2]), model.next_release(lands)
    # where a_c is 0 up to the error of the landing, both may be right
    late = abs(float(flint.arb(later) - after)) / time / allowed if abs(push) > 1e-6 else 0.0
    return off, late, float(max(off, late) > 100 and max(off, late) * allowed > DRAW.wrong)


@dataclass(frozen=True)
class Row:
    """States of one kind: how many, wrong, unresolved; the largest errors in units of what is allowed."""

    kind: str
    states: int
    wrong: int
    unresolved: int
    time_error: float
    velocity_error: float
    open: list[tuple[float, ...]]


def _row(kind: str, table: Array, kinds: list[str]) -> Row:
    rows = table[[index for index, name in enumerate(kinds) if name == kind]].reshape(-1, len(COLUMNS))
    status, time_error, velocity_error, wrong = rows.T[:4]
    undecided = rows[status == Status.unresolved, 4:]
    return Row(
        kind,
        len(rows),
        int(wrong.sum()),
        len(undecided),
        float(time_error.max()),
        float(velocity_error.max()),
        [tuple(row) for row in undecided.tolist()],
    )
