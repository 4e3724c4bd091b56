"""`singimpact selftest`: random states of your own model, compared with independent computations."""

import sys

import click

from singimpact.cli.model_options import model_options, take_model
from singimpact.cli.output import give, output_options, whole_option


@click.command()
@click.argument("file", metavar="[MODEL]", required=False)
@model_options
@whole_option("--states", 1, 10**6, "Number of states.", 1000)
@whole_option("--seed", 0, None, "Seed of the random states.", 0)
@output_options
def command(file: str | None, states: int, seed: int, as_json: bool, output: str | None, **options: str | None) -> None:
    """Fly random states of a model forward and back, against small fixed steps, with more digits and in balls; try its
    orbits, chatter limits, basins and tangency points.

    MODEL is a TOML file, as for --model. The exit code is 1 if a result is wrong.
    """
    osc = take_model(options, file)
    from singimpact.bench.selftest.run import selftest

    report = selftest(osc, states=states, seed=seed)
    give({"model": osc.to_dict(), **report.as_data()}, str(report), as_json, output)
    if report.wrong:
        sys.exit(1)
