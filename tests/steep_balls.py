"""States of steep families enclosed with 20 digits: whether fixed steps agree, and how large the errors of doubles are.

`python tests/steep_balls.py STATES BALLS CHECKED TWICE` prints a summary.

Enclosures share no code with the flights in doubles nor with the fixed steps, which they judge. They are judged
themselves, on some of the states, by the second program and by enclosures with 40 digits, which choose another degree,
other steps and another precision.
"""

from __future__ import annotations

import sys
from concurrent.futures import Executor
from dataclasses import asdict, dataclass
from fractions import Fraction
from functools import partial
from math import isfinite, nan
from pathlib import Path
from time import process_time
from typing import NamedTuple

import numpy as np

from singimpact.algebra import EPSILON, Array, Certified, exact, from_ball
from singimpact.bench import DRAW, FINENESS, HIT, MISS, UNDECIDED, allowed, second_program, steep_states
from singimpact.cases import sweep
from singimpact.certificates.checker import Refused
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.status import Status

FEWER, MORE = 20, 40  # digits
SECONDS = 2.0  # of CPU for a flight of the second program, which decides every second steep state within that
LEAST_ERROR = 2.0**-54  # an answer that is exact by chance has no finite ratio of estimate to error
COLUMNS = (
    "true_status",
    "time_error",
    "velocity_error",
    "step_time_error",
    "checked",
    "twice",
    "seconds",
    "more_seconds",
)
# of two enclosures of one flight: APART where they end otherwise or no number lies in both
VERDICTS = AGREE, APART, OPEN = range(3)


class Flown(NamedTuple):
    """A state by its case and launch, what doubles and fixed steps say, and whether its enclosure is judged itself."""

    case: int
    launch: int
    flight_time: float
    velocity: float
    step_time: float
    checked: bool
    twice: bool


def check(
    columns_: dict[str, Array],
    sizes: tuple[int, int, int],
    seed: int,
    executor: Executor | None = None,
    output: str | Path | None = None,
) -> Enclosures:
    """Enclose some of the states of `steep_states.check`.

    Parameters
    ----------
    sizes : how many states are enclosed, and how many of these by the second program too, and with 40 digits too.
    executor, output : as in `singimpact.cases.sweep`.
    """
    total = len(columns_["status"])
    picked = np.random.default_rng([seed, total]).permutation(total)[: sizes[0]]
    names = ("case", "launch", "flight_time", "velocity", "true_time")
    chosen = zip(*(columns_[name][picked].tolist() for name in names), strict=True)
    states = [
        Flown(int(number), int(launch), time, velocity, true_time, index < sizes[1], index < sizes[2])
        for index, (number, launch, time, velocity, true_time) in enumerate(chosen)
    ]
    table = sweep(partial(enclosed, seed), states, executor, output).reshape(-1, len(COLUMNS))
    return summary(
        {name: column[picked] for name, column in columns_.items()}, dict(zip(COLUMNS, table.T, strict=True))
    )


def enclosed(seed: int, state: Flown) -> Array:
    """The enclosure of one state, in the order of COLUMNS; nan where there is nothing to compare."""
    case = steep_states.drawn(seed, state.case)
    osc, at = case.oscillator(), (float(case.tau[state.launch]), float(case.v[state.launch]))
    row = dict.fromkeys(COLUMNS, np.nan)
    numbers, row["seconds"] = by_digits(osc, at, FEWER)
    row["true_status"] = UNDECIDED if numbers is None else HIT if numbers else MISS
    if numbers:
        time, velocity = numbers
        row["time_error"], row["velocity_error"] = _off(state.flight_time, time), _off(state.velocity, velocity)
        row["step_time_error"] = _off(state.step_time, time)
    if state.checked:
        row["checked"] = judged(numbers, _by_second_program(osc, at))
    if state.twice:
        more, row["more_seconds"] = by_digits(osc, at, MORE)
        row["twice"] = judged(numbers, more)
    return np.array([row[name] for name in COLUMNS])


# Flight time and velocity of a hit; empty where none comes before the horizon, None where that is not decided.
Numbers = list[Certified] | None


def by_digits(osc: ImpactOscillator, at: tuple[float, float], digits: int) -> tuple[Numbers, float]:
    """Numbers that the package's enclosure shows, and the seconds of CPU that it took."""
    begin = process_time()
    hit = osc.first_hit(*at, digits=digits, horizon=DRAW.horizon)
    spent = process_time() - begin
    # a hit without `certified` has the digits of two precisions that agree: no enclosure, so it decides nothing
    if hit.status == Status.no_return:
        return [], spent
    return None if hit.certified is None else [hit.certified.flight_time, hit.certified.velocity], spent


def _by_second_program(osc: ImpactOscillator, at: tuple[float, float]) -> Numbers:
    """Numbers that the program that checks certificates shows."""
    try:
        ball = second_program(osc, *at, DRAW.horizon, SECONDS)
    except Refused:
        return None
    return [] if ball is None else [from_ball(part, MORE) for part in ball]


def judged(one: Numbers, other: Numbers) -> int:
    """Whether two enclosures of one flight can both be right.

    Examples
    --------
    >>> import mpmath
    >>> near, far = ([Certified(mpmath.mpf(x), mpmath.mpf("0.01"), 3)] for x in ("1.01", "1.05"))
    >>> [judged(near, other) for other in (near, far, [], None)] == [AGREE, APART, APART, OPEN]
    True
    """
    if one is None or other is None:
        return OPEN
    return AGREE if len(one) == len(other) and not any(map(_disjoint, one, other)) else APART


def _disjoint(one: Certified, other: Certified) -> bool:
    """Whether no number lies within both radii."""
    value = [exact("value", interval.value) for interval in (one, other)]
    radii: Fraction = sum((exact("radius", interval.radius) for interval in (one, other)), Fraction(0))
    return abs(value[0] - value[1]) > radii


def _off(number: float, true: Certified) -> float:
    """Relative error of a double; nan of nan."""
    return float(abs(Fraction(number) / exact("true", true.value) - 1)) if isfinite(number) else nan


@dataclass(frozen=True)
class Estimate:
    """An estimate of the error beside the true error: states, how often it is smaller, median of the ratio."""

    states: int
    below: int
    median: float


@dataclass(frozen=True)
class Enclosures:
    """Some states enclosed.

    Parameters
    ----------
    states, refused : flights that were enclosed, and that no enclosure decides.
    agree, disagree, worst_step : flights of the fixed steps that end as the enclosures do, or otherwise, where both
        decide, and the largest relative error of a flight time of the fixed steps.
    worst, worst_velocity : largest error of the package's right hits in units of 10 kappa epsilon; the velocity's is
        nan while flights have no `velocity_condition`.
    time, velocity : the package's `error` and `velocity_error` against the true ones; None while flights have none.
    checked, twice : (agree, apart, not decided) of enclosures beside the second program, and beside more digits.
    seconds, more_seconds : mean CPU time of an enclosure with 20 and with 40 digits.
    """

    states: int
    refused: int
    agree: int
    disagree: int
    worst_step: float
    worst: float
    worst_velocity: float
    time: Estimate | None
    velocity: Estimate | None
    checked: tuple[int, ...]
    twice: tuple[int, ...]
    seconds: float
    more_seconds: float

    @property
    def wrong(self) -> bool:
        """Whether fixed steps or an enclosure are wrong, or an estimate of the error is too small."""
        below = any(estimate is not None and estimate.below for estimate in (self.time, self.velocity))
        return bool(self.disagree or self.checked[APART] or self.twice[APART] or below)


def summary(columns_: dict[str, Array], balls: dict[str, Array]) -> Enclosures:
    """The counts, from columns of the same states."""
    decided = (balls["true_status"] != UNDECIDED) & (columns_["true_status"] != UNDECIDED)
    near = (balls["true_status"] == MISS) | (balls["step_time_error"] <= FINENESS.most)
    alike = decided & (balls["true_status"] == columns_["true_status"]) & near
    hit = columns_["status"] == Status.hit
    right = hit & (balls["time_error"] <= allowed(columns_))
    return Enclosures(
        states=len(alike),
        refused=int((balls["true_status"] == UNDECIDED).sum()),
        agree=int(alike.sum()),
        disagree=int((decided & ~alike).sum()),
        worst_step=_most(balls["step_time_error"]),
        worst=_most((balls["time_error"] / (10 * columns_["condition"] * EPSILON))[right]),
        worst_velocity=_most((balls["velocity_error"] / (10 * columns_["velocity_condition"] * EPSILON))[right]),
        time=estimate(columns_["error"], balls["time_error"], hit),
        velocity=estimate(columns_["velocity_error"], balls["velocity_error"], hit),
        checked=tuple(int((balls["checked"] == verdict).sum()) for verdict in VERDICTS),
        twice=tuple(int((balls["twice"] == verdict).sum()) for verdict in VERDICTS),
        seconds=_mean(balls["seconds"]),
        more_seconds=_mean(balls["more_seconds"]),
    )


def estimate(estimates: Array, true: Array, hit: Array) -> Estimate | None:
    """An estimate of the package beside the true error; None where no flight has one.

    Examples
    --------
    >>> import numpy as np
    >>> estimate(np.array([2e-16, 3e-16]), np.array([1e-16, 6e-16]), np.array([True, True]))
    Estimate(states=2, below=1, median=1.25)
    """
    if not np.isfinite(estimates).any():
        return None
    used = hit & np.isfinite(true)
    # a hit without an estimate counts as below
    below = used & ~(estimates >= true)
    ratio = estimates[used] / np.maximum(true[used], LEAST_ERROR)
    return Estimate(int(used.sum()), int(below.sum()), float(np.median(ratio)) if len(ratio) else np.nan)


def _most(values: Array) -> float:
    return float(np.max(values[np.isfinite(values)])) if np.isfinite(values).any() else nan


def _mean(values: Array) -> float:
    return float(np.mean(values[np.isfinite(values)])) if np.isfinite(values).any() else nan


if __name__ == "__main__":
    states, *sizes = map(int, sys.argv[1:])
    for measure, value in asdict(check(steep_states.check(states, 0).columns, sizes, 0)).items():
        print(f"{measure}: {value}")
