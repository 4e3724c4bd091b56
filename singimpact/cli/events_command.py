"""`singimpact events`: curves of grazes, folds and doublings in two parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from singimpact.branches.events import KINDS
from singimpact.cli.model_options import model_options, orbit_options, take_branches, take_ends, take_model, take_orbits
from singimpact.cli.output import (
    columns,
    csv_option,
    give,
    picture_option,
    save,
    whole_option,
)
from singimpact.inputs import InputError
from singimpact.oscillator.moving_number import value_of
from singimpact.result import one_table
from singimpact.store import write_table

if TYPE_CHECKING:
    from singimpact.branches.branch import Branch
    from singimpact.branches.event_curve import EventCurve
    from singimpact.branches.events import Event

NEAR = 0.05  # an event that is nearer to a step of a curve than this part of the step is on the curve
FOLLOWED = tuple(kind.name for kind in KINDS if kind.look is not None)


@click.command()
@model_options
@orbit_options
@click.option(
    "--over",
    nargs=2,
    metavar="A B",
    default=("clearance", "restitution"),
    show_default=True,
    help="Two parameters; the orbits are followed over A first.",
)
@click.option("--from", "low", nargs=2, metavar="A B", help="Their least values.  [default: half of the model's]")
@click.option("--to", "high", nargs=2, metavar="A B", help="Their largest values.")
@click.option(
    "--event", "kinds", type=click.Choice(FOLLOWED), multiple=True, help="Events of this kind.  [default: all]"
)
@whole_option("--index", 1, None, "Only the event with this number in the list of `branch`.")
@whole_option("--points", 2, 1_000_000, "At most, each way.", 1000)
@csv_option("curve, kind, both parameters, states, visible.")
@picture_option()
@click.option("--json", "as_json", is_flag=True, help="Give points and points of codimension two as JSON.")
def command(
    orbit: tuple[str, int],
    start: tuple[str, str] | None,
    over: tuple[str, str],
    kinds: tuple[str, ...],
    csv: str | None,
    output: str | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Follow events of the orbits of N impacts in K periods as curves in the plane of two parameters.

    Prints the points of codimension two: resonant grazes, cusps, two grazes at once, and others.
    """
    ends, points = take_ends(options.pop("low"), options.pop("high")), options.pop("points")
    index = options.pop("index")
    model = take_model(options)
    both = None if ends is None else ((ends[0][0], ends[1][0]), (ends[0][1], ends[1][1]))
    branches = take_branches(take_orbits(model, orbit, start), over[0], None if both is None else both[0], 2000)
    chosen = choose(branches, kinds, index)
    from singimpact.branches.event_curve import event_curve

    curves: list[EventCurve] = []
    for event in chosen:
        if not any(on_curve(event, curve) for curve in curves):
            curves.append(event_curve(event, over, both, points=points))
    if csv is not None:
        tables = [{"curve": number, "kind": curve.kind, **curve.table()} for number, curve in enumerate(curves, 1)]
        write_table(csv, one_table(tables))
    if output is not None:
        from singimpact.scenes import new_axes, plot

        save(plot(curves, new_axes(7.2, 4.8)).figure, output)
    values = {"model": model.to_dict(), "over": over, "curves": [curve.as_dict() for curve in curves]}
    give(values, shown(curves), as_json)


def choose(branches: list[Branch], kinds: tuple[str, ...], index: int | None) -> list[Event]:
    """The events that the options name; the graze of an orbit without impact is that of the orbit with one.

    Raises
    ------
    InputError : there is none.
    """
    every = [event for branch in branches for event in branch.events]
    chosen = [
        event for number, event in enumerate(every, 1) if index in (None, number) and event.kind in (kinds or FOLLOWED)
    ]
    if not chosen:
        names = ", ".join(f"{number} {event.kind}" for number, event in enumerate(every, 1)) or "none"
        raise InputError(f"no such event: those of the branch are {names}; --from and --to make it longer")
    return [event if event.orbit.n else _with_impact(event, branches[0]) for event in chosen]


def _with_impact(event: Event, free: Branch) -> Event:
    """A graze of orbits without impact, on the branch of orbits with the impact that begins there."""
    from singimpact.branches.branch import branch

    ends = float(free.parameter.min()), float(free.parameter.max())
    same = [each for each in branch(event.others()[0], event.over, ends).events if each.described.at_impact]
    return min(same, key=lambda each: abs(each.parameter - event.parameter))


def on_curve(event: Event, curve: EventCurve) -> bool:
    """Whether an event is one of a curve's."""
    import numpy as np

    if (event.kind, event.orbit.n, event.orbit.k) != (curve.kind, curve.n, curve.k):
        return False
    # the two numbers and the least velocity, each in units of its range
    rows = np.column_stack([curve.parameters, curve.v.min(axis=1)])
    numbers = [event.parameter if name == event.over else value_of(event.orbit.oscillator, name) for name in curve.over]
    scale = np.maximum(np.ptp(rows, axis=0), 1e-300)
    scale[2] = np.abs(curve.v).max() or 1.0
    points, at = rows / scale, np.array([*numbers, float(np.min(event.orbit.v))]) / scale
    move = np.diff(points, axis=0)
    length = np.linalg.norm(move, axis=1) + 1e-300
    share = (((at - points[:-1]) * move).sum(axis=1) / length**2).clip(0, 1)
    gap = np.linalg.norm(points[:-1] + share[:, None] * move - at, axis=1)
    return bool((gap < NEAR * length).any())


def shown(curves: list[EventCurve]) -> str:
    """Curves for people: special points as a table, then how each ends."""
    parts = []
    for number, curve in enumerate(curves, 1):
        parts.append(f"curve {number}: {curve.kind} of ({curve.impacts}, {curve.k}) orbits, {len(curve)} points")
        if curve.special:
            rows = [[point.kind, *map("{:.15g}".format, point.parameters)] for point in curve.special]
            parts.append(columns(["point", *curve.over], rows))
        parts += [f"  {note}" for note in curve.notes]
    return "\n".join(parts)
