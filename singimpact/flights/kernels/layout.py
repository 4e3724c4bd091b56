"""Where the numbers of a model and the scratch of its flights lie in two flat arrays of doubles.

Compiled entries get two addresses and build the named tuples over them; Python fills the same arrays through the same
functions.
"""

from math import inf
from typing import Any

from singimpact.flights.kernels.refine import LEVEL
from singimpact.flights.kernels.state import (
    BATCH_ORDER,
    LANE_ROWS,
    LANES,
    Array,
    Batch,
    Columns,
    Flying,
    Linear,
    Mirror,
    Model,
    Rules,
    Table,
    TaylorModel,
    Work,
)

# Entries of `sizes`: the kind of work; states, impacts or times; waves; rows of the tables and of the work of a flight;
# room for Taylor coefficients; constants of a recurrence; impacts of an iteration; constants of rho.
KIND, COUNT, WAVES, ROWS, ROOM, CONSTANTS, IMPACTS, RHO = range(8)
# Where the distance of the walls, the period and the scalars of a model begin; the thirteen rules come first.
GAP, TURN, SCALARS = 11, 13, 18
# Entries of 1/k! in a table.
TERMS = 24


def block(flat: Any, at: int, shape: Any) -> Any:
    """The part of a flat array from `at`, in a shape; `flights.bind` puts pointer arithmetic in its place."""
    size = 1
    for length in shape:
        size *= length
    return flat[at : at + size].reshape(shape)


def beyond(flat: Any, at: int) -> Any:
    """A flat array from `at` on; `flights.bind` puts an address in its place."""
    return flat[at:]


def rules_of(flat: Any) -> Any:
    """The first thirteen numbers of a model."""
    return Rules(flat[0], int(flat[1]), int(flat[2]), int(flat[3]), flat[4], flat[5], flat[6], flat[7], flat[8],
                 flat[9], flat[10], flat[11], flat[12])  # fmt: skip


def numbers_of(flat: Any, scalars: int, at: int, waves: int) -> Any:
    """`state.Linear`: four scalars, and rows of the waves."""
    return Linear(flat[scalars], flat[scalars + 1], flat[scalars + 2], flat[scalars + 3], block(flat, at, (waves, 4)))


def table_of(flat: Any, at: int, step: float, waves: int, rows: int) -> Any:
    """`state.Table` from `at`."""
    turns = at + 8 * rows
    bounds = turns + 8 * rows * waves
    return Table(step, block(flat, at, (rows, 8)), block(flat, turns, (rows, waves, 8)), block(flat, bounds, (3,)),
                 block(flat, bounds + 3, (3,)), block(flat, bounds + 6, (TERMS,)))  # fmt: skip


def table_length(waves: int, rows: int) -> int:
    """Doubles of a table."""
    return 8 * rows * (1 + waves) + 6 + TERMS


def linear_model(flat: Any, sizes: Any) -> Any:
    """`state.Model` over a flat array: rules, turn, scalars, waves, table, flow in double-double, table of batches."""
    waves, rows = sizes[WAVES], sizes[ROWS]
    n, at = 3 + 2 * waves, SCALARS + 10
    numbers, rest = numbers_of(flat, SCALARS, at, waves), numbers_of(flat, SCALARS + 4, at + 4 * waves, waves)
    at += 8 * waves
    table = table_of(flat, at, flat[SCALARS + 8], waves, rows)
    fine = block(flat, at + table_length(waves, rows), (2 * LEVEL, n, n, 2))
    return Model(numbers, rest, table, rules_of(flat), block(flat, TURN, (5,)), fine)


def other_linear_model(flat: Any, sizes: Any, model: Any) -> Any:
    """The model with x -> -x, which lies behind one with two walls; else the model itself."""
    # an offset is chosen, not a model: compiled code would count references to its arrays
    return linear_model(beyond(flat, linear_length(sizes) if model.rules.gap < inf else 0), sizes)


def other_taylor_model(flat: Any, sizes: Any, model: Any) -> Any:
    """`other_linear_model` of a model without a closed form."""
    return taylor_model(beyond(flat, SCALARS + sizes[CONSTANTS] if model.rules.gap < inf else 0), sizes)


def laws_of(w: Any, at: int, sizes: Any, model: Any) -> Any:
    """The constants of rho at both walls, from `at` on."""
    length = sizes[RHO]
    return block(w, at, (length,)), block(w, at + (length if model.rules.gap < inf else 0), (length,))


def batch_model(flat: Any, scratch: Any, sizes: Any, work: Any, launched: float, between: bool) -> Any:
    """`state.Batch` behind the model and the scratch of one flight; between : whether there is another wall."""
    waves = sizes[WAVES]
    table, series, at = tables_of_batch(flat, sizes)
    other = beyond(flat, linear_length(sizes) if between else 0)
    other_table, other_series, _ = tables_of_batch(other, sizes)
    mirror, turn = Mirror(other_table, other_series, other[SCALARS + 2]), block(flat, at, (3,))
    free, shape = flight_length(sizes), (2 * waves, LANES)
    lane, wave = block(scratch, free, (LANE_ROWS * LANES,)), block(scratch, free + LANE_ROWS * LANES, shape)
    free += (LANE_ROWS + 2 * waves) * LANES
    local, X = block(scratch, free, shape), block(scratch, free + 2 * waves * LANES, (BATCH_ORDER + 1, LANES))
    return Batch(table, series, turn, lane, wave, local, X, work, launched, mirror)


def tables_of_batch(flat: Array, sizes: Array) -> tuple[Table, Array, int]:
    """The table and the series of a batch, and where they end."""
    waves, rows = sizes[WAVES], sizes[ROWS]
    n = 3 + 2 * waves
    at = SCALARS + 10 + 8 * waves + table_length(waves, rows) + 4 * LEVEL * n * n
    behind = at + table_length(waves, rows)
    end = behind + (BATCH_ORDER + 1) * n
    return table_of(flat, at, flat[SCALARS + 9], waves, rows), block(flat, behind, (BATCH_ORDER + 1, n)), end


def linear_length(sizes: Any) -> Any:
    """Doubles of a linear model, a whole number."""
    waves, rows = sizes[WAVES], sizes[ROWS]
    n = 3 + 2 * waves
    both = 2 * table_length(waves, rows)
    return SCALARS + 10 + 8 * waves + both + 4 * LEVEL * n * n + (BATCH_ORDER + 1) * n + 3


def taylor_model(flat: Any, sizes: Any) -> Any:
    """`state.TaylorModel` over a flat array: rules, turn, constants."""
    return TaylorModel(block(flat, SCALARS, (sizes[CONSTANTS],)), rules_of(flat), block(flat, TURN, (5,)))


def rows_of_work(sizes: Any) -> int:
    """Rows of W: two a wave at a launch and two at a step, or those of a recurrence."""
    return int(max(4 * sizes[WAVES], sizes[ROWS] if sizes[CONSTANTS] > 0 else 1))


def scratch_of(flat: Any, sizes: Any) -> Any:
    """`state.Flying` over a flat array."""
    room, n, rows = sizes[ROOM], 3 + 2 * sizes[WAVES], rows_of_work(sizes)
    X, q, launch = block(flat, 0, (room,)), block(flat, room, (room,)), block(flat, 2 * room, (room,))
    hit, twice = block(flat, 3 * room, (10,)), block(flat, 3 * room + 10, (4, n, 2))
    W = block(flat, 3 * room + 10 + 8 * n, (rows, room))
    return Flying(Work(X, W, q), launch, hit, twice)


def columns_of(flat: Any, sizes: Any) -> Any:
    """`state.Columns` behind the scratch of one flight."""
    room, at = sizes[ROOM], flight_length(sizes)
    return Columns(block(flat, at, (room,)), block(flat, at + room, (room,)), block(flat, at + 2 * room, (room,)))


def flight_length(sizes: Any) -> int:
    """Doubles of the scratch of one flight."""
    return int(3 * sizes[ROOM] + 10 + 8 * (3 + 2 * sizes[WAVES]) + rows_of_work(sizes) * sizes[ROOM])


def scratch_length(sizes: Any) -> int:
    """Doubles of all scratch: of one flight, and of a batch or of columns."""
    batch = (LANE_ROWS + 4 * int(sizes[WAVES]) + BATCH_ORDER + 1) * LANES
    return flight_length(sizes) + max(batch, 3 * int(sizes[ROOM]))
