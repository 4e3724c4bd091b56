"""`singimpact derive`: the derivations, written from the derived objects."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from singimpact.inputs import InputError
from singimpact.progress import ProgressLine
from singimpact.store import folder

if TYPE_CHECKING:
    from singimpact.documents.steps import Mark, Section

FORMATS = ("latex", "pdf", "markdown", "json", "sympy", "numpy")


@click.command(short_help="write the derivations as LaTeX, PDF, Markdown or JSON")
@click.argument("names", metavar="[SECTION]...", nargs=-1)
@click.option("--format", "form", type=click.Choice(FORMATS), default="latex", show_default=True, help="What to write.")
@click.option("--order", type=int, help="With sympy or numpy: the order of the series.  [default: 6]")
@click.option("--model", metavar="FILE", help="With sympy or numpy: the series of this model.")
@click.option("--json", "as_json", is_flag=True, help="The same as --format json.")
@click.option("-o", "--output", metavar="DIR", help="Write files there instead of one text to standard output.")
def command(
    names: tuple[str, ...], form: str, order: int | None, model: str | None, as_json: bool, output: str | None
) -> None:
    """Write the derivations: steps in order, each equation with its label and the verdict of its claim.

    A SECTION is a number (4), a name (section4) or a subject (tangency); all of them without one.
    LaTeX goes into DIR as one file a section and derivations.tex, which takes them in.
    sympy and numpy write the series v_c, gamma and more to an order, for symbols or for a model.
    """
    from singimpact.documents.derivations import as_text, marks_of, sections

    form = "json" if as_json else form
    if form in ("sympy", "numpy"):
        _series(form, order, model, output)
        return
    if order is not None or model is not None:
        raise InputError("--order and --model belong to --format sympy and --format numpy")
    if form == "pdf" and output is None:
        raise InputError("--format pdf goes to files only: give a folder with -o")
    told = sections(names)
    if output is not None:
        folder(output)  # a place that cannot be written is refused before the claims are run
    with ProgressLine() as line:
        done = iter(range(1, sys.maxsize))
        marks = marks_of(told, lambda claim, _, total: line.show(next(done), total, claim.id))
    if output is None:
        click.echo(as_text(told, marks, form), nl=False)
    else:
        _write(told, marks, form, output)


def _series(form: str, order: int | None, model: str | None, output: str | None) -> None:
    """The series as text, to standard output or to a file in the folder."""
    from singimpact.documents.series import series_text
    from singimpact.store import written

    if output is not None:
        folder(output)
    given = None
    if model is not None:
        from singimpact.impact_oscillator import read_model

        given = read_model(model)
    text = series_text(6 if order is None else order, form, given)
    if output is None:
        click.echo(text, nl=False)
        return
    with written(Path(output) / f"series_{form}.py") as draft:
        draft.write_bytes(text.encode())


def _write(told: list[Section], marks: dict[str, Mark], form: str, output: str) -> None:
    from singimpact.documents.compiling import CompileError
    from singimpact.documents.derivations import as_files
    from singimpact.store import written

    try:
        files = as_files(told, marks, form)
    except CompileError as error:
        raise click.ClickException(str(error)) from None
    for name, content in files.items():
        with written(Path(output) / name) as draft:
            draft.write_bytes(content)
