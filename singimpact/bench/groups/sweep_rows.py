"""`bench sweep`: what a sweep adds to its cases, by the clock on the wall: 10^6 cases that cost nothing.

Beside it stands `map` of the same executor, which keeps nothing, and sends cases one by one to threads.
"""

import math
import os
import tempfile
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import nullcontext
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from singimpact.bench.measuring import Aim, Case, Effort, Method, NotInstalled, Timed, with_peers
from singimpact.cases import sweep

MANY, FEW = 1_000_000, 20_000
AIM = Aim(20.0)  # microseconds a case: 10^6 of them in 20 s
CHUNK = 4096  # of `map`, which takes 1 where nothing is said


def cases(effort: Effort) -> Iterator[Case]:
    """One case: as many square roots."""
    count = FEW if effort.quick else MANY
    yield Case(f"{count} cases that cost nothing, wall", *_methods(count))


def _methods(count: int) -> tuple[list[Method], list[str]]:
    aim = AIM if count == MANY else Aim()  # of a few, the time of starting the processes is left

    def row(name: str, setting: str, run: Callable[[], Any], aim: Aim = Aim()) -> Method:  # noqa: B008
        return Method(name, setting, partial(_timed, run), problems=count, aim=aim)

    def kept(suffix: str) -> Method:
        return row("singimpact, sweep", f"threads, output={suffix}", partial(_kept, count, suffix), aim)

    def store() -> list[Method]:
        try:
            import zarr  # noqa: F401
        except ImportError:
            raise NotInstalled("zarr") from None
        return [kept(".zarr")]

    own = [
        row("singimpact, sweep", "threads", partial(_swept, _threads, count), aim),
        kept(".npz"),
        row("singimpact, sweep", "processes", partial(_swept, nullcontext, count), aim),
    ]
    others = [
        row("ThreadPoolExecutor.map", "", partial(_mapped, _threads, count)),
        row("ProcessPoolExecutor.map", f"chunks of {CHUNK}", partial(_mapped, _processes, count)),
    ]
    return with_peers(own, store, lambda: others)


def _threads() -> Executor:
    return ThreadPoolExecutor(os.cpu_count() or 1)


def _processes() -> Executor:
    return ProcessPoolExecutor(os.cpu_count() or 1, mp_context=get_context("spawn"))


def _swept(executor: Callable[[], Any], count: int, output: Path | None = None) -> Any:
    with executor() as pool:
        return sweep(math.sqrt, (float(n) for n in range(count)), pool, output)


def _kept(count: int, suffix: str) -> Any:
    with tempfile.TemporaryDirectory() as place:
        found = _swept(_threads, count, Path(place) / f"kept{suffix}")
        return found[-1:]


def _mapped(executor: Callable[[], Executor], count: int) -> Any:
    with executor() as pool:
        return list(pool.map(math.sqrt, (float(n) for n in range(count)), chunksize=CHUNK))


def _timed(run: Callable[[], Any]) -> Timed:
    begun = time.perf_counter()
    found = run()
    return Timed(time.perf_counter() - begun, [float(found[-1])])
