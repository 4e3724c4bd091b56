"""Long calls of compiled code in other threads: Ctrl-C ends the wait for one at once, and two share out an array."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache
from threading import Thread, current_thread, main_thread
from typing import Any

from singimpact.inputs import refuse

# Seconds; a thread costs 0.0001
LONG = 0.05
NAME = "long flights"
# Seconds between two looks of the main thread, where the system does not wake it up
LOOK = 0.1


def interruptible(call: Callable[..., int], arguments: tuple[Any, ...], buffers: tuple[Any, ...]) -> int:
    """The value of a call that releases Python's lock and raises nothing.

    Parameters
    ----------
    buffers : what the call writes into. An interrupted call goes on in its thread to its end, and they live as long.

    Examples
    --------
    >>> interruptible(max, (1, 2), ())
    2
    """
    if current_thread() is not main_thread():
        return call(*arguments)
    values: list[int] = []

    def work(_kept: tuple[Any, ...] = buffers) -> None:
        values.append(call(*arguments))

    thread = Thread(target=work, name=NAME, daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(LOOK)
    return values[0]


# Threads that share out an array unless a call says otherwise; never more than there are processors
USUAL = 2
_ASKED: ContextVar[int | None] = ContextVar("threads", default=None)


@contextmanager
def on_threads(threads: Any) -> Iterator[None]:
    """Within it so many threads share out an array; None for `USUAL`.

    Raises
    ------
    InputError : it is no number of threads.

    Examples
    --------
    >>> with on_threads(1):
    ...     threads_now()
    1
    """
    if threads is not None and (type(threads) is not int or not 1 <= threads <= 256):
        raise refuse("threads", threads, "a whole number from 1 to 256, or None")
    before = _ASKED.set(threads)
    try:
        yield
    finally:
        _ASKED.reset(before)


def threads_now() -> int:
    """The number of threads that share out an array in this call."""
    return _ASKED.get() or min(USUAL, _processors())


@lru_cache(maxsize=1)
def _processors() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def shared_out(work: Callable[[slice], None], begin: int, end: int, least: int) -> None:
    """Call `work` for slices that make up begin:end, in threads, of at least so many elements each.

    Examples
    --------
    >>> parts = []
    >>> with on_threads(2):
    ...     shared_out(parts.append, 0, 100, 30)
    >>> sorted((part.start, part.stop) for part in parts)
    [(0, 50), (50, 100)]
    """
    length = end - begin
    count = max(1, min(threads_now(), length // least))
    slices = [slice(begin + length * at // count, begin + length * (at + 1) // count) for at in range(count)]
    errors: list[BaseException] = []

    def run(chosen: slice) -> None:
        try:
            work(chosen)
        except BaseException as error:
            errors.append(error)

    threads = [Thread(target=run, args=(chosen,), name=NAME, daemon=True) for chosen in slices[1:]]
    for thread in threads:
        thread.start()
    work(slices[0])
    for thread in threads:
        while thread.is_alive():
            thread.join(LOOK)
    if errors:
        raise errors[0]
