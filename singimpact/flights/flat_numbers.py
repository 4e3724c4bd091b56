"""The numbers of a model in the flat arrays that kernels read, and the rules of its flights."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from singimpact.algebra.expressions import Number, subtract
from singimpact.algebra.numbers import Array, as_float
from singimpact.codegen.taylor_recurrence import Recurrence
from singimpact.flights.horizons import Allowance
from singimpact.flights.kernels import layout
from singimpact.flights.kernels.hits import UNIT
from singimpact.flights.limits import LIMITS, degree_for
from singimpact.flights.model_numbers import (
    batch_turn_of,
    fastest,
    numbers_of,
    numbers_of_flow,
    phases_of,
    step_with_few_bits,
    turn_of,
)
from singimpact.oscillator.model import Oscillator

EPSILON = UNIT


def gap_of(osc: Oscillator) -> tuple[float, float]:
    """The distance of both walls as a double, and what the double leaves out; inf and 0 of a model with one wall."""
    if osc.upper is None:
        return np.inf, 0.0
    gap = subtract(osc.upper, osc.clearance)
    high = as_float(gap)
    return high, as_float(subtract(gap, Number(Fraction(high))))


@dataclass(frozen=True)
class TableSettings:
    """The layout of the tables of a linear model."""

    # step times the fastest rate: longer steps are fewer, need more terms and leave a larger remainder
    reach: float = 0.6
    # the same for batches: measured best at 1.0, for one flight at a time at 0.6
    batch_reach: float = 1.0
    # degree of a Taylor step: 0.6^17/17! and 1/19! leave less than 1e-17 of the terms at its far end
    order: int = 16
    # rows of a table; after so many steps the closed form begins again
    rows: int = 200
    # the rate where nothing has one: x'' is constant then, and a step of any length is exact
    slowest: float = 2.0**-10
    # bits of the step, so that the time of a row is exact
    bits: int = 24
    # states of one call into compiled code, which hears no interruption: 0.05 s
    block: int = 65_536
    # states that are worth a thread of their own, which costs 0.1 ms, and impacts in batches
    shared: int = 4096
    batched: int = 32_768
    # states at most whose orbits are flown one by one: a batch costs as much as three of them, 1.8 us an impact
    alone: int = 3
    # states of one call when flights are interpreted
    interpreted: int = 64
    # impacts of a chatter that scratch has rows for: at first, and of a state that needs more
    chatter: tuple[int, int] = (4096, 2**20)


TABLES = TableSettings()


def walls_laid_out(
    osc: Oscillator, allowance: Allowance, flows: Sequence[Recurrence | None], laws: Sequence[Array]
) -> tuple[Array, Array, Array]:
    """Sizes and numbers of a model as the kernels read them, see `kernels.layout`, and the constants of its laws.

    Behind a model with two walls lies the one with x -> -x, and so behind its law.

    Parameters
    ----------
    flows : the recurrence of f and g, None of a linear model; and that of the model with x -> -x. laws : constants of
        the restitution, and those of the upper wall.
    """
    laws = _of_one_length(laws)
    sizes, flat = laid_out(osc, allowance, flows[0], laws[0])
    if osc.upper is None:
        return sizes, flat, laws[0]
    others, behind = laid_out(osc.mirrored, allowance, flows[1], laws[1])
    sizes, rho = np.maximum(sizes, others), np.concatenate(laws)
    return sizes, np.concatenate([flat, behind] if flows[0] is None else _of_one_length([flat, behind])), rho


def _of_one_length(arrays: Sequence[Array]) -> list[Array]:
    """Arrays whose last number stays the last: an address is read from there."""
    length = max(array.size for array in arrays)
    return [np.concatenate([array[:-1], np.zeros(length - array.size), array[-1:]]) for array in arrays]


def laid_out(osc: Oscillator, allowance: Allowance, flow: Recurrence | None, rho: Array) -> tuple[Array, Array]:
    """Sizes and numbers of a model as the kernels read them, see `kernels.layout`.

    Parameters
    ----------
    flow : the recurrence of f and g; None of a linear model. rho : constants of the restitution.
    """
    numbers, rest = numbers_of(osc) if flow is None else (numbers_of_flow(osc, flow), np.zeros(0))
    pace = numbers[4] if flow is None else 1.0 if osc.period is None else 2 * np.pi / as_float(osc.period)
    order = degree_for(EPSILON if flow is None else allowance.epsilon)
    short = TABLES.order if flow is None else degree_for(LIMITS.judging)
    coarse = 10 * allowance.epsilon if allowance.epsilon > EPSILON else 0.0
    rules = (allowance.horizon, LIMITS.longest if flow is None else allowance.steps, order, short,
             LIMITS.safety * (EPSILON if flow is None else allowance.epsilon), LIMITS.likely,
             max(LIMITS.rough[0], coarse), max(LIMITS.rough[1], coarse), pace,
             1 - as_float(osc.slope_at_rest()), allowance.reach, *gap_of(osc))  # fmt: skip
    room = max(order, degree_for(LIMITS.judging)) + 2 + LIMITS.derivatives_at_rest
    sizes = np.zeros(8, dtype=np.int64)
    sizes[layout.RHO] = rho.size
    if flow is None:
        waves = len(numbers[5:]) // 3
        sizes[[layout.WAVES, layout.ROWS, layout.ROOM]] = waves, TABLES.rows, max(room, 2 * waves + 2)
        flat = np.zeros(layout.linear_length(sizes))
        scalars = layout.SCALARS
        flat[scalars : scalars + 4], flat[scalars + 4 : scalars + 8] = numbers[1:5], rest[1:5]
        rate = fastest(osc) or TABLES.slowest
        flat[scalars + 8], flat[scalars + 9] = (
            step_with_few_bits(TABLES.reach, rate, TABLES.bits),
            step_with_few_bits(TABLES.batch_reach, rate, TABLES.bits),
        )
        model = layout.linear_model(flat, sizes)
        phases = phases_of(osc)
        for numbers_of_waves, values, phase in ((model.numbers, numbers, phases[0]), (model.rest, rest, phases[1])):
            rates, cosines, sines = values[5:].reshape(-1, 3).T
            numbers_of_waves.waves[:] = np.stack([rates, phase, cosines, sines], axis=1)
        flat[-3:] = batch_turn_of(osc)
    else:
        constants = numbers.size + 1  # last, the address of the compiled recurrence
        sizes[[layout.ROWS, layout.ROOM, layout.CONSTANTS]] = flow.rows, room, constants
        flat = np.ones(layout.SCALARS + constants)
        flat[layout.SCALARS : -1] = numbers
    flat[: len(rules)] = rules
    flat[layout.TURN : layout.TURN + 5] = turn_of(osc)
    return sizes, flat
