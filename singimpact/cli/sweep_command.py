"""`singimpact sweep`: the state after many impacts, for many values of one parameter."""

from functools import partial
from typing import Any

import click

from singimpact.cli.model_options import model_options, take_model
from singimpact.cli.output import columns, give, output_options, state_options, whole_option
from singimpact.inputs import InputError
from singimpact.status import Status


@click.command()
@model_options
@click.option("--over", metavar="NAME", required=True, help="clearance, restitution or a parameter.")
@click.option("--from", "low", metavar="NUMBER", required=True, help="Its first value.")
@click.option("--to", "high", metavar="NUMBER", required=True, help="Its last value.")
@whole_option("--points", 2, 1_000_000, "Number of values.", 21)
@state_options
@whole_option("--impacts", 1, 1_000_000, "Impacts flown.", 200)
@whole_option("--workers", 1, 1024, "Processes.  [default: one for each core]")
@click.option("--keep", metavar="FILE", help="Store results in this file (.npz or .zarr), and resume from it.")
@output_options
def command(
    over: str,
    low: str,
    high: str,
    points: int,
    tau: str,
    v: str,
    impacts: int,
    workers: int | None,
    keep: str | None,
    as_json: bool,
    output: str | None,
    **options: str | None,
) -> None:
    """The state after the last of many impacts, for values of one parameter.

    A model named by options needs the option of the swept parameter too.
    """
    import numpy as np

    from singimpact.algebra.numbers import as_float, constant
    from singimpact.case_pools import WorkerPool
    from singimpact.cases import sweep

    oscillator = take_model(options)
    if over not in {"clearance", "restitution", *oscillator.parameters}:
        numbers = ", ".join(["clearance", "restitution", *oscillator.parameters])
        raise InputError(f"--over {over} is not a number of the model: give one of {numbers}")
    first, last = as_float(constant("--from", low)), as_float(constant("--to", high))
    values = np.linspace(first, last, points).tolist()
    ask = partial(last_state, oscillator.to_dict(), over, tau, v, impacts)
    with WorkerPool(workers) as pool:
        ends = np.array(sweep(ask, values, pool, keep))
    rows = [[value, *map(float, row[:2]), Status(int(row[2])).name] for value, row in zip(values, ends, strict=True)]
    names = [over, "tau", "v", "status"]
    cases = [dict(zip(names, row, strict=True)) for row in rows]
    text = columns(names, [[str(cell) for cell in row] for row in rows])
    give({"model": oscillator.to_dict(), "impacts": impacts, "cases": cases}, text, as_json, output)


def last_state(fields: dict[str, Any], over: str, tau: str, v: str, impacts: int, value: float) -> Any:
    """tau, v and status after the last impact. A module-level function, so that it can be pickled."""
    import numpy as np

    from singimpact.flights.orbits import iterate
    from singimpact.impact_oscillator import ImpactOscillator

    ends = iterate(ImpactOscillator(**fields).replace(**{over: value}), tau, v, impacts)
    return np.array([float(ends.tau), float(ends.v), float(ends.status)])
