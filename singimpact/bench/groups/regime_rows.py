"""`bench regimes`: hard states against 40 digits, one flight each, in four regimes of two families; many digits."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from singimpact.bench.measuring import Case, Effort, Method, with_peers
from singimpact.bench.peers import many_digits, runge_kutta, taylor_events
from singimpact.bench.problems import FAMILIES, REGIMES, Problem, states


def cases(effort: Effort) -> Iterator[Case]:
    """A case a family and regime; then one in many digits. A quick look leaves out duffing, whose kernel takes long."""
    for family in FAMILIES[:1] if effort.quick else FAMILIES:
        for regime in REGIMES:
            yield of_states(family, regime, effort)
    yield _many_digits(effort)
    if not effort.quick:
        yield _certified()


def of_regime(family: str, regime: str, count: int) -> list[Problem]:
    """States of a regime, evenly from the table."""
    found = [problem for problem in states(family) if problem.regime == regime]
    return found[:: max(len(found) // count, 1)][:count]


def of_states(family: str, regime: str, effort: Effort) -> Case:
    """A case of states from the table, each of a model of its own."""
    problems = of_regime(family, regime, effort.states)
    models = [problem.model() for problem in problems]
    own = [Method("singimpact, a call a state", "doubles", partial(_flown, models, problems))]
    methods, skipped = with_peers(
        own,
        lambda: [
            _peer("scipy DOP853", runge_kutta, family, problems, tolerance)
            for tolerance in (runge_kutta.TOLERANCES[1:2] if effort.quick else runge_kutta.TOLERANCES)
        ],
        lambda: [
            _peer("heyoka", taylor_events, family, problems, tolerance)
            for tolerance in (taylor_events.TOLERANCES[1::2] if effort.quick else taylor_events.TOLERANCES)
        ],
    )
    truth = [problem.flight_time for problem in problems]
    return Case(f"{family} {regime}", methods, truth, _conditions(problems), skipped)


def _conditions(problems: list[Problem]) -> list[float]:
    return [float(p.model().first_hit(p.tau, p.v).condition) for p in problems]


def _peer(name: str, peer: Any, family: str, problems: list[Problem], tolerance: float) -> Method:
    fly = peer.stepper(family, tolerance)
    return Method(name, f"tolerance {tolerance:.0e}", lambda: [fly(problem)[0] for problem in problems])


def _flown(models: list[Any], problems: list[Problem]) -> list[float]:
    """Through the public function; models are made before, as a user has one for many states."""
    return [osc.first_hit(problem.tau, problem.v).flight_time for osc, problem in zip(models, problems, strict=True)]


def _many_digits(effort: Effort) -> Case:
    """The 40 digits of the table bound what can be judged."""
    problems = of_regime("linear", "generic", 1 if effort.quick else 4)
    digits = (15, 35) if effort.quick else (15, 25, 35)
    own = [Method("singimpact", f"digits {d}", partial(_digits, problems, d), epsilon=10.0**-d) for d in digits]
    peers = [
        Method("mpmath findroot", f"dps {d}", partial(_at_digits, problems, d, closed), epsilon=10.0**-d)
        for d in digits
    ] + [
        Method("mpmath odefun", f"dps {d}", partial(_at_digits, problems, d, integrated), epsilon=10.0**-d)
        for d in digits[: 1 if effort.quick else 2]
    ]
    truth = [problem.flight_time for problem in problems]
    return Case("linear generic, many digits", own + peers, truth, _conditions(problems))


def _certified() -> Case:
    """Doubles beside enclosures of the same flights; the table holds 17 digits."""
    problems = of_regime("duffing", "generic", 4)
    models = [problem.model() for problem in problems]
    own = [Method("singimpact, a call a state", "doubles", partial(_flown, models, problems))] + [
        Method("singimpact, certified", f"digits {d}", partial(_digits, problems, d), epsilon=10.0 ** -min(d, 16))
        for d in (15, 30, 60)
    ]
    return Case("duffing generic, certified", own, [problem.flight_time for problem in problems], _conditions(problems))


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
