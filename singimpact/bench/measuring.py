"""A case of a group: its methods timed in turn, again and again, their answers judged against the truth.

CPU time of this process and of its children, or of a fresh one where a method brings its own clock; a first round,
not counted, compiles.
Ratios are taken within a round, for the rounds of a busy machine differ more than the methods of one round.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import ceil, isfinite
from typing import Any

import numpy as np

from singimpact.inputs import InputError

if sys.platform != "win32":
    import resource

EPSILON = 2.0**-52
Run = Callable[[], Any]


class NotInstalled(InputError):
    """A peer that is not there: the case goes on without it, and the table names it."""


@dataclass(frozen=True)
class Effort:
    """How much is measured.

    Parameters
    ----------
    quick : fewer cases and settings. rounds : timings of each method.
    least : CPU seconds of a timing at least, reached by calling again; the clock ticks in microseconds.
    once : a method that takes so many seconds is timed once after the first round: its noise is below its length.
    fresh : rounds of a method that runs in a process of its own, which costs a second beside what is timed.
    states : of a regime. copies : of a state in an array or a compiled loop.
    """

    quick: bool = False
    rounds: int = 7
    least: float = 2e-3
    once: float = 2.0
    fresh: int = 3
    states: int = 40
    copies: int = 100


FULL = Effort()
QUICK = Effort(quick=True, rounds=3, least=5e-4, once=0.02, fresh=1, states=4, copies=8)


@dataclass(frozen=True)
class Judged:
    """How answers are compared.

    Parameters
    ----------
    digits : decimal digits of the comparison, beyond those of any truth.
    least : relative error that is always allowed: rounding of the answer and of what it is made of (DESIGN, Accuracy).
    """

    digits: int = 400
    least: float = 1e-14


JUDGED = Judged()


@dataclass(frozen=True)
class Timed:
    """Answers of a method that brings its own clock."""

    seconds: float
    answers: Sequence[Any]


@dataclass(frozen=True)
class Method:
    """One way to the answers of a case.

    Parameters
    ----------
    name, setting : as the table shows them; one that begins with "singimpact" calls public names only, "kernel" is a
        private function of the package. run : gives an answer a problem; None or nan where it has none.
    size : what the cost grows with. copies : how often a run solves each problem.
    epsilon : of the arithmetic; answers may be off by ten times their condition times this.
    problems : by which the time of a run is divided; without it by its answers.
    first : the first round is what is asked: what is computed then is kept.
    """

    name: str
    setting: str
    run: Run
    size: float | None = None
    copies: int = 1
    epsilon: float = EPSILON
    problems: int | None = None
    first: bool = False


@dataclass(frozen=True)
class Case:
    """Problems with one truth; the first method is what the others are compared with.

    Parameters
    ----------
    truth : a number or its decimal text a problem; empty where only time is measured.
    conditions : of the problems. skipped : peers that are not installed.
    missed : relative error of another answer altogether: the next impact is further away than this.
    """

    name: str
    methods: Sequence[Method]
    truth: Sequence[Any] = ()
    conditions: Sequence[float] = ()
    skipped: Sequence[str] = ()
    missed: float = 1e-2


@dataclass(frozen=True)
class Row:
    """What a method at a setting costs and gives.

    Parameters
    ----------
    microseconds : of a problem, median of the rounds. error : relative, median of the problems; None without a truth.
    wrong : answers off by more than ten times condition times epsilon, or absent. missed : of these, the ones that are
        absent or off by more than a hundredth: another impact. of : problems.
    ratio, spread : time over that of the first method of the case, median and quartiles. rounds : timings.
    """

    group: str
    case: str
    method: str
    setting: str
    size: float | None
    microseconds: float
    error: float | None
    wrong: int | None
    missed: int | None
    of: int
    ratio: float
    spread: tuple[float, float]
    rounds: int


@dataclass
class Measured:
    """The rows of a group, and the peers that were not installed."""

    group: str
    rows: list[Row] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)


def with_peers(own: Sequence[Method], *peers: Callable[[], Sequence[Method]]) -> tuple[list[Method], list[str]]:
    """The methods of a case, and the names of peers that are not installed.

    Examples
    --------
    >>> def absent():
    ...     raise NotInstalled("heyoka")
    >>> with_peers([], absent)
    ([], ['heyoka'])
    """
    methods, skipped = list(own), []
    for peer in peers:
        try:
            methods += peer()
        except NotInstalled as error:
            skipped.append(str(error))
    return methods, skipped


def measure(group: str, case: Case, effort: Effort) -> list[Row]:
    """A row a method."""
    first = [_timed(method.run) for method in case.methods]
    rounds = [_rounds(method, fresh, effort) for method, (_, _, fresh) in zip(case.methods, first, strict=True)]
    spent = np.array([[seconds for seconds, _, _ in first]] * effort.rounds)
    for at in (at for at, count in enumerate(rounds) if count):
        if not first[at][2]:  # a process of its own is as cold the second time
            spent[:, at] = _timed(case.methods[at].run)[0]
        if spent[0, at] >= effort.once:
            rounds[at] = 0
    calls = [1 if fresh else max(ceil(effort.least / max(seconds, 1e-7)), 1)
             for (_, _, fresh), seconds in zip(first, spent[0], strict=True)]  # fmt: skip
    for turn in range(effort.rounds):
        for at in (at for at, count in enumerate(rounds) if count):
            again = turn < rounds[at]
            spent[turn, at] = _timed(case.methods[at].run, calls[at])[0] if again else spent[turn % rounds[at], at]
    for at, (method, (_, answers, _)) in enumerate(zip(case.methods, first, strict=True)):
        spent[:, at] /= method.copies * (method.problems or max(len(answers), 1))
    return [_row(group, case, method, answers, spent[:, at], spent[:, at] / spent[:, 0], max(rounds[at], 1))
            for at, (method, (_, answers, _)) in enumerate(zip(case.methods, first, strict=True))]  # fmt: skip


def _rounds(method: Method, fresh: bool, effort: Effort) -> int:
    """How often a method is timed after the first round; not at all where that one is what is asked."""
    if method.first or (fresh and effort.fresh == 1):
        return 0
    return min(effort.fresh, effort.rounds) if fresh else effort.rounds


def cpu_seconds() -> float:
    """CPU seconds of this process and of its children that have ended, as those of a pool that was shut down."""
    if sys.platform == "win32":  # which does not count those of children
        return time.process_time()
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + ended.ru_utime + ended.ru_stime


def _timed(run: Run, calls: int = 1) -> tuple[float, Sequence[Any], bool]:
    """CPU seconds of a run, the mean of some calls; its answers; whether it brought its own clock."""
    start = cpu_seconds()
    for _ in range(calls):
        found = run()
    spent = (cpu_seconds() - start) / calls
    return (found.seconds, found.answers, True) if isinstance(found, Timed) else (spent, found, False)


def _row(group: str, case: Case, method: Method, answers: Sequence[Any], spent: Any, ratios: Any, rounds: int) -> Row:
    error = wrong = missed = None
    of = min(len(answers), len(case.truth)) if case.truth else method.problems or len(answers)
    if case.truth:
        errors = [relative_error(found, truth) for found, truth in zip(answers, case.truth, strict=False)]
        conditions = case.conditions or [1.0] * len(errors)
        allowed = [max(_least(method), 10 * kappa * method.epsilon) for kappa in conditions]
        wrong = sum(not off <= most for off, most in zip(errors, allowed, strict=False))
        missed = sum(not off <= case.missed for off in errors)
        seen = [off for off in errors if isfinite(off)]
        error = float(np.median(seen)) if seen else None
    low, middle, high = np.quantile(ratios, [0.25, 0.5, 0.75]).tolist()
    return Row(group, case.name, method.name, method.setting, method.size, float(np.median(spent)) * 1e6, error, wrong,
               missed, of, middle, (low, high), rounds)  # fmt: skip


def _least(method: Method) -> float:
    return JUDGED.least if method.epsilon == EPSILON else 0.0


def relative_error(found: Any, truth: Any) -> float:
    """|found/truth - 1|; inf without an answer.

    Examples
    --------
    >>> relative_error(0.75, "0.5"), relative_error(None, 1), relative_error(float("nan"), 1)
    (0.5, inf, inf)
    """
    import mpmath

    if found is None:
        return float("inf")
    with mpmath.workdps(JUDGED.digits):
        off = abs(mpmath.mpf(found) / mpmath.mpf(truth) - 1)
        return float("inf") if mpmath.isnan(off) else float(off)


def condition(function: Callable[[float, float], float], tau: float, v: float, step: float = 1e-6) -> float:
    """1 + (|dF/dtau| |tau| + |dF/dv| v)/|F| by central differences: enough for a bound of ten times.

    Examples
    --------
    >>> round(condition(lambda tau, v: tau * v, 2.0, 3.0), 6)
    3.0
    """
    value = abs(function(tau, v))
    by_tau = function(tau * (1 + step), v) - function(tau * (1 - step), v)
    by_v = function(tau, v * (1 + step)) - function(tau, v * (1 - step))
    return 1 + (abs(by_tau) + abs(by_v)) / (2 * step * value)
