"""Basins: the attractor of each state of a grid: an (n, k) orbit, repeated chatter, rest, chaos."""

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial
from math import log
from typing import Any, ClassVar

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.case_pools import ThreadPool
from singimpact.cases import sweep
from singimpact.dynamics.attractors import (
    AWAY,
    CHAOS,
    CHATTER,
    GONE,
    OTHER,
    PLACES,
    SENSITIVE,
    STUCK,
    Attractor,
    states_of,
    within,
)
from singimpact.dynamics.long_run import futures, lift_offs, settled
from singimpact.dynamics.settling import SETTINGS as SETTLING, Study, classified, classify, parted, settles
from singimpact.flights.horizons import horizon_of
from singimpact.flights.orbits import iterate
from singimpact.inputs import refuse, whole
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result
from singimpact.surface.curve import window_ends


@dataclass(frozen=True)
class BasinSettings:
    """Sizes of blocks, and when two orbits are one."""

    # of the grid, together in a case: at most so many cases where there are so many states; fewer states leave lanes of
    # a batch idle while the last of them settle
    cases: int = 64
    states: int = 1250
    same: float = 1e-3  # relative distance below which two periodic orbits are one
    impacts: int = 20_000  # at most, of an orbit that does not settle


SETTINGS = BasinSettings()
KINDS = {
    OTHER: "not decided",
    CHAOS: "chaotic",
    GONE: "never returns",
    AWAY: "no impact",
    STUCK: "unresolved",
    SENSITIVE: "sensitive",
}


@dataclass(frozen=True)
class LongRun:
    """An attractor, or another long-term behaviour.

    Attributes
    ----------
    kind : "orbit"; "chatter" (it completes again and again); "rest"; "chaotic" (no period within `impacts`, and
        neighbours separate); "not decided" (no period, and they do not); "sensitive" (there are several attractors, or
        chatter comes again after more than 60 impacts, and a neighbour 1e-15 away parts from the orbit: more than
        doubles would decide); "no impact" (none within
        `horizon`); "never returns" (proved); "unresolved" (a flight is: `osc.orbit` says which).
    n, k : impacts (inf for chatter) in k periods, of an orbit or of chatter; 0 otherwise.
    tau, v : the states of an orbit; of chatter the phase at which the mass lifts off, and 0.
    """

    kind: str
    n: float
    k: int
    tau: Array
    v: Array
    impacts: int = 0
    horizon: float = 0.0

    @property
    def name(self) -> str:
        """The name in the legend of the picture, and what would decide a class that is not decided."""
        if self.kind == "orbit":
            return f"({self.n:.0f}, {self.k}) orbit"
        count = f"{self.impacts:,}".replace(",", " ")
        names = {
            "chatter": f"(inf, {self.k}) chatter for ever",
            "rest": "rest for ever",
            "chaotic": f"no period in {count} impacts, neighbours separate",
            "not decided": f"not settled in {count} impacts: larger impacts= may decide",
            "sensitive": "rounding decides: neighbours 1e-15 away part",
            "no impact": f"no impact within {self.horizon:.4g}",
            "unresolved": "a flight is unresolved: osc.orbit says which",
        }
        return names.get(self.kind, self.kind)


@dataclass(frozen=True)
class Basins(Result):
    """The attractors of a grid of states.

    Attributes
    ----------
    tau, v : the axes. attractors : the classes that occur. codes : shape (len(v), len(tau)), indices into `attractors`.
    first_chatter_completes : of the same shape, bool: the first chatter of the orbit completes.
    """

    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "tau": ("tau",),
        "v": ("v",),
        "class": ("v", "tau"),
        "first_chatter_completes": ("v", "tau"),
    }
    model: Oscillator
    tau: Array
    v: Array
    attractors: tuple[LongRun, ...]
    codes: Array
    first_chatter_completes: Array

    @property
    def classes(self) -> list[tuple[int, str, float]]:
        """Code, name and share of the classes, the largest first; orbits of equal (n, k) are named with their v."""
        counts = np.bincount(self.codes.ravel(), minlength=len(self.attractors))
        order = np.argsort(-counts, kind="stable")
        names = [each.name for each in self.attractors]
        told = [
            f"{name}, v to {each.v.max():.4g}" if names.count(name) > 1 and each.kind == "orbit" else name
            for name, each in zip(names, self.attractors, strict=True)
        ]
        return [(int(i), told[i], float(counts[i]) / self.codes.size) for i in order]

    @property
    def boundary(self) -> Array:
        """Places (tau, v) half way between neighbouring states of two classes, shape (m, 2)."""
        row, column = np.nonzero(self.codes[:, 1:] != self.codes[:, :-1])
        beside = np.stack([(self.tau[1:] + self.tau[:-1])[column] / 2, self.v[row]], axis=1)
        row, column = np.nonzero(self.codes[1:] != self.codes[:-1])
        above = np.stack([self.tau[column], (self.v[1:] + self.v[:-1])[row] / 2], axis=1)
        return np.concatenate([beside, above])

    def __repr__(self) -> str:
        shares = ", ".join(f"{name} {100 * share:.3g} %" for _, name, share in self.classes[:4])
        more = f", and {len(self.classes) - 4} more" if len(self.classes) > 4 else ""
        return f"Basins({self.tau.size} x {self.v.size} states: {shares}{more})"

    def as_dict(self) -> dict[str, Any]:
        """The axes tau and v, for each state the class and whether the first chatter completes, 0 or 1; the shares."""
        names = np.array([name for _, name, _ in sorted(self.classes)], dtype=object)
        return {
            "tau": self.tau,
            "v": self.v,
            "class": names[self.codes],
            "first_chatter_completes": self.first_chatter_completes.astype(int),
            "classes": [{"class": name, "share": share} for _, name, share in self.classes],
        }


def basins(
    model: Oscillator,
    tau: Any = None,
    v: Any = (0, 2),
    size: int = 600,
    executor: Any = None,
    output: Any = None,
    impacts: int = SETTINGS.impacts,
) -> Basins:
    """Classes of size x size states.

    Parameters
    ----------
    model : periodic. tau, v : ends of the window; one period of tau when it is not given; v > 0 is looked at.
    size : states a side. executor, output : as for `sweep`, where some rows are a case; threads without it, for flights
        of arrays run side by side in one process. impacts : at most, of an orbit that does not settle.

    Raises
    ------
    InputError : a model without a period, a window or a size that is none.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(1) as pool:
    ...     found = basins(Oscillator("x", "cos(2*t)", "0.7", "1/2"), v=(0, 1), size=16, executor=pool)
    >>> found.codes.shape, found.classes[0][1]
    ((16, 16), '(inf, 1) chatter for ever')
    """
    if not isinstance(model, Oscillator):
        raise refuse("model", model, "an ImpactOscillator")
    if model.period is None:
        raise refuse("model", model, "one with a period: periodic orbits are counted in periods")
    if isinstance(size, bool) or not isinstance(size, int) or not 2 <= size <= 10_000:
        raise refuse("size", size, "an integer from 2 to 10000")
    low, high = (0.0, as_float(model.period)) if tau is None else window_ends("tau", tau)
    slow, fast = window_ends("v", v)
    if slow < 0:
        raise refuse("window of v", v, "two numbers >= 0, the lower end first")
    times = low + (np.arange(size) + 0.5) * (high - low) / size
    speeds = slow + (np.arange(size) + 0.5) * (fast - slow) / size
    iterate(model, times[:1], speeds[-1:], 1)  # compiled here once, and not by every worker of a pool
    study = Study(model, lift_offs(model), fast, whole("impacts", impacts, 1, 10**7))
    tau, v = (coordinates.ravel() for coordinates in np.meshgrid(times, speeds))
    with ThreadPool() if executor is None else nullcontext(executor) as pool:
        table = _classes(study, (tau, v), size, pool, output)
    flown, table = table[:, 3], table[:, :3]
    first = table[:, 0] == CHATTER
    doubtful = set[tuple[float, ...]]()
    follows = futures(model, study.phases, partial(_after_lift_off, study, doubtful))
    for index in range(len(study.phases)):
        table[first & (table[:, 1] == index)] = settled(follows, index, as_float(model.period))
    if _several(study, table[settles(table)]):
        table[[row in doubtful for row in map(tuple, table.tolist())]] = SENSITIVE, 0.0, 0.0
    late = _open_to_rounding(study, table, flown)
    table[late[parted(study, tau[late], v[late], flown[late])]] = SENSITIVE, 0.0, 0.0
    attractors, codes = _named(study, table)
    return Basins(model, times, speeds, attractors, codes.reshape(size, size), first.reshape(size, size))


def _classes(study: Study, states: tuple[Array, Array], size: int, pool: Any, output: Any) -> Array:
    """The rows of `classify` of states, some rows of the grid in a case."""
    tau, v = states
    wanted = max(SETTINGS.states, size * size / SETTINGS.cases)
    # whole rows, and as many in each case
    rows = [n for n in range(1, size + 1) if size % n == 0]
    long = size * min(rows, key=lambda n: abs(log(n * size / wanted)))
    cases = [(tuple(tau[i : i + long].tolist()), tuple(v[i : i + long].tolist())) for i in range(0, tau.size, long)]
    work = partial(classified, dict(study.model.to_dict()), (study.phases, study.fast, study.impacts))
    return np.concatenate([np.asarray(part) for part in sweep(work, cases, pool, output)])


def _open_to_rounding(study: Study, table: Array, flown: Array) -> Array:
    """Indices of states that settle late, where there is more than one attractor to settle on."""
    settled = settles(table)
    if not _several(study, table[settled]):
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
    model, phases = study.model, study.phases
    classes, codes, left = list[LongRun](), np.full(len(rows), -1), np.ones(len(rows), dtype=bool)
    none, horizon = np.zeros(0), horizon_of(model, None)
    while left.any():
        code, tau, v = rows[np.flatnonzero(left)[0]].tolist()
        same = left & (rows[:, 0] == code)
        if code >= PLACES:
            orbit = Attractor(int(code), *states_of(model, int(code), tau, v), SETTINGS.same)
            same &= within(orbit, model, rows[:, 1], rows[:, 2], study.fast, SETTINGS.same)
            same[np.flatnonzero(left)[0]] = True
            classes.append(LongRun("orbit", int(code) // PLACES, int(code) % PLACES, orbit.tau, orbit.v))
        elif code == CHATTER:
            same &= rows[:, 1] == tau
            at = np.array([phases[int(tau)]]) if tau >= 0 else none
            classes.append(LongRun("chatter" if tau >= 0 else "rest", np.inf, int(v), at, 0 * at))
        else:
            classes.append(LongRun(KINDS[int(code)], 0, 0, none, none, study.impacts, horizon))
        codes[same], left = len(classes) - 1, left & ~same
    return tuple(classes), codes
