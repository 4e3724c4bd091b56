"""`singimpact chatter`: the time at which infinitely many impacts accumulate."""

import click

from singimpact.cli.model_options import model_options, take_model
from singimpact.cli.output import give, lines_of, number_text, output_options, state_options, whole_option
from singimpact.status import Status


@click.command()
@model_options
@state_options
@whole_option("--digits", 1, 2000, "Significant digits.  [default: a double]")
@whole_option("--impacts", 1, 10_000_000, "Impacts at most.", 1_000_000)
@output_options
def command(
    tau: str, v: str, digits: int | None, impacts: int, as_json: bool, output: str | None, **options: str | None
) -> None:
    """The accumulation time of a chatter sequence, its error, and the impacts flown before a series gave the rest."""
    osc = take_model(options)
    end = osc.chatter_limit(tau, v, digits=digits, impacts=impacts)
    status = Status(int(end.status))
    enclosure = end.certified.as_dict() if end.certified else {}
    time, error = number_text(end.tau, digits), float(end.error)
    values = {"tau": time, "error": error, "impacts": end.impacts, **enclosure, "status": status.name}
    rows = {"tau": time, "error": f"{error:.1e}", **enclosure, "impacts": end.impacts}
    give({"model": osc.to_dict(), **values}, "\n".join(lines_of(rows, status)), as_json, output)
