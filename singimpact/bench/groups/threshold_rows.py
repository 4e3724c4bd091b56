"""`bench threshold`: the v between complete and incomplete chatter: x'' + x = cos 2.8t, c = 0, r = 1/2, over pi/2.8, as
close as wanted; and c = 0.3 or Duffing's model, over other phases in every timed call.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from math import pi
from typing import Any

from singimpact.bench.drawn import Draws, States, counted, model, pressing
from singimpact.bench.groups.impact_map_rows import HEYOKA, SCIPY, taylor_stepper
from singimpact.bench.measuring import Case, Effort, Method, condition, with_peers
from singimpact.bench.peers import followed_impacts, many_digits, runge_kutta, taylor_events
from singimpact.bench.problems import Problem, values
from singimpact.dynamics.threshold import threshold
from singimpact.impact_oscillator import linear

END = 3 * pi / 2 / 2.8  # the next zero of a_c with a_c' > 0
WIDTHS = (1e-3, 1e-6, 1e-9, 1e-12)
# a peer starts to look from here; it flies this one and doubles it until contact is lost
GUESS = 0.05


def cases(effort: Effort) -> Iterator[Case]:
    """One phase as close as wanted, then others by restitution, and an array; peers bisect, to a relative width."""
    yield _one(effort)
    for restitution in (0.5, 0.9) if effort.quick else (0.5, 0.7, 0.9, 0.99):
        yield _drawn("linear", restitution, 1, effort)
    yield _drawn("duffing", 0.7, 1, effort)
    yield _drawn("linear", 0.5, effort.judged if effort.quick else 1000, effort)


def _one(effort: Effort) -> Case:
    osc = linear("2.8", 0, "0.5")
    problem = Problem("linear", "chatter", 2.8, 0.0, 0.5, pi / 2.8, GUESS, "", "")
    widths = WIDTHS[:2] if effort.quick else WIDTHS
    own = [Method("singimpact", "doubles", lambda: [threshold(osc, "pi/2.8").v])]
    own += [
        Method("singimpact", f"digits {d}", partial(_digits, osc, d), epsilon=10.0**-d)
        for d in ((30,) if effort.quick else (20, 30, 40))
    ]
    methods, skipped = with_peers(
        own,
        lambda: [_bisected("scipy DOP853, 1e-9", runge_kutta.stepper("linear", 1e-9), problem, w) for w in widths],
        lambda: [_bisected("heyoka, 1e-9", taylor_events.stepper("linear", 1e-9), problem, w) for w in widths],
        lambda: [_bisected("mpmath findroot, dps 15", many_digits.root_of_closed_form, problem, w) for w in widths[1:]],
    )
    kappa = condition(lambda tau, _: float(threshold(osc, tau).v), pi / 2.8, 1.0, 1e-4)
    truth = values()["threshold.linear[w=2.8,c=0,r=0.5](pi/2.8)"]
    return Case("linear, r = 0.5", methods, [truth], [kappa], skipped)


def _digits(osc: Any, digits: int) -> list[Any]:
    return [threshold(osc, "pi/2.8", digits=digits).v]


def _bisected(name: str, fly: Callable[[Problem], tuple[Any, Any]], problem: Problem, width: float) -> Method:
    return Method(name, f"to {width:.0e}", lambda: [followed_impacts.threshold(fly, problem, END, width)])


CALLS = 5  # of a timed run of a phase a call
JUDGED = {("linear", 0.5): 3, ("linear", 0.7): 2, ("linear", 0.9): 1, ("linear", 0.99): 0, ("duffing", 0.7): 1}
"""Phases with 20 digits: of Duffing's model it takes 10 s, and 50 s at r = 0.99, which is not judged."""
TO = 1e-3  # relative width at which a peer's bisection ends


def _drawn(family: str, restitution: float, count: int, effort: Effort) -> Case:
    """Some calls of one phase, or one of an array."""
    draw = partial(Draws, family, "chattering", restitution=restitution)
    osc, run = model(family, restitution), _a_phase if count == 1 else _an_array
    setting, problems = f"{counted(count, 'phase')} a call", CALLS if count == 1 else count
    own = [Method("singimpact, threshold", setting, run, problems=problems, draw=draw(problems))]
    methods, skipped = with_peers(
        own,
        lambda: [_between(HEYOKA, taylor_stepper(family), draw(1))],
        lambda: [_between(SCIPY, runge_kutta.stepper(family, 1e-9), draw(1))],
    )
    judged = JUDGED[family, restitution]
    if effort.quick:
        judged = min(judged, 1) if family == "linear" else 0
    phases = draw(judged)().tau.tolist()
    truth = [threshold(osc, tau, digits=20).v for tau in phases]
    kappas = [condition(lambda tau, _: float(threshold(osc, tau).v), tau, 1.0, 1e-4) for tau in phases]
    name = "Duffing" if family == "duffing" else family
    title = f"{name}, c = 0.3, r = {restitution:g}, {setting}"
    notes = [] if judged else [f"{title}: times alone, no answer is judged: many digits of it take too long."]
    return Case(title, methods, truth, kappas, skipped, notes=notes)


def _a_phase(states: States) -> list[float]:
    return [float(threshold(states.osc, tau).v) for tau in states.tau.tolist()]


def _an_array(states: States) -> Any:
    return threshold(states.osc, states.tau).v


def _between(name: str, fly: Any, draw: Draws) -> Method:
    end = pressing(draw.family)[1]

    def run(problems: Any) -> list[Any]:
        return [followed_impacts.threshold(fly, replace(each, v=GUESS), end, TO) for each in problems]

    return Method(name, f"{counted(draw.count, 'phase')}, to {TO:.0e}", run, draw=lambda: draw().problems())
