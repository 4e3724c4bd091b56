"""Impact after impact in one loop: the launch is made from the phase, the rebound from rho."""

from math import nan
from typing import Any

from singimpact.flights.kernels.double_double import sum_twice
from singimpact.flights.kernels.hits import NOT_REFINED, next_hit
from singimpact.flights.kernels.state import (
    ACROSS,
    CONDITION,
    FLIGHT_TIME,
    TIME_BY_TAU,
    TIME_BY_V,
    TIME_ERROR,
    VELOCITY,
    VELOCITY_BY_TAU,
    VELOCITY_BY_V,
)
from singimpact.flights.kernels.waves import reduced_twice


def rebound(velocity: float, w: Any) -> float:
    """rho(velocity) of a constant restitution w[0], where the last number of w is 0; else of a law."""
    if w[len(w) - 1] == 0:
        return float(abs(w[0] * velocity))
    return law(velocity, w)


def law(velocity: float, w: Any) -> float:  # noqa: ARG001
    """nan: `flights.bind` puts an emitted rho in this place, or a call of the address that is the last number of w."""
    return nan


def orbit_segment(tau: float, v: float, near: float, laws: Any, models: Any, work: Any, out: Any) -> Any:
    """(impacts flown, code of the last flight) of one orbit, at most one impact a row of `out`.

    Parameters
    ----------
    tau, v : the state. laws : constants of rho at the wall of the state and at the other one. models : the model, and
        the one with x -> -x where there is another wall. out : row i becomes the time since the start, v, flight time,
        velocity, a_c at the launch, kappa and the error of the flight time, the derivatives of the flight time and of
        the velocity by tau and v of impact i, and 1 where it is one of the other wall, else 0; the six before the last
        are of linear models.
    near : the orbit ends, with code PRESSED, where the chatter left is short, see `hits.linear_hit`.
    """
    since, lost, side = 0.0, 0.0, 0.0
    for i in range(len(out)):
        code, a, v, side = impact(tau, since, lost, v, near, side, (laws, models), work)
        if code != 0:
            return i, code
        since, lost = later(since, lost, work.hit[FLIGHT_TIME])
        record(out[i], since, v, a, side, work.hit)
        if not v > 0:
            return i + 1, 8
    return len(out), 0


def impact(tau: float, since: float, lost: float, v: float, near: float, side: float, walls: Any, work: Any) -> Any:
    """(code, a_c at the launch, velocity after the impact, its wall) of a launch at tau + since - lost.

    Parameters
    ----------
    side : 0 at the wall of the first of the models, 1 at that of the second. walls : the laws and the models.
    """
    laws, models = walls
    # models are chosen by branches: compiled tuples of arrays that are reassigned would count references
    if side == 0.0:
        code, a = hit_later(tau, since, lost, v, near, models[0], work)
    else:
        code, a = hit_later(tau, since, lost, v, near, models[1], work)
    if code == ACROSS:
        code, side = 0, 1.0 - side
    if code == 0:
        v = rebound(work.hit[VELOCITY], laws[0]) if side == 0.0 else rebound(work.hit[VELOCITY], laws[1])
    return code, a, v, side


def hit_later(tau: float, since: float, lost: float, v: float, near: float, model: Any, work: Any) -> Any:
    """`hits.next_hit` of a launch at tau + since - lost.

    A hit that is not refined, for want of a table, is within a few roundings more: it counts as a hit.
    """
    t, t_low = launched(tau, since, lost, model)
    code, a = next_hit(t, t_low, v, near, model, work)
    if code == NOT_REFINED or code == ACROSS + NOT_REFINED:
        code -= NOT_REFINED
    return code, a


def launched(tau: float, since: float, lost: float, model: Any) -> Any:
    """(t, t_low): tau + since - lost, reduced by the period."""
    at, at_low = sum_twice(tau, 0.0, since, -lost)
    t, t_low = reduced_twice(at, model.turn)
    return sum_twice(t, t_low, at_low, 0.0)


def iterate(tau: Any, v: Any, count: int, laws: Any, models: Any, work: Any, sides: Any, status: Any) -> None:
    """`count` impacts from every state; tau, v become the last states, status what ended an orbit before, else 0.

    Parameters
    ----------
    laws, models : as for `orbit_segment`. sides : becomes 1 where the last state is one of the other wall, else 0.
    """
    for i in range(len(tau)):
        since, lost, side = 0.0, 0.0, 0.0
        for _ in range(count):
            if status[i] != 0:
                break
            code, _a, v[i], side = impact(tau[i], since, lost, v[i], 0.0, side, (laws, models), work)
            if code == 0:
                since, lost = later(since, lost, work.hit[FLIGHT_TIME])
                if not v[i] > 0:
                    code = 8
            status[i] = code
        tau[i] += since - lost
        sides[i] = side


def later(since: float, lost: float, time: float) -> Any:
    """since + time, and what the sum has lost: a thousand impacts would lose a thousand roundings of tau."""
    part = time - lost
    total = since + part
    return total, (total - since) - part


def record(row: Any, since: float, v: float, a: float, side: float, hit: Any) -> None:
    """One impact of an orbit as a row."""
    row[0], row[1], row[2], row[3], row[4] = since, v, hit[FLIGHT_TIME], hit[VELOCITY], a
    row[5], row[6] = hit[CONDITION], hit[TIME_ERROR]
    row[7], row[8], row[9], row[10] = hit[TIME_BY_TAU], hit[TIME_BY_V], hit[VELOCITY_BY_TAU], hit[VELOCITY_BY_V]
    row[11] = side
