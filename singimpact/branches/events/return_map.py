"""Kinds of events that the derivatives of the closing conditions decide: conditions on the return map."""

from __future__ import annotations

from typing import Any

import numpy as np

from singimpact.branches.events.kind import EventKind, Indexed
from singimpact.branches.events.orbit_state import NUDGE, OrbitState, Test


class ReturnMapKind(EventKind):
    """A kind with one test function at each orbit, whose rate along the branch is a difference."""

    def test(self, state: OrbitState) -> float:  # noqa: ARG002
        """The test function: 0 at an event."""
        raise ArithmeticError(f"a {self.name} has no test of its own")

    def size(self, state: OrbitState) -> float:  # noqa: ARG002
        """The sum of the sizes of its terms, where it is a difference that may be rounding alone; else nan."""
        return np.nan

    def tests(self, state: OrbitState) -> Indexed:
        """The test and its rate; nan where a flight has left the domain of f or g."""
        here = self.test(state) if state.is_finite else np.nan
        later = self.test(state.beside) if state.beside.is_finite else np.nan
        yield 0, 0, Test(here, (later - here) / NUDGE, size=self.size(state))

    def value(self, state: OrbitState, impact: int) -> float:  # noqa: ARG002
        """The test function."""
        return self.test(state)


class MultiplierKind(ReturnMapKind):
    """A kind at which a real multiplier passes 1 or -1: 1 - mu t + d vanishes, t the trace of M, d its determinant."""

    multiplier = 1.0

    def equation(self, state: OrbitState) -> float:
        """det J(mu) of `closing.Loop`, of scaled unknowns."""
        return state.determinant(self.multiplier)

    def of_return_map(self, total: Any) -> Any:
        """1 - mu t + d."""
        return 1 - int(self.multiplier) * trace(total) + total.det()

    def rate_of_return_map(self, total: Any, change: Any) -> Any:
        """Its rate."""
        return -int(self.multiplier) * trace(change) + rate_of_determinant(total, change)


def trace(matrix: Any) -> Any:
    """The trace of a matrix of balls."""
    return matrix[0, 0] + matrix[1, 1]


def rate_of_determinant(total: Any, change: Any) -> Any:
    """The rate of the determinant where the matrix changes at a rate."""
    return (
        change[0, 0] * total[1, 1]
        + total[0, 0] * change[1, 1]
        - change[0, 1] * total[1, 0]
        - total[0, 1] * change[1, 0]
    )
