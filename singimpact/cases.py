"""Many cases on any executor: results are kept in chunks, shown as they come, resumed after an interruption."""

from __future__ import annotations

import os
import time
import zipfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor, as_completed
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.case_keys import key
from singimpact.inputs import InputError, Unfinished, shown
from singimpact.progress import ProgressLine
from singimpact.store import require_writable, written


@dataclass(frozen=True)
class PoolSettings:
    """How cases are handed out.

    Parameters
    ----------
    each : chunks a worker gets on the average: more even out unequal cases, fewer send less.
    most : cases in a chunk; an interruption loses a chunk a worker, a kill what was not written either (`KEEPING`).
    pools : that are tried in full width; when each has lost a worker, the guilty case is looked for in pools of one.
    deaths : of a worker alone with one case; then the case is guilty. A worker killed from outside dies once.
    """

    each: int = 8
    most: int = 4096
    pools: int = 2
    deaths: int = 2


PORTIONS = PoolSettings()


@dataclass(frozen=True)
class KeepingSettings:
    """When results are written; the file is always written whole, so that writing it after every chunk costs n^2.

    Parameters
    ----------
    grown : results over those in the file; all writes together then cost five times the last one.
    share : of the time since the last write, that the next one may take: slow cases are kept as they come.
    """

    grown: float = 1.25
    share: float = 0.05


KEEPING = KeepingSettings()


def sweep(
    function: Callable[[Any], Any],
    cases: Iterable[Any],
    executor: Executor | None = None,
    output: str | Path | None = None,
) -> np.ndarray[Any, Any]:
    """function(case) for every case, in the order of the cases.

    Parameters
    ----------
    function : of one case; it gives a number or an array of numbers of one shape, and can be pickled for the executor.
    cases : whatever the function takes.
    executor : any `concurrent.futures.Executor`; a process pool when it is not given.
    output : an .npz file that takes results as they come: when they have grown by a quarter, when writing them takes
        less than a twentieth of the time since they were written, and at the end, by an error too. When it holds
        results of the same cases, of a function with the same code and the same values closed over, by the same
        version, only what is missing is computed.

    Returns
    -------
    array : results stacked along the first axis.

    Raises
    ------
    Unfinished : cases end their process. A worker that is killed is no error: what it had not given back is computed
        again in a new pool.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(2) as pool:
    ...     sweep(lambda x: x * x, [1.0, 2.0, 3.0], pool).tolist()
    [1.0, 4.0, 9.0]
    """
    items = list(cases)
    kept = _Kept(output, None if output is None else key(function, items), len(items))
    missing = [index for index in range(len(items)) if index not in kept.results]
    try:
        with ProgressLine() as line:
            _run_all(function, items, missing, executor, kept, line)
    finally:
        kept.write()
    return np.stack([kept.results[index] for index in range(len(items))]) if items else np.empty(0)


def _run_all(
    function: Callable[[Any], Any],
    items: list[Any],
    missing: list[int],
    executor: Executor | None,
    kept: _Kept,
    line: ProgressLine,
) -> None:
    """Every missing case once; pools that lose a worker are replaced, and what is done stays done."""
    if executor is not None and not isinstance(executor, ProcessPoolExecutor):
        _run(function, items, missing, executor, kept, line)
        return
    width = None if executor is None else getattr(executor, "_max_workers", None)
    given = executor
    for _ in range(PORTIONS.pools):
        try:
            with _executor(given, width) as pool:
                _run(function, items, missing, pool, kept, line)
            return
        except BrokenExecutor:
            given, missing = None, [index for index in missing if index not in kept.results]
    guilty = _one_by_one(function, items, missing, kept, line)
    if guilty:
        raise Unfinished(
            f"{len(guilty)} of {len(items)} cases ended their process each time, the first is case {guilty[0]} = "
            f"{shown(items[guilty[0]])}; the other {len(kept.results)} are done"
        )


def _one_by_one(
    function: Callable[[Any], Any], items: list[Any], missing: list[int], kept: _Kept, line: ProgressLine
) -> list[int]:
    """Compute in pools of one worker, halving each portion that ends it, down to the cases that do."""
    guilty, deaths, stack = [], Counter[int](), [missing]
    while stack:
        part = [index for index in stack.pop() if index not in kept.results]
        try:
            with _executor(None, 1) as pool:
                _run(function, items, part, pool, kept, line)
        except BrokenExecutor:
            left = [index for index in part if index not in kept.results]
            half = len(left) // 2
            stack += [left[half:], left[:half]] if half else []
            if not half:
                deaths.update(left)
                again = [index for index in left if deaths[index] < PORTIONS.deaths]
                stack += [again] if again else []
                guilty += [index for index in left if index not in again]
    return guilty


def _run(
    function: Callable[[Any], Any],
    items: list[Any],
    missing: list[int],
    pool: Executor,
    kept: _Kept,
    line: ProgressLine,
) -> None:
    waiting: dict[Future[Any], list[int]] = {}
    for part in _portions(missing, pool):
        waiting[pool.submit(_portion, function, [items[index] for index in part])] = part
    try:
        for done in _completed(waiting):
            kept.add(waiting[done], done.result())
            line.show(len(kept.results), len(items), "cases")
    except BaseException as error:
        # a process pool that breaks ends its futures itself, and stumbles over one that somebody else has cancelled
        if not isinstance(error, BrokenExecutor) and not isinstance(pool, WorkerPool):
            for future in waiting:
                future.cancel()
        raise


def _completed(waiting: dict[Future[Any], list[int]]) -> Iterator[Future[Any]]:
    """As they come; an executor beyond this machine brings futures of its own, which know when they are done."""
    if all(isinstance(future, Future) for future in waiting):
        yield from as_completed(waiting)
    else:
        yield from waiting


def _portion(function: Callable[[Any], Any], items: list[Any]) -> list[Any]:
    return [function(item) for item in items]


def _portions(indices: list[int], pool: Executor) -> Iterator[list[int]]:
    workers = getattr(pool, "_max_workers", None) or os.cpu_count() or 1
    size = max(1, min(PORTIONS.most, len(indices) // (PORTIONS.each * workers)))
    for start in range(0, len(indices), size):
        yield indices[start : start + size]


class WorkerPool(ProcessPoolExecutor):
    """Processes that share no locks with this one and end with it; left by an error, it drops what waits.

    Parameters
    ----------
    workers : how many; as many as there are cores without it.
    """

    def __init__(self, workers: int | None = None) -> None:
        import multiprocessing

        # a forked child shares locks of threads that it does not have
        super().__init__(workers, mp_context=multiprocessing.get_context("spawn"), initializer=_end_with_parent)

    def __exit__(self, kind: Any, *rest: Any) -> bool | None:
        if kind is None:
            return super().__exit__(kind, *rest)
        # the thread that cancels is then the one that finds a worker dead
        self.shutdown(wait=False, cancel_futures=True)
        return None


def _executor(given: Executor | None, width: int | None) -> AbstractContextManager[Executor]:
    """The caller's, which the caller ends, or one of our own."""
    return WorkerPool(width) if given is None else nullcontext(given)


def _end_with_parent() -> None:
    """A worker ends when the process it works for is gone: one that waits for cases would wait for ever."""
    import multiprocessing
    import threading
    from multiprocessing.connection import wait

    parent = multiprocessing.parent_process()
    if parent is not None:
        sentinel = parent.sentinel
        threading.Thread(target=lambda: (wait([sentinel]), os._exit(1)), daemon=True).start()


class _Kept:
    """Results by case, on disk too when there is a file: now and then (`KEEPING`), and when `write` is called."""

    def __init__(self, output: str | Path | None, digest: str | None, count: int) -> None:
        self.path, self.key, self.results = None if output is None else Path(output), digest, dict[int, Any]()
        self.saved, self.when, self.spent = 0, time.monotonic(), 0.0
        if self.path is not None:
            require_writable(self.path)
            self._read(self.path, count)

    def _read(self, path: Path, count: int) -> None:
        if not path.exists():
            return
        try:
            with path.open("rb") as stream:
                same, pairs = self._pairs(np.load(stream))
        except (OSError, ValueError, KeyError, EOFError, TypeError, MemoryError, zipfile.BadZipFile) as error:
            raise InputError(f"output = {shown(str(path))} is not a file of results ({error}): name another") from None
        if not same:
            other = "other cases, another function or version"
            raise InputError(f"output = {shown(str(path))} holds results of {other}: name another file")
        self.results.update((index, value) for index, value in pairs if index < count)
        self.saved = len(self.results)

    def _pairs(self, found: Any) -> tuple[bool, list[tuple[int, Any]]]:
        """Whether the key agrees, and (case, result) for what the file holds."""
        if not hasattr(found, "files"):
            raise ValueError("an array, no archive")
        if str(found["key"]) != self.key:
            return False, []
        index, result = found["index"], found["result"]
        if index.ndim != 1 or index.dtype.kind not in "iu" or result.ndim < 1 or len(result) != len(index):
            raise ValueError(f"an index of shape {index.shape} for results of shape {result.shape}")
        if result.dtype.kind not in "biufc":
            raise ValueError(f"results of type {result.dtype}")
        return True, list(zip(index.tolist(), result, strict=True))

    def add(self, part: list[int], values: list[Any]) -> None:
        self.results.update(zip(part, (np.asarray(value) for value in values), strict=True))
        grown = len(self.results) >= KEEPING.grown * self.saved
        if grown or self.spent <= KEEPING.share * (time.monotonic() - self.when):
            self.write()

    def write(self) -> None:
        """Put all results into the file, if there is one and it lacks some."""
        if self.path is None or len(self.results) == self.saved:
            return
        start, index = time.monotonic(), np.array(sorted(self.results))
        values = np.stack([self.results[i] for i in index.tolist()])
        with written(self.path) as draft, draft.open("wb") as stream:
            np.savez(stream, key=np.array(self.key), index=index, result=values)
        self.saved, self.when = len(self.results), time.monotonic()
        self.spent = self.when - start
