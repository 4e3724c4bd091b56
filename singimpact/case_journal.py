"""The journal of a sweep: which chunks of cases have results, and these results where no other file holds them.

Each record is appended with its length and checksum.  One that a killed process has not written whole is cut off by the
next process that reads the journal.
"""

import os
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from singimpact.inputs import InputError, shown
from singimpact.store import lock

MOST = 1 << 62  # cases of a sweep; an index of numpy holds no more
HEAD = b"singimpact sweep 1 "
OTHERS = "holds results of other cases, another function or version"


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
