"""`bench map`: one flight to the next impact, in four regimes of two families, and in many digits."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from singimpact.bench.measuring import EPSILON, Case, Effort, Method, with_peers
from singimpact.bench.peers import many_digits, runge_kutta, taylor_events
from singimpact.bench.problems import FAMILIES, REGIMES, Problem, states
from singimpact.flights.compiled_model import Allowance, allowed, codes_and_columns
from singimpact.flights.states import States

TOLERANCES = (1e-6, 1e-9, 1e-12)
WIDE = 10  # states of an array; some flights take 15 ms each, for doubles cannot tell their digits


def cases(effort: Effort) -> Iterator[Case]:
    """A case a family and regime; then one in many digits. A quick look leaves out duffing, whose kernel takes long."""
    for family in FAMILIES[:1] if effort.quick else FAMILIES:
        for regime in REGIMES:
            yield _regime(family, regime, effort)
    yield _many_digits(effort)


def of_regime(family: str, regime: str, count: int) -> list[Problem]:
    """States of a regime, evenly from the table."""
    found = [problem for problem in states(family) if problem.regime == regime]
    return found[:: max(len(found) // count, 1)][:count]


def _regime(family: str, regime: str, effort: Effort) -> Case:
    problems, copies = of_regime(family, regime, effort.states), effort.copies
    own = [
        Method("kernel", "compiled loop", _looped(problems, copies, EPSILON), copies=copies),
        Method("singimpact, a call a state", "doubles", partial(_arrays, problems, None)),
    ]
    if not effort.quick:
        own.append(Method("singimpact, an array", f"of {WIDE}", partial(_arrays, problems, WIDE), copies=WIDE))
    if family == "duffing":  # a linear model has a closed form, and no tolerance
        own += [Method("kernel", f"tolerance {tolerance:.0e}", _looped(problems, copies, tolerance), copies=copies)
                for tolerance in TOLERANCES]  # fmt: skip
    methods, skipped = with_peers(
        own,
        lambda: [_peer("scipy DOP853", runge_kutta, family, problems, tolerance)
                 for tolerance in (runge_kutta.TOLERANCES[1:2] if effort.quick else runge_kutta.TOLERANCES)],
        lambda: [_peer("heyoka", taylor_events, family, problems, tolerance)
                 for tolerance in (taylor_events.TOLERANCES[1::2] if effort.quick else taylor_events.TOLERANCES)],
    )  # fmt: skip
    truth = [problem.flight_time for problem in problems]
    return Case(f"{family} {regime}", methods, truth, _conditions(problems), skipped)


def _conditions(problems: list[Problem]) -> list[float]:
    return [float(p.model().first_hit(p.tau, p.v).condition) for p in problems]


def _peer(name: str, peer: Any, family: str, problems: list[Problem], tolerance: float) -> Method:
    fly = peer.stepper(family, tolerance)
    return Method(name, f"tolerance {tolerance:.0e}", lambda: [fly(problem)[0] for problem in problems])


def _arrays(problems: list[Problem], copies: int | None) -> list[float]:
    """Through the public function, equal states side by side, or one state a call."""
    found = []
    for problem in problems:
        tau, v = (problem.tau, problem.v) if copies is None else (np.full(copies, problem.tau), problem.v)
        found.append(float(np.ravel(problem.model().first_hit(tau, v).flight_time)[0]))
    return found


def _looped(problems: list[Problem], copies: int, tolerance: float) -> Callable[[], list[float]]:
    loops = [_loop(problem, copies, tolerance) for problem in problems]
    return lambda: [loop() for loop in loops]


def _loop(problem: Problem, copies: int, tolerance: float) -> Callable[[], float]:
    """The compiled loop over equal states, as an orbit or a grid runs it: what a flight itself costs."""
    osc = problem.model()
    allowance = Allowance(1000.0, max(tolerance, EPSILON))
    model = allowed(osc, allowance)
    model.machine.compile_here(model.main)
    given = States.read(np.full(copies, problem.tau), problem.v)
    tau, v = given.tau, given.v.copy()

    def run() -> float:
        codes, rows = codes_and_columns(model, tau, v)
        return float(rows[0, 0]) if codes[0] == 0 else float("nan")

    return run


def _many_digits(effort: Effort) -> Case:
    """The 40 digits of the table bound what can be judged."""
    problems = of_regime("linear", "generic", 1 if effort.quick else 4)
    asked = (15, 35) if effort.quick else (15, 25, 35)
    own = [Method("singimpact", f"digits {d}", partial(_digits, problems, d), epsilon=10.0**-d) for d in asked]
    peers = [
        Method("mpmath findroot", f"dps {d}", partial(_at_digits, problems, d, closed), epsilon=10.0**-d) for d in asked
    ] + [Method("mpmath odefun", f"dps {d}", partial(_at_digits, problems, d, integrated), epsilon=10.0**-d)
         for d in asked[:1 if effort.quick else 2]]  # fmt: skip
    truth = [problem.flight_time for problem in problems]
    return Case("linear generic, many digits", own + peers, truth, _conditions(problems))


def _digits(problems: list[Problem], digits: int) -> list[Any]:
    return [problem.model().first_hit(problem.tau, problem.v, digits=digits).flight_time for problem in problems]


def _at_digits(problems: list[Problem], digits: int, fly: Callable[[Problem], Any]) -> list[Any]:
    import mpmath

    with mpmath.workdps(digits):
        return [fly(problem) for problem in problems]


def closed(problem: Problem) -> Any:
    """The flight time by the closed form."""
    return many_digits.root_of_closed_form(problem)[0]


def integrated(problem: Problem) -> Any:
    """The flight time by integration."""
    return many_digits.root_of_odefun(problem, "linear")
