"""CPU time of `first_hit` on arrays of states, a figure a family."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from time import process_time

import numpy as np

from singimpact.bench.steep_families import FAMILIES, Family
from singimpact.bench.steep_states import DRAW, drawn_of

Rule = Callable[[], AbstractContextManager[None]]


@dataclass(frozen=True)
class CostSettings:
    """How much is flown for a figure.

    Parameters
    ----------
    models, each : of a family, and states of each.
    compiling : flights that end at once, in one call before; a call of more than 1000 has its kernels compiled.
    rounds : of which the fastest counts.
    portion : states in a call; a model that is slow is timed on its first portions alone.
    seconds : of CPU time of a family after which no further call, model or round begins.
    """

    models: int = 4
    each: int = 200
    compiling: int = 1200
    rounds: int = 3
    portion: int = 50
    seconds: float = 3.0


COST = CostSettings()


def cost(family: Family, rule: Rule | None = None) -> float:
    """CPU microseconds a state of `first_hit`, the median over models of the fastest round.

    Parameters
    ----------
    rule : gives a context in which flights take another step rule; None for the rule of the package.
    """
    spent, figures = 0.0, list[float]()
    with nullcontext() if rule is None else rule():
        for number in range(COST.models):
            if figures and spent > COST.seconds:
                break
            case = drawn_of(family, np.random.default_rng([number, FAMILIES.index(family)]), COST.each)
            osc, rounds = case.oscillator(), list[float]()
            if not number:
                osc.first_hit(case.tau[0], np.full(COST.compiling, 1.0), horizon=1e-3)
            while len(rounds) < COST.rounds and (spent < COST.seconds or not rounds):
                begin, flown = process_time(), 0
                while flown < COST.each and (not flown or spent + process_time() - begin < COST.seconds):
                    part = slice(flown, flown + COST.portion)
                    osc.first_hit(case.tau[part], case.v[part], horizon=DRAW.horizon)
                    flown += COST.portion
                spent += process_time() - begin
                rounds.append((process_time() - begin) / flown)
            figures.append(1e6 * min(rounds))
    return float(np.median(figures))
