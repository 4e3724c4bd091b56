"""A lock on a file that the system releases when its holder ends, however it ends."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]
try:
    import msvcrt
except ImportError:
    msvcrt = None  # type: ignore[assignment]

FAR = 1 << 40  # the byte that is locked on Windows, where a locked byte cannot be read
RETRY = 0.01  # s between two attempts to take a lock


def lock(descriptor: int) -> bool:
    """Lock an open file for this process; False where another process or another opening of the file holds the lock.

    Where the file system has no locks the answer is True: the caller goes on without protection.
    """
    try:
        if fcntl is not None:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        elif msvcrt is not None:
            before = os.lseek(descriptor, 0, os.SEEK_CUR)
            os.lseek(descriptor, FAR, os.SEEK_SET)
            try:
                msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined, unused-ignore]
            finally:
                os.lseek(descriptor, before, os.SEEK_SET)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:  # a network file system without locks
        return True
    return True


class FileLock:
    """A file that one process at a time holds, with a line of text about what it does.

    Parameters
    ----------
    path : of the file, which stays when the lock is released.

    Examples
    --------
    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "lock"
    >>> holder = FileLock(path)
    >>> holder.take("compiles"), FileLock(path).holder(), FileLock(path).take("waits")
    (True, 'compiles', False)
    >>> holder.release()
    >>> FileLock(path).holder() is None
    True
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._descriptor: int | None = None

    def take(self, text: str = "", seconds: float = 0.0) -> bool:
        """Take the lock; False when another process holds it for so many seconds.

        Raises
        ------
        OSError : the file cannot be opened or written.
        """
        end = time.monotonic() + seconds
        while True:
            descriptor = self._opened(os.O_RDWR | os.O_CREAT)
            if lock(descriptor):
                break
            os.close(descriptor)
            if time.monotonic() >= end:
                return False
            time.sleep(RETRY)
        self._descriptor = descriptor
        os.ftruncate(descriptor, 0)
        os.write(descriptor, text.encode())
        return True

    def release(self) -> None:
        """Release the lock, if it is held here."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None

    def holder(self) -> str | None:
        """The text that the process that holds the lock wrote about itself; None when no living process holds it."""
        try:
            descriptor = self._opened(os.O_RDWR)
        except OSError:
            return None
        try:
            if lock(descriptor):
                return None
            with suppress(OSError):
                return os.read(descriptor, 4096).decode("utf-8", "replace")
            return ""
        finally:
            os.close(descriptor)

    def _opened(self, flags: int) -> int:
        return os.open(self.path, flags | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0), 0o600)
