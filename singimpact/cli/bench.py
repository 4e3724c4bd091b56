"""`singimpact bench`: run time against error beside what a user would pick instead."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import click

from singimpact.cli.columns import columns
from singimpact.cli.output import as_json_text, emit, output_options
from singimpact.inputs import unknown
from singimpact.progress import ProgressLine

GROUPS = ("map",)


@click.command(short_help="run time against error, beside other tools")
@click.argument("groups", metavar="[GROUP]...", nargs=-1)
@output_options
def command(groups: tuple[str, ...], as_json: bool, output: str | None) -> None:
    """Measure in one run: `map`, the impact map on the reference states. CPU time, compile time left out."""
    for group in groups:
        if group not in GROUPS:
            raise unknown("group", group, GROUPS)
    from singimpact.bench.grid_speed import compare_grid
    from singimpact.bench.map_speed import compare, ratios

    with ProgressLine() as line:
        done = iter(range(1, 100))
        rows = compare(told=lambda text: line.show(next(done), 9, text))
        line.show(next(done), 9, "grid")
        grid = compare_grid()
    if as_json:
        told: dict[str, Any] = {"flights": [asdict(row) for row in rows], "grid": [asdict(row) for row in grid]}
        emit(as_json_text(told), output)
        return
    times = ratios(rows)
    header = ["family", "regime", "method", "microseconds", "wrong", "times singimpact"]
    cells = [
        [row.family, row.regime, row.method, f"{row.microseconds:.3f}", f"{row.wrong}/{row.of}",
         f"{times[row.family, row.regime, row.method]:.1f}" if (row.family, row.regime, row.method) in times else ""]
        for row in rows if row.of
    ]  # fmt: skip
    emit(columns(header, cells) + "\n\n" + _grid_table(grid), output)


def _grid_table(grid: list[Any]) -> str:
    own = grid[0].millions_a_second
    cells = [[row.method, f"{row.states} x {row.impacts}", f"{row.millions_a_second:.3f}",
              f"{own / row.millions_a_second:.1f}"] for row in grid]  # fmt: skip
    return columns(["grid", "states x impacts", "million impacts/s", "singimpact is faster by"], cells)
