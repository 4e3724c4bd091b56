"""Random states enclosed twice: 20 digits against 40, which choose another degree, other steps and other precision."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from pathlib import Path
from time import process_time

import numpy as np

from singimpact.algebra.certified import Certified
from singimpact.algebra.numbers import Array, exact
from singimpact.bench.steep_states import DRAW, drawn, family_of
from singimpact.cases import sweep
from singimpact.status import Status

FEWER, MORE = 20, 40
BOTH = 2  # of the two numbers of digits, where both enclose
COLUMNS = ("status", "enclosed", "apart", "time", "seconds", "more_seconds")


@dataclass(frozen=True)
class Pairs:
    """Some states at both numbers of digits.

    Parameters
    ----------
    states : flown. misses : proved not to hit before the horizon. enclosed : hits that both enclose.
    refused : numbers of the cases that one of them does not decide.
    apart : the truth is outside a radius, since two balls of one number do not meet, or one ends otherwise than the
        other.
    seconds, more_seconds : CPU time of a unit of flight time of the hits, median and largest, at 20 and at 40 digits.
    """

    states: int
    misses: int
    enclosed: int
    refused: tuple[int, ...]
    apart: int
    seconds: tuple[float, float]
    more_seconds: tuple[float, float]


def cases_of(count: int, steep: bool = True) -> list[int]:
    """The first cases of steep families, or of smooth ones; one state of each."""
    found, number = list[int](), 0
    while len(found) < count:
        if family_of(number).steep == steep:
            found.append(number)
        number += 1
    return found


def check(
    count: int, seed: int, executor: Executor | None = None, output: str | Path | None = None, *, steep: bool = True
) -> Pairs:
    """Fly so many states of steep or of smooth families twice; `executor`, `output` as in `singimpact.cases.sweep`."""
    cases = cases_of(count, steep)
    table = sweep(partial(flown, seed), cases, executor, output) if cases else np.empty(0)
    return summary(dict(zip(COLUMNS, table.reshape(-1, len(COLUMNS)).T, strict=True)), cases)


def flown(seed: int, number: int) -> Array:
    """The first launch of a case, in the order of COLUMNS."""
    case = drawn(seed, number, 1)
    osc, at = case.oscillator(), (float(case.tau[0]), float(case.v[0]))
    impacts_, spent = [], []
    for digits in (FEWER, MORE):
        begin = process_time()
        impacts_.append(osc.first_hit(*at, digits=digits, horizon=DRAW.horizon))
        spent.append(process_time() - begin)
    impacts = [impact.certified for impact in impacts_]
    shown = sum(impact is not None for impact in impacts)
    apart = impacts_[0].status != impacts_[1].status
    if shown == BOTH:
        apart |= any(disjoint(getattr(impacts[0], name), getattr(impacts[1], name)) for name in impacts[0].NUMBERS)
    return np.array([float(impacts_[1].status), shown, apart, float(impacts_[1].flight_time), *spent])


def disjoint(one: Certified, other: Certified) -> bool:
    """Whether no number lies within both radii.

    Examples
    --------
    >>> import mpmath
    >>> near, far = (Certified(mpmath.mpf(x), mpmath.mpf("0.01"), 3) for x in ("1.01", "1.05"))
    >>> disjoint(near, near), disjoint(near, far)
    (False, True)
    """
    value = [exact("value", interval.value) for interval in (one, other)]
    radii: Fraction = sum((exact("radius", interval.radius) for interval in (one, other)), Fraction(0))
    return abs(value[0] - value[1]) > radii


def summary(columns_: dict[str, Array], cases: Sequence[int]) -> Pairs:
    """The counts, from columns, and the cases that are not decided."""
    miss = columns_["status"] == Status.no_return
    both = columns_["enclosed"] == BOTH
    rates = [columns_[name][both] / np.maximum(columns_["time"][both], 1.0) for name in ("seconds", "more_seconds")]
    costs = [(float(np.median(rate)), float(rate.max())) if len(rate) else (np.nan, np.nan) for rate in rates]
    return Pairs(
        states=len(miss),
        misses=int(miss.sum()),
        enclosed=int(both.sum()),
        refused=tuple(int(cases[int(at)]) for at in np.flatnonzero(~miss & ~both)),
        apart=int(columns_["apart"].sum()),
        seconds=costs[0],
        more_seconds=costs[1],
    )
