"""Chatter limits and thresholds by flying impact after impact, for any peer that flies to its first event."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from singimpact.bench.problems import Problem

Fly = Callable[[Problem], tuple[Any, Any]]
MOST = 2000  # impacts, after which a peer that does not get on is given up; the right answers take below 300
DEAD = 0.1  # of the width that is asked for: on gamma v falls with every impact, so a larger one moves the answer


def chatter_limit(fly: Fly, problem: Problem, stop: float, cos: Callable[[Any], Any]) -> Any:
    """Impacts until v < stop, and the rest of the chatter by its first term, 2v/(|a|(1 - r))."""
    tau, v = problem.tau, problem.v
    for _ in range(MOST):
        if not v > stop:
            break
        time, velocity = fly(replace(problem, tau=tau, v=v))
        tau, v = tau + time, problem.restitution * abs(velocity)
    a = cos(problem.omega * tau) - problem.clearance
    return tau - 2 * v / (a * (1 - problem.restitution))


def threshold(fly: Fly, problem: Problem, end: float, width: float) -> Any:
    """Bisection between a v from which chatter dies before `end` and one that lands after it, to a relative width."""
    low, high, stop = 0 * problem.v, problem.v, width * problem.v * DEAD
    while not _lands_after(fly, replace(problem, v=high), end, stop):
        low, high = high, 2 * high
    while high - low > width * high:
        middle = (low + high) / 2
        low, high = (low, middle) if _lands_after(fly, replace(problem, v=middle), end, stop) else (middle, high)
    return (low + high) / 2


def _lands_after(fly: Fly, problem: Problem, end: float, stop: float) -> bool:
    tau, v = problem.tau, problem.v
    for _ in range(MOST):
        if not v > stop:
            return False
        time, velocity = fly(replace(problem, tau=tau, v=v))
        tau, v = tau + time, problem.restitution * abs(velocity)
        if not tau < end:
            return True
    return False
