"""Where orbits from a grid of states end: in complete chatter, on an orbit of n impacts in k periods, elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from math import ceil, log
from typing import Any

import numpy as np

from singimpact.algebra.numbers import as_float, constant
from singimpact.cases import sweep
from singimpact.flights.grids import after
from singimpact.inputs import refuse
from singimpact.oscillator.acceleration import acceleration
from singimpact.oscillator.model import Oscillator

Array = np.ndarray[Any, Any]
OTHER, CHATTER = 0, 1


@dataclass(frozen=True)
class BasinSettings:
    """rest : an impact slower than this share of the fastest state shown, with a_c < 0, is in complete chatter.
    transient : impacts flown before an orbit is looked at, beyond those that chatter takes to get so slow.
    most_impacts : n of the orbits that are told apart. close : two states nearer than this are the same, relative.
    rows : of states a case; a call costs 3 ms before it flies. limit : of impacts flown; r = 0.99 wants 2000.
    """

    rest: float = 1e-7
    transient: int = 40
    most_impacts: int = 8
    close: float = 1e-6
    rows: int = 10
    limit: int = 3000


SETTINGS = BasinSettings()
PLACES = 1000  # a class (n, k) is coded n * PLACES + k


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
    low, high = (0.0, as_float(model.period)) if tau is None else _ends("tau", tau)
    slow, fast = _ends("v", v)
    if slow < 0:
        raise refuse("window of v", v, "two numbers >= 0, the lower end first")
    times = low + (np.arange(size) + 0.5) * (high - low) / size
    speeds = slow + (np.arange(size) + 0.5) * (fast - slow) / size
    rows = SETTINGS.rows if size % SETTINGS.rows == 0 else 1
    blocks = [tuple(speeds[i : i + rows].tolist()) for i in range(0, size, rows)]
    codes = sweep(partial(classified, dict(model.to_dict()), tuple(times.tolist()), fast), blocks, executor, output)
    return Basins(model, times, speeds, codes.reshape(size, size))


def _ends(name: str, given: Any) -> tuple[float, float]:
    if not isinstance(given, tuple | list) or len(given) != 2:
        raise refuse(f"window of {name}", given, "two numbers, the lower end first")
    low, high = (as_float(constant(f"window of {name}", end)) for end in given)
    if not low < high:
        raise refuse(f"window of {name}", given, "two numbers, the lower end first")
    return low, high


def classified(fields: Mapping[str, Any], times: tuple[float, ...], fast: float, speeds: tuple[float, ...]) -> Array:
    """The codes of some rows of states; a function of this module, so that another process can be sent it."""
    model = Oscillator(**fields)
    tau, v = np.tile(times, len(speeds)), np.repeat(speeds, len(times))
    r = as_float(model.slope_at_rest())
    more = ceil(log(SETTINGS.rest) / log(r)) if r < 1 else 0
    ends = after(model, tau, v, min(SETTINGS.transient + more, SETTINGS.limit))
    codes = np.full(tau.size, OTHER, dtype=np.int32)
    known = np.isfinite(ends.tau) & np.isfinite(ends.v)
    slow = known & (np.nan_to_num(ends.v) <= SETTINGS.rest * fast)
    codes[slow & (acceleration(model, np.where(known, ends.tau, 0.0)) < 0)] = CHATTER
    flying = np.flatnonzero((codes == OTHER) & known & (ends.status == 0) & (ends.v > 0))
    if flying.size:
        codes[flying] = _periodic(model, ends.tau[flying], ends.v[flying], fast)
    return codes


def _periodic(model: Oscillator, tau: Array, v: Array, fast: float) -> Array:
    """(n, k) of states that come back to themselves, else 0."""
    assert model.period is not None
    period = as_float(model.period)
    codes = np.full(tau.size, OTHER, dtype=np.int32)
    home = tau - period * np.floor(tau / period)
    at, speed, turns = home, v, np.zeros(tau.size)
    for n in range(1, SETTINGS.most_impacts + 1):
        if (codes != OTHER).all():
            break
        ends = after(model, at, speed, 1)
        # doubles do here, and a time within a period needs no exact reduction, which costs more than the flight
        passed = np.floor(ends.tau / period)
        at, speed, turns = ends.tau - passed * period, ends.v, turns + passed
        around = np.rint((at - home) / period)
        near = np.abs(at - home - around * period) < SETTINGS.close * period
        near &= np.abs(speed - v) < SETTINGS.close * fast
        k = turns + around
        new = near & (codes == OTHER) & (k > 0) & (k < PLACES)
        codes[new] = (n * PLACES + k[new]).astype(np.int32)
    return codes
