"""`singimpact bifurcation`: settled orbits for many values of a parameter."""

from typing import Any

import click

from singimpact.cli.model_options import model_options, over_option, take_branches, take_model, take_orbits
from singimpact.cli.output import choice_option, give, picture_option, save, whole_option


@click.command()
@model_options
@over_option
@click.option("--from", "low", metavar="NUMBER", required=True, help="Its first value.")
@click.option("--to", "high", metavar="NUMBER", required=True, help="Its last value.")
@whole_option("--points", 2, 100_000, "Number of values.", 300)
@click.option("--start", nargs=2, metavar="TAU V", default=("0", "0.1"), show_default=True, help="The first state.")
@whole_option("--impacts", 1, 1_000_000, "Impacts for each value.", 200)
@click.option(
    "--kept",
    "last_events",
    type=click.IntRange(1, 100_000),
    default=60,
    show_default=True,
    help="Last impacts of each that are drawn.",
)
@choice_option("--direction", ["up", "down", "both"], "Start each orbit from the last state of the one before.")
@click.option(
    "--follow",
    nargs=2,
    type=int,
    multiple=True,
    metavar="N K",
    help="Also draw the branches of the model's orbits of N impacts in K periods; may be repeated.",
)
@whole_option("--workers", 1, 1024, "Processes.  [default: one for each core]")
@click.option("--keep", metavar="FILE", help="Store results in this file (.npz or .zarr), and resume from it.")
@picture_option(required=True)
@click.option("--json", "as_json", is_flag=True, help="Give phase, v and end of chatter for each value as JSON.")
def command(
    over: str,
    low: str,
    high: str,
    points: int,
    start: tuple[str, str],
    impacts: int,
    last_events: int,
    direction: str | None,
    follow: tuple[tuple[int, int], ...],
    workers: int | None,
    keep: str | None,
    output: str,
    as_json: bool,
    **options: str | None,
) -> None:
    """The last impacts of one orbit for each value of a parameter.

    amplitude, damping, stiffness and phase move without being named before. Drawn are velocities and phases; with
    --follow also the periodic orbits through the model's own value, stable and unstable ones.
    """
    model = take_model(options)
    from singimpact.case_pools import processes
    from singimpact.dynamics.bifurcation_diagram import bifurcation
    from singimpact.scenes.branch_picture import bifurcation_sheet

    # in a direction each orbit begins where the one before ends: there is nothing to share out
    with processes(workers if direction is None else None) as pool:
        settings: dict[str, Any] = {"start": start, "impacts": impacts, "kept": last_events, "direction": direction}
        diagram = bifurcation(model, over, (low, high), points, **settings, executor=pool, output=keep)
    branches = [
        branch for n, k in follow for branch in take_branches(take_orbits(model, (n, k), None), over, (low, high), 2000)
    ]
    save(bifurcation_sheet(diagram, branches), output)
    rows = zip(diagram.values.tolist(), diagram.events.tolist(), strict=True)
    left = int((~diagram.settled).sum())
    open_ = f"; {left} of them without a period seen in at most {diagram.settle} impacts" if left else ""
    text = f"{output}: {points} values of {over}, {last_events} events of each{open_}"
    give({"over": over, "cases": [{"value": value, "events": branch} for value, branch in rows]}, text, as_json)
