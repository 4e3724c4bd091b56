"""Pixels of basins of one model, each followed by itself with `bench.truth.plain_orbits`.

Truth: one orbit of fixed-step flights, chatter summed from such impacts, lift-offs by bisection of a_c. Shared with the
package: f, g, rho as expression trees, the period, and the horizon after which a flight counts as one without impact.
"""

from collections import deque
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import lru_cache
from math import copysign, inf, isfinite

import numpy as np

from singimpact.bench.selftest.rows import Flown, NotComparable, Tally, compared
from singimpact.bench.truth.graded_steps import HIT, MISS, UNDECIDED
from singimpact.bench.truth.plain_orbits import PlainOrbits
from singimpact.dynamics import basins_of_attraction
from singimpact.dynamics.behaviours import LongRun
from singimpact.flights.horizons import horizon_of
from singimpact.inputs import InputError, need

UNSETTLED = ("chaotic", "not decided")


# The fate of one orbit of `bench.truth.plain_orbits`: a periodic orbit, chatter for ever, rest, or none of these.


@dataclass(frozen=True)
class PixelSettings:
    """The number of pixels, and when the fate of an orbit is decided."""

    size: int = 8  # pixels a side
    followed: int = 16  # of them
    impacts: int = 3000  # of an orbit, in `basins` and here; the default of `basins` takes a minute here
    # relative changes of a state, far above the tolerance 1e-10 of the flights of `basins`: where one moves the orbit
    # into another class, rounding explains the difference
    moved: tuple[float, ...] = (-1e-8, -3e-9, 3e-9, 1e-8)
    transient: int = 200  # an orbit that settles sooner is no long transient, whatever its neighbours do
    same: float = 1e-3  # relative distance of states of one attractor
    longer: int = 20_000  # impacts of an orbit that has settled in `basins` and not here
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


PIXELS = PixelSettings()
# tau within a period, v, which is < 0 or -0.0 at an upper wall, and the periods before.
State = tuple[float, float, float]


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

    def first(self, tau: float, v: float) -> Fate:
        """The first behaviour of an orbit: a chatter that completes counts."""
        if not v and self.plain.at(v).push(tau) < 0:
            return Fate("chatter", tau=tau, v=v)
        begun, wait = tau, 0
        states = deque([(tau, v, 0.0)], PIXELS.periods + 1)
        for count in range(1, self.impacts + 1):
            status = self._fly(states)
            if status != HIT:
                return Fate("no impact" if status == MISS else "undecided", impacts=count)
            tau, v, turns = states[-1]
            wait -= 1
            if wait <= 0 and self._slow(tau, v):
                end = self.plain.chatter(tau, v, PIXELS.most)
                if end.status == "complete":
                    elapsed = turns * self.plain.period + tau + end.time - begun
                    return Fate("chatter", 0, 0, tau + end.time, copysign(0.0, end.v), count, elapsed)
                wait = end.impacts
            if count % PIXELS.every == 0 and (closed := self._closed(states)):
                return Fate("orbit", *self._fewest(tau, v, closed), tau, v, count)
        return Fate("unsettled", 0, 0, tau, v, self.impacts)

    def _fly(self, states: deque[State]) -> int:
        """Put the state after the next impact behind the others; MISS or UNDECIDED where there is none."""
        tau, v, turns = states[-1]
        hit = self.plain.fly(tau, v, True, self.horizon)
        if not self.plain.goes_on(hit):
            return MISS if hit.status == MISS else UNDECIDED
        passed = (tau + hit.time) // self.plain.period
        states.append((tau + hit.time - passed * self.plain.period, hit.v, turns + passed))
        return HIT

    def _slow(self, tau: float, v: float) -> bool:
        here = self.plain.at(v)
        if abs(v) > PIXELS.slow * self.fast or not here.slope < 1:
            return False
        a = here.push(tau)
        return a < 0 and 2 * abs(v) / (-a * (1 - here.slope)) < PIXELS.short * self.plain.period

    def _closed(self, states: deque[State]) -> tuple[int, int] | None:
        """(n, k) of the last states, where the last one is near the one n impacts before it."""
        tau, v, turns = states[-1]
        for n in range(1, len(states)):
            earlier, speed, before = states[-1 - n]
            passed = turns - before + (tau - earlier) / self.plain.period
            k = round(passed)
            if k > 0 and abs(passed - k) < PIXELS.close and abs(v - speed) < PIXELS.close * self.fast:
                return n, k
        return None

    def _fewest(self, tau: float, v: float, closed: tuple[int, int]) -> tuple[int, int]:
        """(n, k) after some turns more: an orbit that still spirals in comes back nearer after two turns."""
        n, k = closed
        if n == 1:
            return closed
        states = deque([(tau, v, 0.0)], n + 1)
        if any(self._fly(states) != HIT for _ in range(PIXELS.again * n)):
            return closed
        later = self._closed(states)
        return later if later and later[0] < n and later[0] * k == n * later[1] else closed

    def last(self, fate: Fate) -> Fate:
        """The motion for ever: after a chatter that completes the mass rests and lifts off, again and again."""
        if fate.kind != "chatter":
            return fate
        path, times, after = list[tuple[int, float]](), list[float](), fate
        while True:
            phase = self.plain.at(after.v).next_lift_off(after.tau)
            if phase < 0:
                return Fate("rest", v=after.v, impacts=fate.impacts)
            lifted = phase, copysign(1.0, after.v)
            if lifted in path:
                at = path.index(lifted)
                return Fate("chatter for ever", 0, round(sum(times[at:]) / self.plain.period), impacts=fate.impacts)
            path.append(lifted)
            after, time = _after_lift_off(self, *lifted)
            if after.kind != "chatter":
                return after
            times.append(time)

    def separates(self, state: tuple[float, float], distance: float, impacts: int) -> bool:
        """Whether an orbit and a neighbour part within so many impacts."""
        one, other = state, (state[0] + distance * self.plain.period, state[1] * (1 + distance))
        for _ in range(impacts):
            ends = [self.plain.impacts(*start, 1, True) for start in (one, other)]
            if None in ends:
                return ends[0] is not ends[1]
            (t, v), (s, u) = ((start[0] + end[0], end[1]) for start, end in zip((one, other), ends, strict=True) if end)
            if abs(t - s) > PIXELS.parted * self.plain.period or abs(v - u) > PIXELS.parted * self.fast:
                return True
            turns = t // self.plain.period * self.plain.period
            one, other = (t - turns, v), (s - turns, u)
        return False


@lru_cache(maxsize=64)
def _after_lift_off(follower: Follower, index: int, side: float) -> tuple[Fate, float]:
    """The behaviour after a lift-off, and the time to the next one where a chatter completes.

    Parameters
    ----------
    side : of the wall, -1 for the upper one.
    """
    lifted = follower.plain.at(side).lift_offs[index]
    hit = follower.plain.lifted(lifted, follower.horizon, copysign(0.0, side))
    if not follower.plain.goes_on(hit):
        return Fate("no impact" if hit.status == MISS else "undecided"), inf
    fate = follower.first(lifted + hit.time, hit.v)
    if fate.kind != "chatter" or not isfinite(fate.tau):
        return fate, inf
    there = follower.plain.at(fate.v)
    rest = there.lift_offs[there.next_lift_off(fate.tau)] - fate.tau if there.lift_offs else inf
    return fate, hit.time + fate.elapsed + rest % follower.plain.period


@compared("pixels of basins")
def row(flown: Flown, tally: Tally) -> None:
    """Some of the pixels of a picture."""
    osc, fast = flown.osc, flown.scales.fast
    need(flown.scales.period is not None, NotComparable("g has no period"))
    try:
        follower = Follower(flown.plain, fast, PIXELS.impacts, horizon_of(osc, None))
        with ThreadPoolExecutor(1) as pool:
            answer = basins_of_attraction.basins(osc, None, (0, fast), PIXELS.size, pool, None, PIXELS.impacts)
    except (InputError, TypeError) as reason:
        raise NotComparable(reason) from reason
    tally.restart()
    tau, v = (axis.ravel() for axis in np.meshgrid(answer.tau, answer.v))
    places = np.unique(np.linspace(0, tau.size - 1, PIXELS.followed).astype(int))
    first = answer.first_chatter_completes.ravel()
    for at in tally.in_time(places.tolist()):
        state = float(tau[at]), float(v[at])
        _pixel(follower, state, answer.attractors[answer.codes.ravel()[at]], bool(first[at]), tally)


def _pixel(follower: Follower, state: tuple[float, float], answer: LongRun, first: bool, tally: Tally) -> None:
    call = f"basins from tau {state[0]!r}, v {state[1]!r}: {answer.name}, first chatter completes: {first}"
    if answer.kind == "unresolved":
        tally.leave("unresolved")
        return
    fate = follower.first(*state)
    if fate.kind == "unsettled" and answer.kind not in (*UNSETTLED, "sensitive"):
        fate = replace(follower, impacts=PIXELS.longer).first(*state)
    call += f"; followed: {fate.name} after {fate.impacts} impacts"
    if fate.kind == "undecided":
        tally.leave("steps do not settle")
    elif answer.kind == "sensitive":
        _sensitive(follower, state, fate, call, tally)
    elif answer.kind in UNSETTLED and not first and (open_ := _unsettled_beside(follower, state, fate)):
        # "chaotic" says that neighbours separate too
        if answer.kind == "not decided" or follower.separates((open_.tau, open_.v), PIXELS.chaos, PIXELS.impacts):
            tally.judge(0.0, call)
        else:
            tally.leave("no period, and neighbours separate slowly if at all")
    elif _agrees(follower, answer, first, fate):
        tally.judge(0.0, call)
    elif cause := _explained(follower, state, answer, fate):
        tally.leave(cause)
    else:
        tally.judge(np.inf, call)


def _agrees(follower: Follower, answer: LongRun, first: bool, fate: Fate) -> bool:
    """Whether the first chatter, and what comes of the orbit for ever, are those of `basins`."""
    if first != (fate.kind == "chatter"):
        return False
    last = follower.last(fate)
    if answer.kind == "orbit" and last.kind == "orbit":
        return (last.n, last.k) == (answer.n, answer.k) and _near(follower, answer, last)
    if answer.kind == "chatter":
        return last.kind == "chatter for ever" and last.k == answer.k
    if answer.kind in ("no impact", "never returns"):
        return last.kind == "no impact"
    if answer.kind in UNSETTLED:  # after a chatter
        return last.kind == "unsettled"
    return answer.kind == last.kind == "rest" and answer.word in ("", "lu"[copysign(1.0, last.v) < 0])


def _near(follower: Follower, answer: LongRun, fate: Fate) -> bool:
    """Whether the last state is one of the attractor."""
    away = (fate.tau - answer.tau) / follower.plain.period
    near = (np.abs(away - np.rint(away)) < PIXELS.same) & (np.abs(fate.v - answer.v) < PIXELS.same * follower.fast)
    return bool(near.any())


def _explained(follower: Follower, state: tuple[float, float], answer: LongRun, fate: Fate) -> str:
    """Why a difference decides nothing; empty where nothing explains it."""
    last = follower.last(fate)
    if "undecided" in (last.kind, fate.kind):
        return "steps do not settle"
    if "orbit" == answer.kind == last.kind and last.n != answer.n and _near(follower, answer, last):
        few, many = sorted(((last.n, last.k), (int(answer.n), answer.k)))
        # an orbit that is another one several times over has equal states
        apart = np.abs(np.subtract.outer(answer.v, answer.v))[np.triu_indices(int(answer.n), 1)]
        doubled = answer.n < last.n or bool((apart > PIXELS.close * follower.fast).all())
        if many[0] * few[1] == few[0] * many[1] and doubled:
            return "settles slowly beside a period doubling"
    if last.kind == "unsettled":
        return "settles slowly"
    fates = [follower.first(state[0] + change, state[1] * (1 + change)) for change in PIXELS.moved]
    if any(follower.last(beside).name != last.name or beside.kind != fate.kind for beside in fates):
        return "rounding moves it to another class"
    return ""


def _unsettled_beside(follower: Follower, state: tuple[float, float], fate: Fate) -> Fate | None:
    """The fate of an orbit that does not settle, or of such a neighbour: rounding decides how long a transient is."""
    if fate.kind == "unsettled" or fate.impacts < PIXELS.transient:
        return fate if fate.kind == "unsettled" else None
    fates = (follower.first(state[0] + part, state[1] * (1 + part)) for part in PIXELS.moved)
    return next((beside for beside in fates if beside.kind == "unsettled"), None)


def _sensitive(follower: Follower, state: tuple[float, float], fate: Fate, call: str, tally: Tally) -> None:
    """Neighbours 1e-15 away part before the orbit settles; where some 1e-12 away do not, this is wrong."""
    count = max(fate.impacts, 1)
    if follower.separates(state, PIXELS.rounding, count):
        tally.judge(0.0, call)
    elif follower.separates(state, 1e3 * PIXELS.rounding, count):
        tally.leave("neighbours part at a distance above rounding")
    else:
        tally.judge(np.inf, call)
