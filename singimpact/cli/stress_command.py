"""`singimpact stress`: errors of public functions near singular points and parameters, against 60 digits."""

import sys

import click

from singimpact.cli.output import as_json_text, columns, emit, markdown, output_options, page_format
from singimpact.progress import ProgressLine


@click.command()
@click.argument("functions", metavar="[FUNCTION]...", nargs=-1)
@click.option("--place", "limit", metavar="PLACE", help="One row of the table alone, such as 'a -> 0'.")
@click.option("--quick", is_flag=True, help="Fewer points in every sequence.")
@page_format()
@output_options
def command(
    functions: tuple[str, ...], limit: str | None, quick: bool, form: str, as_json: bool, output: str | None
) -> None:
    """The largest error of every public numerical function near its singular points, compared with 60 digits.

    The exit code is 1 if an error exceeds 100 units of condition times epsilon, or a status is wrong.
    """
    from singimpact.bench.page import stress_page
    from singimpact.bench.stress.table import NOTE, POINTS, QUICK, as_data, chosen, stressed, table, worst_states

    pairs = chosen(functions, limit)
    with ProgressLine() as line:
        cells = stressed(pairs, QUICK if quick else POINTS, lambda done, text: line.show(done, len(pairs), text))
    laid_out = columns if form == "text" else markdown
    text = "\n\n".join([laid_out(*table(cells)), NOTE, laid_out(*worst_states(cells))])
    if form == "page":
        text = stress_page(text)
    emit(as_json_text({"quick": quick, "cells": as_data(cells)}) if as_json else text, output)
    if any(cell.failed for cell in cells):
        sys.exit(1)
