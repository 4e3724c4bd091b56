"""`singimpact errata`: misprints of the paper, their corrections, and the reasons."""

from pathlib import Path

import click

from singimpact.cli.output import as_json_text, emit
from singimpact.inputs import InputError
from singimpact.store import require_writable, written

FORMATS = ("text", "markdown", "latex", "pdf", "json")


@click.command()
@click.option(
    "--format", "form", type=click.Choice(FORMATS), default="text", show_default=True, help="Format of the output."
)
@click.option("--json", "as_json", is_flag=True, help="The same as --format json.")
@click.option("-o", "--output", metavar="FILE", help="Write to this file instead of standard output.")
def command(form: str, as_json: bool, output: str | None) -> None:
    """Every statement that fails as printed, with its correction, a witness, and the effect on later statements."""
    from singimpact.paper.sections.errata import errata

    form = "json" if as_json else form
    if form == "pdf" and output is None:
        raise InputError("--format pdf goes to a file only: give its name with -o")
    if output is not None:
        require_writable(output)
    misprints = errata()
    if form == "pdf":
        _write_pdf(misprints.latex(), str(output))
    else:
        emit(as_json_text(misprints.as_dict()) if form == "json" else getattr(misprints, form)(), output)


def _write_pdf(source: str, output: str) -> None:
    from singimpact.documents.compiling import CompileError, compiled

    try:
        pdf = compiled(source).pdf
    except CompileError as error:
        raise click.ClickException(str(error)) from None
    with written(output) as draft:
        Path(draft).write_bytes(pdf)
