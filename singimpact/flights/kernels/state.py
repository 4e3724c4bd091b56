"""The named tuples that kernels take, and the columns of their tables.

In compiled code the fields are doubles and arrays; on numbers of mpmath and balls the arrays are lists.
"""

from typing import Any, NamedTuple

import numpy as np

Array = np.ndarray[Any, Any]

# Columns of `Table.rows`: x - c and x' by their values at the start and by the constant force; sizes for rounding.
X_BY_X, X_BY_V, X_STEADY, V_BY_X, V_BY_V, V_STEADY, SIZE_X, SIZE_STEADY = range(8)

# Columns of `Table.waves`: x - c, x' and x'' (without the terms of x and x') by cosine and sine of a wave at the
# launch; cosine and sine of the angle that the wave turns.
X_COS, X_SIN, V_COS, V_SIN, A_COS, A_SIN, TURN_COS, TURN_SIN = range(8)


# Columns of `Linear.waves`.
RATE, PHASE, COSINE, SINE = range(4)


class Linear(NamedTuple):
    """x'' + damping x' + stiffness x = steady + sum_j COSINE cos(RATE t + PHASE) + SINE sin(RATE t + PHASE), x from c.

    fastest : the largest rate of waves and free motion. waves : (waves, 4), columns RATE and following. A second such
    tuple holds the parts of these numbers below their doubles.
    """

    damping: Any
    stiffness: Any
    steady: Any
    fastest: Any
    waves: Any


class Table(NamedTuple):
    """The closed form of a linear model at the times m step.

    rows : (times, 8), columns X_BY_X and following. waves : (times, waves, 8), columns X_COS and following.
    fourth, sixth : |x''''| <= fourth[0] |x - c| + fourth[1] |x'| + fourth[2] over one step, and so for the sixth
    derivative. taylor : 1/k!.
    """

    step: Any
    rows: Any
    waves: Any
    fourth: Any
    sixth: Any
    taylor: Any


class Rules(NamedTuple):
    """When a flight is given up, and the degree and rounding of its steps.

    horizon, reach : a flight is given up after this time, or after `reach` times its launch velocity if that is later.
    budget : Taylor steps. order : degree of a Taylor step. short : degree of the shorter steps through
    a table, and of the steps of `variational.judge`. ulp : rounding error allowed for, relative to the size of the
    terms. likely : the same, as it usually is, in roundings. rough_time, rough_velocity : relative errors of a hit
    below these are never refined. pace : the rate at which the model moves. lost : 1 - r, r of a slow impact.
    gap, gap_low : x - c at the other wall, and what the double leaves out; inf and 0 without one.
    """

    horizon: Any
    budget: Any
    order: Any
    short: Any
    ulp: Any
    likely: Any
    rough_time: Any
    rough_velocity: Any
    pace: Any
    lost: Any
    reach: Any
    gap: Any
    gap_low: Any


class Work(NamedTuple):
    """Scratch of one flight: Taylor coefficients of x - c; of every wave or row of a recurrence; a polynomial."""

    X: Any
    W: Any
    q: Any


class Columns(NamedTuple):
    """Taylor coefficients of solutions of the variational equation: from (1, 0), from (0, 1), and driven by g'."""

    A: Any
    B: Any
    Z: Any


class Model(NamedTuple):
    """A linear model as its flights need it.

    rest : the parts of `numbers` below their doubles. turn : the period, then its parts of 26 bits; zeros without one.
    fine : the flow over steps of the table in double-double, see `refine`; empty where hits are refined in balls.
    """

    numbers: Linear
    rest: Linear
    table: Table
    rules: Rules
    turn: Any
    fine: Any


class TaylorModel(NamedTuple):
    """A model without a closed form. numbers : the constants of its recurrence. turn : as in `Model`."""

    numbers: Any
    rules: Rules
    turn: Any


class Interval(NamedTuple):
    """One step of a table: x - c, x' and x'' at both ends, and how well x - c is known there.

    time : of its start, since the launch. m : its row. room : x - c above this is certainly positive on the step.
    """

    time: Any
    m: Any
    z: Any
    u: Any
    e: Any
    z1: Any
    u1: Any
    e1: Any
    noise: Any
    noise1: Any
    room: Any


# Columns of a hit. Where a flight ends in no hit, CONDITION and VELOCITY_CONDITION are depth and bound.
FLIGHT_TIME, VELOCITY, CONDITION, VELOCITY_CONDITION, TIME_ERROR, VELOCITY_ERROR = range(6)
TIME_BY_TAU, TIME_BY_V, VELOCITY_BY_TAU, VELOCITY_BY_V = range(6, 10)

# Added to the code of a flight that ends at the other wall; its velocity, and the derivatives of it, are those of the
# model with x -> -x, whose lower wall that is.
ACROSS = 70

# States of a batch, and rows of the array that holds them: row ROW of state k is lane[ROW + k].
LANES, LANE_ROWS = 64, 21
# v, the launch time in two parts, a_c and the size of its terms there; of an orbit the time since the start, what its
# sum has lost, whole periods less.
V, AT, LATE, ACC, SIZE, SINCE, LOST, TURNS = range(0, 8 * LANES, LANES)
# x - c at the launch of a flight that is no part of an orbit.
HEIGHT = SINCE
# What becomes of the flight (0 flies, 1 a plain crossing, 2 left to `tabulated_flight`, 3 over, 4 a plain crossing of
# the other wall, 5 stopped by an impact); its step; time and velocity of the hit.
MODE, PLACE, TIME, SPEED = range(8 * LANES, 12 * LANES, LANES)
# x - c, x' and x'' at both ends of the step, and the bound that x - c must exceed.
Z0, U0, E0, Z1, U1, E1, BOUND = range(12 * LANES, 19 * LANES, LANES)
# 1, or -1 of a hit of the other wall, whose numbers are those of the model with x -> -x.
SIDE = 19 * LANES
# Where the flight starts: 1 at the wall of the model, -1 at the other one, as a flight of the model with x -> -x.
WALL = 20 * LANES
# At the hit, where the step is done with: the derivatives of x and x' by v and by tau; x''; growth of the free motion.
FREE, SLOPE, BY_TAU, BY_TAU_DOT, THERE, GROWTH = range(12 * LANES, 18 * LANES, LANES)
# Degree of a Taylor step of a batch: a step is one radian of the fastest motion.
BATCH_ORDER = 18


class Flying(NamedTuple):
    """Scratch of an orbit: of one flight; the launch; the last hit; four states in double-double."""

    flight: Work
    launch: Any
    hit: Any
    twice: Any


class Search(NamedTuple):
    """The arguments of a search over orbits: its settings, see `gamma` and `chatter`, and the constants of rho."""

    settings: Any
    rho: Any


class Mirror(NamedTuple):
    """A linear model with x -> -x: only the constant force differs, and the sign of all waves.

    table, series : as of `Batch`. steady : the constant force.
    """

    table: Table
    series: Any
    steady: Any


class Batch(NamedTuple):
    """A linear model as `batch` flies it, and scratch of a batch.

    table : longer steps than those of one flight. series : how a Taylor coefficient at the start of a step follows from
    x - c, x', 1 and cosine and sine of the waves there. turn : the period in two parts, the first of 33 bits, and its
    inverse. lane : see `LANES`. wave, local : cosines of all waves, then their sines, at the launches and at the steps
    of the hits; were they side by side, rows that a loop writes would seem to overlap, and it would stay scalar. X :
    Taylor coefficients; then the columns of the hits. work : scratch of one flight. launched : the step on which t = 0
    is a root, 0; -1 where all start off the wall. mirror : what flights from the other wall have for `table` and
    `series`; without one it is the same.
    """

    table: Table
    series: Any
    turn: Any
    lane: Any
    wave: Any
    local: Any
    X: Any
    work: Flying
    launched: Any
    mirror: Mirror
