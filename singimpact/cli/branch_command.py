"""`singimpact branch`: branches of periodic orbits over a parameter, with their events."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from singimpact.cli.model_options import (
    model_options,
    orbit_options,
    over_option,
    take_branches,
    take_ends,
    take_model,
    take_orbits,
)
from singimpact.cli.output import (
    choice_option,
    columns,
    csv_option,
    give,
    picture_option,
    save,
    whole_option,
)
from singimpact.result import one_table
from singimpact.store import write_table

if TYPE_CHECKING:
    from singimpact.branches.branch import Branch
    from singimpact.branches.orbits import PeriodicOrbit


@click.command()
@model_options
@orbit_options
@over_option
@click.option("--from", "low", metavar="NUMBER", help="Its least value.  [default: half of the model's value]")
@click.option("--to", "high", metavar="NUMBER", help="Its largest value.  [default: 1.5 times the model's]")
@whole_option("--points", 2, 1_000_000, "At most, each way.", 2000)
@choice_option("--height", ["v", "phase"], "Vertical axis of the picture.", "v")
@csv_option("branch, parameter, states, multipliers, ...")
@picture_option()
@click.option("--json", "as_json", is_flag=True, help="Give points and events as JSON.")
def command(
    orbit: tuple[str, int],
    start: tuple[str, str] | None,
    over: str,
    height: str,
    csv: str | None,
    output: str | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Follow orbits of N impacts, or of a word of walls, in K periods as a parameter changes.

    Prints folds, period doublings, tori, pitchforks, grazes and hidden impacts, and the end of each branch.
    """
    ends, points = take_ends(options.pop("low"), options.pop("high")), options.pop("points")
    model = take_model(options)
    branches = take_branches(take_orbits(model, orbit, start), over, ends, points)
    if csv is not None:
        write_table(csv, one_table({"branch": number, **branch.table()} for number, branch in enumerate(branches, 1)))
    if output is not None:
        from singimpact.scenes import new_axes, plot

        save(plot(branches, new_axes(7.2, 4.8), height=height).figure, output)
    values = {"model": model.to_dict(), "over": over, "branches": [branch.as_dict() for branch in branches]}
    give(values, shown(branches), as_json)


def shown(branches: list[Branch]) -> str:
    """Branches as text: a table of events, then the end of each branch."""
    parts = []
    for number, branch in enumerate(branches, 1):
        ends = f"{branch.over} from {branch.parameter.min():.9g} to {branch.parameter.max():.9g}"
        parts.append(f"branch {number}: ({branch.impacts}, {branch.k}) orbits, {len(branch)} points, {ends}")
        rows = [
            [event.kind, f"{event.parameter:.15g}", *state(event.orbit), "" if event.orbit.visible else "virtual"]
            for event in branch.events
        ]
        if rows:
            parts.append(columns(["event", branch.over, "tau", "v", ""], rows))
        parts += [f"  {note}" for note in branch.notes]
    return "\n".join(parts)


def state(orbit: PeriodicOrbit) -> list[str]:
    """Phase and velocity of the weakest impact of an orbit, 12 digits."""
    weakest = min(range(len(orbit.v)), key=lambda i: float(orbit.v[i]))
    return [f"{float(orbit.tau[weakest]):.12g}", f"{float(orbit.v[weakest]):.12g}"]
