"""Basins: the attractor of each state of a grid: an (n, k) orbit, a limit cycle, repeated chatter, rest, chaos."""

from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import log
from typing import Any, ClassVar, NamedTuple

import numpy as np

from singimpact.algebra.numbers import Array, as_float, float_array
from singimpact.cases import in_threads
from singimpact.dynamics import attractors as kinds
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
    def decided(self) -> Array:
        """Whether each class is one of states whose future is known."""
        return np.array([run.kind not in ("not decided", "unresolved", "sensitive") for run in self.attractors])

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

    def uncertainty(
        self, distances: Any = None, pairs: int = 2000, impacts: int = SETTINGS.impacts, seed: int = 0, **computing: Any
    ) -> "Uncertainty":
        """The uncertainty exponent of the boundaries of the basins, from pairs of states that are flown anew.

        Parameters
        ----------
        distances : of the states of a pair, in sides of the window, between 0 and 1; seven from 3e-4 to 3e-2 without
            it. pairs : at each distance, drawn evenly from the window by a numpy generator with the `seed`, in all
            directions. impacts : at most, of an orbit that does not settle. computing : `executor`,
            `output` of `sweep`.

        Returns
        -------
        Uncertainty : `.exponent` and its `.error`, `.dimension`; nan where `.doubt` says why. Pairs count whose states
            are both decided.

        Examples
        --------
        >>> found = basins(Oscillator("x", "cos(2*t)", "0.7", "1/2"), v=(0, 1), size=4)
        >>> found.uncertainty(pairs=20).doubt
        'no exponent: 0 distances have 5 uncertain pairs, give more pairs or other distances'
        """
        sizes = np.geomspace(3e-4, 3e-2, 7) if distances is None else float_array("distances", distances).ravel()
        if np.unique(sizes).size < 3 or not ((sizes > 0) & (sizes < 1)).all():
            raise refuse("distances", distances, "three numbers or more between 0 and 1, in sides of the window")
        shape = 2, sizes.size, whole("pairs", pairs, 1, 10**7)
        rng = np.random.default_rng(seed)
        angles = 2 * np.pi * rng.random(shape[1:])
        halves = sizes[:, None] / 2 * np.array([np.cos(angles), np.sin(angles)])
        middles = np.abs(halves) + rng.random(shape) * (1 - 2 * np.abs(halves))
        places = np.concatenate([middles - halves, middles + halves], axis=1).reshape(2, -1)
        ends = [(float(values[0]), float(values[-1])) for _, values in self.sides]
        study, states = placed(self.model, (ends[0], ends[1]), places, self.wall, impacts)
        attractors, codes = named(study, for_ever(study, states, _classes(study, states, pairs, computing))[0])
        decided = replace(self, attractors=attractors).decided[codes].reshape(shape).all(axis=0)
        unlike = np.not_equal(*codes.reshape(shape)) & decided
        return uncertainty_of(sizes, decided.sum(axis=1), unlike.sum(axis=1))

    def entropy(self, box: int = 5) -> "BasinEntropy":
        """The basin entropy of boxes of the grid, and that of the boxes with several attractors.

        Parameters
        ----------
        box : states on the side of a box. States that are not decided are left out.

        Returns
        -------
        BasinEntropy : `.entropy`, `.boundary`, in natural units; above ln 2 the second one shows a fractal boundary.

        Examples
        --------
        >>> basins(Oscillator("x", "cos(2*t)", "0.7", "1/2"), v=(0, 1), size=4).entropy(2).entropy
        0.0
        """
        return entropy_of(self.codes, self.decided, whole("box", box, 1, min(self.codes.shape)))


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
    side = checked_wall(model, wall)
    if isinstance(size, bool) or not isinstance(size, int) or not 2 <= size <= 10_000:
        raise refuse("size", size, "an integer from 2 to 10000")
    middles = np.arange(size) + 0.5
    study, (times, speeds) = placed(model, (tau, v), (middles, middles), side, impacts, size)
    signed_iterate(model, times[:1], speeds[-1:], 1)  # compiled here once, and not by every worker of a pool
    tau, v = (coordinates.ravel() for coordinates in np.meshgrid(times, speeds))
    table = _classes(study, (tau, v), size, {"executor": executor, "output": output})
    table, first = for_ever(study, (tau, v), table)
    attractors, codes = named(study, table)
    walls = None if model.upper is None or model.autonomous else side[()]
    return (Basins if study.phases.clocked else StartBasins)(
        model,
        times,
        -speeds if side else speeds,
        attractors,
        codes.reshape(size, size),
        first.reshape(size, size),
        walls,
    )


def checked_wall(model: Oscillator, wall: Any) -> Array:
    """The code of the wall of all states of a model that has basins."""
    require_model("model", model)
    if model.period is None and not oscillates(model.force(), model.forcing()):
        raise refuse("model", model, "one with a period, without t, or with sums of waves in t")
    side = wall_codes(model, wall)
    if side.shape or (model.autonomous and wall is not None):
        raise refuse("wall", wall, "one wall, that of all states; none for a model without t, whose starts lie off it")
    return side


def for_ever(study: Study, states: tuple[Array, Array], table: Array) -> tuple[Array, Array]:
    """Rows of what states do for ever, shape (n, 3), and whether their first chatters complete, shape (n,).

    Parameters
    ----------
    table : of `classify`, shape (n, 5).
    """
    (tau, v), table, flown, first = states, table[:, :3], table[:, 3], table[:, 4] > 0
    doubtful = set[tuple[float, ...]]()
    follows = futures(study.model, study.lift_offs, partial(_after_lift_off, study, doubtful))
    for index in range(len(study.lift_offs)):
        table[first & (table[:, 1] == index)] = settled(follows, index, study.phases.unit)
    if _several(study, table[settles(table)]):
        table[[row in doubtful for row in map(tuple, table.tolist())]] = kinds.SENSITIVE, 0.0, 0.0
    if not study.phases.repeats:
        table = confirmed(study, table)
    late = _open_to_rounding(study, table, flown)
    table[late[parted(study, tau[late], v[late], flown[late])]] = kinds.SENSITIVE, 0.0, 0.0
    if not study.phases.clocked:
        cycles = np.flatnonzero(table[:, 0] >= kinds.PLACES)
        several, which = np.unique(table[cycles][:, [0, 2]], axis=0, return_inverse=True)
        level = kinds.neutral(study.model, several[:, 0].astype(np.int64) // kinds.PLACES, several[:, 1])[which.ravel()]
        table[cycles[level]] = kinds.LEVEL, 0.0, 0.0
    return table, first


def placed(
    model: Oscillator, window: Sequence[Any], places: Iterable[Array], side: Any, impacts: int, parts: int = 1
) -> tuple[Study, tuple[Array, Array]]:
    """The study of a window, and its states at places, two arrays, in so many parts of its sides."""
    ((low, high), (slow, fast)), (across, up) = _window(model, *window), places
    speeds = slow + up * (fast - slow) / parts
    study = Study(model, lift_offs_of_walls(model), max(-slow, fast), whole("impacts", impacts, 1, 10**7), high)
    return study, (low + across * (high - low) / parts, -speeds if side else speeds)


def _window(model: Oscillator, tau: Any, v: Any) -> tuple[tuple[float, float], tuple[float, float]]:
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


Case = tuple[dict[str, Any], tuple[Any, float, int, float], tuple[tuple[float, ...], ...]]


def case_of(study: Study, states: Sequence[Array]) -> Case:
    """States as a case of a sweep: fields of the model, those of the study, tau and v."""
    described = study.lift_offs, study.fast, study.impacts, study.start
    return dict(study.model.to_dict()), described, tuple(tuple(column.tolist()) for column in states)


def classified(case: Case) -> Array:
    """`classify` of some states. A module-level function, so that it can be pickled."""
    fields, described, states = case
    study = Study(Oscillator(**fields), *described)
    return (classify if study.phases.repeats else responses)(study, np.array(states[0]), np.array(states[1]))


def _classes(study: Study, states: tuple[Array, Array], size: int, computing: dict[str, Any]) -> Array:
    """The rows of `classify` of states, some rows of the grid in a case."""
    tau, v = states
    wanted, count = max(SETTINGS.states, tau.size / SETTINGS.cases), tau.size // size
    # whole rows, and as many in each case
    rows = [n for n in range(1, count + 1) if count % n == 0]
    long = size * min(rows, key=lambda n: abs(log(n * size / wanted)))
    cases = [case_of(study, (tau[i : i + long], v[i : i + long])) for i in range(0, tau.size, long)]
    return np.concatenate([np.asarray(block) for block in in_threads(classified, cases, computing)])


def _open_to_rounding(study: Study, table: Array, flown: Array) -> Array:
    """Indices of states that settle late, where there is more than one attractor to settle on."""
    settled = settles(table)
    if not (study.phases.clocked and study.phases.repeats) or not _several(study, table[settled]):
        return np.zeros(0, dtype=np.int64)
    return np.flatnonzero(settled & (flown > SETTLING.sensitive))


def _several(study: Study, rows: Array) -> bool:
    """Whether rows of settled states are of more than one attractor."""
    return np.unique(named(study, rows)[1]).size > 1


def _after_lift_off(study: Study, doubtful: set[tuple[float, ...]], tau: Array, v: Array) -> Array:
    """`classify` of the first state after a lift-off; SENSITIVE where rounding decides when chatter comes again.

    Rows of other attractors that rounding decides are added to `doubtful`.
    """
    table = classify(study, tau, v)
    rows, flown = table[:, :3], table[:, 3]
    late = np.flatnonzero(settles(rows) & (flown > SETTLING.sensitive))
    late = late[parted(study, tau[late], v[late], flown[late])]
    doubtful.update(map(tuple, rows[late].tolist()))
    rows[late[rows[late, 0] == kinds.CHATTER]] = kinds.SENSITIVE, 0.0, 0.0
    return rows


def named(study: Study, rows: Array) -> tuple[tuple[LongRun, ...], Array]:
    """The classes that occur, and the index of each row among them; rows near one orbit are one class."""
    classes, codes, left = list[LongRun](), np.full(len(rows), -1), np.ones(len(rows), dtype=bool)
    while left.any():
        first = np.flatnonzero(left)[0]
        code, tau, v = rows[first].tolist()
        classes.append(behaviour(study, rows[first]))
        same = left & (rows[:, 0] == code)
        if code >= kinds.PLACES:
            orbit = kinds.Attractor(int(code), classes[-1].tau, classes[-1].v, SETTINGS.same)
            same &= kinds.within(orbit, study.model, rows[:, 1], rows[:, 2], study.fast, SETTINGS.same)
            same[first] = True
        elif code in (kinds.CYCLE, kinds.STILL):
            same &= np.abs(rows[:, 1] - tau) <= SETTINGS.same * tau
            same &= np.abs(rows[:, 2] - v) <= SETTINGS.same * max(v, abs(as_float(study.model.clearance)))
        elif code in (kinds.CHATTER, kinds.RESPONSE, kinds.RESTING):
            same &= (rows[:, 1] == tau) & ((code == kinds.CHATTER) | (rows[:, 2] == v))
        codes[same], left = len(classes) - 1, left & ~same
    return tuple(classes), codes


# Uncertain pairs of a distance that is seen, and such distances that the fit needs
LEAST, FEWEST = 5, 3


@dataclass(frozen=True, repr=False)
class Uncertainty(Result):
    """The uncertainty exponent: the share of uncertain pairs is proportional to the distance to this power.

    Attributes
    ----------
    distances : of the two states of a pair, in sides of the window, shape (m,). pairs : whose states are both decided.
    uncertain : those of them that go to two attractors.
    exponent, error : 1 of a smooth boundary, less of a fractal one, whose dimension is 2 - exponent; and its standard
        error. Both are nan where `doubt` says why, and what to give.
    """

    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = dict.fromkeys(
        ("distances", "pairs", "uncertain"), ("distances",)
    )
    distances: Array
    pairs: Array
    uncertain: Array
    exponent: float
    error: float
    doubt: str = ""

    def __repr__(self) -> str:
        shown = self.doubt or f"{self.exponent:.3g} +- {self.error:.1g}"
        return f"Uncertainty({shown}; {int(self.pairs.sum())} pairs at {self.distances.size} distances)"


def uncertainty_of(distances: Array, pairs: Array, uncertain: Array) -> Uncertainty:
    """The exponent of greatest likelihood, with binomial counts; its error grows where no power fits them.

    Parameters
    ----------
    distances, pairs, uncertain : as in `Uncertainty`, shape (m,).

    Examples
    --------
    >>> uncertainty_of(np.array([0.01, 0.02, 0.04]), np.full(3, 1000), np.array([20, 40, 80]))
    Uncertainty(1 +- 0.2; 3000 pairs at 3 distances)
    """
    counts = distances, pairs, uncertain
    seen = np.count_nonzero((uncertain >= LEAST) & (uncertain < pairs))
    if seen < FEWEST:
        words = f"no exponent: {seen} distances have {LEAST} uncertain pairs, give more pairs or other distances"
        return Uncertainty(*counts, np.nan, np.nan, words)
    terms, share = np.stack([np.ones(pairs.size), np.log(distances)]), (uncertain + 0.5) / (pairs + 1)
    for _ in range(50):  # Fisher's scoring
        weights = terms * (pairs * share / (1 - share))
        covariance = np.linalg.inv(weights @ terms.T)
        line = covariance @ weights @ (np.log(share) + (uncertain / np.maximum(pairs, 1) - share) / share)
        share = np.minimum(np.exp(line @ terms), 0.99)
    misfit = np.sum((uncertain - pairs * share) ** 2 / (np.maximum(pairs, 1) * share * (1 - share)))
    worse = max(float(misfit) / (pairs.size - 2), 1.0)
    return Uncertainty(*counts, float(line[1]), float(np.sqrt(covariance[1, 1] * worse)))


class BasinEntropy(NamedTuple):
    """Entropies of boxes of a grid of basins.

    Parameters
    ----------
    entropy : the mean over all boxes of -sum p ln p, p the shares of the attractors in a box. boundary : the mean over
        the boxes with several attractors; above ln 2 the boundary is fractal, below it may be; nan without such boxes.
    boxes, mixed : how many there are with decided states, and with several attractors.
    """

    entropy: float
    boundary: float
    boxes: int
    mixed: int


def entropy_of(codes: Array, decided: Array, box: int) -> "BasinEntropy":
    """Basin entropy and boundary basin entropy.

    Parameters
    ----------
    codes : of the classes of a grid, shape (rows, columns). decided : of each class, whether its states count.
    box : states on the side of a box; what is left over at the ends of the grid is left out.

    Examples
    --------
    >>> entropy_of(np.array([[0, 0, 0, 1], [0, 0, 0, 1]]), np.array([True, True]), 2)
    BasinEntropy(entropy=0.34657359027997264, boundary=0.6931471805599453, boxes=2, mixed=1)
    """
    rows, columns = (size // box for size in codes.shape)
    cells = codes[: rows * box, : columns * box].reshape(rows, box, columns, box).swapaxes(1, 2)
    counts = np.array([(cells == code).sum(axis=(2, 3)).ravel() for code in np.flatnonzero(decided).tolist()])
    counts = counts[:, counts.sum(axis=0) > 0]
    shares = counts / counts.sum(axis=0)
    entropies = -np.sum(shares * np.log(np.where(shares > 0, shares, 1.0)), axis=0)
    mixed = entropies[(counts > 0).sum(axis=0) > 1]
    mean, between = (float(values.mean()) if values.size else np.nan for values in (entropies, mixed))
    return BasinEntropy(mean, between, entropies.size, mixed.size)
