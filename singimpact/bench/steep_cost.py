"""CPU time of `first_hit` on arrays of states, a figure a family, paired with the usual rule for Taylor steps."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from time import process_time
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.bench.steep_families import FAMILIES, Family
from singimpact.bench.steep_states import DRAW, drawn_of
from singimpact.codegen.taylor_recurrence import Recurrence
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status

# The usual step rule of Taylor integrators, in place of the package's: a step is chosen by its last two terms. Nothing
# looks at the step afterwards, so it passes over a layer whose terms are below rounding where it begins.

RULE = """
def step_size_of_discs(X, W, z, n, longest, ulp, p, pace):
    h = longest
    for _ in range(2):
        size = abs(z) + h * (abs(X[1]) + h * (abs(X[2]) + h * abs(X[3])))
        k = 4
        while size == 0 and k < n - 1:
            size = abs(X[k]) * h**k
            k += 1
        for k in range(n - 1, n + 1):
            if X[k] != 0:
                fit = (ulp * size / (8 * abs(X[k]))) ** (1 / (k + 0 * h))
                if not fit >= h:
                    h = fit
    return h, 17 / 16, pace
"""
"""The step on which the last two terms are below ulp/8 times the first ones, at most `longest`."""


@contextmanager
def last_terms() -> Iterator[None]:
    """A block in which flights in Taylor steps take this rule."""
    from singimpact.flights import compiled_model, model_numbers, multiprecision

    usual = model_numbers.recurrence_of

    def ruled(osc: Oscillator) -> Recurrence:
        flow = usual(osc)
        return replace(flow, source=f"{flow.source}\n{RULE}")

    rooms: tuple[Any, ...] = (compiled_model, multiprecision)
    for room in rooms:
        room.recurrence_of = ruled
    _forget()
    try:
        yield
    finally:
        for room in rooms:
            room.recurrence_of = usual
        _forget()


def _forget() -> None:
    from singimpact.flights import compiled_model

    compiled_model.compiled_model.cache_clear()
    compiled_model.allowed.cache_clear()


@dataclass(frozen=True)
class CostSettings:
    """The number of flights behind a figure.

    Parameters
    ----------
    models, each : of a family, and states of each.
    compiling : flights that end at once, in one call before; a call of more than 1000 has its kernels compiled.
    rounds : in which both rules fly in turn; the median ratio counts.
    agree : relative difference of flight times up to which both rules fly the same flight.
    """

    models: int = 4
    each: int = 100
    compiling: int = 1200
    rounds: int = 5
    agree: float = 1e-8


COST = CostSettings()


@dataclass(frozen=True)
class Cost:
    """CPU time of a family.

    Parameters
    ----------
    microseconds : a state, all states, the median over models of the fastest round.
    ratio : to the same call with steps chosen by their last terms, on the flights on which both agree; nan without any.
    agree : part of the flights on which both rules agree.
    """

    microseconds: float
    ratio: float
    agree: float


def cost(family: Family) -> Cost:
    """CPU time of `first_hit` for random states of a family, with both step rules in turn."""
    figures, ratios, agree = list[float](), list[float](), list[float]()
    for number in range(COST.models):
        case = drawn_of(family, np.random.default_rng([number, FAMILIES.index(family)]), COST.each)
        osc = case.oscillator()
        if not number:
            for rule in (False, True):
                _timed(osc, (case.tau[0], np.full(COST.compiling, 1.0)), rule, 1e-3)
        every = case.tau, case.v
        ours, theirs = (_timed(osc, every, rule, DRAW.horizon)[1] for rule in (False, True))
        with np.errstate(all="ignore"):
            near = np.abs(ours.flight_time / theirs.flight_time - 1) < COST.agree
        same = (ours.status == theirs.status) & (near | (ours.status != Status.hit))
        agree.append(float(same.mean()))
        figures.append(min(_timed(osc, every, False, DRAW.horizon)[0] for _ in range(2)) * 1e6 / COST.each)
        if same.any():
            states_ = case.tau[same], case.v[same]
            pairs = [
                [_timed(osc, states_, rule, DRAW.horizon)[0] for rule in (False, True)] for _ in range(COST.rounds)
            ]
            ratios.append(float(np.median([one / other for one, other in pairs])))
    return Cost(float(np.median(figures)), float(np.median(ratios)) if ratios else np.nan, float(np.mean(agree)))


def _timed(osc: Any, states: tuple[Array, Array], last: bool, horizon: float) -> tuple[float, Any]:
    """CPU seconds of a call, and what it returns."""
    if not last:
        begin = process_time()
        hit = osc.first_hit(*states, horizon=horizon)
        return process_time() - begin, hit
    with last_terms():
        osc.first_hit(states[0][:1] if np.ndim(states[0]) else states[0], states[1][:1], horizon=1e-6)
        begin = process_time()
        hit = osc.first_hit(*states, horizon=horizon)
        return process_time() - begin, hit
