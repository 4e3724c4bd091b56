"""Any smooth f and g: the emitted Taylor recurrence, restarted from its own sums."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from singimpact.algebra.expressions import substitute
from singimpact.codegen.recurrence import Recurrence, recurrence, variation
from singimpact.oscillator.model import Oscillator


def step_size(X: Any, z: Any, n: int, longest: Any, ulp: Any, p: Any) -> Any:  # noqa: ARG001
    """The step on which the last two terms are below ulp/8 times the first ones, at most `longest`."""
    h = longest
    for _ in range(2):  # the root of a high order forgives a size that is a little wrong
        size = abs(z) + h * (abs(X[1]) + h * (abs(X[2]) + h * abs(X[3])))
        k = 4
        while size == 0 and k < n - 1:  # at rest, with a_c = a_c' = 0 too
            size = abs(X[k]) * h**k
            k += 1
        for k in range(n - 1, n + 1):
            if X[k] != 0:
                fit = (ulp * size / (8 * abs(X[k]))) ** (1 / (k + 0 * h))
                if not fit >= h:
                    h = fit
    return h


def restart(launch: Any, v: Any, time: Any, z: Any, u: Any, noise: Any, ulp: Any, p: Any) -> Any:  # noqa: ARG001
    """The state a step ends in is the state the next one starts from."""
    return z, u, noise


@lru_cache(maxsize=256)
def recurrence_of(osc: Oscillator) -> Recurrence:
    """The emitted recurrence of a model; models of one structure have one text."""
    return recurrence(osc.f, osc.g)


@lru_cache(maxsize=256)
def variation_of(osc: Oscillator) -> Recurrence:
    """The emitted recurrence of a model's flights with their derivatives."""
    return variation(osc.f, osc.g)


def constants(osc: Oscillator) -> list[Any]:
    """The trees p[0], p[1], ...: the clearance and the constant parts of f and g, parameters put in."""
    return values(osc, recurrence_of(osc))


def values(osc: Oscillator, emitted: Recurrence) -> list[Any]:
    """The trees that an emitted recurrence of the model takes as p."""
    return [osc.clearance, *(substitute(tree, osc.parameters) for tree in emitted.constants)]
