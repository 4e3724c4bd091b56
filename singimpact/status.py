"""Outcomes of a numerical question, as data: a failure is a status with a cause and a next step, never an exception."""

from __future__ import annotations

from enum import IntEnum


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
    "digits=; or, without them, a flight that left the range of numbers before it returned; values are nan",
    Status.complete: "infinitely many impacts accumulate; the mass comes to rest at the accumulation time",
    Status.no_rebound: "the obstacle is hit, and rho gives no positive velocity there; v is nan: "
    "give a restitution that is positive at such velocities",
    Status.lifts_off: "contact is lost before the impacts accumulate",
}
