"""Cases of the impact map: what a state costs a user's own loop, by states of a call and by their kind; its derivative.

Every timed call has other states, and another restitution from 0.5 to 0.999; the answers of the first one are judged
by balls (`truth.drawn_flights`).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

from singimpact.bench.drawn import Draws, Problem, counted
from singimpact.bench.measuring import Case, Effort, Method, with_peers
from singimpact.bench.peers import runge_kutta, taylor_events
from singimpact.bench.peers.followed_impacts import Fly
from singimpact.bench.truth import drawn_flights
from singimpact.impact_oscillator import ImpactOscillator

HEYOKA, SCIPY = "heyoka, terminal event", "scipy DOP853, terminal event"
ACCURACY = {HEYOKA: 2.0**-52, SCIPY: 1e-12}


@dataclass(frozen=True)
class Sizes:
    """Numbers of states of a timed run.

    Parameters
    ----------
    flown : of the package, in calls of one state; arrays are `many`. heyoka, scipy : states of these peers.
    judged : states of the linear model and of Duffing's compared with the truth, which takes 2 ms and 80 ms each.
    """

    flown: int
    many: int
    heyoka: int
    scipy: int
    judged: dict[str, int]


def sizes_of(effort: Effort) -> Sizes:
    """The numbers of states of an effort."""
    judged = {"linear": effort.judged, "duffing": max(effort.judged // 10, 1)}
    if effort.quick:
        return Sizes(50 * effort.judged, 250 * effort.judged, 5 * effort.judged, 5, judged)
    return Sizes(20_000, 100_000, 10_000, 30, judged)


def map_case(family: str, kind: str, alone: bool, sizes: Sizes) -> Case:
    """States of a kind, each in a call of its own or all in one array."""
    count, draw = sizes.flown if alone else sizes.many, partial(Draws, family, kind)
    setting = f"{counted(1 if alone else count, 'state')} a call"
    run: Callable[..., Any] = (
        _one_a_call if alone else lambda states: states.osc.impact_map(states.tau, states.v).flight_time
    )
    drawn: Callable[[], Any] = partial(_in_floats, draw(count)) if alone else draw(count)
    own = [Method("singimpact, impact_map", setting, run, problems=count, draw=drawn)]
    methods, skipped = with_peers(
        own,
        lambda: [_peer(HEYOKA, _time(taylor_stepper(family)), draw(sizes.heyoka))],
        lambda: [_peer(SCIPY, _time(runge_kutta.stepper(family, ACCURACY[SCIPY])), draw(sizes.scipy))],
    )
    truth, kappas = drawn_flights.hits(draw(count)(), sizes.judged[family])
    return Case(f"{family}, {kind}, {setting}", methods, truth, kappas, skipped)


def _in_floats(draw: Draws) -> tuple[ImpactOscillator, list[tuple[float, float]]]:
    """A model and its states as floats, which are made outside the clock."""
    states = draw()
    return states.osc, list(zip(states.tau.tolist(), states.v.tolist(), strict=True))


def _one_a_call(drawn: tuple[ImpactOscillator, list[tuple[float, float]]]) -> list[float]:
    osc, states = drawn
    return [osc.impact_map(tau, v).flight_time for tau, v in states]


@lru_cache(maxsize=4)
def taylor_stepper(family: str) -> Fly:
    """heyoka's integrator, compiled once."""
    return taylor_events.stepper(family, ACCURACY[HEYOKA])


def _time(fly: Fly) -> Callable[[Problem], Sequence[float]]:
    """The flight time alone of what a stepper gives."""
    return lambda problem: fly(problem)[:1]


def _peer(name: str, fly: Callable[[Problem], Sequence[float]], draw: Draws) -> Method:
    """A peer, which flies one state after another; `fly` gives a list of numbers a state."""
    setting = f"tolerance {ACCURACY[name]:.0e}, {counted(draw.count, 'state')}"
    return Method(
        name,
        setting,
        lambda problems: [number for problem in problems for number in fly(problem)],
        problems=draw.count,
        draw=lambda: draw().problems(),
    )


def derivative_case(sizes: Sizes) -> Case:
    """All four entries of D G, of an array of states."""
    draw, setting = partial(Draws, "linear", "generic"), f"{sizes.many} states a call"
    own = [
        Method(
            "singimpact, derivative",
            setting,
            lambda states: states.osc.derivative(states.tau, states.v).matrix.reshape(-1),
            problems=sizes.many,
            draw=draw(sizes.many),
        )
    ]
    methods, skipped = with_peers(
        own,
        lambda: [_peer(HEYOKA, taylor_events.varied(ACCURACY[HEYOKA]), draw(sizes.heyoka))],
        lambda: [_peer(SCIPY, runge_kutta.varied(ACCURACY[SCIPY]), draw(sizes.scipy))],
    )
    truth, kappas = drawn_flights.derivatives(draw(sizes.many)(), sizes.judged["linear"])
    return Case("linear, derivative of the map", methods, truth, kappas, skipped)
