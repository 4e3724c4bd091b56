"""First hits of arrays of states, and the few that end in no plain hit: at rest, near a graze, escaped, given up."""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Expression, evaluate, subtract
from singimpact.algebra.numbers import Array, constant
from singimpact.algebra.precision import balls_at
from singimpact.flights.causes import decoded, explained
from singimpact.flights.compiled_model import CompiledModel
from singimpact.flights.flat_numbers import EPSILON, gap_of
from singimpact.flights.flight_path import path
from singimpact.flights.kernels.hits import CANCELS, NOT_REFINED
from singimpact.flights.kernels.state import ACROSS
from singimpact.flights.limits import LIMITS
from singimpact.flights.no_return.barrier import kept_up, stays_up
from singimpact.flights.no_return.polynomial import never_returns, never_turns
from singimpact.flights.response import response, usual_errors
from singimpact.flights.results import JUDGED, Flight
from singimpact.flights.states import States
from singimpact.handed_on import flint
from singimpact.oscillator.linear import at_rest, linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.period import reduced
from singimpact.oscillator.wall_acceleration import acceleration
from singimpact.status import Cause, Status

# Codes and columns of hits, as `CompiledModel.hits` returns them
Flown = tuple[Array, Array]
# Fields that are filled of every flight
PLAIN = ("flight_time", "velocity", "status", "cause", "notes")
# Of its size: so far a hit in doubles is from the true one at most, where it is isolated
NEAR = Fraction(1, 10**7)
# Of Halley's method at most: next to a graze the first ones are not short
STEPS = 6


@dataclass(frozen=True)
class Fates:
    """Flights as they are decided, one column a state.

    Parameters
    ----------
    status, cause : int8. rows : columns of hits, see `kernels.state`; of a flight without a hit the first four are
        time, velocity (or x'), depth (or x - c) and bound. Of a hit of an upper wall the velocity is > 0.
    above : bool, whether a flight that comes near a wall comes near the upper one.
    """

    status: Array
    cause: Array
    rows: Array
    above: Array

    @staticmethod
    def of(codes: Array, rows: Array) -> "Fates":
        """Flights as a kernel left them."""
        return Fates(*decoded(codes), rows, codes >= ACROSS)

    def decide(self, index: int, code: int, numbers: Any) -> None:
        """The outcome of one flight: a code of the kernels, and the first four columns."""
        self.status[index], self.cause[index], self.above[index] = code % ACROSS, Cause.decided, code >= ACROSS
        self.rows[:4, index] = numbers

    @property
    def walls(self) -> Array:
        """The wall of each hit, graze or near graze; 0, that of the launch, of other flights."""
        return np.where(self.status == Status.hit, self.rows[1] > 0, self.above).astype(np.int8)

    @property
    def numbers(self) -> Array:
        """The first four columns, one row a state."""
        return self.rows[:4].T

    @property
    def lost(self) -> Array:
        """Flights that came to no graze but to the end of the range of numbers, of the functions in f and g, or of the
        steps.
        """
        return np.asarray(self.cause > Cause.near_graze)


class Judge:
    """Conditions and errors of the hits of a Taylor flow, when they are read."""

    def __init__(self, model: CompiledModel, tau: Array, v: Array) -> None:
        # they may be the caller's own, and change
        self.model, self.tau, self.v = model, tau.copy(), v.copy()
        self.removed, self.hits = np.ones((2, tau.size))

    def __call__(self, _name: str) -> dict[str, Any]:
        rows = np.full((4, self.tau.size), np.nan)
        chosen = np.flatnonzero(self.hits)
        rows[:, chosen] = self.model.judged(self.tau[chosen], self.v[chosen], self.removed[chosen])[2:6]
        rows[2:] = LIMITS.margin * rows[2:] + EPSILON
        return dict(zip(JUDGED, rows, strict=True))

    def steps(self) -> tuple[Array, Array]:
        """Taylor steps of each hit, and both condition numbers, shape (2, n); nan elsewhere."""
        found, chosen = np.full((3, self.tau.size), np.nan), np.flatnonzero(self.hits)
        judged = self.model.judged(self.tau[chosen], self.v[chosen], self.removed[chosen])
        found[:, chosen] = judged[10], judged[2], judged[3]
        return found[0], found[1:]


def in_shape(later: Any, shape: tuple[int, ...], name: str) -> dict[str, Any]:
    """The values of another function, in a shape."""
    return {each: np.asarray(value).reshape(shape)[()] for each, value in later(name).items()}


def judged_alone(model: CompiledModel, tau: float, v: float, name: str) -> dict[str, Any]:
    """Conditions and errors of the hit of one state, as numbers."""
    return in_shape(Judge(model, np.array([tau]), np.array([v])), (), name)


def flights(osc: Oscillator, model: CompiledModel, states: States, hits: Flown | None = None) -> Flight:
    """First hits in doubles, flat.

    Parameters
    ----------
    hits : of states with v > 0 that have been flown.
    """
    return flights_and_rows(osc, model, states, hits)[0]


def flights_and_rows(
    osc: Oscillator, model: CompiledModel, states: States, hits: Flown | None = None
) -> tuple[Flight, Array]:
    """First hits in doubles, flat; and the columns of `kernels.state`, nan where they are not known."""
    codes, rows = hits or launched(osc, model, states)
    if not np.count_nonzero(codes) and not model.sometimes_kept:
        return plain(model, states, codes, rows), rows
    fates, judge = (
        (decided(osc, model, states, codes, rows), None) if model.linear else _judged(osc, model, states, codes, rows)
    )
    # first: a flight that left the range of doubles would be followed again in many digits
    escapes(osc, model, states, fates)
    settled = _settled(osc, model, states, fates)
    if settled.size:
        escapes(osc, model, states, fates)
    if judge is not None:
        judge.hits = fates.status == Status.hit
    return result(osc, states, fates, judge, settled), fates.rows


def launched(osc: Oscillator, model: CompiledModel, states: States) -> Flown:
    """Codes and columns of first hits; a launch at which a_c has lost digits is flown with the exact one."""
    codes, rows = model.hits(states.tau, states.v)
    cancelled = np.flatnonzero(codes == CANCELS) if np.count_nonzero(codes) else codes[:0]
    if cancelled.size:
        pushes = acceleration(osc, states.tau[cancelled])
        codes[cancelled], rows[:, cancelled] = model.hits(states.tau[cancelled], states.v[cancelled], pushes)
    return codes, rows


def flown(osc: Oscillator, model: CompiledModel, states: States) -> tuple[Fates, Judge]:
    """Flights of a Taylor flow, and what judges them."""
    return _judged(osc, model, states, *launched(osc, model, states))


def _judged(osc: Oscillator, model: CompiledModel, states: States, codes: Array, rows: Array) -> tuple[Fates, Judge]:
    rows[4:] = np.nan
    fates = decided(osc, model, states, codes, rows)
    _decided_at_launch(osc, model, states, fates)
    judge = Judge(model, states.tau, states.v)
    for index, rest in states.rest.items():
        judge.removed[index] = rest.order + 2
    judge.hits = fates.status == Status.hit
    return fates, judge


def decided(osc: Oscillator, model: CompiledModel, states: States, codes: Array, rows: Array) -> Fates:
    """Flights with those from rest flown, and those that double-double arithmetic did not place refined."""
    lifted = [index for index, rest in states.rest.items() if rest.sign > 0]
    if lifted:
        removed = np.array([states.rest[index].order + 2 for index in lifted])
        codes[lifted], rows[:, lifted] = model.releases(model.near(states.tau[lifted]), removed)
    fates = Fates.of(codes, rows)
    for index, rest in states.rest.items():
        if rest.sign <= 0:
            fates.status[index] = Status.sticks
    _refined(osc, model, states, codes, fates)
    return fates


def plain(model: CompiledModel, states: States, codes: Array, rows: Array) -> Flight:
    """Hits and nothing else."""
    judge = None if model.linear else Judge(model, states.tau, states.v)
    judged = dict(zip(JUDGED, rows[2:6], strict=True)) if model.linear else {}
    fields = dict(zip(PLAIN, (*rows[:2], codes, np.zeros(codes.size, np.int8), {}), strict=True))
    if len(model.walls) == 2:
        fields["wall"] = (rows[1] > 0).astype(np.int8)
    return Flight.made(partial(_read_later, codes.size, judge), **fields, **judged)


def _read_later(size: int, judge: Judge | None, name: str) -> dict[str, Any]:
    """Depths of hits, which have none; conditions and errors of a Taylor flow."""
    return {name: np.full(size, np.nan)} if judge is None or name not in JUDGED else judge(name)


def _decided_at_launch(osc: Oscillator, model: CompiledModel, states: States, fates: Fates) -> None:
    """Flights that are proved not to return."""
    moving = states.v > 0
    up = moving & kept_up(osc, states.v)
    fates.status[up], fates.cause[up] = Status.escaped, Cause.decided
    stays = moving & stays_up(osc, states.v, model.allowance.until(states.v))
    fates.status[stays], fates.cause[stays] = Status.no_return, Cause.decided


def _refined(osc: Oscillator, model: CompiledModel, states: States, codes: Array, fates: Fates) -> None:
    """Hits that double-double arithmetic does not place: in balls, and what balls do not confirm in many digits.

    At near resonances all flights come back together: the state hardly matters, but the sums still cancel.
    """
    wanted, left = np.flatnonzero(codes == NOT_REFINED).tolist(), LIMITS.settled
    if not wanted:
        return
    from singimpact.flights.multiprecision import settle  # 8 ms that few calls need

    for index in wanted:
        fates.status[index] = Status.hit
        exact = states.exact_tau(index), states.exact_v(index), constant("height", 0)
        hit = refined_hit(osc, exact, *fates.rows[:2, index].tolist())
        if hit is None and left:
            left -= 1
            settled = settle(osc, states, index, float(model.allowance.until(states.v[index])))
            hit = settled[1][:2] if settled is not None and settled[0] == Status.hit else None
        if hit is not None:
            fates.rows[:2, index] = hit
            fates.rows[4:6, index] = np.minimum(fates.rows[4:6, index], (4 * EPSILON, 64 * EPSILON))


def escapes(osc: Oscillator, model: CompiledModel, states: States, fates: Fates) -> None:
    """Flights that have not returned become `escaped` where they are proved never to return."""
    # a flight that left the range of doubles, or spent its steps, was followed without impact too
    numbers = fates.numbers
    singular = (fates.cause == Cause.domain_left) & (numbers[:, 3] > 0)
    gone = np.flatnonzero(((fates.status == Status.no_return) | (fates.lost & ~singular)) & (numbers[:, 0] > 0))
    if gone.size:
        tau, (time, speed, position, _) = states.tau[gone], numbers[gone].T
        proved = np.ones(gone.size, dtype=bool)
        for wall, model_there in enumerate(model.walls):
            height, u = (position, speed) if not wall else (gap_of(osc)[0] - position, -speed)
            proved &= (
                never_turns(model_there, height, u)
                if model.form is None
                else never_returns(model_there, linear_form(model_there) or model.form, tau, time, height, u)
            )
        fates.status[gone[proved]], fates.cause[gone[proved]] = Status.escaped, Cause.decided


def _settled(osc: Oscillator, model: CompiledModel, states: States, fates: Fates) -> Array:
    """Flights that doubles leave open near a graze, flown in many digits: the state is exact, so the answer exists."""
    open_ones = np.flatnonzero(fates.cause == Cause.near_graze)[: LIMITS.settled]
    if open_ones.size:
        from singimpact.flights.multiprecision import settle  # 8 ms that few calls need
    for index in open_ones:
        settled = settle(osc, states, int(index), float(model.allowance.until(states.v[index])))
        if settled is not None:
            fates.decide(int(index), *settled)
            fates.rows[4:, index] = np.nan
    return open_ones


def result(osc: Oscillator, states: States, fates: Fates, judge: Judge | None, settled: Array) -> Flight:
    """The carrier, with nan and inf where the status says so."""
    status, rows = fates.status, fates.rows
    notes = notes_of(osc, states, fates)
    hit, graze = status == Status.hit, status == Status.graze
    time, velocity = rows[0].copy(), rows[1].copy()
    unknown, gone = status == Status.unresolved, (status == Status.no_return) | (status == Status.escaped)
    time[gone], velocity[gone | unknown], time[unknown] = np.inf, np.nan, np.nan
    rests = status == Status.sticks
    velocity[graze | rests], time[rests] = 0.0, 0.0
    bounded = (unknown & ~fates.lost) | graze
    depth, bound = np.where(bounded, rows[2], np.nan), np.where(bounded, rows[3], np.nan)
    fields = {
        "flight_time": time,
        "velocity": velocity,
        "status": status,
        "depth": depth,
        "bound": bound,
        "cause": fates.cause,
        "notes": notes,
    }
    if osc.upper is not None:
        fields["wall"] = fates.walls
    if judge is not None:
        return Flight.made(judge, **fields)
    judged = np.where(hit, rows[2:6], np.nan)
    # hits that the compiled entry did not fly from v > 0
    others = np.zeros(status.size, dtype=bool)
    others[[*states.rest, *settled.tolist()]] = True
    if (others & hit).any():
        late = conditions(osc, states, others & hit, time, velocity)
        late[2:, settled] = EPSILON
        judged = np.where(others & hit, late, judged)
    return Flight.made(**fields, **dict(zip(JUDGED, judged, strict=True)))


def conditions(osc: Oscillator, states: States, chosen: Array, time: Array, velocity: Array) -> Array:
    """Condition numbers and errors of some hits from the variational equation, shape (4, n), nan elsewhere."""
    found, at = np.full((4, time.size), np.nan), np.flatnonzero(chosen)
    if at.size:
        given = osc, states.tau[at], states.v[at], time[at], velocity[at]
        tau = states.tau[at] if osc.period is None else reduced(states.tau[at], osc.period)
        kappas = response(*given).conditions(tau, states.v[at], time[at], velocity[at])
        found[:, at] = [*kappas, *(part + EPSILON for part in usual_errors(*given))]
    return found


def notes_of(osc: Oscillator, states: States, fates: Fates) -> dict[int, str]:
    """A note for each undecided flight, with its cause."""
    notes = {}
    for index in np.flatnonzero(fates.lost).tolist():

        def way(times: Array, at: int = index) -> Any:
            return path(osc, states.tau[at], states.v[at], times)

        fates.cause[index], notes[index] = explained(
            osc, float(states.tau[index]), fates.numbers[index], Cause(int(fates.cause[index])), way
        )
    return notes


# ---- a hit of a linear model, placed to the last bit where double-double arithmetic does not place it
# The model with its waves is one linear system, whose exponential has no small divisors: resonance needs no care.


class LinearSystem(NamedTuple):
    """The matrix of (z, z', 1, cosine and sine of each wave), and rate and phase of each wave; balls."""

    matrix: Any
    waves: tuple[tuple[Any, Any], ...]


@lru_cache(maxsize=64)
def _system(osc: Oscillator, bits: int) -> LinearSystem:
    """The system of a linear model in balls of so many bits."""
    form, balls = linear_form(osc), Balls(bits)
    assert form is not None
    with balls_at(bits):
        damping, stiffness, rest = (
            evaluate(tree, {}, balls) for tree in (form.damping, form.stiffness, at_rest(form, osc.clearance))
        )
        size = 3 + 2 * len(form.harmonics)
        rows, waves = [[flint.arb(0)] * size for _ in range(size)], []
        rows[0][1], rows[1][0], rows[1][1], rows[1][2] = flint.arb(1), -stiffness, -damping, rest
        for n, wave in enumerate(form.harmonics):
            rate, phase, cosine, sine = (
                evaluate(tree, {}, balls) for tree in (wave.rate, wave.phase, wave.cosine, wave.sine)
            )
            at = 3 + 2 * n
            rows[1][at], rows[1][at + 1], rows[at][at + 1], rows[at + 1][at] = cosine, sine, -rate, rate
            waves.append((rate, phase))
        return LinearSystem(flint.arb_mat(rows), tuple(waves))


def refined_hit(osc: Oscillator, start: tuple[Expression, ...], time: float, velocity: float) -> list[float] | None:
    """Flight time and velocity of a hit of a linear model, correctly rounded up to a unit.

    Which root is the first has been decided; here it is only placed. None where balls do not confirm it.

    Parameters
    ----------
    start : t, x' and x - c at the launch. time, velocity : nearly those of the hit; at an upper wall the velocity is
        > 0.
    """
    balls = Balls(LIMITS.refine_bits)
    system = _system(osc, balls.bits)
    level = constant("height", 0) if osc.upper is None or velocity < 0 else subtract(osc.upper, osc.clearance)
    with balls_at(balls.bits):
        launch = tuple(evaluate(tree, {}, balls) for tree in start)
        try:
            hit = _halley(system, launch, balls.rational(Fraction(time)), evaluate(level, {}, balls))
        except (ArithmeticError, ValueError, TypeError):  # a ball that left the domain of log or a root
            return None
        return None if hit is None else [float(ball.mid()) for ball in hit]


def _halley(system: LinearSystem, launch: tuple[Any, ...], time: Any, level: Any) -> tuple[Any, Any] | None:
    """Time and velocity next to a time at which x - c = level, one step of Halley's method away; None when no step is
    small.
    """
    tau, v, at_first = launch
    angles = [(rate * tau + phase).sin_cos() for rate, phase in system.waves]
    start = flint.arb_mat([[at_first], [v], [1], *([value] for sine, cosine in angles for value in (cosine, sine))])
    for _ in range(STEPS):
        state = (system.matrix * time).exp() * start
        height, speed = state[0, 0] - level, state[1, 0]
        change = system.matrix * state
        curve, jerk = change[1, 0], (system.matrix * change)[1, 0]
        if not abs(height) < abs(speed * time) * NEAR.numerator / NEAR.denominator:
            return None
        step = -height / speed
        # next to a graze the step is not short beside speed/curve; the error left is of third order in the step
        near_enough = bool(abs(step * curve) < abs(speed) / 10**9)
        step *= 1 - step * curve / (2 * speed)
        if near_enough:
            return time + step, speed + step * (curve + step * jerk / 2)
        time = (time + step).mid()
    return None
