"""Long calls of compiled code that Ctrl-C ends at once: another thread makes the call while the main one waits."""

from __future__ import annotations

from collections.abc import Callable
from threading import Thread, current_thread, main_thread
from typing import Any

LONG = 0.05
"""Seconds; a thread costs 0.0001."""
NAME = "long flights"
LOOK = 0.1
"""Seconds between two looks of the main thread, where the system does not wake it up."""


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
