"""Entries of the user's cache, each with a digest of its name and content; a damaged entry is named and made again.

A cache is a convenience: when it cannot be read or written, one line says so and the work goes on without it.
"""

import hashlib
import json
import os
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.inputs import InputError, shown
from singimpact.store import DRAFT, cache_folder, changeable, folder, tell, written


@dataclass(frozen=True)
class CacheSettings:
    """When what a killed process left is taken away.

    Parameters
    ----------
    draft : seconds; no entry takes a day to write, so an older draft has no writer any more.
    """

    draft: float = 86_400.0


AGES = CacheSettings()
_SAID: list[str] = []  # why results are not kept, once in a process


def keep(file: Path, content: bytes) -> None:
    """Write an entry, which appears only when complete. A cache that cannot be written gives one warning, no error."""
    try:
        _swept(folder(file.parent))
        reason = _changeable(file)
        if reason is not None:
            raise InputError(f"{shown(str(file.parent))}: {reason}")
        if file.is_symlink():
            file.unlink()  # an entry is a regular file: a link is removed, its target is not written to
        with written(file) as draft:
            draft.write_bytes(_seal(file, content) + content)
    except (InputError, OSError) as error:
        not_kept(error)


def recall(file: Path) -> bytes | None:
    """The content of an entry, or None when there is none; a damaged one is named on standard error.

    Examples
    --------
    >>> import tempfile
    >>> place = Path(tempfile.mkdtemp()) / "entry"
    >>> keep(place, b"42")
    >>> recall(place), recall(place.with_name("other"))
    (b'42', None)
    """
    if _changeable(file) is not None:
        return None
    try:
        with os.fdopen(
            os.open(file, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)), "rb"
        ) as f:
            record = f.read()
    except FileNotFoundError:
        return None
    except OSError as error:
        damaged(file, error.strerror or str(error))
        return None
    content = unsealed(file, record)
    if content is None and not record.startswith(OLD_SEAL):
        damaged(file, "its content is not what was written under this name")
    return content


def unsealed(place: Path, sealed: bytes) -> bytes | None:
    """The content of the bytes of an entry; None if they are not those that were written under its name."""
    length = len(_seal(place, b""))
    content = sealed[length:]
    return content if sealed[:length] == _seal(place, content) else None


def packed(thing: Any) -> bytes:
    """The bytes of a tree of dataclasses, tuples, lists, dicts, numbers, texts and arrays: JSON, then the arrays.

    Examples
    --------
    >>> unpacked(packed({"ages": AGES, "pair": (1, [2.5, None])}), (CacheSettings,))
    {'ages': CacheSettings(draft=86400.0), 'pair': (1, [2.5, None])}
    """
    arrays: list[Any] = []
    stream = BytesIO()
    stream.write(json.dumps(_tree(thing, arrays)).encode() + b"\n")
    for array in arrays:
        np.save(stream, array, allow_pickle=False)
    return stream.getvalue()


def unpacked(content: bytes, kinds: Iterable[type]) -> Any:
    """The value that was packed; `kinds` are the dataclasses that may occur in it.

    Raises
    ------
    ValueError, KeyError, TypeError : it is not what `packed` wrote, or of other kinds.
    """
    stream = BytesIO(content)
    tree = json.loads(stream.readline())
    return _grown(tree, {kind.__name__: kind for kind in kinds}, lambda: np.load(stream, allow_pickle=False))


def _tree(thing: Any, arrays: list[Any]) -> Any:
    """Every object becomes a list that begins with its kind; arrays are gathered in the order in which they are met."""
    if isinstance(thing, np.ndarray):
        arrays.append(thing)
        return ["array", None]
    if is_dataclass(thing):
        return [type(thing).__name__, {item.name: _tree(getattr(thing, item.name), arrays) for item in fields(thing)}]
    if isinstance(thing, Mapping):
        return ["dict", {key: _tree(value, arrays) for key, value in thing.items()}]
    if isinstance(thing, list | tuple):
        return ["list" if isinstance(thing, list) else "tuple", [_tree(item, arrays) for item in thing]]
    return thing.item() if isinstance(thing, np.generic) else thing


def _grown(tree: Any, kinds: Mapping[str, type], array: Callable[[], Any]) -> Any:
    if not isinstance(tree, list):
        return tree
    kind, inside = tree
    if kind == "array":
        return array()
    if isinstance(inside, dict):
        parts = {key: _grown(value, kinds, array) for key, value in inside.items()}
        return parts if kind == "dict" else kinds[kind](**parts)
    parts_in_order = [_grown(entry, kinds, array) for entry in inside]
    return tuple(parts_in_order) if kind == "tuple" else parts_in_order


def _changeable(place: Path) -> str | None:
    """Why others could change an entry: from the cache's own folder inwards, up to one that is closed to them."""
    inner = [each for each in place.parents if each.is_relative_to(cache_folder())] or [place.parent]
    for each in reversed(inner):
        reason = changeable(each)
        if reason is not None:
            return reason
        if each.exists() and not each.stat().st_mode & 0o077:
            return None
    return None


OLD_SEAL = b"sha256 "  # of an earlier version, without the name: not used, and no damage
SOURCES = (".py", ".js", ".css", ".html")


@lru_cache(maxsize=8)
def source_digest(folder: Path, without: tuple[str, ...] = ()) -> str:
    """The digest of the sources of a folder, pages too, those whose path begins with one of `without` left out.

    Examples
    --------
    >>> here = Path(__file__).parent
    >>> source_digest(here, ("cli/",)) == source_digest(here)
    False
    """
    digest = hashlib.sha256()
    for path in sorted(path for path in folder.rglob("*") if path.suffix in SOURCES):
        name = path.relative_to(folder).as_posix()
        if not name.startswith(without):
            digest.update(name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def key_of(parts: Iterable[Any], libraries: tuple[str, ...], without: tuple[str, ...] = ()) -> str:
    """A digest of what was asked, of the versions of libraries, and of the package's source.

    Parameters
    ----------
    parts : all that the entry depends on beside these, by their `repr`. without : folders that it does not depend on.

    Examples
    --------
    >>> key_of(["horizon", 1], ("numpy",)) == key_of(["horizon", 1], ("numpy",)), len(key_of([], ()))
    (True, 64)
    """
    ground = [_versions(libraries), source_digest(Path(__file__).parent, without)]
    return hashlib.sha256(json.dumps([*ground, *map(repr, parts)]).encode()).hexdigest()


@lru_cache(maxsize=8)
def _versions(libraries: tuple[str, ...]) -> str:
    from importlib.metadata import version

    return repr([version(name) for name in libraries])


def damaged(place: Path, reason: str) -> None:
    """Name an entry that cannot be used."""
    tell(f"cache entry {shown(str(place), 300)} is damaged ({reason}): it is made again")


def not_kept(error: Exception) -> None:
    """Print once in a process that results are not stored."""
    if not _SAID:
        _SAID.append(str(error))
        reason = str(error).removeprefix("output = ").partition(": give")[0]
        tell(f"cache: {reason}; results are not stored; the work goes on (SINGIMPACT_CACHE names another folder)")


def _seal(place: Path, content: bytes) -> bytes:
    """The digest of the name and the content, so that no entry passes for another one."""
    digest = hashlib.sha256(place.name.encode("utf-8", "surrogateescape") + b"\0" + content)
    return b"sealed " + digest.hexdigest().encode() + b"\n"


@lru_cache(maxsize=64)
def _swept(place: Path) -> None:
    """Remove temporary files of killed processes, once for each folder and process."""
    for draft in place.glob(f"{DRAFT}*"):
        if draft.stat().st_mtime < time.time() - AGES.draft:
            draft.unlink(missing_ok=True)
