"""Results of a sweep as they come: in memory, in an .npz file, in a Zarr store.

A file takes its name when it is whole.  Until then results are in a `.part` beside it, with a journal of the chunks
that are there (`case_journal`).

Not here: the key of a function and of its cases (`case_keys`), files in general (`store`).
"""

import os
import zipfile
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.case_journal import OTHERS, Journal, Record, require_file, writing
from singimpact.inputs import InputError, shown
from singimpact.store import require_writable, written

Array = np.ndarray[Any, Any]
NUMBERS = "biufc"  # kinds of arrays that are written
DIGEST = 32  # bytes of the digest of a chunk's cases


@dataclass(frozen=True)
class StoreSettings:
    """Sizes of the files of a Zarr store."""

    bytes: int = 1 << 18  # of a file before compression; it is written anew for each chunk of cases in it, in 2 ms
    rows: int = 1 << 15  # results in a file, at most


FILES = StoreSettings()


class InMemory:
    """Results in memory; the class of what is kept nowhere else, and the base of what is.

    Attributes
    ----------
    records : by the first case of each chunk. done : cases with results. dtype, shape : of one result.
    keyed : whether the cases need a key.
    """

    keyed = False

    def __init__(self) -> None:
        self.records: dict[int, Record] = {}
        self.parts: dict[int, Array] = {}
        self.done = 0
        self.shape: tuple[int, ...] | None = None

    def add(self, record: Record, values: Array) -> None:
        """Take the results of a chunk; one that is there already is left as it is."""
        if record.start in self.records:
            return
        if self.shape is None:
            self.shape = values.shape[1:]
        if values.shape[1:] != self.shape:
            raise InputError(
                f"results of case {record.start} have shape {values.shape[1:]}, those of others {self.shape}: give "
                "arrays of one shape for all cases"
            )
        self._take(record, values)
        self.records[record.start] = record
        self.done += record.count

    def _take(self, record: Record, values: Array) -> None:
        self.parts[record.start] = values

    def refuse_others(self) -> InputError:
        """The error for results that belong to something else; never raised of what is in memory alone."""
        return InputError(OTHERS)

    def expect(self, count: int | None) -> None:
        """The number of cases that will come, where it is known."""

    def leave(self) -> None:
        """End before all cases are done: what there is can be taken up again."""

    def finish(self) -> Any:
        """All results, in order of the cases."""
        return self._together()

    def _together(self) -> Array:
        parts = [self.parts[start] for start in sorted(self.parts)]
        return np.concatenate(parts) if parts else np.empty(0)


class NpzFile(InMemory):
    """Results in memory and in a journal, which becomes an .npz file when the sweep ends, by an error too.

    Parameters
    ----------
    path : of the file. key : of the function.
    """

    keyed = True

    def __init__(self, path: Path, key: str) -> None:
        super().__init__()
        self.path, self.key = path, key
        require_file(path)
        require_writable(path)
        if path.exists():
            self._load()
        self.written = self.done
        self.journal = Journal(path.with_name(path.name + ".part"), key, path)
        for record, content in self.journal.read():
            InMemory.add(self, record, self._read(record, content))

    def _read(self, record: Record, content: bytes) -> Array:
        try:
            values: Array = np.lib.format.read_array(BytesIO(content), allow_pickle=False)
            if values.shape[:1] != (record.count,) or values.dtype.kind not in NUMBERS:
                raise ValueError(f"{values.shape} results of {values.dtype} for {record.count} cases")
        except (ValueError, EOFError, OSError, MemoryError, OverflowError) as error:
            self.journal.close()
            raise InputError(f"{shown(str(self.journal.path))} is damaged ({error}): remove it") from None
        return values

    def add(self, record: Record, values: Array) -> None:
        """The results of some cases, put into the store and into the journal."""
        require_numbers(values)
        if record.start not in self.records:
            super().add(record, values)
            stream = BytesIO()
            np.lib.format.write_array(stream, values, allow_pickle=False)
            self.journal.append(record, stream.getvalue())

    def refuse_others(self) -> InputError:
        """Results of other cases."""
        self.journal.close()
        return InputError(f"output = {shown(str(self.path))} {OTHERS}: name another file")

    def leave(self) -> None:
        """Put what there is into the file."""
        try:
            if self.done != self.written:
                self._write()
        finally:
            self.journal.close()
        with writing(self.path):
            self.journal.path.unlink(missing_ok=True)

    def finish(self) -> Array:
        """Put all into the file."""
        self.leave()
        return self._together()

    def _write(self) -> None:
        records = [self.records[start] for start in sorted(self.records)]
        index = [np.arange(record.start, record.start + record.count) for record in records]
        cases = np.array([record.cases for record in records])
        chunks = np.array([(record.start, record.count) for record in records])
        with written(self.path) as draft, draft.open("wb") as stream:
            np.savez(
                stream,
                key=np.array(self.key),
                index=np.concatenate(index),
                result=self._together(),
                chunks=chunks,
                cases=cases,
            )
        self.written = self.done

    def _load(self) -> None:
        try:
            with self.path.open("rb") as stream:
                values = np.load(stream)
                if not hasattr(values, "files"):
                    raise ValueError("an array, no archive")
                if str(values["key"]) != self.key:
                    raise InputError(f"output = {shown(str(self.path))} {OTHERS}: name another file")
                result, chunks, cases = values["result"], values["chunks"], values["cases"]
                if cases.ndim != 1 or cases.dtype.kind != "U":
                    raise ValueError(f"cases of type {cases.dtype}")
                _check(result.shape, result.dtype, chunks, len(cases))
        except InputError:
            raise
        except (OSError, ValueError, KeyError, EOFError, TypeError, MemoryError, zipfile.BadZipFile) as error:
            refusal = f"output = {shown(str(self.path))} is not a file of results ({error}): name another"
            raise InputError(refusal) from None
        ends = np.cumsum(chunks[:, 1])
        for (start, count), end, case in zip(chunks.tolist(), ends.tolist(), cases.tolist(), strict=True):
            InMemory.add(self, Record(start, count, str(case)), result[end - count : end])


def _check(shape: tuple[int, ...], dtype: np.dtype[Any], chunks: Array, cases: int) -> None:
    """Whether results of a shape and type can be those of some chunks of cases, each with a digest.

    Raises
    ------
    ValueError : they cannot.
    """
    if chunks.ndim != 2 or chunks.shape[1:] != (2,) or chunks.dtype.kind not in "iu" or (chunks[:, 1] < 1).any():
        raise ValueError(f"chunks of shape {chunks.shape} and type {chunks.dtype}")
    order = chunks[np.argsort(chunks[:, 0])].astype(float)
    if (chunks[:, 0] < 0).any() or (order[1:, 0] < order[:-1].sum(axis=1)).any():
        raise ValueError("chunks that overlap or begin before the first case")
    if not shape or shape[0] != chunks[:, 1].sum() or cases != len(chunks):
        raise ValueError(f"results of shape {shape} for {chunks[:, 1].sum()} cases")
    if dtype.kind not in NUMBERS:
        raise ValueError(f"results of type {dtype}")


class ZarrStore(InMemory):
    """Results in a Zarr store alone: memory holds one chunk of cases, and a record of those that are done.

    Parameters
    ----------
    path : of the store, a folder. key : of the function.
    """

    keyed = True

    def __init__(self, path: Path, key: str) -> None:
        super().__init__()
        self.zarr = require_zarr(path)
        self.path, self.key, self.part = path, key, path.with_name(path.name + ".part")
        self.whole, self.total = path.exists(), 0
        self.array: Any = None
        self.dtype = np.dtype(float)
        if self.whole:
            self._load()
        self.journal = Journal(self.part / "journal", key, path)
        if not self.whole:
            for record, _ in self.journal.read():
                self._know(record)
            if self.records:
                self._open()
        require_place(path)

    def _know(self, record: Record) -> None:
        self.records[record.start] = record
        self.done += record.count

    def _load(self) -> None:
        try:
            group = self.zarr.open_group(self.path, mode="r")
            key, chunks, cases = group.attrs["key"], group["chunks"][:], group["cases"][:]
            self.shape, self.dtype = group["result"].shape[1:], group["result"].dtype
            if cases.ndim != 2 or cases.shape[1] != DIGEST or cases.dtype != np.uint8:
                raise ValueError(f"cases of shape {cases.shape} and type {cases.dtype}")
            _check(group["result"].shape, self.dtype, chunks, len(cases))
        except Exception as error:
            message = f"output = {shown(str(self.path))} is not a store of results ({error}): name another"
            raise InputError(message) from None
        if key != self.key:
            raise self.refuse_others()
        for (start, count), case in zip(chunks.tolist(), cases, strict=True):
            self._know(Record(start, count, bytes(case).hex()))

    def _open(self) -> None:
        try:
            self.array = self.zarr.open_group(self.part, mode="r+")["result"]
            cases = max((record.start + record.count for record in self.records.values()), default=0)
            if self.array.dtype.kind not in NUMBERS or self.array.shape[0] < cases:
                raise ValueError(f"results of shape {self.array.shape} and type {self.array.dtype}")
        except Exception as error:
            self.journal.close()
            refusal = f"{shown(str(self.part))} is damaged ({error}): remove it, or name another output"
            raise InputError(refusal) from None
        self.shape, self.dtype = self.array.shape[1:], self.array.dtype

    def _reopen(self) -> None:
        """Go on with a store that was whole; its journal is there before it loses its name."""
        inside = self.path / "journal"
        inside.unlink(missing_ok=True)
        journal = Journal(inside, self.key, self.path)
        for start in sorted(self.records):
            journal.append(self.records[start])
        journal.close()
        os.rename(self.path, self.part)
        self.whole = False
        list(self.journal.read())  # to its end, where the next record goes
        self._open()

    def _begin(self, values: Array) -> None:
        """Make the store, or go on with one that was whole and is given more cases."""
        if self.whole:
            self._reopen()
            return
        row = max(1, values.nbytes // max(1, len(values)))
        rows = max(1, min(FILES.rows, FILES.bytes // row))
        group = self.zarr.open_group(self.part, mode="a")
        self.dtype = values.dtype
        self.array = group.create_array(
            "result",
            shape=(max(self.total, len(values)), *values.shape[1:]),
            chunks=(rows, *(max(1, side) for side in values.shape[1:])),
            dtype=values.dtype,
            overwrite=True,
        )

    def _take(self, record: Record, values: Array) -> None:
        require_numbers(values)
        with writing(self.path):
            if self.array is None:
                self._begin(values)
            if not np.can_cast(values.dtype, self.dtype, "safe"):
                raise InputError(
                    f"results of case {record.start} are {values.dtype}, those before {self.dtype}: give one type for "
                    "all cases, as float(...) does"
                )
            end = record.start + record.count
            if end > self.array.shape[0]:
                self.array.resize((max(self.total, end, 2 * self.array.shape[0]), *values.shape[1:]))
            self.array[record.start : end] = values
        self.journal.append(record)

    def refuse_others(self) -> InputError:
        """Results of other cases."""
        if hasattr(self, "journal"):
            self.journal.close()
        return InputError(f"output = {shown(str(self.path))} {OTHERS}: name another")

    def expect(self, count: int | None) -> None:
        """The length of the array, when it is known."""
        self.total = count or 0

    def leave(self) -> None:
        """The store stays a `.part`."""
        self.journal.close()

    def finish(self) -> Any:
        """Give the store its name; the array, which is read when it is indexed."""
        with writing(self.path):
            if not self.whole:
                self._complete()
            self.journal.close()
            (self.path / "journal").unlink(missing_ok=True)
        return self.zarr.open_array(self.path / "result", mode="r")

    def _complete(self) -> None:
        if self.array is None:
            self._begin(np.empty(0))
        group = self.zarr.open_group(self.part, mode="r+")
        self.array.resize((self.done, *(self.shape or ())))
        records = [self.records[start] for start in sorted(self.records)]
        chunks = np.array([(record.start, record.count) for record in records], dtype=np.int64).reshape(-1, 2)
        cases = np.array([list(bytes.fromhex(record.cases)) for record in records], dtype=np.uint8).reshape(-1, DIGEST)
        group.create_array("chunks", data=chunks, overwrite=True)
        group.create_array("cases", data=cases, overwrite=True)
        group.attrs["key"] = self.key
        os.rename(self.part, self.path)
        self.whole = True


def kept(output: str | Path | None, key: str | None) -> InMemory:
    """Where results go.

    Raises
    ------
    InputError : neither .npz nor .zarr, a place where nothing can be written, or one with something else in it.
    """
    if output is None or key is None:
        return InMemory()
    path = Path(output)
    return ZarrStore(path, key) if path.suffix == ".zarr" else NpzFile(path, key)


def require_zarr(path: Path) -> Any:
    """The library that reads and writes stores.

    Raises
    ------
    InputError : it is not installed.
    """
    try:
        import zarr
    except ImportError:
        raise InputError(
            f"output = {shown(str(path))} needs zarr, which is not installed: python -m pip install "
            "'singimpact[cluster]', or name an .npz file"
        ) from None
    return zarr


def require_place(path: Path) -> None:
    """Refuse a folder in which no store can be made."""
    if not os.access(path.parent, os.W_OK | os.X_OK):
        raise InputError(f"output = {shown(str(path))} cannot be written: give a place that can")


def require_numbers(values: Array) -> None:
    """Refuse results that are no numbers: a file of them would run code when it is read."""
    if values.dtype.kind not in NUMBERS:
        raise InputError(
            f"function gives results of type {values.dtype}, and output= takes numbers: give floats, whole numbers or "
            "arrays of them, or leave output= out"
        )
