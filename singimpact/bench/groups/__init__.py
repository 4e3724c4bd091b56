"""The groups of `singimpact bench`: each a function from an effort to its cases, found when it is asked for.

Files: `impact_map` (`bench map`), `orbit`, `regimes` (hard states), `chatter`, `threshold`, `fixed_points`, `series`,
`emitted`, `figures`, `growth` (how cost grows), `commands` (the command line and series in symbols), `sweep` (many
cases), `scale` (large arrays), `branches`
(periodic orbits), `start` (a new process, a new cache folder).
A new group: a file with a function `cases`, and its name here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from singimpact.bench.groups import (
    branches,
    chatter,
    commands,
    emitted,
    figures,
    fixed_points,
    growth,
    impact_map,
    orbit,
    regimes,
    scale,
    series,
    start,
    sweep,
    threshold,
)
from singimpact.bench.measuring import Case, Effort, Measured, measure

GROUPS: dict[str, Callable[[Effort], Iterator[Case]]] = {
    "map": impact_map.cases,
    "orbit": orbit.cases,
    "regimes": regimes.cases,
    "chatter": chatter.cases,
    "threshold": threshold.cases,
    "series": series.cases,
    "fixed-points": fixed_points.cases,
    "emitted": emitted.cases,
    "figures": figures.cases,
    "growth": growth.cases,
    "commands": commands.cases,
    "sweep": sweep.cases,
    "scale": scale.cases,
    "branches": branches.cases,
    "start": start.cases,
}
SLOW = ("start",)  # compiles in new cache folders, again and again


def usual(effort: Effort) -> list[str]:
    """The groups that are measured when none is named."""
    return [name for name in GROUPS if not (effort.quick and name in SLOW)]


def measured(name: str, effort: Effort, told: Callable[[str], None] = lambda _: None) -> Measured:
    """All rows of a group; `told` is called with the name of each case before it is measured."""
    found = Measured(name)
    for case in GROUPS[name](effort):
        told(f"{name}: {case.name}")
        found.rows += measure(name, case, effort)
        found.skipped += [peer for peer in case.skipped if peer not in found.skipped]
        found.notes += [note for note in case.notes if note not in found.notes]
    return found
