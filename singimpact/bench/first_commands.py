"""CPU of a user's first commands, each in a new cache folder, as ratios to a reference computation of the same run.

    python -m singimpact.bench.first_commands            exits with 1 where a ratio exceeds its stored one by half
    python -m singimpact.bench.first_commands --store    stores the ratios

A busy or slow machine slows the reference too, so that ratios hardly depend on it. CPU seconds are those of the command
and of all its descendants. The process that compiles outlives the command: a supervisor adopts it (Linux:
PR_SET_CHILD_SUBREAPER) and waits for it, so that RUSAGE_CHILDREN contains it. On other systems its seconds are not
counted.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

STORED = Path(__file__).parent / "data" / "first_commands.json"
MOST = 1.5
"""A ratio may exceed the stored one by this factor."""
LINEAR = ("--omega", "2.8", "--clearance", "0", "--restitution", "0.8", "--tau", "0.9", "--v", "0.005")
DUFFING = 'f = "x + 0.1*xdot + 0.3*x**3"\ng = "cos(1.7*t)"\nclearance = 0.3\nrestitution = 0.6\n'
COMMANDS = {
    "verify": ("verify",),
    "first picture": ("orbit", *LINEAR, "-o", "orbit.png"),
    "first own model": ("orbit", "--model", "model.toml", "--tau", "0.9", "--v", "0.005", "-o", "orbit.png"),
}
REFERENCE = """
import numpy as np
total = 0.0
for k in range(1, 6_000_000):
    total += (k % 7) / k
a = np.linspace(0, 1, 200_000)
for k in range(400):
    total += float(np.sum(np.sin(a + k)))
"""
SUPERVISOR = """
import ctypes, json, os, resource, subprocess, sys
if sys.platform == "linux":
    ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER: adopt orphans of descendants
code = subprocess.run(sys.argv[1:], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL).returncode
while True:
    try:
        os.wait()
    except ChildProcessError:
        break
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([code, used.ru_utime + used.ru_stime]))
"""


class First(NamedTuple):
    """CPU seconds of a command with its descendants, its ratio to the reference, and the stored ratio."""

    name: str
    seconds: float
    ratio: float
    stored: float

    @property
    def over(self) -> bool:
        """Whether the ratio exceeds the stored one by half."""
        return not self.ratio <= MOST * self.stored


def cpu_of(command: list[str], directory: str) -> float:
    """CPU seconds of a command and all its descendants, run in a folder with a new cache.

    Raises
    ------
    subprocess.CalledProcessError : the command fails.

    Examples
    --------
    >>> cpu_of([sys.executable, "-c", "sum(range(10**6))"], ".") > 0
    True
    """
    paths = [str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")]
    around = {
        **os.environ,
        "SINGIMPACT_CACHE": str(Path(directory) / "cache"),
        "PYTHONPATH": os.pathsep.join(paths),
        "OPENBLAS_NUM_THREADS": "1",
    }
    done = subprocess.run(
        [sys.executable, "-c", SUPERVISOR, *command],
        cwd=directory,
        env=around,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    code, seconds = json.loads(done.stdout)
    if code:
        raise subprocess.CalledProcessError(code, command)
    return float(seconds)


def measured() -> list[First]:
    """The reference and the commands in turn; the reference again at the end, and their mean counts."""
    stored = json.loads(STORED.read_text()) if STORED.is_file() else {}
    with tempfile.TemporaryDirectory() as place:
        reference = [cpu_of([sys.executable, "-c", REFERENCE], place)]
        spent = {name: _in_new_folder(command) for name, command in COMMANDS.items()}
        reference.append(cpu_of([sys.executable, "-c", REFERENCE], place))
    unit = sum(reference) / len(reference)
    rows = [First(name, seconds, seconds / unit, stored.get(name, 0.0)) for name, seconds in spent.items()]
    return [First("reference", unit, 1.0, 1.0), *rows]


def _in_new_folder(command: tuple[str, ...]) -> float:
    with tempfile.TemporaryDirectory() as place:
        Path(place, "model.toml").write_text(DUFFING)
        return cpu_of([sys.executable, "-m", "singimpact", *command], place)


def main() -> int:
    """Print the rows; 1 where one is over."""
    rows = measured()
    for row in rows:
        limit = "" if row.name == "reference" else f", stored {row.stored:.2f}{', OVER BY HALF' if row.over else ''}"
        print(f"{row.name}: {row.seconds:.2f} s of CPU, {row.ratio:.2f} times the reference{limit}")
    if "--store" in sys.argv:
        STORED.write_text(json.dumps({row.name: round(row.ratio, 2) for row in rows[1:]}, indent=1) + "\n")
        return 0
    return int(any(row.over for row in rows))


if __name__ == "__main__":
    sys.exit(main())
