"""`singimpact basins`: the attractor of each state of a grid."""

from typing import Any

import click

from singimpact.cli.model_options import model_options, take_model, wall_option
from singimpact.cli.output import (
    choice_option,
    columns,
    give,
    picture_option,
    refuse_given,
    save,
    save_once,
    whole_option,
)
from singimpact.inputs import refuse

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
def command(
    size: int,
    impacts: int,
    workers: int | None,
    layer: str,
    output: str,
    as_json: bool,
    **options: Any,
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
        from singimpact.scenes import plot

        how = {"states": states, "output": keep}
        with processes(workers) as pool:
            shares = basins_over(model, over[0], over[1:], (tau, v), values, impacts, wall, executor=pool, **how)
        save(plot(shares).figure, output)
        numbers, lines = shares.as_dict(), zip(shares.values.tolist(), shares.share.tolist(), strict=True)
        rows = [[f"{at:.6g}", *(f"{share:.4f}" for share in line)] for at, line in lines]
        text = columns([shares.over, *numbers["attractor"]], rows)
        give({"model": model.to_dict(), "output": output} | numbers, text, as_json)
        return

    def make() -> tuple[Any, Any]:
        from singimpact.case_pools import processes
        from singimpact.dynamics.basins_of_attraction import basins
        from singimpact.scenes.basins_picture import draw_basins, draw_first_chatter

        with processes(workers) as pool:
            result = basins(model, tau, v, size, pool, keep, impacts, wall)
        draw = draw_basins if layer == LAYERS[0] else draw_first_chatter
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
