"""Attracting responses to a forcing that never repeats: orbits from different starts that meet at equal times.

Nothing closes here, so orbits are compared with each other, at their first impacts after one late time.  A response on
which neighbours come together is called quasi-periodic; one on which they separate, chaotic.
"""

from dataclasses import replace

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.dynamics.attractors import CHAOS, CHATTER, OTHER, RESPONSE, RESTING, STUCK, apart
from singimpact.dynamics.lift_off import release
from singimpact.dynamics.long_run import growth
from singimpact.dynamics.settling import Study, at_rest, chattering, ended
from singimpact.flights.impact_map import impact_map
from singimpact.flights.orbits import signed_iterate
from singimpact.status import Status

# Turns of the fastest motion in which the responses that are left are compared: an exponent of -0.01 an impact makes
# 1e-8 of a distance
CONFIRMED = 2048
# Relative distances of responses that are one, and of those that are several
SAME, DIFFERENT = 1e-6, 1e-3


class Responses:
    """Orbits followed to late times; `rows` of `classify`, impacts flown, and chatters that have completed."""

    def __init__(self, study: Study, tau: Array, v: Array) -> None:
        self.study, self.tau, self.v = study, tau.copy(), v.copy()
        self.rows = np.full((tau.size, 3), np.nan)
        self.flown, self.rests = np.zeros((2, tau.size), dtype=np.int64)
        # of each rest its begin, its end, and the impact after it
        self.lifted: list[tuple[float, ...]] = []

    def settle(self) -> None:
        """Follow all states until neighbours of each come together, or its impacts are used up."""
        # turns before the classes are looked for first; the times are doubled
        leader, time = np.arange(self.tau.size), self.study.phases.unit * 128
        while True:
            before = self.rests.copy()
            self.advance(np.unique(leader), self.study.start + time)
            leader, time = self._joined(leader), 2 * time
            if self._judged(np.unique(leader), self.rests - before):
                break
        for column in (self.rows, self.tau, self.v, self.flown, self.rests):
            column[:] = column[leader]

    def advance(self, chosen: Array, until: float) -> None:
        """The first impacts of orbits after a time; orbits that end before get their rows."""
        model = self.study.model
        left = self._going(chosen, until)
        while left.size:
            ends = signed_iterate(model, self.tau[left], self.v[left], 1)
            self.tau[left], self.v[left] = ends.tau, ends.v
            self.flown[left] += 1
            resting = chattering(self.study, ends.tau, ends.v) | np.isin(ends.status, (Status.complete, Status.sticks))
            for index in left[resting].tolist():
                self._lift(index)
            over = ~resting & ((ends.status != 0) | ~self._leaves(ends.v))
            self.rows[left[over]] = ended(ends.status[over])
            left = self._going(left, until)

    def _going(self, chosen: Array, until: float) -> Array:
        """Orbits that are open, with impacts left, before a time."""
        going = np.isnan(self.rows[chosen, 0]) & (self.tau[chosen] < until)
        return np.asarray(chosen[going & (self.flown[chosen] < self.study.impacts)])

    def _lift(self, index: int) -> None:
        """The first impact after the rest that a chatter ends in."""
        tau, above = float(self.tau[index]), bool(np.signbit(self.v[index]))
        model, side = (self.study.model.mirrored, -1.0) if above else (self.study.model, 1.0)
        rest = tau if self.v[index] == 0 else float(at_rest(self.study, np.array([tau]), self.v[index : index + 1])[0])
        self.rests[index] += 1
        # every orbit that rests between the same two zeros of a_c lifts off with the others
        earlier = [after for begin, end, wall, *after in self.lifted if begin <= rest <= end and wall == side]
        if not earlier:
            end = release(model, rest)
            after = [np.nan, 0.0 if np.isinf(end) else np.nan]
            if np.isfinite(end):
                step = impact_map(model, end, 0.0)
                after = [float(step.tau), float(step.v) * (-side if step.wall else side)]
            self.lifted.append((rest, end, side, *after))
            earlier = [after]
        tau, v = earlier[0]
        self.tau[index], self.v[index] = tau, v
        if not self._leaves(v) or np.isnan(tau):
            self.rows[index] = (CHATTER, -1.0, 0.0) if v == 0 and np.isnan(tau) else (STUCK, 0.0, 0.0)

    def _leaves(self, v: Array | float) -> Array:
        """Whether an orbit goes on after an impact; with restitution 0 none leaves a velocity."""
        return np.asarray(np.isfinite(v) if self.study.model.plastic else np.abs(v) > 0)

    def _joined(self, leader: Array) -> Array:
        """The leaders of orbits, those that have met become one."""
        first = np.unique(leader)
        open_ = first[np.isnan(self.rows[first, 0])]
        order = open_[np.lexsort((self.v[open_], self.tau[open_]))]
        states = self.tau[order], self.v[order]
        step = apart([c[1:] for c in states], [c[:-1] for c in states], self.study.phases, self.study.fast)
        # nearer orbits are followed as one
        group = np.concatenate([[0], np.cumsum(step > 1e-12)])[: order.size]
        target = np.arange(self.tau.size)
        target[order] = order[np.searchsorted(group, group)]
        return np.asarray(target[leader])

    def _judged(self, first: Array, rests: Array) -> bool:
        """Whether the rows of orbits are decided, or their impacts used up."""
        first = first[np.isnan(self.rows[first, 0])]
        codes = np.full(first.size, RESTING)
        # lift-offs between two looks, of an orbit that comes to rest again and again
        flying = np.flatnonzero(rests[first] < 2)
        at = first[flying]
        sign = growth(self.study.model, self.tau[at], self.v[at], self.study.fast)
        codes[flying] = np.select([sign < 0, sign > 0], [RESPONSE, CHAOS], OTHER)
        rows = np.stack([codes, self.tau[first], self.v[first]], axis=1)
        rows[codes != RESPONSE, 1:] = 0.0
        decided = np.isin(codes, (RESPONSE, RESTING)) | (self.flown[first] >= self.study.impacts)
        self.rows[first[decided]] = rows[decided]
        return bool(decided.all())


def responses(study: Study, tau: Array, v: Array) -> Array:
    """Rows as those of `classify`, of states under a forcing that never repeats."""
    run = Responses(study, tau, v)
    run.settle()
    return np.column_stack([run.rows, run.flown, run.rests > 0])


def meets(study: Study, tau: float, v: float) -> bool:
    """Whether the exponent of an orbit is below 0, and the orbit of a neighbour is seen to meet it.

    Examples
    --------
    >>> from singimpact.oscillator.model import Oscillator
    >>> model = Oscillator("x", "cos(2*t) + cos(2*sqrt(2)*t)/2", "0.3", "0.7")
    >>> meets(Study(model, (), 1.0, 100), 0.0, 1.0)
    True
    """
    if growth(study.model, np.array([tau]), np.array([v]), study.fast)[0] >= 0:
        return False
    rows = confirmed(study, np.array([[RESPONSE, tau, v], [RESPONSE, tau, v * (1 + DIFFERENT)]]))
    return bool(rows[0, 0] == RESPONSE and (rows[0] == rows[1]).all())


def confirmed(study: Study, rows: Array) -> Array:
    """Rows with one state for each response: those that meet at a later time are one, those that stay apart several.

    Rows of orbits that have come near each other and have not met are OTHER.
    """
    rows, chosen = rows.copy(), np.flatnonzero(rows[:, 0] == RESPONSE)
    several, which = np.unique(rows[chosen], axis=0, return_inverse=True)
    # impacts there, at most
    run = Responses(replace(study, impacts=10**6), several[:, 1], several[:, 2])
    late = several[:, 1].max(initial=study.start) + study.phases.unit * CONFIRMED
    run.advance(np.arange(len(several)), late)
    out, left = run.rows.copy(), np.isnan(run.rows[:, 0])
    while left.any():
        i = np.flatnonzero(left)[0]
        away = apart((run.tau, run.v), (run.tau[i], run.v[i]), study.phases, study.fast)
        near = left & (away < DIFFERENT)
        out[near] = RESPONSE, run.tau[i], run.v[i]
        out[near & (away >= SAME)] = OTHER, 0.0, 0.0
        left &= ~near
    rows[chosen] = out[which.ravel()]
    return rows
