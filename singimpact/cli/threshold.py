"""`singimpact threshold`: the velocity below which chatter completes."""

from __future__ import annotations

from typing import Any

import click

from singimpact.cli.chatter import enclosure, number
from singimpact.cli.model import model_options, take_model
from singimpact.cli.output import as_json_text, emit, output_options
from singimpact.status import Status


@click.command(short_help="the velocity below which chatter completes")
@model_options
@click.option("--tau", metavar="NUMBER", required=True, help="A phase with a_c < 0.")
@click.option("--digits", type=click.IntRange(1, 2000), help="Significant digits.  [default: a double]")
@click.option(
    "--impacts", type=click.IntRange(1, 10_000_000), default=640_000, show_default=True, help="Impacts at most."
)
@output_options
def command(tau: str, digits: int | None, impacts: int, as_json: bool, output: str | None, **options: Any) -> None:
    """The velocity of gamma at tau: chatter completes below it, and is interrupted by lift-off above it."""
    oscillator = take_model(options)
    from singimpact.dynamics.threshold import threshold

    found = threshold(oscillator, tau, digits=digits, impacts=impacts)
    status = Status(int(found.status))
    if as_json:
        told = {"v": number(found.v, digits), "error": float(found.error), "status": status.name}
        told |= enclosure(found.certified)
        emit(as_json_text({"model": oscillator.to_dict(), **told}), output)
    else:
        lines = [f"v       {number(found.v, digits)}", f"error   {float(found.error):.1e}"]
        lines += [f"{name:7} {text}" for name, text in enclosure(found.certified).items()]
        word = status.name if status == Status.complete else f"{status.name}: {status.sentence}"
        emit("\n".join([*lines, f"status  {word}"]), output)
