"""`singimpact border`: where a released orbit returns onto gamma, and the cascade beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from singimpact.cli.model_options import model_options, over_option, take_ends, take_model
from singimpact.cli.output import as_json_text, columns, picture_option, save, whole_option
from singimpact.inputs import InputError

if TYPE_CHECKING:
    from singimpact.branches.border import BorderOrbit


@click.command()
@model_options
@over_option
@click.option("--from", "low", metavar="NUMBER", help="Its least value; half of the model's value without it.")
@click.option("--to", "high", metavar="NUMBER", help="Its largest value; one and a half of the model's without it.")
@whole_option("--periods", 1, 1000, "Within which it returns.", 1)
@whole_option("--points", 2, 1_000_000, "Values looked at.", 200)
@click.option("--digits", type=int, metavar="N", help="Decimal digits, certified where r is a number.")
@click.option("--cascade", is_flag=True, help="Give edges and attractors beside each; -o does, too.")
@picture_option("The picture of the first one's cascade: .png, .pdf or .svg.")
@click.option("--json", "as_json", is_flag=True, help="Give them as JSON.")
def command(
    over: str,
    periods: int,
    points: int,
    digits: int | None,
    cascade: bool,
    output: str | None,
    as_json: bool,
    **options: str | None,
) -> None:
    """Border orbits: released at rest at a zero of a_c, back exactly on gamma of such a zero.

    There complete chatter becomes incomplete. Beside it the number of impacts changes at edges whose distances shrink
    by mu(r), with attractors between.
    """
    ends = take_ends(options.pop("low"), options.pop("high"))
    model = take_model(options)
    from singimpact.branches.border import border_orbits

    borders = border_orbits(model, over, ends, digits=digits, periods=periods, points=points)
    if output is not None:
        if not borders:
            raise InputError(f"no border orbit to draw: {'; '.join(borders.notes)}")
        save(_picture(borders[0]), output)
    if as_json:
        rows = [as_listed(border, cascade) for border in borders]
        click.echo(as_json_text({"model": model.to_dict(), "over": over, "orbits": rows, "notes": list(borders.notes)}))
    else:
        parts = [line for border in borders for line in shown(border, cascade)] or ["no border orbit found"]
        click.echo("\n".join([*parts, *(f"  {note}" for note in borders.notes)]))


def _picture(border: BorderOrbit) -> Any:
    from matplotlib.figure import Figure

    from singimpact.scenes.branch_picture import draw_border

    figure = Figure(figsize=(7.2, 5.2), dpi=150, layout="constrained")
    return draw_border(border, *figure.subplots(2, sharex=True, height_ratios=(3, 2))).figure


def as_listed(border: BorderOrbit, cascade: bool) -> dict[str, Any]:
    """A border orbit as JSON, with its cascade or without."""
    return border.as_dict() | ({"cascade": border.cascade.as_dict()} if cascade else {})


def shown(border: BorderOrbit, cascade: bool) -> list[str]:
    """A border orbit for people."""
    lines = [repr(border)[1:-1], *(f"  {note}" for note in border.notes)]
    if cascade:
        edges = border.cascade
        rows = []
        for i, number in enumerate(edges.impacts.tolist()):
            ratio = f"{float(edges.ratios[i]):.10f}" if i < len(edges.ratios) else ""
            orbit = edges.windows[i].orbit if i < len(edges.windows) else None
            size = name = ""
            if orbit is not None:
                size = f"{abs(complex(orbit.multipliers[0])):.4f}"
                name = f"({'inf' if orbit.kind == 'chatter' else int(orbit.n)}, {orbit.k})"
            rows.append([str(number), f"{float(edges.distance[i]):.6e}", ratio, name, size])
        names = ["impacts", "distance of the edge", "ratio to the next", "attractor", "multiplier"]
        lines += [repr(edges)[1:-1], columns(names, rows), *(f"  {note}" for note in edges.notes)]
    return lines
