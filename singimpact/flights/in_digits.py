"""The impact map in many digits, from nothing but the exact state: proved where balls can, else two runs that agree."""

from fractions import Fraction
from math import inf, nan
from typing import Any, NamedTuple

import numpy as np

from singimpact.algebra.certified import from_ball
from singimpact.algebra.numbers import Array, as_mpf, sign_of
from singimpact.algebra.precision import digits_at, for_user
from singimpact.flights import undecided
from singimpact.flights.compiled_model import allowed
from singimpact.flights.enclosures.certified_hit import ENCLOSURE, Launch, certified_hit
from singimpact.flights.enclosures.equation import NoHit, Refused
from singimpact.flights.horizons import Allowance
from singimpact.flights.kernels.entries import HITS
from singimpact.flights.kernels.state import ACROSS
from singimpact.flights.multiprecision import found
from singimpact.flights.rebound_law import rebound_in_digits
from singimpact.flights.results import CertifiedImpact, Flight, Step
from singimpact.flights.states import States
from singimpact.oscillator.model import Oscillator
from singimpact.status import Cause, Status


def flights(osc: Oscillator, states: States, digits: int, allowance: Allowance) -> Flight:
    """First hits with `digits` digits, and their condition numbers from double precision.

    All are flown in doubles before: a flight that does not come back there does not here, and the number of its Taylor
    steps is known.
    """
    first = _plain_hit(osc, states, digits, allowance) if states.v.size == 1 else None
    if isinstance(first, Flight):
        return first
    size = states.v.size
    lost, budgets, roughs, kappas = _known_in_doubles(osc, states, allowance)
    codes, rows = np.zeros(size, dtype=np.int8), np.full((10, size), np.nan)
    fields = [np.empty(size, dtype=object) for _ in range(4)]
    certified, reasons = np.full(size, None, dtype=object), {}
    at_hand = np.array([index not in lost for index in range(size)], dtype=bool)
    moving = (roughs[1] < 0) | ((roughs[1] > 0) & (osc.upper is not None))
    in_doubles = at_hand & (states.v > 0) & (roughs[0] > 0) & moving  # from rest the rows are not filled
    roughs = np.where(in_doubles, roughs[:2], np.nan)
    open_ones = in_doubles & np.isnan(kappas).any(axis=0)
    if open_ones.any():
        kappas = np.where(open_ones, undecided.conditions(osc, states, open_ones, roughs[0], roughs[1])[:2], kappas)
    for index in range(size):
        limit = float(allowance.until(states.v[index]))
        proved = first or _proof(osc, states, index, digits, limit, lost, (*roughs[:2], kappas[1]))
        certified[index] = proved.impact
        if proved.reason:
            reasons[index] = proved.reason
        if proved.flight_time is not None:
            codes[index] = Status.hit
            numbers: Any = *(from_ball(number, digits).value for number in proved[:2]), nan, nan
            lost.pop(index, None)
        elif index in lost:
            codes[index], numbers = lost[index][0], (nan,) * 4
            rows[:4, index] = lost[index][1]
        elif proved.missed:
            codes[index], numbers = Status.no_return, (inf, nan, nan, nan)
        else:
            codes[index], numbers = found(osc, states, index, digits, limit, int(budgets[index]))
        if index not in lost:
            rows[:4, index] = [float(number) for number in numbers]
        code = int(codes[index]) % ACROSS
        status, numbers = (code, numbers) if code < 20 else (int(Status.unresolved), (nan,) * 4)
        with digits_at(digits) as mp:
            for field, value in zip(fields, _shown(status, numbers), strict=True):
                field[index] = for_user(+mp.convert(value))
    fates = undecided.Fates.of(codes, rows)
    for index, (_, _, cause) in lost.items():
        fates.cause[index] = cause
    notes = dict(undecided.notes_of(osc, states, fates))
    for index, reason in reasons.items():
        notes[index] = f"{notes[index]}; not certified: {reason}" if index in notes else f"not certified: {reason}"
    new = (fates.status == Status.hit) & ~in_doubles
    if new.any():
        kappas = np.where(new, undecided.conditions(osc, states, new, rows[0], rows[1])[:2], kappas)
    kappas = np.where(fates.status == Status.hit, kappas, np.nan)
    error = np.where(fates.status == Status.hit, 10.0 ** -min(digits, 300), np.nan)
    time, velocity, depth, bound = fields
    return Flight(
        time,
        velocity,
        fates.status,
        depth,
        bound,
        kappas[0],
        kappas[1],
        error,
        error.copy(),
        cause=fates.cause,
        notes=notes,
        certified=certified,
        wall=None if osc.upper is None else fates.walls,
    )


def _plain_hit(osc: Oscillator, states: States, digits: int, allowance: Allowance) -> "Flight | Proof | None":
    """One state of a Taylor flow that doubles bring back and balls prove; what balls prove else, None for nothing.

    Most calls are of this kind, and arrays of one number would take as long as the proof of a weak impact.
    """
    model, v = allowed(osc, allowance), float(states.v[0])
    if model.linear or model.sometimes_kept or not 0 < v < inf or not abs(states.tau[0]) < model.nearest:
        return None
    code, hit = model.one(HITS, float(states.tau[0]), v)
    if code != 0:
        return None
    kappas = model.judged(states.tau, states.v, np.ones(1))[2:4, 0]
    proved = proof(osc, states, 0, digits, float(allowance.until(v)), (hit[0], float(kappas[1])))
    if proved.impact is None:
        return proved
    with digits_at(digits) as mp:
        numbers = [for_user(+mp.convert(entry.value)) for entry in (proved.impact.flight_time, proved.impact.velocity)]
    time, velocity, certified = np.array([[*numbers, proved.impact]], dtype=object).T
    nothing, error = np.array([np.nan]), np.array([10.0 ** -min(digits, 300)])
    return Flight(
        time,
        velocity,
        np.zeros(1, np.int8),
        nothing,
        nothing.copy(),
        kappas[:1],
        kappas[1:],
        error,
        error.copy(),
        certified=certified,
        cause=np.zeros(1, np.int8),
        wall=None if osc.upper is None else np.array([hit[1] > 0], np.int8),
    )


def _proof(
    osc: Oscillator,
    states: States,
    index: int,
    digits: int,
    horizon: float,
    lost: dict[int, tuple[int, Array, int]],
    roughs: tuple[Array, Array, Array],
) -> "Proof":
    """The proof of a flight in balls; one that is proved in doubles never to return needs no other.

    Towards a point where f or g is not analytic the steps in balls shorten without end: such a flight is not tried.
    """
    if index in lost and lost[index][0] == Status.escaped:
        return Proof(None, None, None, "there is no hit: the flight is proved never to return")
    if index in lost and lost[index][2] in (Cause.kink, Cause.domain_left):
        return Proof(None, None, None, "f or g is not analytic where the flight goes")
    rough = None if index in lost else (float(roughs[0][index]), float(roughs[2][index]))
    return proof(osc, states, index, digits, horizon, rough)


def _known_in_doubles(
    osc: Oscillator, states: States, allowance: Allowance
) -> tuple[dict[int, tuple[int, Array, int]], Array, Array, Array]:
    """Code, numbers and cause of flights that do not come back; the Taylor steps allowed to the others; all numbers;
    both condition numbers, nan where they are not known.
    """
    budgets = np.full(states.v.size, allowance.steps)
    model = allowed(osc, allowance)
    if model.linear:
        codes, rows = model.hits(model.near(states.tau), states.v)
        fates = undecided.Fates.of(codes, rows)
        undecided.escapes(osc, model, states, fates)
        gone = (states.v > 0) & ((fates.status == Status.no_return) | (fates.status == Status.escaped))
        return {int(i): (int(fates.status[i]), rows[:4, i], 0) for i in np.flatnonzero(gone)}, budgets, rows, rows[2:4]
    tiny = [i for i in np.flatnonzero(states.v == 0).tolist() if sign_of(states.exact_v(i)) > 0]
    fates, judge = undecided.flown(osc, model, states)
    undecided.escapes(osc, model, states, fates)
    over = fates.lost | (fates.status == Status.no_return) | (fates.status == Status.escaped)
    over[tiny] = False
    lost = {int(i): (int(fates.status[i]), fates.rows[:4, i], int(fates.cause[i])) for i in np.flatnonzero(over)}
    judge.hits[tiny] = False
    steps, kappas = judge.steps()
    budgets = np.where(np.isnan(steps), allowance.steps, 2 * np.nan_to_num(steps) + 100).astype(int)
    return lost, budgets, fates.rows, kappas


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
    status, certified = np.array(hit.status, dtype=np.int8).ravel(), np.asarray(hit.certified, dtype=object).ravel()
    tau, v = np.empty(times.size, dtype=object), np.empty(times.size, dtype=object)
    with digits_at(digits) as mp:
        for index, (time, speed) in enumerate(zip(times.ravel(), speeds.ravel(), strict=True)):
            impact = certified[index]
            if impact is not None:
                landed, bounce = +mp.convert(impact.tau.value), +mp.convert(impact.v.value)
            else:
                landed = as_mpf(states.exact_tau(index), mp) + time
                bounce = rebound_in_digits(osc, mp.convert(speed), mp)
            if status[index] == Status.hit and not (bounce > 0 or osc.plastic):
                status[index], bounce = Status.no_rebound, mp.nan
            tau[index], v[index] = for_user(landed), for_user(bounce)
    shape = states.shape
    fields = vars(hit) | {"status": status.reshape(shape)[()]}
    return Step.made(**fields, tau=tau.reshape(shape)[()], v=v.reshape(shape)[()])


# ---- the proof of one flight in balls


class Proof(NamedTuple):
    """Balls of the flight time and of x' at the first hit and what they certify; or None for all, and why.

    `impact` is None beside a hit whose rebound is not shown positive. `missed` : proved, no hit before the horizon.
    """

    flight_time: Any
    velocity: Any
    impact: CertifiedImpact | None
    reason: str = ""
    missed: bool = False


def proof(
    osc: Oscillator, states: States, index: int, digits: int, horizon: float, rough: tuple[float, float] | None
) -> Proof:
    """The proof of a flight in balls.

    Parameters
    ----------
    horizon : no hit is looked for beyond. rough : flight time and condition number of the velocity in doubles, None
        where they find no hit; they choose the first precision.

    Examples
    --------
    >>> osc = Oscillator("x + x**3", "cos(1.7*t)", "0.3", "1/2")
    >>> print(proof(osc, States.of(osc, "1.4", "0.6"), 0, 20, 60.0, None).impact.tau)
    2.2817511466168335788
    """
    rest, launch = states.rest.get(index), (states.exact_tau(index), states.exact_v(index))
    standing = rest is not None and sign_of(launch[1]) == 0
    if standing and rest is not None and rest.sign <= 0:
        return Proof(None, None, None, "the mass is at rest and does not leave the wall")
    removed = rest.order + 2 if standing and rest is not None else 1
    try:
        hit = certified_hit(
            osc,
            Launch(*launch, removed),
            digits,
            Fraction(horizon),
            steps=ENCLOSURE.idle_steps if rough is None else ENCLOSURE.steps,
            expected=_expected(rough),
        )
    except NoHit as none:
        return Proof(None, None, None, f"proved: {none}", missed=True)
    except (Refused, ArithmeticError, ValueError, TypeError) as reason:  # a ball that left the domain of a function
        return Proof(None, None, None, str(reason) or type(reason).__name__)
    if not (hit.v > 0 or (osc.plastic and hit.velocity < 0)):
        return Proof(hit.flight_time, hit.velocity, None, "the velocity after the impact is not shown positive")
    time, velocity, tau, v = (from_ball(ball, digits) for ball in (hit.flight_time, hit.velocity, hit.tau, hit.v))
    # a certificate names the model and the launch
    return Proof(hit.flight_time, hit.velocity, CertifiedImpact(time, velocity, tau, v, osc, launch))


def _expected(rough: tuple[float, float] | None) -> tuple[float, float]:
    """Flight time and condition number of a hit from double precision, where it decides the flight."""
    if rough is None:
        return inf, 1.0
    time, condition = rough
    return (time, condition if condition > 1 else 1.0) if time > 0 else (0.0, 1.0)
