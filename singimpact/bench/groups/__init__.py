"""The groups of `singimpact bench`: each a function from an effort to its cases, found when it is asked for.

Files: `flights` (`bench map`), `chatter`, `threshold`, `fixed_points`, `series`, `emitted`, `figures`, `growth` (how
cost grows), `grid` (orbits of many states), `start` (a new process).
A new group: a file with a function `cases`, and its name here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from singimpact.bench.groups import (
    chatter,
    emitted,
    figures,
    fixed_points,
    flights,
    grid,
    growth,
    series,
    start,
    threshold,
)
from singimpact.bench.measuring import Case, Effort, Measured, measure

GROUPS: dict[str, Callable[[Effort], Iterator[Case]]] = {
    "map": flights.cases,
    "chatter": chatter.cases,
    "threshold": threshold.cases,
    "series": series.cases,
    "fixed-points": fixed_points.cases,
    "emitted": emitted.cases,
    "figures": figures.cases,
    "growth": growth.cases,
    "grid": grid.cases,
    "start": start.cases,
}
SLOW = ("grid", "start")  # compile in every fresh cache what a first look does not need


def usual(effort: Effort) -> list[str]:
    """The groups that are measured when none is named."""
    return [name for name in GROUPS if not (effort.quick and name in SLOW)]


def measured(name: str, effort: Effort, told: Callable[[str], None] = lambda _: None) -> Measured:
    """All rows of a group; `told` hears the name of each case before it is measured."""
    found = Measured(name)
    for case in GROUPS[name](effort):
        told(f"{name}: {case.name}")
        found.rows += measure(name, case, effort)
        found.skipped += [peer for peer in case.skipped if peer not in found.skipped]
    return found
