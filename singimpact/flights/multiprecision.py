"""One flight in many digits by the kernel on numbers of mpmath, where balls do not prove the hit (`in_digits.proof`).

Two runs at different precision must agree to the digits asked for, else the precision grows: half of the digits go in a
square root at a graze, and no formula is trusted to know how near it is.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache
from math import factorial, isqrt, lcm, nan, sqrt
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls
from singimpact.algebra.expressions import Expression, Number, Pi, multiply, number, power, subtract
from singimpact.algebra.numbers import as_float, as_fraction, as_mpf, sign_of
from singimpact.algebra.precision import balls_at, bits_at, digits_at
from singimpact.codegen.over_lists import FUNCTIONS
from singimpact.flights.bind import over_lists, over_mpmath
from singimpact.flights.interpreted import workspace
from singimpact.flights.kernels.state import ACROSS, Rules
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.model_numbers import constants_of, linear_numbers, linear_waves, recurrence_of
from singimpact.flights.no_return.polynomial import never_returns, never_turns
from singimpact.flights.states import States
from singimpact.handed_on import flint
from singimpact.oscillator.linear import LinearForm, linear_form
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.wall_acceleration import Zero, acceleration
from singimpact.status import Status

Outcome = tuple[int, tuple[Any, Any, Any, Any]]


def found(osc: Oscillator, states: States, index: int, digits: int, limit: float, budget: int) -> Outcome:
    """One flight to `digits` digits where balls prove no hit: by two precisions that agree."""
    return _closing(osc, states, index, digits, limit) or agreed(osc, states, index, digits, limit, budget)


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


def agreed(osc: Oscillator, states: States, index: int, digits: int, limit: float, budget: int) -> Outcome:
    """One flight whose time and velocity two precisions agree on to `digits` digits.

    The cut-off of every step is bounded in both runs, so they differ by their rounding alone.
    """
    precision = digits + LIMITS.guard
    outcome = flown(osc, states, index, precision, limit, budget)
    while precision < 4 * digits + 500 and outcome[0] % ACROSS < 20:
        precision = precision + max(LIMITS.guard, precision // 4)
        again = flown(osc, states, index, precision, limit, budget)
        if _over(outcome) and _over(again):
            return _escaping(osc, states, index, again)
        open_ = outcome[0] % ACROSS == Status.unresolved
        if outcome[0] == again[0] and not open_ and _close(outcome[1], again[1], digits):
            return again
        outcome = again
    if outcome[0] % ACROSS == Status.unresolved and _touches(outcome[1]):
        return outcome[0] - Status.unresolved + Status.graze, outcome[1]
    return _escaping(osc, states, index, outcome) if outcome[0] % ACROSS > 20 else outcome


def _over(outcome: Outcome) -> bool:
    """Whether a flight came to the horizon, or left the range of numbers, and to no graze."""
    code, (_, _, depth, bound) = outcome[0] % ACROSS, outcome[1]
    with bits_at(53):
        return code == Status.no_return or code > 20 or (code == Status.unresolved and not depth <= 10 * bound)


def _escaping(osc: Oscillator, states: States, index: int, outcome: Outcome) -> Outcome:
    """`escaped` in place of `no_return` where it is proved; doubles are enough for that."""
    if osc.upper is not None:
        return outcome
    form, numbers = linear_form(osc), outcome[1]
    time, speed, height = (np.array([float(value)]) for value in numbers[:3])
    proved = (
        never_turns(osc, height, speed)
        if form is None
        else never_returns(osc, form, states.tau[[index]], time, height, speed)
    )
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
    steps = LIMITS.settling_steps
    if linear_form(osc) is None:
        steps = min(steps, int(LIMITS.settling_by_price / recurrence_of(osc).price))

    def fly(digits: int) -> Outcome:
        code, numbers = flown(osc, states, index, digits, limit, steps)
        touch = _touching(osc, states, index, numbers, digits) if code == Status.unresolved else None
        return touch or (code, numbers)

    return settled(fly)


def settled(fly: Callable[[int], Outcome]) -> tuple[int, list[float]] | None:
    """Code and doubles of a flight that `fly` follows with more digits until they decide it; None where none do.

    A touch that the most digits do not separate from a graze is a graze.
    """
    for digits in LIMITS.settling_digits:
        code, numbers = fly(digits)
        if code % ACROSS > 20:
            return None
        if code % ACROSS != Status.unresolved:
            return code, [float(value) for value in numbers]
    touch = code - Status.unresolved + Status.graze
    return (touch, [float(value) for value in numbers]) if _touches(numbers) else None


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
) -> Outcome:
    source = "" if linear_form(osc) is not None else recurrence_of(osc).source
    space = over_mpmath(mp, source, exact_restart=False)
    order = degree_for(float(mp.eps)) if mp.prec < 1000 else int(mp.prec / 2.15)
    order += removed - 1
    rules = Rules(mp.mpf(limits[0]), limits[1], order, order, 8 * mp.eps, 0, 0, 0, 0, 0, 0, gap_in_digits(osc, mp), 0)
    if linear_form(osc) is None:
        space["coefficients"] = _in_balls(osc, mp.prec + 32, mp)
        p: Any = [as_mpf(tree, mp) for tree in constants_of(osc)]
        rows = recurrence_of(osc).rows
    else:
        p, rows = linear_numbers(osc, lambda tree: as_mpf(tree, mp)), max(4 * len(linear_waves(osc)), 1)
    code, *numbers = space["taylor_flight"](
        forcing_phases(osc, states, index, mp), v, removed, mp.nan, p, rules, workspace(mp.mpf(0), order, rows), []
    )
    return at_wall(int(code), numbers)


def at_wall(code: int, numbers: Any) -> Outcome:
    """An outcome whose hit at the upper wall is a hit with x' > 0."""
    return (0, (numbers[0], -numbers[1], *numbers[2:4])) if code == ACROSS else (code, tuple(numbers[:4]))


def gap_in_digits(osc: Oscillator, mp: Any) -> Any:
    """The distance of both walls; inf of a model with one."""
    return mp.inf if osc.upper is None else as_mpf(subtract(osc.upper, osc.clearance), mp)


@lru_cache(maxsize=64)
def _over_balls(flow: str) -> dict[str, Any]:
    return over_lists(flow)({name: lambda x, name=name: getattr(x, name)() for name in FUNCTIONS})


def _in_balls(osc: Oscillator, bits: int, mp: Any) -> Callable[..., None]:
    """`coefficients` of numbers of mpmath, computed in balls of 32 bits more, which takes a quarter of the time."""
    balls, flow = Balls(bits), recurrence_of(osc)
    call, p = _over_balls(flow.source)["coefficients"], [balls.evaluate(tree, {}) for tree in constants_of(osc)]

    def coefficients(start: Any, time: Any, *place: Any) -> None:
        *state, n, _p, work = place
        with balls_at(bits):
            exact = [flint.arb(value) for value in (start[0], time, *state)]
            inner = workspace(flint.arb(0), n, flow.rows)
            call([exact[0]], *exact[1:], n, p, inner)
        work.X[: n + 1] = [centre_of(value, mp) for value in inner.X[: n + 1]]
        for row, filled in zip(work.W, inner.W, strict=True):
            row[0] = centre_of(filled[0], mp)

    return coefficients


def centre_of(ball: Any, mp: Any) -> Any:
    """The centre of a ball as a number of an mpmath context, exactly."""
    from mpmath.libmp import from_man_exp

    if isinstance(ball, float | int):  # the time has series of plain numbers
        return mp.mpf(ball)
    return mp.make_mpf(from_man_exp(*map(int, ball.mid().man_exp()))) if ball.is_finite() else mp.nan


def forcing_phases(osc: Oscillator, states: States, index: int, mp: Any) -> list[Any]:
    """Cosine and sine of every wave at a launch, or its reduced time, at the precision of a context for any tau."""
    size = abs(float(np.broadcast_to(states.tau + states.turns, states.tau.shape)[index]))
    extra = max(int(mp.log(size + 1, 2)), 0) + 10
    with bits_at(mp.prec + extra):
        tau = as_mpf(states.exact_tau(index), mp)
        if linear_form(osc) is None:
            if osc.period is None:
                return [tau]
            period = as_mpf(osc.period, mp)
            return [tau - period * mp.nint(tau / period)]
        angles = [as_mpf(w.rate, mp) * tau + as_mpf(w.phase, mp) for w in linear_waves(osc)]
        return [value for angle in angles for value in (mp.cos(angle), mp.sin(angle))]


# ---- undamped linear models that come back to their launch at rest after the common period of all motions
# There the flight touches the obstacle as it left it: a graze of any order. No number of digits tells it from a near
# miss; the common period does.


def touches_again(osc: Oscillator, rest: Zero, time: float) -> Expression | None:
    """The time at which a flight launched at rest touches the obstacle again as it left it.

    Parameters
    ----------
    osc : the model. rest : the launch. time : the flight was seen above the obstacle until then, and not decided there.

    Returns
    -------
    Expression or None : the common period, where x - c is proved positive from `time` up to it.

    Examples
    --------
    >>> osc = Oscillator("x", "cos(2*t)", -1, "1/2")
    >>> print(touches_again(osc, Zero(multiply(number(Fraction(1, 2)), Pi()), 2, 1), 6.2831))
    2*pi
    """
    form, period = linear_form(osc), common_period(osc)
    if form is None or period is None or rest.sign <= 0 or rest.order % 2:
        return None
    gap = abs(as_float(period) - time)
    order = rest.order + 2
    leading = float(acceleration(osc, np.array([as_float(rest.tau)]), rest.order)[0])
    # backwards from the touch: x - c >= leading s^order/order! - bound s^(order + 1)/(order + 1)!
    bound = _largest_derivative(form, as_float(osc.clearance), order + 1)
    return period if 2 * bound * gap < leading * factorial(order + 1) / factorial(order) else None


@lru_cache(maxsize=256)
def common_period(osc: Oscillator) -> Expression | None:
    """The least common period of free motion and forcing of an undamped linear model; None when there is none.

    Examples
    --------
    >>> print(common_period(Oscillator("x", "cos(2.8*t)", 0, 1)))
    10*pi
    >>> print(common_period(Oscillator("x + 0.1*xdot", "cos(2.8*t)", 0, 1)))
    None
    """
    form = linear_form(osc)
    if form is None or sign_of(form.damping) or sign_of(form.stiffness) <= 0:
        return None
    turns, stiffness = 1, as_fraction(form.stiffness)
    for wave in form.harmonics:
        rate = as_fraction(wave.rate)
        ratio = None if rate is None or not stiffness else _rational_root(rate * rate / stiffness)
        if ratio is None or ratio == 1:
            return None  # no common period, or resonance
        turns = lcm(turns, ratio.denominator)
    root = None if not stiffness else _rational_root(stiffness)
    slowness = power(form.stiffness, Number(Fraction(-1, 2))) if root is None else number(1 / root)
    return multiply(number(2 * turns), Pi(), slowness)


def _rational_root(value: Fraction) -> Fraction | None:
    root = Fraction(isqrt(value.numerator), isqrt(value.denominator))
    return root if root * root == value else None


def _largest_derivative(form: LinearForm, clearance: float, order: int) -> float:
    """A bound, for all times, of a derivative of a flight launched at rest."""
    stiffness = as_float(form.stiffness)
    rate, offset = sqrt(stiffness), as_float(form.constant) / stiffness
    waves = [(as_float(wave.rate), np.hypot(as_float(wave.cosine), as_float(wave.sine))) for wave in form.harmonics]
    answers = [(abs(speed), size / abs(stiffness - speed * speed)) for speed, size in waves]
    free = abs(clearance - offset) + sum(size * (1 + speed / rate) for speed, size in answers)
    return float(free * rate**order + sum(size * speed**order for speed, size in answers))
