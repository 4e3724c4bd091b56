"""`bench start`: the first impact in a new process whose disk cache is warm, beside a cached kernel of one line."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from singimpact.bench.fresh import cost
from singimpact.bench.measuring import Case, Effort, Method, Timed

LINE = """
import numba
@numba.njit(cache=True)
def twice(x):
    return 2 * x
"""
CALLS = {
    "numba, a kernel of one line": "import sys; sys.path.insert(0, {place!r}); import line; line.twice(1.5)",
    "singimpact, linear": "import singimpact; singimpact.linear('2.8', 0, '0.8').impact_map(0.9, 0.1)",
    "singimpact, cubic": "from singimpact import ImpactOscillator; "
    "ImpactOscillator('x + xdot/10 + 3*x**3/10', 'cos(1.7*t)', '0.3', '0.6').impact_map(0.9, 0.1)",
}


def cases(effort: Effort) -> Iterator[Case]:  # noqa: ARG001
    """CPU time from the first import to the first result; a first round fills the cache."""
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / "line.py").write_text(LINE, encoding="utf-8")
        around = {"SINGIMPACT_CACHE": place} if os.environ.get("SINGIMPACT_CACHE") == "off" else {}
        for code in CALLS.values():
            cost(code.format(place=place), around=around)
        methods = [Method(name, "disk cache warm", partial(_first, code.format(place=place), around))
                   for name, code in CALLS.items()]  # fmt: skip
        yield Case("first call in a new process", methods)


def _first(code: str, around: dict[str, str]) -> Timed:
    return Timed(cost(code, around=around).seconds, [None])
