"""Many orbits side by side, of one model or each of its own, through impacts, complete chatter, rest and lift-off.

Impacts are flown by compiled loops until the chatter left is short; then its rest is summed up, and the mass waits for
the next rise of a_c through 0. What follows a lift-off is fixed by its phase: the first impact after it is flown once.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.derivatives import derivative
from singimpact.algebra.expressions import Expression, names_in, number, substitute, subtract
from singimpact.algebra.numbers import Array
from singimpact.dynamics.lift_off import next_lift_offs, release
from singimpact.dynamics.remaining import NAMES, chatter_completes, force_trees, law_coefficients, remaining
from singimpact.flights.causes import decoded
from singimpact.flights.impact_map import impact_map
from singimpact.flights.kernels.hits import PRESSED
from singimpact.flights.members import Members
from singimpact.flights.model_numbers import valued
from singimpact.flights.results import Step
from singimpact.generated.completion import chatter_terms
from singimpact.oscillator.linear import form_of
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.status import Status


@dataclass(frozen=True)
class LifeSettings:
    """When chatter is summed up, and lift-offs that are computed one by one."""

    # the part of the time on which a_c changes that the chatter left is below: its series of four terms is exact then
    near: float = 1e-3
    # relative distance of |a_c|'s mean from its amplitude below which a lift-off is next to a swan
    swan: float = 1e-6
    # slope of a_c at a lift-off, relative to its bend over a period, below which it is next to a swan
    steep: float = 1e-4
    # relative distance of two lift-offs that are one
    same: float = 1e-12
    # impacts after which each orbit's time is taken in again
    block: int = 64


SETTINGS = LifeSettings()


class Pressure:
    """a_c at one wall of the members, and the chatter and rest that it causes.

    Parameters
    ----------
    above : whether the wall is the upper one; the model is that with x -> -x then.
    """

    def __init__(self, members: Members, above: bool) -> None:
        self.members, self.over = members, members.over
        self.osc = members.osc.mirrored if above else members.osc
        self.wall = members.numbers.place(int(above))
        self.place = members.numbers.column(self.wall)
        self.slopes, self._side = members.numbers.slope(int(above)), partial(members.side, above=int(above))

    @cached_property
    def trees(self) -> list[Expression]:
        """a_c and its first three derivatives, letters in place of the numbers that move."""
        letters = self.members.letters
        at_rest = {"x": self.wall, "xdot": number(0)}
        trees = [subtract(self.osc.forcing(letters), substitute(self.osc.force(letters), at_rest))]
        for _ in range(3):
            trees.append(derivative(trees[-1], "t"))
        return trees

    def values(self, tree: Expression, which: Array, tau: Array) -> Array:
        """A tree at times of members."""
        letters = {name: values[which] for name, values in self.over.items()}
        return np.asarray(valued(tree, {**letters, "t": tau})) + 0.0 * tau

    def push(self, which: Array, tau: Array) -> Array:
        """a_c at times of members."""
        return self.values(self.trees[0], which, tau) if self.over else acceleration(self.osc, tau)

    def left(self, which: Array, tau: Array, v: Array) -> Array:
        """The time left of chatters; nan where a_c does not press."""
        a = self.push(which, tau)
        if not self.over:
            left = remaining(self.osc, tau, v, a)[0]
        elif self._law is None:
            states = zip(which.tolist(), tau[:, None], v[:, None], a[:, None], strict=True)
            left = np.array([remaining(self._side(index), *state)[0][0] for index, *state in states])
        else:
            jets = {f"a_d{n}": self.values(self.trees[n], which, tau) for n in (1, 2, 3)}
            trees = force_trees(self.osc.force(self.members.letters), self.wall)
            forces = {name: self.values(trees[name], which, tau) for name in NAMES.values()}
            with np.errstate(all="ignore"):
                left = sum(reversed(chatter_terms(v=v, lambda_=self.slopes[which], a=a, **jets, **forces, **self._law)))
        return np.where((a < 0) & (left >= 0), left, np.nan)

    @cached_property
    def _law(self) -> dict[str, float] | None:
        """Coefficients of the law of restitution; None of one that is not smooth at v = 0, or whose numbers move."""
        if (names_in(self.osc.restitution) - {"v"}) & self.members.letters or not self.osc.smooth_at_rest:
            return None
        return law_coefficients(self.osc)

    @cached_property
    def _wave(self) -> tuple[Array, ...] | None:
        """Mean, amplitude, rate and phase of an a_c of one wave, each of shape (members,); None of any other."""
        form = form_of(number(0), self.trees[0])
        if form is None or len(form.harmonics) != 1:
            return None
        (wave,) = form.harmonics
        trees = form.constant, wave.cosine, wave.sine, wave.rate, wave.phase
        every = np.arange(self.members.size)
        mean, cosine, sine, rate, phase = (self.values(tree, every, np.zeros(every.size)) for tree in trees)
        return mean, np.hypot(cosine, sine), rate, phase - np.arctan2(sine, cosine)

    def lift_offs(self, which: Array, tau: Array) -> tuple[Array, Array]:
        """The phases at which masses that rest at phases tau lift off, and the whole periods before, as in
        `next_lift_offs`; of a model without a period the times, and 0.
        """
        period = self.members.period[which]
        if not self.over:
            if self.osc.period is None:
                return np.array([release(self.osc, time) for time in tau.tolist()]), np.zeros(tau.size)
            return next_lift_offs(self.osc, tau)
        phases, turns = np.full(tau.size, np.nan), np.zeros(tau.size)
        alone = np.arange(tau.size)
        if self._wave is not None:
            mean, size, rate, phase = (column[which] for column in self._wave)
            with np.errstate(all="ignore"):
                ratio = -mean / size
                rise = (-np.sign(rate) * np.arccos(ratio) - phase) / rate
                # one step of Newton's method takes back what the inverse cosine loses
                rise -= self.push(which, rise) / self.values(self.trees[1], which, rise)
                rise -= period * np.floor(rise / period)
            phases = np.where(ratio > 1 + SETTINGS.swan, np.inf, rise)
            turns = np.where(rise < tau, 1.0, 0.0)
            alone = np.flatnonzero(~(np.abs(np.abs(ratio) - 1) > SETTINGS.swan))
        for index in alone.tolist():
            one = self._side(int(which[index]))
            if one.period is None:
                phases[index] = release(one, float(tau[index]))
            else:
                (phases[index],), (turns[index],) = next_lift_offs(one, tau[index : index + 1])
        return phases, np.where(np.isfinite(phases), turns, 0.0)


# Kinds of events of an orbit, by their numbers
KINDS = np.array(["start", "impact", "graze", "complete", "release"])
START, IMPACT, GRAZE, COMPLETE, RELEASE = range(5)


class Single(NamedTuple):
    """One flight of an orbit that the impact map has decided: the state before, phase of its time, and the step."""

    orbit: int
    time: float
    phase: float
    v: float
    wall: int
    step: Step


@dataclass
class Stretch:
    """Some impacts of some orbits.

    Parameters
    ----------
    chosen : the orbits. rows : see `kernels.orbits.orbit_segment`, shape (orbits, impacts, 12). flown : impacts.
    plain : whether all impacts asked for were flown. begun : phase, turns, v and wall of each orbit before.
    rested : whether a chatter was over; `Lives.lifted` has the lift-off after it. singles : flights that the impact map
    decided.
    """

    chosen: Array
    rows: Array
    flown: Array
    plain: Array
    begun: tuple[Array, Array, Array, Array]
    rested: Array
    singles: list[Single]

    @cached_property
    def real(self) -> Array:
        """Which of the rows are impacts, shape (orbits, impacts)."""
        return np.arange(self.rows.shape[1]) < self.flown[:, None]


class Lives:
    """Orbits of members, advanced side by side.

    Parameters
    ----------
    members : the models. which : the model of each orbit. tau, v, walls : the states.

    Attributes
    ----------
    phase, turns : the time of each orbit, phase + turns period; without a period the time, and 0. v, wall : its state.
    status : 0, or why it goes on no more. flown : impacts. rests : chatters that were over. first_rest : the time of
    the first of them, inf before it. lifted : phase and turns of the last lift-off, nan before one. cycle : periods
    between two lift-offs at one phase, 0 before that. between : impacts between the last two lift-offs. singles :
    flights that the impact map has decided since the last `advance` began.
    """

    def __init__(self, members: Members, which: Array, tau: Array, v: Array, walls: Array) -> None:
        self.members, self.which = members, which
        self.pressures = [Pressure(members, above) for above in ((False, True) if members.two_walls else (False,))]
        self.ends = all(members.over or chatter_completes(item.osc) for item in self.pressures)
        size = which.size
        self.unit = np.where(np.isnan(members.period), np.inf, members.period)[which]
        self.phase, self.turns = self.split(tau, np.zeros(size))
        self.v, self.wall = v.astype(float), walls.astype(np.int8)
        self.status, self.flown, self.rests = np.zeros(size, np.int8), np.zeros(size, int), np.zeros(size, int)
        self.first_rest, self.resting = np.full(size, np.inf), np.zeros(size)
        self.lifted = np.full((size, 3), np.nan)
        self.cycle, self.between, self._lifted_at = np.zeros(size), np.zeros(size, int), np.zeros(size, int)
        self.near = SETTINGS.near
        self.singles: list[Single] = []
        self._events: list[tuple[Array, Array, Array, int, Array]] = []
        self._landings: dict[tuple[int, int, float], tuple[float, float, int, int]] = {}
        self._decided: dict[int, int] = {}
        self._event(np.arange(size), START)
        still = np.flatnonzero(self.v == 0)
        if still.size:  # a mass that begins at rest has not come to rest
            self._start(still, self._lift)

    def time(self, chosen: Any = slice(None)) -> Array:
        """The times of the present states."""
        return self.time_of(self.phase[chosen], self.turns[chosen], chosen)

    def time_of(self, phase: Array, turns: Array, chosen: Any) -> Array:
        """The times of states of chosen orbits."""
        with np.errstate(invalid="ignore"):
            return np.asarray(phase + np.where(turns == 0, 0.0, turns * self.unit[chosen]))

    def times(self, stretch: Stretch) -> Array:
        """The times of the impacts of a stretch, shape (orbits, impacts)."""
        begun = self.time_of(*stretch.begun[:2], stretch.chosen)
        return begun[:, None] + np.where(stretch.real, stretch.rows[..., 0], 0.0)

    def places(self, which: Any, above: Any) -> Array:
        """x of the walls of members."""
        low, high = self.pressures[0].place, -self.pressures[-1].place
        return np.asarray(np.where(above, high[which], low[which]))

    def split(self, phase: Array, turns: Array, chosen: Any = slice(None)) -> tuple[Array, Array]:
        """Times, phase + turns period, with the phase within a period."""
        unit = self.unit[chosen]
        more = np.where(np.isfinite(unit), np.floor(phase / unit), 0.0)
        return phase - np.where(more == 0, 0.0, more * np.where(np.isfinite(unit), unit, 0.0)), turns + more

    def advance(self, count: Any, chosen: Array | None = None) -> Stretch:
        """At most `count` impacts of each chosen orbit that goes on; a chatter that is over ends them before."""
        self.singles, self._events = [], []
        orders = np.arange(self.which.size) if chosen is None else chosen
        going = orders[self.status[orders] == 0]
        begun, rests = (self.phase[going], self.turns[going], self.v[going], self.wall[going]), self.rests[going]
        still = going[begun[2] == 0]
        if still.size:
            self._start(still, self._stop)
        states = begun[0].copy(), begun[2].copy(), begun[3].copy()
        counts = np.where(begun[2] > 0, np.broadcast_to(count, orders.shape)[np.isin(orders, going)], 0)
        rows, flown, codes = self.members.segments(self.which[going], states, counts, self.near if self.ends else 0.0)
        self.flown[going] += flown
        moved = np.flatnonzero(flown)
        last, at = rows[moved, flown[moved] - 1], going[moved]
        self.v[at], self.wall[at] = last[:, 1], last[:, 11].astype(np.int8) ^ self.wall[at]
        self.phase[at], self.turns[at] = self.split(self.phase[at] + last[:, 0], self.turns[at], at)
        over = going[codes == PRESSED]
        if over.size:
            self._rest(over)
        # an impact that leaves no velocity is one: the mass rests then, or flies from rest
        dead = (codes == Status.no_rebound) & (self.v[going] == 0)
        other = np.flatnonzero((codes != 0) & (codes != PRESSED) & ~dead)
        for slot in other.tolist():
            self._decide(int(going[slot]), int(codes[slot]))
        return Stretch(going, rows, flown, (codes == 0) & (flown > 0), begun, self.rests[going] > rests, self.singles)

    def events(self, stretch: Stretch | None = None) -> Array:
        """Rows of orbit, time, v, number of a kind and wall, orbit after orbit: the states before a stretch, as starts,
        and all events up to now; without a stretch those of the first states.
        """
        columns = self._events
        if stretch is not None:
            phase, turns, v, walls = stretch.begun
            at, rows = np.nonzero(stretch.real), np.moveaxis(stretch.rows, 2, 0)
            columns = [
                (stretch.chosen, self.time_of(phase, turns, stretch.chosen), v, START, walls),
                (
                    stretch.chosen[at[0]],
                    self.times(stretch)[at],
                    rows[1][at],
                    IMPACT,
                    walls[at[0]] ^ (rows[11][at] == 1),
                ),
                *columns,
            ]
        table = np.concatenate([np.column_stack(np.broadcast_arrays(*column)) for column in columns])
        return table[np.argsort(table[:, 0], kind="stable")]

    def _start(self, still: Array, pressed_to: Callable[[Array, int], None]) -> None:
        """Orbits at rest: those that a_c presses wait, the others fly."""
        walls = self.wall[still]  # before any of them has moved
        for wall, pressure in enumerate(self.pressures):
            at = still[walls == wall]
            pressed = pressure.push(self.which[at], self.phase[at]) < 0
            pressed_to(at[pressed], wall)
            for index in at[~pressed].tolist():
                self._decide(index, 0)

    def _rest(self, over: Array) -> None:
        """Sum up what is left of chatters, and wait for the lift-off."""
        walls = self.wall[over]
        for wall, pressure in enumerate(self.pressures):
            at = over[walls == wall]
            if not at.size:
                continue
            left = pressure.left(self.which[at], self.phase[at], self.v[at])
            lost = np.isnan(left)
            self.status[at[lost]] = Status.unresolved
            at = at[~lost]
            self.phase[at], self.turns[at] = self.split(self.phase[at] + left[~lost], self.turns[at], at)
            self.v[at] = 0.0
            self._event(at, COMPLETE)
            self._stop(at, wall)

    def _event(self, at: Array, kind: int) -> None:
        """Keep the present states of orbits as events of a kind."""
        self._events.append((at, self.time(at), self.v[at], kind, self.wall[at]))

    def _stop(self, at: Array, wall: int) -> None:
        """Masses that come to rest."""
        self.rests[at] += 1
        self.first_rest[at] = np.minimum(self.first_rest[at], self.time(at))
        self._lift(at, wall)

    def _lift(self, at: Array, wall: int) -> None:
        """From rest to the first impact after the lift-off."""
        phases, turns = self.pressures[wall].lift_offs(self.which[at], self.phase[at])
        ends = ~np.isfinite(phases)
        self.status[at[ends]] = np.where(np.isnan(phases[ends]), Status.unresolved, Status.sticks)
        at, phases, turns = at[~ends], phases[~ends], turns[~ends] + self.turns[at[~ends]]
        before = self.time(at)
        # nothing comes again without a period
        beside = np.where(np.isfinite(self.unit[at]), SETTINGS.same * self.unit[at], -1.0)
        again = (np.abs(phases - self.lifted[at, 0]) <= beside) & (self.lifted[at, 2] == wall)
        self.cycle[at] = np.where(again, turns - self.lifted[at, 1], self.cycle[at])
        self.between[at], self._lifted_at[at] = self.flown[at] - self._lifted_at[at], self.flown[at]
        self.lifted[at] = np.stack([phases, turns, np.full(at.size, wall)], axis=1)
        self.phase[at], self.turns[at] = phases, turns
        self.resting[at] += self.time(at) - before
        self._event(at, RELEASE)
        keys = list(zip(self.which[at].tolist(), [wall] * at.size, phases.tolist(), strict=True))
        self._land([key for key in dict.fromkeys(keys) if key not in self._landings], wall)
        landed = np.array([self._landings[key] for key in keys]).reshape(-1, 4)
        self.status[at] = landed[:, 3].astype(np.int8)
        flies = landed[:, 3] == 0
        at, landed = at[flies], landed[flies]
        self.phase[at], self.turns[at] = self.split(self.phase[at] + landed[:, 0], self.turns[at], at)
        self.v[at], self.wall[at] = landed[:, 1], landed[:, 2].astype(np.int8)
        self.flown[at] += 1
        self._event(at, IMPACT)

    def _land(self, keys: list[tuple[int, int, float]], wall: int) -> None:
        """The first impacts after lift-offs: time, v and wall after it, and the status."""
        if not keys:
            return
        which, phases = np.array([key[0] for key in keys]), np.array([key[2] for key in keys])
        steep = np.zeros(which.size, dtype=bool)
        if not self.members.two_walls:
            trees, period = self.pressures[wall].trees, self.members.period[which]
            slope, bend = (np.abs(self.pressures[wall].values(tree, which, phases)) for tree in trees[1:3])
            # a simple zero of a_c, far from the next one
            steep = slope > SETTINGS.steep * bend * np.where(np.isnan(period), 1.0, period)
        codes, columns = np.full(which.size, 99, np.int8), np.full((10, which.size), np.nan)
        if steep.any():
            codes[steep], columns[:, steep] = self.members.releases(
                which[steep], phases[steep], np.full(np.count_nonzero(steep), 3.0)
            )
        r = self.pressures[wall].slopes[which]
        plain = (codes == 0) & ("v" not in names_in(self.pressures[wall].osc.restitution))
        for slot, key in enumerate(keys):
            if plain[slot]:
                self._landings[key] = float(columns[0, slot]), float(-r[slot] * columns[1, slot]), 0, 0
                continue
            step = impact_map(self.members.side(key[0], wall), key[2], 0.0)
            status = 0 if step.status in (Status.hit, Status.graze) else int(step.status)
            self._landings[key] = float(step.flight_time), float(step.v), int(step.wall or 0) ^ wall, status

    def _decide(self, index: int, code: int) -> None:
        """One flight by the impact map, which says what became of it."""
        # an orbit that goes to a graze has no end of such flights
        if self._decided.get(index, 0) >= 16 or not np.isfinite(self.v[index]):
            self.status[index] = Status.unresolved
            return
        here = self.members.side(int(self.which[index]), int(self.wall[index]))
        launched = float(self.phase[index]), float(self.v[index]), int(self.wall[index])
        step = impact_map(here, *launched[:2])
        # without rebound each flight is one from rest
        if step.status == Status.graze or not self.members.osc.plastic:
            self._decided[index] = self._decided.get(index, 0) + 1
        self.singles.append(Single(index, float(self.time(index)), *launched, step))
        if step.status not in (Status.hit, Status.graze):
            self.status[index] = int(step.status) or int(decoded(np.array([code]))[0][0])
            return
        self.flown[index] += 1
        (self.phase[index],), (self.turns[index],) = self.split(
            self.phase[index : index + 1] + float(step.flight_time),
            self.turns[index : index + 1],
            slice(index, index + 1),
        )
        self.v[index], self.wall[index] = float(step.v), self.wall[index] ^ int(step.wall or 0)
        self._event(np.array([index]), GRAZE if step.status == Status.graze else IMPACT)
