"""The impact map of one model: flown forward and back, its derivative D G, and the law of rebound.

Truth of D G: central differences of fixed-step flights, with rho evaluated by Python. Truth of the rebound: rho
evaluated by Python at the velocity of the hit. Shared with the package: f, g and rho as expression trees.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from singimpact.algebra.numbers import EPSILON, Array
from singimpact.bench.selftest.draws import DRAW, LEAST, Flown, NotComparable, compared
from singimpact.bench.selftest.rows import Tally
from singimpact.oscillator.rebound import rho_of
from singimpact.status import Status

# Flights forward and back: `inverse_map` of the impact gives the launch, within what rounding explains. There is no
# independent truth: both flights, D G and the error estimates are those of the package.


@compared("flown forward and back")
def round_trip(flown: Flown, tally: Tally) -> None:
    """Launches that `inverse_map` gives back."""
    if flown.osc.plastic:
        raise NotComparable("restitution = 0")
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
