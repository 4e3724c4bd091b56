"""heyoka.py: adaptive Taylor integration with a terminal event x - c = 0 from above."""

from collections.abc import Callable
from math import nan
from types import ModuleType
from typing import Any

from singimpact.bench.drawn import Problem
from singimpact.bench.measuring import NotInstalled
from singimpact.bench.peers.followed_impacts import FirstEvent, Fly, derivative_of_map, flight

LONGEST = 1000.0  # time after which a flight is given up


def stepper(family: str, tolerance: float = 2.0**-52) -> Fly:
    """A function from a problem to its first event: time since the launch, velocity. The integrator is compiled here.

    Raises
    ------
    NotInstalled : heyoka is not there.
    """
    heyoka = _heyoka()
    x, u = heyoka.make_vars("x", "u")
    force = x if family == "linear" else x + 0.1 * u + 0.3 * x**3
    return flight(_compiled([(x, u), (u, heyoka.cos(heyoka.par[0] * heyoka.time) - force)], tolerance))


def varied(tolerance: float = 2.0**-52) -> Callable[[Problem], list[float]]:
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
