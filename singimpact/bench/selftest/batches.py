"""Arrays longer than a batch of the kernels, each state compared; and flights beside a graze.

Truth: fixed steps of order 8, one state at a time, with rho evaluated by Python; launches that graze are bracketed by
them too. Shared with the package: f, g and rho as expression trees.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.bench.drawn import compile_entries
from singimpact.bench.selftest.rows import LEAST, Flown, Tally, compared
from singimpact.bench.truth.graded_steps import HIT, MISS
from singimpact.bench.truth.plain_orbits import PlainOrbits
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
