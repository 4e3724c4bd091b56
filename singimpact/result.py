"""Ways out of a result: a line of words; names and values, from which JSON, tables, arrays and frames are made."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any, ClassVar, cast

import numpy as np

from singimpact.inputs import InputError
from singimpact.notebook import box, table as html_table
from singimpact.status import Cause, Status, Wall
from singimpact.store import write_table, written

Array = np.ndarray[Any, Any]

# Fields that say where a result came from, not what it is
NO_NUMBERS = frozenset({"oscillator", "model", "launch"})

# Dimensions of the numbers of a result, in the units of the model's f and g
UNITS = {
    "tau": "time",
    "t": "time",
    "flight_time": "time",
    "end": "time",
    "x": "length",
    "height": "length",
    "v": "length/time",
    "xdot": "length/time",
    "velocity": "length/time",
    "exponents": "1/time",
}


# One line of words and numbers: fields by name, statuses by theirs, without the types of numpy.

# Numbers of an array that are shown; of a longer one its shape
MOST_NUMBERS = 6
Words = type[Status] | type[Cause] | type[Wall]
KINDS: dict[str, Words] = {"status": Status, "cause": Cause, "wall": Wall}


def in_words(record: Any) -> str:
    """The line that a result prints: the `__repr__` of its class.

    Parameters
    ----------
    record : a dataclass or a named tuple. What is empty is left out, and so is the cause of what is decided.

    Examples
    --------
    >>> from collections import namedtuple
    >>> Hit = namedtuple("Hit", "tau v status notes")
    >>> print(in_words(Hit(np.float64(0.5), np.array([1.0, 2.5]), np.int8(0), None)))
    Hit(tau=0.5, v=[1.0, 2.5], status=hit)
    """
    names = getattr(record, "_fields", None)
    if names is None:
        names = [name for name, field in record.__dataclass_fields__.items() if field.repr]
    shown = {name: value_in_words(getattr(record, name), KINDS.get(name)) for name in names}
    if not np.any(getattr(record, "cause", 0)):
        shown.pop("cause", None)
    return f"{type(record).__name__}({', '.join(f'{name}={text}' for name, text in shown.items() if text)})"


def value_in_words(value: Any, kind: Words | None = None) -> str:
    """One value without the type that holds it; "" of nothing.

    Parameters
    ----------
    kind : of a status or a cause, whose numbers are shown as names.

    Examples
    --------
    >>> value_in_words(np.float64(0.1)), value_in_words(np.zeros((2, 40))), value_in_words({})
    ('0.1', 'array of shape (2, 40)', '')
    >>> value_in_words(np.array([0, 0, 3], dtype=np.int8), Status)
    '2 hit, 1 no_return'
    """
    if value is None or (isinstance(value, Mapping | tuple | list) and not value):
        return ""
    if kind is not None:
        if not np.ndim(value):
            return kind(int(value)).name
        pairs = zip(*np.unique(np.asarray(value), return_counts=True), strict=True)
        return ", ".join(f"{count} {kind(int(code)).name}" for code, count in pairs)
    if isinstance(value, np.ndarray) and value.shape:
        return str(value.tolist()) if value.size <= MOST_NUMBERS else f"array of shape {value.shape}"
    if isinstance(value, np.generic | np.ndarray):
        value = value.item()
    return repr(value) if isinstance(value, str) else str(value)


class Result:
    """A mixin: what a call returns, with one way out.

    A class says its names and values in `as_dict`; without its own they are the fields of the dataclass. Arrays of
    more than one axis name them in `array_axes`.
    """

    __slots__ = ()
    array_axes: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    """Names of the axes of arrays; of an array that is not here, `row` alone, or `row`, `axis_1`, ..."""
    heads_csv: ClassVar[bool] = False
    """Whether the field `model` stands in a first line of a file of comma-separated values."""

    def as_dict(self) -> dict[str, Any]:
        """The numbers of the result by name: numbers, words, arrays, dictionaries and lists; statuses are words.

        Examples
        --------
        >>> import singimpact as si
        >>> si.linear(4, 0, "1/2").impact_map(0, 1).as_dict()["status"]
        'hit'
        """
        assert is_dataclass(self)
        names = [item.name for item in fields(self) if item.name not in NO_NUMBERS and not item.name.startswith("_")]
        return {name: value for name in names if (value := plain(getattr(self, name), name)) is not None}

    def arrays(self) -> dict[str, tuple[tuple[str, ...], Array]]:
        """Names of axes and values of what is an array in `as_dict`; where nothing is, its numbers and words."""
        values = self.as_dict()
        arrays = {name: value for name, value in values.items() if isinstance(value, np.ndarray) and value.shape}
        if not arrays:
            # such as the points of a classification
            lists = [
                value
                for value in values.values()
                if isinstance(value, list) and all(isinstance(row, Mapping) for row in value)
            ]
            arrays = columns_of(next(filter(None, lists), [values]))
        return {name: (self.array_axes.get(name, default_axes(value.ndim)), value) for name, value in arrays.items()}

    def table(self) -> dict[str, Array]:
        """Columns of equal length: the arrays along the axes of the largest one, those of fewer axes repeated."""
        arrays = self.arrays()
        along = max((axes for axes, _ in arrays.values()), key=len, default=())
        sizes = {axis: n for axes, value in arrays.values() for axis, n in zip(axes, value.shape, strict=True)}
        shape = tuple(sizes[axis] for axis in along)
        columns = {}
        for name, (axes, value) in arrays.items():
            if set(axes) <= set(along):
                placed = value.reshape([sizes[axis] if axis in axes else 1 for axis in along])
                columns[name] = np.broadcast_to(placed, shape).ravel()
        return columns

    def rows(self) -> list[dict[str, Any]]:
        """The rows of `table()`, each a dictionary."""
        columns = self.table()
        cells = zip(*(values.tolist() for values in columns.values()), strict=True)
        return [dict(zip(columns, row, strict=True)) for row in cells]

    def to_csv(self, path: Any) -> None:
        """Write `table()` as comma-separated values below a line of names. The file appears when it is complete.

        Those of many models, ensembles, fits, cascades of doublings and ends of homoclinic orbits begin with "# " and
        the model as JSON; `ImpactOscillator(**json.loads(line[2:]))` is the model again.
        """
        heading = f"# {json.dumps(vars(self)['model'].to_dict())}\n" if self.heads_csv else ""
        write_table(path, {name: as_storable(values).tolist() for name, values in self.table().items()}, heading)

    def to_npz(self, path: Any) -> None:
        """Write the arrays of the result to a file that `numpy.load` reads. It appears when it is complete."""
        with written(path) as draft, draft.open("wb") as stream:
            arrays: dict[str, Any] = {name: as_storable(value) for name, (_, value) in self.arrays().items()}
            np.savez_compressed(stream, **arrays)

    def to_frame(self) -> Any:
        """`table()` as a DataFrame of pandas.

        Raises
        ------
        InputError : pandas is not installed.
        """
        return optional("pandas").DataFrame(self.table())

    def to_xarray(self) -> Any:
        """The arrays as a Dataset of xarray, with names of axes and units.

        Raises
        ------
        InputError : xarray is not installed.
        """
        arrays = {
            name: (axes, value, {"units": UNITS[name]} if name in UNITS else {})
            for name, (axes, value) in self.arrays().items()
        }
        coordinates = {name: arrays.pop(name) for name, (axes, *_) in list(arrays.items()) if axes == (name,)}
        return optional("xarray").Dataset(arrays, coordinates)

    def _repr_html_(self) -> str:
        columns = self.table()
        rows = [[shown(cell) for cell in row] for row in zip(*columns.values(), strict=True)]
        return box(self, html_table(list(columns), rows, f"{type(self).__name__} of {len(rows)}"))


class Results(Result):
    """A mixin of lists and tuples of results: `as_dict` has theirs under the name of what they are."""

    __slots__ = ()
    called: ClassVar[str] = "items"

    def as_dict(self) -> dict[str, Any]:
        """The dictionaries of all items; whether the list is complete may take a proof, and is left out."""
        return {self.called: [item.as_dict() for item in cast("Iterable[Result]", self)]}


def plain(value: Any, name: str = "") -> Any:
    """A value of a result without types of its own; None where there is nothing to show.

    Examples
    --------
    >>> plain(np.array([0, 3], dtype=np.int8), "status").tolist(), plain(np.float64(0.5)), plain(())
    (['hit', 'no_return'], 0.5, None)
    """
    if name == "status" and value is not None:
        return in_status_words(value, Status)
    if name == "wall" and value is not None:
        return in_status_words(value, Wall)
    if name == "cause":
        return in_status_words(value, Cause) if np.any(value) else None
    if hasattr(value, "as_dict"):
        return value.as_dict()
    if isinstance(value, np.ndarray):
        return value if value.shape else plain(value[()])
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()} or None
    return ([plain(item) for item in value] or None) if isinstance(value, list | tuple) else value


def in_status_words(codes: Any, kind: Words) -> Any:
    """Names of statuses or causes, in the shape of their numbers."""
    if not np.ndim(codes):
        return kind(int(codes)).name
    words = [kind(code).name for code in np.ravel(codes).tolist()]
    return np.array(words, dtype=object).reshape(np.shape(codes))


def one_table(tables: Iterable[Mapping[str, Any]]) -> dict[str, list[Any]]:
    """Tables below one another, with the columns of the first; a number or word instead of a column is repeated.

    Examples
    --------
    >>> one_table([{"branch": 1, "v": np.array([0.5, 1.0])}, {"branch": 2, "v": np.array([2.0])}])
    {'branch': [1, 1, 2], 'v': [0.5, 1.0, 2.0]}
    """
    columns: dict[str, list[Any]] = {}
    for table in tables:
        rows = max(np.size(values) for values in table.values())
        columns = columns or {name: [] for name in table}
        for name, values in columns.items():
            values += [table[name]] * rows if is_cell(table[name]) else as_storable(table[name]).tolist()
    return columns


def numbered(name: str, values: Array) -> dict[str, Array]:
    """The columns of an array of two axes, numbered from 1.

    Examples
    --------
    >>> {name: column.tolist() for name, column in numbered("v", np.array([[0.5, 1.0], [2.0, 3.0]])).items()}
    {'v_1': [0.5, 2.0], 'v_2': [1.0, 3.0]}
    """
    return {f"{name}_{i + 1}": values[:, i] for i in range(values.shape[1])}


def columns_of(rows: Sequence[Mapping[str, Any]]) -> dict[str, Array]:
    """Columns of what is a number or a word in every row.

    Examples
    --------
    >>> columns_of([{"kind": "fold", "tau": 0.5, "orbit": {}}, {"kind": "graze", "tau": 1.5}])["tau"].tolist()
    [0.5, 1.5]
    """
    names = [name for name in rows[0] if all(name in row and is_cell(row[name]) for row in rows)]
    return {name: np.array([row[name] for row in rows]) for name in names}


def is_cell(value: Any) -> bool:
    """Whether a value fits into a cell of a table."""
    return value is None or isinstance(value, bool | int | float | complex | str) or hasattr(value, "_mpf_")


def default_axes(count: int) -> tuple[str, ...]:
    """Names of the axes of an array whose class names none."""
    return ("row", *(f"axis_{at}" for at in range(1, count)))[:count]


def as_storable(values: Array) -> Array:
    """Words as an array of fixed width, which needs no pickle."""
    if values.dtype != object:
        return values
    return np.array([text_of(value) for value in values.ravel().tolist()]).reshape(values.shape)


def shown(cell: Any) -> str:
    """A cell of an HTML table."""
    return f"{cell:.12g}" if isinstance(cell, float) else text_of(cell)


def text_of(value: Any) -> str:
    """A value as text; a number of mpmath with all digits that it has.

    Examples
    --------
    >>> import mpmath
    >>> with mpmath.workdps(30):
    ...     print(text_of(mpmath.mpf(1) / 3))
    0.3333333333333333333333333333333
    """
    if not hasattr(value, "_mpf_"):
        return str(value)
    from mpmath.libmp import to_str

    bits = value._mpf_[3]  # of the mantissa, without zeros at its end
    return str(to_str(value._mpf_, max(15, int(bits * math.log10(2))), strip_zeros=True))


def as_json(data: Any) -> Any:
    """Values of `as_dict` as `json` takes them: nan and inf are null, and the status beside them tells them apart.

    Examples
    --------
    >>> as_json({"v": np.array([0.5, np.nan]), "n": np.int8(2)})
    {'v': [0.5, None], 'n': 2}
    """
    if isinstance(data, Mapping):
        return {str(key): as_json(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [as_json(item) for item in data]
    if isinstance(data, float):
        return float(data) if math.isfinite(data) else None
    if isinstance(data, complex):
        return [as_json(data.real), as_json(data.imag)]
    if data is None or isinstance(data, bool | int | str):
        return data
    return as_json(data.tolist()) if isinstance(data, np.ndarray | np.generic) else text_of(data)


def optional(library: str) -> Any:
    """A library that a result does not need, for the one way out that does.

    Raises
    ------
    InputError : it is not installed.
    """
    try:
        if library == "pandas":
            import pandas

            return pandas
        import xarray
    except ImportError:
        method = {"pandas": "to_frame", "xarray": "to_xarray"}[library]
        raise InputError(f"{method}() needs {library}: python -m pip install {library}") from None
    return xarray
