"""`singimpact bench`: run time against error beside what a user would pick instead."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

import click

from singimpact.cli.columns import columns
from singimpact.cli.output import as_json_text, emit, output_options
from singimpact.inputs import unknown
from singimpact.progress import ProgressLine

GROUPS = ("map", "series", "states")
USUAL = ("map", "series")


@click.command(short_help="run time against error, beside other tools")
@click.argument("groups", metavar="[GROUP]...", nargs=-1)
@click.option("--states", type=click.IntRange(1, 10**9), default=100_000, show_default=True, help="How many states.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Which states.")
@click.option("--workers", type=click.IntRange(1, 1024), help="Processes; as many as there are cores without it.")
@click.option("--keep", metavar="FILE.npz", help="Keep results there as they come, and resume from it.")
@output_options
def command(
    groups: tuple[str, ...], states: int, seed: int, workers: int | None, keep: str | None, as_json: bool,
    output: str | None,
) -> None:  # fmt: skip
    """Measure in one run: `map`, the impact map on the reference states; `series`, the exact series. CPU time.

    `states` flies random states and the same ones by a slow solver of 60 digits; the other options are its own. Exit
    code 1 when an impact is wrong.
    """
    for group in groups:
        if group not in GROUPS:
            raise unknown("group", group, GROUPS)
    told: dict[str, Any] = {}
    texts = []
    made: dict[str, Callable[[], tuple[dict[str, Any], str]]] = {
        "map": _map,
        "series": _series,
        "states": lambda: _states(states, seed, workers, keep),
    }
    for group in dict.fromkeys(groups or USUAL):
        data, text = made[group]()
        told |= data
        texts.append(text)
    emit(as_json_text(told) if as_json else "\n\n".join(texts), output)
    if any(row["wrong"] for row in told.get("states", [])):
        sys.exit(1)


def _map() -> tuple[dict[str, Any], str]:
    """The impact map, compile time left out."""
    from singimpact.bench.grid_speed import compare_grid
    from singimpact.bench.map_speed import compare, ratios
    from singimpact.bench.warm_start import starts

    with ProgressLine() as line:
        done = iter(range(1, 100))
        rows = compare(told=lambda text: line.show(next(done), 10, text))
        line.show(next(done), 10, "grid")
        grid = compare_grid()
        line.show(next(done), 10, "first calls")
        first = starts()
    times = ratios(rows)
    header = ["family", "regime", "method", "microseconds", "wrong", "times singimpact"]
    cells = [
        [row.family, row.regime, row.method, f"{row.microseconds:.3f}", f"{row.wrong}/{row.of}",
         f"{times[row.family, row.regime, row.method]:.1f}" if (row.family, row.regime, row.method) in times else ""]
        for row in rows if row.of
    ]  # fmt: skip
    told: dict[str, list[Any]] = {"flights": [*rows], "grid": [*grid], "first_calls": [*first]}
    text = "\n\n".join([columns(header, cells), _grid_table(grid), _start_table(first)])
    return {name: [asdict(row) for row in part] for name, part in told.items()}, text


def _start_table(first: list[Any]) -> str:
    cells = [[row.what, f"{row.seconds:.2f}", f"{row.more:.2f}"] for row in first]
    return columns(["first call in a new process, disk cache warm", "seconds", "more than numba's own"], cells)


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


def _states(states: int, seed: int, workers: int | None, keep: str | None) -> tuple[dict[str, Any], str]:
    """Random states against the truth."""
    from singimpact.bench.states import check
    from singimpact.cli.sweep import process_pool

    with process_pool(workers) as pool:
        rows = check(states, seed, pool, keep)
    header = ["states", "flown", "wrong", "unresolved", "flight time, worst", "v, worst"]
    cells = [[row.kind, str(row.states), str(row.wrong), str(row.unresolved), f"{row.time_error:.3f}",
              f"{row.velocity_error:.3f}"] for row in rows]  # fmt: skip
    text = columns(header, cells) + "\nErrors in units of max(1e-14, 10 kappa epsilon), for v of 1e-13."
    for row in rows:
        for tau, v, depth, bound in row.open:
            text += f"\nunresolved, {row.kind}: tau {tau!r}, v {v!r}, depth {depth:.3g}, known to {bound:.3g}"
    return {"states": [asdict(row) for row in rows]}, text


def _grid_table(grid: list[Any]) -> str:
    own = grid[0].millions_a_second
    cells = [[row.method, f"{row.states} x {row.impacts}", f"{row.millions_a_second:.3f}",
              f"{own / row.millions_a_second:.1f}"] for row in grid]  # fmt: skip
    return columns(["grid", "states x impacts", "million impacts/s", "singimpact is faster by"], cells)
