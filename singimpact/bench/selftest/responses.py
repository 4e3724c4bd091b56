"""The impact map of one model: flown forward and back, its derivative D G, and the law of rebound.

Truth of D G: central differences of fixed-step flights, with rho evaluated by Python. Truth of the rebound: rho
evaluated by Python at the velocity of the hit. Shared with the package: f, g and rho as expression trees.

Flights are compared with small fixed steps, balls, and more digits. Fixed steps (`bench.truth`) share with the package
f and g as expression trees; kappa is that of the package. Balls are those of the second program, which shares nothing
but the texts of the model. `digits=20` is the package's enclosure, by other code than its flights in doubles from the
recurrence on; it decides where doubles and fixed steps disagree.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.bench.measuring import relative_error
from singimpact.bench.selftest.rows import DRAW, LEAST, Flown, NotComparable, Tally, compared
from singimpact.bench.truth import graded_steps
from singimpact.bench.truth.graded_steps import HIT, MISS, UNDECIDED
from singimpact.bench.truth.hit_in_balls import enclosed, second_program
from singimpact.bench.truth.plain_orbits import Impact, PlainOrbits
from singimpact.certificates.checker import Refused
from singimpact.inputs import need
from singimpact.oscillator.rebound import rho_of
from singimpact.status import Status

# Flights forward and back: `inverse_map` of the impact gives the launch, within what rounding explains. There is no
# independent truth: both flights, D G and the error estimates are those of the package.


@compared("flown forward and back")
def round_trip(flown: Flown, tally: Tally) -> None:
    """Launches that `inverse_map` gives back."""
    need(not flown.osc.plastic, NotComparable("restitution = 0"))
    hit = np.flatnonzero(flown.step.status == Status.hit)
    for begin in range(0, hit.size, DRAW.together):
        if tally.late:
            tally.leave("CPU time used up", hit.size - begin)
            break
        _judge(flown, hit[begin : begin + DRAW.together], tally)


def _judge(flown: Flown, places: Array, tally: Tally) -> None:
    osc, step, horizon = flown.osc, flown.step, flown.scales.horizon
    walls = {} if osc.upper is None else {"wall": step.wall[places]}
    back: Any = osc.inverse_map(step.tau[places], step.v[places], horizon=2 * horizon, **walls)
    (by_tau, by_v), trip = allowed(flown, places)
    # where rho is no number inverse_map may take another of the velocities that rebound alike
    with np.errstate(invalid="ignore"):
        other_branch = trip & (np.abs(back.velocity - step.velocity[places]) > 1e-6 * np.abs(step.velocity[places]))
    for at, index in enumerate(places.tolist()):
        tau, v, time = flown.tau[index], flown.v[index], step.flight_time[index]
        status = Status(int(back.status[at]))
        state = f"{flown.call(index)} and back: tau {float(back.tau[at])!r}, v {float(back.v[at])!r}, {status.name}"
        if np.isnan(by_tau[at] + by_v[at]):
            state += "; derivative or an error of the flight is nan, so nothing says how near that must be"
        if status == Status.unresolved:
            tally.leave("unresolved")
        elif by_v[at] > RESPONSES.lost * v or by_tau[at] > RESPONSES.lost * time:
            tally.leave("rounding explains any difference")
        elif other_branch[at]:
            tally.leave("another velocity rebounds alike")
        elif status != Status.hit or (walls and back.wall[at]):
            tally.judge(np.inf, state)
        else:
            tally.judge(max(abs(back.tau[at] - tau) / by_tau[at], abs(back.v[at] - v) / by_v[at]), state)


def allowed(flown: Flown, places: Array) -> tuple[tuple[Array, Array], bool]:
    """Tolerances of tau and v after a flight forward and back, and whether rho is an expression.

    Notes
    -----
    The errors of the landing are `time_error` and `velocity_error` and a rounding; the flight back adds a rounding of
    its own; both are carried to the launch by the inverse of D G.
    """
    osc, step, tau, v = flown.osc, flown.step, flown.tau[places], flown.v[places]
    (a, b), (c, d) = np.moveaxis(osc.derivative(tau, v, horizon=flown.scales.horizon).matrix, (-2, -1), (0, 1))
    with np.errstate(all="ignore"):
        inverse = np.abs(np.array([[d, -b], [-c, a]]) / (a * d - b * c))
        time, landed, speed = (getattr(step, name)[places] for name in ("flight_time", "tau", "v"))
        rounding = RESPONSES.back * EPSILON
        late = step.time_error[places] * time + rounding * np.maximum(np.abs(landed), time)
        fast = (step.velocity_error[places] + rounding) * speed
        by_tau = inverse[0, 0] * late + inverse[0, 1] * fast + rounding * np.maximum(np.abs(tau), time)
        by_v = inverse[1, 0] * late + inverse[1, 1] * fast + rounding * v
    return (by_tau, by_v), str(rho_of(osc.restitution)) != str(rho_of(osc.slope_at_rest()))


@dataclass(frozen=True)
class ResponseSettings:
    """The number of states, and the tolerances of their comparison."""

    # of the landing state and of the flight back, in units of epsilon: the 10 of 10 kappa epsilon
    back: float = 10.0
    # where rounding explains more than this part of v or of the flight time, the map is not linear over it, and the
    # flight back may even miss the obstacle: such a state is undecided
    lost: float = 1e-2
    states: int = 100  # at which D G is compared
    # of an entry, relative to its natural size, beside the error of the differences
    wrong: float = 1e-6
    # a larger error of a difference, relative to the size of its entry, decides nothing
    bent: float = 1e-2
    # relative difference of v' from rho(velocity): rho is evaluated in another order
    rebound: float = 1e-12
    # the same where rho cancels: so many roundings of the sizes of its slope and v
    rounding: float = 32.0


RESPONSES = ResponseSettings()


@compared("D G against differences")
def derivatives(flown: Flown, tally: Tally) -> None:
    """All four entries of `osc.derivative`."""
    places = np.flatnonzero(flown.step.status == Status.hit)[: RESPONSES.states]
    matrices = flown.osc.derivative(flown.tau[places], flown.v[places], horizon=flown.scales.horizon).matrix
    tally.restart()
    for index in tally.in_time(range(places.size)):
        _matrix(flown, int(places[index]), matrices[index], tally)


def _matrix(flown: Flown, at: int, matrix: Array, tally: Tally) -> None:
    tau, v, plain = float(flown.tau[at]), float(flown.v[at]), flown.plain
    quotients, hit = plain.difference_quotients(tau, v), plain.impact(tau, v)
    if quotients is None or not np.isfinite(hit.v):
        tally.leave("a flight beside it does not return")
        return
    true, error = quotients
    sizes = np.outer([hit.time, abs(hit.v)], [plain.rate, 1 / v]) + np.abs(true)
    if not (error <= RESPONSES.bent * sizes).all():
        tally.leave("the map bends within a difference")
        return
    ratio = float(np.max(np.abs(matrix - true) / (RESPONSES.wrong * sizes + 10 * error + LEAST)))
    state = flown.call(at, "derivative")
    tally.judge(ratio, f"{state}: {matrix.round(9).tolist()}, differences {true.round(9).tolist()}")


@compared("rebound")
def rebounds(flown: Flown, tally: Tally) -> None:
    """The state after a hit: tau + T, and rho of the velocity."""
    step, plain = flown.step, flown.plain
    for at in np.flatnonzero((step.status == Status.hit) | (step.status == Status.no_rebound)).tolist():
        velocity, v = float(step.velocity[at]), float(step.v[at])
        true = abs(plain.rebound(velocity))
        state = f"{flown.call(at)}: velocity {velocity!r}, after it {v!r}, rho is {true!r}"
        if step.status[at] == Status.no_rebound:
            tally.judge(0.0 if not true > 0 else np.inf, state)
            continue
        beside = [abs(plain.rebound(velocity * (1 + s * 2.0**-44))) for s in (-1, 1)]
        # 2^-44 is 256 roundings
        near = LEAST + RESPONSES.rebound * true + RESPONSES.rounding / 256 * max(abs(end - true) for end in beside)
        passed = flown.tau[at] + step.flight_time[at]
        late = 4 * 2.0**-52 * (abs(flown.tau[at]) + step.flight_time[at])
        tally.judge(float(max(abs(v - true) / near, abs(step.tau[at] - passed) / late)), state)


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


# Orbits and chatter limits of one model, event by event, against `bench.truth.plain_orbits`.


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
