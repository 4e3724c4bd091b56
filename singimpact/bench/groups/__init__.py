"""The groups of `singimpact bench`: each a function from an effort to its cases, found when it is asked for."""

from collections.abc import Callable, Iterator

from singimpact.bench.groups import impact_map_rows, limit_rows, public_rows, series_rows
from singimpact.bench.measuring import Case, Effort, Measured, measure

GROUPS: dict[str, Callable[[Effort], Iterator[Case]]] = {
    "public": public_rows.cases,
    "chatter": impact_map_rows.chatter,
    "series": series_rows.cases,
    "regions": public_rows.regions,
    "ensemble": public_rows.ensemble,
    "fit": public_rows.fit,
    "limit": limit_rows.cases,
}


def usual(effort: Effort) -> list[str]:
    """The groups that are measured when none is named; `public` has a page of its own.

    A quick look leaves out `limit`, which begins with new cache folders again and again.
    """
    return [name for name in GROUPS if name != "public" and not (effort.quick and name == "limit")]


def measured(name: str, effort: Effort, told: Callable[[str], None] = lambda _: None) -> Measured:
    """All rows of a group; `told` is called with the name of each case before it is measured."""
    found = Measured(name)
    for case in GROUPS[name](effort):
        told(f"{name}: {case.name}")
        found.rows += measure(name, case, effort)
        found.skipped += [peer for peer in case.skipped if peer not in found.skipped]
    return found
