"""Many orbits at once, in doubles: lanes for linear models, one state after another for the others."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import frexp, ldexp
from typing import Any

import numpy as np

from singimpact.algebra.balls import Balls, as_rational
from singimpact.algebra.expressions import substitute
from singimpact.algebra.numbers import as_float
from singimpact.codegen.interpreted import function
from singimpact.codegen.kernels import compiled
from singimpact.codegen.scalar import scalar
from singimpact.flights import chains, lane_roots, lane_walk, lanes
from singimpact.flights.causes import decoded
from singimpact.flights.in_doubles import EPSILON, doubles, remainders
from singimpact.flights.kernel import PRICES, kernel_of, source
from singimpact.flights.launch import States, horizon_of
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.phase import reduced
from singimpact.flights.tables import LANES, STRIDES, Table, table_of
from singimpact.oscillator.model import Oscillator
from singimpact.oscillator.rebound import rho_of
from singimpact.status import Status

LOOPS = (chains.late, lanes.landed, lanes.phased, lane_walk.ahead, lane_walk.doubtful, lane_walk.judged, lane_walk.walk,
         lane_roots.turned_to, lane_roots.expanded, lane_roots.guess, lane_roots.polish, lanes.lanes)  # fmt: skip


@dataclass(frozen=True)
class Ends:
    """The states after the last impact flown, and 0, or the status of the flight that ended an orbit before."""

    tau: Any
    v: Any
    status: Any


def after(osc: Oscillator, tau: Any, v: Any, impacts: int, tolerance: float = EPSILON) -> Ends:
    """G^impacts of states with v > 0; an orbit that meets no further impact stays where it is.

    Parameters
    ----------
    osc : the model. tau, v : states that broadcast. impacts : flown.
    tolerance : relative error of a Taylor step; closed forms and what doubles then leave undecided keep to roundings.

    Examples
    --------
    >>> ends = after(Oscillator("0", "-2", 0, "1/2"), [0, 1], 1, 3)
    >>> ends.tau.tolist(), ends.v.tolist()
    ([1.75, 2.75], [0.125, 0.125])
    """
    states = States.read(tau, v)
    kernel = kernel_of(osc)
    table = table_of(kernel, doubles(kernel), LANES)
    times, speeds = states.tau.copy(), states.v.copy()
    status = np.where(speeds > 0, np.int8(0), np.int8(Status.sticks))
    shift = np.zeros(times.size) if osc.period is None else times - reduced(times, osc.period)
    if table is None:
        flown = _chained(osc, [times - shift, speeds, status], impacts, tolerance)
        if tolerance > EPSILON and (near := flown[2] == Status.unresolved).any():
            flown[2][near] = 0
            again = _chained(osc, [part[near] for part in flown], 1, EPSILON)
            for part, better in zip(flown, again, strict=True):
                part[near] = better
        flown[0], flown[2] = flown[0] + shift, decoded(flown[2])[0]
        return Ends(*(part.reshape(states.shape)[()] for part in flown))
    padded = [np.resize(part, -(-times.size // lanes.LANES) * lanes.LANES) for part in (times - shift, speeds, status)]
    padded[2][times.size :] = Status.sticks
    _fly(osc, table, padded, impacts)
    parts = (padded[0][: times.size] + shift, padded[1][: times.size], padded[2][: times.size])
    return Ends(*(part.reshape(states.shape)[()] for part in parts))


def _chained(osc: Oscillator, parts: list[Any], impacts: int, epsilon: float) -> list[Any]:
    """One state after another in Taylor steps, in blocks that hear an interruption."""
    kernel, order = kernel_of(osc), degree_for(epsilon)
    text, trees = scalar(rho_of(osc.restitution), "v", "rebound")
    loops = (chains.taylor_chain, chains.taylor_ends)
    whole = "\n\n".join([kernel.text, text, *(source(loop) for loop in loops)])
    w = np.array([as_float(substitute(tree, osc.parameters)) for tree in trees])
    names = (*kernel.names, "rebound", *(loop.__name__ for loop in loops))
    fly = function(whole, names, "taylor_ends", parts[0].size * impacts * PRICES.taylor)
    work = np.zeros(order + 2), np.zeros((kernel.rows, order + 2)), np.zeros(order + 2), np.empty((impacts, 5))
    limits = horizon_of(osc, None), LIMITS.steps, LIMITS.safety * epsilon
    for begin in range(0, parts[0].size, LIMITS.block):
        tau, v, status = (part[begin : begin + LIMITS.block] for part in parts)
        fly(tau, v, impacts, w, np.zeros(1), order, *limits, doubles(kernel), *work, status)
    return parts


def _fly(osc: Oscillator, table: Table, padded: list[Any], impacts: int) -> None:
    kernel, p = kernel_of(osc), doubles(kernel_of(osc))
    slow, order = table_of(kernel, p), degree_for(EPSILON)
    assert slow is not None
    text, trees = scalar(rho_of(osc.restitution), "v", "rebound")
    constants = f"{lanes.CONSTANTS}\nORDER = {LANES.order}\n"
    whole = "\n\n".join([kernel.text, constants, text, *(source(loop) for loop in LOOPS)])
    w = np.array([as_float(substitute(tree, osc.parameters)) for tree in trees])
    low, phases = remainders(kernel)
    waves = phases.shape[1]
    with np.errstate(all="ignore"):  # what leaves the range of doubles is not a plain crossing
        compiled(whole, (*kernel.names, "rebound", *(loop.__name__ for loop in LOOPS)))["lanes"](
            padded[0], padded[1], impacts, w, p, low, phases, _turn(osc), table.step, table.rows, table.bound,
            table.series, (slow.step, slow.rows, slow.bound), STRIDES.order, order, horizon_of(osc, None),
            LIMITS.safety * EPSILON, np.zeros(len(lanes.ROWS) * lanes.LANES), np.zeros((2 * waves, lanes.LANES)),
            np.zeros((2 * waves, lanes.LANES)), np.zeros((LANES.order + 1, lanes.LANES)),
            np.zeros(max(2 * waves, 1)), np.zeros(order + 2), np.zeros((kernel.rows, order + 2)), np.zeros(order + 2),
            padded[2],
        )  # fmt: skip


def _turn(osc: Oscillator) -> Any:
    """The period in two parts, the first of 33 bits, and its inverse; zeros without a period."""
    if osc.period is None:
        return np.zeros(3)
    exact = as_rational(Balls(256).evaluate(osc.period, {}))
    fraction, exponent = frexp(float(exact))
    high = ldexp(int(ldexp(fraction, 33)), exponent - 33)
    return np.array([high, float(exact - Fraction(high)), 1 / float(exact)])
