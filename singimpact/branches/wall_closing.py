"""Closing conditions of orbits between two walls, by the word of their walls, such as "lu" or "lul".

A flight from wall s to wall s' is one of the model whose lower wall is s.  It ends at x - c = 0 there, or at the gap of
both walls, and its velocity rebounds by the law of s'.  Everything else is as with one wall.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.closing import Closing, Leg, Turn, minima_of
from singimpact.flights.derivative import log_determinant
from singimpact.flights.family import Family, LinearFamily, family
from singimpact.flights.flat_numbers import gap_of
from singimpact.flights.orbits import iterates
from singimpact.inputs import refuse
from singimpact.oscillator.model import Oscillator
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
    # rounds of Newton's method; the largest step of a phase in one of them, in periods; and the velocity beyond which a
    # start is left, in units of the largest one at the start
    rounds: int = 20
    longest: float = 0.15
    fastest: float = 8.0
    # largest step of a solution that is found again, in units of the period and of the largest velocity
    apart: float = 1e-8


SETTINGS = WordSettings()


@dataclass(frozen=True)
class WallClosing(Closing):
    """Closing conditions of the impacts of a word in k periods.

    Parameters
    ----------
    family, above : of the models of the lower and of the upper wall alone. word : walls of the impacts, 0 or 1.
    gap : distance of the walls.
    """

    above: Family
    word: tuple[int, ...]
    gap: float

    def leg(self, i: int) -> Leg:
        here, there = self.word[i], self.word[(i + 1) % self.n]
        families = self.family, self.above
        return Leg(families[here], families[there], self.gap if here != there else None)

    def product(self, point: Array) -> float:
        """The product of the multipliers, by Liouville's formula at every impact; nan at a graze."""
        sizes, signs = 0.0, 1.0
        for i, (tau, _, v, time) in enumerate(self.flights(point)):
            leg = self.leg(i)
            velocity = leg.family.end({}, tau, v, time).place[1]
            if not v * velocity:
                return float("nan")
            # with the restitution of the wall that is hit: one model of one wall has the flight, the other the law
            law = leg.law.osc.restitution
            osc = leg.family.osc.replace(restitution=law)
            size = log_determinant(osc, *(np.array([number]) for number in (tau, abs(v), time, -abs(velocity))))
            sizes, signs = sizes + float(size[0]), signs * np.sign(v)
        return float(signs * np.exp(sizes))

    def minima(self, point: Array) -> list[list[Turn]]:
        """The places nearest to a wall within each flight: minima of x - c, and of the distance from the other wall."""
        rows = []
        for i, (launch, _, v, time) in enumerate(self.flights(point)):
            own = self.leg(i).family
            turns = minima_of(own, {}, (launch, v, time))
            path = own.path({}, launch, v, time) if time > 0 else np.zeros((0, 2))
            inner = path[:-1, 0]
            if inner.size:
                at = int(np.argmax(inner))
                turns.append(((at + 1) * time / len(path), self.gap - float(inner[at])))
            rows.append(turns)
        return rows


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


def closing_of_word(osc: Oscillator, word: tuple[int, ...], k: int) -> WallClosing:
    """The closing conditions of a word."""
    lower, upper = (family(osc.one_wall(wall)) for wall in ("lower", "upper"))
    return WallClosing(lower, len(word), k, upper, word, gap_of(osc)[0])


def closed_words(osc: Oscillator, closing: WallClosing, start: tuple[Array, Array] | None) -> list[Array]:
    """The solutions that Newton's method finds from true orbits with the word, each once.

    Parameters
    ----------
    start : phases and velocities of the first impact in place of a grid.
    """
    n, period = closing.n, closing.period(np.zeros(2 * closing.n))
    span = closing.k * period
    if start is None:
        phases = np.linspace(0, period, SETTINGS.phases, endpoint=False)
        fast = closing.gap / span * n + float(closing.scales(np.zeros(2 * n))[n])
        speeds = 16 * fast * np.geomspace(1e-3, 1, SETTINGS.speeds)
        tau, v = (axis.ravel() for axis in np.meshgrid(phases, speeds))
    else:
        tau, v = start
    ends = iterates(osc, tau, v, n, keep=True, wall=closing.word[0])
    same = (ends.wall == np.array([*closing.word, closing.word[0]])[:, None]).all(axis=0) & (ends.status == Status.hit)
    share = (ends.tau[-1] - ends.tau[0]) / span
    good = np.flatnonzero(same & (share > SETTINGS.span[0]) & (share < SETTINGS.span[1]))
    fast = np.maximum(ends.v[:-1].max(axis=0), 1e-300)
    misses = np.abs(np.log(share[good])) + np.abs(ends.v[-1, good] - ends.v[0, good]) / fast[good]
    solutions: list[Array] = []
    most = SETTINGS.kept if isinstance(closing.family, LinearFamily) else SETTINGS.fewer
    for at in good[np.argsort(misses, kind="stable")[:most]].tolist():
        times = ends.tau[0, at] + (ends.tau[:-1, at] - ends.tau[0, at]) / share[at]
        near = _approached(closing, np.concatenate([times, ends.v[:-1, at]]), period)
        if near is None or any(_equal(closing, near, other, period) for other in solutions):
            continue
        root = closing.newton(near)
        if root is not None and not any(_equal(closing, root[0], other, period) for other in solutions):
            solutions.append(root[0])
    return solutions


def _approached(closing: WallClosing, start: Array, period: float) -> Array | None:
    """A point next to a solution, by Newton's method with short steps of the phases; None where it leaves the start."""
    n, at = closing.n, start.copy()
    fastest = SETTINGS.fastest * float(start[n:].max())
    for _ in range(SETTINGS.rounds):
        loop = closing.at(at)
        if not (np.isfinite(loop.miss).all() and np.isfinite(loop.slope).all()):
            return None
        try:
            step = np.linalg.solve(loop.slope, loop.miss)
        except np.linalg.LinAlgError:
            return None
        longest = float(np.abs(step[:n]).max()) / period
        at = at - step * min(1.0, SETTINGS.longest / max(longest, 1e-300))
        spans = np.diff(np.append(at[:n], at[0] + closing.k * period))
        if not np.abs(at[n:]).max() < fastest or not spans.min() > 0:
            return None
        if longest < SETTINGS.apart and float(np.abs(step[n:]).max()) < SETTINGS.apart * fastest:
            return at
    return None


def _equal(closing: WallClosing, one: Array, other: Array, period: float) -> bool:
    """Whether two points are the same orbit from the same impact."""
    n = closing.n
    gaps = (one[:n] - other[:n]) / period
    gaps -= np.rint(gaps[0])
    fast = max(float(np.abs(one[n:]).max()), 1e-300)
    return bool(np.abs(gaps).max() < SETTINGS.apart and np.abs(one[n:] - other[n:]).max() < SETTINGS.apart * fast)
