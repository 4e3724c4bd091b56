"""States at two walls: those of the upper wall are flown by the model with x -> -x, and their results turned back."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.algebra.precision import negative
from singimpact.flights.results import Flight
from singimpact.flights.states import as_written
from singimpact.inputs import InputError, need, refuse
from singimpact.oscillator.model import Oscillator
from singimpact.status import Wall, status_array, wall_of


def wall_codes(osc: Oscillator, wall: Any) -> Array:
    """The walls of states as int8, of the shape that they came in; None stands for the lower wall.

    Examples
    --------
    >>> wall_codes(Oscillator("x", "cos(t)", -1, 1, upper=1), ["lower", "u", 1]).tolist()
    [0, 1, 1]
    """
    if wall is None:
        return np.zeros((), np.int8)
    names = np.asarray(wall, dtype=None if isinstance(wall, np.ndarray) else object)
    codes = np.array([wall_of(name) for name in names.ravel().tolist()], np.int8).reshape(names.shape)
    if codes.size and (codes.min() < 0 or (osc.upper is None and codes.any())):
        accepted = (
            "'lower' or 'upper', or an array of them" if osc.upper is not None else "'lower': the model has one wall"
        )
        raise refuse("wall", wall, accepted)
    return codes


def at_walls(
    fly: Callable[..., Any],
    osc: Oscillator,
    wall: Any,
    columns: tuple[Any, ...],
    out: Mapping[str, Array] | None = None,
) -> Any:
    """The result of `fly(model, *columns)` for states at walls, in the coordinates of the model.

    Parameters
    ----------
    fly : gives a record of numbers, or of arrays of the broadcast shape. wall : of the states, see `wall_codes`; with
        arrays of the caller all of one wall.
    """
    codes = wall_codes(osc, wall)
    if not codes.any():
        return fly(osc, *columns)
    if codes.all():
        return turned(fly(osc.mirrored, *columns), out)
    need(out is None, InputError("out= takes the results of states at one wall: give wall='lower' or wall='upper'"))
    names = ("tau", "v") if len(columns) == 2 else tuple(f"column {k}" for k in range(len(columns)))
    try:
        codes, *states = np.broadcast_arrays(codes, *map(as_written, names, columns))
    except ValueError:
        raise InputError(
            f"wall of shape {codes.shape} does not broadcast with the states: give shapes that do"
        ) from None
    chosen = [np.flatnonzero(codes.ravel() == side) for side in Wall]
    parts = [
        fly(model, *(column.ravel()[at] for column in states))
        for model, at in zip((osc, osc.mirrored), chosen, strict=True)
    ]
    return _together([parts[0], turned(parts[1])], chosen, codes.shape)


def each_wall(osc: Oscillator, xdot: Array) -> list[tuple[Oscillator, Array]]:
    """The model whose lower wall is that of states, and their places; x' < 0, or -0.0, of those at an upper wall.

    Examples
    --------
    >>> pair = Oscillator("x", "cos(t)", -1, 1, upper=2)
    >>> [(str(model.clearance), at.tolist()) for model, at in each_wall(pair, np.array([0.5, -0.5, 1.0]))]
    [('-1', [0, 2]), ('-2', [1])]
    """
    if osc.upper is None:
        return [(osc, np.arange(xdot.size))]
    above = np.signbit(xdot)
    return [(osc, np.flatnonzero(~above)), (osc.mirrored, np.flatnonzero(above))]


def shared_out(fly: Callable[..., Any], osc: Oscillator, wall: Any, states: tuple[Any, ...], options: Any) -> Any:
    """`at_walls` of a method of tau and v, which may be given by their names, and of options."""
    columns = (*states, *(options.pop(name) for name in ("tau", "v")[len(states) :]))
    if wall is None:
        return fly(osc, *columns, **options)
    return at_walls(partial(fly, **options), osc, wall, columns, options.get("out"))


def turned(result: Any, out: Mapping[str, Array] | None = None) -> Any:
    """A result of the model with x -> -x in the coordinates of the model; arrays of the caller are turned in place."""
    fields = vars(result)
    if fields.get("wall") is not None:
        fields["wall"] = np.int8(1) - fields["wall"]
    for impact in np.ravel(np.asarray(fields.get("certified"), dtype=object)).tolist():
        if impact is not None:
            vars(impact).update(velocity=impact.velocity.negative, oscillator=impact.oscillator.mirrored, wall=1)
    if "velocity" in fields:
        if out is not None and "velocity" in out:
            np.negative(out["velocity"], out=out["velocity"])
        else:
            fields["velocity"] = negative(fields["velocity"])
    return result


def _together(parts: list[Any], chosen: list[Array], shape: tuple[int, ...]) -> Any:
    """One record of two, whose states lie at the `chosen` places of a shape."""
    size = sum(at.size for at in chosen)

    def joined(values: list[Any]) -> Any:
        first = np.asarray(values[0])
        whole = np.empty((size, *first.shape[1:]), first.dtype)
        for at, value in zip(chosen, values, strict=True):
            whole[at] = value
        return whole.reshape(shape + first.shape[1:])

    names = [name for name, value in vars(parts[0]).items() if isinstance(value, np.ndarray)]
    fields = {name: joined([getattr(record, name) for record in parts]) for name in names}
    fields["status"] = status_array(fields["status"])
    if not isinstance(parts[0], Flight):
        return type(parts[0])(**fields)
    notes = {int(at[k]): note for at, record in zip(chosen, parts, strict=True) for k, note in record.notes.items()}
    return type(parts[0]).made(
        lambda name: {name: joined([getattr(record, name) for record in parts])}, **fields, notes=notes
    )
