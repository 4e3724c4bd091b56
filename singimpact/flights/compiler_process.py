"""The process that compiles kernels for a cache where none come with the package, started by `machine`.

It holds a lock as long as it lives.  A signal ends it, also in the middle of LLVM; so does the removal of its request.
"""

from __future__ import annotations

import gc
import os
import select
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from socket import socketpair
from threading import Lock, Thread
from typing import Any

from singimpact import cache
from singimpact.flights.bind import Emitted
from singimpact.flights.compilers import KernelCompiler
from singimpact.flights.machine import ASKED, BUSY, FIRST, SETTINGS, Machine, withdraw

SIGNALS = {number for name in ("SIGTERM", "SIGINT", "SIGHUP") if (number := getattr(signal, name, None))}


def compile_asked(request: Path) -> None:
    """The work of the other process: it compiles the entries of kernels and stores them, while it holds the lock."""
    if hasattr(os, "nice"):
        os.nice(10)
    gc.disable()  # a tenth of the time: numba makes millions of objects, and the process ends when it is done
    machine = Machine(Emitted(steps=request.read_text(encoding="utf-8") == "steps"))
    held = machine.lock_of_cache
    signals = _heard()
    if not held.take(request.name, SETTINGS.lock):  # another program was a little faster
        if held.holder() != request.name:
            withdraw(request)
        sys.exit(BUSY)
    writing = Lock()
    _end_early(request, writing, signals)
    from singimpact.codegen import object_code

    object_code.without_machine_code()
    try:
        compiler = KernelCompiler(machine.emitted.steps)
        for name in first_wanted(request, machine.emitted.entries):
            if cache.recall(machine.place(name)) is None:
                code = object_code.emitted(compiler.text(name), name)
                with writing:
                    if request.exists():  # else the cache was removed or emptied meanwhile
                        cache.keep(machine.place(name), code)
    except MemoryError:
        signal.raise_signal(signal.SIGKILL)  # whoever waits sees that there is no memory, and does not try it itself
    finally:
        withdraw(request)
        _remove_stale(request.parent)
        held.release()


def _heard() -> tuple[Any, Any]:
    """Sockets through which the system sends the numbers of signals from now on: one may come while LLVM works."""
    reading, writing = socketpair()
    writing.setblocking(False)
    signal.set_wakeup_fd(writing.fileno())
    for number in SIGNALS:
        signal.signal(number, lambda *_: None)
    return reading, writing


def _end_early(request: Path, writing: Lock, signals: tuple[Any, Any]) -> None:
    """End this process at a signal, and when its request is gone."""

    def watch() -> None:
        code = 0
        while not code and request.exists():
            if select.select([signals[0]], [], [], SETTINGS.look)[0]:
                code = 128 + signals[0].recv(1)[0]
        with writing:  # no entry is half-written
            withdraw(request)
            os._exit(code)

    Thread(target=watch, daemon=True).start()


def _remove_stale(place: Path) -> None:
    """Remove requests whose processes were killed."""
    with suppress(OSError):
        for path in (*place.glob(f"*{ASKED}"), *place.glob(f"*{FIRST}")):
            if time.time() - path.stat().st_mtime > SETTINGS.stale:
                path.unlink(missing_ok=True)


def first_wanted(request: Path, names: tuple[str, ...]) -> Iterator[str]:
    """Entries in their order, but always the one next that somebody waits for now."""
    left = list(names)
    while left:
        with suppress(OSError):
            left.sort(key=request.with_suffix(FIRST).read_text(encoding="utf-8").__ne__)
        yield left.pop(0)


if __name__ == "__main__":
    compile_asked(Path(sys.argv[1]))
