"""`singimpact section`: the states of an orbit once in each period, as numbers or as a picture."""

from pathlib import Path

import click

from singimpact.cli.model_options import model_options, take_model
from singimpact.cli.orbit_command import check_ending, draw
from singimpact.cli.output import PICTURES, columns, give, output_options, state_options, whole_option


@click.command()
@model_options
@state_options
@whole_option("--impacts", 1, 10_000_000, "Number of impacts.", 2000)
@click.option("--at", "at", metavar="NUMBER", default="0", show_default=True, help="Time after the start of a period.")
@whole_option("--skip", 0, 10_000_000, "Number of first states that are left out.", 0)
@output_options
def command(
    tau: str, v: str, impacts: int, at: str, skip: int, as_json: bool, output: str | None, **options: str | None
) -> None:
    """x and x' of an orbit once in each period of the forcing: a stroboscopic section.

    With -o FILE.png (or .pdf, .svg) the section is drawn. Numbers may be expressions such as pi/2.8.
    """
    check_ending(output, as_json)
    osc = take_model(options)
    section = osc.orbit(tau, v, impacts=impacts).section(at).after(skip)
    if output is not None and not as_json and Path(output).suffix.lower() in PICTURES:
        draw(section, output)
    else:
        text = columns(list(section.table()), [list(map(str, row.values())) for row in section.rows()])
        give({"model": osc.to_dict(), "at": at, **section.as_dict()}, text, as_json, output)
