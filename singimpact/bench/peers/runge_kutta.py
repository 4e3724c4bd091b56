"""scipy's DOP853 with a terminal event x - c."""

from collections.abc import Callable
from functools import partial
from math import cos, nan, sin
from typing import Any

from scipy.integrate import solve_ivp

from singimpact.bench.drawn import Problem
from singimpact.bench.peers.followed_impacts import Fly, derivative_of_map, flight

LONGEST = 1000.0  # time after which a flight is given up


def stepper(family: str, tolerance: float = 1e-9) -> Fly:
    """A function from a problem to its first event: time since the launch, velocity; nan when none is found."""

    def field(t: float, y: Any, omega: float) -> list[float]:
        pull = y[0] if family == "linear" else y[0] + 0.1 * y[1] + 0.3 * y[0] ** 3
        return [y[1], cos(omega * t) - pull]

    return flight(partial(_first_event, field, tolerance))


def varied(tolerance: float = 1e-9) -> Callable[[Problem], list[float]]:
    """A function from a problem of the linear family to the four entries of D G, from the variational equation."""

    def field(t: float, w: Any, omega: float) -> list[float]:
        return [w[1], cos(omega * t) - w[0], w[3], -w[2], w[5], -omega * sin(omega * t) - w[4]]

    return derivative_of_map(partial(_first_event, field, tolerance))


def _first_event(
    field: Callable[[float, Any, float], list[float]], tolerance: float, problem: Problem, start: list[float]
) -> tuple[float, list[float]]:
    """The time and the state at which x falls through c; nan when it does not."""

    def event(t: float, y: Any, omega: float) -> float:  # noqa: ARG001
        return float(y[0] - problem.clearance)

    event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    span = (problem.tau, problem.tau + LONGEST)
    settings = {"method": "DOP853", "rtol": tolerance, "atol": tolerance, "args": (problem.omega,)}
    solution = solve_ivp(field, span, start, events=event, **settings)
    if solution.status != 1:
        return nan, [nan] * len(start)
    return float(solution.t[-1]), solution.y[:, -1].tolist()
