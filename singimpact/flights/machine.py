"""Compiled entries of a model's kernels: from memory, from the cache, or from a process that compiles them meanwhile.

Until they are there, flights are interpreted.  Compiling takes seconds, so one process of low priority does it, once a
cache; nothing waits for it.
"""

from __future__ import annotations

import atexit
import ctypes
import gc
import hashlib
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from threading import Lock
from typing import Any

from singimpact import cache
from singimpact.flights import bind
from singimpact.flights.bind import Emitted
from singimpact.inputs import InputError
from singimpact.store import cache_folder, folder, write_text


@dataclass(frozen=True)
class CompilingSettings:
    """When models are compiled."""

    # seconds of interpreted flights after which a model of its own f and g is compiled: most sessions fly fewer
    wait: float = 0.25
    # seconds between two reads of the cache while a process compiles
    look: float = 0.2
    # seconds after which a process that compiles is taken for dead
    dead: float = 300.0


SETTINGS = CompilingSettings()
FOLDER = "kernels"
FIRST = ".first"  # beside a request: the entry that somebody waits for
Entry = tuple[Callable[..., int], Callable[..., int]]


@lru_cache(maxsize=256)
def machine_of(emitted: Emitted) -> Machine:
    """The machine of a text, one in a process."""
    return Machine(emitted)


class Machine:
    """The entries of the kernels of models that share a text."""

    def __init__(self, emitted: Emitted) -> None:
        self.emitted = emitted
        self.spent = 0.0  # seconds of flights that were interpreted
        self._entries: dict[str, Entry] = {}
        self._lock = Lock()
        self._looked: dict[str, float] = {}
        self._asked, self._tried = "", -1e9

    def entry(self, name: str) -> Entry | None:
        """An entry, if it is compiled: without the interpreter's lock, and with it."""
        found = self._entries.get(name)
        if found is not None or not compilable():
            return found
        now = time.monotonic()
        if now - self._looked.get(name, -1e9) < SETTINGS.look:
            return None
        self._looked[name] = now
        place = self.place(name)
        if not place.is_file():
            return None
        code = cache.recall(place)
        if code is None:  # damaged, and told so once: whoever waits for this entry waits for another file
            with suppress(OSError):
                place.unlink()
            return None
        return self._load(name, code)

    def interpreted(self, seconds: float, name: str) -> None:
        """Count flights that were interpreted; after a while a process compiles the text, the entry `name` first."""
        self.spent += seconds
        waits = self.emitted != Emitted() and self.spent < SETTINGS.wait
        if self._asked == name or not compilable() or waits:
            return
        now = time.monotonic()
        if now - self._tried > SETTINGS.look:
            self._tried = now
            self._asked = name if self._compile_elsewhere(name) else ""

    def compile_here(self, name: str) -> Entry:
        """An entry that is waited for: from the process that compiles for this cache, or compiled in this one."""
        from singimpact.codegen import object_code

        found = self.entry(name) or self._awaited(name)
        if found is None:
            code = object_code.emitted(bind.Compiler(self.emitted).text(name), name)
            cache.keep(self.place(name), code)
            found = self._load(name, code)
        return found

    def _awaited(self, name: str) -> Entry | None:
        """An entry from that process, started unless it runs; None when it is busy with another text, or fails."""
        self._compile_elsewhere(name)
        while self._is_compiled_now() and not self.place(name).is_file():
            time.sleep(SETTINGS.look / 10)
        self._looked.pop(name, None)
        return self.entry(name)

    def _is_compiled_now(self) -> bool:
        """Whether a process compiles this text: one that this process has started, or another's that is not dead."""
        try:
            asked = self._request.stat().st_mtime
        except OSError:
            return False
        return any(process.poll() is None for process in _STARTED) or (
            not _STARTED and time.time() - asked < SETTINGS.dead
        )

    def _load(self, name: str, code: bytes) -> Entry:
        from singimpact.codegen import object_code

        with self._lock:
            if name not in self._entries:
                self._entries[name] = object_code.loaded(code, name, bind.ADDRESSES)
        return self._entries[name]

    def place(self, name: str) -> Path:
        """The file of an entry's object code."""
        return cache_folder() / FOLDER / f"{self.digest}.{name}.o"

    @cached_property
    def digest(self) -> str:
        """Of everything that object code depends on."""
        digest = hashlib.sha256(_digest_of_sources())
        for text in self.emitted.texts:
            digest.update(hashlib.sha256(text.encode()).digest())
        return digest.hexdigest()[:32]

    @property
    def _request(self) -> Path:
        return cache_folder() / FOLDER / f"{self.digest}{self._kind}"

    @property
    def _kind(self) -> str:
        """How requests end of which one runs at a time: a text takes seconds, so it does not wait for kernels."""
        return ".text.asked" if self.emitted.flow or self.emitted.rho else ".kernels.asked"

    def _compile_elsewhere(self, name: str) -> bool:
        """Start a process of low priority that compiles, unless one runs for this cache; returns whether it started."""
        request = self._request
        try:
            folder(request.parent)
            write_text(request.with_suffix(FIRST), name)
            if any(
                time.time() - each.stat().st_mtime < SETTINGS.dead for each in request.parent.glob(f"*{self._kind}")
            ):
                return request.exists()
            write_text(request, "\0".join(self.emitted.texts))
            command = [sys.executable, "-m", "singimpact.flights.machine", str(request)]
            _outliving(command)
        except (InputError, OSError) as error:
            cache.not_kept(error)
        return True


@dataclass(frozen=True)
class Called:
    """A text that kernels call at an address.

    Parameters
    ----------
    numbers : what is given to the kernels; the last is the address, 1 before the text is compiled.
    """

    machine: Machine
    numbers: Any

    def is_bound(self, seconds: float = 0.0) -> bool:
        """Whether kernels can call it; if not, it is asked for, for work that takes so long when it is interpreted."""
        (name,) = self.machine.emitted.entries
        if self.numbers[-1] == 1:
            found = self.machine.entry(name)
            if found is None:
                self.machine.interpreted(seconds, name)
                return False
            self._bind(found)
        return True

    def compile_here(self) -> None:
        """As `Machine.compile_here`."""
        (name,) = self.machine.emitted.entries
        self._bind(self.machine.compile_here(name))

    def _bind(self, found: Entry) -> None:
        self.numbers[-1] = ctypes.cast(found[0], ctypes.c_void_p).value or 1  # type: ignore[arg-type]


@lru_cache(maxsize=1)
def _digest_of_sources() -> bytes:
    """Of the kernels, of what compiles them and of the processor."""
    from singimpact.codegen.object_code import processor

    parts = (*bind.sources(), processor().encode())
    return hashlib.sha256(b"".join(hashlib.sha256(part).digest() for part in parts)).digest()


_STARTED: list[Any] = []


def _outliving(command: list[str]) -> None:
    """Start a process that goes on when this one ends."""
    import subprocess  # 7 ms, and most processes find all compiled

    _STARTED.append(subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        start_new_session=True, cwd=Path(__file__).parents[2],
        # the passes of `object_code` do all that numba's own would, which take a third of the time
        env={**os.environ, "SINGIMPACT_CACHE": str(cache_folder()), "NUMBA_OPT": "0"},
    ))  # fmt: skip
    if len(_STARTED) == 1:
        atexit.register(_left_alone)


def _left_alone() -> None:
    for process in _STARTED:
        if process.poll() is None:
            process.returncode = 0  # else Python warns that it is still running


@lru_cache(maxsize=1)
def compilable() -> bool:
    """Whether object code can be loaded, and is wanted."""
    try:
        import llvmlite  # noqa: F401
    except ImportError:
        return False
    return os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0")


def compile_asked(request: Path) -> None:
    """What the other process does: compile the entries of a text and keep them."""
    if hasattr(os, "nice"):
        os.nice(10)
    gc.disable()  # a tenth of the time: numba makes millions of objects, and the process ends when it is done
    flow, rho, steps = request.read_text(encoding="utf-8").split("\0")
    machine = Machine(Emitted(flow, rho, bool(steps)))
    from singimpact.codegen import object_code

    object_code.without_machine_code()
    try:
        compiler = bind.Compiler(machine.emitted)
        for name in _first_wanted(request, machine.emitted.entries):
            if cache.recall(machine.place(name)) is None:
                code = object_code.emitted(compiler.text(name), name)
                if request.exists():  # else the cache was removed or emptied meanwhile
                    cache.keep(machine.place(name), code)
    finally:
        request.unlink(missing_ok=True)
        request.with_suffix(FIRST).unlink(missing_ok=True)


def _first_wanted(request: Path, names: tuple[str, ...]) -> Iterator[str]:
    """Entries in their order, but always the one next that somebody waits for now."""
    left = list(names)
    while left:
        with suppress(OSError):
            left.sort(key=request.with_suffix(FIRST).read_text(encoding="utf-8").__ne__)
        yield left.pop(0)


if __name__ == "__main__":
    compile_asked(Path(sys.argv[1]))
