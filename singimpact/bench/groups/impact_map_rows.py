"""Cases of the impact map: what a state costs a user's own loop, by states of a call and by their kind; its derivative.

Every timed call has other states, and another restitution from 0.5 to 0.999; the answers of the first one are judged
by balls of 60 digits and more.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from math import log2, pi
from typing import Any

import flint

from singimpact.algebra.precision import balls_at
from singimpact.bench.drawn import CLEARANCES, OMEGAS, Draws, Problem, States, counted
from singimpact.bench.measuring import Case, Effort, Method, with_peers
from singimpact.bench.peers import followed_impacts
from singimpact.bench.peers.followed_impacts import Fly
from singimpact.bench.truth.first_hit import Cubic, Linear, first_hit
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
        lambda: [_peer(SCIPY, _time(followed_impacts.scipy_stepper(family, ACCURACY[SCIPY])), draw(sizes.scipy))],
    )
    truth, kappas = true_hits(draw(count)(), sizes.judged[family])
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
    return followed_impacts.heyoka_stepper(family, ACCURACY[HEYOKA])


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
        lambda: [_peer(HEYOKA, followed_impacts.heyoka_derivative(ACCURACY[HEYOKA]), draw(sizes.heyoka))],
        lambda: [_peer(SCIPY, followed_impacts.scipy_derivative(ACCURACY[SCIPY]), draw(sizes.scipy))],
    )
    truth, kappas = true_derivatives(draw(sizes.many)(), sizes.judged["linear"])
    return Case("linear, derivative of the map", methods, truth, kappas, skipped)


BITS = 320
HORIZON = 2000.0
SMALL = 10.0**-25  # relative step of a difference; the values have 60 digits and more
DIGITS = 40
Truth = tuple[list[str], list[float]]
# From a state in balls to values and the times at which they are reached.
Values = Callable[[Any, Any], tuple[list[Any], list[Any]]]


def true_hits(states: States, count: int) -> Truth:
    """Flight times of the first states, as decimal text, and their condition numbers.

    Examples
    --------
    >>> from singimpact.bench.drawn import Draws
    >>> truth, kappas = true_hits(Draws("linear", "generic", 3)(), 1)
    >>> len(truth[0]) > DIGITS, 1 < kappas[0] < 100
    (True, True)
    """

    def values(tau: Any, v: Any) -> tuple[list[Any], list[Any]]:
        time, _, _ = _hit(states, tau, v)
        return [time], [time]

    return _judged(states, count, values)


def true_derivatives(states: States, count: int) -> Truth:
    """The four entries of D G at the first states of a linear model, row by row."""

    def values(tau: Any, v: Any) -> tuple[list[Any], list[Any]]:
        time, u, motion = _hit(states, tau, v)
        e, r = motion.at(time)[2], flint.arb(states.restitution)
        (z_by_tau, u_by_tau), (z_by_v, u_by_v) = motion.variations(time)
        time_by_tau, time_by_v = -z_by_tau / u, -z_by_v / u
        rows = [1 + time_by_tau, time_by_v, -r * (u_by_tau + e * time_by_tau), -r * (u_by_v + e * time_by_v)]
        return rows, [time] * 4

    return _judged(states, count, values)


def true_impacts(states: States, count: int, wanted: Sequence[int]) -> Truth:
    """The times of the impacts with the numbers `wanted`, from 1, of the orbits of the first states."""

    def values(tau: Any, v: Any) -> tuple[list[Any], list[Any]]:
        times = []
        for number in range(1, max(wanted) + 1):
            time, u, _ = _hit(states, tau, v)
            tau, v = tau + time, -flint.arb(states.restitution) * u
            if number in wanted:
                times.append(tau)
        return times, times

    return _judged(states, count, values)


def _hit(states: States, tau: Any, v: Any) -> tuple[Any, Any, Any]:
    """Time, velocity and motion of a flight that hits."""
    kind = Cubic if states.family == "duffing" else Linear
    motion: Any = kind(OMEGAS[states.family], CLEARANCES[states.family], tau, v)
    found = first_hit(motion, float(v), HORIZON)
    if found is None:
        raise ArithmeticError(f"no hit from {float(tau)!r}, {float(v)!r} within {HORIZON}")
    return *found, motion


def _judged(states: States, count: int, values: Values) -> Truth:
    truth: list[str] = []
    kappas: list[float] = []
    for tau, v in zip(states.tau[:count].tolist(), states.v[:count].tolist(), strict=True):
        with balls_at(BITS + int(8 * max(-log2(v), 0))):
            found, times = values(flint.arb(tau), flint.arb(v))
            truth += [each.str(DIGITS, radius=False) for each in found]
            kappas += _conditions(states, (tau, v), values, (found, times))
    return truth, kappas


def _conditions(states: States, state: tuple[float, float], values: Values, answer: Any) -> list[float]:
    """The condition number of each value F, which is reached after a time T.

        kappa = 1 + (|dF/dtau| max(|tau|, T) + |dF/dv| v)/|F|

    tau counts within one period of the forcing: a double is an exact time, and what is lost by rounding omega tau is an
    error.
    """
    tau, v = map(flint.arb, state)
    period = 2 * pi / OMEGAS[states.family]
    small = flint.arb(SMALL)
    by_tau, by_v = values(tau + small, v)[0], values(tau, v * (1 + small))[0]
    near = abs(state[0] - period * round(state[0] / period))
    return [
        1 + float((abs(a - value) / small * max(near, float(time)) + abs(b - value) / small) / abs(value))
        for value, time, a, b in zip(*answer, by_tau, by_v, strict=True)
    ]
