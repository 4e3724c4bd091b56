"""The impact map in many digits, from nothing but the exact state.

Linear models are flown in balls, which prove the hit.  Where they decide nothing, and for other models, it is the
kernel itself on numbers of mpmath: two runs at different precision must agree to the digits asked for, else the
precision grows: half of the digits go in a square root at a graze, and no formula is trusted to know how near it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import ceil, inf, nan
from typing import Any

import numpy as np

from singimpact.algebra.balls import BITS_A_DIGIT, Balls
from singimpact.algebra.expressions import evaluate, names_in
from singimpact.algebra.numbers import as_mpf, sign_of
from singimpact.algebra.precision import balls_at, bits_at, digits_at, for_user
from singimpact.algebra.rings import Multiprecision
from singimpact.codegen.over_lists import FUNCTIONS
from singimpact.flights.balls import linear_flow
from singimpact.flights.bind import over_lists, over_mpmath
from singimpact.flights.causes import decoded
from singimpact.flights.closing import common_period, touches_again
from singimpact.flights.compiled_model import Allowance, allowed
from singimpact.flights.escape import never_returns
from singimpact.flights.escape_polynomial import never_turns
from singimpact.flights.kernels.state import Rules, Work
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.model_numbers import constants_of, linear_numbers, linear_waves, recurrence_of
from singimpact.flights.results import Flight, Step
from singimpact.flights.states import States
from singimpact.oscillator.linear import linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.nearest_zero import Zero
from singimpact.status import Status

SPARE_BITS = (64, 320)  # beside the digits asked for: at first, and for a phase or a graze that costs more

Array = np.ndarray[Any, Any]
Outcome = tuple[int, tuple[Any, Any, Any, Any]]


def flights(osc: Oscillator, states: States, digits: int, allowance: Allowance) -> Flight:
    """First hits with `digits` digits, with the conditions that doubles know.

    Flights in Taylor steps are flown in doubles before: a flight that does not come back there does not here, and the
    number of its steps is known.
    """
    from singimpact.flights import undecided

    size = states.v.size
    known, budgets = _known_in_doubles(osc, states, allowance)
    codes, rows = np.zeros(size, dtype=np.int8), np.full((10, size), np.nan)
    fields = [np.empty(size, dtype=object) for _ in range(4)]
    for index in range(size):
        if index in known:
            codes[index], numbers = known[index][0], (nan,) * 4
            rows[:4, index] = known[index][1]
        else:
            codes[index], numbers = found(osc, states, index, digits, allowance.horizon, int(budgets[index]))
            rows[:4, index] = [float(part) for part in numbers]
        status = int(codes[index]) if codes[index] < 20 else int(Status.unresolved)
        numbers = numbers if codes[index] < 20 else (nan,) * 4
        with digits_at(digits) as mp:
            for field, value in zip(fields, _shown(status, numbers), strict=True):
                field[index] = for_user(+mp.mpf(value))
    fates = undecided.Fates(*decoded(codes), rows)
    for index, (_, _, cause) in known.items():
        fates.cause[index] = cause
    notes = undecided.notes_of(osc, states, fates)
    kappas = undecided.conditions(osc, states, fates.status == Status.hit, rows[0], rows[1])
    error = np.where(fates.status == Status.hit, 10.0 ** -min(digits, 300), np.nan)
    time, velocity, depth, bound = fields
    return Flight.made(flight_time=time, velocity=velocity, status=fates.status, depth=depth, bound=bound,
                       condition=kappas[0], velocity_condition=kappas[1], time_error=error, velocity_error=error.copy(),
                       cause=fates.cause, notes=notes)  # fmt: skip


def _known_in_doubles(
    osc: Oscillator, states: States, allowance: Allowance
) -> tuple[dict[int, tuple[int, Array, int]], Array]:
    """Code, numbers and cause of Taylor flights that do not come back; the steps allowed to the others."""
    from singimpact.flights import undecided

    budgets = np.full(states.v.size, allowance.steps)
    model = allowed(osc, allowance)
    if model.linear:
        return {}, budgets
    tiny = [i for i in np.flatnonzero(states.v == 0).tolist() if sign_of(states.exact_v(i)) > 0]
    fates, judge = undecided.flown(osc, model, states)
    undecided.escapes(osc, model, states, fates)
    over = fates.lost | (fates.status == Status.no_return) | (fates.status == Status.escaped)
    over[tiny] = False
    known = {int(i): (int(fates.status[i]), fates.rows[:4, i], int(fates.cause[i])) for i in np.flatnonzero(over)}
    judge.hits[tiny] = False
    steps = judge.steps()
    return known, np.where(np.isnan(steps), allowance.steps, 2 * np.nan_to_num(steps) + 100).astype(int)


def _shown(status: int, numbers: tuple[Any, Any, Any, Any]) -> tuple[Any, Any, Any, Any]:
    time, velocity, depth, bound = numbers
    match status:
        case Status.hit:
            return time, velocity, nan, nan
        case Status.no_return | Status.escaped:
            return inf, nan, nan, nan
        case Status.sticks:
            return 0, 0, nan, nan
        case Status.graze:
            return time, 0, depth, bound
    return nan, nan, depth, bound


def step(osc: Oscillator, states: States, hit: Flight, digits: int) -> Step:
    """The hit with the state after it."""
    times, speeds = np.asarray(hit.flight_time, dtype=object), np.asarray(hit.velocity, dtype=object)
    status = np.array(hit.status, dtype=np.int8).ravel()
    tau, v = np.empty(times.size, dtype=object), np.empty(times.size, dtype=object)
    with digits_at(digits) as mp:
        for index, (time, speed) in enumerate(zip(times.ravel(), speeds.ravel(), strict=True)):
            landed, bounce = as_mpf(states.exact_tau(index), mp) + time, rebound(osc, mp.convert(speed), mp)
            if status[index] == Status.hit and not bounce > 0:
                status[index], bounce = Status.no_rebound, mp.nan
            tau[index], v[index] = for_user(landed), for_user(bounce)
    shape = states.shape
    fields = vars(hit) | {"status": status.reshape(shape)[()]}
    return Step.made(**fields, tau=tau.reshape(shape)[()], v=v.reshape(shape)[()])


def rebound(osc: Oscillator, velocity: Any, mp: Any) -> Any:
    """rho(velocity) at the precision of an mpmath context."""
    if not names_in(osc.restitution):
        return abs(as_mpf(osc.restitution, mp) * velocity)
    return mp.re(evaluate(osc.rho(), {"v": velocity}, Multiprecision(mp)))


def found(osc: Oscillator, states: States, index: int, digits: int, limit: float, budget: int) -> Outcome:
    """One flight to `digits` digits: in balls where they prove the hit, else by two precisions that agree."""
    proved = _proved(osc, states, index, digits, limit)
    if proved is None and (touch := _closing(osc, states, index, digits, limit)) is not None:
        return touch
    return proved or agreed(osc, states, index, digits, limit, budget)


def _closing(osc: Oscillator, states: States, index: int, digits: int, limit: float) -> Outcome | None:
    """The graze of a flight that comes back to its launch at rest after the common period of the model."""
    if index not in states.rest or common_period(osc) is None:
        return None
    code, numbers = flown(osc, states, index, digits + LIMITS.guard, limit, LIMITS.settling_steps)
    return _touching(osc, states, index, numbers, digits) if code == Status.unresolved else None


def _touching(osc: Oscillator, states: States, index: int, numbers: Any, digits: int) -> Outcome | None:
    """The graze at the common period, where a flight was followed to a place that is not decided."""
    rest = states.rest.get(index)
    period = None if rest is None else touches_again(osc, rest, float(numbers[0]))
    if period is None:
        return None
    with digits_at(digits + LIMITS.guard) as mp:
        return int(Status.graze), (as_mpf(period, mp), mp.mpf(0), mp.mpf(0), numbers[3])


def _proved(osc: Oscillator, states: States, index: int, digits: int, limit: float) -> Outcome | None:
    """The first hit of a linear model in balls that are narrow enough; None where they decide nothing.

    They take a twentieth of the time of mpmath.
    """
    tau, v = states.exact_tau(index), states.exact_v(index)
    rest = states.rest.get(index, Zero(tau, -1, 1))
    for bits in (ceil(digits * BITS_A_DIGIT) + spare for spare in SPARE_BITS):
        flow = linear_flow(osc, bits)
        if flow is None or rest.sign <= 0:
            return None
        with balls_at(bits):
            at, speed = (evaluate(tree, {}, flow.balls) for tree in (tau, v))
            hit = flow.first_hit(at, speed, flow.number(Fraction(limit)), rest.order + 2)
            if hit is None or hit.time is None:
                return None
        numbers = hit.time, hit.velocity
        if all(part.rel_accuracy_bits() > digits * BITS_A_DIGIT + 4 for part in numbers):
            with bits_at(bits) as mp:
                time, velocity = (_centre(part, mp) for part in numbers)
            return int(Status.hit), (time, velocity, nan, nan)
    return None


def agreed(osc: Oscillator, states: States, index: int, digits: int, limit: float, budget: int) -> Outcome:
    """One flight whose time and velocity two precisions agree on to `digits` digits.

    The cut-off of every step is bounded in both runs, so they differ by their rounding alone.
    """
    precision = digits + LIMITS.guard
    outcome = flown(osc, states, index, precision, limit, budget)
    while precision < 4 * digits + 500 and outcome[0] < 20:
        precision = precision + max(LIMITS.guard, precision // 4)
        again = flown(osc, states, index, precision, limit, budget)
        if _over(outcome) and _over(again):
            return _escaping(osc, states, index, again)
        if outcome[0] == again[0] != Status.unresolved and _close(outcome[1], again[1], digits):
            return again
        outcome = again
    if outcome[0] == Status.unresolved and _touches(outcome[1]):
        return int(Status.graze), outcome[1]
    return _escaping(osc, states, index, outcome) if outcome[0] > 20 else outcome


def _over(outcome: Outcome) -> bool:
    """Whether a flight came to the horizon, or left the range of numbers, and to no graze."""
    code, (_, _, depth, bound) = outcome
    with bits_at(53):
        return code == Status.no_return or code > 20 or (code == Status.unresolved and not depth <= 10 * bound)


def _escaping(osc: Oscillator, states: States, index: int, outcome: Outcome) -> Outcome:
    """`escaped` in place of `no_return` where it is proved; doubles are enough for that."""
    form, numbers = linear_form(osc), outcome[1]
    time, speed, place = (np.array([float(value)]) for value in numbers[:3])
    proved = (never_turns(osc, place, speed) if form is None
              else never_returns(osc, form, states.tau[[index]], time, place, speed))  # fmt: skip
    return (int(Status.escaped), numbers) if proved[0] else outcome


def _close(first: tuple[Any, ...], second: tuple[Any, ...], digits: int) -> bool:
    with digits_at(digits + 5) as mp:
        small = mp.mpf(10) ** (-digits - 1)
        return all(abs(a - b) <= small * abs(b) for a, b in zip(first[:2], second[:2], strict=True))


def _touches(numbers: tuple[Any, Any, Any, Any]) -> bool:
    depth, bound = numbers[2:]
    with bits_at(53):
        return bool(abs(depth) <= 10 * bound)


def settle(osc: Oscillator, states: States, index: int, limit: float) -> tuple[int, list[float]] | None:
    """One flight that doubles left open, as doubles; None when many digits do not settle it either."""
    for digits in LIMITS.settling_digits:
        code, numbers = flown(osc, states, index, digits, limit, LIMITS.settling_steps)
        if code > 20:
            return None
        if code != Status.unresolved:
            return code, [float(value) for value in numbers]
        if (touch := _touching(osc, states, index, numbers, digits)) is not None:
            return touch[0], [float(value) for value in touch[1]]
    if _touches(numbers):
        return int(Status.graze), [float(value) for value in numbers]
    return None


def flown(osc: Oscillator, states: States, index: int, digits: int, limit: float, budget: int) -> Outcome:
    """One flight in `digits` digits, rounding errors included in what is undecided."""
    with digits_at(digits) as mp:
        v = as_mpf(states.exact_v(index), mp)
        removed = 1
        if v == 0:
            rest = states.rest[index]
            if rest.sign <= 0:
                return int(Status.sticks), (v, v, v, v)
            removed = rest.order + 2
        try:
            return _march(osc, states, index, v, removed, (limit, budget), mp)
        except (ArithmeticError, ValueError, TypeError):  # log or a root left its domain on the way
            return int(Status.unresolved), (nan,) * 4


def _march(
    osc: Oscillator, states: States, index: int, v: Any, removed: int, limits: tuple[float, int], mp: Any
) -> Outcome:  # fmt: skip
    space = over_mpmath(mp, _flow(osc), exact_restart=False)
    order = degree_for(float(mp.eps)) if mp.prec < 1000 else int(mp.prec / 2.15)
    order += removed - 1
    rules = Rules(mp.mpf(limits[0]), limits[1], order, order, 8 * mp.eps, 0, 0, 0, 0, 0)
    if linear_form(osc) is None:
        space["coefficients"] = _in_balls(osc, mp.prec + 32, mp)
        p: Any = [as_mpf(tree, mp) for tree in constants_of(osc)]
        rows = recurrence_of(osc).rows
    else:
        p, rows = linear_numbers(osc, lambda tree: as_mpf(tree, mp)), max(4 * len(linear_waves(osc)), 1)
    code, *numbers = space["taylor_flight"](
        forcing_phases(osc, states, index, mp), v, removed, mp.nan, p, rules, workspace(mp.mpf(0), order, rows), []
    )
    return int(code), (numbers[0], numbers[1], numbers[2], numbers[3])


def _flow(osc: Oscillator) -> str:
    return "" if linear_form(osc) is not None else recurrence_of(osc).source


def workspace(zero: Any, order: int, rows: int) -> Work:
    """Scratch of one flight over lists."""
    return Work([zero] * (order + 2), [[zero] * (order + 2) for _ in range(rows)], [zero] * (order + 2))


@dataclass(frozen=True)
class _InBalls:
    """`coefficients` of numbers of mpmath, computed in balls of 32 bits more, which takes a quarter of the time.

    Parameters
    ----------
    call, p, rows : the function on balls, its numbers as balls, the rows it fills. mp : the context of numbers.
    """

    call: Any
    p: list[Any]
    rows: int
    balls: Balls
    mp: Any

    def __call__(self, start: Any, time: Any, z: Any, u: Any, shift: Any, n: int, _p: Any, work: Any) -> None:
        import flint

        with balls_at(self.balls.bits):
            exact = [flint.arb(value) for value in (start[0], time, z, u, shift)]
            inner = workspace(flint.arb(0), n, self.rows)
            self.call([exact[0]], *exact[1:], n, self.p, inner)
        work.X[: n + 1] = [_centre(value, self.mp) for value in inner.X[: n + 1]]
        for row, filled in zip(work.W, inner.W, strict=True):
            row[0] = _centre(filled[0], self.mp)


@lru_cache(maxsize=64)
def _over_balls(flow: str) -> dict[str, Any]:
    return over_lists(flow)({name: lambda x, name=name: getattr(x, name)() for name in FUNCTIONS})


def _in_balls(osc: Oscillator, bits: int, mp: Any) -> _InBalls:
    balls, space = Balls(bits), _over_balls(_flow(osc))
    numbers = [balls.evaluate(tree, {}) for tree in constants_of(osc)]
    return _InBalls(space["coefficients"], numbers, recurrence_of(osc).rows, balls, mp)


def _centre(ball: Any, mp: Any) -> Any:
    """The centre of a ball as a number of an mpmath context, exactly."""
    from mpmath.libmp import from_man_exp

    if isinstance(ball, float | int):  # the time has series of plain numbers
        return mp.mpf(ball)
    if not ball.is_finite():
        return mp.nan
    return mp.make_mpf(from_man_exp(*map(int, ball.mid().man_exp())))


def forcing_phases(osc: Oscillator, states: States, index: int, mp: Any) -> list[Any]:
    """Cosine and sine of every wave at a launch, or its reduced time, at the precision of a context for any tau."""
    extra = max(int(mp.log(abs(states.tau[index]) + 1, 2)), 0) + 10
    with bits_at(mp.prec + extra):
        tau = as_mpf(states.exact_tau(index), mp)
        if linear_form(osc) is None:
            if osc.period is None:
                return [tau]
            period = as_mpf(osc.period, mp)
            return [tau - period * mp.nint(tau / period)]
        angles = [as_mpf(w.rate, mp) * tau + as_mpf(w.phase, mp) for w in linear_waves(osc)]
        return [value for angle in angles for value in (mp.cos(angle), mp.sin(angle))]
