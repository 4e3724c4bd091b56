"""Impact after impact for any peer that flies to its first event: orbits, chatter limits, thresholds; D G at a hit.

The peers here are scipy's DOP853 with a terminal event x - c, and heyoka.py: adaptive Taylor integration with a
terminal event x - c = 0 from above.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from math import cos, nan, sin
from types import ModuleType
from typing import Any

from scipy.integrate import solve_ivp

from singimpact.algebra.numbers import Array
from singimpact.bench.drawn import Problem
from singimpact.bench.measuring import NotInstalled

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


LONGEST = 1000.0  # time after which a flight is given up


def scipy_stepper(family: str, tolerance: float = 1e-9) -> Fly:
    """A function from a problem to its first event: time since the launch, velocity; nan when none is found."""

    def field(t: float, y: Array, omega: float) -> list[float]:
        pull = y[0] if family == "linear" else y[0] + 0.1 * y[1] + 0.3 * y[0] ** 3
        return [y[1], cos(omega * t) - pull]

    return flight(partial(_scipy_event, field, tolerance))


def scipy_derivative(tolerance: float = 1e-9) -> Callable[[Problem], list[float]]:
    """A function from a problem of the linear family to the four entries of D G, from the variational equation."""

    def field(t: float, w: Array, omega: float) -> list[float]:
        return [w[1], cos(omega * t) - w[0], w[3], -w[2], w[5], -omega * sin(omega * t) - w[4]]

    return derivative_of_map(partial(_scipy_event, field, tolerance))


def _scipy_event(
    field: Callable[[float, Array, float], list[float]], tolerance: float, problem: Problem, start: list[float]
) -> tuple[float, list[float]]:
    """The time and the state at which x falls through c; nan when it does not."""

    def event(t: float, y: Array, omega: float) -> float:  # noqa: ARG001
        return float(y[0] - problem.clearance)

    event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
    span = (problem.tau, problem.tau + LONGEST)
    settings = {"method": "DOP853", "rtol": tolerance, "atol": tolerance, "args": (problem.omega,)}
    solution = solve_ivp(field, span, start, events=event, **settings)
    if solution.status != 1:
        return nan, [nan] * len(start)
    return float(solution.t[-1]), solution.y[:, -1].tolist()


def heyoka_stepper(family: str, tolerance: float = 2.0**-52) -> Fly:
    """A function from a problem to its first event: time since the launch, velocity. The integrator is compiled here.

    Raises
    ------
    NotInstalled : heyoka is not there.
    """
    heyoka = _heyoka()
    x, u = heyoka.make_vars("x", "u")
    force = x if family == "linear" else x + 0.1 * u + 0.3 * x**3
    return flight(_compiled([(x, u), (u, heyoka.cos(heyoka.par[0] * heyoka.time) - force)], tolerance))


def heyoka_derivative(tolerance: float = 2.0**-52) -> Callable[[Problem], list[float]]:
    """A function from a problem of the linear family to the four entries of D G, from the variational equation.

    Raises
    ------
    NotInstalled : heyoka is not there.
    """
    heyoka = _heyoka()
    x, u, y, y_dot, z, z_dot = heyoka.make_vars("x", "u", "y", "y_dot", "z", "z_dot")
    omega, time = heyoka.par[0], heyoka.time
    field = [
        (x, u),
        (u, heyoka.cos(omega * time) - x),
        (y, y_dot),
        (y_dot, -y),
        (z, z_dot),
        (z_dot, -omega * heyoka.sin(omega * time) - z),
    ]
    return derivative_of_map(_compiled(field, tolerance))


def _heyoka() -> ModuleType:
    try:
        import heyoka
    except ImportError:
        raise NotInstalled("heyoka") from None
    return heyoka


def _compiled(field: list[tuple[Any, Any]], tolerance: float) -> FirstEvent:
    """A function from a problem and a state to the time and the state at which x falls through c; nan without one.

    Parameters
    ----------
    field : variables, the first of which is x, and their derivatives; par[0] is omega, par[1] the clearance.
    """
    heyoka = _heyoka()
    event = heyoka.t_event(field[0][0] - heyoka.par[1], direction=heyoka.event_direction.negative)
    flow = heyoka.taylor_adaptive(field, [0.0] * len(field), pars=[1.0, 0.0], t_events=[event], tol=tolerance)

    def first_event(problem: Problem, start: list[float]) -> tuple[float, list[float]]:
        flow.time = problem.tau
        flow.state[:] = start
        flow.pars[:] = [problem.omega, problem.clearance]
        flow.reset_cooldowns()
        if flow.propagate_until(problem.tau + LONGEST)[0] == heyoka.taylor_outcome.time_limit:
            return nan, [nan] * len(start)
        return float(flow.time), flow.state.tolist()

    return first_event
