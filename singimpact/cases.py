"""`sweep`: a function of many cases on any executor; results are stored in chunks and resumed after an interruption.

Cases are read as they are needed, so they may come from a generator.  Not here: where they are computed
(`case_pools`), where results are written (`case_files`), the key by which a file is recognised (`case_keys`).

This file is not called `sweep`: importing a module of that name would replace the function `singimpact.sweep` by it.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Collection, Iterable, Mapping, Sized
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from contextlib import nullcontext
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.case_files import InMemory, Record, kept
from singimpact.case_keys import cases_key, function_key
from singimpact.case_pools import Place, ThreadPool, named, place_of
from singimpact.inputs import Unfinished, checked_keywords, refuse, shown
from singimpact.progress import ProgressLine
from singimpact.store import tell

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class PoolSettings:
    """Sizes of chunks, and limits on lost workers."""

    seconds: float = 0.2  # s, work in a chunk, which ends with the case begun by then; a killed worker loses one chunk
    served: int = 32  # workers that get a chunk every 0.2 s; with more workers the chunks are longer
    most: int = 8192  # cases in a chunk at most; memory holds a few chunks for each worker
    ahead: int = 2  # chunks sent to a worker: one that it computes and one that waits
    awake: float = 0.1  # s between two updates of the progress line; Ctrl-C is handled at the same time
    losses: int = 2  # lost workers that had a chunk, after which its cases run in a pool of one worker
    deaths: int = 2  # ends of a worker alone with one case, after which the case is the cause
    fatal: int = 16  # cases that end their process, after which the sweep stops
    serial_note: float = 10.0  # s after which a line gives the reason why the cases run one after another here


POOL = PoolSettings()


@checked_keywords
def sweep(
    function: Callable[[Any], Any], cases: Iterable[Any], executor: Any = None, output: str | Path | None = None
) -> Any:
    """function(case) for every case, in the order of the cases.

    Parameters
    ----------
    function : of one case; it returns a number or an array of numbers of one shape.
    cases : arguments of the function; a generator is read as cases are needed.
    executor : any `concurrent.futures.Executor`, or a `dask.distributed.Client`. Without it a pool of processes, as
        many as there are cores. Where new processes cannot import the function (it is defined in a script that makes
        this call outside `if __name__ == "__main__":`, or in an interactive session) cases are computed one after
        another in this process.
    output : a file for the results: NAME.npz (results are in memory too), or NAME.zarr, a Zarr store, with memory for
        a few chunks of cases only (extra `cluster`). Until it is complete, results are in
        NAME.npz.part or NAME.zarr.part. A second run computes the missing cases; a longer list that begins with
        the same cases continues the file.

    Returns
    -------
    array : results stacked along the first axis; of a Zarr store the `zarr.Array`, which is read when it is indexed.

    Raises
    ------
    InputError : a function that cannot be sent to other processes; an output that holds results of other cases, of
        another version, or of a function that differs in its code or in anything that it names (models, containers,
        objects and their classes, functions and numbers of modules that are not installed packages); with `output`, a
        function that names something without a lasting text, such as a lock or an open file.
    Unfinished : some cases end their process. A worker killed from outside is no error: its chunk is computed again in
        a new pool.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(2) as pool:
    ...     sweep(lambda x: x * x, (0.5 * n for n in range(4)), pool).tolist()
    [0.0, 0.25, 1.0, 2.25]
    """
    store = kept(output, None if output is None else function_key(function))
    try:
        count = len(cases) if isinstance(cases, Sized) else None
        with ProgressLine() as line:
            work = _Work(function, _Source(cases, store), store, line, count)
            work.run(executor)
        work.refuse_fatal()
        return store.finish()
    except BaseException:
        store.leave()
        raise


def in_threads(
    function: Callable[[Any], Any], cases: Iterable[Any], computing: Mapping[str, Any], workers: int | None = None
) -> Any:
    """`sweep` with threads where no executor is named, for cases that are long calls into compiled code.

    Parameters
    ----------
    computing : "executor" and "output", as for `sweep`. workers : how many threads; one for each core without it.
    """
    unknown = sorted(set(computing) - {"executor", "output"})
    if unknown:
        raise refuse("option", unknown[0], "executor or output")
    executor = computing.get("executor")
    with ThreadPool(workers) if executor is None else nullcontext(executor) as pool:
        return sweep(function, cases, pool, computing.get("output"))


@dataclass
class _Chunk:
    """Consecutive cases from the one numbered `start`; losses : lost workers that had it."""

    start: int
    items: list[Any]
    losses: int = 0

    def cut(self, count: int) -> tuple[_Chunk, _Chunk]:
        """The first cases and the others."""
        first, rest = self.items[:count], self.items[count:]
        return _Chunk(self.start, first, self.losses), _Chunk(self.start + count, rest, self.losses)


class _Source:
    """The cases in order. Cases with stored results are compared with the stored key and left out."""

    def __init__(self, cases: Iterable[Any], store: InMemory) -> None:
        self.cases, self.store, self.at = iter(cases), store, 0
        self.starts = deque(sorted(store.records))

    def take(self, size: int) -> _Chunk | None:
        """The next cases without results; None when there are no more.

        Raises
        ------
        InputError : results are of other cases.
        """
        while self.starts and self.starts[0] <= self.at:
            record = self.store.records[self.starts.popleft()]
            if record.start == self.at:
                items = self._next(record.count)
                if len(items) != record.count or cases_key(items) != record.cases:
                    raise self.store.journal.refuse_others()
        start = self.at
        items = self._next(min(size, self.starts[0] - start) if self.starts else size)
        if self.starts and not items:  # fewer cases than results
            raise self.store.journal.refuse_others()
        return _Chunk(start, items) if items else None

    def _next(self, count: int) -> list[Any]:
        items = list(islice(self.cases, count))
        self.at += len(items)
        return items


@dataclass
class _Work:
    """A running sweep: waiting chunks, running chunks, and cases that ended their process."""

    function: Callable[[Any], Any]
    source: _Source
    store: InMemory
    line: ProgressLine
    count: int | None
    waiting: deque[_Chunk] = field(default_factory=deque)
    running: dict[Future[Any], _Chunk] = field(default_factory=dict)
    fatal: list[tuple[int, Any]] = field(default_factory=list)
    size: int = 1

    def run(self, executor: Any) -> None:
        """Compute every case once. A pool that loses a worker is replaced; finished results are kept."""
        first = self.source.take(1)
        if first is None:
            return
        self.waiting.append(first)
        pool = place_of(executor, self.function, first.items)
        while True:
            try:
                with pool.opened():
                    self._drain(pool)
                return
            except BrokenExecutor:
                self._put_back(lost=True)
                if not pool.replaceable:
                    raise
            suspects = [chunk for chunk in self.waiting if chunk.losses >= POOL.losses]
            self.waiting = deque(chunk for chunk in self.waiting if chunk.losses < POOL.losses)
            for suspect in suspects:
                self._alone(pool, suspect)
            if len(self.fatal) >= POOL.fatal:
                return
            pool = pool.again()

    def refuse_fatal(self) -> None:
        """Raise `Unfinished`, which names the cases that ended their process."""
        if not self.fatal:
            return
        number, case = min(self.fatal, key=lambda pair: pair[0])
        count = len(self.fatal)
        every = f"{count} of {self.source.at} cases" if count < POOL.fatal else f"{count} cases and perhaps more"
        raise Unfinished(
            f"{every} ended their process each time, the first is case {number} = {shown(case)}; {self.store.done} "
            "others are done"
        )

    def _drain(self, pool: Place) -> None:
        """Send chunks and store results until no case is left."""
        begun, said = time.monotonic(), not pool.reason
        try:
            while self._fill(pool):
                for future in self._ended(self.running):
                    self._take_in(future)
                if not said and time.monotonic() - begun > POOL.serial_note:
                    said = True
                    tell(f"cases are computed one after another in this process: {pool.reason}")
        except BrokenExecutor:
            raise
        except BaseException:
            for future in self.running:
                # an interruption within `wait` leaves futures locked by this thread, and their pool would never end
                while future._condition._is_owned():  # type: ignore[attr-defined]
                    future._condition.release()
                # the management thread of a ProcessPoolExecutor fails on futures that are cancelled from outside
                if not pool.replaceable:
                    future.cancel()
            self._put_back(lost=False)
            raise

    def _fill(self, pool: Place) -> bool:
        """Send chunks to every free worker; False when no case is left."""
        width = pool.width
        seconds = POOL.seconds * max(1.0, width / POOL.served)
        while len(self.running) < POOL.ahead * width:
            if not self.waiting:
                chunk = self.source.take(self.size)
                if chunk is None:
                    break
                self.waiting.append(chunk)
            future = pool.submit(self.function, self.waiting[0].items, seconds)  # raises where the pool is broken
            self.running[future] = self.waiting.popleft()
        return bool(self.running)

    def _ended(self, futures: Collection[Future[Any]]) -> list[Future[Any]]:
        """Futures that have ended, one at least, as they were begun; the wait is interrupted by Ctrl-C."""
        while not wait(futures, POOL.awake, FIRST_COMPLETED).done:
            self._show()
        return [future for future in futures if future.done()]

    def _take_in(self, future: Future[Any]) -> None:
        chunk = self.running[future]
        try:
            values, spent = future.result()
        except (BrokenExecutor, CancelledError):
            raise
        except Exception as error:
            if type(error).__name__ == "KilledWorker":  # the cluster tries a task no more
                raise Unfinished(
                    f"workers of the cluster were lost with case {chunk.start} = {shown(chunk.items[0])} and the "
                    f"{len(chunk.items) - 1} after it, as often as it allows; {self.store.done} others are done"
                ) from None
            error.add_note(f"in case {chunk.start} = {shown(chunk.items[0])} of the sweep of {named(self.function)}")
            raise
        del self.running[future]
        done, rest = chunk.cut(len(values))
        if rest.items:
            self.waiting.appendleft(rest)
            self.size = max(1, len(done.items))
        elif spent < POOL.seconds / 2:
            self.size = min(POOL.most, max(self.size, 2 * len(done.items)))
        self._keep(done, values)

    def _keep(self, done: _Chunk, values: Array) -> None:
        key = cases_key(done.items) if self.store.keyed else ""
        self.store.add(Record(done.start, len(done.items), key), values)
        self._show()

    def _show(self) -> None:
        self.line.show(self.store.done, self.count, "cases")

    def _put_back(self, lost: bool) -> None:
        """Store the finished chunks; the others wait again."""
        for future in sorted(self.running, key=lambda future: self.running[future].start, reverse=True):
            if future.done() and not future.cancelled() and future.exception() is None:
                self._take_in(future)
            else:
                chunk = self.running.pop(future)
                chunk.losses += lost
                self.waiting.appendleft(chunk)

    def _alone(self, pool: Place, suspect: _Chunk) -> None:
        """Run a chunk in pools of one worker, and halve it each time the worker ends, down to single cases."""
        stack = [suspect]
        while stack and len(self.fatal) < POOL.fatal:
            single = pool.again(1)
            try:
                with single.opened():
                    while stack:
                        (future,) = self._ended([single.submit(self.function, stack[-1].items, POOL.seconds)])
                        values, _ = future.result()
                        done, rest = stack.pop().cut(len(values))
                        self._keep(done, values)
                        stack += [rest] if rest.items else []
            except BrokenExecutor:
                chunk = stack.pop()
                half = len(chunk.items) // 2
                if half:
                    stack += reversed(chunk.cut(half))
                    continue
                chunk.losses += 1
                if chunk.losses < POOL.losses + POOL.deaths:
                    stack.append(chunk)
                else:
                    self.fatal.append((chunk.start, chunk.items[0]))
