"""`bench map`: what a state costs a user's own loop, by states of a call and by their kind; derivative and inverse.

Every timed call has other states, and another restitution from 0.5 to 0.999; the answers of the first one are judged
by balls (`truth.drawn_flights`).
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Any

import numpy as np

from singimpact.bench.drawn import Draws, Fed, States, counted
from singimpact.bench.measuring import Aim, Case, Effort, Method, with_peers
from singimpact.bench.peers import runge_kutta, taylor_events
from singimpact.bench.truth import drawn_flights

HEYOKA, SCIPY = "heyoka, terminal event", "scipy DOP853, terminal event"
ACCURACY = {HEYOKA: 2.0**-52, SCIPY: 1e-12}
TOLERANCES = (1e-6, 1e-9, 1e-12)
FASTER = Aim(times=4.0)


@dataclass(frozen=True)
class Sizes:
    """Numbers of states of a timed run.

    Parameters
    ----------
    flown : of the package, in calls of fewer states; arrays are `many`. heyoka, scipy : states of these peers.
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


@dataclass(frozen=True)
class Calls:
    """Calls of the map: so many states a call (0: the array), of a kind, in so many microseconds a state."""

    family: str
    kind: str
    states: int
    microseconds: float

    @property
    def name(self) -> str:
        """The name of the case in the table."""
        return f"{'Duffing' if self.family == 'duffing' else self.family}, {self.kind}"


FED = "the map of its own output"
CALLS = (
    Calls("linear", "generic", 1, 6.0),
    Calls("duffing", "generic", 1, 15.0),
    Calls("linear", "generic", 10, 3.0),
    Calls("linear", "generic", 100, 1.5),
    Calls("linear", "generic", 1000, 1.2),
    Calls("linear", "generic", 0, 1.2),
    Calls("linear", "v from 1e-8 to 1e-2", 0, 1.2),
    Calls("linear", "tau within 1e6", 0, 1.2),
    Calls("linear", FED, 0, 1.2),
    Calls("duffing", "generic", 0, 6.0),
)


def cases(effort: Effort) -> Iterator[Case]:
    """A case a way to call the map; then its derivative and its inverse on arrays."""
    sizes = sizes_of(effort)
    for calls in CALLS:
        yield map_case(calls, sizes)
    yield derivative_case(sizes)
    yield _inverse(sizes)


def map_case(calls: Calls, sizes: Sizes) -> Case:
    count = sizes.many if calls.states == 0 else max(sizes.flown, calls.states)
    split = calls.states or count
    draw: Callable[[int], Any] = (
        partial(Fed, calls.family) if calls.kind == FED else partial(Draws, calls.family, calls.kind)
    )
    setting = f"{counted(split, 'state')} a call"
    own = [
        Method(
            "singimpact, impact_map",
            setting,
            _one_a_call if split == 1 else partial(_arrays, split),
            problems=count,
            draw=_divided(draw(count), split),
            aim=Aim(calls.microseconds),
        )
    ]
    if calls.family == "duffing" and not calls.states:
        own += [
            Method(
                "singimpact, impact_map",
                f"tolerance {tolerance:.0e}",
                partial(
                    lambda error, states: states.osc.impact_map(states.tau, states.v, tolerance=error).flight_time,
                    tolerance,
                ),
                problems=count,
                draw=draw(count),
            )
            for tolerance in TOLERANCES
        ]
    aim = FASTER if calls.family == "linear" and not calls.states else Aim()
    methods, skipped = _beside(own, calls.family, (draw, sizes), aim)
    truth, kappas = drawn_flights.hits(draw(count)(), sizes.judged[calls.family])
    return Case(f"{calls.name}, {setting}", methods, truth, kappas, skipped)


def _divided(draw: Callable[[], States], split: int) -> Callable[[], Any]:
    """The arguments of calls, as a user has them: floats for one state, arrays for several."""

    def drawn() -> Any:
        states = draw()
        if split == 1:
            return states.osc, list(zip(states.tau.tolist(), states.v.tolist(), strict=True))
        parts = range(0, states.tau.size, split)
        return states.osc, [(states.tau[i : i + split], states.v[i : i + split]) for i in parts]

    return drawn


def _one_a_call(given: Any) -> list[float]:
    osc, calls = given
    return [osc.impact_map(tau, v).flight_time for tau, v in calls]


def _arrays(split: int, given: Any) -> Any:  # noqa: ARG001
    osc, calls = given
    found = [osc.impact_map(tau, v).flight_time for tau, v in calls]
    return found[0] if len(found) == 1 else np.concatenate(found)


def _beside(
    own: Sequence[Method], family: str, states: tuple[Callable[[int], Any], Sizes], aim: Aim
) -> tuple[list[Method], list[str]]:
    """Methods of the peers, which fly one state after another."""
    return with_peers(
        own,
        lambda: [flown_by(HEYOKA, taylor_stepper(family), (states[0], states[1].heyoka), aim)],
        lambda: [flown_by(SCIPY, runge_kutta.stepper(family, ACCURACY[SCIPY]), (states[0], states[1].scipy), Aim())],
    )


@lru_cache(maxsize=4)
def taylor_stepper(family: str) -> Any:
    """heyoka's integrator, compiled once."""
    return taylor_events.stepper(family, ACCURACY[HEYOKA])


def flown_by(name: str, fly: Any, states: tuple[Callable[[int], Any], int], aim: Aim) -> Method:
    """A peer on so many of the states."""
    draw, count = states
    setting = f"tolerance {ACCURACY[name]:.0e}, {counted(count, 'state')}"
    drawn = draw(count)
    return Method(
        name,
        setting,
        lambda problems: [fly(problem)[0] for problem in problems],
        problems=count,
        draw=lambda: drawn().problems(),
        aim=aim,
    )


def derivative_case(sizes: Sizes) -> Case:
    draw = partial(Draws, "linear", "generic")
    own = [
        Method(
            "singimpact, derivative",
            f"{sizes.many} states a call",
            _entries,
            problems=sizes.many,
            draw=draw(sizes.many),
            aim=Aim(1.5),
        )
    ]
    methods, skipped = with_peers(
        own,
        lambda: [_varied(HEYOKA, taylor_events.varied(ACCURACY[HEYOKA]), draw(sizes.heyoka))],
        lambda: [_varied(SCIPY, runge_kutta.varied(ACCURACY[SCIPY]), draw(sizes.scipy))],
    )
    truth, kappas = drawn_flights.derivatives(draw(sizes.many)(), sizes.judged["linear"])
    return Case("linear, derivative of the map", methods, truth, kappas, skipped)


def _entries(states: States) -> Any:
    return states.osc.derivative(states.tau, states.v).matrix.reshape(-1)


def _varied(name: str, fly: Any, draw: Draws) -> Method:
    def run(problems: Any) -> list[float]:
        return [entry for problem in problems for entry in fly(problem)]

    setting = f"tolerance {ACCURACY[name]:.0e}, {counted(draw.count, 'state')}"
    return Method(name, setting, run, problems=draw.count, draw=lambda: draw().problems())


def _inverse(sizes: Sizes) -> Case:
    """Peers fly the mirrored flight: x'' + x = cos 2.8t is even in time."""
    draw = partial(Draws, "linear", "generic")
    own = [
        Method(
            "singimpact, inverse_map",
            f"{sizes.many} states a call",
            lambda states: states.osc.inverse_map(states.tau, states.v).flight_time,
            problems=sizes.many,
            draw=draw(sizes.many),
            aim=Aim(2.5),
        )
    ]
    methods, skipped = _beside(own, "linear", (lambda count: _Mirrored(draw(count)), sizes), Aim())
    truth, kappas = drawn_flights.backward_hits(draw(sizes.many)(), sizes.judged["linear"])
    return Case("linear, inverse of the map", methods, truth, kappas, skipped)


@dataclass
class _Mirrored:
    """Launches whose flights are those that led to drawn states, backwards."""

    draw: Draws

    def __call__(self) -> States:
        states = self.draw()
        return replace(states, tau=-states.tau, v=states.v / states.restitution)
