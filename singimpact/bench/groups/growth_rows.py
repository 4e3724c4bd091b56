"""`bench growth`: how cost grows with the order, with digits, with the number of states, of impacts and of pixels.

Times alone, without a truth: each case ends in an exponent for each method, beside that of the work: the terms of a
series in symbols, else the size itself.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np

from singimpact import theory
from singimpact.algebra.rings import EXACT
from singimpact.bench.groups.regime_rows import closed
from singimpact.bench.measuring import Case, Effort, Method, with_peers
from singimpact.bench.peers import many_digits, runge_kutta, taylor_events
from singimpact.bench.peers.followed_impacts import chain
from singimpact.bench.problems import Problem
from singimpact.contact.contact import Contact
from singimpact.impact_oscillator import ImpactOscillator, linear
from singimpact.theory.fixed_points import tangency
from singimpact.theory.gamma_series import invariant_curve
from singimpact.theory.impact_sheet import sheet

DUFFING = ImpactOscillator("x + xdot/10 + 3*x**3/10", "3081/10000 + t + t**2/3", "0.3", "117/275")
LINEAR, PERIOD = linear(2, "0.3", "0.8"), np.pi
LOST = ("0.01", "0.003", "0.001", "0.0003", "0.0001")
START = Problem("linear", "generic", 2.0, 0.3, 0.8, 0.0, 1.0, "", "")


def cases(effort: Effort) -> Iterator[Case]:
    """A case a kind of size; the smallest sizes are left out where a call still costs more than its work."""
    short = effort.quick
    symbols = (6, 8, 10) if short else (6, 8, 10, 12, 14)
    theory.v_c(2, at="tangency")  # loads sympy, which `bench start` times
    yield _grown(
        "order of v_c, symbols for the jets",
        "kernel",
        symbols,
        lambda n: sheet(Contact.generic(1, n), n),
        _first("singimpact", symbols[:4], lambda n: _terms([theory.v_c(n, at="tangency")])),
    )
    few = (4, 5, 6) if short else (4, 5, 6, 7, 8)
    yield Case(
        "order of gamma and of chatter_limit, symbols for the jets",
        [
            *_first("singimpact, chatter_limit", few, lambda n: _terms(theory.chatter_limit(n).coefficients.values())),
            *_first("singimpact, gamma", few, lambda n: _terms(theory.gamma(n).coefficients.values())),
        ],
    )
    numbers = (8, 12, 16) if short else (8, 12, 16, 24, 32)
    yield _grown(
        "order of v_c, cubic model",
        "kernel",
        numbers,
        lambda n: sheet(_contact(n), n),
        _first("singimpact", numbers[:3], lambda n: _terms([theory.v_c(n, "tangency", DUFFING, 0)])),
    )
    yield _grown(
        "order of gamma, cubic model",
        "kernel",
        numbers,
        lambda n: invariant_curve(_contact(n), Fraction(3, 5), n),
        _first("singimpact", numbers[:3], lambda n: len(theory.gamma(n, "tangency", DUFFING, 0))),
    )
    digits = (100, 300, 1000) if short else (100, 300, 1000, 3000, 10_000)
    yield _grown(
        "digits of fixed points",
        "singimpact, certified",
        digits,
        lambda n: tangency("1/2", n),
        _line("mpmath findroot", digits[:4], _findroot),
    )
    few = (20, 40, 80) if short else (20, 40, 80, 160, 320)
    yield _grown(
        "digits of a flight",
        "singimpact",
        few,
        lambda n: LINEAR.first_hit(0, 1, digits=n),
        _line("mpmath findroot", few, partial(_at_digits, closed)),
        []
        if short
        else _line("mpmath odefun", few[:3], partial(_at_digits, partial(many_digits.root_of_odefun, family="linear"))),
    )
    states = (1000, 3000, 10_000) if short else (1000, 3000, 10_000, 30_000, 100_000)
    yield _grown(
        "states of an array",
        "singimpact",
        states,
        _flown_array,
        _line("singimpact, in 1000 periods", states, partial(_flown_array, periods=1000)),
    )
    yield _impacts(effort)
    sides = (8, 16, 32) if short else (16, 32, 64, 128)
    yield Case("pixels of basins", [Method("kernel", f"{n} x {n}", partial(_alone, _pixels, n), n * n) for n in sides])
    yield Case("impacts of a chatter", [_chatter(lost) for lost in (LOST[1:4] if short else LOST)])


def _contact(order: int) -> Contact:
    return Contact.of(DUFFING, Fraction(0), 1, order, EXACT)


def _line(name: str, sizes: Sequence[int], run: Callable[[int], Any]) -> list[Method]:
    """A method at each size; the time is that of the whole run."""
    return [Method(name, str(n), partial(_alone, run, n), n) for n in sizes]


def _first(name: str, sizes: Sequence[int], run: Callable[[int], Any]) -> list[Method]:
    """A method that is timed once, because a public function stores its results; `run` gives the number of terms."""
    return [Method(name, str(n), partial(_counted, run, n), n, first=True, counts=True) for n in sizes]


def _counted(run: Callable[[int], Any], size: int) -> list[Any]:
    return [run(size)]


def _terms(parts: Any) -> int:
    """Terms of sums of products, each with one sum at most."""
    import sympy

    factors = [sympy.Mul.make_args(term) for part in parts for term in sympy.Add.make_args(part)]
    lambda_ = sympy.Symbol("lambda")  # polynomials in it are coefficients
    return sum(
        max(len(factor.args) if factor.is_Add and not factor.has(lambda_) else 1 for factor in each) for each in factors
    )


def _pixels(side: int) -> None:
    """In this process: a pool costs more than the smallest picture."""
    from concurrent.futures import ThreadPoolExecutor

    from singimpact.dynamics.basins_of_attraction import basins

    with ThreadPoolExecutor(1) as pool:
        basins(LINEAR, size=side, executor=pool)


def _alone(run: Callable[[int], Any], size: int) -> list[None]:
    run(size)
    return [None]


def _grown(
    case: str, name: str, sizes: Sequence[int], run: Callable[[int], Any], *peers: list[Method], skipped: Any = ()
) -> Case:
    return Case(case, [*_line(name, sizes, run), *(method for peer in peers for method in peer)], skipped=skipped)


def _chatter(lost: str) -> Method:
    """r = 1 - lost: the closer to 1, the more impacts are flown before the rest is summed up, here from v = lost/5."""
    osc, v = linear(2, "0.3", f"1 - {lost}"), f"{lost}/5"

    def run() -> list[Any]:
        return [osc.chatter_limit("1.2", v).tau]

    return Method("singimpact", f"r = 1 - {lost}", run, osc.chatter_limit("1.2", v).impacts)


def _findroot(digits: int) -> None:
    import mpmath

    with mpmath.workdps(digits):
        many_digits.fixed_points(mpmath.mpf(1) / 2)


def _at_digits(fly: Callable[[Problem], Any], digits: int) -> None:
    import mpmath

    with mpmath.workdps(digits):
        fly(START)


def _flown_array(count: int, periods: float = 3 / PERIOD) -> Any:
    rng = np.random.default_rng(count)
    return LINEAR.impact_map(rng.uniform(0, periods * PERIOD, count), rng.uniform(0.1, 2, count))


def _impacts(effort: Effort) -> Case:
    """r = 1, so that impacts never end; the peers fly through their first events."""
    sizes = (1000, 3000, 10_000) if effort.quick else (1000, 3000, 10_000, 30_000, 100_000)
    endless, problem = linear(2, "0.3", 1), replace(START, restitution=1.0)
    methods, skipped = with_peers(
        [],
        lambda: _line(
            "scipy DOP853, 1e-9",
            [size // 100 for size in sizes[:3]],
            partial(chain, runge_kutta.stepper("linear", 1e-9), problem),
        ),
        lambda: _line("heyoka, 1e-9", sizes[:3], partial(chain, taylor_events.stepper("linear", 1e-9), problem)),
    )
    return _grown(
        "impacts of an orbit", "singimpact", sizes, lambda n: endless.orbit(0.0, 1.0, n), methods, skipped=skipped
    )
