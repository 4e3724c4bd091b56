"""Periodic orbits from which a search starts: all of one or two impacts of a linear model, and by Newton's method.

Two impacts, isolated by balls: x - c of a flight is u(tau, t) + v B(t), so the two conditions on velocities,

    r (v_1 B'(t) + u'(tau, t)) + v_2 = 0,   r (v_2 B'(s) + u'(tau + t, s)) + v_1 = 0,     t + s = k P,

give v_1 and v_2, and the two on heights are equations in tau and t alone. They hold at t = 0 and at s = 0 for every
tau. By Rolle's theorem another zero on the way there needs one of the derivative, so a box whose hull with t = 0 has
none holds no orbit; nor does one over which v_1 or v_2 is negative.

One impact, in closed form: with T = k P fixed, x(T) - c and x'(T) are linear in v and in the cosines and sines of the
launch phase,

    v B + L_1(tau) = 0,   v (B' + 1/r) + L_2(tau) = 0,      so L_2 B - L_1 (B' + 1/r) = 0,

a trigonometric polynomial in tau, whose roots are eigenvalues.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra import (
    DOUBLES,
    Array,
    Balls,
    Expression,
    Power,
    Recorder,
    add,
    as_float,
    balls_at,
    derivative,
    evaluate,
    multiply,
    number,
    substitute,
    subtract,
)
from singimpact.algebra.isolated_zeros import SETTINGS as BOXES, IsolatedZeros, isolated_zeros
from singimpact.branches.closing import Closing
from singimpact.branches.resting import free_orbits
from singimpact.flights import ends, rebound_slope, variations
from singimpact.flights.family import LinearFamily, SteppedFamily, family
from singimpact.flights.impact_map import impact_map
from singimpact.oscillator import TAU, Oscillator, T, acceleration, linear_flight, linear_form

SEARCH = replace(BOXES, bits=64, least=Fraction(1, 2**18))
EDGE = Fraction(1, 16)  # of the window of tau beyond each end of a period: no zero is on an edge


class TwoFlights(NamedTuple):
    """x - c at the ends of both flights and the velocities after the impacts, as formulas in tau and t; k P."""

    heights: tuple[Expression, Expression]
    speeds: tuple[Expression, Expression]
    span: Expression


def two_impacts(osc: Oscillator, k: int) -> tuple[list[Array], IsolatedZeros] | None:
    """All solutions as points (tau_1, tau_2, v_1, v_2), and the boxes that are left; None without the formulas.

    Parameters
    ----------
    osc : a linear model with a period and a number for restitution.

    Examples
    --------
    >>> found, boxes = two_impacts(Oscillator("x", "-cos(2.8*t)", "1/10", "4/5"), 2)
    >>> len(found), boxes.complete
    (5, True)
    """
    flights = _formulas(osc, k)
    if flights is None:
        return None
    period = as_float(osc.period)
    with balls_at(SEARCH.bits):
        end = evaluate(flights.span, {}, Balls(SEARCH.bits))
        window = (-Fraction(period) * EDGE, Fraction(period) * (1 + EDGE)), (Fraction(0), Fraction(k * period))
        excluded = _Excluded(flights, end)
        zeros = isolated_zeros(flights.heights, ("tau", "t"), window, excluded=excluded, settings=SEARCH)
        points = []
        for tau, t in zeros.found:
            v, after = excluded.speeds({"tau": tau, "t": t})
            points.append(np.array([float(number.mid()) for number in (tau, tau + t, v, after)]))
    return points, zeros


def _formulas(osc: Oscillator, k: int) -> TwoFlights | None:
    form = linear_form(osc)
    assert form is not None
    assert osc.period is not None
    flight = linear_flight(form, osc.clearance)
    if flight is None:
        return None
    r, span = osc.restitution, multiply(number(k), osc.period)
    later = {"tau": add(TAU, T), "t": subtract(span, T)}
    u, B = (
        (flight.from_rest, substitute(flight.from_rest, later)),
        (flight.by_speed, substitute(flight.by_speed, later)),
    )
    slope, rate = derivative(flight.from_rest, "t"), derivative(flight.by_speed, "t")
    du, dB = (slope, substitute(slope, later)), (rate, substitute(rate, later))
    # Cramer's rule for v_1 and v_2; 1 - r^2 B' B' is the determinant
    shared = Power(subtract(number(1), multiply(r, r, *dB)), number(-1))
    speeds = tuple(multiply(shared, subtract(multiply(r, r, dB[1 - i], du[i]), multiply(r, du[1 - i]))) for i in (0, 1))
    heights = tuple(add(u[i], multiply(speeds[i], B[i])) for i in (0, 1))
    return TwoFlights((heights[0], heights[1]), (speeds[0], speeds[1]), span)


class _Excluded:
    """Whether a box of (tau, t) is proved to hold no orbit."""

    def __init__(self, flights: TwoFlights, end: Any) -> None:
        recorder = Recorder()
        slopes = [derivative(height, "t") for height in flights.heights]
        self.speeds = recorder.program([recorder.record(tree) for tree in flights.speeds]).prepared({})
        self.slopes = recorder.program([recorder.record(tree) for tree in slopes]).prepared({})
        self.end = end

    def __call__(self, place: tuple[Any, ...]) -> bool:
        tau, t = place
        if any(speed < 0 for speed in self.speeds({"tau": tau, "t": t})):
            return True
        sides = ((0, 0), (1, self.end))  # which height vanishes there for every tau
        near = [(which, edge) for which, edge in sides if abs(t - edge).upper() < abs(self.end) / 8]
        return any(not self.slopes({"tau": tau, "t": t.union(edge)})[which].contains(0) for which, edge in near)


# ---- one impact, in closed form


def phases_and_speeds(osc: Oscillator, k: int) -> tuple[Array, Array] | None:
    """Phases in [0, period) and velocities of all solutions, virtual ones too; None where there is a continuum.

    Parameters
    ----------
    osc : a linear model with a period and a number for restitution.

    Examples
    --------
    >>> tau, v = phases_and_speeds(Oscillator("x", "cos(4*t)", 0, "0.5"), 2)
    >>> [round(float(each), 12) for each in v]
    [-0.533333333333, 0.533333333333]
    """
    flights, period, r = family(osc), np.array([as_float(osc.period)]), np.array([as_float(osc.restitution)])
    assert isinstance(flights, LinearFamily)
    (tau,), (v,), (continuum,) = one_impact(flights, {}, (period, r), k)
    roots = np.isfinite(tau)
    return None if continuum else (tau[roots], v[roots])


def one_impact(
    flights: LinearFamily, values: Mapping[str, Array], laws: tuple[Array, Array], k: int
) -> tuple[Array, Array, Array]:
    """Phases and velocities of all solutions of each member, nan where there are fewer; whether there is a continuum.

    Parameters
    ----------
    values : name -> numbers of the members, shape (m,). laws : their periods and restitutions, shape (m,).
    """
    (period, r), p = laws, flights.constants(values)
    flow = flights.flow(values, k * period)[:, :2]
    rebounds = r > 0  # else the second equation times r: v = 0
    by_v = np.stack([flow[:, 0, 1], np.where(rebounds, flow[:, 1, 1] + 1 / np.where(rebounds, r, 1.0), 1.0)], axis=1)
    waves = [(np.broadcast_to(p[i], period.shape), p[i + 1]) for i in range(3, len(p), 4)]
    degrees = [round(abs(rate[0]) * period[0] / (2 * np.pi)) for rate, _ in waves]
    size = max(degrees, default=0)
    # the coefficients of e^{i m omega tau}, m = -size ... size, of L_1 and L_2
    series = np.zeros((period.size, 2, 2 * size + 1), dtype=complex)
    series[..., size] = flow[..., 2]
    for j, ((rate, phase), degree) in enumerate(zip(waves, degrees, strict=True)):
        turned = (flow[..., 3 + 2 * j] - 1j * flow[..., 4 + 2 * j]) / 2
        turned *= np.broadcast_to(np.exp(1j * np.asarray(phase)), period.shape)[:, None]
        turned = np.where(rate[:, None] > 0, turned, np.conj(turned))
        series[..., size + degree] += turned
        series[..., size - degree] += np.conj(turned)
    series[:, 1] *= rebounds[:, None]
    total = series[:, 1] * by_v[:, :1] - series[:, 0] * by_v[:, 1:]
    scale = np.abs(series).max(axis=(1, 2)) * np.abs(by_v).max(axis=1)
    continuum = np.abs(total).max(axis=1) <= 1e-13 * scale
    total[continuum] = np.nan
    angles = _refined(_near(total), total, size)
    turns = np.exp(1j * angles[..., None] * np.arange(-size, size + 1))
    parts = (turns @ series.transpose(0, 2, 1)).real
    row = np.where(rebounds, np.argmax(np.abs(by_v), axis=1), 1)
    every = np.arange(period.size)
    v = -parts[every, :, row] / by_v[every, row, None] + 0.0
    return np.mod(angles, 2 * np.pi) * period[:, None] / (2 * np.pi), v, continuum


def _near(total: Array) -> Array:
    """Real roots of real trigonometric polynomials and near them, from coefficients of e^{i m angle}; nan of fewer."""
    if total.shape[1] == 3:  # a + b cos(angle + shift)
        with np.errstate(all="ignore"):
            share = -total[:, 1].real / (2 * np.abs(total[:, 2]))
        turn = np.arccos(np.where(np.abs(share) > 1 + 1e-9, np.nan, np.clip(share, -1, 1)))
        return np.asarray(np.stack([turn, -turn], axis=1) - np.angle(total[:, 2:]))
    angles = np.full((len(total), total.shape[1] - 1), np.nan)
    for row in np.flatnonzero(np.isfinite(total).all(axis=1)).tolist():
        one = total[row]
        roots = np.roots(np.trim_zeros(np.where(np.abs(one) < 1e-15 * np.abs(one).max(), 0, one))[::-1])
        near = np.angle(roots[np.abs(np.abs(roots) - 1) < 1e-6])
        angles[row, : near.size] = near
    return angles


def _refined(angles: Array, total: Array, size: int) -> Array:
    """Real roots of real trigonometric polynomials near these angles, each once; nan where there was none."""
    orders = 1j * np.arange(-size, size + 1)
    at, columns = angles.copy(), np.stack([total, orders * total], axis=-1)
    with np.errstate(all="ignore"):
        for _ in range(50):
            values = (np.exp(at[..., None] * orders) @ columns).real
            step = values[..., 0] / values[..., 1]
            at = at - np.clip(step, -0.1, 0.1)
            if not (np.abs(step) > 1e-15).any():
                break
        left = np.abs((np.exp(at[..., None] * orders) @ columns)[..., 0].real)
        good = left <= 1e-13 * np.abs(total).sum(axis=1)[:, None]
        roots = np.sort(np.where(good, np.mod(at, 2 * np.pi), np.nan), axis=1)
        for i, j in combinations(range(roots.shape[1]), 2):
            gap = np.abs(roots[:, j] - roots[:, i])
            roots[np.minimum(gap, 2 * np.pi - gap) <= 1e-9, j] = np.nan
    return roots


# Newton's method on the closing conditions from many starts: a grid of states, and grazes of simpler orbits.


@dataclass(frozen=True)
class StartSettings:
    """Starts and tolerances of Newton's method."""

    # phases of the grid, and velocities from 1e-3 of the fastest to the fastest
    phases: int = 48
    speeds: int = 16
    # the same of a model without a closed form, whose flights may be interpreted still; and how many starts, those of
    # the shortest first steps, are followed
    fewer: tuple[int, int] = (20, 8)
    kept: int = 80
    # further, smaller velocities, for orbits that nearly graze
    weak: tuple[float, ...] = (1e-12, 1e-8, 1e-5)
    # a start is flown when its n impacts take this part of the time in which it must close
    span: tuple[float, float] = (0.4, 1.8)
    rounds: int = 25
    # rounds after which points with larger relative steps are dropped
    slow: tuple[int, float] = (9, 0.1)
    # largest change of a phase in one round, in periods
    longest: float = 0.15
    # relative tolerance
    arrived: float = 1e-12
    # distance of equal points
    apart: float = 1e-8


SETTINGS = StartSettings()


def grid_of_starts(closing: Closing, tau: Any = None, v: Any = None) -> Array:
    """Points to start from, shape (m, 2n).

    Parameters
    ----------
    tau, v : states of the first impact; a grid of phases and velocities without them.
    """
    osc, n = closing.family.osc, closing.n
    period = closing.family.period({}).value
    span = closing.k * period
    if tau is None:
        linear = isinstance(closing.family, LinearFamily)
        count, speed_count = (SETTINGS.phases, SETTINGS.speeds) if linear else SETTINGS.fewer
        if osc.plastic:
            count, speed_count = count * speed_count, 0
        phases = np.linspace(0, period, count, endpoint=False)
        fast = float(np.abs(acceleration(osc, phases)).max()) * span / n
        speeds = fast * np.concatenate([SETTINGS.weak, np.geomspace(1e-3, 1, speed_count)]) if speed_count else 0.0
        tau, v = (coordinates.ravel() for coordinates in np.meshgrid(phases, speeds))
    else:
        tau, v = np.asarray(tau, dtype=float), np.asarray(v, dtype=float)
    points = np.stack([tau, v], axis=1) if n == 1 else _flown(osc, tau, v, n, span)
    return np.concatenate([points, _grazes(closing)]) if n < 9 and not osc.plastic else points


def _flown(osc: Oscillator, tau: Array, v: Array, n: int, span: float) -> Array:
    """n impacts of the true map from each start; sequences that take far more or less than the span are left out."""
    times, speeds = [tau], [v]
    for _ in range(n):
        step = impact_map(osc, times[-1], speeds[-1], horizon=2 * span)
        good = np.isfinite(step.tau) & np.isfinite(step.v)
        times.append(np.where(good, step.tau, np.nan))
        speeds.append(np.where(good, step.v, 0.0))
        times[-1][~good], speeds[-1][~good] = 0.0, 0.0
    share = (times[-1] - times[0]) / span
    chosen = (share > SETTINGS.span[0]) & (share < SETTINGS.span[1])
    # the span is met by stretching the flights alike
    stretched = [times[0] + (phases - times[0]) / np.where(chosen, share, 1.0) for phases in times[:-1]]
    return np.stack([*stretched, *speeds[:-1]], axis=1)[chosen]


def _grazes(closing: Closing) -> Array:
    """Points of orbits with one impact less, and with an impact of no velocity at the lowest place of a flight."""
    n, k, points = closing.n, closing.k, list[Array]()
    if n == 1:
        for orbit in free_orbits(closing.family.osc, k, lowest_only=True):
            points += [np.array([float(tau), 0.0]) for tau in np.atleast_1d(orbit.tau)]
        return np.array(points).reshape(-1, 2)
    simpler = Closing(closing.family, n - 1, k)
    for point in closed_from(simpler, grid_of_starts(simpler)):
        for i, (time, height) in enumerate(simpler.heights(point)):
            if np.isfinite(height):
                times = np.insert(point[: n - 1], i + 1, point[i] + time)
                speeds = np.insert(point[n - 1 :], i + 1, 0.0)
                points.append(np.concatenate([times, speeds]))
    return np.array(points).reshape(-1, 2 * n)


def conditions(closing: Closing, points: Array) -> tuple[Array, Array]:
    """Miss and slope of many points, shapes (m, 2n) and (m, 2n, 2n), as `Closing.at` gives them; nan where T <= 0."""
    osc, n, m = closing.family.osc, closing.n, len(points)
    period = closing.family.period({}).value
    times = np.concatenate([points[:, :n], points[:, :1] + closing.k * period], axis=1)
    if osc.upper is not None:
        loops = [closing.at(point) for point in points]
        late = np.all(np.diff(times, axis=1) > 0, axis=1, keepdims=True)
        miss = np.array([loop.miss for loop in loops])
        return np.where(late, miss, np.nan), np.array([loop.slope for loop in loops])
    launches, spans, speeds = (block.ravel() for block in (times[:, :n], np.diff(times, axis=1), points[:, n:]))
    launches = launches - period * np.floor(launches / period)
    spans = np.where(spans > 0, spans, np.nan)
    position, speed, bend = ends(osc, launches, speeds, spans)
    by_v, by_v_dot, by_tau, by_tau_dot = variations(osc, launches, speeds, spans).T
    with np.errstate(all="ignore"):
        # the same blocks as `Closing.at`, for many points at once
        factor = rebound_slope(osc, speed)
        miss = np.empty((m, 2 * n))
        miss[:, ::2] = position.reshape(m, n)
        after = evaluate(osc.rho(), {"v": speed}, DOUBLES) + 0 * speed
        miss[:, 1::2] = after.reshape(m, n) - np.roll(points[:, n:], -1, axis=1)
    slope = np.zeros((m, 2 * n, 2 * n))
    parts = [
        block.reshape(m, n)
        for block in (by_tau - speed, factor * (by_tau_dot - bend), by_v, factor * by_v_dot, speed, factor * bend)
    ]
    for i in range(n):
        after = (i + 1) % n
        for pair, column in enumerate((i, n + i, after)):  # by tau and v at the launch, and by tau at the impact
            slope[:, 2 * i, column] += parts[2 * pair][:, i]
            slope[:, 2 * i + 1, column] += parts[2 * pair + 1][:, i]
        slope[:, 2 * i + 1, n + after] -= 1.0
    return miss, slope


def closed_from(closing: Closing, points: Array) -> list[Array]:
    """The solutions that Newton's method finds from these points, each once, virtual ones too."""
    n, period = closing.n, closing.family.period({}).value
    solutions: list[Array] = []
    at = points
    for count in range(SETTINGS.rounds):
        if not len(at):
            break
        miss, slope = conditions(closing, at)
        good = np.isfinite(miss).all(axis=1) & np.isfinite(slope).all(axis=(1, 2))
        at, miss, slope = at[good], miss[good], slope[good]
        step, regular = _solved(slope, miss)
        at, step = at[regular], step[regular]
        fast = np.maximum(np.abs(at[:, n:]).max(axis=1, initial=0.0), 1e-300)
        with np.errstate(over="ignore"):  # a start with v = 0
            size = np.maximum(np.abs(step[:, :n]).max(axis=1) / period, np.abs(step[:, n:]).max(axis=1) / fast)
        if count == 0 and isinstance(closing.family, SteppedFamily) and len(at) > SETTINGS.kept:
            best = np.argsort(size, kind="stable")[: SETTINGS.kept]
            at, step, size = at[best], step[best], size[best]
        longest = np.abs(step[:, :n]).max(axis=1) / period
        at = at - step * np.minimum(1.0, SETTINGS.longest / np.maximum(longest, 1e-300))[:, None]
        arrived = size < SETTINGS.arrived
        solutions += list(at[arrived])
        at = at[~arrived & (size < (1e6 if count < SETTINGS.slow[0] else SETTINGS.slow[1]))]
    return _distinct(solutions, n, period)


def _solved(slope: Array, miss: Array) -> tuple[Array, Array]:
    """Newton's steps, and which of them there are."""
    size = np.abs(slope).max(axis=(1, 2))
    # powers of two round nothing, so that det and solve see the same pivots: solve raises where one is 0
    scale = np.exp2(np.floor(np.log2(np.where(size > 0, size, 1.0))))[:, None, None]
    regular = (size > 0) & (np.abs(np.linalg.det(slope / scale)) > 1e-25)
    steps = np.full(miss.shape, np.nan)
    if regular.any():
        steps[regular] = np.linalg.solve((slope / scale)[regular], (miss[:, :, None] / scale)[regular])[:, :, 0]
    return steps, regular & np.isfinite(steps).all(axis=1)


def _distinct(points: list[Array], n: int, period: float) -> list[Array]:
    """Each point once, its first phase within a period."""
    kept: dict[tuple[int, ...], Array] = {}
    for point in points:
        moved = point.copy()
        moved[:n] -= period * np.floor(moved[0] / period)
        fast = max(float(np.abs(moved[n:]).max()), 1e-300)
        rounded = np.concatenate([moved[:n] / period, moved[n:] / fast, [np.log(fast)]]) / SETTINGS.apart
        kept.setdefault(tuple(np.rint(rounded).astype(np.int64).tolist()), moved)
    return list(kept.values())
