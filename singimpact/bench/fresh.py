"""Statements timed in a process of their own: a library's cache and a warm allocator flatter a second run."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass
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
spent, most = spent_so_far() - start, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
{after}
print(json.dumps([spent, (most - base) / 1024, answer]))
"""


@dataclass(frozen=True)
class Cost:
    """CPU seconds (with those of children that have ended) and megabytes of what was timed, and the `answer` given."""

    seconds: float
    megabytes: float
    answer: Any


def cost(timed: str, before: str = "", after: str = "answer = None", around: dict[str, str] | None = None) -> Cost:
    """Run `before`, `timed` and `after` in a fresh process; `after` sets `answer` to something JSON can say.

    Examples
    --------
    >>> cost("x = 2 + 2", after="answer = x").answer
    4
    """
    paths = [str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH", "")]
    given = {**os.environ, "PYTHONPATH": os.pathsep.join(paths), **(around or {})}
    text = AROUND.format(before=before, timed=timed, after=after)
    done = subprocess.run([sys.executable, "-c", text], env=given, capture_output=True, text=True, check=True)
    return Cost(*json.loads(done.stdout))
