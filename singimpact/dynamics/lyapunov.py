"""Lyapunov exponents of an orbit of the impact map, from D G along it.

    det D G = -rho'(u) (v/|u|) exp(-int f_v dt) = r^2 (v/v') exp(-int f_v dt)   for rho = -r u

so both exponents together are the mean rate at which areas shrink; the second one is this rate less the first one, for
the entries of D G keep too few digits of a strong contraction. D G comes with the flights of linear models and from the
variational equation of others.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array, compare
from singimpact.dynamics.attractors import apart
from singimpact.dynamics.chatter import ENDING, chatter_limit
from singimpact.dynamics.lift_off import periods_between, release
from singimpact.dynamics.phases import phases_of
from singimpact.dynamics.remaining import chatter_completes
from singimpact.flights.compiled_model import compiled_model
from singimpact.flights.derivative import derivative, log_determinant
from singimpact.flights.impact_map import impact_map
from singimpact.flights.orbits import Ends, Segment, iterates, orbit_segment
from singimpact.flights.rebound_law import rebound_slope
from singimpact.flights.states import States
from singimpact.flights.walls import wall_codes
from singimpact.inputs import InputError, checked_keywords, refuse, shown, takes_two_walls, whole
from singimpact.oscillator.model import Oscillator
from singimpact.result import Result
from singimpact.status import Status


@dataclass(frozen=True)
class LyapunovSettings:
    """Settings of the sums of growth along an orbit."""

    # impacts of one call into compiled code; their slopes take 6 MB
    block: int = 65_536
    # stretches of one block whose products are formed side by side
    stretches: int = 256
    # groups of stretches whose spread gives the standard error
    groups: int = 32
    # impacts of a transient at most: a chaotic one of x'' + x = cos 3.3t, c = 0.03, r = 0.95 lasts 3800 (median)
    transient: int = 20_000
    # impacts between two looks whether the orbit has settled, doubled each time
    look: int = 500
    # longest period, and relative distance of states that repeat
    period: int = 64
    close: float = 1e-9
    # impacts in which the vector that is followed turns into its direction
    turn: int = 100
    # how often the impacts are flown anew when their halves differ by more than so many standard errors
    again: int = 3
    apart: float = 4.0
    # rests after which an orbit is said to rest again and again, where the forcing never repeats
    rests: int = 8
    # roundings of the growth in an impact
    rounded: float = 4.0


SETTINGS = LyapunovSettings()
SMALLEST = float(np.finfo(float).tiny)


@dataclass(frozen=True, eq=False)
class Lyapunov(Result):
    """Both Lyapunov exponents of an orbit.

    Parameters
    ----------
    exponents : per unit of time, the larger first, shape (2,); -inf where the orbit comes to rest again and again, for
        what follows a rest does not depend on what was before; nan where no impact was flown.
    error : standard errors of `exponents`, from the spread of groups of impacts, and their rounding; nan with fewer
        than two groups.
    impacts, time : how many impacts the exponents are taken over, and how long they last.
    start, last : the states (tau, v) before and after these impacts.
    status : `hit` where all impacts were flown, `sticks` of an orbit that comes to rest, else the status of the flight
        that ended the orbit. The exponents are those of the impacts before it.
    superstable : whether the orbit lifts off twice at one phase of the forcing (eight times, where the forcing never
        repeats), or rests for ever.
    transient : impacts flown before. converged : whether the larger exponents of both halves of the impacts agree
        within their errors; where they do not, the orbit has not settled: give more impacts or a longer transient.
    """

    exponents: Array
    error: Array
    impacts: int
    time: float
    start: tuple[float, float]
    last: tuple[float, float]
    status: Any
    superstable: bool
    transient: int = 0
    converged: bool = True

    def as_dict(self) -> dict[str, Any]:
        """The fields, and the exponents per impact."""
        values = super().as_dict()
        return {
            "exponents": values.pop("exponents"),
            "error": values.pop("error"),
            "per_impact": self.per_impact,
        } | values

    @property
    def per_impact(self) -> Array:
        """The exponents per impact."""
        return self.exponents * (self.time / self.impacts if self.impacts else 1.0)

    def __repr__(self) -> str:
        if self.superstable:
            return f"Lyapunov(superstable: the orbit comes to rest, {self.impacts} impacts)"
        each = ", ".join(f"{value:.6g} +- {error:.2g}" for value, error in zip(self.exponents, self.error, strict=True))
        ended = "" if self.status == Status.hit else f", ended by {Status(int(self.status)).name}"
        doubt = "" if self.converged else ", not converged: the halves differ, give more impacts"
        return f"Lyapunov({each} per unit of time, {self.impacts} impacts after {self.transient}{ended}{doubt})"


@checked_keywords
@takes_two_walls
def lyapunov(
    osc: Oscillator, tau: Any, v: Any, impacts: int = 10_000, *, transient: int | None = None, wall: Any = None
) -> Lyapunov:
    """The Lyapunov exponents of the orbit of a state.

    Parameters
    ----------
    osc : the model. tau, v : the state, v >= 0. impacts : flown, with D G, after `transient` others. Without a
        transient the orbit is followed until it repeats, at most 20 000 impacts, then flown anew while both halves
        differ. wall : of the state, of a model with two walls: "lower" (also without it) or "upper".

    Returns
    -------
    Lyapunov : `.exponents` per unit of time, `.per_impact`, `.error`, `.status`, `.superstable`, `.transient`,
        `.converged`.

    Notes
    -----
    After a rest the sums begin anew at the lift-off. The exponents are those of the flow in x, x' and the phase,
    without the one that is 0.

    Examples
    --------
    >>> found = lyapunov(Oscillator("x", "cos(4*t)", 0, "1/2"), 0, 1, 1000, transient=100)
    >>> found.exponents.round(6).tolist()  # ln(1/2) an impact, every two periods
    [-0.220636, -0.220636]
    """
    if not isinstance(osc, Oscillator):
        raise refuse("osc", osc, "an ImpactOscillator")
    states = States.read(tau, v).in_period(osc)
    if states.shape:
        raise InputError(f"tau and v have shape {states.shape}: an orbit starts from one state, give two numbers")
    flown = whole("impacts", impacts, 1, 10**8)
    codes = wall_codes(osc, wall)
    if codes.shape:
        raise refuse("wall", wall, "one wall: an orbit starts from one state")
    run = _Run(osc, states, int(codes))
    if transient is None:
        return run.settled(flown)
    run.fly(whole("transient", transient, 0, 10**8), keep=False)
    run.begin()
    run.fly(flown, keep=True)
    return run.result()


@dataclass
class _Sums:
    """Growth over stretches of impacts: impacts, time, ln of the first diagonal entry of R, ln |det|."""

    direction: Array = field(default_factory=lambda: np.array([1.0, 0.0]))
    rows: list[Array] = field(default_factory=list)

    def add(self, matrices: Array, times: Array, areas: Array) -> None:
        """D G of impacts, shape (n, 2, 2), their flight times, and ln |det D G|."""
        n = times.size
        length = -(-n // SETTINGS.stretches)
        count = -(-n // length)
        padded = np.broadcast_to(np.eye(2), (count * length, 2, 2)).copy()
        padded[:n] = matrices
        # entry by entry, a row of stretches each: products of 2 x 2 matrices as sums of arrays
        a, b, c, d = (np.ascontiguousarray(padded[:, i, j].reshape(count, length).T) for i in (0, 1) for j in (0, 1))
        p, q, r, s, size = np.ones(count), np.zeros(count), np.zeros(count), np.ones(count), np.zeros(count)
        for k in range(length):
            p, q, r, s = a[k] * p + b[k] * r, a[k] * q + b[k] * s, c[k] * p + d[k] * r, c[k] * q + d[k] * s
            scale = np.sqrt(p * p + q * q + r * r + s * s)
            p, q, r, s = p / scale, q / scale, r / scale, s / scale
            size += np.log(scale)
        starts = np.arange(0, n, length)
        lasting, shrunk = np.add.reduceat(times, starts), np.add.reduceat(areas, starts)
        for k, product in enumerate(np.stack([p, q, r, s], axis=1).reshape(-1, 2, 2)):
            moved = product @ self.direction
            length_of = max(float(np.hypot(*moved)), SMALLEST)  # 0 where roundings cancel
            self.direction = moved / length_of
            row = min(length, n - starts[k]), lasting[k], size[k] + np.log(length_of), shrunk[k]
            self.rows.append(np.array(row))


class _Run:
    """An orbit that is being flown, and the growth along it."""

    def __init__(self, osc: Oscillator, states: States, wall: int) -> None:
        self.osc, self.given, self.wall = osc, states.given(0), wall
        self.models = (osc,) if osc.upper is None else (osc, osc.mirrored)
        self.tau, self.v = float(states.tau[0]), float(states.v[0])
        self.before = 0  # impacts of the transient
        self.first, self.lifted, self.status = True, list[tuple[float, int]](), Status.hit
        # one r = 1 is enough: such a wall has no chatter that ends
        self.near = 0.0 if any(compare(model.slope_at_rest(), 1) == 0 for model in self.models) else ENDING.near
        if not self.near and any(chatter_completes(model) for model in self.models):
            raise InputError(
                f"restitution = {shown(str(osc.restitution))} is not accepted: exponents need r < 1, or r = 1 without "
                "the power q < 1 of the speed by which chatter comes to rest"
            )
        self.begin()

    @property
    def here(self) -> Oscillator:
        """The model whose lower wall is the wall of the state."""
        return self.models[self.wall]

    def begin(self, direction: Array | None = None) -> None:
        """Sums from the present state on."""
        self.sums = _Sums() if direction is None else _Sums(direction)
        self.start, self.flown = (self.tau, self.v), 0

    def settled(self, impacts: int) -> Lyapunov:
        """The exponents of what the orbit settles to."""
        block = SETTINGS.look
        while self.before < SETTINGS.transient and self.status == Status.hit and not self._repeats():
            block = min(block, SETTINGS.transient - self.before)
            self.fly(block, keep=False)
            self.before, block = self.before + block, 2 * block
        for _ in range(SETTINGS.again):
            self.begin()
            self.fly(min(SETTINGS.turn, impacts), keep=True)
            if self.status == Status.hit:
                self.begin(self.sums.direction)
                self.fly(impacts, keep=True)
            result = self.result()
            if result.converged or self.status != Status.hit:
                return result
            self.before += impacts
        return result

    def _repeats(self) -> bool:
        """Whether the state comes back after some impacts."""
        plastic = self.osc.plastic
        if not (self.v > 0 or plastic) or not self.before:
            return False
        ahead: Ends | Segment
        if plastic:
            ahead = iterates(self.osc, self.tau, self.v, SETTINGS.period, True)
        else:
            ahead = orbit_segment(self.osc, self.tau, self.v, SETTINGS.period, wall=self.wall)
        last = slice(-SETTINGS.period, None)
        away = apart((ahead.tau[last], ahead.v[last]), (self.tau, self.v), phases_of(self.osc), self.v or 1.0)
        same = True if ahead.wall is None else ahead.wall[last] == self.wall
        return bool(((away < SETTINGS.close) & same).any())

    def fly(self, most: int, keep: bool) -> None:
        """So many impacts, fewer where the orbit ends or is seen to come to rest again and again."""
        done, near, block = 0, self.near, SETTINGS.block
        while done < most and self.status == Status.hit:
            if self.osc.plastic:
                done += self._landed(min(most - done, SETTINGS.look), keep)
                continue
            if not self.v > 0:
                done += self._mapped(keep)
                continue
            segment = orbit_segment(self.osc, self.tau, self.v, min(most - done, block), near, self.wall)
            done += self._flew(segment, keep)
            near, block = self.near, SETTINGS.block
            if done == most:
                return
            if segment.short:
                end = chatter_limit(self.here, self.tau, self.v)
                if end.status == Status.complete:
                    self._rest(float(end.tau))
                else:  # contact is lost before the impacts accumulate: they are flown
                    near, block = 0.0, int(end.impacts) + 1
            elif segment.status:
                done += self._mapped(keep)

    def _flew(self, segment: Segment, keep: bool) -> int:
        count = segment.tau.size
        if not count:
            return 0
        launches = np.append(self.tau, segment.tau[:-1]), np.append(self.v, segment.v[:-1])
        walls = np.append(np.int8(self.wall), segment.wall[:-1])
        self.tau, self.v, self.first = float(segment.tau[-1]), float(segment.v[-1]), False
        self.wall = int(segment.wall[-1])
        if not keep:
            return count
        shrunk = log_determinant(self.osc, *launches, segment.flight_time, segment.velocity, walls)
        self.sums.add(_matrices(self.osc, segment, *launches, walls), segment.flight_time, shrunk)
        self.flown += count
        return count

    def _landed(self, most: int, keep: bool) -> int:
        """Impacts that leave no velocity, up to one after which the mass rests."""
        tau, v = self.given if self.first else (self.tau, self.v)
        rows = iterates(self.osc, tau, v, most, True)
        count = int(np.count_nonzero(np.diff(rows.tau)))
        launches, self.first = (rows.tau[:count], rows.v[:count]), False
        self.tau, self.v = float(rows.tau[count]), float(rows.v[count])
        if keep and count:
            self.sums.add(
                derivative(self.osc, *launches).matrix, np.diff(rows.tau[: count + 1]), np.full(count, -np.inf)
            )
            self.flown += count
        if rows.status == Status.sticks:
            self._rest(self.tau)
            if self.status == Status.hit:  # the impacts after a lift-off do not depend on the orbit before
                self.begin()
        elif rows.status:
            self.status = Status(int(rows.status))
        return count

    def _mapped(self, keep: bool) -> int:
        """One flight by the impact map, which decides what an orbit leaves open: a rest, a flight near a graze."""
        launch_state = self.given if self.first else (self.tau, self.v)
        here = self.here
        step = impact_map(here, *launch_state)
        self.first = False
        if step.status == Status.sticks:
            self._rest(self.tau)
            return 0
        self.status = Status(int(step.status))
        if self.status != Status.hit:
            return 1
        rest, before = self.v == 0, (self.tau, self.v)
        self.tau, self.v = float(step.tau), float(step.v)
        self.wall ^= 0 if step.wall is None else int(step.wall)
        if rest:  # the impact after a lift-off does not depend on the orbit before: the sums begin there
            self.begin()
        elif keep:
            launch = np.array([before[0]]), np.array([before[1]])
            flight = np.array([float(step.flight_time)]), np.array([float(step.velocity)])
            shrunk = log_determinant(here, *launch, *flight)
            self.sums.add(derivative(here, *before).matrix[None], flight[0], shrunk)
            self.flown += 1
        return 1

    def _rest(self, at: float) -> None:
        lifted = release(self.here, at)
        # what follows a lift-off is fixed: one at a phase of an earlier one comes again and again
        earlier = [phase for phase, wall in self.lifted if wall == self.wall]
        again = any(periods_between(self.osc, phase, lifted) is not None for phase in earlier)
        again |= self.osc.period is None and len(self.lifted) + 1 == SETTINGS.rests
        if again or not np.isfinite(lifted):
            self.status = Status.unresolved if np.isnan(lifted) else Status.sticks
        self.lifted.append((lifted, self.wall))
        self.tau, self.v = (lifted if np.isfinite(lifted) else at), 0.0
        self.first = False

    def result(self) -> Lyapunov:
        superstable = self.status == Status.sticks
        time, last = self.tau - self.start[0], (self.tau, self.v)
        nothing = np.full(2, -np.inf if superstable else np.nan)
        exponents, error, converged = nothing, np.full(2, 0.0 if superstable else np.nan), True
        if self.sums.rows and not superstable:
            rows = np.array(self.sums.rows)
            exponents, error = _exponents(rows, time)
            converged = _halves_agree(rows)
        return Lyapunov(
            exponents,
            error,
            self.flown,
            time,
            self.start,
            last,
            np.int8(self.status),
            superstable,
            self.before,
            converged,
        )


def _halves_agree(rows: Array) -> bool:
    """Whether the larger exponents of both halves differ by no more than their errors, and than a turn of the vector.

    A periodic orbit has no spread; the vector that is followed turns there by a bounded angle, which moves the mean by
    the inverse of the time.
    """
    middle = len(rows) // 2
    if middle < 2:
        return True
    halves = [_exponents(half, float(half[:, 1].sum())) for half in (rows[:middle], rows[middle:])]
    times = rows[:middle, 1].sum(), rows[middle:, 1].sum()
    (one, error), (other, spread) = halves
    allowed = SETTINGS.apart * np.hypot(error[0], spread[0]) + 1 / min(times)
    return bool(abs(one[0] - other[0]) <= allowed)


def _matrices(osc: Oscillator, found: Segment, tau: Array, v: Array, wall: Array) -> Array:
    """D G of the impacts of a segment, shape (n, 2, 2)."""
    if not compiled_model(osc).linear:
        return np.asarray(derivative(osc, tau, v, wall=None if osc.upper is None else wall).matrix)
    slope = rebound_slope(osc, found.velocity)
    by_tau, by_v, speed_by_tau, speed_by_v = found.slopes
    return np.stack([1 + by_tau, by_v, slope * speed_by_tau, slope * speed_by_v], axis=-1).reshape(-1, 2, 2)


def _exponents(rows: Array, time: float) -> tuple[Array, Array]:
    """Exponents per unit of time and their standard errors, by groups of stretches of equal number."""
    groups = min(SETTINGS.groups, len(rows))
    parts = np.array([group.sum(axis=0) for group in np.array_split(rows, groups)])
    growth = np.stack([parts[:, 2], parts[:, 3] - parts[:, 2]], axis=1)
    exponents = growth.sum(axis=0) / time
    error = np.full(2, np.nan)
    if groups > 1:
        # of a ratio of sums: what the growth of a group differs by from its time at the mean rate
        with np.errstate(invalid="ignore"):  # where impacts leave no velocity all of a column is -inf
            off = growth - np.outer(parts[:, 1], exponents)
        error = np.sqrt((off**2).sum(axis=0) * groups / (groups - 1)) / time
        error += SETTINGS.rounded * EPSILON * rows[:, 0].sum() / time
        error[np.isneginf(exponents)] = 0.0
    order = np.argsort(-exponents, kind="stable")
    return exponents[order], error[order]
