"""Points at which a branch of periodic orbits meets another branch of orbits of as many impacts and periods.

A pitchfork: the branch of (2n, 2k) orbits that leaves the (n, k) orbits at a period doubling meets them again there,
as (2n, 2k) orbits whose halves are equal. Between two walls orbits whose second half is the mirror image of the first
lose this symmetry where the map of half an orbit, with x -> -x, doubles its period. Other branches cross at a slope
over the parameter (transcritical) or none (pitchfork); the second branch is reached by one step across the first.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from singimpact.algebra.numbers import Array, as_float
from singimpact.branches.closing import Closing
from singimpact.branches.continuation import Curve, Point, cubic_between, null_plane, root_between
from singimpact.branches.events.kind import EventKind
from singimpact.branches.events.meeting_branches import BRANCH_POINT, PITCHFORK, TRANSCRITICAL
from singimpact.branches.orbits import PeriodicOrbit
from singimpact.branches.solutions import AnyClosing, closing_of, orbit_of, point_of
from singimpact.branches.step_search import Crossing, EventTests, Key, Node, StepSearch
from singimpact.branches.wall_closing import closing_of_word
from singimpact.oscillator.moving_number import CLEARANCE

# Orbits of other branches that meet a branch at an event.

APART = 1e-3  # distance from a doubling at which the doubled orbit is given, in scaled unknowns


def states_of(orbit: PeriodicOrbit) -> Array:
    return point_of(closing_of(orbit.oscillator, orbit.word, orbit.k, ()), orbit)


def repeated(once: AnyClosing, twice: AnyClosing, at: Array) -> Array:
    """An orbit and its repetition, or its mirror image, as unknowns of one of twice as many impacts."""
    assert isinstance(once, Closing)
    assert isinstance(twice, Closing)
    n, times, span = once.n, once.times(at), once.k * once.period(at)
    states = twice.point(np.concatenate([times, times + span]), np.tile(at[n : 2 * n], 2), 2 * span)
    return np.concatenate([states, at[2 * n :]])


def _closed(event: PeriodicOrbit, word: tuple[int, ...], times: Array, speeds: Array) -> PeriodicOrbit:
    """The orbit next to a point at the event's model; the event itself closes it already, up to rounding."""
    closing = closing_of(event.oscillator, word, event.k, ())
    assert isinstance(closing, Closing)
    point = closing.point(times, speeds, event.period)
    found = closing.newton(point)
    return orbit_of(closing, point if found is None else found[0])


def without_impact(orbit: PeriodicOrbit) -> PeriodicOrbit:
    n = int(orbit.n)
    times, speeds = np.asarray(orbit.tau, dtype=float), np.asarray(orbit.v, dtype=float)
    at = int(np.argmin(np.abs(speeds)))  # an orbit begins at its least phase, not where its branch did
    if n == 1:
        closing, wall = closing_of(orbit.oscillator, (), orbit.k, ()), as_float(orbit.oscillator.clearance)
        end = closing.family.end({CLEARANCE: wall}, float(times[0]), 0.0, -float(times[0]))
        return orbit_of(closing, np.array([wall + end.place[0], end.place[1]]))
    others = [(at + 1 + i) % n for i in range(n - 1)]
    span = orbit.period
    later = [times[i] + (span if i <= at else 0.0) for i in others]
    return _closed(orbit, tuple(orbit.word[i] for i in others), np.array(later), speeds[others])


def with_impact(orbit: PeriodicOrbit) -> PeriodicOrbit:
    n = int(orbit.n)
    times, speeds = np.asarray(orbit.tau, dtype=float), np.asarray(orbit.v, dtype=float)
    if n == 0:
        return _closed(orbit, (0,), times[:1], np.zeros(1))
    flight, wall, time = touching_flight(orbit)
    times, speeds = np.insert(times, flight + 1, times[flight] + time), np.insert(speeds, flight + 1, 0.0)
    return _closed(orbit, (*orbit.word[: flight + 1], wall, *orbit.word[flight + 1 :]), times, speeds)


def touching_flight(orbit: PeriodicOrbit) -> tuple[int, int, float]:
    """The flight of a hidden impact, the wall that it touches and the time from its launch.

    It is the one with the least height, wherever it begins.
    """
    closing, word = closing_of(orbit.oscillator, orbit.word, orbit.k, ()), orbit.word
    heights = closing.heights(states_of(orbit))
    least = int(np.argmin([abs(height) for _, height in heights]))
    flight = least % len(word)
    return flight, word[flight] if least < len(word) else 1 - word[flight], heights[least][0]


def doubled(orbit: PeriodicOrbit, over: str, parameter: float) -> list[PeriodicOrbit]:
    """The orbit of twice the period next to a doubling."""
    if orbit.n == 0:
        return []
    once, twice = (closing_of(orbit.oscillator, m * orbit.word, m * orbit.k, (over,)) for m in (1, 2))
    return _alternating(once, twice, np.append(states_of(orbit), parameter))


def _alternating(once: AnyClosing, twice: AnyClosing, at: Array) -> list[PeriodicOrbit]:
    """The orbit of two unequal halves next to a doubling of one, by one step along the vector that -1 belongs to."""
    assert isinstance(once, Closing)
    assert isinstance(twice, Closing)
    n, loop, parameter = once.n, once.at(at), float(at[-1])
    # the eigenvector of -1: the doubled orbit alternates along it
    vector = np.linalg.svd(loop.at_multiplier(-1.0))[2][-1]
    point = repeated(once, twice, at)
    moved = np.concatenate([vector[:n], -vector[:n], vector[n:], -vector[n:], [0.0]])
    scales = twice.scales(point)
    scales[-1] = max(abs(parameter), 1e-3)
    curve = Curve(partial(_equations, twice), scales, 10 * APART)
    tangent = moved / scales
    corrected = curve.beyond(Point(point, tangent / np.linalg.norm(tangent)), APART)
    return [] if corrected is None else [orbit_of(twice, corrected[0].at)]


def _equations(closing: AnyClosing, point: Array) -> tuple[Array, Array]:
    """Closing conditions as equations of a curve."""
    loop = closing.at(point)
    return loop.miss, loop.slope


TEST = Key(BRANCH_POINT, 0, 0)


@dataclass(frozen=True)
class BranchPointSettings:
    """Settings of the location of branch points."""

    # of the step: distances of the points from which a branch point is interpolated; the equations are singular at it
    beside: tuple[float, ...] = (1e-1, 1e-2, 1e-3)
    # secants for the doubling of the orbits of half as many impacts, and their tolerance in scaled unknowns
    secants: int = 30
    arrived: float = 1e-12
    # halves of an orbit that differ by less, in scaled unknowns, are equal
    equal: float = 1e-7
    # slope of the parameter along the other branch, in scaled unknowns, below which it turns back: the step is 1e-3
    level: float = 1e-2


SETTINGS = BranchPointSettings()


@dataclass(frozen=True)
class BranchPoint:
    """A branch point.

    Parameters
    ----------
    kind : of the event, unclassified where the other branch is not reached. along : distance from the first point of
        the step. at : the point. other : an orbit of the other branch.
    """

    kind: EventKind
    along: float
    at: Array
    other: PeriodicOrbit | None


def half_of(closing: AnyClosing) -> AnyClosing | None:
    """The closing conditions of half an orbit, or of half a symmetric one; None where the halves cannot be equal."""
    first, second = closing.word[: closing.n // 2], closing.word[closing.n // 2 :]
    if closing.k % 2 == 0 and first == second:
        return closing_of(closing.family.osc, first, closing.k // 2, closing.over)
    if first and closing.k % 2 and second == tuple(1 - wall for wall in first):
        return closing_of_word(closing.family.osc, first, closing.k / 2, closing.over)
    return None


def halves(closing: AnyClosing, at: Array) -> Array:
    """The second half of an orbit less the first, in scaled unknowns; it changes sign where a doubled orbit begins.

    Of halves that cannot be equal a single 0.
    """
    n, k = closing.n, closing.k
    if half_of(closing) is None:
        return np.zeros(1)
    scales = closing.scales(at)
    if not isinstance(closing, Closing):
        end = closing.family.end(closing.launch(at), 0.0, float(at[1]), closing.span(at, 0) / 2)
        return np.asarray((end.place - np.array([0.0, at[1]])) / scales[:2])
    period = closing.period(at)
    times, speeds = (
        np.diff(closing.times(at).reshape(2, -1), axis=0)[0],
        np.diff(at[n : 2 * n].reshape(2, -1), axis=0)[0],
    )
    return np.concatenate([(times - k / 2 * period) / scales[0], speeds / scales[n]])


def branch_point(search: StepSearch, crossing: Crossing) -> BranchPoint | None:
    """The branch point of a step, where the fold or the branch point test changes sign; None where there is none."""
    closing = search.tests.closing
    low, high = crossing.low.point.at, crossing.high.point.at
    differences = halves(closing, low), halves(closing, high)
    sizes = [float(np.linalg.norm(half)) for half in differences]
    if len(differences[0]) > 1 and (max(sizes) < SETTINGS.equal or float(differences[0] @ differences[1]) < 0):
        doubling = _doubling(search, crossing, max(sizes) < SETTINGS.equal)
        if doubling is not None or closing.k % 2 == 0:
            return doubling
    return None if crossing.kind.is_located else _crossing(search, crossing)


def _doubling(search: StepSearch, crossing: Crossing, equal: bool) -> BranchPoint | None:
    """The pitchfork at the period doubling of half the orbit, a regular point of its closing conditions."""
    closing, scales = search.tests.closing, search.tests.scales
    low, high = crossing.low.point.at, crossing.high.point.at
    near = min(low, high, key=lambda at: float(np.linalg.norm(halves(closing, at))))
    n, half, guess = closing.n, half_of(closing), near
    assert half is not None
    if isinstance(closing, Closing) and isinstance(half, Closing):
        shift, both = half.k * closing.period(near), closing.times(near)
        times, speeds = (both[: n // 2] + both[n // 2 :] - shift) / 2, near[n : 2 * n].reshape(2, -1).mean(axis=0)
        guess = np.concatenate([half.point(times, speeds, shift), near[2 * n :]])
    places = [*range(n // 2), *range(n, n + n // 2), 2 * n] if n else [0, 1, 2]
    curve = Curve(partial(_equations, half), scales[places], 1.0)
    start = curve.begin(guess)
    if start is None:
        return None
    root = _doubled_along(curve, start, half)
    if root is None:
        return None
    at = root
    if isinstance(closing, Closing) and isinstance(half, Closing):
        at = repeated(half, closing, root)
    away = np.linalg.norm((at - (low + high) / 2) / scales)
    width = np.linalg.norm((high - low) / scales)
    # half a symmetric orbit is one of the model with x -> -x: the whole one tells whether that is the same
    if not away <= 2 * width or np.abs(closing.at(at).miss / scales[n]).max() > SETTINGS.equal:
        return None
    following = [orbit_of(half if closing.k % 2 == 0 else closing, root if closing.k % 2 == 0 else at)]
    if equal:
        following = _alternating(half, closing, root) if n else []
    along = float(search.here.tangent @ ((at - search.here.at) / scales))
    return BranchPoint(PITCHFORK, along, at, following[0] if following else None)


def _doubled_along(curve: Curve, start: Point, half: AnyClosing) -> Array | None:
    """The point next to the start of a curve of orbits at which they double; None where it is not reached."""
    from scipy.optimize import root_scalar

    def secant(value: Callable[[float], float]) -> float:
        def near(length: float) -> float:
            return value(length) if abs(length) < 1 else np.nan

        solution = root_scalar(near, method="secant", x0=0, x1=1e-6, xtol=SETTINGS.arrived, maxiter=SETTINGS.secants)
        return float(solution.root)

    doubling = curve.zero({0.0: start}, lambda _, point: half.at(point.at).characteristic().doubling, secant)
    return None if doubling is None else doubling[1].at


def _crossing(search: StepSearch, crossing: Crossing) -> BranchPoint | None:
    """A branch point by interpolation from both sides."""
    low, high = crossing.low, crossing.high
    root = _cubic_root(low, high)
    for share in SETTINGS.beside:
        beside = share * search.length
        before, after = search.at(max(root - beside, low.along)), search.at(min(root + beside, high.along))
        if before is None or after is None or _value(before) * _value(after) > 0:
            break
        low, high = before, after
        root = _cubic_root(low, high)
    scales = search.tests.scales
    at = _between(low, high, root, search)
    tangent = (low.point.tangent + high.point.tangent) / 2
    tangent /= np.linalg.norm(tangent)
    return _classified(search.tests, Point(at, tangent), scales, root)


def _value(node: Node) -> float:
    return node.tests[TEST].value


def _cubic_root(low: Node, high: Node) -> float:
    """Where the cubic through the branch point test at two points vanishes."""
    width = high.along - low.along
    one, other = (node.tests[TEST] for node in (low, high))
    rates = one.rate * width, other.rate * width
    square, cube = cubic_between(one.value, rates[0], other.value, rates[1])
    if not np.isfinite(square + cube):
        return low.along - one.value / (other.value - one.value) * width
    share = root_between(
        lambda s: one.value + s * (rates[0] + s * (square + s * cube)), 0.0, 1.0, (one.value, other.value)
    )
    return low.along + share * width


def _between(low: Node, high: Node, along: float, search: StepSearch) -> Array:
    """The cubic through two points of the branch along their tangents."""
    width = high.along - low.along
    s = (along - low.along) / width
    scales = search.tests.scales
    rates = [
        node.point.tangent * scales * width / float(node.point.tangent @ search.here.tangent) for node in (low, high)
    ]
    square, cube = cubic_between(low.point.at, rates[0], high.point.at, rates[1])
    return np.asarray(low.point.at + s * (rates[0] + s * (square + s * cube)))


def _classified(tests: EventTests, point: Point, scales: Array, along: float) -> BranchPoint:
    """The kind of a branch point, by one step to each side along the other branch."""
    closing = tests.closing
    across = null_plane(closing.at(point.at).slope * scales, point.tangent)
    curve = Curve(partial(_equations, closing), scales, 10 * APART)
    sides = [curve.beyond(Point(point.at, sign * across), APART) for sign in (1.0, -1.0)]
    if sides[0] is None or sides[1] is None:
        return BranchPoint(BRANCH_POINT, along, point.at, None)
    ahead, behind = (float(side[0].at[-1]) for side in sides if side is not None)
    slope = (ahead - behind) / (2 * APART * scales[-1])
    turning = min(abs(slope), abs(float(point.tangent[-1]))) < SETTINGS.level
    try:
        other = orbit_of(closing, sides[0][0].at)
    except ArithmeticError:  # at rest
        other = None
    return BranchPoint(PITCHFORK if turning else TRANSCRITICAL, along, point.at, other)
