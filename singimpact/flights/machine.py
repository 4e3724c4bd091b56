"""Compiled entries of a model: kernels that come with the package, and the model's own f, g and law, compiled once.

A text is compiled, by another thread of this process, as soon as its interpreted flights have taken as long as that
takes: a tenth of a second for a model's own text.  Only where no object code of the kernels comes for the machine are
they compiled too, which takes a minute, once a cache.
"""

import ctypes
import hashlib
import os
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import nan
from pathlib import Path
from threading import Lock, Thread
from typing import Any

import numpy as np

from singimpact import cache
from singimpact.algebra.numbers import Array
from singimpact.flights import bind
from singimpact.flights.bind import Emitted
from singimpact.flights.kernels import layout
from singimpact.flights.shipped import shipped_code, sources, why_not
from singimpact.progress import ProgressLine
from singimpact.store import cache_folder, tell


@dataclass(frozen=True)
class CompilingSettings:
    """When models are compiled."""

    # seconds that a model's own text takes to compile, at first and for each of its characters; that kernels take
    own_text: tuple[float, float] = (0.08, 3e-5)
    kernels: float = 30.0
    # seconds of compiling after which a line says so
    silent: float = 1.0
    # bytes of address space that a process needs to compile; with 450 MB one was seen to import scipy without end
    space: int = 750 << 20


SETTINGS = CompilingSettings()
FOLDER = "kernels"
Entry = tuple[Callable[..., int], Callable[..., int]]
# States of one call of a `Bound` entry at most
FEW = 32


@lru_cache(maxsize=256)
def machine_of(emitted: Emitted) -> "Machine":
    """The machine of a text, one in a process."""
    return Machine(emitted)


class Machine:
    """The entries of the kernels of models that share a text."""

    def __init__(self, emitted: Emitted) -> None:
        self.emitted = emitted
        self.is_own = bool(emitted.flow or emitted.rho)  # what a model adds, in place of kernels
        own = SETTINGS.own_text[0] + SETTINGS.own_text[1] * len("".join(emitted.texts))
        self.price = own if self.is_own else SETTINGS.kernels
        self.spent = 0.0  # seconds of flights that were interpreted
        self._entries: dict[str, Entry] = {}
        self._lock, self._compiling = Lock(), Lock()
        self._looked: set[str] = set()

    def entry(self, name: str) -> Entry | None:
        """An entry, if it is compiled: without the interpreter's lock, and with it."""
        entry = self._entries.get(name)
        if entry is not None or not compilable():
            return entry
        if name in self._looked:
            return None
        self._looked.add(name)
        code = None if self.is_own else shipped_code(name)
        if code is not None:
            return self._load(name, code)
        file = self.place(name)
        if not file.is_file():
            return None
        code = cache.recall(file)
        if code is not None:
            try:
                return self._load(name, code)
            except ValueError as error:
                cache.damaged(file, str(error))
        with suppress(OSError):  # damaged, and said so once: who waits for this entry waits for another file
            file.unlink()
        return None

    def interpreted(self, seconds: float, name: str) -> None:
        """Count flights that were interpreted; after a while the text is compiled, for an entry `name`."""
        self.spent += seconds
        if self.spent > self.price and compilable() and not _is_confined():
            self.compile_here(name)

    def compile_here(self, name: str) -> Entry:
        """An entry that nothing can do without, compiled if it is not there."""
        entry = self.entry(name)
        if entry is not None:
            return entry
        with self._compiling:
            self._looked.discard(name)
            return self.entry(name) or self._compiled(name)

    def _compiled(self, name: str) -> Entry:
        """An entry compiled now; another thread does it, so that Ctrl-C is heard, and a line says so after a second."""
        codes: list[bytes] = []
        errors: list[Exception] = []

        def work() -> None:
            try:
                codes.append(self._code(name))
            except Exception as error:
                errors.append(error)

        worker = Thread(target=work, daemon=True)
        worker.start()
        begun, silent = time.monotonic(), True
        with ProgressLine() as line:
            while worker.is_alive():
                worker.join(SETTINGS.silent / 50)
                line.show(0, None, "the model's flights are compiled")
                if silent and time.monotonic() - begun > SETTINGS.silent:
                    silent = False
                    tell(f"the model's flights are compiled, in about {max(self.price, 2):.0f} s, once {self._reason}")
        if errors:
            raise errors[0]
        cache.keep(self.place(name), codes[0])
        return self._load(name, codes[0])

    def _code(self, name: str) -> bytes:
        from singimpact.codegen import object_code
        from singimpact.flights.compilers import KernelCompiler, text_of_model

        text = text_of_model(self.emitted) if self.is_own else KernelCompiler(self.emitted.steps).text(name)
        return object_code.emitted(text, name)

    @property
    def _reason(self) -> str:
        own = f"its f, g or law is {len(''.join(self.emitted.texts))} characters of code"
        return f"a cache: {own if self.is_own else 'there is no object code of the kernels, for ' + why_not()}"

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


@lru_cache(maxsize=1)
def _is_confined() -> bool:
    """Whether this process and its children may use less address space than compiling needs; one line says so."""
    try:
        import resource

        most = resource.getrlimit(resource.RLIMIT_AS)[0]
    except (ImportError, OSError):  # Windows
        return False
    if most == resource.RLIM_INFINITY or most >= SETTINGS.space:
        return False
    tell(
        f"the model's flights are not compiled, for that needs {SETTINGS.space >> 20} MB of address space and"
        f" {most >> 20} MB are allowed (ulimit -v): they are slower; the work goes on"
    )
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
        """Object code compiled in this process, see `Machine.compile_here`."""
        (name,) = self.machine.emitted.entries
        self._bind(self.machine.compile_here(name))

    def _bind(self, found: Entry) -> None:
        self.numbers[-1] = ctypes.cast(found[0], ctypes.c_void_p).value or 1  # type: ignore[arg-type]


class Bound:
    """An entry over memory of its own, lent to one call at a time, for the flights of few states.

    No call looks up an address.
    """

    def __init__(self, entry: Callable[..., int], kind: int, model: tuple[Array, Array, Array]) -> None:
        """`model` : sizes, numbers and scratch of a model."""
        numbers, status, sizes = np.zeros(14 * FEW), np.zeros(FEW, np.int8), model[0].copy()
        sizes[layout.KIND] = kind
        arrays = sizes, *model[1:], *(numbers[FEW * k :] for k in (0, 1, 2, 4)), status
        self._entry, self._arrays = entry, arrays
        self._addresses = [ctypes.c_void_p(array.ctypes.data) for array in arrays]
        # Python's own view of the memory is faster for single numbers
        self._sizes = (ctypes.c_int64 * sizes.size).from_address(sizes.ctypes.data)
        self._numbers = (ctypes.c_double * numbers.size).from_address(numbers.ctypes.data)
        self._status = (ctypes.c_int8 * FEW).from_address(status.ctypes.data)

    def one(self, tau: float, v: float, quantity: float = nan) -> tuple[int, list[float]]:
        """Code and the first ten results of one state."""
        numbers = self._numbers
        numbers[0], numbers[FEW], numbers[2 * FEW] = tau, v, quantity
        self._sizes[layout.COUNT] = 1
        self._entry(*self._addresses)
        return self._status[0], numbers[4 * FEW : 4 * FEW + 10]

    def few(self, tau: Array, v: Array, quantities: Array | float) -> tuple[Array, Array]:
        """Codes, and ten rows of results, of at most `FEW` states."""
        count, (*_, times, speeds, others, results, status) = tau.size, self._arrays
        times[:count], speeds[:count], others[:count] = tau, v, quantities
        self._sizes[layout.COUNT] = count
        self._entry(*self._addresses)
        return status[:count].copy(), results[: 10 * count].reshape(10, count).copy()


def one_by_one(entry: Callable[..., int], counts: list[int]) -> Callable[..., int]:
    """An entry called for flights one after the other, each with as many times and results as `counts` says."""

    def follow(sizes: Any, model: int, scratch: int, tau: int, v: int, w: int, out: int, status: int) -> int:
        for count in counts:
            sizes[layout.COUNT] = count
            entry(sizes, model, scratch, tau, v, w, out, status)
            # rows of three numbers a flight; a time, and two results, of 8 bytes each
            tau, v, w, out = tau + 24, v + 24, w + 8 * count, out + 16 * count
        return 0

    return follow


@lru_cache(maxsize=1)
def _digest_of_sources() -> bytes:
    """Of the kernels, of what compiles them and of the processor."""
    from singimpact.codegen import lowering
    from singimpact.codegen.object_code import processor

    parts = (*sources(), Path(str(lowering.__file__)).read_bytes(), processor().encode())
    return hashlib.sha256(b"".join(hashlib.sha256(part).digest() for part in parts)).digest()


@lru_cache(maxsize=1)
def compilable() -> bool:
    """Whether object code can be loaded, and is wanted."""
    try:
        import llvmlite  # noqa: F401
    except ImportError:
        return False
    return os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0")
