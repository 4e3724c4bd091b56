"""Tangency points of one model: a_c changes its sign at each as its kind says, and nowhere else on a fine grid.

Truth: signs of a_c, evaluated by Python from the expression trees of f and g, which is all that is shared.
"""

from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.bench.selftest.draws import Flown, NotComparable, compared
from singimpact.bench.selftest.rows import Tally
from singimpact.contact.points import tangency_points
from singimpact.inputs import InputError

SIGNS = {"gamma": (-1, 1), "foliation": (1, -1)}


@dataclass(frozen=True)
class GridSettings:
    """Settings of the grid of phases.

    Parameters
    ----------
    grid : intervals of one period, or between the first and the last point and as far beyond.
    beside : distance to a point at which a_c is looked at, in units of an interval; a third of the distance to the next
        point where that is less.
    rounding : a_c is undecided below so many epsilon of its largest value.
    """

    grid: int = 20_000
    beside: float = 0.1
    rounding: float = 100.0


GRID = GridSettings()


@compared("tangency points")
def row(flown: Flown, tally: Tally) -> None:
    """Points of the package, and changes of the sign of a_c on the grid."""
    plain = flown.plain
    try:
        points = tangency_points(flown.osc)
    except (InputError, TypeError) as reason:
        raise NotComparable(reason) from reason
    tau, period = np.array([point.tau for point in points]), flown.scales.period
    low, high = flown.scales.low, flown.scales.high
    if period is None and tau.size:
        low, high = min(low, 2 * tau[0] - tau[-1] - 1), max(high, 2 * tau[-1] - tau[0] + 1)
    # half an interval off the ends, where points of simple models lie
    grid = np.linspace(low, high, GRID.grid + 1) + (high - low) / GRID.grid * 0.4142
    a = plain.pushes(grid)
    least = GRID.rounding * EPSILON * float(np.max(np.abs(a), initial=0.0))
    _kinds(flown, tau, [point.kind for point in points], (high - low) / GRID.grid, tally)
    changed = np.flatnonzero(np.sign(a[:-1]) != np.sign(a[1:]))
    simple = np.array([point.tau for point in points if point.kind != "degenerate"])
    if period is not None:
        simple = np.concatenate([simple, simple + period])
    for at in changed.tolist():
        inside = int(np.count_nonzero((simple > grid[at]) & (simple <= grid[at + 1])))
        if min(abs(a[at]), abs(a[at + 1])) <= least:
            tally.leave("a_c is a rounding")
        else:
            ends = f"{float(grid[at])!r} and {float(grid[at + 1])!r}"
            finding = f"a_c changes its sign between {ends}, with {inside} tangency points"
            tally.judge(0.0 if inside % 2 else np.inf, finding)
    if not (changed.size or tau.size):
        tally.judge(0.0, "")  # no point and no change of sign: one agreement


def _kinds(flown: Flown, tau: Array, kinds: list[str], interval: float, tally: Tally) -> None:
    """Signs of a_c on both sides of each point."""
    gaps, period = np.abs(tau[:, None] - tau[None, :]), flown.scales.period
    if period is not None:
        gaps = np.minimum(gaps, period - gaps)
    np.fill_diagonal(gaps, np.inf)
    beside = np.minimum(GRID.beside * interval, np.min(gaps, axis=1, initial=np.inf) / 3)
    sides = [flown.plain.pushes(tau + sign * beside) for sign in (-1, 1)]
    slope = (sides[1] - sides[0]) / (2 * beside)
    rounding = GRID.rounding * EPSILON * np.maximum(np.abs(tau), 1.0) * np.abs(slope)
    for at, kind in enumerate(kinds):
        signs = tuple(int(np.sign(side[at])) for side in sides)
        if min(abs(side[at]) for side in sides) <= rounding[at]:
            tally.leave("a_c is a rounding")
            continue
        right = signs[0] == signs[1] if kind == "degenerate" else signs == SIGNS[kind]
        tally.judge(
            0.0 if right else np.inf, f"tangency point {float(tau[at])!r}, {kind}: a_c has the signs {signs} beside it"
        )
