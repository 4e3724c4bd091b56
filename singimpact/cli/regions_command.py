"""`singimpact regions`: what an orbit does in the end, over two numbers of the model, as a picture."""

from typing import Any

import click

from singimpact.cli.model_options import model_options, take_model, wall_option
from singimpact.cli.output import columns, give, picture_option, save, whole_option
from singimpact.inputs import refuse


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
def command(output: str, as_json: bool, **options: Any) -> None:
    """Regions over two numbers: (n, k) orbits, complete chatter again and again, chaos; or an exponent, or counts.

    An (n, k) orbit has n impacts in k periods of the forcing.
    """
    names = ("over", "low", "high", "of", "size", "start", "impacts", "workers", "keep", "wall")
    over, low, high, of, size, start, impacts, workers, keep, wall = (options.pop(name) for name in names)
    model = take_model(options)
    from singimpact.case_pools import processes
    from singimpact.dynamics.regions import OF, regions
    from singimpact.scenes.basins_picture import draw_regions

    if of not in OF:
        raise refuse("--of", of, ", ".join(OF))
    both = tuple(zip(low, high, strict=True))
    with processes(workers) as pool:
        result = regions(model, over, both, of, size, (*start, wall), impacts, executor=pool, output=keep)
    save(draw_regions(result).figure, output)
    if result.values is not None:
        values, text = result.as_dict(), repr(result)
    else:
        values = {"classes": result.named_codes["classes"]}
        text = columns(["class", "share"], [[name, f"{share:.4f}"] for _, name, share in result.classes])
    give({"model": model.to_dict(), "over": over, "output": output} | values, text, as_json)
