"""The closing conditions of a periodic orbit, for flights that continue behind the wall.

    x(T_i) = c,   rho(x'(T_i)) = v_{i+1},   T_i = tau_{i+1} - tau_i,   tau_{n+1} = tau_1 + k P       i = 1, ..., n

They are smooth in tau_i, v_i and in every parameter, also at v_i = 0, where the orbit grazes: no square
root.  A solution with some v_i < 0, or with a flight that is below the wall somewhere, is virtual.
An orbit without impact has conditions of its own, `FreeClosing`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from operator import itemgetter
from typing import ClassVar, NamedTuple

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.branches.continuation import cubic_between
from singimpact.flights import Family, Number, Values, log_determinant
from singimpact.oscillator.moving_number import CLEARANCE, RESTITUTION

NEAR = 0.1  # a minimum of x - c is refined when it is below this part of the largest height
# A determinant that is smaller beside its terms has lost six digits of the product of the multipliers.
CANCELLED = 1e-6
SETTLED = 1e-9  # the last step of Newton's method for the time of a minimum, of that time
Flown = tuple[float, float, float, float]  # launch in the first period, periods before it, velocity and flight time
Turn = tuple[float, float]  # a local minimum of x - c in a flight: its time after the launch, and x - c there


class Leg(NamedTuple):
    """A flight from one wall to another.

    Parameters
    ----------
    family : the models that it is flown by. law : those whose restitution it meets. gap : x - c where it ends, at
        another wall, whose model has x -> -x, with its derivatives; None at the wall of the launch.
    """

    family: Family
    law: Family
    gap: Number | None = None


class Characteristic(NamedTuple):
    """a_0, a_1, a_2 of a_0 + a_1 mu + a_2 mu^2, whose zeros are the multipliers of an orbit."""

    zero: float
    one: float
    two: float

    @property
    def doubling(self) -> float:
        """Its value at -1: 0 at a period doubling."""
        return self.zero - self.one + self.two

    @property
    def torus(self) -> float:
        """0 where the product of the multipliers is 1: at a Neimark-Sacker bifurcation, if they are complex."""
        return self.zero - self.two

    @property
    def are_complex(self) -> bool:
        """Whether the multipliers are a conjugate pair."""
        return self.one * self.one < 4 * self.zero * self.two


@dataclass(frozen=True)
class Loop:
    """The closing conditions at a point.

    Parameters
    ----------
    miss : x(T_i) - c and rho(x'(T_i)) - v_{i+1} of each flight, shape (2n,).
    slope : its derivatives by tau_1 ... tau_n, v_1 ... v_n, and the numbers that move, shape (2n, 2n + numbers).
    wrap : the part of the first 2n columns by which the last flight ends at the first state.
    clocked : False of a limit cycle, whose det J(mu) has the one zero that is not trivial.
    rounded : whether a cycle grazes: det J(mu), which has the factor v, is rounding.
    """

    miss: Array
    slope: Array
    wrap: Array
    clocked: bool = True
    rounded: bool = False

    def at_multiplier(self, multiplier: complex) -> Array:
        """J(mu), singular where mu is a multiplier of the orbit; J(1) is the slope."""
        return np.asarray(self.slope[:, : len(self.miss)] + (multiplier - 1) * self.wrap)

    def determinant(self, multiplier: float) -> float:
        """det(J(mu)), which vanishes where mu is a multiplier of the orbit."""
        square = self.at_multiplier(multiplier)
        return float(np.linalg.det(square)) if np.isfinite(square).all() else np.nan

    def characteristic(self) -> Characteristic:
        """a_0, a_1, a_2 with det(J(mu)) = a_0 + a_1 mu + a_2 mu^2; a_2 = 0 where the last flight ends in a graze."""
        zero, plus, minus = (self.determinant(mu) for mu in (0.0, 1.0, -1.0))
        return Characteristic(zero, (plus - minus) / 2, (plus + minus) / 2 - zero)

    def multipliers(self, product: Callable[[], float] | None = None) -> Array:
        """The two multipliers, the larger first; inf at a graze.

        Parameters
        ----------
        product : gives their product by Liouville's formula, where the determinant has lost it.
        """
        zero, one, two = self.characteristic()
        size = max(abs(zero), abs(one), abs(two))
        if not np.isfinite(size):
            return np.full(2, np.nan, dtype=complex)
        # a_2 = 0: the last flight ends in a graze, whose multiplier is infinite
        if self.clocked and abs(two) <= 1e-14 * size:
            return np.array([np.inf, -zero / one if one else np.nan], dtype=complex)
        if not self.clocked:
            return np.array([-zero / one if one and not self.rounded else np.nan], dtype=complex)
        root = np.sqrt(complex(one * one - 4 * zero * two))
        far = (
            -one - root if one > 0 else -one + root
        )  # the sum without cancellation; the other root follows from the product
        first = far / (2 * two)
        second = 2 * zero / far if far else first
        if product is not None and abs(zero) < CANCELLED * size:
            determinant = product()
            second = determinant / first + 0.0 if np.isfinite(determinant) and abs(first) > 0 else second
        return np.array([first, second])


@dataclass(frozen=True)
class Closing:
    """Closing conditions of n impacts in k periods over a family of models.

    A point is an array tau_1, ..., tau_n, v_1, ..., v_n and the numbers of the family.
    """

    family: Family
    n: int
    k: int

    clocked: ClassVar[bool] = True

    @property
    def over(self) -> tuple[str, ...]:
        """Names of the free parameters."""
        return self.family.over

    @property
    def word(self) -> tuple[int, ...]:
        """The walls of the impacts, 0 or 1."""
        return (0,) * self.n

    def leg(self, i: int, values: Values) -> Leg:  # noqa: ARG002
        """The walls of flight i."""
        return Leg(self.family, self.family)

    @property
    def plastic(self) -> bool:
        """Whether the restitution is 0 along the family."""
        return self.family.osc.plastic and RESTITUTION not in self.over

    def times(self, point: Array) -> Array:
        """The times of the impacts."""
        return point[: self.n]

    def period(self, point: Array) -> float:
        """The period of the forcing."""
        return self.family.period(self.values(point)).value

    def point(self, times: Array, speeds: Array, span: float) -> Array:  # noqa: ARG002
        """Unknowns of an orbit from its states and the time after which it closes."""
        return np.concatenate([times, speeds])

    def has_room(self, point: Array) -> bool:  # noqa: ARG002
        """Whether the wall above, where there is one, is above the other."""
        return True

    def grazes(self, point: Array) -> bool:  # noqa: ARG002
        """Whether the derivatives are rounding, which they are where a limit cycle grazes."""
        return False

    def _slopes_of_period(self, point: Array) -> Array:
        """Derivatives of the period of the forcing by the numbers of the family."""
        return np.array(self.family.period(self.values(point)).slopes)

    def values(self, point: Array) -> dict[str, float]:
        """The free parameters."""
        return dict(zip(self.family.over, point[2 * self.n :].tolist(), strict=True))

    def flights(self, point: Array) -> list[Flown]:
        """All flights, the last one to the first impact k periods later."""
        n, period = self.n, self.period(point)
        times, speeds = [*point[:n].tolist(), float(point[0]) + self.k * period], point[n : 2 * n].tolist()
        before = [float(np.floor(time / period)) for time in times[:n]]
        return [(times[i] - before[i] * period, before[i], speeds[i], times[i + 1] - times[i]) for i in range(n)]

    def at(self, point: Array) -> Loop:
        """The conditions and their derivatives at a point."""
        n, over, values = self.n, self.family.over, self.values(point)
        slopes = self._slopes_of_period(point)
        miss, slope, wrap = np.zeros(2 * n), np.zeros((2 * n, 2 * n + len(over))), np.zeros((2 * n, 2 * n))
        for i, (launch, before, v, time) in enumerate(self.flights(point)):
            leg = self.leg(i, values)
            end, side = leg.family.end(values, launch, v, time), 1.0 if leg.gap is None else -1.0
            velocity, factor, by_law = leg.law.rebound(side * float(end.place[1]), values)
            factor *= side
            after, last = (i + 1) % n, i == n - 1
            miss[2 * i], miss[2 * i + 1] = (
                end.place[0] - (leg.gap.value if leg.gap else 0.0),
                velocity - point[n + after],
            )
            # rho changes the second condition, and so every derivative in its row, by its slope
            scale = np.array([1.0, factor])
            if i or self.clocked:  # the first impact of a cycle stays at time 0
                slope[2 * i : 2 * i + 2, i] += scale * (end.by_tau - end.by_time)
            slope[2 * i : 2 * i + 2, n + i] += scale * end.by_v
            by_next = np.zeros((2, 2 * n))
            by_next[:, after] = scale * end.by_time
            by_next[1, n + after] = -1.0
            slope[2 * i : 2 * i + 2, : 2 * n] += by_next
            if last:
                wrap[2 * i : 2 * i + 2, 0 if self.clocked else 1 :] = by_next[:, 0 if self.clocked else 1 :]
            if len(over):
                # launches in the first period move with the period, and so does the length of the last flight
                moved = end.by_numbers - np.outer(before * slopes, end.by_tau)
                moved += np.outer(self.k * slopes, end.by_time) if last else 0.0
                slope[2 * i : 2 * i + 2, 2 * n :] = (moved * scale).T
                slope[2 * i, 2 * n :] -= leg.gap.slopes if leg.gap else 0.0
                slope[2 * i + 1, 2 * n :] += by_law
        return Loop(miss, slope, wrap, self.clocked, self.grazes(point))

    def product(self, point: Array) -> float:
        """The product of the multipliers, by Liouville's formula at every impact; nan at a graze."""
        if self.plastic:
            return 0.0
        size, sign, values = 0.0, 1.0, self.values(point)
        for i, (tau, _, v, time) in enumerate(self.flights(point)):
            leg = self.leg(i, values)
            velocity = leg.family.end(values, tau, v, time).place[1]
            if not v or not (velocity if leg.gap is None else -velocity) < 0:
                return float("nan")
            # with the restitution of the wall that is hit: one model of one wall has the flight, the other the law
            osc = leg.family.one_wall(values).replace(restitution=leg.law.one_wall(values).restitution)
            size += float(log_determinant(osc, *(np.array([x]) for x in (tau, abs(v), time, -abs(velocity))))[0])
            sign *= np.sign(v)
        return float(sign * np.exp(size))

    def newton(self, point: Array, rounds: int = 30, tolerance: float = 4e-15) -> tuple[Array, Loop] | None:
        """The orbit near a point at its numbers; None if Newton's method does not converge."""
        at, size, n = point.copy(), np.inf, 2 * self.n
        for _ in range(rounds):
            loop = self.at(at)
            if not np.isfinite(loop.miss).all() or not np.isfinite(loop.slope).all():
                return None
            try:
                step = np.linalg.solve(loop.slope[:, :n], loop.miss)
            except np.linalg.LinAlgError:
                return None
            at[:n] -= step
            before, size = size, float(np.max(np.abs(step) / self.scales(at)[:n]))
            if size <= tolerance or (size >= before / 2 and size < 1e-11):
                return at, self.at(at)
            if not size < 1e3:
                return None
        return None

    def scales(self, point: Array) -> Array:
        """Sizes of the parts of a point: a period, the largest velocity or one that a period gives, 1."""
        n, values = self.n, self.values(point)
        period = self.period(point)
        # a scale for orbits without a fast impact: what the force gives in a sixteenth of a period
        push = self.family.push(values, period) * period / 16
        speeds = np.full(n, max(float(np.abs(point[n : 2 * n]).max()), push, 1e-300))
        return np.concatenate([np.full(n, period), speeds, np.ones(len(self.family.over))])

    def heights(self, point: Array) -> list[tuple[float, float]]:
        """The lowest place between launch and hit of each flight: its time after the launch, and x - c there.

        A flight that has none, for it falls all the way after its rise, gives (nan, inf).
        """
        return [min(turns, key=itemgetter(1), default=(np.nan, np.inf)) for turns in self.minima(point)]

    def minima(self, point: Array) -> list[list[Turn]]:
        """All local minima between launch and hit of each flight, as `minima_of` gives them."""
        values = self.values(point)
        return [minima_of(self.family, values, (launch, v, time)) for launch, _, v, time in self.flights(point)]

    def rise(self, point: Array, direction: Array, flight: int, time: float) -> float:
        """The rate at which x - c, at a time after the launch of a flight, changes as the point moves.

        Parameters
        ----------
        direction : in which the point moves, shape (2n + numbers,). flight : index. time : after its launch. At a local
            minimum it is the rate of the height of that minimum, because x' = 0 there.
        """
        n, values = self.n, self.values(point)
        launch, before, v, _ = self.flights(point)[flight]
        end = self.leg(flight, values).family.end(values, launch, v, time)
        numbers = direction[2 * n :]
        # launches in the first period move with the period
        late = direction[flight] if flight or self.clocked else 0.0
        moved = late - before * float(np.dot(self._slopes_of_period(point), numbers))
        return float(end.by_tau[0] * moved + end.by_v[0] * direction[n + flight] + numbers @ end.by_numbers[:, 0])

    def span(self, point: Array, flight: int) -> float:
        """The time of a flight."""
        return self.flights(point)[flight % self.n][3]

    def pushes(self, point: Array) -> Array:
        """a_c at each impact."""
        values = self.values(point)
        legs = enumerate(self.flights(point))
        return np.array([self.leg(i, values).family.end(values, tau, 0.0, 0.0).by_time[1] for i, (tau, *_) in legs])


def lowest(family: Family, values: Values, flight: tuple[float, float, float]) -> tuple[float, float]:
    """The lowest local minimum of x - c inside a flight, refined; (nan, inf) where there is none."""
    return min(minima_of(family, values, flight), key=itemgetter(1), default=(np.nan, np.inf))


def minima_of(
    family: Family, values: Values, flight: tuple[float, float, float], gap: float | None = None
) -> list[Turn]:
    """The local minima of x - c inside a flight, in order; with the gap of another wall of the distance from that.

    Those near the wall are refined; the others are those of the cubics through the samples. Of a flight that leaves
    the domain of f or g the list is [(nan, -inf)].
    """
    launch, v, time = flight
    if not time > 0:
        return []
    rows = family.path(values, launch, v, time)
    if not np.isfinite(rows).all():
        return [(np.nan, -np.inf)]
    if gap is not None:
        rows = np.array([gap, 0.0]) - rows
    slopes = np.concatenate([[v if gap is None else -v], rows[:, 1]])
    turns = np.flatnonzero((slopes[:-1] < 0) & (slopes[1:] >= 0))
    near, width = NEAR * float(np.abs(rows[:, 0]).max()), time / len(rows)
    minima = []
    for index in turns.tolist():
        ends = (float(rows[index - 1, 0]) if index else gap or 0.0, float(rows[index, 0]))
        share, height = _cubic_minimum(ends, (float(slopes[index]) * width, float(slopes[index + 1]) * width))
        at = (index + share) * width
        if height < near:
            at, height = _turning_point(family, values, (launch, v, at), (index * width, (index + 1) * width), gap)
        minima.append((at, height))
    return minima


def _cubic_minimum(ends: tuple[float, float], slopes: tuple[float, float]) -> tuple[float, float]:
    """Where the cubic with these values and slopes (the first negative) at 0 and 1 is least between, and its value."""
    square, cube = cubic_between(ends[0], slopes[0], ends[1], slopes[1])
    # slopes[0] + 2 square s + 3 cube s^2 = 0, the root at which it rises
    root = sqrt(max(square * square - 3 * cube * slopes[0], 0.0))
    share = -slopes[0] / (square + root) if square + root > 0 else 1.0
    share = min(max(share, 0.0), 1.0)
    return share, ends[0] + share * (slopes[0] + share * (square + share * cube))


def _turning_point(
    family: Family,
    values: Values,
    flight: tuple[float, float, float],
    between: tuple[float, float],
    gap: float | None = None,
) -> tuple[float, float]:
    """Where x' = 0 between two times, by Newton's method kept inside, and x - c there.

    Parameters
    ----------
    flight : launch, v and a first guess of the time. gap : of another wall, the distance from which is least there.
    """
    launch, v, at = flight
    low, high = between
    wall, side = (0.0, 1.0) if gap is None else (gap, -1.0)
    for _ in range(60):
        end = family.end(values, launch, v, at)
        speed, bend = (side * end.by_time).tolist()
        if speed < 0:
            low = at
        else:
            high = at
        step = at - speed / bend if bend else np.nan
        inside = low < step < high
        after = step if inside else (low + high) / 2
        # Newton's method squares the error; there x - c differs by the square of the last step
        if (inside and abs(after - at) <= SETTLED * abs(at)) or high - low <= 1e-15 * high:
            return after, wall + side * float(end.place[0]) + speed * (after - at) / 2
        at = after
    return at, wall + side * float(family.end(values, launch, v, at).place[0])


# ---- an orbit without impact


@dataclass(frozen=True)
class FreeClosing:
    """The conditions of an orbit without impact: x and x' come back after k periods.

    Points are x and x' at time 0, and the free parameters.

    Parameters
    ----------
    family : over the clearance, which stands for the place of the launch, and the numbers that move flights.
    over : the free parameters; the clearance among them changes the wall alone.
    """

    family: Family
    over: tuple[str, ...]
    k: int
    n: int = 0
    word: tuple[int, ...] = ()

    clocked: ClassVar[bool] = True
    plastic: ClassVar[bool] = False

    def times(self, point: Array) -> Array:
        """The times of the impacts: none."""
        return point[:0]

    def values(self, point: Array) -> dict[str, float]:
        """The free parameters."""
        return dict(zip(self.over, point[2:].tolist(), strict=True))

    def launch(self, point: Array) -> dict[str, float]:
        """The numbers of the family for a launch at x."""
        values = {name: value for name, value in self.values(point).items() if name in self.family.over}
        return values | {CLEARANCE: float(point[0])}

    def at(self, point: Array) -> Loop:
        """The conditions and their derivatives at a point."""
        values = self.launch(point)
        period = self.family.period(values)
        end = self.family.end(values, 0.0, float(point[1]), self.k * period.value)
        flow = np.stack([end.by_numbers[self.family.over.index(CLEARANCE)] + np.array([1.0, 0.0]), end.by_v], axis=1)
        slope = np.zeros((2, 2 + len(self.over)))
        slope[:, :2] = flow - np.eye(2)
        for column, name in enumerate(self.over):
            if name != CLEARANCE and name in self.family.over:
                at = self.family.over.index(name)
                slope[:, 2 + column] = end.by_numbers[at] + self.k * period.slopes[at] * end.by_time
        return Loop(np.array([end.place[0], end.place[1] - point[1]]), slope, -np.eye(2))

    def heights(self, point: Array) -> list[tuple[float, float]]:
        """The lowest place of the orbit: its time, and x - c there."""
        return [min(turns, key=itemgetter(1), default=(np.nan, np.inf)) for turns in self.minima(point)]

    def minima(self, point: Array) -> list[list[Turn]]:
        """All local minima of the orbit: time and x - c, each once."""
        values = self.launch(point)
        span = self.span(point)
        rise = float(point[0]) - self.values(point).get(CLEARANCE, self.family.start[CLEARANCE])
        turns = minima_of(self.family, values, (0.0, float(point[1]), 1.5 * span))
        # one span that begins away from 0: a minimum at time 0 is not between two samples
        turns = [turn for turn in turns if not turn[0] < span / 4 and not turn[0] >= 5 * span / 4]
        return [[(time, height + rise) for time, height in turns]]

    def period(self, point: Array) -> float:
        """The period of the forcing."""
        return self.family.period(self.launch(point)).value

    def rise(self, point: Array, direction: Array, flight: int, time: float) -> float:  # noqa: ARG002
        """The rate at which x - c at a time changes as the point moves: see `Closing.rise`."""
        end = self.family.end(self.launch(point), 0.0, float(point[1]), time)
        moved = dict(zip(self.over, direction[2:].tolist(), strict=True))
        wall = moved.get(CLEARANCE, 0.0)
        rates = [float(direction[0]) if name == CLEARANCE else moved.get(name, 0.0) for name in self.family.over]
        return float(np.dot(rates, end.by_numbers[:, 0]) + end.by_v[0] * direction[1] + direction[0] - wall)

    def pushes(self, point: Array) -> Array:
        """None of an orbit without impact."""
        return point[:0]

    def span(self, point: Array, flight: int = 0) -> float:  # noqa: ARG002
        """The time of k periods."""
        return self.k * self.period(point)

    def scales(self, point: Array) -> Array:
        """Sizes of the parts of a point."""
        size = max(abs(float(point[0])), abs(float(point[1])), 1e-3)
        return np.concatenate([np.full(2, size), np.ones(len(self.over))])
