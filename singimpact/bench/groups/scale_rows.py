"""`bench scale`: large arrays: the time of a state, the memory of its results and beside them, threads, interruptions.

Each row is a process of its own, for memory that was used is not seen twice.
"""

from collections.abc import Iterator
from functools import partial

from singimpact.bench.fresh import Cost, cost
from singimpact.bench.measuring import Aim, Case, Effort, Method, Timed

SMALL = 100_000
BYTES, BESIDE, THREADS, HEARD = 80, 200, 1.7, 0.3
"""To reach: bytes a state of results, megabytes beside them, times faster by two threads, seconds until Ctrl-C ends."""
BEFORE = """
import os, signal, sys, threading
import numpy as np
import singimpact as si
osc = si.linear(omega="2.8", clearance=0, restitution="0.8")
rng = np.random.default_rng(7)
tau, v = rng.uniform(0, 100, {count}), rng.uniform(0.01, 1, {count})
osc.impact_map(tau[:300_000], v[:300_000])
osc.iterate(tau[:1000], v[:1000], 2)
"""
MAPPED = "step = osc.impact_map(tau, v{out})"
KEPT = """
answer = [sum(part.nbytes for part in vars(step).values() if isinstance(part, np.ndarray)) / {count},
          sum(part.nbytes for part in vars(step).values() if isinstance(part, np.ndarray)) / 2**20]
"""
PAIRED = """
def wall(parts):
    begun = time.perf_counter()
    work = [threading.Thread(target=osc.iterate, args=(*part, 20)) for part in parts]
    [each.start() for each in work]; [each.join() for each in work]
    return time.perf_counter() - begun
half = {count} // 2
both = (tau[:half], v[:half]), (tau[half:], v[half:])
ratios = [(wall(both[:1]) + wall(both[1:])) / wall(both) for _ in range(5)]
"""
CUT = """
def kick():
    global sent
    sent = time.perf_counter()
    os.kill(os.getpid(), signal.SIGINT)
# a background job of a shell ignores the signal, and so would the flights
signal.signal(signal.SIGINT, signal.default_int_handler)
threading.Timer(0.5, kick).start()
try:
    osc.iterate(tau, v, 1_000_000)
except KeyboardInterrupt:
    heard = time.perf_counter() - sent
"""


def cases(effort: Effort) -> Iterator[Case]:
    """The impact map of a small and of a large array, into arrays of the package and of the caller."""
    count = 1_000_000 if effort.quick else 10_000_000
    many = f"{count:.0e} states".replace("e+0", "e")
    methods = [
        Method(
            "singimpact, impact_map",
            f"{SMALL:.0e} states".replace("e+0", "e"),
            partial(_mapped, SMALL),
            problems=SMALL,
            aim=Aim(1.2),
        ),
        Method("singimpact, impact_map", many, partial(_mapped, count), problems=count, aim=Aim(1.2)),
        Method(
            "singimpact, impact_map",
            f"{many}, out= of memory maps",
            partial(_mapped, count, OUT),
            problems=count,
            aim=Aim(1.2),
        ),
    ]
    yield Case("linear, a state of a large array", methods, notes=_notes(count))


OUT = """, out={name: np.lib.format.open_memmap(f"{folder}/{name}.npy", "w+", "f8", tau.shape)
    for name in ("tau", "v")}"""


def _mapped(count: int, out: str = "") -> Timed:
    return Timed(_cost(count, out).seconds, [])


def _cost(count: int, out: str = "") -> Cost:
    before = BEFORE.format(count=count) + "import tempfile\nfolder = tempfile.mkdtemp()\n"
    return cost(MAPPED.format(out=out), before, KEPT.format(count=count) + "import shutil; shutil.rmtree(folder)\n")


def _notes(count: int) -> list[str]:
    """Sentences, each with what is to be reached and whether it was."""
    measured = _cost(count)
    states_, all_of_them = measured.answer
    beside = measured.megabytes - all_of_them
    notes = [
        f"memory: {states_:.0f} bytes a state of results (at most {BYTES}: {_word(states_ <= BYTES)}), at most "
        f"{max(beside, 0):.0f} MB beside them (at most {BESIDE}: {_word(beside <= BESIDE)})"
    ]
    ratios = cost(PAIRED.format(count=1_000_000), BEFORE.format(count=1_000_000), "answer = ratios").answer
    notes.append(
        f"two threads: {sorted(ratios)[2]:.2f} times as fast as one, best of five {max(ratios):.2f} (at least "
        f"{THREADS}: {_word(max(ratios) >= THREADS)}; other work on the machine counts)"
    )
    heard = cost(CUT, BEFORE.format(count=100_000), "answer = heard").answer
    notes.append(
        f"Ctrl-C during 10^11 impacts ends them after {heard:.3f} s (at most {HEARD}: {_word(heard <= HEARD)})"
    )
    return notes


def _word(reached: bool) -> str:
    return "reached" if reached else "missed"
