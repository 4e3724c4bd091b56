"""Commands that show a model: scene, classify, explore; and `figure`, the paper's figures from computed data."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from time import process_time
from typing import TYPE_CHECKING, Any, TypeGuard

import click

from singimpact import cache, paper, scenes, surface
from singimpact.cli.model_options import model_options, take_model, wall_option
from singimpact.cli.output import (
    PICTURES,
    as_json_text,
    columns,
    emit,
    give,
    kept_at,
    output_options,
    picture_option,
    save,
    save_once,
)
from singimpact.inputs import InputError, refuse, require
from singimpact.paper.figures import ACCEPTED, BEYOND, FIGURES, kept_picture
from singimpact.progress import ProgressLine
from singimpact.store import folder, require_writable, write_text

if TYPE_CHECKING:
    from singimpact.branches.transitions import Interval, OrbitTransitions
    from singimpact.impact_oscillator import ImpactOscillator
    from singimpact.scenes.clearance_frames import ClearanceFilm
    from singimpact.surface.classification import Classification
    from singimpact.surface.outline_transitions import Transitions


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
    scene = scenes.Scene.read(file)
    save(scene.draw().figure, output, dpi=scenes.DPI)
    report = {"output": str(Path(output)), **scene.report()}
    rows = [[name, str(report["curves"][name]), f"{time:.3f}"] for name, time in report["seconds_by_layer"].items()]
    table = columns(["layer", "curves", "seconds"], rows) if rows else "no layers"
    cached = ", ".join(report["from_cache"]) or "nothing"
    give(report, f"{table}\n{report['flights']} flights computed; from the cache: {cached}", as_json)


ORBIT = ("n", "k", "kind", "stable", "tau", "v")
CHANGE = ("kind", "value", "n", "k", "below", "above")  # of an orbit and of a change of orbits, in JSON
SEEN = {None: "not decided", True: "yes", False: "no"}


@click.command()
@model_options
@click.option("--window-tau", nargs=2, metavar="LOW HIGH", help="Ends of tau.  [default: one period]")
@click.option("--window-t", nargs=2, metavar="LOW HIGH", help="Ends of t.  [default: one period to both sides]")
@click.option("--over", metavar="NAME", help="Also list the transitions of P over this: clearance or a parameter.")
@click.option(
    "--between",
    nargs=2,
    metavar="LOW HIGH",
    help="Interval of --over; without --over, clearances in which swans are searched.",
)
@click.option(
    "--orbits",
    type=click.IntRange(1, 8),
    metavar="M",
    help="With --over: also the orbits of n impacts in k periods, n, k <= M, between these transitions.",
)
@wall_option
@output_options
def classify_command(
    window_tau: tuple[str, str] | None,
    window_t: tuple[str, str] | None,
    over: str | None,
    between: tuple[str, str] | None,
    orbits: int | None,
    wall: str | None,
    as_json: bool,
    output: str | None,
    **options: str | None,
) -> None:
    """The points of V_c' where p or phi is singular: tangencies, swans, cusps, and the fold lines between them.

    Swan points are listed over the clearance. With --over and --between: the transitions of P met on the way (swans,
    swallowtails, lips, beaks, tacnodes, triple points, periodic grazes) and which of them are visible, and with
    --orbits the periodic orbits between them, and where these graze, fold or double. Numbers may be expressions such
    as pi/2.8.
    """
    oscillator = take_model(options)
    if over is not None and between is None:
        raise InputError(f"--over {over} needs its ends: --between LOW HIGH")
    if orbits is not None and over is None:
        raise InputError("--orbits needs the number that is varied: --over NAME --between LOW HIGH")
    from singimpact.studies import interval

    swans_between = interval(between) if between is not None and over in (None, "clearance") else None
    points = surface.classify(oscillator.seen_from(wall), window_tau, window_t, swans_between)
    changes = None if over is None else _transitions(oscillator, wall, over, between, points.t, orbits)
    values = {"model": oscillator.to_dict(), **_as_listed(points, over, changes)}
    give(values, _text(points, over, changes), as_json, output)


def _transitions(
    oscillator: ImpactOscillator,
    wall: str | None,
    over: str,
    between: tuple[str, str] | None,
    t: tuple[float, float],
    orbits: int | None,
) -> Transitions:
    """Without orbits nothing of branches is loaded, which takes 0.2 s."""
    if orbits is None:
        return surface.at_wall(oscillator, wall, over, between, t)
    from singimpact.branches.transitions import transitions as with_orbits

    return with_orbits(oscillator, over, between, t, orbits=orbits, wall=wall)


def _with_orbits(changes: Transitions) -> TypeGuard[OrbitTransitions]:
    """Whether there are orbits between the transitions; asked so that a plain list loads nothing of branches."""
    return hasattr(changes, "orbit_notes")


def _interval(interval: Interval) -> dict[str, Any]:
    orbits = [{name: value for name, value in orbit.as_dict().items() if name in ORBIT} for orbit in interval.orbits]
    changes = [{name: getattr(change, name) for name in CHANGE} for change in interval.changes]
    return {"from": interval.low, "to": interval.high, "orbits_in_the_middle": orbits, "changes": changes}


def _as_listed(found: Classification, over: str | None, changes: Transitions | None) -> dict[str, Any]:
    values = found.as_dict()
    if changes is not None:
        values["transitions"] = {"over": over} | changes.as_dict()
        if _with_orbits(changes):
            values["transitions"] |= {
                "intervals": [_interval(each) for each in changes.intervals],
                "orbit_notes": changes.orbit_notes,
            }
    return values


def _text(points: Classification, over: str | None, changes: Transitions | None) -> str:
    tables = [
        _table(
            "points of V_c' where p or phi is singular",
            ["point", "of", "kind", "tau", "t", "image tau", "image v"],
            [[p.name, p.maps, p.kind, *_numbers(p.tau, p.t, *p.image)] for p in points.points],
        ),
        _table(
            "fold lines",
            ["of", "from tau", "from t", "to tau", "to t", "ends"],
            [[f.maps, *_numbers(*f.start, *f.end), " to ".join(dict.fromkeys(f.bounds))] for f in points.folds],
        ),
        _table(
            "swan points over the clearance",
            ["c_0", "tau", "kind"],
            [[*_numbers(s.clearance, s.tau), s.kind] for s in points.swans],
            points.notes,
        ),
    ]
    if changes is not None:
        rows = [[c.kind, *_numbers(c.value, c.tau, c.t), SEEN[c.visible]] for c in changes]
        header = ["kind", str(over), "tau", "t", "visible"]
        tables.append(_table(f"where P changes as {over} moves", header, rows, changes.notes))
        if _with_orbits(changes):
            tables.append(f"periodic orbits:\n{changes!r}")
        if changes.swans_complete:
            tables.append("no swan between these ends is missing (by interval bounds)")
    low, high = _numbers(*points.tau), _numbers(*points.t)
    return "\n\n".join([f"window: tau from {' to '.join(low)}, t from {' to '.join(high)}", *tables])


def _table(title: str, header: list[str], rows: list[list[str]], notes: tuple[str, ...] = ()) -> str:
    told = columns(header, rows) if rows else "not decided" if notes else "none"
    return "\n".join([f"{title}:", told, *notes])


def _numbers(*values: float) -> list[str]:
    return [f"{value + 0.0:.12g}" for value in values]


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
        page = scenes.explore_page(_film(oscillator, between, points)).encode()
        cache.keep(stored, page)
    _show(page.decode(), file)


def _film(oscillator: ImpactOscillator, between: tuple[str, str] | None, points: int) -> ClearanceFilm:
    with ProgressLine() as line:
        return scenes.clearance_film(oscillator, between, points, line.show)


def _place(html: str | None, output: str | None) -> str | None:
    """The one file that was named, refused before the work when it cannot be written."""
    if html is not None and output is not None:
        raise InputError(f"--html {html} and -o {output} name two files: give one of them")
    place = output if html is None else html
    if place is not None:
        require_writable(place)
    return place


def _show(page: str, file: str | None) -> None:
    if file is not None:
        write_text(file, page)
        return
    import tempfile
    import webbrowser

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


# Figures of the paper and beyond it.

OTHER_PICTURES = (".gif", ".jpg", ".jpeg", ".eps", ".ps", ".tif", ".tiff", ".webp", ".bmp")  # no folder is meant
DPI = 200  # of a PNG: figures are as small as they are printed


@click.command()
@click.argument("which", metavar="N|all|beyond")
@click.option(
    "-o",
    "--output",
    metavar="DIR",
    default=".",
    show_default=True,
    help="A folder for the pictures, or for one figure a file ending in .png, .pdf or .svg.",
)
@click.option("--format", "kind", type=click.Choice(["png", "pdf", "svg"]), default="png", show_default=True)
@click.option("--serif", is_flag=True, help="Serif letters (STIX), as in a journal.")
@click.option("--dark", is_flag=True, help="Light lines on a dark ground.")
@click.option("--data", is_flag=True, help="Write the curves as JSON beside each picture.")
@click.option("--json", "as_json", is_flag=True, help="Print the written files and the CPU time in s as JSON.")
def figure_command(which: str, output: str, kind: str, serif: bool, dark: bool, data: bool, as_json: bool) -> None:
    """Draw figure N of the paper, 1 to 17, or all, each computed from an oscillator, and list the claims that it shows.

    B1 to B11 are figures of what is beyond the paper; `beyond` draws them all.

    Letters are 8 points high at the size of the file, which is at most 6.9 inches wide.

    What a figure shows is kept in the cache as numbers: a run that was cut off goes on where it was.
    """
    numbers = _figures(which)
    targets, written = _targets(output, numbers, kind), []
    with ProgressLine() as line:
        for done, number in enumerate(numbers):
            line.show(done, len(numbers), f"figure {number}")
            start, target = process_time(), targets[done]
            title, claims = save_once(("figure", number, serif, dark), target, partial(_made, number, serif, dark), DPI)
            if data:
                write_text(target.with_suffix(".json"), as_json_text(kept_picture(number).to_dict()) + "\n")
            written.append((number, title, claims, str(target), round(process_time() - start, 3)))
    if as_json:
        keys = ("figure", "title", "claims", "file", "seconds")
        click.echo(as_json_text({"figures": [dict(zip(keys, path, strict=True)) for path in written]}))
    else:
        for _, title, claims, file, _ in written:
            click.echo(f"{file}  {title}" + (f" ({', '.join(claims)})" if claims else ""))


def _made(number: int | str, serif: bool, dark: bool) -> tuple[Any, Any]:
    picture = kept_picture(number)
    return paper.drawn(picture, serif, dark), [picture.title, list(picture.claims)]


def _targets(output: str, numbers: list[int | str], kind: str) -> list[Path]:
    """Where each figure goes; the folder is there."""
    suffix = Path(output).suffix.lower()
    if suffix in OTHER_PICTURES and not Path(output).is_dir():
        raise refuse("output", output, "a folder, or for one figure a file name ending in .png, .pdf or .svg")
    if suffix not in PICTURES:
        return [folder(output) / f"figure{str(number).zfill(2)}.{kind}" for number in numbers]
    require(len(numbers) <= 1, "output", output, "a folder: these are several figures")
    require_writable(output)
    return [Path(output)]


def _figures(which: str) -> list[int | str]:
    if which in ("all", "beyond"):
        return [*FIGURES] if which == "all" else [*BEYOND]
    if which in BEYOND:
        return [which]
    require(which in map(str, FIGURES), "figure", which, f"{ACCEPTED}, or all, or beyond")
    return [int(which)]
