"""Impacts in balls of 60 digits from `bench.truth`, with their derivatives, and the sequences of flights.

Truth of linear and cubic models is `first_hit`, which shares nothing with the package; of steep ones, and of those with
t in f, `enclosed`, which shares nothing with the flights in doubles that are judged here.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache, partial
from math import pi
from typing import Any

import flint
import numpy as np

from singimpact.algebra import as_rational, balls_at
from singimpact.bench.stress.judging import STEP, Judge, Launch, SteepLaunch, Trial, both
from singimpact.bench.truth.first_hit import first_of_both
from singimpact.bench.truth.hit_in_balls import InBalls, enclosed
from singimpact.flights.inverse_map import backwards
from singimpact.status import Status

SQUARED = 1e-140  # the height of a flight is of the size of v squared, and below 1e-300 doubles lose digits
IMPACTS = 4  # of an orbit: every impact multiplies the condition number, so more impacts would hide errors
GONE = (Status.no_return, Status.escaped)

DIGITS = 45  # of the hits of steep models, whose differences over 10^-STEP keep 20


@lru_cache(maxsize=4096)  # the functions of a place fly the same states
def landed(launch: SteepLaunch, tau: Fraction, v: Fraction, sign: int) -> InBalls | None:
    """The next impact of a steep model in balls, with its derivatives; None where there is none.

    Parameters
    ----------
    sign : -1 for the flight backwards.
    """
    return enclosed(launch.model if sign > 0 else backwards(launch.model), tau, v, launch.horizon, DIGITS)


def landing(launch: Launch, tau: Any, v: Any, sign: int = 1) -> InBalls | int:
    """The impact, or the status that is right: sticks, graze or no return.  Call it with the working precision set."""
    if isinstance(launch, SteepLaunch):
        return landed(launch, as_rational(flint.arb(tau)), as_rational(flint.arb(v)), sign) or int(Status.no_return)
    motion = launch.motion(tau, v, sign)
    if v == 0 and not motion.at(0)[2] > 0:
        return int(Status.sticks)
    try:
        hit = first_of_both(motion, float(v), launch.horizon, launch.gap)
    except ArithmeticError:
        return int(Status.graze)
    if hit is None:
        return int(Status.no_return)
    (time, u), e = hit, motion.at(hit[0])[2]
    by_tau, by_v = motion.variations(time) if float(v) else (motion.variations(time)[0], (0 * u, 0 * u))
    rows = [(-by[0] / u, by[1] - e * by[0] / u) for by in (by_tau, by_v)]
    return InBalls(time, u, ((rows[0][0], rows[1][0]), (rows[0][1], rows[1][1])))


def sizes(launch: Launch, time: Any) -> tuple[float, float]:
    """The sizes to which rounding errors of the state are relative; phases are taken from the nearest period."""
    period = 2 * pi / launch.omega
    return max(abs(launch.tau - period * round(launch.tau / period)), float(time)), launch.v


def _status(found: Any, right: int) -> tuple[int, int]:
    given = int(found)
    # whether it never returns is another question than whether it has by the horizon
    return (right, right) if given in GONE and right in GONE else (given, right)


def _swept(judge: Callable[[Launch], Trial | None], place: str, points: int) -> Iterator[Trial]:
    for launch in both(place, points):
        with balls_at(launch.bits):
            trial = judge(launch)
        if trial is not None:
            yield trial


def _first_hit(launch: Launch) -> Trial:
    hit = launch.model.first_hit(launch.tau, launch.v, horizon=launch.horizon)
    return hit_trial(launch, int(hit.status), float(hit.flight_time), float(hit.velocity))


def hit_trial(launch: Launch, status: int, flight_time: float, velocity: float) -> Trial:
    """Flight time and velocity, up from the wall of the launch, that doubles give.  Call it with a precision set."""
    true = landing(launch, launch.tau, launch.v)
    if isinstance(true, int) or status != Status.hit:
        return Trial(str(launch), status=_status(status, true if isinstance(true, int) else int(Status.hit)))
    moved = true.moved(sizes(launch, true.flight_time))
    return Trial(str(launch), [flight_time, velocity], [true.flight_time, true.velocity], moved)


def _impact_map(launch: Launch) -> Trial:
    step = launch.model.impact_map(launch.tau, launch.v, horizon=launch.horizon)
    true = landing(launch, launch.tau, launch.v)
    if isinstance(true, int) or step.status != Status.hit:
        return Trial(str(launch), status=_status(step.status, true if isinstance(true, int) else int(Status.hit)))
    r, late = flint.arb(launch.restitution), true.moved(sizes(launch, true.flight_time))
    values = [true.flight_time + launch.tau, r * abs(true.velocity)]
    return Trial(str(launch), [float(step.tau), float(step.v)], values, [late[0], r * late[1]])


def _inverse(launch: Launch) -> Trial:
    landed = launch.v * launch.restitution  # so that r -> 0 does not send the flight to infinity
    before = launch.model.inverse_map(launch.tau, landed, horizon=launch.horizon)
    true = landing(launch, -launch.tau, flint.arb(landed) / flint.arb(launch.restitution), -1)
    if isinstance(true, int) or before.status != Status.hit:
        return Trial(str(launch), status=_status(before.status, true if isinstance(true, int) else int(Status.hit)))
    size, speed = sizes(launch, true.flight_time)
    late = true.moved((size, speed))
    return Trial(
        str(launch), [float(before.tau), float(before.v)], [launch.tau - true.flight_time, abs(true.velocity)], late
    )


def _flight(launch: Launch) -> Trial | None:
    """Times soon after the launch, halfway to the hit, and just before it."""
    true = landing(launch, launch.tau, launch.v)
    if isinstance(true, int) or launch.v < SQUARED:
        return None
    times = [float(true.flight_time) * share for share in (1e-6, 0.5, 0.999)]
    path_, motion = launch.model.flight(launch.tau, launch.v, times), launch.motion(launch.tau, launch.v)
    truth, slack = [], []
    for t in times:
        (z, u, e), (by_tau, by_v) = motion.at(flint.arb(t)), motion.variations(flint.arb(t))
        size = sizes(launch, t)
        truth += [z + launch.clearance, u]
        slack += [abs(by_tau[n]) * size[0] + abs(by_v[n]) * size[1] + abs(rate) * t for n, rate in ((0, u), (1, e))]
    return Trial(str(launch), np.stack([path_.x, path_.xdot], axis=1).ravel().tolist(), truth, slack)


def _derivative(launch: Launch) -> Trial | None:
    """D G times the sizes of the state, by rows; what a rounding of the state does to it by differences of 60 digits.

    A short flight has d v'/d tau of the size of its square: that entry is right beside the others of its row.
    """
    if launch.v < SQUARED:
        return None
    computed, true = launch.model.derivative(launch.tau, launch.v, horizon=launch.horizon), _matrix(launch, 0, 0)
    if isinstance(true, int):
        return Trial(str(launch), status=_status(computed.status, true))
    if computed.status != Status.hit:
        return Trial(str(launch), status=(int(computed.status), int(Status.hit)))
    values, time = true
    small, size = flint.arb(10) ** -STEP, sizes(launch, time)
    slack = [0 * value for value in values]
    for change in ((size[0] * small, 0), (0, size[1] * small)):
        moved = _matrix(launch, *change)
        if isinstance(moved, int):
            return None
        slack = [so_far + abs(new - old) / small for so_far, new, old in zip(slack, moved[0], values, strict=True)]
    beside = [values[at ^ 1] * size[at % 2 ^ 1] / size[at % 2] for at in range(4)]
    slack = [so_far + abs(other) for so_far, other in zip(slack, beside, strict=True)]
    if isinstance(launch, SteepLaunch):
        # a rounding of x inside the layer changes f' there by the steepness times as much
        slack = [so_far + launch.steepness * abs(value) for so_far, value in zip(slack, values, strict=True)]
    return Trial(str(launch), computed.matrix.ravel().tolist(), values, slack)


def _matrix(launch: Launch, by_tau: Any, by_v: Any) -> tuple[list[Any], Any] | int:
    true = landing(launch, flint.arb(launch.tau) + by_tau, flint.arb(launch.v) + by_v)
    if isinstance(true, int):
        return true
    r, ((a, b), (c, d)) = flint.arb(launch.restitution) * (1 if true.velocity > 0 else -1), true.by_state
    return [1 + a, b, r * c, r * d], true.flight_time


def _orbit(launch: Launch) -> Trial | None:
    found = launch.model.orbit(launch.tau, launch.v, IMPACTS)
    if found.kind.tolist() != ["start"] + ["impact"] * IMPACTS:
        return None  # complete chatter, rest and lift-off are tested as chatter limits
    return _chained(launch, found.tau[-1], found.v[-1])


def _iterate(launch: Launch) -> Trial | None:
    ends = launch.model.iterate(launch.tau, launch.v, IMPACTS)
    return None if ends.status != 0 else _chained(launch, ends.tau, ends.v)


def _chained(launch: Launch, tau: Any, v: Any) -> Trial | None:
    """The state after IMPACTS impacts; each adds a rounding of its own, carried on by those that follow."""
    r, at = flint.arb(launch.restitution), (flint.arb(launch.tau), flint.arb(launch.v))
    rounded: tuple[Any, Any] = (abs(at[0]), abs(at[1]))
    for _ in range(IMPACTS):
        true = landing(launch, at[0].mid(), at[1].mid())
        if isinstance(true, int):
            return None
        rounded = max(float(rounded[0]), float(true.flight_time)), rounded[1]
        (a, b), (c, d) = true.by_state
        late = abs(1 + a) * rounded[0] + abs(b) * rounded[1], r * (abs(c) * rounded[0] + abs(d) * rounded[1])
        at = at[0] + true.flight_time, r * abs(true.velocity)
        launch = replace(launch, wall=launch.wall ^ bool(true.velocity > 0))
        rounded = late[0] + abs(at[0]), late[1] + abs(at[1])
    return Trial(str(launch), [float(tau), float(v)], list(at), list(rounded))


JUDGES: dict[str, Judge] = {
    "first_hit": partial(_swept, _first_hit),
    "impact_map": partial(_swept, _impact_map),
    "flight": partial(_swept, _flight),
    "derivative": partial(_swept, _derivative),
    "inverse_map": partial(_swept, _inverse),
    "orbit": partial(_swept, _orbit),
    "iterate": partial(_swept, _iterate),
}
