"""Impact after impact for any peer that flies to its first event: orbits, chatter limits, thresholds; D G at a hit."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from math import cos

from singimpact.bench.drawn import Problem

Fly = Callable[[Problem], tuple[float, float]]
MOST = 2000  # impacts, after which a peer that does not get on is given up; the right answers take below 300
DEAD = 0.1  # of the width that is asked for: on gamma v falls with every impact, so a larger one moves the answer


def chatter_limit(fly: Fly, problem: Problem, stop: float) -> float:
    """Impacts until v < stop, and the rest of the chatter by its first term, 2v/(|a|(1 - r))."""
    *_, (tau, v) = [(problem.tau, problem.v), *_states(fly, problem, stop)]
    a = cos(problem.omega * tau) - problem.clearance
    return tau - 2 * v / (a * (1 - problem.restitution))


def threshold(fly: Fly, problem: Problem, end: float, width: float) -> float:
    """Bisection between a v from which chatter dies before `end` and one that lands after it, to a relative width."""
    low, high, stop = 0 * problem.v, problem.v, width * problem.v * DEAD
    while not _lands_after(fly, replace(problem, v=high), end, stop):
        low, high = high, 2 * high
    while high - low > width * high:
        middle = (low + high) / 2
        low, high = (low, middle) if _lands_after(fly, replace(problem, v=middle), end, stop) else (middle, high)
    return (low + high) / 2


def _lands_after(fly: Fly, problem: Problem, end: float, stop: float) -> bool:
    return any(not tau < end for tau, _ in _states(fly, problem, stop))


def _states(fly: Fly, problem: Problem, stop: float) -> Iterator[tuple[float, float]]:
    """The states after the impacts from a state, while v > stop."""
    tau, v = problem.tau, problem.v
    for _ in range(MOST):
        if not v > stop:
            return
        time, velocity = fly(replace(problem, tau=tau, v=v))
        tau, v = tau + time, problem.restitution * abs(velocity)
        yield tau, v


def chain(fly: Fly, problem: Problem, count: int) -> list[float]:
    """Times of `count` impacts from a state; where a peer fails it begins again, for so many flights are timed."""
    tau, v, times = problem.tau, problem.v, []
    for _ in range(count):
        time, velocity = fly(replace(problem, tau=tau, v=v))
        speed = problem.restitution * abs(velocity)
        tau, v = (tau + time, speed) if speed > LEAST else (problem.tau, problem.v)
        times.append(tau)
    return times


LEAST = 1e-6  # velocity below which peers go through the wall


# From a problem and a state to the time and the state of the first event; nan when none is found.
FirstEvent = Callable[[Problem, list[float]], tuple[float, list[float]]]


def flight(first_event: FirstEvent) -> Fly:
    """A function from a problem to its first event: time since the launch, velocity."""

    def fly(problem: Problem) -> tuple[float, float]:
        time, state = first_event(problem, [problem.clearance, problem.v])
        return time - problem.tau, state[1]

    return fly


def derivative_of_map(first_event: FirstEvent) -> Callable[[Problem], list[float]]:
    """A function from a problem to the entries of D G, by (x, x', y, y', z, z'): y varies with v, z with tau."""

    def entries(problem: Problem) -> list[float]:
        time, (_, u, y, y_dot, z, z_dot) = first_event(problem, [problem.clearance, problem.v, 0.0, 1.0, 0.0, 0.0])
        e, r = cos(problem.omega * time) - problem.clearance, problem.restitution
        time_by_tau, time_by_v = -z / u, -y / u
        return [1 + time_by_tau, time_by_v, -r * (z_dot + e * time_by_tau), -r * (y_dot + e * time_by_v)]

    return entries
