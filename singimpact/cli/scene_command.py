"""`singimpact scene`: the picture that a scene file describes."""

from pathlib import Path

import click

from singimpact.cli.output import columns, give, picture_option, save


@click.command()
@click.argument("file", metavar="FILE.toml")
@picture_option(required=True)
@click.option("--json", "as_json", is_flag=True, help="Print the report as JSON.")
def scene_command(file: str, output: str, as_json: bool) -> None:
    """Draw a scene: a model, a window and layers, from a TOML file.

    Layers of the (tau, t)-plane: horizon, zero-set, visible, shadow, cut, beyond. Layers of the (tau, v)-plane:
    outline, discontinuities, gamma, stable-manifolds, foliation, orbits. Of a model with two walls the file names one,
    wall = "upper". What is computed, what it took and what came from the cache is printed.
    """
    from singimpact.scenes.scene import DPI, Scene

    scene = Scene.read(file)
    save(scene.draw().figure, output, dpi=DPI)
    report = {"output": str(Path(output)), **scene.report()}
    rows = [[name, str(report["curves"][name]), f"{time:.3f}"] for name, time in report["seconds_by_layer"].items()]
    table = columns(["layer", "curves", "seconds"], rows) if rows else "no layers"
    cached = ", ".join(report["from_cache"]) or "nothing"
    give(report, f"{table}\n{report['flights']} flights computed; from the cache: {cached}", as_json)
