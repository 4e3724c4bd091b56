"""Where cases are computed: a pool of processes, threads, a cluster, or this process, with one interface.

Not here: the choice of the cases and the use of their results (`cases`).
"""

from __future__ import annotations

import ast
import os
import pickle
import sys
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from multiprocessing import context, get_context, parent_process, spawn
from pathlib import Path
from typing import Any

import numpy as np

from singimpact.inputs import InputError, refuse, shown

Array = np.ndarray[Any, Any]
Function = Callable[[Any], Any]
THREADS = "executor=concurrent.futures.ThreadPoolExecutor()"


@dataclass(frozen=True)
class ChunkSettings:
    """Size at which a worker returns its results before its chunk is complete."""

    bytes: int = 1 << 24  # of results; the calling process holds a few chunks of each worker in memory


CHUNK = ChunkSettings()


@dataclass(frozen=True)
class ClusterSettings:
    """Time between two requests for the size of a cluster."""

    interval: float = 1.0  # s; workers come and go while a sweep runs


CLUSTER = ClusterSettings()
PATIENCE = 5.0
"""Seconds that the end of a pool waits for its terminated workers."""
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
        if time.monotonic() - start > seconds or size > CHUNK.bytes:
            break
    return _stacked(function, values), time.monotonic() - start


def _stacked(function: Function, values: list[Any]) -> Array:
    try:
        return np.asarray(values)
    except ValueError:
        told = " and ".join(map(str, sorted({np.shape(value) for value in values})[:2]))
        raise InputError(
            f"{named(function)} gives results of shapes {told}: give arrays of one shape for all cases"
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


class Place:
    """Threads, or any other executor that takes functions as they are.

    Parameters
    ----------
    executor : submits, and gives futures with `add_done_callback`.
    """

    replaceable = False  # by a new pool, when a worker has died
    reason = ""  # for computing in this process

    def __init__(self, executor: Executor) -> None:
        self.executor = executor

    @property
    def width(self) -> int:
        """Cases that are computed at the same time."""
        known = [getattr(self.executor, name, None) for name in ("_max_workers", "num_workers")]
        return next((count for count in known if isinstance(count, int) and count > 0), os.cpu_count() or 1)

    def submit(self, function: Function, items: Sequence[Any], seconds: float) -> Future[Any]:
        """Begin to compute some cases."""
        return self.executor.submit(computed, function, items, seconds)

    def opened(self) -> AbstractContextManager[Any]:
        """A context that ends a pool made here; a pool of the caller stays open."""
        return nullcontext()

    def again(self, width: int | None = None) -> Place:
        """A new pool in place of one that has lost a worker."""
        del width
        return self


class Here(Place):
    """The calling process, one case after another."""

    def __init__(self, reason: str = "") -> None:
        self.reason = reason

    @property
    def width(self) -> int:
        """One."""
        return 1

    def submit(self, function: Function, items: Sequence[Any], seconds: float) -> Future[Any]:
        """Compute the cases and return the finished future; an interruption is raised at once."""
        return _done_here(function, items, seconds)


class Cluster(Place):
    """A `dask.distributed.Client`, or the executor that it gives."""

    def __init__(self, executor: Any) -> None:
        self.client = executor if hasattr(executor, "get_executor") else executor._client
        super().__init__(executor.get_executor() if hasattr(executor, "get_executor") else executor)
        self._known, self._when = 1, -CLUSTER.interval

    @property
    def width(self) -> int:
        """Threads of all workers of the cluster, as many as there are now."""
        if time.monotonic() - self._when >= CLUSTER.interval:
            self._known, self._when = max(1, sum(self.client.nthreads().values())), time.monotonic()
        return self._known

    def submit(self, function: Function, items: Sequence[Any], seconds: float) -> Future[Any]:
        """Begin to compute some cases. They are sent as bytes, because Dask takes a tuple among them for a task."""
        import cloudpickle

        return self.executor.submit(unpacked, _packed(function, items, cloudpickle.dumps), seconds)


class Processes(Place):
    """A process pool. Work is pickled before it is submitted, so that a pickling error gives one clear message."""

    replaceable = True

    def __init__(self, executor: ProcessPoolExecutor, own: bool = False) -> None:
        super().__init__(executor)
        self.own, self.scripted = own, not isinstance(executor, WorkerPool) or executor.script

    def submit(self, function: Function, items: Sequence[Any], seconds: float) -> Future[Any]:
        """Begin to compute some cases; cases of a script that the workers have not imported are computed here."""
        payload = _packed(function, items, pickle.dumps)
        if not self.scripted and b"__main__" in payload:
            return _done_here(function, items, seconds)
        return self.executor.submit(unpacked, payload, seconds)

    def opened(self) -> AbstractContextManager[Any]:
        """The pool, when it was made here."""
        return self.executor if self.own else nullcontext()

    def again(self, width: int | None = None) -> Place:
        """A new pool that starts its processes as this one does."""
        count = width or self.width
        given = self.executor
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
        return Here()
    of_script = b"__main__" in _packed(function, items, pickle.dumps)
    if of_script and not script_can_be_imported():
        return Here('the function belongs to a script without `if __name__ == "__main__":`, or to no file')
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
    line = frame.f_lineno
    calls = [
        statement for statement in tree.body if statement.lineno <= line <= (statement.end_lineno or statement.lineno)
    ]
    return any(isinstance(statement, ast.If) and "__name__" in ast.unparse(statement.test) for statement in calls)


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


def _done_here(function: Function, items: Sequence[Any], seconds: float) -> Future[Any]:
    done: Future[Any] = Future()
    try:
        done.set_result(computed(function, items, seconds))
    except Exception as error:
        done.set_exception(error)
    return done


class ThreadPool(ThreadPoolExecutor):
    """Threads, one for each core by default. After an error the waiting cases are dropped."""

    def __init__(self, workers: int | None = None) -> None:
        super().__init__(workers or os.cpu_count() or 1)

    def __exit__(self, kind: Any, *rest: Any) -> bool | None:
        if kind is None:
            return super().__exit__(kind, *rest)
        self.shutdown(wait=False, cancel_futures=True)
        return None


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
        start = _WithScript() if script else _WithoutScript()
        super().__init__(workers, mp_context=start, initializer=_begin)

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
            manager.join(PATIENCE)  # it closes a pipe that the end of the interpreter writes to
        return None


class _Process(context.SpawnProcess):
    """A process that hears no Ctrl-C while it starts: only later it can ignore the signal."""

    def start(self) -> None:
        """Start the process with the signal blocked."""
        import signal

        if not hasattr(signal, "pthread_sigmask"):
            super().start()
            return
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            super().start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _WithScript(context.SpawnContext):
    Process = _Process


class _BareProcess(_Process):
    """A process that does not import the script that is running."""

    def start(self) -> None:
        """Start the process without the entries that make it import the script."""
        with _STARTING:
            usual, thread = spawn.get_preparation_data, threading.get_ident()

            def without_script(name: str) -> dict[str, Any]:
                data = usual(name)
                ours = threading.get_ident() == thread
                return {key: value for key, value in data.items() if not (ours and key.startswith("init_main"))}

            spawn.get_preparation_data = without_script
            try:
                super().start()
            finally:
                spawn.get_preparation_data = usual


_STARTING = threading.Lock()


class _WithoutScript(context.SpawnContext):
    Process = _BareProcess


def _begin() -> None:
    """Make the worker end with the process that started it, which also handles Ctrl-C in the terminal."""
    import signal
    from multiprocessing.connection import wait

    _OURS.append(True)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    parent = parent_process()
    if parent is not None:
        sentinel = parent.sentinel
        threading.Thread(target=lambda: (wait([sentinel]), os._exit(1)), daemon=True).start()
