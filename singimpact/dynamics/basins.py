"""Basins: the attractor of each state of a grid: an (n, k) orbit, repeated chatter, rest, chaos."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from functools import partial
from math import ceil, log
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.case_pools import ThreadPool
from singimpact.cases import sweep
from singimpact.dynamics.attractors import (
    CHAOS,
    CHATTER,
    GONE,
    OTHER,
    PLACES,
    Attractor,
    caught,
    new_attractors,
    periodic_codes,
    states_of,
    within,
)
from singimpact.dynamics.fractional_chatter import rest_after
from singimpact.dynamics.long_run import chaotic, futures, lift_offs, next_lift_off, settled
from singimpact.flights.orbits import iterate
from singimpact.inputs import refuse
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.model import Oscillator
from singimpact.status import Status
from singimpact.store import write_table
from singimpact.surface.curve import window_ends

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class BasinSettings:
    """When the class of an orbit is decided, and sizes of blocks."""

    # v of an impact in complete chatter where a_c < 0, as a share of the largest v of the window
    rest: float = 1e-7
    # the same if the remaining chatter is shorter than `lasting` and a_c stays negative until then
    slow: float = 1e-2
    lasting: float = 0.02  # periods of the forcing
    # impacts before the first test, in addition to those that chatter needs to become so slow
    transient: int = 40
    block: int = 6  # impacts between two tests
    sample: int = 24  # undecided orbits that are tested for a new attractor after each block
    # of a Taylor step: at 1e-6 no class of 18 000 states changes; a flight costs a quarter less than at full accuracy
    tolerance: float = 1e-10
    rows: int = 10  # of the grid in a case; a call costs 3 ms before its first flight
    limit: int = 3000  # impacts at most; r = 0.99 needs 2000
    same: float = 1e-3  # relative distance below which two periodic orbits are one


SETTINGS = BasinSettings()


@dataclass(frozen=True)
class LongRun:
    """An attractor, or another long-term behaviour.

    Attributes
    ----------
    kind : "orbit", "chatter" (it completes again and again), "rest", "chaotic", "not decided", "never returns".
    n, k : impacts (inf for chatter) in k periods, of an orbit or of chatter; 0 otherwise.
    tau, v : the states of an orbit; of chatter the phase at which the mass lifts off, and 0.
    """

    kind: str
    n: float
    k: int
    tau: Array
    v: Array

    @property
    def name(self) -> str:
        """The name in the legend of the picture."""
        if self.kind == "orbit":
            return f"({self.n:.0f}, {self.k}) orbit"
        return {"chatter": f"(inf, {self.k}) chatter for ever", "rest": "rest for ever"}.get(self.kind, self.kind)


@dataclass(frozen=True)
class Basins:
    """The attractors of a grid of states.

    Attributes
    ----------
    tau, v : the axes. attractors : the classes that occur. codes : shape (len(v), len(tau)), indices into `attractors`.
    first_chatter_completes : of the same shape, bool: the first chatter of the orbit completes.
    """

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

    def to_csv(self, path: Any) -> None:
        """Write one line for each state: tau, v, the class, and whether the first chatter completes."""
        names = {code: name for code, name, _ in self.classes}
        tau, v = np.meshgrid(self.tau, self.v)
        write_table(path, {
            "tau": tau.ravel().tolist(), "v": v.ravel().tolist(), "class": map(names.get, self.codes.ravel().tolist()),
            "first_chatter_completes": self.first_chatter_completes.ravel().astype(int).tolist(),
        })  # fmt: skip


def basins(
    model: Oscillator, tau: Any = None, v: Any = (0, 2), size: int = 600, executor: Any = None,
    output: Any = None,
) -> Basins:  # fmt: skip
    """Classes of size x size states.

    Parameters
    ----------
    model : periodic. tau, v : ends of the window; one period of tau when it is not given; v > 0 is looked at.
    size : states a side. executor, output : as for `sweep`, where some rows are a case; threads without it, for flights
        of arrays run side by side in one process.

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
    rows = SETTINGS.rows if size % SETTINGS.rows == 0 else 1
    blocks = [tuple(speeds[i : i + rows].tolist()) for i in range(0, size, rows)]
    iterate(model, times[:1], speeds[-1:], 1)  # compiled here once, and not by every worker of a pool
    phases = lift_offs(model)
    work = partial(classified, dict(model.to_dict()), phases, tuple(times.tolist()), fast)
    with ThreadPool() if executor is None else nullcontext(executor) as pool:
        table = np.array(sweep(work, blocks, pool, output)).reshape(-1, 3)
    first = table[:, 0] == CHATTER
    follows = futures(model, phases, partial(classify, model, phases, fast))
    for place in range(len(phases)):
        table[first & (table[:, 1] == place)] = settled(follows, place, as_float(model.period))
    attractors, codes = _named(model, table, phases, fast)
    return Basins(model, times, speeds, attractors, codes.reshape(size, size), first.reshape(size, size))


def _named(model: Oscillator, rows: Array, phases: tuple[float, ...], fast: float) -> tuple[tuple[LongRun, ...], Array]:
    """The classes that occur, and the index of each row among them; rows near one orbit are one class."""
    found, codes, left = list[LongRun](), np.full(len(rows), -1), np.ones(len(rows), dtype=bool)
    none = np.zeros(0)
    while left.any():
        code, tau, v = rows[np.flatnonzero(left)[0]].tolist()
        same = left & (rows[:, 0] == code)
        if code >= PLACES:
            orbit = Attractor(int(code), *states_of(model, int(code), tau, v), SETTINGS.same)
            same &= within(orbit, model, rows[:, 1], rows[:, 2], fast, SETTINGS.same)
            same[np.flatnonzero(left)[0]] = True
            found.append(LongRun("orbit", int(code) // PLACES, int(code) % PLACES, orbit.tau, orbit.v))
        elif code == CHATTER:
            same &= rows[:, 1] == tau
            at = np.array([phases[int(tau)]]) if tau >= 0 else none
            found.append(LongRun("chatter" if tau >= 0 else "rest", np.inf, int(v), at, 0 * at))
        else:
            found.append(
                LongRun({CHAOS: "chaotic", GONE: "never returns"}.get(int(code), "not decided"), 0, 0, none, none)
            )
        codes[same], left = len(found) - 1, left & ~same
    return tuple(found), codes


def classified(
    fields: Mapping[str, Any], phases: tuple[float, ...], times: tuple[float, ...], fast: float,
    speeds: tuple[float, ...],
) -> Array:  # fmt: skip
    """The classes of some rows of states. A module-level function, so that it can be pickled."""
    tau, v = np.tile(times, len(speeds)), np.repeat(speeds, len(times))
    return classify(Oscillator(**fields), phases, fast, tau, v)


def classify(model: Oscillator, phases: tuple[float, ...], fast: float, tau: Array, v: Array) -> Array:
    """Rows (code, tau, v), shape (n, 3): of a periodic orbit n * PLACES + k and one of its states; CHATTER and the
    place of the lift-off that follows; CHAOS, GONE or OTHER.
    """
    assert model.period is not None
    period = as_float(model.period)
    tau, v = np.array(tau, dtype=float), np.array(v, dtype=float)
    rows, open_ = np.zeros((tau.size, 3)), np.arange(tau.size)
    r = as_float(model.slope_at_rest())
    most = min(SETTINGS.transient + (ceil(log(SETTINGS.rest) / log(r)) if r < 1 else 0), SETTINGS.limit)
    known: list[Attractor] = []
    flown, block = 0, SETTINGS.block
    while open_.size and flown < most:
        block = min(block, most - flown)
        ends = iterate(model, tau[open_], v[open_], block, SETTINGS.tolerance)
        flown += block
        # doubles do here, and a time within a period needs no exact reduction, which costs more than the flight
        tau[open_], v[open_] = ends.tau - period * np.floor(ends.tau / period), ends.v
        rests = _chattering(model, tau[open_], ends.v, fast) == CHATTER
        gone = np.isin(ends.status, (Status.no_return, Status.escaped)) & ~rests
        rows[open_[rests], 0], rows[open_[gone], 0] = CHATTER, GONE
        rows[open_[rests], 1] = next_lift_off(phases, _at_rest(model, tau[open_[rests]], v[open_[rests]]))
        open_ = open_[~rests & (ends.status == 0) & np.isfinite(ends.tau) & (ends.v > 0)]
        if open_.size and flown < most:
            places = _caught(known, model, tau[open_], v[open_], fast)
            for place in np.unique(places[places >= 0]).tolist():
                orbit = known[place]
                rows[open_[places == place]] = orbit.code, orbit.tau[0], orbit.v[0]
            block *= 1 if (places >= 0).any() else 2  # a search in vain is dear, and the next one more so
            open_ = open_[places < 0]
    if open_.size:
        rows[open_] = np.stack([periodic_codes(model, tau[open_], v[open_], fast), tau[open_], v[open_]], axis=1)
        open_ = open_[rows[open_, 0] == OTHER]
        rows[open_] = 0.0
        rows[open_[chaotic(model, tau[open_], v[open_], fast)], 0] = CHAOS
    return rows


def _at_rest(model: Oscillator, tau: Array, v: Array) -> Array:
    """The phase, within a period, at which the remaining chatter ends, to first order."""
    assert model.period is not None
    left = rest_after(model, v, acceleration(model, tau))
    period = as_float(model.period)
    return np.asarray((tau + left) - period * np.floor((tau + left) / period))


def _caught(known: list[Attractor], model: Oscillator, tau: Array, v: Array, fast: float) -> Array:
    """Places of attractors near states, else -1; those that a sample of the others has reached are added to `known`."""
    places = caught(known, model, tau, v, fast)
    left = np.flatnonzero(places < 0)
    sample = left[:: max(left.size // SETTINGS.sample, 1)]
    before = len(known)
    known += new_attractors(model, tau[sample], v[sample], fast)
    again = caught(known[before:], model, tau[left], v[left], fast)
    places[left] = np.where(again < 0, -1, again + before)
    return places


def _chattering(model: Oscillator, tau: Array, v: Array, fast: float) -> Array:
    """CHATTER where an orbit is slow, a_c < 0, and the mass comes to rest before a_c can become positive.

    What is left of chatter lasts about 2 v/((1 - r)|a|), see `rest_after`; over eight times that, a_c must keep its
    sign.
    """
    codes = np.full(tau.size, OTHER, dtype=np.int32)
    found = np.flatnonzero(np.isfinite(tau) & np.isfinite(v) & (np.nan_to_num(v) <= SETTINGS.slow * fast))
    now, speed = acceleration(model, tau[found]), v[found]
    with np.errstate(all="ignore"):
        rest = np.where(now < 0, rest_after(model, speed, now), np.inf)
    short = (now < 0) & (rest < SETTINGS.lasting * as_float(model.period)) if model.period is not None else now < 0
    pressed = [acceleration(model, tau[found] + np.where(short, k * rest, 0.0)) < now / 2 for k in (2, 4, 8)]
    settled = (now < 0) & (speed <= SETTINGS.rest * fast)
    codes[found[settled | (short & np.all(pressed, axis=0))]] = CHATTER
    return codes
