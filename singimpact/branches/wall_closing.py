"""Closing conditions of orbits between two walls, by the word of their walls, such as "lu" or "lul".

A flight from wall s to wall s' is one of the model whose lower wall is s.  It ends at x - c = 0 there, or at the gap of
both walls, and its velocity rebounds by the law of s'.  Everything else is as with one wall.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.closing import Closing, Leg, Turn, minima_of
from singimpact.branches.starts import closed_from
from singimpact.flights import gap_of, iterates
from singimpact.flights.family import End, Family, Number, Values, family
from singimpact.inputs import refuse
from singimpact.oscillator import CLEARANCE, RESTITUTION, UPPER, Oscillator, value_of
from singimpact.status import Status


@dataclass(frozen=True)
class WordSettings:
    """The grid of states from which orbits of a word are searched."""

    # phases; velocities from 1e-3 of the fastest to the fastest
    phases: int = 48
    speeds: int = 24
    # sequences whose impacts take this part of the time in which they must close are stretched to it, and so many of
    # those that differ least are followed by Newton's method
    span: tuple[float, float] = (0.4, 1.8)
    kept: int = 80
    # the same of a model without a closed form, whose flights cost more
    fewer: int = 24
    # of every so many states of the grid the state so many impacts later is one of them too, on an orbit that attracts;
    # those that differ by less than this are one
    every: int = 8
    later: int = 120
    equal: float = 1e-6


SETTINGS = WordSettings()


class WallFamily(Family):
    """Flights of the models of one wall alone, in the numbers of the models with both.

    Parameters
    ----------
    osc : a model with two walls. wall : 0, or 1 for the upper one, whose models have x -> -x. over : as for `Family`.
    """

    def __init__(self, osc: Oscillator, wall: int, over: Sequence[str]) -> None:
        self.osc, self.over = osc, tuple(over)
        own = osc.upper_restitution is not osc.restitution or UPPER[1] in over  # else both walls have one law
        names = {CLEARANCE: CLEARANCE, RESTITUTION: RESTITUTION, UPPER[0]: "", UPPER[1]: ""}
        if wall:
            names = {CLEARANCE: "", RESTITUTION: "" if own else RESTITUTION, UPPER[0]: CLEARANCE, UPPER[1]: RESTITUTION}
        alone = tuple(names.get(name, name) for name in over)
        self.alone = family(osc.one_wall(wall), tuple(filter(None, alone)))
        self.fastest, self.linear = self.alone.fastest, self.alone.linear
        # a number of the family with both walls, of that of one
        self._into = np.zeros((len(self.alone.over), len(over)))
        for column, name in enumerate(alone):
            if name:
                self._into[self.alone.over.index(name), column] = -1.0 if over[column] == UPPER[0] else 1.0

    def _alone(self, values: Values) -> dict[str, float]:
        numbers = self._into @ np.array([values[name] for name in self.over])
        return dict(zip(self.alone.over, numbers.tolist(), strict=True))

    def one_wall(self, values: Values) -> Oscillator:
        """The model of this wall alone."""
        return self.alone.oscillator(self._alone(values))

    def period(self, values: Values) -> Number:
        """The period of the forcing."""
        period = self.alone.period(self._alone(values))
        return Number(period.value, tuple(period.slopes @ self._into))

    def rebound(self, velocity: float, values: Values) -> tuple[float, float, tuple[float, ...]]:
        """rho of this wall at x' before an impact, its derivative, and its derivatives by the numbers."""
        value, slope, by_numbers = self.alone.rebound(velocity, self._alone(values))
        return value, slope, tuple(by_numbers @ self._into)

    def end(self, values: Values, tau: float, v: float, time: float) -> End:
        """The end of a flight from this wall."""
        end = self.alone.end(self._alone(values), tau, v, time)
        return end._replace(by_numbers=self._into.T @ end.by_numbers)

    def path(self, values: Values, tau: float, v: float, time: float) -> Array:
        """A flight from this wall."""
        return self.alone.path(self._alone(values), tau, v, time)


@dataclass(frozen=True)
class WallClosing(Closing):
    """Closing conditions of the impacts of a word in k periods.

    Parameters
    ----------
    family, above : of the models of the lower and of the upper wall. walls : of the impacts, 0 or 1.
    turned : whether the last flight ends in the mirror image of the first state, which half a symmetric orbit does.

    Notes
    -----
    Flight i has minima i, those of the distance from its own wall, and n + i, those from the other one.
    """

    family: WallFamily
    above: WallFamily
    walls: tuple[int, ...]
    turned: bool = False

    @property
    def word(self) -> tuple[int, ...]:
        return self.walls

    def has_room(self, point: Array) -> bool:
        return self.gap(self.values(point)).value > 0

    def gap(self, values: Values) -> Number:
        """The distance of the walls, and its derivatives."""
        osc = self.family.osc
        ends = [values.get(name, value_of(osc, name)) for name in (UPPER[0], CLEARANCE)]
        moves = {UPPER[0], CLEARANCE}.intersection(self.over)
        slopes = tuple(float(name == UPPER[0]) - float(name == CLEARANCE) for name in self.over)
        return Number(ends[0] - ends[1] if moves else gap_of(osc)[0], slopes)

    def leg(self, i: int, values: Values) -> Leg:
        here, there = self.walls[i], self.walls[(i + 1) % self.n]
        if self.turned and i == self.n - 1:
            there = 1 - there
        families = self.family, self.above
        return Leg(families[here], families[there], self.gap(values) if here != there else None)

    def minima(self, point: Array) -> list[list[Turn]]:
        """All local minima of each flight, of the distance from its wall, and then of that from the other one."""
        values = self.values(point)
        flights = [
            (self.leg(i, values).family, (tau, v, time)) for i, (tau, _, v, time) in enumerate(self.flights(point))
        ]
        gap = self.gap(values).value
        return [minima_of(own, values, flight, at) for at in (None, gap) for own, flight in flights]

    def rise(self, point: Array, direction: Array, flight: int, time: float) -> float:
        rate = super().rise(point, direction, flight % self.n, time)
        if flight < self.n:
            return rate
        return float(np.dot(self.gap(self.values(point)).slopes, direction[2 * self.n :])) - rate


def word_of(word: object) -> tuple[int, ...]:
    """The walls of a word of the letters l and u.

    Examples
    --------
    >>> word_of("lul")
    (0, 1, 0)
    """
    if not isinstance(word, str) or not word or set(word) - {"l", "u"} or len(word) > 1000:
        accepted = (
            "a word of the letters l and u, such as 'lu', the lower and the upper wall in the order of the impacts"
        )
        raise refuse("n", word, accepted)
    return tuple("lu".index(letter) for letter in word)


def closing_of_word(osc: Oscillator, word: tuple[int, ...], k: float, over: Sequence[str] = ()) -> WallClosing:
    """The closing conditions of a word; in half a period those of half a symmetric orbit."""
    lower, upper = (WallFamily(osc, wall, over) for wall in (0, 1))
    return WallClosing(lower, len(word), k, upper, word, bool(2 * k % 2))  # type: ignore[arg-type]


def closed_words(osc: Oscillator, closing: WallClosing, start: tuple[Array, Array] | None = None) -> list[Array]:
    """The solutions that Newton's method finds from true orbits with the word, each once.

    Parameters
    ----------
    start : phases and velocities of the first impact in place of a grid.
    """
    n, period = closing.n, closing.period(np.zeros(2 * closing.n))
    span = closing.k * period
    if start is None:
        phases = np.linspace(0, period, SETTINGS.phases, endpoint=False)
        fast = closing.gap({}).value / span * n + float(closing.scales(np.zeros(2 * n))[n])
        speeds = 16 * fast * np.geomspace(1e-3, 1, SETTINGS.speeds)
        tau, v = (axis.ravel() for axis in np.meshgrid(phases, speeds))
        ends = iterates(osc, tau[:: SETTINGS.every], v[:: SETTINGS.every], SETTINGS.later, False, closing.word[0])
        landed = np.stack([ends.tau % period, ends.v])[:, (ends.status == Status.hit) & (ends.wall == closing.word[0])]
        alike = np.round(landed / (SETTINGS.equal * np.array([[period], [fast]])))
        landed = landed[:, np.unique(alike, axis=1, return_index=True)[1]]
        tau, v = np.append(tau, landed[0]), np.append(v, landed[1])
    else:
        tau, v = start
    ends = iterates(osc, tau, v, n, keep=True, wall=closing.word[0])
    same = (ends.wall == np.array([*closing.word, closing.word[0]])[:, None]).all(axis=0) & (ends.status == Status.hit)
    share = (ends.tau[-1] - ends.tau[0]) / span
    good = np.flatnonzero(same & (share > SETTINGS.span[0]) & (share < SETTINGS.span[1]))
    fast = np.maximum(ends.v[:-1].max(axis=0), 1e-300)
    misses = np.abs(np.log(share[good])) + np.abs(ends.v[-1, good] - ends.v[0, good]) / fast[good]
    most = SETTINGS.kept if closing.family.linear else SETTINGS.fewer
    best = good[np.argsort(misses, kind="stable")[:most]]
    times = ends.tau[0, best] + (ends.tau[:-1, best] - ends.tau[0, best]) / share[best]
    return closed_from(closing, np.concatenate([times, ends.v[:-1, best]]).T)
