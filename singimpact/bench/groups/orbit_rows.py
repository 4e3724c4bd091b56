"""`bench orbit`: what an impact costs in orbits and iterates, by restitution; samples of an orbit, its exponents.

Every timed call has other states; the times of some impacts of the first call are judged by balls.
"""

from collections.abc import Callable, Iterator
from functools import partial
from itertools import chain as joined
from typing import Any

import numpy as np

from singimpact.bench.drawn import CHATTERING, CLEARANCES, RESTITUTIONS, Draws, States, counted
from singimpact.bench.groups.impact_map_rows import ACCURACY, HEYOKA, SCIPY, taylor_stepper
from singimpact.bench.measuring import NO_AIM, Aim, Case, Counted, Effort, Method, with_peers
from singimpact.bench.peers import runge_kutta
from singimpact.bench.peers.followed_impacts import chain
from singimpact.bench.truth import drawn_flights
from singimpact.dynamics.lyapunov import lyapunov

FIRST = (1, 2, 3, 4, 5)
"""Impacts of each orbit that are judged."""
ITERATED = 30
AIMS = {
    "linear": Aim(1.2),
    "duffing": Aim(8.0),
    CHATTERING: Aim(1.2),
    "sample": Aim(5.0),
    "lyapunov": Aim(3.0),
    "launch": Aim(60.0),
}
NAMES = {"linear": "linear", "duffing": "Duffing", CHATTERING: "linear, chatter again and again"}


def cases(effort: Effort) -> Iterator[Case]:
    """Orbits of both families, and orbits that chatter; then iterates of arrays."""
    rates = RESTITUTIONS[::4] if effort.quick else RESTITUTIONS
    for family in ("linear", "duffing"):
        for restitution in rates:
            yield orbit_case(family, restitution, effort)
    yield orbit_case(CHATTERING, 0.5, effort)
    for restitution in rates:
        yield _iterate("linear", restitution, effort)
    yield _iterate("duffing", 0.9, effort)
    yield from _asked_of_orbits(effort)


def orbit_case(family: str, restitution: float, effort: Effort) -> Case:
    """Every run has several orbits; impacts are counted that were flown, not the ones that a sum stands for."""
    starts, impacts = 4 if effort.quick else 10, 1000
    few = (2, 20) if effort.quick else (10, 100)
    draw = partial(Draws, family, "generic", restitution=restitution)
    own = [
        Method(
            "singimpact, orbit",
            f"{impacts} impacts a call",
            partial(_orbits, impacts),
            draw=draw(starts),
            aim=AIMS[family],
        )
    ]
    kind = "duffing" if family == "duffing" else "linear"
    methods, skipped = with_peers(
        own,
        lambda: [_chained(HEYOKA, taylor_stepper(kind), draw(starts), few[1], FIRST)],
        lambda: [_chained(SCIPY, runge_kutta.stepper(kind, ACCURACY[SCIPY]), draw(few[0] // 2), 10, FIRST)],
    )
    truth, kappas = drawn_flights.impacts(draw(starts)(), starts if kind == "linear" else 2, FIRST)
    return Case(f"{NAMES[family]}, an impact of an orbit, r = {restitution:g}", methods, truth, kappas, skipped)


def _orbits(impacts: int, states: States) -> Counted:
    found = [states.osc.orbit(tau, v, impacts) for tau, v in zip(states.tau.tolist(), states.v.tolist(), strict=True)]
    flown = sum(int(np.count_nonzero(each.kind == "impact")) for each in found)
    return Counted(flown, list(joined.from_iterable(each.tau[list(FIRST)].tolist() for each in found)))


def _chained(name: str, fly: Any, draw: Draws, impacts: int, judged: tuple[int, ...]) -> Method:
    def run(problems: Any) -> Counted:
        times = [chain(fly, problem, impacts) for problem in problems]
        return Counted(impacts * len(times), [each[number - 1] for each in times for number in judged])

    setting = f"tolerance {ACCURACY[name]:.0e}, {counted(draw.count, 'state')}, {impacts} impacts"
    return Method(name, setting, run, draw=lambda: draw().problems())


def _iterate(family: str, restitution: float, effort: Effort) -> Case:
    states = 1000 if effort.quick else 10_000
    draw = partial(Draws, family, "generic", restitution=restitution)
    aim = Aim(0.15) if family == "linear" else Aim()
    own = [Method("singimpact, iterate", f"{states} states, {ITERATED} impacts", _iterates, draw=draw(states), aim=aim)]
    methods, skipped = with_peers(
        own,
        lambda: [_chained(HEYOKA, taylor_stepper(family), draw(20 if effort.quick else 300), ITERATED, (ITERATED,))],
        lambda: [_chained(SCIPY, runge_kutta.stepper(family, ACCURACY[SCIPY]), draw(1), ITERATED, (ITERATED,))],
    )
    judged = min(effort.judged // 10, 20) if family == "linear" else 1 if effort.quick else 2
    truth, kappas = drawn_flights.impacts(draw(states)(), judged, (ITERATED,))
    return Case(f"{NAMES[family]}, an impact of iterates, r = {restitution:g}", methods, truth, kappas, skipped)


def _asked_of_orbits(effort: Effort) -> Iterator[Case]:
    """x and x' of an orbit at times, Lyapunov exponents, and starts off the wall; only their time is measured."""
    times, impacts, starts = (1000, 1000, 100) if effort.quick else (100_000, 1_000_000, 10_000)
    draw = partial(Draws, "linear", "generic", restitution=0.9)
    sample = partial(_sampled, times)
    rows: list[tuple[str, str, str, Callable[..., Any], Draws, Aim]] = [
        ("x and x' of an orbit of 1000 impacts, a time", "sample", f"{times} times", sample, draw(1), AIMS["sample"]),
        (
            "Lyapunov exponents, linear, an impact",
            "lyapunov",
            f"{impacts} impacts",
            partial(_exponents, impacts),
            draw(1),
            AIMS["lyapunov"],
        ),
        (
            "starts off the wall, linear, a start",
            "launch",
            counted(starts, "start"),
            _launched,
            draw(starts),
            AIMS["launch"],
        ),
    ]
    for name, method, setting, run, states, aim in rows:
        yield Case(
            name, [Method(f"singimpact, {method}", setting, run, draw=states, aim=NO_AIM if effort.quick else aim)]
        )


def _sampled(count: int, states: States) -> Counted:
    """Samples of an orbit, which is computed first."""
    orbit = states.osc.orbit(float(states.tau[0]), float(states.v[0]), 1000)
    found = orbit.sample(np.linspace(orbit.tau[0], orbit.tau[-1], count))
    return Counted(count, found.x[:1].tolist())


def _exponents(count: int, states: States) -> Counted:
    found = lyapunov(states.osc, float(states.tau[0]), float(states.v[0]), count)
    return Counted(count, found.exponents[:1].tolist())


def _launched(states: States) -> Counted:
    found = states.osc.launch(CLEARANCES["linear"] + states.v, -states.v, states.tau)
    return Counted(states.tau.size, found.tau[:1].tolist())


def _iterates(states: States) -> Counted:
    """Impacts of orbits that ended before are not counted."""
    found = states.osc.iterate(states.tau, states.v, ITERATED)
    return Counted(ITERATED * int(np.count_nonzero(found.status == 0)), found.tau)
