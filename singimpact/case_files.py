"""Results of a sweep as they come: in memory, in an .npz file, in a Zarr store.

A file takes its name when it is whole.  Until then results are in a `.part` beside it, with a journal of the chunks
that are there: each record is appended with its length and checksum.  One that a killed process has not written whole
is cut off by the next process that reads the journal.

Not here: the key of a function and of its cases (`case_keys`), files in general (`store`).
"""

import os
import zlib
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from singimpact.inputs import InputError, shown
from singimpact.store import lock, require_writable, written

Array = np.ndarray[Any, Any]
NUMBERS = "biufc"  # kinds of arrays that are written
MOST = 1 << 62  # cases of a sweep; an index of numpy holds no more
HEAD = b"singimpact sweep 1 "
OTHERS = "holds results of other cases, another function or version"
DIGEST = 32  # bytes of the digest of a chunk's cases


# Of a file of a Zarr store: bytes before compression, because it is written anew for each chunk of cases, in 2 ms; and
# results at most
FILE_BYTES, FILE_ROWS = 1 << 18, 1 << 15


# ---- the journal of a sweep: which chunks have results, and these results where no other file holds them


@dataclass(frozen=True)
class Record:
    """Consecutive cases whose results are there: the first one, how many, and the key of the cases."""

    start: int
    count: int
    cases: str


class Journal:
    """Records with their content, appended one by one.

    Parameters
    ----------
    path : of the journal. key : of the function. output : as the refusals name it.
    """

    def __init__(self, path: Path, key: str, output: Path) -> None:
        require_file(path)
        self.path, self.head, self.output = path, HEAD + key.encode() + b"\n", output
        self._stream: BinaryIO | None = None

    def read(self) -> Iterator[tuple[Record, bytes]]:
        """The records of the journal; an end that was not written whole is cut off."""
        if not self.path.exists():
            return
        stream = self._opened()
        head, end = stream.readline(), 0
        if head.endswith(b"\n"):
            if not head.startswith(HEAD):
                raise InputError(
                    f"{shown(str(self.path))} is not a journal of a sweep: remove it, or name another output"
                )
            if head != self.head:
                raise self.refuse_others()
            end = stream.tell()
            while (record := _record(stream)) is not None:
                end = stream.tell()
                yield record
        stream.seek(end)
        stream.truncate()

    def refuse_others(self) -> InputError:
        """The error for results that belong to something else."""
        return InputError(f"output = {shown(str(self.output))} {OTHERS}: name another file")

    def append(self, record: Record, content: bytes = b"") -> None:
        """Write a record; it is there when this returns, whatever becomes of this process."""
        stream = self._opened()
        head = f"{record.start} {record.count} {record.cases} {len(content)} ".encode()
        line = head + f"{zlib.crc32(content, zlib.crc32(head)):08x}\n".encode()
        with writing(self.output):
            stream.write((b"" if stream.tell() else self.head) + line + content)
            stream.flush()

    def close(self) -> None:
        """Let another process have it."""
        if self._stream is not None:
            with suppress(OSError):  # of a full disk, which was told when the record was appended
                self._stream.close()
            self._stream = None

    def _opened(self) -> BinaryIO:
        if self._stream is None:
            with writing(self.output):
                self._stream = os.fdopen(
                    os.open(self.path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666), "r+b"
                )
            if not lock(self._stream.fileno()):
                self.close()
                raise InputError(
                    f"output = {shown(str(self.output))} is being written by another process: name another file"
                )
        return self._stream


def _record(stream: BinaryIO) -> tuple[Record, bytes] | None:
    """The next record, or None at the end and at what is not whole."""
    line = stream.readline()
    left = os.fstat(stream.fileno()).st_size - stream.tell()
    try:
        first, many, cases, length, check = line.decode("ascii").split()
        start, count, size, checksum = int(first), int(many), int(length), int(check, 16)
    except ValueError:
        return None
    if min(start, count, size) < 0 or max(start, count) >= MOST or size > left or not line.endswith(b"\n"):
        return None
    content = stream.read(size)
    whole = zlib.crc32(content, zlib.crc32(line[: line.rindex(b" ") + 1])) == checksum
    return (Record(start, count, cases), content) if whole else None


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """A full disk, or a place that was taken away, is refused with the name of the output."""
    try:
        yield
    except OSError as error:
        raise InputError(
            f"output = {shown(str(path))} cannot be written ({error.strerror or error}): give a place that can"
        ) from None


def require_file(path: Path) -> None:
    """Refuse a pipe, a device or a folder in the place of a file; reading a pipe would not end."""
    if path.exists() and not path.is_file():
        raise InputError(f"output: {shown(str(path))} is not a file: remove it, or name another output")


# ---- the results


class InMemory:
    """Results in memory; the class of what is kept nowhere else, and the base of what is.

    Attributes
    ----------
    records : by the first case of each chunk. parts : results of each chunk that is in memory. done : cases with
    results. shape : of one result. keyed : whether the cases need a key, and there is a journal.
    """

    keyed = False
    journal: Journal

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
        self._know(record)

    def _take(self, record: Record, values: Array) -> None:
        self.parts[record.start] = values

    def _know(self, record: Record) -> None:
        self.records[record.start] = record
        self.done += record.count

    def leave(self) -> None:
        """End before all cases are done: what there is can be taken up again."""

    def finish(self) -> Any:
        """All results, in order of the cases."""
        parts = [self.parts[start] for start in sorted(self.parts)]
        return np.concatenate(parts) if parts else np.empty(0)


class _Output(InMemory):
    """Results in a file or a store, and the journal of those that are in no whole one.

    Parameters
    ----------
    path : of the file. key : of the function. journal : its path.
    """

    keyed = True
    kind = "file"

    def __init__(self, path: Path, key: str, journal: Path) -> None:
        super().__init__()
        self.path, self.key, self.journal = path, key, Journal(journal, key, path)
        self.whole = path.exists()
        try:
            self._resume(self._loaded() if self.whole else None)
        except BaseException:
            self.journal.close()
            raise

    @abstractmethod
    def _members(self) -> Mapping[str, Any]:
        """The key, the chunks, the digests of their cases and the results of a whole file."""

    @abstractmethod
    def _resume(self, result: Any) -> None:
        """Take up the results of a whole file, or None, and those of the journal."""

    def _loaded(self) -> Any:
        """The results of a whole file, whose chunks are then known."""
        try:
            members = self._members()
            key, chunks, cases, result = (members[name] for name in ("key", "chunks", "cases", "result"))
            if chunks.shape != (len(cases), 2) or chunks.dtype.kind not in "iu" or (chunks[:, 1] < 1).any():
                raise ValueError(f"chunks of shape {chunks.shape} and type {chunks.dtype}")
            order = chunks[np.argsort(chunks[:, 0])].astype(float)
            if (np.diff(order[:, 0], prepend=0) < np.insert(order[:-1, 1], 0, 0)[: len(order)]).any():
                raise ValueError("chunks that overlap or begin before the first case")
            if cases.shape[1:] != (DIGEST,) or cases.dtype != np.uint8:
                raise ValueError(f"cases of shape {cases.shape} and type {cases.dtype}")
            if result.shape[:1] != (chunks[:, 1].sum(),) or result.dtype.kind not in NUMBERS:
                raise ValueError(f"results of shape {result.shape} and type {result.dtype}")
        except Exception as error:
            refusal = f"output = {shown(str(self.path))} is not a {self.kind} of results ({error}): name another"
            raise InputError(refusal) from None
        if str(key) != self.key:
            raise self.journal.refuse_others()
        for (start, count), case in zip(chunks.tolist(), cases, strict=True):
            self._know(Record(start, count, bytes(case).hex()))
        self.shape = result.shape[1:]
        return result

    def _index(self) -> dict[str, Array]:
        """The chunks and the digests of their cases, as a whole file has them."""
        records = [self.records[start] for start in sorted(self.records)]
        cases = bytes.fromhex("".join(record.cases for record in records))
        return {
            "chunks": np.array([(record.start, record.count) for record in records], dtype=np.int64).reshape(-1, 2),
            "cases": np.frombuffer(cases, np.uint8).reshape(-1, DIGEST),
        }

    def add(self, record: Record, values: Array) -> None:
        """The results of some cases, put into the file or its journal; a file of other things would run code."""
        if values.dtype.kind not in NUMBERS:
            raise InputError(
                f"function gives results of type {values.dtype}, and output= takes numbers: give floats, whole numbers "
                "or arrays of them, or leave output= out"
            )
        super().add(record, values)

    def leave(self) -> None:
        """Let another process have what there is."""
        self.journal.close()


class NpzFile(_Output):
    """Results in memory and in a journal, which becomes an .npz file when the sweep ends, by an error too.

    Parameters
    ----------
    path : of the file. key : of the function.
    """

    def __init__(self, path: Path, key: str) -> None:
        require_file(path)
        require_writable(path)
        super().__init__(path, key, path.with_name(path.name + ".part"))

    def _members(self) -> Mapping[str, Any]:
        with self.path.open("rb") as stream:
            return dict(np.load(stream))

    def _resume(self, result: Any) -> None:
        if result is not None:
            ends = np.cumsum([record.count for record in self.records.values()])
            self.parts = dict(zip(self.records, np.split(result, ends[:-1]), strict=True))
        self.written = self.done
        for record, content in self.journal.read():
            InMemory.add(self, record, self._read(record, content))

    def _read(self, record: Record, content: bytes) -> Array:
        try:
            values: Array = np.lib.format.read_array(BytesIO(content), allow_pickle=False)
            if values.shape[:1] != (record.count,) or values.dtype.kind not in NUMBERS:
                raise ValueError(f"{values.shape} results of {values.dtype} for {record.count} cases")
        except (ValueError, EOFError, OSError, MemoryError, OverflowError) as error:
            raise InputError(f"{shown(str(self.journal.path))} is damaged ({error}): remove it") from None
        return values

    def add(self, record: Record, values: Array) -> None:
        """The results of some cases, put into the journal too."""
        super().add(record, values)
        stream = BytesIO()
        np.lib.format.write_array(stream, values, allow_pickle=False)
        self.journal.append(record, stream.getvalue())

    def leave(self) -> None:
        """Put what there is into the file."""
        try:
            if self.done != self.written:
                index = [np.arange(start, start + self.records[start].count) for start in sorted(self.records)]
                members = {"key": self.key, "index": np.concatenate(index), "result": super().finish(), **self._index()}
                with written(self.path) as draft, draft.open("wb") as stream:
                    np.savez(stream, **members)
                self.written = self.done
        finally:
            self.journal.close()
        with writing(self.path):
            self.journal.path.unlink(missing_ok=True)

    def finish(self) -> Any:
        """Put all into the file; the results, in order of the cases."""
        self.leave()
        return super().finish()


class ZarrStore(_Output):
    """Results in a Zarr store alone: memory holds one chunk of cases, and a record of those that are done.

    Parameters
    ----------
    path : of the store, a folder. key : of the function.
    """

    kind = "store"

    def __init__(self, path: Path, key: str) -> None:
        try:
            import zarr
        except ImportError:
            raise InputError(
                f"output = {shown(str(path))} needs zarr, which is not installed: python -m pip install "
                "'singimpact[cluster]', or name an .npz file"
            ) from None
        if not os.access(path.parent, os.W_OK | os.X_OK):
            raise InputError(f"output = {shown(str(path))} cannot be written: give a place that can")
        self.zarr, self.part = zarr, path.with_name(path.name + ".part")
        self.array: Any = None  # of the results, while they are written
        super().__init__(path, key, self.part / "journal")

    def _members(self) -> Mapping[str, Any]:
        group: Any = self.zarr.open_group(self.path, mode="r")
        chunks, cases = group["chunks"][:], group["cases"][:]
        return {"key": group.attrs["key"], "chunks": chunks, "cases": cases, "result": group["result"]}

    def _resume(self, result: Any) -> None:
        if result is None:
            for record, _ in self.journal.read():
                self._know(record)
            if self.records:
                self._open()

    def _open(self) -> None:
        try:
            self.array = self.zarr.open_group(self.part, mode="r+")["result"]
            cases = max(record.start + record.count for record in self.records.values())
            if self.array.dtype.kind not in NUMBERS or self.array.shape[0] < cases:
                raise ValueError(f"results of shape {self.array.shape} and type {self.array.dtype}")
        except Exception as error:
            refusal = f"{shown(str(self.part))} is damaged ({error}): remove it, or name another output"
            raise InputError(refusal) from None
        self.shape = self.array.shape[1:]

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
        rows = max(1, min(FILE_ROWS, FILE_BYTES // max(1, values[:1].nbytes)))
        self.array = self.zarr.open_group(self.part, mode="a").create_array(
            "result",
            shape=values.shape,
            chunks=(rows, *(max(1, side) for side in values.shape[1:])),
            dtype=values.dtype,
            overwrite=True,
        )

    def _take(self, record: Record, values: Array) -> None:
        with writing(self.path):
            if self.whole:
                self._reopen()
            if self.array is None:
                self._begin(values)
            if not np.can_cast(values.dtype, self.array.dtype, "safe"):
                raise InputError(
                    f"results of case {record.start} are {values.dtype}, those before {self.array.dtype}: give one "
                    "type for all cases, as float(...) does"
                )
            end = record.start + record.count
            if end > self.array.shape[0]:
                self.array.resize((max(end, 2 * self.array.shape[0]), *values.shape[1:]))
            self.array[record.start : end] = values
        self.journal.append(record)

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
        self.array.resize((self.done, *self.array.shape[1:]))
        group = self.zarr.open_group(self.part, mode="r+")
        for name, data in self._index().items():
            group.create_array(name, data=data, overwrite=True)
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
