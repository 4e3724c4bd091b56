"""One flight with its condition numbers and errors: what `entries` and `orbits` repeat.

A hit is a row of numbers, columns FLIGHT_TIME and following of `state`.
"""

from math import inf, nan
from typing import Any

from singimpact.flights.kernels.double_double import sum_twice
from singimpact.flights.kernels.linear import coefficients, response
from singimpact.flights.kernels.refine import refine_hit
from singimpact.flights.kernels.state import (
    ACROSS,
    CONDITION,
    COSINE,
    FLIGHT_TIME,
    RATE,
    SINE,
    TIME_BY_TAU,
    TIME_BY_V,
    TIME_ERROR,
    VELOCITY,
    VELOCITY_BY_TAU,
    VELOCITY_BY_V,
    VELOCITY_CONDITION,
    VELOCITY_ERROR,
    Rules,
)
from singimpact.flights.kernels.tabulated import tabulated_flight
from singimpact.flights.kernels.taylor import taylor_flight
from singimpact.flights.kernels.variational import rounding
from singimpact.flights.kernels.waves import wall_acceleration

UNIT = 2.0**-52
# Codes beside those of `taylor_flight`: balls must place the hit; the chatter left is short enough to be summed; a_c is
# needed to more digits than its sum has; a state with v = 0, which is not flown.
NOT_REFINED, PRESSED, CANCELS, AT_REST = 30, 31, 32, 40


def next_hit(t: float, t_low: float, v: float, near: float, model: Any, work: Any) -> Any:
    """`linear_hit`; `flights.bind` puts `next_hit_in_steps` in its place for models without a closed form."""
    return linear_hit(t, t_low, v, 0.0, near, model, work)


def next_hit_in_steps(t: float, t_low: float, v: float, near: float, model: Any, work: Any) -> Any:
    """`taylor_hit` within an orbit."""
    return taylor_hit(t + t_low, v, near, inf, model, work)


def placed(t: float, t_low: float, model: Any, work: Any) -> float:
    """Fills work.launch for a launch at t + t_low; a_c there. Models without a closed form get `placed_in_steps`."""
    return float(wall_acceleration(t, t_low, model.numbers, model.rest, work.launch))


def placed_in_steps(t: float, t_low: float, model: Any, work: Any) -> float:  # noqa: ARG001
    """The launch is its time; a_c is left to the recurrence."""
    work.launch[0] = t + t_low
    return nan


def linear_hit(t: float, t_low: float, v: float, height: float, near: float, model: Any, work: Any) -> Any:
    """(code, a_c at the launch) of the flight of a linear model launched at t + t_low; a hit fills work.hit.

    Parameters
    ----------
    v, height : x' and x - c at the launch. near : the code is PRESSED where the chatter left is shorter
        than this part of the time on which a_c changes; 0 for never.
    """
    p, hit, launch = model.numbers, work.hit, work.launch
    a = wall_acceleration(t, t_low, p, model.rest, launch)
    if near > 0 and a < 0 and ends_soon(v, a, slope_of(p, launch), near, model.rules):
        return PRESSED, a
    code, time, u, depth, bound = tabulated_flight(launch, v, height, a, model, work.flight)
    hit[FLIGHT_TIME], hit[VELOCITY], hit[CONDITION], hit[VELOCITY_CONDITION] = time, u, depth, bound
    if code != 0 and code != ACROSS:
        return code, a
    # the size of a motion from a height is that of one from the wall, as fast
    by_v, by_v_dot, by_tau, by_tau_dot, size, speed = response(launch, abs(v) + p.fastest * height, time, p)
    at, at_low = sum_twice(t, t_low, time, 0.0)
    e, side, wall = wall_acceleration(at, at_low, p, model.rest, work.flight.q), 1.0, code
    if code == ACROSS:
        e, side = p.stiffness * model.rules.gap - e, -1.0
        by_v, by_v_dot, by_tau, by_tau_dot = -by_v, -by_v_dot, -by_tau, -by_tau_dot
    e -= p.damping * u
    conditioned(t, v, e, (by_v, by_v_dot, by_tau, by_tau_dot), hit)
    hit[TIME_ERROR], hit[VELOCITY_ERROR] = rounded(time, u, e, size, speed, p.fastest, model.rules.likely)
    rough = is_rough(hit[TIME_ERROR], hit[VELOCITY_ERROR], hit[CONDITION], hit[VELOCITY_CONDITION], model.rules)
    # a flight that is pressed back at once is a short series in t that loses nothing
    if rough and (time > model.table.step or a >= 0 or height > 0 or side < 0):
        code = wall + NOT_REFINED
    if code == wall + NOT_REFINED and len(model.fine) > 0:
        hit[FLIGHT_TIME], hit[VELOCITY], near = refine_hit(t, t_low, v, height, time, side, model, work.twice)
        hit[TIME_ERROR], hit[VELOCITY_ERROR] = min(hit[TIME_ERROR], 3 * UNIT), min(hit[VELOCITY_ERROR], 63 * UNIT)
        code = wall
        if not near:
            hit[FLIGHT_TIME], hit[VELOCITY] = time, u
            code = wall + NOT_REFINED
    hit[TIME_ERROR] += UNIT
    hit[VELOCITY_ERROR] += UNIT
    return code, a


def ends_soon(v: float, a: float, slope: float, near: float, rules: Any) -> bool:
    """Whether the chatter left, 2 v/(|a_c| (1 - r)), is below a part of the time on which a_c changes."""
    return bool(2 * v * (abs(slope) - a * rules.pace) < near * a * a * rules.lost)


def slope_of(p: Any, launch: Any) -> float:
    """The derivative of a_c at a launch."""
    slope = 0.0
    for j in range(len(p.waves)):
        slope += p.waves[j, RATE] * (p.waves[j, SINE] * launch[2 * j] - p.waves[j, COSINE] * launch[2 * j + 1])
    return slope


def conditioned(t: float, v: float, e: float, variation: Any, hit: Any) -> None:
    """Derivatives and condition numbers of a hit, see `at_the_hit`; t, reduced by the period, and v of the launch."""
    time, u = hit[FLIGHT_TIME], hit[VELOCITY]
    late, off, time_by_tau, time_by_v, velocity_by_tau, velocity_by_v = at_the_hit(
        max(abs(t), time), v, time, u, e, variation
    )
    hit[CONDITION], hit[VELOCITY_CONDITION], hit[TIME_BY_TAU], hit[TIME_BY_V] = late, off, time_by_tau, time_by_v
    hit[VELOCITY_BY_TAU], hit[VELOCITY_BY_V] = velocity_by_tau, velocity_by_v


def at_the_hit(reach: float, v: float, time: float, u: float, e: float, variation: Any) -> Any:
    """Condition numbers 1 + (|d_tau| |tau| + |d_v| v)/|value| of flight time and velocity, and their derivatives.

    Parameters
    ----------
    reach : an error of tau is relative to tau, or to the flight time where tau is small: it is rounded with both.
    e : x'' at the hit. variation : dx/dv, dx'/dv, dx/dtau, dx'/dtau at fixed flight time.
    """
    by_v, by_v_dot, by_tau, by_tau_dot = variation
    # x(T; tau, v) = c: by the implicit function theorem d T = -d x/x'; x' at the hit moves by d x' + x'' d T
    time_by_tau, time_by_v = -by_tau / u, -by_v / u
    velocity_by_tau, velocity_by_v = by_tau_dot + e * time_by_tau, by_v_dot + e * time_by_v
    late = 1 + (abs(time_by_tau) * reach + abs(time_by_v * v)) / time
    off = 1 + (abs(velocity_by_tau) * reach + abs(velocity_by_v * v)) / abs(u)
    return late, off, time_by_tau, time_by_v, velocity_by_tau, velocity_by_v


def rounded(time: float, u: float, e: float, size: float, speed: float, fastest: float, likely: float) -> Any:
    """Relative errors of flight time and velocity from the rounding of the sums behind x and x' at a hit.

    Parameters
    ----------
    e : x'' there. size, speed : of the terms of x and x'. likely : their rounding errors, in units.
    """
    # phases lose digits in time
    error = likely * UNIT * (1 + fastest * time / 64)
    late = error * size / abs(u)
    return late / time, (error * speed + abs(e) * late) / abs(u)


def is_rough(late: float, off: float, condition: float, velocity_condition: float, rules: Any) -> bool:
    """Whether a hit has errors that its condition numbers do not explain."""
    late_by_far = late > max(rules.rough_time, 10 * condition * UNIT)
    return bool(late_by_far | (off > max(rules.rough_velocity, 10 * velocity_condition * UNIT)))


def launch_acceleration(model: Any, work: Any) -> Any:
    """a_c at the launch of a Taylor flow, from its recurrence, and the rounding error of its sum."""
    order = model.rules.order
    # a literal 3 is a type of its own: every function that takes it would be compiled twice
    coefficients(work.launch, 0.0, 0.0, 0.0, 0.0, order - order + 3, model.numbers, work.flight)
    return 2 * work.flight.X[2], rounding(work.flight.X, work.flight.W, UNIT, model.numbers)


def taylor_hit(t: float, v: float, near: float, a_exact: float, model: Any, work: Any) -> Any:
    """(code, a_c at the launch) of a flight in Taylor steps from a launch at t, as `linear_hit` without conditions.

    Parameters
    ----------
    a_exact : a_c at the launch to all its digits; nan: from the recurrence, and the code is CANCELS where that loses
        five bits that matter; inf: from the recurrence.
    """
    hit, launch = work.hit, work.launch
    launch[0] = t
    a = a_exact
    if not abs(a_exact) < inf:
        a, error = launch_acceleration(model, work)
        # a_c decides the flight where v is small beside the size of its terms over the rate at which they change
        if a_exact != a_exact and 32 * UNIT * abs(a) < error and 4 * UNIT * v * model.rules.pace < error:
            return CANCELS, a
    if near > 0 and a < 0 and ends_soon(v, a, 6 * work.flight.X[3], near, model.rules):
        return PRESSED, a
    code, time, u, depth, bound = taylor_flight(
        launch, v, 1, a, model.numbers, model.rules, work.flight, work.flight.W[:0]
    )
    hit[FLIGHT_TIME], hit[VELOCITY], hit[CONDITION], hit[VELOCITY_CONDITION] = time, u, depth, bound
    return code, a


def released(removed: int, a: float, model: Any, work: Any) -> Any:
    """`taylor_flight` of a mass released at rest, by steps of one degree more for each root that is removed."""
    rules = raised(model.rules, removed - 1)
    return taylor_flight(work.launch, 0.0, removed, a, model.numbers, rules, work.flight, work.flight.W[:0])


def raised(rules: Any, degrees: int) -> Any:
    """Rules with steps of a higher degree."""
    return Rules(rules.horizon, rules.budget, rules.order + degrees, rules.short, rules.ulp, rules.likely,
                 rules.rough_time, rules.rough_velocity, rules.pace, rules.lost, rules.reach, rules.gap,
                 rules.gap_low)  # fmt: skip


def carried_errors(t: float, v: float, time: float, u: float, side: float, judged: Any, row: Any) -> None:
    """A hit with conditions and errors from what `variational.judge` returns; entry 10 counts the Taylor steps.

    Parameters
    ----------
    side : 1, or -1 of a hit of the other wall, whose velocity u is that of the model with x -> -x.
    """
    zz, zu, uu, e, steps = judged[4], judged[5], judged[6], side * judged[7], judged[8]
    row[FLIGHT_TIME], row[VELOCITY] = time, u
    conditioned(t, v, e, (side * judged[0], side * judged[1], side * judged[2], side * judged[3]), row)
    # the error (z, u) at the time of the hit moves the hit by -z/u and its velocity by u - z e/u; zz, zu, uu are second
    # moments
    turn = e / u
    late = (zz / (u * u) + steps * (time * UNIT / 2) * (time * UNIT / 2)) ** 0.5
    off = max(uu - 2 * turn * zu + turn * turn * zz, 0.0) ** 0.5
    row[TIME_ERROR], row[VELOCITY_ERROR] = late / time, off / abs(u)
    row[10] = steps
