"""Fly models of hostile expressions: `python tests/tool/fuzzing/hostile.py --models 480 --seed 1`.

Each model is read and flown twice in a process of its own, `impact_map` and `first_hit`, by interpreted kernels: those
of the first calls.  Both must end in a status or in one line, within the bounds of `Bounds`, and without compiling.
Prints faults and the slowest models, and exits with 1 when there is a fault; `--show NUMBER` prints one model again.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import sys
import time
from collections import Counter
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from random import Random
from typing import Any

sys.path[:0] = [str(Path(__file__).parents[3]), str(Path(__file__).parents[2])]


@dataclass(frozen=True)
class Bounds:
    """What one model may take.

    Parameters
    ----------
    seconds : of CPU of a usual machine for one call, always allowed; the first one makes the model too. ordinary : what
        is allowed beyond them, in calls of `ORDINARY` made right before and after, but no more than `most`. memory :
        bytes of the process. killed : seconds of CPU after which the process is ended. address_space : bytes beyond
        which the process has no memory.
    """

    seconds: float = 2.0
    ordinary: float = 4.0
    most: float = 4.0
    memory: int = 500 * 2**20
    killed: int = 20
    address_space: int = 2**31


ORDINARY = {"f": "x + x**3/5 + 0.1*xdot", "g": "cos(2*t)", "clearance": "-9", "restitution": "0.7", "state": (0.3, 0.2)}
"""A model of which no impact comes, and a state: its flight ends at the horizon, after 7400 steps and about 0.8 s."""
NUMBERS = ["1e-65", "1e65", "1e-300", "1e300", "1e-3000", "3/7", "0.1", "2", "1e4", "-1", "pi", "7", "1e-12", "10**300"]
EXPONENTS = ["1000", "999", "511", "-1000", "-7", "0.5", "(1/3)", "(-997/1000)", "17", "2", "(999/2)", "64", "127"]
FUNCTIONS = ["sin", "cos", "tan", "exp", "log", "sqrt", "tanh", "atan"]


def model(seed: int, number: int) -> dict[str, Any]:
    """Fields of a model and a state, the same for the same name."""
    random = Random(f"{seed}:hostile:{number}")
    f = _grown(random, random.randrange(1, 7), ["x", "xdot"])
    g = random.choice(["cos(t)", "cos(2*t)", "1", "-1", "0"])
    if random.random() < 0.3:
        g = _grown(random, random.randrange(1, 5), ["t"])
    state = random.uniform(-5, 5), 10 ** random.uniform(-6, 2)
    return {"f": f, "g": g, "clearance": random.choice(["0", "0.3", "-1"]), "restitution": "0.7", "state": state}


def _grown(random: Random, depth: int, names: list[str]) -> str:
    if depth == 0:
        return random.choice(names if random.random() < 0.6 else NUMBERS)
    way = random.random()
    inner = _grown(random, depth - 1, names)
    if way < 0.3:
        return f"({inner})**{random.choice(EXPONENTS)}"
    if way < 0.5:
        return f"{random.choice(FUNCTIONS)}({inner})"
    if way < 0.6:
        return f"{random.choice(NUMBERS)}*({inner})"
    if way < 0.65:  # one part many times
        return random.choice(["+", "*"]).join(f"({inner})**{power}" for power in range(2, random.randrange(4, 40)))
    return f"({inner}{random.choice(['+', '-', '*', '/'])}{_grown(random, depth - 1, names)})"


@dataclass(frozen=True)
class Flown:
    """What came of a model: its end in words, seconds of CPU of the longer call and of the process, bytes, and
    the seconds allowed."""

    number: int
    end: str
    seconds: float
    both: float
    memory: int
    allowed: float = Bounds.seconds

    @property
    def fault(self) -> bool:
        """Whether it ended otherwise than in a status or a sentence, or took too much."""
        told = self.end.startswith(("status", "refused"))
        return not told or self.seconds > self.allowed or self.memory > Bounds.memory


def flown(number: int, fields: dict[str, Any]) -> Flown:
    """A model with a state, in a process of its own."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        end, times = "no end", [time.process_time()]
        try:
            resource.setrlimit(resource.RLIMIT_CPU, (Bounds.killed, Bounds.killed))
            resource.setrlimit(resource.RLIMIT_AS, (Bounds.address_space, Bounds.address_space))
            end = _end(dict(fields), times)
        except BaseException as error:
            end = f"{type(error).__name__}: {str(error)[:100]}{_places(error)}"
        finally:
            times.append(time.process_time())
            longest = max(after - before for before, after in pairwise(times))
            os.write(writing, json.dumps([end[:1000], longest]).encode())
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        text = pipe.read()
    _, _, used = os.wait4(child, 0)
    both = used.ru_utime + used.ru_stime
    end, longest = json.loads(text) if text else ("killed", both)
    return Flown(number, end, longest, both, used.ru_maxrss * 1024)


def _beside_ordinary(run: Flown, fields: dict[str, Any]) -> Flown:
    """The model flown up to three times more, until a run takes no longer than `Bounds.ordinary` ordinary flights."""
    from slowness import slowness

    for _ in range(3):
        before = flown(0, ORDINARY)
        run = flown(run.number, fields)
        ordinary = Bounds.ordinary * max(before.seconds, flown(0, ORDINARY).seconds)
        slow = slowness()
        run = replace(run, allowed=max(Bounds.seconds * slow, min(ordinary, Bounds.most * slow)))
        if run.seconds <= run.allowed:
            break
    return run


def _places(error: BaseException) -> str:
    import traceback

    return " at {0.filename}:{0.lineno}".format(traceback.extract_tb(error.__traceback__)[-1])


def _end(fields: dict[str, Any], times: list[float]) -> str:
    from singimpact.impact_oscillator import ImpactOscillator
    from singimpact.inputs import InputError

    tau, v = fields.pop("state")
    try:
        osc = ImpactOscillator(**fields)
        step = osc.impact_map(tau, v)
        times.append(time.process_time())
        hit = osc.first_hit(tau, v)
    except InputError as error:
        return f"refused: {error}"
    if step.status != hit.status:
        return f"two statuses, {int(step.status)} and {int(hit.status)}"
    return f"status {int(step.status)} {int(step.cause)}"


def prepare() -> None:
    """Load what every flight loads, and let nothing compile: neither here nor in a process beside."""
    from singimpact.flights import Machine
    from singimpact.impact_oscillator import ImpactOscillator

    def compiled(_self: Machine, name: str) -> Any:
        raise AssertionError(f"{name} is compiled for a first call")

    Machine.compile_here = compiled  # type: ignore[method-assign]
    for f in ("x + x**3/5", "x"):
        ImpactOscillator(f, "cos(2*t)", "0.3", "0.5").impact_map(0.3, [0.1, 0.2], digits=None)


def main() -> int:
    """The command."""
    options = _options()
    if options.show is not None:
        print(model(options.seed, options.show))
        return 0
    os.environ["SINGIMPACT_CACHE"] = "off"  # what others compiled would make an ordinary flight a fast one
    prepare()
    start, found = time.monotonic(), []
    numbers = range(options.models) if options.only is None else options.only
    for number in numbers:
        fields = model(options.seed, number)
        each = flown(number, fields)
        if each.seconds > each.allowed:  # a busy machine takes more CPU time for the same work
            each = _beside_ordinary(each, fields)
        found.append(each)
        if each.fault or options.only:
            print(
                f"{each.number}: {each.seconds:.2f} s of {each.allowed:.2f}, {each.memory >> 20} MB, {each.end[:300]}",
                flush=True,
            )
    print(", ".join(f"{count} {end}" for end, count in Counter(run.end.split(":")[0] for run in found).most_common()))
    slowest = sorted(found, key=lambda run: -run.seconds)[:8]
    print("slowest calls:", ", ".join(f"{run.number} {run.seconds:.2f} s ({run.end[:30]})" for run in slowest))
    print(f"longest process: {max(each.both for each in found):.2f} s")
    print(f"largest: {max(each.memory for each in found) >> 20} MB")
    faults = sum(run.fault for run in found)
    print(f"{len(found)} models, seed {options.seed}, {time.monotonic() - start:.0f} s; faults: {faults or 'none'}")
    return 1 if faults else 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=int, default=480)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, nargs="+")
    parser.add_argument("--show", type=int)
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
