"""scipy's DOP853 with a terminal event x - c."""

from collections.abc import Callable
from math import cos, nan, sin
from typing import Any

from scipy.integrate import solve_ivp

from singimpact.bench.drawn import Problem
from singimpact.bench.peers.followed_impacts import Fly, derivative_of_map

LONGEST = 1000.0  # time after which a flight is given up


def stepper(family: str, tolerance: float = 1e-9) -> Fly:
    """A function from a problem to its first event: time since the launch, velocity; nan when none is found."""

    def fly(problem: Problem) -> tuple[float, float]:
        def field(t: float, y: Any) -> list[float]:
            pull = y[0] if family == "linear" else y[0] + 0.1 * y[1] + 0.3 * y[0] ** 3
            return [y[1], cos(problem.omega * t) - pull]

        time, state = _first_event(problem, field, [problem.clearance, problem.v], tolerance)
        return time - problem.tau, state[1]

    return fly


def varied(tolerance: float = 1e-9) -> Callable[[Problem], list[float]]:
    """A function from a problem of the linear family to the four entries of D G, from the variational equation."""

    def fly(problem: Problem) -> list[float]:
        omega = problem.omega

        def field(t: float, w: Any) -> list[float]:
            return [w[1], cos(omega * t) - w[0], w[3], -w[2], w[5], -omega * sin(omega * t) - w[4]]

        time, state = _first_event(problem, field, [problem.clearance, problem.v, 0.0, 1.0, 0.0, 0.0], tolerance)
        return derivative_of_map(problem, time, state[1:])

    return fly


def _first_event(
    problem: Problem, field: Callable[[float, Any], list[float]], start: list[float], tolerance: float
) -> tuple[float, list[float]]:
    """The time and the state at which x falls through c; nan when it does not."""

    def event(t: float, y: Any) -> float:  # noqa: ARG001
        return float(y[0] - problem.clearance)

    event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    span = (problem.tau, problem.tau + LONGEST)
    solution = solve_ivp(field, span, start, method="DOP853", rtol=tolerance, atol=tolerance, events=event)
    if solution.status != 1:
        return nan, [nan] * len(start)
    return float(solution.t[-1]), solution.y[:, -1].tolist()
