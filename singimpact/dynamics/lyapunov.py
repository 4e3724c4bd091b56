"""Lyapunov exponents of orbits of the impact map, from D G along them: of one orbit, of many, of families.

    det D G = -rho'(u) (v/|u|) exp(-int f_v dt) = r^2 (v/v') exp(-int f_v dt)   for rho = -r u

so both exponents together are the mean rate at which areas shrink; the second one is this rate less the first one, for
the entries of D G keep too few digits of a strong contraction. D G comes with the flights of linear models and from the
variational equation of others.
"""

from collections import deque
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from singimpact.algebra.derivatives import derivative as derivative_of
from singimpact.algebra.expressions import names_in
from singimpact.algebra.numbers import EPSILON, Array, compare
from singimpact.dynamics.families import OscillatorFamily, in_parts
from singimpact.dynamics.lives import Lives, Single, Stretch
from singimpact.dynamics.remaining import chatter_completes
from singimpact.flights.derivative import derivative, log_determinant
from singimpact.flights.model_numbers import valued
from singimpact.flights.response import with_bend
from singimpact.inputs import InputError, checked_keywords, refuse, shown, takes_two_walls, whole
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result
from singimpact.status import Status, status_array


@dataclass(frozen=True)
class LyapunovSettings:
    """Settings of the sums of growth along an orbit."""

    # impacts of one call into compiled code for all orbits together; their slopes take 6 MB
    block: int = 65_536
    # stretches of one block of an orbit whose products are formed side by side, and impacts of one at least
    stretches: int = 256
    least: int = 16
    # impacts of a transient at most: a chaotic one of x'' + x = cos 3.3t, c = 0.03, r = 0.95 lasts 3800 (median)
    transient: int = 20_000
    # longest period, and relative distance of states that repeat
    period: int = 64
    close: float = 1e-9
    # standard errors by which the halves of the impacts may differ
    apart: float = 4.0


SETTINGS = LyapunovSettings()
SMALLEST = float(np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class Lyapunov(Result):
    """Both Lyapunov exponents of an orbit, or of each of many.

    Parameters
    ----------
    exponents : per unit of time, the larger first, of shape (..., 2); -inf where the orbit comes to rest again and
        again, for what follows a rest does not depend on what was before; nan where no impact was flown.
    error : standard errors of `exponents`, from the spread of groups of impacts, and their rounding; nan with fewer
        than two groups.
    impacts, time : how many impacts the exponents are taken over, and how long they last.
    start, last : the states (tau, v) before and after these impacts.
    status : `hit` where all impacts were flown, `sticks` of an orbit that comes to rest, else the status of the flight
        that ended the orbit. The exponents are those of the impacts before it.
    superstable : whether the orbit lifts off twice at one phase of the forcing (eight times, where the forcing never
        repeats), or rests for ever.
    transient : impacts flown before. converged : whether the larger exponents of both halves of the impacts agree
        within their errors; where they do not, the orbit has not settled: give more impacts or a longer transient.
    """

    exponents: Array
    error: Array
    impacts: Any
    time: Any
    start: tuple[Any, Any]
    last: tuple[Any, Any]
    status: Any
    superstable: Any
    transient: Any = 0
    converged: Any = True

    def as_dict(self) -> dict[str, Any]:
        """The fields, and the exponents per impact."""
        values = super().as_dict()
        return {
            "exponents": values.pop("exponents"),
            "error": values.pop("error"),
            "per_impact": self.per_impact,
        } | values

    @property
    def per_impact(self) -> Array:
        """The exponents per impact."""
        with np.errstate(all="ignore"):
            ratio = np.where(np.asarray(self.impacts) > 0, np.divide(self.time, self.impacts), 1.0)
        return np.asarray(self.exponents * ratio[..., None])

    def __repr__(self) -> str:
        if np.ndim(self.impacts):
            positive = self.exponents[..., 0] > 3 * self.error[..., 0]
            chaotic, resting = (100 * np.sum(mark) / max(np.size(mark), 1) for mark in (positive, self.superstable))
            return f"Lyapunov({np.size(self.impacts)} orbits: {chaotic:.3g} % chaotic, {resting:.3g} % superstable)"
        if self.superstable:
            return f"Lyapunov(superstable: the orbit comes to rest, {self.impacts} impacts)"
        item = ", ".join(f"{value:.6g} +- {error:.2g}" for value, error in zip(self.exponents, self.error, strict=True))
        ended = "" if self.status == Status.hit else f", ended by {Status(int(self.status)).name}"
        doubt = "" if self.converged else ", not converged: the halves differ, give more impacts"
        return f"Lyapunov({item} per unit of time, {self.impacts} impacts after {self.transient}{ended}{doubt})"


@checked_keywords
@takes_two_walls
def lyapunov(
    osc: Oscillator | OscillatorFamily,
    tau: object,
    v: object,
    impacts: int = 10_000,
    *,
    transient: int | None = None,
    wall: object = None,
) -> Lyapunov:
    """The Lyapunov exponents of the orbit of a state, or of many.

    Parameters
    ----------
    osc : the model, or a family (`osc.over`). tau, v : states, v >= 0, which broadcast, also with the members of a
        family. impacts : flown, with D G, after `transient` others. Without a transient an orbit is followed until it
        repeats, at most 20 000 impacts, then flown anew while both halves differ. wall : of the states, of a model with
        two walls: "lower" (also without it) or "upper".

    Returns
    -------
    Lyapunov : `.exponents` per unit of time, `.per_impact`, `.error`, `.status`, `.superstable`, `.transient`,
        `.converged`.

    Notes
    -----
    After a rest the sums begin anew at the lift-off. The exponents are those of the flow in x, x' and the phase,
    without the one that is 0.

    Examples
    --------
    >>> found = lyapunov(Oscillator("x", "cos(4*t)", 0, "1/2"), 0, 1, 1000, transient=100)
    >>> found.exponents.round(6).tolist()  # ln(1/2) an impact, every two periods
    [-0.220636, -0.220636]
    """
    if not isinstance(osc, Oscillator | OscillatorFamily):
        raise refuse("osc", osc, "an ImpactOscillator, or a family osc.over(...)")
    flown = whole("impacts", impacts, 1, 10**8)
    before = None if transient is None else whole("transient", transient, 0, 10**8)
    item = lambda *states: exponents_of_states(states, flown, before)  # noqa: E731
    return _shaped(in_parts(osc, (tau, v, wall), item)[0])


def exponents_of_states(states: tuple[Any, ...], impacts: int, transient: int | None) -> tuple[Array]:
    """The fields of `Lyapunov` for some orbits, one row each; states : as `Lives` takes them."""
    run = _Run(Lives(*states))
    if transient is None:
        return (run.settled(impacts),)
    run.fly(np.full(run.size, transient), keep=False)
    run.begin()
    run.fly(np.full(run.size, impacts), keep=True)
    return (run.table(),)


def _shaped(table: Array) -> Lyapunov:
    """Rows of fields as a result; of one row as numbers."""
    columns = np.moveaxis(table, -1, 0)
    impacts, status, over, before, converged = (
        columns[slot].astype(kind)[()]
        for slot, kind in ((4, np.int64), (10, np.int8), (11, bool), (12, np.int64), (13, bool))
    )
    start, last = (columns[6][()], columns[7][()]), (columns[8][()], columns[9][()])
    status = status_array(status)
    return Lyapunov(
        table[..., :2], table[..., 2:4], impacts, columns[5][()], start, last, status, over, before, converged
    )


class Growth:
    """The growth of a vector along each of some orbits.

    Attributes
    ----------
    rows : of each stretch (time, ln of the growth, ln of the area, impacts), shape (4, orbits).
    """

    def __init__(self, lives: Lives) -> None:
        self.lives = lives
        self.vector = np.tile([[1.0], [0.0]], lives.which.size)
        self.rows: list[Array] = []

    def begin(self, chosen: Array) -> None:
        """Sums of some orbits begin anew, with the vector that they have."""
        for before in self.rows:
            before[:, chosen] = 0.0

    def add(self, stretch: Stretch) -> None:
        """Take in a stretch; sums begin anew where an orbit has rested."""
        at, real = stretch.chosen, stretch.real
        if real.any():
            slopes, areas = self.derivatives(stretch)
            count = real.shape[1]
            pieces = max(1, min(SETTINGS.stretches, count // SETTINGS.least))
            length = -(-count // pieces)
            pieces = -(-count // length)
            matrices = np.zeros((2, 2, at.size, pieces * length))
            matrices[0, 0], matrices[1, 1] = 1.0, 1.0
            matrices[:, :, :, :count][:, :, real] = slopes
            columns = np.zeros((3, at.size, pieces * length))
            columns[:, :, :count][:, real] = np.stack([stretch.rows[real][:, 2], areas, np.ones(areas.size)])
            sums = columns.reshape(3, at.size, pieces, length).sum(axis=-1)
            for piece, (product, size) in enumerate(zip(*_products(matrices, pieces, length), strict=True)):
                moved = np.einsum("ijn,jn->in", product, self.vector[:, at])
                grown = np.maximum(np.hypot(*moved), SMALLEST)  # 0 where roundings cancel
                self.vector[:, at] = moved / grown
                row = np.zeros((4, self.lives.which.size))
                row[:, at] = sums[0, :, piece], size + np.log(grown), sums[1, :, piece], sums[2, :, piece]
                self.rows.append(row)
        for single in stretch.singles:
            self._single(single)
        self.begin(at[stretch.rested])

    def _single(self, single: Single) -> None:
        """One flight that the impact map has decided."""
        index, step = single.orbit, single.step
        if step.status != Status.hit:
            return
        here = self.lives.members.side(int(self.lives.which[index]), single.wall)
        one = [np.array([float(item)]) for item in (single.phase, single.v, step.flight_time, step.velocity)]
        moved = derivative(here, single.phase, single.v).matrix @ self.vector[:, index]
        grown = max(float(np.hypot(*moved)), SMALLEST)
        self.vector[:, index] = moved / grown
        row = np.zeros((4, self.lives.which.size))
        row[:, index] = one[2][0], np.log(grown), log_determinant(here, *one)[0], 1.0
        self.rows.append(row)

    @cached_property
    def _slopes_of_rho(self) -> list[Any]:
        """r at each wall, of the members; or rho' as a tree in v."""
        found: list[Any] = []
        for pressure in self.lives.pressures:
            law = pressure.osc.rho(self.lives.members.letters)
            moving = "v" in names_in(pressure.osc.restitution)
            found.append(derivative_of(law, "v") if moving else pressure.slopes)
        return found

    def _rebound_slope(self, which: Array, velocity: Array) -> Array:
        """rho' at velocities, and that of the law of the upper wall, turned, at velocities > 0."""
        result = np.empty(velocity.shape)
        for wall, law in enumerate(self._slopes_of_rho):
            at = (velocity > 0) == bool(wall)
            if isinstance(law, np.ndarray):
                slope = -law[which[at]]
            else:
                letters = {name: values[which[at]] for name, values in self.lives.members.over.items()}
                slope = valued(law, {**letters, "v": -np.abs(velocity[at])})
            result[at] = -slope if wall else slope
        return result

    def derivatives(self, stretch: Stretch) -> tuple[Array, Array]:
        """D G of the impacts of a stretch, shape (2, 2, n), and ln |det D G|."""
        lives, members, real = self.lives, self.lives.members, stretch.real
        phase, _, v, walls = stretch.begun
        turned = np.broadcast_to((walls == 1)[:, None], real.shape)[real]
        other = (stretch.rows[:, :-1, 11] == 1) & real[:, :-1]
        which = np.broadcast_to(lives.which[stretch.chosen][:, None], real.shape)[real]
        tau = np.column_stack([phase, phase[:, None] + stretch.rows[:, :-1, 0]])[real]
        speed = np.column_stack([v, stretch.rows[:, :-1, 1]])[real]
        sides = np.column_stack([walls, walls[:, None] ^ other])[real].astype(np.int8)
        rows, sign = stretch.rows[real], np.where(turned, -1.0, 1.0)
        time, velocity = rows[:, 2], sign * rows[:, 3]
        if members.linear:
            by_tau, by_v = rows[:, 7:9].T
            speed_by_tau, speed_by_v = sign * rows[:, 9:11].T
        else:
            parts = members.variations(which, (tau, speed, sides), time)
            seen = np.where(sides == 1, -1.0, 1.0)  # in the frame of the launch
            answer = with_bend(parts, seen * velocity, seen * self._bend(which, tau + time, velocity))
            by_tau, by_v = answer.time_by_tau, answer.time_by_v
            speed_by_tau, speed_by_v = seen * answer.velocity_by_tau, seen * answer.velocity_by_v
        slope = self._rebound_slope(which, velocity)
        matrices = np.array([[1 + by_tau, by_v], [slope * speed_by_tau, slope * speed_by_v]])
        damping = derivative_of(members.osc.force(members.letters), "xdot")
        if not names_in(damping) & {"x", "xdot", "t"}:
            loss = lives.pressures[0].values(damping, which, time) * time
            with np.errstate(all="ignore"):
                return matrices, np.log(np.abs(slope) * speed / np.abs(velocity)) - loss
        areas = np.empty(which.size)
        for member in np.unique(which).tolist():
            at = which == member
            wall = sides[at] if members.two_walls else None
            areas[at] = log_determinant(members.member(member), tau[at], speed[at], time[at], velocity[at], wall)
        return matrices, areas

    def _bend(self, which: Array, at: Array, velocity: Array) -> Array:
        lives = self.lives
        osc, letters = lives.members.osc, lives.members.letters
        state = {name: values[which] for name, values in lives.members.over.items()}
        state |= {"x": lives.places(which, velocity > 0), "xdot": velocity, "t": at}
        return np.asarray(valued(osc.forcing(letters), state) - valued(osc.force(letters), state))


def _products(matrices: Array, pieces: int, length: int) -> tuple[Array, Array]:
    """Products of the matrices of each piece of an orbit, shape (pieces, 2, 2, n), to a size whose ln is the second."""
    a, b, c, d = matrices.reshape(4, -1, pieces, length)
    count = a.shape[0]
    p, q, r, s = (np.full((count, pieces), one) for one in (1.0, 0.0, 0.0, 1.0))
    size = np.zeros((count, pieces))
    for k in range(length):
        e, f, g, h = a[..., k], b[..., k], c[..., k], d[..., k]
        p, q, r, s = e * p + f * r, e * q + f * s, g * p + h * r, g * q + h * s
        scale = np.maximum(np.sqrt(p * p + q * q + r * r + s * s), SMALLEST)
        p, q, r, s = p / scale, q / scale, r / scale, s / scale
        size += np.log(scale)
    return np.array([[p, q], [r, s]]).transpose(3, 0, 1, 2), size.T


class _Run:
    """Orbits that are being flown, and the growth along them."""

    def __init__(self, lives: Lives) -> None:
        self.lives, self.size = lives, lives.which.size
        osc = lives.members.osc
        sides = [pressure.osc for pressure in lives.pressures]
        elastic = any(compare(side.slope_at_rest(), 1) == 0 for side in sides) and not lives.members.over
        if elastic and any(chatter_completes(side) for side in sides):
            raise InputError(
                f"restitution = {shown(str(osc.restitution))} is not accepted: exponents need r < 1, or r = 1 without "
                "the power q < 1 of the speed by which chatter comes to rest"
            )
        self.growth, self.before, self.start = Growth(lives), np.zeros(self.size, int), np.zeros((2, self.size))
        # without rebound: the last times at which each orbit began from rest, nan where it had a velocity
        self.rests: deque[Array] = deque(maxlen=SETTINGS.period + 1 if osc.plastic else 0)
        self.begin()

    def begin(self, chosen: Any = slice(None)) -> None:
        """Sums from the present states on."""
        self.start[:, chosen] = self.lives.time(chosen), self.lives.v[chosen]
        self.growth.begin(np.arange(self.size)[chosen])

    @property
    def over(self) -> Array:
        """Orbits that rest again and again, or for ever."""
        lives = self.lives
        # where the forcing never repeats, so many rests are rests again and again
        often = np.isnan(lives.members.period[lives.which]) & (lives.rests >= 8)
        return np.asarray((lives.cycle > 0) | (lives.status == Status.sticks) | often)

    def fly(self, most: Array, keep: bool) -> Stretch | None:
        """So many impacts of each orbit, fewer where it ends or is seen to come to rest again and again."""
        lives, done, stretch = self.lives, np.zeros(self.size, np.int64), None
        while (going := np.flatnonzero((done < most) & (lives.status == 0) & ~self.over)).size:
            before = lives.flown[going].copy()
            block = max(SETTINGS.block // going.size, SETTINGS.period)
            stretch = lives.advance(np.minimum(block, most[going] - done[going]), going)
            done[going] += np.maximum(lives.flown[going] - before, 1)
            self.rests.append(np.where(lives.v == 0, lives.time(), np.nan))
            if keep:
                self.growth.add(stretch)
            for single in stretch.singles:
                if single.step.status == Status.graze:  # D G has no limit there
                    lives.status[single.orbit] = Status.graze
            self.begin(stretch.chosen[stretch.rested])
        return stretch

    def settled(self, impacts: int) -> Array:
        """The exponents of what orbits settle to."""
        # impacts between two looks whether the orbit has settled, doubled each time
        block, open_ = 64 if self.lives.members.osc.plastic else 500, np.ones(self.size, bool)
        while open_.any():
            count = np.where(open_, np.minimum(block, SETTINGS.transient - self.before), 0)
            stretch = self.fly(count, keep=False)
            self.before += count
            open_ &= (self.before < SETTINGS.transient) & (self.lives.status == 0) & ~self.over
            if stretch is not None:
                open_[stretch.chosen[_repeats(self.lives, stretch)]] = False
            if self.rests:
                open_ &= ~self._from_the_same_rest()
            block *= 2
        result, open_ = np.zeros((self.size, 14)), np.ones(self.size, bool)
        # the impacts are flown anew when their halves differ
        for _ in range(3):
            self.begin(open_)
            # impacts in which the vector that is followed turns into its direction
            self.fly(np.where(open_, min(100, impacts), 0), keep=True)
            self.begin(open_ & (self.lives.status == 0) & ~self.over)
            self.fly(np.where(open_, impacts, 0), keep=True)
            result[open_] = self.table()[open_]
            open_ &= (result[:, 13] == 0) & (self.lives.status == 0) & ~self.over
            self.before += np.where(open_, impacts, 0)
            if not open_.any():
                break
        return result

    def _from_the_same_rest(self) -> Array:
        """Whether orbits begin from rest at the phase of an earlier rest, later than it: those that wait do not."""
        *before, last = self.rests
        if self.lives.members.osc.autonomous:
            return np.isfinite(last)
        turns = (last - np.reshape(before, (-1, last.size))) / self.lives.unit
        return np.asarray(((np.abs(turns - np.rint(turns)) < SETTINGS.close) & (turns > 0.5)).any(axis=0))

    def table(self) -> Array:
        """The fields of `Lyapunov`, one row for each orbit."""
        lives, over = self.lives, self.over
        rows = np.array(self.growth.rows) if self.growth.rows else np.zeros((1, 4, self.size))
        impacts, last = rows[:, 3].sum(axis=0), np.stack([lives.time(), lives.v])
        time = last[0] - self.start[0]
        exponents, error = exponents_of(rows, time)
        exponents = np.where(over, -np.inf, np.where(impacts > 0, exponents, np.nan))
        error = np.where(over, 0.0, error)
        status = np.where(over & (lives.status != Status.unresolved), Status.sticks, lives.status)
        columns = [*exponents, *error, impacts, time, *self.start, *last, status, over, self.before]
        return np.stack([*columns, _halves_agree(rows) | over], axis=1).astype(float)


def _repeats(lives: Lives, stretch: Stretch) -> Array:
    """Whether the last state of orbits is one of those before, of the longest period that is looked for."""
    times, speeds = stretch.rows[..., 0], np.where(stretch.rows[..., 11] == 1, -1.0, 1.0) * stretch.rows[..., 1]
    result = np.zeros(stretch.chosen.size, bool)
    clocked = not lives.members.osc.autonomous
    for n in range(1, min(SETTINGS.period, times.shape[1] - 1) + 1):
        with np.errstate(all="ignore"):
            turns = (times[:, -1] - times[:, -1 - n]) / lives.unit[stretch.chosen]
            off = np.abs(turns - np.rint(turns)) if clocked else 0.0 * turns
            away = np.maximum(off, np.abs(speeds[:, -1] - speeds[:, -1 - n]) / np.abs(speeds[:, -1]))
        repeats = np.isfinite(lives.unit[stretch.chosen]) | (not clocked)
        result |= stretch.plain & repeats & (stretch.flown == times.shape[1]) & (away < SETTINGS.close)
    return result


def _halves_agree(rows: Array) -> Array:
    """Whether the larger exponents of both halves differ by no more than their errors, and than a turn of the vector.

    A periodic orbit has no spread; the vector that is followed turns there by a bounded angle, which moves the mean by
    the inverse of the time.
    """
    middle = len(rows) // 2
    if middle < 2:
        return np.ones(rows.shape[2], bool)
    halves = [exponents_of(half, half[:, 0].sum(axis=0)) for half in (rows[:middle], rows[middle:])]
    times = [half[:, 0].sum(axis=0) for half in (rows[:middle], rows[middle:])]
    (one, error), (other, spread) = halves
    with np.errstate(all="ignore"):
        allowed = SETTINGS.apart * np.hypot(error[0], spread[0]) + 1 / np.minimum(*times)
        return np.asarray(~(np.abs(one[0] - other[0]) > allowed))


def exponents_of(rows: Array, time: Array) -> tuple[Array, Array]:
    """Exponents per unit of time and their standard errors, by groups of stretches of equal number, shapes (2, n)."""
    # groups of stretches whose spread gives the standard error
    groups = min(32, len(rows))
    parts = np.array([group.sum(axis=0) for group in np.array_split(rows, groups)])
    with np.errstate(all="ignore"):  # where impacts leave no velocity all areas are -inf
        growth = np.stack([parts[:, 1], parts[:, 2] - parts[:, 1]])
        exponents = growth.sum(axis=1) / time
        error = np.full(exponents.shape, np.nan)
        if groups > 1:
            # of a ratio of sums: what the growth of a group differs by from its time at the mean rate
            off = growth - parts[:, 0] * exponents[:, None]
            error = np.sqrt((off**2).sum(axis=1) * groups / (groups - 1)) / time
            # roundings of the growth in an impact
            error += 4.0 * EPSILON * rows[:, 3].sum(axis=0) / time
            error[np.isneginf(exponents)] = 0.0
    order = np.argsort(-exponents, axis=0, kind="stable")
    return np.take_along_axis(exponents, order, axis=0), np.take_along_axis(error, order, axis=0)
