"""Orbits and chatter limits of one model, event by event, against `bench.truth.plain_orbits`.

Truth: impacts by fixed steps of order 8, chatter summed from such impacts, zeros of a_c by its sign on both sides,
flights from rest by scipy's DOP853. Shared with the package: f, g, rho as expression trees, and the period.
"""

from dataclasses import dataclass

import numpy as np

from singimpact.algebra.numbers import EPSILON
from singimpact.bench.selftest.rows import LEAST, Flown, NotComparable, Tally, compared
from singimpact.bench.truth.graded_steps import HIT, MISS, UNDECIDED
from singimpact.bench.truth.plain_orbits import Impact, PlainOrbits
from singimpact.status import Status


@dataclass(frozen=True)
class OrbitSettings:
    """The number of orbits and chatter sequences, and the tolerances of their comparison."""

    orbits: int = 6
    slow_orbits: int = 4  # beside those of the fastest states: slow ones where a_c < 0, which chatter
    impacts: int = 40
    limits: int = 20  # chatter sequences
    most: int = 3000  # impacts flown of each at most: r = 0.99 takes 2000
    slow: float = 0.03  # velocities of chatter are below this part of the largest one drawn
    wrong: float = 1e-9  # relative difference of a flight or a chatter; fixed steps agree to 1e-11
    # a lift-off may be off by this part of 1/rate, and by so many roundings of a_c over its slope
    lifted: float = 1e-11
    rounding: float = 64.0
    looked: int = 512  # times between rest and lift-off at which a_c must not be positive
    flat: float = 1e-3  # a zero of a_c that is less sharp, in units of 1/rate, is undecided
    # where fixed steps do not return the flight of an orbit: as far as that flight, and a half more
    longer: float = 1.5


ORBITS = OrbitSettings()


@compared("orbits, event by event", "no orbit that was flown has an event")
def orbits(flown: Flown, tally: Tally) -> None:
    """All events of `osc.orbit`: impacts, ends of chatter, lift-offs, and what comes last."""
    for at in tally.in_time(_starts(flown)):
        _orbit(flown, at, tally)


def _starts(flown: Flown) -> list[int]:
    """Fast states, and slow ones that are pressed."""
    spread = np.argsort(-flown.v, kind="stable")[:: max(flown.v.size // ORBITS.orbits, 1)][: ORBITS.orbits]
    slow = np.flatnonzero((flown.plain.pushes(flown.tau) < 0) & (flown.v < ORBITS.slow * flown.scales.fast))
    return list(dict.fromkeys([*spread.tolist(), *slow[: ORBITS.slow_orbits].tolist()]))


def _orbit(flown: Flown, at: int, tally: Tally) -> None:
    orbit, plain = flown.osc.orbit(flown.tau[at], flown.v[at], ORBITS.impacts), flown.plain
    call = f"{flown.call(at, 'orbit').split(', horizon')[0]}), event "
    tau, v, kind = orbit.tau.tolist(), orbit.speeds.tolist(), orbit.kind.tolist()
    for index in range(1, len(tau)):
        if tally.late:
            return
        before, after = (tau[index - 1], v[index - 1]), (tau[index], v[index])
        state = f"{call}{index} ({kind[index]}): "
        if kind[index] == "release":
            _lift_off(plain.at(after[1]), before[0], after[0], state, tally)
        elif kind[index] == "complete":
            _end_of_chatter(plain, before, after[0], state, tally)
        elif kind[index] == "graze":
            tally.leave("graze")
        else:
            _impact(plain, before, after, state, tally)
    if len(orbit.phases) == len(tau):
        _last(plain, orbit.phases[-1], (tau[-1], v[-1]), call + f"{len(tau)}: ", tally)


def _impact(
    plain: PlainOrbits, before: tuple[float, float], after: tuple[float, float], state: str, tally: Tally
) -> None:
    passed = after[0] - before[0]
    horizon = max(plain.horizon, ORBITS.longer * passed)
    rest = before[1] == 0
    hit = plain.lifted(before[0], horizon, before[1]) if rest else plain.impact(*before, horizon)
    state += f"tau {after[0]!r}, v {after[1]!r}, truth {before[0] + hit.time!r}, {hit.v!r}"
    if hit.status == UNDECIDED:
        tally.leave("steps do not settle")
        return
    if hit.status == MISS:
        tally.judge(np.inf, state)
        return
    late = ORBITS.wrong * hit.time + 4 * EPSILON * (abs(after[0]) + abs(before[0]))
    fast = ORBITS.wrong * abs(hit.v) + LEAST
    ratio = _ratio(hit, passed, after[1], (late, fast))
    if not ratio <= 1 and not rest:
        more = plain.spread(*before)
        if not np.isfinite(more[0]):
            tally.leave("rounding decides whether the flight touches")
            return
        ratio = _ratio(hit, passed, after[1], (late + more[0], fast + more[1]))
    tally.judge(ratio, state)


def _ratio(hit: Impact, passed: float, v: float, allowed: tuple[float, float]) -> float:
    return max(abs(hit.time - passed) / allowed[0], abs(hit.v - v) / allowed[1])


def _end_of_chatter(plain: PlainOrbits, before: tuple[float, float], end: float, state: str, tally: Tally) -> None:
    true = plain.chatter(*before, ORBITS.most)
    state += f"{end!r}, truth {true.status} at {before[0] + true.time!r}"
    if true.status == "open":
        tally.leave("impacts do not accumulate within the number flown")
    elif true.status == "lifts off":
        tally.judge(np.inf, state)
    else:
        allowed = ORBITS.wrong * true.time + true.error + 4 * EPSILON * (abs(end) + abs(before[0]))
        tally.judge(abs(end - before[0] - true.time) / allowed, state)


def _lift_off(plain: PlainOrbits, rest: float, lifted: float, state: str, tally: Tally) -> None:
    """a_c changes from - to + at the lift-off, and is not positive between rest and lift-off."""
    h = 1e-6 / plain.rate
    around = plain.pushes(lifted + np.linspace(-1, 1, 5) / plain.rate)
    size = float(np.max(np.abs(around))) + abs(float(plain.push(rest)))
    slope = (plain.push(lifted + h) - plain.push(lifted - h)) / (2 * h)
    noise = ORBITS.rounding * EPSILON * size
    beside = ORBITS.lifted / plain.rate + 16 * EPSILON * abs(lifted) + noise / max(slope, 1e-300)
    signs = plain.push(lifted - beside), plain.push(lifted + beside)
    state += f"mass at rest from {rest!r} lifts off at {lifted!r}, a_c {signs[0]:.3g} and {signs[1]:.3g} beside it"
    between = plain.pushes(np.linspace(rest, lifted - beside, ORBITS.looked)) if lifted - beside > rest else np.zeros(1)
    if float(np.max(between)) > noise:
        tally.judge(np.inf, state + f", a_c {np.max(between):.3g} before")
    elif slope > 0 and beside <= ORBITS.flat / plain.rate:
        tally.judge(0.0 if signs[0] < 0 < signs[1] else np.inf, state)
    elif slope < 0 and -slope * beside > noise:
        tally.judge(np.inf, state)
    else:
        tally.leave("a_c is flat at the lift-off")


def _last(
    plain: PlainOrbits, phase: tuple[str, float, float], last: tuple[float, float], state: str, tally: Tally
) -> None:
    """The motion after the last event: no impact, or rest for ever."""
    if phase[0] == "no_return":
        hit = plain.impact(*last) if last[1] else plain.lifted(last[0], v=last[1])
        if hit.status == UNDECIDED:
            tally.leave("steps do not settle")
        else:
            tally.judge(np.inf if hit.status == HIT else 0.0, state + f"no return, truth {hit.time!r}")
    elif phase[0] == "sticking" and not np.isnan(plain.period):
        pushes = plain.at(last[1]).grid[1]
        noise = ORBITS.rounding * EPSILON * float(np.max(np.abs(pushes)))
        tally.judge(0.0 if float(np.max(pushes)) <= noise else np.inf, state + "rest for ever, a_c is positive")
    else:
        tally.leave(f"ends in {phase[0]}")


@compared("chatter limits", "does not apply: no slow state that was drawn is pressed")
def limits(flown: Flown, tally: Tally) -> None:
    """`osc.chatter_limit` of slow states."""
    plain = flown.plain
    if not any(wall.slope < 1 for wall in (plain, plain.above) if wall is not None):
        raise NotComparable("rho is not smooth at rest, or has slope -1: no geometric series")
    pressed = plain.pushes(flown.tau) < 0
    slow = (flown.v < ORBITS.slow * flown.scales.fast) & (flown.step.status == Status.hit)
    for at in tally.in_time(np.flatnonzero(pressed & slow)[: ORBITS.limits].tolist()):
        _limit(flown, at, tally)


def _limit(flown: Flown, at: int, tally: Tally) -> None:
    tau, v, plain = float(flown.tau[at]), float(flown.v[at]), flown.plain
    limit = flown.osc.chatter_limit(tau, v, impacts=ORBITS.most)
    status = Status(int(limit.status))
    if status == Status.unresolved:
        tally.leave("impacts do not accumulate within the number flown")
        return
    true = plain.chatter(tau, v, ORBITS.most)
    state = flown.call(at, "chatter_limit").split(", horizon")[0]
    state += f"): {float(limit.tau)!r}, {status.name}, truth {tau + true.time!r}, {true.status}"
    if true.status == "open":
        tally.leave("impacts do not accumulate within the number flown")
        return
    ends = {Status.complete: "complete", Status.lifts_off: "lifts off"}
    side = plain.chatter(tau, v * (1 + 1e-9), ORBITS.most)
    if ends.get(status) != true.status:
        if side.status == true.status == plain.chatter(tau, v * (1 - 1e-9), ORBITS.most).status:
            tally.judge(np.inf, state)
        else:
            tally.leave("rounding decides whether it completes")
        return
    moved = abs(side.time - true.time) if side.status == true.status else np.inf
    if not np.isfinite(moved) or moved > 1e-2 * true.time:
        tally.leave("rounding decides when it ends")
        return
    allowed = float(limit.error) + true.error + ORBITS.wrong * true.time + 1e-2 * moved
    tally.judge(float(abs(limit.tau - tau - true.time) / allowed), state)
