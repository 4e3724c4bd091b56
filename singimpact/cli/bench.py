"""`singimpact bench`: run time against error beside what a user would pick instead."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import click

from singimpact.cli.columns import columns
from singimpact.cli.output import as_json_text, emit, output_options
from singimpact.inputs import unknown
from singimpact.progress import ProgressLine

GROUPS = ("map", "series")


@click.command(short_help="run time against error, beside other tools")
@click.argument("groups", metavar="[GROUP]...", nargs=-1)
@output_options
def command(groups: tuple[str, ...], as_json: bool, output: str | None) -> None:
    """Measure in one run: `map`, the impact map on the reference states; `series`, the exact series. CPU time."""
    for group in groups:
        if group not in GROUPS:
            raise unknown("group", group, GROUPS)
    told: dict[str, Any] = {}
    texts = []
    for group in dict.fromkeys(groups or GROUPS):
        data, text = _map() if group == "map" else _series()
        told |= data
        texts.append(text)
    emit(as_json_text(told) if as_json else "\n\n".join(texts), output)


def _map() -> tuple[dict[str, Any], str]:
    """The impact map, compile time left out."""
    from singimpact.bench.grid_speed import compare_grid
    from singimpact.bench.map_speed import compare, ratios

    with ProgressLine() as line:
        done = iter(range(1, 100))
        rows = compare(told=lambda text: line.show(next(done), 9, text))
        line.show(next(done), 9, "grid")
        grid = compare_grid()
    times = ratios(rows)
    header = ["family", "regime", "method", "microseconds", "wrong", "times singimpact"]
    cells = [
        [row.family, row.regime, row.method, f"{row.microseconds:.3f}", f"{row.wrong}/{row.of}",
         f"{times[row.family, row.regime, row.method]:.1f}" if (row.family, row.regime, row.method) in times else ""]
        for row in rows if row.of
    ]  # fmt: skip
    told = {"flights": [asdict(row) for row in rows], "grid": [asdict(row) for row in grid]}
    return told, columns(header, cells) + "\n\n" + _grid_table(grid)


def _series() -> tuple[dict[str, Any], str]:
    """The exact series, each task in a process of its own."""
    from singimpact.bench.series import TASKS, measured

    with ProgressLine() as line:
        found = []
        for at, task in enumerate(TASKS, 1):
            line.show(at, len(TASKS), task.name)
            found.append(measured(task))
    told = [{"task": x.task.name, "seconds": x.seconds, "megabytes": x.megabytes, "limit": x.task.limit} for x in found]
    return {"series": told}, "\n".join(x.line() for x in found)


def _grid_table(grid: list[Any]) -> str:
    own = grid[0].millions_a_second
    cells = [[row.method, f"{row.states} x {row.impacts}", f"{row.millions_a_second:.3f}",
              f"{own / row.millions_a_second:.1f}"] for row in grid]  # fmt: skip
    return columns(["grid", "states x impacts", "million impacts/s", "singimpact is faster by"], cells)
