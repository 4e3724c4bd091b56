"""`singimpact derive`: the derivations and the series of a model, in several formats."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from singimpact.inputs import InputError
from singimpact.store import folder, written

if TYPE_CHECKING:
    from singimpact.documents.document_steps import Mark, Section
    from singimpact.documents.series_documents import SeriesRequest

FORMATS = ("latex", "pdf", "markdown", "json", "sympy", "numpy")


@click.command()
@click.argument("names", metavar="[SECTION]...", nargs=-1)
@click.option(
    "--format", "form", type=click.Choice(FORMATS), default="latex", show_default=True, help="Format of the output."
)
@click.option("--order", type=int, help="Write series to this order, not the derivations.  [default: 6]")
@click.option("--model", metavar="FILE", help="Write the series of this model.")
@click.option("--tau", help="With --model: the point of the series.  [default: tangency and swan points]")
@click.option("--keep", metavar="NAME", multiple=True, help="With --model: a parameter that stays a letter.")
@click.option("--only", metavar="SERIES", help="Print this series alone, such as gamma, as one formula in LaTeX.")
@click.option("--json", "as_json", is_flag=True, help="The same as --format json.")
@click.option(
    "-o", "--output", metavar="DIR", help="Write files into this folder instead of one text to standard output."
)
def command(
    names: tuple[str, ...],
    form: str,
    order: int | None,
    model: str | None,
    tau: str | None,
    keep: tuple[str, ...],
    only: str | None,
    as_json: bool,
    output: str | None,
) -> None:
    """Write the derivations: steps in order, each equation with its label and the verdict of its claim.

    A SECTION is a number (4), a name (section4) or a subject (tangency); the default is all sections. The meanings of
    the letters follow them; the section notation prints them alone.
    LaTeX files are one for each section, and derivations.tex, which includes them.
    With --order or --model the series v_c, gamma and more are written instead, in any format. The formats sympy and
    numpy always write series. The numpy file of a model holds tau_* and the radius in which each series is accurate.
    """
    if only is not None:
        from singimpact.documents.series_documents import series_formulas

        click.echo("\n".join(series_formulas(_request(order, model, tau, keep), only)))
        return
    form = "json" if as_json else form
    if form == "pdf" and output is None:
        raise InputError("--format pdf goes to files only: give a folder with -o")
    if form == "pdf":
        from singimpact.documents.compiling import require_latex

        require_latex()
    if output is not None:
        folder(output)  # an error in the output path is raised before the computation, not after it
    if form in ("sympy", "numpy") or order is not None or model is not None:
        if names:
            raise InputError(f"{names[0]} is a section of the derivations: a series takes --order and --model alone")
        _series(_request(order, model, tau, keep), form, output)
        return
    if tau is not None or keep:
        raise InputError("--tau and --keep belong to --model")
    from singimpact.paper.sections.stored_sections import kept_sections, marks_of

    derived = kept_sections(names)
    _write(derived, marks_of(derived), form, output)


def _request(order: int | None, model: str | None, tau: str | None, keep: tuple[str, ...]) -> SeriesRequest:
    from singimpact.documents.series_documents import SeriesRequest
    from singimpact.impact_oscillator import read_model

    return SeriesRequest(6 if order is None else order, None if model is None else read_model(model), tau, keep)


def _series(request: SeriesRequest, form: str, output: str | None) -> None:
    """The series as text to standard output, or as files in the folder."""
    from singimpact.documents.series_documents import series_section, series_text
    from singimpact.paper.sections import NOTATION

    if form in ("sympy", "numpy", "json"):
        text = series_text(request, form)
        if output is None:
            click.echo(text, nl=False)
            return
        with written(Path(output) / ("series.json" if form == "json" else f"series_{form}.py")) as draft:
            draft.write_bytes(text.encode())
        return
    _write([series_section(request), NOTATION], {}, form, output)


def _write(document: list[Section], marks: dict[str, Mark], form: str, output: str | None) -> None:
    """The document as text to standard output, or as files in the folder."""
    from singimpact.documents.compiling import CompileError
    from singimpact.documents.rendering import as_files, as_text

    if output is None:
        click.echo(as_text(document, marks, form), nl=False)
        return
    try:
        files = as_files(document, marks, form, _picture)
    except CompileError as error:
        raise click.ClickException(str(error)) from None
    for name, content in files.items():
        with written(Path(output) / name) as draft:
            draft.write_bytes(content)


def _picture(name: str) -> bytes:
    """A figure of the paper as PDF, from its computed data."""
    from tempfile import TemporaryDirectory

    from singimpact.cli.output import save
    from singimpact.paper.figures import kept_picture
    from singimpact.paper.figures.figure_rendering import drawn

    with TemporaryDirectory() as directory:
        number = name.removeprefix("figure")
        save(drawn(kept_picture(int(number) if number.isdigit() else number)), f"{directory}/{name}.pdf")
        return Path(directory, f"{name}.pdf").read_bytes()
