"""`singimpact explore`: a page with a slider for the clearance, on both sides of a swan."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from singimpact import cache
from singimpact.cli.model_options import model_options, take_model
from singimpact.cli.output import as_json_text, emit, kept_at
from singimpact.inputs import InputError
from singimpact.progress import ProgressLine
from singimpact.store import require_writable, write_text

if TYPE_CHECKING:
    from singimpact.scenes.clearance_frames import ClearanceFilm


@click.command()
@click.argument("path", metavar="[MODEL]", required=False)
@model_options
@click.option(
    "--between", nargs=2, metavar="LOW HIGH", help="Interval of the clearance.  [default: both sides of a swan]"
)
@click.option("--points", type=click.IntRange(2, 1001), default=41, show_default=True, help="Clearances of the slider.")
@click.option("--html", metavar="FILE", help="Write the page to this file.  [default: open it in a browser]")
@click.option("--json", "as_json", is_flag=True, help="Give the curves as JSON instead of a page.")
@click.option("-o", "--output", metavar="FILE", help="The same as --html; with --json, the JSON file.")
def explore_command(
    path: str | None,
    between: tuple[str, str] | None,
    points: int,
    html: str | None,
    as_json: bool,
    output: str | None,
    **options: str | None,
) -> None:
    """Show Z, H, P and gamma for clearances around the swan that is nearest to the clearance of the model.

    A model without a swan is shown around its clearance. MODEL is a TOML file, as for --model. The page is one file
    that needs no network and no other program. It has sliders for r and the parameters too; a click in the plane of
    launch phase and velocity starts an orbit, which the browser computes.
    """
    file = _place(html, output)
    oscillator = take_model(options, path)
    if as_json:
        emit(as_json_text({"model": oscillator.to_dict(), **_told(_film(oscillator, between, points))}), file)
        return
    stored = kept_at(("explore", oscillator, between, points), ("contourpy",))
    page = cache.recall(stored)
    if page is None:
        from singimpact.scenes.explore import explore_page

        page = explore_page(_film(oscillator, between, points)).encode()
        cache.keep(stored, page)
    _show(page.decode(), file)


def _film(oscillator: Any, between: tuple[str, str] | None, points: int) -> ClearanceFilm:
    from singimpact.scenes.clearance_frames import clearance_film

    with ProgressLine() as line:
        return clearance_film(oscillator, between, points, line.show)


def _place(html: str | None, output: str | None) -> str | None:
    """The one file that was named, refused before the work when it cannot be written."""
    if html is not None and output is not None:
        raise InputError(f"--html {html} and -o {output} name two files: give one of them")
    place = output if html is None else html
    if place is not None:
        require_writable(place)
    return place


def _show(page: str, file: str | None) -> None:
    """Into the file, or into a browser's window."""
    if file is not None:
        write_text(file, page)
        return
    import tempfile
    import webbrowser
    from pathlib import Path

    # the browser reads the file after this command has ended, so it is left to the system's cleaning
    shown = Path(tempfile.mkdtemp(prefix="singimpact-")) / "explore.html"
    write_text(shown, page)
    if not webbrowser.open(shown.as_uri()):
        click.echo(f"no browser opens here: the page is in {shown}; --html FILE puts it elsewhere", err=True)


def _told(film: ClearanceFilm) -> dict[str, Any]:
    frames = [
        {
            "clearance": frame.clearance,
            "tangencies": frame.tangencies,
            "window": {"tau": frame.view.tau, "t": frame.view.t, "v": frame.view.v},
            "curves": {name: [curve.points.tolist() for curve in curves] for name, curves in frame.curves.items()},
        }
        for frame in film.frames
    ]
    swan = film.swan and {"clearance": film.swan.clearance, "tau": film.swan.tau, "kind": film.swan.kind}
    return {
        "swan": swan,
        "text": film.sentence,
        "window": {"tau": film.tau, "t": film.t, "v": film.v},
        "frames": frames,
        "flights": film.flights,
    }
