"""Outcomes of a numerical question, as data: a failure is a status with a cause and a next step, never an exception."""

from enum import IntEnum
from typing import Any

import numpy as np

from singimpact.notebook import table


class Status(IntEnum):
    """The outcome of a flight, a chatter sequence or an orbit.

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
    other_wall = 10

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
    Status.unresolved: "not decided, values are nan: `cause` says why, and `sentence` of the result what to type next",
    Status.complete: "infinitely many impacts accumulate; the mass comes to rest at the accumulation time",
    Status.no_rebound: "the obstacle is hit, and rho gives no positive velocity there; v is nan: "
    "give a restitution that is positive at such velocities",
    Status.lifts_off: "contact is lost before the impacts accumulate",
    Status.none: "no gamma lies ahead, for a_c stays negative after this phase: the mass is pressed for ever, and no v "
    "separates complete from incomplete chatter; v is nan: give a clearance for which a_c has a zero",
    Status.other_wall: "chatter completes below v, and from v on a flight meets the other wall: gamma lies above v, or "
    "none lies ahead",
}


class Cause(IntEnum):
    """Why a result is `unresolved`; 0 beside every other status.

    Examples
    --------
    >>> print(Cause.step_budget.sentence)
    the flight takes more Taylor steps than it was given: type steps= with a larger number, or a shorter horizon=
    """

    decided = 0
    near_graze = 1
    step_budget = 2
    domain_left = 3
    kink = 4
    overflow = 5
    impacts_exhausted = 6
    settled = 7

    @property
    def sentence(self) -> str:
        """The cause and what to type next, for a person."""
        return _CAUSES[self]


_CAUSES = {
    Cause.decided: "the status is no question",
    Cause.near_graze: "the flight comes so near to the obstacle that rounding decides whether it touches; depth and "
    "its bound say how near: type digits=30",
    Cause.step_budget: "the flight takes more Taylor steps than it was given: type steps= with a larger number, or a "
    "shorter horizon=",
    Cause.domain_left: "the flight reaches a point where f or g is singular, or grows without a bound: type "
    "osc.flight(tau, v, t) to see the way there",
    Cause.kink: "f or g is not smooth where the flight passes, or changes there within less than a rounding of time: "
    "replace |u| by sqrt(u**2 + 1e-6), or a jump by a steep tanh",
    Cause.overflow: "x or x' leaves the range of doubles: type digits=20",
    Cause.impacts_exhausted: "the impacts neither accumulate nor lift off within the number given: type impacts= with "
    "a larger number, or fly osc.orbit to see where they go",
    Cause.settled: "the impacts repeat themselves to all digits, and neither accumulate nor lift off: fly osc.orbit to "
    "see the periodic orbit",
}


class Wall(IntEnum):
    """The wall of a state; arrays of walls are ``int8``.

    Examples
    --------
    >>> Wall(1).name
    'upper'
    """

    lower = 0
    upper = 1


_WALLS: dict[object, int] = {name: wall for wall in Wall for name in (wall.name, wall.name[0], int(wall))}


def wall_of(name: object) -> int:
    """The wall of a name: "lower" or "upper", the first letter, 0 or 1; -1 of anything else.

    Examples
    --------
    >>> [wall_of(name) for name in ("u", 0, "left", {})]
    [<Wall.upper: 1>, <Wall.lower: 0>, -1, -1]
    """
    return _WALLS.get(name, -1) if isinstance(name, str | int | np.integer) else -1


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
