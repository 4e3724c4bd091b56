"""What is asked of an input: it works or is refused in one line, soon, in little memory, and nothing in it is executed."""

from __future__ import annotations

import builtins
import io
import os
import resource
import signal
import sys
import tempfile
import time
import traceback
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

KINDS = ("expression", "model", "scene", "claim", "command")
WATCHED = (
    "os.system",
    "os.exec",
    "os.posix_spawn",
    "os.spawn",
    "os.fork",
    "subprocess.Popen",
    "socket.connect",
    "ctypes.dlopen",
)


@dataclass(frozen=True)
class Bounds:
    """What one input may take.

    Parameters
    ----------
    seconds : of CPU. memory : bytes beyond what the process holds before its first input. flown : share of the models
        that are flown once, which costs a hundred times as much as reading one.
    """

    seconds: float = 2.0
    memory: int = 500 * 2**20
    flown: float = 0.02


BOUNDS = Bounds()


class TooLong(BaseException):
    """An input took its seconds; no `except Exception` on the way may swallow that."""


class Watch:
    """Everything that looks like execution since the last look."""

    def __init__(self) -> None:
        self.on, self.seen = False, list[str]()
        builtins.canary = lambda *_: self.seen.append("canary was called")  # type: ignore[attr-defined]
        sys.addaudithook(self._hear)

    def _hear(self, event: str, args: tuple[Any, ...]) -> None:
        if not self.on:
            return
        if event in WATCHED:
            self.seen.append(f"{event} {str(args)[:80]}")
        elif event == "exec" and hasattr(args[0], "co_filename"):
            # kernels emitted for a model, modules imported late, and the classes that such modules make
            name, maker = args[0].co_filename, sys._getframe(1).f_code.co_filename
            made = name == "<string>" and maker.endswith(("dataclasses.py", "collections/__init__.py"))
            if not (made or name.startswith(("<kernel", "<frozen")) or name.endswith(".py")):
                self.seen.append(f"exec of {name}")


class Trial:
    """Tries inputs in this process, one after the other."""

    def __init__(self) -> None:
        self.place = Path(tempfile.mkdtemp(prefix="fuzz-"))
        self.watch = Watch()
        from singimpact.flights import Emitted, machine_of

        machine_of(Emitted()).compile_here("linear_entry")  # what all linear models share
        for kind, given in USUAL.items():
            self._run(kind, given, True)
        for name in (
            "threshold",
            "orbit",
            "chatter",
            "fixed-points",
            "claims",
            "cite",
        ):  # what they import is no input's
            self._run("command", [name, *USUAL_OPTIONS.get(name, USUAL["command"][1:-2])], True)
        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + BOUNDS.memory, used + BOUNDS.memory))
        signal.signal(signal.SIGPROF, _too_long)

    def fault(self, kind: str, given: Any, fly: bool = False) -> str | None:
        """What is wrong with what came of an input, or None."""
        self.watch.seen.clear()
        self.watch.on, start = True, time.process_time()
        signal.setitimer(signal.ITIMER_PROF, BOUNDS.seconds)
        try:
            told = self._run(kind, given, fly)
        except TooLong:
            told = "took too long"
        except MemoryError:
            told = "took too much memory"
        except (Exception, SystemExit) as error:
            frames = traceback.extract_tb(error.__traceback__)
            told = f"{type(error).__name__}: {str(error)[:90]} at {Path(frames[-1].filename).name}:{frames[-1].lineno}"
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            self.watch.on = False
        if not told and time.process_time() - start > BOUNDS.seconds:
            told = "took too long"
        return self.watch.seen[0] if self.watch.seen else told

    def _run(self, kind: str, given: Any, fly: bool) -> str | None:
        """Works, or is refused in one line: then None."""
        from singimpact.inputs import InputError

        try:
            return self._command(given) if kind == "command" else getattr(self, f"_{kind}")(given, fly)
        except InputError as error:
            return None if "\n" not in str(error) and len(str(error)) < 2000 else "a refusal of several lines"

    def _expression(self, text: str, fly: bool) -> None:  # noqa: ARG002
        from singimpact.algebra import float_array, parse
        from singimpact.inputs import InputError

        try:
            tree = parse(text, ["x", "xdot", "t", "omega"])
            assert parse(str(tree), ["x", "xdot", "t", "omega"]) is not None or len(str(tree)) > 10_000
        except InputError:
            pass
        float_array("tau", text)

    def _model(self, text: str, fly: bool) -> None:
        from singimpact.impact_oscillator import ImpactOscillator
        from singimpact.oscillator import fields_of

        model = ImpactOscillator(**fields_of(text))
        if fly:
            model.acceleration(0.3)
            model.impact_map(0.3, 0.1, horizon=2.0)

    def _scene(self, text: str, fly: bool) -> None:  # noqa: ARG002
        from singimpact.scenes import Scene

        path = self.place / "scene.toml"
        path.write_text(text, encoding="utf-8", errors="replace", newline="")
        Scene.read(path)

    def _claim(self, text: str, fly: bool) -> None:  # noqa: ARG002
        from singimpact.paper import select

        select([text])

    def _command(self, arguments: list[str]) -> str | None:
        from singimpact.cli import main

        out, err = io.StringIO(), io.StringIO()
        with redirect_stdout(out), redirect_stderr(err):
            code = main._code(arguments)
        if code == 2 and (out.getvalue() or err.getvalue().count("\n") != 1):
            return f"a refusal that is not one line: {err.getvalue()[:90]!r}"
        return None if code in (0, 2) else f"exit code {code}: {err.getvalue()[:90]!r}"


def _too_long(*_: Any) -> None:
    raise TooLong


USUAL = {
    "expression": "root(u**2 - 2, 1, 2) + sin(1)",
    "model": 'f = "x + 0.3*x**3"\ng = "cos(2*t)"\nclearance = 0.3\nrestitution = 0.5',
    "scene": 'layers = ["gamma"]\ntau = [-1, 1]\nv = [0, 1]\n[model]\nf = "x"\ng = "cos(t)"\nclearance = 0\nrestitution = 1',
    "claim": "e:meq",
    "command": [
        "map",
        "--omega",
        "2",
        "--clearance",
        "0.3",
        "--restitution",
        "0.5",
        "--tau",
        "1",
        "--v",
        "0.1",
        "--digits",
        "20",
    ],
}


def tried(seed: int, numbers: range) -> list[tuple[str, int, str]]:
    """Faults (kind, number, sentence) of some inputs; the first call in a process makes it ready."""
    from inputs import made

    global _TRIAL
    os.environ["SINGIMPACT_CACHE"] = os.environ.get("SINGIMPACT_CACHE", "off")
    if _TRIAL is None:
        _TRIAL = Trial()
    found = []
    for number in numbers:
        kind = KINDS[number % len(KINDS)]
        fly = Random(number).random() < BOUNDS.flown
        fault = _TRIAL.fault(kind, made(kind, seed, number), fly)
        if fault:
            found.append((kind, number, fault))
    return found


USUAL_OPTIONS = {"fixed-points": ["swan", "--r", "1/2"], "claims": ["show", "e:meq"], "cite": []}
_TRIAL: Trial | None = None
