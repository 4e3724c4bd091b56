"""The table a linear model's strides go through: its step, its rows, its bounds, once a model."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import frexp, ldexp
from typing import Any

import numpy as np

from singimpact.flights.flow.table import EACH, FIXED
from singimpact.flights.kernel import Kernel, ready

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class Strides:
    """How a table is laid out.

    Parameters
    ----------
    reach : step times the fastest rate: longer steps are fewer, and need more terms and leave a larger remainder;
        measured best for one wave at 0.6 for one flight at a time, at 1.0 for lanes.
    order : terms of a Taylor step: 0.6^17/17! and 1/19! leave less than 1e-17 of the terms at its far end.
    rows : rows of a table; after so many steps the closed form is asked again.
    bits : of the step, so that a row's time is exact.
    """

    reach: float = 0.6
    order: int = 16
    rows: int = 200
    bits: int = 24


STRIDES = Strides()
LANES = Strides(reach=1.0, order=18)


@dataclass(frozen=True, eq=False)
class Table:
    """step, rows[m] for the time m step, bounds of x'''' and x^(6), coefficients of a Taylor step."""

    step: float
    rows: Array
    bound: Array
    series: Array


def fastest(p: Array) -> float:
    """The largest modulus of a root of s^2 + d s + k, or of a wave's rate."""
    root = np.sqrt(complex(p[1] * p[1] / 4 - p[2]))
    return float(max(abs(-p[1] / 2 + root), abs(-p[1] / 2 - root), *np.abs(p[5::3]), 0.0))


@lru_cache(maxsize=512)
def _laid(kernel: Kernel, numbers: bytes, strides: Strides) -> Table | None:
    p = np.frombuffer(numbers)
    rate = fastest(p)
    if not 0 < rate < 1e100:
        return None
    fraction, exponent = frexp(strides.reach / rate)
    step = ldexp(int(ldexp(fraction, strides.bits)), exponent - strides.bits)
    waves = (p.size - 5) // 3
    rows, bound = np.zeros((strides.rows, FIXED + EACH * waves)), np.zeros(6 + strides.order + 1)
    series = np.zeros((strides.order + 1, 3 + 2 * waves))
    ready(kernel, "tabulate", 1)(p.copy(), step, rows)
    ready(kernel, "bounds", 1)(p.copy(), step, bound)
    ready(kernel, "expansions", 1)(p.copy(), series)
    return Table(step, rows, bound, series)


def table_of(kernel: Kernel, p: Array, strides: Strides = STRIDES) -> Table | None:
    """The table of a linear model with the numbers p; None when nothing in it has a rate."""
    return None if kernel.form is None else _laid(kernel, p.tobytes(), strides)
