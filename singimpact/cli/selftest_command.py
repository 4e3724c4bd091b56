"""`singimpact selftest`: random states of your own model, compared with independent computations."""

import sys
from typing import Any

import click

from singimpact.cli.model_options import model_options, take_model
from singimpact.cli.output import as_json_text, emit, output_options
from singimpact.inputs import InputError


@click.command()
@click.argument("file", metavar="[MODEL]", required=False)
@model_options
@click.option("--states", type=click.IntRange(1, 10**6), default=1000, show_default=True, help="Number of states.")
@click.option("--seed", type=click.IntRange(0), default=0, show_default=True, help="Seed of the random states.")
@output_options
def command(file: str | None, states: int, seed: int, as_json: bool, output: str | None, **options: Any) -> None:
    """Fly random states of a model forward and back, against small fixed steps, with more digits and in balls; try its
    orbits, chatter limits, basins and tangency points.

    MODEL is a TOML file, as for --model. The exit code is 1 if a result is wrong.
    """
    if file is not None:
        if options["model"] is not None:
            raise InputError(f"{file} and --model {options['model']} name two models: give one of them")
        options["model"] = file
    osc = take_model(options)
    from singimpact.bench.selftest.run import selftest

    report = selftest(osc, states=states, seed=seed)
    emit(as_json_text({"model": osc.to_dict(), **report.as_data()}) if as_json else str(report), output)
    if report.wrong:
        sys.exit(1)
