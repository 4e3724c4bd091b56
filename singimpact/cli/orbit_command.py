"""`singimpact orbit`: an orbit of many impacts, as numbers or as a picture."""

from pathlib import Path
from typing import Any

import click

from singimpact.cli.model_options import model_options, take_model, wall_option
from singimpact.cli.output import PICTURES, columns, give, output_options, state_options, whole_option
from singimpact.inputs import refuse
from singimpact.store import written


@click.command()
@model_options
@state_options
@whole_option("--impacts", 1, 10_000_000, "Number of impacts.", 200)
@click.option("--horizon", metavar="NUMBER", help="Longest flight time that is searched.")
@wall_option
@output_options
def command(
    tau: str,
    v: str,
    impacts: int,
    horizon: str | None,
    wall: str | None,
    as_json: bool,
    output: str | None,
    **options: str | None,
) -> None:
    """An orbit of the impact map: impacts, chatter, rest on the wall.

    With -o FILE.png (or .pdf, .svg) the orbit is drawn. Numbers may be expressions such as pi/2.8.
    """
    check_ending(output, as_json)
    oscillator = take_model(options)
    orbit = oscillator.orbit(tau, v, impacts=impacts, horizon=horizon, wall=wall)
    if output is not None and not as_json and Path(output).suffix.lower() in PICTURES:
        draw(orbit, output)
    else:
        listed = {"impacts": orbit.rows(), "phases": orbit.as_dict()["phases"]}
        give({"model": oscillator.to_dict(), **listed}, _table(orbit, listed), as_json, output)


def check_ending(output: str | None, as_json: bool) -> None:
    """Refuse a file name whose suffix is that of a picture format which is not written."""
    known = (".json", "") if as_json else (*PICTURES, ".txt", "")
    if output is not None and Path(output).suffix.lower() not in known:
        what = ".json" if as_json else ".png, .pdf or .svg for a picture, or in .txt for a table"
        raise refuse("output", output, f"a file name ending in {what}")


def draw(thing: Any, output: str) -> None:
    """The picture of an orbit or of a section, in the format its file name ends in."""
    import matplotlib

    matplotlib.use("Agg")
    from singimpact.dynamics.orbit import Orbit
    from singimpact.scenes import plot
    from singimpact.scenes.orbit_picture import orbit_sheet

    figure = orbit_sheet(thing) if isinstance(thing, Orbit) else plot(thing).figure
    with written(output) as draft:
        figure.savefig(draft, format=Path(output).suffix[1:].lower())


def _table(orbit: Any, listed: dict[str, Any]) -> str:
    names = ["tau", "v", *(["wall"] if orbit.wall is not None else []), "kind"]
    impacts = [[str(at), *(str(event[name]) for name in names)] for at, event in enumerate(listed["impacts"])]
    phases = [[p["kind"], str(p["start"]), str(p["end"])] for p in listed["phases"]]
    return columns(["", *names], impacts) + "\n\n" + columns(["phase", "from tau", "to tau"], phases)
