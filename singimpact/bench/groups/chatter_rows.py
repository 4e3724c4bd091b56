"""`bench chatter`: when infinitely many impacts accumulate: x'' + x = cos 2t, c = 0.3, from (1.2, 0.01), as close as
wanted; and c = 0.7 or Duffing's model, from other states in every timed call. A threshold is a case of `bench public`.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from singimpact.bench.drawn import CHATTERING, Draws, Problem, States, counted, model, pressing, values
from singimpact.bench.groups.impact_map_rows import ACCURACY, HEYOKA, SCIPY, taylor_stepper
from singimpact.bench.measuring import Case, Effort, Method, condition, with_peers
from singimpact.bench.peers import followed_impacts
from singimpact.bench.peers.followed_impacts import Fly
from singimpact.dynamics.threshold import threshold
from singimpact.impact_oscillator import linear

STATE = "1.2", "0.01"
NAME = "chatter.tau_inf.linear[w=2,c=0.3,r={}](1.2,0.01)"
# velocities at which a peer stops and adds the first term of the rest: the error falls with their square
STOPS = (1e-3, 1e-4, 1e-5, 1e-6)


def cases(effort: Effort) -> Iterator[Case]:
    """Two restitutions as close as wanted; then a state a call by restitution, and an array."""
    for r in ("0.5", "0.9"):
        yield _case(r, effort)
    for restitution in (0.9,) if effort.quick else (0.5, 0.9, 0.99, 0.999):
        yield states_case(CHATTERING, restitution, 1, effort)
    yield states_case("duffing", 0.7, 1, effort)
    for restitution in (0.9,) if effort.quick else (0.5, 0.9):
        yield states_case(CHATTERING, restitution, 25 * effort.judged if effort.quick else 100_000, effort)


def _case(r: str, effort: Effort) -> Case:
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
