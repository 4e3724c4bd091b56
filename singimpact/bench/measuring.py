"""A case of a group: its methods timed in turn, again and again, their answers judged against the truth.

CPU time of this process and of its children, or of a fresh one where a method brings its own clock; a first round,
not counted, compiles.
Ratios are taken within a round, for the rounds of a busy machine differ more than the methods of one round.
"""

import atexit
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import isfinite
from pathlib import Path
from typing import Any

import mpmath
import numpy as np

from singimpact.algebra.numbers import EPSILON
from singimpact.bench.stress.judging import number
from singimpact.inputs import InputError

if sys.platform != "win32":
    import resource


class NotInstalled(InputError):
    """A peer that is not installed. The case is measured without it, and the table names it."""


@dataclass(frozen=True)
class Effort:
    """Numbers of cases, rounds and seconds of a measurement.

    Parameters
    ----------
    quick : fewer cases and settings. rounds : timings of each method.
    least : CPU seconds of a timing at least, reached by calling again; the clock ticks in microseconds.
    once : a method that takes so many seconds is timed once after the first round: its noise is below its length.
    fresh : rounds of a method that runs in a process of its own, which costs a second beside what is timed.
    judged : random states whose answers are compared with the truth.
    """

    quick: bool = False
    rounds: int = 7
    least: float = 2e-3
    once: float = 2.0
    fresh: int = 3
    judged: int = 400


FULL = Effort()
QUICK = Effort(quick=True, rounds=3, least=5e-4, once=0.02, fresh=1, judged=40)


DIGITS = 400  # decimal digits in which answers are compared with the truth, beyond those of any truth
# relative error that is always allowed: rounding of the answer and of what it is made of (DESIGN, Accuracy)
LEAST = 1e-14


@dataclass(frozen=True)
class Timed:
    """Answers of a method that brings its own clock."""

    seconds: float
    answers: Sequence[Any]


@dataclass(frozen=True)
class Counted:
    """Answers of a run whose number of problems is known only afterwards, such as the impacts of an orbit."""

    problems: int
    answers: Sequence[Any]


@dataclass(frozen=True)
class Aim:
    """The figure that a method should reach.

    Parameters
    ----------
    microseconds : of a problem, at most.
    """

    microseconds: float | None = None

    def reached(self, microseconds: float, wrong: int | None) -> bool | None:
        """Whether a measured time is within the aim, with no answer wrong; None where there is no aim.

        Examples
        --------
        >>> Aim(6.0).reached(5.0, 0), Aim(6.0).reached(5.0, 2)
        (True, False)
        """
        return None if self.microseconds is None else microseconds <= self.microseconds and not wrong


NO_AIM = Aim()


@dataclass(frozen=True)
class Method:
    """One way to the answers of a case.

    Parameters
    ----------
    name, setting : as the table shows them; one that begins with "singimpact" calls public names only. run : gives an
        answer a problem; None or nan where it has none.
    epsilon : of the arithmetic; answers may be off by ten times their condition times this.
    problems : by which the time of a run is divided; without it by its answers.
    draw : makes other problems for every timed call, outside the clock; `run` takes them. The first ones are judged.
    aim : what is to be reached.
    """

    name: str
    setting: str
    run: Callable[..., Any]
    epsilon: float = EPSILON
    problems: int | None = None
    draw: Callable[[], Any] | None = None
    aim: Aim = NO_AIM


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
    """Cost and error of a method at a setting.

    Parameters
    ----------
    microseconds : of a problem, median of the rounds. error : relative, median of the problems; None without a truth.
    wrong : answers off by more than ten times condition times epsilon, or absent. missed : of these, the ones that are
        absent or off by more than a hundredth: another impact. of : problems.
    ratio, spread : time over that of the first method of the case, median and quartiles. rounds : timings.
    aim : what is to be reached. reached : whether it is, with no answer wrong; None without an aim.
    problems : by which the time of a run was divided.
    """

    group: str
    case: str
    method: str
    setting: str
    microseconds: float
    error: float | None
    wrong: int | None
    missed: int | None
    of: int
    ratio: float
    spread: tuple[float, float]
    rounds: int
    aim: Aim
    reached: bool | None
    problems: float = 1.0


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


@dataclass(frozen=True)
class _Turn:
    """CPU seconds of a run, the problems solved in it, its answers; whether it brought its own clock."""

    seconds: float
    problems: float
    answers: Sequence[Any]
    fresh: bool

    @property
    def each(self) -> float:
        return self.seconds / self.problems


def measure(group: str, case: Case, effort: Effort) -> list[Row]:
    """A row a method."""
    # the first turn compiles; its answers are judged, its time is not counted unless it is the only one
    first = [_turn(method) for method in case.methods]
    of_processes = 0 if effort.fresh == 1 else min(effort.fresh, effort.rounds)
    rounds = [of_processes if turn.fresh else effort.rounds for turn in first]
    begun, calls = list(first), [1] * len(first)
    for at in (at for at, count in enumerate(rounds) if count):
        if not first[at].fresh:  # a process of its own is as cold the second time
            begun[at] = _turn(case.methods[at])
            # the clock ticks in microseconds, and calls after other methods are cold: short ones are timed together
            while begun[at].seconds * calls[at] < effort.least:
                calls[at] *= 2
                begun[at] = _turn(case.methods[at], calls[at])
        if begun[at].seconds >= effort.once:
            rounds[at] = 0
    spent = np.array([[turn.each for turn in begun]] * effort.rounds)
    for turn in range(effort.rounds):
        for at in (at for at, count in enumerate(rounds) if count):
            # a method with fewer rounds repeats its measured times, so that each round has a ratio
            again = turn < rounds[at]
            spent[turn, at] = _turn(case.methods[at], calls[at]).each if again else spent[turn % rounds[at], at]
    return [
        _row(group, case, method, turn, (spent[:, at], spent[:, at] / spent[:, 0], max(rounds[at], 1)))
        for at, (method, turn) in enumerate(zip(case.methods, first, strict=True))
    ]


def cpu_seconds() -> float:
    """CPU seconds of this process and of its children that have ended, as those of a pool that was shut down."""
    if sys.platform == "win32":  # which does not count those of children
        return time.process_time()
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + ended.ru_utime + ended.ru_stime


def _turn(method: Method, calls: int = 1) -> _Turn:
    """A method timed: the mean of some calls, on the same problems, or on others each time where they are drawn."""
    draws = [() if method.draw is None else (method.draw(),) for _ in range(calls)]
    start = cpu_seconds()
    answers = [method.run(*arguments) for arguments in draws]
    spent = (cpu_seconds() - start) / calls
    problems = (
        sum(
            arguments.problems
            if isinstance(arguments, Counted)
            else method.problems or max(len(_answers(arguments)), 1)
            for arguments in answers
        )
        / calls
    )
    last = answers[-1]
    if isinstance(last, Timed):
        return _Turn(last.seconds, problems, last.answers, True)
    return _Turn(spent, problems, _answers(last), False)


def _answers(found: Any) -> Sequence[Any]:
    return found.answers if isinstance(found, Timed | Counted) else found


def _row(group: str, case: Case, method: Method, turn: _Turn, timings: tuple[Any, Any, int]) -> Row:
    answers, (spent, ratios, rounds) = turn.answers, timings
    error = wrong = missed = None
    of = min(len(answers), len(case.truth)) if case.truth else method.problems or len(answers)
    if case.truth:
        errors = [relative_error(answer, truth) for answer, truth in zip(answers, case.truth, strict=False)]
        conditions = case.conditions or [1.0] * len(errors)
        least = LEAST if method.epsilon == EPSILON else 0.0
        allowed = [max(least, 10 * kappa * method.epsilon) for kappa in conditions]
        wrong = sum(not off <= most for off, most in zip(errors, allowed, strict=False))
        missed = sum(not off <= case.missed for off in errors)
        seen = [off for off in errors if isfinite(off)]
        error = float(np.median(seen)) if seen else None
    low, middle, high = np.quantile(ratios, [0.25, 0.5, 0.75]).tolist()
    microseconds = float(np.median(spent)) * 1e6
    return Row(
        group,
        case.name,
        method.name,
        method.setting,
        microseconds,
        error,
        wrong,
        missed,
        of,
        middle,
        (low, high),
        rounds,
        method.aim,
        method.aim.reached(microseconds, wrong),
        turn.problems,
    )


def relative_error(answer: Any, truth: Any) -> float:
    """|found/truth - 1| for a truth that is a number, its text or the middle of a ball; inf without an answer.

    Examples
    --------
    >>> relative_error(0.75, "0.5"), relative_error(None, 1), relative_error(float("nan"), 1)
    (0.5, inf, inf)
    """
    if answer is None:
        return float("inf")
    with mpmath.workdps(DIGITS):
        off = abs(mpmath.mpf(answer) / number(truth) - 1)
        return float("inf") if mpmath.isnan(off) else float(off)


def condition(function: Callable[[float, float], float], tau: float, v: float, step: float = 1e-6) -> float:
    """1 + (|dF/dtau| |tau| + |dF/dv| v)/|F| by central differences: enough for a bound of ten times.

    Examples
    --------
    >>> round(condition(lambda tau, v: tau * v, 2.0, 3.0), 6)
    3.0
    """
    value = abs(function(tau, v))
    # relative steps: tau and v are given to a relative rounding error each
    by_tau = function(tau * (1 + step), v) - function(tau * (1 - step), v)
    by_v = function(tau, v * (1 + step)) - function(tau, v * (1 - step))
    return 1 + (abs(by_tau) + abs(by_v)) / (2 * step * value)


# Statements timed in a process of their own: a library's cache and a warm allocator flatter a second run. Threads of
# numpy's linear algebra, which nothing here uses, are not started: see `NO_SPINNING`.


AROUND = """
import json, resource, time
def spent_so_far():
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + ended.ru_utime + ended.ru_stime
{before}
base, start = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, spent_so_far()
{timed}
spent = spent_so_far() - start
most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
{after}
print(json.dumps([spent, (most - base) / 1024, answer]))
"""


@dataclass(frozen=True)
class Cost:
    """CPU seconds (with those of children that have ended) and megabytes of what was timed, and the `answer` given."""

    seconds: float
    megabytes: float
    answer: Any


# numpy starts a thread for each core. They spin while they wait: 80 ms of CPU on two cores that no script asked for. A
# user may set the same variable.
NO_SPINNING = {"OPENBLAS_NUM_THREADS": "1"}


@lru_cache(maxsize=1)
def _bytecode() -> str:
    """A folder for bytecode, where it must not be written beside the sources."""
    place = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, place, ignore_errors=True)
    return place


def cost(timed: str, before: str = "", after: str = "answer = None", around: dict[str, str] | None = None) -> Cost:
    """Run `before`, `timed` and `after` in a fresh process; `after` sets `answer` to something JSON can say.

    Examples
    --------
    >>> cost("x = 2 + 2", after="answer = x").answer
    4
    """
    paths = [str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")]
    environment = {**NO_SPINNING, **os.environ, "PYTHONPATH": os.pathsep.join(paths), **(around or {})}
    if environment.pop("PYTHONDONTWRITEBYTECODE", None):  # an installed package has its bytecode
        environment["PYTHONPYCACHEPREFIX"] = _bytecode()
    text = AROUND.format(before=before, timed=timed, after=after)
    done = subprocess.run([sys.executable, "-c", text], env=environment, capture_output=True, text=True, check=True)
    return Cost(*json.loads(done.stdout))
