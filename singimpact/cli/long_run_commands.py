"""Commands of the long run, over states and over numbers of a model: sweep, basins, bifurcation, regions, ensemble."""

from __future__ import annotations

from functools import partial
from typing import Any

import click

import singimpact as si
from singimpact import algebra, dynamics, flights, scenes, surface
from singimpact.cli.model_options import model_options, over_option, take_branches, take_model, take_orbits, wall_option
from singimpact.cli.output import (
    choice_option,
    columns,
    csv_option,
    give,
    output_options,
    picture_option,
    refuse_given,
    save,
    save_once,
    state_options,
    whole_option,
)
from singimpact.inputs import InputError, refuse
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
def sweep_command(
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

    from singimpact.case_pools import WorkerPool

    oscillator = take_model(options)
    if over not in {"clearance", "restitution", *oscillator.parameters}:
        numbers = ", ".join(["clearance", "restitution", *oscillator.parameters])
        raise InputError(f"--over {over} is not a number of the model: give one of {numbers}")
    first, last = algebra.as_float(algebra.constant("--from", low)), algebra.as_float(algebra.constant("--to", high))
    values = np.linspace(first, last, points).tolist()
    ask = partial(last_state, oscillator.to_dict(), over, tau, v, impacts)
    with WorkerPool(workers) as pool:
        ends = np.array(si.sweep(ask, values, pool, keep))
    rows = [[value, *map(float, row[:2]), Status(int(row[2])).name] for value, row in zip(values, ends, strict=True)]
    names = [over, "tau", "v", "status"]
    cases = [dict(zip(names, row, strict=True)) for row in rows]
    text = columns(names, [[str(cell) for cell in row] for row in rows])
    give({"model": oscillator.to_dict(), "impacts": impacts, "cases": cases}, text, as_json, output)


def last_state(fields: dict[str, Any], over: str, tau: str, v: str, impacts: int, value: float) -> algebra.Array:
    """tau, v and status after the last impact. A module-level function, so that it can be pickled."""
    import numpy as np

    ends = flights.iterate(si.ImpactOscillator(**fields).replace(**{over: value}), tau, v, impacts)
    return np.array([float(ends.tau), float(ends.v), float(ends.status)])


LAYERS = ("for-ever", "first-chatter")


@click.command()
@model_options
@wall_option
@click.option("--tau", nargs=2, metavar="LOW HIGH", help="Window of launch phases.  [default: one period]")
@click.option("--v", nargs=2, metavar="LOW HIGH", help="Window of velocities.  [default: 0 2]")
@click.option("--x", nargs=2, metavar="LOW HIGH", help="Without t in f and g: window of x at the start.")
@click.option("--xdot", nargs=2, metavar="LOW HIGH", help="The same of x'.  [default: -2 2]")
@whole_option("--size", 2, 10_000, "States a side.", 600)
@whole_option("--impacts", 1, 10**7, "Of an orbit that does not settle.", 20_000)
@click.option("--over", nargs=3, metavar="NUMBER LOW HIGH", help="Shares of the basins over a number of the model.")
@whole_option("--values", 2, 100_000, "Of that number.", 50)
@whole_option("--states", 1, 1_000_000, "Drawn at each of its values.", 400)
@whole_option("--workers", 1, 1024, "Processes.  [default: threads, one for each core]")
@choice_option("--layer", LAYERS, "Draw the attractors, or the states whose first chatter completes.", LAYERS[0])
@click.option("--keep", metavar="FILE", help="Store results in this file (.npz or .zarr), and resume from it.")
@picture_option(required=True)
@click.option("--json", "as_json", is_flag=True, help="Give the shares of the classes as JSON.")
def basins_command(
    size: int, impacts: int, workers: int | None, layer: str, output: str, as_json: bool, **options: Any
) -> None:
    """Basins of attraction on a grid of launches: (n, k) orbits, limit cycles, repeated chatter, rest, chaos.

    An (n, k) orbit has n impacts in k periods of the forcing. A model without t has a grid of starts off the wall.
    """
    keep, wall, over, values, states = (options.pop(name) for name in ("keep", "wall", "over", "values", "states"))
    ends = {name: options.pop(name) for name in ("tau", "v", "x", "xdot")}
    model = take_model(options)
    axes = ("x", "xdot") if model.autonomous else ("tau", "v")
    for name, value in ends.items():
        if value is not None and name not in axes:
            raise refuse(f"--{name}", " ".join(value), f"--{axes[0]} and --{axes[1]} for this model")
    tau, v = (ends[name] for name in axes)

    if over is None:
        refuse_given(("values", "states"), "--over beside it")
    else:
        refuse_given(("size", "layer"), "one of the two: --over has --values and --states")
        from singimpact.case_pools import processes
        from singimpact.dynamics.basins_over import basins_over

        how = {"states": states, "output": keep}
        with processes(workers) as pool:
            shares = basins_over(model, over[0], over[1:], (tau, v), values, impacts, wall, executor=pool, **how)
        save(si.plot(shares).figure, output)
        numbers, lines = shares.as_dict(), zip(shares.values.tolist(), shares.share.tolist(), strict=True)
        rows = [[f"{at:.6g}", *(f"{share:.4f}" for share in line)] for at, line in lines]
        text = columns([shares.over, *numbers["attractor"]], rows)
        give({"model": model.to_dict(), "output": output} | numbers, text, as_json)
        return

    def make() -> tuple[Any, Any]:
        from singimpact.case_pools import processes

        with processes(workers) as pool:
            result = dynamics.basins(model, tau, v, size, pool, keep, impacts, wall)
        draw = scenes.draw_basins if layer == LAYERS[0] else scenes.draw_first_chatter
        values = result.as_dict()
        first = float(values["first_chatter_completes"].mean())
        return draw(result).figure, {"classes": values["classes"], "first_chatter_completes": first}

    if keep is None:
        summary = save_once(("basins", model, tau, v, size, impacts, layer, wall), output, make)
    else:
        figure, summary = make()
        save(figure, output)
    table = columns(["class", "share"], [[str(item["class"]), f"{item['share']:.4f}"] for item in summary["classes"]])
    text = f"{table}\nfirst chatter completes  {summary['first_chatter_completes']:.4f}"
    give({"model": model.to_dict(), "output": output} | summary, text, as_json)


@click.command()
@model_options
@over_option
@click.option("--from", "low", metavar="NUMBER", required=True, help="Its first value.")
@click.option("--to", "high", metavar="NUMBER", required=True, help="Its last value.")
@whole_option("--points", 2, 100_000, "Number of values.", 300)
@click.option("--start", nargs=2, metavar="TAU V", default=("0", "0.1"), show_default=True, help="The first state.")
@whole_option("--impacts", 1, 1_000_000, "Impacts for each value.", 200)
@click.option(
    "--kept",
    "last_events",
    type=click.IntRange(1, 100_000),
    default=60,
    show_default=True,
    help="Last impacts of each that are drawn.",
)
@choice_option("--direction", ["up", "down", "both"], "Start each orbit from the last state of the one before.")
@click.option(
    "--follow",
    nargs=2,
    type=int,
    multiple=True,
    metavar="N K",
    help="Also draw the branches of the model's orbits of N impacts in K periods; may be repeated.",
)
@whole_option("--workers", 1, 1024, "Processes.  [default: one for each core]")
@click.option("--keep", metavar="FILE", help="Store results in this file (.npz or .zarr), and resume from it.")
@picture_option(required=True)
@click.option("--json", "as_json", is_flag=True, help="Give phase, v and end of chatter for each value as JSON.")
def bifurcation_command(
    over: str,
    low: str,
    high: str,
    points: int,
    start: tuple[str, str],
    impacts: int,
    last_events: int,
    direction: str | None,
    follow: tuple[tuple[int, int], ...],
    workers: int | None,
    keep: str | None,
    output: str,
    as_json: bool,
    **options: str | None,
) -> None:
    """The last impacts of one orbit for each value of a parameter.

    amplitude, damping, stiffness and phase move without being named before. Drawn are velocities and phases; with
    --follow also the periodic orbits through the model's own value, stable and unstable ones.
    """
    model = take_model(options)
    from singimpact.case_pools import processes

    # in a direction each orbit begins where the one before ends: there is nothing to share out
    with processes(workers if direction is None else None) as pool:
        settings: dict[str, Any] = {"start": start, "impacts": impacts, "kept": last_events, "direction": direction}
        diagram = si.bifurcation(model, over, (low, high), points, **settings, executor=pool, output=keep)
    branches = [
        branch for n, k in follow for branch in take_branches(take_orbits(model, (n, k), None), over, (low, high), 2000)
    ]
    save(scenes.bifurcation_sheet(diagram, branches), output)
    rows = zip(diagram.values.tolist(), diagram.events.tolist(), strict=True)
    left = int((~diagram.settled).sum())
    open_ = f"; {left} of them without a period seen in at most {diagram.settle} impacts" if left else ""
    text = f"{output}: {points} values of {over}, {last_events} events of each{open_}"
    give({"over": over, "cases": [{"value": value, "events": branch} for value, branch in rows]}, text, as_json)


@click.command()
@model_options
@wall_option
@click.option("--over", nargs=2, metavar="A B", default=("omega", "clearance"), show_default=True, help="Two numbers.")
@click.option("--from", "low", nargs=2, metavar="A B", required=True, help="Their least values.")
@click.option("--to", "high", nargs=2, metavar="A B", required=True, help="Their largest values.")
@click.option("--of", metavar="WHAT", default="period", show_default=True, help="period, lyapunov, rest or impacts.")
@whole_option("--size", 2, 20_000, "Values of each number.", 400)
@click.option("--start", nargs=2, metavar="TAU V", default=("0", "0.1"), show_default=True, help="The first state.")
@whole_option("--impacts", 64, 10**8, "Of an orbit that does not settle.", 4000)
@whole_option("--workers", 1, 1024, "Processes.  [default: threads, one for each core]")
@click.option("--keep", metavar="FILE", help="Store results in this file (.npz or .zarr), and resume from it.")
@picture_option(required=True)
@click.option("--json", "as_json", is_flag=True, help="Give the shares of the classes, or the values, as JSON.")
def regions_command(output: str, as_json: bool, **options: Any) -> None:
    """Regions over two numbers: (n, k) orbits, complete chatter again and again, chaos; or an exponent, or counts.

    An (n, k) orbit has n impacts in k periods of the forcing.
    """
    names = ("over", "low", "high", "of", "size", "start", "impacts", "workers", "keep", "wall")
    over, low, high, of, size, start, impacts, workers, keep, wall = (options.pop(name) for name in names)
    model = take_model(options)
    from singimpact.case_pools import processes
    from singimpact.dynamics.regions import OF, regions

    if of not in OF:
        raise refuse("--of", of, ", ".join(OF))
    both = tuple(zip(low, high, strict=True))
    with processes(workers) as pool:
        result = regions(model, over, both, of, size, (*start, wall), impacts, executor=pool, output=keep)
    save(scenes.draw_regions(result).figure, output)
    if result.values is not None:
        values, text = result.as_dict(), repr(result)
    else:
        values = {"classes": result.named_codes["classes"]}
        text = columns(["class", "share"], [[name, f"{share:.4f}"] for _, name, share in result.classes])
    give({"model": model.to_dict(), "over": over, "output": output} | values, text, as_json)


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
def ensemble_command(csv: str | None, as_json: bool, output: str | None, **options: Any) -> None:
    """Orbits of many states: impacts a unit of time, share of time at rest, and how fast orbits come to rest."""
    names = ("tau", "v", "size", "seed", "until", "wall")
    tau, v, size, seed, until, wall = (options.pop(name) for name in names)
    model = take_model(options)
    import numpy as np

    rng = np.random.default_rng(seed)
    states = [rng.uniform(*surface.window_ends(name, ends), size) for name, ends in (("tau", tau), ("v", v))]
    result = si.ensemble(model, *states, until=until, wall=wall)
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
