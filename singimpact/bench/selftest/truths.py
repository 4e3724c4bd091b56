"""Flights of one model against small fixed steps, balls, and more digits.

Fixed steps (`bench.truth`) share with the package f and g as expression trees; kappa is that of the package. Balls are
those of the second program, which shares nothing but the texts of the model. `digits=20` is the package's enclosure, by
other code than its flights in doubles from the recurrence on; it decides where doubles and fixed steps disagree.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.numbers import EPSILON
from singimpact.bench.measuring import relative_error
from singimpact.bench.selftest.draws import Flown, compared
from singimpact.bench.selftest.rows import Tally
from singimpact.bench.truth import graded_steps
from singimpact.bench.truth.graded_steps import HIT, MISS
from singimpact.bench.truth.hit_in_balls import enclosed, second_program
from singimpact.certificates.checker import Refused
from singimpact.status import Status

ENDED = (Status.no_return, Status.escaped)


@dataclass(frozen=True)
class TruthSettings:
    """The number of states, and the limit at which a flight is wrong.

    Parameters
    ----------
    balls, digits : states flown in balls, and with `digits=`.
    wanted : the digits.
    wrong : least relative error of a flight time or a velocity that is wrong against the fixed steps, which agree with
        themselves to 1e-11; 100 kappa epsilon counts where it is larger.
    finer : of the fixed steps, where the enclosure does not decide between them and the package.
    """

    balls: int = 20
    digits: int = 50
    wanted: int = 20
    wrong: float = 1e-9
    finer: float = 1 / 16


TRUTHS = TruthSettings()


@compared("against small fixed steps")
def fixed_steps(flown: Flown, tally: Tally) -> None:
    """Flights against fixed steps; where the two disagree, the enclosure decides."""
    tally.leave("CPU time of the flights used up", flown.left)
    motion = flown.plain.motion
    for at in tally.in_time(range(flown.tau.size)):
        _one(flown, at, motion, tally)


def _one(flown: Flown, at: int, motion: graded_steps.Motion, tally: Tally) -> None:
    tau, v, horizon = float(flown.tau[at]), float(flown.v[at]), flown.scales.horizon
    if flown.step.status[at] in (Status.unresolved, Status.graze):
        tally.leave(Status(int(flown.step.status[at])).name)
        return
    true = graded_steps.first_hit(motion, tau, v, horizon)
    if true.status not in (HIT, MISS):
        tally.leave("steps do not settle")
        return
    ratio = _off(flown, at, *_ending(true))
    if not ratio <= 1:
        ratio, decided = _arbitrated(flown, at, motion, ratio)
        if not decided:
            tally.leave("steps and the enclosure do not settle")
            return
    tally.judge(ratio, _told(flown, at, true.flight_time))


def _ending(true: graded_steps.Hit) -> tuple[float | None, float]:
    return (true.flight_time if true.status == HIT else None), true.velocity


def _arbitrated(flown: Flown, at: int, motion: graded_steps.Motion, before: float) -> tuple[float, bool]:
    """The difference from the enclosure, or from finer steps where there is none; and whether one of these decides."""
    tau, v, horizon = float(flown.tau[at]), float(flown.v[at]), flown.scales.horizon
    try:
        ball = enclosed(flown.osc, Fraction(tau), Fraction(v), horizon, TRUTHS.wanted)
    except (ArithmeticError, TypeError):
        true = graded_steps.first_hit(motion, tau, v, horizon, graded_steps.FINENESS.first * TRUTHS.finer)
        return before, true.status in (HIT, MISS) and not _off(flown, at, *_ending(true)) <= 1
    time, velocity = (None, 0.0) if ball is None else (float(ball.flight_time), float(ball.velocity))
    return _off(flown, at, time, velocity), True


def _off(flown: Flown, at: int, time: float | None, velocity: float) -> float:
    """Differences of flight time and velocity in units of max(1e-9, 100 kappa epsilon); inf for another end."""
    step = flown.step
    if step.status[at] != Status.hit or time is None:
        return 0.0 if step.status[at] in ENDED and time is None else np.inf
    compared = (
        (step.flight_time[at], time, step.condition[at]),
        (step.velocity[at], velocity, step.velocity_condition[at]),
    )
    parts = [abs(one / other - 1) / max(TRUTHS.wrong, 100 * kappa * EPSILON) for one, other, kappa in compared]
    return float(np.max(parts))


def _told(flown: Flown, at: int, true: Any) -> str:
    """A state with both flight times."""
    status = Status(int(flown.step.status[at])).name
    return f"{flown.call(at)}: {status}, flight time {float(flown.step.flight_time[at])!r}, truth {true}"


def _some(flown: Flown, count: int) -> list[int]:
    """The places of some states, spread over all of them."""
    spread = np.linspace(0, flown.tau.size - 1, min(count, flown.tau.size))
    return [int(place) for place in np.unique(spread.astype(int))]


@compared("within .error of balls")
def balls(flown: Flown, tally: Tally) -> None:
    """Flights enclosed by the second program: the error is within `time_error` and `velocity_error`."""
    for at in tally.in_time(_some(flown, TRUTHS.balls)):
        try:
            ball = second_program(flown.osc, float(flown.tau[at]), float(flown.v[at]), flown.scales.horizon)
        except Refused:
            tally.leave("balls refuse")
        else:
            _compared(flown, at, ball or (None, None), tally)


@compared(f"within .error of digits={TRUTHS.wanted}")
def digits(flown: Flown, tally: Tally) -> None:
    """Flights with `digits=20`: the flights in doubles are within their `time_error` and `velocity_error`."""
    for at in tally.in_time(_some(flown, TRUTHS.digits)):
        hit = flown.osc.first_hit(
            float(flown.tau[at]), float(flown.v[at]), digits=TRUTHS.wanted, horizon=flown.scales.horizon
        )
        if hit.status in (Status.unresolved, Status.graze):
            tally.leave(Status(int(hit.status)).name)
        else:
            there = hit.status == Status.hit
            _compared(flown, at, (hit.flight_time, hit.velocity) if there else (None, None), tally)


def _compared(flown: Flown, at: int, truth: tuple[Any, Any], tally: Tally) -> None:
    """Judge the errors of flight time and velocity in units of the estimates of the flight."""
    step = flown.step
    if step.status[at] in (Status.unresolved, Status.graze):
        tally.leave(Status(int(step.status[at])).name)
    elif step.status[at] != Status.hit or truth[0] is None:
        same = step.status[at] in ENDED and truth[0] is None
        tally.judge(0.0 if same else np.inf, _told(flown, at, "none" if truth[0] is None else float(truth[0])))
    else:
        pairs = ((step.flight_time, truth[0], step.time_error), (step.velocity, truth[1], step.velocity_error))
        ratio = np.max([relative_error(float(values[at]), true) / error[at] for values, true, error in pairs])
        tally.judge(float(ratio), _told(flown, at, float(truth[0])))
