"""`sweep`: a function of many cases on any executor, kept in chunks as they are done, resumed after an interruption.

Cases are read as they are needed, so that they may come from a generator.  Not here: where they are computed
(`case_pools`), where results are written (`case_files`), the key by which a file is recognised (`case_keys`).

This file is not called `sweep`: importing a module of that name would replace the function `singimpact.sweep` by it.
"""

from __future__ import annotations

import time
from collections import Counter, deque
from collections.abc import Callable, Iterable, Sized
from concurrent.futures import BrokenExecutor, CancelledError, Future, wait
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

import numpy as np

from singimpact.case_files import InMemory, kept
from singimpact.case_journal import Record
from singimpact.case_keys import cases_key, function_key
from singimpact.case_pools import Place, named, place_of
from singimpact.inputs import Unfinished, shown
from singimpact.progress import ProgressLine
from singimpact.store import tell

Array = np.ndarray[Any, Any]


@dataclass(frozen=True)
class PoolSettings:
    """How cases are handed out."""

    seconds: float = 0.2  # of work in a chunk; it ends with the case that is then begun: what a killed worker loses
    served: int = 32  # workers that can be sent chunks that often; with more of them chunks are longer
    most: int = 8192  # cases in a chunk, which memory holds a few of for each worker
    ahead: int = 2  # chunks a worker: one that it computes, and one that waits
    awake: float = 0.1  # seconds between two updates of the progress line; Ctrl-C is handled meanwhile
    losses: int = 2  # of workers with a chunk among their work; its cases are then tried in a pool of one
    deaths: int = (
        2  # of a worker alone with one case; then the case is at fault. A worker killed from outside dies once
    )
    guilty: int = 16  # cases that end their process, after which the rest is not tried
    patience: float = 10.0  # seconds after which a line says why cases are computed one after another in this process


PORTIONS = PoolSettings()


def sweep(
    function: Callable[[Any], Any],
    cases: Iterable[Any],
    executor: Any = None,
    output: str | Path | None = None,
) -> Any:
    """function(case) for every case, in the order of the cases.

    Parameters
    ----------
    function : of one case; it returns a number or an array of numbers of one shape.
    cases : whatever the function takes; a generator is read as cases are needed.
    executor : any `concurrent.futures.Executor`, or a `dask.distributed.Client`. Without it a pool of processes, as
        many as there are cores. Where new processes cannot import the function (it is defined in a script that makes
        this call outside `if __name__ == "__main__":`, or in an interactive session) cases are computed one after
        another in this process.
    output : a file that takes results as they come: NAME.npz (results are in memory too), or NAME.zarr, a Zarr store,
        where memory holds a few chunks of cases only (extra `cluster`). Until it is complete, results are in
        NAME.npz.part or NAME.zarr.part. A second run computes what is missing; longer cases that begin with the same
        ones are continued.

    Returns
    -------
    array : results stacked along the first axis; of a Zarr store the `zarr.Array`, which is read when it is indexed.

    Raises
    ------
    InputError : a function that cannot be sent to other processes; an output that holds results of other cases, of a
        function with other code or other values closed over, or of another version.
    Unfinished : cases end their process. A worker that is killed is no error: the work of its last fraction of a
        second is done again in a new pool.

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
        store.expect(count)
        with ProgressLine() as line:
            work = _Work(function, _Source(cases, store), store, line, count)
            work.run(executor)
        work.refuse_guilty()
    except BaseException:
        store.leave()
        raise
    return store.finish()


@dataclass
class _Chunk:
    """Consecutive cases from the one numbered `start`; losses : of workers that had it among their work."""

    start: int
    items: list[Any]
    losses: int = 0

    def cut(self, count: int) -> tuple[_Chunk, _Chunk]:
        """The first cases and the others."""
        first, rest = self.items[:count], self.items[count:]
        return _Chunk(self.start, first, self.losses), _Chunk(self.start + count, rest, self.losses)


class _Source:
    """Cases in order, as they are asked for; those with kept results are compared with their key and left out."""

    def __init__(self, cases: Iterable[Any], store: InMemory) -> None:
        self.cases, self.store, self.at = iter(cases), store, 0
        self.starts = deque(sorted(store.records))
        self.known = dict(store.records)

    def take(self, size: int) -> _Chunk | None:
        """The next cases without results; None when there are no more.

        Raises
        ------
        InputError : results are of other cases.
        """
        while True:
            while self.starts and self.starts[0] < self.at:
                self.starts.popleft()
            room = self.starts[0] - self.at if self.starts else size
            if room == 0:
                record = self.known[self.starts.popleft()]
                items = self._next(record.count)
                if len(items) != record.count or cases_key(items) != record.cases:
                    raise self.store.refuse_others()
                continue
            start, items = self.at, self._next(min(size, room))
            if items:
                return _Chunk(start, items)
            if self.starts:  # fewer cases than results
                raise self.store.refuse_others()
            return None

    def _next(self, count: int) -> list[Any]:
        items = list(islice(self.cases, count))
        self.at += len(items)
        return items


@dataclass
class _Work:
    """A sweep that runs: what waits, what is being computed, and cases that ended their process."""

    function: Callable[[Any], Any]
    source: _Source
    store: InMemory
    line: ProgressLine
    count: int | None
    waiting: deque[_Chunk] = field(default_factory=deque)
    running: dict[Future[Any], _Chunk] = field(default_factory=dict)
    ended: SimpleQueue[Future[Any]] = field(default_factory=SimpleQueue)
    guilty: list[tuple[int, Any]] = field(default_factory=list)
    size: int = 1

    def run(self, executor: Any) -> None:
        """Every case once; pools that lose a worker are replaced, and what is done stays done."""
        first = self.source.take(1)
        if first is None:
            return
        self.waiting.append(first)
        place = place_of(executor, self.function, first.items)
        while True:
            try:
                with place.opened():
                    self._drain(place)
                return
            except BrokenExecutor:
                self._put_back(lost=True)
                if not place.replaceable:
                    raise
            suspects = [chunk for chunk in self.waiting if chunk.losses >= PORTIONS.losses]
            self.waiting = deque(chunk for chunk in self.waiting if chunk.losses < PORTIONS.losses)
            for suspect in suspects:
                self._alone(place, suspect)
            if len(self.guilty) >= PORTIONS.guilty:
                return
            place = place.again()

    def refuse_guilty(self) -> None:
        """Name the cases that ended their process."""
        if not self.guilty:
            return
        number, case = min(self.guilty, key=lambda pair: pair[0])
        count = len(self.guilty)
        every = f"{count} of {self.source.at} cases" if count < PORTIONS.guilty else f"{count} cases and perhaps more"
        raise Unfinished(
            f"{every} ended their process each time, the first is case {number} = {shown(case)}; {self.store.done} "
            "others are done"
        )

    def _drain(self, place: Place) -> None:
        """Hand out cases and take in results until both are done."""
        begun, told = time.monotonic(), not place.reason
        try:
            while self._fill(place):
                self._take_in(self._next())
                if not told and time.monotonic() - begun > PORTIONS.patience:
                    told = True
                    tell(f"cases are computed one after another in this process: {place.reason}")
        except BrokenExecutor:
            raise
        except BaseException:
            for future in self.running:
                if not place.replaceable:  # a process pool stumbles over futures that somebody else has cancelled
                    future.cancel()
            self._put_back(lost=False)
            raise

    def _fill(self, place: Place) -> bool:
        """Keep every worker busy; False when nothing is left to do."""
        width = place.width
        seconds = PORTIONS.seconds * max(1.0, width / PORTIONS.served)
        while len(self.running) < PORTIONS.ahead * width:
            chunk = self.waiting.popleft() if self.waiting else self.source.take(self.size)
            if chunk is None:
                break
            try:
                future = place.submit(self.function, chunk.items, seconds)
            except BaseException:
                self.waiting.appendleft(chunk)
                raise
            self.running[future] = chunk
            future.add_done_callback(self.ended.put)
        return bool(self.running)

    def _next(self) -> Future[Any]:
        """The next future that has ended, in any order; the wait is interrupted by Ctrl-C."""
        while True:
            try:
                future = self.ended.get(timeout=PORTIONS.awake)
            except Empty:
                self._show()
                continue
            if future in self.running:
                return future

    def _take_in(self, future: Future[Any]) -> None:
        chunk = self.running[future]
        try:
            values, spent = future.result()
        except (BrokenExecutor, CancelledError):
            raise
        except Exception as error:
            if type(error).__name__ == "KilledWorker":  # the cluster has given up
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
        elif spent < PORTIONS.seconds / 2:
            self.size = min(PORTIONS.most, max(self.size, 2 * len(done.items)))
        self._keep(done, values)

    def _keep(self, done: _Chunk, values: Array) -> None:
        key = cases_key(done.items) if self.store.keyed else ""
        self.store.add(Record(done.start, len(done.items), key), values)
        self._show()

    def _show(self) -> None:
        self.line.show(self.store.done, self.count, "cases")

    def _put_back(self, lost: bool) -> None:
        """Keep what has ended well; what has not waits again."""
        for future, chunk in sorted(self.running.items(), key=lambda pair: pair[1].start, reverse=True):
            if future.done() and not future.cancelled() and future.exception() is None:
                values, _ = future.result()
                done, chunk = chunk.cut(len(values))
                self._keep(done, values)
            elif lost:
                chunk.losses += 1
            if chunk.items:
                self.waiting.appendleft(chunk)
        self.running = {}

    def _alone(self, place: Place, suspect: _Chunk) -> None:
        """Compute in pools of one worker, halving what ends it, down to the cases that do."""
        deaths, stack = Counter[int](), [suspect]
        while stack and len(self.guilty) < PORTIONS.guilty:
            single = place.again(1)
            try:
                with single.opened():
                    while stack:
                        values = self._waited(single.submit(self.function, stack[-1].items, PORTIONS.seconds))
                        done, rest = stack.pop().cut(len(values))
                        self._keep(done, values)
                        stack += [rest] if rest.items else []
            except BrokenExecutor:
                chunk = stack.pop()
                half = len(chunk.items) // 2
                if half:
                    stack += reversed(chunk.cut(half))
                    continue
                deaths[chunk.start] += 1
                if deaths[chunk.start] < PORTIONS.deaths:
                    stack.append(chunk)
                else:
                    self.guilty.append((chunk.start, chunk.items[0]))

    def _waited(self, future: Future[Any]) -> Array:
        while not wait([future], PORTIONS.awake).done:
            self._show()
        values: Array = future.result()[0]
        return values
