"""`singimpact derive`: the derivations, written from the derived objects."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from singimpact.inputs import InputError
from singimpact.progress import ProgressLine
from singimpact.store import folder

if TYPE_CHECKING:
    from singimpact.documents.steps import Section

FORMATS = ("latex", "pdf", "markdown", "json")


@click.command(short_help="write the derivations as LaTeX, PDF, Markdown or JSON")
@click.argument("names", metavar="[SECTION]...", nargs=-1)
@click.option("--format", "form", type=click.Choice(FORMATS), default="latex", show_default=True, help="What to write.")
@click.option("--json", "as_json", is_flag=True, help="The same as --format json.")
@click.option("-o", "--output", metavar="DIR", help="Write one file a section there instead of to standard output.")
def command(names: tuple[str, ...], form: str, as_json: bool, output: str | None) -> None:
    """Write the derivations: steps in order, each equation with its label and the verdict of its claim."""
    from singimpact.documents.derivations import sections, verdicts_of

    form = "json" if as_json else form
    if form == "pdf" and output is None:
        raise InputError("--format pdf goes to files only: give a folder with -o")
    told = sections(names)
    if output is not None:
        folder(output)  # a place that cannot be written is refused before the claims are run
    with ProgressLine() as line:
        done = iter(range(1, sys.maxsize))
        verdicts = verdicts_of(told, lambda claim, _, total: line.show(next(done), total, claim.id))
    if output is None:
        _print(told, verdicts, form)
    else:
        _write(told, verdicts, form, output)


def _print(told: list[Section], verdicts: dict[str, str], form: str) -> None:
    from singimpact.documents.derivations import rendered

    texts = [rendered(section, verdicts, form).decode() for section in told]
    if form == "json":
        whole: Any = {"sections": [json.loads(text) for text in texts]}
        texts = [json.dumps(whole, indent=2) + "\n"]
    click.echo("\n".join(texts), nl=False)


def _write(told: list[Section], verdicts: dict[str, str], form: str, output: str) -> None:
    from singimpact.documents.compiling import CompileError
    from singimpact.documents.derivations import ENDINGS, rendered
    from singimpact.store import written

    for section in told:
        try:
            content = rendered(section, verdicts, form)
        except CompileError as error:
            raise click.ClickException(f"section {section.name}: {error}") from None
        with written(Path(output) / f"{section.name}{ENDINGS[form]}") as draft:
            draft.write_bytes(content)
