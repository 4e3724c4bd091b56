"""Where states settle: on a periodic orbit, in chatter that completes, or not within the impacts that are flown.

Chaotic transients are long where impacts lose little: x'' + x = cos 3.3t with c = 0.03 and r = 0.95 settles on one
(2, 2) orbit after 600, 3800 and 15 360 impacts (5, 50 and 95 % of the states).  So a state that has not settled when
the slowest plain chatter would be over is followed on, and compared with the attractors found meanwhile.
"""

from dataclasses import dataclass
from math import ceil, log

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.dynamics import attractors
from singimpact.dynamics.free_motion import free_fates
from singimpact.dynamics.long_run import chaotic, next_lift_off
from singimpact.dynamics.phases import Phases, phases_of
from singimpact.dynamics.remaining import rest_after, stays_below
from singimpact.flights.flat_numbers import gap_of
from singimpact.flights.impact_map import impact_map
from singimpact.flights.off_wall import launch
from singimpact.flights.orbits import signed, signed_iterate
from singimpact.flights.walls import at_walls, each_wall
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.status import Status


@dataclass(frozen=True)
class SettlingSettings:
    """When the class of an orbit is decided."""

    # v of an impact in complete chatter where a_c < 0, as a share of the largest v of the window
    rest: float = 1e-7
    # the same if the remaining chatter is shorter than `lasting` and a_c stays negative until then
    slow: float = 1e-2
    lasting: float = 0.02  # periods of the forcing
    # impacts before the first test, in addition to those that chatter needs to become so slow
    transient: int = 40
    block: int = 6  # impacts between two tests
    # of a Taylor step: at 1e-6 no class of 18 000 states changes; a flight costs a quarter less than at full accuracy
    tolerance: float = 1e-10
    limit: int = 3000  # impacts of the first stage; r = 0.99 needs 2000
    # of the second stage: impacts between two looks, a number with many divisors, for a state that an attractor of n
    # impacts has caught is back after it if n divides it; and looks between two searches for other n
    long_block: int = 240
    searched: int = 20
    # impacts of the longest period that a search in the second stage, and the last look, tell apart
    long_period: int = 64
    longest_period: int = 256
    # impacts after which a class is checked by a neighbour: an exponent of 0.5 an impact makes 1e-2 of 1e-15 in 60
    sensitive: int = 60
    # relative distance of this neighbour, a few roundings; impacts between two looks; distance when both have parted
    neighbour: float = 1e-15
    watched: int = 10
    parted: float = 1e-2


SETTINGS = SettlingSettings()


@dataclass(frozen=True)
class Study:
    """The data of a study of states: the model, phase and wall of each lift-off, the fastest launch, impacts.

    States are (tau, v) at the wall, with -v at an upper one; the latest tau is `start`. Those of a model without a
    clock are (x, x').
    """

    model: Oscillator
    lift_offs: tuple[tuple[float, int], ...]
    fast: float
    impacts: int
    start: float = 0.0

    @property
    def phases(self) -> Phases:
        """The phases in which its states are compared."""
        return phases_of(self.model)

    @property
    def horizon(self) -> float | None:
        """Time after which a flight of a model without a clock is looked at; None for the package default."""
        # turns of the fastest motion after which a flight is looked at as one without impact
        return None if self.phases.clocked else 32 * self.phases.unit


def classify(study: Study, tau: Array, v: Array) -> Array:
    """Rows (code, tau, v, impacts, rests), shape (n, 5): of a periodic orbit n * PLACES + k and one of its states;
    CHATTER and the place of the lift-off that follows; else one of the other codes of `attractors`. Impacts are those
    flown before the class was decided; rests is 1 where the first chatter completes.
    """
    run = _Run(study, tau, v)
    run.settle()
    return np.column_stack([run.rows, run.flown, run.rows[:, 0] == attractors.CHATTER])


def settles(rows: Array) -> Array:
    """Whether rows of `classify` have reached an attractor."""
    return np.asarray(
        (rows[:, 0] >= attractors.CHATTER) & ~np.isin(rows[:, 0], (attractors.CHAOS, attractors.SENSITIVE))
    )


def parted(study: Study, tau: Array, v: Array, impacts: Array) -> Array:
    """Whether a neighbour a few roundings away parts from an orbit within so many impacts.

    Parameters
    ----------
    tau, v, impacts : of each state, shape (n,).
    """
    separated, left = np.zeros(tau.size, dtype=bool), np.arange(tau.size)
    sides = np.array([[0.0], [SETTINGS.neighbour]])
    at, speed, count = tau + sides * study.phases.unit, v * (1 + sides), 0
    while left.size:
        ends = signed_iterate(study.model, at[:, left], speed[:, left], SETTINGS.watched, SETTINGS.tolerance)
        count += SETTINGS.watched
        at[:, left], speed[:, left] = study.phases.of(ends.tau), ends.v
        one, other = ((at[side, left], speed[side, left]) for side in (0, 1))
        distance = attractors.apart(one, other, study.phases, study.fast)
        flying = (ends.status == 0).all(axis=0)
        # one ends its flights where the other goes on
        torn = (ends.status[0] == 0) != (ends.status[1] == 0)
        separated[left] = torn | (flying & (distance > SETTINGS.parted))
        left = left[flying & ~separated[left] & (count < impacts[left])]
    return separated


class _Run:
    """States on their way to an attractor."""

    def __init__(self, study: Study, tau: Array, v: Array) -> None:
        self.study, self.tau, self.v = study, tau.copy(), v.copy()
        self.rows, self.open = np.zeros((tau.size, 3)), np.arange(tau.size)
        # impacts after which each was decided
        self.flown = np.zeros(tau.size, dtype=np.int64)
        self.known: list[attractors.Attractor] = []
        self.count = 0

    def settle(self) -> None:
        """Follow all states to a class."""
        if not self.study.phases.clocked:
            self._drop()
        self._first_stage()
        if self.open.size and self.count < self.study.impacts:
            self._look()
            self._second_stage()
        self._last_look()

    def _drop(self) -> None:
        """The first flights of states (x, x') of a model without a clock, to the wall."""
        model, x, xdot = self.study.model, self.tau, self.v
        ends = launch(model, x, xdot, 0.0, horizon=self.study.horizon)
        rows, self.tau, self.v = ended(ends.status), 0.0 * x, signed(ends)
        free = np.flatnonzero(_open_flights(ends.status))
        late = free[self._free(rows, free, x[free] - as_float(model.clearance), xdot[free])]
        self.v[late] = signed(launch(model, x[late], xdot[late], 0.0))
        self._decide(~((np.abs(self.v) > 0) | (model.plastic & (ends.status == Status.hit))), rows)

    def _free(self, rows: Array, free: Array, height: Array, xdot: Array) -> Array:
        """Put in the rows of motions that met no wall for long; whether these meet it all the same."""
        fates = free_fates(self.study.model, height, xdot)
        late = np.isnan(fates[:, 0])
        certain = ~late & ((fates[:, 0] != attractors.AWAY) | (rows[free, 0] != attractors.GONE))
        rows[free[certain]] = fates[certain]
        return np.asarray(late & (rows[free, 0] != attractors.GONE))

    def _first_stage(self) -> None:
        """The number of impacts in which a plain chatter becomes slow, with searches at doubling distances."""
        rates = [as_float(model.slope_at_rest()) for model, _ in each_wall(self.study.model, self.v)]
        slowest = max(ceil(log(SETTINGS.rest) / log(r)) if 0 < r < 1 else 0 for r in rates)
        most = min(SETTINGS.transient + slowest, SETTINGS.limit, self.study.impacts)
        block = SETTINGS.block
        while self.open.size and self.count < most:
            block = min(block, most - self.count)
            self._fly(block)
            if self.open.size and self.count < most:
                # a search in vain is dear, and the next one more so
                block *= 1 if self._catch() else 2

    def _second_stage(self) -> None:
        looks = 0
        while self.open.size and self.count < self.study.impacts:
            tau, v = self.tau.copy(), self.v.copy()
            self._fly(min(SETTINGS.long_block, self.study.impacts - self.count))
            looks += 1
            if not self.open.size:
                return
            places = self._caught()
            back = places < 0
            if looks % SETTINGS.searched:
                now, then = (self.tau[self.open], self.v[self.open]), (tau[self.open], v[self.open])
                back &= attractors.apart(now, then, self.study.phases, self.study.fast) < attractors.SETTINGS.close
            if back.any():
                places = self._search(places, np.flatnonzero(back), SETTINGS.long_period)
            self._take(places)

    def _last_look(self) -> None:
        """Of states that are left: a long period, else neighbours that separate."""
        if self.open.size:
            self._look(SETTINGS.longest_period)
        if self.open.size:
            study, at = self.study, self.open
            self.rows[at] = 0.0
            self.rows[at[chaotic(study.model, self.tau[at], self.v[at], study.fast)], 0] = attractors.CHAOS
            self.flown[at] = self.count

    def _look(self, most: int = attractors.SETTINGS.most_impacts) -> None:
        """States that close by themselves within so many impacts."""
        study, at = self.study, self.open
        found = attractors.closing_orbits(study.model, self.tau[at], self.v[at], study.fast, most)
        self._decide(found[0] != attractors.OTHER, np.stack(found, axis=1))

    def _decide(self, chosen: Array, rows: Array) -> None:
        """Put rows in for the chosen of the open states."""
        self.rows[self.open[chosen]] = rows[chosen]
        self.flown[self.open[chosen]] = self.count
        self.open = self.open[~chosen]

    def _fly(self, impacts: int) -> None:
        """Impacts of all open states; those whose flights end are decided."""
        study, at = self.study, self.open
        ends = signed_iterate(study.model, self.tau[at], self.v[at], impacts, SETTINGS.tolerance, study.horizon)
        self.count += impacts
        self.tau[at], self.v[at] = study.phases.of(ends.tau), ends.v
        rests = chattering(study, self.tau[at], ends.v)
        rows, over = ended(ends.status), (ends.status != 0) | ~np.isfinite(ends.tau) | np.isnan(ends.v)
        if not study.phases.clocked:
            free = np.flatnonzero(_open_flights(ends.status))
            above = np.signbit(ends.v)
            heights = np.where(above, gap_of(study.model)[0], 0.0)
            late = free[self._free(rows, free, heights[free], ends.v[free])]
            walls = None if study.model.upper is None else above[late].astype(np.int8)
            step = at_walls(impact_map, study.model, walls, (0 * ends.v[late], np.abs(ends.v[late])))
            self.v[at[late]] = signed(step)
            over[late] = ~(np.abs(self.v[at[late]]) > 0)
            # off a wall that pushes, flights of so slow a launch are grazes to rounding; a mass at rest leaves as one
            over |= ~rests & (np.abs(ends.v) <= SETTINGS.rest * study.fast) & ~((ends.v == 0) & study.model.plastic)
        rows[rests, 0] = attractors.CHATTER
        resting = np.flatnonzero(rests)
        ended_at = at_rest(study, self.tau[at[resting]], self.v[at[resting]])
        for wall, (_, there) in enumerate(each_wall(study.model, self.v[at[resting]])):
            rows[resting[there], 1] = next_lift_off(study.lift_offs, ended_at[there], wall)
        self._decide(rests | over, rows)

    def _catch(self) -> bool:
        """Whether some open states are near a known attractor, or one that a sample of them has reached."""
        places = self._caught()
        places = self._search(places, np.flatnonzero(places < 0))
        self._take(places)
        return bool((places >= 0).any())

    def _caught(self) -> Array:
        """Of each open state, the place of the known attractor that it is near, or -1."""
        return attractors.caught(self.known, self.study.model, self.tau[self.open], self.v[self.open], self.study.fast)

    def _search(self, places: Array, chosen: Array, most: int = attractors.SETTINGS.most_impacts) -> Array:
        """The places with those of attractors that a sample of the chosen open states has reached."""
        study, at = self.study, self.open
        # orbits that are tested for a new attractor
        sample = chosen[:: max(chosen.size // 24, 1)]
        before = len(self.known)
        self.known += attractors.new_attractors(study.model, self.tau[at[sample]], self.v[at[sample]], study.fast, most)
        again = attractors.caught(self.known[before:], study.model, self.tau[at], self.v[at], study.fast)
        return np.where((places < 0) & (again >= 0), again + before, places)

    def _take(self, places: Array) -> None:
        """Decide the open states that are near an attractor."""
        rows = np.zeros((places.size, 3))
        for place in np.unique(places[places >= 0]).tolist():
            orbit = self.known[place]
            rows[places == place] = orbit.code, orbit.tau[0], orbit.v[0]
        self._decide(places >= 0, rows)


def ended(status: Array) -> Array:
    """Rows of states whose flights have ended so."""
    rows = np.zeros((status.size, 3))
    rows[:, 0] = np.select(
        [status == Status.no_return, status == Status.escaped], [attractors.AWAY, attractors.GONE], attractors.STUCK
    )
    return rows


def _open_flights(status: Array) -> Array:
    """Whether flights meet no wall, before the horizon, or before their steps were used up."""
    return np.isin(status, (Status.no_return, Status.unresolved, Status.escaped))


def at_rest(study: Study, tau: Array, v: Array) -> Array:
    """The phase, within a period, at which the remaining chatter ends, to first order."""
    after = np.empty(tau.size)
    for model, at in each_wall(study.model, v):
        after[at] = rest_after(model, np.abs(v[at]), acceleration(model, tau[at]))
    return np.asarray(study.phases.of(tau + after))


def chattering(study: Study, tau: Array, v: Array) -> Array:
    """Where an orbit is slow, a_c < 0, and the mass comes to rest before a_c can become positive.

    What is left of chatter lasts about 2 v/((1 - r)|a|), see `rest_after`; over eight times that, a_c must keep its
    sign. Between two walls the next flight must not reach the other one.
    """
    rests = np.zeros(tau.size, dtype=bool)
    for model, at in each_wall(study.model, v):
        rests[at] = _chattering(study, model, tau[at], np.abs(v[at]))
    return rests


def _chattering(study: Study, model: Oscillator, tau: Array, v: Array) -> Array:
    """`chattering` of states at the lower wall of a model."""
    fast, rests = study.fast, np.zeros(tau.size, dtype=bool)
    slow = np.flatnonzero(np.isfinite(tau) & np.isfinite(v) & (np.nan_to_num(v) <= SETTINGS.slow * fast))
    now, speed = acceleration(model, tau[slow]), v[slow]
    with np.errstate(all="ignore"):
        rest = np.where(now < 0, rest_after(model, speed, now), np.inf)
    short = (now < 0) & (rest < SETTINGS.lasting * study.phases.unit)
    pressed = [acceleration(model, tau[slow] + np.where(short, k * rest, 0.0)) < now / 2 for k in (2, 4, 8)]
    settled = (now < 0) & (speed <= SETTINGS.rest * fast)
    rests[slow] = stays_below(model, speed, now) & (settled | (short & np.all(pressed, axis=0)))
    return rests
