"""Outcomes of a numerical question, as data: a failure is a status with a cause and a next step, never an exception."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

import numpy as np

from singimpact.notebook import table


class Status(IntEnum):
    """What became of a flight, a chatter sequence or an orbit.

    Notes
    -----
    Arrays of statuses are ``int8``.  A ``nan`` stands only beside a status whose sentence says so.

    Examples
    --------
    >>> Status(0).name
    'hit'
    >>> print(Status.no_return.sentence)
    no impact before the horizon; the flight time is inf: give a larger horizon to look further
    """

    hit = 0
    graze = 1
    sticks = 2
    no_return = 3
    escaped = 4
    unresolved = 5
    complete = 6
    lifts_off = 7
    no_rebound = 8
    none = 9

    @property
    def sentence(self) -> str:
        """Cause and next step, for a person."""
        return _SENTENCES[self]


_SENTENCES = {
    Status.hit: "the obstacle is hit with negative velocity",
    Status.graze: "the flight touches the obstacle with zero velocity; the flight time is the touching time and v is 0",
    Status.sticks: "the mass rests on the obstacle and is pressed against it; the flight time and v are 0",
    Status.no_return: "no impact before the horizon; the flight time is inf: give a larger horizon to look further",
    Status.escaped: "the flight is proved never to return; the flight time is inf",
    Status.unresolved: "a near graze that this precision cannot decide: depth and its bound say how near, ask with "
    "digits=; or, without them, a flight that left the range of numbers before it returned; or, on chatter, a million "
    "impacts that neither accumulate nor lift off: fly an orbit to see where they go; values are nan",
    Status.complete: "infinitely many impacts accumulate; the mass comes to rest at the accumulation time",
    Status.no_rebound: "the obstacle is hit, and rho gives no positive velocity there; v is nan: "
    "give a restitution that is positive at such velocities",
    Status.lifts_off: "contact is lost before the impacts accumulate",
    Status.none: "no gamma lies ahead, for a_c stays negative after this phase: the mass is pressed for ever, and no v "
    "separates complete from incomplete chatter; v is nan: give a clearance for which a_c has a zero",
}


class StatusArray(np.ndarray[Any, Any]):
    """An int8 array of statuses that says in a notebook what its numbers mean; what is computed from it is plain.

    Examples
    --------
    >>> statuses = status_array([0, 0, 3])
    >>> (statuses == Status.hit).tolist(), type(statuses == Status.hit).__name__
    ([True, True, False], 'ndarray')
    >>> print(statuses)
    [0 0 3]
    """

    def __array_wrap__(self, array: Any, context: Any = None, return_scalar: bool = False) -> Any:
        return array[()] if return_scalar or not array.shape else np.asarray(array)

    def _repr_html_(self) -> str:
        counts = [(Status(value), np.count_nonzero(self == value)) for value in np.unique(np.asarray(self))]
        rows = [(status.name, count, status.sentence) for status, count in counts]
        return table(["status", "how many", "what it means"], rows, f"{self.size} statuses")


def status_array(values: Any) -> Any:
    """Statuses as a `StatusArray` of the same shape, a view where it can be; a scalar stays one."""
    plain = np.asarray(values, dtype=np.int8)
    return plain.view(StatusArray) if plain.shape else plain[()]
