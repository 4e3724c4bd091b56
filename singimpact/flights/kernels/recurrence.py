"""The recurrence of f and g as compiled kernels call it: at the address that the numbers p of a model end with.

`codegen.taylor_recurrence` emits five functions.  In compiled kernels `flights.bind` puts those named `called_...`
here in their places; `recurrence_entry` is what stands at the address.
"""

from math import nan
from typing import Any

from singimpact.flights.kernels.layout import block
from singimpact.flights.kernels.linear import coefficients
from singimpact.flights.kernels.state import Columns, Work
from singimpact.flights.kernels.steps import disc
from singimpact.flights.kernels.variational import disc_of_columns, rounding, variations

PARTS = ("coefficients", "disc", "rounding", "variations", "disc_of_columns")
COEFFICIENTS, DISC, ROUNDING, COLUMNS, DISC_OF_COLUMNS = range(5)


def called(job: Any, numbers: Any, p: Any, launch: Any, X: Any, W: Any, A: Any) -> Any:  # noqa: ARG001
    """The recurrence from four numbers; `flights.bind` puts a call at the last of p in its place.

    Parameters
    ----------
    job : which of `PARTS`, and the degree.
    """
    return nan, nan, nan, nan


def called_coefficients(launch: Any, time: Any, z: Any, u: Any, shift: Any, n: Any, p: Any, work: Any) -> None:
    called((COEFFICIENTS, n), (time, z, u, shift), p, launch, work.X, work.W, work.X)


def called_disc(X: Any, W: Any, n: Any, R: Any, p: Any) -> Any:
    found = called((DISC, n), (R, R, R, R), p, X, X, W, X)
    return found[0], found[1]


def called_rounding(X: Any, W: Any, unit: Any, p: Any) -> Any:
    return called((ROUNDING, 0), (unit, unit, unit, unit), p, X, X, W, X)[0]


def called_variations(launch: Any, time: Any, z: Any, u: Any, n: Any, p: Any, work: Any, columns: Any) -> None:
    called((COLUMNS, n), (time, z, u, u), p, launch, work.X, work.W, columns.A)


def called_disc_of_columns(work: Any, columns: Any, n: Any, R: Any, p: Any) -> Any:
    found = called((DISC_OF_COLUMNS, n), (R, R, R, R), p, work.X, work.X, work.W, columns.A)
    return found[0], found[1], found[2]


def recurrence_entry(sizes: Any, numbers: Any, p: Any, launch: Any, X: Any, W: Any, A: Any) -> None:
    """One of `PARTS`.

    Parameters
    ----------
    sizes : which part, the degree, rows and columns of W. numbers : four, which become what is returned.
    p : of the model. launch, X, W, A : see `state.Work`, `state.Columns`; each is as long as a row of W, and B and Z
        lie behind A, see `layout.columns_of`.
    """
    kind, n, room = sizes[0], sizes[1], sizes[3]
    x, w, constants = block(X, 0, (room,)), block(W, 0, (sizes[2], room)), block(p, 0, (room,))
    values = block(numbers, 0, (4,))
    if kind == DISC:
        values[0], values[1] = disc(x, w, n, values[0], constants)
        return
    if kind == ROUNDING:
        values[0] = rounding(x, w, values[0], constants)
        return
    work, start = Work(x, w, x), block(launch, 0, (room,))
    if kind == COEFFICIENTS:
        coefficients(start, values[0], values[1], values[2], values[3], n, constants, work)
        return
    columns = Columns(block(A, 0, (room,)), block(A, room, (room,)), block(A, 2 * room, (room,)))
    if kind == COLUMNS:
        variations(start, values[0], values[1], values[2], n, constants, work, columns)
        return
    values[0], values[1], values[2] = disc_of_columns(work, columns, n, values[0], constants)
