"""heyoka.py: adaptive Taylor integration with a terminal event x - c = 0 from above."""

from typing import Any

from singimpact.bench.measuring import NotInstalled
from singimpact.bench.peers.followed_impacts import derivative_of_map
from singimpact.bench.problems import Problem

LONGEST = 1000.0  # time after which a flight is given up


def stepper(family: str, tolerance: float = 2.0**-52) -> Any:
    """A function from a problem to its first event: time since the launch, velocity. The integrator is compiled here.

    Raises
    ------
    NotInstalled : heyoka is not there.
    """
    try:
        import heyoka
    except ImportError:
        raise NotInstalled("heyoka") from None
    x, u = heyoka.make_vars("x", "u")
    force = x if family == "linear" else x + 0.1 * u + 0.3 * x**3
    event = heyoka.t_event(x - heyoka.par[1], direction=heyoka.event_direction.negative)
    field = [(x, u), (u, heyoka.cos(heyoka.par[0] * heyoka.time) - force)]
    flow = heyoka.taylor_adaptive(field, [0.0, 0.0], pars=[1.0, 0.0], t_events=[event], tol=tolerance)

    def fly(problem: Problem) -> tuple[float, float]:
        flow.time = problem.tau
        flow.state[:] = [problem.clearance, problem.v]
        flow.pars[:] = [problem.omega, problem.clearance]
        flow.reset_cooldowns()
        if flow.propagate_until(problem.tau + LONGEST)[0] == heyoka.taylor_outcome.time_limit:
            return float("nan"), float("nan")
        return float(flow.time) - problem.tau, float(flow.state[1])

    return fly


def varied(tolerance: float = 2.0**-52) -> Any:
    """A function from a problem of the linear family to the four entries of D G, from the variational equation.

    Raises
    ------
    NotInstalled : heyoka is not there.
    """
    try:
        import heyoka
    except ImportError:
        raise NotInstalled("heyoka") from None
    x, u, y, y_dot, z, z_dot = heyoka.make_vars("x", "u", "y", "y_dot", "z", "z_dot")
    omega, time = heyoka.par[0], heyoka.time
    event = heyoka.t_event(x - heyoka.par[1], direction=heyoka.event_direction.negative)
    field = [
        (x, u),
        (u, heyoka.cos(omega * time) - x),
        (y, y_dot),
        (y_dot, -y),
        (z, z_dot),
        (z_dot, -omega * heyoka.sin(omega * time) - z),
    ]
    flow = heyoka.taylor_adaptive(field, [0.0] * 6, pars=[1.0, 0.0], t_events=[event], tol=tolerance)

    def fly(problem: Problem) -> list[float]:
        flow.time = problem.tau
        flow.state[:] = [problem.clearance, problem.v, 0.0, 1.0, 0.0, 0.0]
        flow.pars[:] = [problem.omega, problem.clearance]
        flow.reset_cooldowns()
        if flow.propagate_until(problem.tau + LONGEST)[0] == heyoka.taylor_outcome.time_limit:
            return [float("nan")] * 4
        return derivative_of_map(problem, float(flow.time), flow.state[1:].tolist())

    return fly
