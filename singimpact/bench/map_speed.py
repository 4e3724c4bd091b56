"""The impact map beside what a user would pick instead: CPU time and wrong impacts on the reference states."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.bench.peers import runge_kutta, taylor_events
from singimpact.bench.problems import Problem, states
from singimpact.codegen.kernels import compiled
from singimpact.flights.hits import EPSILON, doubles
from singimpact.flights.kernel import kernel_of
from singimpact.flights.launch import States, known_accelerations, launches
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.tables import STRIDES, table_of

REGIMES = ("generic", "chatter", "graze", "long")


@dataclass(frozen=True)
class Effort:
    """How much is measured.

    Parameters
    ----------
    problems : of a regime; slow : of scipy, which takes a thousand times longer.
    repeats : of a flight in a compiled loop; calls : of one in a peer, whose call is part of its price.
    wrong : a flight time that is off by this part is a wrong impact.
    """

    problems: int = 200
    slow: int = 12
    repeats: int = 200
    calls: int = 20
    wrong: float = 1e-6


EFFORT = Effort()


@dataclass(frozen=True)
class Row:
    """Microseconds of a flight, median over the states, and how many impacts are wrong."""

    family: str
    regime: str
    method: str
    microseconds: float
    wrong: int
    of: int


def compare(effort: Effort = EFFORT, told: Callable[[str], None] = lambda _: None) -> list[Row]:
    """All rows; compile time is left out."""
    rows: list[Row] = []
    for family in ("linear", "duffing"):
        peers = {"heyoka": taylor_events.stepper(family), "scipy DOP853 1e-9": runge_kutta.stepper(family)}
        for regime in REGIMES:
            problems = [p for p in states(family) if p.regime == regime][: effort.problems]
            told(f"{family} {regime}")
            own = [_own(problem, effort.repeats) for problem in problems]
            rows.append(_row(family, regime, "singimpact", own, problems, effort))
            for name, fly in peers.items():
                few = problems[: effort.slow] if name.startswith("scipy") else problems
                calls = 1 if name.startswith("scipy") else effort.calls
                rows.append(_row(family, regime, name, [_peer(fly, p, calls) for p in few], few, effort))
        rows += _all_regimes(family, rows)
    return rows


def _all_regimes(family: str, rows: list[Row]) -> list[Row]:
    """A row a method for all states of a family: the mean over regimes, weighted by their states."""
    own = {row.regime: row.of for row in rows if (row.family, row.method) == (family, "singimpact")}
    made = []
    for method in dict.fromkeys(row.method for row in rows if row.family == family):
        part = [row for row in rows if (row.family, row.method) == (family, method) and row.of]
        weight = sum(own[row.regime] for row in part)
        if weight:
            mean = sum(row.microseconds * own[row.regime] for row in part) / weight
            made.append(Row(family, "all", method, mean, sum(row.wrong for row in part), sum(row.of for row in part)))
    return made


def _row(
    family: str, regime: str, method: str, measured: list[tuple[float, float]], problems: list[Problem], effort: Effort
) -> Row:
    wrong = sum(not abs(found / float(p.flight_time) - 1) < effort.wrong
                for (_, found), p in zip(measured, problems, strict=True))  # fmt: skip
    return Row(family, regime, method, float(np.median([spent for spent, _ in measured])), wrong, len(problems))


def _own(problem: Problem, repeats: int) -> tuple[float, float]:
    """Microseconds of one flight in a compiled loop over equal states, and its flight time."""
    osc = problem.model()
    kernel, given = kernel_of(osc), States.read(np.full(repeats, problem.tau), problem.v)
    p, order = doubles(kernel), degree_for(EPSILON)
    start = (launches(osc, kernel, given.tau), given.v.copy(), np.ones(repeats, dtype=np.int64),
             known_accelerations(osc, given))  # fmt: skip
    work = np.zeros(order + 2), np.zeros((kernel.rows, order + 2)), np.zeros(order + 2)
    status, numbers = np.empty(repeats, dtype=np.int8), np.empty((repeats, 4))
    space, table, ulp = compiled(kernel.text, kernel.names), table_of(kernel, p), LIMITS.safety * EPSILON
    rest: tuple[Any, ...] = (1000.0, ulp, p)
    loop = space["run"]
    tail: tuple[Any, ...] = (order, *rest)
    if table is not None:
        loop, tail = space["stride_all"], (STRIDES.order, order, *rest, table.step, table.rows, table.bound)
    loop(*(part[:1] for part in start), *tail, *work, status, numbers)
    spent = -time.thread_time()
    loop(*start, *tail, *work, status, numbers)
    spent += time.thread_time()
    return spent / repeats * 1e6, float(numbers[0, 0]) if status[0] == 0 else float("nan")


def _peer(fly: Callable[[Problem], tuple[float, float]], problem: Problem, calls: int) -> tuple[float, float]:
    found, _ = fly(problem)
    spent = -time.thread_time()
    for _ in range(calls):
        fly(problem)
    spent += time.thread_time()
    return spent / calls * 1e6, found


def ratios(rows: list[Row]) -> dict[tuple[str, str, str], float]:
    """How many times longer a peer takes, by family, regime and peer."""
    own = {(row.family, row.regime): row.microseconds for row in rows if row.method == "singimpact"}
    return {
        (row.family, row.regime, row.method): row.microseconds / own[row.family, row.regime]
        for row in rows
        if row.method != "singimpact" and row.of
    }
