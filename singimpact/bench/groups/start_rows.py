"""`bench start`: what a new process costs that finds object code in the cache folder.

Each row is a process of its own, in a cache folder made for all; the states are others in every process.  CPU seconds
do not hold the time that threads of numpy's linear algebra spend while they wait for work (`fresh.NO_SPINNING`).
"""

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import count

from singimpact.bench.drawn import CLEARANCES, OMEGAS
from singimpact.bench.fresh import Cost, cost
from singimpact.bench.measuring import Aim, Case, Effort, Method, Timed, with_peers
from singimpact.bench.peers import runge_kutta, taylor_events

IMPORT = "import singimpact as si"
MODELS = {
    "linear": f"si.linear({OMEGAS['linear']}, {CLEARANCES['linear']}, 0.8)",
    "Duffing": f"si.ImpactOscillator('x + 0.1*xdot + 0.3*x**3', 'cos(omega*t)', {CLEARANCES['duffing']}, 0.8,"
    f" {{'omega': {OMEGAS['duffing']}}})",
    "linear, a law of its own": f"si.linear({OMEGAS['linear']}, {CLEARANCES['linear']}, '-0.8*v - 0.1*(-v)**1.5')",
}
AIMS = {"linear": (0.8e6, 0.6e6), "Duffing": (2.5e6, 0.8e6), "linear, a law of its own": (1.5e6, 0.6e6)}
"""Microseconds of CPU of the first script in a new cache folder, and of the second."""
LINEAR = MODELS["linear"]
DRAWN = """
import numpy as np
rng = np.random.default_rng({seed})
tau, v = rng.uniform(0, 2, {states}), rng.uniform(0.05, 2, {states})
"""
PEER = """
from singimpact.bench.drawn import Draws
from singimpact.bench.peers import runge_kutta, taylor_events
draw = Draws("linear", "generic", {states})
draw.turn = {seed}
problems = draw().problems()
"""
SEEDS = count()
FEW, MANY = 1000, 100_000


def first_model(family: str) -> str:
    """A user's first lines: the model."""
    return f"{IMPORT}\nosc = {MODELS[family]}"


def first_answer(family: str) -> str:
    """The model and one state."""
    return f"{first_model(family)}\nosc.impact_map({0.1 + next(SEEDS) / 1000}, 0.7)"


def script(family: str, states: int) -> str:
    """The model and an array of states."""
    drawn = DRAWN.format(seed=next(SEEDS), states=states)
    return f"{first_model(family)}\n{drawn}\nosc.impact_map(tau, v)"


@dataclass(frozen=True)
class Script:
    """A script in a new process: what is timed, and what goes before; made anew for every run."""

    timed: Callable[[], str]
    before: str = ""

    def in_folder(self, place: str) -> Cost:
        """Run with the cache in a folder."""
        return cost(self.timed(), self.before, around={"SINGIMPACT_CACHE": place})


def cases(effort: Effort) -> Iterator[Case]:
    """Processes that find object code in the cache folder; what a new folder costs is in the group `limit`.

    A first process of each kind is not counted: it leaves object code, bytecode, and the files in memory.
    """
    with tempfile.TemporaryDirectory() as directory:
        for family in MODELS:
            Script(partial(script, family, MANY)).in_folder(directory)
        yield _warm(effort, directory)


def _warm(effort: Effort, directory: str) -> Case:
    def row(name: str, setting: str, script: Script, aim: Aim = Aim()) -> Method:  # noqa: B008
        return Method(name, setting, partial(_timed, script, directory), aim=aim)

    own = [
        row("singimpact, import", "", Script(lambda: IMPORT)),
        row(
            "singimpact, first model", "after the import", Script(lambda: f"osc = {MODELS['linear']}", IMPORT), Aim(1e4)
        ),
        row("singimpact, first answer", "linear", Script(partial(first_answer, "linear"))),
        row("singimpact, script", f"linear, {FEW} states", Script(partial(script, "linear", FEW)), Aim(0.2e6)),
        row("singimpact, script", f"Duffing, {FEW} states", Script(partial(script, "Duffing", FEW))),
    ]
    for family in MODELS:
        many = Script(partial(script, family, MANY))
        own.append(row("singimpact, script", f"{family}, {MANY} states", many, Aim(AIMS[family][1])))
    sizes = (FEW,) if effort.quick else (FEW, MANY)
    methods, skipped = with_peers(
        own,
        lambda: [_peer("heyoka, terminal event", "taylor_events.stepper('linear')", n, row) for n in sizes],
        lambda: [_peer("scipy DOP853, terminal event", "runge_kutta.stepper('linear', 1e-12)", 100, row)],
    )
    return Case("new process, object code there", methods, skipped=skipped)


def _peer(name: str, stepper: str, states: int, row: Callable[..., Method]) -> Method:
    """The peer's import is timed, that of numpy is not.

    Raises
    ------
    NotInstalled : it is not there.
    """
    peer = taylor_events if name.startswith("heyoka") else runge_kutta
    peer.stepper("linear")
    cost("import heyoka" if peer is taylor_events else "import scipy.integrate")  # leaves its bytecode
    before = PEER.format(states=states, seed=next(SEEDS))
    return row(name, f"linear, {states} states", Script(lambda: f"fly = {stepper}\nfor p in problems: fly(p)", before))


def _timed(script: Script, place: str) -> Timed:
    return Timed(script.in_folder(place).seconds, [None])
