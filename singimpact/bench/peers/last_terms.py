"""The usual step rule of Taylor integrators, in place of the package's: a step is chosen by its last two terms.

Nothing looks at the step afterwards, so it passes over a layer whose terms are below rounding where it begins.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from singimpact.codegen.taylor_recurrence import Recurrence
from singimpact.oscillator.model import Oscillator

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
