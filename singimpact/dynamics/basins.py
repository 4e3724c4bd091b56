"""Where orbits from a grid of states end: in complete chatter, on an orbit of n impacts in k periods, elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from math import ceil, log
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float
from singimpact.cases import sweep
from singimpact.dynamics.attractors import CHATTER, OTHER, PLACES, Attractor, caught, new_attractors, periodic_codes
from singimpact.flights.grids import after
from singimpact.inputs import refuse
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.model import Oscillator
from singimpact.surface.curve import window_ends

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class BasinSettings:
    """When an orbit is called decided, and how many are flown together.

    Attributes
    ----------
    rest : an impact slower than this share of the fastest state shown, with a_c < 0, is in complete chatter.
    slow : slower than this share, it is so too if what is left of chatter is short and a_c keeps pressing.
    lasting : the part of a period that such a rest of chatter may last.
    transient : impacts flown before an orbit is looked at, beyond those that chatter takes to get so slow.
    block : impacts flown before it is looked again which orbits are decided.
    sample : of those that are not, looked at for an attractor that others are caught by.
    tolerance : of a Taylor step: no class of 18 000 states moves at 1e-6, and a flight costs a quarter less than at a
        rounding.
    rows : of states a case; a call costs 3 ms before it flies.
    limit : of impacts flown; r = 0.99 wants 2000.
    """

    rest: float = 1e-7
    slow: float = 1e-2
    lasting: float = 0.02
    transient: int = 40
    block: int = 6
    sample: int = 24
    tolerance: float = 1e-10
    rows: int = 10
    limit: int = 3000


SETTINGS = BasinSettings()


@dataclass(frozen=True)
class Basins:
    """Classes of a grid of states.

    Attributes
    ----------
    tau, v : the axes. codes : shape (len(v), len(tau)): 0 other, 1 complete chatter, 1000 n + k for n impacts
        in k periods.
    """

    model: Oscillator
    tau: Array
    v: Array
    codes: Array

    @property
    def classes(self) -> list[tuple[int, str, float]]:
        """Code, name and share of the classes that occur, the largest first."""
        found, counts = np.unique(self.codes, return_counts=True)
        order = np.argsort(-counts, kind="stable")
        return [(int(found[i]), name_of(int(found[i])), float(counts[i]) / self.codes.size) for i in order]


def name_of(code: int) -> str:
    """What a code means.

    Examples
    --------
    >>> name_of(1), name_of(2001)
    ('complete chatter', '(2, 1) orbit')
    """
    if code >= PLACES:
        return f"({code // PLACES}, {code % PLACES}) orbit"
    return "complete chatter" if code == CHATTER else "other"


def basins(
    model: Oscillator, tau: Any = None, v: Any = (0, 2), size: int = 600, executor: Executor | None = None,
    output: Any = None,
) -> Basins:  # fmt: skip
    """Classes of size x size states.

    Parameters
    ----------
    model : periodic. tau, v : ends of the window; one period of tau when it is not given; v > 0 is looked at.
    size : states a side. executor, output : as for `sweep`; rows are its cases.

    Raises
    ------
    InputError : a model without a period, a window or a size that is none.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(1) as pool:
    ...     found = basins(Oscillator("x", "cos(2*t)", "0.7", "1/2"), v=(0, 1), size=16, executor=pool)
    >>> found.codes.shape, found.classes[0][1]
    ((16, 16), 'complete chatter')
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
    after(model, times[:1], speeds[-1:], 1)  # compiled here once, and not by every worker of a pool
    codes = sweep(partial(classified, dict(model.to_dict()), tuple(times.tolist()), fast), blocks, executor, output)
    return Basins(model, times, speeds, codes.reshape(size, size))


def classified(fields: Mapping[str, Any], times: tuple[float, ...], fast: float, speeds: tuple[float, ...]) -> Array:
    """The codes of some rows of states; a function of this module, so that another process can be sent it."""
    model = Oscillator(**fields)
    assert model.period is not None
    period = as_float(model.period)
    tau, v = np.tile(times, len(speeds)), np.repeat(speeds, len(times))
    codes, open_ = np.full(tau.size, OTHER, dtype=np.int32), np.arange(tau.size)
    r = as_float(model.slope_at_rest())
    most = min(SETTINGS.transient + (ceil(log(SETTINGS.rest) / log(r)) if r < 1 else 0), SETTINGS.limit)
    known: list[Attractor] = []
    flown, block = 0, SETTINGS.block
    while open_.size and flown < most:
        block = min(block, most - flown)
        ends = after(model, tau[open_], v[open_], block, SETTINGS.tolerance)
        flown += block
        # doubles do here, and a time within a period needs no exact reduction, which costs more than the flight
        tau[open_], v[open_] = ends.tau - period * np.floor(ends.tau / period), ends.v
        codes[open_] = _chattering(model, tau[open_], ends.v, fast)
        open_ = open_[(codes[open_] == OTHER) & (ends.status == 0) & np.isfinite(ends.tau) & (ends.v > 0)]
        if open_.size and flown < most:
            codes[open_] = _caught(known, model, tau[open_], v[open_], fast)
            block *= 1 if (codes[open_] != OTHER).any() else 2  # a search in vain is dear, and the next one more so
            open_ = open_[codes[open_] == OTHER]
    if open_.size:
        codes[open_] = periodic_codes(model, tau[open_], v[open_], fast)
    return codes


def _caught(known: list[Attractor], model: Oscillator, tau: Array, v: Array, fast: float) -> Array:
    """Codes of states near an attractor; those that a sample of the others has reached are added to the known ones."""
    codes = caught(known, model, tau, v, fast)
    left = np.flatnonzero(codes == OTHER)
    sample = left[:: max(left.size // SETTINGS.sample, 1)]
    known += new_attractors(model, tau[sample], v[sample], fast)
    codes[left] = caught(known, model, tau[left], v[left], fast)
    return codes


def _chattering(model: Oscillator, tau: Array, v: Array, fast: float) -> Array:
    """CHATTER where an orbit is slow, pressed to the obstacle, and at rest before the pressure can have gone.

    What is left of chatter lasts about 2 v/((1 - r)|a|); over eight times that, a_c must keep its sign.
    """
    codes = np.full(tau.size, OTHER, dtype=np.int32)
    found = np.flatnonzero(np.isfinite(tau) & np.isfinite(v) & (np.nan_to_num(v) <= SETTINGS.slow * fast))
    now, speed = acceleration(model, tau[found]), v[found]
    with np.errstate(all="ignore"):
        rest = np.where(now < 0, -2 * speed / (now * (1 - as_float(model.slope_at_rest()))), np.inf)
    short = (now < 0) & (rest < SETTINGS.lasting * as_float(model.period)) if model.period is not None else now < 0
    pressed = [acceleration(model, tau[found] + np.where(short, k * rest, 0.0)) < now / 2 for k in (2, 4, 8)]
    settled = (now < 0) & (speed <= SETTINGS.rest * fast)
    codes[found[settled | (short & np.all(pressed, axis=0))]] = CHATTER
    return codes
