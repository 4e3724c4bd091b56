"""Cases of the impact map and of chatter: what a state costs a user's own loop.

By states of a call and by their kind; and the derivative of the map, the ends of chatter and its thresholds. Every
timed call has other states; of the map another restitution from 0.5 to 0.999 too, and the answers of the first call are
judged by balls of 60 digits and more.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from math import log2, pi
from typing import Any

import flint

from singimpact.algebra.precision import balls_at
from singimpact.bench.drawn import (
    CHATTERING,
    CLEARANCES,
    OMEGAS,
    Draws,
    Problem,
    States,
    counted,
    model,
    pressing,
    values,
)
from singimpact.bench.measuring import Case, Effort, Method, condition, with_peers
from singimpact.bench.peers import followed_impacts
from singimpact.bench.peers.followed_impacts import Fly
from singimpact.bench.truth.first_hit import Cubic, Linear, first_hit
from singimpact.dynamics.threshold import threshold
from singimpact.impact_oscillator import ImpactOscillator, linear

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


# `bench chatter`: when infinitely many impacts accumulate: x'' + x = cos 2t, c = 0.3, from (1.2, 0.01), as close as
# wanted; and c = 0.7 or Duffing's model, from other states in every timed call. A threshold is a case of
# `bench public`.

STATE = "1.2", "0.01"
NAME = "chatter.tau_inf.linear[w=2,c=0.3,r={}](1.2,0.01)"
# velocities at which a peer stops and adds the first term of the rest: the error falls with their square
STOPS = (1e-3, 1e-4, 1e-5, 1e-6)


def chatter(effort: Effort) -> Iterator[Case]:
    """Two restitutions as close as wanted; then a state a call by restitution, and an array."""
    for r in ("0.5", "0.9"):
        yield _chatter_case(r, effort)
    for restitution in (0.9,) if effort.quick else (0.5, 0.9, 0.99, 0.999):
        yield states_case(CHATTERING, restitution, 1, effort)
    yield states_case("duffing", 0.7, 1, effort)
    for restitution in (0.9,) if effort.quick else (0.5, 0.9):
        yield states_case(CHATTERING, restitution, 25 * effort.judged if effort.quick else 100_000, effort)


def _chatter_case(r: str, effort: Effort) -> Case:
    osc, problem = linear(2, "0.3", r), Problem("linear", 2.0, 0.3, float(r), 1.2, 0.01)
    stops = STOPS[:2] if effort.quick else STOPS
    own = [Method("singimpact", "doubles", lambda: [osc.chatter_limit(*STATE).tau])]
    own += [
        Method("singimpact", f"digits {d}", lambda d=d: [osc.chatter_limit(*STATE, digits=d).tau], epsilon=10.0**-d)
        for d in ((20,) if effort.quick else (20, 35))
    ]
    methods, skipped = with_peers(
        own,
        lambda: [
            _flown("scipy DOP853, 1e-9", followed_impacts.scipy_stepper("linear", 1e-9), problem, s) for s in stops
        ],
        lambda: [_flown("heyoka, 1e-9", followed_impacts.heyoka_stepper("linear", 1e-9), problem, s) for s in stops],
    )
    kappa = condition(lambda tau, v: float(osc.chatter_limit(tau, v).tau), 1.2, 0.01, 1e-4)
    return Case(f"linear, r = {r}", methods, [values()[NAME.format(r)]], [kappa], skipped)


def _flown(name: str, fly: Fly, problem: Problem, stop: float) -> Method:
    return Method(name, f"until v < {stop:.0e}", lambda: [followed_impacts.chatter_limit(fly, problem, stop)])


CALLS = 20  # of a timed run of a state a call
JUDGED = {0.5: 5, 0.7: 2, 0.9: 3, 0.99: 1, 0.999: 1}  # states with 25 digits, by the impacts that they take
TO = 1e-3  # of the first velocity: where a peer ends


def states_case(family: str, restitution: float, count: int, effort: Effort) -> Case:
    """Some calls of one state, or one of an array."""
    draw = partial(Draws, family, "chattering", restitution=restitution)
    osc, run = (
        model(family, restitution),
        _a_state if count == 1 else lambda states: states.osc.chatter_limit(states.tau, states.v).tau,
    )
    setting, problems = f"{counted(count, 'state')} a call", CALLS if count == 1 else count
    own = [Method("singimpact, chatter_limit", setting, run, problems=problems, draw=draw(problems))]
    kind = "duffing" if family == "duffing" else "linear"
    methods, skipped = with_peers(
        own,
        lambda: [summed(HEYOKA, taylor_stepper(kind), draw(5))],
        lambda: [summed(SCIPY, followed_impacts.scipy_stepper(kind, ACCURACY[SCIPY]), draw(1))],
    )
    # of linear models these are enclosures, which share no flight with the answers in doubles
    judged = draw(1 if effort.quick else JUDGED[restitution])().problems()
    truth = [osc.chatter_limit(at.tau, at.v, digits=25).tau for at in judged]
    kappas = [condition(lambda tau, v: float(osc.chatter_limit(tau, v).tau), at.tau, at.v, 1e-4) for at in judged]
    name = "linear" if family == CHATTERING else "Duffing"
    return Case(f"{name}, r = {restitution:g}, {setting}", methods, truth, kappas, skipped)


def _a_state(states: States) -> list[float]:
    return [
        float(states.osc.chatter_limit(tau, v).tau)
        for tau, v in zip(states.tau.tolist(), states.v.tolist(), strict=True)
    ]


def summed(name: str, fly: Fly, draw: Draws) -> Method:
    """A peer that flies until v is a thousandth, and adds the rest by its first term."""
    tolerance = f"tolerance {ACCURACY[name]:.0e}, " if name in ACCURACY else ""
    setting = f"{tolerance}{counted(draw.count, 'state')}, until v < {TO:.0e} v"
    return Method(
        name,
        setting,
        lambda problems: [followed_impacts.chatter_limit(fly, each, TO * each.v) for each in problems],
        draw=lambda: draw().problems(),
    )


# ---- thresholds

# a peer starts to look from here; it flies this one and doubles it until contact is lost
GUESS = 0.05


PHASES = 5  # of a timed run of a phase a call
JUDGED_PHASES = 3
WIDTH = 1e-3  # relative width at which a peer's bisection ends


def phases_case(restitution: float, effort: Effort) -> Case:
    """Some calls of one phase of the linear model, judged with 20 digits; peers bisect to a relative width."""
    draw = partial(Draws, "linear", "chattering", restitution=restitution)
    osc, setting = model("linear", restitution), f"{counted(1, 'phase')} a call"
    own = [
        Method(
            "singimpact, threshold",
            setting,
            lambda states: [float(threshold(states.osc, tau).v) for tau in states.tau.tolist()],
            problems=PHASES,
            draw=draw(PHASES),
        )
    ]
    methods, skipped = with_peers(
        own,
        lambda: [between(HEYOKA, taylor_stepper("linear"), draw(1))],
        lambda: [between(SCIPY, followed_impacts.scipy_stepper("linear", 1e-9), draw(1))],
    )
    phases = draw(1 if effort.quick else JUDGED_PHASES)().tau.tolist()
    truth = [threshold(osc, tau, digits=20).v for tau in phases]
    kappas = [condition(lambda tau, _: float(threshold(osc, tau).v), tau, 1.0, 1e-4) for tau in phases]
    return Case(f"linear, c = 0.3, r = {restitution:g}, {setting}", methods, truth, kappas, skipped)


def between(name: str, fly: Fly, draw: Draws) -> Method:
    """A peer that bisects between a v whose chatter completes and one that loses contact."""
    end = pressing(draw.family)[1]
    return Method(
        name,
        f"{counted(draw.count, 'phase')}, to {WIDTH:.0e}",
        lambda problems: [followed_impacts.threshold(fly, replace(each, v=GUESS), end, WIDTH) for each in problems],
        draw=lambda: draw().problems(),
    )
