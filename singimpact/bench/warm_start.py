"""The first impact in a new process whose disk cache is warm, beside numba's own start-up: a cached one-line kernel."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

LINE = """
import numba
@numba.njit(cache=True)
def twice(x):
    return 2 * x
"""
FIRST = """
import time
start = time.process_time()
{}
print(time.process_time() - start)
"""
CALLS = {
    "numba, a cached kernel of one line": "import line; line.twice(1.5)",
    "linear oscillator": "import singimpact; singimpact.linear('2.8', 0, '0.8').impact_map(0.9, 0.1)",
    "cubic oscillator": "from singimpact import ImpactOscillator; "
    "ImpactOscillator('x + xdot/10 + 3*x**3/10', 'cos(1.7*t)', '0.3', '0.6').impact_map(0.9, 0.1)",
}


@dataclass(frozen=True)
class Start:
    """CPU seconds from the first import to the first result; `more` than numba's own."""

    what: str
    seconds: float
    more: float


def starts(repeats: int = 3) -> list[Start]:
    """Each call in processes of its own: one fills the cache, the best of the others counts."""
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / "line.py").write_text(LINE, encoding="utf-8")
        found = {what: min([_seconds(code, place) for _ in range(repeats + 1)][1:]) for what, code in CALLS.items()}
    own = next(iter(found.values()))
    return [Start(what, seconds, seconds - own) for what, seconds in found.items()]


def _seconds(code: str, place: str) -> float:
    paths = os.pathsep.join([place, str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")])
    caches = {"SINGIMPACT_CACHE": place, "NUMBA_CACHE_DIR": str(Path(place) / "numba")}
    around = {**os.environ, **caches, "PYTHONPATH": paths}
    done = subprocess.run(
        [sys.executable, "-c", FIRST.format(code)], env=around, capture_output=True, text=True, check=True
    )
    return float(done.stdout)
