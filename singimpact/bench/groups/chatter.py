"""`bench chatter`: when infinitely many impacts accumulate, x'' + x = cos 2t, c = 0.3, from (1.2, 0.01)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from math import cos
from typing import Any

from singimpact.bench.measuring import Case, Effort, Method, condition, with_peers
from singimpact.bench.peers import impacts, many_digits, runge_kutta, taylor_events
from singimpact.bench.problems import Problem, values
from singimpact.impact_oscillator import linear

STATE = "1.2", "0.01"
NAME = "chatter.tau_inf.linear[w=2,c=0.3,r={}](1.2,0.01)"
# velocities at which a peer stops and adds the first term of the rest: the error falls with their square
STOPS = (1e-3, 1e-4, 1e-5, 1e-6)


def cases(effort: Effort) -> Iterator[Case]:
    """Two restitutions."""
    for r in ("0.5", "0.9"):
        yield _case(r, effort)


def _case(r: str, effort: Effort) -> Case:
    osc, problem = linear(2, "0.3", r), Problem("linear", "chatter", 2.0, 0.3, float(r), 1.2, 0.01, "", "")
    stops = STOPS[:2] if effort.quick else STOPS
    own = [Method("singimpact", "doubles", lambda: [osc.chatter_limit(*STATE).tau])]
    own += [
        Method("singimpact", f"digits {d}", partial(_digits, osc, d), epsilon=10.0**-d)
        for d in ((20,) if effort.quick else (20, 35))
    ]
    methods, skipped = with_peers(
        own,
        lambda: [_flown("scipy DOP853, 1e-9", runge_kutta.stepper("linear", 1e-9), problem, s) for s in stops],
        lambda: [_flown("heyoka, 1e-9", taylor_events.stepper("linear", 1e-9), problem, s) for s in stops],
        lambda: [_in_digits(problem, stop, 30) for stop in ((1e-6,) if effort.quick else (1e-6, 1e-9, 1e-12))],
    )
    kappa = condition(lambda tau, v: float(osc.chatter_limit(tau, v).tau), 1.2, 0.01, 1e-4)
    return Case(f"linear, r = {r}", methods, [values()[NAME.format(r)]], [kappa], skipped)


def _digits(osc: Any, digits: int) -> list[Any]:
    return [osc.chatter_limit(*STATE, digits=digits).tau]


def _flown(name: str, fly: Callable[[Problem], tuple[Any, Any]], problem: Problem, stop: float) -> Method:
    return Method(name, f"until v < {stop:.0e}", lambda: [impacts.chatter_limit(fly, problem, stop, cos)])


def _in_digits(problem: Problem, stop: float, digits: int) -> Method:
    from dataclasses import replace

    import mpmath

    def run() -> list[Any]:
        with mpmath.workdps(digits):
            c, r, tau, v = (mpmath.mpf(text) for text in ("0.3", str(problem.restitution), *STATE))
            exact = replace(problem, clearance=c, restitution=r, tau=tau, v=v)
            return [impacts.chatter_limit(many_digits.root_of_closed_form, exact, stop, mpmath.cos)]

    return Method(f"mpmath findroot, dps {digits}", f"until v < {stop:.0e}", run)
