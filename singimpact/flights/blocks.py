"""Large arrays of states, flown block by block: results are written into arrays made once, or into the caller's.

What is computed one state at a time is put together by `gathered`.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields as fields_of
from typing import Any

import numpy as np

from singimpact.algebra.numbers import Array
from singimpact.flights.results import Flight
from singimpact.inputs import InputError, need, require_memory
from singimpact.status import status_array

# Numbers that few flights have
SPARSE = ("depth", "bound")
# Fields that are filled for any arrays of the caller
ALWAYS = ("status", "cause", "wall")


@dataclass(frozen=True)
class BlockSettings:
    """Sizes of the blocks of an array."""

    # states of a block: its scratch is 16 MB, and a linear model flies it in 0.03 s
    states: int = 65_536
    # arrays of at most so many states go in one piece
    whole: int = 131_072


BLOCKS = BlockSettings()
LEAST = 34  # bytes that the results of a state need


def many(tau: Any, v: Any, out: Mapping[str, Array] | None = None, digits: int | None = None) -> bool:
    """Whether states are flown in blocks: arrays of more than `BLOCKS.whole` of them, and all with `out`.

    Examples
    --------
    >>> many(np.zeros((1000, 1)), np.ones(1000)), many(0.0, 1.0)
    (True, False)
    """
    if digits is not None:
        need(out is None, InputError("out= takes doubles: leave it away with digits="))
        return False
    if out is not None:
        return True
    if _size(tau) * _size(v) <= BLOCKS.whole:
        return False
    try:
        return int(np.prod(np.broadcast_shapes(np.shape(tau), np.shape(v)))) > BLOCKS.whole
    except ValueError:
        return False  # refused where the states are read


def in_blocks(fly: Callable[[Any, Any], Any], tau: Any, v: Any, out: Mapping[str, Array] | None = None) -> Any:
    """The result of `fly` on `many` states.

    Parameters
    ----------
    fly : of tau and v, arrays of one dimension or one of them a number; it returns a `Flight` or a record of arrays.
    out : arrays by the names of the fields that are kept, of the shape of the states.

    Examples
    --------
    >>> from singimpact.flights.orbits import Ends
    >>> found = in_blocks(lambda tau, v: Ends(tau + v, v, np.zeros(v.size, np.int8)), 1.0, np.arange(200_000.0))
    >>> found.tau[-1], found.v.shape
    (np.float64(200000.0), (200000,))
    """
    shape = np.broadcast_shapes(np.shape(tau), np.shape(v))
    size = int(np.prod(shape))
    if out is None:
        require_memory("tau and v", shape, LEAST, "give fewer, or out= with arrays on disk (numpy.memmap)")
    columns = [_flat(value, shape) for value in (tau, v)]
    parts = _Parts(shape, out)
    for begin in range(0, max(size, 1), BLOCKS.states):
        chosen = slice(begin, min(begin + BLOCKS.states, size))
        parts.add(fly(*(column(chosen) for column in columns)), chosen)
    return parts.result()


def _size(value: Any) -> int:
    """Elements of an array; 1 for all that is none."""
    return int(value.size) if isinstance(value, np.ndarray) else 1


def _flat(value: Any, shape: tuple[int, ...]) -> Callable[[slice], Any]:
    """A function that gives the blocks of a value; of a number the number."""
    if np.ndim(value) == 0:
        # with `out` a state of two numbers is an array of one
        return (lambda _chosen: value) if shape else (lambda _chosen: np.array([value], dtype=object))
    array = value if isinstance(value, np.ndarray) else np.array(value, dtype=object)  # text among numbers stays text
    if array.shape == shape and array.flags.c_contiguous:
        whole = array.reshape(-1)
        return lambda chosen: np.asarray(whole[chosen])
    return lambda chosen: np.broadcast_to(array, shape).flat[chosen]


class _Parts:
    """Results of blocks, as they come."""

    def __init__(self, shape: tuple[int, ...], out: Mapping[str, Array] | None) -> None:
        self.shape, self.size = shape, int(np.prod(shape))
        self.out = None if out is None else dict(out)
        self.arrays: dict[str, Array] = {}
        self.notes: dict[int, str] = {}
        self.rare: list[tuple[Array, Array]] = []
        self.later: list[Any] = []
        self.kind: Any = None

    def add(self, block: Any, chosen: slice) -> None:
        """The results of one block."""
        if self.kind is None:
            self._begin(block)
        fields = vars(block)
        for name, target in self.arrays.items():
            if target.flags.c_contiguous:
                target.reshape(self.size, *target.shape[len(self.shape) :])[chosen] = fields[name]
            else:
                target.flat[chosen] = fields[name]
        self.notes |= {chosen.start + index: note for index, note in fields.get("notes", {}).items()}
        if SPARSE[0] in fields and self.out is None:
            rows = np.stack([fields[name] for name in SPARSE])
            sparse = np.flatnonzero(~np.isnan(rows).all(axis=0))
            if sparse.size:
                self.rare.append((chosen.start + sparse, rows[:, sparse]))
        if "_later" in fields and self.out is None:
            self.later.append(fields["_later"])

    def _begin(self, block: Any) -> None:
        self.kind = type(block)
        fields = {name: value for name, value in vars(block).items() if isinstance(value, np.ndarray)}
        for name in SPARSE if self.out is None else ():
            fields.pop(name, None)
        if self.out is not None:
            self._check(fields)
            fields = {name: value for name, value in fields.items() if name in self.out or name in ALWAYS}
        for name, value in fields.items():
            target = None if self.out is None else self.out.get(name)
            if target is None:
                target = np.empty(self.shape + value.shape[1:], value.dtype)
            self.arrays[name] = target

    def _check(self, fields: Mapping[str, Array]) -> None:
        assert self.out is not None
        for name, target in self.out.items():
            if name not in fields:
                raise InputError(f"out has the name {name!r}: give arrays for {', '.join(fields)}")
            wanted = self.shape + fields[name].shape[1:], fields[name].dtype
            layout = (getattr(target, "shape", None), getattr(target, "dtype", type(target).__name__))
            if layout != wanted or not target.flags.writeable:
                raise InputError(
                    f"out[{name!r}] has shape {layout[0]} and type {layout[1]}: give a writable array of shape"
                    f" {wanted[0]} and type {wanted[1]}"
                )

    def result(self) -> Any:
        """All blocks as one."""
        if not issubclass(self.kind, Flight):
            return self.kind(**self.arrays)
        later = _Later(self.shape, self.rare, self.later) if self.out is None else _not_kept
        return self.kind.made(later, **self.arrays, notes=self.notes)


@dataclass(frozen=True)
class _Later:
    """Fields of all blocks that are put together when they are read."""

    shape: tuple[int, ...]
    rare: list[tuple[Array, Array]]
    parts: list[Any] = field(default_factory=list)

    def __call__(self, name: str) -> dict[str, Any]:
        if name in SPARSE:
            rows = np.full((2, int(np.prod(self.shape))), np.nan)
            for index, values in self.rare:
                rows[:, index] = values
            return {each: row.reshape(self.shape) for each, row in zip(SPARSE, rows, strict=True)}
        blocks = [part(name) for part in self.parts]
        return {each: np.concatenate([block[each] for block in blocks]).reshape(self.shape) for each in blocks[0]}


def _not_kept(name: str) -> dict[str, Any]:
    """The fields of a result whose arrays the caller gave."""
    raise AttributeError(f"{name} was not kept: name it in out=, or leave out= away")


def gathered(kind: Any, results: list[Any], shape: tuple[int, ...]) -> Any:
    """One result whose fields are arrays of a shape; statuses and causes are int8.

    Fields that are not printed say where one result comes from, and are left out.
    """
    columns = {}
    for name in (entry.name for entry in fields_of(kind) if entry.repr):
        values = [getattr(one, name) for one in results]
        if name in ("status", "cause"):
            columns[name] = np.array(values, dtype=np.int8).reshape(shape)
        else:
            plain = all(isinstance(value, int | float) for value in values)
            columns[name] = np.array(values, dtype=None if plain else object).reshape(shape)
    columns["status"] = status_array(columns["status"])
    return kind(**columns)
