"""All rows of a self-test in turn; those of tangency points, of batches and of grazes are compared here.

a_c changes its sign at each tangency point as its kind says, and nowhere else on a fine grid.  Truth: signs of a_c,
evaluated by Python from the expression trees of f and g, which is all that is shared.

Here too are arrays longer than a batch of the kernels, each state compared; and flights beside a graze. Truth: fixed
steps of order 8, one state at a time, with rho evaluated by Python; launches that graze are bracketed by them too.
Shared with the package: f, g and rho as expression trees.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from time import process_time
from typing import Any

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.bench.drawn import compile_entries
from singimpact.bench.selftest import basin_pixels, responses
from singimpact.bench.selftest.rows import LEAST, Flown, NotComparable, Row, SelfTest, Tally, compared, flown
from singimpact.bench.truth.graded_steps import HIT, MISS
from singimpact.bench.truth.plain_orbits import PlainOrbits
from singimpact.contact.points import tangency_points
from singimpact.impact_oscillator import ImpactOscillator
from singimpact.inputs import InputError, checked_keywords, require, takes_two_walls, whole
from singimpact.progress import ProgressLine
from singimpact.status import Status


@dataclass(frozen=True)
class BatchSettings:
    """The number of states, and the tolerances of their comparison."""

    states: int = 197  # three batches of 64 and five states more
    impacts: tuple[int, ...] = (1, 3)
    wrong: float = 1e-10  # relative, beside what rounding of the launch moves
    phases: int = 16  # at which launches that graze are looked for
    speeds: int = 24  # at each, up to the fastest
    jump: float = 0.05  # of the flight time at a graze, in units of 1/rate
    decades: tuple[float, ...] = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)  # relative distances of v from that of a graze
    near: float = 1e-8  # relative difference beside a graze, where another impact is looked for


BATCHES = BatchSettings()


@compared("states of a batch")
def lanes(flown: Flown, tally: Tally) -> None:
    """`osc.iterate` of an array, each state against its own flights."""
    hit, plain = np.flatnonzero(flown.step.status == Status.hit), flown.plain
    if not hit.size:
        return
    places = np.resize(hit, BATCHES.states)
    # repeated states are moved by less than a thousandth, so that all of an array differ
    tau, v = flown.tau[places] + 1e-4 * np.arange(places.size) / flown.scales.rate, flown.v[places]
    compile_entries(flown.osc)
    for impacts in BATCHES.impacts:
        ends = flown.osc.iterate(tau, v, impacts)
        if ends.wall is not None:
            ends = replace(ends, v=np.where(ends.wall, -ends.v, ends.v))
        tally.restart()
        for at in tally.in_time(range(tau.size)):
            _lane(plain, (float(tau[at]), float(v[at])), ends, (at, impacts), tally)
        if tally.late:
            return


def _lane(plain: PlainOrbits, state: tuple[float, float], ends: Any, lane: tuple[int, int], tally: Tally) -> None:
    at, impacts = lane
    status, true = Status(int(ends.status[at])), plain.impacts(*state, impacts)
    call = f"osc.iterate({state[0]!r}, {state[1]!r}, {impacts}), state {at} of the array: "
    call += f"{float(ends.tau[at])!r}, {float(ends.v[at])!r}, {status.name}"
    if status not in (Status.hit, Status.no_return, Status.escaped):
        tally.leave(status.name)
    elif true is None:
        if status == Status.hit:
            # the horizon of the truth is shorter
            tally.leave("a flight does not return soon")
        else:
            tally.judge(0.0, call)
    else:
        call += f", truth {state[0] + true[0]!r}, {true[1]!r}"
        late, fast = plain.spread(*state, impacts)
        if not np.isfinite(late) or late > 1e-3 * true[0]:
            tally.leave("rounding decides a flight")
            return
        late += BATCHES.wrong * true[0] + 4 * EPSILON * (abs(state[0]) + true[0])
        fast += BATCHES.wrong * abs(true[1]) + LEAST
        if status != Status.hit:
            tally.judge(np.inf, call)
            return
        passed = ends.tau[at] - state[0]
        tally.judge(float(max(abs(passed - true[0]) / late, abs(ends.v[at] - true[1]) / fast)), call)


@compared("beside a graze", "no launch that grazes lies among those looked at")
def grazes(flown: Flown, tally: Tally) -> None:
    """`osc.impact_map` and `osc.iterate` of states on both sides of a launch that grazes."""
    plain = flown.plain
    tau, v = grazing_states(flown, plain)
    if not tau.size:
        return
    compile_entries(flown.osc)
    # an array longer than a batch; the batch kernels take no shorter one
    ends = flown.osc.iterate(np.resize(tau, max(tau.size, 2 * 64)), np.resize(v, max(tau.size, 2 * 64)), 1)
    step = flown.osc.impact_map(tau, v)
    tally.restart()
    for at in tally.in_time(range(tau.size)):
        _graze(plain, (float(tau[at]), float(v[at])), (step, ends), at, tally)


def _graze(plain: PlainOrbits, state: tuple[float, float], answers: tuple[Any, Any], at: int, tally: Tally) -> None:
    true = plain.impact(*state)
    late, _ = plain.spread(*state)
    for name, answer in zip(("impact_map", "iterate"), answers, strict=True):
        status = Status(int(answer.status[at]))
        call = f"osc.{name} of arrays at {state[0]!r}, {state[1]!r}: {float(answer.tau[at])!r}, {status.name}"
        call += f", truth {state[0] + true.time!r}"
        if status == Status.unresolved or true.status not in (HIT, MISS):
            tally.leave("unresolved or not settled")
        elif true.status == MISS:
            # it may return later than the truth looks
            passed = answer.tau[at] - state[0] if status == Status.hit else np.inf
            tally.judge(0.0 if passed >= plain.horizon else np.inf, call)
        elif not np.isfinite(late) or late > 1e-3 * true.time:
            tally.leave("rounding decides whether it touches")
        else:
            allowed = late + BATCHES.near * true.time
            off = abs(answer.tau[at] - state[0] - true.time) if status == Status.hit else np.inf
            tally.judge(float(off / allowed), call)


def grazing_states(flown: Flown, plain: PlainOrbits) -> tuple[Array, Array]:
    """Launches beside those that graze: where the flight time jumps with v, on both sides, at falling distances."""
    units, states_ = flown.scales, list[tuple[float, float]]()
    speeds = units.fast * (np.arange(BATCHES.speeds) + 0.5) / BATCHES.speeds
    for tau in (units.low + (units.high - units.low) * (np.arange(BATCHES.phases) + 0.5) / BATCHES.phases).tolist():
        times = [plain.quick_impact(tau, v).time for v in speeds.tolist()]
        with np.errstate(invalid="ignore"):  # two flights that do not return
            smooth = np.abs(np.diff(times)) < 0.3 / units.rate
        for at in np.flatnonzero(~smooth).tolist():
            graze = _graze_between(plain, tau, (float(speeds[at]), float(speeds[at + 1])), (times[at], times[at + 1]))
            if graze:
                states_ += [(tau, graze * (1 + side * away)) for away in BATCHES.decades for side in (-1, 1)]
    return np.array([tau for tau, _ in states_]), np.array([v for _, v in states_])


def _graze_between(
    plain: PlainOrbits, tau: float, ends: tuple[float, float], times: tuple[float, float]
) -> float | None:
    """The v of a launch that grazes, by halving the interval in which the flight time jumps most."""
    (low, high), (first, last) = ends, times
    while high - low > 1e-11 * high:
        middle = 0.5 * (low + high)
        time = plain.quick_impact(tau, middle).time
        if not abs(time - first) <= abs(last - time):
            high, last = middle, time
        else:
            low, first = middle, time
    return high if not abs(last - first) < BATCHES.jump / plain.rate else None


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
    "orbits": responses.orbits,
    "chatter limits": responses.limits,
    "D G": responses.derivatives,
    "rebounds": responses.rebounds,
    "basins": basin_pixels.row,
    "tangency points": tangency_row,
    "batches": lanes,
    "grazes": grazes,
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
    require(isinstance(osc, ImpactOscillator), "osc", osc, "an ImpactOscillator")
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
