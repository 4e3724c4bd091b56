"""Results on disk: a file appears under its name when it is whole, or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from singimpact.inputs import InputError, shown


@contextmanager
def written(path: str | Path) -> Iterator[Path]:
    """A temporary path beside `path` that takes its name when the block ends well, and is removed when it does not.

    Raises
    ------
    InputError : nothing can be written there.

    Examples
    --------
    >>> folder = Path(tempfile.mkdtemp())
    >>> with written(folder / "a.txt") as draft:
    ...     _ = draft.write_text("whole")
    >>> [item.name for item in folder.iterdir()]
    ['a.txt']
    """
    target = Path(path)
    draft = _draft(target)
    try:
        yield draft
        os.replace(draft, target)
    except OSError as error:
        raise _unwritable(target, error) from None
    finally:
        draft.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Put a text under a name, whole or not at all."""
    with written(path) as draft:
        draft.write_text(text, encoding="utf-8", newline="\n")


def require_writable(path: str | Path) -> None:
    """Refuse a place where no file can be put.

    Raises
    ------
    InputError : nothing can be written there.
    """
    _draft(Path(path)).unlink()


def folder(path: str | Path) -> Path:
    """A folder to write into, made when it is not there."""
    try:
        Path(path).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _unwritable(Path(path), error) from None
    return Path(path)


def _draft(target: Path) -> Path:
    # the ending stays, because writers of pictures read the format from it
    try:
        if target.is_dir():
            raise InputError(f"output = {shown(str(target))} is a folder: give the name of a file")
        handle, name = tempfile.mkstemp(prefix=".draft-", suffix=target.suffix, dir=target.parent)
    except (OSError, ValueError) as error:
        raise _unwritable(target, error) from None
    os.close(handle)
    os.chmod(name, 0o666 & ~_umask())
    return Path(name)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _unwritable(target: Path, error: Exception) -> InputError:
    reason = getattr(error, "strerror", None) or str(error)
    return InputError(f"output = {shown(str(target))} cannot be written ({reason}): give a place that can")
