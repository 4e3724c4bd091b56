"""The fate of one orbit of `bench.truth.plain_orbits`: a periodic orbit, chatter for ever, rest, or none of these."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from functools import lru_cache
from math import inf, isfinite

from singimpact.bench.truth.graded_steps import HIT, MISS, UNDECIDED
from singimpact.bench.truth.plain_orbits import PlainOrbits


@dataclass(frozen=True)
class FollowedSettings:
    """When the fate of an orbit is decided."""

    periods: int = 64  # most impacts of a periodic orbit, as many as `basins` tells apart in a long run
    close: float = 1e-7  # relative distance of equal states
    every: int = 20  # impacts between two looks
    again: int = 30  # turns after which it is looked again whether fewer impacts close the orbit
    # an impact slower than this part of the fastest state, with a_c < 0, may belong to a chatter that completes: the
    # impacts left are flown and summed if they take less than `short` periods
    slow: float = 1e-2
    short: float = 0.02
    most: int = 3000  # impacts of a chatter
    # relative distances of neighbours: of an orbit that is chaotic, and of one that rounding moves; and of parted ones
    chaos: float = 1e-9
    rounding: float = 1e-15
    parted: float = 1e-2


FOLLOWED = FollowedSettings()
State = tuple[float, float, float]
"""tau within a period, v, and the periods before."""


@dataclass(frozen=True)
class Fate:
    """A behaviour: "orbit", "chatter" (one completes), "no impact", "unsettled", "undecided"; of what follows a chatter
    also "chatter for ever" and "rest".

    Parameters
    ----------
    n, k : impacts and periods. tau, v, impacts : the last state, and impacts flown. elapsed : time flown.
    """

    kind: str
    n: int = 0
    k: int = 0
    tau: float = 0.0
    v: float = 0.0
    impacts: int = 0
    elapsed: float = 0.0

    @property
    def name(self) -> str:
        """The behaviour in words."""
        return f"({self.n}, {self.k}) orbit" if self.kind == "orbit" else f"{self.kind} {self.k or ''}".strip()


@dataclass(frozen=True, eq=False)
class Follower:
    """Follows orbits of a model.

    Parameters
    ----------
    plain : its orbits. fast : fastest state of interest. impacts : at most, of an orbit that does not settle.
    horizon : of a flight.
    """

    plain: PlainOrbits
    fast: float
    impacts: int
    horizon: float

    @property
    def period(self) -> float:
        """The period of the forcing."""
        assert self.plain.period is not None
        return self.plain.period

    def first(self, tau: float, v: float) -> Fate:
        """The first behaviour of an orbit: a chatter that completes counts."""
        begun, wait = tau, 0
        states = deque([(tau, v, 0.0)], FOLLOWED.periods + 1)
        for count in range(1, self.impacts + 1):
            status = self._fly(states)
            if status != HIT:
                return Fate("no impact" if status == MISS else "undecided", impacts=count)
            tau, v, turns = states[-1]
            wait -= 1
            if wait <= 0 and self._slow(tau, v):
                end = self.plain.chatter(tau, v, FOLLOWED.most)
                if end.status == "complete":
                    elapsed = turns * self.period + tau + end.time - begun
                    return Fate("chatter", 0, 0, tau + end.time, 0.0, count, elapsed)
                wait = end.impacts
            if count % FOLLOWED.every == 0 and (closed := self._closed(states)):
                return Fate("orbit", *self._fewest(tau, v, closed), tau, v, count)
        return Fate("unsettled", 0, 0, tau, v, self.impacts)

    def _fly(self, states: deque[State]) -> int:
        """Put the state after the next impact behind the others; MISS or UNDECIDED where there is none."""
        tau, v, turns = states[-1]
        hit = self.plain.quick_impact(tau, v, self.horizon)
        if hit.status != HIT or not hit.v > 0:
            return MISS if hit.status == MISS else UNDECIDED
        passed = (tau + hit.time) // self.period
        states.append((tau + hit.time - passed * self.period, hit.v, turns + passed))
        return HIT

    def _slow(self, tau: float, v: float) -> bool:
        if v > FOLLOWED.slow * self.fast or not self.plain.slope < 1:
            return False
        a = self.plain.push(tau)
        return a < 0 and 2 * v / (-a * (1 - self.plain.slope)) < FOLLOWED.short * self.period

    def _closed(self, states: deque[State]) -> tuple[int, int] | None:
        """(n, k) of the last states, where the last one is near the one n impacts before it."""
        tau, v, turns = states[-1]
        for n in range(1, len(states)):
            earlier, speed, before = states[-1 - n]
            passed = turns - before + (tau - earlier) / self.period
            k = round(passed)
            if k > 0 and abs(passed - k) < FOLLOWED.close and abs(v - speed) < FOLLOWED.close * self.fast:
                return n, k
        return None

    def _fewest(self, tau: float, v: float, closed: tuple[int, int]) -> tuple[int, int]:
        """(n, k) after some turns more: an orbit that still spirals in comes back nearer after two turns."""
        n, k = closed
        if n == 1:
            return closed
        states = deque([(tau, v, 0.0)], n + 1)
        if any(self._fly(states) != HIT for _ in range(FOLLOWED.again * n)):
            return closed
        later = self._closed(states)
        return later if later and later[0] < n and later[0] * k == n * later[1] else closed

    def last(self, fate: Fate) -> Fate:
        """The motion for ever: after a chatter that completes the mass rests and lifts off, again and again."""
        if fate.kind != "chatter":
            return fate
        phase = self.plain.next_lift_off(fate.tau)
        if phase < 0:
            return Fate("rest", impacts=fate.impacts)
        path, times = [phase], list[float]()
        while True:
            after, time = _after_lift_off(self, path[-1])
            if after.kind != "chatter":
                return after
            times.append(time)
            phase = self.plain.next_lift_off(after.tau)
            if phase in path:
                at = path.index(phase)
                return Fate("chatter for ever", 0, round(sum(times[at:]) / self.period), impacts=fate.impacts)
            path.append(phase)

    def separates(self, state: tuple[float, float], distance: float, impacts: int) -> bool:
        """Whether an orbit and a neighbour part within so many impacts."""
        one, other = state, (state[0] + distance * self.period, state[1] * (1 + distance))
        for _ in range(impacts):
            ends = [self.plain.impacts(*each, 1, True) for each in (one, other)]
            if None in ends:
                return ends[0] is not ends[1]
            (t, v), (s, u) = ((each[0] + end[0], end[1]) for each, end in zip((one, other), ends, strict=True) if end)
            if abs(t - s) > FOLLOWED.parted * self.period or abs(v - u) > FOLLOWED.parted * self.fast:
                return True
            turns = t // self.period * self.period
            one, other = (t - turns, v), (s - turns, u)
        return False


@lru_cache(maxsize=64)
def _after_lift_off(follower: Follower, place: int) -> tuple[Fate, float]:
    """The behaviour after a lift-off, and the time to the next one where a chatter completes."""
    lifted = follower.plain.lift_offs[place]
    hit = follower.plain.lifted(lifted, follower.horizon)
    if hit.status != HIT or not hit.v > 0:
        return Fate("no impact" if hit.status == MISS else "undecided"), inf
    fate = follower.first(lifted + hit.time, hit.v)
    if fate.kind != "chatter" or not isfinite(fate.tau):
        return fate, inf
    rest = follower.plain.lift_offs[follower.plain.next_lift_off(fate.tau)] - fate.tau
    return fate, hit.time + fate.elapsed + rest % follower.period
