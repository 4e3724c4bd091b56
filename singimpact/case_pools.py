"""Where cases are computed: a pool of processes, threads, a cluster, or this process, with one interface.

Not here: the choice of the cases and the use of their results (`cases`).
"""

from __future__ import annotations

import ast
import os
import pickle
import signal
import sys
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from multiprocessing import context, get_context, parent_process, spawn
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from singimpact.inputs import InputError, refuse, shown

Array = np.ndarray[Any, Any]
Function = Callable[[Any], Any]
THREADS = "executor=concurrent.futures.ThreadPoolExecutor()"


@dataclass(frozen=True)
class PlaceSettings:
    """Sizes and times of workers."""

    bytes: int = 1 << 24  # of results, at which a worker returns them before its chunk is complete
    interval: float = 1.0  # s between two requests for the size of a cluster; workers come and go while a sweep runs
    patience: float = 5.0  # s that the end of a pool waits for its terminated workers


PLACE = PlaceSettings()
_OURS: list[bool] = []  # holds an entry in a worker of `WorkerPool`


def computed(function: Function, items: Sequence[Any], seconds: float) -> tuple[Array, float]:
    """Results of the first items, and the seconds spent: as many as begin within the time and size of a chunk.

    At least one.  Where a case raises, the results of those before it are returned; the first case alone raises.
    """
    start = time.monotonic()
    values: list[Any] = []
    size = 0
    for item in items:
        try:
            values.append(function(item))
        except Exception:
            if not values:
                raise
            break
        size += getattr(values[-1], "nbytes", 0)
        if time.monotonic() - start > seconds or size > PLACE.bytes:
            break
    try:
        return np.asarray(values), time.monotonic() - start
    except ValueError:
        shapes = " and ".join(map(str, sorted({np.shape(value) for value in values})[:2]))
        raise InputError(
            f"{named(function)} gives results of shapes {shapes}: give arrays of one shape for all cases"
        ) from None


def unpacked(payload: bytes, seconds: float) -> tuple[Array, float]:
    """`computed` in another process. A payload that cannot be loaded raises an error and does not end the worker."""
    try:
        function, items = pickle.loads(payload)
    except Exception as error:
        raise InputError(
            f"function or cases cannot be loaded in another process ({error}): define them in a module that it can "
            f"import, or give {THREADS}"
        ) from None
    return computed(function, items, seconds)


def named(function: Any) -> str:
    """A function as a refusal names it."""
    inner = getattr(function, "func", function)
    return f"function = {shown(getattr(inner, '__qualname__', None) or str(inner))}"


@dataclass
class Place:
    """Threads, or any other executor that takes functions as they are."""

    executor: Executor
    own: bool = False  # made here, and ended after the sweep; a pool of the caller stays open
    reason: str = ""  # for computing in this process
    replaceable: ClassVar[bool] = False  # by a new pool, when a worker has died

    @property
    def width(self) -> int:
        """Cases that are computed at the same time."""
        known = [getattr(self.executor, name, None) for name in ("_max_workers", "num_workers")]
        return next((count for count in known if isinstance(count, int) and count > 0), os.cpu_count() or 1)

    def submit(self, function: Function, items: Sequence[Any], seconds: float) -> Future[Any]:
        """Begin to compute some cases."""
        return self.executor.submit(computed, function, items, seconds)

    def opened(self) -> AbstractContextManager[Any]:
        """A context that ends a pool made here."""
        return self.executor if self.own else nullcontext()

    def again(self, width: int | None = None) -> Place:
        """A new pool in place of one that has lost a worker."""
        del width
        return self


class Here(Executor):
    """The calling process, one task after another; an interruption is raised at once."""

    _max_workers = 1

    def submit(self, function: Callable[..., Any], /, *args: Any, **keywords: Any) -> Future[Any]:
        """Compute, and return the finished future."""
        done: Future[Any] = Future()
        try:
            done.set_result(function(*args, **keywords))
        except Exception as error:
            done.set_exception(error)
        return done


class Cluster(Place):
    """A `dask.distributed.Client`, or the executor that it gives."""

    def __init__(self, executor: Any) -> None:
        super().__init__(executor.get_executor() if hasattr(executor, "get_executor") else executor)
        self._known, self._when = 1, -PLACE.interval

    @property
    def width(self) -> int:
        """Threads of all workers of the cluster, as many as there are now."""
        if time.monotonic() - self._when >= PLACE.interval:
            threads: dict[str, int] = self.executor._client.nthreads()  # type: ignore[attr-defined]
            self._known, self._when = max(1, sum(threads.values())), time.monotonic()
        return self._known

    def submit(self, function: Function, items: Sequence[Any], seconds: float) -> Future[Any]:
        """Begin to compute some cases. They are sent as bytes, because Dask takes a tuple among them for a task."""
        import cloudpickle

        return self.executor.submit(unpacked, _packed(function, items, cloudpickle.dumps), seconds)


class Processes(Place):
    """A process pool. Work is pickled before it is submitted, so that a pickling error gives one clear message."""

    replaceable = True

    def submit(self, function: Function, items: Sequence[Any], seconds: float) -> Future[Any]:
        """Begin to compute some cases; cases of a script that the workers have not imported are computed here."""
        payload = _packed(function, items, pickle.dumps)
        if b"__main__" in payload and not getattr(self.executor, "script", True):
            return Here().submit(computed, function, items, seconds)
        return self.executor.submit(unpacked, payload, seconds)

    def again(self, width: int | None = None) -> Place:
        """A new pool that starts its processes as this one does."""
        given, count = self.executor, width or self.width
        if isinstance(given, WorkerPool):
            return Processes(WorkerPool(count, given.script), own=True)
        return Processes(ProcessPoolExecutor(count, getattr(given, "_mp_context", None)), own=True)


def place_of(executor: Any, function: Function, items: Sequence[Any]) -> Place:
    """Where cases are computed.

    Parameters
    ----------
    executor : as for `sweep`. function, items : the first cases; what they are made of decides what a new process has
        to load.

    Raises
    ------
    InputError : no executor; a function that cannot be sent to other processes; a pool whose processes would run the
        caller's script again.
    """
    if executor is None:
        return _usual(function, items)
    if hasattr(executor, "get_executor") or type(executor).__name__ == "ClientExecutor":
        return Cluster(executor)
    if not hasattr(executor, "submit"):
        raise refuse("executor", executor, "a concurrent.futures.Executor, a dask.distributed.Client, or None")
    if not isinstance(executor, ProcessPoolExecutor):
        return Place(executor)
    if _would_run_the_script(executor):
        raise InputError(
            "executor = ProcessPoolExecutor starts processes that run this script again: put the call under "
            f'`if __name__ == "__main__":`, leave executor= out, or give {THREADS}'
        )
    return Processes(executor)


def _usual(function: Function, items: Sequence[Any]) -> Place:
    """A pool of processes; in one of its workers, or where a new process cannot have the function, this process."""
    if _OURS:
        return Place(Here())
    of_script = b"__main__" in _packed(function, items, pickle.dumps)
    if of_script and not script_can_be_imported():
        reason = 'the function belongs to a script without `if __name__ == "__main__":`, or to no file'
        return Place(Here(), reason=reason)
    return Processes(WorkerPool(script=of_script), own=True)


def _would_run_the_script(pool: ProcessPoolExecutor) -> bool:
    if isinstance(pool, WorkerPool) or getattr(pool, "_processes", None):
        return False
    method = getattr(pool, "_mp_context", get_context()).get_start_method()
    has_file = getattr(sys.modules["__main__"], "__file__", None) is not None
    return method != "fork" and has_file and not script_can_be_imported()


def script_can_be_imported() -> bool:
    """Whether a new process may import the running script.

    It imports the file under another name than "__main__": a call under `if __name__ == "__main__":` is
    not made again there, any other is.
    """
    main = sys.modules["__main__"]
    path = getattr(main, "__file__", None)
    frame = sys._current_frames().get(threading.main_thread().ident or 0)
    while frame is not None and not (frame.f_code.co_name == "<module>" and frame.f_globals is vars(main)):
        frame = frame.f_back
    if path is None or frame is None:
        return False
    try:
        tree = ast.parse(Path(path).read_bytes())
    except (OSError, SyntaxError, ValueError):
        return False
    return any(
        isinstance(statement, ast.If)
        and statement.lineno <= frame.f_lineno <= (statement.end_lineno or statement.lineno)
        and "__name__" in ast.unparse(statement.test)
        for statement in tree.body
    )


def _packed(function: Function, items: Sequence[Any], dumps: Callable[[Any], bytes]) -> bytes:
    try:
        return dumps((function, items))
    except Exception as error:
        try:
            dumps(function)
        except Exception as reason:
            raise InputError(
                f"{named(function)} cannot be sent to other processes ({reason}): define it by `def` at the top level "
                f"of a module or script, or give {THREADS}"
            ) from None
        raise InputError(
            f"cases cannot be sent to other processes ({error}): give numbers, text, arrays or dataclasses, or "
            f"{THREADS}"
        ) from None


class ThreadPool(ThreadPoolExecutor):
    """Threads, one for each core by default. After an error the waiting cases are dropped."""

    def __init__(self, workers: int | None = None) -> None:
        super().__init__(workers or os.cpu_count() or 1)

    def __exit__(self, kind: Any, *rest: Any) -> bool | None:
        if kind is None:
            return super().__exit__(kind, *rest)
        self.shutdown(wait=False, cancel_futures=True)
        return None


def processes(workers: int | None) -> AbstractContextManager[ProcessPoolExecutor | None]:
    """So many processes, or None where no number is given: threads of this process compute then."""
    return nullcontext() if workers is None else WorkerPool(workers)


class WorkerPool(ProcessPoolExecutor):
    """Processes that share no locks with this one and end with it. After an error they are ended at once.

    Parameters
    ----------
    workers : number of processes; one for each core by default.
    script : whether they import the running script; functions of a module do not need it.
    """

    def __init__(self, workers: int | None = None, script: bool = False) -> None:
        self.script = script
        # a forked child shares locks of threads that it does not have
        super().__init__(workers, mp_context=_Start(script), initializer=_begin)

    def __exit__(self, kind: Any, *rest: Any) -> bool | None:
        if kind is None:
            return super().__exit__(kind, *rest)
        workers = list((getattr(self, "_processes", None) or {}).values())
        manager = getattr(self, "_executor_manager_thread", None)
        # the thread that cancels is then the one that finds a worker dead
        self.shutdown(wait=False, cancel_futures=True)
        for worker in workers:
            worker.terminate()
        if manager is not None:
            manager.join(PLACE.patience)  # it closes a pipe that the end of the interpreter writes to
        return None


class _Process(context.SpawnProcess):
    """A process that hears no Ctrl-C while it starts: only later it can ignore the signal."""

    def start(self) -> None:
        """Start the process with the signal blocked."""
        if not hasattr(signal, "pthread_sigmask"):
            super().start()
            return
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            super().start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _BareProcess(_Process):
    """A process that does not import the script that is running."""

    def start(self) -> None:
        """Start the process without the entries that make it import the script."""
        with _STARTING:
            usual, thread = spawn.get_preparation_data, threading.get_ident()

            def without_script(name: str) -> dict[str, Any]:
                ours = threading.get_ident() == thread
                return {key: data for key, data in usual(name).items() if not (ours and key.startswith("init_main"))}

            spawn.get_preparation_data = without_script
            try:
                super().start()
            finally:
                spawn.get_preparation_data = usual


_STARTING = threading.Lock()


class _Start(context.SpawnContext):
    """Starts processes that import the running script, or do not."""

    def __init__(self, script: bool) -> None:
        super().__init__()
        self.Process = _Process if script else _BareProcess  # type: ignore[misc]


def _begin() -> None:
    """Make the worker end with the process that started it, which also handles Ctrl-C in the terminal."""
    from multiprocessing.connection import wait

    _OURS.append(True)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    parent = parent_process()
    if parent is not None:
        sentinel = parent.sentinel
        threading.Thread(target=lambda: (wait([sentinel]), os._exit(1)), daemon=True).start()
