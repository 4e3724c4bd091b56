"""Entries that Python calls: one function for linear models and one for Taylor flows, over addresses.

`sizes[KIND]` is the kind of work. The entries that most sessions need are compiled first.
"""

from math import inf, nan
from typing import Any

from singimpact.flights.kernels.batch import fly_batches, hit_batches
from singimpact.flights.kernels.chatter import SETTINGS_OF_CHATTER, linear_limits
from singimpact.flights.kernels.gamma import SETTINGS_OF_GAMMA, bracket_gamma
from singimpact.flights.kernels.hits import (
    AT_REST,
    carried_errors,
    launch_acceleration,
    linear_hit,
    placed,
    raised,
    released,
    taylor_hit,
)
from singimpact.flights.kernels.layout import (
    COUNT,
    IMPACTS,
    KIND,
    RHO,
    batch_model,
    block,
    columns_of,
    laws_of,
    linear_model,
    other_linear_model,
    other_taylor_model,
    scratch_length,
    scratch_of,
    taylor_model,
)
from singimpact.flights.kernels.linear import place_of, response
from singimpact.flights.kernels.orbits import iterate, orbit_segment
from singimpact.flights.kernels.refine import fill_fine
from singimpact.flights.kernels.state import ACROSS, Array, Linear, Search, Table
from singimpact.flights.kernels.tables import bounds, expansions, tabulate
from singimpact.flights.kernels.taylor import follow, taylor_flight
from singimpact.flights.kernels.variational import derivatives_at, judge
from singimpact.flights.kernels.waves import reduced_twice

# Kinds of work: fill the tables of a model, of its batches; first hits of many states; impacts of one orbit; the last
# states of many orbits; derivatives of x and x' at given times; x and x' along one flight; errors and conditions of
# hits of a Taylor flow; flights from rest; brackets of gamma; ends of chatter; flights that start off the wall; x and
# x' of many flights at given times.
(PREPARE, PREPARE_BATCH, HITS, SEGMENT, ITERATE, VARIATIONS, FOLLOW, JUDGE, RELEASES, BRACKET, LIMIT, DROPS,
 PLACES) = range(13)  # fmt: skip


def linear_entry(sizes: Any, flat: Any, scratch: Any, tau: Any, v: Any, w: Any, out: Any, status: Any) -> int:
    """PREPARE, HITS, DROPS, SEGMENT, RELEASES, PLACES or VARIATIONS of a linear model.

    Parameters
    ----------
    sizes : see `layout`. flat, scratch : of the model. tau, v : states. w : times; the part of a time below which
        chatter ends an orbit, then constants of rho, and those of the other wall; orders of roots removed at rest;
        x - c at the start.
    out : results. status : codes.

    Returns
    -------
    int : how many codes are not 0; of SEGMENT the impacts flown.
    """
    count, kind = sizes[COUNT], sizes[KIND]
    model, work = linear_model(flat, sizes), scratch_of(scratch, sizes)
    models = model, other_linear_model(flat, sizes, model)
    if kind == SEGMENT:
        return segment(tau, v, w, laws_of(w, 1, sizes, model), models, work, block(out, 0, (count, 12)), status)
    if kind == PREPARE:
        if model.rules.gap < inf:
            prepare(models[1], work)
        return prepare(model, work)
    states, speeds, codes = block(tau, 0, (count,)), block(v, 0, (count,)), block(status, 0, (count,))
    if kind in (HITS, DROPS):
        heights = block(w, 0, (count if kind == DROPS else 0,))
        return linear_hits(states, speeds, heights, model, work, block(out, 0, (10, count)), codes)
    if kind == RELEASES:
        return releases(states, block(w, 0, (count,)), model, work, block(out, 0, (10, count)), codes)
    if kind == PLACES:
        return linear_places(states, speeds, block(w, 0, (count, 2)), model, work, block(out, 0, (count, 2)))
    return linear_variations(states, speeds, block(w, 0, (count,)), model, work, block(out, 0, (count, 4)))


def segment(tau: Any, v: Any, w: Any, laws: Any, models: Any, work: Any, out: Any, status: Any) -> int:
    """`orbits.orbit_segment` of one state."""
    flown, status[0] = orbit_segment(tau[0], v[0], w[0], laws, models, work, out)
    return int(flown)


def batch_entry(sizes: Any, flat: Any, scratch: Any, tau: Any, v: Any, w: Any, out: Any, status: Any) -> int:
    """PREPARE_BATCH, HITS, DROPS or ITERATE, whose last states come in place of tau, v; w as in `linear_entry`."""
    count = sizes[COUNT]
    model, work = linear_model(flat, sizes), scratch_of(scratch, sizes)
    models = model, other_linear_model(flat, sizes, model)
    batch = batch_model(flat, scratch, sizes, work, -1.0 if sizes[KIND] == DROPS else 0.0, model.rules.gap < inf)
    if sizes[KIND] == PREPARE_BATCH:
        # states that a batch cannot decide are flown one by one
        if model.rules.gap < inf:
            prepare_batch(models[1].numbers, batch.mirror.table, batch.mirror.series)
            prepare(models[1], work)
        prepare_batch(model.numbers, batch.table, batch.series)
        return prepare(model, work)
    states, speeds, codes = block(tau, 0, (count,)), block(v, 0, (count,)), block(status, 0, (count,))
    if sizes[KIND] in (HITS, DROPS):
        return hit_batches(states, speeds, block(w, 0, (count,)), model, batch, block(out, 0, (10, count)), codes)
    laws, walls = laws_of(w, 0, sizes, model), block(out, 0, (count,))
    fly_batches(states, speeds, sizes[IMPACTS], laws, models, batch, walls, codes)
    return 0


def search_entry(sizes: Any, flat: Any, scratch: Any, tau: Any, v: Any, w: Any, out: Any, status: Any) -> int:
    """BRACKET or LIMIT of a linear model whose tables are filled.

    Parameters
    ----------
    w : settings of the search, then constants of rho. sizes : IMPACTS of LIMIT are rows behind all scratch.
    """
    count = sizes[COUNT]
    model, work = linear_model(flat, sizes), scratch_of(scratch, sizes)
    states, codes = block(tau, 0, (count,)), block(status, 0, (count,))
    if sizes[KIND] == BRACKET:
        search = Search(block(w, 0, (SETTINGS_OF_GAMMA,)), block(w, SETTINGS_OF_GAMMA, (sizes[RHO],)))
        return linear_brackets(states, block(v, 0, (count, 3)), search, model, work, block(out, 0, (count, 2)), codes)
    rows = block(scratch, scratch_length(sizes), (sizes[IMPACTS], 6))
    search = Search(block(w, 0, (SETTINGS_OF_CHATTER,)), block(w, SETTINGS_OF_CHATTER, (sizes[RHO],)))
    speeds = block(v, 0, (count,))
    return linear_limits(states, speeds, search, model, work, rows, block(out, 0, (3, count)), codes)


def prepare(model: Any, work: Any) -> int:
    """Fills the tables of one flight."""
    tabulate(model.numbers, model.table)
    bounds(model.numbers, model.table)
    fill_fine(model.numbers, model.rest, model.table.step, model.fine, work.twice)
    return 0


def prepare_batch(numbers: Linear, table: Table, series: Array) -> None:
    """Fills the tables of a batch."""
    tabulate(numbers, table)
    bounds(numbers, table)
    expansions(numbers, series)


def linear_hits(tau: Any, v: Any, heights: Any, model: Any, work: Any, out: Any, status: Any) -> int:
    """`linear_hit` of every state; how many codes are not 0 is returned.

    Parameters
    ----------
    heights : x - c > 0 at the launches; empty for launches from the wall.
    """
    others = 0
    for i in range(len(tau)):
        code, height = AT_REST, (heights[i] if len(heights) > 0 else 0.0)
        if v[i] > 0 or height > 0:
            t, t_low = reduced_twice(tau[i], model.turn)
            code, _a = linear_hit(t, t_low, v[i], height, 0.0, model, work)
        status[i] = code
        others += 1 if code != 0 else 0
        for k in range(10):
            out[k, i] = work.hit[k]
    return others


def linear_brackets(tau: Any, given: Any, search: Any, model: Any, work: Any, out: Any, status: Any) -> int:
    """`bracket_gamma` of many phases; given : a velocity below gamma, one above it, and the time to its end."""
    others = 0
    for i in range(len(tau)):
        low, high, end = given[i, 0], given[i, 1], given[i, 2]
        out[i, 0], out[i, 1], status[i] = bracket_gamma(tau[i], low, high, end, search, model, work)
        others += 1 if status[i] != 0 else 0
    return others


def linear_variations(tau: Any, v: Any, times: Any, model: Any, work: Any, out: Any) -> int:
    """dx/dv, dx'/dv, dx/dtau, dx'/dtau at given times."""
    for i in range(len(tau)):
        t, t_low = reduced_twice(tau[i], model.turn)
        placed(t, t_low, model, work)
        by_v, by_v_dot, by_tau, by_tau_dot, _size, _speed = response(work.launch, v[i], times[i], model.numbers)
        out[i, 0], out[i, 1], out[i, 2], out[i, 3] = by_v, by_v_dot, by_tau, by_tau_dot
    return 0


def linear_places(tau: Any, v: Any, times: Any, model: Any, work: Any, out: Any) -> int:
    """x - c and x' at given times of flights from x - c = height, x' = v; times : of each flight, with its height."""
    for i in range(len(tau)):
        t, t_low = reduced_twice(tau[i], model.turn)
        push = placed(t, t_low, model, work)
        out[i, 0], out[i, 1] = place_of(work.launch, v[i], push, times[i, 1], times[i, 0], model.numbers)
    return 0


def releases(tau: Any, removed: Any, model: Any, work: Any, out: Any, status: Any) -> int:
    """First hits of masses released at rest; t = 0 is a root of x - c `removed` times."""
    others = 0
    for i in range(len(tau)):
        t, t_low = reduced_twice(tau[i], model.turn)
        a = placed(t, t_low, model, work)
        code, out[0, i], out[1, i], out[2, i], out[3, i] = released(int(removed[i]), a, model, work)
        status[i] = code
        others += 1 if code != 0 else 0
    return others


def drops(tau: Any, v: Any, heights: Any, model: Any, work: Any, out: Any, status: Any) -> int:
    """First hits of flights in Taylor steps that start off the wall: x - c = heights > 0, x' = v of either sign."""
    others, none = 0, model.rules.order - model.rules.order
    for i in range(len(tau)):
        t, t_low = reduced_twice(tau[i], model.turn)
        placed(t, t_low, model, work)
        work.flight.q[0] = heights[i]
        status[i], out[0, i], out[1, i], out[2, i], out[3, i] = taylor_flight(
            work.launch, v[i], none, nan, model.numbers, model.rules, work.flight, work.flight.W[:0]
        )
        others += 1 if status[i] != 0 else 0
    return others


def taylor_entry(sizes: Any, flat: Any, scratch: Any, tau: Any, v: Any, w: Any, out: Any, status: Any) -> int:
    """HITS, SEGMENT or ITERATE of a model flown in Taylor steps; as `linear_entry` and `batch_entry`."""
    count, kind = sizes[COUNT], sizes[KIND]
    model, work = taylor_model(flat, sizes), scratch_of(scratch, sizes)
    models = model, other_taylor_model(flat, sizes, model)
    if kind == SEGMENT:
        return segment(tau, v, w, laws_of(w, 1, sizes, model), models, work, block(out, 0, (count, 12)), status)
    states, speeds, codes = block(tau, 0, (count,)), block(v, 0, (count,)), block(status, 0, (count,))
    if kind == ITERATE:
        laws = laws_of(w, 0, sizes, model)
        iterate(states, speeds, sizes[IMPACTS], laws, models, work, block(out, 0, (count,)), codes)
        return 0
    return taylor_hits(states, speeds, block(w, 0, (count,)), model, work, block(out, 0, (10, count)), codes)


def judge_entry(sizes: Any, flat: Any, scratch: Any, tau: Any, v: Any, w: Any, out: Any, status: Any) -> int:
    """FOLLOW, RELEASES, DROPS, VARIATIONS or JUDGE of a model flown in Taylor steps.

    Parameters
    ----------
    v : velocities; of FOLLOW a velocity and x - c at the start. w : times; orders of the roots removed at a launch; of
        DROPS x - c at the start. sizes : IMPACTS are the rows of a trace, behind all scratch.
    """
    count, kind = sizes[COUNT], sizes[KIND]
    model, work = taylor_model(flat, sizes), scratch_of(scratch, sizes)
    states, speeds, quantities = block(tau, 0, (count,)), block(v, 0, (count,)), block(w, 0, (count,))
    if kind == FOLLOW:
        t, t_low = reduced_twice(tau[0], model.turn)
        placed(t, t_low, model, work)
        work.flight.q[0] = v[1]
        follow(work.launch, v[0], quantities, model.numbers, model.rules, work.flight, block(out, 0, (count, 2)))
        return 0
    if kind == RELEASES:
        codes = block(status, 0, (count,))
        return releases(states, quantities, model, work, block(out, 0, (10, count)), codes)
    if kind == DROPS:
        codes = block(status, 0, (count,))
        return drops(states, speeds, quantities, model, work, block(out, 0, (10, count)), codes)
    columns = columns_of(scratch, sizes)
    if kind == VARIATIONS:
        return taylor_variations(states, speeds, quantities, model, work, columns, block(out, 0, (count, 4)))
    trace = block(scratch, scratch_length(sizes), (sizes[IMPACTS], 4))
    return judged_hits(states, speeds, quantities, model, work, columns, trace, block(out, 0, (11, count)))


def taylor_hits(tau: Any, v: Any, accelerations: Any, model: Any, work: Any, out: Any, status: Any) -> int:
    """`taylor_hit` of every state; how many codes are not 0 is returned."""
    others = 0
    for i in range(len(tau)):
        code = AT_REST
        if v[i] > 0:
            t, t_low = reduced_twice(tau[i], model.turn)
            code, _a = taylor_hit(t + t_low, v[i], 0.0, accelerations[i], model, work)
        status[i] = code
        others += 1 if code != 0 else 0
        for k in range(4):
            out[k, i] = work.hit[k]
    return others


def taylor_variations(tau: Any, v: Any, times: Any, model: Any, work: Any, columns: Any, out: Any) -> int:
    """dx/dv, dx'/dv, dx/dtau, dx'/dtau at given times; nan where a flight does not get there."""
    for i in range(len(tau)):
        t, t_low = reduced_twice(tau[i], model.turn)
        placed(t, t_low, model, work)
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], reached = derivatives_at(
            work.launch, v[i], times[i], model.numbers, model.rules, work.flight, columns
        )
        if not reached:
            out[i, 0] = out[i, 1] = out[i, 2] = out[i, 3] = nan
    return 0


def judged_hits(tau: Any, v: Any, removed: Any, model: Any, work: Any, columns: Any, trace: Any, out: Any) -> int:
    """Hits with their condition numbers, errors and derivatives: columns of `state` and the number of Taylor steps.

    A flight of more steps than the trace has rows gets nan.
    """
    for i in range(len(tau)):
        t, t_low = reduced_twice(tau[i], model.turn)
        placed(t, t_low, model, work)
        trace[0, 3] = 0.0
        a = nan
        if v[i] > 0:
            a, _error = launch_acceleration(model, work)
        rules = raised(model.rules, int(removed[i]) - 1)
        code, time, u, _depth, _bound = taylor_flight(
            work.launch, v[i], int(removed[i]), a, model.numbers, rules, work.flight, trace
        )
        for k in range(11):
            out[k, i] = nan
        if (code == 0 or code == ACROSS) and trace[0, 3] > 0:
            judge(work.launch, trace, model.numbers, rules, work.flight, columns, work.hit)
            row = work.flight.q
            carried_errors(work.launch[0], v[i], time, u, 1.0 if code == 0 else -1.0, work.hit, row)
            for k in range(11):
                out[k, i] = row[k]
    return 0
