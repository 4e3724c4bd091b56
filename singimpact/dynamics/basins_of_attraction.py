"""Basins: the attractor of each state of a grid: an (n, k) orbit, a limit cycle, repeated chatter, rest, chaos."""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from math import log
from typing import Any, ClassVar

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.cases import in_threads
from singimpact.dynamics.attractors import (
    CHATTER,
    CYCLE,
    LEVEL,
    PLACES,
    RESPONSE,
    RESTING,
    SENSITIVE,
    STILL,
    Attractor,
    neutral,
    within,
)
from singimpact.dynamics.behaviours import LongRun, behaviour
from singimpact.dynamics.long_run import futures, lift_offs_of_walls, settled
from singimpact.dynamics.phases import phases_of
from singimpact.dynamics.settling import SETTINGS as SETTLING, Study, classify, parted, settles
from singimpact.dynamics.synchrony import confirmed, responses
from singimpact.flights.orbits import signed_iterate
from singimpact.flights.walls import wall_codes
from singimpact.inputs import refuse, whole
from singimpact.oscillator.model import Oscillator, require_model
from singimpact.oscillator.period import oscillates
from singimpact.result import Result
from singimpact.surface.curve import window_ends


@dataclass(frozen=True)
class BasinSettings:
    """Sizes of blocks, and when two orbits are one."""

    # of the grid, together in a case: at most so many cases where there are so many states; fewer states leave lanes of
    # a batch idle while the last of them settle
    cases: int = 64
    states: int = 2500
    same: float = 1e-3  # relative distance below which two periodic orbits are one
    impacts: int = 20_000  # at most, of an orbit that does not settle


SETTINGS = BasinSettings()


class ClassGrid(Result):
    """A grid of places, each of one of some classes of long-term behaviour: `attractors`, and `codes` of the places."""

    attractors: tuple[LongRun, ...]
    codes: Array

    @property
    @abstractmethod
    def sides(self) -> tuple[tuple[str, Array], tuple[str, Array]]:
        """Names and values of both axes; the second is the first axis of `codes`."""

    @property
    def classes(self) -> list[tuple[int, str, float]]:
        """Code, name and share of the classes, the largest first.

        Orbits of equal (n, k) are named with their v, and numbered where these are equal too.
        """
        counts = np.bincount(self.codes.ravel(), minlength=len(self.attractors))
        order = np.argsort(-counts, kind="stable")
        plain = [run.name for run in self.attractors]
        names = [
            f"{name}, v to {run.v.max():.4g}" if plain.count(name) > 1 and run.v.size else name
            for name, run in zip(plain, self.attractors, strict=True)
        ]
        numbered = [
            f"{name}, number {names[: i + 1].count(name)}" if names.count(name) > 1 else name
            for i, name in enumerate(names)
        ]
        return [(int(i), numbered[i], float(counts[i]) / self.codes.size) for i in order]

    @property
    def boundary(self) -> Array:
        """Places half way between neighbours of two classes, shape (m, 2)."""
        first, second, _ = unlike_neighbours((self.sides[0][1], self.sides[1][1]), self.codes[..., None])
        return (first + second) / 2

    @property
    def shares(self) -> str:
        """The largest classes and their shares, in words."""
        shares = ", ".join(f"{name} {100 * share:.3g} %" for _, name, share in self.classes[:4])
        return f"{shares}, and {len(self.classes) - 4} more" if len(self.classes) > 4 else shares

    @property
    def named_codes(self) -> dict[str, Any]:
        """For each place the name of its class; the shares."""
        names = np.array([name for _, name, _ in sorted(self.classes)], dtype=object)
        return {
            "class": names[self.codes],
            "classes": [{"class": name, "share": share} for _, name, share in self.classes],
        }


def unlike_neighbours(axes: tuple[Array, Array], table: Array) -> tuple[Array, Array, Array]:
    """Neighbours of a grid whose rows differ: places of both, shape (m, 2), and the row of the first.

    Parameters
    ----------
    axes : x and y. table : rows, shape (len(y), len(x), columns).

    Examples
    --------
    >>> unlike_neighbours((np.array([0.0, 1.0]), np.zeros(1)), np.array([[[3], [4]]]))[1].tolist()
    [[1.0, 0.0]]
    """
    x, y = np.meshgrid(*axes)
    pairs = []
    for low, high in ((np.s_[:, :-1], np.s_[:, 1:]), (np.s_[:-1], np.s_[1:])):
        differs = (table[low] != table[high]).any(axis=-1)
        ends = [np.stack([x[end][differs], y[end][differs]], axis=1) for end in (low, high)]
        pairs.append((*ends, table[low][differs]))
    first, second, rows = (np.concatenate(column) for column in zip(*pairs, strict=True))
    return first, second, rows


@dataclass(frozen=True)
class Basins(ClassGrid):
    """The attractors of a grid of states.

    Attributes
    ----------
    tau, v : the axes. attractors : the classes that occur. codes : shape (len(v), len(tau)), indices into `attractors`.
    first_chatter_completes : of the same shape, bool: the first chatter of the orbit completes.
    wall : of the states of a model with two walls; None of others.
    """

    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "tau": ("tau",),
        "v": ("v",),
        "class": ("v", "tau"),
        "first_chatter_completes": ("v", "tau"),
    }
    coordinates: ClassVar[tuple[str, str]] = ("tau", "v")
    model: Oscillator
    tau: Array
    v: Array
    attractors: tuple[LongRun, ...]
    codes: Array
    first_chatter_completes: Array
    wall: Any = None

    @property
    def sides(self) -> tuple[tuple[str, Array], tuple[str, Array]]:
        """Names and values of both axes."""
        return (self.coordinates[0], self.tau), (self.coordinates[1], self.v)

    def __repr__(self) -> str:
        return f"Basins({self.tau.size} x {self.v.size} states: {self.shares})"

    def as_dict(self) -> dict[str, Any]:
        """The axes, for each state the class and whether the first chatter completes, 0 or 1; the shares."""
        named = self.named_codes
        first = {"class": named.pop("class"), "first_chatter_completes": self.first_chatter_completes.astype(int)}
        return dict(self.sides) | first | named


@dataclass(frozen=True, repr=False)
class StartBasins(Basins):
    """The attractors of a grid of starts (x, x') of a model without t.

    Attributes
    ----------
    x, xdot : the axes, also as `tau` and `v`; the others as in `Basins`.
    """

    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "x": ("x",),
        "xdot": ("xdot",),
        "class": ("xdot", "x"),
        "first_chatter_completes": ("xdot", "x"),
    }
    coordinates: ClassVar[tuple[str, str]] = ("x", "xdot")

    @property
    def x(self) -> Array:
        """x of the starts."""
        return self.tau

    @property
    def xdot(self) -> Array:
        """x' of the starts."""
        return self.v


def basins(
    model: Oscillator,
    tau: Any = None,
    v: Any = None,
    size: int = 600,
    executor: Any = None,
    output: Any = None,
    impacts: int = SETTINGS.impacts,
    wall: Any = None,
) -> Basins:
    """Classes of size x size states.

    Parameters
    ----------
    model : periodic, without t, or with sums of waves in t. tau, v : ends of the window; one period of tau when it is
        not given, a turn of the fastest wave where there is none; v > 0 is looked at, from 0 to 2 when it is not given.
        Of a model without t they are those of x and x'.
    size : states a side. executor, output : as for `sweep`, where some rows are a case; threads without it, for flights
        of arrays run side by side in one process. impacts : at most, of an orbit that does not settle. wall : of the
        states of a model with two walls: "lower" (also without it) or "upper".

    Raises
    ------
    InputError : a model with t and without a period, a window or a size that is none.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(1) as pool:
    ...     found = basins(Oscillator("x", "cos(2*t)", "0.7", "1/2"), v=(0, 1), size=16, executor=pool)
    >>> found.codes.shape, found.classes[0][1]
    ((16, 16), '(inf, 1) chatter for ever')
    """
    require_model("model", model)
    if model.period is None and not oscillates(model.force(), model.forcing()):
        raise refuse("model", model, "one with a period, without t, or with sums of waves in t")
    side = wall_codes(model, wall)
    if side.shape or (model.autonomous and wall is not None):
        raise refuse("wall", wall, "one wall, that of all states; none for a model without t, whose starts lie off it")
    if isinstance(size, bool) or not isinstance(size, int) or not 2 <= size <= 10_000:
        raise refuse("size", size, "an integer from 2 to 10000")
    (low, high), (slow, fast) = _window(model, tau, v)
    times = low + (np.arange(size) + 0.5) * (high - low) / size
    speeds = slow + (np.arange(size) + 0.5) * (fast - slow) / size
    signed_iterate(model, times[:1], speeds[-1:], 1)  # compiled here once, and not by every worker of a pool
    study = Study(model, lift_offs_of_walls(model), max(-slow, fast), whole("impacts", impacts, 1, 10**7), high)
    tau, v = (coordinates.ravel() for coordinates in np.meshgrid(times, -speeds if side else speeds))
    table = _classes(study, (tau, v), size, {"executor": executor, "output": output})
    table, flown, first = table[:, :3], table[:, 3], table[:, 4] > 0
    doubtful = set[tuple[float, ...]]()
    follows = futures(model, study.lift_offs, partial(_after_lift_off, study, doubtful))
    for index in range(len(study.lift_offs)):
        table[first & (table[:, 1] == index)] = settled(follows, index, study.phases.unit)
    if _several(study, table[settles(table)]):
        table[[row in doubtful for row in map(tuple, table.tolist())]] = SENSITIVE, 0.0, 0.0
    if not study.phases.repeats:
        table = confirmed(study, table)
    late = _open_to_rounding(study, table, flown)
    table[late[parted(study, tau[late], v[late], flown[late])]] = SENSITIVE, 0.0, 0.0
    if not study.phases.clocked:
        cycles = np.flatnonzero(table[:, 0] >= PLACES)
        several, which = np.unique(table[cycles][:, [0, 2]], axis=0, return_inverse=True)
        level = neutral(model, several[:, 0].astype(np.int64) // PLACES, several[:, 1])[which.ravel()]
        table[cycles[level]] = LEVEL, 0.0, 0.0
    attractors, codes = _named(study, table)
    walls = None if model.upper is None or model.autonomous else side[()]
    return (Basins if study.phases.clocked else StartBasins)(
        model, times, speeds, attractors, codes.reshape(size, size), first.reshape(size, size), walls
    )


def _window(model: Oscillator, tau: Any, v: Any) -> tuple[tuple[float, float], tuple[float, float]]:
    """The ends of both axes of a window."""
    if not phases_of(model).clocked:
        wall = as_float(model.clearance)
        above = np.inf if model.upper is None else as_float(model.upper)
        low, high = (wall, min(wall + 2 * max(abs(wall), 1.0), above)) if tau is None else window_ends("x", tau)
        if low < wall or high > above:
            raise refuse("window of x", tau, f"two numbers from the wall on, x >= {model.clearance}, to an upper one")
        return (low, high), window_ends("xdot", (-2, 2) if v is None else v)
    ends = (0.0, phases_of(model).unit) if tau is None else window_ends("tau", tau)
    slow, fast = window_ends("v", (0, 2) if v is None else v)
    if slow < 0:
        raise refuse("window of v", v, "two numbers >= 0, the lower end first")
    return ends, (slow, fast)


def classified(
    fields: Mapping[str, Any], study: tuple[Any, float, int, float], states: tuple[tuple[float, ...], ...]
) -> Array:
    """`classify` of some states. A module-level function, so that it can be pickled."""
    several = Study(Oscillator(**fields), *study)
    tau, v = np.array(states[0]), np.array(states[1])
    return (classify if several.phases.repeats else responses)(several, tau, v)


def _classes(study: Study, states: tuple[Array, Array], size: int, computing: dict[str, Any]) -> Array:
    """The rows of `classify` of states, some rows of the grid in a case."""
    tau, v = states
    wanted = max(SETTINGS.states, size * size / SETTINGS.cases)
    # whole rows, and as many in each case
    rows = [n for n in range(1, size + 1) if size % n == 0]
    long = size * min(rows, key=lambda n: abs(log(n * size / wanted)))
    cases = [(tuple(tau[i : i + long].tolist()), tuple(v[i : i + long].tolist())) for i in range(0, tau.size, long)]
    work = partial(classified, dict(study.model.to_dict()), (study.lift_offs, study.fast, study.impacts, study.start))
    return np.concatenate([np.asarray(block) for block in in_threads(work, cases, computing)])


def _open_to_rounding(study: Study, table: Array, flown: Array) -> Array:
    """Indices of states that settle late, where there is more than one attractor to settle on."""
    settled = settles(table)
    if not (study.phases.clocked and study.phases.repeats) or not _several(study, table[settled]):
        return np.zeros(0, dtype=np.int64)
    return np.flatnonzero(settled & (flown > SETTLING.sensitive))


def _several(study: Study, rows: Array) -> bool:
    """Whether rows of settled states are of more than one attractor."""
    return np.unique(_named(study, rows)[1]).size > 1


def _after_lift_off(study: Study, doubtful: set[tuple[float, ...]], tau: Array, v: Array) -> Array:
    """`classify` of the first state after a lift-off; SENSITIVE where rounding decides when chatter comes again.

    Rows of other attractors that rounding decides are added to `doubtful`.
    """
    table = classify(study, tau, v)
    rows, flown = table[:, :3], table[:, 3]
    late = np.flatnonzero(settles(rows) & (flown > SETTLING.sensitive))
    late = late[parted(study, tau[late], v[late], flown[late])]
    doubtful.update(map(tuple, rows[late].tolist()))
    rows[late[rows[late, 0] == CHATTER]] = SENSITIVE, 0.0, 0.0
    return rows


def _named(study: Study, rows: Array) -> tuple[tuple[LongRun, ...], Array]:
    """The classes that occur, and the index of each row among them; rows near one orbit are one class."""
    classes, codes, left = list[LongRun](), np.full(len(rows), -1), np.ones(len(rows), dtype=bool)
    while left.any():
        first = np.flatnonzero(left)[0]
        code, tau, v = rows[first].tolist()
        classes.append(behaviour(study, rows[first]))
        same = left & (rows[:, 0] == code)
        if code >= PLACES:
            orbit = Attractor(int(code), classes[-1].tau, classes[-1].v, SETTINGS.same)
            same &= within(orbit, study.model, rows[:, 1], rows[:, 2], study.fast, SETTINGS.same)
            same[first] = True
        elif code in (CYCLE, STILL):
            same &= np.abs(rows[:, 1] - tau) <= SETTINGS.same * tau
            same &= np.abs(rows[:, 2] - v) <= SETTINGS.same * max(v, abs(as_float(study.model.clearance)))
        elif code in (CHATTER, RESPONSE, RESTING):
            same &= (rows[:, 1] == tau) & ((code == CHATTER) | (rows[:, 2] == v))
        codes[same], left = len(classes) - 1, left & ~same
    return tuple(classes), codes
