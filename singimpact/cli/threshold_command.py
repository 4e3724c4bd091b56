"""`singimpact threshold`: the velocity below which chatter completes."""

import click

from singimpact.cli.model_options import model_options, take_model, wall_option
from singimpact.cli.output import give, lines_of, number_text, output_options, whole_option
from singimpact.status import Status


@click.command()
@model_options
@click.option("--tau", metavar="NUMBER", required=True, help="A phase with a_c < 0.")
@whole_option("--digits", 1, 2000, "Significant digits.  [default: a double]")
@whole_option("--impacts", 1, 10_000_000, "Impacts at most.", 640_000)
@wall_option
@output_options
def command(
    tau: str,
    digits: int | None,
    impacts: int,
    wall: str | None,
    as_json: bool,
    output: str | None,
    **options: str | None,
) -> None:
    """The velocity of gamma at tau: chatter completes below it, and is interrupted by lift-off above it.

    With two walls the status is other_wall where a flight meets the other one from a lower velocity on, which is given.
    """
    osc = take_model(options)
    from singimpact.dynamics.threshold import threshold

    limit = threshold(osc.seen_from(wall), tau, digits=digits, impacts=impacts)
    status = Status(int(limit.status))
    enclosure = limit.certified.as_dict() if limit.certified else {}
    speed, error = number_text(limit.v, digits), float(limit.error)
    values = {"v": speed, "error": error, "status": status.name, **enclosure}
    rows = {"v": speed, "error": f"{error:.1e}", **enclosure}
    text = "\n".join(lines_of(rows, status, (Status.complete,)))
    give({"model": osc.to_dict(), **values}, text, as_json, output)
