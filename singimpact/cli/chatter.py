"""`singimpact chatter`: the time at which infinitely many impacts accumulate."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from singimpact.cli.model import model_options, take_model
from singimpact.cli.output import as_json_text, emit, output_options
from singimpact.status import Status

if TYPE_CHECKING:
    from singimpact.algebra.certified import Certified


@click.command(short_help="the time at which infinitely many impacts accumulate")
@model_options
@click.option("--tau", metavar="NUMBER", required=True, help="Launch phase.")
@click.option("--v", metavar="NUMBER", required=True, help="Launch velocity.")
@click.option("--digits", type=click.IntRange(1, 2000), help="Significant digits.  [default: a double]")
@click.option(
    "--impacts", type=click.IntRange(1, 10_000_000), default=1_000_000, show_default=True, help="Impacts at most."
)
@output_options
def command(
    tau: str, v: str, digits: int | None, impacts: int, as_json: bool, output: str | None, **options: Any
) -> None:
    """The accumulation time of a chatter sequence, its error, and the impacts flown before a series gave the rest."""
    oscillator = take_model(options)
    found = oscillator.chatter_limit(tau, v, digits=digits, impacts=impacts)
    status = Status(int(found.status))
    if as_json:
        told = {"tau": number(found.tau, digits), "error": float(found.error), "impacts": found.impacts}
        told |= enclosure(found.certified)
        emit(as_json_text({"model": oscillator.to_dict(), **told, "status": status.name}), output)
    else:
        lines = [f"tau      {number(found.tau, digits)}", f"error    {float(found.error):.1e}",
                 *(f"{name:8} {text}" for name, text in enclosure(found.certified).items()),
                 f"impacts  {found.impacts}", f"status   {status.name}: {status.sentence}"]  # fmt: skip
        emit("\n".join(lines), output)


def enclosure(found: Certified | None) -> dict[str, str]:
    """Value and radius as text, where they are proved."""
    return {} if found is None else found.as_dict()


def number(value: Any, digits: int | None) -> Any:
    """A double, or the text of as many digits as were asked for."""
    if digits is None:
        return float(value)
    from mpmath import nstr

    return nstr(value, digits, strip_zeros=False)
