"""`si.regions`: what orbits do in the end, over two numbers of the model: periods, chaos, chatter, or a number."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial, reduce
from itertools import chain, count, repeat
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array, as_float, constant
from singimpact.cases import in_threads
from singimpact.dynamics.basins_of_attraction import ClassGrid, unlike_neighbours
from singimpact.dynamics.behaviours import LongRun
from singimpact.dynamics.families import OscillatorFamily, in_parts
from singimpact.dynamics.lives import Lives, Stretch
from singimpact.dynamics.lyapunov import exponents_of_states
from singimpact.flights.members import SETTINGS as MEMBERS
from singimpact.inputs import checked_keywords, refuse, require, require_memory, takes_two_walls, whole
from singimpact.oscillator.model import Oscillator, require_model
from singimpact.oscillator.moving_number import with_number
from singimpact.status import Status
from singimpact.surface.curve import window_ends

# What regions are of: classes, the larger exponent, the share of time at rest, impacts a period
OF = ("period", "lyapunov", "rest", "impacts")
# Kinds of classes; NONE is not decided
NONE, ORBIT, CHATTER, REST, CHAOS, AWAY, GONE, STUCK = range(8)
KINDS = {
    NONE: "not decided",
    ORBIT: "orbit",
    CHATTER: "chatter",
    REST: "rest",
    CHAOS: "chaotic",
    AWAY: "no impact",
    GONE: "never returns",
    STUCK: "unresolved",
}
ENDS = {Status.sticks: REST, Status.no_return: AWAY, Status.escaped: GONE}
# Of a place: kind, n, k, word of walls as bits, value
COLUMNS = 5


@dataclass(frozen=True)
class RegionSettings:
    """When the class of an orbit is decided."""

    # impacts between two looks, and between later ones, at longer periods
    block: int = 48
    last: int = 192
    # longest period that is looked for, in impacts; a look has three of them
    period: int = 64
    # relative distance of states that may be one, of a state from the orbit that it goes to, and of equal states
    beside: float = 1e-3
    near: float = 3e-4
    rounding: float = 1e-11
    # relative distance of states of an orbit that are one; at a doubling they part like a root
    same: float = 3e-4
    # impacts between two lift-offs up to which rounding does not decide the second
    certain: int = 60
    # impacts over which a number is taken, after as many
    measured: int = 600
    # impacts from which on a neighbour is followed, its relative distance, and impacts after which it is set back
    chaos: int = 160
    apart: float = 1e-12
    steps: int = 16
    # standard errors, and growth an impact, above which chaos is seen
    sure: float = 4.0
    least: float = 0.01


SETTINGS = RegionSettings()


@dataclass(frozen=True, eq=False)
class Regions(ClassGrid):
    """Long-term behaviours of orbits over two numbers.

    Attributes
    ----------
    over : names of the numbers. x, y : their values. of : what is shown. attractors : the classes that occur.
    A chatter again and again has k = 0 where rounding would decide after how many periods.
    codes : shape (len(y), len(x)), indices into `attractors`. values : of a number, the same shape; None of classes.
    seams : places (x, y) between two classes, shape (m, 2), to a part 2^-refine of the distance of two values.
    """

    heads_csv = True
    model: Oscillator
    over: tuple[str, str]
    x: Array
    y: Array
    of: str
    attractors: tuple[LongRun, ...]
    codes: Array
    values: Array | None
    seams: Array

    @property
    def sides(self) -> tuple[tuple[str, Array], tuple[str, Array]]:
        """Names and values of both axes."""
        return (self.over[0], self.x), (self.over[1], self.y)

    @property
    def undecided(self) -> float:
        """The share of places whose class is not decided, or which have no number."""
        open_ = np.array([run.kind in ("not decided", "unresolved") for run in self.attractors])
        return float(np.mean(open_[self.codes] if self.values is None else np.isnan(self.values)))

    def __repr__(self) -> str:
        if self.values is None:
            shown = self.shares
        else:
            shown = f"{self.of} {np.nanmin(self.values):.4g} to {np.nanmax(self.values):.4g}"
        return f"Regions({self.x.size} x {self.y.size} models over {' and '.join(self.over)}: {shown})"

    def as_dict(self) -> dict[str, Any]:
        """The axes; for each place its class, or the number."""
        grid = {self.over[0]: self.x, self.over[1]: self.y}
        return grid | (self.named_codes if self.values is None else {self.of: self.values})

    def arrays(self) -> dict[str, tuple[tuple[str, ...], Array]]:
        """Names of axes and values."""
        values = {name: value for name, value in self.as_dict().items() if isinstance(value, np.ndarray)}
        return {name: ((name,) if value.ndim == 1 else self.over[::-1], value) for name, value in values.items()}


@checked_keywords
@takes_two_walls
def regions(
    osc: Oscillator,
    over: Sequence[str] = ("omega", "clearance"),
    between: Any = None,
    of: Any = "period",
    size: Any = 400,
    start: Any = (0, "0.1"),
    impacts: int = 4000,
    refine: int = 0,
    **computing: Any,
) -> Regions:
    """Classes of the long-term behaviour of one orbit, over two numbers of the model.

    Parameters
    ----------
    osc : a model; at all values it has a period. over : two of its numbers, as `bifurcation` takes them. between : a
        pair of intervals, one a number.
    of : "period", classes of long-term behaviour; "lyapunov", the larger exponent; "rest", the share of time at rest;
        "impacts", impacts a period of the forcing; or a function of a model that gives a number.
    size : values of each number, or a pair. start : the state (tau, v), v = 0 at rest; of two walls (tau, v, wall).
    impacts : of an orbit that does not settle, at most; twice as many may decide what is left open.
    refine : how often the distance of two values of different class is halved: `.seams`.
    computing : `executor` and `output`, as for `sweep`: the rows of the grid are its cases, and a second run goes on.

    Returns
    -------
    Regions : `.codes`, `.classes`, `.undecided`, `.seams`, or `.values`; `si.plot` draws it.

    Examples
    --------
    >>> model = Oscillator("x", "cos(omega*t)", 0, "1/2", {"omega": 2})
    >>> found = regions(model, ("omega", "restitution"), ((2, 4.5), (0.3, 0.6)), size=(8, 3))
    >>> [name for _, name, _ in found.classes][:2], found.undecided
    (['(1, 2) orbit', '(1, 1) orbit'], 0.0)
    """
    require_model("osc", osc)
    names = tuple(over)
    require(len(names) == 2 and names[0] != names[1], "over", over, "two different numbers of the model")
    osc = reduce(with_number, names, osc)
    require(osc.period is not None, "model", osc, "one with a period")
    if between is None or np.shape(between) != (2, 2):
        raise refuse("between", between, "two intervals, ((low, high), (low, high)), one for each number")
    if not callable(of) and of not in OF:
        raise refuse("of", of, f"{', '.join(OF)}, or a function of a model")
    counts = [whole("size", count, 2, 20_000) for count in (size if np.ndim(size) else (size, size))]
    require_memory("places", (counts[1], counts[0]), 8 * COLUMNS)
    x, y = (
        np.linspace(*window_ends(name, ends), count) for name, ends, count in zip(names, between, counts, strict=True)
    )
    state = as_float(constant("tau", start[0])), as_float(constant("v", start[1])), *(start[2:] or [None])
    job = _Job(osc, names, of, state, whole("impacts", impacts, SETTINGS.block, 10**8))
    job.family(x[:1], y[:1])  # what the model refuses, before anything is computed
    rows = max(1, MEMBERS.held // x.size)
    cases = [(x, y[begin : begin + rows]) for begin in range(0, y.size, rows)]
    strips = in_threads(partial(_strip, job, rows), cases, computing, 1)
    table = np.asarray(strips).reshape(-1, x.size, COLUMNS)[: y.size]
    values = table[..., 4].copy() if of != "period" else None
    seams = _seams(job, (x, y), table[..., :4], whole("refine", refine, 0, 40)) if values is None else np.zeros((0, 2))
    classes, codes = np.unique(table[..., :4].reshape(-1, 4), axis=0, return_inverse=True)
    runs = tuple(_long_run(row, job) for row in classes.tolist())
    name = of if isinstance(of, str) else getattr(of, "__name__", "value")
    return Regions(osc, (names[0], names[1]), x, y, name, runs, codes.reshape(y.size, x.size), values, seams)


@dataclass(frozen=True)
class _Job:
    """The question that is put to each model."""

    osc: Oscillator
    names: tuple[str, ...]
    of: str | Callable[[Oscillator], Any]
    start: tuple[Any, Any, Any]
    impacts: int

    def family(self, x: Array, y: Array) -> OscillatorFamily:
        """Models at places, arrays of one shape."""
        return OscillatorFamily(self.osc, dict(zip(self.names, (x, y), strict=True)))

    def rows(self, x: Array, y: Array) -> Array:
        """`COLUMNS` of places, shape (n, 5)."""
        family = self.family(x, y)
        if callable(self.of):
            return _only(np.array([float(self.of(model)) for model in family]))
        return in_parts(family, self.start, self._measured)[0]

    def _measured(self, *states: Any) -> tuple[Array]:
        if self.of == "period":
            return (_Settling(Lives(*states), self.impacts).rows(),)
        if self.of == "lyapunov":
            return (_only(exponents_of_states(states, SETTINGS.measured, SETTINGS.measured)[0][:, 0]),)
        return (_only(_counted(Lives(*states), str(self.of))),)


def _only(values: Array) -> Array:
    return np.column_stack([np.zeros((values.size, 4)), values])


def _counted(lives: Lives, of: str) -> Array:
    """The share of time at rest, or impacts a period of the forcing, after a transient."""
    for _ in ("transient", "counted"):
        time, count, rested = lives.time(), lives.flown.copy(), lives.resting.copy()
        while (going := np.flatnonzero((lives.status == 0) & (lives.flown < count + SETTINGS.measured))).size:
            lives.advance(SETTINGS.last, going)
    with np.errstate(all="ignore"):
        lasted = lives.time() - time
        if of == "rest":
            return np.where(lives.status == Status.sticks, 1.0, (lives.resting - rested) / lasted)
        return np.where(lives.status != 0, 0.0, (lives.flown - count) / lasted * lives.unit)


def _strip(job: _Job, rows: int, case: tuple[Array, Array]) -> Array:
    """Some rows of the grid, filled up to so many."""
    x, y = case
    places = np.meshgrid(x, y)
    table = np.full((rows, x.size, COLUMNS), np.nan)
    table[: y.size] = job.rows(places[0].ravel(), places[1].ravel()).reshape(y.size, x.size, COLUMNS)
    return table


def _long_run(row: list[float], job: _Job) -> LongRun:
    kind, n, k, word = row
    none = np.zeros(0)
    letters = "" if not word else bin(int(word))[3:].replace("0", "l").replace("1", "u")
    return LongRun(
        KINDS[int(kind)],
        n if kind == ORBIT else np.inf if kind == CHATTER else 0,
        int(k),
        none,
        none,
        SETTINGS.chaos if kind == CHAOS else job.impacts,
        word=letters,
    )


def _seams(job: _Job, axes: tuple[Array, Array], table: Array, refine: int) -> Array:
    """Places between neighbours of different class, halved so often."""
    first, second, classes = unlike_neighbours(axes, table)
    for _ in range(refine if first.size else 0):
        middle = (first + second) / 2
        same = (job.rows(*middle.T)[:, :4] == classes).all(axis=1)
        first[same], second[~same] = middle[same], middle[~same]
    return np.asarray((first + second) / 2)


class _Settling:
    """Orbits, one of each member, on their way to a class."""

    def __init__(self, lives: Lives, impacts: int) -> None:
        self.lives, self.impacts = lives, impacts
        size = lives.which.size
        self.kind, self.n, self.k = np.full(size, -1), np.zeros(size), np.zeros(size)
        self.word, self.fast = np.zeros(size), np.maximum(lives.v, 1e-300)
        # phase, turns and impacts of a former state without velocity
        self.left = np.full((3, size), np.nan)
        # the direction to a neighbour; how often its distance was taken, the growth, and its square
        self.away, self.grown = np.tile([[1.0], [0.0]], size), np.zeros((3, size))

    def rows(self) -> Array:
        """The classes of all."""
        lives = self.lives
        # the first looks come early, the later ones tell longer periods apart
        looks = chain(repeat(SETTINGS.block, 5), repeat(SETTINGS.last))
        for look in count(1):
            going = np.flatnonzero((self.kind < 0) & (lives.flown < self.impacts))
            if not going.size:
                break
            stretch = self._advanced(next(looks), going)
            self._closed(stretch)
            self._ended(going)
            self._dead(going, look)
            self._chaotic(stretch)
        self.kind[self.kind < 0] = NONE
        return np.column_stack([self.kind, self.n, self.k, self.word, 0 * self.n])

    def _advanced(self, count: int, going: Array) -> Stretch:
        stretch = self.lives.advance(count, going)
        speeds = np.where(stretch.real, stretch.rows[..., 1], 0.0).max(axis=1, initial=0.0)
        at = stretch.chosen
        self.fast[at] = np.maximum(self.fast[at] / 2, speeds)
        return stretch

    def _ended(self, going: Array) -> None:
        """Orbits that chatter again and again, rest for ever, or end."""
        lives = self.lives
        again = going[(lives.cycle[going] > 0) & (self.kind[going] < 0)]
        self.kind[again], self.k[again] = CHATTER, lives.cycle[again]
        long = again[lives.between[again] > SETTINGS.certain]
        if long.size:
            self.k[long[~self._repeated(long)]] = 0
        over = going[(lives.status[going] != 0) & (self.kind[going] < 0)]
        self.kind[over] = [ENDS.get(Status(status), STUCK) for status in lives.status[over].tolist()]

    def _dead(self, going: Array, look: int) -> None:
        """Orbits that leave the wall without velocity where they did before (Brent's search for a cycle)."""
        lives = self.lives
        at = going[(lives.v[going] == 0) & (lives.status[going] == 0) & (self.kind[going] < 0)]
        states = np.stack([lives.phase[at], lives.turns[at], lives.flown[at]])
        away, k, n = states - self.left[:, at]
        # of an orbit of one impact that comes from both sides in turn, every second state is nearer
        # some orbits that leave the wall without velocity come to their cycle slowly, and
        near = 1e-8 * np.where(n == 1, 1.0, 1e-2)
        same = (np.abs(away) < near * lives.unit[at]) & (k > 0)
        self.kind[at[same]], self.n[at[same]], self.k[at[same]] = ORBIT, n[same], k[same]
        if look.bit_count() <= 2:
            self.left[:, at] = states

    def _repeated(self, at: Array) -> Array:
        """Whether a neighbour a few roundings away lifts off after as many periods as an orbit did."""
        lives = self.lives
        v = lives.v[at] * (1 + 1e-14)
        other = Lives(lives.members, lives.which[at], lives.phase[at], v, lives.wall[at])
        other.turns, other.lifted = lives.turns[at].copy(), lives.lifted[at].copy()
        while (
            going := np.flatnonzero((other.cycle == 0) & (other.status == 0) & (other.flown < 2 * lives.between[at]))
        ).size:
            other.advance(SETTINGS.last, going)
        return np.asarray(other.cycle == lives.cycle[at])

    def _closed(self, stretch: Stretch) -> None:
        """Orbits whose last impacts are those of some impacts before, and that stay there."""
        whole_ones = np.flatnonzero(stretch.plain & ~stretch.rested)
        at, rows = stretch.chosen[whole_ones], stretch.rows[..., [0, 1, 11]][whole_ones]
        turns = (stretch.begun[0][whole_ones][:, None] + rows[..., 0]) / self.lives.unit[at][:, None]
        speeds = np.where(rows[..., 2] == 1, -rows[..., 1], rows[..., 1]) / self.fast[at][:, None]
        most = min(SETTINGS.period, turns.shape[1] // 3)
        gone = turns[:, -1:] - turns[:, -2 : -2 - most : -1]
        beside = (np.abs(speeds[:, -1:] - speeds[:, -2 : -2 - most : -1]) < SETTINGS.beside) & (np.rint(gone) > 0)
        beside &= np.abs(gone - np.rint(gone)) < SETTINGS.beside
        periods = np.zeros(at.size, np.int64)
        for n in (np.flatnonzero(beside.any(axis=0)) + 1).tolist():
            near = np.flatnonzero(beside[:, n - 1] & (periods == 0))
            near = near[_comes_there(turns[near], speeds[near], n)]
            for m in (m for m in range(n, 0, -1) if n % m == 0):  # the least period: others close too
                gaps = np.abs(_gaps(turns[near], speeds[near], m)[..., -n:]).max(axis=(0, 2))
                periods[near[(gaps < SETTINGS.same) | (m == n)]] = m
        places = np.flatnonzero(periods)
        if not places.size:
            return
        periods = periods[places]
        k = np.rint(turns[places, -1] - turns[places, -1 - periods])
        if self.lives.members.two_walls:
            sides = speeds * np.where(stretch.begun[3][whole_ones] == 1, -1.0, 1.0)[:, None]
            words = [_word(sides[at_row, -n:] < 0) for at_row, n in zip(places.tolist(), periods.tolist(), strict=True)]
        else:
            words = [0] * places.size
        stays = self._stays(at[places], periods)
        chosen = at[places][stays]
        self.kind[chosen], self.n[chosen], self.k[chosen] = ORBIT, periods[stays], k[stays]
        self.word[chosen] = np.array(words)[stays]

    def _stays(self, at: Array, n: Array) -> Array:
        """Whether orbits are where they were after some more turns: beside a saddle they have left it."""
        lives = self.lives
        phase, v = lives.phase[at].copy(), lives.v[at].copy()
        # impacts after which an orbit is still there
        self._advanced(n * -(-16 // n), at)
        gone = (lives.phase[at] - phase) / lives.unit[at]
        away = np.maximum(np.abs(gone - np.rint(gone)), np.abs(lives.v[at] - v) / self.fast[at])
        return np.asarray((away < 2 * SETTINGS.near) & (lives.status[at] == 0))

    def _chaotic(self, stretch: Stretch) -> None:
        """Orbits that have not settled and whose neighbours separate (Benettin et al. 1980)."""
        lives, late = self.lives, self.lives.flown[stretch.chosen] > SETTINGS.chaos
        whole_ones = np.flatnonzero(stretch.plain & ~stretch.rested & late & (self.kind[stretch.chosen] < 0))
        at, rows = stretch.chosen[whole_ones], stretch.rows[whole_ones]
        unit, (phase, turns, v, wall) = lives.unit[at], (column[whole_ones] for column in stretch.begun)
        scale = SETTINGS.apart * np.stack([unit, self.fast[at]])
        step = self.away[:, at] * scale
        other = Lives(lives.members, lives.which[at], phase + step[0], np.abs(v + step[1]), wall)
        for last in range(SETTINGS.steps - 1, rows.shape[1], SETTINGS.steps):
            other.advance(SETTINGS.steps)
            there, speed = phase + rows[:, last, 0], rows[:, last, 1]
            gone = (other.phase - there) / unit
            off = np.stack([gone - np.rint(gone), (other.v - speed) / self.fast[at]]) / SETTINGS.apart
            size = np.hypot(*off)
            flies = (other.status == 0) & (other.wall == wall ^ (rows[:, last, 11] == 1)) & (size > 0)
            size = np.where(flies, size, 1.0)
            self.grown[:, at] += np.where(flies, [np.ones(at.size), np.log(size), np.log(size) ** 2], 0.0)
            self.away[:, at] = np.where(flies, off / size, self.away[:, at])
            step = self.away[:, at] * scale
            other.phase, other.turns = other.split(there + step[0], 0 * turns)
            other.v, other.wall = np.maximum(speed + step[1], speed / 2), wall ^ (rows[:, last, 11] == 1)
            other.status[:] = 0
        count, total, square = self.grown[:, at]
        with np.errstate(all="ignore"):
            mean = total / count
            error = np.sqrt(np.maximum(square / count - mean**2, 0.0) / count)
            least = np.maximum(SETTINGS.least * SETTINGS.steps, SETTINGS.sure * error)
        # so many distances are taken at least
        self.kind[at[(count >= 6) & (mean > least)]] = CHAOS


def _gaps(turns: Array, speeds: Array, n: int) -> Array:
    """Differences of states from those n impacts before, in turns and in velocity."""
    gone = turns[:, n:] - turns[:, :-n]
    return np.stack([gone - np.rint(gone), speeds[:, n:] - speeds[:, :-n]])


def _comes_there(turns: Array, speeds: Array, n: int) -> Array:
    """Whether the distances of states from those n impacts before fall like a geometric sequence whose sum is short."""
    off = _gaps(turns, speeds, n)
    last, before = off[..., -n:], off[..., -2 * n : -n]
    size = np.abs(last).max(axis=(0, 2))
    with np.errstate(all="ignore"):
        # the multiplier that the distance shows, negative where orbits come from both sides in turn
        ratio = (last * before).sum(axis=(0, 2)) / (before * before).sum(axis=(0, 2))
        falls = (last * last).sum(axis=(0, 2)) < (before * before).sum(axis=(0, 2))
        return np.asarray((size < SETTINGS.rounding) | (falls & (size / (1 - ratio) < SETTINGS.near)))


def _word(upper: Array) -> int:
    """The least rotation of the walls of an orbit's impacts, as bits below a leading 1; 0 of a long one."""
    # the longest word that is kept
    if upper.size > 48:
        return 0
    bits = "".join("01"[int(side)] for side in upper.tolist())
    return int("1" + min(bits[i:] + bits[:i] for i in range(len(bits))), 2)
