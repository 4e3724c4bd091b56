"""`bench threshold`: the v between complete and incomplete chatter, x'' + x = cos 2.8t, c = 0, r = 1/2, over pi/2.8."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from math import pi
from typing import Any

from singimpact.bench.measuring import Case, Effort, Method, condition, with_peers
from singimpact.bench.peers import impacts, many_digits, runge_kutta, taylor_events
from singimpact.bench.problems import Problem, values
from singimpact.impact_oscillator import linear, threshold

END = 3 * pi / 2 / 2.8  # the next zero of a_c with a_c' > 0
WIDTHS = (1e-3, 1e-6, 1e-9, 1e-12)
# a peer starts to look from here; it flies this one and doubles it until contact is lost
GUESS = 0.05


def cases(effort: Effort) -> Iterator[Case]:
    """One case; peers bisect, to a relative width."""
    osc = linear("2.8", 0, "0.5")
    problem = Problem("linear", "chatter", 2.8, 0.0, 0.5, pi / 2.8, GUESS, "", "")
    widths = WIDTHS[:2] if effort.quick else WIDTHS
    own = [Method("singimpact", "doubles", lambda: [threshold(osc, "pi/2.8").v])]
    own += [
        Method("singimpact", f"digits {d}", partial(_digits, osc, d), epsilon=10.0**-d)
        for d in ((20,) if effort.quick else (20, 40))
    ]
    methods, skipped = with_peers(
        own,
        lambda: [_bisected("scipy DOP853, 1e-9", runge_kutta.stepper("linear", 1e-9), problem, w) for w in widths],
        lambda: [_bisected("heyoka, 1e-9", taylor_events.stepper("linear", 1e-9), problem, w) for w in widths],
        lambda: [_bisected("mpmath findroot, dps 15", many_digits.root_of_closed_form, problem, w) for w in widths[1:]],
    )
    kappa = condition(lambda tau, _: float(threshold(osc, tau).v), pi / 2.8, 1.0, 1e-4)
    truth = values()["threshold.linear[w=2.8,c=0,r=0.5](pi/2.8)"]
    yield Case("linear, r = 0.5", methods, [truth], [kappa], skipped)


def _digits(osc: Any, digits: int) -> list[Any]:
    return [threshold(osc, "pi/2.8", digits=digits).v]


def _bisected(name: str, fly: Callable[[Problem], tuple[Any, Any]], problem: Problem, width: float) -> Method:
    return Method(name, f"to {width:.0e}", lambda: [impacts.threshold(fly, problem, END, width)])
