"""`singimpact figure`: the paper's figures from computed data, and those beyond it."""

from functools import partial
from pathlib import Path
from time import process_time
from typing import Any

import click

from singimpact import paper
from singimpact.cli.output import PICTURES, as_json_text, save_once
from singimpact.inputs import refuse, require
from singimpact.paper.figures import ACCEPTED, BEYOND, FIGURES, kept_picture
from singimpact.progress import ProgressLine
from singimpact.store import folder, require_writable, write_text

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
    numbers = _numbers(which)
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


def _numbers(which: str) -> list[int | str]:
    if which in ("all", "beyond"):
        return [*FIGURES] if which == "all" else [*BEYOND]
    if which in BEYOND:
        return [which]
    require(which in map(str, FIGURES), "figure", which, f"{ACCEPTED}, or all, or beyond")
    return [int(which)]
