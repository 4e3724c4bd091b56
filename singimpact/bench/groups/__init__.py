"""The groups of `singimpact bench`: each a function from an effort to its cases, found when it is asked for."""

from collections.abc import Callable, Iterator

from singimpact.bench.groups import (
    branch_rows,
    chatter_rows,
    command_rows,
    emitted_rows,
    fixed_point_rows,
    growth_rows,
    impact_map_rows,
    limit_rows,
    orbit_rows,
    public_rows,
    regime_rows,
    scale_rows,
    series_rows,
    start_rows,
    sweep_rows,
)
from singimpact.bench.measuring import Case, Effort, Measured, measure

GROUPS: dict[str, Callable[[Effort], Iterator[Case]]] = {
    "public": public_rows.cases,
    "map": impact_map_rows.cases,
    "orbit": orbit_rows.cases,
    "regimes": regime_rows.cases,
    "chatter": chatter_rows.cases,
    "threshold": chatter_rows.threshold_cases,
    "series": series_rows.cases,
    "fixed-points": fixed_point_rows.cases,
    "emitted": emitted_rows.cases,
    "growth": growth_rows.cases,
    "commands": command_rows.cases,
    "sweep": sweep_rows.cases,
    "scale": scale_rows.cases,
    "branches": branch_rows.cases,
    "start": start_rows.cases,
    "limit": limit_rows.cases,
}
SLOW = ("start", "limit")  # new cache folders, again and again


def usual(effort: Effort) -> list[str]:
    """The groups that are measured when none is named; `public` repeats cases of others."""
    return [name for name in GROUPS if name != "public" and not (effort.quick and name in SLOW)]


def measured(name: str, effort: Effort, told: Callable[[str], None] = lambda _: None) -> Measured:
    """All rows of a group; `told` is called with the name of each case before it is measured."""
    found = Measured(name)
    for case in GROUPS[name](effort):
        told(f"{name}: {case.name}")
        found.rows += measure(name, case, effort)
        found.skipped += [peer for peer in case.skipped if peer not in found.skipped]
        found.notes += [note for note in case.notes if note not in found.notes]
    return found
