"""`si.ensemble`: many orbits that live through chatter, rest and lift-off, and what is counted of them."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, ClassVar

import numpy as np

from singimpact.algebra.numbers import Array, as_float, constant, float_array
from singimpact.cases import in_threads
from singimpact.dynamics.families import OscillatorFamily, beside_members
from singimpact.dynamics.lives import GRAZE, IMPACT, SETTINGS as LIFE, Lives, Stretch
from singimpact.flights.flight_path import along
from singimpact.flights.members import Members
from singimpact.inputs import checked_keywords, refuse, require, require_memory, takes_two_walls, whole
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result, default_axes
from singimpact.status import Status, status_array

# Orbits that are flown together; their random numbers are those of the block, wherever it is computed
BLOCK = 2048
# What is kept of each orbit, before its samples
COLUMNS = ("tau", "v", "wall", "status", "impacts", "rests", "first_rest", "resting", "speed")
# The part of the time on which a_c changes below which chatter is over where its restitution is random
SHORT = 1e-9
# What may be random, and between which numbers
DISTURBED = {"restitution": (0.0, 1.0), "kick": (-np.inf, np.inf)}


@dataclass(frozen=True)
class Survival(Result):
    """The share of orbits that have not come to rest, and its binomial standard error, at times after the start."""

    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = {"t": ("t",), "share": ("t",), "error": ("t",)}
    t: Array
    share: Array
    error: Array


@dataclass(frozen=True)
class Spectrum(Result):
    """The mean power spectrum of x of many orbits, one-sided, per unit of angular frequency, and its standard error."""

    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(("frequency", "power", "error"), ("frequency",))
    frequency: Array
    power: Array
    error: Array


@dataclass(frozen=True, eq=False)
class Ensemble(Result):
    """Orbits of many states.

    Attributes
    ----------
    tau, v, status, wall : the last states, and 0, or why an orbit ended before, of the shape of the states; `wall` of
        two walls, else None. impacts : flown. rests : chatters that were over. first_rest : the time at which the
        first one was, inf if none was. resting : time at rest on the wall.
    start, duration : the first times of the orbits, and how long each lasts. mean_v : of the impacts.
    model : of a family that of its first member.
    t, x, xdot : times of samples, and the motion there, shape (times, *states); None without `sample`.
    """

    tau: Array
    v: Array
    status: Array
    impacts: Array
    rests: Array
    first_rest: Array
    resting: Array
    mean_v: Array
    start: Array
    duration: Array
    wall: Array | None = None
    t: Array | None = None
    x: Array | None = None
    xdot: Array | None = None
    model: Oscillator | None = None
    heads_csv = True

    def arrays(self) -> dict[str, tuple[tuple[str, ...], Any]]:
        """Names of axes and values."""
        states = default_axes(self.tau.ndim)
        axes = {"t": ("t",), "x": ("t", *states), "xdot": ("t", *states)}
        return {name: (axes.get(name, states), value) for name, value in self.as_dict().items()}

    def __repr__(self) -> str:
        ended = np.count_nonzero(self.status)
        rested = np.mean(np.isfinite(self.first_rest)) if self.tau.size else 0.0
        words = f"{self.tau.size} orbits, {int(self.impacts.sum())} impacts: {100 * rested:.3g} % have come to rest"
        return f"Ensemble({words}{f', {ended} ended' if ended else ''})"

    @cached_property
    def survival(self) -> Survival:
        """The share of orbits that have not come to rest, at the times after the start at which one does."""
        lasted = np.sort((self.first_rest - self.start).ravel())
        times, n = np.concatenate([[0.0], lasted[np.isfinite(lasted)]]), max(lasted.size, 1)
        share = 1 - np.searchsorted(lasted, times, side="right") / n
        return Survival(times, share, np.sqrt(share * (1 - share) / n))

    def escape_rate(self, after: object = 0) -> tuple[float, float]:
        """The rate at which orbits come to rest for the first time, a unit of time, and its standard error.

        Parameters
        ----------
        after : the time after the start from which on the rate is taken: the number of rests divided by the time at
            risk, the estimate of greatest likelihood where the rate is constant.
        """
        begin = as_float(constant("after", after))
        lasted = (self.first_rest - self.start).ravel()
        at_risk = np.minimum(lasted, self.duration.ravel()) - begin
        count = int(np.count_nonzero(np.isfinite(lasted) & (lasted > begin)))
        time = float(at_risk[at_risk > 0].sum())
        if not time > 0:
            raise refuse("after", after, f"a time below {np.max(at_risk + begin, initial=0):.6g}, where orbits go on")
        return count / time, float(np.sqrt(count)) / time

    @property
    def averages(self) -> dict[str, tuple[float, float]]:
        """Means over the orbits and their standard errors: impacts a unit of time, v of impacts, share of time at rest.

        Orbits that ended early are left out.
        """
        whole_ones = (self.status.ravel() == 0) & (self.duration.ravel() > 0)
        time = self.duration.ravel()[whole_ones]
        columns = {
            "impacts": self.impacts.ravel()[whole_ones] / time,
            "v": self.mean_v.ravel()[whole_ones],
            "rest": self.resting.ravel()[whole_ones] / time,
        }
        return {name: _mean(values[np.isfinite(values)]) for name, values in columns.items()}

    def density(self, bins: Any = 50) -> tuple[Array, Array, Array]:
        """The density of the samples over x and x', and the edges of its cells, as `numpy.histogram2d` gives them.

        Examples
        --------
        >>> ball = Oscillator("1", "1.9*sin(t)", 0, "1/2")
        >>> found = ensemble(ball, 0, np.linspace(0.1, 3, 50), until=50, sample=0)
        >>> found.density(8)[0].shape
        (8, 8)
        """
        _, x, xdot = self._samples()
        seen = np.isfinite(x)
        return np.histogram2d(x[seen], xdot[seen], bins=bins, density=True)

    @cached_property
    def spectrum(self) -> Spectrum:
        """The power spectrum of x, from the samples under Hann's window; orbits that ended early are left out."""
        times, x, _ = self._samples()
        steps = np.diff(times)
        if steps.size < 7 or np.ptp(steps) > 1e-9 * np.abs(times).max():
            raise refuse("sample", f"{times.size} times", "8 or more evenly spaced times for a spectrum")
        rows = x.reshape(times.size, -1)
        rows = rows[:, np.isfinite(rows).all(axis=0)]
        window = np.hanning(times.size + 1)[:-1, None]
        moved = np.fft.rfft((rows - rows.mean(axis=0)) * window, axis=0)
        power = np.abs(moved) ** 2 * steps[0] / (np.pi * np.sum(window**2))
        mean, error = np.transpose([_mean(values) for values in power])
        return Spectrum(2 * np.pi * np.fft.rfftfreq(times.size, steps[0]), mean, error)

    def _samples(self) -> tuple[Array, Array, Array]:
        if self.t is None or self.x is None or self.xdot is None:
            raise refuse("sample", None, "times of samples: give sample= to ensemble()")
        return self.t, self.x, self.xdot


def _mean(values: Array) -> tuple[float, float]:
    mean = float(values.mean()) if values.size else np.nan
    return mean, float(values.std(ddof=1) / np.sqrt(values.size)) if values.size > 1 else np.nan


@checked_keywords
@takes_two_walls
def ensemble(
    osc: Oscillator | OscillatorFamily,
    tau: object,
    v: object,
    *,
    until: object = None,
    impacts: int | None = None,
    sample: object = None,
    wall: object = None,
    random: Mapping[str, Any] | None = None,
    **computing: Any,
) -> Ensemble:
    """Orbits of many states, through chatter that completes, rest and lift-off.

    Parameters
    ----------
    osc : a model, or a family (`osc.over`), of which each member has its own states. tau, v : states, which broadcast.
    until : the time up to which orbits are flown; each ends with its first impact after it. impacts : instead, how many
        are flown of each; a chatter that completes counts as one, some more may be flown.
    sample : times at which x and x' are kept, or a phase, at which they are once a period. wall : of the states.
    random : "restitution" and "kick", each a function of a numpy Generator and a size: the restitution of each impact,
        and a velocity added after it (a result < 0 is turned back); "generator" or a seed for them.
    computing : `executor`, `output`, as for `sweep`; without an executor here, by compiled loops on two threads.

    Returns
    -------
    Ensemble : the last states, `.first_rest`, `.survival`, `.escape_rate()`, `.averages`; of samples `.x`, `.xdot`,
        `.density()`, `.spectrum`.

    Notes
    -----
    In the last thousandth of a chatter the samples have x at the wall.
    White noise between impacts is no ensemble of this kind: after a launch from the wall it has no first impact.

    Examples
    --------
    >>> ball = Oscillator("1", "1.9*sin(t)", 0, "1/2")
    >>> found = ensemble(ball, 0, np.linspace(0.1, 3, 200), until=100)
    >>> bool((found.rests > 0).mean() > 0.5), found.first_rest.shape
    (True, (200,))
    """
    if not isinstance(osc, Oscillator | OscillatorFamily):
        raise refuse("osc", osc, "an ImpactOscillator, or a family osc.over(...)")
    require((until is None) != (impacts is None), "until", until, "a time, or impacts= in its place")
    end = as_float(constant("until", until)) if until is not None else np.inf
    most = whole("impacts", impacts, 0, 10**9) if impacts is not None else 10**9
    noise, generator = _noise_of({} if random is None else random)
    model, flat, which, columns, shape = beside_members(osc, (tau, v, wall))
    start = columns[0]
    if np.isfinite(end) and start.size and not end > start.max():
        raise refuse("until", until, f"a time after all starts, the last of which is {start.max():.6g}")
    times = _times(model, sample, start, end)
    require_memory("orbits and their samples", (len(COLUMNS) + 2 * times.size, start.size), 8)
    cases = _cases(flat, which, columns, generator if noise else None)
    work = partial(_flown, model, (end, most), times, noise)
    blocks = in_threads(work, cases, computing, 1)
    table = np.asarray(blocks).reshape(-1, len(COLUMNS) + 2 * times.size)[: start.size]
    return _result(model, table, times, start, shape)


def _noise_of(random: Any) -> tuple[dict[str, Callable[..., Any]], np.random.Generator]:
    """The functions that disturb orbits, and the generator of their numbers."""
    accepted = 'a dict of "restitution" and "kick", functions of a generator and a size, and of "generator", or a seed'
    noise = {name: work for name, work in random.items() if name != "generator"} if isinstance(random, Mapping) else {}
    if not isinstance(random, Mapping) or set(noise) - set(DISTURBED) or not all(map(callable, noise.values())):
        raise refuse("random", random, accepted)
    try:
        return noise, np.random.default_rng(random.get("generator"))
    except (TypeError, ValueError):
        raise refuse("generator", random["generator"], "a numpy Generator, or a whole number >= 0 as a seed") from None


def _cases(
    flat: Mapping[str, Array], which: Array, columns: list[Array], generator: np.random.Generator | None
) -> list[Any]:
    """Blocks of orbits: numbers of their models, the model of each, tau, v, wall and a seed."""
    blocks, cases = range(0, which.size, BLOCK), []
    seeds = [0] * len(blocks) if generator is None else generator.integers(2**63, size=len(blocks)).tolist()
    for begin, seed in zip(blocks, seeds, strict=True):
        piece = slice(begin, begin + BLOCK)
        used, places = np.unique(which[piece], return_inverse=True)
        some = {name: values[used] for name, values in flat.items()}
        cases.append((some, places.ravel(), *(column[piece] for column in columns), seed))
    return cases


def _times(model: Oscillator, sample: Any, start: Array, end: float) -> Array:
    if sample is None:
        return np.zeros(0)
    if np.ndim(sample):
        return np.sort(float_array("sample", sample).ravel())
    if model.period is None or not np.isfinite(end):
        raise refuse("sample", sample, "an array of times: a phase needs a model with a period, and until=")
    period, phase = as_float(model.period), as_float(constant("sample", sample))
    latest = start.max() if start.size else 0.0
    return phase + period * np.arange(np.ceil((latest - phase) / period), np.floor((end - phase) / period) + 1)


def _result(model: Oscillator, table: Array, times: Array, start: Array, shape: tuple[int, ...]) -> Ensemble:
    columns = dict(zip(COLUMNS, table.T[: len(COLUMNS)].reshape(len(COLUMNS), *shape), strict=True))
    motion = table[:, len(COLUMNS) :].T.reshape(2, times.size, *shape)
    impacts, begun = columns["impacts"].astype(np.int64), start.reshape(shape)
    with np.errstate(invalid="ignore"):
        speed = columns["speed"] / np.where(impacts > 0, impacts, np.nan)
    t, x, xdot = (times, motion[0], motion[1]) if times.size else (None, None, None)
    ended = status_array(columns["status"].astype(np.int8)), impacts, columns["rests"].astype(np.int64)
    wall = columns["wall"].astype(np.int8) if model.upper is not None else None
    lasted = columns["first_rest"], columns["resting"], speed, begun, columns["tau"] - begun
    return Ensemble(columns["tau"], columns["v"], *ended, *lasted, wall, t, x, xdot, model)


def _flown(
    model: Oscillator, ends: tuple[float, int], times: Array, noise: Mapping[str, Callable[..., Any]], case: Any
) -> Array:
    """Rows of `COLUMNS` and samples of one block of orbits, filled up to `BLOCK`."""
    numbers, which, tau, v, walls, seed = case
    run = _Run(Lives(Members(model, numbers), which, tau, v, walls), ends, noise, seed)
    run.samples = Samples(run.lives, times) if times.size else None
    run.fly()
    table = np.full((BLOCK, len(COLUMNS) + 2 * times.size), np.nan)
    table[: which.size, : len(COLUMNS)] = run.table()
    if run.samples is not None:
        run.samples.end()
        table[: which.size, len(COLUMNS) :] = np.concatenate(list(run.samples.motion), axis=1)
    return table


# ---- the motion at given times


class Samples:
    """x and x' of orbits at times.

    Parameters
    ----------
    lives : the orbits, before they are flown. times : of the samples, in order.

    Attributes
    ----------
    motion : x and x', shape (2, orbits, times); nan before the start, and after an orbit has ended unresolved.
    """

    def __init__(self, lives: Lives, times: Array) -> None:
        self.lives, self.times = lives, times
        self.motion = np.full((2, lives.which.size, times.size), np.nan)
        self.add(lives.events())

    def add(self, events: Array) -> None:
        """Take in the flights, chatter and rests between events of orbits, as `Lives.events` has them."""
        joined = events[1:, 0] == events[:-1, 0]
        before, ends, kinds = events[:-1][joined], events[1:, 1][joined], events[1:, 3][joined]
        flies = (kinds == IMPACT) | (kinds == GRAZE)
        self._fly(before[flies], ends[flies])
        self._rest(before[~flies], ends[~flies])

    def end(self) -> None:
        """Fill in the motion after the last events of orbits that rest for ever, or do not return."""
        lives = self.lives
        last = np.column_stack([np.arange(lives.which.size), lives.time(), lives.v, lives.status, lives.wall])
        away, forever = np.isin(lives.status, (Status.no_return, Status.escaped)), lives.status == Status.sticks
        self._fly(last[away], np.full(np.count_nonzero(away), np.inf))
        self._rest(last[forever], np.full(np.count_nonzero(forever), np.inf))

    def _rest(self, events: Array, ends: Array) -> None:
        """Masses at their walls from some events up to others."""
        orbits, above = events[:, 0].astype(int), events[:, 4] == 1
        places = self.lives.places(self.lives.which[orbits], above)
        slots = np.searchsorted(self.times, np.stack([events[:, 1], ends]))
        for orbit, height, begin, end in zip(orbits.tolist(), places.tolist(), *slots.tolist(), strict=True):
            self.motion[0, orbit, begin:end], self.motion[1, orbit, begin:end] = height, 0.0

    def _fly(self, events: Array, ends: Array) -> None:
        """Flights of orbits from events up to some times."""
        begun, v, orbits, walls = events[:, 1], events[:, 2], *events[:, [0, 4]].T.astype(int)
        first = np.searchsorted(self.times, begun)
        counts = np.maximum(np.searchsorted(self.times, ends) - first, 0)
        flight = np.repeat(np.arange(orbits.size), counts)
        slot = first[flight] + np.arange(flight.size) - np.repeat(np.cumsum(counts) - counts, counts)
        lives, since = self.lives, self.times[slot] - begun[flight]
        phase, _ = lives.split(begun, np.zeros(orbits.size), orbits)
        heights, sides = np.empty((since.size, 2)), 2 * lives.which[orbits] + walls
        for side in np.unique(sides[flight]).tolist():
            chosen = sides[flight] == side
            model = lives.members.side(*divmod(side, 2))
            heights[chosen] = along(model, phase, v, flight[chosen], since[chosen])
        above = walls[flight] == 1
        heights *= np.where(above, -1.0, 1.0)[:, None]
        heights[:, 0] += lives.places(lives.which[orbits[flight]], above)
        self.motion[:, orbits[flight], slot] = heights.T


class _Run:
    """One block of orbits on its way."""

    def __init__(
        self, lives: Lives, ends: tuple[float, int], noise: Mapping[str, Callable[..., Any]], seed: int
    ) -> None:
        self.lives, (self.end, self.most) = lives, ends
        self.noise, self.generator = noise, np.random.default_rng(seed)
        size = lives.which.size
        self.speed = np.zeros(size)
        self.samples: Samples | None = None
        if noise:
            lives.near = SHORT

    def fly(self) -> None:
        """All impacts that are asked for."""
        lives = self.lives
        block = 1 if self.noise else LIFE.block
        while (
            going := np.flatnonzero((lives.status == 0) & (lives.flown < self.most) & (lives.time() < self.end))
        ).size:
            count = np.minimum(block, self.most - lives.flown[going])
            before = {name: getattr(lives, name)[going].copy() for name in ("flown", "rests", "first_rest", "resting")}
            stretch = lives.advance(count, going)
            self.speed[going] += np.where(stretch.real, stretch.rows[..., 1], 0.0).sum(axis=1)
            if self.samples is not None:
                self.samples.add(lives.events(stretch))
            if np.isfinite(self.end):
                self._cut(stretch, before)
            if self.noise:
                self._disturb(stretch)

    def _disturb(self, stretch: Stretch) -> None:
        """Random velocities after the impacts that were flown."""
        lives, at = self.lives, stretch.chosen[stretch.plain]
        if "restitution" in self.noise:
            lives.v[at] = np.abs(stretch.rows[stretch.plain, 0, 3]) * self._drawn("restitution", at.size)
        if "kick" in self.noise:
            lives.v[at] = np.abs(lives.v[at] + self._drawn("kick", at.size))

    def _drawn(self, name: str, size: int) -> Array:
        """Random numbers, of which a function of the caller has made as many as it was asked for."""
        values, (low, high) = np.asarray(self.noise[name](self.generator, size), float), DISTURBED[name]
        good = np.isfinite(values) & (low <= values) & (values <= high)
        if values.shape != (size,) or not good.all():
            wanted = f"a function that returns {size} finite numbers from {low:g} to {high:g}"
            raise refuse(name, values.ravel()[:4].tolist(), wanted)
        return values

    def _cut(self, stretch: Stretch, before: dict[str, Array]) -> None:
        """Orbits whose time has passed the end go back to their first impact after it."""
        lives, times = self.lives, self.lives.times(stretch)
        passed = (times >= self.end) & stretch.real
        late = np.flatnonzero(passed.any(axis=1))
        if not late.size:
            return
        slot = passed[late].argmax(axis=1)
        at, rows = stretch.chosen[late], stretch.rows[late, slot]
        dropped = stretch.real[late] & (np.arange(times.shape[1]) > slot[:, None])
        self.speed[at] -= np.where(dropped, stretch.rows[late, :, 1], 0.0).sum(axis=1)
        phase, turns, _, walls = (column[late] for column in stretch.begun)
        lives.phase[at], lives.turns[at] = lives.split(phase + rows[:, 0], turns, at)
        lives.v[at], lives.wall[at], lives.status[at] = rows[:, 1], walls ^ rows[:, 11].astype(np.int8), 0
        for name in ("rests", "first_rest", "resting"):
            getattr(lives, name)[at] = before[name][late]
        lives.flown[at] = before["flown"][late] + slot + 1

    def table(self) -> Array:
        """Rows of `COLUMNS`."""
        names = ("v", "wall", "status", "flown", "rests", "first_rest", "resting")
        return np.column_stack([self.lives.time(), *(getattr(self.lives, name) for name in names), self.speed])
