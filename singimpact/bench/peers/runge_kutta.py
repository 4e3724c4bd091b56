"""scipy's DOP853 at 1e-9 with a terminal event x - c."""

from __future__ import annotations

from math import cos
from typing import Any

from singimpact.bench.problems import Problem


def stepper(family: str) -> Any:
    """A function from a problem to its first event: time since the launch, velocity."""
    from scipy.integrate import solve_ivp

    def fly(problem: Problem) -> tuple[float, float]:
        def field(t: float, y: Any) -> list[float]:
            pull = y[0] if family == "linear" else y[0] + 0.1 * y[1] + 0.3 * y[0] ** 3
            return [y[1], cos(problem.omega * t) - pull]

        def event(t: float, y: Any) -> float:  # noqa: ARG001
            return float(y[0] - problem.clearance)

        event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
        span = (problem.tau, problem.tau + 200.0)
        start = [problem.clearance, problem.v]
        found = solve_ivp(field, span, start, method="DOP853", rtol=1e-9, atol=1e-9, events=event)
        return float(found.t[-1]) - problem.tau, float(found.y[1, -1])

    return fly
