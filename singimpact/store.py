"""Output files and folders, and locks on files. Output files appear only when complete."""

import os
import stat
import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any

from singimpact.inputs import InputError, refuse, shown

DRAFT = ".draft-"


@contextmanager
def written(path: str | Path) -> Iterator[Path]:
    """A temporary path that takes the name `path` when the block ends well, and is removed when it does not.

    Raises
    ------
    InputError : nothing can be written there.

    Examples
    --------
    >>> import tempfile
    >>> place = Path(tempfile.mkdtemp())
    >>> with written(place / "a.txt") as draft:
    ...     _ = draft.write_text("whole")
    >>> [item.name for item in place.iterdir()]
    ['a.txt']
    """
    target, special = _target(path)
    draft = _draft(target, special)
    try:
        # its name is known before it exists: an interruption at any later time removes it
        os.close(os.open(draft, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
        yield draft
        if special:
            target.write_bytes(draft.read_bytes())
        else:
            os.replace(draft, target)
    except OSError as error:
        raise _unwritable(path, error) from None
    finally:
        with suppress(OSError):  # a file system that is read-only refuses this too
            draft.unlink()


def write_text(path: str | Path, text: str) -> None:
    """Write a text to a file, which appears only when complete."""
    with written(path) as draft:
        draft.write_text(text, encoding="utf-8", newline="\n")


def write_table(path: str | Path, columns: Mapping[str, Iterable[Any]], heading: str = "") -> None:
    """Write columns of equal length to a file of comma-separated values, below a line with their names.

    `heading` : lines before it, each with its end.

    Examples
    --------
    >>> import tempfile
    >>> place = Path(tempfile.mkdtemp()) / "a.csv"
    >>> write_table(place, {"tau": [0.5, 1.0], "kind": ["impact", "graze"]})
    >>> print(place.read_text(), end="")
    tau,kind
    0.5,impact
    1.0,graze
    """
    import csv

    if Path(path).suffix.lower() in (".xlsx", ".xls", ".ods", ".parquet", ".json", ".npz"):
        raise refuse("path", str(path), "a name that ends in .csv: comma-separated values are written")
    with written(path) as draft, draft.open("w", encoding="utf-8", newline="") as stream:
        stream.write(heading)
        lines = csv.writer(stream, lineterminator="\n")
        lines.writerow(columns)
        lines.writerows(zip(*columns.values(), strict=True))


def read_bounded(path: str | Path, what: str, most: int = 1_000_000, seconds: float = 10.0) -> bytes:
    """The bytes of a file that a user names; a device without end and a pipe that nobody writes to are refused.

    Raises
    ------
    InputError : it cannot be read, has more than `most` bytes, or gives none for so many seconds.

    Examples
    --------
    >>> read_bounded("/dev/zero", "model file")
    Traceback (most recent call last):
    singimpact.inputs.InputError: model file '/dev/zero' has more than 1000000 bytes: at most 1000000 are accepted
    """
    import select

    content = b""
    try:
        # a pipe that nobody writes to would not even open
        with open(
            os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)), "rb", 0
        ) as file:
            while len(content) <= most:
                block = file.read(most + 1 - len(content))
                if block is None and not select.select([file], [], [], seconds)[0]:
                    raise InputError(f"{what} {shown(str(path))} gives nothing for {seconds:g} s: give a file")
                if block == b"":
                    return content
                content += block or b""
    except OSError as error:
        raise InputError(f"{what} {shown(str(path))} cannot be read: {error.strerror}") from None
    raise InputError(f"{what} {shown(str(path))} has more than {most} bytes: at most {most} are accepted")


def require_writable(path: str | Path) -> None:
    """Check that a file can be written at a path.

    Raises
    ------
    InputError : nothing can be written there.
    """
    with suppress(_Writable), written(path):
        raise _Writable


def folder(path: str | Path) -> Path:
    """A folder to write into, created if it is missing; a cache folder is created with access for its user alone."""
    target = Path(path)
    try:
        if target.is_relative_to(cache_folder()):
            for directory in (*reversed(target.parents), target):
                directory.mkdir(mode=0o700, exist_ok=True)
        target.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from None
    return target


def cache_folder() -> Path:
    """The cache folder: `SINGIMPACT_CACHE`, else the folder of the system for the caches of a user.

    Notes
    -----
    `SINGIMPACT_CACHE=off` gives a folder that lasts as long as the process; so does a folder that others can change,
    for what is kept there is run as code: one line says so.
    """
    from platformdirs import user_cache_path

    named = os.environ.get("SINGIMPACT_CACHE", "")
    if named == "off":
        return passing_folder()
    directory = Path(named).expanduser() if named else user_cache_path("singimpact", appauthor=False)
    reason = changeable(directory)
    if reason is None:
        return directory
    _tell_once(f"cache {shown(str(directory), 300)} is not used: {reason} (SINGIMPACT_CACHE names another folder)")
    return passing_folder()


def changeable(path: Path) -> str | None:
    """The reason why another user could change files in a folder; None for a folder that is safe or does not exist.

    Examples
    --------
    >>> import tempfile
    >>> changeable(Path(tempfile.mkdtemp())) is None
    True
    """
    try:
        state = os.stat(path)
    except OSError:
        return None
    if not hasattr(os, "getuid"):
        return None
    if state.st_uid != os.getuid():
        return "it belongs to another user"
    return "others can write it" if state.st_mode & 0o022 else None


def tell(sentence: str) -> None:
    """One line on standard error."""
    print(f"singimpact: {' '.join(sentence.split())}", file=sys.stderr)


_tell_once = lru_cache(maxsize=64)(tell)


@lru_cache(maxsize=1)
def passing_folder() -> Path:
    """A folder of this process, removed when it ends."""
    import atexit
    import shutil
    import tempfile

    place = tempfile.mkdtemp(prefix="singimpact-")
    atexit.register(shutil.rmtree, place, ignore_errors=True)
    return Path(place)


def _target(path: str | Path) -> tuple[Path, bool]:
    """The path with links resolved, and whether it is a device or a pipe, which must not be replaced by a file."""
    try:
        mode = os.stat(path).st_mode
    except FileNotFoundError:
        return _followed(path), False
    except (OSError, ValueError) as error:
        raise _unwritable(path, error) from None
    if stat.S_ISDIR(mode):
        raise InputError(f"output = {shown(str(path))} is a folder: give the name of a file")
    return (_followed(path), False) if stat.S_ISREG(mode) else (Path(path), True)


def _followed(path: str | Path) -> Path:
    return Path(os.path.realpath(path)) if os.path.islink(path) else Path(path)


def _draft(target: Path, special: bool) -> Path:
    """A name that no file has, in the folder of the target or the one for temporary files."""
    if special:
        import tempfile  # 4 ms, and most processes write no such file

        folder_of_draft = Path(tempfile.gettempdir())
    else:
        folder_of_draft = target.parent
    # the suffix is kept, because matplotlib reads the format from it
    return folder_of_draft / f"{DRAFT}{os.urandom(8).hex()}{target.suffix}"


class _Writable(Exception):
    """Leaves a draft unfinished, once it could be created."""


def _unwritable(path: str | Path, error: Exception) -> InputError:
    reason = getattr(error, "strerror", None) or str(error)
    return InputError(f"output = {shown(str(path))} cannot be written ({reason}): give a place that can")


# A lock on a file that the system releases when its holder ends, however it ends.

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

FAR = 1 << 40  # the byte that is locked on Windows, where a locked byte cannot be read


def lock(descriptor: int) -> bool:
    """Lock an open file for this process; False where another process or another opening of the file holds the lock.

    Where the file system has no locks the answer is True: the caller goes on without protection.
    """
    try:
        if sys.platform == "win32":
            before = os.lseek(descriptor, 0, os.SEEK_CUR)
            os.lseek(descriptor, FAR, os.SEEK_SET)
            try:
                msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
            finally:
                os.lseek(descriptor, before, os.SEEK_SET)
        else:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:  # a network file system without locks
        return True
    return True
