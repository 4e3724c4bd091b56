"""Impacts in balls of 60 digits from `bench.truth`, with their derivatives, and the sequences of flights."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from math import pi
from typing import Any

import flint
import numpy as np

from singimpact.algebra.precision import balls_at
from singimpact.bench.stress.judging import STEP, Judge, Trial
from singimpact.bench.stress.launches import Launch, SteepLaunch, both
from singimpact.bench.truth import enclosed_flight
from singimpact.bench.truth.enclosed_flight import EnclosureSettings
from singimpact.bench.truth.first_hit import first_of_both
from singimpact.flights.inverse_map import backwards
from singimpact.status import Status

SQUARED = 1e-140  # the height of a flight is of the size of v squared, and below 1e-300 doubles lose digits
IMPACTS = 4  # of an orbit: every impact multiplies the condition number, so more impacts would hide errors
GONE = (Status.no_return, Status.escaped)


# Models with steep layers: impacts in balls by `bench.truth.enclosed_flight`, and their derivatives as differences of
# such balls.

# differences over 10^-STEP, and differences of these, keep 10 digits
EXACT = EnclosureSettings(accuracy=1e-60, bits=240)
Pair = tuple[Any, Any]


def landed(launch: SteepLaunch, tau: Any, v: Any, sign: int) -> tuple[Any, Any, tuple[Pair, Pair]] | None:
    """Time and velocity of the next impact and their derivatives by (tau, v); None where there is none.

    Parameters
    ----------
    tau, v : numbers or balls, of which the midpoints are flown. sign : -1 for the flight backwards.
    """
    start = [flint.arb(flint.arb(number).mid()) for number in (tau, v)]
    time, velocity = _flown(launch, *map(_key, start), sign)
    if time is None:
        return None
    small, rows = flint.arb(10) ** -STEP, []
    for moved in (0, 1):
        size = max(abs(float(start[moved])), 1.0) if moved == 0 else float(start[1])
        change = flint.arb((small * size).mid())
        there = [number + change if index == moved else number for index, number in enumerate(start)]
        late, fast = _flown(launch, *(_key(flint.arb(number.mid())) for number in there), sign)
        if late is None:
            return None
        rows.append(((late - time) / change, (fast - velocity) / change))
    (time_by_tau, velocity_by_tau), (time_by_v, velocity_by_v) = rows
    return time, velocity, ((time_by_tau, time_by_v), (velocity_by_tau, velocity_by_v))


def _key(exact: Any) -> Pair:
    """Mantissa and exponent of an exact ball."""
    mantissa, exponent = exact.man_exp()
    return int(mantissa), int(exponent)


@lru_cache(maxsize=4096)  # the functions of a place fly the same states
def _flown(launch: SteepLaunch, tau: Pair, v: Pair, sign: int) -> Pair:
    model = launch.model if sign > 0 else backwards(launch.model)
    state = [flint.arb(mantissa) * flint.arb(2) ** exponent for mantissa, exponent in (tau, v)]
    with balls_at(launch.bits):
        found = enclosed_flight.first_hit(model, state[0], state[1], launch.horizon, EXACT)
    return found.flight_time, found.velocity


@dataclass(frozen=True)
class Landing:
    """The next impact of a state in balls: flight time, velocity up from its wall; their derivatives by (tau, v)."""

    time: Any
    velocity: Any
    by_state: tuple[tuple[Any, Any], tuple[Any, Any]]

    def moved(self, sizes: tuple[float, float]) -> list[Any]:
        """The change of time and velocity for a change of the state by its size."""
        return [sum(abs(part) * size for part, size in zip(row, sizes, strict=True)) for row in self.by_state]


def landing(launch: Launch, tau: Any, v: Any, sign: int = 1) -> Landing | int:
    """The impact, or the status that is right: sticks, graze or no return.  Call it with the working precision set."""
    if isinstance(launch, SteepLaunch):
        there = landed(launch, tau, v, sign)
        return int(Status.no_return) if there is None else Landing(*there)
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
    return Landing(time, u, ((rows[0][0], rows[1][0]), (rows[0][1], rows[1][1])))


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
    hit, true = (
        launch.model.first_hit(launch.tau, launch.v, horizon=launch.horizon),
        landing(launch, launch.tau, launch.v),
    )
    if isinstance(true, int) or hit.status != Status.hit:
        return Trial(str(launch), status=_status(hit.status, true if isinstance(true, int) else int(Status.hit)))
    found = [float(hit.flight_time), float(hit.velocity)]
    return Trial(str(launch), found, [true.time, true.velocity], true.moved(sizes(launch, true.time)))


def _impact_map(launch: Launch) -> Trial:
    step = launch.model.impact_map(launch.tau, launch.v, horizon=launch.horizon)
    true = landing(launch, launch.tau, launch.v)
    if isinstance(true, int) or step.status != Status.hit:
        return Trial(str(launch), status=_status(step.status, true if isinstance(true, int) else int(Status.hit)))
    r, late = flint.arb(launch.restitution), true.moved(sizes(launch, true.time))
    values = [true.time + launch.tau, r * abs(true.velocity)]
    return Trial(str(launch), [float(step.tau), float(step.v)], values, [late[0], r * late[1]])


def _inverse(launch: Launch) -> Trial:
    landed = launch.v * launch.restitution  # so that r -> 0 does not send the flight to infinity
    before = launch.model.inverse_map(launch.tau, landed, horizon=launch.horizon)
    true = landing(launch, -launch.tau, flint.arb(landed) / flint.arb(launch.restitution), -1)
    if isinstance(true, int) or before.status != Status.hit:
        return Trial(str(launch), status=_status(before.status, true if isinstance(true, int) else int(Status.hit)))
    size, speed = sizes(launch, true.time)
    late = true.moved((size, speed))
    return Trial(str(launch), [float(before.tau), float(before.v)], [launch.tau - true.time, abs(true.velocity)], late)


def _flight(launch: Launch) -> Trial | None:
    """Times soon after the launch, halfway to the hit, and just before it."""
    true = landing(launch, launch.tau, launch.v)
    if isinstance(true, int) or launch.v < SQUARED:
        return None
    times = [float(true.time) * share for share in (1e-6, 0.5, 0.999)]
    path_, motion = launch.model.flight(launch.tau, launch.v, times), launch.motion(launch.tau, launch.v)
    truth, slack = [], []
    for t in times:
        (z, u, e), (by_tau, by_v) = motion.at(flint.arb(t)), motion.variations(flint.arb(t))
        size = sizes(launch, t)
        truth += [z + launch.clearance, u]
        slack += [abs(by_tau[n]) * size[0] + abs(by_v[n]) * size[1] + abs(rate) * t for n, rate in ((0, u), (1, e))]
    samples = np.stack([path_.x, path_.xdot], axis=1).ravel().tolist()
    return Trial(str(launch), samples, truth, slack)


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
    return [1 + a, b, r * c, r * d], true.time


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
        rounded = max(float(rounded[0]), float(true.time)), rounded[1]
        (a, b), (c, d) = true.by_state
        late = abs(1 + a) * rounded[0] + abs(b) * rounded[1], r * (abs(c) * rounded[0] + abs(d) * rounded[1])
        at = at[0] + true.time, r * abs(true.velocity)
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
