"""Statements timed in a process of their own: a library's cache and a warm allocator flatter a second run.

Threads of numpy's linear algebra, which nothing here uses, are not started: see `NO_SPINNING`.
"""

import atexit
import json
import os
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

AROUND = """
import json, resource, time
def spent_so_far():
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + ended.ru_utime + ended.ru_stime
{before}
base, start = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, spent_so_far()
{timed}
spent = spent_so_far() - start
most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
{after}
print(json.dumps([spent, (most - base) / 1024, answer]))
"""


@dataclass(frozen=True)
class Cost:
    """CPU seconds (with those of children that have ended) and megabytes of what was timed, and the `answer` given."""

    seconds: float
    megabytes: float
    answer: Any


# numpy starts a thread for each core. They spin while they wait: 80 ms of CPU on two cores that no script asked for. A
# user may set the same variable.
NO_SPINNING = {"OPENBLAS_NUM_THREADS": "1"}


@lru_cache(maxsize=1)
def _bytecode() -> str:
    """A folder for bytecode, where it must not be written beside the sources."""
    place = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, place, ignore_errors=True)
    return place


def cost(timed: str, before: str = "", after: str = "answer = None", around: dict[str, str] | None = None) -> Cost:
    """Run `before`, `timed` and `after` in a fresh process; `after` sets `answer` to something JSON can say.

    Examples
    --------
    >>> cost("x = 2 + 2", after="answer = x").answer
    4
    """
    paths = [str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")]
    environment = {**NO_SPINNING, **os.environ, "PYTHONPATH": os.pathsep.join(paths), **(around or {})}
    if environment.pop("PYTHONDONTWRITEBYTECODE", None):  # an installed package has its bytecode
        environment["PYTHONPYCACHEPREFIX"] = _bytecode()
    text = AROUND.format(before=before, timed=timed, after=after)
    done = subprocess.run([sys.executable, "-c", text], env=environment, capture_output=True, text=True, check=True)
    return Cost(*json.loads(done.stdout))
