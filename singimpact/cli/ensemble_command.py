"""`singimpact ensemble`: many orbits through chatter, rest and lift-off: averages, and how fast they come to rest."""

from typing import Any

import click

from singimpact.cli.model_options import model_options, take_model, wall_option
from singimpact.cli.output import csv_option, give, output_options, whole_option


@click.command()
@model_options
@wall_option
@click.option("--tau", nargs=2, metavar="LOW HIGH", required=True, help="Window of launch phases.")
@click.option("--v", nargs=2, metavar="LOW HIGH", required=True, help="Window of velocities.")
@whole_option("--size", 1, 10**8, "Orbits, from states drawn in the window.", 1000)
@whole_option("--seed", 0, 2**62, "Of the states that are drawn.", 0)
@click.option("--until", metavar="NUMBER", required=True, help="Time at which the orbits end.")
@csv_option("state, last state, impacts, rests, time of the first rest.")
@output_options
def command(csv: str | None, as_json: bool, output: str | None, **options: Any) -> None:
    """Orbits of many states: impacts a unit of time, share of time at rest, and how fast orbits come to rest."""
    names = ("tau", "v", "size", "seed", "until", "wall")
    tau, v, size, seed, until, wall = (options.pop(name) for name in names)
    model = take_model(options)
    import numpy as np

    from singimpact.dynamics.ensemble import ensemble
    from singimpact.surface.curve import window_ends

    rng = np.random.default_rng(seed)
    states = [rng.uniform(*window_ends(name, ends), size) for name, ends in (("tau", tau), ("v", v))]
    result = ensemble(model, *states, until=until, wall=wall)
    if csv is not None:
        result.to_csv(csv)
    rate, error = result.escape_rate()
    numbers = {name: {"mean": mean, "error": off} for name, (mean, off) in result.averages.items()}
    numbers["escape_rate"] = {"mean": rate, "error": error}
    words = {
        "impacts": "impacts a unit of time",
        "v": "v of impacts",
        "rest": "share of time at rest",
        "escape_rate": "first rests a unit of time at risk",
    }
    lines = [f"{words[name]:36}{one['mean']:.6g} +- {one['error']:.2g}" for name, one in numbers.items()]
    values = {"model": model.to_dict(), "until": until, "averages": numbers}
    give(values, "\n".join([repr(result), *lines]), as_json, output)
