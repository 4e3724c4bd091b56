"""Random states, flown by the impact map and by the slow one of `bench.truth`: what is wrong, how large the errors are.

A case is a model and some states; it is drawn from its number and the seed alone, so cases run anywhere, in any order.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from math import log2, pi
from typing import Any

import flint
import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.algebra.precision import balls_at
from singimpact.bench.truth.first_hit import Cubic, Linear, first_hit
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
COLUMNS = ("status", "time_error", "velocity_error", "wrong", "tau", "v", "depth", "bound")


def check(count: int, seed: int, executor: Any = None, output: Any = None) -> list[Row]:
    """Fly `count` states, rounded up to whole cases; a row a kind of state.

    Parameters
    ----------
    executor, output : as in `singimpact.cases.sweep`; an interrupted check goes on.
    """
    numbers = range(-(-count // DRAW.each))
    table = sweep(partial(case, seed), numbers, executor, output)
    kinds = [kind_of(number) for number in numbers]
    return [_row(kind, table, kinds) for kind in dict.fromkeys(kinds)]


def kind_of(number: int) -> str:
    """Family and regime of a case."""
    family = "cubic" if number % DRAW.cubic == 0 else "linear"
    turn = number // DRAW.cubic if family == "cubic" else number
    return f"{family} {REGIMES[turn % len(REGIMES)]}"


def case(seed: int, number: int) -> Array:
    """An array (states, COLUMNS); errors in units of what is allowed."""
    family, regime = kind_of(number).split()
    rng = np.random.default_rng([seed, number])
    omega, clearance, states = _drawn(rng, family, regime)
    tau, v = np.array(states).T
    if family == "linear":
        osc = linear(omega, clearance, "0.8")
    else:
        osc = ImpactOscillator("x + xdot/10 + 3*x**3/10", "cos(omega*t)", clearance, "0.8", {"omega": omega})
    step = osc.impact_map(tau, v, horizon=_horizon(family, omega))
    rows = []
    for index, (start, speed) in enumerate(states):
        one = [
            float(np.ravel(field)[index]) for field in (step.status, step.flight_time, step.v, step.depth, step.bound)
        ]
        rows.append([one[0], *_errors(family, omega, clearance, start, speed, one), start, speed, *one[3:]])
    return np.array(rows)


def _horizon(family: str, omega: float) -> float:
    return 2000 * pi / omega if family == "linear" else DRAW.horizon


def _motion(family: str, omega: float, clearance: float, tau: float, v: float, sign: int = 1) -> Any:
    return Linear(omega, clearance, tau, v) if family == "linear" else Cubic(omega, clearance, tau, v, sign)


def _drawn(rng: Any, family: str, regime: str) -> tuple[float, float, list[tuple[float, float]]]:
    """omega, clearance, and states (tau, v)."""
    if regime == "long":
        near = [1.0, 1 + 1e-12, 1 - 1e-12, 1 + 10 ** rng.uniform(-9, -1.3), 1 - 10 ** rng.uniform(-9, -1.3)]
        omega = float(rng.choice(near))
        clearance = float(-rng.uniform(3, 60) if family == "linear" else -rng.uniform(0.7, 1.6))
    else:
        omega, clearance = float(rng.uniform(0.3, 3.5)), float(rng.uniform(-0.9, 0.9))
    states: list[tuple[float, float]] = []
    for _ in range(DRAW.tries * DRAW.each):
        tau, v = float(rng.uniform(-1, 1) * 2 * pi / omega), float(rng.uniform(0.01, 3))
        if regime == "low":
            v = float(10 ** rng.uniform(-12, -3) if rng.random() < 0.9 else 10 ** rng.uniform(-300, -12))
        states += _grazing(rng, family, omega, clearance, tau) if regime == "graze" else [(tau, v)]
        if len(states) == DRAW.each:
            return omega, clearance, states
    return _drawn(rng, family, regime)  # few flights of that model touch: another one


def _grazing(rng: Any, family: str, omega: float, clearance: float, tau: float) -> Iterator[tuple[float, float]]:
    """A state that a flight run backwards from a touch at tau started from, moved off it by 1e-10 to 1e-4."""
    with balls_at(DRAW.bits):
        motion = _motion(family, omega, clearance, -tau, 0.0, -1)
        if not motion.at(0)[2] > 1e-3:
            return
        found = first_hit(motion, 0.0, 60.0)
    if found is not None:
        v = -float(found[1]) * (1 + float(rng.choice([-1, 1])) * 10 ** rng.uniform(-10, -4))
        yield tau - float(found[0]), v


def _errors(
    family: str, omega: float, clearance: float, tau: float, v: float, errors: list[float]
) -> tuple[float, float, float]:
    """Errors of flight time and velocity in units of max(1e-14, 10 kappa eps), max(1e-13, 10 kappa eps); 1 if wrong."""
    status, time, next_v = errors[:3]
    period = 2 * pi / omega
    with balls_at(DRAW.bits + int(4 * max(-log2(v), 0))):
        motion = _motion(family, omega, clearance, tau, v)
        truth = first_hit(motion, v, _horizon(family, omega))
        if truth is None:
            return 0.0, 0.0, float(status not in (Status.no_return, Status.escaped, Status.unresolved))
        if status != Status.hit:
            return 0.0, 0.0, float(status != Status.unresolved)
        off = float(abs(flint.arb(time) / truth[0] - 1)), float(abs(flint.arb(next_v) / (-truth[1] * 4 / 5) - 1))
        kappa = _conditions(motion, truth, (abs(tau - period * round(tau / period)), v))
    allowed = [max(least, 10 * k * EPSILON) for least, k in zip((1e-14, 1e-13), kappa, strict=True)]
    return off[0] / allowed[0], off[1] / allowed[1], float(off[0] > DRAW.wrong and off[0] > 100 * allowed[0])


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
