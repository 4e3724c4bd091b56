"""All rows of a self-test in turn; the row of tangency points compares signs of a_c.

a_c changes its sign at each tangency point as its kind says, and nowhere else on a fine grid.  Truth: signs of a_c,
evaluated by Python from the expression trees of f and g, which is all that is shared.
"""

from collections.abc import Callable
from dataclasses import dataclass
from time import process_time

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.bench.selftest import basin_pixels, batches, followed_orbits, responses
from singimpact.bench.selftest.rows import Flown, NotComparable, Row, SelfTest, Tally, compared, flown
from singimpact.contact.points import tangency_points
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.inputs import InputError, checked_keywords, refuse, takes_two_walls, whole
from singimpact.progress import ProgressLine

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
def tangency_row(flown: Flown, tally: Tally) -> None:
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


COMPARED: dict[str, Callable[[Flown], Row]] = {
    "flights forward and back": responses.round_trip,
    "small fixed steps": responses.fixed_steps,
    "more digits": responses.digits,
    "balls": responses.balls,
    "orbits": followed_orbits.orbits,
    "chatter limits": followed_orbits.limits,
    "D G": responses.derivatives,
    "rebounds": responses.rebounds,
    "basins": basin_pixels.row,
    "tangency points": tangency_row,
    "batches": batches.lanes,
    "grazes": batches.grazes,
}


@checked_keywords
@takes_two_walls
def selftest(osc: ImpactOscillator, *, states: int = 1000, seed: int = 0) -> SelfTest:
    """Random states of a model, flown by the package and judged against independent computations.

    Parameters
    ----------
    osc : the model. With two walls the states are at the lower one, and orbits and basins go on from both.
    states : how many are drawn: phases over a period of g, or over [-10, 10]; velocities log-uniform over ten decades.
    seed : which states; the same seed draws the same ones.

    Returns
    -------
    SelfTest : prints as a table; `.wrong` is 0 where nothing is wrong, `.rows` has the counts and, for wrong states,
        the calls that repeat them.

    Raises
    ------
    InputError : osc is no ImpactOscillator, or states or seed is no whole number.

    Notes
    -----
    The rows are: flights forward and back; flights against fixed steps of order 8, against the balls of the program
    that checks certificates, and against `digits=20`; events of orbits (impacts, ends of chatter, lift-offs) and
    chatter limits; D G against differences of flights; rho; each state of an array longer than a batch; launches
    beside a graze; pixels of basins; signs of a_c beside tangency points. "Flown forward and back" compares the package
    with itself, and `digits=20` its two ways to fly. The second program shares nothing but the texts of the model; the
    truths of the others share with the package f, g and rho as expression trees, the period and the default horizon.

    A row starts no further state after 10 s of CPU time; states that are left are undecided.

    Examples
    --------
    >>> import singimpact as si
    >>> found = si.selftest(si.linear(2, "0.3", "0.5"), states=40)
    >>> found.wrong, found.rows[1].compared, found.rows[1].agree
    (0, 'against small fixed steps', 40)
    """
    if not isinstance(osc, ImpactOscillator):
        raise refuse("osc", osc, "an ImpactOscillator")
    count, chosen = whole("states", states, 1, 10**6), whole("seed", seed, 0, 2**63)
    begun = process_time()
    with ProgressLine() as line:
        line.show(0, len(COMPARED) + 1, "flights")
        drawn = flown(osc, count, chosen)
        rows = []
        for done, (name, row_of) in enumerate(COMPARED.items()):
            line.show(done + 1, len(COMPARED) + 1, name)
            rows.append(row_of(drawn))
    return SelfTest(repr(osc), tuple(rows), process_time() - begun)
