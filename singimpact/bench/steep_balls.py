"""Flights of steep families in balls: whether the fixed-step truth holds, and how large the errors of doubles are.

Balls cost a hundred times what the fixed steps cost, so they fly a part of the states.
"""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from time import process_time
from typing import Any, NamedTuple

import flint
import mpmath
import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.algebra.precision import balls_at
from singimpact.bench.steep_states import DRAW, drawn
from singimpact.bench.truth import enclosed_flight
from singimpact.bench.truth.enclosed_flight import Refused
from singimpact.bench.truth.graded_steps import FINENESS, HIT, MISS, UNDECIDED
from singimpact.cases import sweep
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.status import Status

DIGITS = 20
DIGITS_WRONG = 1e-19  # relative error of a number of 20 digits, one unit of the last
LEAST_ERROR = 2.0**-54  # an answer that is exact by chance has no finite ratio of estimate to error
COLUMNS = (
    "true_status",
    "time_error",
    "velocity_error",
    "step_time_error",
    "step_velocity_error",
    "digits_status",
    "digits_error",
    "seconds",
    "digits_seconds",
)


class Flown(NamedTuple):
    """A state by its case and launch, what the package and the fixed steps say of it, and whether digits are tried."""

    case: int
    launch: int
    flight_time: float
    velocity: float
    step_time: float
    step_velocity: float
    digits: bool


def check(
    columns_: dict[str, Array],
    sizes: tuple[int, int],
    seed: int,
    executor: Executor | None = None,
    output: str | Path | None = None,
) -> Enclosures:
    """Enclose some of the states of `steep_states.check`.

    Parameters
    ----------
    sizes : how many states are enclosed, and how many of these are also flown with `digits=20`.
    executor, output : as in `singimpact.cases.sweep`.
    """
    total = len(columns_["status"])
    picked = np.random.default_rng([seed, total]).permutation(total)[: sizes[0]]
    names = ("case", "launch", "flight_time", "velocity", "true_time", "true_velocity")
    chosen = zip(*(columns_[name][picked].tolist() for name in names), strict=True)
    states = [
        Flown(int(number), int(launch), time, velocity, true_time, true_velocity, index < sizes[1])
        for index, (number, launch, time, velocity, true_time, true_velocity) in enumerate(chosen)
    ]
    table = sweep(partial(enclosed, seed), states, executor, output).reshape(-1, len(COLUMNS))
    return summary(
        {name: column[picked] for name, column in columns_.items()}, dict(zip(COLUMNS, table.T, strict=True))
    )


def enclosed(seed: int, state: Flown) -> Array:
    """Relative errors of one state against its ball, in the order of COLUMNS; nan where there is nothing to compare."""
    case = drawn(seed, state.case)
    osc, tau, v = case.oscillator(), float(case.tau[state.launch]), float(case.v[state.launch])
    row = dict.fromkeys(COLUMNS, np.nan)
    begin = process_time()
    try:
        ball = enclosed_flight.first_hit(osc, tau, v, DRAW.horizon)
        row["true_status"] = MISS if ball.flight_time is None else HIT
    except Refused:
        row["true_status"] = UNDECIDED
    row["seconds"] = process_time() - begin
    if row["true_status"] == HIT:
        row.update(
            time_error=_off(state.flight_time, ball.flight_time),
            velocity_error=_off(state.velocity, ball.velocity),
            step_time_error=_off(state.step_time, ball.flight_time),
            step_velocity_error=_off(state.step_velocity, ball.velocity),
        )
        if state.digits:
            row.update(_with_digits(osc, (tau, v), ball.flight_time))
    return np.array([row[name] for name in COLUMNS])


def _with_digits(osc: ImpactOscillator, at: tuple[float, float], time: Any) -> dict[str, float]:
    """The result of `digits=20` for a state whose flight time is known."""
    begin = process_time()
    hit = osc.first_hit(*at, digits=DIGITS, horizon=DRAW.horizon)
    spent = process_time() - begin
    given = mpmath.nstr(hit.flight_time, 2 * DIGITS)
    error = _off(given, time) if hit.status == Status.hit else np.nan
    return {"digits_status": float(hit.status), "digits_error": error, "digits_seconds": spent}


def _off(found: float | str, ball: Any) -> float:
    """Relative error of a number against a ball, rounded up; nan for no number."""
    with balls_at(256):
        return float(abs(flint.arb(found) / ball - 1).upper())


@dataclass(frozen=True)
class Estimate:
    """An estimate of the error beside the true error: states, how often it is smaller, median of the ratio."""

    states: int
    below: int
    median: float


@dataclass(frozen=True)
class Enclosures:
    """Some states against balls.

    Parameters
    ----------
    states, refused : flights that were tried in balls, and that balls did not decide.
    agree, disagree, worst_step : flights of the fixed steps that end as the balls do, or otherwise, where both decide,
        and the largest relative error of a flight time of the fixed steps.
    worst, worst_velocity : largest error of the package's right hits in units of 10 kappa epsilon; the velocity's is
        nan while flights have no `velocity_condition`.
    time, velocity : the package's `error` and `velocity_error` against the true ones; None while flights have none.
    digits, digits_wrong, digits_unresolved : flights with `digits=20`.
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
    digits: int
    digits_wrong: int
    digits_unresolved: int
    seconds: float
    digits_seconds: float


def summary(columns_: dict[str, Array], balls: dict[str, Array]) -> Enclosures:
    """The counts, from columns of the same states."""
    decided = (balls["true_status"] != UNDECIDED) & (columns_["true_status"] != UNDECIDED)
    near = (balls["true_status"] == MISS) | (balls["step_time_error"] <= FINENESS.most)
    alike = decided & (balls["true_status"] == columns_["true_status"]) & near
    allowed = np.maximum(DRAW.wrong, 100 * columns_["condition"] * EPSILON)
    right = (columns_["status"] == Status.hit) & (balls["time_error"] <= allowed)
    tried = np.isfinite(balls["digits_status"])
    hit = balls["digits_status"] == Status.hit
    open_ = balls["digits_status"] == Status.unresolved
    bad = hit & ~(balls["digits_error"] <= DIGITS_WRONG) | (tried & ~hit & ~open_)
    return Enclosures(
        states=len(alike),
        refused=int((balls["true_status"] == UNDECIDED).sum()),
        agree=int(alike.sum()),
        disagree=int((decided & ~alike).sum()),
        worst_step=_most(balls["step_time_error"]),
        worst=_most((balls["time_error"] / (10 * columns_["condition"] * EPSILON))[right]),
        worst_velocity=_most((balls["velocity_error"] / (10 * columns_["velocity_condition"] * EPSILON))[right]),
        time=estimate(columns_["error"], balls["time_error"], columns_["status"] == Status.hit),
        velocity=estimate(columns_["velocity_error"], balls["velocity_error"], columns_["status"] == Status.hit),
        digits=int(tried.sum()),
        digits_wrong=int(bad.sum()),
        digits_unresolved=int(open_.sum()),
        seconds=float(balls["seconds"].mean()) if len(alike) else np.nan,
        digits_seconds=float(np.nanmean(balls["digits_seconds"])) if tried.any() else np.nan,
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
    known = values[np.isfinite(values)]
    return float(known.max()) if len(known) else np.nan
