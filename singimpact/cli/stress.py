"""`singimpact stress`: public functions towards their bad places, against 60 digits."""

from __future__ import annotations

import sys

import click

from singimpact.cli.columns import columns, markdown
from singimpact.cli.output import as_json_text, emit, output_options
from singimpact.progress import ProgressLine


@click.command(short_help="errors towards the bad places, in units of rounding")
@click.argument("functions", metavar="[FUNCTION]...", nargs=-1)
@click.option("--place", metavar="PLACE", help="One place alone, as the table names it, such as 'a -> 0'.")
@click.option("--quick", is_flag=True, help="Fewer points of every sweep.")
@click.option("--format", "form", type=click.Choice(["text", "markdown"]), default="text", show_default=True)
@output_options
def command(
    functions: tuple[str, ...], place: str | None, quick: bool, form: str, as_json: bool, output: str | None
) -> None:
    """The worst error of every public numerical function near every place that is hard for it, beside 60 digits.

    Exit code 1 when one is over 100 units of condition times epsilon, or has a wrong status.
    """
    from singimpact.bench.stress.table import NOTE, POINTS, QUICK, as_data, chosen, stressed, table, worst_states

    pairs = chosen(functions, place)
    with ProgressLine() as line:
        cells = stressed(pairs, QUICK if quick else POINTS, lambda done, text: line.show(done, len(pairs), text))
    laid_out = markdown if form == "markdown" else columns
    text = "\n\n".join([laid_out(*table(cells)), NOTE, laid_out(*worst_states(cells))])
    emit(as_json_text({"quick": quick, "cells": as_data(cells)}) if as_json else text, output)
    if any(cell.failed for cell in cells):
        sys.exit(1)
